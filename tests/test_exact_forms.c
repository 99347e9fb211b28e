/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exact reference against closed forms: vibrations, loads in x and t, forces and a moment at
 * the tip, sticks; and that it stops when it is told to. Without mass: test_exact_events. */
#include <gsl/gsl_math.h>
#include <math.h>
#include <string.h>

#include "solver/function.h"
#include "solver/scene.h"
#include "tests/exact_scenes.h"

static const struct br_exact_quantity u = {BR_AXIAL, false, 0}, v = {BR_AXIAL, true, 0},
                                      u_xt = {BR_AXIAL, true, 1}, w = {BR_BENDING, false, 0},
                                      w_t = {BR_BENDING, true, 0}, w_xxt = {BR_BENDING, true, 2};

/* Solves, checks up to the end, and clears all. */
static void check_forms(struct br_scene *scene, int times, size_t count,
                        const struct expected *expected)
{
    struct solved s = solve(scene, 1e-10);
    check_closed(&s, scene->length, scene->duration, times, count, expected);
    release(&s);
    br_scene_clear(scene);
}

/* ---- free vibrations in one mode ---- */

/* q'' + d q' + w q = 0, q(0) = 1, q'(0) = 0: q and q' at t, without loss where
 * the damping is large. */
static void oscillate(double d, double square, struct text *q, struct text *rate)
{
    const double discriminant = d * d / 4 - square;
    if (discriminant < 0) {
        const double omega = sqrt(-discriminant);
        *q = text_of("exp(-%.17g*t)*(cos(%.17g*t)+%.17g*sin(%.17g*t))", d / 2, omega,
                     d / (2 * omega), omega);
        *rate = text_of("-%.17g*exp(-%.17g*t)*sin(%.17g*t)", square / omega, d / 2, omega);
    } else {
        const double fast = -d / 2 - sqrt(discriminant), slow = square / fast, gap = fast - slow;
        *q = text_of("(%.17g*exp(%.17g*t)-%.17g*exp(%.17g*t))", fast / gap, slow, slow / gap, fast);
        *rate = text_of("%.17g*(exp(%.17g*t)-exp(%.17g*t))", square / gap, slow, fast);
    }
}

/* A vibration of a shape, with the estimate put to the test. square: of the wave number, to the
 * power of the field, over the density. reaction: at the tip, a shape; NULL: none. */
static void check_vibration(struct br_scene *scene, struct br_exact_quantity part,
                            const char *shape, double square, const char *reaction)
{
    const bool axial = part.field == BR_AXIAL;
    const double a = axial ? scene->axial.stiffness : scene->bending.stiffness,
                 c = axial ? scene->axial.viscosity : scene->bending.viscosity;
    const struct br_exact_quantity velocity = {part.field, true, 0};
    struct text q, rate;
    oscillate(square * c, square * a, &q, &rate);
    struct solved s = solve(scene, 1e-10);
    const struct br_exact_report r = br_exact_report(s.exact, part.field);
    const struct br_exact_size *l = &r.largest, *e = &r.error;
    AT_MOST(e->displacement, 1e-10 * l->displacement); /* as solve() asks */
    const struct expected expected[] = {
        {PART, part, text_of("%s*%s", shape, q.s),
         fmin(1e-10 * l->displacement, 3 * e->displacement + 1e-13 * l->displacement)},
        {PART, velocity, text_of("%s*%s", shape, rate.s),
         fmin(1e-9 * l->velocity, 3 * e->velocity + 1e-12 * l->velocity)},
        {FRICTION_FORCE, part, text_of("%s*(%.17g*%s+%.17g*%s)", reaction, a, q.s, c, rate.s),
         1e-9 * l->force},
    };
    check_closed(&s, scene->length, scene->duration, 500, reaction ? 3 : 2, expected);
    release(&s);
    br_scene_clear(scene);
}

