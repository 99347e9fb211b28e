/* SPDX-License-Identifier: GPL-3.0-or-later */
/* L2 distances on nested meshes against Gauss quadrature in long double (support.c). */
#include <math.h>
#include <stdlib.h>

#include "solver/modes.h"
#include "study/grid/ladder.h"
#include "support.h"

static const double length = 1.75;

static struct br_field field_of(enum br_field_kind kind, size_t n)
{
    return (struct br_field){.kind = kind, .n = n, .h = length / (double)n};
}

/* Random nodal values; bending slopes scaled by h as they should be. */
static double *random_function(struct br_test_random *r, const struct br_field *f)
{
    const size_t size = br_field_size(f);
    double *nodal = calloc(size, sizeof *nodal);
    assert_non_null(nodal);
    for (size_t i = br_field_unknowns(f); i < size; i++)
        nodal[i] = br_test_uniform(r, -1, 1);
    return nodal;
}

static struct br_view view_of(const struct br_field *f, const double *nodal)
{
    struct br_view view;
    br_view_field(&view, f, BR_DISPLACEMENT);
    view.values = (double *)(uintptr_t)nodal;
    return view;
}

static struct br_store store; /* of the ladders of a test */

static struct br_ladder *create(enum br_field_kind kind, size_t finest, size_t count,
                                const size_t *n)
{
    struct br_error err = {0};
    struct br_ladder *ladder;
    MUST(br_ladder_create(&ladder, br_mode_count((struct br_elements){kind, 1}, BR_DISPLACEMENT),
                          &(struct br_mesh_list){1, &finest}, &(struct br_mesh_list){count, n},
                          &store, &err));
    return ladder;
}

static double *projection_of(const struct br_ladder *ladder, const struct br_field *f,
                             const double *nodal)
{
    const struct br_view view = view_of(f, nodal);
    double *projection = calloc(br_ladder_size(ladder), sizeof *projection);
    assert_non_null(projection);
    br_ladder_project(ladder, &view, projection);
    return projection;
}

static double distance(const struct br_ladder *ladder, size_t rung, const struct br_field *f,
                       const double *nodal, const double *projection)
{
    const struct br_view view = view_of(f, nodal);
    return br_ladder_distance(ladder, rung, &view, projection);
}

/* Ladders: chains, gaps, branches that do not divide each other, duplicates, the
 * finest mesh itself, and ratios from 1 to 128. */
static const struct {
    size_t finest, count, n[5];
} ladders[] = {
    {1, 1, {1}},           {8, 1, {8}},     {8, 3, {1, 2, 4}}, {9, 2, {1, 3}},
    {25, 2, {5, 1}},       {12, 2, {4, 6}}, {30, 2, {10, 15}}, {30, 5, {6, 10, 15, 1, 30}},
    {16, 4, {4, 4, 8, 2}}, {128, 1, {1}},   {640, 2, {5, 40}}, {384, 3, {3, 128, 96}},
    {77, 3, {7, 11, 1}},
};
enum { LADDERS = sizeof ladders / sizeof *ladders };

static void check_ladder(struct br_test_random *r, enum br_field_kind kind, size_t l)
{
    const struct br_field fine = field_of(kind, ladders[l].finest);
    struct br_ladder *ladder = create(kind, fine.n, ladders[l].count, ladders[l].n);
    double *reference = random_function(r, &fine);
    double *projection = projection_of(ladder, &fine, reference);
    for (size_t rung = 0; rung < ladders[l].count; rung++) {
        const struct br_field coarse = field_of(kind, ladders[l].n[rung]);
        double *v = random_function(r, &coarse);
        const double d = distance(ladder, rung, &coarse, v, projection);
        CLOSE(d, br_test_distance(kind, length, coarse.n, v, fine.n, reference), 1e-14);
        free(v);
    }
    free(projection);
    free(reference);
    br_store_clear(&store);
}

TEST(test_random_functions)
{
    struct br_test_random r = {3};
    for (int repeat = 0; repeat < 20; repeat++)
        for (size_t l = 0; l < LADDERS; l++)
            for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
                check_ladder(&r, (enum br_field_kind)kind, l);
}

