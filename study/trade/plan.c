/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/trade/plan.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "solver/clock.h"
#include "study/fit/fit.h"

const double br_plan_band = 3;

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
                             .seconds = br_trial_seconds,
                             .own = NAN};
    plan->request.time_limit = 60;
    br_named_methods_default(scene, &all);
    for (size_t i = 0; i < all.count; i++)
        if (all.list[i].method.solver == usual.solver &&
            all.list[i].method.friction == usual.friction)
            plan->methods.list[plan->methods.count++] = all.list[i];
}

/* ---- the list of trials ---- */

/* The point of a trial in the model of its method. */
static void position_of(const struct br_trial *t, double at[BR_PLAN_AXES])
{
    at[BR_PLAN_X] = log((double)t->at.n);
    at[BR_PLAN_Y] =
        t->named->method.scheme->adaptive ? -log(t->tolerance) : log((double)t->at.steps);
}

/* Whether a trial was proposed before or, if `cheap`, was one of the cheap trials. */
static bool has(const struct br_plan *p, const struct br_trial *trial, bool cheap)
{
    for (size_t i = 0; i < p->count; i++)
        if ((p->forecast[i].round > 0 || cheap) && br_trials_same(&p->trial[i], trial))
            return true;
    return false;
}

/* Adds a trial that is still to be run, unless it was added before. */
static void add(struct br_plan *p, const struct br_trial *trial, struct br_plan_forecast forecast)
{
    if (has(p, trial, forecast.round == 0))
        return;
    p->trial[p->count] = *trial;
    p->forecast[p->count++] = forecast;
}

/* ---- cheap trials: the first models are made from them ---- */

static const size_t probe_meshes[BR_PLAN_MESHES] = {2, 4, 12, 36, 108, 324, 972, 2916};

/* One mesh takes all of these, the other meshes every other one: steps that happen to end where the
 * solution switches are more accurate than their neighbours. Time levels in common save the judge
 * work. */
static const size_t probe_steps[BR_PLAN_PROBES] = {10, 15, 20, 30, 40, 60, 80, 120, 160, 240};
static const size_t mesh_of_all_steps = 108;

static const double probe_tolerances[BR_PLAN_PROBES] = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5,
                                                        1e-6, 1e-7, 1e-8, 1e-9, 1e-10};

/* The overhead of a solve, in elements; the largest work of a cheap trial, solves times elements;
 * and the assumed solves of an adaptive scheme before it has marched. */
static const double overhead = 700, most_work = 5e5, guessed_solves = 150;

/* Adds the cheap trials of one method on one mesh. */
static void add_column(struct br_plan *plan, const struct br_named_method *named, size_t n)
{
    const bool adaptive = named->method.scheme->adaptive;
    const double stages = br_time_scheme_stages(named->method.scheme);
    const size_t next = n == mesh_of_all_steps ? 1 : adaptive ? 3 : 2;
    for (size_t j = 0; j < BR_PLAN_PROBES; j += next) {
        const struct br_trial trial = br_trial_at(named, n, probe_steps[j], probe_tolerances[j]);
        const double solves = adaptive ? guessed_solves : stages * (double)trial.at.steps;
        if (((double)n + overhead) * solves <= most_work)
            add(plan, &trial, (struct br_plan_forecast){0, NAN, NAN});
    }
}

/* Allocates for the largest possible number of rounds. */
enum br_status br_plan_lay_out(struct br_plan *p, struct br_error *err)
{
    const size_t most =
        p->methods.count * BR_PLAN_MESHES * BR_PLAN_PROBES + BR_PLAN_ROUNDS * BR_PLAN_BATCH;
    p->trial = br_allocate(most, sizeof *p->trial);
    p->forecast = br_allocate(most, sizeof *p->forecast);
    p->model = br_allocate(p->methods.count, sizeof *p->model);
    if (!p->trial || !p->forecast || !p->model)
        return br_no_memory(err, "the trials");
    for (size_t c = 0; c < p->methods.count; c++)
        for (size_t i = 0; i < BR_PLAN_MESHES; i++)
            add_column(p, &p->methods.list[c], probe_meshes[i]);
    return BR_OK;
}

/* ---- models ---- */

static struct br_plan_model *model_of(const struct br_plan *p, const struct br_named_method *named)
{
    return &p->model[named - p->methods.list];
}

