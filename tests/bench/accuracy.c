/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Round-off of every solver, measured against the golden values and predicted. */
#include <stdio.h>
#include <string.h>

#include "solver/linear/linear_solver.h"
#include "solver/scene.h"
#include "tests/bench/bench.h"

static double predicted(const struct br_scene *scene, const struct br_test_golden *row,
                        const struct br_method *method)
{
    struct br_march *march = br_test_march(scene, row->n, row->steps, method);
    const double round_off = br_march_round_off(march);
    br_march_free(march);
    return round_off;
}

static void run_row(const struct br_test_golden *row, const struct br_method *method)
{
    struct br_scene scene = br_test_bundled(row->scene);
    const struct br_test_end end = br_test_run(&scene, row->n, row->steps, method);
    const double deviation = br_test_deviation(&end, &row->end);
    const double limit = predicted(&scene, row, method);
    const char *name = method->solver->name;
    br_scene_clear(&scene);
    printf("%-8s %8zu %12.1e %12.1e\n", name, row->n, deviation, limit);
    fflush(stdout);
    json_t *made = bench_row("%s round-off n=%zu", name, row->n);
    bench_put(made, "relative", deviation);
    if (!(deviation <= limit))
        fail_msg("%s, n = %zu: the round-off is %g, predicted were at most %g", name, row->n,
                 deviation, limit);
}

void bench_accuracy(void **state)
{
    struct br_test_golden rows[BR_TEST_MOST_GOLDEN];
    (void)state;
    const size_t count = br_test_golden(rows);
    printf("\nRound-off of Example 2 with k = 1e-3 s, relative to quadruple precision\n");
    printf("%-8s %8s %12s %12s\n", "solver", "n", "measured", "predicted");
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++)
        for (size_t i = 0; i < count; i++)
            if (strcmp(rows[i].scene, "example2") == 0) {
                const struct br_method method = br_test_method((*s)->name, "lagged", "exact");
                run_row(&rows[i], &method);
            }
}
