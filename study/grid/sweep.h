/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Marches the cells of studies beside their references, and measures the errors. */
#ifndef BR_STUDY_GRID_SWEEP_H
#define BR_STUDY_GRID_SWEEP_H

#include "study/fit/fit.h"
#include "study/base/observer.h"
#include "study/grid/study.h"

/* Runs studies on `threads` threads (0: all cores), all at once: the reference and
 * the cells march in lockstep, a few time levels at a time, so that neither is
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

/* ---- the engine: reference and cells in lockstep, as tasks ---- */

/* Marches prepared studies (cells allocated, grids known to nest) that have not failed already; see
 * br_study_run_each. */
enum br_status br_lockstep(struct br_study *studies, size_t count, int threads,
                           const struct br_observer *observer, struct br_error *err);

/* ---- successive grids ---- */

/* Each cell against the same scheme on the next finer mesh, and with the next smaller time step
 * (Richardson 1911; Roache 1998). Such differences have the orders of the errors, and need no
 * judge. */

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

/* ---- printed tables ---- */

/* What the triangle inequality says about a printed table, whatever reference its
 * authors used. Let D(a, b) be the largest distance of the scheme's solutions in
 * two cells over the time levels of a, all of which are levels of b, in the norm of
 * (31). For errors against one common reference
 *     E(a) - E(b) <= D(a, b) <= E(a) + E(b),
 * and with equal time levels also E(b) - E(a) <= D(a, b). Printed errors that
 * break this were not produced by this scheme with a common reference. */

struct br_triangle {
    struct br_resolution a, b;
    double printed_a, printed_b; /* m^(3/2) */
    double distance;             /* D(a, b), computed, m^(3/2) */
    double least, most;          /* what the printed values allow for D, digits rounded in favour */
    bool contradiction;          /* !(least <= D <= most) */
};

/* Marches pairs of cells that contradict `printed` (n_count * k_count values by rows, NaN where
 * nothing is printed): up to `most` into `triangles` (out); *count: how many. The study's own
 * errors choose them; of those that plainly contradict it, the cheapest come first. */
enum br_status br_triangles(const struct br_study *study, const double *printed, size_t most,
                            struct br_triangle *triangles, size_t *count, int threads,
                            struct br_error *err);

#endif
