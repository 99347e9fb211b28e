/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <float.h>
#include <math.h>

#include "study/fit/grid_convergence.h"

static const double safety = 1.25; /* factor with an observed order; Roache 1998 */
static const double careful = 3;   /* factor without one */

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

/* The limit that the last two values give with this order. */
static double limit(const struct triple *t, double order)
{
    return t->value[2] + (t->value[2] - t->value[1]) / (pow(t->x[1] / t->x[2], order) - 1);
}

/* The order that three values show; NaN: none, or none from 0.2 to 12. */
static double observed_order(const struct triple *t)
{
    const double growth = (t->value[0] - t->value[1]) / (t->value[1] - t->value[2]);
    if (!(growth > 0 && isfinite(growth)))
        return NAN;
    const double order =
        br_order_of_differences(log(t->x[1] / t->x[2]), log(t->x[0] / t->x[1]), log(growth), 1);
    return order > 0.2 && order < 12 ? order : NAN;
}

/* Values on a line of the grid, from coarse to fine. */
struct line {
    size_t count;
    const double *x, *value;
    double formal; /* the order of theory */
};

static struct br_estimate around(double value, double half)
{
    return (struct br_estimate){value, value - half, value + half};
}

/* Leaves out coarse cells that failed. All other cells must be known, else none is left. */
static struct line known_cells(const struct line *l)
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
    const struct line known = known_cells(whole), *l = &known;
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

/* Extrapolates over k on each mesh, then over h. The uncertainty over k is nearly the same on all
 * meshes, so it is added at the end: in the extrapolation over h, only its differences between the
 * meshes are noise. */
struct br_estimate br_extrapolate(const struct br_tips *tips, enum br_field_kind kind)
{
    const size_t n_count = tips->n_count, k_count = tips->k_count;
    double *h = br_allocate(2 * n_count + k_count, sizeof *h);
    if (!h)
        return around(NAN, NAN);
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
    free(h);
    e.low -= half;
    e.high += half;
    return e;
}
