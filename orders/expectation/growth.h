/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BR_ORDERS_EXPECTATION_GROWTH_H
#define BR_ORDERS_EXPECTATION_GROWTH_H

#include "orders/expectation/case.h"

/* Where the errors begin to grow, by one law over all of them; NULL: they do not grow so. */
const struct br_point *br_turning_point(const struct br_case *c);

#endif
