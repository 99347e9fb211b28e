/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate trade SCENE...: what a digit costs. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/progress.h"
#include "cli/signals.h"
#include "cli/study_request.h"
#include "cli/trade_files.h"
#include "cli/trade_split.h"
#include "cli/warn_marches.h"
#include "study/ranks/ranks.h"

struct run {
    const struct br_options *options;
    struct br_study_request study;
    struct br_contenders contenders; /* count 0: not said */
    struct br_trade_item *item;      /* one a scene */
};

/* The scheme of the highest order that does not choose its steps: a fine run's. */
static struct br_method fine_method(void)
{
    struct br_contender finest = {.method = br_method_default()};
    for (const struct br_time_scheme *const *s = br_time_schemes; *s; s++) {
        struct br_contender c;
        if (!(*s)->adaptive && (*s)->order > finest.method.scheme->order &&
            !br_contender_read((*s)->name, &c, NULL))
            finest = c;
    }
    return finest.method;
}

static enum br_status set_request(const struct run *r, struct br_trade_item *item,
                                  struct br_error *err)
{
    const struct br_study_request *study = &r->study;
    struct br_trial_request *q = &item->trade.request;
    *q = br_trial_request_default(&item->scene);
    q->judge = study->judge;
    q->threads = study->threads;
    q->repeats = (size_t)br_option_number(r->options, BR_OPT_REPEATS, 0);
    q->time_limit = br_option_number(r->options, BR_OPT_TIME_LIMIT, 0);
    item->trade.norm[0] = study->norm[0];
    if (!q->judge || !q->judge->nests)
        return BR_OK;
    q->reference_method = fine_method();
    return br_study_request_fine(study, &item->scene, &q->reference, err);
}

static enum br_status lay_out(const struct run *r, struct br_trade_item *item, struct br_error *err)
{
    const struct br_study_request *study = &r->study;
    struct br_error inner = {0};
    size_t steps = 0;
    enum br_status status = set_request(r, item, err);
    if (status)
        return status;
    status = br_option_steps(r->options, &item->scene, &item->steps, &steps, &inner);
    if (status)
        return br_fail(err, status, "%s: %s", item->scene.name, inner.message);
    if (r->contenders.count)
        item->trade.contenders = r->contenders;
    else
        br_contenders_default(&item->scene, &item->trade.contenders);
    return br_trade_lay_out(&item->trade,
                            &(struct br_trade_grid){
                                .n = study->n,
                                .steps = item->steps,
                                .tolerance = r->options->number[BR_OPT_TOLERANCES],
                                .n_count = study->n_count,
                                .step_count = steps,
                                .tolerances = r->options->count[BR_OPT_TOLERANCES],
                                .printed = item->printed.count ? &item->printed : NULL,
                            },
                            err);
}

static enum br_status prepare(struct run *r, struct br_error *err)
{
    r->item = br_allocate(r->options->words, sizeof *r->item);
    if (!r->item)
        return br_no_memory(err, "the scenes");
    enum br_status status = BR_OK;
    for (size_t i = 0; i < r->options->words && !status; i++) {
        status = br_trade_item_read(&r->item[i], r->options->word[i], err);
        for (size_t j = 0; j < i && !status; j++)
            if (strcmp(r->item[j].scene.name, r->item[i].scene.name) == 0)
                status =
                    br_fail(err, BR_BAD_INPUT, "scene %s is given twice", r->item[i].scene.name);
        if (!status)
            status = lay_out(r, &r->item[i], err);
    }
    return status;
}

static enum br_status hold(struct run *r, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < r->options->words && !status; i++) {
        struct br_trade_item *item = &r->item[i];
        struct br_error inner = {0};
        item->trade.request.observer =
            br_progress_start(item->scene.name, br_option_given(r->options, BR_OPT_QUIET));
        status = br_trade_hold(&item->trade, &inner);
        br_progress_end();
        if (status)
            br_fail(err, status, "%s: %.1000s", item->scene.name, inner.message);
        if (!status && br_signals_caught())
            status = br_fail(err, BR_INTERRUPTED, "interrupted");
    }
    return status;
}

/* Failed trials are results; a scene in which all failed is a failure. */
static enum br_status check(const struct run *r, struct br_error *err)
{
    for (size_t i = 0; i < r->options->words; i++) {
        const struct br_trade *t = &r->item[i].trade;
        if (br_trade_tally(t, BR_TRIAL_FAILED) + br_trade_tally(t, BR_TRIAL_OVER) == t->count)
            return br_fail(err, BR_NOT_FINITE, "%s: no trial came to its end; the first: %.900s",
                           r->item[i].scene.name, t->trial[0].failure.message);
    }
    return BR_OK;
}

