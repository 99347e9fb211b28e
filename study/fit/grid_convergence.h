/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Values of a quantity on finer and finer grids, without a reference: their limit, and how far from
 * it the finest value may be.
 *
 * Three grids: the grid convergence index of Celik, Ghia, Roache, Freitas, Coleman and Raad,
 * "Procedure for Estimation and Reporting of Uncertainty Due to Discretization in CFD
 * Applications", J. Fluids Eng. 130, 078001 (2008), and of ASME V&V 20-2009.
 * Four or more: the least squares of Eca and Hoekstra, "A procedure for the estimation of the
 * numerical uncertainty of CFD calculations based on grid refinement studies", J. Comput. Phys.
 * 262, 104-130 (2014).
 *
 * In all functions, h[count] are mesh sizes or time steps > 0 in any unit, from coarse to fine,
 * each smaller than the one before, with finite ratios, and value[count] is the quantity on these
 * grids, below DBL_MAX/4. The papers count from the finest grid: their h_1 is h[count - 1]. NaN in
 * a result: not known. */
#ifndef BR_STUDY_FIT_GRID_CONVERGENCE_H
#define BR_STUDY_FIT_GRID_CONVERGENCE_H

#include "study/fit/fit.h"

/* X(name, text): how a sequence of values behaves. */
#define BR_SEQUENCE_LIST(X)                                  \
    X(BR_SEQUENCE_UNKNOWN, "not known")                      \
    X(BR_SEQUENCE_CONSTANT, "constant")                      \
    X(BR_MONOTONE_CONVERGENCE, "monotone convergence")       \
    X(BR_OSCILLATORY_CONVERGENCE, "oscillatory convergence") \
    X(BR_MONOTONE_DIVERGENCE, "monotone divergence")         \
    X(BR_OSCILLATORY_DIVERGENCE, "oscillatory divergence")   \
    X(BR_SEQUENCE_SCATTER, "changes within the scatter of the means") \
    X(BR_SEQUENCE_ANOMALOUS, "anomalous behaviour")

enum br_sequence {
#define X(name, text) name,
    BR_SEQUENCE_LIST(X)
#undef X
};

const char *br_sequence_text(enum br_sequence sequence);

/* ---- the grid convergence index ---- */

/* A grid and the next coarser one: indices 21 or 32 of Celik et al. */
struct br_gci_pair {
    double ratio;                 /* r = h_coarse/h_fine > 1 */
    double difference;            /* |phi_fine - phi_coarse|, in the unit of the values */
    double limit;                 /* phi_ext, equation (4) */
    double uncertainty;           /* 1.25 |phi_fine - phi_coarse| / (r^p - 1), in that unit */
    double relative;              /* e_a, (5), of phi_fine; NaN where phi_fine is 0 */
    double relative_extrapolated; /* e_ext, (6), of phi_ext */
    double index;                 /* GCI, (7): the uncertainty relative to phi_fine */
};

/* With e21 = phi_2 - phi_1 and e32 = phi_3 - phi_2, convergence means that the order is positive:
 *     e21/e32 ln r32/ln r21 < 1 where both differences have the same sign,
 *     |e21/e32| < 1             where the signs alternate.
 * For equal ratios the left side is |R|, with R = e21/e32 of the literature. For unequal ones R
 * alone misleads: values 1 + h at h = 1, 1/10 and 1/100000 have R = 0.11, but at h = 1, 10/11 and
 * 5/11 R = 5. The quotient of the logarithms is the limit of (r32^p - 1)/(r21^p - 1) for p -> 0.
 * Differences within round-off count as zero: two, the sequence is constant; one, not known. */
struct br_gci {
    enum br_sequence sequence;
    double order;                    /* p, (3): negative if divergent */
    struct br_gci_pair fine, coarse; /* 21 and 32; without convergence only ratio, difference and
                                        relative are known */
    double asymptotic; /* GCI_32/(r21^p GCI_21), near 1 in the asymptotic range. With monotone
                          convergence it is always |phi_1/phi_2|, so it shows little. */
};

/* From the three finest grids; count >= 3. An order far above the formal one makes the uncertainty
 * too small (Xing and Stern, J. Fluids Eng. 132, 061403, 2010): compare the orders. */
void br_gci(const double *h, const double *value, size_t count, struct br_gci *gci);

/* The index of the fine grid with the limits of Oberkampf and Roy, Verification and Validation in
 * Scientific Computing (2010), chapter 8: within a tenth of the formal order, that order with a
 * safety of 1.25; else the observed order, between 0.5 and the formal one, with a safety of 3. NaN
 * without convergence. */
double br_gci_limited(const struct br_gci *gci, double formal);

/* Whether the observed order is that far from the formal one. */
bool br_gci_is_far(const struct br_gci *gci, double formal);

/* ---- least squares ---- */

/* phi_0 + sum alpha_j h^power_j, fitted to the values. */
struct br_expansion_fit {
    size_t terms;    /* 1 or 2; 0: no fit */
    double power[2]; /* of each term */
    bool observed;   /* power[0] is the observed order; else it is fixed */
    bool weighted;   /* by 1/h */
    double limit;    /* phi_0 */
    double error;    /* eps: the fit at the finest grid minus phi_0 */
    double misfit;   /* the finest value minus the fit there */
    double sigma;    /* standard deviation of the fit */
};

/* The sequence is monotone where an order between -12 and 12 fits best, whatever the scatter. Else
 * no order can be established; then it is oscillatory if its differences change sign count/3 times
 * (rounded down) or more, else anomalous. It is convergent or divergent by the sign of the order,
 * or of that of the magnitudes of the differences. */
struct br_least_squares {
    enum br_sequence sequence;
    double order;                /* p of phi_0 + alpha h^p; NaN where none can be established */
    struct br_expansion_fit fit; /* the one with the smallest sigma of those that may be chosen */
    double range;                /* Delta_phi = (max - min)/(count - 1) */
    double safety;               /* 1.25 for a reliable fit, else 3 */
    double uncertainty;          /* U of the finest value, 95 % */
};

/* The paper is about methods of formal order 2. Another formal order, 1 to 10, replaces 2 as the
 * highest order that is accepted (2.1: formal + 0.1) and as the exponent of the second term; for
 * formal order 1 the second term is h^2, and is never the only one. count >= 4. The uncertainty is
 * known for each sequence but a constant one, also for divergence. Fails with
 * BR_NO_MEMORY. */
enum br_status br_least_squares(const double *h, const double *value, size_t count, double formal,
                                struct br_least_squares *result, struct br_error *err);

/* The observed order with its interval, from the differences of successive values, by
 * br_line_order_find; count >= 4. Fails with BR_NO_MEMORY. */
enum br_status br_order_of_values(const double *h, const double *value, size_t count,
                                  struct br_estimate *order, struct br_error *err);

#endif
