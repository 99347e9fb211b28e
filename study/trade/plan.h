/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A plan: the cheapest way to an error, or the least error for so many seconds. Cheap trials of
 * every named method give models of its errors and costs. The models propose what might be
 * cheaper, it is tried, the models are fitted again, and so on until nothing that is cheaper is
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

/* ---- the model of one method, in plan_model.c ---- */

/* Errors: the space and the time error are fields that may point against each other (as in fit.h):
 *     e^2 = a^2 + 2 r a b + b^2,   a = a(n),  b = b(k), or b(tolerance).
 * No power law holds for b from the coarsest steps on: long steps do not look at what lies between
 * their ends, orders are reduced while k is above the relaxation time, and switching spoils them.
 * So log a and log b are piecewise linear in log n and log k, with a knot wherever there are
 * trials, held smooth by a weak penalty on changes of slope: the slopes are the orders, as observed
 * there.
 *
 * Costs: seconds = c0 + c1 n + (c2 + c3 n) solves, all c >= 0, to relative errors; the solves are
 * counted in the trials, and interpolated over the steps or the tolerance.
 *
 * What a model leaves over is deterministic, not noise: a prediction follows the residual of the
 * nearest trial, less so with the distance, and is the less certain. */
enum {
    BR_PLAN_MESHES = 8,
    BR_PLAN_PROBES = 10, /* numbers of steps, or tolerances, of the cheap trials */
    BR_PLAN_ROUNDS = 8,  /* at most */
    BR_PLAN_BATCH = 6,   /* trials of a round, at most */
    BR_PLAN_POINTS = BR_PLAN_MESHES * BR_PLAN_PROBES + BR_PLAN_ROUNDS * BR_PLAN_BATCH,
    BR_PLAN_COSTS = 4
};

/* The two variables of a model: log n; and log of the steps, or -log of the tolerance. What it
 * tells there. */
enum br_plan_axis { BR_PLAN_X, BR_PLAN_Y, BR_PLAN_AXES };
enum br_plan_quantity { BR_PLAN_ERROR, BR_PLAN_SECONDS, BR_PLAN_QUANTITIES };

/* A trial as the model sees it. */
struct br_plan_point {
    double at[BR_PLAN_AXES];
    double value[BR_PLAN_QUANTITIES];    /* the error relative; > 0 */
    double solves;                       /* > 0 */
    double residual[BR_PLAN_QUANTITIES]; /* out: log(value/model) */
};

/* A piecewise linear function, with its end slopes beyond its ends. */
struct br_plan_curve {
    size_t count;
    double at[BR_PLAN_POINTS], value[BR_PLAN_POINTS];
};

struct br_plan_model {
    bool known; /* enough of its trials came to their end */
    size_t points;
    struct br_plan_point point[BR_PLAN_POINTS];
    struct br_plan_curve part[BR_PLAN_AXES]; /* log a of log n, log b of y */
    struct br_plan_curve solves;             /* log of them, of y */
    double r;
    double cost[BR_PLAN_COSTS];         /* s, s per element, s per solve, s per element and solve */
    double scatter[BR_PLAN_QUANTITIES]; /* root mean squares of the residuals */
};

/* Fits the model to its points; p and q are the orders that theory expects, which count where
 * nothing else does. Fails with BR_BAD_INPUT (fewer than 4 points), BR_NO_MEMORY. */
enum br_status br_plan_model_fit(struct br_plan_model *model, double p, double q,
                                 struct br_error *err);

/* What to expect there. */
struct br_plan_prediction {
    double log[BR_PLAN_QUANTITIES];       /* of what is expected */
    double deviation[BR_PLAN_QUANTITIES]; /* of these logarithms */
};
struct br_plan_prediction br_plan_model_predict(const struct br_plan_model *model,
                                                const double at[BR_PLAN_AXES]);

/* The parts of the error there, relative, and their orders. */
struct br_plan_parts {
    double error[BR_PLAN_AXES], order[BR_PLAN_AXES];
};
struct br_plan_parts br_plan_model_parts(const struct br_plan_model *model,
                                         const double at[BR_PLAN_AXES]);

/* ---- plans ---- */

struct br_plan {
    /* in */
    struct br_trial_request request;
    struct br_named_methods methods;
    struct br_plan_goal goal;
    double (*seconds)(const struct br_trial *trial); /* what a trial costs: br_trial_seconds */
    /* out */
    struct br_trial *trial;            /* count; owned */
    struct br_plan_forecast *forecast; /* count; owned */
    size_t count, rounds;
    size_t first;  /* the first proposal, the most promising of round 1; count: none */
    size_t chosen; /* count: none */
    enum br_plan_end end;
    struct br_plan_model *model; /* of each named method; owned */
    double own;                  /* the judge's own relative error, where it is least; NaN: not
                                    known */
    double wall_seconds;         /* of all of it */
};

/* The least that is proposed; fewer steps would hardly look at the solution. */
enum { BR_PLAN_LEAST_N = 1, BR_PLAN_LEAST_STEPS = 10 };

/* A request with its defaults: l2, marches of at most 60 s, seconds as measured. The named methods
 * of br_named_methods_default that keep the default solver and friction rule. Trials point to the
 * named methods, so a plan that is made is not to be moved. */
void br_plan_default(struct br_plan *plan, const struct br_scene *scene);

/* Lays out the cheap trials that every plan begins with, and holds none. Fails with BR_NO_MEMORY.
 */
enum br_status br_plan_lay_out(struct br_plan *plan, struct br_error *err);

/* Makes the plan. Fails with BR_BAD_INPUT (a goal that makes no sense, or below the judge's own
 * error), BR_NOT_FINITE (no trial came to its end), BR_NO_MEMORY, BR_INTERRUPTED. A goal that is
 * not reached is no failure: see `end`. Clear the plan even then. */
enum br_status br_plan_make(struct br_plan *plan, struct br_error *err);
void br_plan_clear(struct br_plan *plan);

/* The parts of the chosen trial's error, and its observed orders, as modelled; NaN: none. */
struct br_plan_parts br_plan_chosen_parts(const struct br_plan *plan);

/* Seconds of all trials' marches, once each. */
double br_plan_spent(const struct br_plan *plan);

#endif
