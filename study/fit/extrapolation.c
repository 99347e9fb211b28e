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

/* What the three values that end at x[2] show; its order is NaN unless it is monotone convergence of
 * an order from 0.2 to 12. */
static struct br_gci three_values(const double *x, const double *value)
{
    struct br_gci found;
    struct br_error err;
    if (br_gci(x, value, 3, &found, &err) || found.sequence != BR_MONOTONE_CONVERGENCE ||
        !(found.order > 0.2 && found.order < 12))
        found.order = NAN;
    return found;
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
    const double *x = l->x + l->count - 3, *value = l->value + l->count - 3;
    const double last = fabs(value[2] - value[1]), round_off = 64 * DBL_EPSILON * fabs(value[2]);
    if (last <= safety * round_off)
        return l->constant ? around(value[2], safety * last + round_off) : around(NAN, NAN);
    const struct br_gci fine = three_values(x, value);
    const double formal = formal_near(l, fine.order, near), limit = fine.fine.limit;
    if (isnan(formal))
        return around(NAN, NAN);
    double spread =
        fabs(limit - value[2] - (value[2] - value[1]) / (pow(x[1] / x[2], formal) - 1));
    if (l->count > 3) {
        const struct br_gci coarse = three_values(x - 1, value - 1);
        if (formal_near(l, coarse.order, drift) != formal)
            return around(NAN, NAN);
        spread = fmax(spread, fabs(limit - coarse.fine.limit));
    }
    return around(limit, safety * spread + round_off);
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
