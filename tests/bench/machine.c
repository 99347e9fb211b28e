/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What this machine could do, and what the fast solver would take if it did. */
#include <stdio.h>
#include <string.h>

#include "solver/linear/riccati/kernel.h"
#include "tests/bench/bench.h"

void bench_machine(void **state)
{
    struct bench *b = *state;
    bench_measure_rates(b->limits);
    bench_measure_levels(b->limits);
    printf("\nThis machine, one core: independent multiply-adds\n");
    for (size_t i = 0; i < b->limits->rates; i++) {
        const struct bench_rate *r = &b->limits->rate[i];
        const double flops = r->per_ns * r->bits / 64 * (r->fused ? 2 : 1);
        printf("  %-14s %3d bit %-28s %6.2f a ns %8.1f GFlop/s\n", r->name, r->bits,
               r->fused ? "fused" : "a multiply and an add each", r->per_ns, flops);
        bench_record_value(b, "instructions/ns", r->per_ns, "machine, %s", r->name);
    }
    printf("and read and write of a working set\n");
    for (size_t i = 0; i < BENCH_LEVELS; i++) {
        const struct bench_level *l = &b->limits->level[i];
        printf("  %-14s %8zu KiB %31.1f GB/s\n", l->name, l->working_set >> 10, l->rate);
        bench_record_value(b, "GB/s", l->rate, "machine, %s", l->name);
    }
}

static const struct bench_rate *rate_of(const struct bench_limits *limits, const char *kernel)
{
    for (size_t i = 0; i < limits->rates; i++)
        if (strcmp(limits->rate[i].name, kernel) == 0)
            return &limits->rate[i];
    return NULL;
}

struct bench_least bench_least_time(const struct bench_limits *limits, const char *kernel,
                                    enum bench_fields fields, size_t n)
{
    struct bench_least least = {-1, -1, "?"};
    const struct bench_rate *rate = rate_of(limits, kernel);
    double instructions = 0, bytes = 0;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        if (fields == (kind == BR_AXIAL ? BENCH_BENDING : BENCH_AXIAL))
            continue;
        const struct br_sweep_cost *c = &br_sweep_costs[kind];
        const int fused = rate && rate->fused ? 1 : 2;
        instructions += (double)(fused * c->fma + c->multiply + c->add) / BR_LANES;
        bytes += (double)c->state * sizeof(double);
    }
    if (!rate)
        return least;
    least.instructions = instructions * (64.0 * BR_LANES / rate->bits) / rate->per_ns;
    size_t i = 0;
    while (i + 1 < BENCH_LEVELS && bytes * (double)n > (double)limits->level[i].bytes)
        i++;
    least.memory = 2 * bytes / limits->level[i].rate;
    least.level = limits->level[i].name;
    return least;
}
