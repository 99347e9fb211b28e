/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes and methods in a request's words. */
#ifndef BR_STUDY_SCENE_STATEMENT_H
#define BR_STUDY_SCENE_STATEMENT_H

#include "base/statement.h"

struct br_method;
struct br_scene;

/* All lines of a scene, by the rows of br_scene_keys and by its functions; of a method, by the rows
 * of br_method_fields. */
void br_state_scene(struct br_statement *statement, const struct br_scene *scene);
void br_state_method(struct br_statement *statement, const struct br_method *method);

#endif
