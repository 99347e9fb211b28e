/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The library's calls beside what they stand for: the same bits, errors by value, several threads.
 * That it is installed and found is tested by library.sh. */
#include <gsl/gsl_errno.h>
#include <locale.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study/fit/fit.h"
#include "study/foresee/prediction.h"
#include "study/grid/sweep.h"
#include "study/library/beamrate.h"
#include "study/scene/file.h"
#include "support.h"

static struct beamrate_error failure;

/* A call that must end with a status, and say a text. */
#define ENDS(call, expected, text)                                                                 \
    do {                                                                                           \
        const enum beamrate_status ended = (call);                                                 \
        if (ended != (expected) || failure.status != (expected) || !strstr(failure.message, text)) \
            fail_msg("%s: status %d, message '%s', expected %d and '%s'", #call, (int)ended,       \
                     failure.message, (int)(expected), text);                                      \
    } while (0)
#define WORKS(call) ENDS(call, BEAMRATE_OK, "")

static struct beamrate_scene *opened(const char *name)
{
    struct beamrate_scene *scene;
    WORKS(beamrate_scene_open(&scene, name, &failure));
    return scene;
}

static void close_to(double a, double b)
{
    if (!(a == b || (isnan(a) && isnan(b))))
        fail_msg("%.17g and %.17g are not the same", a, b);
}

static void same_estimate(struct beamrate_estimate a, struct br_estimate b)
{
    close_to(a.value, b.value);
    close_to(a.low, b.low);
    close_to(a.high, b.high);
}

/* ---- scenes ---- */

TEST(scenes_say_what_they_are)
{
    struct beamrate_scene *scene = opened("example3");
    struct br_scene expected = br_test_bundled("example3");
    struct beamrate_scene_info info;
    beamrate_scene_info(scene, &info);
    assert_string_equal(info.name, "example3");
    assert_string_equal(info.title, expected.title);
    close_to(info.length, expected.length);
    close_to(info.duration, expected.duration);
    close_to(info.density, expected.density);
    assert_int_equal(info.modelled[BEAMRATE_AXIAL], expected.axial.modelled);
    assert_int_equal(info.modelled[BEAMRATE_BENDING], expected.bending.modelled);
    assert_int_equal(info.contact, expected.contact.modelled);
    assert_int_equal(info.friction, expected.friction.law);
    br_scene_clear(&expected);
    beamrate_scene_free(scene);
    beamrate_scene_free(NULL);
}

TEST(wrong_scenes_are_refused)
{
    struct beamrate_scene *scene = (void *)&failure;
    ENDS(beamrate_scene_parse(&scene, "mine.yaml", "title: x\nlength: -1\n", &failure),
         BEAMRATE_BAD_INPUT, "mine.yaml:2: length: found '-1', expected");
    assert_null(scene);
    const char *path = br_test_scene_file("title: x\nlenth: 1\n");
    ENDS(beamrate_scene_open(&scene, path, &failure), BEAMRATE_BAD_INPUT, ":2: lenth: unknown key");
    ENDS(beamrate_scene_open(&scene, "exampel2", &failure), BEAMRATE_BAD_INPUT, "'example2'");
    ENDS(beamrate_scene_open(&scene, "-", &failure), BEAMRATE_BAD_INPUT, "./-");
    assert_int_equal(beamrate_scene_open(&scene, "exampel2", NULL), BEAMRATE_BAD_INPUT);
    WORKS(beamrate_scene_open(&scene, "example2", &failure));
    assert_string_equal(failure.message, "");
    beamrate_scene_free(scene);
}

/* ---- marches ---- */

static void march_gives(const char *scene_name, const char *const *method, struct br_method plain)
{
    enum { N = 12, STEPS = 30 };
    struct beamrate_scene *scene = opened(scene_name);
    struct br_scene expected = br_test_bundled(scene_name);
    struct br_march *march = br_test_march(&expected, N, STEPS, &plain);
    struct beamrate_march *ours;
    struct beamrate_tip tip;
    struct beamrate_march_report report;
    double a[2][2 * (N + 1)], b[2][2 * (N + 1)];
    WORKS(beamrate_march_create(&ours, scene, N, STEPS, method, &failure));
    for (size_t step = 0; step <= STEPS; step += 5) {
        br_test_advance(march, step);
        if (step)
            WORKS(beamrate_march_step(ours, 5, &failure));
        beamrate_march_tip(ours, &tip);
        assert_int_equal(tip.step, step);
        close_to(tip.time, br_march_time(march));
        const struct br_contact *contact = &expected.contact;
        const struct br_tip *t = br_march_tip(march);
        const double depth = fmax(tip.displacement[BEAMRATE_AXIAL] - contact->gap, 0);
        const double h =
            expected.friction.coefficient * (expected.friction.law == BR_COULOMB ? depth : 1);
        close_to(tip.contact_force, step ? t->contact_force : contact->stiffness * depth);
        close_to(tip.friction_bound, step ? t->friction_bound : h);
        assert_true(step ? tip.friction_force == t->friction_force : isnan(tip.friction_force));
        for (int kind = 0; kind < 2; kind++) {
            const size_t columns = beamrate_march_columns(ours, (enum beamrate_field)kind);
            assert_true(columns >= 1 && columns <= 2);
            memset(a, 1, sizeof a);
            memcpy(b, a, sizeof b);
            br_march_get(march, (enum br_field_kind)kind, a[0], a[1]);
            beamrate_march_get(ours, (enum beamrate_field)kind, b[0], b[1]);
            assert_memory_equal(a, b, sizeof a);
            close_to(tip.displacement[kind], b[0][columns * N]);
            close_to(tip.velocity[kind], b[1][columns * N]);
        }
    }
    beamrate_march_report(ours, &report);
    assert_int_equal(report.n, N);
    assert_int_equal(report.steps, STEPS);
    assert_int_equal(report.done, STEPS);
    assert_int_equal(report.stages, br_march_counts(march).stages);
    assert_int_equal(report.accepted, br_march_counts(march).steps);
    assert_int_equal(report.rejected, br_march_counts(march).rejected);
    if (!method || strcmp(method[1], "adaptive") != 0)
        assert_int_equal(report.rejected, 0);
    else
        assert_true(report.rejected > 0 && report.accepted != report.rejected);
    assert_int_equal(report.unstable, br_march_contact_unstable(march));
    close_to(report.round_off, br_march_round_off(march));
    beamrate_march_free(ours);
    beamrate_march_free(NULL);
    br_march_free(march);
    br_scene_clear(&expected);
    beamrate_scene_free(scene);
}

