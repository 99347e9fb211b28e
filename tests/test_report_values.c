/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What golden/ does not hold of reports: a check's JSON of version 1 is read as it was; numbers
 * that are round-off or zero there; and the digits of a run's answer. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study/foresee/prediction.h"
#include "study/paper/paper.h"
#include "study/run/run.h"
#include "study/trade/plan.h"
#include "study/trade/split.h"
#include "study/trade/trade.h"
#include "study/verify/comparison.h"
#include "tables/reports.h"
#include "tests/document_reader.h"

/* ---- check ---- */

static void read_text(const char *text, struct br_old_check *old)
{
    struct br_error err = {0};
    MUST(br_check_read_json(br_test_scene_file(text), old, &err));
}

static void is_read(const char *text)
{
    struct br_old_check old;
    read_text(text, &old);
    const struct br_old_case *c = old.cases;
    const struct br_old_method *m = &old.costs[0].method[BR_VERIFY_TIME];
    assert_int_equal(old.count, 1);
    assert_int_equal(old.scenes, 2);
    assert_string_equal(c->scene, "made");
    assert_string_equal(c->study, "time");
    assert_string_equal(c->norm, "l2");
    assert_string_equal(c->part, "axial");
    assert_int_equal(c->verdict, BR_FAIL);
    CLOSE(c->order, 2.25, 0);
    CLOSE(c->constant, 3.5, 0);
    CLOSE(c->expected, 2.75, 0);
    CLOSE(c->tolerance, 0.375, 0);
    CLOSE(c->floor, 0.75, 0);
    CLOSE(c->ceiling, 7.5, 0);
    CLOSE(old.costs[0].seconds, 4.25, 0);
    CLOSE(old.costs[0].element_steps, 5.25, 0);
    assert_string_equal(old.costs[1].scene, "refused");
    assert_true(m->known);
    assert_false(old.costs[0].method[BR_VERIFY_SPACE].known);
    assert_string_equal(m->value[BR_METHOD_SCHEME], "adaptive");
    assert_string_equal(m->value[BR_METHOD_SOLVER], "banded");
    assert_string_equal(m->value[BR_METHOD_TOLERANCE], "0.0625");
    br_old_check_clear(&old);
}

static void check_of_version_1_is_read(void **state)
{
    (void)state;
    is_read("{\"format\": \"beamrate check 1\", \"scenes\": [{\"scene\": \"made\", \"methods\": "
            "{\"time\": {\"scheme\": \"adaptive\", \"tolerance\": 0.0625, \"solver\": \"banded\", "
            "\"contact\": \"implicit\", \"friction\": \"exact\"}}, \"seconds\": 4.25, "
            "\"element_steps\": 5.25, \"cases\": [{\"study\": \"time\", \"norm\": \"l2\", "
            "\"part\": \"axial\", \"verdict\": \"FAIL\", \"order\": {\"value\": 2.25, \"low\": "
            "2.125, \"high\": 2.5}, \"expected\": 2.75, \"tolerance\": 0.375, \"margin\": 0.625, "
            "\"constant\": 3.5, \"floor\": 0.75, \"ceiling\": 7.5, \"reason\": \"\", \"note\": "
            "\"\", \"points\": []}]}, {\"scene\": \"refused\", \"methods\": {}, \"seconds\": 0, "
            "\"element_steps\": 0, \"cases\": []}]}");
}

/* ---- what golden/ takes for round-off, or where it has zeros alone ---- */

