/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The processes of a run: one, or the ranks of an MPI job, of which rank 0 speaks and writes.
 * Messages between them. ranks_mpi.c or, in a build without MPI, ranks_none.c. */
#ifndef BR_STUDY_RANKS_RANKS_H
#define BR_STUDY_RANKS_RANKS_H

#include <stdbool.h>

#include "solver/status.h"

/* Joins the other ranks, if a launcher started more than one process; else does nothing, so that a
 * process that was started alone starts as fast as ever. Fails with BR_UNSUPPORTED where
 * there are others but this build has no MPI, or BR_BAD_INPUT where MPI does not know of them: each
 * process would then run the whole, and all would write the same files. To be called by the main
 * thread, as all of these functions but the first four below. */
enum br_status br_ranks_start(struct br_error *err);

/* Which one this is, of how many: 0 of 1 before the start. */
int br_ranks_rank(void);
int br_ranks_size(void);

/* Whether it is the one that speaks and writes files. */
bool br_ranks_first(void);

/* Threads that a rank uses where it is not told: the cores that it is bound to, divided by the
 * ranks of this machine that are bound to the same ones, since launchers often bind to none. */
int br_ranks_threads(void);
int br_ranks_most_threads(void); /* of all ranks */

/* A message. `from` is the sender; `bytes` are owned by the receiver, who frees them. */
struct br_message {
    int from, kind;
    char *bytes;
    size_t size;
};

/* Sends a copy of the bytes: returns at once, and never waits for the receiver. Fails with
 * BR_NO_MEMORY or BR_IO. */
enum br_status br_ranks_send(int to, int kind, const void *bytes, size_t size,
                             struct br_error *err);

/* Whether a message has come (out); BR_NO_MEMORY and BR_IO as above. Moves what is being sent on.
 */
enum br_status br_ranks_receive(struct br_message *message, bool *came, struct br_error *err);

/* Whether everything that was sent has left. */
bool br_ranks_sent(void);

/* Leaves the others in good order, once all of them have sent everything. */
void br_ranks_leave(void);

/* Ends all ranks at once, with exit code 3, after saying why on standard error; NULL: silently,
 * since another rank has said it. */
_Noreturn void br_ranks_abort(const char *why);

#endif
