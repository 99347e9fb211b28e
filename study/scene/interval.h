/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Interval arithmetic: each operation of tree.h over all numbers of its arguments, rounded outward
 * so that it encloses what exact arithmetic gives and what evaluation gives (elementary.h), both.
 * No number ("none", NaN at both ends) is where the operation may have no value or a pole; an end
 * may be infinite where it may overflow. All of it needs rounding to nearest. */
#ifndef BR_STUDY_SCENE_INTERVAL_H
#define BR_STUDY_SCENE_INTERVAL_H

#include "study/scene/tree.h"

static inline struct br_interval br_point(double a)
{
    return (struct br_interval){a, a};
}

extern const struct br_interval br_no_interval;

bool br_is_none(struct br_interval a);
bool br_is_finite(struct br_interval a); /* both ends, and not none */
bool br_is_point(struct br_interval a);
bool br_has_zero(struct br_interval a);
double br_magnitude(struct br_interval a); /* the largest |a| */

/* The neighbouring number below and above; of the infinite ones the largest finite one. */
double br_next_down(double a);
double br_next_up(double a);

struct br_interval br_interval_add(struct br_interval a, struct br_interval b);
struct br_interval br_interval_subtract(struct br_interval a, struct br_interval b);
struct br_interval br_interval_multiply(struct br_interval a, struct br_interval b);
struct br_interval br_interval_divide(struct br_interval a, struct br_interval b);
struct br_interval br_interval_square(struct br_interval a);
struct br_interval br_interval_hull(struct br_interval a, struct br_interval b);

/* Any operation; `same`: its first and second argument are equal, not only their intervals. */
struct br_interval br_interval_apply(enum br_operation operation,
                                     const struct br_interval *argument, bool same);

#endif
