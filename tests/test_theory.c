/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The orders that theory states (study/fit/theory.h) against measured ones: of random scenes and
 * methods, in all norms, of each component. No stated order may be contradicted, and enough must be
 * stated and confirmed. BR_TEST_SHOW prints each. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/words.h"
#include "study/fit/theory.h"
#include "study/grid/sweep.h"
#include "study/scene/file.h"
#include "study/scene/method_fields.h"
#include "study/verify/check.h"
#include "support.h"

enum { SCENES = 200, SAMPLE = 10, CELLS = 6 };

#define PICK(r, list) list[br_test_index(r, sizeof list / sizeof *list)]
static bool chance(struct br_test_random *r, double p)
{
    return br_test_uniform(r, 0, 1) < p;
}

static const char *const shapes[] = {
    "1",
    "x",
    "sin(3*x)",
    "exp(-x)",
    "(1 - x^2)",
    "step(x - 0.37)",
    "abs(x - 0.37)",
    "step(x - 0.5)",
    "sqrt(x)",
};
static const char *const histories[] = {
    "sin(3*t)",      "t",          "(exp(t) - 1)",    "1",
    "cos(2*t)",      "sin(9*t)^2", "step(t - 0.373)", "min(t, 0.373)",
    "step(t - 0.5)",
};
static const char *const moving[] = {"exp(-((x - t)/0.3)^2)", "step(0.77*t - x)", "sin(3*x - 2*t)"};

/* "12*x*sin(3*t)": smooth more often than not. */
static void draw_load(struct br_test_random *r, double size, char text[200])
{
    const bool rough = chance(r, 0.25);
    if (chance(r, 0.1))
        snprintf(text, 200, "%.6g*%s", size, PICK(r, moving));
    else {
        const char *history = histories[br_test_index(r, rough ? 9 : 6)];
        snprintf(text, 200, "%.6g*%s*%s", size, shapes[br_test_index(r, rough ? 9 : 5)], history);
    }
}

/* A scene as a file; L = 1 m, T = 1 s. */
static void draw_scene(struct br_test_random *r, char *text, size_t size)
{
    char load[200];
    const bool rod = chance(r, 0.85), beam = !rod || chance(r, 0.8),
               contact = rod && chance(r, 0.7);
    const double density = chance(r, 0.12) ? 0 : br_test_log_uniform(r, 1e-4, 3);
    const double relax = br_test_log_uniform(r, 3e-3, 0.3), way = br_test_log_uniform(r, 0.01, 0.1);
    *text = '\0';
    br_append(text, size, "title: Drawn\nlength: 1 m\nduration: 1 s\ndensity: %.6g kg/m\n",
              density);
    const double a1 = br_test_log_uniform(r, 10, 1e4), a2 = br_test_log_uniform(r, 1, 1e3);
    if (rod) {
        draw_load(r, 2 * way * a1, load);
        br_append(text, size,
                  "axial:\n  stiffness: %.6g N\n  viscosity: %.6g N s\n  load: %s [N/m]\n", a1,
                  a1 * relax, load);
        if (chance(r, 0.15))
            br_append(text, size, "  tip_force: %.6g*sin(4*t) [N]\n", way * a1);
        if (chance(r, 0.15))
            br_append(text, size, "  displacement: %.6g*%s [m]\n", way,
                      chance(r, 0.7) ? "x*(2 - x)" : "min(x, 0.37)");
        if (density > 0 && chance(r, 0.15))
            br_append(text, size, "  velocity: %.6g*%s [m/s]\n", way,
                      chance(r, 0.7) ? "sin(2*x)" : "x*step(0.37 - x)");
    }
    const double force = a2 * br_test_log_uniform(r, 0.1, 1);
    if (beam) {
        draw_load(r, chance(r, 0.5) ? force : -force, load);
        br_append(
            text, size,
            "bending:\n  stiffness: %.6g N m^2\n  viscosity: %.6g N m^2 s\n  load: %s [N/m]\n", a2,
            a2 * relax, load);
        if (chance(r, 0.15))
            br_append(text, size, "  tip_force: %.6g*sin(4*t) [N]\n", force / 4);
        if (chance(r, 0.15))
            br_append(text, size, "  tip_moment: %.6g*t [N m]\n", force / 4);
        if (density > 0 && chance(r, 0.15))
            br_append(text, size, "  velocity: %.6g*x^2 [m/s]\n  velocity_slope: 2*%.6g*x [1/s]\n",
                      way, way);
    }
    if (contact) { /* one draw after the other: the same scenes from every compiler */
        const double stiffness = a1 * br_test_log_uniform(r, 0.1, 10);
        const double gap = chance(r, 0.4) ? 0 : way * br_test_uniform(r, 0.1, 0.6);
        br_append(text, size, "contact:\n  gap: %.6g m\n  stiffness: %.6g N/m\n", gap, stiffness);
    }
    const double share = br_test_log_uniform(r, 0.03, 1);
    if (beam && chance(r, 0.75)) {
        if (contact && chance(r, 0.7))
            br_append(text, size, "friction:\n  law: coulomb\n  coefficient: %.6g N/m\n",
                      share * force / way);
        else
            br_append(text, size, "friction:\n  law: tresca\n  bound: %.6g N\n", share * force);
        br_append(text, size, "  regularisation: 1e-3 m/s\n");
    }
}

