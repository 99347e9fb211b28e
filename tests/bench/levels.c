/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How fast a core reads and writes a working set that stays in one level of the memory, with the
 * widest vectors that it has. */
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

#include "solver/linear/riccati/kernel.h"
#include "tests/bench/bench.h"

struct set {
    double *x;
    size_t bytes, passes;
};

/* x = x/2 + 1/2 */
#define UPDATE(suffix, size, attributes)                                         \
    attributes static void update_##suffix(void *self)                           \
    {                                                                            \
        typedef double vec __attribute__((vector_size(size), may_alias));        \
        const struct set *s = self;                                              \
        for (size_t pass = 0; pass < s->passes; pass++)                          \
            for (vec *v = (vec *)s->x, *end = v + s->bytes / size; v < end; v++) \
                *v = 0.5 * *v + 0.5;                                             \
    }

#if defined __x86_64__ && !defined BR_NO_FMA
UPDATE(avx512, 64, __attribute__((target("avx512f"))))
UPDATE(avx2, 32, __attribute__((target("avx2,fma"))))
#endif
UPDATE(portable, 16, )

#if defined __x86_64__ && !defined BR_NO_FMA
static bool has(const char *name)
{
    const struct br_kernel *kernel = br_kernel_find(name);
    return kernel && kernel->available();
}
#endif

static void update(void *self)
{
#if defined __x86_64__ && !defined BR_NO_FMA
    if (has("avx512"))
        update_avx512(self);
    else if (has("avx2"))
        update_avx2(self);
    else
#endif
        update_portable(self);
}

/* Bytes a ns, read and written. */
static double rate_of(size_t bytes)
{
    struct set s = {.bytes = bytes};
    s.passes = bytes < (4u << 20) ? (4u << 20) / bytes : 1;
    s.x = br_allocate_aligned(bytes / sizeof *s.x, sizeof *s.x);
    assert_non_null(s.x);
    const struct bench_time t = bench_time(update, &s, 2.0 * (double)(bytes * s.passes));
    free(s.x);
    return 1 / t.least;
}

static size_t size_or(int name, size_t usual)
{
    const long size = sysconf(name);
    return size > 0 ? (size_t)size : usual;
}

void bench_measure_levels(struct bench_limits *limits)
{
    const size_t first = size_or(_SC_LEVEL1_DCACHE_SIZE, 32u << 10);
    const size_t second = size_or(_SC_LEVEL2_CACHE_SIZE, 512u << 10);
    const size_t third = size_or(_SC_LEVEL3_CACHE_SIZE, 8u << 20);
    const size_t most = (size_t)512 << 20, beyond = 4 * third < most ? 4 * third : most;
    const struct bench_level levels[BENCH_LEVELS] = {
        {"L1", first, first / 2, 0},
        {"L2", second, second / 2, 0},
        {"L3", third, third / 4 > 2 * second ? third / 4 : 2 * second, 0},
        {"memory", SIZE_MAX, beyond, 0},
    };
    for (size_t i = 0; i < BENCH_LEVELS; i++) {
        limits->level[i] = levels[i];
        limits->level[i].rate = rate_of(levels[i].working_set / 64 * 64);
    }
}
