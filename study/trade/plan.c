/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/trade/plan.h"

#include <math.h>
#include <stdlib.h>

#include "solver/clock.h"
#include "study/fit/fit.h"

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

/* The grid: factors of four in space and of about the square root of ten in time, as `trade` has
 * them, from the coarsest to what only a long march needs. Tolerances are of adaptive schemes. */
static const size_t meshes[] = {1, 2, 6, 25, 100, 400, 1600, 6400, 25600, 102400};
static const size_t steps[] = {10, 30, 100, 300, 1000, 3000, 10000, 30000, 100000, 300000, 1000000};
enum {
    MESHES = sizeof meshes / sizeof *meshes,
    STEPS = sizeof steps / sizeof *steps,
    TOLERANCES = 12 /* 1e-1 to 1e-12 */
};

static enum br_status add(struct br_plan *p, const struct br_trial *trial, struct br_error *err)
{
    if (p->count == p->room) {
        const size_t room = 2 * p->room + 64;
        struct br_trial *more = realloc(p->trial, room * sizeof *more);
        if (!more)
            return br_no_memory(err, "the trials");
        p->trial = more;
        p->room = room;
    }
    p->trial[p->count++] = *trial;
    return BR_OK;
}

/* From the trial `from` on. */
static const struct br_trial *find(const struct br_plan *p, size_t from,
                                   const struct br_trial *trial)
{
    for (size_t i = from; i < p->count; i++)
        if (br_trials_same(&p->trial[i], trial))
            return &p->trial[i];
    return NULL;
}

/* The trial at a place of a method's grid. */
static struct br_trial at_place(const struct br_named_method *named, size_t mesh, size_t level)
{
    return named->method.scheme->adaptive
               ? br_trial_at(named, meshes[mesh], 0, pow(10, -1.0 - (double)level))
               : br_trial_at(named, meshes[mesh], steps[level], 0);
}

/* ---- what a trial will cost ---- */

static double work_of(const struct br_plan *p, const struct br_trial *t)
{
    return br_trial_work(p->request.scene, t);
}

/* Expected seconds: those of the complete trial of the same method that has the nearest work, times
 * the ratio of their works; 0: no trial of the method is complete. */
static double expected_seconds(const struct br_plan *p, const struct br_trial *trial)
{
    double nearest = INFINITY, seconds = 0;
    for (const struct br_trial *t = p->trial; t < p->trial + p->count; t++) {
        const double ratio = work_of(p, trial) / work_of(p, t), distance = fabs(log(ratio));
        if (t->named == trial->named && p->seconds(t) > 0 && distance < nearest) {
            nearest = distance;
            seconds = p->seconds(t) * ratio;
        }
    }
    return seconds;
}

/* ---- which trial is better ---- */

/* An error between E/3 and E is worth this factor in seconds: the goal is met, and no more. */
static const double band = 3, worth_the_band = 1.25;

/* What a plan minimises over the trials that meet its goal: the error or, for a goal of error, the
 * seconds. INFINITY: it misses the goal, or has no error. */
static double price_of(const struct br_plan *p, const struct br_trial *t)
{
    const double error = br_trial_bound(t), seconds = p->seconds(t), goal = p->goal.error;
    if (isnan(goal))
        return seconds <= p->goal.seconds && isfinite(error) ? error : INFINITY;
    return error <= goal && seconds > 0 ? seconds * (error < goal / band ? worth_the_band : 1)
                                        : INFINITY;
}

/* The trial with the least price from `from` on, of one method or of all (NULL); count: none. */
static size_t best_of(const struct br_plan *p, size_t from, const struct br_named_method *only)
{
    size_t best = p->count;
    double least = INFINITY;
    for (size_t i = from; i < p->count; i++)
        if ((!only || p->trial[i].named == only) && price_of(p, &p->trial[i]) < least) {
            least = price_of(p, &p->trial[i]);
            best = i;
        }
    return best;
}

/* The most that a further trial may take, s: as much as the best one where an error is the goal. */
static double allowed_seconds(const struct br_plan *p)
{
    const double limit = p->request.time_limit > 0 ? p->request.time_limit : INFINITY;
    const size_t best = best_of(p, 0, NULL);
    if (isnan(p->goal.error))
        return fmin(limit, p->goal.seconds);
    return best < p->count ? fmin(limit, p->seconds(&p->trial[best])) : limit;
}