#define METHOD(...) ((const char *const[]){__VA_ARGS__, NULL})

TEST(marches_have_the_same_bits)
{
    static const char *const higher[] = {"scheme", "bdf2", "axial_degree", "2", NULL};
    struct br_method method = br_method_default();
    march_gives("example2", NULL, method);
    method.scheme = br_time_scheme_find("bdf2");
    method.contact = br_contact_rule_of(method.scheme);
    method.axial_degree = 2;
    march_gives("example2", higher, method);
    march_gives("example3", (const char *const[]){"friction", "uzawa", NULL},
                br_test_method(NULL, NULL, "uzawa"));
    method = br_method_default();
    method.scheme = br_time_scheme_find("adaptive");
    method.contact = br_contact_rule_of(method.scheme);
    method.tolerance = 1e-6;
    march_gives("release", METHOD("scheme", "adaptive", "tolerance", "1e-6"), method);
    march_gives("chatter", NULL, br_method_default()); /* unstable */
    march_gives("initial_data", NULL, br_method_default());
}

TEST(marches_are_refused)
{
    struct beamrate_scene *scene = opened("example2");
    struct beamrate_march *march;
#define WITH(method) beamrate_march_create(&march, scene, 4, 8, method, &failure)
    ENDS(WITH(METHOD("scheme", "eulr")), BEAMRATE_BAD_INPUT, "scheme: found 'eulr'");
    ENDS(WITH(METHOD("shceme", "euler")), BEAMRATE_BAD_INPUT,
         "found 'shceme', expected one of: scheme, tolerance");
    ENDS(WITH(METHOD("scheme", "euler", "scheme", "bdf2")), BEAMRATE_BAD_INPUT, "found it twice");
    ENDS(WITH(METHOD("scheme")), BEAMRATE_BAD_INPUT, "the end of the list");
    ENDS(WITH(METHOD("tolerance", "1e-6")), BEAMRATE_BAD_INPUT, "does not use it");
    ENDS(WITH(METHOD("scheme", "bdf2", "contact", "lagged")), BEAMRATE_BAD_INPUT, "lagged");
    assert_null(march);
    ENDS(beamrate_march_create(&march, scene, 0, 8, NULL, &failure), BEAMRATE_BAD_INPUT,
         "found n = 0 and 8 steps");
    ENDS(beamrate_march_create(&march, scene, 4, 0, NULL, &failure), BEAMRATE_BAD_INPUT, "0 steps");
    ENDS(beamrate_march_create(&march, scene, (size_t)1 << 50, 8, NULL, &failure),
         BEAMRATE_NO_MEMORY, "GB");
    ENDS(beamrate_march_create(&march, scene, 4, (size_t)1 << 60, NULL, &failure),
         BEAMRATE_BAD_INPUT, "years");
    WORKS(WITH(NULL));
    WORKS(beamrate_march_step(march, 7, &failure));
    ENDS(beamrate_march_step(march, 2, &failure), BEAMRATE_BAD_INPUT, "at most the 1");
    WORKS(beamrate_march_step(march, 1, &failure)); /* nothing was lost */
    beamrate_march_free(march);
    beamrate_scene_free(scene);
}

/* A march that has failed fails again, and says why. */
TEST(failed_marches_stay_failed)
{
    struct beamrate_scene *scene;
    struct beamrate_march *march;
    struct beamrate_tip tip;
    WORKS(beamrate_scene_parse(&scene, "grows",
                               "title: grows\nlength: 1 m\nduration: 1 s\ndensity: 1 kg/m\n"
                               "bending:\n  stiffness: 1 N m^2\n  viscosity: 1 N m^2 s\n"
                               "  load: 1e150*(1 + 10*t)^9 [N/m]\n",
                               &failure));
    WORKS(beamrate_march_create(&march, scene, 4, 8, NULL, &failure));
    ENDS(beamrate_march_step(march, 8, &failure), BEAMRATE_NOT_FINITE, "t = ");
    beamrate_march_tip(march, &tip);
    ENDS(beamrate_march_step(march, 1, &failure), BEAMRATE_NOT_FINITE, "t = ");
    beamrate_march_free(march);
    beamrate_scene_free(scene);
}

static void forecast_gives(const char *name, bool warned)
{
    struct beamrate_scene *scene = opened(name);
    struct br_scene expected = br_test_bundled(name);
    const struct br_method method = br_method_default();
    struct br_prediction prediction;
    struct br_warnings warnings = {0};
    static struct beamrate_forecast forecast;
    struct br_error err = {0};
    const struct br_planned_march planned = {
        .scene = &expected, .method = &method, .n = 10, .steps = 50, .prediction = &prediction};
    MUST(br_check_ahead(&planned, &warnings, &err));
    WORKS(beamrate_foresee(scene, 10, 50, NULL, &forecast, &failure));
    assert_int_equal(forecast.known, prediction.known);
    assert_string_equal(forecast.why, prediction.known ? "" : prediction.why);
    close_to(forecast.round_off, prediction.round_off);
    for (int kind = 0; kind < 2; kind++) {
        const struct br_predicted *e = &prediction.field[kind];
        const struct br_estimate none = {NAN, NAN, NAN};
        same_estimate(forecast.error[kind],
                      forecast.known ? (struct br_estimate){e->error, e->low, e->high} : none);
    }
    if (forecast.known) /* no two ends are the same */
        assert_true(0 < forecast.error[1].low && forecast.error[1].low < forecast.error[1].value &&
                    forecast.error[1].value < forecast.error[1].high);
    assert_int_equal(forecast.known, !warned);
    assert_int_equal(warnings.count > 0, warned);
    assert_int_equal(forecast.warnings, warnings.count);
    for (size_t i = 0; i < warnings.count; i++) {
        assert_string_equal(forecast.warning[i].kind, br_warning_words[warnings.list[i].kind]);
        assert_string_equal(forecast.warning[i].text, warnings.list[i].text);
        assert_string_equal(forecast.warning[i].remedy, warnings.list[i].remedy);
    }
    ENDS(beamrate_foresee(scene, 0, 50, NULL, &forecast, &failure), BEAMRATE_BAD_INPUT, "n = 0");
    br_scene_clear(&expected);
    beamrate_scene_free(scene);
}

