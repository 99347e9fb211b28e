/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "tests/exact_scenes.h"

static void evaluate(void *self, size_t count, const double *x, double t, double *value)
{
    const struct formula *formula = self;
    for (size_t i = 0; i < count; i++)
        value[i] = formula->f(formula->p, x[i], t);
}

static const struct br_function_ops formula_ops = {.evaluate = evaluate};

struct br_function formula_function(struct formula *formula)
{
    return (struct br_function){
        .ops = &formula_ops, .self = formula, .uses_x = true, .uses_t = true};
}

struct br_load formula_load(double amplitude, struct formula *time)
{
    return (struct br_load){.term[0].space = {.constant = amplitude},
                            .term[0].time = formula_function(time)};
}

double f_expm1(const double *p, double x, double t)
{
    (void)x;
    return expm1(p[0] * t);
}

double f_ramp(const double *p, double x, double t)
{
    (void)x;
    return p[0] * t;
}

double f_sine(const double *p, double x, double t)
{
    (void)x;
    return sin(p[0] * t);
}

double f_power(const double *p, double x, double t)
{
    (void)t;
    return p[0] * pow(x, p[1]);
}

struct br_scene paper_example(int which)
{
    static struct formula exponential = {f_expm1, {1}}, ramp = {f_ramp, {1}},
                          sine = {f_sine, {1.57079632679489661923}};
    static const double friction[] = {5e6, 1e4, 3000, 5e4};
    struct br_scene s = {
        .length = 1,
        .duration = which == 4 ? 3 : 1,
        .density = 1e-4,
        .axial = {.modelled = which != 3, .stiffness = 1000, .viscosity = 1},
        .bending = {.modelled = true, .stiffness = 1000, .viscosity = 1},
        .contact = {.modelled = which != 3, .stiffness = 1000},
        .friction = {which == 3 ? BR_TRESCA : BR_COULOMB, friction[which - 1], 0},
    };
    if (which <= 2) {
        s.axial.load = formula_load(which == 1 ? 400 : 100, &exponential);
        s.bending.load = formula_load(which == 1 ? -10000 : -1000, &exponential);
    } else {
        s.axial.load = formula_load(125, &ramp);
        s.bending.load = which == 3 ? formula_load(-10000, &ramp) : formula_load(10000, &sine);
    }
    return s;
}

struct br_exact *solve(const struct br_scene *scene, double tolerance)
{
    struct br_error err = {0};
    struct br_exact *exact = NULL;
    const struct br_exact_options options = {.tolerance = tolerance};
    if (br_exact_create(&exact, scene, &options, &err))
        fail_msg("%s", err.message);
    return exact;
}

struct br_exact_state *new_state(const struct br_exact *exact)
{
    struct br_exact_state *state = NULL;
    assert_int_equal(br_exact_state_create(&state, exact, NULL), BR_OK);
    return state;
}

double value_of(const struct br_exact *exact, const struct br_exact_state *state,
                struct br_exact_part part, double x)
{
    double value = NAN;
    assert_int_equal(br_exact_evaluate(exact, state, &part, 1, &x, &value, NULL), BR_OK);
    return value;
}

double square_of(const struct br_exact *exact, const struct br_exact_state *state,
                 struct br_exact_part part)
{
    struct br_exact_projection *projection = NULL;
    const struct br_exact_mesh mesh = {.elements = 1, .degree = 3};
    double c[4], square = NAN;
    assert_int_equal(br_exact_projection_create(&projection, exact, &part, &mesh, NULL), BR_OK);
    br_exact_projection_apply(projection, state, c, &square);
    br_exact_projection_free(projection);
    for (size_t i = 0; i < 4; i++)
        square += c[i] * c[i];
    return square;
}

void assert_near(double value, double expected, double allowed)
{
    if (!(fabs(value - expected) <= allowed))
        fail_msg("%.17g, expected %.17g: off by %.3g, allowed %.3g", value, expected,
                 fabs(value - expected), allowed);
}
