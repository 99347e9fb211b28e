/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Differences of successive grids, against studies of single cells. */

#include "solver/scene.h"
#include "study/grid/sweep.h"
#include "support.h"

/* ---- differences ---- */

enum { NORMS = BR_TEST_NORMS };
static const size_t meshes[] = {3, 6, 24}, steps[] = {10, 20, 60, 120};
enum { ROWS = sizeof meshes / sizeof *meshes, COLUMNS = sizeof steps / sizeof *steps };

static void make_grid(const struct br_scene *scene, struct br_study grid[NORMS])
{
    grid[0] = br_test_study(scene, NULL, ROWS, meshes, COLUMNS, steps);
    br_test_all_norms(grid);
}

/* One cell against a finer one, in one norm. */
static void check_cell(const struct br_study *differences, size_t i, size_t j,
                       struct br_resolution finer)
{
    struct br_error err = {0};
    const struct br_cell *cell = br_study_cell(differences, i, j);
    assert_true(cell->at.n == meshes[i] && cell->at.steps == steps[j]);
    assert_true(cell->against.n == finer.n && cell->against.steps == finer.steps);
    struct br_study s = *differences;
    s.reference_kind = &br_reference_fine;
    s.reference_method = s.method;
    s.reference = finer;
    s.n = &meshes[i], s.steps = &steps[j];
    s.n_count = s.k_count = 1;
    MUST(br_study_run(&s, 1, 1, NULL, &err));
    for (enum br_part part = 0; part < BR_PARTS; part++)
        assert_true(s.cell[0].error[part] == cell->error[part]);
    br_study_clear(&s);
}

TEST(test_differences)
{
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled("example4");
    struct br_study grid[NORMS];
    make_grid(&scene, grid);
    struct br_study over[BR_AXES][NORMS];
    for (enum br_axis axis = 0; axis < BR_AXES; axis++)
        MUST(br_differences_run(grid, axis, over[axis], 2, NULL, &err));
    for (size_t m = 0; m < NORMS; m++) {
        struct br_study *h = &over[BR_AXIS_SPACE][m], *k = &over[BR_AXIS_TIME][m];
        assert_true(h->norm == br_norms[m] && k->norm == br_norms[m]);
        assert_true(h->n_count == ROWS - 1 && h->k_count == COLUMNS);
        assert_true(k->n_count == ROWS && k->k_count == COLUMNS - 1);
        for (size_t i = 0; i < ROWS; i++)
            for (size_t j = 0; j < COLUMNS; j++) {
                if (i + 1 < ROWS)
                    check_cell(h, i, j, (struct br_resolution){meshes[i + 1], steps[j]});
                if (j + 1 < COLUMNS)
                    check_cell(k, i, j, (struct br_resolution){meshes[i], steps[j + 1]});
            }
        br_study_clear(h);
        br_study_clear(k);
    }
    br_scene_clear(&scene);
}

TEST(test_refusals)
{
    struct br_scene scene = br_test_bundled("example2");
    static const size_t odd[] = {10, 15};
    static const struct {
        enum br_axis axis;
        size_t n_count, k_count;
        const size_t *n, *steps;
        const char *message;
    } bad[] = {
        {BR_AXIS_SPACE, 1, 3, meshes, steps, "found 1 meshes and 3 time steps, expected at least"},
        {BR_AXIS_TIME, 3, 1, meshes, steps, "found 3 meshes and 1 time steps, expected at least"},
        {BR_AXIS_SPACE, 2, 0, meshes, steps, "found 2 meshes and 0 time steps, expected at least"},
        {BR_AXIS_SPACE, 2, 2, odd, steps, "n = 10 does not nest in the reference's 15 elements"},
        {BR_AXIS_TIME, 2, 2, meshes, odd, "the time levels of k = 0.1 s are not all among"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct br_error err = {0};
        struct br_study grid[NORMS];
        make_grid(&scene, grid);
        grid[0].n_count = bad[i].n_count, grid[0].n = bad[i].n;
        grid[0].k_count = bad[i].k_count, grid[0].steps = bad[i].steps;
        struct br_study out[NORMS];
        REFUSED(br_differences_run(grid, bad[i].axis, out, 1, NULL, &err), BR_BAD_INPUT,
                bad[i].message);
    }
    br_scene_clear(&scene);
}
