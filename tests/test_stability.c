/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The part `stability` of extremes: schemes without a limit break no bundled scene, the lagged
 * contact breaks where solver/laws.h has its limit (an oracle that marches nothing), work of loads
 * is no break, and a verdict that sees what is wrong. Its report and figure are in golden/. */
#include <math.h>
#include <string.h>

#include "base/observer.h"
#include "solver/laws.h"
#include "study/extremes/extremes.h"
#include "study/run/run.h"
#include "study/scene/file.h"
#include "support.h"

static const size_t few_n[] = {10}, few_steps[] = {10, 40, 120};

/* A run of a scene on 10 elements by methods, separated by commas; clear it. */
static enum br_status run(struct br_stability *s, const struct br_scene *scene, const char *methods,
                          struct br_error *why)
{
    struct br_named_methods named;
    assert_int_equal(br_named_methods_read(methods, &named, why), BR_OK);
    const struct br_extremes_job job = {.scene = &scene,
                                        .scenes = 1,
                                        .n = few_n,
                                        .n_count = 1,
                                        .steps = few_steps,
                                        .step_count = 3,
                                        .methods = &named};
    return br_stability_run(s, &job, why);
}

/* No march breaks: but those that bdf3 refuses. */
static void check_sound(const char *name, const char *methods)
{
    OWNED(br_scene) scene = br_test_bundled(name);
    OWNED(br_stability) s;
    MUST(run(&s, &scene, methods, &err));
    for (size_t i = 0; i < s.planes; i++) {
        const bool refusing = strcmp(s.plane[i].by->name, "bdf3") == 0;
        if (br_stability_count(&s, &s.plane[i], BR_UNSTABLE) > 0 ||
            (!refusing && br_stability_count(&s, &s.plane[i], BR_REFUSED) > 0))
            fail_msg("%s by %s breaks", name, s.plane[i].by->name);
    }
    MUST(br_stability_verdict(&s, &err));
}

/* Each scene with its own loads, which put energy in and take it out; with c_H up to 1e4 times its
 * own. */
TEST(test_schemes_without_a_limit)
{
    char **name;
    size_t count;
    MUST(br_scene_list(&name, &count, &err));
    assert_true(count >= 33);
    for (size_t i = 0; i < count; i += br_test_quick() ? 8 : 1) {
        if (i % 2 == 0 || br_test_long())
            check_sound(name[i], "euler+implicit,bdf2,trbdf2");
        if (i % 2 == 1 || br_test_long())
            check_sound(name[i], "sdirk2,esdirk3,esdirk4");
        check_sound(name[i], i % 8 ? "bdf3" : "bdf3,adaptive"); /* whose own steps are many */
    }
    br_scene_list_free(name, count);
}

/* The lagged contact of each scene that has one: nothing breaks that theory has sound. Where a
 * column breaks between two steps, the largest stable one is near the limit of a closed contact;
 * these tips also open, and some are closed only for a few steps. */
TEST(test_lagged_contact)
{
    char **name;
    size_t count, limits = 0, near = 0;
    MUST(br_scene_list(&name, &count, &err));
    for (size_t i = 0; i < count; i++) {
        OWNED(br_scene) scene = br_test_bundled(name[i]);
        struct br_stability s;
        MUST(run(&s, &scene, "euler+lagged", &err));
        MUST(br_stability_verdict(&s, &err));
        for (size_t j = 0; s.planes == 2 && j < s.plane[1].columns; j++) {
            const struct br_stability_column *c = &s.plane[1].column[j];
            const double ratio = c->largest / c->predicted;
            if (!(c->largest > 0) || isinf(c->broken))
                continue;
            if (!(ratio > 0.3 && ratio < 2 && c->broken > c->largest))
                fail_msg("%s, c_H = %g N/m: %g s, theory %g s", name[i], c->stiffness, c->largest,
                         c->predicted);
            limits++;
            near += ratio > 0.8 && ratio < 1.25;
        }
        br_stability_clear(&s);
    }
    assert_true(limits >= 25 && near >= limits / 2);
    br_scene_list_free(name, count);
}

