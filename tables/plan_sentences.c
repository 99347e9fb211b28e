/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "tables/plan_emitter.h"

/* "bdf2, n = 100, k = 0.01 s (100 steps)" */
static const char *describe(const struct br_plan_page *page, size_t i, char *text, size_t size)
{
    const struct br_trial *t = &page->plan->trial[i];
    if (br_contender_adaptive(t->contender))
        snprintf(text, size, "%s, n = %zu, tolerance %.4g (%zu steps)", t->contender->name, t->at.n,
                 t->tolerance, t->cost.counts.steps);
    else
        snprintf(text, size, "%s, n = %zu, k = %.6g s (%zu steps)", t->contender->name, t->at.n,
                 br_plan_step(page, t), t->at.steps);
    return text;
}

static void say_trial(const struct br_plan_page *page, const char *what, size_t i,
                      const struct br_writer *w)
{
    const struct br_plan *p = page->plan;
    char text[256];
    br_say(w, "%s: %s. Error %.3e predicted, %.3e achieved; CPU %.3g s predicted, %.3g s achieved.",
           what, describe(page, i, text, sizeof text), p->forecast[i].error,
           br_trial_bound(&p->trial[i], 0), p->forecast[i].seconds, p->seconds(&p->trial[i]));
}

static void say_end(const struct br_plan *p, const struct br_writer *w)
{
    const double error = p->chosen < p->count ? br_trial_bound(&p->trial[p->chosen], 0) : NAN;
    const bool by_error = isfinite(p->goal.error);
    if (p->end == BR_PLAN_MISSED && by_error)
        br_say(
            w,
            "Missed: nothing that was tried has an error so small within the time limit of %g s a "
            "march.",
            p->request.time_limit);
    else if (p->end == BR_PLAN_MISSED)
        br_say(w, "Missed: nothing that was tried takes so little.");
    else if (!by_error)
        br_say(w, "Met: the least error found within the seconds.");
    else if (p->end == BR_PLAN_MET)
        br_say(
            w,
            "Met: the achieved error is %.2f of what was asked for, between a third and all of it.",
            error / p->goal.error);
    else if (p->end == BR_PLAN_COARSEST)
        br_say(
            w,
            "Met, and better: the coarsest mesh was taken, and its error is %.2g of what was asked "
            "for; there is nothing coarser that would cost less.",
            error / p->goal.error);
    else
        br_say(w,
               "Met, and better: the achieved error is %.2g of what was asked for, below a third: "
               "nothing between was found that costs as little.",
               error / p->goal.error);
}

/* The least error of all. */
static size_t most_accurate(const struct br_plan *p)
{
    size_t best = p->count;
    for (size_t i = 0; i < p->count; i++) {
        const double error = br_trial_bound(&p->trial[i], 0);
        if (isfinite(error) && (best == p->count || error < br_trial_bound(&p->trial[best], 0)))
            best = i;
    }
    return best;
}

void br_say_plan(const struct br_plan_page *page, const struct br_writer *w)
{
    const struct br_plan *p = page->plan;
    char text[256], line[BR_PLAN_LINE];
    if (isfinite(p->goal.error))
        br_say(w, "Goal: the cheapest way to a relative error of %g at most, norm %s.",
               p->goal.error, p->norm[0]->name);
    else
        br_say(w, "Goal: the least error within %g CPU s, norm %s.", p->goal.seconds,
               p->norm[0]->name);
    if (p->first < p->count && p->first != p->chosen)
        say_trial(page, "First proposal, by the cheap trials alone", p->first, w);
    if (p->chosen < p->count)
        say_trial(page, p->first == p->chosen ? "Proposal" : "Proposal, after what was learnt",
                  p->chosen, w);
    say_end(p, w);
    const size_t best = most_accurate(p);
    if (p->end == BR_PLAN_MISSED && best < p->count)
        br_say(w, "The most accurate one was %s: error %.3e, CPU %.3g s.",
               describe(page, best, text, sizeof text), br_trial_bound(&p->trial[best], 0),
               p->seconds(&p->trial[best]));
    br_plan_run_line(page, line);
    if (*line)
        br_say(w, "To march it: %s", line);
    br_plan_trade_line(page, line);
    if (*line)
        br_say(w, "To measure it again: %s", line);
}

static void say_parts(const struct br_plan *p, const struct br_writer *w)
{
    const struct br_plan_parts parts = br_plan_chosen_parts(p);
    if (!isfinite(parts.space))
        return;
    br_say(
        w,
        "By the model, the space error is %.2e and the time error %.2e there, relative; the observed "
        "order in h is %.2f, and that in %s %.2f.",
        parts.space, parts.time, parts.p,
        br_contender_adaptive(p->trial[p->chosen].contender) ? "the tolerance" : "k", parts.q);
}

static void say_work(const struct br_plan *p, const struct br_writer *w)
{
    size_t cheap = 0, failed = 0;
    for (size_t i = 0; i < p->count; i++) {
        cheap += p->forecast[i].round == 0 ? 1 : 0;
        failed += isfinite(br_trial_bound(&p->trial[i], 0)) ? 0 : 1;
    }
    br_say(
        w,
        "The planning: %zu cheap trials and %zu proposals in %zu rounds, %zu of them failed; their "
        "marches take %.3g CPU s, once each, and all of it took %.3g s.",
        cheap, p->count - cheap, p->rounds, failed, br_plan_spent(p), p->wall_seconds);
}

void br_say_plan_notes(const struct br_plan_page *page, const struct br_writer *w)
{
    const struct br_plan *p = page->plan;
    say_parts(p, w);
    say_work(p, w);
    br_say(w, "%s", p->norm[0]->title);
    br_say(
        w,
        "Relative errors are over the norm of the solution; the judge's own error, %.1e, is added.",
        isfinite(p->own) ? p->own : 0.0);
    br_say(
        w,
        "An error is the largest at a run's own time levels: long steps are not asked about what "
        "happens between them. There are at least 10 steps, and 20 levels where the scheme chooses its "
        "steps.");
    br_say(
        w,
        "CPU s: set-up and march, seconds of the processor in one thread, the least of up to %zu "
        "marches after a warm-up. On %s.",
        p->request.repeats, page->provenance->machine);
}
