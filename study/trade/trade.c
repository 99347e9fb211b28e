/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/trade/trade.h"

#include <math.h>

#include "solver/clock.h"
#include "solver/linear/linear_solver.h"

double br_trade_target(size_t digit)
{
    return pow(10, -(double)(BR_TRADE_FIRST_DIGIT + digit));
}

double br_trade_digits_per_second(const struct br_trial *trial)
{
    if (!isfinite(br_trial_bound(trial)))
        return NAN;
    return -log10(br_trial_relative(trial)) / br_trial_seconds(trial);
}

double br_trade_seconds_of_all(const struct br_trial_forecast *o)
{
    return ceil(1.3 * (o->seconds + o->left_seconds));
}

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

size_t br_trials_cheapest(const struct br_trial *trial, size_t count, double target,
                          const struct br_named_method *only)
{
    size_t best = count;
    for (size_t i = 0; i < count; i++) {
        if (only && trial[i].named != only)
            continue;
        if (!(br_trial_bound(&trial[i]) <= target) || !isfinite(br_trial_seconds(&trial[i])))
            continue;
        if (best == count || is_cheaper(&trial[i], &trial[best]))
            best = i;
    }
    return best;
}

/* Errors that differ by less count as equal: those of two linear solvers differ in the last bits.
 */
static const double tie = 1e-6;

/* Whether b is better than a; of equals the earlier is better. */
static bool is_beaten(const struct br_trial *a, const struct br_trial *b)
{
    const double error = br_trial_bound(a), other_error = br_trial_bound(b);
    const double seconds = br_trial_seconds(a), other_seconds = br_trial_seconds(b);
    if (other_seconds < seconds)
        return other_error <= (1 + tie) * error;
    return other_seconds <= seconds && (other_error < error || (other_error <= error && b < a));
}

void br_trials_front(const struct br_trial *trial, size_t count, bool *front)
{
    for (size_t i = 0; i < count; i++) {
        front[i] = isfinite(br_trial_bound(&trial[i])) && isfinite(br_trial_seconds(&trial[i]));
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

/* The judge's set-up and the forecast itself count: as seconds of this thread, which do not depend
 * on other work of the machine. */
enum br_status br_trade_foresee(struct br_trade *t, struct br_error *err)
{
    const double start = br_seconds(), begin = br_thread_seconds(), seconds = t->request.seconds;
    enum br_status status = br_trials_keep_judge(&t->request, &t->judge, err);
    if (seconds > 0)
        t->request.seconds = fmax(seconds - (br_thread_seconds() - begin), seconds / 10);
    if (!status)
        status = br_trials_foresee(t->trial, t->count, &t->request, &t->forecast, err);
    t->request.seconds = seconds;
    t->wall_seconds = br_seconds() - start;
    t->forecast.seconds += br_thread_seconds() - begin;
    return status;
}

enum br_status br_trade_run(struct br_trade *t, struct br_error *err)
{
    const double start = br_seconds();
    const enum br_status status = br_trials_run(t->trial, t->count, &t->request, err);
    if (!status)
        choose(t);
    t->wall_seconds += br_seconds() - start;
    return status;
}

void br_trade_clear(struct br_trade *t)
{
    br_trials_forget_judge(&t->request, t->judge);
    free(t->trial);
    free(t->front);
    t->trial = NULL;
    t->front = NULL;
    t->judge = NULL;
    t->count = 0;
}

/* ---- the grid ---- */

/* Factors of about the square root of ten in time, and factors of four in space, which nest. */
static const size_t default_n[] = {25, 100, 400, 1600, 6400};
static const size_t default_steps[] = {10, 30, 100, 300, 1000, 3000, 10000};
static const double default_tolerance[] = {1e-2, 1e-4, 1e-6, 1e-8, 1e-10};

/* The most element-stages of a trial in a default grid, by the default solver and by the others,
 * which are some 20 times slower; and the assumed steps of an adaptive scheme. */
static const double most_work = 4e6, most_slow_work = 4e5, guessed_steps = 100;

enum {
    DEFAULT_N = sizeof default_n / sizeof *default_n,
    DEFAULT_STEPS = sizeof default_steps / sizeof *default_steps,
    DEFAULT_TOLERANCES = sizeof default_tolerance / sizeof *default_tolerance
};

/* A grid with its defaults filled in. */
static struct br_trade_grid fill_in(struct br_trade_grid g)
{
    if (!g.n_count)
        g.n = default_n, g.n_count = DEFAULT_N;
    if (!g.step_count)
        g.steps = default_steps, g.step_count = DEFAULT_STEPS;
    if (!g.tolerances)
        g.tolerance = default_tolerance, g.tolerances = DEFAULT_TOLERANCES;
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
    const struct br_trade_grid g = fill_in(*given);
    const size_t levels = g.tolerances > g.step_count ? g.tolerances : g.step_count;
    const size_t printed = g.printed ? g.printed->count : 0;
    const size_t most = t->methods.count * (g.n_count * levels + printed) + 1;
    t->count = 0;
    t->trial = br_allocate(most, sizeof *t->trial);
    t->front = br_allocate(most, sizeof *t->front);
    if (!t->trial || !t->front)
        return br_no_memory(err, "the trials");
    for (size_t i = 0; i < t->methods.count; i++)
        add_named(t, &g, &t->methods.list[i]);
    return t->count ? BR_OK
                    : br_fail(err, BR_BAD_INPUT,
                              "there is nothing to try: no method can march this "
                              "scene");
}
