/* SPDX-License-Identifier: GPL-3.0-or-later */
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
#ifndef BR_STUDY_TRADE_PLAN_MODEL_H
#define BR_STUDY_TRADE_PLAN_MODEL_H

#include <stdbool.h>

#include "solver/status.h"

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

/* The parts of the error, relative, and the observed orders there. */
struct br_plan_parts {
    double space, time, p, q;
};
struct br_plan_parts br_plan_model_parts(const struct br_plan_model *model, double x, double y);

#endif
