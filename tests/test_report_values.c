/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What golden/ does not hold of reports: made ones, whose numbers are all different, as they are
 * stored in golden/made; a check's JSON, as it is read for a comparison; and the digits of a run's
 * answer. */
#include <jansson.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "orders/expectation/comparison.h"
#include "orders/request.h"
#include "plots/beam/pictures.h"
#include "study/estimate/prediction.h"
#include "study/paper/paper.h"
#include "study/run/run.h"
#include "study/scene/method_fields.h"
#include "study/trade/trade.h"
#include "tables/beam/reports.h"
#include "tables/reports.h"
#include "tests/made_report.h"

static const struct br_provenance provenance = {.version = "1",
                                                .commit = "c",
                                                .compiler = "cc",
                                                .flags = "-O",
                                                .command_line = "beamrate",
                                                .machine = "m",
                                                .date = "2026-01-02T03:04:05Z",
                                                .threads = 1,
                                                .scene_path = "p",
                                                .scene_text = "t"};

/* ---- check ---- */

/* What it has of a field of its method over time. */
static const char *old_field(const struct br_old_check *old, enum br_method_key field,
                             char buffer[BR_SETTING_USUAL])
{
    const struct br_method method = br_method_default();
    static struct br_settings now; /* what is returned may be its */
    br_method_settings(&(struct br_meshes){0}, &method, &now);
    return br_old_setting(old, 0, BR_VERIFY_TIME, &now.row[field], buffer);
}

/* That it is read as this check. */
static void is_read(const char *text)
{
    OWNED(br_old_check) old;
    char found[1200];
    MUST(br_check_read_json(br_test_scene_file(text), &old, &err));
    assert_int_equal(old.count, 2);
    const struct br_check *made = &old.check[0];
    const struct br_case *c = made->cases;
    const struct br_expectation *e = &c->expected;
    char tolerance[BR_SETTING_USUAL];
    assert_int_equal(made->count, 1);
    assert_string_equal(old_field(&old, BR_METHOD_DEGREE, tolerance), "1");
    assert_string_equal(old_field(&old, BR_METHOD_FRICTION_PARAMETER, tolerance), "");
    assert_null(old_field(&old, BR_METHOD_CONTACT, tolerance));
    snprintf(found, sizeof found, "%s %s %s %s %d %g %g %g %g %g %g; %g %g %s %s %s; %s",
             made->name, br_verify_names[c->kind], c->measure, c->part, c->verdict == BR_FAIL,
             c->order.value, c->constant, e->order, e->tolerance, e->floor, e->ceiling,
             made->seconds, made->element_steps, old_field(&old, BR_METHOD_SCHEME, tolerance),
             old_field(&old, BR_METHOD_SOLVER, tolerance),
             old_field(&old, BR_METHOD_TOLERANCE, tolerance), old.check[1].name);
    assert_string_equal(found, "made time l2 axial 1 2.25 3.5 2.75 0.375 0.75 7.5; 4.25 5.25 "
                               "adaptive banded 0.0625; refused");
}

TEST(check_is_read)
{
    is_read("{\"format\": \"beamrate check\", \"version\": 2, \"methods\": {\"0\": {\"time\": "
            "{\"scheme\": \"adaptive\", \"tolerance\": 0.0625, \"solver\": \"banded\", "
            "\"contact\": [], \"friction\": \"exact\"}}}, \"tables\": {\"scenes\": "
            "[{\"scene\": \"made\", \"seconds\": 4.25, \"element_steps\": 5.25}, {\"scene\": "
            "\"refused\", \"seconds\": 0, \"element_steps\": 0}], \"orders\": [{\"scene\": "
            "\"made\", \"study\": \"time\", \"norm\": \"l2\", \"part\": \"axial\", \"verdict\": "
            "\"FAIL\", \"order\": 2.25, \"low\": 2.125, \"high\": 2.5, \"expected\": 2.75, "
            "\"tolerance\": 0.375, \"margin\": 0.625, \"constant\": 3.5, \"floor\": 0.75, "
            "\"ceiling\": 7.5}]}}");
}

/* ---- a study ---- */

