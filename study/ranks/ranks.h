/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The processes of a run: one, or the ranks of an MPI job. All ranks run the same program, read the
 * same scenes and prepare the same studies; only rank 0 prints and writes files. ranks_mpi.c or, in
 * a build without MPI, ranks_none.c. All of these functions are for the main thread. */
#ifndef BR_STUDY_RANKS_RANKS_H
#define BR_STUDY_RANKS_RANKS_H

#include "base/observer.h"
#include "study/grid/study.h"

/* A job of several processes, as the environment of each describes it. */
struct br_launch {
    const char *launcher; /* its name, for messages; NULL: the process was started alone */
    int size;             /* processes; 1 where it was started alone */
    int rank;             /* of this one, from 0 */
};
struct br_launch br_launch_read(void);

/* Joins the other ranks, if a launcher started more than one process: they then march all studies
 * together that are not `here`. Else does nothing, so that a process that was started alone
 * starts fast. Fails with BR_UNSUPPORTED where there are others but
 * this build has no MPI, or BR_BAD_INPUT where MPI does not know of them: each process would then
 * run the whole, and all would write the same files. Also BR_IO, BR_NO_MEMORY. */
enum br_status br_ranks_start(struct br_error *err);

/* How many there are: 1 before the start. */
int br_ranks_size(void);

/* Whether this rank prints and writes files. */
bool br_ranks_first(void);

/* The engine of all ranks: each of them calls br_study_run in the same order; the work is shared,
 * and all get the results of all, so that all continue alike. threads: of each rank; 0: the cores
 * that it is bound to, divided by the ranks of its machine that are bound to the same ones, since
 * launchers often bind to none. What ends the call on one (BR_NO_MEMORY, BR_INTERRUPTED) ends it on
 * all. Besides fails with BR_BAD_INPUT where the ranks have not read the same, and BR_IO where one
 * is not heard from any more. */

/* The end of the program on this rank, with its status (in) and error (in, out). Returns what the
 * whole job has come to on rank 0, and BR_OK on the others, whose failures rank 0 reports. Does not
 * return, but ends the job with exit code 3, where a rank is not heard from any more. */
enum br_status br_ranks_end(enum br_status status, struct br_error *err);

#endif
