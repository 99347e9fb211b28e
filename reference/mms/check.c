/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/mms/check.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <math.h>

#include "reference/mms/tip.h"

static const struct br_partial axial_orders[] = {
    {0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 1}, {0, 2},
};
static const struct br_partial bending_orders[] = {
    {0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {0, 1}, {1, 1}, {2, 1}, {3, 1}, {4, 1}, {0, 2},
};

const struct br_partial *br_solution_orders(enum br_field_kind kind, size_t *count)
{
    *count = kind == BR_AXIAL ? sizeof axial_orders / sizeof *axial_orders
                              : sizeof bending_orders / sizeof *bending_orders;
    return kind == BR_AXIAL ? axial_orders : bending_orders;
}

/* "u_xxt" */
static const char *name_of(enum br_field_kind kind, struct br_partial order, char text[16])
{
    size_t length = 0;
    text[length++] = kind == BR_AXIAL ? 'u' : 'w';
    if (order.x + order.t > 0)
        text[length++] = '_';
    for (int i = 0; i < order.x; i++)
        text[length++] = 'x';
    for (int i = 0; i < order.t; i++)
        text[length++] = 't';
    text[length] = '\0';
    return text;
}

static double value_at(const struct br_function *f, double x, double t)
{
    double value;
    br_function_evaluate(f, 1, &x, t, &value);
    return value;
}

/* ---- finite, and clamped ---- */

enum { T_SAMPLES = 1025, GRID = 33, MIDPOINTS = 24, NEAR = 10 };

/* Above the largest value elsewhere. */
static const double peak_margin = 20;

static double sample(double size, int i, int count)
{
    return size * i / (count - 1);
}

/* Points where no kink is likely to be hit, and nearer and nearer to 0. */
static void scatter(double size, double point[MIDPOINTS + NEAR])
{
    for (int i = 0; i < MIDPOINTS; i++)
        point[i] = size * (i + 0.5) / MIDPOINTS;
    for (int i = 0; i < NEAR; i++)
        point[MIDPOINTS + i] = size * pow(4, -i - 3);
}

/* The largest magnitude over scattered points; NaN where it is not finite. */
static double largest_of(const struct br_solution *s, struct br_function *d)
{
    double x[MIDPOINTS + NEAR], t[MIDPOINTS + NEAR], value[MIDPOINTS + NEAR], largest = 0;
    scatter(s->length, x);
    scatter(s->duration, t);
    for (int j = 0; j < MIDPOINTS + NEAR; j++) {
        br_function_evaluate(d, MIDPOINTS + NEAR, x, t[j], value);
        for (int i = 0; i < MIDPOINTS + NEAR; i++)
            if (!(fabs(value[i]) <= largest) && !isnan(largest))
                largest = fabs(value[i]);
    }
    return largest;
}

/* Its scale, and that it is bounded on a grid that has the ends and round numbers. */
static enum br_status find_scale(const struct br_solution *s, struct br_function *d,
                                 struct br_partial order, double *scale, struct br_error *err)
{
    char name[16];
    double x[GRID], value[GRID];
    *scale = largest_of(s, d);
    for (int i = 0; i < GRID; i++)
        x[i] = sample(s->length, i, GRID);
    for (int j = 0; j < GRID; j++) {
        const double t = sample(s->duration, j, GRID);
        br_function_evaluate(d, GRID, x, t, value);
        for (int i = 0; i < GRID; i++)
            if (!(fabs(value[i]) <= peak_margin * *scale))
                return br_fail(err, BR_BAD_INPUT,
                               "%s is %g at x = %g m, t = %g s, expected a finite number, at most "
                               "%g times the largest elsewhere, %g",
                               name_of(s->kind, order, name), value[i], x[i], t, peak_margin,
                               *scale);
    }
    return BR_OK;
}

static enum br_status check_clamp(const struct br_solution *s, const struct br_function *d,
                                  struct br_partial order, double scale, struct br_error *err)
{
    char name[16];
    for (int j = 0; j < T_SAMPLES; j++) {
        const double t = sample(s->duration, j, T_SAMPLES);
        const double value = value_at(d, 0, t);
        if (!(fabs(value) <= 1e-12 * scale))
            return br_fail(err, BR_BAD_INPUT,
                           "%s is %g at x = 0, t = %g s, expected 0 where the beam is clamped",
                           name_of(s->kind, order, name), value, t);
    }
    return BR_OK;
}

/* ---- derivatives that integrate back ---- */

/* A derivative and what it was derived from, along x at fixed t or along t at fixed x. */
struct line {
    const struct br_solution *solution;
    struct br_function derivative, origin;
    struct br_partial order, origin_order;
    bool along_x;
    double other;            /* the fixed coordinate */
    double scale;            /* of the origin's changes */
    double largest, allowed; /* of the derivative: met, and expected at most */
};

static double derivative_on(double s, void *line)
{
    struct line *l = line;
    const double value =
        l->along_x ? value_at(&l->derivative, s, l->other) : value_at(&l->derivative, l->other, s);
    l->largest = fmax(l->largest, fabs(value));
    return value;
}

static double origin_on(const struct line *l, double s)
{
    return l->along_x ? value_at(&l->origin, s, l->other) : value_at(&l->origin, l->other, s);
}

static enum br_status disagree(const struct line *l, double from, double to, double found,
                               double expected, struct br_error *err)
{
    char name[16], origin[16];
    const enum br_field_kind kind = l->solution->kind;
    return br_fail(err, BR_BAD_INPUT,
                   "%s integrates to %.10g from %s = %.10g to %.10g %s at %s = %g %s, expected "
                   "%.10g, the change of %s there: it jumps",
                   name_of(kind, l->order, name), found, l->along_x ? "x" : "t", from, to,
                   l->along_x ? "m" : "s", l->along_x ? "t" : "x", l->other, l->along_x ? "s" : "m",
                   expected, name_of(kind, l->origin_order, origin));
}

/* An integrable pole, like that of the second derivative of abs(t - 0.3)^1.5. */
static enum br_status unbounded(const struct line *l, double from, double to, struct br_error *err)
{
    char name[16];
    return br_fail(err, BR_BAD_INPUT,
                   "%s reaches %g between %s = %.10g and %.10g %s at %s = %g %s, expected at most "
                   "%g, %g times what it is elsewhere: it is not bounded",
                   name_of(l->solution->kind, l->order, name), l->largest, l->along_x ? "x" : "t",
                   from, to, l->along_x ? "m" : "s", l->along_x ? "t" : "x", l->other,
                   l->along_x ? "s" : "m", l->allowed, peak_margin);
}

enum { PIECES = 8, INTERVALS = 400, LINES = 9 };

/* The tolerance is no smaller than the round-off of a fourth derivative. */
static enum br_status check_line(struct line *l, gsl_integration_workspace *space,
                                 struct br_error *err)
{
    const double size = l->along_x ? l->solution->length : l->solution->duration;
    const gsl_function f = {.function = derivative_on, .params = l};
    for (int i = 0; i < PIECES; i++) {
        const double from = size * i / PIECES, to = size * (i + 1) / PIECES;
        const double expected = origin_on(l, to) - origin_on(l, from);
        double found = NAN, uncertainty;
        gsl_integration_qags(&f, from, to, 1e-10 * l->scale, 1e-10, INTERVALS, space, &found,
                             &uncertainty);
        if (!(fabs(found - expected) <= 1e-7 * l->scale))
            return disagree(l, from, to, found, expected, err);
        if (!(l->largest <= l->allowed))
            return unbounded(l, from, to, err);
    }
    return BR_OK;
}

static enum br_status check_lines(struct line *l, gsl_integration_workspace *space,
                                  struct br_error *err)
{
    const double other = l->along_x ? l->solution->duration : l->solution->length;
    enum br_status status = BR_OK;
    for (int i = 0; i < LINES && !status; i++) {
        l->other = sample(other, i, LINES);
        status = check_line(l, space, err);
    }
    return status;
}

/* The derivative of that order: finite, clamped where it is a clamped value, and the
 * derivative of the one before it. */
static enum br_status check_order(const struct br_solution *s, struct br_partial order,
                                  gsl_integration_workspace *space, struct br_error *err)
{
    struct line l = {.solution = s, .order = order, .along_x = order.t == 0};
    l.origin_order = (struct br_partial){order.x - l.along_x, order.t - !l.along_x};
    double scale, origin_scale;
    enum br_status status = br_function_derivative(s->function, order, &l.derivative, err);
    if (!status)
        status = find_scale(s, &l.derivative, order, &scale, err);
    if (!status && order.t == 0 && order.x < (s->kind == BR_AXIAL ? 1 : 2))
        status = check_clamp(s, &l.derivative, order, scale, err);
    if (status || order.x + order.t == 0)
        goto done;
    status = br_function_derivative(s->function, l.origin_order, &l.origin, err);
    if (!status)
        status = find_scale(s, &l.origin, l.origin_order, &origin_scale, err);
    if (status)
        goto done;
    l.scale = origin_scale + scale * (l.along_x ? s->length : s->duration) / PIECES;
    l.allowed = peak_margin * scale;
    status = check_lines(&l, space, err);
done:
    br_function_free(&l.derivative);
    br_function_free(&l.origin);
    return status;
}

enum br_status br_solution_check(const struct br_solution *s, struct br_error *err)
{
    gsl_integration_workspace *space = gsl_integration_workspace_alloc(INTERVALS);
    if (!space)
        return br_no_memory(err, "an integral");
    gsl_error_handler_t *handler = gsl_set_error_handler_off(); /* it would end the program */
    enum br_status status = BR_OK;
    size_t count;
    const struct br_partial *orders = br_solution_orders(s->kind, &count);
    for (size_t i = 0; i < count && !status; i++)
        status = check_order(s, orders[i], space, err);
    gsl_set_error_handler(handler);
    gsl_integration_workspace_free(space);
    return status;
}

/* ---- the tip at rest ---- */

enum br_status br_stick_check(const struct br_scene *scene, const struct br_function *u,
                              const struct br_function *velocity, struct br_error *err)
{
    for (int j = 0; j < T_SAMPLES; j++) {
        const double t = sample(scene->duration, j, T_SAMPLES);
        if (value_at(velocity, 0, t) != 0)
            continue;
        const double stick = value_at(&scene->bending.stick_force, 0, t);
        const double bound = br_tip_bound(&scene->contact, &scene->friction, value_at(u, 0, t));
        if (!(fabs(stick) <= bound * (1 + 1e-12)))
            return br_fail(err, BR_BAD_INPUT,
                           "stick_force is %g N at t = %g s, where the tip rests, expected at most "
                           "the friction bound, %g N",
                           stick, t, bound);
    }
    return BR_OK;
}