static void make(struct br_made_report *m, bool with_exact)
{
    br_made_report(m, with_exact);
    struct br_study *const studies[] = {&m->study, &m->exact};
    for (int s = 0; s < 2; s++) {
        studies[s]->reference_size[BR_AXIAL] = 0.3 + s;
        studies[s]->reference_size[BR_BENDING] = 0.2 + s;
        studies[s]->reference_tip[BR_AXIAL] = 0.171 + 0.001 * s;
        studies[s]->reference_tip[BR_BENDING] = -0.07;
        for (size_t i = 0; i < BR_MADE_CELLS; i++) {
            m->cell[s][i].tip[BR_AXIAL] = 0.17 + 0.01 * (double)i + s;
            m->cell[s][i].tip[BR_BENDING] = -0.07 - 0.01 * (double)i - s;
        }
    }
    m->report.observed[BR_PART_TOTAL][BR_AXIS_SPACE] =
        (struct br_observed_order){.asked = true,
                                   .order = {2.03, 2.01, 2.05},
                                   .theory = {2, 4, 4, "it is so"},
                                   .by = "differences of successive meshes",
                                   .remark = "agrees with theory"};
    m->report.observed[BR_PART_TOTAL][BR_AXIS_TIME] =
        (struct br_observed_order){.asked = true,
                                   .order = {NAN, NAN, NAN},
                                   .theory = {1, 1, 1, ""},
                                   .by = "errors",
                                   .remark = "not measurable: for a reason"};
}

/* For people. */
static void print_text(FILE *out, struct br_document *d)
{
    MUST(br_document_print(out, &br_document_text, d, NULL, &err));
}

/* What a format makes of it, to be freed. */
static char *printed(const struct br_document_format *format, const struct br_document *d)
{
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    MUST(br_document_print(out, format, d, NULL, &err));
    assert_int_equal(fclose(out), 0);
    return text;
}

/* For programs: of JSON what is in no other format, and the tables as CSV; clears the document.
 * That the formats agree is a test of documents. */
static void print_values(FILE *out, struct br_document *d)
{
    static const char *const elsewhere[] = {"answer", "about_tables", "notes",   "pictures",
                                            "tables", "provenance",   "verdicts"};
    const struct br_document_table *t;
    size_t block = 0;
    FREED char *text = printed(&br_document_json, d);
    json_t *root = json_loads(text, JSON_REJECT_DUPLICATES, NULL);
    for (size_t i = 0; i < sizeof elsewhere / sizeof *elsewhere; i++)
        json_object_del(root, elsewhere[i]);
    json_dumpf(root, out, JSON_INDENT(1) | JSON_REAL_PRECISION(17));
    while ((t = br_document_next_table(d, &block))) {
        fprintf(out, "\n---- %s\n", t->key);
        MUST(br_document_print(out, &br_document_csv, d, t, &err));
    }
    json_decref(root);
    br_document_clear(d);
}

static void print_study(FILE *out)
{
    OWNED(br_made_report) m;
    struct br_document d = {0};
    make(&m, true);
    br_report_study(&m.report, &d);
    print_text(out, &d);
    print_values(out, &d);
}

/* Another method; and what is said where the last cell is sound, the printed errors agree, and the
 * exact reference is unstable. */
static void print_other_study(FILE *out)
{
    OWNED(br_made_report) m;
    OWNED(br_document) d = {0};
    make(&m, true);
    m.study.method = br_test_method("umfpack", "implicit", "uzawa");
    m.study.method.axial_degree = 2;
    m.study.method.iteration = (struct br_iteration){0.5, 1e-9, 10000};
    m.cell[1][11] = m.cell[1][10];
    m.cell[1][11].at.steps = 200;
    m.report.fits[BR_PART_TOTAL].reference_error = NAN;
    m.exact.reference_report.unstable = true;
    for (size_t i = 0; i < BR_MADE_CELLS; i++)
        m.report.printed[i] = 1.04 * m.cell[0][i].error[0];
    br_report_study(&m.report, &d);
    print_text(out, &d);
}