/* Fits the model of every method to its trials. */
static enum br_status fit_all(struct br_plan *p, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t c = 0; c < p->methods.count; c++)
        p->model[c].points = 0;
    for (const struct br_trial *t = p->trial; t < p->trial + p->count; t++) {
        struct br_plan_model *m = model_of(p, t->named);
        const double error = br_trial_bound(t), seconds = p->seconds(t);
        struct br_plan_point *point = &m->point[m->points];
        *point = (struct br_plan_point){.value = {error, seconds},
                                        .solves = (double)t->cost.counts.stages};
        position_of(t, point->at);
        m->points += error > 0 && isfinite(error) && seconds > 0 && point->solves > 0;
    }
    for (size_t c = 0; c < p->methods.count && status != BR_NO_MEMORY; c++) {
        const struct br_method *method = &p->methods.list[c].method;
        status = br_plan_model_fit(&p->model[c], 1.0 + method->axial_degree,
                                   method->scheme->adaptive ? 1 : method->scheme->order, err);
    }
    return status == BR_NO_MEMORY ? status : BR_OK; /* a model that failed is marked as not known */
}

/* ---- what was found ---- */

/* A trial with an error between E/3 and E is chosen even if it costs this factor more than one with
 * a smaller error. */
static const double worth_the_band = 1.25;

/* What a plan minimises over the trials that meet its goal: the error or, for a goal of error, the
 * seconds, which count more where the error is below E/3. INFINITY: it misses the goal. */
static double price(const struct br_plan *p, double error, double seconds)
{
    const double goal = p->goal.error;
    if (isnan(goal))
        return seconds <= p->goal.seconds ? error : INFINITY;
    return error <= goal ? seconds * (error < goal / br_plan_band ? worth_the_band : 1) : INFINITY;
}

/* The proposed trial with the least price so far, *least (out); count: none. */
static size_t best_of(const struct br_plan *p, double *least)
{
    size_t best = p->count;
    *least = INFINITY;
    for (size_t i = 0; i < p->count; i++) {
        const double here = price(p, br_trial_bound(&p->trial[i]), p->seconds(&p->trial[i]));
        if (p->forecast[i].round > 0 && here < *least) {
            *least = here;
            best = i;
        }
    }
    return best;
}

static void choose(struct br_plan *p)
{
    double least;
    p->chosen = best_of(p, &least);
    p->end = BR_PLAN_MET;
    if (p->chosen == p->count)
        p->end = BR_PLAN_MISSED;
    else if (br_trial_bound(&p->trial[p->chosen]) < p->goal.error / br_plan_band)
        p->end = p->trial[p->chosen].at.n == BR_PLAN_LEAST_N ? BR_PLAN_COARSEST : BR_PLAN_BETTER;
}

struct br_plan_components br_plan_chosen_components(const struct br_plan *p)
{
    double at[BR_PLAN_AXES];
    const struct br_trial *t = &p->trial[p->chosen];
    if (p->chosen == p->count || !model_of(p, t->named)->known)
        return (struct br_plan_components){{NAN, NAN}, {NAN, NAN}};
    position_of(t, at);
    return br_plan_model_components(model_of(p, t->named), at);
}

double br_plan_spent(const struct br_plan *p)
{
    double sum = 0;
    for (size_t i = 0; i < p->count; i++)
        if (isfinite(br_trial_seconds(&p->trial[i])))
            sum += br_trial_seconds(&p->trial[i]);
    return sum;
}

/* ---- what to try next, by the models, in all resolutions of all named methods ---- */

/* Ratios of neighbouring candidates in n, steps and tolerances. */
static const double n_factor = 1.06, step_factor = 1.08, tolerance_factor = 1.6;

/* A candidate exceeds the trials of its method at most by this factor in each variable. */
static const double most_beyond = 8;

/* A trial may cost at most this factor more than the dearest trial so far: models err. */
static const double most_growth = 16;

/* Once the goal is reached, the least promise of a candidate: the logarithm of the factor that it
 * saves, times the probability that it meets the goal. */
static const double least_promise = 0.1;

/* Until the goal is reached, any promise is enough. Below the least chance, the promise is tiny. */
static const double least_chance = 0.01, next_to_nothing = 1e-4;

