/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A function of x and t that is no product: the box is halved along either variable until in each
 * part a polynomial stands for the function, or a guard goes through it that never lets go. What
 * counts as an end of a cell is where smooth functions ask for more, not where a guard does: that
 * moves, and quadratures are cut at it. */
#include <math.h>

#include "reference/exact/sight.h"

enum { MOST_BOXES = 40000, MOST_HALVINGS = 10 };

struct cover {
    struct br_sight *sight;
    struct br_list *ends; /* along x, along t */
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
    c->sight->missed += width(box->x) * width(box->t) * excess;
    return BR_OK;
}

static enum br_status add_ends(struct cover *c, const struct br_box *box, enum br_variable v)
{
    const struct br_interval i = along(box, v), whole = along(&c->whole, v);
    enum br_status status = BR_OK;
    if (i.low > whole.low)
        status = br_list_add(&c->ends[v], i.low, c->err);
    if (i.high < whole.high && !status)
        status = br_list_add(&c->ends[v], i.high, c->err);
    return status;
}

static enum br_status cover(struct cover *c, struct br_box box);

/* ends: whether the halves are cells. */
static enum br_status halve(struct cover *c, struct br_box box, enum br_variable v, bool ends)
{
    struct br_box half[2] = {box, box};
    enum br_status status = BR_OK;
    const struct br_interval i = along(&box, v);
    const double middle = i.low + width(i) / 2;
    *(v == BR_X ? &half[0].x.high : &half[0].t.high) = middle;
    *(v == BR_X ? &half[1].x.low : &half[1].t.low) = middle;
    for (size_t k = 0; k < 2 && !status; k++) {
        status = ends ? add_ends(c, &half[k], v) : BR_OK;
        if (!status)
            status = cover(c, half[k]);
    }
    return status;
}

/* The share of the whole that the box takes along a variable. */
static double share(const struct cover *c, const struct br_box *box, enum br_variable v)
{
    return width(along(box, v)) / width(along(&c->whole, v));
}

static enum br_status cover(struct cover *c, struct br_box box)
{
    struct br_interval value;
    const bool bounded = br_function_bound(c->sight->f, box, &value);
    const double size = bounded ? fmax(fabs(value.low), fabs(value.high)) : 0;
    const enum br_variable longer = share(c, &box, BR_X) >= share(c, &box, BR_T) ? BR_X : BR_T;
    enum br_fit fit[2];
    if (++c->boxes > MOST_BOXES)
        return br_fail(
            c->err, BR_NOT_FINITE,
            "no exact solution: a load of x and t has details that are too fine near x = %g m, t = %g s",
            box.x.low, box.t.low);
    for (enum br_variable v = BR_X; v <= BR_T; v++)
        fit[v] = br_sight_fit(c->sight->f, v, box, c->sight->degree[v], fmax(size, c->sight->mean));
    for (enum br_variable v = BR_X; v <= BR_T; v++)
        if (fit[v] == BR_TOO_WIDE)
            return halve(c, box, v, true);
    if (bounded && fit[BR_X] == BR_FITS && fit[BR_T] == BR_FITS)
        return BR_OK;
    if (share(c, &box, longer) > pow(0.5, MOST_HALVINGS))
        return halve(c, box, longer, false);
    return bounded ? give_up(c, &box, value) : br_must_be_finite(c->sight->f, box, c->err);
}

enum br_status br_sight_both(struct br_sight *sight, struct br_box box, struct br_list ends[2],
                             struct br_error *err)
{
    struct cover c = {.sight = sight, .ends = ends, .whole = box, .err = err};
    return cover(&c, box);
}
