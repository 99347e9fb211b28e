/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exact reference under loads that are short in x or t, that jump, or whose fronts move,
 * against closed forms; and its elements against one. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "reference/exact/modes.h"
#include "reference/exact/piecewise.h"
#include "tests/exact_scenes.h"
#include "tests/support.h"

/* Room for a text that is made from numbers. */
struct text {
    char s[400];
};

#define TEXT(...)                                 \
    ({                                            \
        struct text t_;                           \
        snprintf(t_.s, sizeof t_.s, __VA_ARGS__); \
        t_;                                       \
    })

static struct br_scene rod(double density, double viscosity)
{
    return (struct br_scene){
        .length = 2.5,
        .duration = 3,
        .density = density,
        .axial = {.modelled = true, .stiffness = 7, .viscosity = viscosity},
    };
}

static struct br_scene beam(double density, double viscosity)
{
    return (struct br_scene){
        .length = 0.4,
        .duration = 2,
        .density = density,
        .bending = {.modelled = true, .stiffness = 5, .viscosity = viscosity},
    };
}

/* Solves a scene whose velocities may be less certain than `solve` wants them. */
static struct br_exact *solve_sharp(const struct br_scene *scene)
{
    struct br_exact *exact = NULL;
    struct br_error err = {0};
    const struct br_exact_options options = {.acceptable = 1e-5};
    MUST(br_exact_create(&exact, scene, &options, &err));
    return exact;
}

/* How far the tip may be off: what the solution says of itself, which must be small. */
static double allowed(const struct br_exact *exact, enum br_exact_field field, double relative)
{
    const struct br_exact_report report = br_exact_report(exact, field);
    AT_MOST(report.error.displacement / report.largest.displacement, relative);
    return report.error.displacement + 1e-13 * report.largest.displacement;
}

static struct br_load load_of(struct text text)
{
    return br_test_load(text.s);
}

/* ---- patches, without inertia: a shape times 1 - e^{-a t / c} ---- */

/* Displacement of a rod at x under 1 N/m on [p, q], times the stiffness. */
static double rod_shape(double p, double q, double x)
{
    if (x <= p)
        return (q - p) * x;
    const double in = fmin(x, q) - p; /* the force falls over the patch */
    return (q - p) * p + (q - p) * in - in * in / 2;
}

/* Deflection of a cantilever's tip, times the stiffness. */
static double beam_tip(double length, double p, double q)
{
    const long double a = p, b = q, h = b - a;
    const long double cubes = h * (a * a + a * b + b * b);
    const long double fourths = h * (a + b) * (a * a + b * b);
    return (double)((length * cubes - fourths / 4) / 6);
}

static void check_rod_patch(double place, double width)
{
    struct br_scene s = rod(0, 0.7);
    const double p = place * s.length, q = p + width * s.length, amplitude = -3 / (q - p);
    s.axial.load = load_of(TEXT("%.17g*step(x-%.17g)*step(%.17g-x)", amplitude, p, q));
    struct br_exact *exact = solve(&s, 1e-10);
    struct br_exact_state *state = new_state(exact);
    const struct br_exact_part part = {BR_EXACT_AXIAL, false, 0};
    for (int n = 1; n <= 10; n++) {
        br_exact_at(exact, s.duration * n / 10, state);
        const double rise = -expm1(-10 * state->time) * amplitude / 7;
        const double tip = rise * rod_shape(p, q, s.length);
        assert_near(state->tip[BR_EXACT_AXIAL].displacement, tip, 1e-10 * fabs(tip));
        for (int i = 0; i <= 8; i++) {
            const double x = s.length * i / 8;
            assert_near(value_of(exact, state, part, x), rise * rod_shape(p, q, x),
                        1e-10 * fabs(tip));
        }
    }
    br_exact_state_free(state);
    br_exact_free(exact);
    br_scene_clear(&s);
}

static void check_beam_patch(double place, double width)
{
    struct br_scene s = beam(0, 0.25);
    const double p = place * s.length, q = p + width * s.length, amplitude = 20 / (q - p);
    s.bending.load = load_of(TEXT("%.17g*step(x-%.17g)*step(%.17g-x)", amplitude, p, q));
    struct br_exact *exact = solve(&s, 1e-10);
    struct br_exact_state *state = new_state(exact);
    for (int n = 1; n <= 10; n++) {
        br_exact_at(exact, s.duration * n / 10, state);
        const double tip = -expm1(-20 * state->time) * amplitude / 5 * beam_tip(s.length, p, q);
        assert_near(state->tip[BR_EXACT_BENDING].displacement, tip, 1e-10 * fabs(tip));
    }
    br_exact_state_free(state);
    br_exact_free(exact);
    br_scene_clear(&s);
}

static void test_patches(void **unused)
{
    (void)unused;
    static const double place[] = {0.1234567, 0.57, 0.9}, width[] = {0.1, 1e-3, 1e-6, 1e-8};
    for (size_t i = 0; i < 3; i++)
        for (size_t j = 0; j < 4; j++) {
            check_rod_patch(place[i], width[j]);
            check_beam_patch(place[i], width[j]);
        }
}

/* A peak of unit area: of its integral nothing may be lost, wherever it is. */
static void test_peaks(void **unused)
{
    (void)unused;
    for (double width = 0.01; width > 0.9e-8; width /= 10) {
        struct br_scene s = rod(0, 0.7);
        const double x = 0.71 * s.length, w = width * s.length;
        s.axial.load = load_of(TEXT("-3/sqrt(pi)/%.17g*exp(-((x-%.17g)/%.17g)^2)", w, x, w));
        struct br_exact *exact = solve(&s, 1e-10);
        struct br_exact_state *state = new_state(exact);
        br_exact_at(exact, 1.5, state);
        assert_near(state->tip[BR_EXACT_AXIAL].displacement / (3 * expm1(-15) * x / 7), 1, 1e-9);
        br_exact_state_free(state);
        br_exact_free(exact);
        br_scene_clear(&s);
    }
}

