/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/trade/plan.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "solver/clock.h"
#include "study/fit/fit.h"
#include "study/trade/plan_steps.h"

const double br_plan_band = 3;

/* Between E/3 and E something may cost this much more than the cheapest that is at most E. */
static const double worth_the_band = 1.25;

/* After so many rounds without anything better there is none more. */
static const size_t most_idle_rounds = 3;

const char *br_plan_end_name(enum br_plan_end end)
{
    static const char *const words[] = {
#define X(name, word) [name] = word,
        BR_PLAN_LIST(X)
#undef X
    };
    return words[end];
}

void br_plan_default(struct br_plan *plan, const struct br_scene *scene)
{
    struct br_named_methods all;
    const struct br_method usual = br_method_default();
    *plan = (struct br_plan){.request = br_trial_request_default(scene),
                             .norm = {br_norms[0]},
                             .goal = {NAN, NAN},
                             .most_rounds = 8,
                             .seconds = br_trial_seconds,
                             .own = NAN};
    plan->request.time_limit = 60;
    br_named_methods_default(scene, &all);
    for (size_t i = 0; i < all.count; i++)
        if (all.list[i].method.solver == usual.solver &&
            all.list[i].method.friction == usual.friction)
            plan->methods.list[plan->methods.count++] = all.list[i];
}

/* ---- what was found ---- */

bool br_plan_meets(const struct br_plan *p, const struct br_trial *t)
{
    if (!isfinite(br_trial_bound(t, 0)))
        return false;
    return isfinite(p->goal.error) ? br_trial_bound(t, 0) <= p->goal.error
                                   : p->seconds(t) <= p->goal.seconds;
}

/* The least of what is to be least among those that meet the goal, with an error of at least
 * `least_error`. */
static size_t least_of(const struct br_plan *p, double least_error)
{
    const bool by_error = isfinite(p->goal.error);
    size_t best = p->count;
    double least = INFINITY;
    for (size_t i = 0; i < p->count; i++) {
        const double error = br_trial_bound(&p->trial[i], 0), seconds = p->seconds(&p->trial[i]);
        const double value = by_error ? seconds : error;
        if (p->forecast[i].round > 0 && br_plan_meets(p, &p->trial[i]) && error >= least_error &&
            value < least) {
            least = value;
            best = i;
        }
    }
    return best;
}

size_t br_plan_best(const struct br_plan *p)
{
    return least_of(p, 0);
}

/* Within the band, unless that is dearer. */
static void choose(struct br_plan *p)
{
    const size_t best = br_plan_best(p);
    p->chosen = best;
    p->end = best == p->count ? BR_PLAN_MISSED : BR_PLAN_MET;
    if (!isfinite(p->goal.error) || best == p->count)
        return;
    const size_t within = least_of(p, p->goal.error / br_plan_band);
    if (within < p->count &&
        p->seconds(&p->trial[within]) <= worth_the_band * p->seconds(&p->trial[best]))
        p->chosen = within;
    else
        p->end = p->trial[best].at.n == BR_PLAN_LEAST_N ? BR_PLAN_COARSEST : BR_PLAN_BETTER;
}

struct br_plan_parts br_plan_chosen_parts(const struct br_plan *p)
{
    if (p->chosen == p->count)
        return (struct br_plan_parts){NAN, NAN, NAN, NAN};
    const struct br_trial *t = &p->trial[p->chosen];
    const struct br_plan_models *m = &p->model[t->named - p->methods.list];
    if (!m->known)
        return (struct br_plan_parts){NAN, NAN, NAN, NAN};
    return br_plan_model_parts(&m->error, log((double)t->at.n), br_plan_y(t));
}

double br_plan_spent(const struct br_plan *p)
{
    double sum = 0;
    for (size_t i = 0; i < p->count; i++)
        if (isfinite(br_trial_seconds(&p->trial[i])))
            sum += br_trial_seconds(&p->trial[i]);
    return sum;
}

/* ---- rounds ---- */

/* Holds on to what the judge knows, so that it is found out once and not in every round. */
static enum br_status keep_judge(const struct br_plan *p, const struct br_judge *judge, void **self,
                                 struct br_error *err)
{
    *self = NULL;
    if (!judge || !judge->create || judge->nests)
        return BR_OK;
    const struct br_observer *o = p->request.observer;
    return judge->create(self,
                         &(struct br_judge_request){
                             .scene = p->request.scene,
                             .levels = 1,
                             .lead = 1,
                             .stop = o ? o->stop : NULL,
                             .stop_self = o ? o->self : NULL,
                         },
                         err);
}

