/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scenes of energy_behaviour.c: bundled ones, and what is changed in them. */
#ifndef BR_STUDY_EXTREMES_BALANCE_SCENES_H
#define BR_STUDY_EXTREMES_BALANCE_SCENES_H

#include "solver/march.h"

/* Scene i of br_balance_scenes (out) and the contact rule by name, NULL: the scheme's own. The
 * caller clears the scene. Fails as br_scene_read. */
enum br_status br_balance_scene(size_t i, struct br_scene *scene, const char **contact,
                                struct br_error *err);

/* Whether its contact is lagged, which few schemes take. */
bool br_balance_scene_lags(size_t i);

#endif
