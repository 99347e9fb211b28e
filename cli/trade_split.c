/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/trade_split.h"

#include <stdio.h>
#include <string.h>

#include "cli/documents.h"
#include "cli/picture_files.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/signals.h"
#include "cli/study_request.h"
#include "cli/warn_marches.h"
#include "plots/pictures.h"
#include "study/grid/observer.h"
#include "study/ranks/ranks.h"
#include "study/scene/file.h"
#include "study/trade/contender.h"
#include "study/trade/split.h"
#include "tables/reports.h"

struct work {
    const struct br_options *options;
    struct br_study_request request; /* n, norms, threads */
    struct br_contenders methods;
    const double *tolerance; /* tolerances */
    size_t tolerances;
    size_t *steps; /* step_count; owned */
    size_t step_count;
    char path[1024]; /* of the scene */
    char *text;
    struct br_scene scene;
    struct br_split *split; /* splits; owned */
    size_t splits;
    struct br_provenance provenance;
    struct br_document document;
    struct br_output output;
};

/* ---- options ---- */

/* Tolerances that no method heeds are refused. */
static enum br_status check_heeded(const struct work *w, struct br_error *err)
{
    for (size_t i = 0; i < w->methods.count; i++)
        if (br_contender_adaptive(&w->methods.list[i]))
            return BR_OK;
    return w->tolerances
               ? br_fail(err, BR_BAD_INPUT, "--tolerances: no method of --methods heeds it")
               : BR_OK;
}

static enum br_status read_lists(struct work *w, struct br_error *err)
{
    const struct br_options *o = w->options;
    const char *methods = br_option_text(o, BR_OPT_METHODS);
    enum br_status status = br_study_request_read(o, &w->request, err);
    if (!status)
        status = br_contenders_read("--methods", methods ? methods : br_time_schemes[0]->name,
                                    &w->methods, err);
    w->tolerance = o->number[BR_OPT_TOLERANCES];
    w->tolerances = o->count[BR_OPT_TOLERANCES];
    return status ? status : check_heeded(w, err);
}

/* ---- the runs: methods, then meshes, then time steps, or tolerances ---- */

/* How many tolerances a method is run with. */
static size_t tolerances_of(const struct work *w, const struct br_contender *c)
{
    return br_contender_adaptive(c) && w->tolerances ? w->tolerances : 1;
}

static void set_run(const struct work *w, const struct br_contender *c, size_t n, size_t steps,
                    struct br_split *split)
{
    *split = (struct br_split){
        .scene = &w->scene,
        .method = c->method,
        .at = {n, steps},
        .norms = w->request.norms,
    };
    memcpy(split->norm, w->request.norm, sizeof split->norm);
}

enum { DEFAULT_N = 100, DEFAULT_STEPS = 1000 };

static void add_runs(struct work *w, const struct br_contender *c, size_t n)
{
    for (size_t j = 0; j < (w->step_count ? w->step_count : 1); j++)
        for (size_t t = 0; t < tolerances_of(w, c); t++) {
            struct br_split *split = &w->split[w->splits++];
            set_run(w, c, n, w->step_count ? w->steps[j] : DEFAULT_STEPS, split);
            if (br_contender_adaptive(c) && w->tolerances)
                split->method.tolerance = w->tolerance[t];
        }
}

static enum br_status lay_out(struct work *w, struct br_error *err)
{
    const size_t meshes = w->request.n_count ? w->request.n_count : 1;
    const size_t most = w->tolerances ? w->tolerances : 1;
    const enum br_status status =
        br_option_steps(w->options, &w->scene, &w->steps, &w->step_count, err);
    if (status)
        return status;
    const size_t steps = w->step_count ? w->step_count : 1;
    w->split = br_allocate(w->methods.count * meshes * steps * most, sizeof *w->split);
    if (!w->split)
        return br_no_memory(err, "the parts of the errors");
    for (size_t c = 0; c < w->methods.count; c++)
        for (size_t i = 0; i < meshes; i++)
            add_runs(w, &w->methods.list[c], w->request.n_count ? w->request.n[i] : DEFAULT_N);
    return BR_OK;
}

