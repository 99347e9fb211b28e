/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Orthonormal Legendre polynomials p_k on [0, 1], and their integrals.
 *
 * Both directions of the exact reference live on these: the beam's modes are
 * repeated integrals of p_k(x / L), a time step is a polynomial in p_k((t - t0) / h). */
#ifndef BR_REFERENCE_EXACT_LEGENDRE_H
#define BR_REFERENCE_EXACT_LEGENDRE_H

#include <stddef.h>

#include "solver/status.h"

/* p[k] = p_k(xi), k < count; xi in [0, 1]. */
void br_legendre(size_t count, double xi, double *p);

/* The same, with the derivatives dp[k] = p_k'(xi). */
void br_legendre_derivative(size_t count, double xi, double *p, double *dp);

enum { BR_MOST_INTEGRALS = 15 };

/* p[k] = p_k(xi), q[k] = integral of p_k from 0 to xi, k < count <= BR_MOST_INTEGRALS. */
void br_legendre_integral(size_t count, double xi, double *p, double *q);

/* alpha_k in: integral from 0 of p_k = alpha_{k+1} p_{k+1} - alpha_k p_{k-1}, k >= 1. */
double br_legendre_coupling(size_t k);

/* c: in, count coefficients of a series; out, count + 1 coefficients of its
 * integral from 0. */
void br_legendre_integrate(size_t count, double *c);

/* Radau IIA (Hairer and Wanner, Solving ODEs II, IV.5) written in Legendre
 * coefficients: a step's velocity is the polynomial sum_k v_k p_k(theta), and
 * collocation means that `integral` replaces integration over the step.
 * 9 stages: order 17 at the step's end, 9 inside the step, L-stable. */
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
