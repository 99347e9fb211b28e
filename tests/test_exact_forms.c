/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exact reference against closed forms. */
#include <gsl/gsl_math.h>
#include <math.h>

#include "tests/exact_scenes.h"

static const struct br_exact_part axial = {.field = BR_EXACT_AXIAL};
static const struct br_exact_part axial_velocity = {.field = BR_EXACT_AXIAL, .velocity = true};
static const struct br_exact_part bending = {.field = BR_EXACT_BENDING};
static const struct br_exact_part bending_velocity = {.field = BR_EXACT_BENDING, .velocity = true};

/* q'' + d q' + w q = 0, q(0) = 1, q'(0) = 0: q and q' at t, without loss where
 * the damping is large. */
static void oscillate(double d, double w, double t, double *q, double *v)
{
    const double discriminant = d * d / 4 - w;
    if (discriminant < 0) {
        const double omega = sqrt(-discriminant), decay = exp(-d * t / 2);
        *q = decay * (cos(omega * t) + d / (2 * omega) * sin(omega * t));
        *v = -decay * w / omega * sin(omega * t);
    } else {
        const double fast = -d / 2 - sqrt(discriminant), slow = w / fast;
        *q = (fast * exp(slow * t) - slow * exp(fast * t)) / (fast - slow);
        *v = w * (exp(slow * t) - exp(fast * t)) / (fast - slow);
    }
}

/* A mode of free vibration in a closed form. */
struct vibration {
    struct br_exact_part part;
    double damping, square; /* d and w of oscillate() */
    double (*shape)(const double *p, double x, double t);
    const double *p;
};

/* All values over [0, T], with the estimate put to the test. */
static void check_vibration(const struct br_scene *scene, const struct vibration *mode)
{
    struct br_exact *exact = solve(scene, 1e-10);
    struct br_exact_state *state = new_state(exact);
    const struct br_exact_report report = br_exact_report(exact, mode->part.field);
    struct br_exact_part rate = mode->part;
    rate.velocity = true;
    double displacement_error = 0, velocity_error = 0;
    for (int n = 0; n <= 500; n++) {
        double q, v;
        br_exact_at(exact, scene->duration * n / 500, state);
        oscillate(mode->damping, mode->square, state->time, &q, &v);
        for (int i = 0; i <= 4; i++) {
            const double x = scene->length * i / 4, shape = mode->shape(mode->p, x, 0);
            displacement_error =
                fmax(displacement_error, fabs(value_of(exact, state, mode->part, x) - q * shape));
            velocity_error =
                fmax(velocity_error, fabs(value_of(exact, state, rate, x) - v * shape));
        }
    }
    const struct br_exact_size *l = &report.largest, *e = &report.error;
    assert_near(displacement_error, 0, 1e-10 * l->displacement);
    assert_near(velocity_error, 0, 1e-9 * l->velocity);
    assert_near(displacement_error, 0, 3 * e->displacement + 1e-13 * l->displacement);
    assert_near(velocity_error, 0, 3 * e->velocity + 1e-12 * l->velocity);
    br_exact_state_free(state);
    br_exact_free(exact);
}

static double f_sine_shape(const double *p, double x, double t)
{
    (void)t;
    return p[0] * sin(p[1] * x);
}

TEST(test_axial_vibration)
{
    const double viscosities[] = {0, 1e-3, 0.3, 50};
    for (size_t i = 0; i < 4; i++) {
        struct formula shape = {f_sine_shape, {0.01, M_PI_2 / 2.5}};
        struct br_scene s = {.length = 2.5, .duration = 10, .density = 1.5};
        s.axial = (struct br_axial){.modelled = true, .stiffness = 7, .viscosity = viscosities[i]};
        s.axial.displacement = formula_function(&shape);
        const double k2 = shape.p[1] * shape.p[1] / s.density;
        check_vibration(&s, &(struct vibration){axial, k2 * s.axial.viscosity,
                                                k2 * s.axial.stiffness, f_sine_shape, shape.p});
    }
}

/* cosh bx - cos bx - p2 (sinh bx - sin bx), b = p1 */
static double f_beam(const double *p, double x, double t)
{
    (void)t;
    const double y = p[1] * x;
    return p[0] * (cosh(y) - cos(y) - p[2] * (sinh(y) - sin(y)));
}

