/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate run SCENE: marches one scene. */
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
static enum br_status prepare(struct run *r, struct br_error *err)
{
    struct br_scene *scene = &r->opened.scene;
    const struct br_options *o = r->session.options;
    if (br_opened_scene_read(&r->opened, o->word[0], err) ||
        br_run_plan_make(o, scene, &r->plan, err) ||
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
    if (br_look_ahead(&planned, &r->warnings, err) || open_files(r, err))
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

static enum br_status run(const struct br_options *options, struct br_error *err)
{
    static struct run r;
    const double start = br_seconds();
    if (!br_ranks_first())
        return BR_OK; /* one march is the work of one rank */
    r = (struct run){.session = br_session_begin(options),
                     .out = br_option_text(options, BR_OPT_OUT),
                     .json = br_option_text(options, BR_OPT_JSON),
                     .animate = br_option_text(options, BR_OPT_ANIMATE)};
    const bool failed =
        prepare(&r, err) || march(&r, err) || write_all(&r, start, err) || conclude(&r, err);
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
                "beamrate run example1 --at 0.5,T --out results --json -"},
    .least_words = 1,
    .most_words = 1,
    .run = run,
};
