/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A function of x and t that is no product. For cells along one variable the box is halved along
 * either, whichever helps more, until in each part a polynomial along the one stands for the
 * function, or a guard goes through it that never lets go. What counts as an end of a cell is where
 * smooth functions ask for more, not where a guard does: that moves, and quadratures are cut at
 * it. */
#include "reference/exact/outline.h"

#include <gsl/gsl_sort.h>
#include <math.h>

/* ---- lists ---- */

enum br_status br_list_add(struct br_list *list, double value, struct br_store *store,
                           struct br_error *err)
{
    double *at = br_store_grow(store, list->at, list->count, &list->room, sizeof *at);
    if (!at)
        return br_no_memory(err, "a mesh");
    list->at = at;
    list->at[list->count++] = value;
    return BR_OK;
}

void br_list_sort(struct br_list *list)
{
    size_t kept = 0;
    if (list->count)
        gsl_sort(list->at, 1, list->count);
    for (size_t i = 0; i < list->count; i++)
        if (!kept || list->at[i] > list->at[kept - 1])
            list->at[kept++] = list->at[i];
    list->count = kept;
}

/* ---- boxes ---- */

static double magnitude(struct br_interval v)
{
    return fmax(fabs(v.low), fabs(v.high));
}

static struct br_interval along(const struct br_box *box, enum br_variable v)
{
    return v == BR_X ? box->x : box->t;
}

static double width(struct br_interval i)
{
    return i.high - i.low;
}

static void halve(struct br_box box, enum br_variable v, struct br_box half[2])
{
    const struct br_interval i = along(&box, v);
    half[0] = half[1] = box;
    br_side(&half[0], v)->high = br_side(&half[1], v)->low = i.low + width(i) / 2;
}

double br_sight_error(const struct br_function *f, enum br_variable v, struct br_box box,
                      size_t degree)
{
    struct br_interval coefficient[17];
    if (!br_function_taylor(f, v, box, degree + 1, coefficient))
        return INFINITY;
    const double error =
        2 * magnitude(coefficient[degree + 1]) * pow(width(along(&box, v)) / 4, (double)degree + 1);
    return isnan(error) ? INFINITY : error;
}

/* ---- the mean ---- */

/* Halves of halves, of which the one is halved whose share is least known. */
struct share {
    struct br_box box;
    double low, high; /* of the integral of |f| over it */
};

static double measure(struct br_box box)
{
    const double x = width(box.x), t = width(box.t);
    return (x > 0 ? x : 1) * (t > 0 ? t : 1);
}

static struct share share_of(const struct br_function *f, struct br_box box)
{
    struct br_interval v;
    if (!br_function_bound(f, box, &v))
        return (struct share){box, 0, INFINITY};
    const double least = v.low > 0 ? v.low : v.high < 0 ? -v.high : 0;
    return (struct share){box, measure(box) * least, measure(box) * magnitude(v)};
}

double br_sight_mean(const struct br_function *f, struct br_box whole)
{
    enum { MOST = 400 };
    struct share share[MOST];
    size_t count = 1;
    share[0] = share_of(f, whole);
    for (;;) {
        double low = 0, high = 0;
        size_t worst = 0;
        for (size_t i = 0; i < count; i++) {
            low += share[i].low;
            high += share[i].high;
            if (share[i].high - share[i].low > share[worst].high - share[worst].low)
                worst = i;
        }
        if (count == MOST || low >= high / 2)
            return (low > 0 ? low : high) / measure(whole);
        const struct br_box box = share[worst].box;
        const double x = width(box.x), t = width(box.t);
        const bool along_x = x > 0 && !(t / width(whole.t) > x / width(whole.x));
        struct br_box half[2];
        halve(box, along_x ? BR_X : BR_T, half);
        share[worst] = share_of(f, half[0]);
        share[count++] = share_of(f, half[1]);
    }
}

/* ---- one variable ---- */

struct cover {
    struct br_sight *sight;
    enum br_variable along;
    struct br_list *ends;
    struct br_box whole;
    struct br_error *err;
    double missed; /* the rest is for both variables */
    size_t boxes;
};

static enum br_status survey(const struct cover *s, struct br_box box)
{
    struct br_sight *sight = s->sight;
    const struct br_interval here = along(&box, s->along);
    struct br_interval value = {0, 0};
    const double middle = here.low + width(here) / 2;
    const bool bounded = br_function_bound(sight->f, box, &value);
    const double size = fmax(magnitude(value), sight->mean);
    const double unseen = width(here) * (value.high - value.low);
    const bool narrow = !(width(here) > sight->least && here.low < middle && middle < here.high);
    if (narrow && !bounded)
        return br_must_be_finite(sight->f, box, s->err);
    if (!bounded || !(br_sight_error(sight->f, s->along, box, sight->degree[s->along]) <=
                      BR_SIGHT_TOLERANCE * size)) {
        if (!narrow && !(bounded && unseen <= sight->most_missed)) {
            struct br_box half[2];
            halve(box, s->along, half);
            const enum br_status status = survey(s, half[0]);
            return status ? status : survey(s, half[1]);
        }
        sight->missed += unseen;
    }
    if (s->ends->count >= sight->most)
        return br_fail(s->err, BR_NOT_FINITE,
                       "no exact solution: the data have details that are too fine near %s = %g %s",
                       s->along == BR_X ? "x" : "t", middle, s->along == BR_X ? "m" : "s");
    return here.high < along(&s->whole, s->along).high
               ? br_list_add(s->ends, here.high, sight->store, s->err)
               : BR_OK;
}