/* Two trials whose numbers are all different. */
static struct br_trade *made_trade(const struct br_scene *scene)
{
    struct br_error err = {0};
    struct br_trade *t = calloc(1, sizeof *t);
    assert_non_null(t);
    MUST(br_named_methods_read("--methods", "euler,adaptive", &t->methods, &err));
    t->request = br_trial_request_default(scene);
    t->request.norm = &br_norm_l2;
    t->count = 2;
    t->trial = calloc(2, sizeof *t->trial);
    t->front = calloc(2, sizeof *t->front);
    assert_true(t->trial && t->front);
    for (size_t i = 0; i < t->count; i++)
        t->trial[i] = (struct br_trial){
            .named = &t->methods.list[i],
            .at = {11 + i, 20 + i},
            .tolerance = i ? 0.0625 : 0,
            .printed = i == 0,
            .cost = {i ? 0.5 : 2.5,
                     i ? 0.75 : 3.75,
                     4,
                     {.steps = 5, .stages = 6, .rejected = 7, .set_ups = 8, .iterations = 9}},
            .error = {0.125, 0.25, 0.375},
            .scale = 1.5,
            .own = 0.0078125,
        };
    t->front[1] = true;
    t->wall_seconds = 10.5;
    for (size_t d = 0; d < BR_TRADE_DIGITS; d++) {
        t->best[d] = d == 1 || d == 3 ? 1 : 2;
        t->best_of[0][d] = t->best_of[1][d] = d == 3 ? 0 : 2;
    }
    return t;
}

/* A split whose part i has errors, floors and tips that are i + 1 times what the first has. */
static struct br_split made_split(struct br_scene *scene)
{
    struct br_split s = {
        .scene = scene,
        .method = br_test_method("umfpack", "implicit", "uzawa"),
        .unstable = true,
        .refined = {.name = "made finer"},
        .at = {12, 16},
        .norm = {&br_norm_l2},
        .norms = 1,
        .judge = &br_judge_exact,
        .whole = {.error = {{16, 32, 48}}, .floor = {{0.5, 0.625, 0.75}}, .tip = {17, 33}},
        .sum = {{64, 128, 192}},
        .tip_sum = {65, 129},
        .tip = {66, 130},
        .solution_tip = {67, 131},
        .scale = {4},
        .predicted_round_off = 0.03125,
    };
    s.method.scheme = br_time_scheme_find("adaptive");
    s.method.tolerance = 0.0009765625;
    s.method.linear.refinement = 3;
    s.method.iteration = (struct br_iteration){0.25, 0.0001220703125, 77};
    for (; br_sources[s.shares].name; s.shares++) {
        const double times = (double)(s.shares + 1);
        s.share[s.shares] = (struct br_share){
            .source = &br_sources[s.shares],
            .error = {{times, 2 * times, 3 * times}},
            .floor = {{0.125 * times, 0.25 * times, 0.375 * times}},
            .tip = {5 * times, -7 * times},
        };
    }
    return s;
}

static double seconds_of_plan(const struct br_trial *trial)
{
    return 2 * br_trial_seconds(trial);
}

/* Two trials and models of two methods; the second is not known. */
static struct br_plan *made_plan(const struct br_scene *scene)
{
    struct br_error err = {0};
    struct br_plan *p = calloc(1, sizeof *p);
    assert_non_null(p);
    br_plan_default(p, scene);
    MUST(br_named_methods_read("--methods", "euler,bdf2", &p->methods, &err));
    p->goal = (struct br_plan_goal){0.5, NAN};
    p->request.norm = &br_norm_l2;
    p->seconds = seconds_of_plan;
    p->count = 2;
    p->trial = calloc(2, sizeof *p->trial);
    p->forecast = calloc(2, sizeof *p->forecast);
    assert_true(p->trial && p->forecast);
    for (size_t i = 0; i < p->count; i++) {
        p->trial[i] = (struct br_trial){
            .named = &p->methods.list[0],
            .at = {11 + i, 20 + i},
            .cost = {2.5, 3.75, 4, {.steps = 5, .stages = 6, .set_ups = 8}},
            .error = {0.125, 0.25, 0.375},
            .scale = 1.5,
            .own = 0.25,
        };
        p->forecast[i] = (struct br_plan_forecast){i, 0.0625, 7.5};
    }
    p->first = 0;
    p->chosen = 1;
    p->rounds = 9;
    p->own = 0.0078125;
    p->wall_seconds = 10.5;
    struct br_plan_models *m = &p->model[0];
    m->known = true;
    m->error = (struct br_plan_model){.r = 0.75, .scatter = 0.875, .points = 13};
    m->error.space = m->error.time = (struct br_plan_curve){1, {1.25}, {-2.25}};
    m->error.time.value[0] = -3.25;
    m->cost =
        (struct br_plan_cost){.c = {1, 2, 3, 4}, .scatter = 0.9375, .solves = {1, {4.25}, {5.25}}};
    return p;
}

