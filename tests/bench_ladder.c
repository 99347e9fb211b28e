/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What measuring errors costs with each kernel: projecting a reference of 12800 elements onto six
 * rungs, and the distances of the cells there, both from nodal values.
 *     meson test --benchmark -C build/release ladder
 * Nothing is asserted about time. */
#include <stdio.h>
#include <stdlib.h>

#include "solver/clock.h"
#include "study/grid/ladder.h"
#include "support.h"

enum { ROOT = 12800, RUNGS = 6, REPEATS = 30, CALLS = 10 };
static const size_t rungs[RUNGS] = {3200, 1600, 800, 400, 200, 100};

/* One field: a reference, its ladder, and a cell on every rung, which are the same values. */
struct bench {
    struct br_ladder *ladder;
    struct br_view reference, cell[RUNGS];
    double *projection;
    double sum; /* so that nothing is left out */
};

static struct br_view random_view(enum br_field_kind kind, size_t n)
{
    const struct br_field field = {.kind = kind, .n = n, .h = 1.0 / (double)n};
    struct br_test_random random = {n};
    struct br_view view;
    br_view_field(&view, &field, BR_VELOCITY);
    view.values = br_allocate_aligned(
        br_measure_size((struct br_elements){kind, 1}, BR_VELOCITY, n), sizeof(double));
    assert_non_null(view.values);
    for (size_t i = 0; i < br_field_size(&field); i++)
        view.values[i] = br_test_uniform(&random, -1, 1);
    return view;
}

static void set_up(struct bench *b, enum br_field_kind kind)
{
    struct br_error err = {0};
    const size_t root = ROOT;
    MUST(br_ladder_create(&b->ladder, br_mode_count((struct br_elements){kind, 1}, BR_VELOCITY),
                          &(struct br_mesh_list){1, &root}, &(struct br_mesh_list){RUNGS, rungs},
                          &err));
    b->projection = br_allocate_aligned(br_ladder_size(b->ladder), sizeof(double));
    assert_non_null(b->projection);
    b->reference = random_view(kind, ROOT);
    for (size_t r = 0; r < RUNGS; r++)
        b->cell[r] = random_view(kind, rungs[r]);
}

static void clear(struct bench *b)
{
    br_ladder_free(b->ladder);
    free(b->projection);
    free(b->reference.values);
    for (size_t r = 0; r < RUNGS; r++)
        free(b->cell[r].values);
}

static void project(struct bench *b)
{
    br_ladder_project(b->ladder, &b->reference, b->projection);
}

static void norm(struct bench *b)
{
    b->sum += br_ladder_norm(b->ladder, b->projection);
}

static void measure_cells(struct bench *b)
{
    for (size_t r = 0; r < RUNGS; r++)
        b->sum += br_ladder_distance(b->ladder, r, &b->cell[r], b->projection);
}

/* The shortest time of some calls, ns an element. */
static double time_of(void (*what)(struct bench *), struct bench *b, size_t elements)
{
    double best = 1e9;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        const double start = br_seconds();
        for (int call = 0; call < CALLS; call++)
            what(b);
        const double seconds = br_seconds() - start;
        best = seconds < best ? seconds : best;
    }
    return 1e9 * best / (double)(CALLS * elements);
}

static void bench(void **state)
{
    (void)state;
    static const char *const names[] = {"axial", "bending"};
    struct bench b[2] = {0};
    size_t cells = 0;
    for (size_t r = 0; r < RUNGS; r++)
        cells += rungs[r];
    printf("%-10s %-8s %28s %24s %24s\n", "kernel", "field", "project, ns/reference element",
           "norm, the same", "distance, ns/cell element");
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        set_up(&b[kind], (enum br_field_kind)kind);
    for (const struct br_ladder_kernel *const *k = br_ladder_kernels; *k; k++)
        for (int kind = BR_AXIAL; kind <= BR_BENDING && (*k)->available(); kind++) {
            br_ladder_use(b[kind].ladder, *k);
            printf("%-10s %-8s %28.2f %24.2f %24.2f\n", (*k)->name, names[kind],
                   time_of(project, &b[kind], ROOT), time_of(norm, &b[kind], ROOT),
                   time_of(measure_cells, &b[kind], cells));
        }
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        clear(&b[kind]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(bench)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
