/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exact reference on the bundled scenes, above all the hard ones: its estimate is small
 * and honest, its events are those that the scene is about, and other units or a mirror
 * change nothing but the numbers' scale and sign. */
#include <math.h>
#include <string.h>

#include "reference/exact/exact.h"
#include "study/scene/rescale.h"
#include "support.h"

static const char *const scenes[] = {"example1", "example2", "example3",  "example4", "impact",
                                     "reversal", "chatter",  "vibration", "release"};
enum { SCENES = sizeof scenes / sizeof *scenes, MORE = 5, TIMES = 97 };

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

/* A bundled scene and its solution to 1e-10, which all tests share. */
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
        *b = (struct bundled){.name = name, .scene = br_test_bundled(name)};
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

TEST(test_estimates)
{
    for (size_t i = 0; i < SCENES; i++) {
        const struct bundled *b = find(scenes[i]);
        const struct solved *tight = &b->tight;
        struct solved loose = solve(&b->scene, 1e-6);
        for (int f = 0; f < BR_EXACT_FIELDS; f++) {
            const enum br_exact_field field = (enum br_exact_field)f;
            if (!is_modelled(&b->scene, field))
                continue;
            const struct br_exact_report r = br_exact_report(tight->exact, field);
            const struct br_exact_report l = br_exact_report(loose.exact, field);
            AT_MOST(r.error.displacement, 1e-10 * r.largest.displacement);
            AT_MOST(r.error.velocity, 1e-9 * r.largest.velocity);
            AT_MOST(r.error.force, 1e-9 * r.largest.force);
            AT_MOST(tip_distance(tight, &loose, b->scene.duration, field),
                    l.error.displacement + r.error.displacement + 1e-15);
        }
        release(&loose);
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

/* ---- other units, and a mirror ---- */

/* The same with the other sign; borrows it. */
static void negated_evaluate(void *self, size_t count, const double *x, double t, double *value)
{
    br_function_evaluate(self, count, x, t, value);
    for (size_t i = 0; i < count; i++)
        value[i] = -value[i];
}

static void *negated_clone(const void *self)
{
    return (void *)(uintptr_t)self;
}

static void negated_free(void *self)
{
    (void)self;
}

static struct br_function negated(const struct br_function *f)
{
    static const struct br_function_ops ops = {
        .evaluate = negated_evaluate, .clone = negated_clone, .free = negated_free};
    struct br_function out = *f;
    out.constant = -f->constant;
    if (f->ops) {
        out.ops = &ops;
        out.self = (void *)(uintptr_t)f;
    }
    return out;
}

/* The scene with the beam upside down; its functions borrow from the old one's. */
static struct br_scene mirrored(const struct br_scene *s)
{
    struct br_scene out = *s;
    for (size_t i = 0; i < BR_LOAD_TERMS; i++)
        out.bending.load.term[i].time = negated(&s->bending.load.term[i].time);
    out.bending.tip_force = negated(&s->bending.tip_force);
    out.bending.tip_moment = negated(&s->bending.tip_moment);
    out.bending.displacement = negated(&s->bending.displacement);
    out.bending.displacement_slope = negated(&s->bending.displacement_slope);
    out.bending.velocity = negated(&s->bending.velocity);
    out.bending.velocity_slope = negated(&s->bending.velocity_slope);
    return out;
}

/* Largest deviation of the other solution from the old one, relative to the largest value of each,
 * over displacements and forces of the tip. sign: of bending. */
static double deviation(const struct solved *old, const struct solved *other, double duration,
                        const struct br_units_change *u, double sign)
{
    const double force = u->kilogram * u->metre / (u->second * u->second);
    double most[2][2] = {{0}}, off[2][2] = {{0}}, worst = 0;
    for (int i = 0; i <= TIMES; i++) {
        const double t = duration * i / TIMES;
        const struct br_exact_state *x = old->state, *y = other->state;
        br_exact_at(old->exact, t, old->state);
        br_exact_at(other->exact, t * u->second, other->state);
        const double a[2][2] = {{x->tip[0].displacement, x->contact_force},
                                {sign * x->tip[1].displacement, sign * x->friction_force}};
        const double b[2][2] = {{y->tip[0].displacement, y->contact_force},
                                {y->tip[1].displacement, y->friction_force}};
        for (int f = 0; f < 2; f++)
            for (int v = 0; v < 2; v++) {
                const double d = fabs(b[f][v] / (v ? force : u->metre) - a[f][v]);
                off[f][v] = d <= off[f][v] ? off[f][v] : d;
                most[f][v] = fmax(most[f][v], fabs(a[f][v]));
            }
    }
    for (int f = 0; f < 2; f++)
        for (int v = 0; v < 2; v++)
            if (off[f][v] != 0 && !(off[f][v] / most[f][v] <= worst))
                worst = off[f][v] / most[f][v];
    return worst;
}

/* The same events; where the beam is upside down, slips go the other way. */
static void compare_events(const struct br_exact *a, const struct br_exact *b, double second,
                           double sign)
{
    static const enum br_phase mirror[] = {BR_FREE,  BR_OPEN,      BR_CLOSED,
                                           BR_STICK, BR_SLIP_DOWN, BR_SLIP_UP};
    size_t count, other;
    const struct br_exact_event *x = br_exact_events(a, &count), *y = br_exact_events(b, &other);
    assert_int_equal(count, other);
    for (size_t i = 0; i < count; i++) {
        CLOSE(y[i].time, second * x[i].time, second * 10 * x[i].error);
        assert_int_equal(y[i].phase, sign > 0 ? x[i].phase : mirror[x[i].phase]);
    }
}

static void compare(const struct bundled *old, const struct br_scene *other,
                    const struct br_units_change *u, double sign, double allowed)
{
    struct solved b = solve(other, 1e-10);
    const double worst = deviation(&old->tight, &b, old->scene.duration, u, sign);
    if (!(worst <= allowed))
        fail_msg("%s in other units, or mirrored, is off by %g", old->name, worst);
    compare_events(old->tight.exact, b.exact, u->second, sign);
    release(&b);
}

static void check_units(const char *name, const struct br_units_change *u)
{
    struct br_error err = {0};
    struct br_scene other;
    const struct bundled *b = find(name);
    MUST(br_rescale(&b->scene, u, &other, &err));
    compare(b, &other, u, 1, 1e-8);
    br_scene_clear(&other);
}

TEST(test_units)
{
    for (size_t i = 0; i < SCENES; i++) {
        check_units(scenes[i], &(struct br_units_change){39.37, 1e3, 2.2046});
        if (i % 2) /* a nanoworld */
            check_units(scenes[i], &(struct br_units_change){3e-9, 7e-12, 1.1e-20});
    }
}

TEST(test_mirror)
{
    for (size_t i = 0; i < SCENES; i++) {
        const struct bundled *b = find(scenes[i]);
        const struct br_scene other = mirrored(&b->scene);
        compare(b, &other, &(struct br_units_change){1, 1, 1}, -1, 1e-11);
    }
}

AROUND_TESTS(NULL, release_all)
