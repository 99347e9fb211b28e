/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/mms/mms.h"
#include "solver/scene.h"

#include <math.h>
#include <stdio.h>

#include "solver/laws.h"
#include "solver/proof.h"

/* The derivatives that the equations (3), (4), (8), (9), (11) use. */
static const struct br_partial axial_orders[] = {
    {0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 1}, {0, 2},
};
static const struct br_partial bending_orders[] = {
    {0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {0, 1}, {1, 1}, {2, 1}, {3, 1}, {4, 1}, {0, 2},
};

/* "u_xxt" */
static const char *name_of(enum br_field_kind kind, struct br_partial order, char text[16])
{
    snprintf(text, 16, "%c%s%.*s%.*s", kind == BR_AXIAL ? 'u' : 'w',
             order.x + order.t > 0 ? "_" : "", order.x, "xxxx", order.t, "tt");
    return text;
}

/* ---- finite, and clamped ---- */

enum { T_SAMPLES = 1025, MIDPOINTS = 24, NEAR = 10 };

static double sample(double size, int i, int count)
{
    return size * i / (count - 1);
}

/* Points that hardly hit a kink, and points that approach 0. */
static void scatter(double size, double point[MIDPOINTS + NEAR])
{
    for (int i = 0; i < MIDPOINTS; i++)
        point[i] = size * (i + 0.5) / MIDPOINTS;
    for (int i = 0; i < NEAR; i++)
        point[MIDPOINTS + i] = size * pow(4, -i - 3);
}

/* The largest magnitude over scattered points; NaN where it is not finite. */
static double largest_of(const struct br_given *s, struct br_function *d)
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

/* Proves that the derivative has no pole. */
static enum br_status check_finite(const struct br_given *s, const struct br_function *d,
                                   struct br_partial order, struct br_error *err)
{
    char name[16];
    struct br_error inner = {0};
    const struct br_box box = {{0, s->length}, {0, s->duration}};
    const enum br_status status = br_must_be_finite(d, box, &inner);
    return status ? br_fail(err, status, "%s: %.900s", name_of(s->kind, order, name), inner.message)
                  : BR_OK;
}

static enum br_status check_clamp(const struct br_given *s, const struct br_function *d,
                                  struct br_partial order, double scale, struct br_error *err)
{
    char name[16];
    for (int j = 0; j < T_SAMPLES; j++) {
        const double t = sample(s->duration, j, T_SAMPLES);
        const double value = br_function_at(d, 0, t);
        if (!(fabs(value) <= 1e-12 * scale))
            return br_fail(err, BR_BAD_INPUT,
                           "%s is %g at x = 0, t = %g s, expected 0 where the beam is clamped",
                           name_of(s->kind, order, name), value, t);
    }
    return BR_OK;
}

/* ---- derivatives that miss nothing ---- */

/* A function that is differentiated by x or by t: its jumps would be lost. */
struct derived {
    const struct br_given *solution;
    struct br_function function;
    struct br_partial order;
    enum br_variable by;
    double scale;
};

static double end_of(const struct br_given *s, enum br_variable v)
{
    return v == BR_X ? s->length : s->duration;
}

static double along(const struct derived *d, double at, double other)
{
    return d->by == BR_X ? br_function_at(&d->function, at, other)
                         : br_function_at(&d->function, other, at);
}

/* Its breaks on a line, where `other` is fixed. */
static enum br_status find_breaks(const struct derived *d, enum br_variable by, double other,
                                  struct br_breaks *breaks, struct br_error *err)
{
    const struct br_interval all = {0, end_of(d->solution, by)}, one = {other, other};
    const struct br_box box = {by == BR_X ? all : one, by == BR_X ? one : all};
    return br_breaks_add(&d->function, by, box, breaks, err);
}

/* Checks that the function is the same on both sides of each break. */
static enum br_status check_line(const struct derived *d, double other, struct br_error *err)
{
    struct br_breaks breaks = {0};
    char name[16];
    enum br_status status = find_breaks(d, d->by, other, &breaks, err);
    for (size_t i = 0; i < breaks.count && !status; i++) {
        const double before = along(d, nextafter(breaks.at[i].low, -INFINITY), other),
                     after = along(d, nextafter(breaks.at[i].high, INFINITY), other);
        if (!(fabs(after - before) <= 1e-7 * d->scale))
            status = br_fail(err, BR_BAD_INPUT,
                             "%s jumps by %.10g at %s = %.10g %s, %s = %g %s, expected a solution "
                             "whose derivatives there are functions",
                             name_of(d->solution->kind, d->order, name), after - before,
                             d->by == BR_X ? "x" : "t", breaks.at[i].low, d->by == BR_X ? "m" : "s",
                             d->by == BR_X ? "t" : "x", other, d->by == BR_X ? "s" : "m");
    }
    br_breaks_free(&breaks);
    return status;
}

enum { LINES = 9 };

/* Checks lines through the middle of each interval between the breaks along the other variable, and
 * some more where breaks move. */
static enum br_status check_lines(const struct derived *d, struct br_error *err)
{
    const enum br_variable across = d->by == BR_X ? BR_T : BR_X;
    const double end = end_of(d->solution, across);
    struct br_breaks breaks = {0};
    enum br_status status =
        find_breaks(d, across, 0.618 * end_of(d->solution, d->by), &breaks, err);
    for (int i = 0; i < LINES && !status; i++)
        status = check_line(d, sample(end, i, LINES), err);
    for (size_t i = 0; i <= breaks.count && !status; i++) {
        const double from = i ? breaks.at[i - 1].high : 0,
                     to = i < breaks.count ? breaks.at[i].low : end;
        status = check_line(d, from + (to - from) / 2, err);
    }
    br_breaks_free(&breaks);
    return status;
}

/* Checks the derivative of that order: it is finite, zero at the clamp where it must be, and of a
 * function that does not jump. */
static enum br_status check_order(const struct br_given *s, struct br_partial order,
                                  struct br_error *err)
{
    const bool by_x = order.t == 0;
    struct derived from = {
        .solution = s, .order = {order.x - by_x, order.t - !by_x}, .by = by_x ? BR_X : BR_T};
    struct br_function derivative;
    enum br_status status = br_function_derivative(s->function, order, &derivative, err);
    if (!status)
        status = check_finite(s, &derivative, order, err);
    if (!status && order.t == 0 && order.x < (s->kind == BR_AXIAL ? 1 : 2))
        status = check_clamp(s, &derivative, order, largest_of(s, &derivative), err);
    if (!status && order.x + order.t > 0)
        status = br_function_derivative(s->function, from.order, &from.function, err);
    if (!status && order.x + order.t > 0) {
        from.scale = largest_of(s, &from.function);
        status = check_lines(&from, err);
    }
    br_function_free(&derivative);
    br_function_free(&from.function);
    return status;
}

enum br_status br_given_check(const struct br_given *s, struct br_error *err)
{
    const bool axial = s->kind == BR_AXIAL;
    const struct br_partial *orders = axial ? axial_orders : bending_orders;
    const size_t count = (axial ? sizeof axial_orders : sizeof bending_orders) / sizeof *orders;
    enum br_status status = BR_OK;
    for (size_t i = 0; i < count && !status; i++)
        status = check_order(s, orders[i], err);
    return status;
}

/* ---- the tip at rest ---- */

enum br_status br_stick_check(const struct br_scene *scene, const struct br_function *u,
                              const struct br_function *velocity, struct br_error *err)
{
    for (int j = 0; j < T_SAMPLES; j++) {
        const double t = sample(scene->duration, j, T_SAMPLES);
        if (br_function_at(velocity, 0, t) != 0)
            continue;
        const double stick = br_function_at(&scene->bending.stick_force, 0, t);
        const double bound =
            br_friction_bound(scene, br_penetration(&scene->contact, br_function_at(u, 0, t)));
        if (!(fabs(stick) <= bound * (1 + 1e-12)))
            return br_fail(err, BR_BAD_INPUT,
                           "stick_force is %g N at t = %g s, where the tip rests, expected at most "
                           "the friction bound, %g N",
                           stick, t, bound);
    }
    return BR_OK;
}
