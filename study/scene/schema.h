/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scene format: one row a key. The reader, its messages, the template and the JSON schema of
 * tables/scene_format.h walk this list. */
#ifndef BR_STUDY_SCENE_SCHEMA_H
#define BR_STUDY_SCENE_SCHEMA_H

#include "solver/scene.h"

enum br_key_kind {
    BR_KEY_SECTION,
    BR_KEY_TEXT,
    BR_KEY_POSITIVE,     /* "number unit", > 0 */
    BR_KEY_NOT_NEGATIVE, /* "number unit", >= 0 */
    BR_KEY_LOAD,         /* "expression in x and t [N/m]", or shape and history */
    BR_KEY_INITIAL,      /* "expression in x [unit]" */
    BR_KEY_HISTORY,      /* "expression in t [unit]" */
    BR_KEY_SOLUTION,     /* "expression in x and t [unit]", kept as text */
    BR_KEY_LAW,          /* tresca or coulomb */
    BR_KEY_SHAPE,        /* "rectangle 20 mm x 5 mm": a cross-section */
    BR_KEY_VERIFY,       /* read by verify_file.c, and only where somebody asks for it */
};

/* Whether a key must be given where its section is. */
enum br_need {
    BR_OPTIONAL,
    BR_REQUIRED,
    BR_OR_DERIVED, /* it, or what makes it (engineering.c) */
    BR_OR_RATIO,   /* it, or a number without unit that makes it */
    BR_MAKES,      /* optional: makes another one, and is in no struct br_scene */
};

struct br_scene_key {
    const char *section; /* "" at the top */
    const char *name;
    enum br_key_kind kind;
    enum br_need need;
    enum br_friction_law law; /* the law it belongs to; BR_FRICTIONLESS: any */
    const char *unit;         /* "" for none; one of those of its dimension */
    size_t offset;            /* into struct br_scene; of a section: whether it is modelled */
    const char *help;         /* what is expected */
    const char *example;      /* a value, for templates; the required ones make a scene together */
};

enum { BR_MOST_SCENE_KEYS = 64 };

/* What a file gives, row by row of br_scene_keys. */
struct br_scene_given {
    struct br_scene_number {
        size_t line;               /* 0: not given; of what makes it, where it is derived */
        size_t origin;             /* the row that was given */
        bool ratio;                /* of BR_OR_RATIO: the number without unit */
        bool used;                 /* it has made another one */
        long double value, second; /* in m, s and kg; of a section: area and inertia */
    } row[BR_MOST_SCENE_KEYS];
};

/* The names of the friction laws, by enum br_friction_law; NULL where none is written. */
enum { BR_FRICTION_LAWS = 3 };
extern const char *const br_friction_law_names[BR_FRICTION_LAWS];

/* Ends with a row whose name is NULL. */
extern const struct br_scene_key br_scene_keys[];

/* The row of "axial.stiffness", or of "density", which is there. */
size_t br_scene_row(const char *path);

/* Refuses (BR_BAD_INPUT) initial data that break the clamp, that are not finite,
 * or whose slope is missing or is not the derivative. *culprit (out): where in struct br_scene the
 * function at fault is. */
enum br_status br_scene_check_initial(const struct br_scene *scene, size_t *culprit,
                                      struct br_error *err);

/* ---- functions that are numbers everywhere ---- */

/* Whether the function of a key (an initial one, a history or a load) is proved to be finite
 * everywhere in [0, L] and [0, T] (solver/proof.h). Fails with BR_BAD_INPUT, naming value, x and t,
 * also where that cannot be proved; BR_OK for other keys. */
enum br_status br_scene_scan(const struct br_scene *scene, const struct br_scene_key *key,
                             struct br_error *err);

#endif
