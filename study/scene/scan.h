/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether an expression of a scene is a number everywhere. */
#ifndef BR_STUDY_SCENE_SCAN_H
#define BR_STUDY_SCENE_SCAN_H

#include "study/scene/schema.h"

/* Whether the function of a key (an initial one, a history or a load) is proved to be finite
 * everywhere in [0, L] and [0, T] (solver/proof.h). Fails with BR_BAD_INPUT, naming value, x and t,
 * also where that cannot be proved; BR_OK for other keys. */
enum br_status br_scene_scan(const struct br_scene *scene, const struct br_scene_key *key,
                             struct br_error *err);

#endif
