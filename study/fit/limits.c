/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/fit/limits.h"

#include <gsl/gsl_cdf.h>
#include <math.h>

static const struct br_estimate unknown = {NAN, NAN, NAN};
static const double normal95 = 1.959963984540054; /* half width of a 95 % interval, deviations */

/* Values that grow like log n have the order zero, and no limit: round-off makes it +1e-9. */
static const double least_order = 0.05;

/* Whether one constant agrees with all values. */
static bool agree(const double *value, const double *half, size_t count)
{
    double weights = 0, mean = 0, squares = 0;
    for (size_t i = 0; i < count; i++) {
        weights += 1 / (half[i] * half[i]);
        mean += (value[i] - mean) / (half[i] * half[i]) / weights;
    }
    for (size_t i = 0; i < count; i++)
        squares += pow(normal95 * (value[i] - mean) / half[i], 2);
    return squares <= gsl_cdf_chisq_Pinv(0.99, (double)count - 1); /* NaN: no means */
}

/* Names a sequence that shows its scatter alone. */
static void find_scatter(struct br_grid_limit *limit, const double *value, const double *half,
                         size_t count)
{
    const bool monotone = limit->sequence == BR_MONOTONE_CONVERGENCE;
    if (half && limit->sequence != BR_SEQUENCE_CONSTANT &&
        (agree(value, half, count) || (!monotone && agree(value + count - 3, half + count - 3, 3))))
        limit->sequence = BR_SEQUENCE_SCATTER;
}

/* Two differences within the scatter of their values show nothing, and neither does one. */
static void leave_scatter(struct br_gci *gci, const double *half)
{
    const bool fine = gci->fine.difference <= hypot(half[1], half[2]),
               coarse = gci->coarse.difference <= hypot(half[0], half[1]);
    struct br_gci_pair *pair[] = {&gci->fine, &gci->coarse};
    if (!fine && !coarse)
        return;
    gci->sequence = fine && coarse ? BR_SEQUENCE_SCATTER : BR_SEQUENCE_UNKNOWN;
    gci->order = gci->asymptotic = NAN;
    for (int i = 0; i < 2; i++)
        pair[i]->limit = pair[i]->uncertainty = pair[i]->relative_extrapolated = pair[i]->index =
            NAN;
}

/* By how much the uncertainty of three means changes as each goes to the ends of its interval; NaN:
 * there they do not converge. */
static double carried(const double *h, const double *value, const double *half, double uncertainty)
{
    double squares = 0;
    for (int i = 0; i < 6; i++) {
        double moved[3] = {value[0], value[1], value[2]};
        struct br_gci gci;
        moved[i / 2] += i % 2 ? half[i / 2] : -half[i / 2];
        br_gci(h, moved, 3, &gci);
        squares += pow(gci.fine.uncertainty - uncertainty, 2) / 2;
    }
    return sqrt(squares);
}

/* Widens the uncertainty to the error of the finest value that its difference to the one before
 * leaves open, by the least order of the differences: with a higher power beside, the order that
 * fits them is too high. */
static enum br_status widen(const double *h, const double *value, size_t count, double *uncertainty,
                            struct br_error *err)
{
    struct br_estimate order;
    const size_t last = count - 1;
    if (br_order_of_values(h, value, count, &order, err))
        return err->status;
    const double error =
        fabs(value[last] - value[last - 1]) / (pow(h[last - 1] / h[last], order.low) - 1);
    if (order.low > least_order && error > *uncertainty)
        *uncertainty = error;
    return BR_OK;
}

