/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A plan: the cheapest way to an error, or the least error for so many seconds. Cheap trials of
 * every named method give models of its errors and costs. The models propose the cheapest
 * resolution, it is tried, the models are fitted again, and so on until nothing that is cheaper is
 * likely to do. Errors are relative: the norm of the error over the norm of the solution, the
 * judge's own error added. */
#ifndef BR_STUDY_TRADE_PLAN_H
#define BR_STUDY_TRADE_PLAN_H

#include "study/trade/trial.h"

/* The promise: a proposal's error is at most E, and not less than E over this. */
extern const double br_plan_band;

/* One of the two; the other is NaN. */
struct br_plan_goal {
    double error;   /* relative */
    double seconds; /* of set-up and march */
};

/* How a plan ended. */
enum br_plan_end {
    BR_PLAN_MET,
    BR_PLAN_COARSEST, /* the coarsest mesh does, and is better */
    BR_PLAN_BETTER,   /* no more was found between E/3 and E */
    BR_PLAN_MISSED,   /* nothing that was tried reaches the goal */
};
extern const char *const br_plan_end_names[];

/* What was expected of a trial before it was held. */
struct br_plan_forecast {
    size_t round;          /* 0: a cheap trial that the first models were made from */
    double error, seconds; /* NaN in round 0 */
};

/* What the errors of one method are at resolutions that were not tried: a model, fitted with GSL.
 *
 * The space and the time error are fields that may point against each other (as in fit.h):
 *     e^2 = a^2 + 2 r a b + b^2,   a = a(n),  b = b(k), or b(tolerance).
 * No power law holds for b from the coarsest steps on: long steps do not look at what lies between
 * their ends, orders are reduced while k is above the relaxation time, and switching spoils them.
 * So log a and log b are piecewise linear in log n and log k, with a knot wherever there are
 * trials, held smooth by a weak penalty on changes of slope: the slopes are the orders, as observed
 * there.
 *
 * What the model leaves over is deterministic, not noise: a prediction follows the residual of the
 * nearest trial, less so with the distance, and is the less certain. */

/* A trial as the model sees it. */
struct br_plan_point {
    double x;     /* log n */
    double y;     /* log of the steps, or -log of the tolerance */
    double error; /* relative, > 0 */
};

enum { BR_PLAN_KNOTS = 40 };

/* A piecewise linear function, with its end slopes beyond its ends. */
struct br_plan_curve {
    size_t count;
    double at[BR_PLAN_KNOTS], value[BR_PLAN_KNOTS];
};

struct br_plan_model {
    struct br_plan_curve space, time; /* log a of log n, log b of y */
    double r;
    double scatter; /* root mean square of log(error/model) */
    size_t points;
    struct br_plan_point *point; /* points; owned */
    double *residual;            /* points, log(error/model); owned */
};

/* The parts of the error, relative, and the observed orders. */
struct br_plan_parts {
    double space, time, p, q;
};

/* What a march of one method costs at resolutions that were not tried: a model, fitted with GSL.
 *     seconds = c0 + c1 n + (c2 + c3 n) solves,
 * all c >= 0, to relative errors; the solves are counted in the trials, and interpolated over the
 * steps or the tolerance. */
enum { BR_PLAN_COSTS = 4 };

struct br_plan_cost {
    double c[BR_PLAN_COSTS];     /* s, s per element, s per solve, s per element and solve */
    struct br_plan_curve solves; /* log of them, over y */
    double scatter;              /* root mean square of log(seconds/model) */
};

/* The models of one named method. */
struct br_plan_models {
    bool known; /* enough of its trials came to their end */
    struct br_plan_model error;
    struct br_plan_cost cost;
};

struct br_plan {
    /* in */
    struct br_trial_request request;
    struct br_named_methods methods;
    struct br_plan_goal goal;
    size_t most_rounds;
    double (*seconds)(const struct br_trial *trial); /* what a trial costs: br_trial_seconds */
    /* out */
    struct br_trial *trial;            /* count; owned */
    struct br_plan_forecast *forecast; /* count; owned */
    size_t count, rounds;
    size_t first;  /* the first proposal, the cheapest of round 1; count: none */
    size_t chosen; /* count: none */
    enum br_plan_end end;
    struct br_plan_models model[BR_MOST_NAMED_METHODS];
    double own;          /* the judge's own relative error, where it is least; NaN: not known */
    double wall_seconds; /* of all of it */
};

/* A request with its defaults: l2, marches of at most 60 s, 8 rounds, seconds as measured. The
 * named methods of br_named_methods_default that keep the default solver and friction rule.
 * Trials point to the named methods, so a plan that is made is not to be moved. */
void br_plan_default(struct br_plan *plan, const struct br_scene *scene);

/* Lays out the cheap trials that every plan begins with, and holds none. Fails with BR_NO_MEMORY.
 */
enum br_status br_plan_lay_out(struct br_plan *plan, struct br_error *err);

/* Makes the plan. Fails with BR_BAD_INPUT (a goal that makes no sense, or below the judge's own
 * error), BR_NOT_FINITE (no trial came to its end), BR_NO_MEMORY, BR_INTERRUPTED. A goal that is
 * not reached is no failure: see `end`. Clear the plan even then. */
enum br_status br_plan_make(struct br_plan *plan, struct br_error *err);
void br_plan_clear(struct br_plan *plan);

/* The parts of the chosen trial's error, and its observed orders, as modelled. */
struct br_plan_parts br_plan_chosen_parts(const struct br_plan *plan);

/* Seconds of all trials' marches, once each. */
double br_plan_spent(const struct br_plan *plan);

/* ---- among plan.c, plan_search.c (candidates) and plan_model.c ---- */

enum {
    BR_PLAN_LEAST_N = 1,
    BR_PLAN_LEAST_STEPS = 10, /* fewer would hardly look at the solution */
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
