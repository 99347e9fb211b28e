/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One Euler step of either field as the linear-quadratic problem of plain.h, in long double: what
 * the fast sweeps compute their tables from. Bending's second curvature is divided by sqrt(3) here,
 * so that R is a number; costates, P and loads are divided by it, so that it is 1. */
#ifndef BR_SOLVER_LQ_H
#define BR_SOLVER_LQ_H

#include "solver/field.h"

typedef long double br_real;

enum { BR_LQ_MOST = 2 }; /* unknowns a node */

struct br_lq {
    int d;                                        /* unknowns a node */
    br_real t[BR_LQ_MOST][BR_LQ_MOST];            /* T */
    br_real g[BR_LQ_MOST][BR_LQ_MOST];            /* G: y_{i+1} = T y_i + G kappa_i */
    br_real mass[2 * BR_LQ_MOST][2 * BR_LQ_MOST]; /* rho h / k times the element's mass, over R */
    br_real r;                                    /* R: (c + k a) / h, bending: / h^3 */
    br_real alpha;                                /* a / (c + k a) */
};

/* sqrt(3), and what G has for the second curvature: -sqrt(3)/6 */
#define BR_LQ_ROOT3 1.732050807568877293527446341505872367L
#define BR_LQ_LEVER (BR_LQ_ROOT3 / 6)

/* The gains of one element. */
struct br_lq_gain {
    br_real closed[BR_LQ_MOST][BR_LQ_MOST];   /* A = T - G K */
    br_real feedback[BR_LQ_MOST][BR_LQ_MOST]; /* K */
    br_real inverse[BR_LQ_MOST][BR_LQ_MOST];  /* S^-1 */
};

struct br_lq br_lq_of_field(const struct br_field *field);

/* One step of the Riccati recursion towards the clamped end: P_{i+1} becomes P_i. False where S is
 * not positive definite. */
bool br_lq_step(const struct br_lq *lq, br_real p[BR_LQ_MOST][BR_LQ_MOST], struct br_lq_gain *gain);

#endif
