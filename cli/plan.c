/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate plan SCENE --error E | --seconds S: the cheapest way, proposed and tried. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/documents.h"
#include "cli/plan_options.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/signals.h"
#include "cli/warn_marches.h"
#include "study/ranks/ranks.h"
#include "study/scene/file.h"
#include "tables/report_plan.h"

struct work {
    struct br_plan_options options;
    struct br_plan_wish wish;
    char path[1024]; /* of the scene */
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
        br_scene_open(w->options.scene, w->path, sizeof w->path, &w->text, &w->scene, err);
    if (status)
        return status;
    struct br_plan *p = &w->plan;
    br_plan_default(p, &w->scene);
    p->goal = w->wish.goal;
    p->norm[0] = w->wish.study.norm[0];
    p->request.judge = w->wish.study.judge;
    p->request.threads = w->wish.study.threads;
    p->request.repeats = w->wish.repeats ? w->wish.repeats : p->request.repeats;
    if (isfinite(w->wish.time_limit))
        p->request.time_limit = w->wish.time_limit;
    if (w->wish.contenders.count)
        p->contenders = w->wish.contenders;
    return w->options.study.out ? br_output_open(&w->output, w->options.study.out, err) : BR_OK;
}

static enum br_status make(struct work *w, struct br_error *err)
{
    struct br_error inner = {0};
    w->plan.request.observer = br_progress_start(w->scene.name, w->options.study.quiet);
    const enum br_status status = br_plan_make(&w->plan, &inner);
    br_progress_end();
    if (status)
        return br_fail(err, status, "%s%s: %.1000s",
                       status == BR_BAD_INPUT && w->options.error ? "--error: " : "", w->scene.name,
                       inner.message);
    return br_signals_caught() ? br_fail(err, BR_INTERRUPTED, "interrupted") : BR_OK;
}

/* ---- results ---- */

static enum br_status write_all(struct work *w, struct br_error *err)
{
    enum br_status status =
        br_documents_write(&w->output, w->options.study.format, &w->document, 1, err);
    if (!status)
        status = br_output_commit(&w->output, err);
    if (!status && !w->options.study.quiet)
        br_output_announce(&w->output);
    return status;
}

static enum br_status show(struct work *w, struct br_error *err)
{
    br_provenance_fill(&w->provenance, w->wish.study.threads);
    w->provenance.scene_path = w->path;
    w->provenance.scene_text = w->text;
    br_warn_of_plan(&w->plan);
    br_report_plan(&w->plan, w->options.scene, &w->provenance, &w->document);
    enum br_status status =
        w->options.study.quiet ? BR_OK : br_documents_show(&w->document, 1, err);
    if (!status && w->options.study.out)
        status = write_all(w, err);
    if (!status && w->plan.end == BR_PLAN_MISSED)
        status = br_fail(err, BR_NOT_FINITE, "%s: the goal was missed by all %zu trials",
                         w->scene.name, w->plan.count);
    return status;
}

static enum br_status work(struct work *w, struct br_error *err)
{
    enum br_status status = br_plan_wish_read(&w->options, &w->wish, err);
    if (!status)
        status = prepare(w, err);
    if (!status)
        status = make(w, err);
    return status ? status : show(w, err);
}

static enum br_status run(int argc, const char **argv, struct br_error *err)
{
    static struct work w; /* large: models of all methods */
    w = (struct work){.text = NULL};
    enum br_status status = br_plan_options_parse(argc, argv, &w.options, err);
    const bool works = !status && !w.options.study.help;
    if (works && br_ranks_size() > 1)
        status =
            br_fail(err, BR_BAD_INPUT, "%d ranks would disturb one another's clocks, expected one",
                    br_ranks_size());
    if (works && !status)
        status = work(&w, err);
    br_output_discard(&w.output);
    br_document_clear(&w.document);
    br_plan_clear(&w.plan);
    br_plan_wish_clear(&w.wish);
    br_scene_clear(&w.scene);
    free(w.text);
    br_plan_options_clear(&w.options);
    return status;
}

const struct br_command br_command_plan = {
    .name = "plan",
    .arguments = "SCENE",
    .title = "the cheapest way to an error, or the least error for some seconds",
    .run = run,
};
