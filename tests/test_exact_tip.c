/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Forces and a moment on the tip in the exact reference, against closed forms; its strain
 * rates; and that it stops when it is told to. */
#include <math.h>
#include <string.h>

#include "tests/exact_scenes.h"

static const double length = 1.3, stiffness = 40, viscosity = 8;
static const struct br_exact_part u = {BR_EXACT_AXIAL, false, 0}, v = {BR_EXACT_AXIAL, true, 0},
                                  u_xt = {BR_EXACT_AXIAL, true, 1},
                                  w = {BR_EXACT_BENDING, false, 0},
                                  w_xxt = {BR_EXACT_BENDING, true, 2};

static struct br_scene bare_scene(double density)
{
    return (struct br_scene){
        .length = length,
        .duration = 2,
        .density = density,
        .axial = {.modelled = true, .stiffness = stiffness, .viscosity = viscosity},
        .bending = {.modelled = true, .stiffness = stiffness, .viscosity = viscosity},
    };
}

/* The solution of q + tau q' = t with q(0) = 0. */
static double creep(double tau, double t)
{
    return t - tau * -expm1(-t / tau);
}

/* Without mass, loads that grow like t make the beam creep in its static shape. */
TEST(test_creep)
{
    struct formula pull = {f_ramp, {3}}, push = {f_ramp, {-2}}, turn = {f_ramp, {0.7}};
    struct br_scene scene = bare_scene(0);
    scene.axial.tip_force = formula_function(&pull);
    scene.bending.tip_force = formula_function(&push);
    scene.bending.tip_moment = formula_function(&turn);
    struct br_exact *exact = solve(&scene, 1e-10);
    struct br_exact_state *now = new_state(exact);
    for (int i = 1; i <= 20; i++) {
        br_exact_at(exact, 0.1 * i, now);
        const double q = creep(viscosity / stiffness, 0.1 * i) / stiffness;
        for (int j = 1; j <= 5; j++) {
            const double x = length * j / 5;
            assert_near(value_of(exact, now, u, x), 3 * x * q, 1e-11);
            assert_near(value_of(exact, now, w, x),
                        q * (-2 * x * x * (3 * length - x) / 6 + 0.7 * x * x / 2), 1e-11);
        }
        assert_near(now->tip[BR_EXACT_AXIAL].displacement, 3 * length * q, 1e-11);
    }
    br_exact_state_free(now);
    br_exact_free(exact);
}

/* The same rod pressed against its foundation: one spring more. */
TEST(test_pressed)
{
    struct formula pull = {f_ramp, {3}};
    struct br_scene scene = bare_scene(0);
    scene.bending.modelled = false;
    scene.axial.tip_force = formula_function(&pull);
    scene.contact = (struct br_contact){.modelled = true, .gap = 0, .stiffness = 70};
    struct br_exact *exact = solve(&scene, 1e-10);
    struct br_exact_state *now = new_state(exact);
    const double spring = stiffness / length + 70;
    for (int i = 1; i <= 20; i++) {
        br_exact_at(exact, 0.1 * i, now);
        const double tip = 3 / spring * creep(viscosity / length / spring, 0.1 * i);
        assert_near(now->tip[BR_EXACT_AXIAL].displacement, tip, 1e-11);
        assert_near(now->contact_force, 70 * tip, 1e-9);
    }
    br_exact_state_free(now);
    br_exact_free(exact);
}

/* ---- with mass: u = t^3 sin x and w = t^3 (1 - cos x), loads to fit ---- */

static const double density = 2;

static double stress(double t) /* a q + c q' for q = t^3 */
{
    return stiffness * t * t * t + viscosity * 3 * t * t;
}

static double axial_load(const double *p, double x, double t)
{
    (void)p;
    return sin(x) * (density * 6 * t + stress(t));
}

static double axial_tip(const double *p, double x, double t)
{
    (void)p, (void)x;
    return cos(length) * stress(t);
}

static double bending_load(const double *p, double x, double t)
{
    (void)p;
    return density * 6 * t * (1 - cos(x)) - cos(x) * stress(t);
}

static double bending_tip(const double *p, double x, double t)
{
    (void)p, (void)x;
    return sin(length) * stress(t);
}

TEST(test_inertia)
{
    struct formula f[] = {
        {axial_load, {0}}, {axial_tip, {0}}, {bending_load, {0}}, {bending_tip, {0}}};
    const struct br_function one = {.constant = 1};
    struct br_scene scene = bare_scene(density);
    scene.axial.load = (struct br_load){{{formula_function(&f[0]), one}}};
    scene.axial.tip_force = formula_function(&f[1]);
    scene.bending.load = (struct br_load){{{formula_function(&f[2]), one}}};
    scene.bending.tip_force = formula_function(&f[3]);
    scene.bending.tip_moment = formula_function(&f[1]); /* cos(L) times the stress, too */
    struct br_exact *exact = solve(&scene, 1e-10);
    struct br_exact_state *now = new_state(exact);
    double largest = 0;
    for (int i = 1; i <= 20; i++) {
        const double t = 0.1 * i;
        br_exact_at(exact, t, now);
        for (int j = 1; j <= 5; j++) {
            const double x = length * j / 5;
            assert_near(value_of(exact, now, u, x), t * t * t * sin(x), 8e-9);
            assert_near(value_of(exact, now, v, x), 3 * t * t * sin(x), 1e-7);
            assert_near(value_of(exact, now, w, x), t * t * t * (1 - cos(x)), 8e-9);
            assert_near(value_of(exact, now, u_xt, x), 3 * t * t * cos(x), 1e-7);
            assert_near(value_of(exact, now, w_xxt, x), 3 * t * t * cos(x), 1e-6);
        }
        largest = fmax(largest, sqrt(square_of(exact, now, u_xt) / length));
    }
    /* t = 2 is the last one and the largest; the estimate covers the error */
    const struct br_exact_report r = br_exact_report(exact, BR_EXACT_AXIAL);
    assert_near(r.largest.strain_rate / largest, 1, 1e-6);
    const double integral = (length + sin(2 * length) / 2) / 2; /* of cos^2 */
    assert_near(r.largest.strain_rate, 12 * sqrt(integral / length), 1e-6);
    assert_near(br_exact_report(exact, BR_EXACT_BENDING).largest.strain_rate,
                12 * sqrt(integral / length), 1e-6);
    assert_true(r.error.strain_rate >= 0 && r.error.strain_rate <= 1e-6);
    br_exact_state_free(now);
    br_exact_free(exact);
}

