/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate plan SCENE --error E | --seconds S: the cheapest way, proposed and tried. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/documents.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/signals.h"
#include "cli/study_request.h"
#include "cli/warn_marches.h"
#include "study/ranks/ranks.h"
#include "study/scene/file.h"
#include "study/trade/plan.h"
#include "tables/reports.h"

struct work {
    const struct br_options *options;
    struct br_study_request study;
    struct br_contenders contenders; /* count 0: not said */
    char path[1024];                 /* of the scene */
    char *text;
    struct br_scene scene;
    struct br_plan plan;
    struct br_provenance provenance;
    struct br_document document;
    struct br_output output;
};

static enum br_status prepare(struct work *w, struct br_error *err)
{
    enum br_status status =
        br_scene_open(w->options->word[0], w->path, sizeof w->path, &w->text, &w->scene, err);
    if (status)
        return status;
    struct br_plan *p = &w->plan;
    br_plan_default(p, &w->scene);
    p->goal = (struct br_plan_goal){br_option_number(w->options, BR_OPT_ERROR, NAN),
                                    br_option_number(w->options, BR_OPT_SECONDS, NAN)};
    p->norm[0] = w->study.norm[0];
    p->request.judge = w->study.judge;
    p->request.threads = w->study.threads;
    p->request.repeats = (size_t)br_option_number(w->options, BR_OPT_REPEATS, 0);
    p->request.time_limit = br_option_number(w->options, BR_OPT_TIME_LIMIT, 0);
    if (w->contenders.count)
        p->contenders = w->contenders;
    const char *out = br_option_text(w->options, BR_OPT_OUT);
    return out ? br_output_open(&w->output, out, err) : BR_OK;
}

static enum br_status make(struct work *w, struct br_error *err)
{
    struct br_error inner = {0};
    w->plan.request.observer =
        br_progress_start(w->scene.name, br_option_given(w->options, BR_OPT_QUIET));
    const enum br_status status = br_plan_make(&w->plan, &inner);
    br_progress_end();
    if (status)
        return br_fail(
            err, status, "%s%s: %.1000s",
            status == BR_BAD_INPUT && br_option_given(w->options, BR_OPT_ERROR) ? "--error: " : "",
            w->scene.name, inner.message);
    return br_signals_caught() ? br_fail(err, BR_INTERRUPTED, "interrupted") : BR_OK;
}

/* ---- results ---- */

static enum br_status write_all(struct work *w, struct br_error *err)
{
    struct br_picture_files none = {.output = &w->output};
    enum br_status status = br_documents_write(&none, w->options, &w->document, 1, err);
    if (!status)
        status = br_output_commit(&w->output, err);
    if (!status && !br_option_given(w->options, BR_OPT_QUIET))
        br_output_announce(&w->output);
    return status;
}

static enum br_status show(struct work *w, struct br_error *err)
{
    br_provenance_fill(&w->provenance, w->study.threads);
    w->provenance.scene_path = w->path;
    w->provenance.scene_text = w->text;
    br_warn_of_plan(&w->plan);
    br_report_plan(&w->plan, w->options->word[0], &w->provenance, &w->document);
    enum br_status status =
        br_option_given(w->options, BR_OPT_QUIET) ? BR_OK : br_documents_show(&w->document, 1, err);
    if (!status && br_option_given(w->options, BR_OPT_OUT))
        status = write_all(w, err);
    if (!status && w->plan.end == BR_PLAN_MISSED)
        status = br_fail(err, BR_NOT_FINITE, "%s: the goal was missed by all %zu trials",
                         w->scene.name, w->plan.count);
    return status;
}

static enum br_status read_request(struct work *w, struct br_error *err)
{
    const struct br_options *o = w->options;
    const bool error = br_option_given(o, BR_OPT_ERROR);
    const char *methods = br_option_text(o, BR_OPT_METHODS);
    enum br_status status = br_study_request_read(o, &w->study, err);
    const struct br_judge *judge = w->study.judge;
    if (!status && judge && (!judge->create || judge->nests))
        status =
            br_fail(err, BR_BAD_INPUT,
                    "--reference: found '%s', expected a judge of any mesh and step: exact or mms",
                    judge->name);
    if (!status && error == br_option_given(o, BR_OPT_SECONDS))
        status = br_fail(err, BR_BAD_INPUT, "expected one of --error and --seconds, found %s",
                         error ? "both" : "none");
    if (!status && methods)
        status = br_contenders_read("--methods", methods, &w->contenders, err);
    return status;
}

static enum br_status run(const struct br_options *options, struct br_error *err)
{
    static struct work w; /* large: models of all methods */
    w = (struct work){.options = options};
    if (br_ranks_size() > 1)
        return br_fail(err, BR_BAD_INPUT,
                       "%d ranks would disturb one another's clocks, expected one",
                       br_ranks_size());
    enum br_status status = read_request(&w, err);
    if (!status)
        status = prepare(&w, err);
    if (!status)
        status = make(&w, err);
    if (!status)
        status = show(&w, err);
    br_output_discard(&w.output);
    br_document_clear(&w.document);
    br_plan_clear(&w.plan);
    br_study_request_clear(&w.study);
    br_scene_clear(&w.scene);
    free(w.text);
    return status;
}

const struct br_command br_command_plan = {
    .bit = BR_FOR_PLAN,
    .name = "plan",
    .arguments = "SCENE",
    .title = "the cheapest way to an error, or the least error for some seconds",
    .about = "The cheapest way to a relative error, or the least error for some seconds of the "
             "processor: models of errors and costs are fitted to cheap runs, and propose a method "
             "with n and k (or a tolerance); that is run, and what it shows improves the models, "
             "until nothing that would cost less is likely to do. Out come what was predicted and "
             "what was achieved, and a command line that repeats it.",
    .more =
        "One of --error and --seconds is needed. The achieved error lies between a third of what "
        "was asked for and all of it, unless the coarsest mesh is better. A goal that nothing "
        "reaches ends with exit code 3.",
    .example = {"beamrate plan example2 --error 1e-3",
                "beamrate plan example3 --error 1e-4 --methods bdf2,esdirk3,adaptive --out plan",
                "beamrate plan example2 --seconds 1e-3 --methods euler+implicit,adaptive"},
    .least_words = 1,
    .most_words = 1,
    .run = run,
};
