/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What every solution must obey, whatever it is: the energy balance, the weak
 * form with other test functions, the laws at the tip. */
#include <gsl/gsl_integration.h>
#include <gsl/gsl_math.h>
#include <math.h>

#include "tests/exact_scenes.h"

static struct formula push = {f_sine, {5}}, shake = {f_sine, {7}};

/* Impacts, sticks and slips both ways, with inertia and little damping. */
static struct br_scene lively_scene(void)
{
    struct br_scene s = {.length = 1.2, .duration = 3, .density = 0.7};
    s.axial = (struct br_axial){.modelled = true, .stiffness = 2, .viscosity = 0.05};
    s.axial.load = formula_load(6, &push);
    s.bending = (struct br_bending){.modelled = true, .stiffness = 1, .viscosity = 0.02};
    s.bending.load = formula_load(5, &shake);
    s.contact = (struct br_contact){true, 0.1, 20};
    s.friction = (struct br_friction){BR_COULOMB, 10, 0};
    return s;
}

/* An integrand of time, and what it needs. */
struct power {
    const struct br_scene *scene;
    const struct br_exact *exact;
    struct br_exact_state *state;
    struct br_exact_projection *rate[2], *strain[2]; /* of the velocity, on one element */
};

static struct br_exact_projection *project(const struct br_exact *exact, struct br_exact_part part)
{
    struct br_exact_projection *projection = NULL;
    const struct br_exact_mesh mesh = {.elements = 1, .degree = 0};
    assert_int_equal(br_exact_projection_create(&projection, exact, &part, &mesh, NULL), BR_OK);
    return projection;
}

/* Load's power less the dissipated one, of the beam and of friction. */
static double net_power(double t, void *data)
{
    struct power *p = data;
    const double viscosity[] = {p->scene->axial.viscosity, p->scene->bending.viscosity};
    const struct br_load *load[] = {&p->scene->axial.load, &p->scene->bending.load};
    br_exact_at(p->exact, t, p->state);
    double sum = -p->state->friction_force * p->state->tip[BR_EXACT_BENDING].velocity;
    for (size_t i = 0; i < 2; i++) {
        double mean, rest, factor;
        br_exact_projection_apply(p->strain[i], p->state, &mean, &rest);
        sum -= viscosity[i] * (mean * mean + rest);
        br_exact_projection_apply(p->rate[i], p->state, &mean, &rest);
        br_function_evaluate(&load[i]->term[0].time, 1, &t, t, &factor);
        sum += factor * load[i]->term[0].space.constant * mean * sqrt(p->scene->length);
    }
    return sum;
}

static double energy(const struct power *p)
{
    const struct br_scene *s = p->scene;
    const double stiffness[] = {s->axial.stiffness, s->bending.stiffness};
    const double in = fmax(p->state->tip[BR_EXACT_AXIAL].displacement - s->contact.gap, 0);
    double sum = s->contact.stiffness * in * in / 2;
    for (unsigned i = 0; i < 2; i++) {
        const enum br_exact_field field = (enum br_exact_field)i;
        const struct br_exact_part strain = {field, false, i + 1}, rate = {field, true, 0};
        sum += stiffness[i] / 2 * square_of(p->exact, p->state, strain);
        sum += s->density / 2 * square_of(p->exact, p->state, rate);
    }
    return sum;
}

/* The integral over [0, T] of f, which is smooth between events. */
static double integrate(const struct br_exact *exact, double end, double (*f)(double, void *),
                        void *data)
{
    gsl_integration_workspace *work = gsl_integration_workspace_alloc(500);
    gsl_function function = {f, data};
    size_t count;
    const struct br_exact_event *event = br_exact_events(exact, &count);
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        const double next = i + 1 < count ? event[i + 1].time : end;
        double part = 0, error;
        if (next > event[i].time)
            gsl_integration_qag(&function, event[i].time, next, 1e-11, 1e-10, 500,
                                GSL_INTEG_GAUSS31, work, &part, &error);
        sum += part;
    }
    gsl_integration_workspace_free(work);
    return sum;
}

TEST(test_energy)
{
    const struct br_scene scene = lively_scene();
    struct br_exact *exact = solve(&scene, 1e-9);
    struct power p = {.scene = &scene, .exact = exact, .state = new_state(exact)};
    for (unsigned i = 0; i < 2; i++) {
        const enum br_exact_field field = (enum br_exact_field)i;
        p.rate[i] = project(exact, (struct br_exact_part){field, true, 0});
        p.strain[i] = project(exact, (struct br_exact_part){field, true, i + 1});
    }
    size_t count;
    const struct br_exact_event *event = br_exact_events(exact, &count);
    assert_true(count >= 14);
    for (size_t i = 0; i < count; i++) /* an open contact frees the tip */
        assert_true(event[i].phase != BR_OPEN || event[i + 1].phase == BR_FREE);
    const double work = integrate(exact, scene.duration, net_power, &p);
    br_exact_at(exact, scene.duration, p.state);
    const double stored = energy(&p);
    assert_true(stored > 0.1);
    assert_near(work, stored, 1e-8 * stored);
    for (size_t i = 0; i < 2; i++) {
        br_exact_projection_free(p.rate[i]);
        br_exact_projection_free(p.strain[i]);
    }
    br_exact_state_free(p.state);
    br_exact_free(exact);
}

/* The weak form (13) with w = x: a u(L) + L p - integral of f x. */
static double axial_form(double t, void *data)
{
    struct power *p = data;
    const struct br_scene *s = p->scene;
    double factor;
    br_exact_at(p->exact, t, p->state);
    br_function_evaluate(&s->axial.load.term[0].time, 1, &t, t, &factor);
    return s->axial.stiffness * p->state->tip[0].displacement +
           s->length * p->state->contact_force -
           factor * s->axial.load.term[0].space.constant * s->length * s->length / 2;
}

