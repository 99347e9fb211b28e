/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exact reference on the bundled scenes, above all the hard ones, and on a lively one: its
 * estimate is small and honest, its events are those that the scene is about, energy is balanced,
 * the tip obeys its laws, and other units change nothing but the
 * numbers' scale. */
#include <gsl/gsl_integration.h>
#include <math.h>
#include <string.h>

#include "tests/exact_scenes.h"
#include "tests/rescale.h"

static const char *const scenes[] = {"example1", "example2", "example3",  "example4", "impact",
                                     "reversal", "chatter",  "vibration", "release",  "lively"};
enum { SCENES = sizeof scenes / sizeof *scenes, MORE = 5, TIMES = 97 };

/* Impacts, sticks and slips both ways, with inertia and little damping. */
static struct br_scene lively_scene(void)
{
    struct br_scene s = {.length = 1.2, .duration = 3, .density = 0.7};
    s.axial = (struct br_scene_field){.modelled = true, .stiffness = 2, .viscosity = 0.05};
    s.axial.load = uniform(6, "sin(5*t)");
    s.bending = (struct br_scene_field){.modelled = true, .stiffness = 1, .viscosity = 0.02};
    s.bending.load = uniform(5, "sin(7*t)");
    s.contact = (struct br_contact){true, 0.1, 20};
    s.friction = (struct br_friction){BR_COULOMB, 10, 0};
    return s;
}

/* A scene and its solution to 1e-10, which all tests share. */
struct bundled {
    const char *name;
    struct br_scene scene;
    struct solved tight;
};
static struct bundled bundled[SCENES + MORE];

static struct bundled *find(const char *name)
{
    struct bundled *b = bundled;
    while (b->name && strcmp(b->name, name) != 0)
        b++;
    assert_true(b < bundled + SCENES + MORE);
    if (!b->name)
        *b = (struct bundled){.name = name,
                              .scene = strcmp(name, "lively") == 0 ? lively_scene()
                                                                   : br_test_bundled(name)};
    if (!b->tight.exact)
        b->tight = solve(&b->scene, 1e-10);
    return b;
}

static int release_all(void **state)
{
    (void)state;
    for (struct bundled *b = bundled; b < bundled + SCENES + MORE && b->name; b++) {
        release(&b->tight);
        br_scene_clear(&b->scene);
    }
    return 0;
}

static bool is_modelled(const struct br_scene *scene, enum br_field_kind field)
{
    return scene->field[field].modelled;
}

/* ---- estimates ---- */

/* The tip's largest distance of two solutions at many times that are no step's ends. */
static double tip_distance(const struct solved *a, const struct solved *b, double duration,
                           enum br_field_kind field)
{
    double most = 0;
    for (int i = 1; i <= 400; i++) {
        const double t = duration * (i - 0.318) / 400;
        br_exact_at(a->exact, t, a->state);
        br_exact_at(b->exact, t, b->state);
        const double d =
            fabs(a->state->tip[field].displacement - b->state->tip[field].displacement);
        most = d <= most ? most : d; /* NaN wins */
    }
    return most;
}

/* The same events. */
static void compare_events(const struct br_exact *a, const struct br_exact *b, double second)
{
    size_t count, other;
    const struct br_exact_event *x = br_exact_events(a, &count), *y = br_exact_events(b, &other);
    assert_int_equal(count, other);
    for (size_t i = 0; i < count; i++) {
        assert_near(y[i].time, second * x[i].time, y[i].error + second * 10 * x[i].error);
        assert_int_equal(y[i].phase, x[i].phase);
    }
}

/* Solutions that are asked to be worse must know how bad they are. */
static void check_loose(const struct bundled *b, double tolerance)
{
    struct solved loose = solve(&b->scene, tolerance);
    for (enum br_field_kind field = 0; field < BR_FIELDS; field++) {
        if (!is_modelled(&b->scene, field))
            continue;
        const struct br_exact_report r = br_exact_report(b->tight.exact, field);
        const struct br_exact_report l = br_exact_report(loose.exact, field);
        const double off = tip_distance(&b->tight, &loose, b->scene.duration, field);
        AT_MOST(r.error.displacement, 1e-10 * r.largest.displacement);
        AT_MOST(r.error.velocity, 1e-9 * r.largest.velocity);
        AT_MOST(r.error.force, 1e-9 * r.largest.force);
        AT_MOST(off, l.error.displacement + r.error.displacement + 1e-15);
        AT_MOST(off, tolerance * l.largest.displacement + 1e-15);
        AT_MOST(1e-7 * l.error.displacement, off + 1e-15);
    }
    compare_events(b->tight.exact, loose.exact, 1);
    release(&loose);
}

