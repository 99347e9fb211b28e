/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/trade/trade.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/clock.h"
#include "solver/linear/linear_solver.h"
#include "study/fit/fit.h"

size_t br_trade_tally(const struct br_trade *trade, enum br_trial_end end)
{
    size_t count = 0;
    for (size_t i = 0; i < trade->count; i++)
        count += trade->trial[i].end == end;
    return count;
}

/* ---- choosing ---- */

/* Whether a took less than b; of equal seconds fewer solves are cheaper. */
static bool is_cheaper(const struct br_trial *a, const struct br_trial *b)
{
    const double x = br_trial_seconds(a), y = br_trial_seconds(b);
    return x < y || (!(x > y) && a->cost.counts.stages < b->cost.counts.stages);
}

/* Errors that differ by less count as equal: those of two linear solvers differ in the last bits.
 */
static const double tie = 1e-6;

/* Seconds of two trials that differ by less may change places when they are measured again. */
static const double scatter = 0.1;

static bool reaches(const struct br_trial *t, const struct br_trade_goal *goal)
{
    const double error = br_trial_bound(t), seconds = br_trial_seconds(t);
    return isfinite(error) && isfinite(seconds) && (!(goal->error > 0) || error <= goal->error) &&
           (!(goal->seconds > 0) || seconds <= goal->seconds);
}

/* Whether a is better than b, both of which reach the goal. */
static bool is_better(const struct br_trial *a, const struct br_trial *b,
                      const struct br_trade_goal *goal)
{
    return goal->error > 0 ? is_cheaper(a, b) : br_trial_bound(a) < br_trial_bound(b);
}

size_t br_trials_for_goal(const struct br_trial *trial, size_t count,
                          const struct br_trade_goal *goal, const struct br_named_method *only)
{
    size_t best = count;
    for (size_t i = 0; i < count; i++)
        if ((!only || trial[i].named == only) && reaches(&trial[i], goal) &&
            (best == count || is_better(&trial[i], &trial[best], goal)))
            best = i;
    if (best == count || !(goal->error > 0))
        return best;
    const struct br_trade_goal equal = {goal->error,
                                        (1 + scatter) * br_trial_seconds(&trial[best])};
    for (size_t i = 0; i < count; i++)
        if ((!only || trial[i].named == only) && reaches(&trial[i], &equal) &&
            (1 + tie) * br_trial_bound(&trial[i]) < br_trial_bound(&trial[best]))
            best = i;
    return best;
}

void br_trials_points(const struct br_trial *trial, size_t count,
                      const struct br_named_method *list, struct br_point *point)
{
    for (size_t i = 0; i < count; i++)
        point[i] = (struct br_point){
            .program = (size_t)(trial[i].named - list),
            .error = br_trial_bound(&trial[i]),
            .cost = br_trial_seconds(&trial[i]),
            .effort = (double)trial[i].cost.counts.stages,
        };
}

static void choose(struct br_trade *t)
{
    t->chosen =
        br_trade_has_goal(t) ? br_trials_for_goal(t->trial, t->count, &t->goal, NULL) : t->count;
    t->forecast.left = br_trade_tally(t, BR_TRIAL_LEFT); /* a goal that is reached may need fewer */
    br_trials_points(t->trial, t->count, t->methods.list, t->point);
    br_work_front(t->point, t->count);
    for (size_t d = 0; d < BR_TRADE_DIGITS; d++) {
        const double target = br_trade_target(d);
        t->best[d] = br_work_cheapest(t->point, t->count, target, SIZE_MAX, SIZE_MAX);
        for (size_t c = 0; c < t->methods.count; c++)
            t->best_of[c][d] = br_work_cheapest(t->point, t->count, target, c, SIZE_MAX);
    }
}

/* ---- searching for a goal ---- */

/* The most that a further trial may take, s: as much as the best one where an error is the goal. */
static double allowed_seconds(const struct br_trade *t)
{
    const double limit = t->request.time_limit > 0 ? t->request.time_limit : INFINITY;
    const size_t best = br_trials_for_goal(t->trial, t->count, &t->goal, NULL);
    if (!(t->goal.error > 0))
        return fmin(limit, t->goal.seconds);
    return best < t->count ? fmin(limit, br_trial_seconds(&t->trial[best])) : limit;
}

