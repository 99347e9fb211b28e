/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Radau IIA (Hairer and Wanner, Solving ODEs II, IV.5) written in Legendre
 * coefficients: a step's velocity is the polynomial sum_k v_k p_k(theta), and
 * collocation means that `integral` replaces integration over the step.
 * 9 stages: order 17 at the step's end, 9 inside the step, L-stable. */
#ifndef BR_REFERENCE_EXACT_RADAU_H
#define BR_REFERENCE_EXACT_RADAU_H

#include <stddef.h>

#include "solver/status.h"

enum { BR_STAGES = 9 };

struct br_radau {
    double node[BR_STAGES];                       /* c_j in (0, 1], the last is 1 */
    double to_coefficients[BR_STAGES][BR_STAGES]; /* [k][j]: values at nodes to coefficients */
    double integral[BR_STAGES][BR_STAGES];        /* X: coefficients to those of the integral */
    double end[BR_STAGES];                        /* p_k(1) */
};

/* Fails with BR_NO_MEMORY. */
enum br_status br_radau_init(struct br_radau *r, struct br_error *err);

/* out[k] = coefficient k of the polynomial with the given values at the nodes. */
void br_radau_fit(const struct br_radau *r, const double value[BR_STAGES], double out[BR_STAGES]);

/* sum_k c_k b_k */
static inline double br_radau_sum(const double c[BR_STAGES], const double b[BR_STAGES])
{
    double sum = 0;
    for (size_t k = 0; k < BR_STAGES; k++)
        sum += c[k] * b[k];
    return sum;
}

#endif
