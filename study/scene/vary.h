/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A number of a scene that takes several values: "contact.stiffness=1e2..1e6 log 9". */
#ifndef BR_STUDY_SCENE_VARY_H
#define BR_STUDY_SCENE_VARY_H

#include "study/scene/schema.h"

enum { BR_MOST_VARIED = 1000 };

/* Begins as zeros. */
struct br_varied {
    const struct br_scene_key *key;
    char name[64];    /* "contact.stiffness" */
    bool logarithmic; /* its values are spaced so */
    char unit[32];    /* of the values; "": of a key that takes numbers without unit, as Coulomb's
                         coefficient, which they then make */
    double *value;    /* count, in that unit, in the order given; owned */
    size_t count;
};

/* Reads KEY=LOW..HIGH log|lin COUNT, or KEY=VALUE,VALUE,... A unit behind a value is that of all;
 * without one they have the key's, or none where the key takes numbers without, whose list has it
 * behind each or none. The scene's reader judges it. Fails with BR_BAD_INPUT, naming the key, what
 * was found and what was expected, or with BR_NO_MEMORY; clear it even then. */
enum br_status br_varied_read(const char *text, struct br_varied *varied, struct br_error *err);
void br_varied_clear(struct br_varied *varied);

/* Reads the scene of a text (path: for messages) as if value i stood in it, with all checks. Fails
 * as br_scene_read_text does; clear the scene even then. */
enum br_status br_varied_scene(const struct br_varied *varied, size_t i, const char *path,
                               const char *text, struct br_scene *scene, struct br_error *err);

/* ---- what a command finds at each value ---- */

/* Numbers by columns, for one table and one picture. */
struct br_variation_column {
    const char *key, *heading, *unit, *format; /* as those of a document's columns */
    bool for_programs;                         /* people do not see it */
    const char *axis; /* its panel's, in gnuplot's markup; columns with the same one are drawn
                         together; NULL: not drawn */
    bool logarithmic; /* that axis */
};

/* Borrowed, but for what br_variation_create makes. */
struct br_variation {
    const struct br_varied *varied;
    const char *format; /* of the document: "beamrate study variation" */
    char name[300];     /* of the files */
    char caption[400];
    const struct br_variation_column *column;
    size_t columns;
    double *value;            /* varied->count rows of `columns` numbers; NaN: none; owned */
    const char **remark;      /* varied->count static texts: why it counts less; NULL: it does not;
                                 owned */
    bool *unstable;           /* varied->count: beyond the lagged contact's stability limit; such a
                                 row is in the tables alone; owned */
    struct br_error *failure; /* varied->count; status BR_OK: none; owned */
};

/* Makes room for all values, all NaN, of a scene, and the name and caption from it; varied, format,
 * column and columns are set. Fails with BR_NO_MEMORY. */
enum br_status br_variation_create(struct br_variation *sweep, const struct br_scene *scene,
                                   struct br_error *err);
void br_variation_clear(struct br_variation *sweep);

/* "contact.stiffness = 100 N/m": returns the text. */
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
