/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Printed tables, and the triangle inequality against printed values: sound ones, planted ones,
 * none. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reference/printed.h"
#include "solver/scene.h"
#include "study/fit/triangle.h"
#include "study/grid/sweep.h"
#include "support.h"

/* ---- the printed tables: all cells, their corners, and what stands between them ---- */

static const struct {
    const struct br_printed *table;
    double corner[4]; /* coarse and fine mesh with the largest step, then with the smallest one */
} tables[] = {
    {&br_printed_table1, {5.042e-3, 2.028e-4, 5.042e-3, 2.003e-4}},
    {&br_printed_table2, {1.522e-2, 1.498e-2, 5.944e-3, 5.549e-3}},
};

TEST(test_printed_cells)
{
    static const double k[] = {0.01, 0.005, 0.002, 0.001, 0.0005, 0.0001};
    for (size_t i = 0; i < 2; i++) {
        const struct br_printed *p = tables[i].table;
        assert_int_equal(p->count, 36);
        for (size_t n = 100; n <= 3200; n *= 2)
            for (int j = 0; j < 6; j++)
                assert_true(br_printed_error(p, n, k[j]) > 0);
        for (int c = 0; c < 4; c++)
            CLOSE(br_printed_error(p, c % 2 ? 3200 : 100, c < 2 ? 0.01 : 0.0001),
                  tables[i].corner[c], 0);
    }
}

TEST(test_what_is_not_printed)
{
    const struct br_printed *p = &br_printed_table1, none = {0};
    CLOSE(br_printed_error(p, 100, 0.01 * (1 + 1e-12)), 5.042e-3, 0); /* k = T/steps, rounded */
    assert_true(isnan(br_printed_error(p, 100, 0.0101)));
    assert_true(isnan(br_printed_error(p, 101, 0.01)));
    assert_true(isnan(br_printed_error(p, 6400, 0.01)));
    assert_true(isnan(br_printed_error(&none, 100, 0.01)));
}

/* ---- the inequality ---- */

enum { CELLS = 9 };

static const size_t n[3] = {10, 20, 40}, steps[3] = {10, 20, 100};

/* The state of the tests: a study of Example 2, run once. */
struct made {
    struct br_scene scene;
    struct br_study study;
};

static int make(void **state)
{
    static struct made made;
    made.scene = br_test_bundled("example2");
    made.study = br_test_study(&made.scene, &br_reference_exact, 3, n, 3, steps);
    MUST(br_study_run(&made.study, 1, 1, NULL, &err));
    *state = &made;
    return 0;
}

static int drop(void **state)
{
    struct made *made = *state;
    br_study_clear(&made->study);
    br_scene_clear(&made->scene);
    return 0;
}

/* As a paper would print it: four digits. */
static double four_digits(double x)
{
    char text[32];
    snprintf(text, sizeof text, "%.3e", x);
    return strtod(text, NULL);
}

/* Half of 0.001 in the leading digit's place, as %.3e prints. */
static double half_digit(double x)
{
    char text[32];
    snprintf(text, sizeof text, "%.3e", x);
    memcpy(text, "0.000", 5);
    char unit[32];
    snprintf(unit, sizeof unit, "0.0005%s", strchr(text, 'e'));
    return strtod(unit, NULL);
}

/* What the printed digits allow: |a - b| or a - b, and a + b, each with half a digit. */
static void check_allowed(const struct br_triangle *t)
{
    const double digits = half_digit(t->printed_a) + half_digit(t->printed_b);
    const double gap =
        t->a.steps == t->b.steps ? fabs(t->printed_a - t->printed_b) : t->printed_a - t->printed_b;
    CLOSE(t->least, fmax(0, gap - digits), 1e-12);
    CLOSE(t->most, t->printed_a + t->printed_b + digits, 1e-12);
    assert_int_equal(t->b.n % t->a.n, 0);
    assert_int_equal(t->b.steps % t->a.steps, 0); /* every level of a is one of b */
}

static size_t contradictions(const struct br_study *s, const double *printed)
{
    struct br_triangle triangle[4];
    size_t count, found = 0;
    MUST(br_triangles(s, printed, 4, triangle, &count, 1, &err));
    for (size_t i = 0; i < count; i++) {
        check_allowed(&triangle[i]);
        found += triangle[i].contradiction;
    }
    return found;
}

/* Sound ones; one cell much too large, which is too far from its neighbours; all much too small:
 * the solutions are farther apart than the sum of their errors; one alone, which contradicts
 * nothing. */
TEST(test_planted)
{
    static const struct {
        double first, others;
        bool wrong;
    } rows[] = {{1, 1, false}, {10, 1, true}, {2, 1, true}, {0.1, 0.1, true}, {1, NAN, false}};
    const struct br_study *s = &((const struct made *)*fixture)->study;
    for (size_t row = 0; row < sizeof rows / sizeof *rows; row++) {
        double printed[CELLS];
        for (size_t i = 0; i < CELLS; i++)
            printed[i] = four_digits(s->cell[i].error[BR_PART_TOTAL]) *
                         (i == 0 ? rows[row].first : rows[row].others);
        assert_true((contradictions(s, printed) > 0) == rows[row].wrong);
    }
}

/* Of many pairs that would do the cheapest is marched. */
TEST(test_cheapest)
{
    const struct br_study *s = &((const struct made *)*fixture)->study;
    struct br_triangle triangle;
    size_t count;
    double printed[CELLS];
    for (size_t i = 0; i < CELLS; i++)
        printed[i] = s->cell[i].error[BR_PART_TOTAL] / 10;
    MUST(br_triangles(s, printed, 1, &triangle, &count, 1, &err));
    assert_int_equal(count, 1);
    assert_true(triangle.contradiction);
    assert_int_equal(triangle.a.n * triangle.a.steps, 10 * 10);
    assert_int_equal(triangle.b.n * triangle.b.steps, 10 * 20);
}

/* With unequal time levels the finer cell's error may well be the larger; with equal ones
 * the two may not be further apart than the solutions. */
TEST(test_unequal_levels)
{
    const struct br_study *s = &((const struct made *)*fixture)->study;
    double printed[CELLS];
    size_t tried[2] = {0};
    for (size_t j = 1; j < CELLS; j++) {
        const struct br_resolution a = s->cell[0].at, b = s->cell[j].at;
        if (b.n % a.n != 0 || b.steps % a.steps != 0)
            continue;
        for (size_t i = 0; i < CELLS; i++)
            printed[i] = NAN;
        const double coarse = s->cell[0].error[BR_PART_TOTAL];
        printed[0] = four_digits(coarse);
        printed[j] = four_digits(50 * coarse);
        const bool same = a.steps == b.steps;
        assert_int_equal(contradictions(s, printed), same ? 1 : 0);
        tried[same]++;
    }
    assert_true(tried[false] > 0 && tried[true] > 0);
}

AROUND_TESTS(make, drop)