/* The limit that stands beside a column is that of its mesh, its c_H and its elements' degree. */
TEST(test_limit_of_columns)
{
    static const size_t n[] = {10, 20};
    OWNED(br_scene) scene = br_test_bundled("impact");
    const struct br_scene *one = &scene;
    struct br_named_methods named;
    OWNED(br_stability) s;
    size_t below = 0;
    MUST(br_named_methods_read("euler+lagged,euler+lagged+p2", &named, &err));
    MUST(br_stability_run(&s,
                          &(struct br_extremes_job){.scene = &one,
                                                    .scenes = 1,
                                                    .n = n,
                                                    .n_count = 2,
                                                    .steps = few_steps,
                                                    .step_count = 1,
                                                    .methods = &named},
                          &err));
    assert_int_equal(s.planes, 4);
    for (struct br_stability_plane *p = s.plane; p < s.plane + s.planes; p++)
        for (size_t i = 0; i < p->columns; i++) {
            const struct br_stability_column *c = &p->column[i];
            struct br_field field =
                br_field_of_scene(&scene, BR_AXIAL, c->n, 1, p < s.plane + 2 ? 1 : 2);
            assert_int_equal(c->n, p->over_stiffness ? n[0] : n[i]);
            const double limit = br_contact_limit_step(&field, c->stiffness);
            if (limit < scene.duration) {
                CLOSE(c->predicted, limit, 1e-9 * limit);
                below++;
            }
        }
    assert_true(below > 20);
}

/* By hand: a rod of one element, with a mass of 3 kg and a/L = 1 N/m, has a tip of 1 kg that
 * c_H - 1 = 4 kg/k^2 makes break. The duration is 1 s, and theory is silent beyond a million. */
TEST(test_limits_by_hand)
{
    static const struct {
        double stiffness, limit, tolerance;
    } rows[] = {
        {5, 1, 1e-9}, {1.0004, 100, 1e-6}, {1 + 1.6e-11, 5e5, 50}, {1 + 1e-12, INFINITY, 0}};
    static const size_t n = 1, steps = 100;
    struct br_scene scene = br_test_bare();
    const struct br_scene *one = &scene;
    const struct br_extremes_job job = {
        .scene = &one, .scenes = 1, .n = &n, .n_count = 1, .steps = &steps, .step_count = 1};
    scene.axial.stiffness = scene.length = scene.duration = 1;
    scene.axial.viscosity = 0;
    scene.density = 3;
    scene.bending.modelled = false;
    scene.contact = (struct br_contact){.modelled = true, .gap = 1};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        OWNED(br_stability) s;
        scene.contact.stiffness = rows[i].stiffness;
        MUST(br_stability_run(&s, &job, &err));
        const double found = s.plane[0].column[0].predicted;
        if (!(found == rows[i].limit || fabs(found - rows[i].limit) <= rows[i].tolerance))
            fail_msg("row %zu: %.9g s, by hand %g s", i, found, rows[i].limit);
    }
}

/* What a column breaks by is found where it is found. This scheme takes the damping for enough up
 * to k = b/(2 a 0.071) = 0.0704 s, so that it refuses 10 steps. Of 101 none is at t = 0.5 s, where
 * the load is not a number; then 32 break by it, and 35 do not. */
TEST(test_broken_by)
{
    static const size_t n = 10, steps[] = {101, 10};
    struct br_scene scene = br_test_bare();
    const struct br_scene *one = &scene;
    struct br_named_methods named;
    OWNED(br_stability) s;
    MUST(br_named_methods_read("bdf3", &named, &err));
    scene.axial.stiffness = scene.length = scene.duration = scene.density = 1;
    scene.axial.viscosity = 0.01;
    scene.bending.modelled = false;
    scene.axial.load = br_test_load("(t - 0.5)/(t - 0.5)");
    MUST(br_stability_run(&s,
                          &(struct br_extremes_job){.scene = &one,
                                                    .scenes = 1,
                                                    .n = &n,
                                                    .n_count = 1,
                                                    .steps = steps,
                                                    .step_count = 2,
                                                    .methods = &named},
                          &err));
    const struct br_stability_column *c = &s.plane[0].column[0];
    assert_int_equal(c->point[0].outcome, BR_STABLE);
    assert_int_equal(c->point[1].outcome, BR_REFUSED);
    assert_int_equal(c->by, BR_UNSTABLE);
    CLOSE(c->largest, 1.0 / 35, 1e-15);
    CLOSE(c->broken, 1.0 / 34, 1e-15);
    br_load_clear(&scene.axial.load);
}