/* ---- the grid, from the cheapest trials on ---- */

/* A refinement helps if it lowers the error by this factor or more. */
static const double helps = 0.9;

/* The error at a place of the grid that lies so many places back; *found (out): whether it was
 * tried. A trial that failed may be followed by a better one. */
static double error_back(const struct br_plan *p, const struct br_named_method *named,
                         const size_t place[2], int axis, size_t back, bool *found)
{
    size_t at[2] = {place[0], place[1]};
    *found = at[axis] >= back;
    at[axis] -= *found ? back : 0;
    const struct br_trial there = at_place(named, at[0], at[1]);
    const struct br_trial *t = *found ? find(p, 0, &there) : NULL;
    *found = t;
    return t && isfinite(br_trial_bound(t)) ? br_trial_bound(t) : INFINITY;
}

/* Whether a place may be better than those before it: a neighbour on a coarser mesh or with longer
 * steps was tried, and the step to this neighbour helped. One lucky error does not end a row. */
static bool may_help(const struct br_plan *p, const struct br_named_method *named,
                     const size_t place[2])
{
    bool reached = place[0] == 0 && place[1] == 0, found, other;
    for (int axis = 0; axis < 2; axis++) {
        const double last = error_back(p, named, place, axis, 1, &found);
        const double before = fmax(error_back(p, named, place, axis, 2, &other),
                                   error_back(p, named, place, axis, 3, &other));
        reached |= found;
        if (found && !(last <= helps * before))
            return false;
    }
    return reached;
}

static enum br_status check_grid(struct br_plan *p, struct br_error *err)
{
    size_t good = 0;
    for (const struct br_trial *t = p->trial; t < p->trial + p->count; t++) {
        good += isfinite(br_trial_bound(t)) ? 1 : 0;
        if (t->scale > 0 && isfinite(t->own))
            p->own = fmin(isfinite(p->own) ? p->own : INFINITY, t->own / t->scale);
    }
    if (good == 0)
        return br_fail(err, BR_NOT_FINITE,
                       "no trial was completed with a known error; the first: %.900s",
                       p->count ? p->trial[0].failure.message : "there is none");
    if (p->goal.error < br_flag_margin * p->own)
        return br_fail(
            err, BR_BAD_INPUT,
            "found %g, but the reference itself has an error of %.1e: expected at least %.1e",
            p->goal.error, p->own, br_flag_margin * p->own);
    return BR_OK;
}

/* Lists the places whose neighbours are known and whose cost is allowed. */
static enum br_status add_front(struct br_plan *p, double work, bool *left, struct br_error *err)
{
    const double allowed = allowed_seconds(p);
    const struct br_named_method *end = p->methods.list + p->methods.count;
    enum br_status status = BR_OK;
    *left = false;
    for (const struct br_named_method *m = p->methods.list; m < end; m++) {
        const size_t levels = m->method.scheme->adaptive ? TOLERANCES : STEPS;
        for (size_t i = 0; i < MESHES * levels && !status; i++) {
            const size_t place[] = {i / levels, i % levels};
            const struct br_trial trial = at_place(m, place[0], place[1]);
            if (find(p, 0, &trial) || !may_help(p, m, place) ||
                expected_seconds(p, &trial) > allowed)
                continue;
            *left = true;
            if (work_of(p, &trial) <= work)
                status = add(p, &trial, err);
        }
    }
    return status;
}

/* Waves of trials, each of at most three times the work of the one before. */
static enum br_status run_grid(struct br_plan *p, struct br_error *err)
{
    const size_t repeats = p->request.repeats;
    enum br_status status = BR_OK;
    bool left = true;
    p->request.repeats = 1;
    for (double work = 1.5e-5; left && !status; work *= p->grid == p->count ? 3 : 1) {
        p->grid = p->count;
        status = add_front(p, work, &left, err);
        if (!status && p->count > p->grid)
            status = br_trials_run(p->trial + p->grid, p->count - p->grid, &p->request, err);
        if (!status && p->count)
            status = check_grid(p, err);
    }
    p->request.repeats = repeats;
    p->grid = p->count;
    return status;
}

/* ---- around the best ---- */

