/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A function of x and t that is no product. For cells along one variable the box is halved along
 * either, whichever helps more, until in each part a polynomial along the one stands for the
 * function, or a guard goes through it that never lets go. What counts as an end of a cell is where
 * smooth functions ask for more, not where a guard does: that moves, and quadratures are cut at
 * it. */
#include <math.h>

#include "reference/exact/sight.h"

enum { MOST_BOXES = 40000, MOST_HALVINGS = 10 };

struct cover {
    struct br_sight *sight;
    enum br_variable along;
    struct br_list *ends;
    double missed;
    struct br_box whole;
    size_t boxes;
    struct br_error *err;
};

static struct br_interval along(const struct br_box *box, enum br_variable v)
{
    return v == BR_X ? box->x : box->t;
}

static double width(struct br_interval i)
{
    return i.high - i.low;
}

/* A guard goes through the box, which is not halved any more: how much more than its values at
 * some places the function may take there. */
static enum br_status give_up(struct cover *c, const struct br_box *box, struct br_interval value)
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
    return BR_OK;
}

static enum br_status add_ends(struct cover *c, const struct br_box *box)
{
    const struct br_interval i = along(box, c->along), whole = along(&c->whole, c->along);
    enum br_status status = BR_OK;
    if (i.low > whole.low)
        status = br_list_add(c->ends, i.low, c->err);
    if (i.high < whole.high && !status)
        status = br_list_add(c->ends, i.high, c->err);
    return status;
}

static enum br_status cover(struct cover *c, struct br_box box);

static void halve(struct br_box box, enum br_variable v, struct br_box half[2])
{
    const struct br_interval i = along(&box, v);
    const double middle = i.low + width(i) / 2;
    half[0] = half[1] = box;
    *(v == BR_X ? &half[0].x.high : &half[0].t.high) = middle;
    *(v == BR_X ? &half[1].x.low : &half[1].t.low) = middle;
}

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
static double share(const struct cover *c, const struct br_box *box, enum br_variable v)
{
    return width(along(box, v)) / width(along(&c->whole, v));
}

static enum br_status cover(struct cover *c, struct br_box box)
{
    const enum br_variable one = c->along, other = one == BR_X ? BR_T : BR_X;
    struct br_interval value;
    const bool bounded = br_function_bound(c->sight->f, box, &value);
    const double size = bounded ? fmax(fabs(value.low), fabs(value.high)) : 0;
    const double error = error_in(c, box), least = pow(0.5, MOST_HALVINGS);
    if (++c->boxes > MOST_BOXES)
        return br_fail(c->err, BR_NOT_FINITE,
                       "no exact solution: a load of x and t has details that are too fine near "
                       "x = %g m, t = %g s",
                       box.x.low, box.t.low);
    if (bounded && error <= BR_SIGHT_TOLERANCE * fmax(size, c->sight->mean))
        return BR_OK;
    if (isfinite(error)) {
        const bool help = share(c, &box, other) > least &&
                          error_of_halves(c, box, other) < error_of_halves(c, box, one);
        return cover_halves(c, box, help ? other : one, !help);
    }
    const enum br_variable longer = share(c, &box, BR_X) >= share(c, &box, BR_T) ? BR_X : BR_T;
    if (share(c, &box, longer) > least)
        return cover_halves(c, box, longer, false);
    return bounded ? give_up(c, &box, value) : br_must_be_finite(c->sight->f, box, c->err);
}

enum br_status br_sight_both(struct br_sight *sight, struct br_box box, struct br_list ends[2],
                             struct br_error *err)
{
    enum br_status status = BR_OK;
    double missed = 0;
    for (enum br_variable v = BR_X; v <= BR_T && !status; v++) {
        struct cover c = {.sight = sight, .along = v, .ends = &ends[v], .whole = box, .err = err};
        status = cover(&c, box);
        missed = fmax(missed, c.missed);
    }
    sight->missed += missed;
    return status;
}
