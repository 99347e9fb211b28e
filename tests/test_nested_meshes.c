/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ladders with every kernel, and functions in every layout, against the definitions of
 * solver/modes.h and Gauss quadrature in long double: nothing is projected there. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solver/linear/linear_solver.h"
#include "study/grid/nested_meshes.h"
#include "support.h"

typedef long double real;

enum { MOST_FINE = 1000, MOST_RATIO = 128, ROOM = (MOST_FINE + BR_MOST_LANES) * BR_MOST_MODES };

/* A function and its modes, element by element. */
struct sample {
    struct br_view view;
    size_t n;
    double values[ROOM];
    real modes[ROOM];
};

/* ---- functions ---- */

static void node_modes(const struct sample *s, size_t e, real *modes)
{
    const double *v = s->values + e * ((s->view.modes + 1) / 2);
    if (s->view.modes == 2) {
        modes[0] = (real)v[0] + v[1];
        modes[1] = (real)v[1] - v[0];
        return;
    }
    if (s->view.modes == 3) {
        modes[0] = (real)v[0] + v[2] - (real)v[3] / 3;
        modes[1] = (real)v[2] - v[0];
        modes[2] = v[3];
        return;
    }
    const real w = (real)v[0] + v[2], d = (real)v[2] - v[0], sum = (real)v[1] + v[3],
               c = (real)v[3] - v[1];
    modes[0] = w - c / 6;
    modes[1] = d - sum / 12;
    modes[2] = c;
    modes[3] = sum - 2 * d;
}

/* Random values, or, where modes are `wanted`, by element or in lanes, these and a little more.
 * Nothing must be read beyond what the layout has: there is NaN, as in the lanes' gaps. */
static void fill(struct br_test_random *r, struct sample *s, enum br_layout layout, size_t modes,
                 size_t n, size_t lanes, const real *wanted, double little)
{
    br_view_modes(&s->view, modes);
    s->view.layout = layout;
    s->view.values = s->values;
    s->n = n;
    for (size_t i = 0; i < ROOM; i++)
        s->values[i] = NAN;
    for (size_t i = 0; i < modes && layout != BR_IN_LANES; i++)
        s->view.scale[i] = br_test_uniform(r, 0.5, 2);
    for (size_t i = 0; i < (n + 1) * ((modes + 1) / 2) && layout == BR_BY_NODE; i++)
        s->values[i] = br_test_uniform(r, -1, 1);
    for (size_t e = 0; e < n; e++) {
        real *mode = s->modes + e * modes;
        for (size_t i = 0; i < modes && layout != BR_BY_NODE; i++) {
            const size_t at = layout == BR_BY_ELEMENT ? e * modes + i
                                                      : (e / lanes * modes + i) * lanes + e % lanes;
            const real exact = wanted ? wanted[e * modes + i] / s->view.scale[i] : 0;
            mode[i] = s->values[at] = (double)(exact + little * br_test_uniform(r, -1, 1));
        }
        if (layout == BR_BY_NODE)
            node_modes(s, e, mode);
        for (size_t i = 0; i < modes; i++)
            mode[i] *= s->view.scale[i];
    }
}

/* ---- the oracle ---- */

/* Orthonormal on [0, 1]. */
static real legendre(size_t i, real x)
{
    const real y = 2 * x - 1;
    const real p[] = {1, y, (3 * y * y - 1) / 2, y * (5 * y * y - 3) / 2};
    return sqrtl(2 * (real)i + 1) * p[i];
}

/* Mode i of child j of an element, from the element's mode m: by four Gauss points. */
static real transfer(size_t ratio, size_t j, size_t i, size_t m)
{
    const real a = sqrtl(3.0L / 7 - 2.0L / 7 * sqrtl(1.2L)),
               b = sqrtl(3.0L / 7 + 2.0L / 7 * sqrtl(1.2L));
    const real x[] = {(1 - b) / 2, (1 - a) / 2, (1 + a) / 2, (1 + b) / 2};
    real sum = 0;
    for (int q = 0; q < 4; q++)
        sum += (q % 3 ? 18 + sqrtl(30) : 18 - sqrtl(30)) / 72 * legendre(i, x[q]) *
               legendre(m, ((real)j + x[q]) / (real)ratio);
    return sum / sqrtl((real)ratio);
}