TEST(forecasts_are_the_programs)
{
    forecast_gives("chatter", true);
    forecast_gives("example2", false);
}

/* ---- studies ---- */

static const size_t meshes[] = {4, 8, 16}, times[] = {8, 16, 32};

static void same_study(const struct beamrate_study *study, struct br_study *expected)
{
    struct br_error err = {0};
    struct beamrate_cell cell;
    for (size_t c = 0; c < 9; c++) {
        const struct br_cell *e = br_study_cell(expected, c / 3, c % 3);
        beamrate_study_cell(study, c / 3, c % 3, &cell);
        assert_int_equal(cell.n, e->at.n);
        assert_int_equal(cell.steps, e->at.steps);
        assert_string_equal(cell.failure, "");
        for (int i = 0; i < 2; i++)
            close_to(cell.tip[i], e->tip[i]);
    }
    for (enum br_part part = 0; part < BR_PARTS; part++) {
        struct br_fits fits;
        struct beamrate_fit fit;
        MUST(br_fit(expected, part, &fits, &err));
        beamrate_study_fit(study, (enum beamrate_part)part, &fit);
        assert_int_equal(fit.describes, br_joint_describes(&fits.joint));
        assert_int_equal(fit.points, fits.joint.points);
        same_estimate(fit.p, fits.joint.order[0]);
        same_estimate(fit.q, fits.joint.order[1]);
        same_estimate(fit.c_h, fits.joint.c[0]);
        same_estimate(fit.c_k, fits.joint.c[1]);
        same_estimate(fit.r, fits.joint.r);
        close_to(fit.misfit, fits.joint.misfit);
        for (size_t c = 0; c < 9; c++) {
            beamrate_study_cell(study, c / 3, c % 3, &cell);
            close_to(cell.error[part], br_study_cell(expected, c / 3, c % 3)->error[part]);
            assert_string_equal(cell.flag[part],
                                br_flag_name(br_study_cell(expected, c / 3, c % 3)->flag[part]));
        }
    }
}

TEST(studies_have_the_same_bits)
{
    struct beamrate_scene *scene = opened("example2");
    struct br_scene bundled = br_test_bundled("example2");
    struct br_error err = {0};
    for (int fine = 0; fine < 2; fine++) {
        struct br_study expected =
            br_test_study(&bundled, fine ? &br_judge_fine : &br_judge_exact, 3, meshes, 3, times);
        struct beamrate_study_request request = {.n = meshes,
                                                 .n_count = 3,
                                                 .steps = times,
                                                 .steps_count = 3,
                                                 .reference = fine ? "fine" : NULL,
                                                 .norm = fine ? "energy" : NULL,
                                                 .threads = 2};
        struct beamrate_study *study;
        struct beamrate_reference reference;
        expected.norm = fine ? &br_norm_energy : &br_norm_l2;
        if (fine) {
            expected.reference = (struct br_resolution){32, 64};
            expected.auditor = &br_judge_exact;
            request.reference_n = 32;
            request.reference_steps = 64;
        }
        MUST(br_study_run(&expected, 1, 1, NULL, &err));
        WORKS(beamrate_study_run(&study, scene, &request, &failure));
        same_study(study, &expected);
        beamrate_study_reference(study, &reference);
        assert_string_equal(reference.name, fine ? "fine" : "exact");
        assert_int_equal(reference.n, fine ? 32 : 0);
        close_to(reference.size, expected.reference_scale);
        close_to(reference.tip[1], expected.reference_tip[1]);
        close_to(reference.own_error[2],
                 fine ? expected.reference_error[2]
                      : br_norm_of_constant(expected.norm, &bundled, expected.judged_by.own_error,
                                            BR_PART_BENDING));
        assert_true(reference.own_error[2] > 0);
        beamrate_study_free(study);
        br_study_clear(&expected);
    }
    beamrate_study_free(NULL);
    br_scene_clear(&bundled);
    beamrate_scene_free(scene);
}

TEST(studies_are_refused)
{
    struct beamrate_scene *scene = opened("example2");
    struct beamrate_study *study = NULL;
    static const size_t falling[] = {8, 4}, zero[] = {0, 4};
    struct beamrate_study_request good = {
        .n = meshes, .n_count = 2, .steps = times, .steps_count = 2};
    struct beamrate_study_request r;
#define STUDY_WITH(text, ...)                                                        \
    r = good;                                                                        \
    __VA_ARGS__;                                                                     \
    ENDS(beamrate_study_run(&study, scene, &r, &failure), BEAMRATE_BAD_INPUT, text); \
    assert_null(study)
    STUDY_WITH("n: found 4 behind 8, expected ascending", r.n = falling);
    STUDY_WITH("n: found 0, expected", r.n = zero);
    STUDY_WITH("steps: found an empty list", r.steps_count = 0);
    STUDY_WITH("norm: found 'l1'", r.norm = "l1");
    STUDY_WITH("reference: found 'none'", r.reference = "none");
    STUDY_WITH("reference: found 'fin'", r.reference = "fin");
    STUDY_WITH("expected those of the fine run", r.reference = "fine");
    STUDY_WITH("they are for a fine run", r.reference_n = 8);
    STUDY_WITH("does not nest", r.reference = "fine", r.reference_n = 10, r.reference_steps = 16);
    STUDY_WITH("threads: found -1", r.threads = -1);
    STUDY_WITH("threads: found 1000000000, expected 0 to 1024", r.threads = 1000000000);
    STUDY_WITH("n: found NULL", r.n = NULL);
    STUDY_WITH("steps: found NULL", r.steps = NULL);
    STUDY_WITH("scheme: found 'x'", r.method = METHOD("scheme", "x"));
    beamrate_scene_free(scene);
}

/* What an observer sees, and the locale and the handler of GSL that it finds; it makes a call of
 * its own within the one that it observes. */
struct seen {
    int calls, most;
    double last;
    locale_t locale;
    gsl_error_handler_t *handler;
};

