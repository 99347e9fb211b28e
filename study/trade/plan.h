/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A plan: the cheapest way to an error, or the least error for so many seconds. Cheap trials of
 * every named method give models of its errors and costs. The models propose cheaper trials, these
 * are run, and the models are fitted again, until no cheaper trial is likely to meet the goal.
 * Errors are relative: the norm of the error over the norm of the solution, the judge's own error
 * added. */
#ifndef BR_STUDY_TRADE_PLAN_H
#define BR_STUDY_TRADE_PLAN_H

#include "study/trade/trial.h"

/* A proposal aims at an error of at most E, and of at least E over this factor. */
extern const double br_plan_band;

/* One of the two; the other is NaN. */
struct br_plan_goal {
    double error;   /* relative */
    double seconds; /* of set-up and march */
};

/* How a plan ended. */
enum br_plan_end {
    BR_PLAN_MET,
    BR_PLAN_COARSEST, /* the coarsest mesh meets the goal, with an error below E/3 */
    BR_PLAN_BETTER,   /* met, with an error below E/3 */
    BR_PLAN_MISSED,   /* no trial reaches the goal */
};
extern const char *const br_plan_end_names[];

/* What was expected of a trial before it was run. */
struct br_plan_forecast {
    size_t round;          /* 0: a cheap trial for the first models */
    double error, seconds; /* NaN in round 0 */
};

/* ---- the model of one method, in plan_model.c ---- */

/* Errors: the space and the time error are fields that may point against each other (as in fit.h):
 *     e^2 = a^2 + 2 r a b + b^2,   a = a(n),  b = b(k), or b(tolerance).
 * No power law holds for b from the coarsest steps on: long steps miss what lies between their
 * ends, orders are reduced while k is above the relaxation time, and switching lowers the orders.
 * So log a and log b are piecewise linear in log n and log k, with a knot wherever there are
 * trials. A weak penalty on changes of slope keeps them smooth. The slopes are observed orders.
 *
 * Costs: seconds = c0 + c1 n + (c2 + c3 n) solves, all c >= 0, fitted to relative errors; the
 * solves are counted in the trials, and interpolated over the steps or the tolerance.
 *
 * The residuals of a model are deterministic, not noise. So a prediction adds the residual of the
 * nearest trial, with a weight that decays with the distance; its deviation grows as this decays.
 */
enum {
    BR_PLAN_MESHES = 8,
    BR_PLAN_PROBES = 10, /* numbers of steps, or tolerances, of the cheap trials */
    BR_PLAN_ROUNDS = 8,  /* at most */
    BR_PLAN_BATCH = 6,   /* trials of a round, at most */
    BR_PLAN_POINTS = BR_PLAN_MESHES * BR_PLAN_PROBES + BR_PLAN_ROUNDS * BR_PLAN_BATCH,
    BR_PLAN_COSTS = 4
};

/* The two variables of a model: log n; and log of the steps, or -log of the tolerance. Then the
 * quantities that it predicts. */
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
    bool known; /* enough of its trials are complete */
    size_t points;
    struct br_plan_point point[BR_PLAN_POINTS];
    struct br_plan_curve component[BR_PLAN_AXES]; /* log a of log n, log b of y */
    struct br_plan_curve solves;                  /* log of them, of y */
    double r;
    double cost[BR_PLAN_COSTS];         /* s, s per element, s per solve, s per element and solve */
    double scatter[BR_PLAN_QUANTITIES]; /* root mean squares of the residuals */
};

/* Fits the model to its points. p and q are the orders of theory; they have a small weight. Fails
 * with BR_BAD_INPUT (fewer than 4 points), BR_NO_MEMORY. */
enum br_status br_plan_model_fit(struct br_plan_model *model, double p, double q,
                                 struct br_error *err);

/* What a model predicts at a point. */
struct br_plan_prediction {
    double log[BR_PLAN_QUANTITIES];       /* of the predicted values */
    double deviation[BR_PLAN_QUANTITIES]; /* of these logarithms */
};
struct br_plan_prediction br_plan_model_predict(const struct br_plan_model *model,
                                                const double at[BR_PLAN_AXES]);

/* The space and the time error at a point, relative, and their orders. */
struct br_plan_components {
    double error[BR_PLAN_AXES], order[BR_PLAN_AXES];
};
struct br_plan_components br_plan_model_components(const struct br_plan_model *model,
                                                   const double at[BR_PLAN_AXES]);

/* ---- plans ---- */

struct br_plan {
    /* in */
    struct br_trial_request request;
    struct br_named_methods methods;
    struct br_plan_goal goal;
    double (*seconds)(
        const struct br_trial *trial); /* cost of a trial; default: br_trial_seconds */
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

/* The least that is proposed; fewer steps would hardly sample the solution. */
enum { BR_PLAN_LEAST_N = 1, BR_PLAN_LEAST_STEPS = 10 };

/* A request with its defaults: l2, marches of at most 60 s, seconds as measured. The named methods
 * of br_named_methods_default that keep the default solver and friction rule. Trials point to the
 * named methods, so do not move a plan that has trials. */
void br_plan_default(struct br_plan *plan, const struct br_scene *scene);

/* Lists the cheap trials that every plan begins with; runs none. Fails with BR_NO_MEMORY. */
enum br_status br_plan_lay_out(struct br_plan *plan, struct br_error *err);

/* Makes the plan. Fails with BR_BAD_INPUT (a goal that makes no sense, or below the judge's own
 * error), BR_NOT_FINITE (no trial has an error), BR_NO_MEMORY, BR_INTERRUPTED. A goal that is
 * not reached is no failure: see `end`. Clear the plan even then. */
enum br_status br_plan_make(struct br_plan *plan, struct br_error *err);
void br_plan_clear(struct br_plan *plan);

/* The space and the time error of the chosen trial, and their orders, as modelled; NaN: none. */
struct br_plan_components br_plan_chosen_components(const struct br_plan *plan);

/* Seconds of all trials' marches, once each. */
double br_plan_spent(const struct br_plan *plan);

#endif
