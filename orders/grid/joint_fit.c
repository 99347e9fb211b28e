/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The orders of a grid, from the models that the search has tried: their intervals, and one model
 * or the mixture of all. */
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "orders/grid/joint_search.h"

/* ---- intervals ---- */

/* How far neighbours along h and along k have residuals of one sign: the sum of their products, in
 * standard deviations of that of independent ones. A wrong model leaves waves, noise does not. */
static double structure_of(const struct br_joint_cells *cells, const double *residual)
{
    double products = 0, pairs = 0, squares = 0;
    for (size_t i = 0; i < cells->count; i++) {
        const struct br_joint_cell *at = &cells->cell[i];
        squares += residual[i] * residual[i] / (double)cells->count;
        for (int a = 0; a < BR_AXES; a++) {
            size_t next = cells->count, size = 0;
            for (size_t j = 0; j < cells->count; j++) {
                const struct br_joint_cell *o = &cells->cell[j];
                if (o->at[1 - a] == at->at[1 - a] && o->at[a] < at->at[a] && o->at[a] > size) {
                    size = o->at[a];
                    next = j;
                }
            }
            products += next < cells->count ? residual[i] * residual[next] : 0;
            pairs += next < cells->count;
        }
    }
    return pairs > 0 && squares > 0 ? products / squares / sqrt(pairs) : 0;
}

/* Residuals with less structure than this are as independent as noise is. Those below `exact` do
 * not scatter. */
static const double waves = 0.7, exact = 1e-4;

/* How many times as wide as that of 95 % the interval of 99 % is. */
static double as_99(double freedom)
{
    return gsl_cdf_tdist_Pinv(0.995, freedom) / gsl_cdf_tdist_Pinv(0.975, freedom);
}

/* Cells that share h or k are not independent: the residuals are deterministic. So the intervals
 * come from leaving out one whole line of the grid after the other (delete-a-group jackknife, Efron
 * 1982), where they are wider. */
static void widen_along(struct br_joint_search *s, struct br_joint_candidate *c, int axis)
{
    static const double off_the_end = 0.9;
    int unknown[BR_UNKNOWNS];
    double sum[BR_UNKNOWNS] = {0}, squares[BR_UNKNOWNS] = {0}, groups = 0, whole[BR_UNKNOWNS];
    br_joint_in_units(s, &c->trial, whole);
    const size_t unknowns = br_joint_unknowns(&c->trial.law, unknown);
    struct br_joint_cells rest = s->used;
    rest.cell = s->rest;
    for (size_t size = 1; size < s->used.sizes[axis]; size++) {
        rest.count = 0;
        for (size_t i = 0; i < s->used.count; i++)
            if (s->used.cell[i].at[axis] != size)
                rest.cell[rest.count++] = s->used.cell[i];
        if (rest.count == s->used.count)
            continue;
        struct br_joint_trial without = c->trial;
        without.sum = INFINITY;
        without.value[BR_THETA] *= off_the_end; /* where it is 1, r has no slope to leave by */
        if (rest.count > unknowns)
            br_joint_descend(&rest, &without);
        double value[BR_UNKNOWNS];
        br_joint_in_units(s, &without, value);
        for (size_t i = 0; i < unknowns; i++) {
            const double off =
                isfinite(without.sum) ? value[unknown[i]] - whole[unknown[i]] : (double)NAN;
            sum[i] += off;
            squares[i] += off * off;
        }
        groups++;
    }
    const double quantiles =
        gsl_cdf_tdist_Pinv(0.975, groups - 1) / gsl_cdf_tdist_Pinv(0.975, c->trial.freedom);
    for (size_t i = 0; i < unknowns; i++) {
        const double spread = squares[i] - sum[i] * sum[i] / groups;
        const double deviation = sqrt((groups - 1) / groups * fmax(0, spread)) * quantiles;
        if (deviation <= c->deviation[unknown[i]])
            continue;
        c->deviation[unknown[i]] =
            isfinite(spread) ? deviation : INFINITY; /* NaN: a refit failed */
        for (int a = 0; a < BR_AXES; a++)            /* its freedom is that of the groups */
            if (unknown[i] == BR_OF(a, BR_ORDER))
                c->tails[a] = as_99(groups - 1) / as_99(c->trial.freedom);
    }
}