static int see(void *self, double share)
{
    struct seen *seen = self;
    seen->calls++;
    seen->last = share;
    seen->locale = uselocale((locale_t)0);
    if (seen->calls == 1)
        beamrate_scene_free(opened("release"));
    seen->handler = gsl_set_error_handler_off();
    return seen->calls >= seen->most;
}

static void fatal(const char *reason, const char *file, int line, int number)
{
    fail_msg("%s (%s:%d, %d)", reason, file, line, number);
}

TEST(callers_keep_their_handler_and_locale)
{
    struct beamrate_scene *scene = opened("example2");
    struct seen seen = {.most = INT32_MAX};
    const struct beamrate_observer observer = {see, &seen};
    const struct beamrate_study_request request = {.n = meshes,
                                                   .n_count = 2,
                                                   .steps = times,
                                                   .steps_count = 2,
                                                   .threads = 1,
                                                   .observer = &observer};
    struct beamrate_study *study;
    const locale_t mine = newlocale(LC_ALL_MASK, "C.UTF-8", (locale_t)0);
    assert_true(mine != (locale_t)0);
    const locale_t before = uselocale(mine);
    gsl_error_handler_t *const handler = gsl_set_error_handler(fatal);
    WORKS(beamrate_study_run(&study, scene, &request, &failure));
    assert_true(seen.calls > 0 && seen.last == 1);
    assert_true(seen.locale != mine && seen.handler != fatal);
    assert_true(uselocale(before) == mine);
    assert_true(gsl_set_error_handler(handler) == fatal);
    freelocale(mine);
    beamrate_study_free(study);
    beamrate_scene_free(scene);
}

TEST(observers_stop_what_takes_long)
{
    struct beamrate_scene *scene = opened("example2");
    struct seen seen = {.most = 1};
    const struct beamrate_observer observer = {see, &seen};
    struct beamrate_study *study;
    struct beamrate_check *check;
    const size_t n[] = {500, 1000}, steps[] = {5000, 10000};
    const struct beamrate_study_request request = {
        .n = n, .n_count = 2, .steps = steps, .steps_count = 2, .observer = &observer};
    ENDS(beamrate_study_run(&study, scene, &request, &failure), BEAMRATE_INTERRUPTED,
         "interrupted");
    assert_null(study);
    seen = (struct seen){.most = 1};
    ENDS(beamrate_check_run(&check, scene, 1, &observer, &failure), BEAMRATE_INTERRUPTED,
         "interrupted");
    assert_null(check);
    beamrate_scene_free(scene);
}

/* ---- verdicts ---- */

static const char verified[] =
    "title: a rod\nlength: 1 m\nduration: 1 s\ndensity: 1 kg/m\n"
    "axial:\n  stiffness: 10 N\n  viscosity: 1 N s\n  load: 10*t [N/m]\n"
    "verify:\n  time:\n    n: 8\n    k: 0.01, 0.005, 0.0025, 0.00125, 0.000625 s\n    l2: %s\n";

TEST(verdicts_are_values)
{
    static const struct {
        const char *expected;
        enum beamrate_verdict verdict;
    } rows[] = {{"1 +- 0.1", BEAMRATE_PASS}, {"2 +- 0.1", BEAMRATE_FAIL}};
    for (size_t i = 0; i < 2; i++) {
        char text[1000];
        struct beamrate_scene *scene;
        struct beamrate_check *check;
        struct beamrate_case c;
        snprintf(text, sizeof text, verified, rows[i].expected);
        WORKS(beamrate_scene_parse(&scene, "rod.yaml", text, &failure));
        WORKS(beamrate_check_run(&check, scene, 1, NULL, &failure));
        beamrate_scene_free(scene);
        assert_int_equal(beamrate_check_count(check), 1);
        beamrate_check_case(check, 0, &c);
        assert_string_equal(c.study, "time");
        assert_string_equal(c.measure, "l2");
        assert_string_equal(c.part, "total");
        assert_int_equal(c.verdict, rows[i].verdict);
        assert_true((c.margin >= 0) == (rows[i].verdict == BEAMRATE_PASS));
        assert_true((*c.reason == '\0') == (rows[i].verdict == BEAMRATE_PASS));
        assert_true(c.expected == (double)(i + 1) && c.tolerance == 0.1);
        CLOSE(c.order.value, 1, 0.1);
        assert_true(c.order.low <= c.order.value && c.order.value <= c.order.high);
        assert_true(c.points == 4 && c.used == 4 && c.constant > 0);
        beamrate_check_free(check);
    }
    beamrate_check_free(NULL);
    struct beamrate_scene *scene = opened("example2");
    struct beamrate_check *check;
    ENDS(beamrate_check_run(&check, scene, -1, NULL, &failure), BEAMRATE_BAD_INPUT, "threads");
    beamrate_scene_free(scene);
}

