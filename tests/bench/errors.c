/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compares the time for the errors of a study with that of its reference's march: the printed grid
 * of Table 2 with all time steps ten times as long, on one thread. */
#include <math.h>
#include <stdio.h>

#include "base/clock.h"
#include "solver/linear/linear_solver.h"
#include "solver/scene.h"
#include "study/grid/study.h"
#include "study/grid/sweep.h"
#include "tests/bench/bench.h"

enum { MESHES = 6, STEPS = 6, REPEATS = 3 };

/* Seconds of the reference's march, of the cells' and of everything else. */
struct parts {
    double reference, cells, errors;
};

static struct parts run(const struct br_scene *scene, const struct br_method *method)
{
    static const size_t n[MESHES] = {100, 200, 400, 800, 1600, 3200};
    static const size_t steps[STEPS] = {10, 20, 50, 100, 200, 1000};
    struct br_error err = {0};
    struct br_study study = {.scene = scene,
                             .norm = br_norms[0],
                             .method = *method,
                             .reference_kind = &br_reference_fine,
                             .reference_method = *method,
                             .reference = {12800, 10000},
                             .n_count = MESHES,
                             .k_count = STEPS,
                             .n = n,
                             .steps = steps};
    const double start = br_seconds();
    MUST(br_study_run(&study, 1, 1, NULL, &err));
    struct parts p = {.reference = study.reference_report.seconds};
    for (size_t i = 0; i < br_study_cells(&study); i++)
        p.cells += study.cell[i].seconds;
    p.errors = br_seconds() - start - p.reference - p.cells;
    br_study_clear(&study);
    return p;
}

void bench_errors(void **state)
{
    (void)state;
    struct br_scene scene = br_test_bundled("example2");
    const struct br_method method = bench_fast_method();
    struct parts best = run(&scene, &method);
    for (int i = 1; i < REPEATS; i++) {
        const struct parts p = run(&scene, &method);
        best.reference = fmin(best.reference, p.reference);
        best.cells = fmin(best.cells, p.cells);
        best.errors = fmin(best.errors, p.errors);
    }
    br_scene_clear(&scene);
    printf("\nA study on one thread with %s: reference %.3f s, cells %.3f s, errors and all else "
           "%.3f s,\nwhich is %.1f %% of the reference\n",
           method.solver->name, best.reference, best.cells, best.errors,
           100 * best.errors / best.reference);
    bench_put(bench_row("study, reference"), "s", best.reference);
    bench_put(bench_row("study, cells"), "s", best.cells);
    bench_put(bench_row("study, errors"), "s", best.errors);
    bench_put(bench_row("study, errors/reference"), "1", best.errors / best.reference);
}