/* Only the total of a scene with one field; events. */
static void print_study_of_one_field(FILE *out)
{
    OWNED(br_made_report) m;
    OWNED(br_document) d = {0};
    make(&m, false);
    m.scene.axial.modelled = false;
    free(m.report.printed);
    m.report.printed = NULL;
    m.study.events = (char[]){"first event\nsecond event"};
    br_report_study(&m.report, &d);
    print_text(out, &d);
    m.study.events = NULL;
}

/* ---- claims ---- */

static void print_claims(FILE *out)
{
    struct br_finding finding[BR_MOST_CLAIMS] = {
        {.value = 0.75, .exact = 0.5, .error = 0.25, .printed = 0.625, .agreement = BR_DIFFERS},
        {.agreement = BR_UNDECIDED},
    };
    struct br_document d = {.name = NULL};
    br_report_claims(finding, 1000, 500, &d);
    print_values(out, &d);
}

static void print_studies(FILE *out)
{
    print_study(out);
    print_other_study(out);
    print_study_of_one_field(out);
    print_claims(out);
}

/* ---- the verdicts of a check ---- */

static struct br_case made_case(enum br_verify_kind kind, enum br_verdict verdict, size_t i)
{
    const double x = (double)i;
    struct br_case c = {
        .kind = kind,
        .expected = {.order = 2 + x, .tolerance = 0.25, .floor = 0.5, .ceiling = 8, .line = 10 + i},
        .measure = "l2",
        .part = "axial",
        .unit = "m",
        .order = {1.5 + x, 1.25 + x, 1.75 + x},
        .constant = 3 + x,
        .margin = 0.125 - x,
        .verdict = verdict};
    if (verdict)
        snprintf(c.reason, sizeof c.reason, "reason <%zu>, 100 %%", i);
    else
        snprintf(c.note, sizeof c.note, "note <%zu>", i);
    return c;
}

/* One of each outcome: a scene whose cases pass, fail, are open and have no number; one that cannot
 * be verified; a study of another program; and one that was skipped. Then what differs from an
 * earlier check, each of it by a severity of its own. */
static void print_check(FILE *out)
{
    struct br_point point[] = {
        {.at = {4, 8},
         .against = {8, 16},
         .z = 0.25,
         .z_against = 0.125,
         .error = 0.5,
         .constant = 2.5,
         .label = "n = 4",
         .flag = BR_FLAG_COARSE,
         .failure = "",
         .fit = {NAN, NAN, NAN}},
        {.at = {8, 16},
         .against = {0, 0},
         .z = 0.125,
         .z_against = 0,
         .error = 0.25,
         .constant = 1.25,
         .label = "n = 8",
         .flag = BR_FLAG_ROUND_OFF,
         .failure = "",
         .fit = {NAN, NAN, NAN}},
        {.at = {0, 0},
         .against = {0, 0},
         .z = 0.5,
         .z_against = 0.25,
         .error = 0.125,
         .constant = 1.125,
         .label = "h = 1",
         .flag = BR_FLAG_NONE,
         .failure = "",
         .fit = {NAN, NAN, NAN}},
        {.at = {16, 32},
         .against = {0, 0},
         .z = 0.5,
         .z_against = 0,
         .error = NAN,
         .constant = NAN,
         .label = "n = 16",
         .flag = BR_FLAG_FAILED,
         .failure = "it blew up",
         .fit = {NAN, NAN, NAN}},
    };
    struct br_case cases[2][5], other[2], *now = cases[0], *was = cases[1];
    const enum br_verdict verdict[] = {BR_PASS, BR_FAIL, BR_INCONCLUSIVE, BR_FAIL, BR_PASS};
    for (size_t i = 0; i < 5; i++)
        now[i] = was[i] = made_case((enum br_verify_kind)(i % 3), verdict[i], i);
    now[0].point = point;
    now[0].points = 3;
    now[3].point = &point[3];
    now[3].points = 1;
    now[3].order = was[3].order = (struct br_estimate){NAN, NAN, NAN};
    for (size_t i = 3; i < 5; i++)
        now[i].measure = was[i].measure = "tip";
    was[0].constant = 3.3;           /* a warning: 9 % */
    now[0].expected.highest = 3;     /* looser now, 2 to 3: a warning */
    was[1].expected.floor = 1;       /* looser now: a warning */
    was[1].expected.tolerance = 0.5; /* narrower now: 0.1 is 0.4 of the tolerance now: a warning */
    was[1].order.value = 2.4;
    was[2].verdict = BR_PASS; /* serious */
    was[4].verdict = BR_FAIL; /* a note, as is its constant of twice the size */
    was[4].constant = 3.5;
    other[0] = made_case(BR_VERIFY_SPACE, BR_INCONCLUSIVE, 7);
    other[1] = made_case(BR_VERIFY_TIME, BR_PASS, 8);
    struct br_check checks[] = {
        {.path = "a.yaml",
         .name = "a",
         .cases = now,
         .count = 5,
         .seconds = 2.5,
         .element_steps = 3e9},
        {.path = "b.yaml",
         .name = "b",
         .of_program = true,
         .failure = {BR_BAD_INPUT, "its reference & method"},
         .seconds = 0.5},
        {.path = "c.yaml", .name = "c", .of_program = true, .cases = other, .count = 1},
    };
    struct br_check before[] = {checks[0], {.name = "c", .cases = other, .count = 2}};
    before[0].cases = was;
    before[0].element_steps = 2.5e9; /* 1.2 times as many now: a note */
    before[0].seconds = 5;           /* 2.4 times as many for a step: a warning, never serious */
    const struct br_old_check old = {.check = before, .count = 2};
    OWNED(br_comparison) comparison;
    MUST(br_compare(checks, 3, true, &old, &comparison, &err));
    struct br_document d = {0};
    br_report_check(&(struct br_check_findings){checks, 3, 4.5, &comparison, &provenance}, &d);
    print_text(out, &d);
    const struct br_document_format *const formats[] = {&br_document_junit, &br_document_github};
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        FREED char *text = printed(formats[i], &d);
        fprintf(out, "\n==== %s\n%s", formats[i]->name, text);
    }
    fputs("\n==== csv, json\n", out);
    print_values(out, &d);
}

