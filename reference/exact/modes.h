/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Modes of a clamped-free rod or beam of unit length, by a spectral Galerkin
 * method.
 *
 * Trial functions are the degree-fold integrals (from the clamp) of p_0 ...
 * p_{m-1}; degree 1 gives the rod's space E, 2 the beam's space V, and the
 * elastic energy is the identity. With B the matrix that integrates, the
 * singular value decomposition B = Y diag(s) U' gives modes that are orthogonal
 * in the mass and in the energy: mode i is s_i times the unit function with the
 * coefficients Y_i, and its derivative of order `degree` has the coefficients U_i. */
#ifndef BR_MODES_H
#define BR_MODES_H

#include <stddef.h>

#include "solver/scene.h"

struct br_modes {
    size_t count;  /* m */
    size_t degree; /* 1: axial, 2: bending */
    double *size;  /* s, m: L2 norm of each mode */
    double *shape; /* Y, (m + degree) x m, by columns */
    double *curve; /* U, m x m, by columns */
    double *tip;   /* m: value of each mode at the free end */
    double *slope; /* m: derivative of each there; degree 2 only, else zeros */
};

/* Fails with BR_NO_MEMORY or BR_SINGULAR. */
enum br_status br_modes_create(struct br_modes **out, size_t count, size_t degree,
                               struct br_error *err);
void br_modes_free(struct br_modes *modes);

/* Number of Legendre coefficients of a sum of modes derived `order` times,
 * order <= degree. */
size_t br_modes_length(const struct br_modes *modes, size_t order);

/* c (out, br_modes_length) = Legendre coefficients of the order-th derivative of
 * sum_i q_i mode_i, order <= degree. */
void br_modes_expand(const struct br_modes *modes, size_t order, const double *q, double *c);

/* out[i] = integral of f(x length, t) mode_i(x) over x in [0, 1]. Fails with
 * BR_NO_MEMORY. */
enum br_status br_modes_load(const struct br_modes *modes, const struct br_function *f,
                             double length, double t, double *out, struct br_error *err);

/* q (out) = L2 projection of f(x length, 0) on the modes. */
enum br_status br_modes_project(const struct br_modes *modes, const struct br_function *f,
                                double length, double *q, struct br_error *err);

/* q (out) = energy projection of the displacement whose derivative of order
 * degree - 1 with respect to x / length is scale * f(x, 0). */
enum br_status br_modes_project_energy(const struct br_modes *modes, const struct br_function *f,
                                       double length, double scale, double *q,
                                       struct br_error *err);

#endif