/* The load puts in more and more energy; and a rod with no contact and no load has none. */
TEST(test_growth_of_loads)
{
    struct br_scene scene = br_test_bare();
    struct br_stability s;
    scene.axial.load = br_test_load("exp(30*t)");
    for (int loaded = 1; loaded >= 0; loaded--) {
        MUST(run(&s, &scene, "euler+lagged,bdf2", &err));
        assert_int_equal(s.planes, 2); /* no contact: over n alone */
        for (size_t i = 0; i < 2; i++) {
            const struct br_stability_column *c = &s.plane[i].column[0];
            assert_int_equal(br_stability_count(&s, &s.plane[i], BR_STABLE), 3);
            CLOSE(c->largest, 0.1, 0);
            assert_true(isinf(c->broken) && isinf(c->predicted) && isnan(c->stiffness));
            assert_true(i == 0 || (c->point[2].share > 0) == loaded);
        }
        br_stability_clear(&s);
        br_load_clear(&scene.axial.load);
    }
}

TEST(test_outcome)
{
    const struct br_method euler = br_method_default();
    struct br_method bdf2 = euler;
    bdf2.scheme = br_time_scheme_find("bdf2");
    assert_int_equal(br_stability_outcome_of(&euler, 0.09), BR_STABLE);
    assert_int_equal(br_stability_outcome_of(&euler, 0.11), BR_UNSTABLE);
    assert_int_equal(br_stability_outcome_of(&euler, NAN), BR_UNSTABLE);
    assert_int_equal(br_stability_outcome_of(&euler, INFINITY), BR_UNSTABLE);
    assert_int_equal(br_stability_outcome_of(&bdf2, 9), BR_STABLE);
    assert_int_equal(br_stability_outcome_of(&bdf2, 11), BR_UNSTABLE);
}

/* The energy at the end over what its own march and one by implicit Euler, on the same mesh with
 * the same steps, have put in; of linear and of quadratic elements. */
TEST(test_share_of_two_marches)
{
    OWNED(br_scene) scene = br_test_bundled("impact");
    OWNED(br_stability) s;
    MUST(run(&s, &scene, "bdf2,bdf2+p2", &err));
    assert_int_equal(s.planes, 4);
    for (int degree = 1; degree <= 2; degree++) {
        struct br_run_report r[2];
        struct br_method method[2] = {br_method_default(), br_method_default()};
        method[0].scheme = br_time_scheme_find("bdf2");
        method[0].contact = method[1].contact = br_contact_rule_find("implicit");
        method[0].axial_degree = method[1].axial_degree = degree;
        for (int i = 0; i < 2; i++) {
            const struct br_run_request request = {.scene = &scene,
                                                   .wanted = BR_WANT_AXIAL,
                                                   .method = method[i],
                                                   .n = 10,
                                                   .steps = 40,
                                                   .energies = true};
            assert_false(scene.bending.modelled);
            MUST(br_run(&request, &r[i], &err));
        }
        const double put_in = br_energy_put_in(&r[0].energy_start, &r[0].work, BR_AXIAL) +
                              br_energy_put_in(&r[1].energy_start, &r[1].work, BR_AXIAL);
        const struct br_stability_point *point = &s.plane[2 * (degree - 1)].column[0].point[1];
        assert_int_equal(point->steps, 40);
        CLOSE(point->share, br_energy_total(&r[0].energy_now) / put_in, 1e-12);
        assert_true(point->share > 0.01);
    }
}

/* A verdict that sees a break where there is no limit, and steps of one column in order. */
TEST(test_verdict)
{
    OWNED(br_scene) scene = br_test_bundled("impact");
    OWNED(br_stability) s;
    MUST(run(&s, &scene, "euler+lagged,euler+implicit,bdf3", &err));
    MUST(br_stability_verdict(&s, &err));
    const struct br_stability_column *lagged = &s.plane[0].column[0], *bdf3 = &s.plane[4].column[0];
    assert_true(lagged->by == BR_UNSTABLE && bdf3->by == BR_REFUSED);
    assert_true(s.steps[0] == 120 && s.steps[2] == 10);
    assert_non_null(strstr(bdf3->point[0].why, "vibration of so little damping"));
    struct br_stability_point *point = &s.plane[2].point[1];
    point->outcome = BR_UNSTABLE;
    REFUSED(br_stability_verdict(&s, &err), BR_VERDICT, "impact by euler+implicit is unstable");
    point->outcome = BR_STABLE;
    s.plane[1].column[0].point[0].outcome = BR_UNSTABLE; /* c_H = 20 N/m: below a/L */
    REFUSED(br_stability_verdict(&s, &err), BR_VERDICT, "impact by euler+lagged is unstable");
}

