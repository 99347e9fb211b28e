/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes and small helpers for the tests of the exact reference. */
#ifndef BR_TESTS_EXACT_SCENES_H
#define BR_TESTS_EXACT_SCENES_H

#include "reference/exact/exact.h"
#include "tests/test.h"

/* A function of x and t with parameters; f gets them all. */
struct formula {
    double (*f)(const double *p, double x, double t);
    double p[4];
};

/* Borrows the formula. */
struct br_function formula_function(struct formula *formula);

/* amplitude times the formula's function of t alone */
struct br_load formula_load(double amplitude, struct formula *time);

double f_expm1(const double *p, double x, double t); /* e^{p0 t} - 1 */
double f_ramp(const double *p, double x, double t);  /* p0 t */
double f_sine(const double *p, double x, double t);  /* sin(p0 t) */
double f_power(const double *p, double x, double t); /* p0 x^p1 */

/* The paper's example 1 to 4. */
struct br_scene paper_example(int which);

/* Solves the scene, or fails the test. */
struct br_exact *solve(const struct br_scene *scene, double tolerance);
struct br_exact_state *new_state(const struct br_exact *exact);

/* One value of a part. */
double value_of(const struct br_exact *exact, const struct br_exact_state *state,
                struct br_exact_part part, double x);

/* Square of the L2 norm of a part over the beam. */
double square_of(const struct br_exact *exact, const struct br_exact_state *state,
                 struct br_exact_part part);

/* Fails the test unless |value - expected| <= allowed; NaN fails. */
void assert_near(double value, double expected, double allowed);

#endif
