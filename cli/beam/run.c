/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate run SCENE: marches one scene. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "cli/beam/session.h"
#include "cli/beam/study_request.h"
#include "cli/command.h"
#include "cli/progress.h"
#include "plots/beam/pictures.h"
#include "study/estimate/prediction.h"
#include "study/ranks/ranks.h"
#include "study/run/run.h"
#include "study/scene/method_fields.h"
#include "tables/beam/fields_file.h"
#include "tables/beam/reports.h"

/* The march that the options ask for. */
struct run_plan {
    struct br_opened_scene opened;
    struct br_scene marched;       /* borrows from `opened` */
    struct br_run_request request; /* without outputs */
    size_t *level;                 /* the request's levels; owned */
};

/* ---- times ---- */

/* The time level (out) at t, s. */
static enum br_status read_level(double t, const struct br_scene *scene, size_t steps,
                                 size_t *level, struct br_error *err)
{
    const double T = scene->duration, position = t / T * (double)steps;
    if (!(t >= 0 && t <= T))
        return br_fail(err, BR_BAD_INPUT, "--at: found %g s, expected a time of [0, %g] s", t, T);
    const double nearest = round(position);
    *level = (size_t)nearest;
    if (fabs(position - nearest) <= 1e-6)
        return BR_OK;
    const double below = floor(position);
    return br_fail(
        err, BR_BAD_INPUT,
        "--at: found %.10g s, expected a multiple of k = %g s; the nearest are %.15g s and %.15g s",
        t, T / (double)steps, T * below / (double)steps, T * (below + 1) / (double)steps);
}

static enum br_status read_times(const char *text, struct run_plan *plan, struct br_error *err)
{
    struct br_run_request *q = &plan->request;
    struct br_error inner = {0};
    if (br_times_check(text, &inner))
        return br_fail(err, BR_BAD_INPUT, "--at: %s", inner.message);
    for (const char *rest = text; rest; rest = *rest ? rest + 1 : NULL) {
        double t;
        const char *end = br_read_time(rest, q->scene->duration, &t);
        if (!end)
            return br_fail(err, BR_BAD_INPUT,
                           "--at: found '%s', expected times separated by commas, like 0.1,0.5, or "
                           "'every:TIME'",
                           rest);
        if (read_level(t, q->scene, q->steps, &plan->level[q->levels++], err))
            return err->status;
        rest = end;
    }
    br_sort_counts(plan->level, q->levels);
    for (size_t i = 1; i < q->levels; i++)
        if (plan->level[i] == plan->level[i - 1])
            return br_fail(err, BR_BAD_INPUT, "--at: %g s is given twice",
                           q->scene->duration * (double)plan->level[i] / (double)q->steps);
    return BR_OK;
}

/* The steps (out) between two times of 'every:TIME'. */
static enum br_status read_every(const char *text, const struct br_run_request *q, size_t *interval,
                                 struct br_error *err)
{
    double t;
    const char *end = br_read_time(text, q->scene->duration, &t);
    if (!end || *end || !(t > 0))
        return br_fail(err, BR_BAD_INPUT,
                       "--at: found 'every:%s', expected a time above 0, like every:0.1", text);
    if (read_level(t, q->scene, q->steps, interval, err))
        return err->status;
    return *interval ? BR_OK
                     : br_fail(err, BR_BAD_INPUT,
                               "--at: found 'every:%s', expected a multiple of k = %g s", text,
                               q->scene->duration / (double)q->steps);
}

/* By default ten intervals of about the same length, whatever the number of steps. */
static enum br_status make_levels(struct run_plan *plan, const struct br_options *o,
                                  struct br_error *err)
{
    enum { PARTS = 10 };
    static const char word[] = "every:";
    struct br_run_request *q = &plan->request;
    const char *at = br_option_text(o, BR_OPT_AT);
    const bool every = at && strncmp(at, word, strlen(word)) == 0;
    size_t room = at ? strlen(at) + 1 : PARTS + 1, interval = 1;
    if (at && !br_option_given(o, BR_OPT_OUT))
        return br_fail(err, BR_BAD_INPUT, "--at needs --out, the folder for the fields");
    if (every && read_every(at + strlen(word), q, &interval, err))
        return err->status;
    if (every)
        room = q->steps / interval + 1;
    q->level = plan->level = br_allocate(room, sizeof *plan->level);
    if (!plan->level)
        return br_no_memory(err, "the output times");
    if (at && !every)
        return read_times(at, plan, err);
    for (size_t i = 0; i < room && br_option_given(o, BR_OPT_OUT); i++) {
        const size_t level =
            every ? i * interval
                  : (size_t)llround((double)q->steps * (double)i / PARTS); /* exact below 2^49 */
        if (q->levels == 0 || level > plan->level[q->levels - 1])
            plan->level[q->levels++] = level;
    }
    return BR_OK;
}