TEST(orders_of_numbers)
{
    double h[16], k[16], error[16], value[16];
    struct beamrate_orders *orders;
    struct beamrate_order order;
    struct beamrate_fit fit;
    struct beamrate_check *check;
    struct beamrate_case c;
    for (int i = 0; i < 16; i++) {
        h[i] = ldexp(0.1, -(i / 4));
        k[i] = ldexp(0.2, -(i % 4));
        error[i] = 3 * h[i] * h[i] + 0.5 * k[i];
        value[i] = 7 + h[i] * h[i];
    }
    struct beamrate_numbers numbers = {.h = h, .k = k, .number = error, .count = 16};
    WORKS(beamrate_orders_find(&orders, &numbers, &failure));
    beamrate_orders_fit(orders, &fit);
    CLOSE(fit.p.value, 2, 1e-6);
    CLOSE(fit.q.value, 1, 1e-6);
    CLOSE(fit.c_h.value, 3, 1e-5);
    CLOSE(fit.c_k.value, 0.5, 1e-6);
    assert_int_equal(fit.describes, 1);
    const struct beamrate_expectation expected[] = {{BEAMRATE_SPACE, 2, 0.1, 0},
                                                    {BEAMRATE_TIME, 2, 0.1, 0}};
    WORKS(beamrate_orders_check(&check, orders, expected, 2, &failure));
    beamrate_orders_free(orders);
    assert_int_equal(beamrate_check_count(check), 2);
    beamrate_check_case(check, 0, &c);
    assert_int_equal(c.verdict, BEAMRATE_PASS);
    assert_string_equal(c.study, "space");
    assert_string_equal(c.measure, "error");
    beamrate_check_case(check, 1, &c);
    assert_int_equal(c.verdict, BEAMRATE_FAIL);
    assert_string_equal(c.study, "time");
    beamrate_check_free(check);
    double coarse[4] = {h[0], h[4], h[8], h[12]},
           values[4] = {value[0], value[4], value[8], value[12]};
    numbers = (struct beamrate_numbers){.h = coarse, .number = values, .count = 4, .values = 1};
    WORKS(beamrate_orders_find(&orders, &numbers, &failure));
    assert_int_equal(beamrate_orders_line(orders, BEAMRATE_SPACE, &order), 1);
    CLOSE(order.order.value, 2, 1e-6);
    CLOSE(order.constant, 1, 1e-5);
    CLOSE(order.limit.value, 7, 1e-9);
    assert_int_equal(order.points, 3);
    assert_int_equal(beamrate_orders_line(orders, BEAMRATE_TIME, &order), 0);
    beamrate_orders_fit(orders, &fit);
    assert_true(isnan(fit.p.value) && isnan(fit.misfit) && !fit.describes);
    ENDS(beamrate_orders_check(&check, orders, &expected[1], 1, &failure), BEAMRATE_BAD_INPUT,
         "numbers: an order of value in k is expected");
    beamrate_orders_free(orders);
    beamrate_orders_free(NULL);
}

TEST(wrong_numbers_are_refused)
{
    double h[] = {4, 2, 1}, error[] = {16, 4, 1};
    struct beamrate_orders *orders;
    struct beamrate_numbers numbers = {.number = error, .count = 3};
    ENDS(beamrate_orders_find(&orders, &numbers, &failure), BEAMRATE_BAD_INPUT, "neither h nor k");
    numbers.h = h;
    numbers.count = 2;
    ENDS(beamrate_orders_find(&orders, &numbers, &failure), BEAMRATE_BAD_INPUT, "at least 3");
    numbers.count = 3;
    error[1] = -4;
    ENDS(beamrate_orders_find(&orders, &numbers, &failure), BEAMRATE_BAD_INPUT, "numbers:2: error");
    error[1] = 4;
    h[2] = NAN;
    ENDS(beamrate_orders_find(&orders, &numbers, &failure), BEAMRATE_BAD_INPUT, "numbers:3: h");
    assert_null(orders);
    h[2] = 1;
    WORKS(beamrate_orders_find(&orders, &numbers, &failure));
    const struct beamrate_expectation wrong[] = {{BEAMRATE_SPACE, 2, 3, 0},
                                                 {BEAMRATE_SPACE, NAN, 0.1, 0},
                                                 {BEAMRATE_SPACE, INFINITY, 0.1, 0},
                                                 {BEAMRATE_SPACE, 2, 0.1, NAN}};
    struct beamrate_check *check;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        ENDS(beamrate_orders_check(&check, orders, &wrong[i], 1, &failure), BEAMRATE_BAD_INPUT,
             "expectation 0: found order");
    beamrate_orders_free(orders);
}

/* e = 3 h^2 and v = 7 + h on h = 1/n; the mesh of 5 has another error. */
static const char two_columns[] = "N; e [m]; v\n5; 0,9; 7,2\n10; 0,03; 7,1\n20; 0,0075; 7,05\n"
                                  "40; 0,001875; 7,025\n80; 0,00046875; 7,0125\n";

TEST(orders_of_a_table)
{
    struct beamrate_table table = {.text = two_columns, .errors = "e", .values = "v", .formal = 1};
    struct beamrate_orders *orders;
    struct beamrate_answer answer;
    struct beamrate_order_point point;
    struct beamrate_check *check;
    struct beamrate_case c;
    const char *json;
    WORKS(beamrate_orders_read(&orders, &table, &failure));
    for (size_t i = 0; i < 2; i++) {
        assert_int_equal(beamrate_orders_answer(orders, i, BEAMRATE_SPACE, &answer), 1);
        assert_string_equal(answer.quantity, i ? "v" : "e");
        assert_int_equal(answer.values, i);
        assert_int_equal(answer.refined, 1);
        CLOSE(answer.order.value, i ? 1 : 2, 1e-4); /* of few digits */
        assert_string_equal(answer.open, "");
        assert_int_equal(beamrate_orders_answer(orders, i, BEAMRATE_TIME, &answer), 1);
        assert_true(!answer.refined && isnan(answer.order.value));
        for (size_t at = 1; at < 5 - i; at++) {
            assert_int_equal(beamrate_orders_point(orders, i, BEAMRATE_SPACE, at, &point), 1);
            CLOSE(point.size, 0.2 / (double)(1 << at), 1e-12);
            CLOSE(point.error, i ? point.size / 2 : 3 * point.size * point.size, 1e-12);
            CLOSE(point.fit.value, point.error, 1e-4 * point.error);
            assert_true(point.fit.low <= point.fit.value && point.fit.value <= point.fit.high);
            assert_string_equal(point.left_out, "");
            if (at > 1)
                CLOSE(point.rate, i ? 1 : 2, 1e-9);
        }
        assert_int_equal(beamrate_orders_point(orders, i, BEAMRATE_SPACE, 5 - i, &point), 0);
        assert_true(isnan(point.error) && !*point.left_out);
        assert_int_equal(beamrate_orders_point(orders, i, BEAMRATE_TIME, 0, &point), 0);
        const struct beamrate_expectation expected = {BEAMRATE_SPACE, i ? 1 : 2, 0.1, 0};
        WORKS(beamrate_orders_check_quantity(&check, orders, i, &expected, 1, &failure));
        beamrate_check_case(check, 0, &c);
        assert_int_equal(c.verdict, BEAMRATE_PASS);
        assert_string_equal(c.measure, i ? "v" : "e");
        beamrate_check_free(check);
    }
    beamrate_orders_point(orders, 0, BEAMRATE_SPACE, 0, &point);
    assert_string_equal(point.left_out, "not asymptotic");
    assert_int_equal(beamrate_orders_answer(orders, 2, BEAMRATE_SPACE, &answer), 0);
    assert_true(!*answer.quantity && isnan(answer.order.value));
    WORKS(beamrate_orders_report(orders, &json, &failure));
    assert_non_null(strstr(json, "\"answer\": [\n  \"e: order 2.00"));
    assert_non_null(strstr(json, "\"gci_fine\": "));
    const struct beamrate_expectation expected = {BEAMRATE_SPACE, 2, 0.1, 0};
    ENDS(beamrate_orders_check_quantity(&check, orders, 2, &expected, 1, &failure),
         BEAMRATE_BAD_INPUT, "quantity: found 2, expected less than 2");
    beamrate_orders_free(orders);
    static const struct {
        struct beamrate_table table;
        const char *message;
    } refused[] = {
        {{.text = NULL}, "table: found NULL"},
        {{.text = "h,e\n4,1\n2,1\n1,-1\n"}, "table:4: e: found -1"},
        {{.text = "h,e\n4,1\n2,1\n1,1\n", .name = "a.csv", .errors = "f"},
         "a.csv: --error: there is"},
        {{.text = two_columns, .dimension = NAN}, "table: found dimension nan"},
        {{.text = two_columns, .dimension = INFINITY}, "table: found dimension inf"},
        {{.text = two_columns, .formal = -1}, "formal order -1"},
    };
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        ENDS(beamrate_orders_read(&orders, &refused[i].table, &failure), BEAMRATE_BAD_INPUT,
             refused[i].message);
        assert_null(orders);
    }
    ENDS(beamrate_orders_read(&orders, NULL, &failure), BEAMRATE_BAD_INPUT, "table: found NULL");
}

