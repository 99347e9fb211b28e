/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/trade/plan.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit_nlinear.h>
#include <gsl/gsl_sort.h>
#include <math.h>

/* Weights relative to a trial's log error: of a change of slope at a knot, of a slope's distance
 * from the order of theory, and of atanh r. */
static const double smoothness = 0.03, theory = 0.003, uncorrelated = 0.003;

/* The smoothness of a first, almost straight fit: without it a knot may stay on the wrong side of a
 * cancellation. */
static const double straight = 1;

/* Error fields are never exactly opposite; with |r| = 1 the modelled error could be 0. */
static const double most_r = 0.95;

/* Knots nearer than this are merged: factors of 1.5 in n, 1.15 in k. */
static const double least_gap[BR_PLAN_AXES] = {0.4, 0.14};

/* ---- curves ---- */

/* The piece that contains `at`, or the nearest one. */
static size_t piece_of(const struct br_plan_curve *c, double at)
{
    size_t i = 0;
    while (i + 2 < c->count && at > c->at[i + 1])
        i++;
    return i;
}

/* Minus the slope of a curve. */
static double curve_order(const struct br_plan_curve *c, double at)
{
    const size_t i = piece_of(c, at);
    return c->count < 2 ? 0 : -(c->value[i + 1] - c->value[i]) / (c->at[i + 1] - c->at[i]);
}

static double curve_value(const struct br_plan_curve *c, double at)
{
    const size_t i = piece_of(c, at);
    return c->value[i] - curve_order(c, at) * (at - c->at[i]);
}

/* Places the knots of the model at its trials, and merges near ones. */
static void lay_knots(struct br_plan_model *m, int axis)
{
    struct br_plan_curve *c = &m->component[axis];
    double at[BR_PLAN_POINTS];
    for (size_t i = 0; i < m->points; i++)
        at[i] = m->point[i].at[axis];
    gsl_sort(at, 1, m->points);
    c->count = 0;
    for (size_t i = 0; i < m->points; i++)
        if (c->count == 0 || at[i] - c->at[c->count - 1] > least_gap[axis])
            c->at[c->count++] = at[i];
}

/* ---- values ---- */

static void terms_of(double n, double solves, double term[BR_PLAN_COSTS])
{
    term[0] = 1;
    term[1] = n;
    term[2] = solves;
    term[3] = n * solves;
}

static double log_seconds(const struct br_plan_model *m, const double at[BR_PLAN_AXES])
{
    double term[BR_PLAN_COSTS], sum = 0;
    terms_of(exp(at[BR_PLAN_X]), exp(curve_value(&m->solves, at[BR_PLAN_Y])), term);
    for (int i = 0; i < BR_PLAN_COSTS; i++)
        sum += m->cost[i] * term[i];
    return log(sum);
}

static double log_error(const struct br_plan_model *m, const double at[BR_PLAN_AXES])
{
    const double a = curve_value(&m->component[BR_PLAN_X], at[BR_PLAN_X]);
    const double b = curve_value(&m->component[BR_PLAN_Y], at[BR_PLAN_Y]);
    const double ratio = exp(-fabs(a - b)), square = 1 + 2 * m->r * ratio + ratio * ratio;
    return fmax(a, b) + 0.5 * log(fmax(square, 1e-6));
}

/* The logarithm of the modelled value. */
static double model_value(const struct br_plan_model *m, int quantity,
                          const double at[BR_PLAN_AXES])
{
    return quantity == BR_PLAN_ERROR ? log_error(m, at) : log_seconds(m, at);
}

static void measure_residuals(struct br_plan_model *m, int quantity)
{
    double sum = 0;
    for (struct br_plan_point *p = m->point; p < m->point + m->points; p++) {
        const double residual = log(p->value[quantity]) - model_value(m, quantity, p->at);
        p->residual[quantity] = residual;
        sum += residual * residual;
    }
    m->scatter[quantity] = sqrt(sum / (double)m->points);
}

/* ---- errors ---- */

struct fit {
    struct br_plan_model *model;
    double order[BR_PLAN_AXES]; /* by theory */
    double smoothness;
};

/* The unknowns: the knots' values, and atanh of r. */
static size_t unknowns(const struct br_plan_model *m)
{
    return m->component[BR_PLAN_X].count + m->component[BR_PLAN_Y].count + 1;
}

static void take_unknowns(struct br_plan_model *m, const gsl_vector *v)
{
    size_t next = 0;
    for (int axis = 0; axis < BR_PLAN_AXES; axis++)
        for (size_t i = 0; i < m->component[axis].count; i++)
            m->component[axis].value[i] = gsl_vector_get(v, next++);
    m->r = most_r * tanh(gsl_vector_get(v, next));
}

