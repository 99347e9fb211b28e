/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each cell against the same scheme on the next finer mesh, or with the next smaller time step
 * (Richardson 1911; Roache 1998). Such differences have the orders of the errors, and need no
 * reference. */
#ifndef BR_STUDY_GRID_DIFFERENCES_H
#define BR_STUDY_GRID_DIFFERENCES_H

#include "base/observer.h"
#include "study/grid/study.h"

/* Marches a grid (the first of a chain of norms; scene, norm, method, and lists n and steps,
 * ascending) and measures its differences along an axis into out[0 .. norms): studies with one mesh
 * or one time step less, whose cells are compared with their next finer neighbours, `against`.
 * Fails with BR_BAD_INPUT where there is no neighbour, or as br_study_run does. */
enum br_status br_differences_run(const struct br_study *grid, enum br_axis axis,
                                  struct br_study *out, int threads,
                                  const struct br_observer *observer, struct br_error *err);

#endif
