/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Orthonormal Legendre polynomials p_k on [0, 1], and their integrals.
 *
 * The exact reference uses them in space and time: the beam's modes are
 * repeated integrals of p_k(x / L), a time step is a polynomial in p_k((t - t0) / h). */
#ifndef BR_REFERENCE_EXACT_LEGENDRE_H
#define BR_REFERENCE_EXACT_LEGENDRE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "solver/instruction_set.h"

/* p[k] = p_k(xi), k < count; xi in [0, 1]. */
void br_legendre(size_t count, double xi, double *p);

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

/* b = a \ b, b with `columns` columns, by rows; a is destroyed. BR_SINGULAR, or BR_NOT_FINITE where
 * an entry of a or b is not. Of our own: what a BLAS does with so few numbers follows the machine.
 */
enum br_status br_radau_solve(double a[BR_STAGES][BR_STAGES], size_t columns, double *b);

/* sum_k c_k b_k */
static inline double br_radau_sum(const double c[BR_STAGES], const double b[BR_STAGES])
{
    double sum = 0;
    for (size_t k = 0; k < BR_STAGES; k++)
        sum += c[k] * b[k];
    return sum;
}

/* ---- the loops that take most of the time (combine_loops.c) ----
 *
 * Sums of rows of a table, and the stages' equations of all modes, for each instruction set. */

/* out[r * width + j] (out, rows x width) = sum over k < count of factor[r * count + k]
 * table[k * width + j]. The same bits on every instruction set, and for any number of rows: a sum
 * goes from the first k to the last. */
void br_combine(size_t rows, size_t count, const double *factor, size_t width, const double *table,
                double *out);

/* The stages' equations of every mode, (a_i + b X + X^2) x = r with Radau's X of legendre.h.
 *
 * They are (X + theta) (X + theta') with theta + theta' = b and theta theta' = a_i, conjugate or
 * both real. Of numbers u + v theta one tridiagonal system is left, (X + theta') w = r: its
 * solution is w = X x + x theta. Its pivots p + q theta' need no exchange of rows: with a_i, b >= 0
 * their real parts are sums of what is positive. */
struct br_stage_system {
    double coupling[BR_STAGES]; /* X's entries, k > 0: [k][k - 1], and - [k - 1][k] */
    double first, last;         /* and on its diagonal, which is 0 between them */
    double b;
    size_t width;  /* modes, a multiple of BR_STAGE_LANES */
    double *a;     /* width */
    double *pivot; /* 2 x BR_STAGES x width: of 1 / (p + q theta') = P + Q theta, all P, then Q */
};
enum { BR_STAGE_LANES = 8 };

/* x (BR_STAGES x width): in, right-hand sides r that are zero in the rows before `first`; out,
 * X x from there on. The same bits on every instruction set. */
void br_stage_solve(const struct br_stage_system *system, size_t first, double *x);

/* Sets X and the pivots. */
void br_stage_factor(struct br_stage_system *system, const struct br_radau *radau);

/* Sum of a[i] b[i], and root of the sum of squares of weight[i] x[i] (weight NULL: of x[i]), i <
 * count. The same bits on every machine. */
double br_sum_products(size_t count, const double *a, const double *b);
double br_norm(size_t count, const double *weight, const double *x);

/* Both loops for one instruction set (combine_loops.c). */
struct br_combiner {
    void (*combine)(size_t rows, size_t count, const double *factor, size_t width,
                    const double *table, double *out);
    void (*solve)(const struct br_stage_system *system, size_t first, double *x);
};
#define BR_COMBINER_DECLARE(set) extern const struct br_combiner br_combiner_##set;
BR_INSTRUCTION_SETS(BR_COMBINER_DECLARE)

/* In the order of instruction_set.h. */
extern const struct br_combiner *const br_combiners[];

#endif
