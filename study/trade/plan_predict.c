/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a model of errors says of resolutions that were not tried. */
#include <math.h>

#include "study/trade/plan_model.h"

/* Distances, as logarithms, at which a residual has lost 1/e of its say. */
static const double reach_x = 0.7, reach_y = 0.25;

/* What a prediction is unsure by at least, and more for each unit beyond the knots. */
static const double least_deviation = 0.03, beyond_x = 0.5, beyond_y = 0.3;

static double excess(const struct br_plan_curve *c, double at)
{
    return fmax(0, fmax(c->at[0] - at, at - c->at[c->count - 1]));
}

struct br_plan_prediction br_plan_model_predict(const struct br_plan_model *m, double x, double y)
{
    double nearest = INFINITY, residual = 0;
    for (size_t i = 0; i < m->points; i++) {
        const double distance = hypot((m->point[i].x - x) / reach_x, (m->point[i].y - y) / reach_y);
        if (distance <= nearest) {
            nearest = distance;
            residual = m->residual[i];
        }
    }
    const double say = exp(-nearest);
    const double unknown = m->scatter * sqrt(1 - say * say);
    const double beyond = beyond_x * excess(&m->space, x) + beyond_y * excess(&m->time, y);
    return (struct br_plan_prediction){
        .log_error = br_plan_model_value(m, x, y) + say * residual,
        .deviation = hypot(hypot(least_deviation * fmin(1, nearest), unknown), beyond),
    };
}

struct br_plan_parts br_plan_model_parts(const struct br_plan_model *m, double x, double y)
{
    return (struct br_plan_parts){
        .space = exp(br_plan_curve_value(&m->space, x)),
        .time = exp(br_plan_curve_value(&m->time, y)),
        .p = br_plan_curve_order(&m->space, x),
        .q = br_plan_curve_order(&m->time, y),
    };
}
