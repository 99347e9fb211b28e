/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers as engineers have them, and what the scene makes of them: stiffnesses of a material and a
 * cross-section, viscosities of a damping, the friction bound of a ratio. Formulas and where they
 * come from: docs/scenes.md. */
#ifndef BR_STUDY_SCENE_ENGINEERING_H
#define BR_STUDY_SCENE_ENGINEERING_H

#include "study/scene/value.h"

/* Makes what a file has not given itself; scene->derived says what and of what. Fails with
 * BR_BAD_INPUT where something is given twice, once by what makes it, where a number that makes
 * others has nothing to make, and where a number is missing. */
enum br_status br_scene_derive(const struct br_scene_reader *r);

#endif
