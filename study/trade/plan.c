/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/trade/plan.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "solver/clock.h"
#include "study/fit/fit.h"

/* ---- the list of trials ---- */

double br_plan_y(const struct br_trial *t)
{
    return t->named->method.scheme->adaptive ? -log(t->tolerance) : log((double)t->at.steps);
}

/* To three digits, as a person types it. */
static double rounded(double tolerance)
{
    char text[32];
    snprintf(text, sizeof text, "%.3g", tolerance);
    return strtod(text, NULL);
}

struct br_trial br_plan_trial(const struct br_plan_candidate *c)
{
    return br_trial_at(c->named, (size_t)(c->n + 0.5), (size_t)(exp(c->y) + 0.5),
                       rounded(exp(-c->y)));
}

bool br_plan_has(const struct br_plan *p, const struct br_trial *trial, bool cheap)
{
    for (size_t i = 0; i < p->count; i++)
        if ((p->forecast[i].round > 0 || cheap) && p->trial[i].named == trial->named &&
            p->trial[i].at.n == trial->at.n &&
            fabs(br_plan_y(&p->trial[i]) - br_plan_y(trial)) <= 1e-12)
            return true;
    return false;
}

/* Adds a trial without an outcome, unless it was added before. */
static void add(struct br_plan *p, const struct br_trial *trial, struct br_plan_forecast forecast)
{
    if (br_plan_has(p, trial, forecast.round == 0))
        return;
    p->trial[p->count] = *trial;
    p->forecast[p->count++] = forecast;
}

/* ---- cheap trials: the first models are made from them ---- */

enum { MESHES = 8 };
static const size_t probe_meshes[MESHES] = {2, 4, 12, 36, 108, 324, 972, 2916};

/* All of them on one mesh, every other one on the rest: probe_steps that happen to end where the
 * solution switches are better than their neighbours. Many time levels in common spare the judge
 * work. */
enum { PROBES = 10 };
static const size_t probe_steps[PROBES] = {10, 15, 20, 30, 40, 60, 80, 120, 160, 240};
static const size_t mesh_of_all_steps = 108;

static const double probe_tolerances[PROBES] = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5,
                                                1e-6, 1e-7, 1e-8, 1e-9, 1e-10};

/* A solve costs as much as so many elements more than it has; a cheap trial's solves times elements
 * at most; solves of an adaptive scheme where they are not known yet. */
static const double overhead = 700, most_work = 5e5, guessed_solves = 150;

/* Those of one method on one mesh. */
static void add_column(struct br_plan *plan, const struct br_named_method *named, size_t n)
{
    const bool adaptive = named->method.scheme->adaptive;
    const double stages = br_time_scheme_stages(named->method.scheme);
    const size_t next = n == mesh_of_all_steps ? 1 : adaptive ? 3 : 2;
    for (size_t j = 0; j < PROBES; j += next) {
        const struct br_trial trial = br_trial_at(named, n, probe_steps[j], probe_tolerances[j]);
        const double solves = adaptive ? guessed_solves : stages * (double)trial.at.steps;
        if (((double)n + overhead) * solves <= most_work)
            add(plan, &trial, (struct br_plan_forecast){0, NAN, NAN});
    }
}

/* With room for as many rounds as there may be. */
enum br_status br_plan_lay_out(struct br_plan *p, struct br_error *err)
{
    const size_t most = p->methods.count * MESHES * PROBES + p->most_rounds * BR_PLAN_BATCH;
    p->trial = br_allocate(most, sizeof *p->trial);
    p->forecast = br_allocate(most, sizeof *p->forecast);
    if (!p->trial || !p->forecast)
        return br_no_memory(err, "the trials");
    for (size_t c = 0; c < p->methods.count; c++)
        for (size_t i = 0; i < MESHES; i++)
            add_column(p, &p->methods.list[c], probe_meshes[i]);
    return BR_OK;
}

/* ---- models ---- */

static void forget(struct br_plan *p)
{
    for (size_t c = 0; c < p->methods.count; c++) {
        br_plan_model_clear(&p->model[c].error);
        p->model[c].known = false;
    }
}

/* By what is seen of its trials, in room for all. The space error's order is 2 for elements of
 * degree 1; of more it is measured. */