static enum br_status work(struct run *r, struct br_error *err)
{
    struct br_trade_files files = {
        .item = r->item, .items = r->options->words, .options = r->options};
    enum br_status status = br_trade_files_open(&files, r->study.threads, err);
    for (size_t i = 0; i < r->options->words && !status; i++)
        br_warn_of_trade(&r->item[i].trade);
    if (!status)
        status = hold(r, err);
    if (!status)
        status = br_trade_files_write(&files, err);
    br_trade_files_discard(&files);
    return status ? status : check(r, err);
}

static void clear(struct run *r)
{
    for (size_t i = 0; r->item && i < r->options->words; i++)
        br_trade_item_clear(&r->item[i]);
    free(r->item);
    br_study_request_clear(&r->study);
}

/* Clocks do not matter to where errors come from, nor does who judges. */
static enum br_status split(const struct br_options *o, struct br_error *err)
{
    static const struct {
        const char *name;
        enum br_option_id id;
    } others[] = {{"repeats", BR_OPT_REPEATS},
                  {"time-limit", BR_OPT_TIME_LIMIT},
                  {"reference", BR_OPT_REFERENCE}};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (br_option_given(o, others[i].id))
            return br_fail(err, BR_BAD_INPUT, "--%s: --split does not heed it", others[i].name);
    if (o->words != 1)
        return br_fail(err, BR_BAD_INPUT, "--split: found %zu scenes, expected one", o->words);
    return br_trade_split(o, err);
}

/* A list that no method heeds is refused. */
static enum br_status check_heeded(const struct run *r, struct br_error *err)
{
    const bool k = br_option_given(r->options, BR_OPT_K);
    size_t adaptive = 0;
    for (size_t i = 0; i < r->contenders.count; i++)
        adaptive += br_contender_adaptive(&r->contenders.list[i]);
    if (r->contenders.count && adaptive == 0 && br_option_given(r->options, BR_OPT_TOLERANCES))
        return br_fail(err, BR_BAD_INPUT, "--tolerances: no method of --methods heeds it");
    if (r->contenders.count && adaptive == r->contenders.count &&
        (k || br_option_given(r->options, BR_OPT_STEPS)))
        return br_fail(err, BR_BAD_INPUT, "--%s: no method of --methods heeds it",
                       k ? "k" : "steps");
    return BR_OK;
}

static enum br_status read_request(struct run *r, struct br_error *err)
{
    const char *methods = br_option_text(r->options, BR_OPT_METHODS);
    enum br_status status = br_study_request_read(r->options, &r->study, err);
    const struct br_judge *judge = r->study.judge;
    if (!status && r->study.norms > 1)
        status =
            br_fail(err, BR_BAD_INPUT, "--norm: found %zu norms, expected one", r->study.norms);
    if (!status && judge && !judge->create)
        status =
            br_fail(err, BR_BAD_INPUT,
                    "--reference: found '%s', expected a judge that gives errors: exact, mms or "
                    "fine:N,K",
                    judge->name);
    if (!status && methods)
        status = br_contenders_read("--methods", methods, &r->contenders, err);
    return status ? status : check_heeded(r, err);
}

static enum br_status run(const struct br_options *options, struct br_error *err)
{
    struct run r = {.options = options};
    if (br_option_given(options, BR_OPT_SPLIT))
        return split(options, err);
    if (br_ranks_size() > 1)
        return br_fail(err, BR_BAD_INPUT,
                       "%d ranks would disturb one another's clocks, expected one",
                       br_ranks_size());
    enum br_status status = read_request(&r, err);
    if (!status)
        status = prepare(&r, err);
    if (!status)
        status = work(&r, err);
    clear(&r);
    return status;
}

const struct br_command br_command_trade = {
    .bit = BR_FOR_TRADE,
    .name = "trade",
    .arguments = "SCENE...",
    .title = "what a digit costs: errors against seconds of many methods",
    .about =
        "The relative error of many methods at many resolutions against the CPU seconds of their "
        "marches, one thread, alone. Out come work-precision diagrams with the Pareto front, the "
        "cheapest way to an error of 1e-2, 1e-3, ... 1e-10, and all trials. Without --methods "
        "all time schemes are tried, and other friction rules and linear solvers with one of "
        "them; without -n and -k a coarse grid, and what the paper's table prints.",
    .more = "Several scenes make a summary, too.",
    .example =
        {"beamrate trade example2 --methods euler+lagged,euler+implicit -n 25,100 -k 0.1,0.01",
         "beamrate trade example1 example3 --methods bdf2,adaptive -n 50 -k 0.05,0.01 --time-limit 2",
         "beamrate trade example2 --split --methods euler+lagged,euler+implicit -k 0.1,0.01"},
    .least_words = 1,
    .most_words = BR_MOST_WORDS,
    .run = run,
};
