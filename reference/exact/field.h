/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One field of the beam, axial or bending, as independent damped oscillators
 *     mass_i q_i'' + damping q_i' + stiffness q_i = load_i(t) - tip_i force,
 * held together only by the force at the tip: equations (3), (4), (8), (9), (11). */
#ifndef BR_REFERENCE_EXACT_FIELD_H
#define BR_REFERENCE_EXACT_FIELD_H

#include "reference/exact/outline.h"
#include "reference/exact/pieces.h"

/* Modes of a clamped-free rod or beam of unit length, by a spectral Galerkin
 * method on elements.
 *
 * Trial functions are the degree-fold integrals (from the clamp) of the elements'
 * orthonormal polynomials, m of them in all; degree 1 gives the rod's space E, 2 the
 * beam's space V, and the elastic energy is the identity. With B the matrix that integrates, the
 * singular value decomposition B = Y diag(s) U' gives modes that are orthogonal
 * in the mass and in the energy: mode i is s_i times the unit function with the
 * coefficients Y_i, and its derivative of order `degree` has the coefficients U_i. */
struct br_modes {
    struct br_pieces pieces;
    size_t count;     /* m, the pieces' terms */
    size_t width;     /* m, and zeros up to a multiple of BR_STAGE_LANES */
    size_t degree;    /* 1: axial, 2: bending */
    double *size;     /* s, width: L2 norm of each mode */
    double *shape;    /* Y, br_modes_length(0) x m, by columns */
    double *function; /* B U = Y s, br_modes_length(0) x width, by rows: modes integrated from the
                         clamp */
    double *curve;    /* U, m x m, by columns */
    double *tip;      /* width: value of each mode at the free end */
    double *slope;    /* width: derivative of each there; degree 2 only, else zeros */

    struct br_quadrature quadrature; /* of functions that are tested with shapes */
};

/* modes: in, with its pieces, all else zero. Fails with BR_NO_MEMORY or BR_SINGULAR. */
enum br_status br_modes_init(struct br_modes *modes, size_t degree, struct br_store *store,
                             struct br_error *err);

/* Number of Legendre coefficients of a sum of modes derived `order` times,
 * order <= degree. */
size_t br_modes_length(const struct br_modes *modes, size_t order);

/* c (out, br_modes_length) = Legendre coefficients of the order-th derivative of
 * sum_i q_i mode_i in x / L, order <= degree. */
void br_modes_expand(const struct br_modes *modes, size_t order, const double *q, double *c);

/* ---- the field ---- */

struct br_oscillators {
    struct br_modes modes;
    double length;             /* L, m */
    double *mass;              /* width, kg; behind the modes 1 */
    double damping, stiffness; /* N s/m, N/m */
    struct br_exact_data data; /* borrowed */
    bool fronts;               /* places where the load jumps move */
    double *load_space;        /* BR_LOAD_TERMS x width: of the terms whose space part is constant
                                  in time */
    double *load_series;       /* BR_STAGES x br_modes_length(0), workspace for one that is not */
    double *load_sum;          /* BR_STAGES x width, likewise */
    double *displacement;      /* modes: at t = 0, m */
    double *velocity;          /* modes: at t = 0, m/s */
    double tip_displacement, tip_velocity; /* at t = 0, m, m/s */
};

/* *out (owned by the store). The scene (borrowed, with its functions) must model the field. On the
 * outline's elements, of as many polynomials as it has for `modes`. Fails with BR_NO_MEMORY or
 * BR_SINGULAR. */
enum br_status br_oscillators_create(struct br_oscillators **out, const struct br_scene *scene,
                                     const struct br_outline *outline, size_t modes,
                                     struct br_store *store, struct br_error *err);

/* out (BR_STAGES x width): load_i(t) at each t, N. *size: out, of loads that no product gives, N:
 * what a mode of size 1 gets of them may be wrong by round-off of that at any t. Fails with
 * BR_NO_MEMORY, or BR_BAD_INPUT: too many fronts. */
enum br_status br_oscillators_load(const struct br_oscillators *field, const double t[BR_STAGES],
                                   double *out, double *size, struct br_error *err);

/* What a step costs in the units of br_effort: its modes, and loads that no product gives. */
double br_oscillators_work(const struct br_oscillators *field);

/* L2 norm over the beam of sum_i q_i mode_i. */
double br_oscillators_norm(const struct br_oscillators *field, const double *q);

#endif
