/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate run SCENE: marches one scene. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/pictures.h"
#include "cli/progress.h"
#include "cli/run.h"
#include "cli/session.h"
#include "cli/warn.h"
#include "solver/clock.h"
#include "study/ranks/ranks.h"

struct run {
    struct br_session session;
    const char *out, *json, *animate; /* files and folders of the options; NULL: not given */
    struct br_run_plan plan;
    struct br_opened_scene opened;
    struct br_scene marched; /* borrows from that */
    struct br_prediction prediction;
    struct br_warnings warnings;
    struct br_run_report report;
    struct br_provenance provenance;
    struct br_whole_file summary; /* of --json */
    struct br_run_files files;
    struct br_pictures pictures;
};

/* Whether two files have one name but for what follows its last dot. */
static bool same_stem(const char *a, const char *b)
{
    const char *x = strrchr(a, '/') ? strrchr(a, '/') + 1 : a;
    const char *y = strrchr(b, '/') ? strrchr(b, '/') + 1 : b;
    const size_t m = strrchr(x, '.') ? (size_t)(strrchr(x, '.') - x) : strlen(x);
    const size_t n = strrchr(y, '.') ? (size_t)(strrchr(y, '.') - y) : strlen(y);
    return m == n && strncmp(x, y, n) == 0;
}

/* One output must not replace another, or a scene. */
static enum br_status check_places(const struct run *r, struct br_error *err)
{
    const char *slash = r->animate ? strrchr(r->animate, '/') : NULL;
    char folder[1024] = ".";
    if (br_whole_file_replaces(&r->summary, r->opened.path))
        return br_fail(err, BR_BAD_INPUT, "--json would replace the scene %s", r->summary.path);
    if (r->out && br_whole_file_is_in(&r->summary, r->out))
        return br_fail(err, BR_BAD_INPUT,
                       "--json: found '%s', expected a place outside of the folder of --out, which "
                       "has a summary.json of its own",
                       r->json);
    if (slash)
        snprintf(folder, sizeof folder, "%.*s", (int)(slash - r->animate + 1), r->animate);
    if (r->animate &&
        (br_whole_file_is_in(&r->summary, r->animate) ||
         (br_whole_file_is_in(&r->summary, folder) && same_stem(r->json, r->animate))))
        return br_fail(err, BR_BAD_INPUT,
                       "--json: found '%s', which --animate %s writes too, expected another name",
                       r->json, r->animate);
    return BR_OK;
}

static enum br_status open_files(struct run *r, struct br_error *err)
{
    r->provenance = br_provenance_of(&r->opened, 1);
    const struct br_pictures_request pictures = {
        .animate = r->animate,
        .quiet = r->session.quiet,
        .plot = br_option_given(r->session.options, BR_OPT_PLOT),
        .scene = &r->opened.scene,
        .n = r->plan.n,
        .steps = r->plan.steps,
    };
    const struct br_fields_request fields = {
        .scene = &r->marched,
        .n = r->plan.n,
        .steps = r->plan.steps,
        .looks = r->plan.levels,
        .axial_degree = r->plan.method.axial_degree,
        .provenance = &r->provenance,
    };
    const bool failed = br_whole_file_open(&r->summary, "json", r->json, err) ||
                        check_places(r, err) || br_pictures_open(&r->pictures, &pictures, err) ||
                        (r->out && br_run_files_open(&r->files, r->out, &fields, err));
    return failed ? err->status : BR_OK;
}

/* What is to be marched, and what is to be expected of it, before anything of it is there. */
static enum br_status look_at_march(struct run *r, struct br_error *err)
{
    struct br_scene *scene = &r->opened.scene;
    if (br_run_plan_make(r->session.options, scene, &r->plan, err) ||
        br_model_select(scene, r->plan.wanted, &r->marched, err))
        return err->status;
    if (r->plan.method.axial_degree != 1 && !r->marched.axial.modelled)
        return br_fail(err, BR_BAD_INPUT, "--axial-degree: no axial field is marched");
    const struct br_planned_march planned = {
        .scene = &r->marched,
        .method = &r->plan.method,
        .n = r->plan.n,
        .steps = r->plan.steps,
        .prediction = &r->prediction,
    };
    return br_look_ahead(&planned, &r->warnings, err);
}

static enum br_status prepare(struct run *r, struct br_error *err)
{
    if (br_opened_scene_read(&r->opened, r->session.options->word[0], err) ||
        look_at_march(r, err) || open_files(r, err))
        return err->status;
    br_print_warnings("", &r->warnings);
    return BR_OK;
}

