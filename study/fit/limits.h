/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The limit of a quantity on finer and finer grids, without a reference: on a line, by the
 * procedures of grid_convergence.h, and on a grid of h and k. Values may be means over several
 * runs; then differences that such a scatter makes are no convergence and no divergence.
 *
 * Arrays as in grid_convergence.h. NaN: not known. */
#ifndef BR_STUDY_FIT_LIMITS_H
#define BR_STUDY_FIT_LIMITS_H

#include "study/fit/grid_convergence.h"

enum br_limit_method { BR_LIMIT_GCI, BR_LIMIT_LEAST_SQUARES };

struct br_grid_limit {
    struct br_estimate value; /* low, high: the finest value -+ its uncertainty, so they are not
                                 symmetric to the limit */
    double order;             /* p */
    enum br_limit_method method;
    enum br_sequence sequence;
};

/* The limit with its interval: by least squares for four grids or more, and at least as wide as the
 * least order that the differences leave open makes it; by the grid convergence index for three.
 * NaN for divergence, and where a single difference is zero. The limit of a constant sequence is
 * its value, without an interval: the procedures do not apply.
 *
 * half[count]: half widths of the 95 % intervals of values that are means; NULL: they are none. The
 * interval is wider by that of the finest value. The sequence is BR_SEQUENCE_SCATTER, and its limit
 * the finest value with that interval, where one constant agrees with all values (chi square, 95
 * %), or with the finest three of values that do not converge monotonely.
 *
 * count >= 3; formal as in br_least_squares. Fails with BR_NO_MEMORY. The interval is
 * an estimate, not a bound. For random cubics in h, it contained the limit in 99 to 100 % at h =
 * 0.01, where the linear term dominates; at h = 0.1, where it does not, in 98 to 99 % of four grids
 * or more, in 81 % of three. */
enum br_status br_limit_of_values(const double *h, const double *value, const double *half,
                                  size_t count, double formal, struct br_grid_limit *limit,
                                  struct br_error *err);

/* All that a line of values shows. */
struct br_limits {
    struct br_grid_limit limit;
    struct br_grid_limit first_order; /* with the formal order 1, where none is stated */
    struct br_gci gci;                /* of the three finest */
    struct br_gci *triple;            /* of each three neighbours, from coarse to fine; owned */
    size_t triples;
};

/* formal 0: none is stated, and it is 2. Of less than three values nothing is known. Clear the
 * limits even after a failure. Fails with BR_BAD_INPUT where formal is neither 0 nor 1 to 10, or
 * with BR_NO_MEMORY. */
enum br_status br_limits_find(const double *h, const double *value, const double *half,
                              size_t count, double formal, struct br_limits *limits,
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
