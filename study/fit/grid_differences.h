/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Orders that a grid hides: the error in k hides the one in h, or the other way round. Differences
 * of marches that are no cells of the grid show them. */
#ifndef BR_STUDY_FIT_GRID_DIFFERENCES_H
#define BR_STUDY_FIT_GRID_DIFFERENCES_H

#include "base/observer.h"
#include "study/fit/report.h"
#include "study/grid/sweep.h"

/* At most; each half of the one before, unless the grid has others. */
enum { BR_DIFFERENCE_SIZES = 12 };

/* The differences of a study, by its chain of norms. Begins as zeros, but for the first members.
 * The reports borrow them. */
struct br_grid_differences {
    struct br_report *report; /* of one study in `norms` norms, in the order of its chain, whose
                                 cells have been marched; borrowed, as the observer */
    size_t norms;
    int threads;
    const struct br_observer *observer;
    size_t size[BR_AXES]
               [BR_DIFFERENCE_SIZES];    /* meshes, and numbers of steps, that are compared: */
    size_t first[BR_AXES], end[BR_AXES]; /* ... those that have been marched; end 0: none */
    size_t at[BR_AXES];                  /* the number of steps, or the mesh, at which they are */
    struct br_error no_meshes;           /* why there are no differences of meshes */
    struct br_study over[BR_AXES][BR_MOST_NORMS];
};
void br_grid_differences_clear(struct br_grid_differences *compared);

/* A march that fails is no failure: it ends what there is to see. Both fail with BR_NO_MEMORY or
 * BR_INTERRUPTED. */

/* Compares each mesh with the next at one time step, for br_report_finish. */
enum br_status br_grid_differences_meshes(struct br_grid_differences *compared,
                                          struct br_error *err);

/* Where the finished reports do not settle the order along an axis: compares ever smaller sizes, of
 * time on a cheap mesh, until they settle it, or cost more than the grid; then larger time steps of
 * the grid's range, which cost little. */
enum br_status br_grid_differences_settle(struct br_grid_differences *compared, enum br_axis axis,
                                          struct br_error *err);

#endif
