/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Without mass the tip obeys one scalar equation between events, so that all
 * events have closed conditions: sticks, slips and contacts over many periods. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_roots.h>
#include <math.h>

#include "solver/scene.h"
#include "tests/exact_scenes.h"

/* y' + rate y = amplitude sin(omega t) + constant, y(start) = value */
struct scalar {
    double rate, amplitude, omega, constant;
    double start, value;
    bool held;    /* y' = 0 instead */
    double limit; /* of the switching function below */
};

static double particular(const struct scalar *s, double t)
{
    const double r = s->rate, w = s->omega;
    return s->amplitude * (r * sin(w * t) - w * cos(w * t)) / (r * r + w * w) + s->constant / r;
}

static double scalar_at(const struct scalar *s, double t)
{
    if (s->held)
        return s->value;
    const double free = exp(-s->rate * (t - s->start));
    return particular(s, t) + (s->value - particular(s, s->start)) * free;
}

/* What y' would be, were it not held. */
static double drive(const struct scalar *s, double t)
{
    return s->amplitude * sin(s->omega * t) + s->constant - s->rate * scalar_at(s, t);
}

/* The first root after s->start of a function that is not zero just after it. */
static double first_root(double (*f)(double, void *), struct scalar *s, double end)
{
    const double step = 1e-3, first = s->start + 1e-7;
    double low = first;
    while (low < end && f(low, s) * f(low + step, s) > 0)
        low += step;
    if (!(low < end))
        return INFINITY;
    gsl_set_error_handler_off();
    gsl_function function = {f, s};
    gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
    gsl_root_fsolver_set(solver, &function, low, low + step);
    for (int i = 0; i < 60; i++)
        gsl_root_fsolver_iterate(solver);
    const double root = gsl_root_fsolver_root(solver);
    gsl_root_fsolver_free(solver);
    return root;
}

static double slip_switching(double t, void *scalar)
{
    return drive(scalar, t);
}

static double stick_switching(double t, void *scalar)
{
    const struct scalar *s = scalar;
    return s->limit - fabs(drive(s, t));
}

static double contact_switching(double t, void *scalar)
{
    const struct scalar *s = scalar;
    return scalar_at(s, t) - s->limit;
}

/* Compares the tip with s from s->start up to `end`. */
static void check_piece(const struct solved *solved, enum br_field_kind field,
                        const struct scalar *s, double end)
{
    struct br_exact_state *state = solved->state;
    for (int i = 1; i < 10; i++) {
        br_exact_at(solved->exact, s->start + (end - s->start) * i / 10, state);
        assert_near(state->tip[field].displacement, scalar_at(s, state->time), 1e-12);
        assert_near(state->tip[field].velocity, s->held ? 0 : drive(s, state->time), 1e-10);
    }
}

static void check_event(const struct br_exact_event *event, double t, enum br_phase phase)
{
    assert_int_equal(event->phase, phase);
    assert_near(event->time, t, event->error);
    assert_near(event->error, 0, 1e-11);
}

/* The moment balance gives c w' + a w = (L^3 / 3) (3/8 f L - lambda) at the tip. */
TEST(test_slider)
{
    OWNED(br_scene) s = {.length = 1.5, .duration = 10};
    s.bending = (struct br_scene_field){.modelled = true, .stiffness = 4, .viscosity = 3};
    s.bending.load = uniform(20, "sin(3*t)");
    s.friction = (struct br_friction){BR_TRESCA, 5, 0};
    struct solved solved = solve(&s, 1e-10);
    size_t count;
    const struct br_exact_event *event = br_exact_events(solved.exact, &count);
    const double flexibility = gsl_pow_3(s.length) / (3 * s.bending.viscosity);
    const double friction = flexibility * s.friction.coefficient;
    struct scalar tip = {.rate = s.bending.stiffness / s.bending.viscosity,
                         .amplitude = flexibility * 3 / 8 * 20 * s.length,
                         .omega = 3,
                         .held = true,
                         .limit = friction};
    size_t n = 0;
    check_event(&event[n++], 0, BR_STICK);
    for (;;) {
        const double t = first_root(tip.held ? stick_switching : slip_switching, &tip, s.duration);
        check_piece(&solved, BR_BENDING, &tip, fmin(t, s.duration));
        if (!(t < s.duration))
            break;
        tip.value = scalar_at(&tip, t);
        const bool up = drive(&tip, t) > 0;
        tip.held = !tip.held;
        check_event(&event[n++], t, tip.held ? BR_STICK : up ? BR_SLIP_UP : BR_SLIP_DOWN);
        tip.constant = tip.held ? 0 : up ? -friction : friction;
        tip.start = t;
    }
    assert_int_equal(n, count);
    assert_true(count > 15);
    release(&solved);
}

/* c u' + a u = f L^2 / 2 - p L at the tip. */
TEST(test_bouncing)
{
    OWNED(br_scene) s = {.length = 1.5, .duration = 10};
    s.axial = (struct br_scene_field){.modelled = true, .stiffness = 4, .viscosity = 3};
    s.axial.load = uniform(20, "sin(5*t)");
    s.contact = (struct br_contact){true, 0.3, 50};
    struct solved solved = solve(&s, 1e-10);
    size_t count;
    const struct br_exact_event *event = br_exact_events(solved.exact, &count);
    const double open_rate = s.axial.stiffness / s.axial.viscosity;
    const double spring = s.contact.stiffness * s.length / s.axial.viscosity;
    struct scalar tip = {.rate = open_rate,
                         .amplitude = 20 * s.length * s.length / 2 / s.axial.viscosity,
                         .omega = 5,
                         .limit = s.contact.gap};
    size_t n = 0;
    bool open = true;
    check_event(&event[n++], 0, BR_OPEN);
    for (;;) {
        const double t = first_root(contact_switching, &tip, s.duration);
        check_piece(&solved, BR_AXIAL, &tip, fmin(t, s.duration));
        if (!(t < s.duration))
            break;
        tip.value = s.contact.gap;
        open = !open;
        check_event(&event[n++], t, open ? BR_OPEN : BR_CLOSED);
        tip.rate = open ? open_rate : open_rate + spring;
        tip.constant = open ? 0 : spring * s.contact.gap;
        tip.start = t;
    }
    assert_int_equal(n, count);
    assert_true(count > 10);
    release(&solved);
}

/* A slip that a constant load drives comes to rest without an end. */
TEST(test_slip_to_rest)
{
    OWNED(br_scene) s = {.length = 1, .duration = 100, .density = 0.1};
    s.bending = (struct br_scene_field){.modelled = true, .stiffness = 4, .viscosity = 3};
    s.bending.load = uniform(8, "1");
    s.friction = (struct br_friction){BR_TRESCA, 1, 0};
    struct solved solved = solve(&s, 1e-10);
    struct br_exact_state *state = solved.state;
    size_t count;
    const struct br_exact_event *event = br_exact_events(solved.exact, &count);
    assert_int_equal(event[count - 1].phase, BR_SLIP_UP);
    br_exact_at(solved.exact, s.duration, state);
    assert_near(state->tip[BR_BENDING].displacement, (3.0 / 8 * 8 - 1) / (3 * 4), 1e-13);
    assert_near(state->friction_force, 1, 0);
    release(&solved);
}