/* ---- orders, with costs ---- */

/* Errors that fall, with a scatter above round-off, and that grow with n, so that other runs are
 * the cheapest ones; a value; runs that were kept; one that failed. Time grows like n^2/k, with
 * some scatter. */
static void print_orders(FILE *out)
{
    char text[4096] = "n,k [s],fall [m],grow [N],u [J]\n";
    for (int i = 0; i < 16; i++) {
        const double n = 10 << i / 4, k = 0.1 / (1 << i % 4);
        snprintf(text + strlen(text), sizeof text - strlen(text), "%g,%.17g,%.17g,%.17g,%.17g\n", n,
                 k, (1 / n / n + k) * (1 + 1e-3 * (i * i % 7)), 3e-4 * n * k, 5 - 2 / n / n - k);
    }
    struct br_orders_request q = br_orders_request_default();
    OWNED(br_numbers) numbers;
    OWNED(br_orders) orders;
    struct br_estimate growth[BR_AXES];
    struct br_document d = {0};
    q.path = (char[]){"made"};
    q.table = text;
    q.errors = (char[]){"fall,grow"};
    q.values = (char[]){"u"};
    MUST(br_orders_read(&q, &numbers, &err));
    for (int i = 0; i < 16; i++) {
        numbers.row[i].seconds = 0.03 * (1 << 2 * (i / 4)) * (1 << i % 4) * (1 + 0.01 * (i % 3));
        numbers.row[i].bytes = 1e6 * (i + 1);
        numbers.row[i].cached = i % 5 == 1;
    }
    numbers.row[7].failure = strdup("exit code 1"); /* at the finest k */
    numbers.row[7].number[0] = numbers.row[7].number[1] = numbers.row[7].number[2] = (double)NAN;
    MUST(br_orders_find(&numbers, 2, &orders, &err));
    for (int axis = 0; axis < BR_AXES; axis++)
        MUST(br_orders_growth(&orders, (enum br_axis)axis, &growth[axis], &err));
    br_report_orders(&orders, growth, "made", &d);
    print_text(out, &d);
    print_values(out, &d);
    OWNED(br_figure) f = br_orders_draw(&orders, "made");
    br_figure_write_data(out, &f);
}