TEST(test_axial_vibration)
{
    const double viscosities[] = {0, 1e-3, 0.3, 50}, k = M_PI_2 / 2.5;
    for (size_t i = 0; i < 4; i++) {
        const struct text shape = text_of("0.01*sin(%.17g*x)", k);
        struct br_scene s = {.length = 2.5, .duration = 10, .density = 1.5};
        s.axial =
            (struct br_scene_field){.modelled = true, .stiffness = 7, .viscosity = viscosities[i]};
        s.axial.displacement = br_test_function(shape.s);
        check_vibration(&s, u, shape.s, k * k / s.density, NULL);
    }
}

/* The cantilever's second mode; and the first one of the clamped-propped beam, held by friction,
 * with its reaction. */
TEST(test_bending_vibration)
{
    const double wave[] = {4.694091132974174576436, 3.926602312047918677556};
    const double viscosities[] = {0, 1e-3, 0.02, 3};
    for (size_t i = 0; i < 8; i++) {
        const bool held = i >= 4;
        const double b = wave[held], k = b / 1.25, viscosity = viscosities[i % 4];
        const double ratio = held ? (cosh(b) - cos(b)) / (sinh(b) - sin(b))
                                  : (sinh(b) - sin(b)) / (cosh(b) + cos(b));
        const struct text y = text_of("(%.17g*x)", k);
        const struct text shape = text_of("0.03*(cosh%s-cos%s-%.17g*(sinh%s-sin%s))", y.s, y.s,
                                          ratio, y.s, y.s),
                          slope = text_of("0.03*%.17g*(sinh%s+sin%s-%.17g*(cosh%s-cos%s))", k, y.s,
                                          y.s, ratio, y.s, y.s),
                          third = text_of("0.03*%.17g*(sinh%s-sin%s-%.17g*(cosh%s+cos%s))",
                                          gsl_pow_3(k), y.s, y.s, ratio, y.s, y.s);
        struct br_scene s = {.length = 1.25, .duration = 3, .density = 0.8};
        if (held && viscosity == 0)
            continue;
        s.bending =
            (struct br_scene_field){.modelled = true, .stiffness = 2, .viscosity = viscosity};
        s.bending.displacement = br_test_function(shape.s);
        s.bending.displacement_slope = br_test_function(slope.s);
        if (held)
            s.friction = (struct br_friction){BR_TRESCA, 1e4, 0};
        check_vibration(&s, w, shape.s, gsl_pow_4(k) / s.density, held ? third.s : NULL);
    }
}

/* A contact that never opens, without viscosity: a constant load's static shape,
 * and a mode of a rod on a spring, a k cos kL = -c_H sin kL, with k chosen. */
TEST(test_closed_vibration)
{
    const double k = 2, a = 3, load = 6, gap = 0.1, c = -a * k / tan(k), bow = load / (2 * a);
    const double slope = (load + c * (bow + gap)) / (a + c), omega = k * sqrt(a / 2);
    const struct text still = text_of("%.17g*x-%.17g*x^2+0.05*sin(2*x)", slope, bow),
                      moving = text_of("(%.17g*x-%.17g*x^2+0.05*sin(2*x)*cos(%.17g*t))", slope, bow,
                                       omega);
    struct br_scene s = {.length = 1, .duration = 4, .density = 2};
    s.axial = (struct br_scene_field){.modelled = true, .stiffness = a};
    s.axial.load = uniform(load, "1");
    s.contact = (struct br_contact){true, gap, c};
    s.axial.displacement = br_test_function(still.s);
    check_forms(&s, 200, 3,
                (struct expected[]){
                    {PART, u, moving, 1e-11},
                    {PART, v, text_of("%.17g*sin(2*x)*sin(%.17g*t)", -0.05 * omega, omega), 1e-10},
                    {CONTACT_FORCE, u, text_of("%.17g*(%s-0.1)", c, moving.s), 1e-9}});
}

/* ---- loads that depend on x and t at once ---- */

