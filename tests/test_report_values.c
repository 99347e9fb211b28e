/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reports of check and run: every number stands under its own key, in JSON, JUnit and TAP, and
 * a check's JSON is read again as it was. The structs hold another number in every place, so that
 * two that are exchanged are seen. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "study/foresee/prediction.h"
#include "study/run/run.h"
#include "study/verify/comparison.h"
#include "tables/reports.h"
#include "tests/document_reader.h"

/* ---- check ---- */

static const struct expected case_numbers[] = {
    {"order", 2.25},   {"low", 2.125},    {"high", 2.5},   {"expected", 2.75}, {"tolerance", 0.375},
    {"margin", 0.625}, {"constant", 3.5}, {"floor", 0.75}, {"ceiling", 7.5},   {"line", 26}};
enum { CASE_NUMBERS = sizeof case_numbers / sizeof *case_numbers };

/* One scene with one order that fails, and one that cannot be verified. */
struct made {
    struct br_scene scene[2];
    struct br_verify verify;
    struct br_point point[2];
    struct br_case c;
    struct br_check check[2];
    struct br_difference difference;
    struct br_comparison comparison;
};

static void make(struct made *m, struct br_document *d)
{
    *m = (struct made){
        .scene = {br_test_bare(), br_test_bare()},
        .point =
            {{.at = {21, 22}, .against = {23, 24}, .error = 1.5, .constant = 1.75, .used = true},
             {.at = {31, 32},
              .error = 11.5,
              .constant = NAN,
              .flag = BR_FLAG_FAILED,
              .failure = "blew up"}},
        .c = {.kind = BR_VERIFY_TIME,
              .expected = {&br_norm_l2, BR_PART_AXIAL, 2.75, 0.375, 0.75, 7.5, 26},
              .points = 2,
              .used = 1,
              .order = {2.25, 2.125, 2.5},
              .constant = 3.5,
              .margin = 0.625,
              .verdict = BR_FAIL,
              .reason = "too low; more steps"},
        .difference = {"made: order", 41.5, 42.5, BR_SERIOUS, "moved"},
        .comparison = {.count = 1, .tally = {51, 52, 53, 54}},
    };
    m->scene[0].name = (char[]){"made"};
    m->scene[1].name = (char[]){"refused"};
    m->c.point = m->point;
    m->comparison.difference = &m->difference;
    m->verify.study[BR_VERIFY_TIME].count = 1;
    m->verify.study[BR_VERIFY_TIME].method = br_test_method("banded", "implicit", NULL);
    m->verify.study[BR_VERIFY_TIME].method.scheme = br_time_scheme_find("adaptive");
    m->verify.study[BR_VERIFY_TIME].method.tolerance = 0.0625;
    m->check[0] =
        (struct br_check){"made.yaml", &m->scene[0], &m->verify, {0}, &m->c, 1, 4.25, 5.25};
    m->check[1] = (struct br_check){.path = "refused.yaml",
                                    .scene = &m->scene[1],
                                    .verify = &m->verify,
                                    .failure = {BR_BAD_INPUT, "refused.yaml:7: no"},
                                    .seconds = 0.5};
    br_report_check(&(struct br_check_findings){.checks = m->check,
                                                .count = 2,
                                                .wall_seconds = 8.5,
                                                .comparison = &m->comparison,
                                                .provenance = &br_made_provenance},
                    d);
}

