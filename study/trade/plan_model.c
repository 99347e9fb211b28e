/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/trade/plan.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit.h>
#include <gsl/gsl_multifit_nlinear.h>
#include <gsl/gsl_sort.h>
#include <math.h>
#include <string.h>

/* Weights beside that of a trial's log error: of a change of slope at a knot, of a slope's distance
 * from theory's order, and of atanh r. */
static const double smoothness = 0.03, theory = 0.003, uncorrelated = 0.003;

/* Fields of errors are never quite opposite; |r| = 1 would let the model vanish. */
static const double most_r = 0.95;

/* A fit that leaves more than this has gone astray, and is made again with r = 0. */
static const double astray = 0.3;

/* Knots nearer than this are one: factors of 1.5 in n, 1.15 in k. */
static const double least_gap_x = 0.4, least_gap_y = 0.14;

/* ---- curves ---- */

/* The piece that `at` lies in, or the one nearest to it. */
static size_t piece_of(const struct br_plan_curve *c, double at)
{
    size_t i = 0;
    while (i + 2 < c->count && at > c->at[i + 1])
        i++;
    return i;
}

static double curve_value(const struct br_plan_curve *c, double at)
{
    if (c->count < 2)
        return c->value[0];
    const size_t i = piece_of(c, at);
    const double through = (at - c->at[i]) / (c->at[i + 1] - c->at[i]); /* 0 to 1 within */
    return c->value[i] + through * (c->value[i + 1] - c->value[i]);
}

/* Minus the slope of a curve. */
static double curve_order(const struct br_plan_curve *c, double at)
{
    if (c->count < 2)
        return 0;
    const size_t i = piece_of(c, at);
    return -(c->value[i + 1] - c->value[i]) / (c->at[i + 1] - c->at[i]);
}

/* Knots at the values, the near ones merged; fewer where there are too many. */
static void lay_knots(struct br_plan_curve *c, double *value, size_t count, double gap)
{
    gsl_sort(value, 1, count);
    for (bool all = false; !all; gap *= 2) {
        all = true;
        c->count = 0;
        for (size_t i = 0; i < count && all; i++) {
            const bool is_knot = c->count == 0 || value[i] - c->at[c->count - 1] > gap;
            all = !is_knot || c->count < BR_PLAN_KNOTS;
            if (is_knot && all)
                c->at[c->count++] = value[i];
        }
    }
}

/* ---- the fit ---- */

struct problem {
    struct br_plan_model *model;
    double p, q;
    bool no_r;         /* r = 0 */
    double smoothness; /* of this fit */
};

/* A fit begins from one that is as good as straight, lest a knot gets caught on the wrong side of a
 * cancellation. */
static const double straight = 1;

static size_t unknowns(const struct br_plan_model *m)
{
    return m->space.count + m->time.count + 1;
}

static void spread(const struct problem *problem, const gsl_vector *v)
{
    struct br_plan_model *m = problem->model;
    for (size_t i = 0; i < m->space.count; i++)
        m->space.value[i] = gsl_vector_get(v, i);
    for (size_t j = 0; j < m->time.count; j++)
        m->time.value[j] = gsl_vector_get(v, m->space.count + j);
    m->r = problem->no_r ? 0 : most_r * tanh(gsl_vector_get(v, m->space.count + m->time.count));
}

/* The model's own value, log e. */
static double model_value(const struct br_plan_model *m, double x, double y)
{
    const double a = curve_value(&m->space, x), b = curve_value(&m->time, y);
    const double most = fmax(a, b), ratio = exp(-fabs(a - b));
    const double square = 1 + 2 * m->r * ratio + ratio * ratio;
    return most + 0.5 * log(fmax(square, 1e-6));
}

/* Rows of a curve's penalties; returns how many. */
static size_t penalties(const struct br_plan_curve *c, double order, double stiffness,
                        gsl_vector *out, size_t row)
{
    for (size_t i = 0; i + 1 < c->count; i++) {
        const double slope = curve_order(c, (c->at[i] + c->at[i + 1]) / 2);
        gsl_vector_set(out, row++, theory * (slope - order));
        if (i + 2 < c->count) {
            const double next = curve_order(c, (c->at[i + 1] + c->at[i + 2]) / 2);
            gsl_vector_set(out, row++, stiffness * (next - slope));
        }
    }
    return row;
}

