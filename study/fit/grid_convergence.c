/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Equation numbers are those of Celik et al. (2008) for the grid convergence index, and of Eca and
 * Hoekstra (2014) for least squares. */
#include "study/fit/grid_convergence.h"

#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_min.h>
#include <math.h>

#include "study/fit/line_order.h"

static const double safety_observed = 1.25; /* with an observed order */
static const double safety_else = 3;

const char *br_sequence_text(enum br_sequence sequence)
{
    static const char *const texts[] = {
#define X(name, text) [name] = text,
        BR_SEQUENCE_LIST(X)
#undef X
    };
    return texts[sequence];
}

static enum br_status check_line(const double *h, const double *value, size_t count, size_t least,
                                 struct br_error *err)
{
    if (count < least)
        return br_fail(err, BR_BAD_INPUT, "%zu grids, expected at least %zu", count, least);
    for (size_t i = 0; i < count; i++) {
        if (!(h[i] > 0 && isfinite(h[i])))
            return br_fail(err, BR_BAD_INPUT, "h[%zu] is %g, expected a finite number > 0", i,
                           h[i]);
        if (i > 0 && !(h[i - 1] / h[i] > 1 && isfinite(h[i - 1] / h[i])))
            return br_fail(err, BR_BAD_INPUT, "h[%zu] is %.17g, expected less than %.17g before it",
                           i, h[i], h[i - 1]);
        if (!(fabs(value[i]) <= DBL_MAX / 4)) /* differences do not overflow */
            return br_fail(err, BR_BAD_INPUT, "value[%zu] is %g, expected a finite number", i,
                           value[i]);
    }
    return BR_OK;
}

enum br_status br_check_formal(double formal, struct br_error *err)
{
    return formal >= 1 && formal <= 10
               ? BR_OK
               : br_fail(err, BR_BAD_INPUT, "the formal order is %g, expected 1 to 10", formal);
}

/* The round-off that the difference of two values may have. */
static double round_off_of(const double *value, size_t count)
{
    double largest = 0;
    for (size_t i = 0; i < count; i++)
        largest = fmax(largest, fabs(value[i]));
    return 64 * DBL_EPSILON * largest;
}

/* ---- the grid convergence index ---- */

/* The numbers of (3) from the three finest grids. */
struct triplet {
    double ln21, ln32; /* logarithms of the refinement ratios */
    double ln_growth;  /* ln |e32/e21| */
    int s;             /* sign(e32/e21), (3c) */
};

/* ln |e^x - s|, finite also where e^x overflows */
static double ln_gain(double x, int s)
{
    return fmax(x, 0) + (s > 0 ? log(-expm1(-fabs(x))) : log1p(exp(-fabs(x))));
}

/* (3a) and (3b): p ln r21 - ln |e32/e21| - q(p), q = ln((r21^p - s)/(r32^p - s)). It increases
 * with p from -infinity to infinity. Celik et al. take the magnitude of the right side; here,
 * without it, divergence has a negative order. */
static double order_mismatch(const struct triplet *t, double p)
{
    double q = ln_gain(p * t->ln21, t->s) - ln_gain(p * t->ln32, t->s);
    if (p == 0)
        q = t->s > 0 ? log(t->ln21 / t->ln32) : 0;
    return p * t->ln21 - t->ln_growth - q;
}

/* The order p of three values, the root of (3). Celik et al. iterate p <- (ln |e32/e21| + q(p))/ln
 * r21, which has the same fixed point, but diverges from it where r32 is greater than about r21^2.
 * So the root is bracketed here. */
static double order_of(const struct triplet *t)
{
    double low = -1, high = 1;
    while (order_mismatch(t, low) > 0)
        low *= 2;
    while (order_mismatch(t, high) < 0)
        high *= 2;
    for (int i = 0; i < 200; i++) {
        const double p = (low + high) / 2;
        *(order_mismatch(t, p) < 0 ? &low : &high) = p;
    }
    return (low + high) / 2;
}

static enum br_sequence sequence_of(const struct triplet *t)
{
    if (t->s < 0)
        return t->ln_growth > 0 ? BR_OSCILLATORY_CONVERGENCE : BR_OSCILLATORY_DIVERGENCE;
    return t->ln_growth > log(t->ln32 / t->ln21) ? BR_MONOTONE_CONVERGENCE : BR_MONOTONE_DIVERGENCE;
}

static bool convergent(enum br_sequence sequence)
{
    return sequence == BR_MONOTONE_CONVERGENCE || sequence == BR_OSCILLATORY_CONVERGENCE;
}

static double relative_to(double difference, double value)
{
    return value != 0 ? fabs(difference / value) : NAN;
}

