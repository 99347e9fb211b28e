/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Schemes that need damping: how much, for the vibration that a mesh has at a step. */
#ifndef BR_SOLVER_DAMPING_H
#define BR_SOLVER_DAMPING_H

#include "solver/method.h"

/* The largest step, s, with which a scheme that needs damping lets no mode of a field grow:
 * INFINITY where any will do. spring: whether an undamped spring at the tip, the contact, may take
 * its part of a mode. */
double br_damping_largest_step(const struct br_field *field, bool spring);

/* Refuses (BR_BAD_INPUT) a march of a scheme that needs damping on n elements with a step of k, s,
 * where a mode would grow. */
enum br_status br_damping_check(const struct br_method *method, const struct br_scene *scene,
                                size_t n, double k, struct br_error *err);

#endif
