/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures the limits of this machine, and from them the least time of the fast solver. Compiled
 * with contraction but without automatic vectors, so that the scalar row stays scalar. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "solver/linear/riccati/kernel.h"
#include "tests/bench/bench.h"

/* The rate of independent fused multiply-adds of one instruction set, or of pairs of a multiply and
 * an add where it has no fused ones. */
struct rate {
    const char *name; /* of the kernel that uses it, if any */
    int bits;
    bool fused;
    double per_ns; /* instructions per ns */
};

/* Read and write of a working set that stays in one level of the memory. */
struct level {
    const char *name;
    size_t bytes;       /* its size; of the last: SIZE_MAX */
    size_t working_set; /* bytes */
    double rate;        /* bytes read and written per ns */
};

enum { MOST_RATES = 8, LEVELS = 4 };

static struct rate rate[MOST_RATES];
static size_t rates;
static struct level level[LEVELS];

/* ---- multiply-adds ---- */

enum { ROUNDS = 200000, CHAINS = 12 };

struct chains {
    double factor, term, result;
};

typedef double vec512 __attribute__((vector_size(64)));
typedef double vec256 __attribute__((vector_size(32)));
typedef double vec128 __attribute__((vector_size(16)));

/* CHAINS independent chains a = a factor + term, which stay near 1. */
#define RUN(suffix, type, attributes)                                                         \
    attributes static void run_##suffix(void *self)                                           \
    {                                                                                         \
        struct chains *c = self;                                                              \
        const type f = c->factor - (type){0}, t = c->term - (type){0};                        \
        type a0 = t, a1 = t + f, a2 = a1 + t, a3 = a2 + t, a4 = a3 + t, a5 = a4 + t;          \
        type a6 = a5 + t, a7 = a6 + t, a8 = a7 + t, a9 = a8 + t, a10 = a9 + t, a11 = a10 + t; \
        for (size_t i = 0; i < ROUNDS; i++) {                                                 \
            a0 = a0 * f + t, a1 = a1 * f + t, a2 = a2 * f + t, a3 = a3 * f + t;               \
            a4 = a4 * f + t, a5 = a5 * f + t, a6 = a6 * f + t, a7 = a7 * f + t;               \
            a8 = a8 * f + t, a9 = a9 * f + t, a10 = a10 * f + t, a11 = a11 * f + t;           \
        }                                                                                     \
        const type sum = a0 + a1 + a2 + a3 + a4 + a5 + a6 + a7 + a8 + a9 + a10 + a11;         \
        memcpy(&c->result, &sum, sizeof c->result);                                           \
    }

#if defined __x86_64__ && !defined BR_NO_FMA
RUN(avx512, vec512, __attribute__((target("avx512f"))))
RUN(avx2, vec256, __attribute__((target("avx2,fma"))))
RUN(fma128, vec128, __attribute__((target("avx2,fma"))))
RUN(fma64, double, __attribute__((target("avx2,fma"))))
#endif
RUN(portable, vec128, )
RUN(scalar, double, )

#if defined __FP_FAST_FMA
#define PORTABLE_FUSED true
#else
#define PORTABLE_FUSED false
#endif

static const struct {
    const char *name, *needs; /* runs if this kernel can run */
    int bits;
    bool fused;
    void (*run)(void *self);
} sets[] = {
#if defined __x86_64__ && !defined BR_NO_FMA
    {"avx512", "avx512", 512, true, run_avx512},
    {"avx2", "avx2", 256, true, run_avx2},
    {"fma, 128 bit", "avx2", 128, true, run_fma128},
    {"fma, scalar", "avx2", 64, true, run_fma64},
#endif
    {"portable", "portable", 128, PORTABLE_FUSED, run_portable},
    {"scalar", "portable", 64, PORTABLE_FUSED, run_scalar},
};

static bool has(const char *name)
{
    const struct br_kernel *kernel = br_kernel_find(name);
    return kernel && kernel->available();
}

static void measure_rates(void)
{
    for (size_t i = 0; i < sizeof sets / sizeof *sets; i++) {
        if (!has(sets[i].needs))
            continue;
        struct chains chains = {.factor = 0.5, .term = 0.5};
        const double instructions = (sets[i].fused ? 1.0 : 2.0) * ROUNDS * CHAINS;
        const struct bench_time t = bench_time(sets[i].run, &chains, instructions);
        rate[rates++] = (struct rate){sets[i].name, sets[i].bits, sets[i].fused, 1 / t.least};
    }
}

/* ---- memory, with the widest vectors ---- */

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

/* Bytes read and written per ns. */
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

static void measure_levels(void)
{
    const size_t first = size_or(_SC_LEVEL1_DCACHE_SIZE, 32u << 10);
    const size_t second = size_or(_SC_LEVEL2_CACHE_SIZE, 512u << 10);
    const size_t third = size_or(_SC_LEVEL3_CACHE_SIZE, 8u << 20);
    const size_t most = (size_t)512 << 20, beyond = 4 * third < most ? 4 * third : most;
    const struct level levels[LEVELS] = {
        {"L1", first, first / 2, 0},
        {"L2", second, second / 2, 0},
        {"L3", third, third / 4 > 2 * second ? third / 4 : 2 * second, 0},
        {"memory", SIZE_MAX, beyond, 0},
    };
    for (size_t i = 0; i < LEVELS; i++) {
        level[i] = levels[i];
        level[i].rate = rate_of(levels[i].working_set / 64 * 64);
    }
}

/* ---- the section ---- */

void bench_machine(void **state)
{
    (void)state;
    measure_rates();
    measure_levels();
    printf("\nThis machine, one core: independent multiply-adds\n");
    for (const struct rate *r = rate; r < rate + rates; r++) {
        const double flops = r->per_ns * r->bits / 64 * (r->fused ? 2 : 1);
        printf("  %-14s %3d bit %-28s %6.2f a ns %8.1f GFlop/s\n", r->name, r->bits,
               r->fused ? "fused" : "a multiply and an add each", r->per_ns, flops);
        bench_put(bench_row("machine, %s", r->name), "instructions/ns", r->per_ns);
    }
    printf("and read and write of a working set\n");
    for (const struct level *l = level; l < level + LEVELS; l++) {
        printf("  %-14s %8zu KiB %31.1f GB/s\n", l->name, l->working_set >> 10, l->rate);
        bench_put(bench_row("machine, %s", l->name), "GB/s", l->rate);
    }
}

struct bench_least bench_least_time(const char *kernel, enum bench_fields fields, size_t n)
{
    struct bench_least least = {-1, -1, "?"};
    const struct rate *r = rate;
    double instructions = 0, bytes = 0;
    while (r < rate + rates && strcmp(r->name, kernel) != 0)
        r++;
    if (r == rate + rates)
        return least;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        if (fields == (kind == BR_AXIAL ? BENCH_BENDING : BENCH_AXIAL))
            continue;
        const struct br_sweep_cost *c = &br_sweep_costs[kind];
        instructions += (double)((r->fused ? 1 : 2) * c->fma + c->multiply + c->add) / BR_LANES;
        bytes += (double)c->state * sizeof(double);
    }
    least.instructions = instructions * (64.0 * BR_LANES / r->bits) / r->per_ns;
    size_t i = 0;
    while (i + 1 < LEVELS && bytes * (double)n > (double)level[i].bytes)
        i++;
    least.memory = 2 * bytes / level[i].rate;
    least.level = level[i].name;
    return least;
}
