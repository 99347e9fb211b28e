/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "tables/trade_page.h"

/* The first trial that has an error: it knows the judge and the solution. */
static const struct br_trial *judged(const struct br_trade *trade)
{
    for (size_t i = 0; i < trade->count; i++)
        if (isfinite(trade->trial[i].scale[0]))
            return &trade->trial[i];
    return NULL;
}

static void say_judge(const struct br_trade *t, const struct br_writer *w)
{
    const struct br_judge *judge =
        t->request.judge ? t->request.judge : br_judge_best(t->request.scene);
    const struct br_trial *known = judged(t);
    const char *unit = t->norm[0]->unit;
    if (!known)
        br_say(w, "Judged by: %s. No trial came to its end.", judge->title);
    else if (isfinite(known->own[0]))
        br_say(
            w,
            "Judged by: %s. Relative errors are over the norm of the solution, %.4g %s. The judge's "
            "own error is at most %.1e of that; it is added before a trial counts as good enough.",
            judge->title, known->scale[0], unit, known->own[0] / known->scale[0]);
    else
        br_say(w, "Judged by: %s. Relative errors are over the norm of the solution, %.4g %s.",
               judge->title, known->scale[0], unit);
}

void br_say_trade(const struct br_trade_page *page, const struct br_writer *w)
{
    const struct br_trade *t = page->trade;
    br_say(w, "%s", t->norm[0]->title);
    say_judge(t, w);
    br_say(
        w,
        "CPU s: set-up and march, seconds of the processor in one thread, the least of up to %zu "
        "marches after a warm-up; longer ones than %g s are marched once. Digits/s: -log10 of the "
        "relative error, over these seconds. On %s.",
        t->request.repeats, t->request.repeat_seconds, page->provenance->machine);
    br_say(
        w,
        "An error is the largest at a trial's own time levels: long steps are not asked about what "
        "happens between them.");
    br_say(w, "A method is its time scheme and what is not the default with it; a tolerance (tol) "
              "stands for k where the scheme chooses its steps.");
}

/* As it was asked for: "bdf2 n = 100, k = 0.01 s" */
static const char *describe(const struct br_trade *t, const struct br_trial *trial, char *text,
                            size_t size)
{
    if (br_contender_adaptive(trial->contender))
        snprintf(text, size, "%s, n = %zu, tolerance %g", trial->contender->name, trial->at.n,
                 trial->tolerance);
    else
        snprintf(text, size, "%s, n = %zu, k = %g s", trial->contender->name, trial->at.n,
                 br_trade_step(t, trial));
    return text;
}

void br_say_trade_ends(const struct br_trade_page *page, const struct br_writer *w)
{
    const struct br_trade *t = page->trade;
    char text[512];
    size_t used = 0;
    for (int end = BR_TRIAL_DONE; end < BR_TRIAL_ENDS; end++)
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%s: %zu", end ? ", " : "",
                                 br_trial_end_name((enum br_trial_end)end),
                                 br_trade_tally(t, (enum br_trial_end)end));
    br_say(w, "%zu trials. %s.", t->count, text);
    if (br_trade_tally(t, BR_TRIAL_DOUBTFUL))
        br_say(w, "Doubtful: the judge's own error is more than a third of the trial's.");
    for (size_t i = 0; i < t->count; i++)
        if (t->trial[i].failure.status)
            br_say(w, "%s: %s: %.1000s", describe(t, &t->trial[i], text, sizeof text),
                   br_trial_end_name(t->trial[i].end), t->trial[i].failure.message);
}