static void check_is_in_json(void **state)
{
    (void)state;
    struct made m;
    struct br_document d = {0};
    make(&m, &d);
    json_t *root = read_back(&d);
    numbers_are(root, "tables.orders.0", case_numbers, CASE_NUMBERS - 1);
    const struct expected rest[] = {
        {"verdicts.0.line", 26},
        {"verdicts.0.seconds", 4.25},
        {"verdicts.1.seconds", 0.5},
        {"tables.points.0.n", 21},
        {"tables.points.0.steps", 22},
        {"tables.points.0.against_n", 23},
        {"tables.points.0.against_steps", 24},
        {"tables.points.0.error", 1.5},
        {"tables.points.0.constant", 1.75},
        {"tables.points.1.n", 31},
        {"tables.points.1.error", 11.5},
        {"tables.scenes.0.seconds", 4.25},
        {"tables.scenes.0.element_steps", 5.25},
        {"tables.differences.0.before", 41.5},
        {"tables.differences.0.now", 42.5},
        {"tables.points.0.used", 1},
        {"tables.points.1.used", 0},
        {"tally.FAIL", 1},
        {"tally.PASS", 0},
        {"wall_seconds", 8.5},
        {"methods.0.time.tolerance", 0.0625},
    };
    NUMBERS(root, "", rest);
    TEXTS(root, "", "tables.orders.0.scene", "made", "tables.orders.0.study", "time",
          "tables.orders.0.norm", "l2", "tables.orders.0.part", "axial", "tables.orders.0.verdict",
          "FAIL", "tables.points.0.flag", "", "tables.points.1.failure", "blew up",
          "tables.scenes.0.path", "made.yaml", "tables.scenes.1.failure", "refused.yaml:7: no",
          "tables.differences.0.severity", "serious", "tables.differences.0.subject", "made: order",
          "tables.differences.0.remark", "moved", "verdicts.0.file", "made.yaml",
          "verdicts.0.message", "too low; more steps", "verdicts.1.verdict", "ERROR",
          "methods.0.time.scheme", "adaptive", "answer.0",
          "1 order in 2 scenes: 0 PASS, 1 FAIL, 0 INCONCLUSIVE, 1 cannot be verified; "
          "8.5 s",
          "answer.1", "refused cannot be verified: refused.yaml:7: no", "answer.2",
          "FAIL, made, time l2 axial (made.yaml:26): too low; more steps", "answer.3",
          "Against the earlier check: 54 serious, 53 warnings, 52 notes, 51 the same");
    json_decref(root);
}

/* The number behind the first "  key: ". */
static double number_behind(const char *text, const char *key)
{
    char wanted[64];
    snprintf(wanted, sizeof wanted, "\n  %s: ", key);
    const char *at = strstr(text, wanted);
    if (!at)
        fail_msg("'%s' is not in:\n%s", wanted, text);
    return strtod(at + strlen(wanted), NULL);
}

static char *check_printed(const struct br_document_format *format)
{
    struct made m;
    struct br_document d = {0};
    make(&m, &d);
    char *text = printed(&d, format);
    br_document_clear(&d);
    for (size_t i = 0; i < CASE_NUMBERS; i++)
        CLOSE(number_behind(text, case_numbers[i].key), case_numbers[i].value, 0);
    return text;
}

static void check_is_in_junit(void **state)
{
    (void)state;
    static const char *const parts[] = {
        "<testsuites name=\"beamrate check\" tests=\"2\" failures=\"1\" errors=\"1\" "
        "time=\"4.750000\">",
        "<testsuite name=\"made\" tests=\"1\" failures=\"1\" errors=\"0\" time=\"4.250000\" "
        "skipped=\"0\" timestamp=\"2026-01-02T03:04:05\">",
        "<testcase classname=\"beamrate.made\" name=\"time l2 axial\" time=\"4.250000\">",
        "<failure type=\"FAIL\" message=\"too low; more steps\">",
        "n = 21, k = T/22 against n = 23, k = T/24: error 1.5000e+00, constant 1.7500e+00\n",
        "<error type=\"ERROR\" message=\"refused.yaml:7: no\">",
    };
    char *text = check_printed(&br_document_junit);
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        if (!strstr(text, parts[i]))
            fail_msg("no %s in:\n%s", parts[i], text);
    assert_null(strstr(text, "<propert"));
    free(text);
}

/* Where there is xmllint. */
static void junit_is_xml(void **state)
{
    (void)state;
    if (system("command -v xmllint > /dev/null") != 0)
        skip();
    char *text = check_printed(&br_document_junit);
    FILE *lint = popen("xmllint --noout -", "w");
    assert_non_null(lint);
    fputs(text, lint);
    assert_int_equal(pclose(lint), 0);
    free(text);
}