/* A promise is at least this share of the best one of the round. */
static const double least_share = 0.2;

/* An upper bound of all relative errors. */
static const double any_error = 1e9;

/* A resolution that might meet the goal. */
struct candidate {
    struct br_trial trial;
    struct br_plan_prediction expected;
    double promise;
};

/* The most promising candidate of each named method, by its index. */
struct search {
    const struct br_plan *plan;
    double least; /* the price of the best so far, or one above all that is allowed */
    double most;  /* s */
    struct candidate best[BR_MOST_NAMED_METHODS];
};

/* Whether the nearest trial of the same method has no error that counts. */
static bool is_near_failure(const struct br_plan *p, const struct br_trial *trial)
{
    double nearest = INFINITY, here[BR_PLAN_AXES], there[BR_PLAN_AXES];
    bool failed = false;
    position_of(trial, here);
    for (const struct br_trial *t = p->trial; t < p->trial + p->count; t++) {
        position_of(t, there);
        const double distance =
            hypot(there[BR_PLAN_X] - here[BR_PLAN_X], 2 * (there[BR_PLAN_Y] - here[BR_PLAN_Y]));
        if (t->named == trial->named && distance < nearest) {
            nearest = distance;
            failed = !isfinite(br_trial_bound(t));
        }
    }
    return failed;
}

/* If a candidate is expected to miss the goal, its price is that of just meeting the goal. A
 * candidate below the least chance promises next to nothing, more the nearer it is to the goal. */
static double promise_of(const struct search *s, const struct br_plan_prediction *e)
{
    const struct br_plan_goal *goal = &s->plan->goal;
    const int met = isnan(goal->error) ? BR_PLAN_SECONDS : BR_PLAN_ERROR;
    const double distance = log(met == BR_PLAN_ERROR ? goal->error : goal->seconds) - e->log[met];
    const double chance = 0.5 * erfc(-distance / fmax(e->deviation[met], 1e-6) / sqrt(2));
    if (chance < least_chance)
        return next_to_nothing * exp(distance - e->deviation[met]);
    return chance * log(s->least / price(s->plan, fmin(exp(e->log[BR_PLAN_ERROR]), goal->error),
                                         fmin(exp(e->log[BR_PLAN_SECONDS]), goal->seconds)));
}

/* A cheap trial may be proposed again: it then gets all repeats. */
static void consider(struct search *s, const struct candidate *c)
{
    struct candidate *best = &s->best[c->trial.named - s->plan->methods.list];
    if (c->promise > best->promise && !has(s->plan, &c->trial, false) &&
        !is_near_failure(s->plan, &c->trial))
        *best = *c;
}

/* To three digits, as a person types it. */
static double rounded(double tolerance)
{
    char text[32];
    snprintf(text, sizeof text, "%.3g", tolerance);
    return strtod(text, NULL);
}

/* Elements from few to many, until the cost forbids more. */
static void consider_column(struct search *s, const struct br_named_method *named, size_t steps,
                            double tolerance, double most_n)
{
    const struct br_plan_model *m = model_of(s->plan, named);
    size_t before = 0;
    for (double real = BR_PLAN_LEAST_N; real <= most_n; real *= n_factor) {
        const size_t n = (size_t)(real + 0.5);
        double at[BR_PLAN_AXES];
        if (n == before)
            continue;
        before = n;
        struct candidate c = {.trial = br_trial_at(named, n, steps, tolerance)};
        position_of(&c.trial, at);
        c.expected = br_plan_model_predict(m, at);
        if (!(exp(c.expected.log[BR_PLAN_SECONDS]) <= s->most))
            return;
        c.promise = promise_of(s, &c.expected);
        consider(s, &c);
    }
}