static struct br_method draw_method(struct br_test_random *r, const struct br_scene *scene)
{
    struct br_method m = br_method_default();
    size_t schemes = 0;
    while (br_time_schemes[schemes])
        schemes++;
    if (chance(r, 0.5))
        m.scheme = br_time_schemes[br_test_index(r, schemes)];
    m.contact = br_contact_rule_of(m.scheme);
    if (chance(r, 0.3))
        m.contact = br_contact_rule_find("implicit");
    if (chance(r, 0.15))
        m.friction = br_friction_rule_find("regularised");
    if (scene->axial.modelled && chance(r, 0.3))
        m.axial_degree = 2;
    return m;
}

struct tally {
    size_t of[BR_INCONCLUSIVE + 1], silent, still;
};

/* Whether the errors are round-off: a tip that always sticks has no other ones. Displacements are
 * about 0.01 m to 0.1 m. */
static bool is_round_off(const struct br_case *c)
{
    double most = 0;
    for (size_t i = 0; i < c->points; i++)
        most = fmax(most, c->point[i].error);
    return most <= 1e-14;
}

/* Sets what theory states of one study in all norms, of each component. */
static void expect(const struct br_scene *scene, enum br_verify_kind kind,
                   struct br_verify_study *v)
{
    for (const struct br_norm *const *norm = br_norms; *norm; norm++)
        for (enum br_part part = BR_PART_AXIAL; part <= BR_PART_BENDING; part++) {
            const struct br_study study = {
                .scene = scene, .norm = *norm, .method = v->method, .n = v->n, .steps = v->steps};
            if (!(part == BR_PART_AXIAL ? scene->axial.modelled : scene->bending.modelled))
                continue;
            const struct br_theory t =
                br_theory_of(&study, part, kind == BR_VERIFY_SPACE ? BR_AXIS_SPACE : BR_AXIS_TIME);
            struct br_verify_expectation *e = &v->expectation[v->expectations++];
            *e = (struct br_verify_expectation){.norm = *norm,
                                                .part = part,
                                                .band = {
                                                    .order = t.order,
                                                    .highest = t.highest > t.order ? t.highest : 0,
                                                    .tolerance = t.order / 10,
                                                    .floor = NAN,
                                                    .ceiling = NAN,
                                                }};
            snprintf(e->band.why, sizeof e->band.why, "%s", t.reason);
        }
}