/* The coarse function written on the fine mesh, plus something small. */
static double *prolonged(const struct br_field *coarse, const double *v,
                         const struct br_field *fine, const double *small, double factor)
{
    const size_t ratio = fine->n / coarse->n, unknowns = br_field_unknowns(fine);
    double *nodal = calloc(br_field_size(fine), sizeof *nodal);
    assert_non_null(nodal);
    for (size_t j = 0; j <= fine->n; j++) {
        const size_t e = j == fine->n ? coarse->n - 1 : j / ratio;
        const long double xi = (long double)(j - e * ratio) / (long double)ratio;
        const long double eta = 1 - xi;
        nodal[j * unknowns] = (double)(br_test_value(fine->kind, v, e, xi) +
                                       (long double)factor * small[j * unknowns]);
        if (fine->kind == BR_AXIAL)
            continue;
        const double *w = v + 2 * e;
        const long double slope = 6 * xi * eta * ((long double)w[2] - w[0]) +
                                  eta * (1 - 3 * xi) * w[1] - xi * (2 - 3 * xi) * w[3];
        nodal[2 * j + 1] =
            (double)(slope / (long double)ratio + (long double)factor * small[2 * j + 1]);
    }
    return nodal;
}

/* Functions that agree to 1e-9: the distance still has six digits; with the square of a
 * norm less another's it would have none. And none at all: round-off only. */
TEST(test_close_functions)
{
    struct br_test_random r = {4};
    for (size_t l = 0; l < LADDERS; l++)
        for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
            for (size_t rung = 0; rung < ladders[l].count; rung++) {
                const struct br_field fine = field_of((enum br_field_kind)kind, ladders[l].finest);
                const struct br_field coarse =
                    field_of((enum br_field_kind)kind, ladders[l].n[rung]);
                struct br_ladder *ladder =
                    create(fine.kind, fine.n, ladders[l].count, ladders[l].n);
                double *v = random_function(&r, &coarse), *small = random_function(&r, &fine);
                for (int i = 0; i < 2; i++) {
                    const double factor = i ? 1e-9 : 0;
                    double *reference = prolonged(&coarse, v, &fine, small, factor);
                    double *projection = projection_of(ladder, &fine, reference);
                    CLOSE(distance(ladder, rung, &coarse, v, projection),
                          br_test_distance(fine.kind, length, coarse.n, v, fine.n, reference),
                          2e-15);
                    free(projection);
                    free(reference);
                }
                free(small);
                free(v);
                br_store_clear(&store);
            }
}

/* |x| and |x^3| over [0, L]: L^3/3 and L^7/7 under the root. */
TEST(test_norms)
{
    const size_t n = 6;
    const struct br_field rod = field_of(BR_AXIAL, n), beam = field_of(BR_BENDING, n);
    double u[7], w[14], zero[14] = {0};
    for (size_t i = 0; i <= n; i++) {
        const double x = rod.h * (double)i;
        u[i] = x;
        w[2 * i] = x * x * x;
        w[2 * i + 1] = rod.h * 3 * x * x;
    }
    struct br_ladder *ladder[2] = {create(BR_AXIAL, n, 1, &n), create(BR_BENDING, n, 1, &n)};
    double *projection = projection_of(ladder[0], &rod, u);
    CLOSE(distance(ladder[0], 0, &rod, zero, projection), sqrt(pow(length, 3) / 3), 1e-14);
    free(projection);
    projection = projection_of(ladder[1], &beam, w);
    CLOSE(distance(ladder[1], 0, &beam, zero, projection), sqrt(pow(length, 7) / 7), 1e-14);
    free(projection);
    br_store_clear(&store);
}

TEST(test_refusals)
{
    struct br_error err = {0};
    struct br_ladder *ladder;
    const struct br_mesh_list twelve = {1, (const size_t[]){12}};
    REFUSED(br_ladder_create(&ladder, 2, &twelve, &(struct br_mesh_list){2, (const size_t[]){4, 5}},
                             &store, &err),
            BR_BAD_INPUT, "n = 5 does not divide the reference's 12");
    br_store_clear(&store);
    REFUSED(br_ladder_create(&ladder, 2, &twelve, &(struct br_mesh_list){1, (const size_t[]){0}},
                             &store, &err),
            BR_BAD_INPUT, "n is 0");
    br_store_clear(&store);
}

TEST(test_nan_stays)
{
    const size_t n[] = {2};
    struct br_ladder *ladder = create(BR_BENDING, 4, 1, n);
    const struct br_field fine = field_of(BR_BENDING, 4), coarse = field_of(BR_BENDING, 2);
    double good[10] = {0}, bad[10] = {0};
    bad[5] = NAN;
    double *projection = projection_of(ladder, &fine, bad);
    assert_true(isnan(distance(ladder, 0, &coarse, good, projection)));
    free(projection);
    projection = projection_of(ladder, &fine, good);
    assert_true(distance(ladder, 0, &coarse, good, projection) == 0);
    assert_true(isnan(distance(ladder, 0, &coarse, bad, projection)));
    free(projection);
    br_store_clear(&store);
}
