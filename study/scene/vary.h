/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A number of a scene that takes several values: "contact.stiffness=1e2..1e6 log 9". */
#ifndef BR_STUDY_SCENE_VARY_H
#define BR_STUDY_SCENE_VARY_H

#include "study/scene/schema.h"

enum { BR_MOST_VARIED = 1000 };

/* Starts as zeros. */
struct br_varied {
    const struct br_scene_key *key;
    char name[64];    /* "contact.stiffness" */
    bool logarithmic; /* the spacing of its values */
    char unit[32];    /* of the values; "": none, where the key accepts a number without unit, like
                         Coulomb's coefficient */
    double *value;    /* count, in that unit, in the order given; owned */
    size_t count;
};

/* Reads KEY=LOW..HIGH log|lin COUNT, or KEY=VALUE,VALUE,... A unit after one value is that of all;
 * without one they have the key's unit. If the key accepts ratios, values without unit are ratios,
 * and in a list all values have the unit or none has. The scene's reader checks the unit. Fails
 * with BR_BAD_INPUT, naming the key, what was found and expected, or BR_NO_MEMORY; clear it even
 * then. */
enum br_status br_varied_read(const char *text, struct br_varied *varied, struct br_error *err);
void br_varied_clear(struct br_varied *varied);

/* Reads a scene from a text in which value i replaces that of the key, with all checks. path: for
 * messages. Fails as br_scene_read_text does; clear the scene even then. */
enum br_status br_varied_scene(const struct br_varied *varied, size_t i, const char *path,
                               const char *text, struct br_scene *scene, struct br_error *err);

/* ---- results at each value ---- */

/* Numbers by columns, for one table and one picture. */
struct br_variation_column {
    const char *key, *heading, *unit, *format; /* as those of a document's columns */
    bool for_programs;                         /* not in tables for people */
    const char *axis; /* label of its panel's axis, in gnuplot's markup; columns with the same label
                         share a panel; NULL: not drawn */
    bool logarithmic; /* of that axis */
};

/* Borrowed, except what br_variation_create allocates. */
struct br_variation {
    const struct br_varied *varied;
    const char *format; /* of the document: "beamrate study variation" */
    char name[300];     /* of the files */
    char caption[400];
    const struct br_variation_column *column;
    size_t columns;
    double *value;       /* varied->count rows of `columns` numbers; NaN: none; owned */
    const char **remark; /* varied->count static texts: why it is flagged; NULL: not; owned */
    bool *unstable; /* varied->count: lagged contact beyond its stability limit; in tables only;
                       owned */
    struct br_error *failure; /* varied->count; status BR_OK: none; owned */
};

/* Allocates all values, as NaN, and makes name and caption from the scene. The caller has set
 * varied, format, column and columns. Fails with BR_NO_MEMORY. */
enum br_status br_variation_create(struct br_variation *sweep, const struct br_scene *scene,
                                   struct br_error *err);
void br_variation_clear(struct br_variation *sweep);

/* Writes "contact.stiffness = 100 N/m"; returns text (out). */
enum { BR_VARIED_TEXT = 120 };
const char *br_varied_text(const struct br_varied *varied, size_t i, char text[BR_VARIED_TEXT]);

/* How many values have failed; *first (out): the first of these. */
size_t br_variation_failures(const struct br_variation *sweep, size_t *first);

/* The value of row i in a column. */
static inline double br_variation_value(const struct br_variation *s, size_t i, size_t column)
{
    return s->value[i * s->columns + column];
}

#endif
