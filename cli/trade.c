/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate trade SCENE...: what a digit costs. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/progress.h"
#include "cli/signals.h"
#include "cli/trade_files.h"
#include "cli/trade_options.h"
#include "cli/trade_split.h"
#include "cli/warn_marches.h"
#include "study/ranks/ranks.h"

struct run {
    struct br_trade_options options;
    struct br_trade_wish wish;
    struct br_trade_item *item; /* options.scenes of them */
};

static enum br_status fill_steps(const struct br_study_request *r, struct br_trade_item *item,
                                 struct br_error *err)
{
    struct br_error inner = {0};
    item->steps = br_allocate(r->k_count + 1, sizeof *item->steps);
    if (!item->steps)
        return br_no_memory(err, "the grid");
    for (size_t i = 0; i < r->k_count; i++) {
        if (br_steps_of(&item->scene, r->k[i], &item->steps[i], &inner))
            return br_fail(err, BR_BAD_INPUT, "--k: %s: %s", item->scene.name, inner.message);
        for (size_t j = 0; j < i; j++)
            if (item->steps[j] == item->steps[i])
                return br_fail(err, BR_BAD_INPUT, "--k: %g is given twice", r->k[i]);
    }
    return BR_OK;
}

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
    const struct br_study_request *study = &r->wish.study;
    struct br_trial_request *q = &item->trade.request;
    struct br_error inner = {0};
    *q = br_trial_request_default(&item->scene);
    q->judge = study->judge;
    q->threads = study->threads;
    q->repeats = r->wish.repeats ? r->wish.repeats : q->repeats;
    q->time_limit = isfinite(r->wish.time_limit) ? r->wish.time_limit : q->time_limit;
    item->trade.norm[0] = study->norm[0];
    if (!q->judge || !q->judge->nests)
        return BR_OK;
    q->reference_method = fine_method();
    q->reference.n = study->reference_n;
    if (br_steps_of(&item->scene, study->reference_k, &q->reference.steps, &inner))
        return br_fail(err, BR_BAD_INPUT, "--reference: %s", inner.message);
    return BR_OK;
}

static enum br_status lay_out(const struct run *r, struct br_trade_item *item, struct br_error *err)
{
    const struct br_study_request *study = &r->wish.study;
    enum br_status status = set_request(r, item, err);
    if (!status)
        status = fill_steps(study, item, err);
    if (status)
        return status;
    if (r->wish.contenders.count)
        item->trade.contenders = r->wish.contenders;
    else
        br_contenders_default(&item->scene, &item->trade.contenders);
    return br_trade_lay_out(&item->trade,
                            &(struct br_trade_grid){
                                .n = study->n,
                                .steps = item->steps,
                                .tolerance = r->wish.tolerance,
                                .n_count = study->n_count,
                                .step_count = study->k_count,
                                .tolerances = r->wish.tolerances,
                                .printed = item->printed.count ? &item->printed : NULL,
                            },
                            err);
}

static enum br_status prepare(struct run *r, struct br_error *err)
{
    r->item = br_allocate(r->options.scenes, sizeof *r->item);
    if (!r->item)
        return br_no_memory(err, "the scenes");
    enum br_status status = BR_OK;
    for (size_t i = 0; i < r->options.scenes && !status; i++) {
        status = br_trade_item_read(&r->item[i], r->options.scene[i], err);
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
    for (size_t i = 0; i < r->options.scenes && !status; i++) {
        struct br_trade_item *item = &r->item[i];
        struct br_error inner = {0};
        br_warn_of_trade(&item->trade);
        item->trade.request.observer = br_progress_start(item->scene.name, r->options.study.quiet);
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
    for (size_t i = 0; i < r->options.scenes; i++) {
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
        .item = r->item, .items = r->options.scenes, .options = &r->options.study};
    enum br_status status = br_trade_files_open(&files, r->wish.study.threads, err);
    if (!status)
        status = hold(r, err);
    if (!status)
        status = br_trade_files_write(&files, err);
    br_trade_files_discard(&files);
    return status ? status : check(r, err);
}

static void clear(struct run *r)
{
    for (size_t i = 0; r->item && i < r->options.scenes; i++)
        br_trade_item_clear(&r->item[i]);
    free(r->item);
    br_trade_wish_clear(&r->wish);
    br_trade_options_clear(&r->options);
}

/* Clocks do not matter to where errors come from, nor does who judges. */
static enum br_status split(const struct br_trade_options *o, struct br_error *err)
{
    const struct {
        const char *option, *value;
    } others[] = {{"--repeats", o->repeats},
                  {"--time-limit", o->time_limit},
                  {"--reference", o->study.reference}};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (others[i].value)
            return br_fail(err, BR_BAD_INPUT, "%s: --split does not heed it", others[i].option);
    if (o->scenes != 1)
        return br_fail(err, BR_BAD_INPUT, "--split: found %zu scenes, expected one", o->scenes);
    return br_trade_split(o, err);
}

static enum br_status run(int argc, const char **argv, struct br_error *err)
{
    struct run r = {.item = NULL};
    enum br_status status = br_trade_options_parse(argc, argv, &r.options, err);
    const bool asked = !status && !r.options.study.help, works = asked && !r.options.split;
    if (asked && r.options.split)
        status = split(&r.options, err);
    if (works && br_ranks_size() > 1)
        status =
            br_fail(err, BR_BAD_INPUT, "%d ranks would disturb one another's clocks, expected one",
                    br_ranks_size());
    if (works && !status)
        status = br_trade_wish_read(&r.options, &r.wish, err);
    if (works && !status)
        status = prepare(&r, err);
    if (works && !status)
        status = work(&r, err);
    clear(&r);
    return status;
}

const struct br_command br_command_trade = {
    .name = "trade",
    .arguments = "SCENE...",
    .title = "what a digit costs: errors against seconds of many methods",
    .run = run,
};
