/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a given solution must fulfil before data are derived from it. */
#ifndef BR_REFERENCE_MMS_CHECK_H
#define BR_REFERENCE_MMS_CHECK_H

#include "solver/field.h"

/* One field's solution on [0, length] x [0, duration]. */
struct br_solution {
    const struct br_function *function; /* u(x, t) or w(x, t), m; borrowed */
    enum br_field_kind kind;
    double length, duration; /* m, s */
};

/* The derivatives that the equations (3), (4), (8), (9), (11) use, of either field. */
const struct br_partial *br_solution_orders(enum br_field_kind kind, size_t *count);

/* Refuses (BR_BAD_INPUT), naming the derivative, x, t, what was found and expected:
 * - a solution or derivative of which it is not proved that it is finite everywhere;
 * - u(0, t), w(0, t) or w_x(0, t) that is not zero;
 * - a jump in what is derived, whose delta the derivative would leave out: at what the guards of
 *   function.h tell, on lines that cross every stretch between them.
 * Fails with BR_NO_MEMORY, too. */
enum br_status br_solution_check(const struct br_solution *solution, struct br_error *err);

/* Refuses (BR_BAD_INPUT) a stick force beyond the friction bound at a time at which the tip
 * rests. u, velocity: u(L, t), m, and w_t(L, t), m/s. */
enum br_status br_stick_check(const struct br_scene *scene, const struct br_function *u,
                              const struct br_function *velocity, struct br_error *err);

#endif
