/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Legendre series on [0, 1] as series on an interval of it. */
#ifndef BR_REFERENCE_EXACT_SUBINTERVAL_H
#define BR_REFERENCE_EXACT_SUBINTERVAL_H

#include "solver/status.h"

struct br_subinterval {
    size_t count;
    long double *coupling; /* count + 1: b in x p_k = b_{k+1} p_{k+1} + p_k / 2 + b_k p_{k-1} */
    long double *r;        /* count x count, see br_subinterval_move; 0 for l > k */
};

/* For p_0 ... p_{count - 1}. Clear it even after a failure, which is BR_NO_MEMORY. */
enum br_status br_subinterval_init(struct br_subinterval *interval, size_t count,
                                   struct br_error *err);
void br_subinterval_clear(struct br_subinterval *interval);

/* p_k(first + width xi) = sum over l of r[k * count + l] p_l(xi), 0 <= first and
 * first + width <= 1. */
void br_subinterval_move(struct br_subinterval *interval, long double first, long double width);

#endif
