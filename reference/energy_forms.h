/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Squares of nodal values, for energy.c and energy_meter.c alone. */
#ifndef BR_ENERGY_FORMS_H
#define BR_ENERGY_FORMS_H

#include "reference/energy.h"

typedef long double real;

/* |a - b|_M^2 and |a - b|^2 of the stiffness without its coefficient; b NULL: of a. */
real br_mass_square(const struct br_field *field, const double *a, const double *b);
real br_bend_square(const struct br_field *field, const double *a, const double *b);

#endif
