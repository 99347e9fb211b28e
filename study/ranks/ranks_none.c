/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A build without MPI: there are no other ranks. */
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

int br_ranks_size(void)
{
    return 1;
}

bool br_ranks_first(void)
{
    return launch.rank == 0; /* so that only one of them prints why they end */
}

enum br_status br_ranks_end(enum br_status status, struct br_error *err)
{
    (void)err;
    return br_ranks_first() ? status : BR_OK;
}
