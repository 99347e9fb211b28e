/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One order from a line of errors, refined in one quantity z (h/L or k/T):
 *     e = C |z^p - z_against^p|.
 * Any p can come out, also one that is zero or negative: errors that stall or grow. */
#ifndef BR_STUDY_FIT_ORDER_FIT_H
#define BR_STUDY_FIT_ORDER_FIT_H

#include "study/fit/fit.h"

struct br_order_point {
    double z, z_against; /* z_against < z: of what it was compared with; 0: the solution itself */
    double error;
};

/* Fits p to the logarithms by least squares. Its 95 % interval is the wider one of two: that of the
 * regression, which takes what is left over for noise, and that of leaving out one point after the
 * other (jackknife, Efron 1982), which sees a drift. NaN with less than 3 points, or where an error
 * is not > 0. Fails with BR_NO_MEMORY. */
enum br_status br_order_fit(const struct br_order_point *point, size_t count,
                            struct br_estimate *order, struct br_error *err);

#endif