static double f_beam_slope(const double *p, double x, double t)
{
    (void)t;
    const double y = p[1] * x;
    return p[0] * p[1] * (sinh(y) + sin(y) - p[2] * (cosh(y) - cos(y)));
}

static double f_beam_third(const double *p, double x)
{
    const double y = p[1] * x;
    return p[0] * gsl_pow_3(p[1]) * (sinh(y) - sin(y) - p[2] * (cosh(y) + cos(y)));
}

static struct br_scene beam_scene(struct formula *shape, struct formula *slope, double viscosity)
{
    struct br_scene s = {.length = 1.25, .duration = 3, .density = 0.8};
    s.bending = (struct br_bending){.modelled = true, .stiffness = 2, .viscosity = viscosity};
    s.bending.displacement = formula_function(shape);
    s.bending.displacement_slope = formula_function(slope);
    return s;
}

static struct vibration beam_vibration(const struct br_scene *s, const struct formula *shape)
{
    const double b4 = gsl_pow_4(shape->p[1]) / s->density;
    return (struct vibration){bending, b4 * s->bending.viscosity, b4 * s->bending.stiffness, f_beam,
                              shape->p};
}

/* The cantilever's second mode. */
TEST(test_bending_vibration)
{
    const double b = 4.694091132974174576436, viscosities[] = {0, 1e-3, 0.02, 3};
    const double ratio = (sinh(b) - sin(b)) / (cosh(b) + cos(b));
    for (size_t i = 0; i < 4; i++) {
        struct formula shape = {f_beam, {0.03, b / 1.25, ratio}}, slope = shape;
        slope.f = f_beam_slope;
        const struct br_scene s = beam_scene(&shape, &slope, viscosities[i]);
        const struct vibration mode = beam_vibration(&s, &shape);
        check_vibration(&s, &mode);
    }
}

/* The first mode of the clamped-propped beam, held by friction; its reaction. */
TEST(test_stick_vibration)
{
    const double b = 3.926602312047918677556;
    const double ratio = (cosh(b) - cos(b)) / (sinh(b) - sin(b));
    const double viscosities[] = {1e-3, 0.02, 3};
    for (size_t i = 0; i < 3; i++) {
        struct formula shape = {f_beam, {0.03, b / 1.25, ratio}}, slope = shape;
        slope.f = f_beam_slope;
        struct br_scene s = beam_scene(&shape, &slope, viscosities[i]);
        s.friction = (struct br_friction){BR_TRESCA, 1e4, 0};
        const struct vibration mode = beam_vibration(&s, &shape);
        check_vibration(&s, &mode);

        struct br_exact *exact = solve(&s, 1e-10);
        struct br_exact_state *state = new_state(exact);
        const double third = f_beam_third(shape.p, s.length);
        const double largest = br_exact_report(exact, BR_EXACT_BENDING).largest.force;
        for (int n = 1; n <= 300; n++) {
            double q, v;
            br_exact_at(exact, s.duration * n / 300, state);
            oscillate(mode.damping, mode.square, state->time, &q, &v);
            assert_near(state->friction_force,
                        third * (s.bending.stiffness * q + s.bending.viscosity * v),
                        1e-9 * largest);
        }
        br_exact_state_free(state);
        br_exact_free(exact);
    }
}

/* slope x - bow x^2 + p2 sin(p3 x) */
static double f_closed(const double *p, double x, double t)
{
    (void)t;
    return p[0] * x - p[1] * x * x + p[2] * sin(p[3] * x);
}

/* A contact that never opens, without viscosity: a constant load's static shape,
 * and a mode of a rod on a spring, a k cos kL = -c_H sin kL, with k chosen. */