/* h[0], value[0]: the coarser grid; h[1], value[1]: the finer one. order: NaN if there is none. */
static struct br_gci_pair pair_of(const double *h, const double *value, double order)
{
    const double ratio = h[0] / h[1], fine = value[1];
    const double step = (fine - value[0]) / expm1(order * log(ratio)); /* e/(r^p - 1) */
    const double limit = fine + step, uncertainty = safety_observed * fabs(step);
    return (struct br_gci_pair){
        .ratio = ratio,
        .difference = fabs(fine - value[0]),
        .limit = limit,
        .uncertainty = uncertainty,
        .relative = relative_to(fine - value[0], fine),
        .relative_extrapolated = relative_to(step, limit),
        .index = relative_to(uncertainty, fine),
    };
}

/* Sets sequence and order from the three grids h[0] to h[2]. */
static void judge_triplet(const double *h, const double *value, struct br_gci *gci)
{
    const double e21 = value[1] - value[2], e32 = value[0] - value[1];
    const double zero = round_off_of(value, 3);
    if (fabs(e21) <= zero || fabs(e32) <= zero) {
        const bool both = fabs(e21) <= zero && fabs(e32) <= zero;
        gci->sequence = both ? BR_SEQUENCE_CONSTANT : BR_SEQUENCE_UNKNOWN;
        return;
    }
    const struct triplet t = {
        .ln21 = log(h[1] / h[2]),
        .ln32 = log(h[0] / h[1]),
        .ln_growth = log(fabs(e32)) - log(fabs(e21)),
        .s = (e32 > 0) == (e21 > 0) ? 1 : -1,
    };
    gci->sequence = sequence_of(&t);
    gci->order = order_of(&t);
}

bool br_gci_is_far(const struct br_gci *gci, double formal)
{
    return convergent(gci->sequence) && !(fabs(gci->order - formal) <= 0.1 * formal);
}

double br_gci_limited(const struct br_gci *gci, double formal)
{
    const bool far = br_gci_is_far(gci, formal);
    const double order = far ? fmin(fmax(0.5, gci->order), formal) : formal;
    return convergent(gci->sequence) ? (far ? safety_else : safety_observed) * gci->fine.relative /
                                           expm1(order * log(gci->fine.ratio))
                                     : NAN;
}

enum br_status br_gci(const double *h, const double *value, size_t count, struct br_gci *gci,
                      struct br_error *err)
{
    *gci = (struct br_gci){.order = NAN};
    if (check_line(h, value, count, 3, err))
        return err->status;
    h += count - 3;
    value += count - 3;
    judge_triplet(h, value, gci);
    const double order = convergent(gci->sequence) ? gci->order : NAN;
    gci->fine = pair_of(h + 1, value + 1, order);
    gci->coarse = pair_of(h, value, order);
    gci->asymptotic = gci->coarse.index / (pow(gci->fine.ratio, order) * gci->fine.index);
    return BR_OK;
}

/* ---- least squares ---- */

/* The values minus the finest one, over (max - min): so fits do not depend on units and offsets. */
struct data {
    size_t count;
    double *y;         /* count */
    double *ln_h;      /* count: ln(h/h_1) */
    double *weight[2]; /* count each, sum 1: equal ones, and (16) */
    double *x;         /* 3 count: workspace for the columns of a fit */
    double *rest;      /* count: workspace for its right-hand side */
    gsl_min_fminimizer *minimizer;
};

static void data_free(struct data *d)
{
    free(d->y);
    if (d->minimizer)
        gsl_min_fminimizer_free(d->minimizer);
}

/* Takes h and the values; full: max - min > 0. */
static enum br_status data_create(struct data *d, const double *h, const double *value,
                                  size_t count, double full, struct br_error *err)
{
    double *room = br_allocate(8 * count, sizeof *room);
    *d = (struct data){
        .count = count,
        .y = room,
        .ln_h = room + count,
        .weight = {room + 2 * count, room + 3 * count},
        .x = room + 4 * count,
        .rest = room + 7 * count,
        .minimizer = gsl_min_fminimizer_alloc(gsl_min_fminimizer_brent),
    };
    if (!room || !d->minimizer)
        return br_no_memory(err, "the fits");
    const double finest = h[count - 1];
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += finest / h[i];
    for (size_t i = 0; i < count; i++) {
        d->y[i] = (value[i] - value[count - 1]) / full;
        d->ln_h[i] = log(h[i] / finest);
        d->weight[0][i] = 1 / (double)count;
        d->weight[1][i] = finest / h[i] / sum; /* (16) */
    }
    return BR_OK;
}

/* The columns 1 and ((h/h_1)^power - 1)/power of each term. They span the same space as 1 and
 * h^power, but stay independent as power -> 0. Returns whether all are finite. */
