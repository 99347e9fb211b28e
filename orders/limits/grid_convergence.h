/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Three values of a quantity on finer and finer grids, without a reference: the grid convergence
 * index of Celik, Ghia, Roache, Freitas, Coleman and Raad, "Procedure for Estimation and Reporting
 * of Uncertainty Due to Discretization in CFD Applications", J. Fluids Eng. 130, 078001 (2008), and
 * of ASME V&V 20-2009. The limit with its interval is that of limits.h.
 *
 * Of a point are read value, half and rounding, and z, the h of the papers. Points stand from
 * coarse to fine: z > 0 is smaller than the one before, with a finite ratio; the value there is
 * below DBL_MAX/4. The papers count from the finest grid: their h_1 is the last one. NaN in a
 * result: not known. */
#ifndef BR_ORDERS_LIMITS_GRID_CONVERGENCE_H
#define BR_ORDERS_LIMITS_GRID_CONVERGENCE_H

#include "base/status.h"
#include "orders/axis.h"
#include "orders/line/line_order.h"

/* X(name, text): how a sequence of values behaves. */
#define BR_SEQUENCE_LIST(X)                                           \
    X(BR_SEQUENCE_UNKNOWN, "not known")                               \
    X(BR_SEQUENCE_CONSTANT, "constant")                               \
    X(BR_MONOTONE_CONVERGENCE, "monotone convergence")                \
    X(BR_OSCILLATORY_CONVERGENCE, "oscillatory convergence")          \
    X(BR_MONOTONE_DIVERGENCE, "monotone divergence")                  \
    X(BR_OSCILLATORY_DIVERGENCE, "oscillatory divergence")            \
    X(BR_SEQUENCE_SCATTER, "changes within the scatter of the means") \
    X(BR_SEQUENCE_ANOMALOUS, "anomalous behaviour")                   \
    X(BR_SEQUENCE_LOGARITHM, "growth like a logarithm")

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
 * Differences within round-off count as zero: two, the sequence is constant; one, not known. An
 * order within 0.05 of zero, of one sign, is that of a logarithm: differences stay, and no limit is
 * in sight. */
struct br_gci {
    enum br_sequence sequence;
    double order;                    /* p, (3): negative if divergent */
    struct br_gci_pair fine, coarse; /* 21 and 32; without convergence only ratio, difference and
                                        relative are known */
    size_t row;                      /* of the finest value */
    double asymptotic; /* GCI_32/(r21^p GCI_21), near 1 in the asymptotic range. With monotone
                          convergence it is always |phi_1/phi_2|, so it shows little. */
};

/* From three grids. An order far above the formal one makes the uncertainty
 * too small (Xing and Stern, J. Fluids Eng. 132, 061403, 2010): compare the orders. */
void br_gci(const struct br_point value[3], struct br_gci *gci);

/* The round-off that the difference of two values may have. */
double br_round_off_of(const struct br_point *value, size_t count);

/* The index of the fine grid with the limits of Oberkampf and Roy, Verification and Validation in
 * Scientific Computing (2010), chapter 8: within a tenth of the formal order, that order with a
 * safety of 1.25; else the observed order, between 0.5 and the formal one, with a safety of 3. NaN
 * without convergence. */
double br_gci_limited(const struct br_gci *gci, double formal);

/* Whether the observed order is that far from the formal one. */
bool br_gci_is_far(const struct br_gci *gci, double formal);

#endif
