/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether an expression of a scene is a number everywhere. */
#ifndef BR_SCENE_SCAN_H
#define BR_SCENE_SCAN_H

#include "study/scene_schema.h"

/* Looks at the function of a key (an initial one, a history or a load) at many equidistant places
 * of [0, L] and times of [0, T], the ends included: 1025, or 65 times 65 of both, and for poles
 * between them (pole.h). What is missed a march finds, if it meets it. Fails with BR_BAD_INPUT,
 * naming value, x and t; BR_OK for other keys. */
enum br_status br_scene_scan(const struct br_scene *scene, const struct br_scene_key *key,
                             struct br_error *err);

#endif
