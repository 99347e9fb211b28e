/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Quadratic elements of the rod in studies: orders against solutions that are known and by
 * differences, what judges tell of them, and what is kept of a run. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "study/fit/fit.h"
#include "study/grid/sweep.h"
#include "support.h"

static struct br_method method_of(const char *contact)
{
    struct br_method method = br_test_method(NULL, contact, NULL);
    method.axial_degree = 2;
    return method;
}

/* ---- orders ---- */

enum { MESHES = 4 };

/* Axial errors of some meshes in a norm, each against the next one's mesh with the same steps. */
static void differences(const char *name, const struct br_norm *norm, size_t steps,
                        const size_t n[MESHES + 1], double error[MESHES])
{
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled(name);
    for (size_t i = 0; i < MESHES; i++) {
        struct br_study s = br_test_study(&scene, &br_judge_fine, 1, &n[i], 1, &steps);
        s.norm = norm;
        s.method = method_of("implicit");
        s.reference_method = method_of("implicit");
        s.reference = (struct br_resolution){n[i + 1], steps};
        MUST(br_study_run(&s, 1, 2, NULL, &err));
        error[i] = s.cell[0].error[BR_PART_AXIAL];
        br_study_clear(&s);
    }
    br_scene_clear(&scene);
}

/* The last two of several slopes. */
static void check_orders(const char *what, const char *norm, const double error[MESHES],
                         double expected, double tolerance)
{
    for (int i = MESHES - 2; i < MESHES; i++) {
        const double order = log2(error[i - 1] / error[i]);
        print_message("# %-12s %-6s %.3e to %.3e: order %.3f\n", what, norm, error[i - 1], error[i],
                      order);
        CLOSE(order, expected, tolerance);
    }
}

/* h^3 in L2, h^2 of the strain rate, and h^4 at the tip, where a Galerkin solution is better than
 * anywhere else. The velocity's L2 norm is that of a displacement over time: order 3, too. */
TEST(test_orders_in_space)
{
    static const char *const scenes[] = {"mms_smooth", "mms_implicit", "initial_data", "example2"};
    static const size_t n[MESHES + 1] = {8, 16, 32, 64, 128};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        double error[MESHES];
        differences(scenes[i], &br_norm_l2, 200, n, error);
        check_orders(scenes[i], "l2", error, 3, 0.05);
        differences(scenes[i], &br_norm_energy, 200, n, error);
        check_orders(scenes[i], "energy", error, 2, 0.05);
        differences(scenes[i], &br_norm_tip, 200, n, error);
        if (error[MESHES - 1] > 1e-12) /* Example 2 is nearly a parabola */
            check_orders(scenes[i], "tip", error, 4, 0.1);
    }
}

/* Jointly, with k going as h^3, against the continuous problem: what converges is the right thing.
 */
TEST(test_joint_orders)
{
    static const char *const scenes[] = {"mms_smooth", "mms_implicit", "mms_pressed"};
    static const size_t n[] = {10, 20, 40}, steps[] = {100, 800, 6400};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes && br_judge_find("mms"); i++) {
        struct br_error err = {0};
        struct br_scene scene = br_test_bundled(scenes[i]);
        struct br_study s = br_test_study(&scene, br_judge_find("mms"), 3, n, 3, steps);
        s.method = method_of("implicit");
        s.path = true;
        MUST(br_study_run(&s, 1, 2, NULL, &err));
        for (int c = 1; c < 3; c++) {
            const double a = s.cell[c - 1].error[BR_PART_AXIAL], b = s.cell[c].error[BR_PART_AXIAL];
            print_message("# %-12s joint %.3e to %.3e: order %.3f\n", scenes[i], a, b, log2(a / b));
            CLOSE(log2(a / b), 3, 0.2);
        }
        br_study_clear(&s);
        br_scene_clear(&scene);
    }
}

/* So fine in time that only space counts: the error against the solution is of order 3, also in
 * what the modes of an element cannot hold. */
