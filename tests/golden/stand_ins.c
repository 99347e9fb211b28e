/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Linked into the program, these make what it prints the same on every machine: a clock that each
 * look advances, by a nanosecond on the wall, by ten microseconds for a thread; the portable
 * kernel; and a provenance without a machine. */
#include <stdatomic.h>
#include <time.h>

#include "cli/provenance.h"
#include "solver/linear/linear_solver.h"
#include "solver/linear/riccati/kernel.h"

int clock_gettime(clockid_t clock, struct timespec *t)
{
    static atomic_long looks;
    const long now = (atomic_fetch_add(&looks, 1) + 1) * (clock == CLOCK_MONOTONIC ? 1 : 10000);
    *t = (struct timespec){.tv_sec = now / 1000000000, .tv_nsec = now % 1000000000};
    return 0;
}

const struct br_kernel *__wrap_br_kernel_best(void);
const struct br_kernel *__wrap_br_kernel_best(void)
{
    return br_kernel_find("portable");
}

void __wrap_br_provenance_fill(struct br_provenance *p, int threads);
void __wrap_br_provenance_fill(struct br_provenance *p, int threads)
{
    *p = (struct br_provenance){
        .version = "0",
        .commit = "a commit",
        .compiler = "a compiler",
        .flags = "some flags",
        .command_line = br_command_line(),
        .machine = "a machine",
        .date = "2006-01-01T00:00:00Z",
        .threads = threads,
    };
}