static enum br_status hold_new(struct br_plan *p, size_t from, struct br_error *err)
{
    return p->count > from ? br_trials_hold(&p->trial[from], p->count - from, &p->request, err)
                           : BR_OK;
}

static enum br_status hold_probes(struct br_plan *p, struct br_error *err)
{
    const size_t repeats = p->request.repeats;
    enum br_status status = br_plan_add_probes(p, err);
    p->request.repeats = 1;
    if (!status)
        status = hold_new(p, 0, err);
    p->request.repeats = repeats;
    return status;
}

/* Whether the rounds have gone on for long without anything better than the best. */
static bool is_idle(const struct br_plan *p)
{
    const size_t best = br_plan_best(p);
    return best < p->count && p->rounds >= p->forecast[best].round + most_idle_rounds;
}

/* One round: whether anything was tried (*tried, out). */
static enum br_status go_round(struct br_plan *p, bool *tried, struct br_error *err)
{
    struct br_plan_batch batch;
    const size_t from = p->count;
    *tried = false;
    enum br_status status = br_plan_fit(p, err);
    if (status)
        return status;
    br_plan_propose(p, &batch);
    for (size_t i = 0; i < batch.count && !status; i++) {
        const struct br_plan_candidate *c = &batch.candidate[i];
        const struct br_trial trial = br_plan_trial(c);
        const struct br_plan_forecast forecast = {p->rounds + 1, exp(c->log_error), c->seconds};
        bool added = false;
        status = br_plan_add(p, &trial, &forecast, &added, err);
        *tried |= added;
    }
    if (!status && *tried)
        status = hold_new(p, from, err);
    if (!status && *tried && ++p->rounds == 1)
        p->first = from;
    return status;
}

static enum br_status check_goal(const struct br_plan *p, struct br_error *err)
{
    const double e = p->goal.error, s = p->goal.seconds;
    if (isnan(e) == isnan(s))
        return br_fail(err, BR_BAD_INPUT, "a plan needs an error or seconds, and not both");
    if (!isnan(e) && !(e > 0 && e < 1))
        return br_fail(err, BR_BAD_INPUT, "found %g, expected a relative error between 0 and 1", e);
    if (!isnan(s) && !(s > 0 && isfinite(s)))
        return br_fail(err, BR_BAD_INPUT, "found %g, expected seconds > 0", s);
    return p->methods.count ? BR_OK : br_fail(err, BR_BAD_INPUT, "no method takes this scene");
}

/* After the cheap trials: whether there are any results, and whether the goal can be told. */
static enum br_status check_probes(struct br_plan *p, struct br_error *err)
{
    size_t good = 0;
    for (size_t i = 0; i < p->count; i++) {
        const struct br_trial *t = &p->trial[i];
        if (isfinite(br_trial_bound(t, 0)))
            good++;
        if (t->scale[0] > 0 && isfinite(t->own[0]))
            p->own = fmin(isfinite(p->own) ? p->own : INFINITY, t->own[0] / t->scale[0]);
    }
    if (good == 0)
        return br_fail(err, BR_NOT_FINITE,
                       "no trial came to its end with an error; the first: %.900s",
                       p->trial[0].failure.message);
    if (p->goal.error < br_flag_margin * p->own)
        return br_fail(
            err, BR_BAD_INPUT,
            "found %g, but what judges has an error of %.1e of its own: expected at least "
            "%.1e",
            p->goal.error, p->own, br_flag_margin * p->own);
    return BR_OK;
}

enum br_status br_plan_make(struct br_plan *p, struct br_error *err)
{
    const double start = br_seconds();
    const struct br_judge *judge =
        p->request.judge ? p->request.judge : br_judge_best(p->request.scene);
    void *kept = NULL;
    bool tried = true;
    p->request.norm = p->norm;
    p->request.norms = 1;
    p->first = SIZE_MAX;
    enum br_status status = check_goal(p, err);
    if (!status)
        status = keep_judge(p, judge, &kept, err);
    if (!status)
        status = hold_probes(p, err);
    if (!status)
        status = check_probes(p, err);
    while (!status && tried && p->rounds < p->most_rounds && !is_idle(p))
        status = go_round(p, &tried, err);
    if (!status)
        status = br_plan_fit(p, err);
    if (p->first == SIZE_MAX)
        p->first = p->count;
    if (!status)
        choose(p);
    if (kept)
        judge->free(kept);
    p->wall_seconds = br_seconds() - start;
    return status;
}

void br_plan_clear(struct br_plan *p)
{
    br_plan_forget(p);
    free(p->trial);
    free(p->forecast);
    p->trial = NULL;
    p->forecast = NULL;
    p->count = p->capacity = 0;
}
