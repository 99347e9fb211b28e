/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The same scene in other units: results must not depend on the units. */
#ifndef BR_TESTS_RESCALE_H
#define BR_TESTS_RESCALE_H

#include "solver/scene.h"

/* Old units in new ones: 1 m is `metre` new units of length. */
struct br_units_change {
    double metre, second, kilogram;
};

/* *out (to be cleared, even after a failure): the scene in the new units, without manufactured
 * solutions and the list of derived numbers; the numbers themselves stay. Fails with BR_NO_MEMORY,
 * with BR_BAD_INPUT if a number overflows or a positive one underflows, and with BR_UNSUPPORTED if
 * a function is not an expression, as the forces of a manufactured contact. */
enum br_status br_rescale(const struct br_scene *scene, const struct br_units_change *units,
                          struct br_scene *out, struct br_error *err);

#endif
