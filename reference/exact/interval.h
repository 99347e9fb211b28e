/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Legendre series on [0, 1] as series on an interval of it. */
#ifndef BR_INTERVAL_H
#define BR_INTERVAL_H

#include "solver/status.h"

struct br_interval {
    size_t count;
    long double *coupling; /* count + 1: b in x p_k = b_{k+1} p_{k+1} + p_k / 2 + b_k p_{k-1} */
    long double *r;        /* count x count, see br_interval_move; 0 for l > k */
};

/* For p_0 ... p_{count - 1}. Clear it even after a failure, which is BR_NO_MEMORY. */
enum br_status br_interval_init(struct br_interval *interval, size_t count, struct br_error *err);
void br_interval_clear(struct br_interval *interval);

/* p_k(first + width xi) = sum over l of r[k * count + l] p_l(xi), 0 <= first and
 * first + width <= 1. */
void br_interval_move(struct br_interval *interval, long double first, long double width);

#endif
