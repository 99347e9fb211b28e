/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What errors are measured in, and a finite element function in Legendre polynomials
 * that are orthonormal on each element: the squared L2 norm is the sum of the squared
 * modes. */
#ifndef BR_MODES_H
#define BR_MODES_H

#include "solver/field.h"

enum br_measure {
    BR_DISPLACEMENT, /* u or w in L2 */
    BR_VELOCITY,     /* u_t or w_t in L2 */
    BR_STRAIN_RATE,  /* u_xt or w_xxt in L2, which the energy is made of */
    BR_TIP,          /* u or w at x = L: one number, no modes */
    BR_MEASURES
};

/* Modes an element: of a polynomial of degree 1 (axial) or 3 (bending), or of its
 * derivative. */
size_t br_mode_count(enum br_field_kind kind, enum br_measure measure);

/* Values that make up a measure on a mesh of n elements: all modes, or 1 for the tip. */
size_t br_measure_size(enum br_field_kind kind, enum br_measure measure, size_t n);

/* Modes of a displacement or velocity (out, n * br_mode_count values) from its nodal
 * values (in, laid out as in solver/field.h). */
void br_modes(const struct br_field *field, const double *nodal, double *modes);

/* Modes of a strain rate (out) from the elements' scaled strains (in, m/s, as
 * br_field_solver's strain_rate gives them). */
void br_strain_modes(const struct br_field *field, const double *strain, double *modes);

#endif