TEST(test_closed_vibration)
{
    const double k = 2, a = 3, load = 6, x = 0.7;
    struct br_scene s = {.length = 1, .duration = 4, .density = 2};
    s.axial = (struct br_axial){.modelled = true, .stiffness = a};
    s.axial.load =
        (struct br_load){.term[0].space = {.constant = load}, .term[0].time = {.constant = 1}};
    s.contact = (struct br_contact){true, 0.1, -a * k / tan(k)};
    const double c = s.contact.stiffness, bow = load / (2 * a);
    const double slope = (load + c * (bow + s.contact.gap)) / (a + c);
    struct formula start = {f_closed, {slope, bow, 0.05, k}};
    s.axial.displacement = formula_function(&start);
    struct br_exact *exact = solve(&s, 1e-10);
    struct br_exact_state *state = new_state(exact);
    for (int n = 0; n <= 200; n++) {
        br_exact_at(exact, s.duration * n / 200, state);
        const double omega = k * sqrt(a / s.density), wave = 0.05 * cos(omega * state->time);
        const double rate = -0.05 * omega * sin(omega * state->time);
        assert_near(value_of(exact, state, axial, x), slope * x - bow * x * x + wave * sin(k * x),
                    1e-11);
        assert_near(value_of(exact, state, axial_velocity, x), rate * sin(k * x), 1e-10);
        assert_near(state->contact_force, c * (slope - bow + wave * sin(k) - s.contact.gap), 1e-9);
    }
    br_exact_state_free(state);
    br_exact_free(exact);
}

/* sin(p0 x) (p1 sin p3 t + p2 cos p3 t) */
static double f_forced(const double *p, double x, double t)
{
    return sin(p[0] * x) * (p[1] * sin(p[3] * t) + p[2] * cos(p[3] * t));
}

/* u = sin(kx) sin(omega t), by a load that depends on x and t at once. */
TEST(test_forced)
{
    const double length = 0.8, k = 5 * M_PI_2 / length, omega = 4, x = 0.5;
    struct br_scene s = {.length = length, .duration = 2, .density = 0.3};
    s.axial = (struct br_axial){.modelled = true, .stiffness = 2, .viscosity = 0.1};
    struct formula load = {f_forced,
                           {k, k * k * 2 - 0.3 * omega * omega, k * k * 0.1 * omega, omega}};
    struct formula velocity = {f_sine_shape, {omega, k}};
    s.axial.load = (struct br_load){{{formula_function(&load), {.constant = 1}}}};
    s.axial.velocity = formula_function(&velocity);
    struct br_exact *exact = solve(&s, 1e-10);
    struct br_exact_state *state = new_state(exact);
    for (int n = 0; n <= 100; n++) {
        br_exact_at(exact, s.duration * n / 100, state);
        assert_near(value_of(exact, state, axial, x), sin(k * x) * sin(omega * state->time), 1e-10);
        assert_near(value_of(exact, state, axial_velocity, x),
                    omega * sin(k * x) * cos(omega * state->time), 4e-9);
    }
    br_exact_state_free(state);
    br_exact_free(exact);
}

/* sin(p0 x) (rho g'' + k^2 (a g + c g')), g a pulse of the width p3 around t = 1, rho = 1 */
static double f_pulse(const double *p, double x, double t)
{
    const double y = (t - 1) / p[3], g = exp(-y * y), rate = -2 * y / p[3] * g;
    const double force = (4 * y * y - 2) / (p[3] * p[3]) * g;
    return sin(p[0] * x) * (force + p[0] * p[0] * (p[1] * g + p[2] * rate));
}

/* u = sin(kx) g(t): nothing happens for long, and then much in a short time. */
TEST(test_pulse)
{
    struct formula load = {f_pulse, {M_PI_2, 2, 0.1, 0.01}};
    struct br_scene s = {.length = 1, .duration = 2, .density = 1};
    s.axial = (struct br_axial){.modelled = true, .stiffness = 2, .viscosity = 0.1};
    s.axial.load = (struct br_load){{{formula_function(&load), {.constant = 1}}}};
    struct br_exact *exact = solve(&s, 1e-9);
    struct br_exact_state *state = new_state(exact);
    const double allowed = br_exact_report(exact, BR_EXACT_AXIAL).error.displacement;
    assert_near(allowed, 0, 1e-9);
    for (int n = 0; n <= 1000; n++) {
        br_exact_at(exact, s.duration * n / 1000, state);
        assert_near(state->tip[BR_EXACT_AXIAL].displacement, exp(-pow((state->time - 1) / 0.01, 2)),
                    allowed + 1e-13);
    }
    br_exact_state_free(state);
    br_exact_free(exact);
}