/* ---- friction ---- */

/* A tip force holds against Tresca's bound as long as it can, and nothing moves. */
TEST(test_stick)
{
    struct formula push = {f_ramp, {5}};
    struct br_scene scene = bare_scene(density);
    scene.axial.modelled = false;
    scene.bending.tip_force = formula_function(&push);
    scene.friction.law = BR_TRESCA;
    scene.friction.coefficient = 2;
    struct br_exact *exact = solve(&scene, 1e-10);
    struct br_exact_state *now = new_state(exact);
    size_t count;
    const struct br_exact_event *event = br_exact_events(exact, &count);
    assert_true(count >= 2 && event[0].phase == BR_STICK && event[1].phase == BR_SLIP_UP);
    assert_near(event[1].time, 0.4, 1e-12);
    for (int i = 0; i <= 7; i++) {
        br_exact_at(exact, 0.05 * i, now);
        assert_near(now->friction_force, 5 * 0.05 * i, 1e-9);
        assert_near(value_of(exact, now, w, length / 2), 0, 1e-12);
    }
    br_exact_at(exact, 0.6, now);
    assert_near(now->friction_force, 2, 0);
    assert_true(now->tip[BR_EXACT_BENDING].displacement > 1e-4);
    br_exact_state_free(now);
    br_exact_free(exact);
}

/* Nothing ever moves: the displacement is round-off, and that is good enough. */
TEST(test_rest)
{
    struct formula push = {f_sine, {3}};
    struct br_scene scene = bare_scene(density);
    scene.axial.modelled = false;
    scene.bending.tip_force = formula_function(&push);
    scene.friction.law = BR_TRESCA;
    scene.friction.coefficient = 1.01;
    struct br_exact *exact = solve(&scene, 1e-10);
    struct br_exact_state *now = new_state(exact);
    size_t count;
    br_exact_events(exact, &count);
    assert_int_equal(count, 1);
    br_exact_at(exact, 1.9, now);
    assert_near(now->friction_force, sin(5.7), 1e-9);
    assert_near(br_exact_report(exact, BR_EXACT_BENDING).largest.displacement, 0, 1e-13);
    br_exact_state_free(now);
    br_exact_free(exact);
}

static double f_square(const double *p, double x, double t)
{
    (void)t;
    return p[0] * x * x;
}

static double f_linear(const double *p, double x, double t)
{
    (void)t;
    return p[0] * x;
}

/* A beam with next to no stiffness goes on as it was thrown, but for a layer of 6 cm at a tip that
 * friction stops within 1e-8 T to 1e-22 T: w = t x^2. */
TEST(test_stopped_tip)
{
    static const double bounds[] = {1e5, 1e8, 1e10, 1e12, 1e18};
    struct formula thrown = {f_square, {1}}, slope = {f_linear, {2}};
    struct br_scene scene = bare_scene(1);
    scene.length = scene.duration = 1;
    scene.axial.modelled = false;
    scene.bending.stiffness = 0;
    scene.bending.viscosity = 1e-5;
    scene.bending.velocity = formula_function(&thrown);
    scene.bending.velocity_slope = formula_function(&slope);
    scene.friction.law = BR_TRESCA;
    for (size_t i = 0; i < sizeof bounds / sizeof *bounds; i++) {
        scene.friction.coefficient = bounds[i];
        struct br_exact *exact = solve(&scene, 1e-8);
        struct br_exact_state *now = new_state(exact);
        br_exact_at(exact, 1, now);
        for (double x = 0.25; x < 0.6; x += 0.25)
            assert_near(value_of(exact, now, w, x), x * x, 0.01 * x * x);
        assert_near(now->tip[BR_EXACT_BENDING].displacement, 0, 1e-7);
        br_exact_state_free(now);
        br_exact_free(exact);
    }
}

/* ---- stopping ---- */

static bool count_down(void *self)
{
    int *left = self;
    return (*left)-- <= 0;
}

TEST(test_stop)
{
    const struct br_scene scene = paper_example(4);
    for (int asked = 0; asked < 300; asked += 100) {
        int left = asked;
        const struct br_exact_options options = {.stop = count_down, .stop_self = &left};
        struct br_exact *exact;
        struct br_error err = {0};
        assert_int_equal(br_exact_create(&exact, &scene, &options, &err), BR_INTERRUPTED);
        assert_null(exact);
        assert_non_null(strstr(err.message, "interrupted"));
        assert_int_equal(left, -1); /* not asked again */
    }
}
