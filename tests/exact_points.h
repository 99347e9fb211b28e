/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exact solution point by point; the program samples its projections alone. */
#ifndef BR_TESTS_EXACT_POINTS_H
#define BR_TESTS_EXACT_POINTS_H

#include "reference/exact/exact.h"

/* value[i] (out) = quantity at x[i] in [0, L], i < count; m or m/s per m^order, order: axial up to
 * 2, bending up to 3. Fails with BR_NO_MEMORY. */
enum br_status exact_points(const struct br_exact *exact, const struct br_exact_state *state,
                            const struct br_exact_quantity *quantity, size_t count, const double *x,
                            double *value, struct br_error *err);

#endif