/* The dimension of a mesh, and that it was assumed. */
TEST(dimensions_of_a_table)
{
    static const char text[] = "dofs,e\n1,64\n64,4\n4096,0.25\n262144,0.015625\n";
    const struct beamrate_expectation expected = {BEAMRATE_SPACE, 2, 0.1, 0};
    struct beamrate_check *check;
    for (int dimension = 0; dimension < 4; dimension++) {
        const struct beamrate_table table = {.text = text, .dimension = dimension};
        struct beamrate_orders *orders;
        struct beamrate_answer answer;
        const char *json;
        WORKS(beamrate_orders_read(&orders, &table, &failure));
        WORKS(beamrate_orders_report(orders, &json, &failure));
        beamrate_orders_answer(orders, 0, BEAMRATE_SPACE, &answer);
        CLOSE(answer.order.value, 2 * (dimension ? dimension : 2) / 3., 1e-6);
        assert_int_equal(!!strstr(json, "assumed"), !dimension);
        if (dimension)
            WORKS(beamrate_orders_check(&check, orders, &expected, 1, &failure));
        else
            ENDS(beamrate_orders_check(&check, orders, &expected, 1, &failure), BEAMRATE_BAD_INPUT,
                 "state the dimension of the mesh");
        beamrate_check_free(check);
        beamrate_orders_free(orders);
    }
}

/* Numbers at a floor are left out of the fit, and counted. */
TEST(used_numbers_are_counted)
{
    static const double h[] = {256, 128, 64, 32, 16, 8, 4, 2},
                        error[] = {65536, 16384, 4096, 1024, 256, 64, 10, 10};
    const struct beamrate_numbers numbers = {.h = h, .number = error, .count = 8};
    const struct beamrate_expectation expected = {BEAMRATE_SPACE, 2, 0.5, 10};
    struct beamrate_orders *orders;
    struct beamrate_order order;
    struct beamrate_check *check;
    struct beamrate_case c;
    WORKS(beamrate_orders_find(&orders, &numbers, &failure));
    assert_int_equal(beamrate_orders_line(orders, BEAMRATE_SPACE, &order), 1);
    assert_int_equal(order.points, 8);
    assert_int_equal(order.used, 6);
    CLOSE(order.constant, 1, 0.01); /* of the observed order, whose interval the floor widens */
    WORKS(beamrate_orders_check(&check, orders, &expected, 1, &failure));
    WORKS(beamrate_check_case(check, 0, &c));
    assert_int_equal(c.points, order.points);
    assert_int_equal(c.used, 6);
    CLOSE(c.constant, 1, 1e-6);
    assert_true(*c.note);
    beamrate_check_free(check);
    beamrate_orders_free(orders);
}

/* Values of order 3: their limit, which does not depend on what theory says. */
TEST(limit_of_values)
{
    static const double h[] = {16, 8, 4, 2, 1}, formal[] = {2, 4, 0};
    static const double value[] = {7 + 4096.1, 7 + 511.9, 7 + 64.1, 7 + 7.9, 7 + 1};
    for (size_t i = 0; i < 3; i++) {
        const struct beamrate_numbers numbers = {
            .h = h, .number = value, .count = 5, .values = 1, .formal = formal[i]};
        struct beamrate_orders *orders;
        struct beamrate_order order;
        WORKS(beamrate_orders_find(&orders, &numbers, &failure));
        assert_int_equal(beamrate_orders_line(orders, BEAMRATE_SPACE, &order), 1);
        CLOSE(order.limit.value, 7, 0.2);
        assert_true(order.limit.low <= 7 && 7 <= order.limit.high);
        beamrate_orders_free(orders);
    }
    const struct beamrate_numbers wrong = {
        .h = h, .number = value, .count = 5, .values = 1, .formal = 0.5};
    struct beamrate_orders *none;
    ENDS(beamrate_orders_find(&none, &wrong, &failure), BEAMRATE_BAD_INPUT, "formal order is 0.5");
}

/* ---- what is no handle, no index, no number ---- */

