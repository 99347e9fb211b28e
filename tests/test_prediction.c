/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Predicted errors against those that the exact reference measures. */
#include "study/estimate/prediction.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "solver/linear/linear_solver.h"
#include "study/grid/study.h"
#include "study/grid/sweep.h"
#include "study/scene/file.h"
#include "study/scene/named_method.h"
#include "support.h"

/* ---- predicted over measured ---- */

struct tally {
    int all, known, within_3, within_10, below, inside, far_too_low;
};

static void count_one(struct tally *t, const struct br_prediction *p, enum br_field_kind kind,
                      double actual)
{
    const struct br_predicted *e = &p->field[kind];
    const double ratio = e->error / actual;
    t->all++;
    if (!p->known)
        return;
    assert_false(e->high > 1 && e->high < INFINITY);
    t->known++;
    t->within_3 += ratio >= 1.0 / 3 && ratio <= 3;
    t->within_10 += ratio >= 0.1 && ratio <= 10;
    t->below += actual <= br_predicted_most(p, kind);
    t->inside += actual >= e->low && actual <= e->high;
    t->far_too_low += !(ratio >= 0.01);
}

static void show(const char *what, const struct tally *t)
{
    print_message(
        "# %s: %d errors, %d known, of these %d within 3, %d within 10, %d below the upper "
        "bound, %d between the bounds\n",
        what, t->all, t->known, t->within_3, t->within_10, t->below, t->inside);
}

static const size_t meshes[] = {3, 16, 100}, steps[] = {1, 8, 40, 200};
enum { MESHES = sizeof meshes / sizeof *meshes, STEPS = sizeof steps / sizeof *steps };

/* Adds what a cell shows of each field whose error the reference can tell. */
static void count_cell(struct tally *t, const struct br_study *s, const struct br_cell *cell,
                       double budget)
{
    static const enum br_part parts[2] = {BR_PART_AXIAL, BR_PART_BENDING};
    struct br_prediction p;
    const struct br_planned_march o = {.scene = s->scene,
                                       .method = &s->method,
                                       .n = cell->at.n,
                                       .steps = cell->at.steps,
                                       .budget = budget};
    if (cell->failure.status || cell->unstable)
        return;
    MUST(br_predict(&o, &p, &err));
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const double error = cell->error[parts[kind]];
        const double own =
            br_norm_of_constant(s->norm, s->scene, s->reference_report.own_error, parts[kind]);
        if (s->reference_size[kind] > 0 && !(error <= 10 * own))
            count_one(t, &p, kind, error / s->reference_size[kind]);
    }
}

/* Marches a scene by one method at the resolutions (n[i], steps[i]) and adds what it shows. A
 * scene that the exact reference refuses is left out. */
static void measure(struct tally *t, const struct br_scene *scene, const char *name,
                    const struct br_study *shape, double budget)
{
    struct br_named_method c;
    MUST(br_named_method_read(name, &c, &err));
    OWNED(br_study) s = *shape;
    s.scene = scene;
    s.norm = &br_norm_l2;
    s.method = c.method;
    if (!s.reference_kind)
        s.reference_kind = &br_reference_exact;
    MUST(br_study_run_each(&s, 1, 0, NULL, &err));
    for (size_t i = 0; !s.failure.status && i < br_study_cells(&s); i++)
        count_cell(t, &s, &s.cell[i], budget);
}

/* Bundled scenes against the exact solution; budget: as in struct br_planned_march. */
static struct tally measure_bundled(double budget, const char *what)
{
    static const char *const scenes[] = {"example1", "example2", "example3", "example4",
                                         "reversal", "release",  "smoothed", "close_bound"};
    static const char *const methods[] = {"euler+lagged", "euler+implicit", "bdf2"};
    const struct br_study shape = {
        .n_count = MESHES, .k_count = STEPS, .n = meshes, .steps = steps};
    struct tally t = {0};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i += br_test_quick() ? 4 : 1) {
        OWNED(br_scene) scene = br_test_bundled(scenes[i]);
        for (size_t m = 0; m < sizeof methods / sizeof *methods; m++)
            if (br_test_long() || (i + m) % 3 == 0)
                measure(&t, &scene, methods[m], &shape, budget);
    }
    show(what, &t);
    return t;
}

