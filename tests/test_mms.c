/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Manufactured solutions as scenes: every refusal, the data that a solution determines against
 * closed forms, derivatives against those by hand, what is checked of a solution, and the
 * reference. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reference/mms/mms.h"
#include "solver/proof.h"
#include "study/grid/study.h"
#include "study/grid/sweep.h"
#include "study/scene/file.h"
#include "support.h"

/* ---- scenes ---- */

#define TOP "title: t\nlength: 2 m\nduration: 1 s\ndensity: 3 kg/m\n"
#define AXIAL "axial:\n  stiffness: 5 N\n  viscosity: 7 N s\n"
#define BENDING "bending:\n  stiffness: 11 N m^2\n  viscosity: 13 N m^2 s\n"
#define CONTACT "contact: {gap: 0.1 m, stiffness: 17 N/m}\n"
#define TRESCA "friction: {law: tresca, bound: 19 N}\n"
#define COULOMB "friction: {law: coulomb, coefficient: 19 N/m}\n"
#define U "  solution: x^2*t^2 [m]\n"
#define W "  solution: x^4*t^2 [m]\n"
#define REST "  solution: x^4 [m]\n"

TEST(test_refusals)
{
    static const struct {
        const char *text, *message;
    } refusals[] = {
        {TOP AXIAL U BENDING, ":8: solution: found none in bending, expected one in every part"},
        {TOP AXIAL BENDING W, ":11: solution: found none in axial, expected one in every part"},
        {TOP AXIAL U "  load: 1 [N/m]\n", ":8: solution: found 'load' beside it, expected none"},
        {TOP AXIAL U "  load: x [N/m]\n", "found 'load' beside it"},
        {TOP AXIAL U "  tip_force: t [N]\n", "found 'tip_force' beside it"},
        {TOP AXIAL U "  displacement: x [m]\n", "found 'displacement' beside it"},
        {TOP AXIAL U "  velocity: x [m/s]\n", "found 'velocity' beside it"},
        {TOP BENDING W "  load: t [N/m]\n", ":8: solution: found 'load' beside it"},
        {TOP BENDING W "  tip_force: t [N]\n", "found 'tip_force' beside it"},
        {TOP BENDING W "  tip_moment: t [N m]\n", "found 'tip_moment' beside it"},
        {TOP BENDING W "  displacement: x^2 [m]\n", "found 'displacement' beside it"},
        {TOP BENDING W "  displacement_slope: x [1]\n", "found 'displacement_slope' beside it"},
        {TOP BENDING W "  velocity: x^2 [m/s]\n", "found 'velocity' beside it"},
        {TOP BENDING W "  velocity_slope: x [1/s]\n", "found 'velocity_slope' beside it"},
        {TOP AXIAL "  solution: x + [m]\n", ":8: solution: 'x +' is no expression in x and t"},
        {TOP AXIAL "  solution: x [N]\n",
         ":8: solution: found 'x [N]', which is a force, expected a length, as m"},
        {TOP AXIAL "  solution: \"x > 1 ? x : t [m]\"\n", ":8: solution: u "},
        {TOP AXIAL "  solution: x + y [m]\n", ":8: solution: 'x + y' is no expression"},
        {TOP AXIAL "  solution: x*step(t - 0.3) [m]\n", ":8: solution: u jumps by "},
        {TOP AXIAL U BENDING "  solution: x [m]\n", ":12: solution: w_x is 1 at x = 0"},
        {TOP AXIAL U "  stick_force: 1 [N]\n", ":9: stick_force: unknown key in axial"},
        {TOP BENDING W "  stick_force: 1 [N]\n", "stick_force belongs to friction and a solution"},
        {TOP BENDING "  stick_force: 1 [N]\n" TRESCA, "belongs to friction and a solution"},
        {TOP BENDING W "  stick_force: x [N]\n", "expected an expression without x"},
        {TOP BENDING REST "  stick_force: -19.1 [N]\n" TRESCA,
         ":8: solution: stick_force is -19.1 N at t = 0 s, where the tip rests, expected at most "
         "the friction bound, 19 N"},
        {TOP BENDING REST "  stick_force: 20*t [N]\n" TRESCA, "stick_force is 19.0"},
        {TOP BENDING REST "  stick_force: 1/(t - 0.5)^2 [N]\n" TRESCA, "stick_force is "},
        {TOP AXIAL "  solution: x*(1 - t) [m]\n" BENDING REST
                   "  stick_force: 1 [N]\n" CONTACT COULOMB,
         ":12: solution: stick_force is 1 N at t = 0.923828 s, where the tip rests"},
    };
    for (size_t i = 0; i < sizeof refusals / sizeof *refusals; i++)
        br_test_scene_refused(refusals[i].text, false, refusals[i].message);
}

