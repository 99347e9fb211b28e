/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Forces and moments on the tip, against closed forms without inertia: with the
 * stiffness a and the viscosity c, a load that begins at t = 0 makes the beam creep
 * towards its static shape S like S (1 - exp(-a t / c)), of which implicit Euler makes
 * S (1 - (1 + k a / c)^-n); both elements hold that shape to all digits. */
#include <math.h>
#include <string.h>

#include "study/scene/expression.h"
#include "tests/support.h"

enum { N = 7, STEPS = 30 };
static const double length = 1.5, duration = 2, stiffness = 40, viscosity = 25;

static struct br_scene creeping_scene(void)
{
    return (struct br_scene){
        .length = length,
        .duration = duration,
        .axial = {.modelled = true, .stiffness = stiffness, .viscosity = viscosity},
        .bending = {.modelled = true, .stiffness = stiffness, .viscosity = viscosity},
    };
}

static double creep(size_t step)
{
    return 1 - pow(1 + duration / STEPS * stiffness / viscosity, -(double)step);
}

/* Static shapes of a force F and a moment M at the tip. */
static double pulled(double force, double x)
{
    return force * x / stiffness;
}

static double bent(double force, double moment, double x)
{
    return (force * x * x * (3 * length - x) / 6 + moment * x * x / 2) / stiffness;
}

static void check_creep(const struct br_linear_solver *solver)
{
    struct br_scene scene = creeping_scene();
    scene.axial.tip_force.constant = 3;
    scene.bending.tip_force.constant = -2;
    scene.bending.tip_moment.constant = 0.7;
    struct br_method method = br_method_default();
    method.solver = solver;
    struct br_march *march;
    assert_int_equal(br_march_create(&march, &scene, N, STEPS, &method, NULL), BR_OK);
    double u[N + 1], w[2 * (N + 1)];
    for (size_t step = 1; step <= STEPS; step++) {
        assert_int_equal(br_march_step(march, NULL), BR_OK);
        br_march_get(march, BR_AXIAL, u, NULL);
        br_march_get(march, BR_BENDING, w, NULL);
        for (size_t i = 1; i <= N; i++) {
            const double x = length * (double)i / N;
            assert_true(fabs(u[i] / (creep(step) * pulled(3, x)) - 1) <= 1e-12);
            assert_true(fabs(w[2 * i] / (creep(step) * bent(-2, 0.7, x)) - 1) <= 1e-11);
        }
    }
    br_march_free(march);
}

static void test_creep(void **state)
{
    (void)state;
    for (size_t i = 0; br_linear_solvers[i]; i++)
        check_creep(br_linear_solvers[i]);
}

/* A load per length and a tip force, both changing in time, add up. */
static void test_superposition(void **state)
{
    (void)state;
    double w[3][2 * (N + 1)];
    for (int which = 1; which <= 3; which++) {
        struct br_scene scene = creeping_scene();
        assert_int_equal(br_expression("2*t", &scene.bending.load.term[0].time, NULL), BR_OK);
        scene.bending.load.term[0].space.constant = which & 1 ? 5 : 0;
        if (which & 2)
            assert_int_equal(br_expression("sin(3*t)", &scene.bending.tip_force, NULL), BR_OK);
        const struct br_method method = br_method_default();
        struct br_march *march;
        assert_int_equal(br_march_create(&march, &scene, N, STEPS, &method, NULL), BR_OK);
        for (size_t step = 1; step <= STEPS; step++)
            assert_int_equal(br_march_step(march, NULL), BR_OK);
        br_march_get(march, BR_BENDING, w[which - 1], NULL);
        br_march_free(march);
        br_scene_clear(&scene);
    }
    for (size_t i = 2; i < 2 * (N + 1); i++) {
        assert_true(fabs(w[0][i]) > 1e-4 && fabs(w[1][i]) > 1e-4);
        assert_true(fabs(w[0][i] + w[1][i] - w[2][i]) <= 1e-13);
    }
}

static void test_not_finite(void **state)
{
    (void)state;
    struct br_scene scene = creeping_scene();
    assert_int_equal(br_expression("1/(1-t)", &scene.bending.tip_moment, NULL), BR_OK);
    const struct br_method method = br_method_default();
    struct br_march *march;
    struct br_error err = {0};
    assert_int_equal(br_march_create(&march, &scene, N, 2, &method, &err), BR_OK);
    assert_int_equal(br_march_step(march, &err), BR_NOT_FINITE);
    assert_non_null(strstr(err.message, "the tip moment is inf at t = 1 s"));
    br_march_free(march);
    br_scene_clear(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_creep),
        cmocka_unit_test(test_superposition),
        cmocka_unit_test(test_not_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