TEST(reports_are_as_stored)
{
    br_test_stored("check", print_check, 1e-13);
    br_test_stored("orders", print_orders, 1e-9);
    br_test_stored("studies", print_studies, 1e-13);
}

/* ---- trade ---- */

/* The paper's method reaches 1e-3 at six times the least cost: not 1e-2, at three times, where it
 * is the first that it reaches, and not 1e-4, which it does not reach. */
TEST(paper_is_beside_the_cheapest)
{
    static const struct {
        int method;
        double error, seconds;
    } made[] = {{0, 9e-3, 3}, {0, 8e-4, 12}, {1, 7e-3, 1}, {1, 6e-4, 2}, {1, 5e-5, 5}};
    enum { MADE = sizeof made / sizeof *made };
    OWNED(br_scene) scene = br_test_bundled("example2");
    FREED struct br_trade *t = calloc(1, sizeof *t);
    struct br_trial trial[MADE];
    struct br_point point[MADE];
    assert_non_null(t);
    MUST(br_named_methods_read("euler,bdf2", &t->methods, &err));
    t->request = br_trial_request_default(&scene);
    for (size_t i = 0; i < MADE; i++)
        trial[i] = (struct br_trial){.named = &t->methods.list[made[i].method],
                                     .at = {10, 10},
                                     .cost = {.march = made[i].seconds},
                                     .error = {made[i].error},
                                     .scale = 1,
                                     .own = NAN};
    t->trial = trial;
    t->point = point;
    t->count = MADE;
    br_trials_points(trial, MADE, t->methods.list, point);
    br_work_front(point, MADE);
    for (size_t i = 0; i < BR_TRADE_DIGITS; i++) {
        const double target = br_trade_target(i);
        t->best[i] = br_work_cheapest(point, MADE, target, SIZE_MAX, SIZE_MAX);
        for (size_t c = 0; c < t->methods.count; c++)
            t->best_of[c][i] = br_work_cheapest(point, MADE, target, c, SIZE_MAX);
    }
    OWNED(br_document) d = {0};
    br_report_trade(t, "example2", &provenance, &d);
    FREED char *text = printed(&br_document_json, &d);
    assert_non_null(strstr(text, "method, euler, reaches 1e-03 in 12 CPU s, 6 times as much as"));
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
    example = br_test_bundled("example2");
    const struct br_run_request request = {.scene = &example,
                                           .wanted = 3,
                                           .method = br_test_method(NULL, NULL, NULL),
                                           .n = ELEMENTS,
                                           .steps = STEPS,
                                           .check = true,
                                           .energies = true};
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
    br_report_run(&(struct br_run_findings){&report, p, w, &provenance, 12.5}, d);
}

/* Parts of a run's report; what the march computed is not the same everywhere. */
static void print_certificate(FILE *out)
{
    static const char *const keys[] = {"prediction", "energies", "certificate", "work", "seconds"};
    OWNED(br_document) d = {0};
    const struct br_warnings none = {0};
    report_run(&made_prediction, &none, &d);
    FREED char *text = printed(&br_document_json, &d);
    json_t *root = json_loads(text, JSON_REJECT_DUPLICATES, NULL);
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        json_dumpf(json_object_get(root, keys[i]), out, JSON_INDENT(1));
        fputc('\n', out);
    }
    json_decref(root);
}

TEST(certificate_is_printed)
{
    struct br_run_report *r = &report;
    double *worst = br_certificate_entries(&r->worst), *limits = br_certificate_entries(&r->limits);
    for (int i = 0; i < BR_CERTIFICATE_ENTRIES; i++) {
        worst[i] = 1 + i / 8.0;
        limits[i] = 2 + i / 8.0;
    }
    r->end.set_up_seconds = 0.5;
    r->end.march_seconds = 8;
    r->energy_worst = 3.5;
    r->energy_limit = 4.5;
    r->energy_start = (struct br_energy){{11, 12}, {13, 14}, 15};
    r->energy_now = (struct br_energy){{21, 22}, {23, 24}, 25};
    r->work = (struct br_work){.loads = {31, 32},
                               .viscous = {33, 34},
                               .friction = 35,
                               .scheme = {-36, 37},
                               .scheme_contact = 38,
                               .noise = {0.5, 0.25},
                               .steps = {41, 42},
                               .gaining = {43, 44},
                               .gained = {45, 46}};
    br_test_stored("certificate", print_certificate, 1e-13);
}