enum br_status br_limit_of_values(const double *h, const double *value, const double *half,
                                  size_t count, double formal, struct br_grid_limit *limit,
                                  struct br_error *err)
{
    struct br_least_squares fit;
    struct br_gci gci;
    double uncertainty;
    *limit = (struct br_grid_limit){.value = unknown, .order = NAN};
    if (count > 3) {
        if (br_least_squares(h, value, count, formal, &fit, err))
            return err->status;
        *limit = (struct br_grid_limit){
            {fit.fit.limit, NAN, NAN}, fit.order, BR_LIMIT_LEAST_SQUARES, fit.sequence};
        uncertainty = fit.uncertainty;
        if (fit.sequence == BR_MONOTONE_CONVERGENCE && widen(h, value, count, &uncertainty, err))
            return err->status;
    } else {
        br_gci(h, value, count, &gci);
        if (half)
            leave_scatter(&gci, half);
        *limit = (struct br_grid_limit){
            {gci.fine.limit, NAN, NAN}, gci.order, BR_LIMIT_GCI, gci.sequence};
        uncertainty = gci.fine.uncertainty;
        if (half && isfinite(uncertainty)) {
            uncertainty += carried(h, value, half, uncertainty);
            limit->sequence = isnan(uncertainty) ? BR_SEQUENCE_UNKNOWN : limit->sequence;
        }
    }
    const double finest = value[count - 1], own = half && half[count - 1] > 0 ? half[count - 1] : 0;
    if (limit->sequence == BR_MONOTONE_CONVERGENCE && !(limit->order >= least_order))
        limit->sequence = BR_SEQUENCE_UNKNOWN;
    find_scatter(limit, value, half, count);
    limit->value.low = finest - uncertainty - own;
    limit->value.high = finest + uncertainty + own;
    if (limit->sequence == BR_MONOTONE_DIVERGENCE || limit->sequence == BR_OSCILLATORY_DIVERGENCE ||
        limit->sequence == BR_SEQUENCE_UNKNOWN)
        limit->value = unknown;
    if (limit->sequence == BR_SEQUENCE_CONSTANT)
        limit->value = (struct br_estimate){finest, NAN, NAN};
    if (limit->sequence == BR_SEQUENCE_SCATTER) {
        limit->value = (struct br_estimate){finest, finest - own, finest + own};
        limit->order = NAN;
    }
    return BR_OK;
}

/* ---- a line ---- */

enum br_status br_limits_find(const double *h, const double *value, const double *half,
                              size_t count, double formal, struct br_limits *limits,
                              struct br_error *err)
{
    static const struct br_gci none = {.order = NAN,
                                       .asymptotic = NAN,
                                       .fine = {NAN, NAN, NAN, NAN, NAN, NAN, NAN},
                                       .coarse = {NAN, NAN, NAN, NAN, NAN, NAN, NAN}};
    *limits = (struct br_limits){.limit.value = unknown, .first_order.value = unknown, .gci = none};
    if (formal != 0 && !(formal >= 1 && formal <= 10))
        return br_fail(err, BR_BAD_INPUT, "the formal order is %g, expected 1 to 10", formal);
    limits->triple = br_allocate(count, sizeof *limits->triple);
    if (!limits->triple)
        return br_no_memory(err, "the limits");
    if (count < 3)
        return BR_OK;
    enum br_status status =
        br_limit_of_values(h, value, half, count, formal > 0 ? formal : 2, &limits->limit, err);
    if (!status && !(formal > 0))
        status = br_limit_of_values(h, value, half, count, 1, &limits->first_order, err);
    for (size_t i = 0; i + 2 < count && !status; i++) {
        br_gci(h + i, value + i, 3, &limits->triple[i]);
        if (half)
            leave_scatter(&limits->triple[i], half + i);
        limits->gci = limits->triple[i];
        limits->triples = i + 1;
    }
    return status;
}

void br_limits_clear(struct br_limits *limits)
{
    free(limits->triple);
    *limits = (struct br_limits){.triples = 0};
}

/* ---- a grid ---- */

/* What is left over h at the finest k and over k at the finest h adds up, each with its interval.
 * By as much as one of the two changes to the next size of the other axis, the products may change
 * it again. */
struct br_grid_limit br_limit_of_grid(double value, const struct br_limit_along along[BR_AXES])
{
    struct br_grid_limit limit = {.value = unknown, .order = NAN};
    double left = 0, half = 0, products = 0;
    for (int axis = 0; axis < BR_AXES; axis++) {
        const struct br_grid_limit *line = &along[axis].limit;
        const struct br_estimate *e = &line->value;
        const bool constant = line->sequence == BR_SEQUENCE_CONSTANT;
        const double rest = e->value - value;
        left += rest;
        half += constant ? 0 : fmax(e->high - value, value - e->low);
        products =
            fmax(products, fabs(along[axis].next.value.value - along[axis].next_value - rest));
        if (axis == 0 || limit.sequence == BR_SEQUENCE_CONSTANT)
            limit.sequence = line->sequence;
        else if (line->sequence != limit.sequence && !constant)
            limit.sequence = BR_SEQUENCE_UNKNOWN;
        limit.method = line->method;
    }
    half += products;
    if (isfinite(left) && half > 0 && isfinite(half))
        limit.value = (struct br_estimate){value + left, value - half, value + half};
    return limit;
}
