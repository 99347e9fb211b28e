/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <float.h>
#include <math.h>

#include "study/fit/grid_convergence.h"

static const double safety = 3; /* Roache's factor (1998) without an order that is certain */
static const double near =
    0.1; /* of an order of theory: what the finest three values may be off, */
static const double drift = 0.3; /* and the next coarser three */

enum br_status br_tips_create(struct br_tips *tips, const struct br_study *grid,
                              struct br_error *err)
{
    const struct br_time_scheme *scheme = grid->method.scheme;
    *tips = (struct br_tips){
        .n_count = grid->n_count,
        .k_count = grid->k_count,
        .n = grid->n,
        .steps = grid->steps,
        .axial_degree = grid->method.axial_degree,
        .scheme_order = scheme && !scheme->adaptive ? scheme->order
                        : scheme                    ? 0
                                                    : 1,
    };
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
    size_t count, least; /* least: how many show an order */
    const double *x, *value;
    double formal[2]; /* orders of theory; one of them should be seen */
    bool constant;    /* whether values that do not change have converged */
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

/* The order of theory that an order is near; NaN: none. */
static double formal_near(const struct line *l, double order, double share)
{
    for (int i = 0; i < 2; i++)
        if (fabs(order - l->formal[i]) <= share * l->formal[i])
            return l->formal[i];
    return NAN;
}

/* NaN where the values show no order of theory: what they tend to is then not known. */
static struct br_estimate extrapolate_line(const struct line *whole)
{
    const struct line known = known_cells(whole), *l = &known;
    if (l->count < l->least)
        return around(NAN, NAN);
    const struct triple fine = {l->x + l->count - 3, l->value + l->count - 3};
    const double last = fabs(fine.value[2] - fine.value[1]);
    const double round_off = 64 * DBL_EPSILON * fabs(fine.value[2]);
    if (last <= safety * round_off)
        return l->constant ? around(fine.value[2], safety * last + round_off) : around(NAN, NAN);
    const double order = observed_order(&fine), formal = formal_near(l, order, near);
    if (isnan(formal))
        return around(NAN, NAN);
    const double value = limit(&fine, order);
    double spread = fabs(value - limit(&fine, formal));
    if (l->count > 3) {
        const struct triple coarse = {l->x + l->count - 4, l->value + l->count - 4};
        const double coarse_order = observed_order(&coarse);
        if (formal_near(l, coarse_order, drift) != formal)
            return around(NAN, NAN);
        spread = fmax(spread, fabs(value - limit(&coarse, coarse_order)));
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
        const struct line row = {
            k_count, 4, k, tips->value[kind] + i * k_count, {1, tips->scheme_order}, false};
        const struct br_estimate e = extrapolate_line(&row);
        h[i] = 1 / (double)tips->n[i];
        value[i] = e.value;
        half = (e.high - e.low) / 2;
    }
    const double at_nodes = kind == BR_AXIAL && tips->axial_degree != 2 ? 2 : 4;
    /* the beam's tip has that of the rod's where Coulomb's bound depends on it: 2 or 4 */
    const struct line line = {n_count, 3, h, value, {at_nodes, 2}, true};
    struct br_estimate e = extrapolate_line(&line);
    free(h);
    e.low -= half;
    e.high += half;
    return e;
}