/* ---- the plan ---- */

static enum br_status read_fields(const char *text, unsigned *wanted, struct br_error *err)
{
    static const struct {
        const char *name;
        unsigned bits;
    } names[] = {{"axial", BR_WANT_AXIAL},
                 {"bending", BR_WANT_BENDING},
                 {"axial,bending", BR_WANT_AXIAL | BR_WANT_BENDING},
                 {"bending,axial", BR_WANT_AXIAL | BR_WANT_BENDING}};
    *wanted = 0;
    for (size_t i = 0; text && i < sizeof names / sizeof *names; i++)
        if (strcmp(text, names[i].name) == 0)
            *wanted = names[i].bits;
    if (text && !*wanted)
        return br_fail(err, BR_BAD_INPUT,
                       "--fields: found '%s', expected axial, bending or axial,bending", text);
    return BR_OK;
}

/* Checks the options against the open scene; clear the plan even after a failure. */
static enum br_status make_plan(struct run_plan *plan, const struct br_options *o,
                                struct br_error *err)
{
    const char *const *given = &o->given[BR_OPT_METHOD];
    struct br_run_request *q = &plan->request;
    const struct br_method *const methods[] = {&q->method};
    *q = (struct br_run_request){
        .scene = &plan->opened.scene,
        .method = br_method_default(),
        .n = (size_t)br_option_number(o, BR_OPT_N, 0),
        .check = br_option_given(o, BR_OPT_CHECK),
    };
    if (br_method_read(given, BR_METHOD_OPTION, &q->method, err) ||
        br_method_check_used(given, BR_METHOD_OPTION, methods, 1, err) ||
        read_fields(br_option_text(o, BR_OPT_FIELDS), &q->wanted, err) ||
        br_read_step("--k", br_option_text(o, BR_OPT_K), q->scene, &q->steps, err) ||
        make_levels(plan, o, err) || br_model_select(q->scene, q->wanted, &plan->marched, err))
        return err->status;
    if (br_option_given(o, BR_OPT_OUT))
        q->stride = br_history_stride(q->steps, (size_t)br_option_number(o, BR_OPT_ROWS, 0));
    return q->method.axial_degree == 1 || plan->marched.axial.modelled
               ? BR_OK
               : br_fail(err, BR_BAD_INPUT, "--axial-degree: no axial field is marched");
}

static void clear_plan(struct run_plan *plan)
{
    free(plan->level);
    br_opened_scene_clear(&plan->opened);
}

/* ---- the run ---- */

/* The files of --out that are written while it marches. */
enum { HISTORY, FIELDS_CSV, FIELDS_XDMF, FILES };
enum { PICTURE_ROWS = 2000 };
static const char *const file_names[] = {"history.csv", "fields.csv", "fields.xdmf"};

struct scene_run {
    const struct br_options *options; /* borrowed */
    struct br_session *session;       /* borrowed */
    const char *out, *json;           /* paths of these options; NULL: not given */
    struct run_plan plan;
    struct br_prediction prediction;
    struct br_warnings warnings;
    struct br_run_report report;
    struct br_provenance provenance;
    struct br_whole_file summary; /* of --json */
    FILE *file[FILES];            /* this and the next one: of --out */
    struct br_fields_file fields;
    size_t picture_stride; /* steps between rows of the picture of the tip; 0: none is drawn */
    struct br_history_record record;
    struct br_history_observer recorder; /* writes into the record */
};

/* ---- the files of --out ---- */

