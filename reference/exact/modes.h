/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Modes of a clamped-free rod or beam of unit length, by a spectral Galerkin
 * method on elements.
 *
 * Trial functions are the degree-fold integrals (from the clamp) of the elements'
 * orthonormal polynomials, m of them in all; degree 1 gives the rod's space E, 2 the
 * beam's space V, and the elastic energy is the identity. With B the matrix that integrates, the
 * singular value decomposition B = Y diag(s) U' gives modes that are orthogonal
 * in the mass and in the energy: mode i is s_i times the unit function with the
 * coefficients Y_i, and its derivative of order `degree` has the coefficients U_i. */
#ifndef BR_REFERENCE_EXACT_MODES_H
#define BR_REFERENCE_EXACT_MODES_H

#include <stddef.h>

#include "reference/exact/quadrature.h"

struct br_modes {
    struct br_pieces pieces;
    size_t count;     /* m, the pieces' terms */
    size_t degree;    /* 1: axial, 2: bending */
    double *size;     /* s, m: L2 norm of each mode */
    double *shape;    /* Y, br_modes_length(0) x m, by columns */
    double *function; /* B U = Y s, the same size: each mode, as integrated from the clamp */
    double *curve;    /* U, m x m, by columns */
    double *tip;      /* m: value of each mode at the free end */
    double *slope;    /* m: derivative of each there; degree 2 only, else zeros */

    struct br_quadrature quadrature; /* of functions that are tested with shapes */
    double *series;                  /* br_modes_length(0): coefficients of the last one */
};

/* Modes on a copy of the elements. Fails with BR_NO_MEMORY or BR_SINGULAR. */
enum br_status br_modes_create(struct br_modes **out, const struct br_pieces *pieces, size_t degree,
                               struct br_error *err);
void br_modes_free(struct br_modes *modes);

/* Number of Legendre coefficients of a sum of modes derived `order` times,
 * order <= degree. */
size_t br_modes_length(const struct br_modes *modes, size_t order);

/* c (out, br_modes_length) = Legendre coefficients of the order-th derivative of
 * sum_i q_i mode_i in x / L, order <= degree. */
void br_modes_expand(const struct br_modes *modes, size_t order, const double *q, double *c);

/* out[i] = integral of f(x, t) mode_i(x) over x / L in [0, 1]; fronts as in quadrature.h. For one
 * thread at a time. Fails with BR_NO_MEMORY. */
enum br_status br_modes_load(struct br_modes *modes, const struct br_function *f, double t,
                             struct br_places fronts, double *out, struct br_error *err);

/* q (out) = L2 projection of f(x, 0) on the modes. */
enum br_status br_modes_project(struct br_modes *modes, const struct br_function *f, double *q,
                                struct br_error *err);

/* q (out) = energy projection of the displacement whose derivative of order
 * degree - 1 with respect to x / L is scale * f(x, 0). */
enum br_status br_modes_project_energy(struct br_modes *modes, const struct br_function *f,
                                       double scale, double *q, struct br_error *err);

#endif
