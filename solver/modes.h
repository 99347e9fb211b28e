/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What errors are measured in, and a finite element function in Legendre polynomials
 * that are orthonormal on each element, its modes: the squared L2 norm is the sum of the
 * squared modes. */
#ifndef BR_SOLVER_MODES_H
#define BR_SOLVER_MODES_H

#include <stdbool.h>
#include <stddef.h>

#include "solver/kind.h"

struct br_field;

enum br_measure {
    BR_DISPLACEMENT, /* u or w in L2 */
    BR_VELOCITY,     /* u_t or w_t in L2 */
    BR_STRAIN_RATE,  /* u_xt or w_xxt in L2, which the energy is made of */
    BR_TIP,          /* u or w at x = L: one number, no modes */
    BR_MEASURES
};

/* A field's elements. */
struct br_elements {
    enum br_field_kind kind;
    int degree; /* of axial ones, as in struct br_field */
};

/* Modes an element: of a polynomial of its degree (3 for bending), or of its derivative. */
size_t br_mode_count(struct br_elements elements, enum br_measure measure);

/* Number of values of a measure on a mesh of n elements: all modes or the nodal values, or 1 for
 * the tip. */
size_t br_measure_size(struct br_elements elements, enum br_measure measure, size_t n);

enum { BR_MOST_MODES = 4, BR_MOST_LANES = 8 };

/* How modes follow from values. */
enum br_layout {
    /* value[e * modes + i] * scale[i] is mode i of element e */
    BR_BY_ELEMENT,
    /* Nodal values as in solver/field.h. Two modes, u: scale times (u0 + u1, u1 - u0). Three,
     * (u, b): scale times (u0 + u1 - b/3, u1 - u0, b). Four modes, (w, s): scale times (W - C/6, D
     * - S/12, C, S - 2 D) with W = w0 + w1, D = w1 - w0, S = s0 + s1, C = s1 - s0. */
    BR_BY_NODE,
    /* Some elements side by side, for vectors: mode i of element e is
     * value[(e / lanes * modes + i) * lanes + e % lanes]; after the last element come zeros. */
    BR_IN_LANES,
};

/* A function on a mesh in one of these layouts. */
struct br_view {
    enum br_layout layout;
    size_t modes;                /* modes an element: 1 to 4; 0 for the tip's one value */
    double scale[BR_MOST_MODES]; /* 1 in lanes */
    double rest;    /* the squared L2 norm of the part of the function that is not in the modes */
    double *values; /* room for br_measure_size of them */
};

/* The view (out, except its values) of a measure of a field in a march: displacements and
 * velocities by node; strain rates by element as br_field_solver's strain_rate gives them, m/s. */
void br_view_field(struct br_view *view, const struct br_field *field, enum br_measure measure);

/* The view (out, except its values) of modes by element, with scales of 1. */
void br_view_modes(struct br_view *view, size_t modes);

#endif
