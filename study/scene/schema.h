/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scene format: one row for each key. The reader, its messages and the template of
 * tables/beam/reports.h use this list. */
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
    BR_KEY_LAW,          /* a name of br_friction_models */
    BR_KEY_SHAPE,        /* "rectangle 20 mm x 5 mm": a cross-section */
    BR_KEY_VERIFY,       /* whoever asks for it reads it: br_scene_asked */
};

/* Whether a key must be given if its section is given. */
enum br_need {
    BR_OPTIONAL,
    BR_REQUIRED,
    BR_OR_DERIVED, /* required, or derived from other keys (engineering.c) */
    BR_OR_RATIO,   /* required; a number without unit is accepted as a ratio */
    BR_MAKES,      /* optional: another number is derived from it; it is not in struct br_scene */
};

struct br_scene_key {
    const char *section; /* "" at the top */
    const char *name;
    enum br_key_kind kind;
    enum br_need need;
    unsigned laws;       /* of friction that have this key, a bit each: 1u << BR_COULOMB; 0: any */
    const char *unit;    /* one unit of its dimension; "": none */
    size_t offset;       /* in struct br_scene; of a section: of its flag `modelled` */
    const char *help;    /* what is expected; "" of a law: br_scene_key_help */
    const char *example; /* a value for templates; the required keys together make a scene */
};

enum { BR_MOST_SCENE_KEYS = 64 };

/* The numbers that a file gives, by rows of br_scene_keys. */
struct br_scene_given {
    struct br_scene_number {
        size_t line;               /* 0: not given; of a derived number: the line of its source */
        size_t origin;             /* the row of the key that the file gives */
        bool ratio;                /* the file gives a ratio (BR_OR_RATIO) */
        bool used;                 /* another number was derived from it */
        long double value, second; /* in m, s and kg; of a section: area and inertia */
    } row[BR_MOST_SCENE_KEYS];
};

/* Ends with a row whose name is NULL. */
extern const struct br_scene_key br_scene_keys[];

/* What is expected of a key. text: workspace. */
enum { BR_KEY_HELP = 200 };
const char *br_scene_key_help(const struct br_scene_key *key, char text[BR_KEY_HELP]);

/* The row of a key, as "axial.stiffness" or "density", which must exist. */
size_t br_scene_row(const char *path);

#endif
