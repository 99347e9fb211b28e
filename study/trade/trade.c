/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/trade/trade.h"

#include <math.h>

#include "solver/clock.h"

double br_trade_target(size_t digit)
{
    return pow(10, -(double)(BR_TRADE_FIRST_DIGIT + digit));
}

double br_trade_step(const struct br_trade *trade, const struct br_trial *trial)
{
    return br_named_method_adaptive(trial->named)
               ? 0
               : br_time_step(trade->request.scene, trial->at.steps);
}

double br_trade_digits_per_second(const struct br_trial *trial)
{
    if (!isfinite(br_trial_bound(trial, 0)))
        return NAN;
    return -log10(br_trial_relative(trial, 0, BR_PART_TOTAL)) / br_trial_seconds(trial);
}

size_t br_trade_tally(const struct br_trade *trade, enum br_trial_end end)
{
    size_t count = 0;
    for (size_t i = 0; i < trade->count; i++)
        count += trade->trial[i].end == end;
    return count;
}

/* ---- choosing ---- */

/* Whether a trial took less; NaN takes more than any number. */
static bool is_cheaper(const struct br_trial *a, const struct br_trial *b)
{
    const double x = br_trial_seconds(a), y = br_trial_seconds(b);
    return x < y || (!(x > y) && a->cost.counts.stages < b->cost.counts.stages);
}

size_t br_trials_cheapest(const struct br_trial *trial, size_t count, double target,
                          const struct br_named_method *only)
{
    size_t best = count;
    for (size_t i = 0; i < count; i++) {
        if (only && trial[i].named != only)
            continue;
        if (!(br_trial_bound(&trial[i], 0) <= target) || !isfinite(br_trial_seconds(&trial[i])))
            continue;
        if (best == count || is_cheaper(&trial[i], &trial[best]))
            best = i;
    }
    return best;
}

/* Errors that differ by less are equal: two linear solvers' differ in their last bits. */
static const double tie = 1e-6;

/* Whether `a` loses to `b`; of equals the later one does. */
static bool is_beaten(const struct br_trial *a, const struct br_trial *b)
{
    const double error = br_trial_bound(a, 0), other_error = br_trial_bound(b, 0);
    const double seconds = br_trial_seconds(a), other_seconds = br_trial_seconds(b);
    if (other_seconds < seconds)
        return other_error <= (1 + tie) * error;
    return other_seconds <= seconds && (other_error < error || (other_error <= error && b < a));
}

void br_trials_front(const struct br_trial *trial, size_t count, bool *front)
{
    for (size_t i = 0; i < count; i++) {
        front[i] = isfinite(br_trial_bound(&trial[i], 0)) && isfinite(br_trial_seconds(&trial[i]));
        for (size_t j = 0; j < count && front[i]; j++)
            front[i] = j == i || !is_beaten(&trial[i], &trial[j]);
    }
}

static void choose(struct br_trade *t)
{
    br_trials_front(t->trial, t->count, t->front);
    for (size_t d = 0; d < BR_TRADE_DIGITS; d++) {
        const double target = br_trade_target(d);
        t->best[d] = br_trials_cheapest(t->trial, t->count, target, NULL);
        for (size_t c = 0; c < t->methods.count; c++)
            t->best_of[c][d] = br_trials_cheapest(t->trial, t->count, target, &t->methods.list[c]);
    }
}

enum br_status br_trade_hold(struct br_trade *t, struct br_error *err)
{
    const double start = br_seconds();
    t->request.norm = t->norm;
    t->request.norms = 1;
    const enum br_status status = br_trials_hold(t->trial, t->count, &t->request, err);
    if (!status)
        choose(t);
    t->wall_seconds = br_seconds() - start;
    return status;
}

void br_trade_clear(struct br_trade *t)
{
    free(t->trial);
    free(t->front);
    t->trial = NULL;
    t->front = NULL;
    t->count = 0;
}
