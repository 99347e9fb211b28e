/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A given solution, from which a scene is manufactured (study/scene/manufactured.c): its checks,
 * and its reference. */
#ifndef BR_REFERENCE_MMS_MMS_H
#define BR_REFERENCE_MMS_MMS_H

#include "base/status.h"
#include "solver/kind.h"

struct br_function;
struct br_scene;

/* ---- the given solution ---- */

/* One field's solution on [0, length] x [0, duration]. */
struct br_given {
    const struct br_function *function; /* u(x, t) or w(x, t), m; borrowed */
    enum br_field_kind kind;
    double length, duration; /* m, s */
};

/* Refuses (BR_BAD_INPUT), naming the derivative, x, t, what was found and expected:
 * - a solution or derivative of which it is not proved that it is finite everywhere;
 * - u(0, t), w(0, t) or w_x(0, t) that is not zero;
 * - a jump in what is derived, since the derivative would leave out its delta. The switching
 * functions of function.h give the points; lines through every interval between them are checked.
 * Fails with BR_NO_MEMORY, too. */
enum br_status br_given_check(const struct br_given *solution, struct br_error *err);

/* Refuses (BR_BAD_INPUT) a stick force beyond the friction bound at a time at which the tip
 * rests. u, velocity: u(L, t), m, and w_t(L, t), m/s. */
enum br_status br_stick_check(const struct br_scene *scene, const struct br_function *u,
                              const struct br_function *velocity, struct br_error *err);

#endif
