/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stability limit of the lagged contact: the closed form against the linear solvers, against
 * marches, and in the limits that can be written down. Contact at u_n has none. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reference/energy/energy.h"
#include "solver/function.h"
#include "solver/laws.h"
#include "solver/scene.h"
#include "study/estimate/warnings.h"
#include "study/run/run.h"
#include "study/scene/file.h"
#include "support.h"

/* A rod that stays pressed against its obstacle. */
static struct br_scene pressed_scene(double density, double viscosity, double stiffness)
{
    struct br_scene scene = br_test_bare();
    scene.bending.modelled = false;
    scene.density = density;
    scene.axial.viscosity = viscosity;
    scene.contact = (struct br_contact){.modelled = true, .stiffness = stiffness};
    return scene;
}

static struct br_field field_of(const struct br_scene *scene, size_t n, double k, int degree)
{
    return br_field_of_scene(scene, BR_AXIAL, n, k, degree);
}

/* G(1/k) = k z_tip of a step of k, whatever solver computed it. */
TEST(test_flexibility)
{
    struct br_test_random random = {31};
    for (int trial = 0; trial < 400; trial++) {
        struct br_scene scene = pressed_scene(br_test_log_uniform(&random, 1e-6, 1e6),
                                              br_test_log_uniform(&random, 1e-6, 1e6), 1);
        if (trial % 5 == 0)
            scene.axial.viscosity = 0;
        scene.length = br_test_log_uniform(&random, 1e-2, 1e2);
        struct br_method method = br_test_method("plain", "implicit", NULL);
        method.axial_degree = 1 + trial % 2;
        const size_t n = 1 + br_test_index(&random, 60);
        const size_t steps = 1 + br_test_index(&random, 10000);
        OWNED(br_march) *march = br_test_march(&scene, n, steps, &method);
        const double k = scene.duration / (double)steps;
        const struct br_field field = field_of(&scene, n, k, method.axial_degree);
        const double solved = k * br_march_compliance(march, BR_AXIAL);
        CLOSE(br_tip_flexibility(&field, 1 / k) / solved, 1, 1e-13);
    }
}

/* Without inertia all is known: the limit is (a + 2c/k)/L, the eigenvalue (c/k - c_H L)/(a + c/k).
 */
TEST(test_no_inertia)
{
    struct br_scene scene = pressed_scene(0, 2, 1);
    scene.length = 4;
    scene.axial.stiffness = 3;
    for (int degree = 1; degree <= 2; degree++) {
        const struct br_field field = field_of(&scene, 7, 0.5, degree);
        const double limit = (3 + 2 * 2 / 0.5) / 4; /* (a + 2c/k)/L */
        CLOSE(br_contact_limit_stiffness(&field), limit, 1e-15);
        CLOSE(br_contact_limit_bouncing(&field), limit, 1e-15);
        CLOSE(br_contact_limit_step(&field, limit), 0.5, 1e-15);
        assert_false(br_contact_grows(&field, limit));
        assert_true(br_contact_grows(&field, limit * (1 + 1e-11)));
        CLOSE(br_contact_growth(&field, limit), 1, 0);
        CLOSE(br_contact_growth(&field, 5), -(4 - 5 * 4) / (3 + 4.0), 1e-14);
    }
}

/* What is 0, in each combination. */
TEST(test_nothing_there)
{
    struct br_scene scene = pressed_scene(0, 0, 1); /* neither inertia nor viscosity */
    struct br_field field = field_of(&scene, 10, 0.1, 1);
    CLOSE(br_contact_limit_stiffness(&field), 1, 1e-15); /* a/L, whatever k is */
    assert_true(isinf(br_contact_limit_step(&field, 0.999)));
    CLOSE(br_contact_limit_step(&field, 1.001), 0, 0);
    CLOSE(br_contact_growth(&field, 7), 7, 1e-14);
    CLOSE(br_contact_growth(&field, 0), 1, 0);
    assert_true(isinf(br_contact_limit_step(&field, 0)));
    assert_false(br_contact_grows(&field, 0));

    scene = pressed_scene(0, 1, 1); /* a dashpot alone: 2c/k = c_H L */
    scene.axial.stiffness = 0;
    field = field_of(&scene, 10, 0.1, 1);
    CLOSE(br_contact_limit_stiffness(&field), 20, 1e-14);
    CLOSE(br_contact_limit_step(&field, 50), 0.04, 1e-16);

    scene = pressed_scene(1, 0, 1); /* waves alone: 2 sqrt(rho a)/k where they do not come back */
    field = field_of(&scene, 100000, 1e-3, 1);
    CLOSE(br_contact_limit_stiffness(&field) / 2000, 1, 1e-3);
    CLOSE(br_contact_limit_step(&field, 2000) / 1e-3, 1, 1e-3);
}

