/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Linked into the program, these make what it prints the same on every machine: a clock that each
 * look advances, by a nanosecond on the wall, by ten microseconds for a thread, but none of an
 * exact solution, whose steps follow the BLAS; the portable kernel; and a provenance without a
 * machine. */
#include <stdatomic.h>
#include <time.h>

#include "cli/provenance.h"
#include "reference/exact/exact.h"
#include "solver/linear/linear_solver.h"
#include "solver/linear/riccati/kernel.h"

static atomic_long looks;

int clock_gettime(clockid_t clock, struct timespec *t)
{
    const long now = (atomic_fetch_add(&looks, 1) + 1) * (clock == CLOCK_MONOTONIC ? 1 : 10000);
    *t = (struct timespec){.tv_sec = now / 1000000000, .tv_nsec = now % 1000000000};
    return 0;
}

enum br_status __real_br_exact_create(struct br_exact **out, const struct br_scene *scene,
                                      const struct br_exact_options *options, struct br_error *err);
enum br_status __wrap_br_exact_create(struct br_exact **out, const struct br_scene *scene,
                                      const struct br_exact_options *options, struct br_error *err);
enum br_status __wrap_br_exact_create(struct br_exact **out, const struct br_scene *scene,
                                      const struct br_exact_options *options, struct br_error *err)
{
    const long before = atomic_load(&looks);
    const enum br_status status = __real_br_exact_create(out, scene, options, err);
    atomic_store(&looks, before);
    return status;
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