enum { AROUND = 2 }; /* methods whose best trial is refined */

/* Meshes in factors of the square root of two and steps in factors of 10^(1/8), from one coarser
 * than the grid's neighbour to one finer than the best. */
static enum br_status add_around(struct br_plan *p, const struct br_trial *best,
                                 struct br_error *err)
{
    const bool adaptive = best->named->method.scheme->adaptive;
    enum br_status status = BR_OK;
    for (int i = -4; i <= 1; i++)
        for (int j = -4; j <= 1 && !status; j++) {
            const double n = round((double)best->at.n * pow(2, 0.5 * i));
            const double k = round((double)best->at.steps * pow(10, 0.125 * j));
            const double power = pow(10, floor(log10(best->tolerance)) - 0.25 * j);
            char text[32];
            snprintf(text, sizeof text, "%.3g", power); /* as a person types it */
            const struct br_trial trial =
                br_trial_at(best->named, (size_t)fmax(n, 1), adaptive ? 0 : (size_t)fmax(k, 10),
                            adaptive ? strtod(text, NULL) : 0);
            if (!find(p, p->grid, &trial) &&
                expected_seconds(p, &trial) <= 1.5 * allowed_seconds(p))
                status = add(p, &trial, err);
        }
    return status;
}

/* The best trial of each of the best methods, and what is around it, with all repeats. */
static enum br_status refine(struct br_plan *p, struct br_error *err)
{
    struct br_trial best[AROUND];
    size_t methods = 0;
    enum br_status status = BR_OK;
    bool taken[BR_MOST_NAMED_METHODS] = {false};
    for (; methods < AROUND; methods++) {
        size_t least = p->count;
        for (size_t m = 0; m < p->methods.count; m++) {
            const size_t i = best_of(p, 0, &p->methods.list[m]);
            if (!taken[m] && i < p->count &&
                (least == p->count || price_of(p, &p->trial[i]) < price_of(p, &p->trial[least])))
                least = i;
        }
        if (least == p->count)
            break;
        best[methods] = p->trial[least];
        taken[best[methods].named - p->methods.list] = true;
    }
    for (size_t i = 0; i < methods && !status; i++)
        status = add_around(p, &best[i], err);
    if (!status && p->count > p->grid)
        status = br_trials_run(p->trial + p->grid, p->count - p->grid, &p->request, err);
    if (!status) {
        p->chosen = best_of(p, p->grid, NULL);
        if (p->chosen == p->count) /* all repeats took longer than the one of the grid */
            p->chosen = best_of(p, 0, NULL);
    }
    return status;
}

/* ---- the plan ---- */

static enum br_status check_goal(const struct br_plan *p, struct br_error *err)
{
    const double e = p->goal.error, s = p->goal.seconds;
    if (isnan(e) == isnan(s))
        return br_fail(err, BR_BAD_INPUT, "a plan needs an error or seconds, and not both");
    if (!isnan(e) && !(e > 0 && e < 1))
        return br_fail(err, BR_BAD_INPUT, "found %g, expected a relative error between 0 and 1", e);
    if (!isnan(s) && !(s > 0 && isfinite(s)))
        return br_fail(err, BR_BAD_INPUT, "found %g, expected seconds > 0", s);
    return p->methods.count ? BR_OK : br_fail(err, BR_BAD_INPUT, "no method can march this scene");
}

enum br_status br_plan_make(struct br_plan *p, struct br_error *err)
{
    const double start = br_seconds();
    void *judge = NULL;
    enum br_status status = check_goal(p, err);
    if (!status)
        status = br_trials_keep_judge(&p->request, &judge, err);
    if (!status)
        status = run_grid(p, err);
    if (!status)
        status = refine(p, err);
    br_trials_forget_judge(&p->request, judge);
    p->wall_seconds = br_seconds() - start;
    return status;
}

double br_plan_spent(const struct br_plan *p)
{
    double sum = 0;
    for (size_t i = 0; i < p->count; i++)
        if (isfinite(br_trial_seconds(&p->trial[i])))
            sum += br_trial_seconds(&p->trial[i]);
    return sum;
}

void br_plan_clear(struct br_plan *p)
{
    free(p->trial);
    p->trial = NULL;
    p->count = p->room = 0;
}