static struct br_scene scene_of(const char *text)
{
    struct br_scene scene;
    MUST(br_scene_read_text("made.yaml", text, &scene, &err));
    return scene;
}

/* u = x^2 (t^2 + t), w = x^4 (t^2 + t), with L = 2 and the constants above. */
TEST(test_data)
{
    OWNED(br_scene)
    s = scene_of(TOP AXIAL "  solution: x^2*(t^2 + t)  [m]\n" BENDING
                           "  solution: x^4*(t^2 + t) [m]\n" CONTACT COULOMB);
    const double x = 0.7, t = 0.6, g = t * t + t, g_t = 2 * t + 1, tip = 2;
    assert_string_equal(s.axial.solution, "x^2*(t^2 + t)");
    assert_false(s.axial.load.term[0].space.uses_t); /* products, assembled once */
    assert_false(s.bending.load.term[0].space.uses_t);
    CLOSE(br_load_value(&s.axial.load, x, t), 3 * x * x * 2 - 2 * (5 * g + 7 * g_t), 1e-12);
    CLOSE(br_load_value(&s.bending.load, x, t), 3 * pow(x, 4) * 2 + 24 * (11 * g + 13 * g_t),
          1e-11);
    const double press = 4 * g - 0.1;
    CLOSE(br_function_at(&s.axial.tip_force, 0, t), 2 * tip * (5 * g + 7 * g_t) + 17 * press,
          1e-11);
    CLOSE(br_function_at(&s.bending.tip_force, 0, t), 19 * press - 24 * tip * (11 * g + 13 * g_t),
          1e-11);
    CLOSE(br_function_at(&s.bending.tip_moment, 0, t), 12 * tip * tip * (11 * g + 13 * g_t), 1e-11);
    CLOSE(br_function_at(&s.axial.velocity, x, 9), x * x, 1e-15);
    CLOSE(br_function_at(&s.bending.velocity, x, 9), pow(x, 4), 1e-15);
    CLOSE(br_function_at(&s.bending.velocity_slope, x, 9), 4 * pow(x, 3), 1e-14);
    assert_true(!s.axial.tip_force.uses_x && !s.axial.velocity.uses_t && s.axial.velocity.uses_x);
    CLOSE(br_function_at(&s.axial.displacement, x, 9), 0, 0);
}

/* At rest, then slipping back: lambda = stick force, then -b; an open contact gives none. */
TEST(test_friction_data)
{
    struct br_scene s = scene_of(TOP BENDING "  solution: x^4*(1 - (t - 0.5)^2*step(t - 0.5)) [m]\n"
                                             "  stick_force: 10*t [N]\n" TRESCA);
    CLOSE(br_function_at(&s.bending.tip_force, 0, 0.25), 2.5 - 24 * 2 * 11, 1e-11);
    CLOSE(br_function_at(&s.bending.tip_force, 0, 0.75),
          -19 - 24 * 2 * (11 * (1 - 0.0625) - 13 * 0.5), 1e-11);
    CLOSE(br_function_at(&s.bending.displacement_slope, 0.5, 0), 0.5, 1e-15);
    br_scene_clear(&s);
    s = scene_of(TOP AXIAL "  solution: -x [m]\n" BENDING W CONTACT COULOMB);
    CLOSE(br_function_at(&s.axial.tip_force, 0, 0.5), -5, 1e-15);
    CLOSE(br_function_at(&s.bending.tip_force, 0, 0.5), -24 * 2 * (11 * 0.25 + 13), 1e-11);
    br_scene_clear(&s);
    /* without density an initial velocity means nothing */
    s = scene_of("title: t\nlength: 1 m\nduration: 1 s\ndensity: 0 kg/m\n" AXIAL
                 "  solution: x*(1 + t) [m]\n");
    assert_true(br_function_is_zero(&s.axial.velocity));
    CLOSE(br_function_at(&s.axial.displacement, 0.5, 0), 0.5, 0);
    br_scene_clear(&s);
}

/* ---- derivatives ---- */

