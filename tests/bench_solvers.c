/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Speed and round-off of every solver, on Example 2 with k = 1e-3:
 *     meson test --benchmark -C build/release
 * Both fields count as one element-step. Nothing is asserted about time. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "solver/clock.h"
#include "support.h"

enum { REPEATS = 5 };

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Median time of an element-step, ns, over some repeats of about 0.1 s and more. */
static double time_of(const struct br_scene *scene, size_t n, const struct br_method *method)
{
    const size_t steps = 4000000 / n;
    double seconds[REPEATS];
    struct br_march *march = br_test_march(scene, n, (REPEATS + 1) * steps, method);
    br_test_advance(march, steps); /* warm */
    for (size_t r = 0; r < REPEATS; r++) {
        const double start = br_seconds();
        br_test_advance(march, (r + 2) * steps);
        seconds[r] = br_seconds() - start;
    }
    br_march_free(march);
    qsort(seconds, REPEATS, sizeof *seconds, by_value);
    return 1e9 * seconds[REPEATS / 2] / (double)(n * steps);
}

static double predicted(const struct br_scene *scene, size_t n, const struct br_method *method)
{
    struct br_march *march = br_test_march(scene, n, 1000, method);
    const double round_off = br_march_round_off(march);
    br_march_free(march);
    return round_off;
}

static void bench(void **state)
{
    (void)state;
    struct br_test_golden rows[BR_TEST_MOST_GOLDEN];
    const size_t count = br_test_golden(rows);
    printf("%-10s %8s %20s %14s %14s\n", "solver", "n", "ns per element-step", "round-off",
           "predicted");
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++)
        for (size_t i = 0; i < count; i++) {
            if (strcmp(rows[i].scene, "example2") != 0)
                continue;
            const struct br_method method = br_test_method((*s)->name, "lagged", "exact");
            struct br_scene scene = br_test_bundled("example2");
            const struct br_test_end end = br_test_run(&scene, rows[i].n, rows[i].steps, &method);
            printf("%-10s %8zu %20.2f %14.1e %14.1e\n", (*s)->name, rows[i].n,
                   time_of(&scene, rows[i].n, &method), br_test_deviation(&end, &rows[i].end),
                   predicted(&scene, rows[i].n, &method));
            fflush(stdout);
            br_scene_clear(&scene);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(bench)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
