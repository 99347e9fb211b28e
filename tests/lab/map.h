/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The map of extremes: scenes, methods and resolutions that are drawn from a seed to break the
 * program, and what checks them. map.c counts, test_map.c replays cases that were wrong once. */
#ifndef BR_TESTS_LAB_MAP_H
#define BR_TESTS_LAB_MAP_H

#include <stdint.h>

#include "solver/method.h"
#include "solver/scene.h"

/* ---- cases ---- */

/* A case is a scene, a method and a resolution, drawn at random from (seed, index) alone, so that
 * neither order nor threads matter. */

/* size * shape * history; size 0: none. */
struct br_extreme_force {
    double size;    /* N/m, N or N m */
    size_t shape;   /* of x, a row of case.c; 0: constant, as the tip's are */
    size_t history; /* of t, likewise */
    double rate;    /* oscillations within T */
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

/* What was changed on purpose after the numbers were drawn. */
enum br_extreme_special {
    BR_SPECIAL_NONE,
    BR_SPECIAL_AT_LIMIT,    /* c_H at the lagged contact's stability limit times 1 +- little */
    BR_SPECIAL_AT_REACTION, /* Tresca's bound is the first step's reaction to the last bit */
    BR_SPECIAL_REVERSAL,    /* forces oscillate within a step */
    BR_SPECIAL_GRAZING,  /* the gap is the tip's largest static displacement to the last digits */
    BR_SPECIAL_DENORMAL, /* loads of about 1e-310 */
    BR_SPECIAL_ZEROS,    /* some numbers that may be 0 are */
    BR_SPECIALS
};

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

/* ---- what checks ---- */

/* Tests for one case that a march is right, or that the program says that it is not.
 *
 * A case is read, checked for warnings, and marched as `run --check` does. Then
 *   - the certificate of every step, the energy balance and the numbers themselves must be sound;
 *   - the exact solution, or where that cannot be had in time another scheme on a finer mesh by
 *     shorter steps, measures the error of the displacements, which is compared with the error
 *     stated before the march (prediction.h).
 * Silently wrong is an answer whose error is larger than the stated one with its interval, or than
 * 5 % where none is stated and no warning says so; or an answer that breaks an equation or a law.
 * Each field counts relative to its own size. */

enum br_extreme_class {
    BR_EXTREME_RIGHT,
    BR_EXTREME_WARNED,   /* inaccurate, and says so */
    BR_EXTREME_UNKNOWN,  /* inaccurate, and says that its error is not known */
    BR_EXTREME_UNSTABLE, /* as predicted */
    BR_EXTREME_REFUSED,
    BR_EXTREME_UNCHECKED, /* given up by the map */
    BR_EXTREME_WRONG,
    BR_EXTREME_CLASSES
};
extern const char *const br_extreme_words[BR_EXTREME_CLASSES];

/* What the error is measured by. */
enum br_extreme_by { BR_BY_NOBODY, BR_BY_EXACT, BR_BY_REFINEMENT };
extern const char *const br_extreme_sources[];

struct br_extreme_verdict {
    enum br_extreme_class which;
    enum br_extreme_by by;
    bool known;     /* the run states its error */
    double error;   /* of displacements, over the largest; NaN: not known */
    double nearest; /* the error of the field that is nearest to its stated bound or furthest beyond
                       it; NaN: not compared */
    double stated;  /* that bound; INFINITY: no bound; NaN: not compared */
    unsigned warned; /* bits: 1 << br_warning_kind */
    char why[200];   /* the reason why it is not right; one line */
};

/* An error over the stated one, where it is larger than that and the slack of the reference; else
 * 0. */
double br_extreme_beyond(double error, double slack, double stated);

/* The class of an answer by the members by, known, error and warned, and by how far an error is
 * beyond the stated one. */
enum br_extreme_class br_extreme_class_of(const struct br_extreme_verdict *verdict, double beyond);

/* How a case is checked; zeros: as the map does. */
struct br_extreme_options {
    bool quick;            /* without the exact solution */
    double stated_divisor; /* divides the stated errors, so that tests see what is called wrong; 0:
                              as stated */
};

/* Checks a case; *verdict (out). Fails with BR_NO_MEMORY. */
enum br_status br_extreme_check(const struct br_extreme_case *one,
                                const struct br_extreme_options *options,
                                struct br_extreme_verdict *verdict, struct br_error *err);

#endif