TEST(wrong_handles_are_refused)
{
    static const double h[] = {4, 2, 1}, error[] = {16, 4, 1};
    struct beamrate_numbers numbers = {.h = h, .number = error, .count = 3};
    const struct beamrate_study_request request = {
        .n = meshes, .n_count = 1, .steps = times, .steps_count = 1, .threads = 1};
    struct beamrate_expectation expected = {BEAMRATE_SPACE, 2, 0.1, 0};
    struct beamrate_scene *scene = opened("example2");
    struct beamrate_march *march, *made_march;
    struct beamrate_study *study, *made_study;
    struct beamrate_orders *orders;
    struct beamrate_check *check;
    static struct beamrate_forecast forecast;
    struct beamrate_scene_info info;
    struct beamrate_tip tip;
    struct beamrate_march_report report;
    struct beamrate_cell cell;
    struct beamrate_reference reference;
    struct beamrate_fit fit;
    struct beamrate_order order;
    struct beamrate_answer answer;
    struct beamrate_order_point point;
    struct beamrate_case c;
    const char *json;
    double room[2 * 5];
    WORKS(beamrate_march_create(&march, scene, 4, 8, NULL, &failure));
    WORKS(beamrate_study_run(&study, scene, &request, &failure));
    WORKS(beamrate_orders_find(&orders, &numbers, &failure));
    /* another handle: a march in place of any but a march, a scene in place of a march */
    void *const wrong[] = {NULL, march, scene};
    for (size_t i = 0; i < 2; i++) {
        void *const other = wrong[i], *const no_march = wrong[2 * i];
        ENDS(beamrate_march_create(&made_march, other, 4, 8, NULL, &failure), BEAMRATE_BAD_INPUT,
             i ? "scene: found something else, expected a handle of kind 'scene'"
               : "scene: found NULL");
        assert_null(made_march);
        ENDS(beamrate_foresee(other, 4, 8, NULL, &forecast, &failure), BEAMRATE_BAD_INPUT,
             "scene:");
        ENDS(beamrate_study_run(&made_study, other, &request, &failure), BEAMRATE_BAD_INPUT,
             "scene: found");
        assert_null(made_study);
        ENDS(beamrate_check_run(&check, other, 1, NULL, &failure), BEAMRATE_BAD_INPUT, "scene:");
        ENDS(beamrate_march_step(no_march, 1, &failure), BEAMRATE_BAD_INPUT, "march: found");
        ENDS(beamrate_orders_check(&check, other, &expected, 1, &failure), BEAMRATE_BAD_INPUT,
             "orders: found");
        assert_null(check);
#define REFUSES(call) assert_int_equal((call), BEAMRATE_BAD_INPUT)
        REFUSES(beamrate_scene_info(other, &info));
        assert_true(*info.name == 0 && info.length == 0);
        REFUSES(beamrate_march_tip(no_march, &tip));
        REFUSES(beamrate_march_report(no_march, &report));
        REFUSES(beamrate_march_get(no_march, BEAMRATE_AXIAL, room, room));
        assert_int_equal(beamrate_march_columns(no_march, BEAMRATE_AXIAL), 0);
        REFUSES(beamrate_study_cell(other, 0, 0, &cell));
        assert_true(isnan(cell.error[0]) && *cell.flag[2] == 0);
        REFUSES(beamrate_study_fit(other, BEAMRATE_TOTAL, &fit));
        REFUSES(beamrate_study_reference(other, &reference));
        REFUSES(beamrate_check_case(other, 0, &c));
        assert_int_equal(c.verdict, BEAMRATE_FAIL);
        assert_int_equal(beamrate_check_count(other), 0);
        assert_int_equal(beamrate_orders_line(other, BEAMRATE_SPACE, &order), 0);
        assert_true(isnan(order.order.value));
        assert_int_equal(beamrate_orders_answer(other, 0, BEAMRATE_SPACE, &answer), 0);
        assert_int_equal(beamrate_orders_point(other, 0, BEAMRATE_SPACE, 0, &point), 0);
        assert_true(isnan(answer.order.value) && isnan(point.size) && !*point.left_out);
        ENDS(beamrate_orders_report(other, &json, &failure), BEAMRATE_BAD_INPUT, "orders: found");
        assert_null(json);
        REFUSES(beamrate_orders_fit(other, &fit));
        assert_true(isnan(fit.p.value));
        beamrate_scene_free(other); /* nothing */
        beamrate_march_free(no_march);
        beamrate_study_free(other);
        beamrate_check_free(other);
        beamrate_orders_free(other);
    }
    WORKS(beamrate_march_step(march, 1, &failure)); /* all are as they were */
    /* NULL elsewhere */
    ENDS(beamrate_scene_open(&scene, NULL, &failure), BEAMRATE_BAD_INPUT, "name: found NULL");
    assert_null(scene);
    scene = opened("example2");
    struct beamrate_scene *none;
    ENDS(beamrate_scene_parse(&none, "x", NULL, &failure), BEAMRATE_BAD_INPUT, "text: found NULL");
    ENDS(beamrate_scene_open(NULL, "example2", &failure), BEAMRATE_BAD_INPUT, "place for a handle");
    ENDS(beamrate_study_run(&made_study, scene, NULL, &failure), BEAMRATE_BAD_INPUT, "request:");
    ENDS(beamrate_foresee(scene, 4, 8, NULL, NULL, &failure), BEAMRATE_BAD_INPUT, "forecast:");
    REFUSES(beamrate_march_tip(march, NULL));
    REFUSES(beamrate_study_cell(study, 0, 0, NULL));
    /* indices and enums */
    REFUSES(beamrate_study_cell(study, 1, 0, &cell));
    REFUSES(beamrate_study_cell(study, 0, SIZE_MAX, &cell));
    REFUSES(beamrate_study_fit(study, (enum beamrate_part) - 1, &fit));
    REFUSES(beamrate_march_get(march, (enum beamrate_field)2, room, room));
    assert_int_equal(beamrate_orders_line(orders, (enum beamrate_axis)2, &order), 0);
    assert_int_equal(beamrate_orders_answer(orders, 0, (enum beamrate_axis)2, &answer), 0);
    assert_int_equal(beamrate_orders_answer(orders, 0, BEAMRATE_SPACE, NULL), 0);
    assert_int_equal(beamrate_orders_point(orders, SIZE_MAX, BEAMRATE_SPACE, 0, &point), 0);
    ENDS(beamrate_orders_report(orders, NULL, &failure), BEAMRATE_BAD_INPUT, "json: found NULL");
    expected.axis = (enum beamrate_axis) - 1;
    ENDS(beamrate_orders_check(&check, orders, &expected, 1, &failure), BEAMRATE_BAD_INPUT,
         "expectation 0: axis: found -1");
    ENDS(beamrate_orders_check(&check, orders, &expected, 0, &failure), BEAMRATE_BAD_INPUT,
         "expectations: found none");
    beamrate_orders_free(orders);
    /* numbers */
    ENDS(beamrate_orders_find(&orders, NULL, &failure), BEAMRATE_BAD_INPUT, "numbers: found NULL");
    numbers.formal = NAN;
    ENDS(beamrate_orders_find(&orders, &numbers, &failure), BEAMRATE_BAD_INPUT,
         "formal: found nan");
    numbers.formal = -1;
    ENDS(beamrate_orders_find(&orders, &numbers, &failure), BEAMRATE_BAD_INPUT, "formal: found -1");
    beamrate_study_free(study);
    beamrate_march_free(march);
    beamrate_scene_free(scene);
}

