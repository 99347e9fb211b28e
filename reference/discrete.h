/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exact discrete solution: the same equations (27), (28) with the same elements, laws and time
 * scheme as a march of solver/, in long double and in a form that loses no digits on fine meshes.
 * The difference between a march and this solution is the march's round-off.
 *
 * It uses the recursions of `plain` (solver/linear/recursion.c) in long double and the schemes of
 * textbook.h; loads, quadrature and laws are its own. So it measures only round-off. Whether the
 * equations are right is checked by judges that share nothing with the solver. The data are the
 * doubles that the scene's functions give at the time levels t_n = n T/N, at the nodes and at the
 * five Gauss points of each element; they are part of the discrete problem.
 *
 * Its error is 2e-15 against quadruple precision up to n = 100,000, and 1e-14 for n = 1,000,000. It
 * cannot be used where long double has no more digits than double. */
#ifndef BR_REFERENCE_DISCRETE_H
#define BR_REFERENCE_DISCRETE_H

#include "solver/march.h"

struct br_discrete;

/* Creates the solution at t = 0. Of the method it uses the names of scheme, contact and friction
 * rule. The scene must outlive it. Fails with BR_BAD_INPUT where a rule or the scheme is not known
 * here; BR_SINGULAR, BR_NOT_FINITE, BR_NO_MEMORY; *discrete is then NULL. */
enum br_status br_discrete_create(struct br_discrete **discrete, const struct br_scene *scene,
                                  size_t n, size_t steps, const struct br_method *method,
                                  struct br_error *err);
void br_discrete_free(struct br_discrete *discrete); /* accepts NULL */

/* One step. Fails with BR_NOT_FINITE, BR_SINGULAR; the state is then lost. */
enum br_status br_discrete_step(struct br_discrete *discrete, struct br_error *err);

/* Nodal values, laid out as in solver/field.h, m and m/s (out; either may be NULL): zero where the
 * field is not modelled. */
void br_discrete_get(const struct br_discrete *discrete, enum br_field_kind kind,
                     long double *displacement, long double *velocity);

/* Whether long double has more digits than double, so that anything can be judged. */
bool br_discrete_judges(void);

#endif