/* A bug in one of the keys that the outputs in golden/ do not tell from others. */
static void small_numbers_are_printed(void **state)
{
    (void)state;
    struct br_scene scene = br_test_bare();
    scene.name = (char[]){"made"};
    struct br_trade *trade = made_trade(&scene);
    const struct br_split split = made_split(&scene);
    struct br_plan *plan = made_plan(&scene);
    struct br_document d = {.name = NULL};
    br_report_trade(trade, &br_made_provenance, &d);
    json_t *root = read_back(&d);
    const struct expected trial[] = {{"own_error", 0.0078125},
                                     {"rejected", 7},
                                     {"set_ups", 8},
                                     {"iterations", 9},
                                     {"tolerance", NAN}};
    NUMBERS(root, "tables.trials.0", trial);
    const struct expected adaptive[] = {{"k", NAN}, {"tolerance", 0.0625}};
    NUMBERS(root, "tables.trials.1", adaptive);
    json_decref(root);
    br_report_split(&split, 1, &br_made_provenance, &d);
    root = read_back(&d);
    const struct expected run[] = {{"predicted_round_off", 0.03125}, {"unstable", 1}};
    NUMBERS(root, "tables.runs.0", run);
    json_decref(root);
    br_report_plan(plan, "made", &br_made_provenance, &d);
    root = read_back(&d);
    const struct expected numbers[] = {{"own_error", 0.0078125},
                                       {"tables.trials.1.set_ups", 8},
                                       {"tables.models.0.seconds_set_up", 1},
                                       {"tables.models.0.seconds_element", 2},
                                       {"tables.models.0.seconds_solve", 3},
                                       {"tables.models.0.seconds_element_solve", 4}};
    NUMBERS(root, "", numbers);
    json_decref(root);
    free(trade->trial);
    free(trade->front);
    free(trade);
    free(plan->trial);
    free(plan->forecast);
    free(plan);
}

/* ---- run ---- */

enum { ELEMENTS = 4, STEPS = 8 };

static const struct br_prediction made_prediction = {
    .known = true,
    .bounded = true,
    .field = {{0.125, 0.0625, 0.25, 1}, {0.375, 0.1875, 0.75, 1}},
    .size = {0.5, 0.75},
    .space = {1.125, 1.0625, 1.25, 1},
    .time = {2.125, 2.0625, 2.25, 1},
    .whole = {3.125, 3.0625, 3.25, 1},
    .round_off = 0.03125,
    .seconds = 4.5,
};

static struct br_run_report report; /* of a march of example2 */
static struct br_scene example;

static int march(void **state)
{
    (void)state;
    struct br_error err = {0};
    example = br_test_bundled("example2");
    const struct br_run_request request = {.scene = &example,
                                           .wanted = 3,
                                           .method = br_test_method(NULL, NULL, NULL),
                                           .n = ELEMENTS,
                                           .steps = STEPS,
                                           .check = true,
                                           .energies = true,
                                           .explain = true};
    const enum br_status status = br_run(&request, &report, &err);
    report.counts.rejected = 3; /* no step of fixed length is */
    return status != BR_OK;
}

static int end(void **state)
{
    (void)state;
    br_scene_clear(&example);
    return 0;
}

static void report_run(const struct br_prediction *p, const struct br_warnings *w,
                       struct br_document *d)
{
    br_report_run(&(struct br_run_findings){&report, p, w, &br_made_provenance, 12.5}, d);
}

