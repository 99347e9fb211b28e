/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes and small helpers for the tests of the exact reference. */
#ifndef BR_TESTS_EXACT_SCENES_H
#define BR_TESTS_EXACT_SCENES_H

#include "reference/exact/exact.h"
#include "tests/support.h"

/* A function of x and t with parameters; f gets them all. */
struct formula {
    double (*f)(const double *p, double x, double t);
    double p[4];
};

/* Borrows the formula. */
struct br_function formula_function(struct formula *formula);

/* amplitude times a function of t; to be freed with its scene */
struct br_load uniform(double amplitude, const char *time);

/* A solution, and a state of it to read it with. */
struct solved {
    struct br_exact *exact;
    struct br_exact_state *state;
};

/* Solves the scene, or fails the test. To be released. */
struct solved solve(const struct br_scene *scene, double tolerance);
void release(struct solved *solved);

/* One value of a part now. */
double value_of(const struct solved *solved, struct br_exact_quantity part, double x);

/* Square of the L2 norm of a part over the beam. */
double square_of(const struct solved *solved, struct br_exact_quantity part);

/* Room for a text that is made from numbers. */
struct text {
    char s[1000];
};
__attribute__((format(printf, 1, 2))) struct text text_of(const char *format, ...);

/* What a solution must be: a part of it, or a force at the tip, as an expression in x and t. */
struct expected {
    enum { PART, CONTACT_FORCE, FRICTION_FORCE } what;
    struct br_exact_quantity part;
    struct text f;
    double allowed;
};

/* Up to the time `until`, itself among `times` times, and at six places, the ends among them;
 * values of the tip itself, too. */
void check_closed(const struct solved *solved, double length, double until, int times, size_t count,
                  const struct expected *expected);

/* Fails the test unless |value - expected| <= allowed; NaN fails. */
void assert_near(double value, double expected, double allowed);

#endif
