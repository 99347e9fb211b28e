/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Quadratic elements of the rod in studies: what references tell of them, and what is kept of a
 * run. Their orders are those that the scenes mms_quadratic and quadratic_rod are checked for. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solver/function.h"
#include "solver/scene.h"
#include "study/fit/fit.h"
#include "study/grid/sweep.h"
#include "support.h"

static struct br_method method_of(const char *contact)
{
    struct br_method method = br_test_method(NULL, contact, NULL);
    method.axial_degree = 2;
    return method;
}

/* ---- references ---- */

/* Modes are orthonormal: the first ones are the same whatever is kept, and so is the norm. */
static void check_reference(const struct br_reference *reference_kind, const char *name)
{
    enum { N = 3, LEVELS = 8 };
    static const size_t mesh = N;
    OWNED(br_scene) scene = br_test_bundled(name);
    double values[2][3 * N], square[2][BR_MEASURES];
    struct br_view view[2];
    for (int degree = 1; degree <= 2; degree++) {
        struct br_reference_request request = {.scene = &scene,
                                               .axial_degree = degree,
                                               .levels = LEVELS,
                                               .lead = 1,
                                               .mesh_count = 1,
                                               .mesh = &mesh};
        for (int measure = 0; measure < BR_MEASURES; measure++)
            request.measured[BR_AXIAL][measure] = true;
        void *self;
        MUST(reference_kind->create(&self, &request, &err));
        MUST(reference_kind->advance(self, BR_AXIAL, LEVELS, &err));
        for (int measure = 0; measure < BR_TIP; measure++) {
            const struct br_sample_at at = {BR_AXIAL, (enum br_measure)measure, 0};
            struct br_view *v = &view[degree - 1];
            v->values = values[degree - 1];
            reference_kind->sample(self, &at, v);
            assert_int_equal(v->modes, degree + (measure != BR_STRAIN_RATE));
            double sum = v->rest;
            for (size_t i = 0; i < N * v->modes; i++)
                sum += v->values[i] * v->values[i];
            square[degree - 1][measure] = sum;
        }
        reference_kind->free(self);
    }
    for (int measure = 0; measure < BR_TIP; measure++)
        CLOSE(square[1][measure], square[0][measure], 1e-11 * square[0][measure]);
    for (size_t e = 0; e < N; e++) /* of the strain rate, the last one looked at */
        CLOSE(values[1][2 * e], values[0][e], 1e-12 * fabs(values[0][e]));
    AT_MOST(view[1].rest, 0.9 * view[0].rest);
}

TEST(test_references)
{
    check_reference(&br_reference_exact, "example2");
    if (br_reference_find("mms"))
        check_reference(br_reference_find("mms"), "mms_smooth");
}

/* Looked at: a parabola's modes by Gauss quadrature in all measures. */
TEST(test_look)
{
    enum { N = 5 };
    OWNED(br_scene) scene = br_test_bare();
    scene.length = 2;
    scene.bending.modelled = false;
    scene.axial.displacement = br_test_function("sin(3*x)");
    scene.axial.velocity = br_test_function("x*exp(-x)");
    const struct br_method method = method_of(NULL);
    OWNED(br_march) *march = br_test_march(&scene, N, 10, &method);
    br_test_advance(march, 4);
    double nodal[2][2 * (N + 1)];
    br_march_get(march, BR_AXIAL, nodal[0], nodal[1]);
    const double h = 2.0 / N;
    for (int measure = 0; measure < BR_TIP; measure++) {
        double values[4 * N];
        struct br_view view = {.values = values};
        br_march_sample(march, BR_AXIAL, (enum br_measure)measure, &view);
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
}

/* ---- refusals, and what is kept ---- */

TEST(test_other_degree)
{
    static const size_t n = 4, steps = 10;
    OWNED(br_scene) scene = br_test_bundled("example2");
    struct br_study s = br_test_study(&scene, &br_reference_fine, 1, &n, 1, &steps);
    s.method = method_of(NULL);
    s.reference = (struct br_resolution){8, 20};
    REFUSED(br_study_run(&s, 1, 1, NULL, &err), BR_BAD_INPUT,
            "the cells have axial elements of degree 2 and the reference of degree 1");
}

/* One element, every reference and norm: the smallest arrays. */
TEST(test_one_element)
{
    const struct br_elements elements = {BR_AXIAL, 2};
    assert_int_equal(br_measure_size(elements, BR_DISPLACEMENT, 1), 4); /* two nodes */
    assert_int_equal(br_measure_size(elements, BR_DISPLACEMENT, 9), 27);
    assert_int_equal(br_measure_size(elements, BR_STRAIN_RATE, 1), 2);
    static const size_t n = 1, steps = 4;
    OWNED(br_scene) scene = br_test_bundled("example2");
    struct br_study chain[3];
    chain[0] = br_test_study(&scene, &br_reference_fine, 1, &n, 1, &steps);
    chain[0].method = chain[0].reference_method = method_of(NULL);
    chain[0].reference = (struct br_resolution){1, 8};
    chain[0].reference_check = &br_reference_exact;
    br_test_all_norms(chain);
    MUST(br_study_run(chain, 1, 1, NULL, &err));
    for (int i = 0; i < 3; i++) {
        AT_MOST(chain[i].cell[0].error[BR_PART_AXIAL], 1);
        AT_MOST(chain[i].reference_error[BR_PART_AXIAL], 1);
        assert_true(chain[i].cell[0].error[BR_PART_AXIAL] > 0);
        br_study_clear(&chain[i]);
    }
}
