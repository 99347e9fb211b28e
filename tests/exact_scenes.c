/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdarg.h>

#include "solver/function.h"
#include "solver/scene.h"

#include "tests/exact_points.h"
#include "tests/exact_scenes.h"
#include "tests/support.h"

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

struct br_load uniform(double amplitude, const char *time)
{
    return (struct br_load){.term[0].space = {.constant = amplitude},
                            .term[0].time = br_test_function(time)};
}

struct solved solve(const struct br_scene *scene, double tolerance)
{
    struct solved s = {0};
    const struct br_exact_options options = {.tolerance = tolerance};
    if (br_exact_create(&s.exact, scene, &options, &err))
        fail_msg("%s", err.message);
    assert_int_equal(br_exact_state_create(&s.state, s.exact, NULL), BR_OK);
    return s;
}

void release(struct solved *s)
{
    br_exact_state_free(s->state);
    br_exact_free(s->exact);
}

double value_of(const struct solved *s, struct br_exact_quantity part, double x)
{
    double value = NAN;
    assert_int_equal(exact_points(s->exact, s->state, &part, 1, &x, &value, NULL), BR_OK);
    return value;
}

double square_of(const struct solved *s, struct br_exact_quantity part)
{
    struct br_exact_projection *projection = NULL;
    const struct br_exact_mesh mesh = {.elements = 1, .degree = 3};
    double c[4], square = NAN;
    assert_int_equal(br_exact_projection_create(&projection, s->exact, &part, &mesh, NULL), BR_OK);
    br_exact_projection_apply(projection, s->state, c, &square);
    br_exact_projection_free(projection);
    for (size_t i = 0; i < 4; i++)
        square += c[i] * c[i];
    return square;
}

struct text text_of(const char *format, ...)
{
    struct text text;
    va_list rest;
    va_start(rest, format);
    const int length = vsnprintf(text.s, sizeof text.s, format, rest);
    va_end(rest);
    assert_true(length < (int)sizeof text.s);
    return text;
}

/* All places, or the one force. */
static void check_now(const struct solved *s, double length, const struct expected *e,
                      const struct br_function *f)
{
    const struct br_exact_state *now = s->state;
    const double at_tip = br_function_at(f, length, now->time);
    if (e->what != PART) {
        assert_near(e->what == CONTACT_FORCE ? now->contact_force : now->friction_force, at_tip,
                    e->allowed);
        return;
    }
    for (int i = 0; i <= 5; i++) {
        const double x = length * i / 5;
        assert_near(value_of(s, e->part, x), br_function_at(f, x, now->time), e->allowed);
    }
    if (e->part.order == 0)
        assert_near(e->part.velocity ? now->tip[e->part.field].velocity
                                     : now->tip[e->part.field].displacement,
                    at_tip, e->allowed);
}

void check_closed(const struct solved *s, double length, double until, int times, size_t count,
                  const struct expected *expected)
{
    for (size_t i = 0; i < count; i++) {
        OWNED(br_function) f = br_test_function(expected[i].f.s);
        for (int n = 1; n <= times; n++) {
            br_exact_at(s->exact, until * n / times, s->state);
            check_now(s, length, &expected[i], &f);
        }
    }
}

void assert_near(double value, double expected, double allowed)
{
    if (!(fabs(value - expected) <= allowed))
        fail_msg("%.17g, expected %.17g: off by %.3g, allowed %.3g", value, expected,
                 fabs(value - expected), allowed);
}