/* Verdicts by hand. A rod of a = 1 N, b = 0, L = 1 m on 4 elements gains nothing by a lagged
 * contact of at most a/L = 1 N/m; with b = 0.5 N s and k = T/10 = 0.1 s, of at most (a + 2 b/k)/L =
 * 11 N/m. */
TEST(test_verdicts_by_hand)
{
    static const struct {
        const char *by;
        double viscosity, stiffness;
        enum br_stability_outcome outcome;
        bool right;
    } rows[] = {
        {"euler+lagged", 0, 1, BR_STABLE, true},
        {"euler+lagged", 0, 1, BR_REFUSED, true},
        {"euler+lagged", 0, 1, BR_UNSTABLE, false},
        {"euler+lagged", 0, 1.0001, BR_UNSTABLE, true},
        {"euler+lagged", 0.5, 10.999, BR_UNSTABLE, false},
        {"euler+lagged", 0.5, 11.001, BR_UNSTABLE, true},
        {"euler+lagged", 0, NAN, BR_UNSTABLE, false}, /* no contact */
        {"euler+lagged", 0, NAN, BR_STABLE, true},
        {"euler+implicit", 0, 1e6, BR_UNSTABLE, false},
        {"euler+implicit", 0, 1e6, BR_REFUSED, true},
        {"bdf2", 0, 1e6, BR_UNSTABLE, false},
    };
    enum { PLANES = 2, COLUMNS = 2, ROWS = 3, ALL = PLANES * COLUMNS * ROWS };
    struct br_scene scene = br_test_bare();
    scene.axial.stiffness = scene.length = scene.duration = 1;
    for (size_t i = 0; i < ALL * sizeof rows / sizeof *rows; i++) {
        const size_t row = i / ALL, place = i % ALL;
        size_t steps[ROWS] = {10, 10, 10};
        struct br_stability_point point[PLANES][COLUMNS * ROWS];
        struct br_stability_column column[PLANES][COLUMNS];
        struct br_named_method method;
        struct br_stability s = {.scene = &scene, .steps = steps, .rows = ROWS, .planes = PLANES};
        scene.axial.viscosity = rows[row].viscosity;
        MUST(br_named_method_read(rows[row].by, &method, &err));
        for (size_t j = 0; j < ALL; j++)
            point[j / (COLUMNS * ROWS)][j % (COLUMNS * ROWS)] = (struct br_stability_point){
                .steps = 10, .outcome = j == place ? rows[row].outcome : BR_STABLE};
        for (size_t p = 0; p < PLANES; p++) {
            for (size_t c = 0; c < COLUMNS; c++)
                column[p][c] = (struct br_stability_column){
                    .n = 4, .stiffness = rows[row].stiffness, .point = &point[p][c * ROWS]};
            s.plane[p] = (struct br_stability_plane){
                .by = &method, .column = column[p], .point = point[p], .columns = COLUMNS};
        }
        const enum br_status status = br_stability_verdict(&s, &err);
        if (status != (rows[row].right ? BR_OK : BR_VERDICT))
            fail_msg("row %zu at place %zu: %s", row, place, status ? err.message : "passes");
    }
    assert_int_equal(
        br_stability_verdict(&(struct br_stability){.planes = 0}, &(struct br_error){0}), BR_OK);
}

static bool stop_now(void *self)
{
    (void)self;
    return true;
}

TEST(test_refusals)
{
    OWNED(br_scene) scene = br_test_bundled("impact");
    const struct br_scene *one = &scene;
    struct br_stability s;
    REFUSED(run(&s, &scene, "bdf2,bdf3,trbdf2,sdirk2", &err), BR_BAD_INPUT, "found 4 methods");
    br_stability_clear(&s);
    const struct br_extremes_job job = {
        .scene = &one, .scenes = 1, .observer = &(struct br_observer){.stop = stop_now}};
    REFUSED(br_stability_run(&s, &job, &err), BR_INTERRUPTED, "interrupted");
    br_stability_clear(&s);
}
