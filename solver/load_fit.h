/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A load f(x, t) that is no product, as a sum of few: in each of some cells of the beam
 *     f(x, t) = sum over j of f(x_j, t) L_j(x)
 * with the Lagrange polynomials L_j of m Chebyshev points x_j. Their load vectors are assembled
 * once; a step evaluates f at the x_j alone, where the direct way has five Gauss points an element.
 *
 * On a cell of width w the error is at most |d^m f / dx^m| / m! 2 (w/4)^m. That is enclosed over
 * all times of the march by interval arithmetic (function.h): nothing is sampled. Where f is not
 * smooth, or no few cells do, there is no fit, and the direct way is taken. */
#ifndef BR_SOLVER_LOAD_FIT_H
#define BR_SOLVER_LOAD_FIT_H

#include "solver/field.h"

struct br_load_fit;

/* Fits f, N/m, on a field's mesh for t in [0, duration], s. *fit: out; NULL where f is not for it.
 * Fails with BR_NO_MEMORY. */
enum br_status br_load_fit_create(const struct br_field *field, const struct br_function *f,
                                  double duration, struct br_load_fit **fit, struct br_error *err);
void br_load_fit_free(struct br_load_fit *fit); /* accepts NULL */

/* The load vector (out, as br_assemble_load has it) of f at time t, s, to the round-off of f's
 * largest value there. False: that is not known of this t. f is the function that was fitted, or a
 * clone. */
bool br_load_fit_assemble(struct br_load_fit *fit, const struct br_function *f, double t,
                          double *vector);

#endif