/* sin(p0 x) (rho g'' + k^2 (a g + c g')), g a pulse of the width p3 around t = 1, rho = 1 */
static double f_pulse(const double *p, double x, double t)
{
    const double y = (t - 1) / p[3], g = exp(-y * y), rate = -2 * y / p[3] * g;
    const double force = (4 * y * y - 2) / (p[3] * p[3]) * g;
    return sin(p[0] * x) * (force + p[0] * p[0] * (p[1] * g + p[2] * rate));
}

/* u = sin(kx) g(t): nothing happens for long, and then much in a short time; nothing is proved of
 * the load. */
TEST(test_pulse)
{
    struct formula load = {f_pulse, {M_PI_2, 2, 0.1, 0.01}};
    struct br_scene scene = {.length = 1, .duration = 2, .density = 1};
    scene.axial = (struct br_scene_field){.modelled = true, .stiffness = 2, .viscosity = 0.1};
    scene.axial.load = (struct br_load){{{formula_function(&load), {.constant = 1}}}};
    struct solved s = solve(&scene, 1e-9);
    const double allowed = br_exact_report(s.exact, BR_AXIAL).error.displacement;
    assert_near(allowed, 0, 1e-9);
    check_closed(
        &s, 1, 2, 1000, 1,
        &(struct expected){PART, u, text_of("sin(pi/2*x)*exp(-((t-1)/0.01)^2)"), allowed + 1e-13});
    release(&s);
}

/* u'' + 0.1 k^2 u' + 2 k^2 u = load, k = pi/2, times sin(k x). A pulse as short as some 1e6 doubles
 * near its time: their rounding, one for all of it at most, is the error. Two that cancel leave
 * less than the rounding of each. */
TEST(test_rounded_times)
{
    const double k = M_PI_2, width = 1e-9, damping = 0.05 * k * k;
    const double omega = sqrt(2 * k * k - damping * damping);
    struct br_scene scene = {.length = 1, .duration = 2, .density = 1};
    scene.axial = (struct br_scene_field){.modelled = true, .stiffness = 2, .viscosity = 0.1};
    scene.axial.load = br_test_load("sin(pi/2*x)*1e9*exp(-((t-1)*1e9)^2)");
    struct solved s = solve(&scene, 1e-9);
    const struct br_exact_report r = br_exact_report(s.exact, BR_AXIAL);
    check_closed(
        &s, 1, 2, 10, 1,
        &(struct expected){PART, u,
                           text_of("sin(pi/2*x)*step(t-1)*%.17g*exp(-%.17g*(t-1))*sin(%.17g*(t-1))",
                                   sqrt(M_PI) / omega, damping, omega),
                           r.error.displacement});
    AT_MOST(r.error.displacement, 0.29 * DBL_EPSILON / width * r.largest.displacement);
    release(&s);
    br_function_free(&scene.axial.load.term[0].space);

    struct br_exact *exact;
    const struct br_exact_options modest = {.tolerance = 1e-9, .acceptable = 1e-3};
    scene.axial.load = br_test_load("cos(x*t)*exp(-((t-1)*1e9)^2)*(1-2*((t-1)*1e9)^2)*1e16");
    REFUSED(br_exact_create(&exact, &scene, &modest, &err), BR_NOT_FINITE,
            "the load changes faster than times in double precision can resolve");
    br_scene_clear(&scene);
}

/* ---- the paper's examples ---- */

/* Over a long stick the modes must go on adding up to the tip that is held. */
TEST(test_held)
{
    OWNED(br_scene) scene = br_test_bundled("example4");
    struct solved s = solve(&scene, 1e-10);
    br_exact_at(s.exact, 2.1, s.state);
    assert_near(value_of(&s, w, 1), s.state->tip[BR_BENDING].displacement, 1e-14);
    assert_near(value_of(&s, w_t, 1), 0, 3e-14);
    assert_near(s.state->tip[BR_BENDING].velocity, 0, 0);
    release(&s);
}

/* Values at t = 1, and the last event: example 3 lets go at 0.8 s, example 1 slips first, and then
 * sticks for good. */