/* By those of the last trial of the method that is complete; 0: there is none. */
static double expected_seconds(const struct br_trade *t, const struct br_trial *trial)
{
    double seconds = 0;
    for (const struct br_trial *o = t->trial; o < t->trial + t->count; o++)
        if (o->named == trial->named && br_trial_seconds(o) > 0)
            seconds = br_trial_seconds(o) * trial->estimated / o->estimated;
    return seconds;
}

/* A goal far above the reference's own error alone can be resolved. */
static enum br_status check_reference(const struct br_trade *t, struct br_error *err)
{
    double own = INFINITY;
    for (const struct br_trial *o = t->trial; o < t->trial + t->count; o++)
        if (o->scale > 0 && isfinite(o->own))
            own = fmin(own, o->own / o->scale);
    if (!(t->goal.error > 0) || !isfinite(own) || t->goal.error >= br_flag_margin * own)
        return BR_OK;
    return br_fail(err, BR_BAD_INPUT,
                   "--error: found %g, but the reference itself has an error of %.1e: expected at "
                   "least %.1e",
                   t->goal.error, own, br_flag_margin * own);
}

/* By work, then in the order of the list. */
static int by_work(const void *a, const void *b)
{
    const struct br_trial *x = a, *y = b;
    const int work = (x->estimated > y->estimated) - (x->estimated < y->estimated);
    return work ? work : (x->named > y->named) - (x->named < y->named);
}

/* From the cheapest trials on, in waves of at most three times the work of their first trial. What
 * is expected to take too long when its wave comes is dropped. */
static enum br_status run_waves(struct br_trade *t, struct br_error *err)
{
    const size_t all = t->count;
    enum br_status status = BR_OK;
    for (size_t i = 0; i < all; i++)
        t->trial[i].estimated = br_trial_work(t->request.scene, &t->trial[i]);
    qsort(t->trial, all, sizeof *t->trial, by_work);
    t->count = 0;
    for (size_t next = 0; next < all && !status;) {
        const size_t done = t->count;
        const double most = 3 * t->trial[next].estimated;
        const double allowed = allowed_seconds(t);
        for (; next < all && t->trial[next].estimated <= most; next++)
            if (expected_seconds(t, &t->trial[next]) <= allowed)
                t->trial[t->count++] = t->trial[next];
        status = br_trials_run(t->trial + done, t->count - done, &t->request, err);
        if (!status)
            status = check_reference(t, err);
    }
    return status;
}

/* The trial so many places from another one: meshes are in factors of the square root of two, steps
 * of 10^(1/8), and tolerances, which have two digits, of the square root of ten. */
static struct br_trial beside(const struct br_trial *b, int mesh, int step)
{
    static const double fewest = 10, loosest = 0.1; /* fewer times would hide the error */
    char text[32];
    struct br_trial trial = br_trial_at(b->named, b->at.n, b->at.steps, b->tolerance);
    if (mesh)
        trial.at.n = (size_t)fmax(round((double)b->at.n * pow(2, 0.5 * mesh)), 1);
    if (step && b->named->method.scheme->adaptive) {
        snprintf(text, sizeof text, "%.2g", fmin(b->tolerance * pow(10, -0.5 * step), loosest));
        trial.tolerance = strtod(text, NULL);
    } else if (step) {
        trial.at.steps = (size_t)fmax(round((double)b->at.steps * pow(10, 0.125 * step)), fewest);
    }
    return trial;
}

/* Adds trials around trial `best` that are not there and are expected not to take too long: from
 * about its coarser neighbour to one that is finer than it or, if seconds are the goal, from one
 * that is coarser to about its finer neighbour. */
enum { PLACES = 6, AROUND = PLACES * PLACES };
static void add_around(struct br_trade *t, size_t best)
{
    const double allowed = 1.5 * allowed_seconds(t);
    const int last = t->goal.error > 0 ? 1 : PLACES - 2, first = last - PLACES + 1;
    for (int i = t->finer_n ? first : 0; i <= (t->finer_n ? last : 0); i++)
        for (int j = t->finer_steps ? first : 0; j <= (t->finer_steps ? last : 0); j++) {
            struct br_trial trial = beside(&t->trial[best], i, j);
            size_t same = 0;
            trial.estimated = br_trial_work(t->request.scene, &trial);
            while (same < t->count && !br_trials_same(&t->trial[same], &trial))
                same++;
            if (same == t->count && expected_seconds(t, &trial) <= allowed)
                t->trial[t->count++] = trial;
        }
}

