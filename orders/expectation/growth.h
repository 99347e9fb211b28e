/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BR_ORDERS_EXPECTATION_GROWTH_H
#define BR_ORDERS_EXPECTATION_GROWTH_H

#include "orders/expectation/case.h"

/* Where the errors begin to grow, by one law over all of them; NULL: they do not grow so. */
const struct br_point *br_turning_point(const struct br_case *c);

/* What one power leaves of so many coarse rows, in squares of logarithms; rows without an error are
 * left aside. */
double br_squares_of_power(const struct br_case *c, size_t rows);

#endif