static enum br_status open_results(struct scene_run *r, struct br_error *err)
{
    enum br_status status = br_session_open(r->session, err);
    for (int i = 0; i < FILES && !status; i++)
        status = br_output_file(&r->session->output, file_names[i], &r->file[i], err);
    if (status)
        return status;
    br_history_csv_head(r->file[HISTORY]);
    r->fields = (struct br_fields_file){
        .csv = r->file[FIELDS_CSV],
        .xdmf = r->file[FIELDS_XDMF],
        .scene = &r->plan.marched,
        .n = r->plan.request.n,
        .axial_degree = r->plan.request.method.axial_degree,
    };
    return br_fields_begin(&r->fields, &r->provenance, err);
}

/* Fails where a write to one of the files did. */
static enum br_status check_files(const struct scene_run *r, struct br_error *err)
{
    for (int i = 0; i < FILES; i++)
        if (ferror(r->file[i]))
            return br_fail(err, BR_IO, "%s could not be written", file_names[i]);
    return BR_OK;
}

/* A quantity that is not modelled is an empty field, not a zero. */
static enum br_status write_row(void *self, const struct br_history_row *row, struct br_error *err)
{
    struct scene_run *r = self;
    struct br_history_row known = *row;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        if (!r->plan.marched.field[kind].modelled)
            known.displacement[kind] = known.velocity[kind] = NAN;
    if (!r->plan.marched.contact.modelled)
        known.contact_force = NAN;
    if (r->plan.marched.friction.law == BR_FRICTIONLESS)
        known.friction_force = known.friction_bound = NAN;
    br_history_csv_row(r->file[HISTORY], &known);
    return check_files(r, err);
}

static enum br_status write_sample(void *self, const struct br_march *march,
                                   const struct br_history_row *row, struct br_error *err)
{
    struct scene_run *r = self;
    br_fields_add(&r->fields, march, row);
    return check_files(r, err);
}

/* Keeps a row of the picture; the beam's end, which a step does not fill, is asked for. */
static enum br_status keep_row(void *self, const struct br_march *march,
                               const struct br_history_row *row, struct br_error *err)
{
    struct scene_run *r = self;
    if (row->step % r->picture_stride && row->step != r->plan.request.steps)
        return BR_OK;
    struct br_history_row whole = *row;
    whole.displacement[BR_BENDING] = br_march_tip_displacement(march, BR_BENDING);
    return r->recorder.row(r->recorder.self, &whole, err);
}

/* stopped: why the march did not reach T; NULL: it did. */
static enum br_status close_results(struct scene_run *r, const char *stopped, struct br_error *err)
{
    enum br_status status = BR_OK;
    if (r->file[HISTORY] && stopped)
        br_history_csv_stopped(r->file[HISTORY], stopped);
    br_fields_end(&r->fields, stopped);
    for (int i = 0; i < FILES; i++) {
        if (r->file[i] && br_output_close(r->file[i], file_names[i], status ? NULL : err))
            status = BR_IO;
        r->file[i] = NULL;
    }
    return status;
}

/* Results are put in place even if the march stopped early. */
static enum br_status write_results(struct scene_run *r, const char *stopped, struct br_error *err)
{
    static const struct br_document_format *const formats[] = {&br_document_text, &br_document_json,
                                                               &br_document_html, NULL};
    const bool failed =
        close_results(r, stopped, err) || br_session_write(r->session, formats, err);
    return failed ? err->status : BR_OK;
}

/* ---- before the march ---- */

/* One output must not replace another, or a scene. */
static enum br_status check_places(const struct scene_run *r, struct br_error *err)
{
    if (br_whole_file_meets(&r->summary, r->plan.opened.path))
        return br_fail(err, BR_BAD_INPUT, "--json would replace the scene %s", r->summary.path);
    if (r->out && br_whole_file_meets(&r->summary, r->out))
        return br_fail(err, BR_BAD_INPUT,
                       "--json: found '%s', expected a place outside of the folder of --out, which "
                       "has a summary.json of its own",
                       r->json);
    return BR_OK;
}

static enum br_status open_files(struct scene_run *r, struct br_error *err)
{
    r->provenance = br_provenance_of(&r->plan.opened, 1);
    r->recorder = br_history_recorder(&r->record, r->plan.request.n);
    if (r->out && !br_option_given(r->options, BR_OPT_NO_PLOTS))
        r->picture_stride = br_history_stride(r->plan.request.steps, PICTURE_ROWS);
    const bool failed = br_whole_file_open(&r->summary, "json", r->json, err) ||
                        check_places(r, err) || (r->out && open_results(r, err));
    return failed ? err->status : BR_OK;
}