TEST(test_examples)
{
    static const struct {
        const char *example;
        double tip_u, tip_w, off_w;
        size_t events;
        enum br_phase phase[3];
        double last, off;
    } rows[] = {
        {"example1",
         0.171692329889782302,
         -3.05935662255835e-7,
         5e-18,
         3,
         {BR_CLOSED, BR_SLIP_DOWN, BR_STICK},
         3.99152306461369e-5,
         5e-17},
        {"example2", 0.0429230824724455755, -0.0715950242871993164, 5e-15, 0, {0}, 0, 0},
        {"example3", NAN, -0.24875, 5e-15, 2, {BR_STICK, BR_SLIP_DOWN}, 0.8, 1e-12},
    };
    for (size_t i = 0; i < 3; i++) {
        OWNED(br_scene) scene = br_test_bundled(rows[i].example);
        struct solved s = solve(&scene, 1e-10);
        size_t count;
        const struct br_exact_event *event = br_exact_events(s.exact, &count);
        br_exact_at(s.exact, 1, s.state);
        if (!isnan(rows[i].tip_u))
            assert_near(s.state->tip[0].displacement, rows[i].tip_u, 1e-13);
        assert_near(s.state->tip[1].displacement, rows[i].tip_w, rows[i].off_w);
        assert_near(value_of(&s, w, 1), rows[i].tip_w, 5e-15);
        if (strcmp(rows[i].example, "example3") == 0)
            assert_near(value_of(&s, w, 0.5), -0.129765625, 1e-13);
        for (size_t k = 0; k < rows[i].events; k++)
            assert_int_equal(event[k].phase, rows[i].phase[k]);
        if (rows[i].events) {
            assert_int_equal(count, rows[i].events);
            assert_near(event[count - 1].time, rows[i].last,
                        fmin(rows[i].off, event[count - 1].error));
            assert_near(event[count - 1].error, 0, 1e-12);
        }
        release(&s);
    }
}

/* ---- with mass: u = t^3 sin x and w = t^3 (1 - cos x), loads to fit ---- */

static struct br_scene bare_scene(double density)
{
    return (struct br_scene){
        .length = 1.3,
        .duration = 2,
        .density = density,
        .axial = {.modelled = true, .stiffness = 40, .viscosity = 8},
        .bending = {.modelled = true, .stiffness = 40, .viscosity = 8},
    };
}

TEST(test_inertia)
{
    static const char stress[] = "(40*t^3+8*3*t^2)"; /* a q + c q' for q = t^3 */
    OWNED(br_scene) scene = bare_scene(2);
    scene.axial.load = br_test_load(text_of("sin(x)*(12*t+%s)", stress).s);
    scene.axial.tip_force = br_test_function(text_of("cos(1.3)*%s", stress).s);
    scene.bending.load = br_test_load(text_of("12*t*(1-cos(x))-cos(x)*%s", stress).s);
    scene.bending.tip_force = br_test_function(text_of("sin(1.3)*%s", stress).s);
    scene.bending.tip_moment = br_test_function(text_of("cos(1.3)*%s", stress).s);
    struct solved s = solve(&scene, 1e-10);
    check_closed(&s, 1.3, 2, 20, 5,
                 (struct expected[]){{PART, u, text_of("t^3*sin(x)"), 8e-9},
                                     {PART, v, text_of("3*t^2*sin(x)"), 1e-7},
                                     {PART, w, text_of("t^3*(1-cos(x))"), 8e-9},
                                     {PART, u_xt, text_of("3*t^2*cos(x)"), 1e-7},
                                     {PART, w_xxt, text_of("3*t^2*cos(x)"), 1e-6}});
    /* t = 2 is the last one and the largest; the estimate covers the error */
    const double largest = 12 * sqrt((1.3 + sin(2.6) / 2) / 2 / 1.3); /* of cos^2, its mean */
    const struct br_exact_report r = br_exact_report(s.exact, BR_AXIAL);
    assert_near(sqrt(square_of(&s, u_xt) / 1.3), largest, 1e-6);
    assert_near(r.largest.strain_rate, largest, 1e-6);
    assert_near(br_exact_report(s.exact, BR_BENDING).largest.strain_rate, largest, 1e-6);
    assert_true(r.error.strain_rate >= 0 && r.error.strain_rate <= 1e-6);
    release(&s);
}

