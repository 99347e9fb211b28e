/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "orders/limits/limits.h"

#include <gsl/gsl_cdf.h>
#include <math.h>

#include "orders/line/line_order.h"

static const struct br_estimate unknown = {NAN, NAN, NAN};
static const double normal95 = 1.959963984540054; /* half width of a 95 % interval, deviations */

/* ---- values that are means ---- */

/* Whether one constant agrees with all values, which are means. */
static bool agree(const struct br_point *v, size_t count)
{
    double weights = 0, mean = 0, squares = 0;
    for (size_t i = 0; i < count; i++) {
        weights += 1 / (v[i].half * v[i].half);
        mean += (v[i].value - mean) / (v[i].half * v[i].half) / weights;
    }
    for (size_t i = 0; i < count; i++)
        squares += pow(normal95 * (v[i].value - mean) / v[i].half, 2);
    return squares <= gsl_cdf_chisq_Pinv(0.99, (double)count - 1); /* NaN: no means */
}

/* Two differences within the scatter of their values show nothing, and neither does one. */
static void leave_scatter(struct br_gci *gci, const struct br_point *v)
{
    const bool fine = gci->fine.difference <= hypot(v[1].half, v[2].half),
               coarse = gci->coarse.difference <= hypot(v[0].half, v[1].half);
    struct br_gci_pair *pair[] = {&gci->fine, &gci->coarse};
    if ((!fine && !coarse) || gci->sequence == BR_SEQUENCE_CONSTANT)
        return;
    gci->sequence = fine && coarse ? BR_SEQUENCE_SCATTER : BR_SEQUENCE_UNKNOWN;
    gci->order = gci->asymptotic = NAN;
    for (int i = 0; i < 2; i++)
        pair[i]->limit = pair[i]->uncertainty = pair[i]->relative_extrapolated = pair[i]->index =
            NAN;
}

/* ---- a line ---- */

static bool are_constant(const struct br_point *v, size_t count)
{
    for (size_t i = 0; i + 1 < count; i++)
        if (!(fabs(v[i].value - v[i + 1].value) <= br_round_off_of(v, count)))
            return false;
    return true;
}

/* Where values begin to stay, to their digits, up to the finest one. */
static size_t end_of(const struct br_point *v, size_t count)
{
    size_t end = count - 1;
    while (end > 1 && v[end].value == v[end - 1].value)
        end--;
    return end;
}

/* +1: the differences from `first` on have one sign; -1: their signs alternate; 0: neither. Zeros
 * have none. */
static int turns_of(const struct br_point *v, size_t first, size_t count)
{
    size_t same = 0, turns = 0;
    double before = 0;
    for (size_t i = first; i + 1 < count; i++) {
        const double by = v[i + 1].value - v[i].value;
        same += before * by > 0;
        turns += before * by < 0;
        before = by != 0 ? by : before;
    }
    return turns == 0 ? 1 : same == 0 ? -1 : 0;
}

/* sure: the least probability. */
static enum br_sequence sequence_of(const struct br_line_order *found, int turns, double sure)
{
    static const double small = 0.4, none = 0.1; /* orders of values like log n, or its logarithm */
    const bool falls = found->converges >= sure, grows = found->diverges >= sure;
    if (!falls && !grows)
        return turns > 0 && found->order.high < small && found->order.low > -small &&
                       found->order.value < none
                   ? BR_SEQUENCE_LOGARITHM
                   : BR_SEQUENCE_UNKNOWN;
    if (turns == 0)
        return falls ? BR_SEQUENCE_ANOMALOUS : BR_SEQUENCE_UNKNOWN;
    return turns > 0 ? (falls ? BR_MONOTONE_CONVERGENCE : BR_MONOTONE_DIVERGENCE)
                     : (falls ? BR_OSCILLATORY_CONVERGENCE : BR_OSCILLATORY_DIVERGENCE);
}

/* The share of the last difference by which errors of this order that alternate are off. */
static double back(double ratio, double order)
{
    return 1 / (1 + pow(ratio, -fmax(order, 0)));
}

/* The limit from what is left at the finest value, in the direction of its difference; of values
 * that alternate it lies on the way back, of others on either side. Three values show no order:
 * they may have passed the limit, by a tenth of the difference, and those that turn may have any.
 * Values that stay at the end have the finest one as their limit; by as much as is left where they
 * begin to stay they may be off. */