/* The interval is honest: what is stated as the most is more. */
TEST(test_bundled)
{
    const struct tally t = measure_bundled(0, "bundled scenes");
    assert_true(t.all >= (br_test_quick() ? 10 : 60));
    AT_MOST(0.95 * t.all, t.known);
    AT_MOST(0.9 * t.known, t.within_3);
    AT_MOST(0.97 * t.known, t.within_10);
    AT_MOST(0.9 * t.known, t.inside);
    assert_int_equal(t.below, t.known);
}

/* The same where the run itself is too dear to be marched beforehand. */
TEST(test_extrapolated)
{
    const struct tally t = measure_bundled(1e6, "bundled scenes, extrapolated");
    assert_true(t.all >= (br_test_quick() ? 10 : 60));
    AT_MOST(0.85 * t.all, t.known);
    AT_MOST(0.95 * t.known, t.within_3);
    assert_int_equal(t.within_10, t.known);
    assert_int_equal(t.below, t.known);
    assert_int_equal(t.far_too_low, 0);
}

/* Where in a step a load jumps decides the error of few steps: they may show any order, but a jump
 * leaves order one. */
TEST(test_jumps)
{
    static const size_t n = 32, many = 5001;
    static const double at[] = {0.21, 0.3101234567, 0.4987, 0.7331};
    const struct br_study shape = {.n_count = 1, .k_count = 1, .n = &n, .steps = &many};
    struct tally t = {0};
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        char text[64];
        struct br_scene scene = br_test_bare();
        scene.axial.modelled = false;
        scene.duration = 1;
        scene.density = 1e-4;
        scene.bending.stiffness = 1000;
        scene.bending.viscosity = 333;
        snprintf(text, sizeof text, "100*step(t - %.17g)", at[i]);
        scene.bending.load = br_test_load(text);
        measure(&t, &scene, "esdirk4", &shape, 2e5);
        br_load_clear(&scene.bending.load);
    }
    show("loads that jump, extrapolated", &t);
    assert_int_equal(t.all, 4);
    assert_true(t.known >= 2);
    assert_int_equal(t.below, t.known);
}

/* Loads that begin late, end early or jump often, on the levels of 20 and 100 steps and between
 * them. They are not too short for the marches that predict the error. */
TEST(test_late_loads)
{
    static const char *const late[] = {
        "30*step(t - 0.83)",
        "30*step(t - 0.95)",
        "x*(t > 0.57)",
        "step(t - 0.825)",
        "step(t - 0.97)",
        "2*step(t - 0.2) - 2*step(t - 0.29)",
        "step(t - 0.58)*(1 - step(t - 0.6))",
        "step(t - 0.123) - 2*step(t - 0.4567) + 3*step(t - 0.83)",
        "max(0, t - 0.83)",
        "(t - 0.9)^2*step(t - 0.9)*x",
        "step(sin(31*t))",
    };
    static const char *const methods[] = {"euler", "bdf2", "trbdf2", "esdirk4", "adaptive"};
    static const size_t n = 16, some[] = {20, 100};
    const struct br_study shape = {.n_count = 1, .k_count = 2, .n = &n, .steps = some};
    struct tally t = {0}, dear = {0};
    for (size_t i = 0; i < 2 * sizeof late / sizeof *late; i++)
        for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
            if (!br_test_long() && (i + m) % 5)
                continue;
            struct br_scene scene = br_test_bare();
            struct br_load *load = i % 2 ? &scene.bending.load : &scene.axial.load;
            scene.field[1 - i % 2].modelled = false;
            scene.axial.stiffness = 100;
            scene.bending.viscosity = 0.1;
            *load = br_test_load(late[i / 2]);
            measure(&t, &scene, methods[m], &shape, 0);
            measure(&dear, &scene, methods[m], &shape, 2e5);
            br_load_clear(load);
        }
    show("late loads", &t);
    show("late loads, extrapolated", &dear);
    assert_true(t.all >= 40 && dear.all == t.all);
    AT_MOST(0.95 * t.all, t.known);
    assert_int_equal(t.below, t.known);
    AT_MOST(0.95 * t.known, t.within_3);
    assert_int_equal(dear.below, dear.known);
}

