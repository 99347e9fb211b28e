/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The engine of br_study_run: reference and cells in lockstep, as tasks. */
#ifndef BR_STUDY_GRID_LOCKSTEP_H
#define BR_STUDY_GRID_LOCKSTEP_H

#include "study/grid/observer.h"
#include "study/grid/study.h"

/* Marches prepared studies (cells allocated, grids known to nest) that have not failed already; see
 * br_study_run_each. */
enum br_status br_lockstep(struct br_study *studies, size_t count, int threads,
                           const struct br_observer *observer, struct br_error *err);

#endif