/* ---- friction ---- */

static struct br_scene stuck_scene(const char *push, double bound)
{
    struct br_scene scene = bare_scene(2);
    scene.axial.modelled = false;
    scene.bending.tip_force = br_test_function(push);
    scene.friction = (struct br_friction){BR_TRESCA, bound, 0};
    return scene;
}

/* A tip force holds against Tresca's bound as long as it can, and nothing moves. */
TEST(test_stick)
{
    OWNED(br_scene) scene = stuck_scene("5*t", 2);
    struct solved s = solve(&scene, 1e-10);
    size_t count;
    const struct br_exact_event *event = br_exact_events(s.exact, &count);
    assert_true(count >= 2 && event[0].phase == BR_STICK && event[1].phase == BR_SLIP_UP);
    assert_near(event[1].time, 0.4, 1e-12);
    check_closed(&s, 1.3, 0.35, 7, 2,
                 (struct expected[]){{FRICTION_FORCE, w, text_of("5*t"), 1e-9},
                                     {PART, w, text_of("0"), 1e-12}});
    br_exact_at(s.exact, 0.6, s.state);
    assert_near(s.state->friction_force, 2, 0);
    assert_true(s.state->tip[BR_BENDING].displacement > 1e-4);
    release(&s);
}

/* Nothing ever moves: the displacement is round-off, and that is good enough. */
TEST(test_rest)
{
    OWNED(br_scene) scene = stuck_scene("sin(3*t)", 1.01);
    struct solved s = solve(&scene, 1e-10);
    size_t count;
    br_exact_events(s.exact, &count);
    assert_int_equal(count, 1);
    br_exact_at(s.exact, 1.9, s.state);
    assert_near(s.state->friction_force, sin(5.7), 1e-9);
    assert_near(br_exact_report(s.exact, BR_BENDING).largest.displacement, 0, 1e-13);
    release(&s);
}

/* A beam with next to no stiffness goes on as it was thrown, but for a layer of 6 cm at a tip that
 * friction stops within 1e-8 T to 1e-22 T: w = t x^2. */
TEST(test_stopped_tip)
{
    static const double bounds[] = {1e5, 1e8, 1e10, 1e12, 1e18};
    OWNED(br_scene) scene = {.length = 1, .duration = 1, .density = 1};
    scene.bending = (struct br_scene_field){.modelled = true, .viscosity = 1e-5};
    scene.bending.velocity = br_test_function("x^2");
    scene.bending.velocity_slope = br_test_function("2*x");
    for (size_t i = 0; i < sizeof bounds / sizeof *bounds; i++) {
        scene.friction = (struct br_friction){BR_TRESCA, bounds[i], 0};
        struct solved s = solve(&scene, 1e-8);
        br_exact_at(s.exact, 1, s.state);
        for (double x = 0.25; x < 0.6; x += 0.25)
            assert_near(value_of(&s, w, x), x * x, 0.01 * x * x);
        assert_near(s.state->tip[BR_BENDING].displacement, 0, 1e-7);
        release(&s);
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
    OWNED(br_scene) scene = br_test_bundled("example4");
    for (int asked = 0; asked < 300; asked += 100) {
        int left = asked;
        const struct br_exact_options options = {.stop = count_down, .stop_self = &left};
        struct br_exact *exact;
        assert_int_equal(br_exact_create(&exact, &scene, &options, &err), BR_INTERRUPTED);
        assert_null(exact);
        assert_non_null(strstr(err.message, "interrupted"));
        assert_int_equal(left, -1); /* not asked again */
    }
}