/* A row for each trial, for each slope and for each change of slope, and one for r. */
static size_t rows_of(const struct br_plan_model *m)
{
    size_t rows = m->points + 1;
    for (int axis = 0; axis < BR_PLAN_AXES; axis++)
        rows += m->component[axis].count < 2 ? 0 : 2 * m->component[axis].count - 3;
    return rows;
}

static int residuals(const gsl_vector *v, void *self, gsl_vector *out)
{
    const struct fit *fit = self;
    struct br_plan_model *m = fit->model;
    size_t row = 0;
    take_unknowns(m, v);
    for (; row < m->points; row++) {
        const double f = log(m->point[row].value[BR_PLAN_ERROR]) - log_error(m, m->point[row].at);
        if (!isfinite(f))
            return GSL_EDOM;
        gsl_vector_set(out, row, f);
    }
    for (int axis = 0; axis < BR_PLAN_AXES; axis++) {
        const struct br_plan_curve *c = &m->component[axis];
        for (size_t i = 0; i + 1 < c->count; i++) {
            const double order = curve_order(c, c->at[i + 1]);
            gsl_vector_set(out, row++, theory * (order - fit->order[axis]));
            if (i > 0)
                gsl_vector_set(out, row++, fit->smoothness * (order - curve_order(c, c->at[i])));
        }
    }
    gsl_vector_set(out, row, uncorrelated * gsl_vector_get(v, unknowns(m) - 1));
    return GSL_SUCCESS;
}

/* The logarithm of the least error at a knot: an upper bound of the knot's component. */
static double least_error_near(const struct br_plan_model *m, int axis, double at)
{
    double least = INFINITY;
    for (const struct br_plan_point *p = m->point; p < m->point + m->points; p++)
        if (fabs(p->at[axis] - at) <= 1e-9)
            least = fmin(least, p->value[BR_PLAN_ERROR]);
    return log(least);
}

static void start(const struct br_plan_model *m, double atanh_r, gsl_vector *v)
{
    size_t next = 0;
    for (int axis = 0; axis < BR_PLAN_AXES; axis++)
        for (size_t i = 0; i < m->component[axis].count; i++)
            gsl_vector_set(v, next++, least_error_near(m, axis, m->component[axis].at[i]) - 0.35);
    gsl_vector_set(v, next, atanh_r);
}

/* Where the components nearly cancel there is more than one minimum: the best fit of several starts
 * counts, converged or not, since its residuals show its quality. */
static enum br_status fit_errors(struct fit *fit, struct br_error *err)
{
    static const double starts[] = {0, 0.7, -0.7};
    struct br_plan_model *m = fit->model;
    const gsl_multifit_nlinear_parameters parameters = gsl_multifit_nlinear_default_parameters();
    gsl_multifit_nlinear_fdf fdf = {
        .f = residuals, .n = rows_of(m), .p = unknowns(m), .params = fit};
    gsl_multifit_nlinear_workspace *w =
        gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &parameters, fdf.n, fdf.p);
    gsl_vector *v = gsl_vector_alloc(fdf.p), *best = gsl_vector_alloc(fdf.p);
    const bool ready = w && v && best;
    double least = INFINITY;
    int info = 0;
    for (size_t i = 0; i < sizeof starts / sizeof *starts && ready; i++) {
        start(m, starts[i], v);
        for (int pass = 0; pass < 2; pass++) {
            fit->smoothness = pass == 0 ? straight : smoothness;
            gsl_multifit_nlinear_init(v, &fdf, w);
            gsl_multifit_nlinear_driver(60, 1e-8, 1e-8, 0, NULL, NULL, &info, w);
            gsl_vector_memcpy(v, gsl_multifit_nlinear_position(w));
        }
        take_unknowns(m, v);
        measure_residuals(m, BR_PLAN_ERROR);
        if (i == 0 || m->scatter[BR_PLAN_ERROR] < least) {
            least = m->scatter[BR_PLAN_ERROR];
            gsl_vector_memcpy(best, v);
        }
    }
    if (ready)
        take_unknowns(m, best);
    gsl_multifit_nlinear_free(w);
    gsl_vector_free(v);
    gsl_vector_free(best);
    return ready ? BR_OK : br_no_memory(err, "the error model");
}

/* ---- costs ---- */

/* The mean logarithm of the solves at each knot in y. */
static void average_solves(struct br_plan_model *m)
{
    m->solves = m->component[BR_PLAN_Y];
    for (size_t i = 0; i < m->solves.count; i++) {
        double sum = 0, members = 0;
        for (const struct br_plan_point *p = m->point; p < m->point + m->points; p++)
            if (fabs(p->at[BR_PLAN_Y] - m->solves.at[i]) <= 1e-9) {
                sum += log(p->solves);
                members++;
            }
        m->solves.value[i] = sum / members;
    }
}