/* The same function on `ratio` times as many elements: its modes (out). */
static void refine(const struct sample *coarse, size_t ratio, real *modes)
{
    const size_t count = coarse->view.modes;
    for (size_t j = 0; j < ratio; j++)
        for (size_t i = 0; i < count; i++)
            for (size_t m = 0; m < count; m++) {
                const real e = transfer(ratio, j, i, m);
                for (size_t p = 0; p < coarse->n; p++) {
                    real *mode = &modes[(p * ratio + j) * count + i];
                    *mode = (m ? *mode : 0) + e * coarse->modes[p * count + m];
                }
            }
}

/* Of modes from others, or, where these are NULL, from zero. */
static double distance(const real *a, const real *b, size_t count)
{
    real sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += (a[i] - (b ? b[i] : 0)) * (a[i] - (b ? b[i] : 0));
    return (double)sqrtl(sum);
}

/* ---- nested meshes ---- */

/* Chains, gaps, branches that do not divide each other, duplicates, the finest mesh itself, one
 * element, ratios from 1 to 128; meshes that fill vectors, and those that leave some elements. */
static const struct {
    size_t finest, count, n[5];
} sequences[] = {
    {1, 1, {1}},           {8, 1, {8}},          {8, 3, {1, 2, 4}},  {9, 2, {1, 3}},
    {25, 2, {5, 1}},       {12, 2, {4, 6}},      {30, 2, {10, 15}},  {30, 5, {6, 10, 15, 1, 30}},
    {16, 4, {4, 4, 8, 2}}, {128, 1, {1}},        {640, 2, {5, 40}},  {384, 3, {3, 128, 96}},
    {77, 3, {7, 11, 1}},   {840, 3, {40, 7, 8}}, {340, 2, {17, 85}}, {992, 3, {31, 248, 62}},
    {9, 1, {9}},           {34, 1, {17}},        {60, 2, {15, 3}},   {840, 4, {105, 56, 140, 168}},
    {13, 1, {13}},         {216, 2, {12, 27}},
};
enum { SEQUENCES = sizeof sequences / sizeof *sequences };

static const enum br_layout layouts[] = {BR_BY_ELEMENT, BR_BY_NODE, BR_IN_LANES};

struct trial {
    struct br_test_random r;
    const struct br_nested_meshes_kernel *kernel;
    size_t row, modes;
    struct br_nested_meshes *nested;
    double *projection;
};

static double far(const struct trial *t, size_t level, const struct sample *v)
{
    return br_nested_meshes_distance(t->nested, level, &v->view, t->projection);
}

/* A function from the projected one; and one that is the same but for a little, or not even that:
 * with the square of a norm less another's the distance would have no digit. */
static void check_mesh(struct trial *t, size_t level, struct sample *fine, enum br_layout layout)
{
    static struct sample v;
    static real refined[ROOM];
    const size_t n = sequences[t->row].n[level], all = fine->n * t->modes;
    fill(&t->r, &v, layout, t->modes, n, t->kernel->lanes, NULL, 1);
    refine(&v, fine->n / n, refined);
    CLOSE(far(t, level, &v), distance(fine->modes, refined, all), 5e-14);
    for (int same = 0; same < 2 && fine->view.layout != BR_BY_NODE; same++) {
        fill(&t->r, fine, fine->view.layout, t->modes, fine->n, t->kernel->lanes, refined,
             same ? 0 : 1e-9);
        br_nested_meshes_project(t->nested, &fine->view, t->projection);
        CLOSE(far(t, level, &v), distance(fine->modes, refined, all),
              1e-14 * (1 + distance(refined, NULL, all)));
    }
    v.values[0] = NAN;
    assert_true(isnan(far(t, level, &v)));
}