static void measure(struct br_test_random *r, size_t number, struct tally tally[BR_VERIFY_KINDS])
{
    static size_t n[BR_VERIFY_KINDS][CELLS], steps[BR_VERIFY_KINDS][CELLS];
    OWNED(br_scene) scene;
    struct br_verify verify = {0};
    char text[4000], name[64];
    draw_scene(r, text, sizeof text);
    MUST(br_scene_parse("drawn.yaml", text, &(struct br_scene_asked){0}, &scene, &err));
    const struct br_method method = draw_method(r, &scene);
    for (int kind = BR_VERIFY_SPACE; kind <= BR_VERIFY_TIME; kind++) {
        struct br_verify_study *v = &verify.study[kind];
        for (size_t i = 0; i < CELLS; i++) {
            n[kind][i] = kind == BR_VERIFY_SPACE ? (size_t)10 << i : 10;
            steps[kind][i] = kind == BR_VERIFY_SPACE ? 100 : (size_t)1000 << i;
        }
        v->n = n[kind];
        v->steps = steps[kind];
        v->count = CELLS;
        v->method = method;
        expect(&scene, (enum br_verify_kind)kind, v);
    }
    snprintf(name, sizeof name, "%zu", number);
    OWNED(br_check) check = {.path = "drawn.yaml", .name = name};
    MUST(br_check_run(&(struct br_scene_check){.scene = &scene, .verify = &verify, .check = &check},
                      1, 0, NULL, &err));
    if (check.failure.status)
        print_message("# %zu: %s\n", number, check.failure.message);
    for (const struct br_case *c = check.cases; c < check.cases + check.count; c++) {
        const bool stated = !isnan(c->expected.order);
        char order[64];
        if (stated && is_round_off(c))
            tally[c->kind].still++;
        else if (stated)
            tally[c->kind].of[c->verdict]++;
        else
            tally[c->kind].silent++;
        if (stated && c->verdict == BR_FAIL && !is_round_off(c))
            print_message("# %zu %s %s %s: %g is stated, but %s\n%s", number,
                          br_verify_names[c->kind], c->measure, c->part, c->expected.order,
                          c->reason, text);
        if (getenv("BR_TEST_SHOW"))
            print_message("# %zu %s deg %d %s %s %s: %g to %g, %s, %s [%s] %s\n", number,
                          method.scheme->name, method.axial_degree, br_verify_names[c->kind],
                          c->measure, c->part, c->expected.order, c->expected.highest,
                          br_order_text(&c->order, order, sizeof order),
                          stated ? br_verdict_names[c->verdict] : "silent", c->expected.why,
                          c->verdict == BR_PASS ? "" : c->reason);
    }
    if (getenv("BR_TEST_SHOW"))
        print_message("# %zu scene:\n%s", number, text);
}

TEST(test_random)
{
    struct br_test_random r = {20261123};
    struct tally tally[BR_VERIFY_KINDS] = {0};
    for (size_t i = 0; i < (br_test_long() ? SCENES : SAMPLE); i++)
        measure(&r, i, tally);
    for (int kind = BR_VERIFY_SPACE; kind <= BR_VERIFY_TIME; kind++) {
        const struct tally *t = &tally[kind];
        const size_t stated = t->of[BR_PASS] + t->of[BR_FAIL] + t->of[BR_INCONCLUSIVE];
        print_message("# %s: %zu PASS, %zu FAIL, %zu INCONCLUSIVE, %zu round-off, %zu not stated\n",
                      br_verify_names[kind], t->of[BR_PASS], t->of[BR_FAIL], t->of[BR_INCONCLUSIVE],
                      t->still, t->silent);
        assert_int_equal(t->of[BR_FAIL], 0);
        assert_true(4 * t->of[BR_PASS] >= 3 * stated);
        assert_true(3 * stated >= t->silent);
    }
}

/* ---- each place where a force may start suddenly ---- */

