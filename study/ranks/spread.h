/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Spreads the studies of a call over the ranks of an MPI job. All ranks run the same program, read
 * the same scenes and prepare the same studies; here each gets units of the work (units.h) as it is
 * done with the ones before, and all get the results of all, so that they go on alike. Rank 0 hands
 * out, and works, too. */
#ifndef BR_STUDY_RANKS_SPREAD_H
#define BR_STUDY_RANKS_SPREAD_H

#include "study/grid/observer.h"
#include "study/grid/study.h"

/* As br_lockstep, on all ranks: to be called by each of them, in the same order. What ends the call
 * on one (BR_NO_MEMORY, BR_INTERRUPTED) ends it on all. Besides fails with BR_BAD_INPUT where the
 * ranks have not read the same, and BR_IO where one is not heard from any more. */
enum br_status br_spread(struct br_study *studies, size_t count, int threads,
                         const struct br_observer *observer, struct br_error *err);

/* The end of the program on this rank, with its status (in) and error (in, out). Returns what the
 * whole job has come to on rank 0, and BR_OK on the others, whose failures rank 0 tells. Does not
 * return, but ends the job with exit code 3, where a rank is not heard from any more. */
enum br_status br_spread_end(enum br_status status, struct br_error *err);

#endif