/* ---- what no march beforehand sees ---- */

static struct br_prediction predict(const struct br_scene *scene, const struct br_method *method,
                                    size_t n, size_t k)
{
    const struct br_planned_march o = {.scene = scene, .method = method, .n = n, .steps = k};
    struct br_prediction p;
    MUST(br_predict(&o, &p, &err));
    return p;
}

/* What dies away in a hundredth of a step, and leaves the tip elsewhere: equal steps that are 16
 * times smaller do not see it either. */
TEST(test_layer)
{
    static const char text[] = "title: A blow against viscosity\nlength: 1 m\nduration: 1 s\n"
                               "density: 1 kg/m\nbending:\n  stiffness: 0.001 N m^2\n"
                               "  viscosity: 200 N m^2 s\n  velocity: 0.01*x^2 [m/s]\n"
                               "  velocity_slope: 0.02*x [1/s]\n";
    OWNED(br_scene) s;
    struct tally t = {0};
    MUST(br_scene_read_text("layer", text, &s, &err));
    static const size_t few[] = {8, 32}, some[] = {1, 4, 16};
    const struct br_study shape = {.n_count = 2, .k_count = 3, .n = few, .steps = some};
    measure(&t, &s, "euler+implicit", &shape, 0);
    show("a layer", &t);
    assert_int_equal(t.all, 6);
    assert_int_equal(t.known, 6);
    assert_int_equal(t.below, 6);
    assert_int_equal(t.within_3, 6);
    /* Here time and space go apart, so that d is 3 (docs/error.md), and the first steps decide. */
    struct br_method method = br_method_default();
    method.contact = br_contact_rule_find("implicit");
    const struct br_prediction p = predict(&s, &method, few[0], 1000);
    assert_true(p.known);
    AT_MOST(p.whole.low, p.whole.error / 3);
    AT_MOST(2.99999 * p.whole.error, p.whole.high);
}

/* ---- what is plainly inaccurate, or not known ---- */

static struct br_warnings warnings_of(const struct br_scene *scene, const struct br_method *method,
                                      size_t n, size_t k)
{
    const struct br_planned_march o = {.scene = scene, .method = method, .n = n, .steps = k};
    struct br_warnings w = {0};
    MUST(br_check_ahead(&o, &w, &err));
    return w;
}

TEST(test_inaccurate)
{
    struct br_scene s = br_test_bundled("example4");
    const struct br_method method = br_method_default();
    struct br_prediction p = predict(&s, &method, 100, 1);
    assert_true(p.known && p.time.error > 0.05);
    br_scene_clear(&s);

    s = br_test_bare();
    s.bending.modelled = false;
    s.axial.load = br_test_load("sin(60*3.14159265*x)");
    p = predict(&s, &method, 10, 100);
    assert_true(p.whole.low > 0.05);
    assert_true(p.space.error > 0.05);
    p = predict(&s, &method, 3000, 100); /* now the waves are seen */
    assert_true(p.space.high < 0.05);
    br_load_clear(&s.axial.load);
}

/* A solution that is zero is zero; beyond its limit a lagged contact has no error that is known,
 * and it is said so, with the reason. */
TEST(test_not_known)
{
    OWNED(br_scene) s = br_test_bare();
    struct br_method method = br_method_default();
    struct br_prediction p = predict(&s, &method, 10, 10);
    assert_true(p.known && p.bounded && p.whole.high == 0);
    s = br_test_bundled("example2");
    s.contact.stiffness = 1e9;
    p = predict(&s, &method, 10, 10);
    assert_false(p.known || p.bounded);
    assert_true(isinf(br_predicted_most(&p, BR_AXIAL)));
    assert_non_null(strstr(p.why, "stability limit"));
    const struct br_warnings w = warnings_of(&s, &method, 10, 10);
    const struct br_warning *one = br_test_warning(&w, BR_WARN_UNKNOWN);
    assert_non_null(one);
    assert_non_null(strstr(one->text, "is not known"));
    assert_non_null(strstr(one->text, "stability limit"));
    method.contact = br_contact_rule_find("implicit");
    p = predict(&s, &method, 10, 10);
    assert_true(p.known);
}