enum br_status br_sight_along(struct br_sight *sight, enum br_variable v, struct br_box box,
                              struct br_list *ends, struct br_error *err)
{
    const struct cover s = {sight, v, ends, box, err, 0, 0};
    return survey(&s, box);
}

/* ---- both variables ---- */

enum { MOST_BOXES = 40000, MOST_HALVINGS = 10 };

/* A guard goes through the box, which is not halved any more: how much more than its values at
 * some places the function may take there. */
static void give_up(struct cover *c, const struct br_box *box, struct br_interval value)
{
    double low = INFINITY, high = -INFINITY;
    for (int j = 0; j <= 2; j++) {
        double x[3], at[3];
        for (int i = 0; i <= 2; i++)
            x[i] = box->x.low + width(box->x) * i / 2;
        br_function_evaluate(c->sight->f, 3, x, box->t.low + width(box->t) * j / 2, at);
        for (int i = 0; i <= 2; i++) {
            low = fmin(low, at[i]);
            high = fmax(high, at[i]);
        }
    }
    const double excess = fmax(low - value.low, 0) + fmax(value.high - high, 0);
    c->missed += width(box->x) * width(box->t) * excess;
}

/* The ends of a cell; the box's own are none. */
static enum br_status add_ends(struct cover *c, const struct br_box *box)
{
    const struct br_interval i = along(box, c->along), whole = along(&c->whole, c->along);
    const double end[2] = {i.low, i.high};
    enum br_status status = BR_OK;
    for (size_t k = 0; k < 2 && !status; k++)
        if (end[k] > whole.low && end[k] < whole.high)
            status = br_list_add(c->ends, end[k], c->sight->store, c->err);
    return status;
}

static enum br_status cover(struct cover *c, struct br_box box);

/* Covers both halves along v; ends: they are cells. */
static enum br_status cover_halves(struct cover *c, struct br_box box, enum br_variable v,
                                   bool ends)
{
    struct br_box half[2];
    enum br_status status = BR_OK;
    halve(box, v, half);
    for (size_t k = 0; k < 2 && !status; k++) {
        status = ends ? add_ends(c, &half[k]) : BR_OK;
        if (!status)
            status = cover(c, half[k]);
    }
    return status;
}

static double error_in(const struct cover *c, struct br_box box)
{
    return br_sight_error(c->sight->f, c->along, box, c->sight->degree[c->along]);
}

/* The larger error of both halves. */
static double error_of_halves(const struct cover *c, struct br_box box, enum br_variable v)
{
    struct br_box half[2];
    halve(box, v, half);
    return fmax(error_in(c, half[0]), error_in(c, half[1]));
}

/* The share of the whole that the box takes along a variable. */
static double share_along(const struct cover *c, const struct br_box *box, enum br_variable v)
{
    return width(along(box, v)) / width(along(&c->whole, v));
}

static enum br_status cover(struct cover *c, struct br_box box)
{
    const enum br_variable one = c->along, other = one == BR_X ? BR_T : BR_X;
    struct br_interval value;
    const bool bounded = br_function_bound(c->sight->f, box, &value);
    const double size = bounded ? magnitude(value) : 0;
    const double error = error_in(c, box), least = pow(0.5, MOST_HALVINGS);
    if (++c->boxes > MOST_BOXES)
        return br_fail(c->err, BR_NOT_FINITE,
                       "no exact solution: a load of x and t has details that are too fine near "
                       "x = %g m, t = %g s",
                       box.x.low, box.t.low);
    if (bounded && error <= BR_SIGHT_TOLERANCE * fmax(size, c->sight->mean))
        return BR_OK;
    if (isfinite(error)) {
        const bool help = share_along(c, &box, other) > least &&
                          error_of_halves(c, box, other) < error_of_halves(c, box, one);
        return cover_halves(c, box, help ? other : one, !help);
    }
    const enum br_variable longer =
        share_along(c, &box, BR_X) >= share_along(c, &box, BR_T) ? BR_X : BR_T;
    if (share_along(c, &box, longer) > least)
        return cover_halves(c, box, longer, false);
    if (!bounded)
        return br_must_be_finite(c->sight->f, box, c->err);
    give_up(c, &box, value);
    return BR_OK;
}

enum br_status br_sight_both(struct br_sight *sight, struct br_box box, struct br_list *ends[2],
                             struct br_error *err)
{
    enum br_status status = BR_OK;
    double missed = 0;
    for (enum br_variable v = BR_X; v <= BR_T && !status; v++) {
        struct cover c = {.sight = sight, .along = v, .ends = ends[v], .whole = box, .err = err};
        status = cover(&c, box);
        missed = fmax(missed, c.missed);
    }
    sight->missed += missed;
    return status;
}
