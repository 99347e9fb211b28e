/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The fully discrete problem once more, in quadruple precision and in the assembled form, for
 * meshes so small that its condition does not matter: what a march of any linear solver is compared
 * with. It follows a march stage by stage, with the weights of its scheme and loads, contact and
 * friction of its own, and starts anew where the march does. */
#ifndef BR_TESTS_QUAD_MARCH_H
#define BR_TESTS_QUAD_MARCH_H

#include "solver/march.h"

struct br_quad_march;

/* Follows a march that has taken no step, from rest, of a scene with loads of space constant and
 * laws that do not iterate; until it is freed nobody else may watch the march. NULL where the
 * compiler has no quadruple precision. */
struct br_quad_march *br_quad_follow(struct br_march *march, const struct br_scene *scene,
                                     const struct br_method *method, size_t steps);
void br_quad_free(struct br_quad_march *quad); /* accepts NULL */

/* Largest deviation of the march's nodal displacements (0) or velocities (1) from those, now,
 * relative to the largest of them so far; NaN counts as infinite. */
double br_quad_deviation(struct br_quad_march *quad, enum br_field_kind kind, int derivative);

/* The largest so far, m or m/s. */
double br_quad_largest(const struct br_quad_march *quad, enum br_field_kind kind, int derivative);

#endif
