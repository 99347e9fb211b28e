/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The same scene in other units: what is measured must not depend on them. */
#ifndef BR_STUDY_SCENE_RESCALE_H
#define BR_STUDY_SCENE_RESCALE_H

#include "solver/scene.h"

/* How many new units an old one is: 1 m = `metre` of the new units of length. */
struct br_units_change {
    double metre, second, kilogram;
};

/* *out (to be cleared, even after a failure) is the scene in the new units; manufactured solutions
 * and the list of derived numbers are forgotten, what was derived stays. Fails with BR_NO_MEMORY,
 * with BR_BAD_INPUT where a number overflows, or a positive one underflows, and with BR_UNSUPPORTED
 * where a function is no expression, as forces that a contact's solution needs. */
enum br_status br_rescale(const struct br_scene *scene, const struct br_units_change *units,
                          struct br_scene *out, struct br_error *err);

/* The same scene with each number and function, and the x and t that the function takes, changed by
 * a relative `size` at most, at random (seed), L and T excepted. */
enum br_status br_perturb(const struct br_scene *scene, double size, unsigned long long seed,
                          struct br_scene *out, struct br_error *err);

#endif
