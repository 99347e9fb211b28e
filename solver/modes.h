/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A finite element function in Legendre polynomials that are orthonormal on each
 * element: the squared L2 norm is the sum of the squared modes. */
#ifndef BR_MODES_H
#define BR_MODES_H

#include "solver/field.h"

/* Modes of an element: 2 axial, 4 bending. */
size_t br_mode_count(enum br_field_kind kind);

/* Modes of a finite element function (out, n * br_mode_count values) from its
 * nodal values (in, laid out as in solver/field.h). */
void br_modes(const struct br_field *field, const double *nodal, double *modes);

#endif
