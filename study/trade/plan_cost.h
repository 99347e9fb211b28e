/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a march of one method costs at resolutions that were not tried: a model, fitted with GSL.
 *     seconds = c0 + c1 n + (c2 + c3 n) solves,
 * all c >= 0, to relative errors; the solves are counted in the trials, and interpolated over the
 * steps or the tolerance. */
#ifndef BR_STUDY_TRADE_PLAN_COST_H
#define BR_STUDY_TRADE_PLAN_COST_H

#include "study/trade/plan_model.h"

struct br_plan_work {
    double n, y;    /* elements; log of the steps, or -log of the tolerance */
    double solves;  /* as counted, > 0 */
    double seconds; /* > 0 */
};

enum { BR_PLAN_COSTS = 4 };

struct br_plan_cost {
    double c[BR_PLAN_COSTS];     /* s, s per element, s per solve, s per element and solve */
    struct br_plan_curve solves; /* log of them, over y */
    double scatter;              /* root mean square of log(seconds/model) */
};

/* Fails with BR_BAD_INPUT (no works) or BR_NO_MEMORY. */
enum br_status br_plan_cost_fit(struct br_plan_cost *cost, const struct br_plan_work *work,
                                size_t count, struct br_error *err);

/* Solves and seconds to expect. */
double br_plan_cost_solves(const struct br_plan_cost *cost, double y);
double br_plan_cost_seconds(const struct br_plan_cost *cost, double n, double y);

#endif