static int residuals(const gsl_vector *v, void *params, gsl_vector *out)
{
    const struct problem *problem = params;
    struct br_plan_model *m = problem->model;
    spread(problem, v);
    size_t row = 0;
    for (; row < m->points; row++) {
        const struct br_plan_point *p = &m->point[row];
        const double f = log(p->error) - model_value(m, p->x, p->y);
        if (!isfinite(f))
            return GSL_EDOM;
        gsl_vector_set(out, row, f);
    }
    row = penalties(&m->space, problem->p, problem->smoothness, out, row);
    row = penalties(&m->time, problem->q, problem->smoothness, out, row);
    gsl_vector_set(out, row, uncorrelated * gsl_vector_get(v, unknowns(m) - 1));
    return GSL_SUCCESS;
}

/* The least error near a knot is all that its part can be. */
static double least_error_near(const struct br_plan_model *m, double at, bool space)
{
    double least = INFINITY, nearest = INFINITY;
    for (size_t i = 0; i < m->points; i++)
        nearest = fmin(nearest, fabs((space ? m->point[i].x : m->point[i].y) - at));
    for (size_t i = 0; i < m->points; i++)
        if (fabs((space ? m->point[i].x : m->point[i].y) - at) <= nearest + 1e-9)
            least = fmin(least, m->point[i].error);
    return log(least);
}

static void start(struct br_plan_model *m, double atanh_r, gsl_vector *v)
{
    for (size_t i = 0; i < m->space.count; i++)
        gsl_vector_set(v, i, least_error_near(m, m->space.at[i], true) - 0.35);
    for (size_t j = 0; j < m->time.count; j++)
        gsl_vector_set(v, m->space.count + j, least_error_near(m, m->time.at[j], false) - 0.35);
    gsl_vector_set(v, unknowns(m) - 1, atanh_r);
}

static enum br_status solve(struct problem *problem, double atanh_r, struct br_error *err)
{
    struct br_plan_model *m = problem->model;
    const size_t of_space = m->space.count < 2 ? 0 : 2 * m->space.count - 3;
    const size_t of_time = m->time.count < 2 ? 0 : 2 * m->time.count - 3;
    const size_t rows = m->points + of_space + of_time + 1;
    gsl_multifit_nlinear_parameters parameters = gsl_multifit_nlinear_default_parameters();
    gsl_multifit_nlinear_fdf fdf = {.f = residuals, .n = rows, .p = unknowns(m), .params = problem};
    gsl_multifit_nlinear_workspace *w =
        gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &parameters, rows, fdf.p);
    gsl_vector *v = gsl_vector_alloc(fdf.p);
    if (!w || !v) {
        gsl_multifit_nlinear_free(w);
        gsl_vector_free(v);
        return br_no_memory(err, "the error model");
    }
    int info = 0;
    start(m, atanh_r, v);
    for (int pass = 0; pass < 2; pass++) {
        problem->smoothness = pass == 0 ? straight : smoothness;
        gsl_multifit_nlinear_init(v, &fdf, w);
        /* A fit that did not converge is the best so far: its residuals show its quality. */
        gsl_multifit_nlinear_driver(60, 1e-8, 1e-8, 0, NULL, NULL, &info, w);
        gsl_vector_memcpy(v, gsl_multifit_nlinear_position(w));
    }
    spread(problem, v);
    gsl_multifit_nlinear_free(w);
    gsl_vector_free(v);
    return BR_OK;
}

static void measure_residuals(struct br_plan_model *m)
{
    double sum = 0;
    for (size_t i = 0; i < m->points; i++) {
        const struct br_plan_point *p = &m->point[i];
        m->residual[i] = log(p->error) - model_value(m, p->x, p->y);
        sum += m->residual[i] * m->residual[i];
    }
    m->scatter = sqrt(sum / (double)m->points);
}