/* ---- warnings ---- */

TEST(test_warnings)
{
    OWNED(br_scene) s = br_test_bundled("example2");
    struct br_method method = br_method_default();
    struct br_warnings w = warnings_of(&s, &method, 100, 1000);
    assert_int_equal(w.count, 0);

    w = warnings_of(&s, &method, 100, 2);
    const struct br_warning *one = br_test_warning(&w, BR_WARN_INACCURATE);
    assert_non_null(one);
    assert_non_null(strstr(one->remedy, "--contact implicit"));

    method.solver = br_linear_solver_find("umfpack");
    w = warnings_of(&s, &method, 6400, 1000);
    one = br_test_warning(&w, BR_WARN_ROUND_OFF);
    assert_non_null(one);
    assert_non_null(strstr(one->text, "--solver umfpack at n = 6400"));
    assert_non_null(strstr(one->remedy, "--solver auto"));
    assert_null(br_test_warning(&w, BR_WARN_INACCURATE));
}

/* What the hard scenes begin with. */
#define UNIT                                                                                      \
    "length: 1 m\nduration: 1 s\ndensity: 1 kg/m\naxial:\n  stiffness: 1 N\n  viscosity: 1 N s\n" \
    "bending:\n  stiffness: 1 N m^2\n  viscosity: 1 N m^2 s\n"
#define FOLLOWER                                                                     \
    "length: 1 m\nduration: 1 s\ndensity: 0 kg/m\nbending:\n  stiffness: 10 N m^2\n" \
    "  viscosity: 0 N m^2 s\n"

/* Scenes in which what a prediction is made from can go wrong. `off` is what the run is off by,
 * relative to the largest, by the exact solution or by a far finer march: the most that is stated
 * is not less, nor more than `times` that; 0: it may also not be known. Or it is not known, and
 * why. */