/* ---- threads and memory ---- */

/* What a thread does: a march, whose scheme may search for switches with GSL, a study of the same
 * scene, and a scene of its own that is refused. */
struct job {
    const struct beamrate_scene *scene;
    const char *const *method;
    size_t n;
    struct beamrate_tip tip;
    struct beamrate_fit fit;
    struct beamrate_estimate expected;
    struct beamrate_error refusal;
    enum beamrate_status status;
};

static void *march_and_study(void *self)
{
    struct job *job = self;
    struct beamrate_march *march;
    struct beamrate_study *study;
    struct beamrate_scene *wrong;
    struct beamrate_forecast forecast;
    const struct beamrate_study_request request = {
        .n = meshes, .n_count = 2, .steps = times, .steps_count = 3, .threads = 1};
    char text[1000];
    job->status = beamrate_march_create(&march, job->scene, job->n, 50, job->method, NULL);
    for (int i = 0; i < 50 && !job->status; i++)
        job->status = beamrate_march_step(march, 1, NULL);
    if (!job->status)
        beamrate_march_tip(march, &job->tip);
    beamrate_march_free(march);
    if (!job->status)
        job->status = beamrate_study_run(&study, job->scene, &request, NULL);
    if (!job->status)
        job->status = beamrate_foresee(job->scene, 8, 16, NULL, &forecast, NULL);
    if (!job->status) {
        job->expected = forecast.error[BEAMRATE_BENDING];
        beamrate_study_fit(study, BEAMRATE_TOTAL, &job->fit);
        beamrate_study_free(study);
    }
    snprintf(text, sizeof text, verified, "1 +- 0.1\n    l3: 1 +- 0.1");
    beamrate_scene_parse(&wrong, "wrong", text, &job->refusal);
    return NULL;
}

TEST(threads_do_not_disturb_each_other)
{
    static const char *const adaptive[] = {"scheme", "adaptive", NULL};
    struct beamrate_scene *one = opened("example2"), *other = opened("release");
    struct job alone[4] = {{.scene = one, .method = adaptive, .n = 8},
                           {.scene = one, .method = adaptive, .n = 9},
                           {.scene = other, .method = adaptive, .n = 10},
                           {.scene = one, .n = 11}};
    struct job together[4];
    pthread_t thread[4];
    gsl_error_handler_t *const handler = gsl_set_error_handler(fatal);
    memcpy(together, alone, sizeof together);
    for (int i = 0; i < 4; i++)
        march_and_study(&alone[i]);
    for (int i = 0; i < 4; i++)
        assert_int_equal(pthread_create(&thread[i], NULL, march_and_study, &together[i]), 0);
    for (int i = 0; i < 4; i++)
        assert_int_equal(pthread_join(thread[i], NULL), 0);
    assert_true(gsl_set_error_handler(handler) == fatal);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(together[i].status, BEAMRATE_OK);
        assert_true(alone[i].tip.displacement[1] != 0);
        assert_memory_equal(&alone[i].tip, &together[i].tip, sizeof alone[i].tip);
        assert_memory_equal(&alone[i].expected, &together[i].expected, sizeof alone[i].expected);
        assert_memory_equal(&alone[i].fit, &together[i].fit, sizeof alone[i].fit);
        assert_non_null(strstr(together[i].refusal.message, "wrong:14: l3: unknown key in verify"));
        assert_string_equal(alone[i].refusal.message, together[i].refusal.message);
    }
    beamrate_scene_free(one);
    beamrate_scene_free(other);
}

/* Everything once. */
static enum br_status use_all(const void *data, struct br_error *err)
{
    struct beamrate_error *e = &failure;
    struct beamrate_scene *scene = NULL;
    struct beamrate_march *march = NULL;
    struct beamrate_study *study = NULL;
    struct beamrate_check *check = NULL;
    struct beamrate_orders *orders = NULL;
    const char *json;
    static const double h[] = {4, 2, 1}, error[] = {16, 4, 1};
    const struct beamrate_numbers numbers = {.h = h, .number = error, .count = 3};
    const struct beamrate_expectation expected = {BEAMRATE_SPACE, 2, 0.1, 0};
    const struct beamrate_study_request request = {
        .n = meshes, .n_count = 1, .steps = times, .steps_count = 1, .threads = 1};
    if (!beamrate_scene_parse(&scene, "rod", data, e) &&
        !beamrate_march_create(&march, scene, 4, 8, NULL, e) && !beamrate_march_step(march, 8, e) &&
        !beamrate_study_run(&study, scene, &request, e) &&
        !beamrate_orders_find(&orders, &numbers, e) &&
        !beamrate_orders_check(&check, orders, &expected, 1, e))
        beamrate_orders_report(orders, &json, e);
    beamrate_check_free(check);
    beamrate_orders_free(orders);
    beamrate_study_free(study);
    beamrate_march_free(march);
    beamrate_scene_free(scene);
    if (e->status == BEAMRATE_OK)
        return BR_OK;
    return br_fail(err, e->status == BEAMRATE_NO_MEMORY ? BR_NO_MEMORY : BR_VERDICT, "%s",
                   e->message);
}

/* A manufactured solution, whose judge allocates little. */
TEST(memory_may_end_at_any_place)
{
    static const char text[] = "title: a rod\nlength: 1 m\nduration: 1 s\ndensity: 1 kg/m\n"
                               "axial:\n  stiffness: 10 N\n  viscosity: 1 N s\n"
                               "  solution: x^2*t [m]\n";
    br_test_without_memory(use_all, text, 60);
}