/* The order in k of sdirk2 on 4 elements, against a fine run on these. */
static double rate_in_k(const struct br_scene *scene, struct br_theory *theory)
{
    static const size_t n[] = {4}, steps[] = {80, 160};
    OWNED(br_study) s = br_test_study(scene, &br_reference_fine, 1, n, 2, steps);
    s.norm = &br_norm_energy; /* of velocities, where the start is seen */
    s.method = br_test_method(NULL, "implicit", NULL);
    s.method.scheme = br_time_scheme_find("sdirk2");
    s.reference_method = s.method;
    s.reference = (struct br_resolution){4, 5120};
    *theory = br_theory_of(&s, BR_PART_TOTAL, BR_AXIS_TIME);
    MUST(br_study_run(&s, 1, 1, NULL, &err));
    const double rate = log2(s.cell[0].error[0] / s.cell[1].error[0]);
    return rate;
}

/* A load may break between the elements of the coarsest mesh, not inside one. */
TEST(test_breaks_between_elements)
{
    static const size_t n[] = {4, 8}, steps[] = {10};
    static const char *const loads[] = {"step(x - 0.25)", "step(x - 0.3)"};
    for (int inside = 0; inside < 2; inside++) {
        OWNED(br_scene) scene = br_test_bare();
        scene.bending.modelled = false;
        scene.axial.load = br_test_load(loads[inside]);
        OWNED(br_study) s = br_test_study(&scene, &br_reference_fine, 2, n, 1, steps);
        const struct br_theory t = br_theory_of(&s, BR_PART_TOTAL, BR_AXIS_SPACE);
        assert_true(inside ? isnan(t.order) : t.order == 2);
    }
}

/* A force that starts gently keeps the order 2 of velocities; one that starts suddenly, or with a
 * rate, or has a kink later, may cost it, wherever it is, and theory states none. */
TEST(test_sudden_forces)
{
    static const char *const start[] = {"sin(3*t)^2", "cos(t)", "sin(3*t)", "max(t - 0.371, 0)"};
    enum { STARTS = sizeof start / sizeof *start, SUDDEN = 1, BY_RATE = 2, KINK = 3 };
    static const char scene_of[] = "title: T\nlength: 1 m\nduration: 1 s\ndensity: 1 kg/m\n"
                                   "%s:\n  stiffness: 30 %s\n  viscosity: 0.3 %s\n  %s: %s [%s]\n";
    static const struct {
        const char *field, *stiffness, *viscosity, *key, *unit;
    } rows[] = {
        {"axial", "N", "N s", "load", "N/m"},
        {"axial", "N", "N s", "tip_force", "N"},
        {"bending", "N m^2", "N m^2 s", "load", "N/m"},
        {"bending", "N m^2", "N m^2 s", "tip_force", "N"},
        {"bending", "N m^2", "N m^2 s", "tip_moment", "N m"},
    };
    for (size_t i = 0; i < STARTS * (sizeof rows / sizeof *rows); i++) {
        const size_t how = i % STARTS, row = i / STARTS;
        OWNED(br_scene) scene;
        struct br_theory theory;
        char text[500];
        snprintf(text, sizeof text, scene_of, rows[row].field, rows[row].stiffness,
                 rows[row].viscosity, rows[row].key, start[how], rows[row].unit);
        MUST(br_scene_parse("force.yaml", text, &(struct br_scene_asked){0}, &scene, &err));
        const double rate = rate_in_k(&scene, &theory);
        if (how) {
            assert_true(isnan(theory.order));
            assert_non_null(strstr(theory.reason, how == KINK ? "forces are not smooth in time"
                                                              : "forces start suddenly"));
            /* the beam's mesh has the faster modes, which show it */
            assert_true(how != SUDDEN || row < 2 || rate < 1.8);
        } else
            assert_true(theory.order == 2 && fabs(rate - 2) < 0.1);
    }
}