TEST(test_against_exact)
{
    static const size_t n[] = {4, 8}, steps = 25000;
    if (br_test_quick())
        skip();
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled("initial_data");
    double error[2][2]; /* of degree 1, 2 */
    scene.duration = 0.1;
    scene.bending.modelled = false;
    scene.friction.law = BR_FRICTIONLESS;
    for (int degree = 1; degree <= 2; degree++) {
        struct br_study s = br_test_study(&scene, &br_judge_exact, 2, n, 1, &steps);
        s.method = method_of("implicit");
        s.method.axial_degree = degree;
        MUST(br_study_run(&s, 1, 2, NULL, &err));
        for (int i = 0; i < 2; i++)
            error[degree - 1][i] = s.cell[i].error[BR_PART_AXIAL];
        br_study_clear(&s);
    }
    print_message("# degree 1: %.3e, %.3e; degree 2: %.3e, %.3e\n", error[0][0], error[0][1],
                  error[1][0], error[1][1]);
    CLOSE(log2(error[0][0] / error[0][1]), 2, 0.1);
    CLOSE(log2(error[1][0] / error[1][1]), 3, 0.15);
    br_scene_clear(&scene);
}

/* ---- judges ---- */

/* Modes are orthonormal: the first ones are the same whatever is kept, and so is the norm. */
static void check_judge(const struct br_judge *judge, const char *name)
{
    enum { N = 3, LEVELS = 8 };
    static const size_t mesh = N;
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled(name);
    double values[2][3 * N], square[2][BR_MEASURES];
    struct br_view view[2];
    for (int degree = 1; degree <= 2; degree++) {
        struct br_judge_request request = {.scene = &scene,
                                           .axial_degree = degree,
                                           .levels = LEVELS,
                                           .lead = 1,
                                           .mesh_count = 1,
                                           .mesh = &mesh};
        for (int measure = 0; measure < BR_MEASURES; measure++)
            request.measured[BR_AXIAL][measure] = true;
        void *self;
        MUST(judge->create(&self, &request, &err));
        MUST(judge->advance(self, BR_AXIAL, LEVELS, &err));
        for (int measure = 0; measure < BR_TIP; measure++) {
            const struct br_sample_at at = {BR_AXIAL, (enum br_measure)measure, 0};
            struct br_view *v = &view[degree - 1];
            v->values = values[degree - 1];
            judge->sample(self, &at, v);
            assert_int_equal(v->modes, degree + (measure != BR_STRAIN_RATE));
            double sum = v->rest;
            for (size_t i = 0; i < N * v->modes; i++)
                sum += v->values[i] * v->values[i];
            square[degree - 1][measure] = sum;
        }
        judge->free(self);
    }
    for (int measure = 0; measure < BR_TIP; measure++)
        CLOSE(square[1][measure], square[0][measure], 1e-11 * square[0][measure]);
    for (size_t e = 0; e < N; e++) /* of the strain rate, the last one looked at */
        CLOSE(values[1][2 * e], values[0][e], 1e-12 * fabs(values[0][e]));
    AT_MOST(view[1].rest, 0.9 * view[0].rest);
    br_scene_clear(&scene);
}

TEST(test_judges)
{
    check_judge(&br_judge_exact, "example2");
    if (br_judge_find("mms"))
        check_judge(br_judge_find("mms"), "mms_smooth");
}