/* Around the best trials of the two best methods. */
static enum br_status refine(struct br_trade *t, struct br_error *err)
{
    const size_t done = t->count, best = br_trials_for_goal(t->trial, done, &t->goal, NULL);
    size_t other = done;
    if (best == done)
        return BR_OK;
    for (size_t i = 0; i < done; i++)
        if (t->trial[i].named != t->trial[best].named && reaches(&t->trial[i], &t->goal) &&
            (other == done || is_better(&t->trial[i], &t->trial[other], &t->goal)))
            other = i;
    add_around(t, best);
    if (other < done)
        add_around(t, other);
    return br_trials_run(t->trial + done, t->count - done, &t->request, err);
}

/* ---- all of it ---- */

/* Creates the reference, which keeps its results for all later calls; NULL: it is not needed. */
static enum br_status prepare_reference(struct br_trade *t, struct br_error *err)
{
    const struct br_reference *reference = br_trials_reference(&t->request);
    const struct br_reference_request request = {
        .scene = t->request.scene, .levels = 1, .lead = 1, .observer = t->request.observer};
    return t->reference || reference->nests ? BR_OK
                                            : reference->create(&t->reference, &request, err);
}

/* The reference's set-up and the forecast itself count: as seconds of this thread, which do not
 * depend on other work of the machine. */
enum br_status br_trade_estimate(struct br_trade *t, struct br_error *err)
{
    const double start = br_seconds(), begin = br_thread_seconds(), seconds = t->request.seconds;
    enum br_status status = prepare_reference(t, err);
    if (seconds > 0)
        t->request.seconds = fmax(seconds - (br_thread_seconds() - begin), seconds / 10);
    if (!status)
        status = br_trials_estimate(t->trial, t->count, &t->request, &t->forecast, err);
    t->request.seconds = seconds;
    t->wall_seconds = br_seconds() - start;
    t->forecast.seconds += br_thread_seconds() - begin;
    return status;
}

enum br_status br_trade_run(struct br_trade *t, struct br_error *err)
{
    const double start = br_seconds();
    enum br_status status = BR_OK;
    if (!br_trade_has_goal(t))
        status = br_trials_run(t->trial, t->count, &t->request, err);
    else if (!(status = run_waves(t, err)))
        status = refine(t, err);
    if (!status)
        choose(t);
    t->wall_seconds += br_seconds() - start;
    return status;
}

void br_trade_clear(struct br_trade *t)
{
    if (t->reference)
        br_trials_reference(&t->request)->free(t->reference);
    free(t->trial);
    free(t->point);
    t->trial = NULL;
    t->point = NULL;
    t->reference = NULL;
    t->count = 0;
}

/* ---- the grid ---- */

/* Factors of about the square root of ten in time, and factors of four in space. */
static const size_t default_n[] = {25, 100, 400, 1600, 6400};
static const size_t default_steps[] = {10, 30, 100, 300, 1000, 3000, 10000};
static const double default_tolerance[] = {1e-2, 1e-4, 1e-6, 1e-8, 1e-10};

/* The same for a goal, which ends them. */
static const size_t goal_n[] = {1, 2, 6, 25, 100, 400, 1600, 6400, 25600, 102400};
static const size_t goal_steps[] = {10,    30,    100,    300,    1000,   3000,
                                    10000, 30000, 100000, 300000, 1000000};
static const double goal_tolerance[] = {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12};

/* The most element-stages of a trial in a default grid, by the default solver and by the others,
 * which are some 20 times slower; and the assumed steps of an adaptive scheme. */
static const double most_work = 4e6, most_slow_work = 4e5, guessed_steps = 100;

