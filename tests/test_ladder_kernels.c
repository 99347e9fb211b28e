/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every kernel of the ladder, with functions in every layout, against the definitions of
 * solver/modes.h and Gauss quadrature in long double. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "study/grid/ladder.h"
#include "support.h"

typedef long double real;

enum { MOST_N = 40, MOST_RATIO = 21, MOST_FINE = MOST_N * MOST_RATIO };

static const size_t ns[] = {1, 2, 3, 5, 7, 8, 9, 15, 16, 17, 31, 40};
static const size_t ratios[] = {1, 2, 3, 4, 5, 6, 7, 8, 12, 18, 21};
enum { NS = sizeof ns / sizeof *ns, RATIOS = sizeof ratios / sizeof *ratios };

/* A function and its modes, element by element. */
struct sample {
    struct br_view view;
    size_t n;
    double values[MOST_FINE * BR_MOST_MODES + BR_MOST_LANES * BR_MOST_MODES];
    real modes[MOST_FINE * BR_MOST_MODES];
};

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

/* values must not be read beyond what the layout has: there is NaN, as in the lanes' gaps. */
static void fill(struct br_test_random *r, struct sample *s, enum br_layout layout, size_t modes,
                 size_t n, size_t lanes)
{
    br_view_modes(&s->view, modes);
    s->view.layout = layout;
    s->view.values = s->values;
    s->n = n;
    for (size_t i = 0; i < sizeof s->values / sizeof *s->values; i++)
        s->values[i] = NAN;
    const size_t size = layout == BR_BY_NODE ? (n + 1) * ((modes + 1) / 2) : n * modes;
    for (size_t i = 0; i < size && layout != BR_IN_LANES; i++)
        s->values[i] = br_test_uniform(r, -1, 1);
    for (size_t i = 0; i < modes && layout != BR_IN_LANES; i++)
        s->view.scale[i] = br_test_uniform(r, 0.5, 2);
    for (size_t e = 0; e < n; e++) {
        real *mode = s->modes + e * modes;
        for (size_t i = 0; i < modes && layout == BR_IN_LANES; i++)
            mode[i] = s->values[(e / lanes * modes + i) * lanes + e % lanes] =
                br_test_uniform(r, -1, 1);
        for (size_t i = 0; i < modes && layout == BR_BY_ELEMENT; i++)
            mode[i] = s->values[e * modes + i];
        if (layout == BR_BY_NODE)
            node_modes(s, e, mode);
        for (size_t i = 0; i < modes; i++)
            mode[i] *= s->view.scale[i];
    }
}

/* Orthonormal on [0, 1]. */
static real legendre(size_t i, real x)
{
    const real y = 2 * x - 1;
    const real p[] = {1, y, (3 * y * y - 1) / 2, y * (5 * y * y - 3) / 2};
    return sqrtl(2 * (real)i + 1) * p[i];
}

/* Four Gauss points on [0, 1]. */
static void gauss(real x[4], real weight[4])
{
    const real a = sqrtl(3.0L / 7 - 2.0L / 7 * sqrtl(1.2L)),
               b = sqrtl(3.0L / 7 + 2.0L / 7 * sqrtl(1.2L));
    const real wa = (18 + sqrtl(30)) / 72, wb = (18 - sqrtl(30)) / 72;
    const real points[] = {(1 - b) / 2, (1 - a) / 2, (1 + a) / 2, (1 + b) / 2};
    const real weights[] = {wb, wa, wa, wb};
    memcpy(x, points, sizeof points);
    memcpy(weight, weights, sizeof weights);
}

/* E_j[i][m] */
static real transfer(size_t ratio, size_t j, size_t i, size_t m)
{
    real x[4], weight[4], sum = 0;
    gauss(x, weight);
    for (int q = 0; q < 4; q++)
        sum += weight[q] * legendre(i, x[q]) * legendre(m, ((real)j + x[q]) / (real)ratio);
    return sum / sqrtl((real)ratio);
}