/* The two limits are each other's inverse, and beyond it an eigenvalue leaves the circle. */
TEST(test_inverse)
{
    struct br_test_random random = {32};
    for (int trial = 0; trial < 2000; trial++) {
        const struct br_scene scene =
            pressed_scene(trial % 3 ? br_test_log_uniform(&random, 1e-9, 1e9) : 0,
                          trial % 4 ? br_test_log_uniform(&random, 1e-9, 1e9) : 1e-3, 1);
        struct br_field field = field_of(&scene, 1 + br_test_index(&random, 200),
                                         br_test_log_uniform(&random, 1e-9, 1), 1 + trial % 2);
        const double limit = br_contact_limit_stiffness(&field);
        assert_true(br_contact_limit_bouncing(&field) <= limit * (1 + 1e-13));
        assert_false(br_contact_grows(&field, limit));
        const double beyond = limit * br_test_log_uniform(&random, 1.001, 1e12);
        assert_true(br_contact_growth(&field, beyond) > 1);
        const double k = field.k;
        field.k = br_contact_limit_step(&field, limit);
        /* where the compliance hardly depends on k, k hardly is one of its digits */
        CLOSE(br_contact_limit_stiffness(&field) / limit, 1, 1e-12);
        CLOSE(br_contact_limit_step(&field, beyond) < k, true, 0);
    }
}

/* How far a pressed tip is off its rest, over the rest, after so many steps of a march that begins
 * off by 1e-9: the contact stays closed. */
static double deviation(const struct br_scene *scene, int degree, size_t steps, double *before)
{
    struct br_scene pressed = *scene;
    const double load = 1000, stiffness = scene->contact.stiffness;
    const double strain = load / (scene->axial.stiffness + stiffness * scene->length);
    char text[64];
    snprintf(text, sizeof text, "%.17g*x", strain * (1 + 1e-9));
    pressed.axial.displacement = br_test_function(text);
    pressed.axial.tip_force.constant = load;
    struct br_method method = br_test_method("plain", "lagged", NULL);
    method.axial_degree = degree;
    OWNED(br_march) *march = br_test_march(&pressed, 5, 1000, &method);
    br_test_advance(march, steps - 1);
    *before = br_march_tip_displacement(march, BR_AXIAL) / strain - scene->length;
    br_test_advance(march, steps);
    const double now = br_march_tip_displacement(march, BR_AXIAL) / strain - scene->length;
    br_function_free(&pressed.axial.displacement);
    return now;
}

/* Above the limit a tip that rests leaves its rest as the eigenvalue says; below it does not. */
TEST(test_marches)
{
    static const double density[] = {0, 1e-4, 1, 1e4}, viscosity[] = {0, 1e-3, 1};
    for (size_t i = 0; i < 4; i++)
        for (size_t j = 0; j < 3; j++)
            for (int degree = 1; degree <= 2; degree++) {
                struct br_scene scene = pressed_scene(density[i], viscosity[j], 1);
                scene.duration = 50;
                const struct br_field field = field_of(&scene, 5, 0.05, degree);
                const double limit = br_contact_limit_stiffness(&field);
                double before;
                scene.contact.stiffness = 1.5 * limit;
                const double growth = br_contact_growth(&field, scene.contact.stiffness);
                assert_true(growth > 1.01);
                const size_t steps = (size_t)(log(1e7) / log(growth));
                const double now = deviation(&scene, degree, steps, &before);
                CLOSE(now / before / -growth, 1, 1e-5);
                scene.contact.stiffness = 0.99 * limit;
                AT_MOST(fabs(deviation(&scene, degree, 1000, &before)), 1e-8);
            }
}