static enum br_status lay_out(struct br_plan_model *m, const struct br_plan_point *point,
                              size_t count, struct br_error *err)
{
    m->point = br_allocate(count, sizeof *m->point);
    m->residual = br_allocate(count, sizeof *m->residual);
    if (!m->point || !m->residual)
        return br_no_memory(err, "the error model");
    memcpy(m->point, point, count * sizeof *point);
    m->points = count;
    for (size_t i = 0; i < count; i++) /* as scratch */
        m->residual[i] = point[i].x;
    lay_knots(&m->space, m->residual, count, least_gap_x);
    for (size_t i = 0; i < count; i++)
        m->residual[i] = point[i].y;
    lay_knots(&m->time, m->residual, count, least_gap_y);
    return BR_OK;
}

/* Where the parts are about to cancel there is more than one minimum: several starts, of which the
 * best fit counts; r = 0 only where all went astray. */
static enum br_status solve_from_all(struct problem *problem, struct br_error *err)
{
    static const double starts[] = {0, 0.7, -0.7, 0};
    enum { STARTS = sizeof starts / sizeof *starts };
    struct br_plan_model *m = problem->model, best = {.scatter = INFINITY};
    enum br_status status = BR_OK;
    for (size_t i = 0; i < STARTS && !status; i++) {
        problem->no_r = i + 1 == STARTS;
        if (problem->no_r && best.scatter <= astray)
            break;
        status = solve(problem, starts[i], err);
        measure_residuals(m);
        if (!status && !(m->scatter >= best.scatter))
            best = *m;
    }
    *m = best.points ? best : *m;
    measure_residuals(m);
    return status;
}

enum br_status br_plan_model_fit(struct br_plan_model *m, const struct br_plan_point *point,
                                 size_t count, double p, double q, struct br_error *err)
{
    *m = (struct br_plan_model){.r = 0};
    if (count < 4)
        return br_fail(err, BR_BAD_INPUT, "%zu trials, expected at least 4 to model an error",
                       count);
    enum br_status status = lay_out(m, point, count, err);
    gsl_error_handler_t *const before = gsl_set_error_handler_off();
    if (!status)
        status = solve_from_all(&(struct problem){m, p, q, false, smoothness}, err);
    gsl_set_error_handler(before);
    return status;
}

void br_plan_model_clear(struct br_plan_model *m)
{
    free(m->point);
    free(m->residual);
    *m = (struct br_plan_model){.r = 0};
}

/* ---- resolutions that were not tried ---- */

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
        .log_error = model_value(m, x, y) + say * residual,
        .deviation = hypot(hypot(least_deviation * fmin(1, nearest), unknown), beyond),
    };
}

struct br_plan_parts br_plan_model_parts(const struct br_plan_model *m, double x, double y)
{
    return (struct br_plan_parts){
        .space = exp(curve_value(&m->space, x)),
        .time = exp(curve_value(&m->time, y)),
        .p = curve_order(&m->space, x),
        .q = curve_order(&m->time, y),
    };
}

/* ---- costs ---- */

static void terms_of(double n, double solves, double term[BR_PLAN_COSTS])
{
    term[0] = 1;
    term[1] = n;
    term[2] = solves;
    term[3] = n * solves;
}

static double seconds_of(const struct br_plan_cost *cost, double n, double solves)
{
    double term[BR_PLAN_COSTS], sum = 0;
    terms_of(n, solves, term);
    for (int i = 0; i < BR_PLAN_COSTS; i++)
        sum += cost->c[i] * term[i];
    return sum;
}

/* Solves over steps or tolerances: the mean of the logarithms at each y. */
static void average_solves(struct br_plan_cost *cost, const struct br_plan_work *work, size_t count)
{
    struct br_plan_curve *c = &cost->solves;
    size_t members[BR_PLAN_KNOTS] = {0};
    c->count = 0;
    for (size_t i = 0; i < count; i++) {
        size_t j = 0;
        while (j < c->count && !(fabs(c->at[j] - work[i].y) <= 1e-9))
            j++;
        if (j == BR_PLAN_KNOTS)
            continue;
        if (j == c->count) {
            c->at[j] = work[i].y;
            c->value[j] = 0;
            c->count++;
        }
        members[j]++;
        c->value[j] += (log(work[i].solves) - c->value[j]) / (double)members[j];
    }
    gsl_sort2(c->at, 1, c->value, 1, c->count);
}

