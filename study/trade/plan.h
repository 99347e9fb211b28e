/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A plan: the cheapest way to an error, or the least error for so many seconds. It measures trials
 * of all named methods on one grid of meshes and steps, from the cheapest on, until no cheaper one
 * is left. Then it measures a finer grid around the best ones. Errors are relative: the norm of the
 * error over the norm of the solution, the judge's own error added. */
#ifndef BR_STUDY_TRADE_PLAN_H
#define BR_STUDY_TRADE_PLAN_H

#include "study/trade/trial.h"

/* One of the two; the other is NaN. */
struct br_plan_goal {
    double error;   /* relative */
    double seconds; /* of set-up and march */
};

struct br_plan {
    /* in */
    struct br_trial_request request;
    struct br_named_methods methods;
    struct br_plan_goal goal;
    double (*seconds)(const struct br_trial *); /* cost of a trial; default: br_trial_seconds */
    /* out */
    struct br_trial *trial; /* count; those of the grid, then those around the best; owned */
    size_t count, room;
    size_t grid;         /* trials of the grid */
    size_t chosen;       /* count: the goal is missed */
    double own;          /* the judge's own relative error, where it is least; NaN: not known */
    double wall_seconds; /* of all of it */
};

/* A request with its defaults: l2, marches of at most 60 s, seconds as measured. The named methods
 * of br_named_methods_default that keep the default solver and friction rule. Trials point to the
 * named methods, so do not move a plan that has trials. */
void br_plan_default(struct br_plan *plan, const struct br_scene *scene);

/* Makes the plan. Fails with BR_BAD_INPUT (a goal that makes no sense, or below the judge's own
 * error), BR_NOT_FINITE (no trial has an error), BR_NO_MEMORY, BR_INTERRUPTED. A goal that is
 * not reached is no failure: see `chosen`. Clear the plan even then. */
enum br_status br_plan_make(struct br_plan *plan, struct br_error *err);
void br_plan_clear(struct br_plan *plan);

/* Seconds of all trials' marches, once each. */
double br_plan_spent(const struct br_plan *plan);

#endif