/* Processor time that grows by a tenth of an order or more is said, where the longest run takes
 * twice as long as the shortest one; then there is a table of costs. */
TEST(growth_of_time_is_said)
{
    static const struct {
        double growth, longest; /* s; the shortest run takes 1 s */
        const char *said;
    } cases[] = {
        {0.3, 3, "time grows like h^-0.3"}, {-0.3, 3, NULL}, {0.05, 3, NULL}, {0.3, 1.5, NULL}};
    struct br_orders_request q = br_orders_request_default();
    OWNED(br_numbers) numbers;
    OWNED(br_orders) orders;
    q.path = (char[]){"made"};
    q.table = (char[]){"h,l2\n1,1\n.5,.5\n.25,.25\n"};
    MUST(br_orders_read(&q, &numbers, &err));
    MUST(br_orders_find(&numbers, 2, &orders, &err));
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const double g = cases[i].growth;
        const struct br_estimate growth[BR_AXES] = {{g, g - 0.01, g + 0.01}, {NAN, NAN, NAN}};
        OWNED(br_document) d = {0};
        for (size_t row = 0; row < 3; row++)
            numbers.row[row].seconds = row == 2 ? cases[i].longest : 1;
        br_report_orders(&orders, growth, "made", &d);
        FREED char *text = printed(&br_document_text, &d);
        assert_true(!strstr(text, "Processor time") == !cases[i].said);
        assert_true(!cases[i].said || strstr(text, cases[i].said));
        assert_true(!strstr(text, "What each run costs") == !(cases[i].longest > 2));
    }
}

/* Of the printed errors one is by a ratio off; the others are ours. */
TEST(five_percent_is_a_difference)
{
    static const double ratio[] = {0.94, 0.96, 1.04, 1.06};
    for (size_t i = 0; i < 4; i++) {
        OWNED(br_made_report) m;
        OWNED(br_document) d = {0};
        make(&m, true);
        for (size_t c = 0; c < BR_MADE_CELLS; c++)
            m.report.printed[c] = m.cell[0][c].error[0] / (c == 5 ? ratio[i] : 1);
        br_report_study(&m.report, &d);
        FREED char *text = printed(&br_document_text, &d);
        assert_non_null(strstr(text, i % 3 ? "agree within 5 % in all" : " 5 % in 1 of "));
    }
}

/* People get the digits that the predicted error leaves, or the reason why it is not known. */
TEST(answer_comes_first)
{
    OWNED(br_document) d = {0};
    struct br_prediction p = made_prediction;
    const struct br_warnings none = {0};
    struct br_history_row *last = &report.end.last, cache = *last;
    last->displacement[BR_AXIAL] = -0.2216123;
    last->displacement[BR_BENDING] = 3.4567e-9;
    p.round_off = 0;
    /* rms errors of 0.0081 and 1.5e-11 m */
    p.field[BR_AXIAL].high = 0.0162 * sqrt(example.length);
    p.field[BR_BENDING].high = 2e-11 * sqrt(example.length);
    report_run(&p, &none, &d);
    char *text = printed(&br_document_text, &d);
    assert_non_null(
        strstr(text, "\nTip at t = 1 s: u = -0.222 +- 0.014 m, w = 3.457e-09 +- 3.4e-11"));
    assert_non_null(strstr(text, "\naxial displacement u: -0.222 +- 0.014 m\n"));
    free(text);
    p.known = p.bounded = false;
    strcpy(p.why, "it is so");
    report.failure = (struct br_error){BR_NOT_FINITE, "it blew up"};
    report_run(&p, &none, &d);
    text = printed(&br_document_text, &d);
    assert_non_null(strstr(text, "\nSTOPPED: it blew up\nTip at t = 1 s (the last good step): "
                                 "u = -0.221612 m, w = 3.4567e-09 m, "));
    assert_non_null(strstr(text, "\nThe discretisation error is not known: it is so; "));
    free(text);
    report.failure.status = BR_OK;
    *last = cache;
}

AROUND_TESTS(march, end)
