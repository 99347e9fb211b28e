/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The fully discrete problem once more, in quadruple precision and in the assembled form, with no
 * line of the solver: what a march of any linear solver, scheme and degree is compared with. It
 * follows a march stage by stage, with the weights of its scheme and loads, contact and friction of
 * its own, and starts anew where the march does. The stiffness form loses some 1e17 times the unit
 * round-off at n = 12800: that leaves 17 digits. */
#ifndef BR_TESTS_DENSE_MARCH_H
#define BR_TESTS_DENSE_MARCH_H

#include "solver/march.h"

struct dense_march;

/* Follows a march that has taken no step, with laws that do not iterate; until it is freed nobody
 * else may watch the march. NULL where the compiler has no quadruple precision. */
struct dense_march *dense_follow(struct br_march *march, const struct br_scene *scene,
                                 const struct br_method *method);
void dense_free(struct dense_march *dense); /* accepts NULL */

/* Largest deviation of the march's nodal displacements (derivative 0) or velocities (1) from those,
 * now, relative to the largest of them so far; NaN counts as infinite. */
double dense_deviation(struct dense_march *dense, enum br_field_kind kind, int derivative);

/* Displacement of one field at a node, node 0 being clamped, m. */
long double dense_displacement(const struct dense_march *dense, enum br_field_kind kind,
                               size_t node);

#endif
