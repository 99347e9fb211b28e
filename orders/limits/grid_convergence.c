/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Equation numbers are those of Celik et al. (2008). */
#include "orders/limits/grid_convergence.h"

#include <float.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>

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

/* The round-off that the difference of two values may have. */
static double round_off_of(const double *value, size_t count)
{
    double least, most;
    gsl_stats_minmax(&least, &most, value, 1, count);
    return 64 * DBL_EPSILON * fmax(fabs(least), fabs(most));
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

/* A smaller order shows no limit: it would be more than 36 differences away, at a ratio of 2. */
static const double least_order = 0.05;

static enum br_sequence sequence_of(const struct triplet *t, double order)
{
    if (t->s > 0 && fabs(order) < least_order)
        return BR_SEQUENCE_LOGARITHM;
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
static void check_triplet(const double *h, const double *value, struct br_gci *gci)
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
    gci->order = order_of(&t);
    gci->sequence = sequence_of(&t, gci->order);
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

void br_gci(const double *h, const double *value, size_t count, struct br_gci *gci)
{
    *gci = (struct br_gci){.order = NAN};
    h += count - 3;
    value += count - 3;
    check_triplet(h, value, gci);
    const double order = convergent(gci->sequence) ? gci->order : NAN;
    gci->fine = pair_of(h + 1, value + 1, order);
    gci->coarse = pair_of(h, value, order);
    gci->asymptotic = gci->coarse.index / (pow(gci->fine.ratio, order) * gci->fine.index);
}
