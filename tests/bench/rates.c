/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How many multiply-adds a core does, by instruction set: this file is contracted, and not
 * vectorised by the compiler, so that the scalar row stays scalar. */
#include <string.h>

#include "solver/linear/riccati/kernel.h"
#include "tests/bench/bench.h"

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
    const char *name, *needs; /* the kernel that tells whether it can run */
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

void bench_measure_rates(struct bench_limits *limits)
{
    for (size_t i = 0; i < sizeof sets / sizeof *sets; i++) {
        const struct br_kernel *kernel = br_kernel_find(sets[i].needs);
        if (!kernel || !kernel->available())
            continue;
        struct chains chains = {.factor = 0.5, .term = 0.5};
        const double instructions = (sets[i].fused ? 1.0 : 2.0) * ROUNDS * CHAINS;
        const struct bench_time t = bench_time(sets[i].run, &chains, instructions);
        limits->rate[limits->rates++] =
            (struct bench_rate){sets[i].name, sets[i].bits, sets[i].fused, 1 / t.least};
    }
}
