/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exact reference on the bundled scenes, above all the hard ones: its estimate is small
 * and honest, its events are those that the scene is about, and other units or a mirror
 * change nothing but the numbers' scale and sign. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/exact/exact.h"
#include "support.h"

static const char *const scenes[] = {"example1", "example2", "example3",  "example4", "impact",
                                     "reversal", "chatter",  "vibration", "release"};
enum { SCENES = sizeof scenes / sizeof *scenes, TIMES = 97 };

struct solved {
    struct br_exact *exact;
    struct br_exact_state *state;
};

static struct solved solve(const struct br_scene *scene, double tolerance)
{
    struct br_error err = {0};
    struct solved s;
    const struct br_exact_options options = {.tolerance = tolerance};
    MUST(br_exact_create(&s.exact, scene, &options, &err));
    MUST(br_exact_state_create(&s.state, s.exact, &err));
    return s;
}

static void release(struct solved *s)
{
    br_exact_state_free(s->state);
    br_exact_free(s->exact);
}

static bool is_modelled(const struct br_scene *scene, enum br_exact_field field)
{
    return field == BR_EXACT_AXIAL ? scene->axial.modelled : scene->bending.modelled;
}

/* ---- estimates ---- */

/* The tip's largest distance of two solutions at many times that are no step's ends. */
static double tip_distance(const struct solved *a, const struct solved *b, double duration,
                           enum br_exact_field field)
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

static void test_estimates(void **state)
{
    (void)state;
    for (size_t i = 0; i < SCENES; i++) {
        struct br_scene scene = br_test_bundled(scenes[i]);
        struct solved tight = solve(&scene, 1e-10), loose = solve(&scene, 1e-6);
        for (int f = 0; f < BR_EXACT_FIELDS; f++) {
            const enum br_exact_field field = (enum br_exact_field)f;
            if (!is_modelled(&scene, field))
                continue;
            const struct br_exact_report r = br_exact_report(tight.exact, field);
            const struct br_exact_report l = br_exact_report(loose.exact, field);
            AT_MOST(r.error.displacement, 1e-10 * r.largest.displacement);
            AT_MOST(r.error.velocity, 1e-9 * r.largest.velocity);
            AT_MOST(r.error.force, 1e-9 * r.largest.force);
            AT_MOST(tip_distance(&tight, &loose, scene.duration, field),
                    l.error.displacement + r.error.displacement + 1e-15);
        }
        release(&tight);
        release(&loose);
        br_scene_clear(&scene);
    }
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

static void test_events(void **state)
{
    (void)state;
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
        struct br_scene scene = br_test_bundled(expected[i].scene);
        struct solved s = solve(&scene, 1e-10);
        assert_int_equal(count_phase(s.exact, BR_CLOSED), expected[i].closes);
        assert_int_equal(count_phase(s.exact, BR_OPEN), expected[i].opens);
        assert_int_equal(count_phase(s.exact, BR_STICK), expected[i].sticks);
        assert_int_equal(count_phase(s.exact, BR_SLIP_UP), expected[i].up);
        assert_int_equal(count_phase(s.exact, BR_SLIP_DOWN), expected[i].down);
        release(&s);
        br_scene_clear(&scene);
    }
}

/* ---- other units, and a mirror ---- */

/* value(x, t) = factor * inner(x / length, t / time) */
struct rescaled {
    struct br_function inner; /* borrowed */
    double factor, length, time;
};

static void rescaled_evaluate(void *self, size_t count, const double *x, double t, double *value)
{
    const struct rescaled *r = self;
    for (size_t i = 0; i < count; i++) {
        const double inner_x = x[i] / r->length;
        br_function_evaluate(&r->inner, 1, &inner_x, t / r->time, &value[i]);
        value[i] *= r->factor;
    }
}

static void *rescaled_clone(const void *self)
{
    struct rescaled *copy = malloc(sizeof *copy);
    assert_non_null(copy);
    memcpy(copy, self, sizeof *copy);
    return copy;
}

static const struct br_function_ops rescaled_ops = {
    .evaluate = rescaled_evaluate, .clone = rescaled_clone, .free = free};

/* How many of a unit one old unit is. */
struct units {
    double length, time, mass;
    double mirror; /* of bending: 1 or -1 */
};

static struct br_function rescale(const struct br_function *f, double factor, const struct units *u)
{
    struct br_function out = *f;
    if (!f->ops) {
        out.constant *= factor;
        return out;
    }
    const struct rescaled r = {*f, factor, u->length, u->time};
    out.ops = &rescaled_ops;
    out.self = rescaled_clone(&r);
    return out;
}