static void certificate_is_printed(void **state)
{
    (void)state;
    struct br_document d = {0};
    const struct br_warnings none = {0};
    const struct br_run_report *r = &report;
    report_run(&made_prediction, &none, &d);
    json_t *root = read_back(&d);
    const struct expected numbers[] = {
        {"prediction.round_off", 0.03125},
        {"energies.imbalance", br_energy_imbalance(&r->energy_start, &r->energy_now, &r->work)},
        {"energies.largest_imbalance_of_a_step", r->energy_worst},
        {"certificate.worst.axial", r->worst.axial_residual},
        {"certificate.worst.bending", r->worst.bending_residual},
        {"certificate.worst.update", r->worst.update},
        {"certificate.worst.contact", r->worst.contact},
        {"certificate.worst.friction", r->worst.friction},
        {"certificate.worst.energy", r->energy_worst},
        {"certificate.limits.axial", r->limits.axial_residual},
        {"certificate.limits.bending", r->limits.bending_residual},
        {"certificate.limits.update", r->limits.update},
        {"certificate.limits.contact", r->limits.contact},
        {"certificate.limits.friction", r->limits.friction},
        {"certificate.limits.energy", r->energy_limit},
        {"certificate.bad_steps", 0},
        {"work.steps_taken_back", 3},
        {"seconds.wall", 12.5},
    };
    NUMBERS(root, "", numbers);
    json_decref(root);
}

/* People get the digits that the predicted error leaves, or the reason why it is not known. */
static void answer_comes_first(void **state)
{
    (void)state;
    struct br_document d = {0};
    struct br_prediction p = made_prediction;
    const struct br_warnings none = {0};
    struct br_history_row *last = &report.end.last, kept = *last;
    last->displacement[BR_AXIAL] = -0.2216123;
    last->displacement[BR_BENDING] = 3.4567e-9;
    p.round_off = 0;
    /* rms errors of 0.0081 and 1.5e-11 m */
    p.field[BR_AXIAL].high = 0.0162 * sqrt(example.length);
    p.field[BR_BENDING].high = 2e-11 * sqrt(example.length);
    report_run(&p, &none, &d);
    char *text = printed(&d, &br_document_text);
    br_document_clear(&d);
    assert_non_null(
        strstr(text, "\nTip at t = 1 s: u = -0.222 +- 0.014 m, w = 3.457e-09 +- 3.4e-11"));
    assert_non_null(strstr(text, "\naxial displacement u: -0.222 +- 0.014 m\n"));
    free(text);
    p.known = p.bounded = false;
    strcpy(p.why, "it is so");
    report.failure = (struct br_error){BR_NOT_FINITE, "it blew up"};
    report_run(&p, &none, &d);
    text = printed(&d, &br_document_text);
    br_document_clear(&d);
    assert_non_null(strstr(text, "\nSTOPPED: it blew up\nTip at t = 1 s (the last good step): "
                                 "u = -0.221612 m, w = 3.4567e-09 m, "));
    assert_non_null(strstr(text, "\nThe discretisation error is not known: it is so; "));
    free(text);
    report.failure.status = BR_OK;
    *last = kept;
}

/* ---- claims ---- */

static void claims_are_printed(void **state)
{
    (void)state;
    struct br_document d = {0};
    struct br_finding finding[BR_MOST_CLAIMS] = {
        {.value = 0.75, .exact = 0.5, .error = 0.25, .printed = 0.625, .agreement = BR_DIFFERS},
        {.agreement = BR_UNDECIDED},
    };
    size_t claims = 0;
    while (br_claims[claims].name)
        claims++;
    br_report_claims(finding, 1000, 500, &d);
    json_t *root = read_back(&d);
    char expected[100];
    snprintf(expected, sizeof expected, "The paper's claims: %zu agree, 1 differ, 1 undecided.",
             claims - 2);
    answers(root, expected);
    NUMBERS(root, "tables.claims.0",
            ((struct expected[]){
                {"value", 0.75}, {"exact", 0.5}, {"error", 0.25}, {"printed", 0.625}}));
    TEXTS(root, "tables.claims.0", "claim", br_claims[0].name, "agreement", "differ");
    json_decref(root);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(check_of_version_1_is_read), cmocka_unit_test(small_numbers_are_printed),
        cmocka_unit_test(certificate_is_printed),     cmocka_unit_test(answer_comes_first),
        cmocka_unit_test(claims_are_printed),
    };
    return cmocka_run_group_tests_name("report_values", tests, march, end);
}