/* Of higher orders, and at kinks: from the right. */
TEST(test_derivatives)
{
    static const struct {
        const char *text;
        struct br_partial order;
        double x, t, expected;
    } rows[] = {
        {"x^3*t^2", {2, 1}, 2, 3, 72},
        {"x^3*t^2", {3, 2}, 2, 3, 12},
        {"sin(2*x)*exp(-t)", {4, 1}, 0.3, 0.7, -16 * 0.5646424733950354 * 0.4965853037914095},
        {"abs(t - 0.5)", {0, 1}, 0, 0.5, 1},
        {"abs(t - 0.5)", {0, 1}, 0, 0.25, -1},
        {"x*abs(t - 0.5)^3", {0, 2}, 2, 0.5, 0},
        {"(t - 0.5)^2*step(t - 0.5)", {0, 2}, 0, 0.5, 2},
        {"(t - 0.5)^2*step(t - 0.5)", {0, 2}, 0, 0.4999, 0},
        {"(x - 0.5)^2*step(x - 0.5) + t", {2, 0}, 0.5, 0.5, 2},
        {"(x + t - 1)^2*step(x + t - 1)", {1, 1}, 0.5, 0.5, 2},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct br_function f = br_test_function(rows[i].text), d;
        MUST(br_function_derivative(&f, rows[i].order, &d, &err));
        CLOSE(br_function_at(&d, rows[i].x, rows[i].t), rows[i].expected, 1e-9);
        br_function_free(&d);
        br_function_free(&f);
    }
}

/* ---- the check of a solution ---- */

static const struct {
    enum br_field_kind kind;
    const char *text, *message; /* NULL: accepted */
} solutions[] = {
    {BR_AXIAL, "sin(x)*exp(t)", NULL},
    {BR_AXIAL, "x*abs(t - 0.3)*(t - 0.3)", NULL},                        /* u_tt jumps */
    {BR_BENDING, "x^2*(t - 0.4)^2*step(t - 0.4)", NULL},                 /* at no sample point */
    {BR_AXIAL, "x*(0.5 + (x + t - 1)^2*step(x + t - 1))", "u_xx jumps"}, /* u_xx jumps */
    {BR_AXIAL, "1 + x", "u is 1 at x = 0, t = 0 s, expected 0 where the beam is clamped"},
    {BR_AXIAL, "x + (t - 0.5)^2*step(t - 0.5)", "u is "},
    {BR_BENDING, "1 + x^2", "w is 1 at x = 0, t = 0 s"},
    {BR_BENDING, "sin(x)", "w_x is 1 at x = 0, t = 0 s, expected 0"},
    {BR_AXIAL, "x/(t - 0.5)", "u: "},
    {BR_AXIAL, "x*log(t)", "u: "},
    {BR_AXIAL, "x*sqrt(t)", "u_t: "},
    {BR_AXIAL, "x*abs(t - 0.3)^1.5", "u_tt: "},
    {BR_AXIAL, "x*abs(t - 0.5)^1.5", "u_tt: "},
    {BR_AXIAL, "x*t^1.5", "u_tt: "},
    {BR_AXIAL, "x^1.5", "u_xx: "},
    {BR_AXIAL, "x*(1 + exp(-100*t))", NULL},
    {BR_AXIAL, "x/(t - 0.3)", "u: "},
    /* jumps, whose deltas the derivatives leave out */
    {BR_AXIAL, "x*step(t - 0.3)",
     "u jumps by 0.125 at t = 0.3 s, x = 0.125 m, expected a solution whose derivatives"},
    {BR_AXIAL, "x*abs(t - 0.3)", "u_t jumps by 0.25 at t = 0.3 s"},
    {BR_AXIAL, "x*step(x - 0.3)", "u jumps"},
    {BR_AXIAL, "x*abs(x - 0.3)", "u_x jumps"},
    {BR_BENDING, "x^2*step(t - 0.3)", "w jumps"},
    {BR_BENDING, "x^2*abs(t - 0.3)", "w_t jumps"},
    {BR_BENDING, "x^2*abs(x - 0.3)", "w_x jumps"},
    {BR_BENDING, "x^2*abs(x - 0.3)*(x - 0.3)", "w_xx jumps"},
    {BR_BENDING, "x^2*abs(x - 0.3)^3", "w_xxx jumps"},
    {BR_BENDING, "x^2*abs(x - 0.3)^3*(x - 0.3)", NULL},
    {BR_AXIAL, "asinh(x/2)*t", NULL},
    {BR_AXIAL, "x*asinh(t/2)", NULL},
    {BR_AXIAL, "x > 0.3 ? x : x", NULL},
    {BR_AXIAL, "x > 0.3 ? x : 0", "u jumps"},
    {BR_AXIAL, "x*min(t, 0.3)", "u_t jumps"},
    {BR_BENDING, "ln(1 + x^2)*2^3^t", NULL},
    /* between all samples */
    {BR_AXIAL, "x*(1 + step(t - 0.3001) - step(t - 0.3002))", "u jumps by "},
    {BR_AXIAL, "x*(1 + (t > 0.3001 && t < 0.3002 && x > 0.7001 && x < 0.7002))", "u jumps by "},
    {BR_AXIAL, "x + 1e-9*x/(t - 0.300001)", "u: "},
};

