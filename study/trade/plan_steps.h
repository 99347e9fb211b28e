/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a plan is made of: the cheap trials, the models, the candidates of a round,
 * the choice at the end. */
#ifndef BR_STUDY_TRADE_PLAN_STEPS_H
#define BR_STUDY_TRADE_PLAN_STEPS_H

#include "study/trade/plan.h"

enum {
    BR_PLAN_LEAST_N = 1,
    BR_PLAN_LEAST_STEPS = 10, /* fewer would hardly look at the solution */
    BR_PLAN_LEVELS = 20,      /* where an adaptive scheme is looked at */
    BR_PLAN_BATCH = 8,        /* candidates of a round */
};

/* A resolution that might do. */
struct br_plan_candidate {
    const struct br_named_method *named;
    double n, y; /* whole elements; log of whole steps, or -log of the tolerance */
    double log_error, deviation, seconds;
    double score; /* of a gamble: what it may save times how likely that is */
};

struct br_plan_batch {
    struct br_plan_candidate candidate[BR_PLAN_BATCH];
    size_t count;
};

/* Adds a trial without an outcome; a proposal that was made before is not added (*added, out).
 * Fails with BR_NO_MEMORY. */
enum br_status br_plan_add(struct br_plan *plan, const struct br_trial *trial,
                           const struct br_plan_forecast *forecast, bool *added,
                           struct br_error *err);

/* Adds the cheap trials of all named methods. Fails with BR_NO_MEMORY. */
enum br_status br_plan_add_probes(struct br_plan *plan, struct br_error *err);

/* The y of a trial: log of its steps, or -log of its tolerance. */
double br_plan_y(const struct br_trial *trial);
struct br_trial br_plan_trial(const struct br_plan_candidate *candidate);

/* Fits the models of all named methods to their trials so far. Fails with BR_NO_MEMORY. */
enum br_status br_plan_fit(struct br_plan *plan, struct br_error *err);
void br_plan_forget(struct br_plan *plan); /* clears them */

/* The best candidates of every named method, by its index: the cheapest (or, for seconds, the most
 * accurate) safe one, and the most promising gamble; and the least error of all. A candidate
 * without a named method: none. */
struct br_plan_table {
    struct br_plan_candidate safe[BR_MOST_NAMED_METHODS], gamble[BR_MOST_NAMED_METHODS], explorer;
};
void br_plan_search(const struct br_plan *plan, size_t best, struct br_plan_table *table);

/* What the trial `best` costs: clocks err, so the model has a say, too. Infinite: count. */
double br_plan_best_seconds(const struct br_plan *plan, size_t best);

/* What to try next (out); nothing where no candidate promises anything. */
void br_plan_propose(const struct br_plan *plan, struct br_plan_batch *batch);

/* The trial that meets the goal best so far; count: none. */
size_t br_plan_best(const struct br_plan *plan);

/* Whether a trial's error is at most the goal's, or its seconds. */
bool br_plan_meets(const struct br_plan *plan, const struct br_trial *trial);

/* ---- the model of errors ---- */

struct br_plan_prediction {
    double log_error;
    double deviation; /* of log_error, as a factor's logarithm */
};

/* The value of a curve, and minus its slope: an order. */
double br_plan_curve_value(const struct br_plan_curve *curve, double at);
double br_plan_curve_order(const struct br_plan_curve *curve, double at);

/* Fits the model; p and q are the orders that theory expects, which count where nothing else does.
 * Fails with BR_BAD_INPUT (fewer than 4 points), BR_NO_MEMORY. Clear the model even then. */
enum br_status br_plan_model_fit(struct br_plan_model *model, const struct br_plan_point *point,
                                 size_t count, double p, double q, struct br_error *err);
void br_plan_model_clear(struct br_plan_model *model);

/* The model's own value, log e. */
double br_plan_model_value(const struct br_plan_model *model, double x, double y);

/* What to expect there. */
struct br_plan_prediction br_plan_model_predict(const struct br_plan_model *model, double x,
                                                double y);

struct br_plan_parts br_plan_model_parts(const struct br_plan_model *model, double x, double y);

/* ---- the model of costs ---- */

struct br_plan_work {
    double n, y;    /* elements; log of the steps, or -log of the tolerance */
    double solves;  /* as counted, > 0 */
    double seconds; /* > 0 */
};

/* Fails with BR_BAD_INPUT (no works) or BR_NO_MEMORY. */
enum br_status br_plan_cost_fit(struct br_plan_cost *cost, const struct br_plan_work *work,
                                size_t count, struct br_error *err);

/* Solves and seconds to expect. */
double br_plan_cost_solves(const struct br_plan_cost *cost, double y);
double br_plan_cost_seconds(const struct br_plan_cost *cost, double n, double y);

#endif
