/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Equation numbers are those of Celik et al. (2008). */
#include "orders/limits/grid_convergence.h"

#include <float.h>
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

double br_round_off_of(const struct br_point *v, size_t count)
{
    double most = 0;
    for (size_t i = 0; i < count; i++)
        most = fmax(most, fabs(v[i].value));
    return 64 * DBL_EPSILON * most;
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

/* v[0]: the coarser grid; v[1]: the finer one. order: NaN if there is none. */
static struct br_gci_pair pair_of(const struct br_point *v, double order)
{
    const double ratio = v[0].z / v[1].z, fine = v[1].value;
    const double step = (fine - v[0].value) / expm1(order * log(ratio)); /* e/(r^p - 1) */
    const double limit = fine + step, uncertainty = safety_observed * fabs(step);
    return (struct br_gci_pair){
        .ratio = ratio,
        .difference = fabs(fine - v[0].value),
        .limit = limit,
        .uncertainty = uncertainty,
        .relative = relative_to(fine - v[0].value, fine),
        .relative_extrapolated = relative_to(step, limit),
        .index = relative_to(uncertainty, fine),
    };
}

/* Sets sequence and order from three grids. */
static void check_triplet(const struct br_point *v, struct br_gci *gci)
{
    const double e21 = v[1].value - v[2].value, e32 = v[0].value - v[1].value;
    const double zero = br_round_off_of(v, 3);
    if (fabs(e21) <= zero || fabs(e32) <= zero) {
        const bool both = fabs(e21) <= zero && fabs(e32) <= zero;
        gci->sequence = both ? BR_SEQUENCE_CONSTANT : BR_SEQUENCE_UNKNOWN;
        return;
    }
    const struct triplet t = {
        .ln21 = log(v[1].z / v[2].z),
        .ln32 = log(v[0].z / v[1].z),
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

void br_gci(const struct br_point v[3], struct br_gci *gci)
{
    *gci = (struct br_gci){.order = NAN, .row = v[2].row};
    check_triplet(v, gci);
    const double order = convergent(gci->sequence) ? gci->order : NAN;
    gci->fine = pair_of(v + 1, order);
    gci->coarse = pair_of(v, order);
    gci->asymptotic = gci->coarse.index / (pow(gci->fine.ratio, order) * gci->fine.index);
}