/* ---- computing and writing ---- */

/* Progress over all runs. */
struct overall {
    const struct br_observer *inner;
    size_t done, all;
};

static void progress(void *self, double fraction)
{
    const struct overall *o = self;
    if (o->inner->progress)
        o->inner->progress(o->inner->self, ((double)o->done + fraction) / (double)o->all);
}

static void preparing(void *self, double share)
{
    const struct overall *o = self;
    if (o->inner->preparing)
        o->inner->preparing(o->inner->self, share);
}

static bool stop(void *self)
{
    const struct overall *o = self;
    return o->inner->stop && o->inner->stop(o->inner->self);
}

static enum br_status split_all(struct work *w, struct br_error *err)
{
    struct overall o = {
        .inner = br_progress_start("splitting",
                                   br_option_given(w->options, BR_OPT_QUIET) || !br_ranks_first()),
        .all = w->splits};
    const struct br_observer observer = {progress, stop, &o, preparing};
    enum br_status status = BR_OK;
    for (; o.done < o.all && !status; o.done++)
        status = br_split_run(&w->split[o.done], w->request.threads, &observer, err);
    br_progress_end();
    return !status && br_signals_caught() ? br_fail(err, BR_INTERRUPTED, "interrupted") : status;
}

/* Over k or h, where the runs differ by one of them. */
static enum br_status plot(struct work *w, struct br_picture_files *files, struct br_error *err)
{
    struct br_figure figure;
    enum br_status status = br_split_draw(w->split, w->splits, &figure, err);
    if (!status && figure.panels) {
        br_put_picture(&w->document, figure.stem, figure.title);
        status = br_picture_files_draw(files, &figure, err);
    }
    br_figure_clear(&figure);
    return status;
}

static enum br_status write_files(struct work *w, struct br_error *err)
{
    struct br_picture_files files = {.output = &w->output};
    enum br_status status =
        br_option_given(w->options, BR_OPT_NO_PLOTS) ? BR_OK : plot(w, &files, err);
    if (!status)
        status = br_documents_write(&files, w->options, &w->document, 1, err);
    const enum br_status drawn = br_picture_files_finish(&files, status ? NULL : err);
    return status ? status : drawn;
}

static enum br_status write_all(struct work *w, struct br_error *err)
{
    br_provenance_fill(&w->provenance, w->request.threads);
    w->provenance.scene_path = w->path;
    w->provenance.scene_text = w->text;
    br_report_split(w->split, w->splits, &w->provenance, &w->document);
    enum br_status status = write_files(w, err);
    if (!status && !br_option_given(w->options, BR_OPT_QUIET))
        status = br_documents_show(&w->document, 1, err);
    if (!status)
        status = br_output_commit(&w->output, err);
    if (!status && !br_option_given(w->options, BR_OPT_QUIET))
        br_output_announce(&w->output);
    return status;
}

static enum br_status run(struct work *w, struct br_error *err)
{
    const bool writes = br_ranks_first();
    enum br_status status = read_lists(w, err);
    if (!status)
        status =
            br_scene_open(w->options->word[0], w->path, sizeof w->path, &w->text, &w->scene, err);
    if (!status)
        status = lay_out(w, err);
    if (!status && writes)
        status = br_output_open(&w->output, br_option_text(w->options, BR_OPT_OUT), err);
    if (!status && writes)
        status = br_warn_of_splits(w->split, w->splits, err);
    if (!status)
        status = split_all(w, err);
    return status || !writes ? status : write_all(w, err);
}

enum br_status br_trade_split(const struct br_options *options, struct br_error *err)
{
    struct work w = {.options = options};
    const enum br_status status = run(&w, err);
    br_output_discard(&w.output);
    br_study_request_clear(&w.request);
    br_document_clear(&w.document);
    br_scene_clear(&w.scene);
    free(w.steps);
    free(w.split);
    free(w.text);
    return status;
}
