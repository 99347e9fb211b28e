/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each cell against the same scheme on the next finer mesh, and with the next smaller time step
 * (Richardson 1911; Roache 1998). Such differences have the orders of the errors, and need no
 * judge. */
#ifndef BR_STUDY_GRID_DIFFERENCES_H
#define BR_STUDY_GRID_DIFFERENCES_H

#include "study/base/observer.h"
#include "study/grid/study.h"

/* The differences of one grid in one norm: studies whose cells are compared with their
 * next finer neighbours, `against`. */
struct br_differences {
    struct br_study over[BR_AXES]; /* n_count - 1 by k_count cells, n_count by k_count - 1 */
};

/* Marches a grid (the first of a chain of norms; scene, norm, method, and lists n and steps,
 * ascending) and measures its differences into out[0 .. norms). A grid may have
 * one mesh or one time step: there is nothing over that axis. Fails with BR_BAD_INPUT where it has
 * one of both, or one does not nest in the next, or as br_study_run does. */
enum br_status br_differences_run(const struct br_study *grid, struct br_differences *out,
                                  int threads, const struct br_observer *observer,
                                  struct br_error *err);

#endif