static enum br_status march(struct run *r, struct br_error *err)
{
    const struct br_options *o = r->session.options;
    struct br_history_observer output[2];
    size_t outputs = 0;
    if (r->out)
        output[outputs++] = br_run_files_observer(&r->files);
    if (r->animate || br_option_given(o, BR_OPT_PLOT))
        output[outputs++] = br_pictures_observer(&r->pictures);
    const struct br_run_request request = {
        .scene = &r->opened.scene,
        .wanted = r->plan.wanted,
        .method = r->plan.method,
        .n = r->plan.n,
        .steps = r->plan.steps,
        .stride = r->plan.stride,
        .level = r->plan.level,
        .levels = r->plan.levels,
        .check = br_option_given(o, BR_OPT_CHECK),
        .energies = br_option_given(o, BR_OPT_ENERGIES),
        .explain = br_option_given(o, BR_OPT_EXPLAIN),
        .output = output,
        .outputs = outputs,
        .progress = br_progress_start("marching", r->session.quiet),
    };
    const enum br_status status = br_run(&request, &r->report, err);
    br_progress_end();
    return status;
}

/* A summary on standard output stands there alone. It is shown first: a disk that is full must not
 * hide what was computed. */
static enum br_status write_all(struct run *r, double start, struct br_error *err)
{
    const struct br_error *failure = &r->report.failure;
    const char *stopped = failure->status ? failure->message : NULL;
    FILE *summary = r->summary.file, *terminal = summary == stdout ? NULL : stdout;
    struct br_document d = {0};
    const struct br_run_findings findings = {
        .report = &r->report,
        .prediction = &r->prediction,
        .warnings = &r->warnings,
        .provenance = &r->provenance,
        .wall_seconds = br_seconds() - start,
    };
    br_report_run(&findings, &d);
    const bool failed = (summary && br_document_print(summary, &br_document_json, &d, NULL, err)) ||
                        (terminal && !r->session.quiet && br_document_show(terminal, &d, err)) ||
                        (r->out && br_run_files_commit(&r->files, &d, stopped, err)) ||
                        br_whole_file_commit(&r->summary, err) ||
                        br_pictures_finish(&r->pictures, terminal, err);
    br_document_clear(&d);
    return failed ? err->status : BR_OK;
}

/* Results are kept also where the march stopped, or a step is beyond its certificate's limits. */
static enum br_status conclude(const struct run *r, struct br_error *err)
{
    const struct br_run_report *p = &r->report;
    if (p->failure.status)
        return br_fail(err, p->failure.status, "%.1000s", p->failure.message);
    if (p->bad_steps)
        return br_fail(err, BR_VERDICT, "%zu of %zu steps are beyond the certificate's limits: %s",
                       p->bad_steps, p->steps, p->verdict.message);
    return BR_OK;
}

/* ---- what would be run ---- */

static enum br_status foresee(const struct br_session *session,
                              const struct br_opened_scene *opened, size_t count,
                              struct br_error *err)
{
    struct br_foreseen work = {.alone = true};
    struct br_scene *marched = br_allocate(count, sizeof *marched);
    enum br_status status = marched ? BR_OK : br_no_memory(err, "the scenes");
    for (size_t i = 0; i < count && !status; i++) {
        struct br_run_plan plan = {0};
        status = br_run_plan_make(session->options, &opened[i].scene, &plan, err);
        if (!status)
            status = br_model_select(&opened[i].scene, plan.wanted, &marched[i], err);
        if (!status)
            br_foreseen_add_march(&work, &(struct br_planned_march){.scene = &marched[i],
                                                                    .method = &plan.method,
                                                                    .n = plan.n,
                                                                    .steps = plan.steps});
        br_run_plan_clear(&plan);
    }
    if (!status)
        status = br_session_foresee(session, &work, err);
    br_foreseen_clear(&work);
    free(marched);
    return status;
}

/* ---- a parameter that varies ---- */

enum {
    TIP,
    TIP_ERROR = TIP + 2,
    CONTACT_FORCE = TIP_ERROR + 2,
    FRICTION_FORCE,
    EVENTS,
    BAD_STEPS = EVENTS + BR_TIP_EVENTS,
    SWEPT
};