TEST(test_estimates)
{
    for (size_t i = 0; i < SCENES; i++) {
        check_loose(find(scenes[i]), 1e-6);
        check_loose(find(scenes[i]), 1e-3);
    }
}

/* The force of a closed contact is c_H (u - g), and so is its error that of the tip times c_H; it
 * leaves out layers after an event, where the tip may be a little farther off. */
TEST(test_error_of_a_force)
{
    const struct bundled *b = find("impact");
    struct solved loose = solve(&b->scene, 1e-3);
    const struct br_exact_size error = br_exact_report(loose.exact, BR_AXIAL).error;
    const double most = b->scene.contact.stiffness * error.displacement;
    AT_MOST(error.force, most * (1 + 1e-9));
    AT_MOST(0.4 * most, error.force);
    release(&loose);
}

/* ---- events ---- */

static size_t count_phase(const struct br_exact *exact, enum br_phase phase)
{
    size_t count, found = 0;
    const struct br_exact_event *event = br_exact_events(exact, &count);
    for (size_t i = 0; i < count; i++)
        found += event[i].phase == phase;
    return found;
}

TEST(test_events)
{
    static const struct {
        const char *scene;
        size_t closes, opens, sticks, up, down; /* at t = 0 as well */
    } expected[] = {
        {"impact", 3, 3, 0, 0, 0},        {"reversal", 0, 0, 5, 3, 2},
        {"chatter", 2, 3, 2, 3, 1},       {"vibration", 0, 0, 0, 0, 0},
        {"release", 0, 0, 1, 0, 1},       {"example3", 0, 0, 1, 0, 1},
        {"landing", 1, 1, 0, 0, 0},       {"bouncing", 5, 6, 0, 0, 0},
        {"heavy_damping", 1, 1, 0, 0, 1}, {"heavy_beam", 1, 0, 5, 0, 6},
        {"close_bound", 0, 0, 2, 0, 1},
    };
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        const struct br_exact *exact = find(expected[i].scene)->tight.exact;
        assert_int_equal(count_phase(exact, BR_CLOSED), expected[i].closes);
        assert_int_equal(count_phase(exact, BR_OPEN), expected[i].opens);
        assert_int_equal(count_phase(exact, BR_STICK), expected[i].sticks);
        assert_int_equal(count_phase(exact, BR_SLIP_UP), expected[i].up);
        assert_int_equal(count_phase(exact, BR_SLIP_DOWN), expected[i].down);
    }
}

/* ---- energy ---- */

/* An integrand of time, and what it needs. */
struct power {
    const struct br_scene *scene;
    const struct solved *solved;
    struct br_exact_projection *rate[2], *strain[2]; /* of the velocity, on one element */
};

static struct br_exact_projection *project(const struct br_exact *exact,
                                           struct br_exact_quantity part)
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
    br_exact_at(p->solved->exact, t, p->solved->state);
    double sum = -p->solved->state->friction_force * p->solved->state->tip[BR_BENDING].velocity;
    for (size_t i = 0; i < 2; i++) {
        double mean, rest, factor;
        br_exact_projection_apply(p->strain[i], p->solved->state, &mean, &rest);
        sum -= viscosity[i] * (mean * mean + rest);
        br_exact_projection_apply(p->rate[i], p->solved->state, &mean, &rest);
        br_function_evaluate(&load[i]->term[0].time, 1, &t, t, &factor);
        sum += factor * load[i]->term[0].space.constant * mean * sqrt(p->scene->length);
    }
    return sum;
}