static void check_is_in_tap(void **state)
{
    (void)state;
    char *text = check_printed(&br_document_tap);
    assert_ptr_equal(strstr(text,
                            "TAP version 14\n1..2\nnot ok 1 - made, time l2 axial: FAIL\n  ---\n"
                            "  message: \"too low; more steps\"\n  file: \"made.yaml\"\n"),
                     text);
    assert_non_null(strstr(text, "\n  ...\nnot ok 2 - refused, verify: ERROR\n  ---\n"
                                 "  message: \"refused.yaml:7: no\"\n"));
    assert_non_null(strstr(text, "\n  details:\n    - \"n = 21, k = T/22 against n = 23, "));
    assert_non_null(strstr(text, "left out: "));
    assert_null(strstr(text, "seconds"));
    free(text);
}

static void read_text(const char *text, struct br_old_check *old)
{
    char path[] = "/tmp/br_check_XXXXXX";
    struct br_error err = {0};
    const int file = mkstemp(path);
    assert_true(file >= 0);
    assert_int_equal(write(file, text, strlen(text)), (ssize_t)strlen(text));
    close(file);
    const enum br_status status = br_check_read_json(path, old, &err);
    unlink(path);
    if (status)
        fail_msg("%s", err.message);
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

static void check_is_read_again(void **state)
{
    (void)state;
    struct made m;
    struct br_document d = {0};
    make(&m, &d);
    char *text = printed(&d, &br_document_json);
    br_document_clear(&d);
    is_read(text);
    free(text);
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
    return br_run(&request, &report, &err) != BR_OK;
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

static void run_is_in_json(void **state)
{
    (void)state;
    struct br_document d = {0};
    struct br_warnings warnings = {0};
    br_warn(&warnings, BR_WARN_LONG, "less", "days");
    report_run(&made_prediction, &warnings, &d);
    json_t *root = read_back(&d);
    const struct br_run_report *r = &report;
    const struct br_prediction *p = &made_prediction;
    const struct br_history_row *last = &r->end.last;
    const struct br_work *w = &r->work;
    const struct expected numbers[] = {
        {"n", ELEMENTS},
        {"steps", STEPS},
        {"h", r->h},
        {"k", 1.0 / STEPS},
        {"scene.length", example.length},
        {"scene.duration", example.duration},
        {"prediction.discretisation.error", 3.125},
        {"prediction.discretisation.low", 3.0625},
        {"prediction.discretisation.high", 3.25},
        {"prediction.axial.error", 0.125},
        {"prediction.axial.low", 0.0625},
        {"prediction.axial.high", 0.25},
        {"prediction.axial.most", br_predicted_most(p, BR_AXIAL)},
        {"prediction.bending.error", 0.375},
        {"prediction.bending.low", 0.1875},
        {"prediction.bending.high", 0.75},
        {"prediction.bending.most", br_predicted_most(p, BR_BENDING)},
        {"prediction.time.error", 2.125},
        {"prediction.time.low", 2.0625},
        {"prediction.time.high", 2.25},
        {"prediction.space.error", 1.125},
        {"prediction.space.low", 1.0625},
        {"prediction.space.high", 1.25},
        {"prediction.round_off", 0.03125},
        {"prediction.seconds", 4.5},
        {"tip.t", 1},
        {"tip.step", STEPS},
        {"tip.displacement.axial", last->displacement[BR_AXIAL]},
        {"tip.displacement.bending", last->displacement[BR_BENDING]},
        {"tip.predicted_error.axial", br_predicted_tip(p, BR_AXIAL, example.length)},
        {"tip.predicted_error.bending", br_predicted_tip(p, BR_BENDING, example.length)},
        {"tip.velocity.axial", last->velocity[BR_AXIAL]},
        {"tip.velocity.bending", last->velocity[BR_BENDING]},
        {"tip.contact_force", last->contact_force},
        {"tip.friction_force", last->friction_force},
        {"tip.friction_bound", last->friction_bound},
        {"tip.friction_share", 100 * fabs(last->friction_force) / last->friction_bound},
        {"events.resolution", r->k},
        {"events.largest_contact_force.value", r->watch.contact_force.value},
        {"events.largest_contact_force.t", r->watch.contact_force.time},
        {"events.largest_friction_force.value", r->watch.friction_force.value},
        {"events.largest_friction_force.t", r->watch.friction_force.time},
        {"events.counts.closed", (double)r->watch.count[BR_TIP_CLOSED]},
        {"events.counts.opened", (double)r->watch.count[BR_TIP_OPENED]},
        {"events.counts.slipped", (double)r->watch.count[BR_TIP_SLIPPED]},
        {"events.steps.slip", (double)r->watch.regime_steps[BR_TIP_SLIP]},
        {"events.steps.stick", (double)r->watch.regime_steps[BR_TIP_STICK]},
        {"events.steps.free", (double)r->watch.regime_steps[BR_TIP_FREE]},
        {"events.steps.closed", (double)r->watch.closed_steps},
        {"tables.events.0.t", r->watch.event[0].time},
        {"tables.events.0.step", (double)r->watch.event[0].step},
        {"energies.start.total", br_energy_total(&r->energy_start)},
        {"energies.end.kinetic.axial", r->energy_now.kinetic[BR_AXIAL]},
        {"energies.end.kinetic.bending", r->energy_now.kinetic[BR_BENDING]},
        {"energies.end.stored.axial", r->energy_now.stored[BR_AXIAL]},
        {"energies.end.stored.bending", r->energy_now.stored[BR_BENDING]},
        {"energies.end.contact", r->energy_now.contact},
        {"energies.end.total", br_energy_total(&r->energy_now)},
        {"energies.work_of_loads.axial", w->loads[BR_AXIAL]},
        {"energies.work_of_loads.bending", w->loads[BR_BENDING]},
        {"energies.lost_to_viscosity.axial", w->viscous[BR_AXIAL]},
        {"energies.lost_to_viscosity.bending", w->viscous[BR_BENDING]},
        {"energies.lost_to_friction", w->friction},
        {"energies.lost_to_scheme.axial", w->scheme[BR_AXIAL]},
        {"energies.lost_to_scheme.bending", w->scheme[BR_BENDING]},
        {"energies.lost_to_scheme_by_contact", w->scheme_contact},
        {"energies.imbalance", br_energy_imbalance(&r->energy_start, &r->energy_now, w)},
        {"energies.largest_imbalance_of_a_step", r->energy_worst},
        {"energies.added_by_scheme.in_all.axial", br_energy_added(w, BR_AXIAL)},
        {"energies.added_by_scheme.put_in.bending",
         br_energy_put_in(&r->energy_start, w, BR_BENDING)},
        {"energies.added_by_scheme.steps_that_add.axial", (double)w->gaining[BR_AXIAL]},
        {"energies.added_by_scheme.by_these_steps.axial", w->gained[BR_AXIAL]},
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
        {"tables.cost.0.ns_per_step", 1e9 * r->cost.seconds[BR_COST_LOAD_AXIAL] / STEPS},
        {"cost.ns_per_reading", 1e9 * r->cost.lap_seconds},
        {"seconds.wall", 12.5},
        {"seconds.set_up", r->end.set_up_seconds},
        {"seconds.march", r->end.march_seconds},
        {"seconds.per_step", r->end.march_seconds / STEPS},
        {"seconds.per_element_step", r->end.march_seconds / STEPS / ELEMENTS},
        {"work.steps", (double)r->counts.steps},
        {"work.solves_a_field", (double)r->counts.stages},
        {"work.changes_of_the_step", (double)r->counts.set_ups},
    };
    NUMBERS(root, "", numbers);
    assert_int_equal(json_array_size(at_path(root, "tables.model")), r->model_rows);
    TEXTS(root, "tables.warnings.0", "text", "days", "remedy", "less", "warning", "long");
    TEXTS(root, "method", "scheme", "euler");
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(check_is_in_json),    cmocka_unit_test(check_is_in_junit),
        cmocka_unit_test(junit_is_xml),        cmocka_unit_test(check_is_in_tap),
        cmocka_unit_test(check_is_read_again), cmocka_unit_test(run_is_in_json),
        cmocka_unit_test(answer_comes_first),
    };
    return cmocka_run_group_tests_name("report_values", tests, march, end);
}
