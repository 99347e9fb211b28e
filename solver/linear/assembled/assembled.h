/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The usual way: the assembled stiffness form of (27) and (28),
 *     A v_n = F_n + M v_{n-1}/k - K w_{n-1},    A = M/k + C + kK,
 * factorised once by a library and solved once a step. The libraries differ in the factorisation
 * alone: each is a br_factoriser, which its row of the registry names.
 * A's condition number grows like h^-4 for bending: see each solver's round_off. */
#ifndef BR_SOLVER_ASSEMBLED_H
#define BR_SOLVER_ASSEMBLED_H

#include "solver/linear/linear_solver.h"

/* A without the clamped node: its lower band by columns. Entry (i, j), 0 <= i - j <= band, is
 * value[j * (band + 1) + i - j]; entries below the last row are zero. */
struct br_band {
    size_t order; /* unknowns a node times n */
    size_t band;  /* below the diagonal: 1 axial, 3 bending */
    double *value;
};

/* The whole band, with its zeros, of the lower triangle or of both, by compressed columns: the
 * pattern, which is the same for all values, and the values (out). */
void br_band_pattern(const struct br_band *a, bool both, int *column, int *row);
void br_band_values(const struct br_band *a, bool both, double *value);

/* How a library factorises and solves. */
struct br_factoriser {
    const char *name;
    bool refines; /* applies the option `refinement` by itself; else the assembled form does */

    /* Creates all that does not depend on A's values. Fails with BR_BAD_INPUT (an option),
     * BR_NO_MEMORY, BR_SINGULAR; free *factor even then. */
    enum br_status (*create)(const struct br_band *a, const struct br_linear_options *options,
                             void **factor, struct br_error *err);
    void (*free)(void *factor); /* accepts NULL */

    /* Factorises A, whose values are finite, and replaces the factors before. Fails with
     * BR_SINGULAR where it finds that A is not positive definite, BR_NO_MEMORY. */
    enum br_status (*factorise)(void *factor, const struct br_band *a, struct br_error *err);

    /* x = A^-1 rhs; rhs: in, x: out, `order` values each, which do not overlap. Fails with
     * BR_SINGULAR, BR_NO_MEMORY. */
    enum br_status (*solve)(void *factor, const double *rhs, double *x, struct br_error *err);
};

/* The functions of a br_field_solver, for both fields: `create` takes the row's factoriser. */
extern const struct br_field_solver br_assembled;

/* For a row: the usual loss of a march by its solves, relative to the largest displacement, and the
 * residual of elimination without refinement, by measurements. */
double br_assembled_round_off(const struct br_linear_solver *row, const struct br_field *field,
                              const struct br_linear_options *options);
double br_assembled_residual(const struct br_linear_solver *row, const struct br_field *field,
                             const struct br_linear_options *options);

#endif