static double energy(const struct power *p)
{
    const struct br_scene *s = p->scene;
    const double stiffness[] = {s->axial.stiffness, s->bending.stiffness};
    const double in = fmax(p->solved->state->tip[BR_AXIAL].displacement - s->contact.gap, 0);
    double sum = s->contact.stiffness * in * in / 2;
    for (unsigned i = 0; i < 2; i++) {
        const enum br_field_kind field = (enum br_field_kind)i;
        const struct br_exact_quantity strain = {field, false, i + 1}, rate = {field, true, 0};
        sum += stiffness[i] / 2 * square_of(p->solved, strain);
        sum += s->density / 2 * square_of(p->solved, rate);
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
    const struct bundled *b = find("lively");
    const struct br_exact *exact = b->tight.exact;
    struct power p = {.scene = &b->scene, .solved = &b->tight};
    for (unsigned i = 0; i < 2; i++) {
        const enum br_field_kind field = (enum br_field_kind)i;
        p.rate[i] = project(exact, (struct br_exact_quantity){field, true, 0});
        p.strain[i] = project(exact, (struct br_exact_quantity){field, true, i + 1});
    }
    size_t count;
    const struct br_exact_event *event = br_exact_events(exact, &count);
    assert_true(count >= 14);
    for (size_t i = 0; i < count; i++) /* an open contact frees the tip */
        assert_true(event[i].phase != BR_OPEN || event[i + 1].phase == BR_FREE);
    const double work = integrate(exact, b->scene.duration, net_power, &p);
    br_exact_at(exact, b->scene.duration, b->tight.state);
    const double stored = energy(&p);
    assert_true(stored > 0.1);
    assert_near(work, stored, 1e-8 * stored);
    for (size_t i = 0; i < 2; i++) {
        br_exact_projection_free(p.rate[i]);
        br_exact_projection_free(p.strain[i]);
    }
}

/* ---- the laws ---- */

/* (10) and (12), at many times. */
static void check_laws(const struct bundled *b)
{
    const struct br_scene *scene = &b->scene;
    const struct br_exact_state *state = b->tight.state;
    const double largest = br_exact_report(b->tight.exact, BR_BENDING).largest.force;
    for (int n = 1; n <= 3000; n++) {
        br_exact_at(b->tight.exact, scene->duration * n / 3000, b->tight.state);
        const double in = fmax(state->tip[BR_AXIAL].displacement - scene->contact.gap, 0);
        const double bound = scene->friction.law == BR_TRESCA    ? scene->friction.coefficient
                             : scene->friction.law == BR_COULOMB ? scene->friction.coefficient * in
                                                                 : 0;
        const double force = state->friction_force, v = state->tip[BR_BENDING].velocity;
        assert_near(state->friction_bound, bound, 1e-12 * bound);
        if (scene->contact.modelled)
            assert_near(state->contact_force, scene->contact.stiffness * in, 1e-9);
        assert_near(fmax(fabs(force), bound), bound, 1e-9 * largest);
        if (v != 0)
            assert_near(force, v > 0 ? bound : -bound, 1e-9 * largest);
    }
}

TEST(test_laws)
{
    for (size_t i = 0; i < SCENES; i++)
        check_laws(find(scenes[i]));
}

/* ---- other units ---- */

/* In a world of nanometres nothing changes but the numbers' scale; other units: test_rescale. */
TEST(test_small_units)
{
    static const struct br_units_change u = {3e-9, 7e-12, 1.1e-20};
    const double newton = u.kilogram * u.metre / (u.second * u.second);
    for (size_t i = 1; i < SCENES; i += 2) {
        OWNED(br_scene) other;
        const struct bundled *b = find(scenes[i]);
        const struct br_exact_state *x = b->tight.state;
        MUST(br_rescale(&b->scene, &u, &other, &err));
        struct solved s = solve(&other, 1e-10);
        for (int n = 0; n <= TIMES; n++) {
            const double t = b->scene.duration * n / TIMES;
            br_exact_at(b->tight.exact, t, b->tight.state);
            br_exact_at(s.exact, t * u.second, s.state);
            const double force[2][2] = {{x->contact_force, s.state->contact_force},
                                        {x->friction_force, s.state->friction_force}};
            for (int f = 0; f < 2; f++) {
                const struct br_exact_size largest =
                    br_exact_report(b->tight.exact, (enum br_field_kind)f).largest;
                assert_near(s.state->tip[f].displacement / u.metre, x->tip[f].displacement,
                            1e-8 * largest.displacement);
                assert_near(force[f][1] / newton, force[f][0], 1e-8 * largest.force);
            }
        }
        compare_events(b->tight.exact, s.exact, u.second);
        release(&s);
    }
}

AROUND_TESTS(NULL, release_all)