/* Least squares of model/seconds - 1 with all terms >= 0, by coordinate descent. */
static void fit_costs(struct br_plan_model *m)
{
    enum { TURNS = 20000 };
    double normal[BR_PLAN_COSTS][BR_PLAN_COSTS] = {{0}}, right[BR_PLAN_COSTS] = {0};
    for (const struct br_plan_point *p = m->point; p < m->point + m->points; p++) {
        const double seconds = p->value[BR_PLAN_SECONDS];
        double term[BR_PLAN_COSTS];
        terms_of(exp(p->at[BR_PLAN_X]), p->solves, term);
        for (int i = 0; i < BR_PLAN_COSTS; i++) {
            right[i] += term[i] / seconds;
            for (int j = 0; j < BR_PLAN_COSTS; j++)
                normal[i][j] += term[i] * term[j] / (seconds * seconds);
        }
    }
    for (int i = 0; i < BR_PLAN_COSTS; i++)
        m->cost[i] = 0;
    for (int turn = 0; turn < TURNS; turn++)
        for (int i = 0; i < BR_PLAN_COSTS; i++) {
            double rest = right[i] + normal[i][i] * m->cost[i];
            for (int j = 0; j < BR_PLAN_COSTS; j++)
                rest -= normal[i][j] * m->cost[j];
            m->cost[i] = fmax(0, rest / normal[i][i]);
        }
}

enum br_status br_plan_model_fit(struct br_plan_model *m, double p, double q, struct br_error *err)
{
    m->known = false;
    if (m->points < 4)
        return br_fail(err, BR_BAD_INPUT, "%zu trials, expected at least 4 to model an error",
                       m->points);
    lay_knots(m, BR_PLAN_X);
    lay_knots(m, BR_PLAN_Y);
    average_solves(m);
    fit_costs(m);
    gsl_error_handler_t *const before = gsl_set_error_handler_off();
    const enum br_status status = fit_errors(&(struct fit){m, {p, q}, smoothness}, err);
    gsl_set_error_handler(before);
    for (int quantity = 0; quantity < BR_PLAN_QUANTITIES; quantity++)
        measure_residuals(m, quantity);
    m->known = !status;
    return status;
}

/* ---- resolutions that were not tried ---- */

/* Distances, as logarithms, at which the weight of a residual is 1/e. */
static const double reach[BR_PLAN_AXES] = {0.7, 0.25};

/* The least deviation of a prediction, and what each unit beyond the knots adds. */
static const double least_deviation = 0.03, beyond[BR_PLAN_AXES] = {0.5, 0.3};

struct br_plan_prediction br_plan_model_predict(const struct br_plan_model *m,
                                                const double at[BR_PLAN_AXES])
{
    const struct br_plan_point *near = m->point;
    struct br_plan_prediction predicted;
    double nearest = INFINITY, excess = 0;
    for (const struct br_plan_point *p = m->point; p < m->point + m->points; p++) {
        const double distance = hypot((p->at[BR_PLAN_X] - at[BR_PLAN_X]) / reach[BR_PLAN_X],
                                      (p->at[BR_PLAN_Y] - at[BR_PLAN_Y]) / reach[BR_PLAN_Y]);
        if (distance <= nearest) {
            nearest = distance;
            near = p;
        }
    }
    for (int axis = 0; axis < BR_PLAN_AXES; axis++) {
        const struct br_plan_curve *c = &m->component[axis];
        const double outside = fmax(c->at[0] - at[axis], at[axis] - c->at[c->count - 1]);
        excess += beyond[axis] * fmax(0, outside);
    }
    const double say = exp(-nearest), least = least_deviation * fmin(1, nearest);
    for (int quantity = 0; quantity < BR_PLAN_QUANTITIES; quantity++) {
        const double unknown = m->scatter[quantity] * sqrt(1 - say * say);
        predicted.log[quantity] = model_value(m, quantity, at) + say * near->residual[quantity];
        predicted.deviation[quantity] = hypot(hypot(least, unknown), excess);
    }
    return predicted;
}

struct br_plan_components br_plan_model_components(const struct br_plan_model *m,
                                                   const double at[BR_PLAN_AXES])
{
    struct br_plan_components components;
    for (int axis = 0; axis < BR_PLAN_AXES; axis++) {
        components.error[axis] = exp(curve_value(&m->component[axis], at[axis]));
        components.order[axis] = curve_order(&m->component[axis], at[axis]);
    }
    return components;
}