static const struct {
    const char *what, *text, *method;
    size_t n, steps;
    double off, times;
    const char *why;
    enum br_warning_kind kind; /* of those that are not known: warned of as well */
} hard[] = {
    {"a blow", UNIT "  tip_force: '1 + 1e7*exp(-((t - 0.1234567)/1e-8)^2) [N]'", "euler", 10, 800,
     .why = "a load", .kind = BR_WARN_LOAD_TIME},
    {"a peak", UNIT "  load: '1e4*exp(-((x - 0.3333)/1e-5)^2) [N/m]'", "euler", 10, 800,
     .why = "a load", .kind = BR_WARN_LOAD_SPACE},
    {"peaked data",
     UNIT "  velocity: 'x^2 + 1e4*exp(-((x - 0.3333)/1e-6)^2) [m/s]'\n"
          "  velocity_slope: '2*x - 2e16*(x - 0.3333)*exp(-((x - 0.3333)/1e-6)^2) [1/s]'",
     "euler", 10, 800, .why = "the initial data", .kind = BR_WARN_INITIAL},
    {"smooth data", UNIT "  velocity: x^2 [m/s]\n  velocity_slope: 2*x [1/s]", "euler", 10, 800, 0,
     INFINITY, NULL, BR_WARN_INITIAL},

    {"waved data on one element",
     UNIT "  velocity: '1 - cos(2.5*pi*x) [m/s]'\n  velocity_slope: '2.5*pi*sin(2.5*pi*x) [1/s]'",
     "euler", 1, 800, 0, INFINITY, NULL, BR_WARN_UNKNOWN},

    /* A layer at the tip that is far narrower than any element: what it moves grows with each finer
     * mesh. */
    {"a layer of a rod",
     "length: 1 m\nduration: 0.005 s\ndensity: 1e5 kg/m\naxial:\n  stiffness: 0 N\n"
     "  viscosity: 0.002 N s\n  tip_force: 2e-4*(exp(t/0.005) - 1) [N]\n"
     "  displacement: -4e-7*x [m]",
     "euler", 1, 2, 2e-4, 0, NULL, BR_WARN_UNKNOWN},
    {"a layer of a beam",
     "length: 2e4 m\nduration: 2e-6 s\ndensity: 0.2 kg/m\nbending:\n  stiffness: 0 N m^2\n"
     "  viscosity: 1000 N m^2 s\n  load: 3e-6*sin(pi*x/2e4)*(exp(t/2e-6) - 1) [N/m]\n"
     "  tip_moment: -200 [N m]",
     "euler", 136, 267, 4.1e3, 0, NULL, BR_WARN_UNKNOWN},
    {"a layer on many elements",
     "length: 2e4 m\nduration: 6e-6 s\ndensity: 30 kg/m\nbending:\n  stiffness: 0 N m^2\n"
     "  viscosity: 2e4 N m^2 s\n  tip_moment: -4e4 [N m]",
     "euler", 10027, 1, 1.4e4, 0, NULL, BR_WARN_UNKNOWN},

    /* Uzawa's iteration stops at 1e-10 of the bound at each step; the tip, which ought to stick,
     * creeps by that, and the steps' own error is far smaller. */
    {"a creeping tip",
     "length: 0.2 m\nduration: 1 s\ndensity: 0 kg/m\nbending:\n  stiffness: 3000 N m^2\n"
     "  viscosity: 0 N m^2 s\n  load: -9*sin(7*pi*x/0.2)*(t^3 - 2*t^2) [N/m]\nfriction:\n"
     "  law: tresca\n  bound: 2 N",
     "euler+uzawa", 31, 1208, 1.36e-3, 4, NULL, BR_WARN_UNKNOWN},

    /* A beam that is let go bent vibrates a hundred times within any step, and its tip slips
     * meanwhile: no march sees it. */
    {"an unseen start",
     "length: 0.3 m\nduration: 1 s\ndensity: 0.04 kg/m\nbending:\n  stiffness: 400 N m^2\n"
     "  viscosity: 0.003 N m^2 s\n  tip_force: -1000 [N]\n  displacement: -0.33*x^2 [m]\n"
     "  displacement_slope: -0.66*x [1]\nfriction:\n  law: tresca\n  bound: 1000 N",
     "euler", 91, 1, .why = "t = 0", .kind = BR_WARN_UNKNOWN},

    /* All that happens is that the velocity of t = 0 dies away within 1e-8 of T: no step of any
     * march is so short, and the marches that are not agree among themselves. */
    {"a velocity that dies away",
     "length: 0.4 m\nduration: 0.01 s\ndensity: 2e-5 kg/m\nbending:\n  stiffness: 0 N m^2\n"
     "  viscosity: 40 N m^2 s\n  velocity: 0.005*x^2 [m/s]\n  velocity_slope: 0.01*x [1/s]\n"
     "friction:\n  law: tresca\n  bound: 20 N",
     "trbdf2", 15, 48, .why = "dies away", .kind = BR_WARN_UNKNOWN},

    /* A light beam swings undamped at the length of a step: its error is 0.11. */
    {"a light beam",
     "length: 10 m\nduration: 0.1166 s\ndensity: 2.3355e-6 kg/m\nbending:\n"
     "  stiffness: 274303 N m^2\n  viscosity: 0.0407 N m^2 s\n"
     "  load: -0.01147*sin(pi*x/10) [N/m]\n  displacement: 0.000338853*(x/10)^2 [m]\n"
     "  displacement_slope: 2*0.000338853*x/100 [1]\nfriction:\n  law: tresca\n"
     "  bound: 0.111581 N",
     "trbdf2", 1, 11778, 0.115, 0, NULL, BR_WARN_UNKNOWN},

    /* A beam without mass and viscosity follows its load at once. The load just tops the bound at
     * t = 0, less than a hundredth of T: steps that do not see that slip agree among themselves.
     * Nor do loads that top it between two steps escape. */
    {"a follower",
     FOLLOWER "  tip_force: 0.007 [N]\n  tip_moment: 0.02*(t^3 - 2*t^2) [N m]\nfriction:\n"
              "  law: tresca\n  bound: 0.006994069305199177 N",
     "euler", 1, 5, 4.3e-4, 5, NULL, BR_WARN_UNKNOWN},
    {"a follower of a peak",
     FOLLOWER "  tip_force: 0.007*(1 - 30*(t - 0.377)^2) [N]\n  tip_moment: 0.002*t [N m]\n"
              "friction:\n  law: tresca\n  bound: 0.00813 N",
     "euler", 1, 5, 0.11, 5, NULL, BR_WARN_UNKNOWN},
};