static struct br_estimate limit_of(const struct br_point *v, size_t count,
                                   const struct br_line_order *found, int turns)
{
    static const double passed = 0.1;
    const size_t end = end_of(v, count);
    const struct br_point *finest = &v[end];
    const double step = finest->value - finest[-1].value, sign = step < 0 ? -1 : 1;
    const double own = finest->half + finest->rounding;
    const bool few = isnan(found->order.value);
    double low = found->left.low, high = found->left.high, value = found->left.value;
    if (few)
        low = fmin(low, -passed * fabs(step));
    if (turns < 0 && !few) {
        const double r = finest->z / finest[-1].z;
        value = -fabs(step) * back(r, found->order.value);
        low = -fabs(step) * fmax(back(r, found->order.low), back(r, 0.5 * found->order.value));
        high = -fabs(step) * back(r, fmax(found->order.high, 1.5 * found->order.value));
    } else if (turns <= 0) { /* opposite terms, or noise: as far as the last values are apart */
        for (size_t i = count < 4 ? 0 : count - 4; i + 1 < count; i++)
            high = fmax(fmax(fabs(high), fabs(low)), fabs(v[i].value - finest->value));
        low = -high;
        value = 0;
    }
    if (end + 1 < count) {
        value = 0;
        low = fmin(low, 0);
        high = fmax(high, 0);
    }
    return (struct br_estimate){finest->value + sign * value,
                                finest->value + fmin(sign * low, sign * high) - own,
                                finest->value + fmax(sign * low, sign * high) + own};
}

/* The posterior of the differences. */
static enum br_status find_order(const struct br_point *v, size_t count,
                                 struct br_line_order *found, struct br_error *err)
{
    struct br_point *point = br_allocate(count - 1, sizeof *point);
    if (!point)
        return br_no_memory(err, "the limit");
    for (size_t i = 0; i + 1 < count; i++)
        point[i] = (struct br_point){.z = v[i].z,
                                     .z_against = v[i + 1].z,
                                     .error = fabs(v[i].value - v[i + 1].value),
                                     .deviation = hypot(v[i].half, v[i + 1].half) / normal95,
                                     .rounding = hypot(v[i].rounding, v[i + 1].rounding)};
    const enum br_status status = br_line_order_find(point, count - 1, found, err);
    free(point);
    return status;
}

enum br_status br_limit_of_values(const struct br_point *v, size_t count,
                                  struct br_grid_limit *limit, struct br_error *err)
{
    const double finest = v[count - 1].value, half = v[count - 1].half,
                 rounding = v[count - 1].rounding;
    struct br_line_order found;
    *limit = (struct br_grid_limit){.value = unknown, .order = NAN};
    if (are_constant(v, count)) {
        const double own = half > 0 ? half : rounding > 0 ? 2 * rounding : (double)NAN;
        *limit =
            (struct br_grid_limit){{finest, finest - own, finest + own}, NAN, BR_SEQUENCE_CONSTANT};
        return BR_OK;
    }
    if (find_order(v, count, &found, err))
        return err->status;
    const int turns = turns_of(v, found.first, count);
    /* The scatter of means is known, which the mixture takes from few differences. */
    const double sure = half > 0 ? 0.5 : 0.9;
    limit->sequence = sequence_of(&found, turns, sure);
    if (count == 3 && limit->sequence == BR_SEQUENCE_UNKNOWN) {
        struct br_gci gci;
        br_gci(v, &gci);
        limit->sequence = gci.sequence == BR_SEQUENCE_LOGARITHM ? gci.sequence : limit->sequence;
    }
    limit->order = found.order.value;
    if (limit->sequence != BR_SEQUENCE_UNKNOWN && found.converges >= sure &&
        isfinite(found.left.value))
        limit->value = limit_of(v, count, &found, turns);
    const bool falls = limit->sequence == BR_MONOTONE_CONVERGENCE || found.converges > 0.5;
    if (agree(v, count) || (!falls && agree(v + count - 3, 3)))
        *limit = (struct br_grid_limit){
            {finest, finest - half, finest + half}, NAN, BR_SEQUENCE_SCATTER};
    return BR_OK;
}

enum br_status br_limits_find(const struct br_point *v, size_t count, struct br_limits *limits,
                              struct br_error *err)
{
    static const struct br_gci none = {.order = NAN,
                                       .asymptotic = NAN,
                                       .fine = {NAN, NAN, NAN, NAN, NAN, NAN, NAN},
                                       .coarse = {NAN, NAN, NAN, NAN, NAN, NAN, NAN}};
    *limits = (struct br_limits){.limit = {.value = unknown, .order = NAN}, .gci = none};
    limits->triple = br_allocate(count, sizeof *limits->triple);
    if (!limits->triple)
        return br_no_memory(err, "the limits");
    for (size_t i = 0; i + 2 < count; i++) {
        br_gci(v + i, &limits->triple[i]);
        leave_scatter(&limits->triple[i], v + i);
        limits->gci = limits->triple[i];
        limits->triples = i + 1;
    }
    return count < 3 ? BR_OK : br_limit_of_values(v, count, &limits->limit, err);
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
        half += constant ? 0 : fmax(e->high - e->value, e->value - e->low);
        products =
            fmax(products, fabs(along[axis].next.value.value - along[axis].next_value - rest));
        if (axis == 0 || limit.sequence == BR_SEQUENCE_CONSTANT)
            limit.sequence = line->sequence;
        else if (line->sequence != limit.sequence && !constant)
            limit.sequence = BR_SEQUENCE_UNKNOWN;
    }
    half += products;
    if (isfinite(left) && half > 0 && isfinite(half))
        limit.value = (struct br_estimate){value + left, value + left - half, value + left + half};
    return limit;
}
