/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The two loops that take most of the exact reference's time, for each instruction set: sums of
 * rows of a table, and the stages' equations of all modes. */
#ifndef BR_REFERENCE_EXACT_COMBINE_H
#define BR_REFERENCE_EXACT_COMBINE_H

#include <stdbool.h>
#include <stddef.h>

#include "reference/exact/legendre.h"

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

/* Both loops for one instruction set. */
struct br_combiner {
    bool (*available)(void);
    void (*combine)(size_t rows, size_t count, const double *factor, size_t width,
                    const double *table, double *out);
    void (*solve)(const struct br_stage_system *system, size_t first, double *x);
};

/* The fastest first; the last one runs anywhere, and ends the list. The first that is available is
 * taken. */
extern const struct br_combiner br_combiners[];
extern const size_t br_combiner_count;

#endif