#define COUNT(list) (sizeof list / sizeof *list)
static const struct br_trade_grid defaults[] = {
    {default_n, default_steps, default_tolerance, COUNT(default_n), COUNT(default_steps),
     COUNT(default_tolerance), NULL},
    {goal_n, goal_steps, goal_tolerance, COUNT(goal_n), COUNT(goal_steps), COUNT(goal_tolerance),
     NULL}}; /* with a goal */

/* A grid with its defaults filled in. */
static struct br_trade_grid fill_in(struct br_trade_grid g, bool goal)
{
    const struct br_trade_grid *d = &defaults[goal];
    if (!g.n_count)
        g.n = d->n, g.n_count = d->n_count;
    if (!g.step_count)
        g.steps = d->steps, g.step_count = d->step_count;
    if (!g.tolerances)
        g.tolerance = d->tolerance, g.tolerances = d->tolerances;
    return g;
}

bool br_trade_is_printed_method(const struct br_named_method *c)
{
    const struct br_method *m = &c->method, paper = br_method_default();
    return m->scheme == paper.scheme && m->contact == paper.contact &&
           m->friction == paper.friction && m->axial_degree == paper.axial_degree;
}

/* Whether a trial is light enough for a default grid. */
static bool is_light(const struct br_named_method *c, size_t n, double steps)
{
    const double work = (double)n * steps * (double)br_time_scheme_stages(c->method.scheme);
    const bool quick = c->method.solver == br_linear_solvers[0];
    return work <= (quick ? most_work : most_slow_work);
}

/* Marks the trials that the paper prints and, if `all`, adds those that are missing. */
static void add_printed(struct br_trade *t, const struct br_trade_grid *g,
                        const struct br_named_method *c, bool all)
{
    for (size_t i = 0; g->printed && i < g->printed->count; i++) {
        struct br_trial trial = {.named = c, .at.n = g->printed->cell[i].n, .printed = true};
        size_t j = 0;
        if (br_steps_of(t->request.scene, g->printed->cell[i].k, &trial.at.steps, NULL))
            continue;
        while (j < t->count && !br_trials_same(&t->trial[j], &trial))
            j++;
        if (j < t->count)
            t->trial[j].printed = true;
        else if (all)
            t->trial[t->count++] = trial;
    }
}

static void add_named(struct br_trade *t, const struct br_trade_grid *g,
                      const struct br_named_method *c)
{
    const bool adaptive = c->method.scheme->adaptive;
    const bool capped_n = g->n == default_n, capped_steps = g->steps == default_steps;
    const bool capped = capped_n || (capped_steps && !adaptive);
    for (size_t i = 0; i < g->n_count; i++)
        for (size_t j = 0; j < (adaptive ? g->tolerances : g->step_count); j++) {
            const struct br_trial trial =
                br_trial_at(c, g->n[i], adaptive ? 0 : g->steps[j], adaptive ? g->tolerance[j] : 0);
            const double steps = adaptive ? guessed_steps : (double)trial.at.steps;
            if (!capped || is_light(c, trial.at.n, steps))
                t->trial[t->count++] = trial;
        }
    if (br_trade_is_printed_method(c))
        add_printed(t, g, c, capped_n && capped_steps);
}

enum br_status br_trade_lay_out(struct br_trade *t, const struct br_trade_grid *given,
                                struct br_error *err)
{
    const bool goal = br_trade_has_goal(t);
    const struct br_trade_grid g = fill_in(*given, goal);
    const size_t levels = g.tolerances > g.step_count ? g.tolerances : g.step_count;
    const size_t printed = g.printed ? g.printed->count : 0;
    const size_t finer = goal ? 2 * AROUND : 0;
    const size_t most = t->methods.count * (g.n_count * levels + printed) + finer + 1;
    t->count = 0;
    t->finer_n = !given->n_count;
    t->finer_steps = !given->step_count && !given->tolerances;
    t->trial = br_allocate(most, sizeof *t->trial);
    t->point = br_allocate(most, sizeof *t->point);
    if (!t->trial || !t->point)
        return br_no_memory(err, "the trials");
    for (size_t i = 0; i < t->methods.count; i++)
        add_named(t, &g, &t->methods.list[i]);
    return t->count ? BR_OK
                    : br_fail(err, BR_BAD_INPUT,
                              "there is nothing to try: no method can march this "
                              "scene");
}
