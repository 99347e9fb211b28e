/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The search for what might do, by the models, in all resolutions of all named methods. */
#include "study/trade/plan.h"

#include <gsl/gsl_cdf.h>
#include <math.h>

/* Predictions err: a candidate is safe so many deviations below E, and within this part of the
 * seconds. What was tried has no deviation. */
static const double safe_deviations = 1.5, safe_seconds = 0.9;

/* Neighbouring candidates: n, steps and tolerances are so far apart, as factors. */
static const double n_factor = 1.06, step_factor = 1.08, tolerance_factor = 1.6;

/* Beyond the trials of its named method a candidate may be by so much, as factors. */
static const double most_beyond = 8;

/* A trial costs at most so many times what one has cost so far: models err. */
static const double most_growth = 16;

/* A search in the candidates of one named method. */
struct search {
    const struct br_plan *plan;
    const struct br_named_method *named;
    const struct br_plan_models *models;
    double most_x, most_y; /* where there are trials */
    double most_seconds;
    double best_seconds;                                /* of what is there; infinite: nothing */
    struct br_plan_candidate *safe, *gamble, *explorer; /* out */
};

static const double nobody = INFINITY;

/* Whether the nearest trial did not come to a good end. */
static bool is_near_failure(const struct search *s, double x, double y)
{
    double nearest = INFINITY;
    bool failed = false;
    for (size_t i = 0; i < s->plan->count; i++) {
        const struct br_trial *t = &s->plan->trial[i];
        const double distance = hypot(log((double)t->at.n) - x, 2 * (br_plan_y(t) - y));
        if (t->named == s->named && distance < nearest) {
            nearest = distance;
            failed = !isfinite(br_trial_bound(t));
        }
    }
    return failed;
}

/* ---- one candidate ---- */

static struct br_plan_candidate candidate_at(const struct br_named_method *named,
                                             const struct br_plan_models *m, double n, double y)
{
    const struct br_plan_prediction p = br_plan_model_predict(&m->error, log(n), y);
    const double seconds = br_plan_cost_seconds(&m->cost, n, y);
    return (struct br_plan_candidate){
        .named = named,
        .n = n,
        .y = y,
        .log_error = p.log_error,
        .deviation = p.deviation,
        .seconds = seconds,
        .rank = seconds,
    };
}

/* A gamble scores what it may save times how likely that is. */
static void consider_error(const struct search *s, const struct br_plan_candidate *c)
{
    const double distance = log(s->plan->goal.error) - c->log_error;
    if (distance >= safe_deviations * c->deviation && c->seconds < s->safe->seconds)
        *s->safe = *c;
    const double gain = log(fmin(s->best_seconds, 1e3 * c->seconds) / c->seconds);
    struct br_plan_candidate gamble = *c;
    gamble.rank = -(gsl_cdf_ugaussian_P(distance / fmax(c->deviation, 1e-6)) * gain);
    if (gamble.rank < s->gamble->rank)
        *s->gamble = gamble;
    if (c->log_error + c->deviation < s->explorer->log_error + s->explorer->deviation)
        *s->explorer = *c;
}

static void consider_seconds(const struct search *s, const struct br_plan_candidate *c)
{
    if (!(c->seconds <= safe_seconds * s->plan->goal.seconds) ||
        !(c->log_error + c->deviation < s->safe->log_error + s->safe->deviation))
        return;
    *s->safe = *c;
    s->safe->rank = exp(c->log_error + c->deviation);
}

/* Of one column: elements from few to many, until the cost forbids more. */
static void consider_column(const struct search *s, double y)
{
    const bool by_error = isfinite(s->plan->goal.error);
    double before = 0;
    for (double real = BR_PLAN_LEAST_N; real <= exp(s->most_x) * most_beyond; real *= n_factor) {
        const double n = floor(real + 0.5), x = log(n);
        if (!(n > before))
            continue;
        before = n;
        const struct br_plan_candidate c = candidate_at(s->named, s->models, n, y);
        if (!(c.seconds <= s->most_seconds) || (by_error && c.seconds > s->best_seconds))
            return;
        if (is_near_failure(s, x, y))
            continue;
        if (by_error)
            consider_error(s, &c);
        else
            consider_seconds(s, &c);
    }
}

/* ---- one named method ---- */

static bool is_tried_column(const struct search *s, size_t i)
{
    for (size_t j = 0; j < i; j++)
        if (s->plan->trial[j].named == s->named &&
            fabs(br_plan_y(&s->plan->trial[j]) - br_plan_y(&s->plan->trial[i])) <= 1e-12)
            return true;
    return false;
}

/* Columns that were tried are known best. */
static void look_through(struct search *s)
{
    s->most_x = s->most_y = -INFINITY;
    for (size_t i = 0; i < s->models->error.points; i++) {
        const struct br_plan_point *p = &s->models->error.point[i];
        s->most_x = fmax(s->most_x, p->x);
        s->most_y = fmax(s->most_y, p->y);
    }
    for (size_t i = 0; i < s->plan->count; i++)
        if (s->plan->trial[i].named == s->named && !is_tried_column(s, i))
            consider_column(s, br_plan_y(&s->plan->trial[i]));
    if (s->named->method.scheme->adaptive) {
        for (double tolerance = 0.1; - log(tolerance) <= s->most_y + log(most_beyond);
             tolerance /= tolerance_factor)
            consider_column(s, -log(tolerance));
        return;
    }
    const double most = exp(s->most_y) * most_beyond;
    double before = 0;
    for (double real = BR_PLAN_LEAST_STEPS; real <= most; real *= step_factor) {
        const double steps = floor(real + 0.5);
        if (steps > before)
            consider_column(s, log(steps));
        before = steps;
    }
}