/* The same scene in other units; its functions borrow from the old one's. */
static struct br_scene convert(const struct br_scene *s, const struct units *u)
{
    const double l = u->length, t = u->time, force = u->mass * l / (t * t), m = u->mirror;
    struct br_scene out = *s;
    out.name = out.title = out.remark = NULL;
    out.length *= l;
    out.duration *= t;
    out.density *= u->mass / l;
    out.axial.stiffness *= force;
    out.axial.viscosity *= force * t;
    out.axial.load.term[0].space = rescale(&s->axial.load.term[0].space, 1, u);
    out.axial.load.term[0].time = rescale(&s->axial.load.term[0].time, force / l, u);
    out.axial.displacement = rescale(&s->axial.displacement, l, u);
    out.axial.velocity = rescale(&s->axial.velocity, l / t, u);
    out.bending.stiffness *= force * l * l;
    out.bending.viscosity *= force * l * l * t;
    out.bending.load.term[0].space = rescale(&s->bending.load.term[0].space, 1, u);
    out.bending.load.term[0].time = rescale(&s->bending.load.term[0].time, m * force / l, u);
    out.bending.displacement = rescale(&s->bending.displacement, m * l, u);
    out.bending.displacement_slope = rescale(&s->bending.displacement_slope, m, u);
    out.bending.velocity = rescale(&s->bending.velocity, m * l / t, u);
    out.bending.velocity_slope = rescale(&s->bending.velocity_slope, m / t, u);
    out.contact.gap *= l;
    out.contact.stiffness *= force / l;
    out.friction.coefficient *= s->friction.law == BR_TRESCA ? force : force / l;
    return out;
}

/* Largest deviation of the converted solution from the old one, relative to the largest
 * value of each, over displacements and forces of the tip. */
static double deviation(const struct solved *old, const struct solved *converted, double duration,
                        const struct units *u)
{
    const double force = u->mass * u->length / (u->time * u->time);
    double most[2][2] = {{0}}, off[2][2] = {{0}};
    for (int i = 0; i <= TIMES; i++) {
        const double t = duration * i / TIMES;
        br_exact_at(old->exact, t, old->state);
        br_exact_at(converted->exact, t * u->time, converted->state);
        const double a[2][2] = {
            {old->state->tip[0].displacement, old->state->contact_force},
            {u->mirror * old->state->tip[1].displacement, u->mirror * old->state->friction_force}};
        const double b[2][2] = {
            {converted->state->tip[0].displacement, converted->state->contact_force},
            {converted->state->tip[1].displacement, converted->state->friction_force}};
        for (int f = 0; f < 2; f++)
            for (int v = 0; v < 2; v++) {
                const double d = fabs(b[f][v] / (v ? force : u->length) - a[f][v]);
                off[f][v] = d <= off[f][v] ? off[f][v] : d;
                most[f][v] = fmax(most[f][v], fabs(a[f][v]));
            }
    }
    double worst = 0;
    for (int f = 0; f < 2; f++)
        for (int v = 0; v < 2; v++)
            if (off[f][v] != 0 && !(off[f][v] / most[f][v] <= worst))
                worst = off[f][v] / most[f][v];
    return worst;
}

static void check_conversion(const char *name, const struct units *u, double allowed)
{
    struct br_scene scene = br_test_bundled(name);
    struct br_scene other = convert(&scene, u);
    struct solved a = solve(&scene, 1e-10), b = solve(&other, 1e-10);
    const double worst = deviation(&a, &b, scene.duration, u);
    if (!(worst <= allowed))
        fail_msg("%s in other units is off by %g", name, worst);
    size_t count, other_count;
    br_exact_events(a.exact, &count);
    br_exact_events(b.exact, &other_count);
    assert_int_equal(count, other_count);
    release(&a);
    release(&b);
    other.axial.solution = other.bending.solution = NULL; /* borrowed */
    br_scene_clear(&other);
    br_scene_clear(&scene);
}

static void test_units(void **state)
{
    (void)state;
    for (size_t i = 0; i < SCENES; i++) {
        check_conversion(scenes[i], &(struct units){39.37, 1e3, 2.2046, 1}, 1e-8);
        if (i % 2) /* a nanoworld */
            check_conversion(scenes[i], &(struct units){3e-9, 7e-12, 1.1e-20, 1}, 1e-8);
    }
}

static void test_mirror(void **state)
{
    (void)state;
    for (size_t i = 0; i < SCENES; i++)
        check_conversion(scenes[i], &(struct units){1, 1, 1, -1}, 1e-11);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_estimates),
        cmocka_unit_test(test_events),
        cmocka_unit_test(test_units),
        cmocka_unit_test(test_mirror),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