/* ---- contact at u_n ---- */

/* The rest of a pressed rod by its balance: the free tip is at q L^2 / (2 a), and the contact's
 * share of q L / 2 is c_H L over a + c_H L. */
static void check_rest(const struct br_time_scheme *scheme, double stiffness, size_t steps)
{
    static struct br_run_report report;
    struct br_scene scene = br_test_bare();
    scene.bending.modelled = false;
    scene.density = 1e-4;
    scene.axial.stiffness = 1000;
    scene.axial.load = (struct br_load){{{{.constant = 1000}, {.constant = 1}}}};
    scene.contact = (struct br_contact){.modelled = true, .stiffness = stiffness};
    struct br_run_request request = {
        .scene = &scene, .method = br_method_default(), .n = 8, .steps = steps, .check = true};
    request.method.scheme = scheme;
    request.method.contact = br_contact_rule_find("implicit");
    MUST(br_run(&request, &report, &err));
    MUST(report.failure.status);
    MUST(report.verdict.status);
    const double rest = 500 / (1000 + stiffness); /* 1e-8 of the way is left by bdf3 in 10 steps */
    CLOSE(report.end.last.contact_force / (stiffness * rest), 1, 1e-7);
    CLOSE(report.end.last.displacement[BR_AXIAL] / 0.5, rest / 0.5, 1e-7);
}

/* Contact at u_n has no limit, and every scheme damps at infinity: ten steps of a hundred
 * relaxation times bring a pressed rod to rest. */
TEST(test_rest)
{
    for (size_t i = 0; br_time_schemes[i]; i++)
        for (double stiffness = 1; stiffness < 2e15; stiffness *= 1e3)
            for (size_t steps = 10; steps <= 1000; steps *= 10)
                check_rest(br_time_schemes[i], stiffness, steps);
}

/* ---- what is said of it ---- */

TEST(test_round_steps)
{
    static const double of[][2] = {{0, 1},     {1, 1},      {1.0001, 2},  {3, 4},       {9, 10},
                                   {10.5, 16}, {121, 125},  {125, 125},   {1601, 2000}, {0.1, 1},
                                   {81, 100},  {8001, 1e4}, {3e11, 4e11}, {8e12, 8e12}};
    for (size_t i = 0; i < sizeof of / sizeof *of; i++)
        CLOSE(br_round_steps(of[i][0]), of[i][1], 0);
    assert_true(isinf(br_round_steps(9e12)));
    assert_true(isinf(br_round_steps(INFINITY)));
    assert_true(isinf(br_round_steps(NAN)));
}

static bool warns(const struct br_scene *scene, size_t n, size_t steps,
                  const struct br_method *method, struct br_warning *first)
{
    struct br_warnings warnings = {0};
    const struct br_planned_march planned = {
        .scene = scene, .method = method, .n = n, .steps = steps};
    br_check_contact(&planned, &warnings);
    if (warnings.count)
        *first = warnings.list[0];
    return warnings.count > 0;
}

/* What the remedy names is within the limit, for scenes at random; where nothing is warned of, an
 * error does not grow. */
TEST(test_warning)
{
    struct br_test_random random = {33};
    int warned = 0, by_step = 0;
    for (int trial = 0; trial < 500; trial++) {
        struct br_scene scene =
            pressed_scene(br_test_log_uniform(&random, 1e-4, 1e2), trial % 3 ? 1 : 0, 1);
        scene.contact.stiffness = br_test_log_uniform(&random, 1, 1e8);
        struct br_method method = br_test_method(NULL, "lagged", NULL);
        method.axial_degree = 1 + trial % 2;
        const size_t n = 1 + br_test_index(&random, 50), steps = 1 + br_test_index(&random, 5000);
        struct br_warning w;
        if (!warns(&scene, n, steps, &method, &w))
            continue;
        warned++;
        const char *k = strstr(w.remedy, "--k T/"),
                   *least = strstr(w.remedy, "stiffness of at most");
        if (k) {
            const double more = strtod(k + 6, NULL);
            AT_MOST((double)steps, more);
            assert_false(warns(&scene, n, (size_t)more, &method, &w));
            by_step++;
        }
        assert_non_null(least);
        scene.contact.stiffness = strtod(least + strlen("stiffness of at most"), NULL);
        assert_true(scene.contact.stiffness > 0);
        assert_false(warns(&scene, n, steps, &method, &w));
        method.contact = br_contact_rule_find("implicit");
        scene.contact.stiffness = 1e15;
        assert_false(warns(&scene, n, steps, &method, &w));
    }
    assert_true(warned > 100 && by_step > 100);
}

