/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/fit/fit.h"

#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>
#include <math.h>

static const double safety = 1.25; /* with an observed order; Roache 1998 */
static const double careful = 3;   /* without */

enum br_status br_tips_create(struct br_tips *tips, const struct br_study *grid,
                              struct br_error *err)
{
    *tips = (struct br_tips){
        grid->n_count, grid->k_count, grid->n, grid->steps, grid->method.axial_degree,
        {NULL, NULL}};
    const size_t cells = grid->n_count * grid->k_count;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        tips->value[kind] = br_allocate(cells, sizeof(double));
        if (!tips->value[kind])
            return br_no_memory(err, "the tips");
        for (size_t i = 0; i < cells; i++)
            tips->value[kind][i] = NAN;
    }
    return BR_OK;
}

enum br_status br_tips_of_study(struct br_tips *tips, const struct br_study *study,
                                struct br_error *err)
{
    const enum br_status status = br_tips_create(tips, study, err);
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++)
        for (size_t i = 0; i < study->n_count * study->k_count; i++)
            if (!study->cell[i].failure.status && !study->cell[i].unstable)
                tips->value[kind][i] = study->cell[i].tip[kind];
    return status;
}

void br_tips_clear(struct br_tips *tips)
{
    free(tips->value[BR_AXIAL]);
    free(tips->value[BR_BENDING]);
    *tips = (struct br_tips){0};
}

/* Three values on finer and finer grids; x is h or k in any unit. */
struct triple {
    const double *x, *value;
};

/* (x0^q - x1^q)/(x1^q - x2^q) - (v0 - v1)/(v1 - v2), which is 0 for v = v* + C x^q */
static double mismatch(double q, void *self)
{
    const struct triple *t = self;
    return (pow(t->x[0] / t->x[1], q) - 1) / (1 - pow(t->x[2] / t->x[1], q)) -
           (t->value[0] - t->value[1]) / (t->value[1] - t->value[2]);
}

/* v* for a given order, from the last two values. */
static double limit(const struct triple *t, double order)
{
    return t->value[2] + (t->value[2] - t->value[1]) / (pow(t->x[1] / t->x[2], order) - 1);
}

/* The order that three values show; NaN where they show none. */
static double observed_order(const struct triple *t)
{
    double low = 0.2, high = 12, order = NAN;
    gsl_function f = {mismatch, (void *)t};
    if (!(mismatch(low, (void *)t) < 0 && mismatch(high, (void *)t) > 0))
        return NAN;
    gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
    if (solver && gsl_root_fsolver_set(solver, &f, low, high) == GSL_SUCCESS)
        for (int i = 0; i < 100; i++) {
            gsl_root_fsolver_iterate(solver);
            order = gsl_root_fsolver_root(solver);
            low = gsl_root_fsolver_x_lower(solver);
            high = gsl_root_fsolver_x_upper(solver);
            if (gsl_root_test_interval(low, high, 0, 1e-12) == GSL_SUCCESS)
                break;
        }
    gsl_root_fsolver_free(solver);
    return order;
}

/* Values on a line of the grid, from coarse to fine. */
struct line {
    size_t count;
    const double *x, *value;
    double formal; /* order that theory knows */
};

static struct br_estimate around(double value, double half)
{
    return (struct br_estimate){value, value - half, value + half};
}

/* Coarse cells that failed are left out; what is left must be whole. */
static struct line known_part(const struct line *l)
{
    struct line known = *l;
    while (known.count && !isfinite(known.value[0])) {
        known.x++;
        known.value++;
        known.count--;
    }
    for (size_t i = 0; i < known.count; i++)
        if (!isfinite(known.value[i]))
            known.count = 0;
    return known;
}

static struct br_estimate extrapolate_line(const struct line *whole)
{
    const struct line part = known_part(whole), *l = &part;
    if (l->count < 3)
        return around(NAN, NAN);
    const struct triple fine = {l->x + l->count - 3, l->value + l->count - 3};
    const double last = fabs(fine.value[2] - fine.value[1]);
    const double round_off = 64 * DBL_EPSILON * fabs(fine.value[2]);
    if (last <= careful * round_off)
        return around(fine.value[2], careful * last + round_off);
    const double order = observed_order(&fine);
    if (!isfinite(order))
        return around(fine.value[2], careful * last + round_off);
    const double value = limit(&fine, order);
    double spread = fabs(value - limit(&fine, l->formal));
    if (l->count > 3) {
        const struct triple coarse = {l->x + l->count - 4, l->value + l->count - 4};
        const double coarse_order = observed_order(&coarse);
        const double other =
            isfinite(coarse_order) ? limit(&coarse, coarse_order) : coarse.value[2];
        spread = fmax(spread, fabs(value - other));
    }
    return around(value, safety * spread + round_off);
}

/* First over k on each mesh, then over h. The uncertainty over time is nearly the same on all
 * meshes: it is added at the end, and only what it does not share is noise for the extrapolation
 * over h. */
struct br_estimate br_extrapolate(const struct br_tips *tips, enum br_field_kind kind)
{
    const size_t n_count = tips->n_count, k_count = tips->k_count;
    double *h = br_allocate(2 * n_count + k_count, sizeof *h);
    if (!h)
        return around(NAN, NAN);
    gsl_error_handler_t *handler = gsl_set_error_handler_off();
    double *value = h + n_count, *k = value + n_count, half = 0;
    for (size_t j = 0; j < k_count; j++)
        k[j] = 1 / (double)tips->steps[j];
    for (size_t i = 0; i < n_count; i++) {
        const struct line row = {k_count, k, tips->value[kind] + i * k_count, 1};
        const struct br_estimate e = extrapolate_line(&row);
        h[i] = 1 / (double)tips->n[i];
        value[i] = e.value;
        half = (e.high - e.low) / 2;
    }
    const double formal = kind == BR_AXIAL && tips->axial_degree != 2 ? 2 : 4;
    const struct line line = {n_count, h, value, formal};
    struct br_estimate e = extrapolate_line(&line);
    gsl_set_error_handler(handler);
    free(h);
    e.low -= half;
    e.high += half;
    return e;
}