/* Over a long stick the modes must go on adding up to the tip that is held. */
TEST(test_held)
{
    const struct br_scene s = paper_example(4);
    struct br_exact *exact = solve(&s, 1e-10);
    struct br_exact_state *state = new_state(exact);
    br_exact_at(exact, 2.1, state);
    assert_near(value_of(exact, state, bending, 1), state->tip[BR_EXACT_BENDING].displacement,
                1e-14);
    assert_near(value_of(exact, state, bending_velocity, 1), 0, 3e-14);
    assert_near(state->tip[BR_EXACT_BENDING].velocity, 0, 0);
    br_exact_state_free(state);
    br_exact_free(exact);
}

TEST(test_examples)
{
    const struct {
        int example;
        double u, w;
    } expected[] = {
        {1, 0.171692329889782302, NAN},
        {2, 0.0429230824724455755, -0.0715950242871993164},
        {3, NAN, -0.24875},
    };
    for (size_t i = 0; i < 3; i++) {
        const struct br_scene s = paper_example(expected[i].example);
        struct br_exact *exact = solve(&s, 1e-10);
        struct br_exact_state *state = new_state(exact);
        br_exact_at(exact, 1, state);
        if (!isnan(expected[i].u))
            assert_near(state->tip[BR_EXACT_AXIAL].displacement, expected[i].u, 1e-13);
        if (!isnan(expected[i].w))
            assert_near(state->tip[BR_EXACT_BENDING].displacement, expected[i].w, 5e-15);
        if (!isnan(expected[i].w))
            assert_near(value_of(exact, state, bending, 1), expected[i].w, 5e-15);
        if (expected[i].example == 3)
            assert_near(value_of(exact, state, bending, 0.5), -0.129765625, 1e-13);
        br_exact_state_free(state);
        br_exact_free(exact);
    }
}

/* Example 3 lets go at 0.8 s; example 1 slips first, and then sticks for good. */
TEST(test_example_events)
{
    const struct br_scene three = paper_example(3), one = paper_example(1);
    struct br_exact *exact = solve(&three, 1e-10);
    size_t count;
    const struct br_exact_event *event = br_exact_events(exact, &count);
    assert_int_equal(count, 2);
    assert_int_equal(event[0].phase, BR_STICK);
    assert_int_equal(event[1].phase, BR_SLIP_DOWN);
    assert_near(event[1].time, 0.8, event[1].error);
    assert_near(event[1].error, 0, 1e-12);
    br_exact_free(exact);

    exact = solve(&one, 1e-10);
    event = br_exact_events(exact, &count);
    assert_int_equal(count, 3);
    assert_int_equal(event[0].phase, BR_CLOSED);
    assert_int_equal(event[1].phase, BR_SLIP_DOWN);
    assert_int_equal(event[2].phase, BR_STICK);
    assert_near(event[2].time, 3.99152306461369e-5, 1e-18);
    struct br_exact_state *state = new_state(exact);
    br_exact_at(exact, 1, state);
    assert_near(state->tip[BR_EXACT_BENDING].displacement, -3.05935662255835e-7, 1e-20);
    br_exact_state_free(state);
    br_exact_free(exact);
}

/* Without mass a beam whose tip is held creeps to its static shape in the time
 * c / a, and the reaction is there at once. */
TEST(test_creep)
{
    struct br_scene s = {.length = 2, .duration = 3};
    s.bending = (struct br_bending){.modelled = true, .stiffness = 5, .viscosity = 4};
    s.bending.load =
        (struct br_load){.term[0].space = {.constant = 3}, .term[0].time = {.constant = 1}};
    s.friction = (struct br_friction){BR_TRESCA, 3, 0};
    struct br_exact *exact = solve(&s, 1e-10);
    struct br_exact_state *state = new_state(exact);
    for (int n = 1; n <= 100; n++) {
        const double x = 1.3, f = 3, a = 5, rate = a / s.bending.viscosity;
        br_exact_at(exact, s.duration * n / 100, state);
        const double shape = f / (48 * a) * x * x * (2 * x * x - 5 * s.length * x + 3 * 4);
        assert_near(value_of(exact, state, bending, x), -shape * expm1(-rate * state->time), 1e-12);
        assert_near(value_of(exact, state, bending_velocity, x),
                    shape * rate * exp(-rate * state->time), 1e-11);
        assert_near(state->friction_force, 3.0 / 8 * f * s.length, 1e-10);
    }
    br_exact_state_free(state);
    br_exact_free(exact);
}