TEST(test_given)
{
    for (size_t i = 0; i < sizeof solutions / sizeof *solutions; i++) {
        OWNED(br_function) f = br_test_function(solutions[i].text);
        const struct br_given s = {&f, solutions[i].kind, 1, 1};
        if (solutions[i].message)
            REFUSED(br_given_check(&s, &err), BR_BAD_INPUT, solutions[i].message);
        else
            MUST(br_given_check(&s, &err));
    }
}

/* ---- the reference ---- */

/* exp(x) t^2 at t = 3 on three elements of [0, 2]: the modes and what they leave out make up the
 * norm; the first of them is a mean. */
TEST(test_projection)
{
    static const size_t mesh[] = {5, 3};
    static const double factor[] = {9, 6, 6}; /* of exp(x) and all its derivatives */
    struct br_scene scene = br_test_bare();
    scene.length = 2;
    scene.duration = 6;
    scene.axial.solution = scene.bending.solution = (char[]){"exp(x)*t^2"};
    scene.axial.given = scene.bending.given = br_test_function(scene.axial.solution);
    const struct br_reference_request request = {
        .scene = &scene, .axial_degree = 2, .levels = 10, .mesh_count = 2, .mesh = mesh};
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        for (int measure = 0; measure < BR_TIP; measure++) {
            void *reference;
            double modes[3 * BR_MOST_MODES], sum = 0;
            struct br_view view = {.values = modes};
            const struct br_sample_at at = {kind, (enum br_measure)measure, 1};
            MUST(br_reference_mms.create(&reference, &request, &err));
            MUST(br_reference_mms.advance(reference, at.kind, 5, &err));
            br_reference_mms.sample(reference, &at, &view);
            for (size_t m = 0; m < 3 * view.modes; m++)
                sum += modes[m] * modes[m];
            const double norm = factor[measure] * factor[measure] * expm1(4) / 2;
            CLOSE(sum + view.rest, norm, 1e-12 * norm);
            CLOSE(modes[0], factor[measure] * sqrt(1.5) * expm1(2.0 / 3), 1e-12);
            assert_true(view.rest > 0);
            AT_MOST(br_reference_mms.report(reference).own_error[kind][measure],
                    1e-10 * sqrt(norm));
            br_reference_mms.free(reference);
        }
    br_function_free(&scene.axial.given);
}

static struct br_study study_of(const struct br_scene *scene, const size_t *n, const size_t *steps)
{
    struct br_study s = br_test_study(scene, &br_reference_mms, 2, n, 2, steps);
    s.method = br_test_method(NULL, "implicit", NULL);
    return s;
}

/* What both the elements and the Euler steps hold exactly has no error at all: with contact,
 * friction, a tip force and a moment, on any mesh. */
TEST(test_exact)
{
    struct br_scene scene =
        scene_of(TOP AXIAL "  solution: x*(1 + t) [m]\n" BENDING
                           "  solution: x^2*(3 - x)*(1 - 2*t) [m]\n" CONTACT COULOMB);
    static const size_t n[] = {3, 7}, steps[] = {5, 40};
    OWNED(br_study) s = study_of(&scene, n, steps);
    MUST(br_study_run(&s, 1, 2, NULL, &err));
    for (size_t c = 0; c < 4; c++)
        for (int p = 0; p < BR_PARTS; p++)
            AT_MOST(s.cell[c].error[p], 2e-13);
    assert_true(s.reference_scale > 1);
    AT_MOST(s.reference_report.own_error[BR_BENDING][BR_DISPLACEMENT], 1e-13 * s.reference_scale);
    assert_string_equal(s.events,
                        "Manufactured solution: u = x*(1 + t), w = x^2*(3 - x)*(1 - 2*t).\n");
    br_scene_clear(&scene);
}

