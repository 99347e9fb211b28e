/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate plan SCENE --error E | --seconds S: the cheapest way, proposed and tried. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/formats.h"
#include "cli/output.h"
#include "cli/plan_options.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/signals.h"
#include "cli/warn_marches.h"
#include "study/ranks/ranks.h"
#include "study/scene/file.h"
#include "tables/plan_emitter.h"

struct work {
    struct br_plan_options options;
    struct br_plan_wish wish;
    char path[1024]; /* of the scene */
    char *text;
    char caption[512];
    struct br_scene scene;
    struct br_plan plan;
    struct br_provenance provenance;
    struct br_output output;
};

static enum br_status prepare(struct work *w, struct br_error *err)
{
    enum br_status status =
        br_scene_open(w->options.scene, w->path, sizeof w->path, &w->text, &w->scene, err);
    if (status)
        return status;
    struct br_plan *p = &w->plan;
    snprintf(w->caption, sizeof w->caption, "A plan: %.400s", w->scene.title);
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

static enum br_status write_one(struct work *w, const struct br_page_emitter *e,
                                const struct br_plan_page *page, struct br_error *err)
{
    char name[600];
    FILE *file;
    snprintf(name, sizeof name, "%.500s-plan%s", w->scene.name, e->extension);
    enum br_status status = br_output_file(&w->output, name, &file, err);
    if (status)
        return status;
    status = br_plan_emit(e, file, page, err);
    const enum br_status closed = br_output_close(file, name, status ? NULL : err);
    return status ? status : closed;
}

static enum br_status write_all(struct work *w, const struct br_plan_page *page,
                                struct br_error *err)
{
    enum br_status status = BR_OK;
    for (const struct br_page_emitter *const *e = br_page_emitters; *e && !status; e++)
        if (br_format_wanted(w->options.study.format, (*e)->name))
            status = write_one(w, *e, page, err);
    if (!status)
        status = br_output_commit(&w->output, err);
    if (!status && !w->options.study.quiet) {
        putchar('\n');
        br_output_announce(&w->output);
    }
    return status;
}

static enum br_status show(struct work *w, struct br_error *err)
{
    br_provenance_fill(&w->provenance, w->wish.study.threads);
    w->provenance.scene_path = w->path;
    w->provenance.scene_text = w->text;
    const struct br_plan_page page = {
        .name = w->scene.name,
        .scene_word = w->options.scene,
        .caption = w->caption,
        .plan = &w->plan,
        .provenance = &w->provenance,
    };
    enum br_status status = BR_OK;
    br_warn_of_plan(&w->plan);
    if (!w->options.study.quiet)
        status = br_plan_emit(&br_page_text, stdout, &page, err);
    if (!status && w->options.study.out)
        status = write_all(w, &page, err);
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
