/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Studies without a reference: the differences against studies of single cells, the tips
 * against marches, and the extrapolation on values whose limit is known. */
#include <math.h>
#include <stdlib.h>

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
    s.judge = &br_judge_fine;
    s.reference_method = s.method;
    s.reference = finer;
    s.n = &meshes[i], s.steps = &steps[j];
    s.n_count = s.k_count = 1;
    MUST(br_study_run(&s, 1, 1, NULL, &err));
    for (int part = 0; part < BR_PARTS; part++)
        assert_true(s.cell[0].error[part] == cell->error[part]);
    br_study_clear(&s);
}

static void check_tips(const struct br_scene *scene, const struct br_tips *tips)
{
    const struct br_method method = br_method_default();
    for (size_t i = 0; i < ROWS; i++)
        for (size_t j = 0; j < COLUMNS; j++) {
            struct br_march *march = br_test_march(scene, meshes[i], steps[j], &method);
            br_test_advance(march, steps[j]);
            for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
                assert_true(tips->value[kind][i * COLUMNS + j] ==
                            br_march_tip_displacement(march, (enum br_field_kind)kind));
            br_march_free(march);
        }
}

TEST(test_differences)
{
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled("example4");
    struct br_study grid[NORMS];
    make_grid(&scene, grid);
    struct br_differences out[NORMS];
    struct br_tips tips = {0};
    MUST(br_differences_run(grid, out, &tips, 2, NULL, &err));
    for (size_t m = 0; m < NORMS; m++) {
        assert_true(out[m].over[BR_AXIS_SPACE].norm == br_norms[m] && out[m].over[BR_AXIS_TIME].norm == br_norms[m]);
        assert_true(out[m].over[BR_AXIS_SPACE].n_count == ROWS - 1 && out[m].over[BR_AXIS_SPACE].k_count == COLUMNS);
        assert_true(out[m].over[BR_AXIS_TIME].n_count == ROWS && out[m].over[BR_AXIS_TIME].k_count == COLUMNS - 1);
        for (size_t i = 0; i < ROWS - 1; i++)
            for (size_t j = 0; j < COLUMNS; j++)
                check_cell(&out[m].over[BR_AXIS_SPACE], i, j, (struct br_resolution){meshes[i + 1], steps[j]});
        for (size_t i = 0; i < ROWS; i++)
            for (size_t j = 0; j < COLUMNS - 1; j++)
                check_cell(&out[m].over[BR_AXIS_TIME], i, j, (struct br_resolution){meshes[i], steps[j + 1]});
        br_study_clear(&out[m].over[BR_AXIS_SPACE]);
        br_study_clear(&out[m].over[BR_AXIS_TIME]);
    }
    check_tips(&scene, &tips);
    br_tips_clear(&tips);
    br_scene_clear(&scene);
}

