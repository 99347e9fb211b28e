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
        assert_true(out[m].over_h.norm == br_norms[m] && out[m].over_k.norm == br_norms[m]);
        assert_true(out[m].over_h.n_count == ROWS - 1 && out[m].over_h.k_count == COLUMNS);
        assert_true(out[m].over_k.n_count == ROWS && out[m].over_k.k_count == COLUMNS - 1);
        for (size_t i = 0; i < ROWS - 1; i++)
            for (size_t j = 0; j < COLUMNS; j++)
                check_cell(&out[m].over_h, i, j, (struct br_resolution){meshes[i + 1], steps[j]});
        for (size_t i = 0; i < ROWS; i++)
            for (size_t j = 0; j < COLUMNS - 1; j++)
                check_cell(&out[m].over_k, i, j, (struct br_resolution){meshes[i], steps[j + 1]});
        br_study_clear(&out[m].over_h);
        br_study_clear(&out[m].over_k);
    }
    check_tips(&scene, &tips);
    br_tips_clear(&tips);
    br_scene_clear(&scene);
}

/* The orders that the differences of a smooth march show, with no reference at all. */
TEST(test_orders)
{
    static const size_t doubling[] = {8, 16, 32, 64}, halving[] = {100, 200, 400, 800};
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled("example2");
    struct br_study grid[NORMS];
    make_grid(&scene, grid);
    grid[0].n = doubling, grid[0].n_count = 4;
    grid[0].steps = halving, grid[0].k_count = 4;
    grid[0].next_norm = NULL;
    struct br_differences out;
    struct br_tips tips = {0};
    MUST(br_differences_run(grid, &out, &tips, 2, NULL, &err));
    static const double orders[BR_PARTS] = {0, 2, 4};
    for (int part = BR_PART_AXIAL; part < BR_PARTS; part++) {
        struct br_fits over_h, over_k;
        MUST(br_fit(&out.over_h, (enum br_part)part, &over_h, &err));
        MUST(br_fit(&out.over_k, (enum br_part)part, &over_k, &err));
        assert_true(over_h.joint.kind == BR_JOINT_SPACE && over_k.joint.kind == BR_JOINT_TIME);
        CLOSE(over_h.joint.order[0].value, orders[part], 0.02);
        AT_MOST(over_h.joint.order[0].high - over_h.joint.order[0].low, 0.1);
        CLOSE(over_k.joint.order[1].value, 1, 0.05);
        br_fits_clear(&over_h);
        br_fits_clear(&over_k);
    }
    br_study_clear(&out.over_h);
    br_study_clear(&out.over_k);
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

struct truth {
    double limit, c_h, p, c_k, q, cross;
};

static struct br_estimate extrapolated(const struct truth *t, size_t rows, size_t columns)
{
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled("example2");
    struct br_study grid[NORMS];
    make_grid(&scene, grid);
    grid[0].n_count = rows, grid[0].k_count = columns;
    struct br_tips tips;
    MUST(br_tips_create(&tips, grid, &err));
    for (size_t i = 0; i < rows; i++)
        for (size_t j = 0; j < columns; j++) {
            const double h = 1 / (double)meshes[i], k = 1 / (double)steps[j];
            tips.value[BR_AXIAL][i * columns + j] =
                t->limit + t->c_h * pow(h, t->p) + t->c_k * pow(k, t->q) + t->cross * k * k * k;
        }
    const struct br_estimate e = br_extrapolate(&tips, BR_AXIAL);
    br_tips_clear(&tips);
    br_scene_clear(&scene);
    return e;
}

TEST(test_extrapolation)
{
    const struct truth exact = {3, 0.5, 2, -0.25, 1, 0};
    struct br_estimate e = extrapolated(&exact, ROWS, COLUMNS);
    CLOSE(e.value, 3, 1e-9);
    assert_true(e.low <= 3 && 3 <= e.high && e.high - e.low <= 1e-8);
    /* orders that are not the formal ones: found all the same, with a wider interval */
    const struct truth odd = {3, 0.5, 1.5, -0.25, 0.7, 0};
    e = extrapolated(&odd, ROWS, COLUMNS);
    CLOSE(e.value, 3, 1e-8);
    assert_true(e.low <= 3 && 3 <= e.high && e.high - e.low > 1e-3);
    /* terms of higher order: off, and the interval says so */
    const struct truth rough = {3, 0.5, 2, -0.25, 1, 2};
    e = extrapolated(&rough, ROWS, COLUMNS);
    assert_true(fabs(e.value - 3) > 1e-6 && e.low <= 3 && 3 <= e.high);
    /* nothing changes over h */
    const struct truth still = {3, 0, 2, -0.25, 1, 0};
    e = extrapolated(&still, ROWS, COLUMNS);
    assert_true(e.low <= 3 && 3 <= e.high && e.high - e.low <= 1e-9);
    /* two grids tell no order */
    assert_true(isnan(extrapolated(&exact, ROWS, 2).value));
    assert_true(isnan(extrapolated(&exact, 2, COLUMNS).value));
}

/* Values that swing show no order: the last one, with a wide interval. A failed cell: none. */
TEST(test_no_order)
{
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled("example2");
    struct br_study grid[NORMS];
    make_grid(&scene, grid);
    struct br_tips tips;
    MUST(br_tips_create(&tips, grid, &err));
    assert_true(isnan(br_extrapolate(&tips, BR_BENDING).value));
    for (size_t i = 0; i < ROWS; i++)
        for (size_t j = 0; j < COLUMNS; j++)
            tips.value[BR_BENDING][i * COLUMNS + j] = 5 + (j % 2 ? 0.01 : -0.01);
    struct br_estimate e = br_extrapolate(&tips, BR_BENDING);
    CLOSE(e.value, 5.01, 1e-12);
    CLOSE(e.high - e.value, 0.06, 1e-9);
    for (size_t i = 0; i < ROWS; i++) /* the coarsest cells failed: the others will do */
        tips.value[BR_BENDING][i * COLUMNS] = (double)NAN;
    e = br_extrapolate(&tips, BR_BENDING);
    CLOSE(e.value, 5.01, 1e-12);
    tips.value[BR_BENDING][ROWS * COLUMNS - 1] = (double)NAN;
    assert_true(isnan(br_extrapolate(&tips, BR_BENDING).value));
    br_tips_clear(&tips);
    br_scene_clear(&scene);
}