static enum br_status fit_one(struct br_plan *p, size_t c, struct br_plan_point *point,
                              struct br_plan_work *work, struct br_error *err)
{
    const struct br_named_method *named = &p->methods.list[c];
    struct br_plan_models *m = &p->model[c];
    size_t points = 0, works = 0;
    for (const struct br_trial *t = p->trial; t < p->trial + p->count; t++) {
        const double error = br_trial_bound(t), seconds = p->seconds(t), n = (double)t->at.n;
        const double solves = (double)t->cost.counts.stages;
        if (t->named != named)
            continue;
        if (error > 0 && isfinite(error))
            point[points++] = (struct br_plan_point){log(n), br_plan_y(t), error};
        if (seconds > 0 && isfinite(seconds) && solves > 0)
            work[works++] = (struct br_plan_work){n, br_plan_y(t), solves, seconds};
    }
    if (points < 4 || works == 0)
        return BR_OK;
    const double q = named->method.scheme->adaptive ? 1 : named->method.scheme->order;
    enum br_status status =
        br_plan_model_fit(&m->error, point, points, 1.0 + named->method.axial_degree, q, err);
    if (!status)
        status = br_plan_cost_fit(&m->cost, work, works, err);
    m->known = !status;
    return status == BR_NO_MEMORY ? status : BR_OK;
}

static enum br_status fit_all(struct br_plan *p, struct br_error *err)
{
    struct br_plan_point *point = br_allocate(p->count + 1, sizeof *point);
    struct br_plan_work *work = br_allocate(p->count + 1, sizeof *work);
    enum br_status status = point && work ? BR_OK : br_no_memory(err, "the models");
    forget(p);
    for (size_t c = 0; c < p->methods.count && !status; c++)
        status = fit_one(p, c, point, work, err);
    free(point);
    free(work);
    return status;
}

/* ---- plans ---- */

const double br_plan_band = 3;

/* Between E/3 and E something may cost this much more than the cheapest that is at most E. */
static const double worth_the_band = 1.25;

/* After so many rounds without anything better there is none more. */
static const size_t most_idle_rounds = 3;

const char *const br_plan_end_names[] = {[BR_PLAN_MET] = "met",
                                         [BR_PLAN_COARSEST] = "coarsest",
                                         [BR_PLAN_BETTER] = "better",
                                         [BR_PLAN_MISSED] = "missed"};

void br_plan_default(struct br_plan *plan, const struct br_scene *scene)
{
    struct br_named_methods all;
    const struct br_method usual = br_method_default();
    *plan = (struct br_plan){.request = br_trial_request_default(scene),
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

/* Whether a trial's error is at most the goal's, or its seconds. */
static bool meets(const struct br_plan *p, const struct br_trial *t)
{
    if (!isfinite(br_trial_bound(t)))
        return false;
    return isfinite(p->goal.error) ? br_trial_bound(t) <= p->goal.error
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
        const double error = br_trial_bound(&p->trial[i]), seconds = p->seconds(&p->trial[i]);
        const double value = by_error ? seconds : error;
        if (p->forecast[i].round > 0 && meets(p, &p->trial[i]) && error >= least_error &&
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
    enum br_status status = fit_all(p, err);
    if (status)
        return status;
    br_plan_propose(p, &batch);
    for (size_t i = 0; i < batch.count; i++) {
        const struct br_plan_candidate *c = &batch.candidate[i];
        const struct br_trial trial = br_plan_trial(c);
        add(p, &trial, (struct br_plan_forecast){p->rounds + 1, exp(c->log_error), c->seconds});
    }
    *tried = p->count > from;
    if (*tried)
        status = br_trials_hold(&p->trial[from], p->count - from, &p->request, err);
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

/* After the cheap trials: whether there are any results, and whether the judge can decide the goal.
 */
static enum br_status check_probes(struct br_plan *p, struct br_error *err)
{
    size_t good = 0;
    for (size_t i = 0; i < p->count; i++) {
        const struct br_trial *t = &p->trial[i];
        if (isfinite(br_trial_bound(t)))
            good++;
        if (t->scale > 0 && isfinite(t->own))
            p->own = fmin(isfinite(p->own) ? p->own : INFINITY, t->own / t->scale);
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
    void *kept = NULL;
    bool tried = true;
    p->first = SIZE_MAX;
    enum br_status status = check_goal(p, err);
    if (!status)
        status = br_plan_lay_out(p, err);
    if (!status)
        status = br_trials_keep_judge(&p->request, &kept, err);
    const size_t repeats = p->request.repeats;
    p->request.repeats = 1;
    if (!status)
        status = br_trials_hold(p->trial, p->count, &p->request, err);
    p->request.repeats = repeats;
    if (!status)
        status = check_probes(p, err);
    while (!status && tried && p->rounds < p->most_rounds && !is_idle(p))
        status = go_round(p, &tried, err);
    if (!status)
        status = fit_all(p, err);
    if (p->first == SIZE_MAX)
        p->first = p->count;
    if (!status)
        choose(p);
    br_trials_forget_judge(&p->request, kept);
    p->wall_seconds = br_seconds() - start;
    return status;
}

void br_plan_clear(struct br_plan *p)
{
    forget(p);
    free(p->trial);
    free(p->forecast);
    p->trial = NULL;
    p->forecast = NULL;
    p->count = 0;
}