/* coarse: out, n * modes by element; returns what that loses. */
static real project(const struct sample *fine, size_t ratio, real *coarse)
{
    const size_t modes = fine->view.modes, n = fine->n / ratio;
    real loss = 0, e[MOST_RATIO][4][4];
    for (size_t j = 0; j < ratio; j++)
        for (size_t i = 0; i < modes; i++)
            for (size_t m = 0; m < modes; m++)
                e[j][i][m] = transfer(ratio, j, i, m);
    memset(coarse, 0, n * modes * sizeof *coarse);
    for (size_t p = 0; p < n; p++) {
        const real *x = fine->modes + p * ratio * modes;
        for (size_t j = 0; j < ratio; j++)
            for (size_t i = 0; i < modes; i++)
                for (size_t m = 0; m < modes; m++)
                    coarse[p * modes + m] += e[j][i][m] * x[j * modes + i];
        for (size_t j = 0; j < ratio; j++)
            for (size_t i = 0; i < modes; i++) {
                real rest = x[j * modes + i];
                for (size_t m = 0; m < modes; m++)
                    rest -= e[j][i][m] * coarse[p * modes + m];
                loss += rest * rest;
            }
    }
    return loss;
}

struct kernel_case {
    const struct br_ladder_kernel *kernel;
    enum br_layout layout;
    size_t modes;
};

static void check_project(struct br_test_random *r, const struct kernel_case *k, size_t n,
                          size_t ratio)
{
    static struct sample fine;
    static real coarse[MOST_N * BR_MOST_MODES];
    const size_t lanes = k->kernel->lanes;
    double e[(MOST_RATIO + 1) / 2 * BR_MOST_MODES * BR_MOST_MODES] = {0};
    double got[(MOST_N + BR_MOST_LANES) * BR_MOST_MODES];
    fill(r, &fine, k->layout, k->modes, n * ratio, lanes);
    for (size_t j = 0; 2 * j < ratio; j++)
        for (size_t i = 0; i < k->modes; i++)
            for (size_t m = i; m < k->modes; m++)
                e[(j * k->modes + i) * k->modes + m] = (double)transfer(ratio, j, i, m);
    for (size_t i = 0; i < sizeof got / sizeof *got; i++)
        got[i] = NAN;
    const struct br_projecting p = {
        .fine = fine.view, .n = n, .ratio = ratio, .transfer = e, .coarse = got};
    const double loss = k->kernel->project(&p);
    const double expected = (double)project(&fine, ratio, coarse);
    CLOSE(loss, expected, 1e-14 * fmax(1, expected));
    for (size_t i = 0; i < (n + lanes - 1) / lanes * lanes * k->modes; i++) {
        const size_t element = i / (lanes * k->modes) * lanes + i % lanes;
        const size_t mode = i / lanes % k->modes;
        CLOSE(got[i], element < n ? (double)coarse[element * k->modes + mode] : 0,
              element < n ? 2e-14 : 0);
    }
}

static void check_distance(struct br_test_random *r, const struct kernel_case *k, size_t n)
{
    static struct sample a, b;
    fill(r, &a, k->layout, k->modes, n, k->kernel->lanes);
    fill(r, &b, BR_IN_LANES, k->modes, n, k->kernel->lanes);
    real sum = 0;
    for (size_t i = 0; i < n * k->modes; i++)
        sum += (a.modes[i] - b.modes[i]) * (a.modes[i] - b.modes[i]);
    const size_t lanes = k->kernel->lanes;
    for (size_t i = n / lanes * lanes * k->modes; i < (n + lanes - 1) / lanes * lanes * k->modes;
         i++)
        if (isnan(b.values[i]))
            b.values[i] = 0; /* after the last element */
    CLOSE(k->kernel->distance(&a.view, n, b.values), (double)sum, 1e-14 * (double)sum);
}