/* ---- all named methods ---- */

/* What the trial `best` costs: clocks err, so the model has a say, too. Infinite: count. */
static double best_seconds_of(const struct br_plan *plan, size_t best)
{
    if (best == plan->count)
        return INFINITY;
    const struct br_trial *t = &plan->trial[best];
    const struct br_plan_models *m = &plan->model[t->named - plan->methods.list];
    const double seconds = plan->seconds(t);
    return m->known ? fmin(seconds, br_plan_cost_seconds(&m->cost, (double)t->at.n, br_plan_y(t)))
                    : seconds;
}

/* The best candidates of every named method, by its index: the cheapest (or, for seconds, the most
 * accurate) safe one, and the most promising gamble; and the least error of all. A candidate
 * without a named method: none. */
struct table {
    struct br_plan_candidate safe[BR_MOST_NAMED_METHODS], gamble[BR_MOST_NAMED_METHODS], explorer;
};

static void search_all(const struct br_plan *plan, size_t best, struct table *table)
{
    const double limit = plan->request.time_limit > 0 ? plan->request.time_limit : INFINITY;
    double most = 0;
    for (size_t i = 0; i < plan->count; i++)
        most = fmax(most, plan->seconds(&plan->trial[i])); /* NaN is passed over */
    table->explorer = (struct br_plan_candidate){.log_error = INFINITY};
    for (size_t c = 0; c < plan->methods.count; c++) {
        table->safe[c] = (struct br_plan_candidate){.seconds = nobody, .log_error = nobody};
        table->gamble[c] = (struct br_plan_candidate){.seconds = nobody, .rank = 0};
        struct search s = {
            .plan = plan,
            .named = &plan->methods.list[c],
            .models = &plan->model[c],
            .most_seconds = fmin(limit, most_growth * most),
            .best_seconds = best_seconds_of(plan, best),
            .safe = &table->safe[c],
            .gamble = &table->gamble[c],
            .explorer = &table->explorer,
        };
        if (s.models->known)
            look_through(&s);
    }
}

/* ---- the next round ---- */

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
    return !br_plan_has(plan, &wanted, false);
}

static void take(const struct br_plan *plan, struct br_plan_batch *batch,
                 const struct br_plan_candidate *c)
{
    if (batch->count < BR_PLAN_BATCH && is_new(plan, c))
        batch->candidate[batch->count++] = *c;
}

/* Takes up to `most` of the candidates, the least rank first, below limit. */
static void take_least(const struct br_plan *plan, struct br_plan_batch *batch,
                       struct br_plan_candidate *of, size_t most, double limit)
{
    for (size_t taken = 0; taken < most; taken++) {
        struct br_plan_candidate *least = NULL;
        for (size_t c = 0; c < plan->methods.count; c++)
            if (of[c].named && of[c].rank < (least ? least->rank : limit))
                least = &of[c];
        if (!least)
            return;
        take(plan, batch, least);
        least->named = NULL;
    }
}

/* Fewer elements in the column of the best trial, which is better than it need be. */
static void tune(const struct br_plan *plan, struct br_plan_batch *batch, size_t best)
{
    const struct br_trial *t = &plan->trial[best];
    const struct br_plan_models *m = &plan->model[t->named - plan->methods.list];
    const double y = br_plan_y(t), wanted = log(plan->goal.error / sqrt(br_plan_band));
    if (br_trial_bound(t) * br_plan_band >= plan->goal.error || !m->known)
        return;
    struct br_plan_candidate found = {.named = NULL};
    double nearest = INFINITY;
    for (size_t n = BR_PLAN_LEAST_N; n < t->at.n; n++) {
        const struct br_plan_candidate c = candidate_at(t->named, m, (double)n, y);
        if (fabs(c.log_error - wanted) < nearest && is_new(plan, &c)) {
            nearest = fabs(c.log_error - wanted);
            found = c;
        }
    }
    if (found.named)
        take(plan, batch, &found);
}

static void propose_for_error(const struct br_plan *plan, struct table *table, size_t best,
                              struct br_plan_batch *batch)
{
    const bool reached = best < plan->count;
    const double limit = best_seconds_of(plan, best);
    double safest = limit;
    for (size_t c = 0; c < plan->methods.count; c++)
        safest = fmin(safest, table->safe[c].seconds);
    take_least(plan, batch, table->safe, SAFE, worth_trying * limit);
    for (size_t c = 0; c < plan->methods.count; c++)
        if (!(table->gamble[c].seconds <= worth_a_gamble * safest))
            table->gamble[c].named = NULL;
    if (reached)
        tune(plan, batch, best);
    if (isfinite(safest))
        take_least(plan, batch, table->gamble, GAMBLES, -least_score);
    if (!reached && batch->count == 0 && table->explorer.named)
        take(plan, batch, &table->explorer);
}

void br_plan_propose(const struct br_plan *plan, struct br_plan_batch *batch)
{
    struct table table;
    const size_t best = br_plan_best(plan);
    const struct br_trial *t = best < plan->count ? &plan->trial[best] : NULL;
    batch->count = 0;
    search_all(plan, best, &table);
    if (isfinite(plan->goal.error))
        propose_for_error(plan, &table, best, batch);
    else if (!t || t->end != BR_TRIAL_DOUBTFUL) /* else the judge could not say what is better */
        take_least(plan, batch, table.safe, SAFE,
                   worth_seconds * (t ? br_trial_bound(t) : INFINITY));
}
