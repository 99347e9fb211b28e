/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cases for the map of extremes: a scene, a method and a resolution, drawn at random from (seed,
 * index) alone, so that neither order nor threads matter. A case is kept as numbers, so that it can
 * be shrunk, and written as the text of a scene file. */
#ifndef BR_STUDY_EXTREMES_CASE_H
#define BR_STUDY_EXTREMES_CASE_H

#include <stdint.h>

#include "solver/march.h"

/* Of x, xi = x/L. */
enum br_extreme_shape {
    BR_SHAPE_FLAT,   /* 1 */
    BR_SHAPE_LINEAR, /* xi */
    BR_SHAPE_SINE,   /* sin(pi xi) */
    BR_SHAPE_WAVES,  /* sin(7 pi xi) */
    BR_SHAPE_POWER,  /* 1 - xi^3 */
    BR_SHAPES
};

/* Of t, s = t/T. */
enum br_extreme_history {
    BR_HISTORY_SUDDEN, /* 1 */
    BR_HISTORY_RAMP,   /* s */
    BR_HISTORY_EXP,    /* exp(s) - 1 */
    BR_HISTORY_SINE,   /* sin(2 pi rate s) */
    BR_HISTORY_POWER,  /* s^3 - 2 s^2 */
    BR_HISTORIES
};

/* size * shape * history; size 0: none. */
struct br_extreme_force {
    double size; /* N/m, N or N m */
    enum br_extreme_shape shape;
    enum br_extreme_history history;
    double rate; /* oscillations within T */
};

/* Initial data: size * xi of the rod, size * xi^2 of the beam; or, waved, size * sin(5 pi xi/2) and
 * size * (1 - cos(5 pi xi/2)). */
struct br_extreme_start {
    double size; /* m or m/s */
    bool waved;
};

/* One field. */
struct br_extreme_field {
    bool modelled;
    double stiffness, viscosity; /* N and N s, or N m^2 and N m^2 s */
    struct br_extreme_force load, tip_force, tip_moment;
    struct br_extreme_start displacement, velocity;
};

/* What was done on purpose beside drawing numbers. */
enum br_extreme_special {
    BR_SPECIAL_NONE,
    BR_SPECIAL_AT_LIMIT,    /* c_H at the lagged contact's stability limit times 1 +- little */
    BR_SPECIAL_AT_REACTION, /* Tresca's bound is the first step's reaction to the last bit */
    BR_SPECIAL_REVERSAL,    /* forces oscillate within a step */
    BR_SPECIAL_GRAZING,     /* the gap is the tip's largest static way to the last digits */
    BR_SPECIAL_DENORMAL,    /* loads of about 1e-310 */
    BR_SPECIAL_ZEROS,       /* some numbers that may be 0 are */
    BR_SPECIALS
};
extern const char *const br_extreme_specials[BR_SPECIALS];

struct br_extreme_case {
    uint64_t seed;
    size_t index;
    bool natural; /* dimensionless groups were drawn, not numbers with units */
    enum br_extreme_special special;
    double length, duration, density; /* m, s, kg/m */
    struct br_extreme_field field[2]; /* by br_field_kind */
    bool contact;
    double gap, contact_stiffness; /* m, N/m */
    enum br_friction_law law;
    double friction, regularisation; /* c_V: N or N/m; mu: m/s */
    unsigned wanted;                 /* fields, see study/run/run.h */
    struct br_method method;
    size_t n, steps;
};

/* Draws a case (out). */
void br_extreme_draw(uint64_t seed, size_t index, struct br_extreme_case *drawn);

enum { BR_EXTREME_TEXT = 8192, BR_EXTREME_COMMAND = 1024 };

/* The scene file (out), with a comment of where it comes from, and the command line that marches
 * the scene `name`. */
void br_extreme_scene(const struct br_extreme_case *one, char text[BR_EXTREME_TEXT]);
void br_extreme_command(const struct br_extreme_case *one, const char *name,
                        char text[BR_EXTREME_COMMAND]);

#endif