static bool fill_columns(const struct data *d, const struct br_expansion_fit *fit)
{
    const size_t columns = 1 + fit->terms;
    bool finite = true;
    for (size_t i = 0; i < d->count; i++) {
        double *row = d->x + i * columns;
        row[0] = 1;
        for (size_t j = 0; j < fit->terms; j++) {
            const double p = fit->power[j];
            row[1 + j] = p == 0 ? d->ln_h[i] : expm1(p * d->ln_h[i]) / p;
            finite = finite && isfinite(row[1 + j]);
        }
    }
    return finite;
}

/* Fits the expansion whose first four members are given; sigma is NaN where there is no fit.
 * sigma^2 = sum n w_i (phi_i - fit_i)^2 / (n - parameters), Appendix B. */
static void fit_expansion(const struct data *d, struct br_expansion_fit *fit)
{
    const size_t n = d->count, columns = 1 + fit->terms;
    fit->limit = fit->error = fit->misfit = fit->sigma = NAN;
    if (!fill_columns(d, fit))
        return;
    double c[3], covariance[9];
    for (size_t i = 0; i < n; i++) {
        const double root = sqrt(d->weight[fit->weighted][i]);
        for (size_t j = 0; j < columns; j++)
            d->x[i * columns + j] *= root;
        d->rest[i] = d->y[i] * root;
    }
    const double sum = br_least_squares_solve(d->x, d->rest, n, columns, 0, c, covariance);
    fit->error = 0;
    for (size_t j = 0; j < fit->terms; j++)
        fit->error += c[1 + j] / fit->power[j];
    fit->limit = c[0] - fit->error;
    fit->misfit = -c[0]; /* y is 0 on the finest grid */
    fit->sigma = sqrt((double)n * sum / (double)(n - columns - (fit->observed ? 1 : 0)));
}

struct scan {
    const struct data *data;
    bool weighted;
};

static double variance_at(double p, void *self)
{
    const struct scan *s = self;
    struct br_expansion_fit fit = {1, {p, NAN}, true, s->weighted, NAN, NAN, NAN, NAN};
    fit_expansion(s->data, &fit);
    return fit.sigma * fit.sigma;
}

/* phi_0 + alpha h^p with the best p, (1). For a given p the fit is linear. The variance can have
 * several minima over p, so p is scanned before the lowest minimum is refined. Where the best p is
 * at an end of the scan, there is no fit: no terms. */
static struct br_expansion_fit fit_observed(const struct data *d, bool weighted)
{
    enum { STEPS = 480 };
    const double most = 12, width = 2 * most / STEPS;
    struct scan scan = {d, weighted};
    double best = INFINITY;
    size_t at = 0;
    for (size_t i = 0; i <= STEPS; i++) {
        const double variance = variance_at((double)i * width - most, &scan);
        if (variance < best) {
            best = variance;
            at = i;
        }
    }
    struct br_expansion_fit fit = {0, {NAN, NAN}, true, weighted, NAN, NAN, NAN, NAN};
    if (at == 0 || at == STEPS)
        return fit;
    double p = (double)at * width - most;
    gsl_function f = {variance_at, &scan};
    gsl_min_fminimizer *m = d->minimizer;
    if (gsl_min_fminimizer_set(m, &f, p, p - width, p + width) == GSL_SUCCESS)
        for (int i = 0; i < 100 && gsl_min_fminimizer_iterate(m) == GSL_SUCCESS; i++) {
            p = gsl_min_fminimizer_x_minimum(m);
            if (gsl_min_fminimizer_x_upper(m) - gsl_min_fminimizer_x_lower(m) <= 1e-12)
                break;
        }
    fit.terms = 1;
    fit.power[0] = p;
    fit_expansion(d, &fit);
    return fit;
}

/* Keeps the fit with the smaller sigma. */
static void keep_better(struct br_expansion_fit *best, const struct br_expansion_fit *other)
{
    if (other->terms > 0 && (best->terms == 0 || other->sigma < best->sigma))
        *best = *other;
}

static void try_fixed(const struct data *d, size_t terms, double first, double second,
                      struct br_expansion_fit *best)
{
    for (int weighted = 0; weighted < 2; weighted++) {
        struct br_expansion_fit fit = {.terms = terms, .weighted = weighted};
        fit.power[0] = first;
        fit.power[1] = second;
        fit_expansion(d, &fit);
        if (fit.sigma >= 0)
            keep_better(best, &fit);
    }
}