/* Evaluators are made and used on several threads at once: the same bits. */
TEST(test_threads)
{
    static const size_t n[] = {4, 6}, steps[] = {20, 30};
    OWNED(br_scene) scene = br_test_bundled("mms_opening");
    double one[4] = {0};
    for (int threads = 1; threads <= 4; threads++) {
        OWNED(br_study) s = study_of(&scene, n, steps);
        MUST(br_study_run(&s, 1, threads, NULL, &err));
        for (size_t c = 0; c < 4; c++) {
            one[c] = threads == 1 ? s.cell[c].error[0] : one[c];
            assert_true(s.cell[c].error[0] == one[c] && one[c] > 0);
        }
    }
}

/* Coulomb's bound takes the axial tip value, which is right to O(h^2) only: on fine meshes the
 * bending's order falls to 2; with Tresca's it stays 4. Seen against a run with the same steps, so
 * that there is no time error at all. What other orders the scheme has is seen by `check --all`. */
TEST(test_coulomb_limit)
{
    static const struct {
        const char *scene;
        double order;
    } rows[] = {{"mms_opening", 2}, {"mms_stick", 4}};
    static const size_t n[] = {96, 128}, steps = 1000;
    for (size_t i = 0; i < 2 && !br_test_quick(); i++) {
        OWNED(br_scene) scene = br_test_bundled(rows[i].scene);
        OWNED(br_study) s = br_test_study(&scene, &br_reference_fine, 2, n, 1, &steps);
        s.method = s.reference_method = br_test_method(NULL, "implicit", NULL);
        s.reference = (struct br_resolution){768, steps};
        MUST(br_study_run(&s, 1, 2, NULL, &err));
        CLOSE(log(s.cell[0].error[BR_PART_BENDING] / s.cell[1].error[BR_PART_BENDING]) /
                  log(4.0 / 3),
              rows[i].order, 0.1);
    }
}

/* ---- out of memory ---- */

static enum br_status attempt(const void *text, struct br_error *why)
{
    static const size_t n[] = {2, 3}, steps[] = {2, 3};
    OWNED(br_scene) scene;
    enum br_status status = br_scene_read_text("made.yaml", text, &scene, why);
    if (!status) {
        OWNED(br_study) s = study_of(&scene, n, steps);
        status = br_study_run(&s, 1, 1, NULL, why);
    }
    return status;
}

TEST(test_allocation)
{
    br_test_without_memory(attempt,
                           TOP AXIAL "  solution: x*(1 + t) [m]\n" BENDING
                                     "  solution: x^4*t [m]\n" CONTACT COULOMB,
                           60);
}

/* ---- where tip forces break ---- */

static const struct forced {
    const char *text;
    enum br_field_kind kind;
    size_t breaks;
    double at[3]; /* s: where the force bends or jumps */
} forced[] = {
    {TOP AXIAL "  solution: x*t^2 [m]\n" CONTACT, BR_AXIAL, 1, {0.22360679774997896}},
    {TOP AXIAL "  solution: x*sin(pi*t) [m]\n" CONTACT, BR_AXIAL, 2, {0.0159221332, 0.9840778668}},
    {TOP BENDING "  solution: x^4*(t^2 - t) [m]\n" TRESCA, BR_BENDING, 1, {0.5}},
    {TOP BENDING "  solution: x^4*(1 + (t - 0.4)^2*step(t - 0.4)) [m]\n"
                 "  stick_force: 3*cos(9*t) [N]\n" TRESCA,
     BR_BENDING,
     1,
     {0.4}},
    {TOP AXIAL "  solution: x*t [m]\n" BENDING "  solution: x^4*(t^3 - t) [m]\n" CONTACT COULOMB,
     BR_BENDING,
     2,
     {0.05, 0.57735026918962576}},
};

/* The places where a tip force bends or jumps are found, and no others. */
TEST(test_tip_breaks)
{
    for (size_t i = 0; i < sizeof forced / sizeof *forced; i++) {
        OWNED(br_scene) s = scene_of(forced[i].text);
        struct br_breaks breaks = {0};
        const struct br_function *f = &s.field[forced[i].kind].tip_force;
        MUST(br_breaks_add(f, BR_T, (struct br_box){{0, 2}, {0, 1}}, &breaks, &err));
        assert_int_equal(breaks.count, forced[i].breaks);
        for (size_t k = 0; k < breaks.count; k++)
            CLOSE(breaks.at[k].low, forced[i].at[k], 1e-8);
        br_breaks_free(&breaks);
    }
}
