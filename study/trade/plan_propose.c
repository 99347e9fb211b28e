/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The candidates of a plan's next round. */
#include <math.h>

#include "study/trade/plan_steps.h"

/* Something new has to be cheaper than what is there by this, a gamble by that. */
static const double worth_trying = 0.9, worth_a_gamble = 0.6, least_score = 0.1;

/* Something new for a number of seconds has to have an error less by this. */
static const double worth_seconds = 0.8;

/* Most of a round. */
enum { SAFE = 2, GAMBLES = 4 };

/* Whether it has not been proposed before; what was a cheap trial is tried anew, with all
 * repeats. */
static bool is_new(const struct br_plan *plan, const struct br_plan_candidate *c)
{
    const struct br_trial wanted = br_plan_trial(c);
    for (size_t i = 0; i < plan->count; i++) {
        const struct br_trial *t = &plan->trial[i];
        if (plan->forecast[i].round > 0 && t->named == wanted.named && t->at.n == wanted.at.n &&
            fabs(br_plan_y(t) - br_plan_y(&wanted)) <= 1e-12)
            return false;
    }
    return true;
}

static void take(const struct br_plan *plan, struct br_plan_batch *batch,
                 const struct br_plan_candidate *c)
{
    if (batch->count < BR_PLAN_BATCH && is_new(plan, c))
        batch->candidate[batch->count++] = *c;
}

/* Takes up to `most` of the candidates, the least first; key: what is least, below limit. */
static void take_least(const struct br_plan *plan, struct br_plan_batch *batch,
                       struct br_plan_candidate *of, size_t most,
                       double (*key)(const struct br_plan_candidate *), double limit)
{
    for (size_t taken = 0; taken < most; taken++) {
        size_t least = plan->methods.count;
        for (size_t c = 0; c < plan->methods.count; c++)
            if (of[c].named && key(&of[c]) < limit &&
                (least == plan->methods.count || key(&of[c]) < key(&of[least])))
                least = c;
        if (least == plan->methods.count)
            return;
        take(plan, batch, &of[least]);
        of[least].named = NULL;
    }
}

static double seconds_key(const struct br_plan_candidate *c)
{
    return c->seconds;
}

static double score_key(const struct br_plan_candidate *c)
{
    return -c->score;
}

static double error_key(const struct br_plan_candidate *c)
{
    return exp(c->log_error + c->deviation);
}

/* Fewer elements in the column of the best trial, which is better than it need be. */
static void tune(const struct br_plan *plan, struct br_plan_batch *batch, size_t best)
{
    const struct br_trial *t = &plan->trial[best];
    const struct br_plan_models *m = &plan->model[t->named - plan->methods.list];
    const double y = br_plan_y(t), wanted = log(plan->goal.error / sqrt(br_plan_band));
    if (br_trial_bound(t, 0) * br_plan_band >= plan->goal.error || !m->known)
        return;
    struct br_plan_candidate found = {.named = NULL};
    double nearest = INFINITY;
    for (size_t n = BR_PLAN_LEAST_N; n < t->at.n; n++) {
        const struct br_plan_prediction p = br_plan_model_predict(&m->error, log((double)n), y);
        const struct br_plan_candidate c = {
            .named = t->named,
            .n = (double)n,
            .y = y,
            .log_error = p.log_error,
            .deviation = p.deviation,
            .seconds = br_plan_cost_seconds(&m->cost, (double)n, y),
        };
        if (fabs(p.log_error - wanted) < nearest && is_new(plan, &c)) {
            nearest = fabs(p.log_error - wanted);
            found = c;
        }
    }
    if (found.named)
        take(plan, batch, &found);
}

static void propose_for_error(const struct br_plan *plan, struct br_plan_table *table, size_t best,
                              struct br_plan_batch *batch)
{
    const bool reached = best < plan->count;
    const double limit = br_plan_best_seconds(plan, best);
    double safest = limit;
    for (size_t c = 0; c < plan->methods.count; c++)
        safest = fmin(safest, table->safe[c].seconds);
    take_least(plan, batch, table->safe, SAFE, seconds_key, worth_trying * limit);
    for (size_t c = 0; c < plan->methods.count; c++)
        if (!(table->gamble[c].seconds <= worth_a_gamble * safest))
            table->gamble[c].named = NULL;
    if (reached)
        tune(plan, batch, best);
    if (isfinite(safest))
        take_least(plan, batch, table->gamble, GAMBLES, score_key, -least_score);
    if (!reached && batch->count == 0 && table->explorer.named)
        take(plan, batch, &table->explorer);
}

static void propose_for_seconds(const struct br_plan *plan, struct br_plan_table *table,
                                size_t best, struct br_plan_batch *batch)
{
    const double error = best < plan->count ? br_trial_bound(&plan->trial[best], 0) : INFINITY;
    if (best < plan->count && plan->trial[best].end == BR_TRIAL_DOUBTFUL)
        return; /* nobody could tell what is better */
    take_least(plan, batch, table->safe, SAFE, error_key, worth_seconds * error);
}

void br_plan_propose(const struct br_plan *plan, struct br_plan_batch *batch)
{
    struct br_plan_table table;
    const size_t best = br_plan_best(plan);
    batch->count = 0;
    br_plan_search(plan, best, &table);
    if (isfinite(plan->goal.error))
        propose_for_error(plan, &table, best, batch);
    else
        propose_for_seconds(plan, &table, best, batch);
}
