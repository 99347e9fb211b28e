/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How finely a scene is cut: elements of its length, steps of its duration. */
#ifndef BR_STUDY_SCENE_RESOLUTION_H
#define BR_STUDY_SCENE_RESOLUTION_H

#include "base/status.h"
#include "orders/axis.h"

struct br_scene;

/* Steps of size k that make up the scene's duration. Refuses k that does not
 * divide it (BR_BAD_INPUT) with the nearest that do. */
enum br_status br_steps_of(const struct br_scene *scene, double k, size_t *steps,
                           struct br_error *err);

/* Sorts meshes or numbers of steps, the least first. */
void br_sort_counts(size_t *counts, size_t count);

/* k = T/steps, s, and h = L/n, m. For 0 steps or elements, as an exact reference has, 0. */
double br_time_step(const struct br_scene *scene, size_t steps);
double br_mesh_size(const struct br_scene *scene, size_t n);

#endif
