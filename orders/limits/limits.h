/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The limit of a quantity on finer and finer grids, without a reference: on a line it is one more
 * unknown of the mixture of laws that finds the order (line_order.h), so that order, limit, rows
 * and words do not contradict each other; and on a grid of h and k. The grid convergence index of
 * three values stands beside it. Values may be means over several runs; then differences that such
 * a scatter makes are no convergence and no divergence. NaN: not known. */
#ifndef BR_ORDERS_LIMITS_LIMITS_H
#define BR_ORDERS_LIMITS_LIMITS_H

#include "orders/limits/grid_convergence.h"

struct br_grid_limit {
    struct br_estimate value; /* NaN: there is none, or too little is known */
    double order;             /* p */
    enum br_sequence sequence;
};

/* The limit with its interval; NaN unless the differences converge, by an order above 0.1, with a
 * probability of 90 %. The limit of a constant sequence is its value, to a unit of its last digit
 * where it was printed. The sequence is BR_SEQUENCE_SCATTER, and its limit the finest value with
 * its own interval, where one constant agrees with all values (chi square, 99 %), or with the
 * finest three of values that do not converge monotonely.
 *
 * value[count]: from coarse to fine, as in grid_convergence.h; count >= 3. Fails with
 * BR_NO_MEMORY. */
enum br_status br_limit_of_values(const struct br_point *value, size_t count,
                                  struct br_grid_limit *limit, struct br_error *err);

/* All that a line of values shows. */
struct br_limits {
    struct br_grid_limit limit;
    struct br_gci gci;     /* of the three finest */
    struct br_gci *triple; /* of each three neighbours, from coarse to fine; owned */
    size_t triples;
};

/* Of less than three values nothing is known. Clear the limits even after a failure. Fails with
 * BR_NO_MEMORY. */
enum br_status br_limits_find(const struct br_point *value, size_t count, struct br_limits *limits,
                              struct br_error *err);
void br_limits_clear(struct br_limits *limits);

/* A value of a grid is L + f(h) + g(k), and small products of both. For each axis: the limit of the
 * line that ends at the value, and that of the line at the next size of the other axis, with the
 * value where that ends. */
struct br_limit_along {
    struct br_grid_limit limit, next;
    double next_value;
};
struct br_grid_limit br_limit_of_grid(double value, const struct br_limit_along along[BR_AXES]);

#endif
