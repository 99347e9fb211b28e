/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a digit costs in one scene: trials of many methods at many resolutions, the Pareto front of
 * their errors and seconds, and the cheapest way to each error. Errors are relative: the norm of
 * the error over the norm of the solution.
 *
 * With a goal the trials begin with the cheapest ones and end where nothing cheaper is left; then
 * come finer meshes and steps around the best two methods. */
#ifndef BR_STUDY_TRADE_TRADE_H
#define BR_STUDY_TRADE_TRADE_H

#include <math.h>

#include "orders/work.h"
#include "reference/printed.h"
#include "study/trade/trial.h"

/* Targets: relative errors of 1e-2 to 1e-10. */
enum { BR_TRADE_FIRST_DIGIT = 2, BR_TRADE_DIGITS = 9 };
/* digit: 0 .. BR_TRADE_DIGITS - 1 */
static inline double br_trade_target(size_t digit)
{
    return pow(10, -(double)(BR_TRADE_FIRST_DIGIT + digit));
}

/* The resolutions to try. Lists are borrowed; an empty one means the default. */
struct br_trade_grid {
    const size_t *n, *steps;
    const double *tolerance; /* of adaptive schemes */
    size_t n_count, step_count, tolerances;
    const struct br_printed *printed; /* the scene's printed table; NULL: none */
};

/* One of the two, or none; 0: not wanted. */
struct br_trade_goal {
    double error;   /* the cheapest trial with at most this relative error */
    double seconds; /* the least error with at most these seconds of set-up and march */
};

struct br_trade {
    struct br_named_methods methods;
    struct br_trial_request request;
    struct br_trade_goal goal;
    bool finer_n, finer_steps; /* whether a goal is searched between the meshes, the steps */
    size_t chosen;             /* the trial for the goal; `count`: none reaches it */
    struct br_trial *trial;    /* count, those of a named method together; owned */
    size_t count;
    struct br_point *point;       /* count: of the trials, with their fronts; owned */
    size_t best[BR_TRADE_DIGITS]; /* the cheapest trial to each target; `count`: none */
    /* Likewise of each named method. */
    size_t best_of[BR_MOST_NAMED_METHODS][BR_TRADE_DIGITS];
    struct br_trial_forecast forecast;
    void *reference;     /* kept since br_trade_estimate; owned */
    double wall_seconds; /* of all of it */
};

/* Lists the trials of trade->methods. A default list is coarse and leaves out heavy trials; if both
 * lists are the defaults, the paper's method also gets the printed table's cells. With a goal the
 * defaults are longer, and leave out nothing.
 * Fails with BR_NO_MEMORY, BR_BAD_INPUT (no trial at all). */
enum br_status br_trade_lay_out(struct br_trade *trade, const struct br_trade_grid *grid,
                                struct br_error *err);

/* Forecasts the seconds of the trials by `request`. Fails as br_trials_estimate does. */
enum br_status br_trade_estimate(struct br_trade *trade, struct br_error *err);

/* Runs the trials and chooses the best; after br_trade_estimate. Fails as br_trials_run does, or
 * with BR_BAD_INPUT: the reference's own error is not far below the goal. */
enum br_status br_trade_run(struct br_trade *trade, struct br_error *err);
void br_trade_clear(struct br_trade *trade);

/* Whether a named method is the paper's own method. */
bool br_trade_is_printed_method(const struct br_named_method *named);

/* -log10 of the relative error, over the seconds; NaN: no trial that counts. */
static inline double br_trade_digits_per_second(const struct br_trial *trial)
{
    if (!isfinite(br_trial_bound(trial)))
        return NAN;
    return -log10(br_trial_relative(trial)) / br_trial_seconds(trial);
}

static inline bool br_trade_has_goal(const struct br_trade *trade)
{
    return trade->goal.error > 0 || trade->goal.seconds > 0;
}

/* The number of trials with this end. */
size_t br_trade_tally(const struct br_trade *trade, enum br_trial_end end);

/* ---- choosing ---- */

/* The trial for a goal, of one named method or of all (NULL); `count`: none reaches it. Of trials
 * whose seconds differ by no more than the clock scatters, the one with the smallest error. */
size_t br_trials_for_goal(const struct br_trial *trial, size_t count,
                          const struct br_trade_goal *goal, const struct br_named_method *only);

/* Their points (out, count): bounds of the errors over seconds; program: the place of the named
 * method in its list. */
void br_trials_points(const struct br_trial *trial, size_t count,
                      const struct br_named_method *list, struct br_point *point);

#endif