static void widen(struct br_joint_search *s, struct br_joint_candidate *c)
{
    const struct br_joint_law *law = &c->trial.law;
    if (c->widened || br_joint_changes_along(law, 0) || br_joint_changes_along(law, 1))
        return; /* the interval reaches from order to order */
    br_joint_look_at(s, c->window);
    br_joint_residuals(&s->used, &c->trial, s->residual);
    const bool noise = c->trial.sum > exact * exact * c->trial.weight;
    if (s->any_model && (noise || !(law->of[0] || law->of[1])) &&
        structure_of(&s->used, s->residual) < waves)
        return;
    for (int a = 0; a < BR_AXES; a++)
        if (br_joint_has(law->kind, a))
            widen_along(s, c, a);
    c->widened = true;
}

/* ---- what one model makes of the errors ---- */

/* A number with its interval by the deviation of an unknown; NaN: there is none. */
static struct br_estimate estimate(const struct br_joint_candidate *c, bool has, double value,
                                   int unknown)
{
    return br_estimate_of(has ? value : (double)NAN, c->deviation[unknown],
                          (size_t)c->trial.freedom);
}

/* r with its interval by the slope of the sine, within [-1, 1]. */
static struct br_estimate correlation(const struct br_joint_candidate *c)
{
    static const double fixed[BR_SUMS] = {[BR_SUM_ADDS] = 1, [BR_SUM_SUBTRACTS] = -1};
    const struct br_joint_law *law = &c->trial.law;
    const double theta = c->trial.value[BR_THETA], r = fixed[law->sum];
    if (law->kind == BR_JOINT_BOTH && law->sum != BR_SUM_ANY)
        return (struct br_estimate){r, r, r};
    struct br_estimate e = estimate(c, law->kind == BR_JOINT_BOTH, theta, BR_THETA);
    const double half = fabs(cos(theta)) * (e.high - e.value);
    e.value = sin(e.value);
    e.low = e.value - half < -1 ? -1 : e.value - half; /* NaN stays */
    e.high = e.value + half > 1 ? 1 : e.value + half;
    return e;
}

static void describe(struct br_joint_search *s, const struct br_joint_candidate *c,
                     struct br_joint_fit *fit)
{
    static const double most_scatter = 0.3, most_structure = 1;
    static const double round_off = 1e-24; /* a mean square below this */
    const struct br_joint_trial *t = &c->trial;
    double mean = 0, total = 0, value[BR_UNKNOWNS];
    br_joint_in_units(s, t, value);
    br_joint_look_at(s, c->window);
    *fit = (struct br_joint_fit){.kind = t->law.kind,
                                 .converged = true,
                                 .points = s->used.count,
                                 .left_out = s->all.count - s->used.count,
                                 .freedom = (size_t)t->freedom,
                                 .worst = t->worst,
                                 .misfit =
                                     t->sum / t->weight > round_off ? sqrt(t->sum / t->weight) : 0,
                                 .r = correlation(c),
                                 .floor = t->law.floor ? exp(value[BR_LOG_F]) : (double)NAN};
    br_joint_residuals(&s->used, t, s->residual);
    for (int a = 0; a < BR_AXES; a++) {
        const bool has = br_joint_has(t->law.kind, a);
        struct br_estimate e = estimate(c, has, value[BR_OF(a, BR_LOG_C)], BR_OF(a, BR_LOG_C));
        fit->c[a] = (struct br_estimate){exp(e.value), exp(e.low), exp(e.high)};
        if (t->law.of[a]) /* its deviation is that of the error at the coarsest size */
            fit->c[a].low = fit->c[a].high = NAN;
        e = fit->order[a] = estimate(c, has, value[BR_OF(a, BR_ORDER)], BR_OF(a, BR_ORDER));
        const double half = as_99(t->freedom) * c->tails[a] * (e.high - e.value);
        fit->low99[a] = e.value - half;
        fit->high99[a] = e.value + half;
        fit->share[a] = br_joint_share(&s->used, a);
        fit->law[a] = has && t->law.of[a] ? br_law_text(t->law.of[a]->law) : NULL;
    }
    for (size_t i = 0; i < s->used.count; i++)
        mean += s->used.cell[i].log_error / (double)s->used.count;
    for (size_t i = 0; i < s->used.count; i++)
        total += pow(s->used.cell[i].log_error - mean, 2);
    fit->r_squared = total > 0 ? 1 - t->sum / total : NAN;
    fit->scatters = s->any_model && fit->misfit <= most_scatter &&
                    structure_of(&s->used, s->residual) <= most_structure;
}

