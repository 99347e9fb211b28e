/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A study without a reference: each cell against the same scheme on the next finer mesh,
 * and with the next smaller time step (Richardson 1911; Roache 1998). The differences
 * of successive grids tell the orders as errors do, and owe nothing to any judge. */
#ifndef BR_STUDY_GRID_DIFFERENCES_H
#define BR_STUDY_GRID_DIFFERENCES_H

#include "study/fit/fit.h"
#include "study/grid/observer.h"

/* The differences of one grid in one norm: studies whose cells are compared with their
 * next finer neighbours, `against`. */
struct br_differences {
    struct br_study over_h; /* n_count - 1 by k_count cells */
    struct br_study over_k; /* n_count by k_count - 1 cells */
};

/* Marches a grid (the first of a chain of norms; scene, norm, method, and lists n and steps,
 * ascending) and measures its differences into out[0 .. norms); `tips` gets the tips of
 * all its cells. Fails with BR_BAD_INPUT where there are less than two meshes or two time
 * steps, or one does not nest in the next, or as br_study_run does. */
enum br_status br_differences_run(const struct br_study *grid, struct br_differences *out,
                                  struct br_tips *tips, int threads,
                                  const struct br_observer *observer, struct br_error *err);

#endif
