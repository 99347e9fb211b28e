/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate extremes [PART...]: where does it break, and does it say so? */
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/extremes_experiment.h"
#include "cli/progress.h"
#include "cli/session.h"
#include "study/ranks/ranks.h"
#include "study/scene/words.h"

enum { MOST_EXPERIMENTS = 16 };

struct run {
    struct br_session session;
    const struct br_extremes_experiment *experiment[MOST_EXPERIMENTS]; /* in registry order */
    struct br_error verdict[MOST_EXPERIMENTS];
    size_t experiments;
    struct br_extremes_job job; /* as the options have it */
};

/* ---- what the options say ---- */

static const struct {
    const char *option;
    enum br_option_id id;
} own_options[] = {{"--n", BR_OPT_N},
                   {"--k", BR_OPT_K},
                   {"--rounding", BR_OPT_ROUNDING}};
enum { OPTIONS = sizeof own_options / sizeof *own_options };

static bool accepts(const struct br_extremes_experiment *experiment, enum br_option_id option)
{
    return experiment->accepts >> option & 1;
}

/* The experiments that accept an option, as in the help: "floors, steps". */
static const char *accepting(enum br_option_id option)
{
    static char text[256];
    text[0] = '\0';
    for (const struct br_extremes_experiment *e = br_extremes_experiments; e->name; e++)
        if (accepts(e, option))
            br_append(text, sizeof text, "%s%s", *text ? ", " : "", e->name);
    return *text ? text : "no part";
}

/* With the options that it accepts. */
static const char *experiment_title(size_t row)
{
    static char text[256];
    const struct br_extremes_experiment *experiment = &br_extremes_experiments[row];
    snprintf(text, sizeof text, "%.150s.", experiment->title);
    for (size_t i = 0; i < OPTIONS; i++)
        if (accepts(experiment, own_options[i].id))
            br_append(text, sizeof text, " %s", own_options[i].option);
    return text;
}

static const char *experiment_name(size_t row)
{
    return br_extremes_experiments[row].name;
}

static const struct br_words experiments = {experiment_name, experiment_title, NULL};

/* Refuses an option that no chosen experiment accepts. */
static enum br_status check_options(const struct run *r, struct br_error *err)
{
    for (size_t i = 0; i < OPTIONS; i++) {
        bool wanted = !br_option_given(r->session.options, own_options[i].id);
        for (size_t e = 0; e < r->experiments; e++)
            wanted |= accepts(r->experiment[e], own_options[i].id);
        if (!wanted)
            return br_fail(err, BR_BAD_INPUT, "%s: no chosen part heeds it; it is for %s",
                           own_options[i].option, accepting(own_options[i].id));
    }
    return BR_OK;
}

/* Chooses the named experiments, in the registry's order; without names, all. */
static enum br_status choose_experiments(struct run *r, struct br_error *err)
{
    const struct br_options *o = r->session.options;
    for (const struct br_extremes_experiment *e = br_extremes_experiments; e->name; e++) {
        size_t times = 0;
        for (size_t i = 0; i < o->words; i++)
            times += strcmp(o->word[i], e->name) == 0;
        if (times > 1)
            return br_fail(err, BR_BAD_INPUT, "part %s is given twice", e->name);
        if ((times || !o->words) && r->experiments < MOST_EXPERIMENTS)
            r->experiment[r->experiments++] = e;
    }
    return BR_OK;
}

static enum br_status read_request(struct run *r, struct br_error *err)
{
    const struct br_options *o = r->session.options;
    if (br_ranks_size() > 1)
        return br_fail(err, BR_BAD_INPUT,
                       "found %d ranks, expected one: its threads share the work", br_ranks_size());
    r->job = (struct br_extremes_job){
        .threads = r->session.threads,
        .n = o->whole[BR_OPT_N],
        .k = o->number[BR_OPT_K],
        .n_count = o->count[BR_OPT_N],
        .k_count = o->count[BR_OPT_K],
        .rounding = br_rounding_mode((size_t)br_option_number(o, BR_OPT_ROUNDING, 0)),
    };
    return choose_experiments(r, err) ? err->status : check_options(r, err);
}

/* ---- computing and writing ---- */

static enum br_status run_experiment(struct run *r, size_t i, struct br_error *err)
{
    const struct br_extremes_experiment *experiment = r->experiment[i];
    const struct br_provenance provenance = br_provenance_of(NULL, r->session.threads);
    struct br_extremes_job job = r->job;
    char what[64];
    snprintf(what, sizeof what, "%s (%zu of %zu)", experiment->name, i + 1, r->experiments);
    job.observer = br_progress_start(what, r->session.quiet);
    const struct br_extremes_output to = {&r->session, &r->session.document[i], &r->verdict[i]};
    const enum br_status status = experiment->run(&job, &to, err);
    br_progress_end();
    if (status)
        return br_failed_in(err, experiment->name);
    br_put_provenance(to.report, &provenance);
    return br_progress_result(status, err);
}

static enum br_status run_experiments(struct run *r, struct br_error *err)
{
    enum br_status status = br_session_report(&r->session, r->experiments, err);
    for (size_t i = 0; i < r->experiments && !status; i++)
        status = run_experiment(r, i, err);
    return status;
}

/* The first verdict that fails. */
static enum br_status judge(const struct run *r, struct br_error *err)
{
    for (size_t i = 0; i < r->experiments; i++)
        if (r->verdict[i].status) {
            *err = r->verdict[i];
            return br_failed_in(err, r->experiment[i]->name);
        }
    return BR_OK;
}

static enum br_status run(const struct br_options *options, struct br_error *err)
{
    struct run r = {.session = br_session_begin(options)};
    const bool failed = read_request(&r, err) || br_session_open(&r.session, err) ||
                        run_experiments(&r, err) || br_session_finish(&r.session, err) ||
                        judge(&r, err);
    br_session_close(&r.session);
    return failed ? err->status : BR_OK;
}

const struct br_command br_command_extremes = {
    .bit = BR_FOR_EXTREMES,
    .name = "extremes",
    .arguments = "[PART...]",
    .title = "where does it break, and does it say so?",
    .about =
        "Where does it break, and does it say so? Each part goes to one kind of extremes, compares "
        "what the theory predicts with what is measured, and writes tables and pictures. The "
        "verdict fails where a result is wrong and nothing said so. Without a PART all are "
        "tried.",
    .more =
        "Parts floors and steps hold every linear solver, and what steps gather, to the exact "
        "discrete solution in long double. Part stability has the limit of the lagged contact "
        "over its stiffness and k, predicted and measured by marches of one step. An option that "
        "no chosen part heeds is refused.",
    .example = {"beamrate extremes", "beamrate extremes stability --out stability",
                "beamrate extremes floors -n 100,1000 -k 0.01"},
    .most_words = BR_MOST_WORDS,
    .words = &experiments,
    .run = run,
};