/* ---- one model, or the mixture ---- */

static int by_weight(const void *a, const void *b)
{
    const struct br_joint_candidate *x = a, *y = b;
    return (x->log_weight < y->log_weight) - (x->log_weight > y->log_weight);
}

static bool one_determined(const struct br_joint_fit *fit)
{
    return br_order_determined(&fit->order[0]) || br_order_determined(&fit->order[1]);
}

/* Whether all orders of the model are determined. */
static bool all_determined(const struct br_joint_fit *fit)
{
    return (!br_joint_has(fit->kind, 0) || br_order_determined(&fit->order[0])) &&
           (!br_joint_has(fit->kind, 1) || br_order_determined(&fit->order[1]));
}

/* The best model whose orders are determined; else that of both errors, if one of them is. */
static void take_one(struct br_joint_search *s, struct br_joint_fit *fit)
{
    struct br_joint_fit one;
    for (size_t i = 0; i < s->count && !fit->converged; i++) {
        describe(s, &s->candidate[i], &one);
        if (!all_determined(&one))
            continue;
        widen(s, &s->candidate[i]);
        describe(s, &s->candidate[i], &one);
        *fit = all_determined(&one) ? one : *fit;
    }
    for (size_t i = 0; i < s->count && !br_joint_describes(fit); i++) {
        if (s->candidate[i].trial.law.kind != BR_JOINT_BOTH)
            continue;
        widen(s, &s->candidate[i]);
        describe(s, &s->candidate[i], &one);
        if (br_joint_describes(&one) && one_determined(&one))
            *fit = one;
        return;
    }
}

/* The probability that the order of an axis is below this one, by one model; tails: that far out.
 */
static double below(const struct br_joint_candidate *c, int axis, double order, bool tails)
{
    const double scale = hypot(c->deviation[BR_OF(axis, BR_ORDER)], c->trial.open[axis]) *
                         (tails ? c->tails[axis] : 1),
                 off = order - c->trial.value[BR_OF(axis, BR_ORDER)],
                 coarse =
                     br_joint_changes_along(&c->trial.law, axis) ? c->trial.law.of[axis]->s : 0;
    if (!isfinite(scale))
        return 0.5;
    double sum = (1 - coarse) * br_student_below(off / scale, c->trial.freedom);
    if (coarse > 0)
        sum += coarse *
               br_student_below(
                   (off - c->trial.value[BR_OF(axis, BR_ORDER) - BR_ORDER + BR_SHAPE]) / scale,
                   c->trial.freedom);
    return sum;
}

/* The order of an axis below which this share of the mixture is. */
static double quantile(const struct br_joint_search *s, int axis, double all, double share)
{
    double low = -60, high = 60;
    const bool tails = fabs(share - 0.5) > 0.49; /* beyond 95 % */
    while (high - low > 1e-9) {
        const double at = (low + high) / 2;
        double sum = 0;
        for (size_t i = 0; i < s->count; i++)
            if (br_joint_has(s->candidate[i].trial.law.kind, axis))
                sum += s->candidate[i].log_weight * below(&s->candidate[i], axis, at, tails);
        *(sum < share * all ? &low : &high) = at;
    }
    return (low + high) / 2;
}

/* Models of less weight than this logarithm below the best are not kept, and of less than that not
 * widened. */
static const double kept = 8.5, widened = 0.02;

/* The mixture: from logarithms to weights of sum 1. An axis whose error most of the weight does not
 * see has no order. */