struct varied_run {
    struct br_session session;
    struct br_opened_scene base;
    struct br_varied varied;
    struct br_opened_scene *point; /* points, of each value; owned */
    size_t points;
    struct br_variation found;
    struct br_variation_column column[SWEPT];
};

static void name_columns(struct br_variation_column column[SWEPT])
{
    static const char tip[] = "tip at t = T (m)", forces[] = "largest forces at the tip (N)";
    column[TIP + BR_AXIAL] =
        (struct br_variation_column){"tip_axial", "u(L, T)", "m", "%.6g", .axis = tip};
    column[TIP + BR_BENDING] =
        (struct br_variation_column){"tip_bending", "w(L, T)", "m", "%.6g", .axis = tip};
    column[TIP_ERROR + BR_AXIAL] = (struct br_variation_column){
        "predicted_error_axial", "predicted error of u", "m", "%.1e", .axis = NULL};
    column[TIP_ERROR + BR_BENDING] = (struct br_variation_column){
        "predicted_error_bending", "predicted error of w", "m", "%.1e", .axis = NULL};
    column[CONTACT_FORCE] = (struct br_variation_column){
        "largest_contact_force", "largest contact force", "N", "%.5g", .axis = forces};
    column[FRICTION_FORCE] = (struct br_variation_column){
        "largest_friction_force", "largest friction force", "N", "%.5g", .axis = forces};
    for (int kind = 0; kind < BR_TIP_EVENTS; kind++) {
        const char *word = br_tip_event_word((enum br_tip_event_kind)kind);
        column[EVENTS + kind] = (struct br_variation_column){word, word, .format = "%.0f"};
    }
    column[BAD_STEPS] = (struct br_variation_column){"bad_steps", "bad steps", .format = "%.0f"};
}

static void take_point(const struct br_run_report *p, const struct br_prediction *prediction,
                       double *value)
{
    const bool modelled[] = {p->marched.axial.modelled, p->marched.bending.modelled};
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const double error =
            br_predicted_tip(prediction, (enum br_field_kind)kind, p->scene->length);
        value[TIP + kind] = modelled[kind] ? p->end.last.displacement[kind] : (double)NAN;
        value[TIP_ERROR + kind] = modelled[kind] && prediction->known ? error : (double)NAN;
    }
    for (int kind = 0; kind < BR_TIP_EVENTS; kind++)
        value[EVENTS + kind] = (double)p->watch.count[kind];
    if (p->marched.contact.modelled)
        value[CONTACT_FORCE] = p->watch.contact_force.value;
    if (p->marched.friction.law != BR_FRICTIONLESS)
        value[FRICTION_FORCE] = p->watch.friction_force.value;
    if (p->checked)
        value[BAD_STEPS] = (double)p->bad_steps;
}

/* What is of one march alone. */
static enum br_status check_swept(const struct br_options *o, struct br_error *err)
{
    static const enum br_option_id single[] = {BR_OPT_AT,     BR_OPT_EVERY,   BR_OPT_ROWS,
                                               BR_OPT_PLOT,   BR_OPT_ANIMATE, BR_OPT_JSON,
                                               BR_OPT_EXPLAIN};
    static const char *const names[] = {"at",      "every", "rows",   "plot",
                                        "animate", "json",  "explain"};
    for (size_t i = 0; i < sizeof single / sizeof *single; i++)
        if (br_option_given(o, single[i]))
            return br_fail(err, BR_BAD_INPUT,
                           "--%s: it is of one march: --vary does not heed it; --out has what is "
                           "found at all values",
                           names[i]);
    return BR_OK;
}

/* All scenes, so that what is refused is refused before anything marches. */
static enum br_status prepare_values(struct varied_run *w, struct br_error *err)
{
    const struct br_options *o = w->session.options;
    char text[BR_VARIED_TEXT];
    if (check_swept(o, err) || br_opened_scene_read(&w->base, o->word[0], err) ||
        br_varied_read(br_option_text(o, BR_OPT_VARY), &w->varied, err))
        return err->status;
    if (!(w->point = br_allocate(w->varied.count, sizeof *w->point)))
        return br_no_memory(err, "the scenes");
    while (w->points < w->varied.count) {
        struct br_run_plan plan = {0};
        struct br_opened_scene *point = &w->point[w->points++];
        const bool failed = br_opened_scene_vary(point, &w->base, &w->varied, w->points - 1, err) ||
                            br_run_plan_make(o, &point->scene, &plan, err);
        br_run_plan_clear(&plan);
        if (failed)
            return br_failed_in(err, br_varied_text(&w->varied, w->points - 1, text));
    }
    name_columns(w->column);
    w->found = (struct br_variation){.varied = &w->varied,
                                     .format = "beamrate run variation",
                                     .column = w->column,
                                     .columns = SWEPT};
    return br_variation_create(&w->found, &w->base.scene, err);
}

