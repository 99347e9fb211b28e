/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Orthonormal Legendre polynomials p_k on [0, 1], and their integrals.
 *
 * Both directions of the exact reference live on these: the beam's modes are
 * repeated integrals of p_k(x / L), a time step is a polynomial in p_k((t - t0) / h). */
#ifndef BR_REFERENCE_EXACT_LEGENDRE_H
#define BR_REFERENCE_EXACT_LEGENDRE_H

#include <stddef.h>

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

#endif