static void take_mixture(struct br_joint_search *s, struct br_joint_fit *fit)
{
    double sum = 0, sees[BR_AXES] = {0};
    size_t count = 0;
    while (count < s->count && s->candidate[count].log_weight >= s->best - kept)
        sum += exp(s->candidate[count++].log_weight - s->best);
    s->count = count;
    for (size_t i = 0; i < count; i++) {
        struct br_joint_candidate *c = &s->candidate[i];
        c->log_weight = exp(c->log_weight - s->best) / sum;
        if (c->log_weight > widened)
            widen(s, c);
        for (int a = 0; a < BR_AXES; a++)
            sees[a] += br_joint_has(c->trial.law.kind, a) ? c->log_weight : 0;
    }
    const enum br_joint_kind kind = sees[BR_AXIS_SPACE] < 0.5  ? BR_JOINT_TIME
                                    : sees[BR_AXIS_TIME] < 0.5 ? BR_JOINT_SPACE
                                                               : BR_JOINT_BOTH;
    size_t likely = 0;
    while (likely + 1 < count && s->candidate[likely].trial.law.kind != kind)
        likely++;
    describe(s, &s->candidate[likely], fit);
    for (int a = 0; a < BR_AXES; a++) {
        if (!br_joint_has(fit->kind, a))
            continue;
        fit->order[a] =
            (struct br_estimate){quantile(s, a, sees[a], 0.5), quantile(s, a, sees[a], 0.025),
                                 quantile(s, a, sees[a], 0.975)};
        if (fit->order[a].low < br_priors.least_order) /* no order, or a floor */
            fit->order[a].low = fmin(fit->order[a].low, 0);
        fit->low99[a] = quantile(s, a, sees[a], 0.005);
        fit->high99[a] = quantile(s, a, sees[a], 0.995);
    }
}

static struct br_joint_fit nothing_fitted(size_t points)
{
    const struct br_estimate none = {NAN, NAN, NAN};
    return (struct br_joint_fit){.c = {none, none},
                                 .order = {none, none},
                                 .r = none,
                                 .misfit = NAN,
                                 .worst = NAN,
                                 .r_squared = NAN,
                                 .floor = NAN,
                                 .points = points};
}

/* Cells that the most probable model leaves out; those of a whole size are too coarse. */
static void flag_cells(const struct br_joint_search *s, struct br_point *point)
{
    const struct br_joint_window *window = &s->window[s->count ? s->candidate[0].window : 0];
    for (size_t i = 0; i < s->all.count; i++)
        point[i].flag = !br_joint_is_out(s, window, i)  ? BR_FLAG_NONE
                        : s->window[1].far && s->far[i] ? BR_FLAG_OUTLIER
                                                        : BR_FLAG_COARSE;
}

/* All memory of a search; false: there is none. */
static bool make_room(struct br_joint_search *s)
{
    const size_t count = s->all.count;
    s->all.cell = br_allocate(3 * count + 1, sizeof *s->all.cell);
    s->all.size[0] = br_allocate(4 * count + 4, sizeof *s->all.size[0]);
    s->all.room = br_allocate(br_joint_room(count) + 2 * count, sizeof *s->all.room);
    s->far = br_allocate(count + 1, sizeof *s->far);
    s->candidate = br_allocate(BR_JOINT_TRIALS, sizeof *s->candidate);
    if (!s->all.cell || !s->all.size[0] || !s->all.room || !s->far || !s->candidate)
        return false;
    s->all.size[1] = s->all.size[0] + 2 * count + 2;
    s->residual = s->all.room + br_joint_room(count);
    return true;
}

static void fit_all(struct br_joint_search *s, struct br_point *point, struct br_joint_fit *fit)
{
    br_joint_search(s, point);
    qsort(s->candidate, s->count, sizeof *s->candidate, by_weight);
    while (s->count && !isfinite(s->candidate[s->count - 1].log_weight))
        s->count--;
    if (s->count && s->any_model)
        take_mixture(s, fit);
    else
        take_one(s, fit);
    if (!one_determined(fit))
        *fit = nothing_fitted(s->all.count);
    flag_cells(s, point);
}

enum { UNKNOWNS = 4 /* a constant and an order for each axis */ };

enum br_status br_joint_fit_solve(struct br_point *point, size_t count, bool any_model,
                                  const struct br_observer *observer, struct br_joint_fit *fit,
                                  struct br_error *err)
{
    struct br_joint_search s = {.any_model = any_model,
                                .best = -INFINITY,
                                .all = {.count = count, .priors = any_model, .observer = observer}};
    *fit = nothing_fitted(count);
    const enum br_status status = make_room(&s) ? BR_OK : br_no_memory(err, "the fits");
    if (!status && count >= UNKNOWNS)
        fit_all(&s, point, fit);
    free(s.all.cell);
    free(s.all.size[0]);
    free(s.all.room);
    free(s.far);
    free(s.candidate);
    return status ? status : br_observer_check(observer, err);
}