/* The weak form of (4) with z = x^2: 2 a w_x(L) + L^2 lambda - integral of f x^2. */
static double bending_form(double t, void *data)
{
    struct power *p = data;
    const struct br_scene *s = p->scene;
    const struct br_exact_part slope = {BR_EXACT_BENDING, false, 1};
    double factor;
    br_exact_at(p->exact, t, p->state);
    br_function_evaluate(&s->bending.load.term[0].time, 1, &t, t, &factor);
    return 2 * s->bending.stiffness * value_of(p->exact, p->state, slope, s->length) +
           s->length * s->length * p->state->friction_force -
           factor * s->bending.load.term[0].space.constant * gsl_pow_3(s->length) / 3;
}

/* rho times the integral of the velocity times x^power */
static double momentum(const struct power *p, enum br_exact_field field, int power)
{
    gsl_integration_glfixed_table *gauss = gsl_integration_glfixed_table_alloc(256);
    double sum = 0;
    for (size_t i = 0; i < 256; i++) {
        double x, weight;
        gsl_integration_glfixed_point(0, p->scene->length, i, &x, &weight, gauss);
        sum += weight * gsl_pow_int(x, power) *
               value_of(p->exact, p->state, (struct br_exact_part){field, true, 0}, x);
    }
    gsl_integration_glfixed_table_free(gauss);
    return p->scene->density * sum;
}

TEST(test_weak_form)
{
    const struct br_scene scene = lively_scene();
    struct br_exact *exact = solve(&scene, 1e-9);
    struct power p = {.scene = &scene, .exact = exact, .state = new_state(exact)};
    const double axial = integrate(exact, scene.duration, axial_form, &p);
    const double bending = integrate(exact, scene.duration, bending_form, &p);
    br_exact_at(exact, scene.duration, p.state);
    const struct br_exact_part slope = {BR_EXACT_BENDING, false, 1};
    const double tip = p.state->tip[BR_EXACT_AXIAL].displacement;
    assert_near(momentum(&p, BR_EXACT_AXIAL, 1) + scene.axial.viscosity * tip, -axial, 1e-8);
    assert_near(momentum(&p, BR_EXACT_BENDING, 2) +
                    2 * scene.bending.viscosity * value_of(exact, p.state, slope, scene.length),
                -bending, 1e-8);
    br_exact_state_free(p.state);
    br_exact_free(exact);
}

/* (10) and (12), at many times. */
static void check_laws(const struct br_scene *scene)
{
    struct br_exact *exact = solve(scene, 1e-8);
    struct br_exact_state *state = new_state(exact);
    const double largest = br_exact_report(exact, BR_EXACT_BENDING).largest.force;
    for (int n = 1; n <= 3000; n++) {
        br_exact_at(exact, scene->duration * n / 3000, state);
        const double in = fmax(state->tip[BR_EXACT_AXIAL].displacement - scene->contact.gap, 0);
        const double bound = scene->friction.law == BR_TRESCA ? scene->friction.coefficient
                                                              : scene->friction.coefficient * in;
        const double force = state->friction_force, v = state->tip[BR_EXACT_BENDING].velocity;
        assert_near(state->friction_bound, bound, 1e-12 * bound);
        if (scene->contact.modelled)
            assert_near(state->contact_force, scene->contact.stiffness * in, 1e-9);
        assert_near(fmax(fabs(force), bound), bound, 1e-9 * largest);
        if (v != 0)
            assert_near(force, v > 0 ? bound : -bound, 1e-9 * largest);
    }
    br_exact_state_free(state);
    br_exact_free(exact);
}

TEST(test_laws)
{
    for (int i = 1; i <= 4; i++) {
        const struct br_scene scene = paper_example(i);
        check_laws(&scene);
    }
    const struct br_scene scene = lively_scene();
    check_laws(&scene);
}

/* Solutions that are asked to be worse must know how bad they are. */
TEST(test_honest)
{
    const struct br_scene scene = lively_scene();
    struct br_exact *exact = solve(&scene, 1e-10);
    struct br_exact_state *x = new_state(exact);
    for (double tolerance = 1e-3; tolerance > 1e-7; tolerance /= 30) {
        struct br_exact *rough = solve(&scene, tolerance);
        struct br_exact_state *y = new_state(rough);
        double worst[2] = {0};
        for (int n = 0; n <= 1000; n++) {
            br_exact_at(exact, scene.duration * n / 1000, x);
            br_exact_at(rough, scene.duration * n / 1000, y);
            for (size_t i = 0; i < 2; i++)
                worst[i] = fmax(worst[i], fabs(x->tip[i].displacement - y->tip[i].displacement));
        }
        for (size_t i = 0; i < 2; i++) {
            const struct br_exact_report r = br_exact_report(rough, (enum br_exact_field)i);
            assert_near(worst[i], 0, r.error.displacement);
            assert_near(worst[i], 0, tolerance * r.largest.displacement);
            assert_true(worst[i] > 1e-7 * r.error.displacement);
        }
        size_t count, other;
        const struct br_exact_event *e = br_exact_events(exact, &count);
        const struct br_exact_event *f = br_exact_events(rough, &other);
        assert_int_equal(count, other);
        for (size_t i = 0; i < count; i++)
            assert_near(f[i].time, e[i].time, f[i].error + e[i].error);
        br_exact_state_free(y);
        br_exact_free(rough);
    }
    br_exact_state_free(x);
    br_exact_free(exact);
}