/* Looked at: a parabola's modes by Gauss quadrature in all measures. */
TEST(test_look)
{
    enum { N = 5 };
    struct br_scene scene = br_test_bare();
    scene.length = 2;
    scene.bending.modelled = false;
    scene.axial.displacement = br_test_function("sin(3*x)");
    scene.axial.velocity = br_test_function("x*exp(-x)");
    const struct br_method method = method_of(NULL);
    struct br_march *march = br_test_march(&scene, N, 10, &method);
    br_test_advance(march, 4);
    double nodal[2][2 * (N + 1)];
    br_march_get(march, BR_AXIAL, nodal[0], nodal[1]);
    const double h = 2.0 / N;
    for (int measure = 0; measure < BR_TIP; measure++) {
        double values[4 * N];
        struct br_view view = {.values = values};
        br_look(march, BR_AXIAL, (enum br_measure)measure, &view);
        const double *v = nodal[measure == BR_DISPLACEMENT ? 0 : 1];
        double sum = 0, expected = 0;
        for (size_t e = 0; e < N; e++, v += 2)
            for (int q = 0; q < 3; q++) {
                const double y = (q - 1) * sqrt(0.6), weight = (q == 1 ? 8 : 5) / 18.0;
                const double value =
                    measure == BR_STRAIN_RATE
                        ? (v[2] - v[0] + y * v[3]) / h
                        : (v[0] + v[2]) / 2 + y * (v[2] - v[0]) / 2 - (1 - y * y) / 4 * v[3];
                expected += h * weight * value * value;
            }
        for (size_t e = 0; e < N; e++) {
            const double *u = values + (measure == BR_STRAIN_RATE ? 2 * e : 2 * e);
            const double raw[3] = {u[0] + u[2] - u[3] / 3, u[2] - u[0], u[3]};
            for (size_t i = 0; i < view.modes; i++) {
                const double mode = (measure == BR_STRAIN_RATE ? u[i] : raw[i]) * view.scale[i];
                sum += mode * mode;
            }
        }
        CLOSE(sum, expected, 1e-13 * expected);
    }
    br_march_free(march);
    br_scene_clear(&scene);
}

/* ---- refusals, and what is kept ---- */

TEST(test_other_degree)
{
    static const size_t n = 4, steps = 10;
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled("example2");
    struct br_study s = br_test_study(&scene, &br_judge_fine, 1, &n, 1, &steps);
    s.method = method_of(NULL);
    s.reference = (struct br_resolution){8, 20};
    REFUSED(br_study_run(&s, 1, 1, NULL, &err), BR_BAD_INPUT,
            "the cells have axial elements of degree 2 and the reference of degree 1");
    br_scene_clear(&scene);
}

/* One element, every judge and norm: the smallest arrays. */
TEST(test_one_element)
{
    const struct br_elements elements = {BR_AXIAL, 2};
    assert_int_equal(br_measure_size(elements, BR_DISPLACEMENT, 1), 4); /* two nodes */
    assert_int_equal(br_measure_size(elements, BR_DISPLACEMENT, 9), 27);
    assert_int_equal(br_measure_size(elements, BR_STRAIN_RATE, 1), 2);
    static const size_t n = 1, steps = 4;
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled("example2");
    struct br_study chain[3];
    chain[0] = br_test_study(&scene, &br_judge_fine, 1, &n, 1, &steps);
    chain[0].method = chain[0].reference_method = method_of(NULL);
    chain[0].reference = (struct br_resolution){1, 8};
    chain[0].auditor = &br_judge_exact;
    br_test_all_norms(chain);
    MUST(br_study_run(chain, 1, 1, NULL, &err));
    for (int i = 0; i < 3; i++) {
        AT_MOST(chain[i].cell[0].error[BR_PART_AXIAL], 1);
        AT_MOST(chain[i].reference_error[BR_PART_AXIAL], 1);
        assert_true(chain[i].cell[0].error[BR_PART_AXIAL] > 0);
        br_study_clear(&chain[i]);
    }
    br_scene_clear(&scene);
}

/* The extrapolation of the tip counts with its order: 4. */
TEST(test_extrapolation)
{
    static const size_t n[] = {4, 8, 16, 32}, steps[] = {10, 20, 40, 80};
    for (int degree = 1; degree <= 2; degree++) {
        struct br_error err = {0};
        struct br_study grid = {
            .method = {.axial_degree = degree}, .n_count = 4, .k_count = 4, .n = n, .steps = steps};
        struct br_tips tips;
        MUST(br_tips_create(&tips, &grid, &err));
        for (int i = 0; i < 16; i++)
            tips.value[BR_AXIAL][i] =
                1 + pow(1.0 / (double)n[i / 4], 2 * degree) + 0.1 / (double)steps[i % 4];
        const struct br_estimate e = br_extrapolate(&tips, BR_AXIAL);
        CLOSE(e.value, 1, 1e-9);
        AT_MOST(e.high - e.low, 1e-9);
        br_tips_clear(&tips);
    }
}
