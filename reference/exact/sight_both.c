/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A function of x and t that is no product: the box is halved along either variable until in each
 * part a polynomial stands for the function, or a guard goes through it that never lets go. What
 * counts as an end of a cell is where smooth functions ask for more, not where a guard does: that
 * moves, and quadratures are cut at it. */
#include <math.h>

#include "reference/exact/sight.h"

enum { SAMPLES = 48, MOST_BOXES = 40000, MOST_HALVINGS = 10 };

struct cover {
    const struct br_function *f;
    const struct br_sight *sight; /* along x, along t */
    struct br_list *ends;         /* likewise */
    struct br_box whole;
    double mean; /* of |f| at samples */
    double missed;
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

static enum br_status find_mean(struct cover *c)
{
    double x[SAMPLES], value[SAMPLES], sum = 0;
    for (size_t i = 0; i < SAMPLES; i++)
        x[i] = c->whole.x.low + width(c->whole.x) * ((double)i + 0.5) / SAMPLES;
    for (size_t j = 0; j < SAMPLES; j++) {
        br_function_evaluate(c->f, SAMPLES, x,
                             c->whole.t.low + width(c->whole.t) * ((double)j + 0.5) / SAMPLES,
                             value);
        for (size_t i = 0; i < SAMPLES; i++)
            sum += fabs(value[i]);
    }
    c->mean = sum / (SAMPLES * SAMPLES);
    return isfinite(c->mean) ? BR_OK : br_must_be_finite(c->f, c->whole, c->err);
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
        br_function_evaluate(c->f, 3, x, box->t.low + width(box->t) * j / 2, at);
        for (int i = 0; i <= 2; i++) {
            low = fmin(low, at[i]);
            high = fmax(high, at[i]);
        }
    }
    const double excess = fmax(low - value.low, 0) + fmax(value.high - high, 0);
    c->missed += width(box->x) * width(box->t) * excess;
    return BR_OK;
}

static enum br_status add_ends(struct cover *c, const struct br_box *box, enum br_variable v)
{
    const struct br_interval i = along(box, v);
    const enum br_status status = br_list_add(&c->ends[v], i.low, c->err);
    return status ? status : br_list_add(&c->ends[v], i.high, c->err);
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
    const bool bounded = br_function_bound(c->f, box, &value);
    const double size = bounded ? fmax(fabs(value.low), fabs(value.high)) : 0;
    const enum br_variable longer =
        share(c, &box, BR_X) >= share(c, &box, BR_T) ? BR_X : BR_T;
    enum br_fit fit[2];
    if (++c->boxes > MOST_BOXES)
        return br_fail(c->err, BR_NOT_FINITE,
                       "a load of x and t has details that are too fine near x = %g m, t = %g s",
                       box.x.low, box.t.low);
    for (enum br_variable v = BR_X; v <= BR_T; v++)
        fit[v] = br_sight_fit(c->f, v, box, c->sight[v].degree, fmax(size, c->mean));
    for (enum br_variable v = BR_X; v <= BR_T; v++)
        if (fit[v] == BR_TOO_WIDE)
            return halve(c, box, v, true);
    if (bounded && fit[BR_X] == BR_FITS && fit[BR_T] == BR_FITS)
        return BR_OK;
    if (share(c, &box, longer) > pow(0.5, MOST_HALVINGS))
        return halve(c, box, longer, false);
    return bounded ? give_up(c, &box, value) : br_must_be_finite(c->f, box, c->err);
}

enum br_status br_sight_both(const struct br_function *f, struct br_box box,
                             const struct br_sight sight[2], struct br_list ends[2],
                             double *missed, struct br_error *err)
{
    struct cover c = {.f = f, .sight = sight, .ends = ends, .whole = box, .err = err};
    *missed = 0;
    enum br_status status = add_ends(&c, &box, BR_X);
    if (!status)
        status = add_ends(&c, &box, BR_T);
    if (status || !f->ops || !f->ops->bound)
        return status;
    status = find_mean(&c);
    if (!status)
        status = cover(&c, box);
    *missed = c.mean > 0 ? c.missed / (c.mean * width(box.x) * width(box.t)) : 0;
    return status;
}
