/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/trade/plan_cost.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit.h>
#include <math.h>

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

/* ---- solves over steps or tolerances ---- */

/* The mean of the logarithms at each y. */
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
}

static void sort_curve(struct br_plan_curve *c)
{
    for (size_t i = 1; i < c->count; i++)
        for (size_t j = i; j > 0 && c->at[j] < c->at[j - 1]; j--) {
            const double at = c->at[j], value = c->value[j];
            c->at[j] = c->at[j - 1], c->value[j] = c->value[j - 1];
            c->at[j - 1] = at, c->value[j - 1] = value;
        }
}

/* ---- seconds ---- */

/* Least squares of seconds/model - 1 over the terms that are in use. */
static enum br_status fit_terms(struct br_plan_cost *cost, const struct br_plan_work *work,
                                size_t count, const bool used[BR_PLAN_COSTS], struct br_error *err)
{
    size_t terms = 0;
    for (int i = 0; i < BR_PLAN_COSTS; i++)
        terms += used[i];
    gsl_matrix *x = gsl_matrix_alloc(count, terms), *covariance = gsl_matrix_alloc(terms, terms);
    gsl_vector *y = gsl_vector_alloc(count), *c = gsl_vector_alloc(terms);
    gsl_multifit_linear_workspace *w = gsl_multifit_linear_alloc(count, terms);
    enum br_status status = BR_OK;
    if (!x || !y || !c || !covariance || !w) {
        status = br_no_memory(err, "the cost model");
        goto done;
    }
    for (size_t i = 0; i < count; i++) {
        double term[BR_PLAN_COSTS];
        terms_of(work[i].n, work[i].solves, term);
        for (size_t j = 0, k = 0; j < BR_PLAN_COSTS; j++)
            if (used[j])
                gsl_matrix_set(x, i, k++, term[j] / work[i].seconds);
        gsl_vector_set(y, i, 1);
    }
    double sum;
    if (gsl_multifit_linear(x, y, c, covariance, &sum, w) != GSL_SUCCESS) {
        status = br_fail(err, BR_SINGULAR, "the cost model could not be fitted");
        goto done;
    }
    for (size_t j = 0, k = 0; j < BR_PLAN_COSTS; j++)
        cost->c[j] = used[j] ? gsl_vector_get(c, k++) : 0;
done:
    gsl_multifit_linear_free(w);
    gsl_matrix_free(covariance);
    gsl_matrix_free(x);
    gsl_vector_free(c);
    gsl_vector_free(y);
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

/* Few works: all of the cost by elements and solves, as the largest of them has it. */
static void guess(struct br_plan_cost *cost, const struct br_plan_work *work, size_t count)
{
    double most = 0;
    for (size_t i = 0; i < count; i++)
        most = fmax(most, work[i].seconds / (work[i].n * work[i].solves));
    for (int i = 0; i < BR_PLAN_COSTS; i++)
        cost->c[i] = i == 3 ? most : 0;
}

enum br_status br_plan_cost_fit(struct br_plan_cost *cost, const struct br_plan_work *work,
                                size_t count, struct br_error *err)
{
    *cost = (struct br_plan_cost){.scatter = NAN};
    if (count == 0)
        return br_fail(err, BR_BAD_INPUT, "no trial that a cost could be modelled from");
    average_solves(cost, work, count);
    sort_curve(&cost->solves);
    enum br_status status = BR_OK;
    gsl_error_handler_t *const before = gsl_set_error_handler_off();
    if (count > BR_PLAN_COSTS)
        status = fit_seconds(cost, work, count, err);
    else
        guess(cost, work, count);
    gsl_set_error_handler(before);
    double sum = 0;
    for (size_t i = 0; i < count && !status; i++)
        sum += pow(log(work[i].seconds / seconds_of(cost, work[i].n, work[i].solves)), 2);
    cost->scatter = sqrt(sum / (double)count);
    return status;
}

double br_plan_cost_solves(const struct br_plan_cost *cost, double y)
{
    return exp(br_plan_curve_value(&cost->solves, y));
}

double br_plan_cost_seconds(const struct br_plan_cost *cost, double n, double y)
{
    return seconds_of(cost, n, br_plan_cost_solves(cost, y));
}
