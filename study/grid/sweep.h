/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Marches the cells of studies beside their references, and measures the errors. */
#ifndef BR_STUDY_GRID_SWEEP_H
#define BR_STUDY_GRID_SWEEP_H

#include "base/observer.h"
#include "study/grid/study.h"

/* Runs studies on `threads` threads (0: all cores), all at once: the reference and
 * the cells march side by side, a few time levels at a time, so that neither is
 * ever stored as a whole. The results do not depend on the number of threads.
 * A cell that fails is marked; the reference failing, or grids that do not nest,
 * fail the call (BR_BAD_INPUT names the nearest values that would do). `studies` are
 * the first ones of their chains of norms. */
enum br_status br_study_run(struct br_study *studies, size_t count, int threads,
                            const struct br_observer *observer, struct br_error *err);

/* As br_study_run, but what is wrong with one study stays in its `failure`, and the others go
 * on: only BR_NO_MEMORY and BR_INTERRUPTED fail the call. */
enum br_status br_study_run_each(struct br_study *studies, size_t count, int threads,
                                 const struct br_observer *observer, struct br_error *err);

/* ---- differences (differences.c): each cell against the same scheme on the next finer mesh, or
 * with the next smaller time step (Richardson 1911; Roache 1998). They have the orders of the
 * errors, and need no reference. ---- */

/* Marches a grid (the first of a chain of norms; scene, norm, method, and lists n and steps,
 * ascending) and measures its differences along an axis into
 * out[0 .. norms): studies with one mesh or one time step less, whose cells are compared with their
 * next finer neighbours, `against`.
 * Fails with BR_BAD_INPUT where there is no neighbour, or as br_study_run does. */
enum br_status br_differences_run(const struct br_study *grid, enum br_axis axis,
                                  struct br_study *out, int threads,
                                  const struct br_observer *observer, struct br_error *err);

/* ---- engines ---- */

/* An engine marches prepared studies (cells allocated, grids known to nest), all of a call at once;
 * but not those that have failed already. br_march_studies is the one in this process: reference
 * and cells side by side, as tasks. */
typedef enum br_status br_engine(struct br_study *studies, size_t count, int threads,
                                 const struct br_observer *observer, struct br_error *err);
br_engine br_march_studies;

/* The engine of studies that are not `here`, for the whole process: at first br_march_studies. For
 * the main thread, before any study runs. */
void br_engine_set(br_engine *engine);

#endif
