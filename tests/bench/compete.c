/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The fast solver beside others on the same march, which must end at the same tip. */
#include <float.h>
#include <math.h>
#include <stdio.h>

#include "tests/bench/bench.h"

enum { STEPS = 200 };

/* Largest relative difference of the tips after some steps of 1e-3 s. */
static double deviation_of(const struct br_scene *scene, size_t n, const struct br_method *method,
                           const struct br_method *other)
{
    struct br_scene s = *scene;
    s.duration = 1e-3 * STEPS;
    const struct br_test_end a = br_test_run(&s, n, STEPS, method);
    const struct br_test_end b = br_test_run(&s, n, STEPS, other);
    return br_test_deviation(&b, &a);
}

/* The condition number of the assembled form is about n^4 for bending: a wrong system is told by
 * the coarse meshes, and on the finest nothing is promised. */
static double allowed(size_t n)
{
    return DBL_EPSILON * pow((double)n, 4);
}

static void run_peer(struct bench *b, const struct br_scene *scene, size_t n,
                     const struct br_linear_solver *peer, double fast)
{
    const struct br_method usual = bench_fast_method();
    struct br_method method = usual;
    method.solver = peer;
    const struct bench_march march = {scene, &method, n, 60};
    struct br_error err = {0};
    if (!bench_can_march(&march, &err)) {
        printf("  %-20s %7zu   failed: %s\n", peer->name, n, err.message);
        bench_record_skipped(b, err.message, "peer %s n=%zu", peer->name, n);
        return;
    }
    const struct bench_time t = bench_march(&march).step;
    const double deviation = deviation_of(scene, n, &usual, &method), limit = allowed(n);
    printf("  %-20s %7zu %9.2f %9.2f %9.2f %9.1f %12.1e\n", peer->name, n, t.median, t.least,
           t.most, t.least / fast, deviation);
    fflush(stdout);
    bench_record(b, "ns/element-step", &t, "peer %s n=%zu", peer->name, n);
    bench_record_value(b, "times the fast solver's", t.least / fast, "peer ratio %s n=%zu",
                       peer->name, n);
    if (!(deviation <= limit))
        fail_msg("n = %zu: the tips of %s and %s differ by %g, expected at most %g: another system",
                 n, usual.solver->name, peer->name, deviation, limit);
}

void bench_peers(void **state)
{
    static const size_t sizes[] = {100, 400, 3200, 12800};
    struct br_scene scene = bench_scene(BENCH_BOTH);
    const struct br_method method = bench_fast_method();
    printf("\nPeers: the same steps of Example 2, both fields, right side and tip included; ns an "
           "element-step,\nas a multiple of %s (by the least), and how far the tip is off after %d "
           "steps\n",
           method.solver->name, STEPS);
    printf("  %-20s %7s %9s %9s %9s %9s %12s\n", "", "n", "median", "least", "most", "ratio",
           "tip off by");
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        const struct bench_march march = {&scene, &method, sizes[i], 4};
        const struct bench_time t = bench_march(&march).step;
        printf("  %-20s %7zu %9.2f %9.2f %9.2f\n", method.solver->name, sizes[i], t.median, t.least,
               t.most);
        for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++)
            if (*s != method.solver)
                run_peer(*state, &scene, sizes[i], *s, t.least);
    }
    br_scene_clear(&scene);
}