/* Least squares of seconds/model - 1 over the terms that are in use. */
static enum br_status fit_terms(struct br_plan_cost *cost, const struct br_plan_work *work,
                                size_t count, const bool used[BR_PLAN_COSTS], struct br_error *err)
{
    size_t terms = 0;
    for (int i = 0; i < BR_PLAN_COSTS; i++)
        terms += used[i];
    double c[BR_PLAN_COSTS], covariance[BR_PLAN_COSTS * BR_PLAN_COSTS], sum;
    double *x = br_allocate(count * (terms + 1), sizeof *x);
    gsl_multifit_linear_workspace *w = gsl_multifit_linear_alloc(count, terms);
    enum br_status status = x && w ? BR_OK : br_no_memory(err, "the cost model");
    for (size_t i = 0, k = 0; i < count && !status; i++) {
        double term[BR_PLAN_COSTS];
        terms_of(work[i].n, work[i].solves, term);
        for (size_t j = 0; j < BR_PLAN_COSTS; j++)
            if (used[j])
                x[k++] = term[j] / work[i].seconds;
        x[count * terms + i] = 1;
    }
    if (!status) {
        gsl_matrix_view rows = gsl_matrix_view_array(x, count, terms);
        gsl_matrix_view spread_of = gsl_matrix_view_array(covariance, terms, terms);
        gsl_vector_view ones = gsl_vector_view_array(x + count * terms, count);
        gsl_vector_view found = gsl_vector_view_array(c, terms);
        if (gsl_multifit_linear(&rows.matrix, &ones.vector, &found.vector, &spread_of.matrix, &sum,
                                w) != GSL_SUCCESS)
            status = br_fail(err, BR_SINGULAR, "the cost model could not be fitted");
    }
    for (size_t j = 0, k = 0; j < BR_PLAN_COSTS && !status; j++)
        cost->c[j] = used[j] ? c[k++] : 0;
    gsl_multifit_linear_free(w);
    free(x);
    return status;
}

/* No term is a saving: the most negative one goes, until none is. */
static enum br_status fit_seconds(struct br_plan_cost *cost, const struct br_plan_work *work,
                                  size_t count, struct br_error *err)
{
    bool used[BR_PLAN_COSTS] = {true, true, true, true};
    enum br_status status = BR_OK;
    for (int round = 0; round < BR_PLAN_COSTS && !status; round++) {
        int worst = -1;
        double saving = 0;
        status = fit_terms(cost, work, count, used, err);
        for (int i = 0; i < BR_PLAN_COSTS && !status; i++) {
            double term[BR_PLAN_COSTS];
            terms_of(work[0].n, work[0].solves, term);
            if (used[i] && cost->c[i] * term[i] < saving)
                worst = i, saving = cost->c[i] * term[i];
        }
        if (worst < 0)
            break;
        used[worst] = false;
    }
    return status;
}

enum br_status br_plan_cost_fit(struct br_plan_cost *cost, const struct br_plan_work *work,
                                size_t count, struct br_error *err)
{
    *cost = (struct br_plan_cost){.scatter = NAN};
    if (count == 0)
        return br_fail(err, BR_BAD_INPUT, "no trial that a cost could be modelled from");
    average_solves(cost, work, count);
    enum br_status status = BR_OK;
    gsl_error_handler_t *const before = gsl_set_error_handler_off();
    if (count > BR_PLAN_COSTS)
        status = fit_seconds(cost, work, count, err);
    gsl_set_error_handler(before);
    /* Few works: all of the cost by elements and solves, as the largest of them has it. */
    for (size_t i = 0; i < count && count <= BR_PLAN_COSTS; i++)
        cost->c[3] = fmax(cost->c[3], work[i].seconds / (work[i].n * work[i].solves));
    double sum = 0;
    for (size_t i = 0; i < count && !status; i++)
        sum += pow(log(work[i].seconds / seconds_of(cost, work[i].n, work[i].solves)), 2);
    cost->scatter = sqrt(sum / (double)count);
    return status;
}

double br_plan_cost_solves(const struct br_plan_cost *cost, double y)
{
    return exp(curve_value(&cost->solves, y));
}

double br_plan_cost_seconds(const struct br_plan_cost *cost, double n, double y)
{
    return seconds_of(cost, n, br_plan_cost_solves(cost, y));
}