/* Finds the warnings and the prediction, too. */
static enum br_status prepare(struct scene_run *r, struct br_error *err)
{
    const struct br_run_request *q = &r->plan.request;
    if (br_opened_scene_read(&r->plan.opened, r->session, r->options->word[0], err) ||
        make_plan(&r->plan, r->options, err))
        return err->status;
    struct br_costs work = {.alone = true};
    struct br_planned_march march =
        br_planned(&r->plan.marched, &q->method, (struct br_resolution){q->n, q->steps});
    march.prediction = &r->prediction;
    if (br_check_ahead(&march, &r->warnings, err) || open_files(r, err))
        return err->status;
    br_print_warnings("", &r->warnings);
    br_costs_add_march(&work, &march);
    br_session_announce(r->session, &work);
    return BR_OK;
}

/* ---- the march and its report ---- */

static enum br_status march(struct scene_run *r, struct br_error *err)
{
    struct br_history_observer output[2];
    size_t outputs = 0;
    if (r->out)
        output[outputs++] =
            (struct br_history_observer){.self = r, .row = write_row, .sample = write_sample};
    if (r->picture_stride)
        output[outputs++] = (struct br_history_observer){.self = r, .step = keep_row};
    struct br_run_request request = r->plan.request;
    request.output = output;
    request.outputs = outputs;
    request.progress = br_progress_start("marching", r->session->quiet);
    const enum br_status status = br_run(&request, &r->report, err);
    br_progress_end();
    return status;
}

/* A summary on standard output replaces the report there. It is printed before files are written,
 * so that a full disk cannot hide the results. */
static enum br_status write_all(struct scene_run *r, double start, struct br_error *err)
{
    const struct br_error *failure = &r->report.failure;
    const char *stopped = failure->status ? failure->message : NULL;
    FILE *summary = r->summary.file, *terminal = summary == stdout ? NULL : stdout;
    const struct br_run_findings findings = {
        .report = &r->report,
        .prediction = &r->prediction,
        .warnings = &r->warnings,
        .provenance = &r->provenance,
        .wall_seconds = br_seconds() - start,
    };
    if (br_session_report(r->session, 1, err))
        return err->status;
    struct br_document *d = r->session->document;
    br_report_run(&findings, d);
    if (r->record.rows > 1)
        br_session_draw(r->session, d, br_history_draw(&r->plan.opened.scene, &r->record), NULL);
    const bool failed = (summary && br_document_print(summary, &br_document_json, d, NULL, err)) ||
                        (terminal && !r->session->quiet && br_document_show(terminal, d, 1, err)) ||
                        (r->out && write_results(r, stopped, err)) ||
                        br_whole_file_commit(&r->summary, err);
    return failed ? err->status : BR_OK;
}

/* Fails if the march stopped or a step exceeds its certificate's limits. Results are kept. */
static enum br_status conclude(const struct scene_run *r, struct br_error *err)
{
    const struct br_run_report *p = &r->report;
    if (p->failure.status)
        return br_fail(err, p->failure.status, "%.1000s", p->failure.message);
    if (p->bad_steps)
        return br_fail(err, BR_VERDICT, "%zu of %zu steps are beyond the certificate's limits: %s",
                       p->bad_steps, p->steps, p->verdict.message);
    return BR_OK;
}

/* ---- the command ---- */

static enum br_status run(const struct br_options *options, struct br_session *session,
                          struct br_error *err)
{
    static struct scene_run r;
    const double start = br_seconds();
    if (!br_ranks_first())
        return BR_OK; /* one rank does a single march */
    r = (struct scene_run){.options = options,
                           .session = session,
                           .out = br_option_text(options, BR_OPT_OUT),
                           .json = br_option_text(options, BR_OPT_JSON)};
    const bool failed =
        prepare(&r, err) || march(&r, err) || write_all(&r, start, err) || conclude(&r, err);
    close_results(&r, NULL, NULL);
    br_history_record_clear(&r.record);
    br_whole_file_discard(&r.summary);
    clear_plan(&r.plan);
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
    .example = {"run example3", "run example2 -n 400 -k 1e-4 --check",
                "run example2 --set 'contact.stiffness=2e3 N/m' --set 'length=500 mm'",
                "run example1 --at 0.5,T --out results --json -"},
    .least_words = 1,
    .most_words = 1,
    .run = run,
};
