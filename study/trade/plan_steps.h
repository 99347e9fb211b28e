/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a plan is made of: candidates and their search (plan_search.c), models (plan_model.c). */
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
    double rank; /* the least is tried first: seconds, error, or minus a gamble's score */
};

struct br_plan_batch {
    struct br_plan_candidate candidate[BR_PLAN_BATCH];
    size_t count;
};

/* Whether a trial was proposed before or, if `cheap`, was one of the cheap trials. */
bool br_plan_has(const struct br_plan *plan, const struct br_trial *trial, bool cheap);

/* The y of a trial: log of its steps, or -log of its tolerance. */
double br_plan_y(const struct br_trial *trial);
struct br_trial br_plan_trial(const struct br_plan_candidate *candidate);

/* What to try next (out); nothing where no candidate promises anything. */
void br_plan_propose(const struct br_plan *plan, struct br_plan_batch *batch);

/* The trial that meets the goal best so far; count: none. */
size_t br_plan_best(const struct br_plan *plan);

/* ---- the model of errors ---- */

struct br_plan_prediction {
    double log_error;
    double deviation; /* of log_error, as a factor's logarithm */
};

/* Fits the model; p and q are the orders that theory expects, which count where nothing else does.
 * Fails with BR_BAD_INPUT (fewer than 4 points), BR_NO_MEMORY. Clear the model even then. */
enum br_status br_plan_model_fit(struct br_plan_model *model, const struct br_plan_point *point,
                                 size_t count, double p, double q, struct br_error *err);
void br_plan_model_clear(struct br_plan_model *model);

/* What to expect there. */
struct br_plan_prediction br_plan_model_predict(const struct br_plan_model *model, double x,
                                                double y);

/* The parts of the error and the orders there. */
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
