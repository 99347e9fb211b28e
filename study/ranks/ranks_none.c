/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A build without MPI: there are no other ranks. */
#include "study/ranks/launcher.h"
#include "study/ranks/ranks.h"

static struct br_launch launch = {.size = 1};

enum br_status br_ranks_start(struct br_error *err)
{
    launch = br_launch_read();
    if (launch.size == 1)
        return BR_OK;
    return br_fail(err, BR_UNSUPPORTED,
                   "started by %s as one of %d processes, but this build has no MPI: each would do "
                   "all the work, and all would write the same files; build with -Dmpi=enabled",
                   launch.launcher, launch.size);
}

int br_ranks_rank(void)
{
    return launch.rank; /* so that only one of them says why they end */
}

int br_ranks_size(void)
{
    return 1;
}

bool br_ranks_first(void)
{
    return launch.rank == 0;
}

int br_ranks_threads(void)
{
    return 0;
}

int br_ranks_most_threads(void)
{
    return 0;
}

enum br_status br_ranks_send(int to, int kind, const void *bytes, size_t size, struct br_error *err)
{
    (void)to, (void)kind, (void)bytes, (void)size;
    return br_fail(err, BR_UNSUPPORTED, "there is no other rank");
}

enum br_status br_ranks_receive(struct br_message *message, bool *came, struct br_error *err)
{
    (void)message, (void)err;
    *came = false;
    return BR_OK;
}

bool br_ranks_sent(void)
{
    return true;
}

void br_ranks_leave(void)
{
}

void br_ranks_abort(const char *why)
{
    (void)why;
    abort(); /* nobody calls this */
}