/* ---- jumps and blows in time, with inertia: a sum over the rod's modes ---- */

/* q'' + d q' + w q = 0: `fall` from 1 at rest, `rise` from 0 with velocity 1. */
struct free_motion {
    double fall, rise;
};

static struct free_motion move_freely(double d, double w, double t)
{
    const double discriminant = d * d / 4 - w;
    struct free_motion m;
    if (discriminant < 0) {
        const double omega = sqrt(-discriminant), decay = exp(-d * t / 2);
        m.fall = decay * (cos(omega * t) + d / (2 * omega) * sin(omega * t));
        m.rise = decay * sin(omega * t) / omega;
    } else {
        const double fast = -d / 2 - sqrt(discriminant), slow = w / fast;
        m.fall = (fast * exp(slow * t) - slow * exp(fast * t)) / (fast - slow);
        m.rise = (exp(slow * t) - exp(fast * t)) / (slow - fast);
    }
    return m;
}

/* The tip of a rod of rod() under a uniform load of 1 N/m: since a time t it has acted, or t after
 * a blow of 1 N s/m. The mean of two sums that end in either sign. */
static double uniform_tip(const struct br_scene *s, double t, bool blow)
{
    enum { MODES = 40000 };
    long double sum = 0, last = 0;
    for (int i = 0; i < MODES && t > 0; i++) {
        const double k = (i + 0.5) * acos(-1) / s->length, square = k * k / s->density;
        const struct free_motion m =
            move_freely(square * s->axial.viscosity, square * s->axial.stiffness, t);
        const double load = 2 / (k * s->length * s->density);
        last = (i % 2 ? -1 : 1) *
               (blow ? load * m.rise : load / (square * s->axial.stiffness) * (1 - m.fall));
        sum += last;
    }
    return (double)(sum - last / 2);
}

static void test_jump_in_time(void **unused)
{
    (void)unused;
    struct br_scene s = rod(1.7, 0.4);
    s.axial.load = load_of(TEXT("-4*step(t-1/3)+9*step(t-1.4)*step(1.4+1e-6-t)"));
    struct br_exact *exact = solve(&s, 1e-10);
    struct br_exact_state *state = new_state(exact);
    const double from = 1.4 + 1e-6;
    for (int n = 0; n <= 60; n++) {
        const double t = s.duration * n / 60;
        br_exact_at(exact, t, state);
        const double tip = -4 * uniform_tip(&s, t - 1.0 / 3, false) +
                           9 * (uniform_tip(&s, t - 1.4, false) - uniform_tip(&s, t - from, false));
        assert_near(state->tip[BR_EXACT_AXIAL].displacement, tip,
                    allowed(exact, BR_EXACT_AXIAL, 1e-10));
    }
    br_exact_state_free(state);
    br_exact_free(exact);
    br_scene_clear(&s);
}

static void test_blows(void **unused)
{
    (void)unused;
    static const double width[] = {1e-7, 1e-8}, at[] = {0.1234567, 1.7};
    for (size_t i = 0; i < 4; i++) {
        struct br_scene s = rod(1.7, 0.4);
        const double w = width[i / 2] * s.duration, t = at[i % 2];
        s.axial.load = load_of(TEXT("-2.5/sqrt(pi)/%.17g*exp(-((t-%.17g)/%.17g)^2)", w, t, w));
        struct br_exact *exact = solve_sharp(&s);
        struct br_exact_state *state = new_state(exact);
        for (int n = 0; n <= 20; n++) {
            br_exact_at(exact, s.duration * n / 20, state);
            const double tip = -2.5 * uniform_tip(&s, state->time - t, true);
            assert_near(state->tip[BR_EXACT_AXIAL].displacement, tip,
                        allowed(exact, BR_EXACT_AXIAL, 1e-9));
        }
        br_exact_state_free(state);
        br_exact_free(exact);
        br_scene_clear(&s);
    }
}

/* ---- a front ---- */

/* A load of -3 N/m on all x < 2 t of a rod without inertia: c u' + a u = -3 (2 t)^2 / 2 at the tip
 * until the front leaves. */
static void test_front(void **unused)
{
    (void)unused;
    struct br_scene s = rod(0, 0.7);
    s.axial.load = load_of(TEXT("-3*step(2*t-x)"));
    struct br_exact *exact = solve_sharp(&s);
    struct br_exact_state *state = new_state(exact);
    for (int n = 0; n <= 20; n++) {
        br_exact_at(exact, s.duration * n / 20, state);
        const double r = 10, t = fmin(state->time, 1.25), later = state->time - t;
        const double ramp = 2 * (t * t - 2 * t / r + 2 / (r * r) - 2 / (r * r) * exp(-r * t));
        const double tip = -3.0 / 7 * (later > 0 ? 3.125 + (ramp - 3.125) * exp(-r * later) : ramp);
        assert_near(state->tip[BR_EXACT_AXIAL].displacement, tip,
                    allowed(exact, BR_EXACT_AXIAL, 1e-6));
    }
    br_exact_state_free(state);
    br_exact_free(exact);
    br_scene_clear(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_patches),      cmocka_unit_test(test_peaks),
        cmocka_unit_test(test_jump_in_time), cmocka_unit_test(test_blows),
        cmocka_unit_test(test_front),
    };
    return cmocka_run_group_tests_name("exact: pieces", tests, NULL, NULL);
}