/* No step is short enough where nothing but springs is there: no step is named. */
TEST(test_no_step_helps)
{
    struct br_scene scene = pressed_scene(0, 0, 2);
    const struct br_method method = br_test_method(NULL, "lagged", NULL);
    struct br_warning w;
    assert_true(warns(&scene, 4, 10, &method, &w));
    assert_null(strstr(w.remedy, "--k"));
    assert_non_null(strstr(w.remedy, "at most 1 N/m"));
}

/* A march that never touches is not affected; one that does, is. */
TEST(test_touched)
{
    struct br_scene scene = pressed_scene(1, 1, 1e9);
    scene.axial.load = (struct br_load){{{{.constant = 1}, {.constant = 1}}}};
    const struct br_method method = br_test_method(NULL, "lagged", NULL);
    for (int touching = 0; touching < 2; touching++) {
        scene.contact.gap = touching ? 0.1 : 10;
        OWNED(br_march) *march = br_test_march(&scene, 10, 100, &method);
        assert_false(br_march_contact_unstable(march));
        br_test_advance(march, 100);
        assert_int_equal(br_march_contact_unstable(march), touching);
    }
}

/* ---- a contact that gains energy within the limit, against marches ---- */

/* The share of what was put into the axial field that a march of it has added at its most. */
static double added(const struct br_scene *scene, size_t n, size_t steps)
{
    const struct br_method method = br_method_default();
    struct br_energy start, now;
    struct br_work work;
    struct br_energy_meter *meter;
    double share = 0;
    OWNED(br_march) *march = br_test_march(scene, n, steps, &method);
    MUST(br_energy_meter_create(&meter, march, scene, &method, &err));
    for (size_t i = 0; i < steps; i++) {
        MUST(br_march_step(march, &err));
        br_energy_meter_step(meter);
        br_energy_meter_read(meter, &start, &now, &work);
        const double put_in = br_energy_put_in(&start, &work, BR_AXIAL);
        if (put_in > 0)
            share = fmax(share, br_energy_added(&work, BR_AXIAL) / put_in);
    }
    br_energy_meter_free(meter);
    return share;
}

static bool is_warned(const struct br_scene *scene, const char *contact, size_t steps)
{
    struct br_method method = br_method_default();
    struct br_warnings w = {0};
    method.contact = br_contact_rule_find(contact);
    const struct br_planned_march o = {.scene = scene, .method = &method, .n = 40, .steps = steps};
    MUST(br_check_ahead_cheaply(&o, &w, &err));
    return br_test_warning(&w, BR_WARN_BOUNCE);
}

/* Of the bundled scenes those are warned of that do gain energy on a finer mesh, at the steps of
 * `run` and at fewer. */
TEST(test_bounce)
{
    enum { N = 40 };
    static const size_t steps[] = {200, 1000};
    char **name;
    size_t count, warned[2] = {0};
    MUST(br_scene_list(&name, &count, &err));
    for (size_t i = 0; i < count; i++) {
        OWNED(br_scene) scene = br_test_bundled(name[i]);
        for (size_t j = 0; j < 2 && scene.contact.modelled; j++) {
            struct br_scene axial;
            assert_false(is_warned(&scene, "implicit", steps[j]));
            if (!is_warned(&scene, "lagged", steps[j]))
                continue;
            MUST(br_model_select(&scene, BR_WANT_AXIAL, &axial, &err));
            const double share = added(&axial, N, steps[j]);
            print_message("# %s, %zu steps: %.3g\n", name[i], steps[j], share);
            assert_true(share > 0.003);
            warned[j]++;
        }
    }
    br_scene_list_free(name, count);
    assert_true(warned[0] >= 2 && warned[1] == 1);
}