TEST(test_all_kernels)
{
    static const enum br_layout layouts[] = {BR_BY_ELEMENT, BR_BY_NODE, BR_IN_LANES};
    struct br_test_random r = {6};
    for (const struct br_ladder_kernel *const *kernel = br_ladder_kernels; *kernel; kernel++)
        for (size_t c = 0; c < 12 && (*kernel)->available(); c++) {
            const struct kernel_case k = {*kernel, layouts[c % 3], 1 + c / 3};
            if (k.layout == BR_BY_NODE && k.modes == 1)
                continue;
            for (size_t i = 0; i < NS; i++) {
                check_distance(&r, &k, ns[i]);
                for (size_t j = 0; j < RATIOS; j++)
                    check_project(&r, &k, ns[i], ratios[j]);
            }
        }
    assert_true(br_ladder_kernels[br_instruction_set_best()]->available());
}

/* The norm of the projected function is that of the function, and every rung has the same
 * squares: what it keeps and what it has lost. */
TEST(test_norm)
{
    static struct sample root;
    static const size_t n = 60, rungs[] = {30, 20, 12, 5, 1};
    struct br_test_random r = {7};
    struct br_error err = {0};
    for (const struct br_ladder_kernel *const *kernel = br_ladder_kernels; *kernel; kernel++)
        for (size_t modes = 1; modes <= 4 && (*kernel)->available(); modes++) {
            struct br_ladder *ladder;
            struct br_store store = {0};
            MUST(br_ladder_create(&ladder, modes, &(struct br_mesh_list){1, &n},
                                  &(struct br_mesh_list){5, rungs}, &store, &err));
            br_ladder_use(ladder, *kernel);
            double *projection = malloc(br_ladder_size(ladder) * sizeof *projection);
            assert_non_null(projection);
            for (size_t i = 0; i < br_ladder_size(ladder); i++)
                projection[i] = NAN;
            fill(&r, &root, BR_BY_ELEMENT, modes, n, (*kernel)->lanes);
            root.view.rest = 0.25;
            br_ladder_project(ladder, &root.view, projection);
            real square = root.view.rest;
            for (size_t i = 0; i < n * modes; i++)
                square += root.modes[i] * root.modes[i];
            CLOSE(br_ladder_norm(ladder, projection), (double)sqrtl(square), 2e-14);
            struct br_view zero;
            br_view_modes(&zero, modes);
            zero.values = calloc(n * modes, sizeof *zero.values);
            assert_non_null(zero.values);
            for (size_t rung = 0; rung < 5; rung++)
                CLOSE(br_ladder_distance(ladder, rung, &zero, projection), (double)sqrtl(square),
                      2e-14);
            free(zero.values);
            free(projection);
            br_store_clear(&store);
        }
}

/* On one mesh nothing is rounded: a function is at no distance from itself. */
TEST(test_same_mesh)
{
    static struct sample s;
    static const size_t n = 13;
    struct br_test_random r = {8};
    struct br_error err = {0};
    for (const struct br_ladder_kernel *const *kernel = br_ladder_kernels; *kernel; kernel++)
        for (size_t modes = 1; modes <= 4 && (*kernel)->available(); modes++) {
            const struct br_mesh_list mesh = {1, &n};
            struct br_ladder *ladder;
            struct br_store store = {0};
            MUST(br_ladder_create(&ladder, modes, &mesh, &mesh, &store, &err));
            br_ladder_use(ladder, *kernel);
            double *projection = malloc(br_ladder_size(ladder) * sizeof *projection);
            assert_non_null(projection);
            fill(&r, &s, BR_BY_ELEMENT, modes, n, (*kernel)->lanes);
            for (size_t i = 0; i < modes; i++)
                s.view.scale[i] = 1;
            br_ladder_project(ladder, &s.view, projection);
            CLOSE(br_ladder_distance(ladder, 0, &s.view, projection), 0, 0);
            free(projection);
            br_store_clear(&store);
        }
}

/* --kernel forces both: every kernel of the solver has its counterpart here. */
TEST(test_counterparts)
{
    for (const struct br_kernel *const *k = br_kernels; *k; k++) {
        const struct br_ladder_kernel *other =
            br_ladder_kernels[br_instruction_set_find((*k)->name)];
        assert_non_null(other);
        assert_string_equal(other->name, (*k)->name);
        assert_int_equal(other->available(), (*k)->available());
    }
    assert_null(br_ladder_kernels[br_instruction_set_find("sse2")]);
}