/* Searches the steps of the trials first: their models are the surest. */
static void search_method(struct search *s, const struct br_named_method *named)
{
    const struct br_plan_model *m = model_of(s->plan, named);
    double most[BR_PLAN_AXES] = {0, 0};
    for (size_t i = 0; i < m->points; i++)
        for (int axis = 0; axis < BR_PLAN_AXES; axis++)
            most[axis] = fmax(most[axis], most_beyond * exp(m->point[i].at[axis]));
    for (const struct br_trial *t = s->plan->trial; t < s->plan->trial + s->plan->count; t++)
        if (t->named == named)
            consider_column(s, named, t->at.steps, t->tolerance, most[BR_PLAN_X]);
    if (named->method.scheme->adaptive)
        for (double inverse = 10; inverse <= most[BR_PLAN_Y]; inverse *= tolerance_factor)
            consider_column(s, named, 0, rounded(1 / inverse), most[BR_PLAN_X]);
    else
        for (double steps = BR_PLAN_LEAST_STEPS; steps <= most[BR_PLAN_Y]; steps *= step_factor)
            consider_column(s, named, (size_t)(steps + 0.5), 0, most[BR_PLAN_X]);
}

static void search_all(struct search *s)
{
    const struct br_plan *p = s->plan;
    const bool reached = best_of(p, &s->least) < p->count;
    for (const struct br_trial *t = p->trial; t < p->trial + p->count; t++)
        s->most = fmax(s->most, most_growth * p->seconds(t)); /* fmax ignores NaN */
    if (p->request.time_limit > 0)
        s->most = fmin(s->most, p->request.time_limit);
    if (isnan(p->goal.error)) {
        s->most = fmin(s->most, p->goal.seconds);
        s->least = reached ? s->least : any_error;
    } else {
        s->least = reached ? s->least : s->most;
        s->most = fmin(s->most, s->least);
    }
    for (size_t c = 0; c < p->methods.count; c++) {
        s->best[c] = (struct candidate){.promise = reached ? least_promise : 0};
        if (p->model[c].known)
            search_method(s, &p->methods.list[c]);
    }
}

/* ---- rounds ---- */

/* The plan ends after so many rounds without an improvement. */
static const size_t most_idle_rounds = 3;

/* Whether the last rounds have found nothing better than the best trial or, if none meets the goal,
 * nothing nearer to the goal; or the judge cannot tell which trial is better. */
static bool is_idle(const struct br_plan *p)
{
    const bool by_error = isfinite(p->goal.error);
    double least;
    size_t best = best_of(p, &least);
    if (best < p->count && !by_error && p->trial[best].end == BR_TRIAL_DOUBTFUL)
        return true;
    for (size_t i = 0; i < p->count && !isfinite(least); i++) {
        const struct br_trial *t = &p->trial[i], *nearest = &p->trial[best];
        const double here = by_error ? br_trial_bound(t) : p->seconds(t);
        if (best == p->count || here < (by_error ? br_trial_bound(nearest) : p->seconds(nearest)))
            best = isfinite(here) ? i : best;
    }
    return best < p->count && p->rounds >= p->forecast[best].round + most_idle_rounds;
}

/* One round; *tried (out): whether a trial was run. */
static enum br_status go_round(struct br_plan *p, bool *tried, struct br_error *err)
{
    const size_t from = p->count;
    double promised = 0;
    struct search *s = br_allocate(1, sizeof *s);
    enum br_status status = s ? fit_all(p, err) : br_no_memory(err, "the search");
    if (!status) {
        s->plan = p;
        search_all(s);
    }
    for (size_t i = 0; i < BR_PLAN_BATCH && !status; i++) {
        struct candidate *most = &s->best[0];
        for (size_t c = 1; c < p->methods.count; c++)
            if (s->best[c].promise > most->promise)
                most = &s->best[c];
        promised = fmax(promised, most->promise);
        const struct br_plan_forecast forecast = {p->rounds + 1,
                                                  exp(most->expected.log[BR_PLAN_ERROR]),
                                                  exp(most->expected.log[BR_PLAN_SECONDS])};
        if (most->trial.named && most->promise >= least_share * promised)
            add(p, &most->trial, forecast);
        *most = (struct candidate){.promise = 0};
    }
    free(s);
    *tried = p->count > from;
    if (!status && *tried)
        status = br_trials_run(&p->trial[from], p->count - from, &p->request, err);
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
        status = br_trials_run(p->trial, p->count, &p->request, err);
    p->request.repeats = repeats;
    if (!status)
        status = check_probes(p, err);
    while (!status && tried && p->rounds < BR_PLAN_ROUNDS && !is_idle(p))
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
    free(p->trial);
    free(p->forecast);
    free(p->model);
    p->trial = NULL;
    p->forecast = NULL;
    p->model = NULL;
    p->count = 0;
}