TEST(test_refusals)
{
    struct br_scene scene = br_test_bundled("example2");
    static const size_t odd[] = {10, 15};
    static const struct {
        size_t n_count, k_count;
        const size_t *n, *steps;
        const char *message;
    } bad[] = {
        {1, 2, meshes, steps, "found 1 meshes and 2 time steps, expected at least two"},
        {2, 1, meshes, steps, "found 2 meshes and 1 time steps, expected at least two"},
        {2, 2, odd, steps, "n = 10 does not divide n = 15"},
        {2, 2, meshes, odd, "the time levels of k = 0.1 s are not all among those of"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct br_error err = {0};
        struct br_study grid[NORMS];
        make_grid(&scene, grid);
        grid[0].n_count = bad[i].n_count, grid[0].n = bad[i].n;
        grid[0].k_count = bad[i].k_count, grid[0].steps = bad[i].steps;
        struct br_differences out[NORMS];
        struct br_tips tips = {0};
        REFUSED(br_differences_run(grid, out, &tips, 1, NULL, &err), BR_BAD_INPUT, bad[i].message);
    }
    br_scene_clear(&scene);
}

/* ---- extrapolation ---- */

TEST(test_extrapolation)
{
    static const struct {
        double c_h, p, q, cross;
        size_t rows, columns;
        double off[2], width[2]; /* from, to: from 3, and of the interval; NaN: there is none */
    } rows[] = {
        {0.5, 2, 1, 0, ROWS, COLUMNS, {0, 1e-9}, {0, 1e-8}},
        /* orders that are none of theory: nothing is stated */
        {0.5, 1.5, 1, 0, ROWS, COLUMNS, {NAN, NAN}, {NAN, NAN}},
        {0.5, 2, 0.7, 0, ROWS, COLUMNS, {NAN, NAN}, {NAN, NAN}},
        /* terms of higher order: off, and the interval says so */
        {0.5, 2, 1, 2, ROWS, COLUMNS, {1e-6, INFINITY}, {0, INFINITY}},
        /* nothing changes over h */
        {0, 2, 1, 0, ROWS, COLUMNS, {0, 1e-9}, {0, 1e-9}},
        /* two grids tell no order */
        {0.5, 2, 1, 0, ROWS, 2, {NAN, NAN}, {NAN, NAN}},
        {0.5, 2, 1, 0, 2, COLUMNS, {NAN, NAN}, {NAN, NAN}},
    };
    struct br_scene scene = br_test_bundled("example2");
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        struct br_error err = {0};
        struct br_study grid[NORMS];
        struct br_tips tips;
        make_grid(&scene, grid);
        grid[0].n_count = rows[r].rows, grid[0].k_count = rows[r].columns;
        MUST(br_tips_create(&tips, grid, &err));
        for (size_t i = 0; i < rows[r].rows * rows[r].columns; i++) {
            const double h = 1 / (double)meshes[i / rows[r].columns],
                         k = 1 / (double)steps[i % rows[r].columns];
            tips.value[BR_AXIAL][i] = 3 + rows[r].c_h * pow(h, rows[r].p) -
                                      0.25 * pow(k, rows[r].q) + rows[r].cross * k * k * k;
        }
        const struct br_estimate e = br_extrapolate(&tips, BR_AXIAL);
        const double off = fabs(e.value - 3), width = e.high - e.low;
        if (isnan(rows[r].off[0])
                ? !isnan(e.value)
                : !(off >= rows[r].off[0] && off <= rows[r].off[1] && e.low <= 3 && 3 <= e.high &&
                    width >= rows[r].width[0] && width <= rows[r].width[1]))
            fail_msg("row %zu: %g from %g to %g", r, e.value, e.low, e.high);
        br_tips_clear(&tips);
    }
    br_scene_clear(&scene);
}

/* Nothing is stated of values that swing, that do not change with k, or that are not known. */
TEST(test_no_order)
{
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled("example2");
    struct br_study grid[NORMS];
    make_grid(&scene, grid);
    struct br_tips tips;
    MUST(br_tips_create(&tips, grid, &err));
    assert_true(isnan(br_extrapolate(&tips, BR_BENDING).value));
    for (int kind = 0; kind < 3; kind++) {
        for (size_t i = 0; i < ROWS * COLUMNS; i++)
            tips.value[BR_BENDING][i] = 5 + (kind == 0   ? (i % COLUMNS % 2 ? 0.01 : -0.01)
                                             : kind == 1 ? 0
                                                         : 1 / (double)steps[i % COLUMNS]);
        const struct br_estimate e = br_extrapolate(&tips, BR_BENDING);
        assert_true(isnan(e.value) == (kind < 2) && isnan(e.low) == (kind < 2));
    }
    tips.value[BR_BENDING][ROWS * COLUMNS - 1] = (double)NAN;
    assert_true(isnan(br_extrapolate(&tips, BR_BENDING).value));
    br_tips_clear(&tips);
    br_scene_clear(&scene);
}