/* The norm of what is projected is that of the function, with what the view says is missing. */
static void check_meshes(struct trial *t, enum br_layout layout)
{
    static struct sample fine;
    const size_t levels = sequences[t->row].count, n = sequences[t->row].finest;
    for (size_t level = 0; level < levels; level++) {
        fill(&t->r, &fine, layout, t->modes, n, t->kernel->lanes, NULL, 1);
        const double norm = distance(fine.modes, NULL, n * t->modes);
        for (int rest = 1; rest >= 0; rest--) {
            for (size_t i = 0; i < br_nested_meshes_size(t->nested); i++)
                t->projection[i] = NAN;
            fine.view.rest = 0.25 * rest;
            br_nested_meshes_project(t->nested, &fine.view, t->projection);
            CLOSE(br_nested_meshes_norm(t->nested, t->projection), sqrt(norm * norm + 0.25 * rest),
                  2e-15 * (1 + norm));
        }
        check_mesh(t, level, &fine, layouts[br_test_index(&t->r, t->modes == 1 ? 1 : 3)]);
    }
    fine.values[0] = NAN;
    br_nested_meshes_project(t->nested, &fine.view, t->projection);
    assert_true(isnan(br_nested_meshes_norm(t->nested, t->projection)));
}

static void check_row(struct trial *t)
{
    OWNED(br_store) store = {0};
    const struct br_mesh_list root = {1, &sequences[t->row].finest},
                              levels = {sequences[t->row].count, sequences[t->row].n};
    MUST(br_nested_meshes_create(&t->nested, t->modes, &root, &levels, &store, &err));
    br_nested_meshes_use(t->nested, t->kernel);
    t->projection = br_store_take(&store, br_nested_meshes_size(t->nested), sizeof *t->projection);
    assert_non_null(t->projection);
    for (int i = 0; i < 3; i++)
        if (layouts[i] != BR_BY_NODE || t->modes > 1)
            check_meshes(t, layouts[i]);
}

TEST(test_all_kernels)
{
    struct trial t = {.r = {6}};
    for (const struct br_nested_meshes_kernel *const *kernel = br_nested_meshes_kernels; *kernel;
         kernel++)
        for (t.modes = 1; t.modes <= 4 && (*kernel)->available(); t.modes++)
            for (t.row = 0; t.row < SEQUENCES; t.row++) {
                t.kernel = *kernel;
                check_row(&t);
            }
    assert_true(br_nested_meshes_kernels[br_instruction_set_best()]->available());
}

TEST(test_refusals)
{
    static const struct {
        size_t n[2];
        const char *message;
    } rows[] = {{{4, 5}, "n = 5 does not divide the reference's 12"}, {{0, 1}, "n is 0"}};
    const struct br_mesh_list twelve = {1, (const size_t[]){12}};
    for (size_t i = 0; i < 2; i++) {
        struct br_nested_meshes *nested;
        OWNED(br_store) store = {0};
        REFUSED(br_nested_meshes_create(&nested, 2, &twelve, &(struct br_mesh_list){2, rows[i].n},
                                        &store, &err),
                BR_BAD_INPUT, rows[i].message);
    }
}

/* --kernel forces both: every kernel of the solver has its counterpart here. */
TEST(test_counterparts)
{
    for (const struct br_kernel *const *k = br_kernels; *k; k++) {
        const struct br_nested_meshes_kernel *other =
            br_nested_meshes_kernels[br_instruction_set_find((*k)->name)];
        assert_non_null(other);
        assert_string_equal(other->name, (*k)->name);
        assert_int_equal(other->available(), (*k)->available());
    }
    assert_null(br_nested_meshes_kernels[br_instruction_set_find("sse2")]);
}