/* Row i, with room for what it points to. */
static struct br_planned_march hard_march(size_t i, struct br_scene *s, struct br_named_method *c,
                                          struct br_prediction *p)
{
    char text[1000];
    snprintf(text, sizeof text, "title: t\n%s\n", hard[i].text);
    MUST(br_scene_read_text("hard", text, s, &err));
    MUST(br_named_method_read(hard[i].method, c, &err));
    return (struct br_planned_march){
        .scene = s, .method = &c->method, .n = hard[i].n, .steps = hard[i].steps, .prediction = p};
}

TEST(test_hard)
{
    for (size_t i = 0; i < sizeof hard / sizeof *hard; i++) {
        struct br_named_method c;
        OWNED(br_scene) s;
        struct br_prediction p;
        struct br_warnings w = {0};
        const struct br_planned_march o = hard_march(i, &s, &c, &p);
        MUST(br_check_ahead(&o, &w, &err));
        const bool warned = br_test_warning(&w, hard[i].kind);
        const bool right =
            hard[i].why ? !p.known && strstr(p.why, hard[i].why) && warned &&
                              br_test_warning(&w, BR_WARN_UNKNOWN)
            : p.known ? !warned && p.whole.high >= hard[i].off &&
                            (hard[i].times == 0 || p.whole.high <= hard[i].times * hard[i].off ||
                             isinf(hard[i].times))
                      : hard[i].times == 0;
        if (!right)
            fail_msg("%s: known %d, %g to %g, %s", hard[i].what, p.known, p.whole.low, p.whole.high,
                     p.why);
    }
}

/* Nor do they state less where they are too dear, and are extrapolated from fewer steps: creep
 * grows with the number of steps. */
TEST(test_hard_extrapolated)
{
    size_t known = 0;
    for (size_t i = 0; i < sizeof hard / sizeof *hard; i++) {
        struct br_named_method c;
        OWNED(br_scene) s;
        struct br_prediction p;
        struct br_planned_march o = hard_march(i, &s, &c, &p);
        o.budget = 3e5;
        MUST(br_predict(&o, &p, &err));
        if (p.known && !(p.whole.high >= hard[i].off))
            fail_msg("%s: %g, stated %g to %g", hard[i].what, hard[i].off, p.whole.low,
                     p.whole.high);
        known += p.known && strcmp(hard[i].what, "a creeping tip") == 0;
    }
    assert_int_equal(known, 1);
}

/* Of each kind the first is kept, the others are counted. */
TEST(test_list)
{
    struct br_warnings w = {0};
    br_warn(&w, BR_WARN_LONG, NULL, "%d days", 3);
    br_warn(&w, BR_WARN_UNSTABLE, "less", "grows");
    br_warn(&w, BR_WARN_LONG, "none", "%d days", 4);
    assert_int_equal(w.count, 2);
    const struct br_warning *one = br_test_warning(&w, BR_WARN_LONG);
    assert_string_equal(one->text, "3 days");
    assert_string_equal(one->remedy, "");
    assert_int_equal(one->more, 1);
    assert_null(br_test_warning(&w, BR_WARN_ROUND_OFF));
    for (int kind = 0; kind < BR_WARNINGS; kind++)
        assert_non_null(br_warning_words[kind]);
}
