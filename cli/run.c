/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate run SCENE: marches one scene. */
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/pictures.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/run_files.h"
#include "cli/run_plan.h"
#include "cli/warn.h"
#include "cli/output.h"
#include "solver/clock.h"
#include "study/ranks/ranks.h"
#include "study/scene/file.h"

struct run {
    const struct br_options *options;
    struct br_run_plan plan;
    char path[1024];                /* of the scene */
    char *text;                     /* of the scene's file */
    struct br_scene scene, marched; /* the latter borrows from the former */
    struct br_prediction prediction;
    struct br_warnings warnings;
    struct br_run_report report;
    struct br_provenance provenance;
    struct br_whole_file json;
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
    const char *out = br_option_text(r->options, BR_OPT_OUT),
               *json = br_option_text(r->options, BR_OPT_JSON),
               *animate = br_option_text(r->options, BR_OPT_ANIMATE);
    if (br_whole_file_replaces(&r->json, r->path))
        return br_fail(err, BR_BAD_INPUT, "--json would replace the scene %s", r->json.path);
    if (out && br_whole_file_is_in(&r->json, out))
        return br_fail(err, BR_BAD_INPUT,
                       "--json: found '%s', expected a place outside of the folder of --out, which "
                       "has a summary.json of its own",
                       json);
    const char *slash = animate ? strrchr(animate, '/') : NULL;
    char folder[1024] = ".";
    if (slash)
        snprintf(folder, sizeof folder, "%.*s", (int)(slash - animate + 1), animate);
    if (animate && (br_whole_file_is_in(&r->json, animate) ||
                    (br_whole_file_is_in(&r->json, folder) && same_stem(json, animate))))
        return br_fail(err, BR_BAD_INPUT,
                       "--json: found '%s', which --animate %s writes too, expected another name",
                       json, animate);
    return BR_OK;
}

static enum br_status open_files(struct run *r, struct br_error *err)
{
    br_provenance_fill(&r->provenance, 1);
    r->provenance.scene_path = r->path;
    r->provenance.scene_text = r->text;
    enum br_status status =
        br_whole_file_open(&r->json, "json", br_option_text(r->options, BR_OPT_JSON), err);
    if (!status)
        status = check_places(r, err);
    const struct br_pictures_request pictures = {
        .animate = br_option_text(r->options, BR_OPT_ANIMATE),
        .plot = br_option_given(r->options, BR_OPT_PLOT),
        .scene = &r->scene,
        .n = r->plan.n,
        .steps = r->plan.steps,
    };
    if (!status)
        status = br_pictures_open(&r->pictures, &pictures, err);
    if (status || !br_option_given(r->options, BR_OPT_OUT))
        return status;
    const struct br_fields_request fields = {
        .scene = &r->marched,
        .n = r->plan.n,
        .steps = r->plan.steps,
        .looks = r->plan.levels,
        .axial_degree = r->plan.method.axial_degree,
        .provenance = &r->provenance,
    };
    return br_run_files_open(&r->files, br_option_text(r->options, BR_OPT_OUT), &fields, err);
}

/* What is to be expected of the march, before anything of it is there. */
static enum br_status look_ahead(struct run *r, struct br_error *err)
{
    const struct br_outlook outlook = {
        .scene = &r->marched,
        .method = &r->plan.method,
        .n = r->plan.n,
        .steps = r->plan.steps,
        .prediction = &r->prediction,
    };
    return br_look_ahead(&outlook, &r->warnings, err);
}

static enum br_status march(struct run *r, struct br_error *err)
{
    struct br_history_observer output[2];
    size_t outputs = 0;
    if (br_option_given(r->options, BR_OPT_OUT))
        output[outputs++] = br_run_files_observer(&r->files);
    if (br_option_given(r->options, BR_OPT_ANIMATE) || br_option_given(r->options, BR_OPT_PLOT))
        output[outputs++] = br_pictures_observer(&r->pictures);
    const struct br_run_request request = {
        .scene = &r->scene,
        .wanted = r->plan.wanted,
        .method = r->plan.method,
        .n = r->plan.n,
        .steps = r->plan.steps,
        .stride = r->plan.stride,
        .level = r->plan.level,
        .levels = r->plan.levels,
        .check = br_option_given(r->options, BR_OPT_CHECK),
        .energies = br_option_given(r->options, BR_OPT_ENERGIES),
        .explain = br_option_given(r->options, BR_OPT_EXPLAIN),
        .output = output,
        .outputs = outputs,
        .progress = br_progress_start("marching", br_option_given(r->options, BR_OPT_QUIET)),
    };
    const enum br_status status = br_run(&request, &r->report, err);
    br_progress_end();
    return status;
}

static enum br_status write_report(struct run *r, const struct br_document *d, struct br_error *err)
{
    const struct br_error *failure = &r->report.failure;
    enum br_status status = BR_OK;
    if (br_option_given(r->options, BR_OPT_OUT))
        status = br_run_files_commit(&r->files, d, failure->status ? failure->message : NULL, err);
    if (!status && r->json.file)
        status = br_document_print(r->json.file, &br_document_json, d, NULL, err);
    if (!status && !br_option_given(r->options, BR_OPT_QUIET) && r->json.file != stdout)
        status = br_document_show(stdout, d, err);
    return status;
}

static enum br_status write_results(struct run *r, double start, struct br_error *err)
{
    const struct br_run_findings findings = {
        .report = &r->report,
        .prediction = &r->prediction,
        .warnings = &r->warnings,
        .provenance = &r->provenance,
        .wall_seconds = br_seconds() - start,
    };
    struct br_document d = {0};
    br_report_run(&findings, &d);
    enum br_status status = write_report(r, &d, err);
    br_document_clear(&d);
    FILE *letters = r->json.file == stdout ? NULL : stdout;
    if (!status)
        status = br_whole_file_commit(&r->json, err);
    return status ? status : br_pictures_finish(&r->pictures, letters, err);
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

static enum br_status run_scene(struct run *r, struct br_error *err)
{
    const double start = br_seconds();
    enum br_status status =
        br_scene_open(r->options->word[0], r->path, sizeof r->path, &r->text, &r->scene, err);
    if (!status)
        status = br_run_plan_make(r->options, &r->scene, &r->plan, err);
    if (!status)
        status = br_model_select(&r->scene, r->plan.wanted, &r->marched, err);
    if (!status && r->plan.method.axial_degree != 1 && !r->marched.axial.modelled)
        status = br_fail(err, BR_BAD_INPUT, "--axial-degree: no axial field is marched");
    if (!status)
        status = look_ahead(r, err);
    if (!status)
        status = open_files(r, err);
    if (!status)
        br_print_warnings("", &r->warnings);
    if (!status)
        status = march(r, err);
    if (!status)
        status = write_results(r, start, err);
    return status ? status : conclude(r, err);
}

static void clear(struct run *r)
{
    br_run_files_discard(&r->files);
    br_pictures_discard(&r->pictures);
    br_whole_file_discard(&r->json);
    br_run_plan_clear(&r->plan);
    br_scene_clear(&r->scene);
    free(r->text);
}

static enum br_status run(const struct br_options *options, struct br_error *err)
{
    static struct run r;
    if (!br_ranks_first())
        return BR_OK; /* one march is the work of one rank */
    r.options = options;
    const enum br_status status = run_scene(&r, err);
    clear(&r);
    return status;
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