/* Appendix A, step 1. */
static void choose_fit(const struct data *d, double formal, struct br_least_squares *r)
{
    struct br_expansion_fit growing = {.power = {NAN, NAN}}, falling = growing;
    for (int weighted = 0; weighted < 2; weighted++) {
        const struct br_expansion_fit fit = fit_observed(d, weighted);
        keep_better(fit.power[0] > 0 ? &falling : &growing, &fit);
        if (fit.power[0] >= 0.5 && fit.power[0] <= formal)
            keep_better(&r->fit, &fit);
    }
    if (r->fit.terms > 0) {
        r->order = r->fit.power[0];
        return;
    }
    r->order = falling.terms > 0 ? falling.power[0] : growing.power[0];
    try_fixed(d, 1, 1, NAN, &r->fit); /* (5) */
    if (formal > 1)
        try_fixed(d, 1, formal, NAN, &r->fit); /* (6) */
    if (!(r->order > formal))
        try_fixed(d, 2, 1, formal > 1 ? formal : 2, &r->fit); /* (7) */
}

/* Appendix A, steps 2 to 4, in units of max - min. */
static void find_uncertainty(size_t count, double formal, struct br_least_squares *r)
{
    const double sigma = r->fit.sigma, error = fabs(r->fit.error), misfit = fabs(r->fit.misfit);
    r->range = 1 / (double)(count - 1); /* (19) */
    const bool smooth = sigma < r->range;
    const bool reliable = smooth && r->order >= 0.5 && r->order < formal + 0.1;
    r->safety = reliable ? safety_observed : safety_else;
    r->uncertainty = smooth ? r->safety * error + sigma + misfit               /* (20) */
                            : 3 * sigma / r->range * (error + sigma + misfit); /* (21) */
}

enum br_status br_order_of_values(const double *h, const double *value, size_t count,
                                  struct br_estimate *order, struct br_error *err)
{
    struct br_order_point *point = br_allocate(count - 1, sizeof *point);
    if (!point)
        return br_no_memory(err, "the order");
    for (size_t i = 0; i + 1 < count; i++)
        point[i] = (struct br_order_point){
            .z = h[i], .z_against = h[i + 1], .error = fabs(value[i] - value[i + 1])};
    struct br_line_order found;
    const enum br_status status = br_line_order_find(point, count - 1, &found, err);
    *order = found.order;
    free(point);
    return status;
}

static enum br_status name_sequence(const double *h, const double *value, size_t count,
                                    struct br_least_squares *r, struct br_error *err)
{
    if (!isnan(r->order)) {
        r->sequence = r->order > 0 ? BR_MONOTONE_CONVERGENCE : BR_MONOTONE_DIVERGENCE;
        return BR_OK;
    }
    size_t changes = 0;
    for (size_t i = 2; i < count; i++)
        changes += (value[i] > value[i - 1] && value[i - 1] < value[i - 2]) ||
                   (value[i] < value[i - 1] && value[i - 1] > value[i - 2]);
    r->sequence = BR_SEQUENCE_ANOMALOUS;
    if (changes < count / 3)
        return BR_OK;
    struct br_estimate order = {NAN, NAN, NAN};
    const enum br_status status = br_order_of_values(h, value, count, &order, err);
    if (order.value > 0)
        r->sequence = BR_OSCILLATORY_CONVERGENCE;
    if (order.value <= 0)
        r->sequence = BR_OSCILLATORY_DIVERGENCE;
    return status;
}

/* From units of max - min to those of the values. */
static void rescale(struct br_least_squares *r, double full, double finest)
{
    r->range *= full;
    r->uncertainty *= full;
    r->fit.limit = finest + full * r->fit.limit;
    r->fit.error *= full;
    r->fit.misfit *= full;
    r->fit.sigma *= full;
}

enum br_status br_least_squares(const double *h, const double *value, size_t count, double formal,
                                struct br_least_squares *result, struct br_error *err)
{
    const struct br_expansion_fit none = {0, {NAN, NAN}, false, false, NAN, NAN, NAN, NAN};
    *result = (struct br_least_squares){BR_SEQUENCE_UNKNOWN, NAN, none, NAN, NAN, NAN};
    enum br_status status = check_line(h, value, count, 4, err);
    if (!status)
        status = br_check_formal(formal, err);
    if (status)
        return status;
    double least = value[0], most = value[0];
    for (size_t i = 1; i < count; i++) {
        least = fmin(least, value[i]);
        most = fmax(most, value[i]);
    }
    if (most - least <= round_off_of(value, count)) {
        result->sequence = BR_SEQUENCE_CONSTANT;
        result->range = (most - least) / (double)(count - 1);
        return BR_OK;
    }
    struct data data;
    status = data_create(&data, h, value, count, most - least, err);
    if (!status) {
        choose_fit(&data, formal, result);
        find_uncertainty(count, formal, result);
        rescale(result, most - least, value[count - 1]);
        status = name_sequence(h, value, count, result, err);
    }
    data_free(&data);
    return status;
}