/* One march as of `run` alone, without files; the static part is large. */
static enum br_status march_point(struct varied_run *w, size_t i, struct br_error *err)
{
    static struct run r;
    struct br_error *failure = &w->found.failure[i];
    char text[BR_VARIED_TEXT];
    r = (struct run){.session = w->session, .opened = w->point[i]};
    r.session.quiet = true;
    if (look_at_march(&r, failure)) {
        br_run_plan_clear(&r.plan);
        return failure->status == BR_BAD_INPUT
                   ? BR_OK
                   : br_fail(err, failure->status, "%s", failure->message);
    }
    br_print_warnings(br_varied_text(&w->varied, i, text), &r.warnings);
    r.plan.levels = r.plan.stride = 0;
    const enum br_status status = march(&r, err);
    if (!status)
        take_point(&r.report, &r.prediction, &w->found.value[i * SWEPT]);
    w->found.unstable[i] = !status && r.report.contact_unstable;
    if (!status && (r.report.contact_unstable || !r.prediction.known))
        w->found.remark[i] = r.report.contact_unstable ? "beyond the contact's stability limit"
                                                       : "its error is not known";
    if (!status)
        conclude(&r, failure);
    br_run_plan_clear(&r.plan);
    return br_progress_result(status, err);
}

static enum br_status run_varied(const struct br_options *options, struct br_error *err)
{
    struct varied_run w = {.session = br_session_begin(options)};
    bool failed = prepare_values(&w, err);
    if (!failed && br_option_given(options, BR_OPT_DRY_RUN)) {
        failed = foresee(&w.session, w.point, w.points, err);
    } else if (!failed) {
        failed = br_session_open(&w.session, err);
        for (size_t i = 0; i < w.points && !failed; i++)
            failed = march_point(&w, i, err);
        if (!failed)
            failed = br_session_variation(&w.session, &w.found, &w.base, err);
    }
    for (size_t i = 0; i < w.points; i++)
        br_opened_scene_clear(&w.point[i]);
    free(w.point);
    br_variation_clear(&w.found);
    br_varied_clear(&w.varied);
    br_opened_scene_clear(&w.base);
    br_session_close(&w.session);
    return failed ? err->status : BR_OK;
}

static enum br_status run(const struct br_options *options, struct br_error *err)
{
    static struct run r;
    const double start = br_seconds();
    if (!br_ranks_first())
        return BR_OK; /* one march is the work of one rank */
    if (br_option_given(options, BR_OPT_VARY))
        return run_varied(options, err);
    r = (struct run){.session = br_session_begin(options),
                     .out = br_option_text(options, BR_OPT_OUT),
                     .json = br_option_text(options, BR_OPT_JSON),
                     .animate = br_option_text(options, BR_OPT_ANIMATE)};
    const bool failed =
        br_option_given(options, BR_OPT_DRY_RUN)
            ? br_opened_scene_read(&r.opened, options->word[0], err) ||
                  foresee(&r.session, &r.opened, 1, err)
            : prepare(&r, err) || march(&r, err) || write_all(&r, start, err) || conclude(&r, err);
    br_run_files_discard(&r.files);
    br_pictures_discard(&r.pictures);
    br_whole_file_discard(&r.summary);
    br_run_plan_clear(&r.plan);
    br_opened_scene_clear(&r.opened);
    return failed ? err->status : BR_OK;
}

const struct br_command br_command_run = {
    .bit = BR_FOR_RUN,
    .name = "run",
    .arguments = "SCENE",
    .title = "marches one scene: its tip, its energies, its fields",
    .about =
        "Marches one scene and says what happened at its tip: displacements, forces, when it "
        "stuck, slipped, reversed, closed and opened, energies, and what was modelled and what "
        "not.",
    .example = {"beamrate run example3", "beamrate run example2 -n 400 -k 1e-4 --check",
                "beamrate run example4 --animate example4.gif",
                "beamrate run example2 --vary 'contact.stiffness=1e2..1e6 log 9' --out sweep",
                "beamrate run example1 --at 0.5,T --out results --json -"},
    .least_words = 1,
    .most_words = 1,
    .run = run,
};
