/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The load vector and the initial data of the exact discrete solution. */
#include <math.h>
#include <string.h>

#include "reference/discrete_state.h"

/* ---- quadrature ---- */

enum { POINTS = 5 };

/* Gauss and Legendre's rule on [0, 1]: the roots of P_5 are 0 and -+ sqrt(5 -+ 2 sqrt(10/7)) / 3,
 * the weights 128/225 and (322 +- 13 sqrt 70) / 900, here halved (Abramowitz and Stegun 25.4.30).
 */
static void gauss(long double x[POINTS], long double weight[POINTS])
{
    const long double inner = sqrtl(5 - 2 * sqrtl(10 / 7.0L)) / 6;
    const long double outer = sqrtl(5 + 2 * sqrtl(10 / 7.0L)) / 6;
    const long double place[POINTS] = {-outer, -inner, 0, inner, outer};
    const long double heavy = (322 + 13 * sqrtl(70)) / 1800, light = (322 - 13 * sqrtl(70)) / 1800;
    const long double share[POINTS] = {light, heavy, 64 / 225.0L, heavy, light};
    for (int q = 0; q < POINTS; q++) {
        x[q] = 0.5L + place[q];
        weight[q] = share[q];
    }
}

/* The shape functions of an element at xi: Lagrange's two, or Hermite's four for (w, h w_x). */
static void shapes(size_t d, long double xi, long double shape[2 * BR_DISCRETE_MOST])
{
    const long double square = xi * xi, cube = square * xi;
    if (d == 1) {
        shape[0] = 1 - xi;
        shape[1] = xi;
        return;
    }
    shape[0] = 1 - 3 * square + 2 * cube;
    shape[1] = xi - 2 * square + cube;
    shape[2] = 3 * square - 2 * cube;
    shape[3] = cube - square;
}

/* One value of f at a time; f may be NULL, which is 0. */
static enum br_status value_of(const struct br_function *f, double x, double t, long double *value,
                               struct br_error *err)
{
    double y = 0;
    if (f)
        br_function_evaluate(f, 1, &x, t, &y);
    *value = y;
    return isfinite(y) ? BR_OK
                       : br_fail(err, BR_NOT_FINITE,
                                 "an expression is %g at x = %.17g m, t = %.17g s", y, x, t);
}

/* vector = int f(x, t) shape: of a function of t alone the rule is exact, too. */
static enum br_status assemble(const struct br_discrete_field *field, const struct br_function *f,
                               double t, long double *vector, struct br_error *err)
{
    const size_t d = field->d;
    long double xi[POINTS], weight[POINTS], shape[2 * BR_DISCRETE_MOST];
    gauss(xi, weight);
    memset(vector, 0, d * (field->n + 1) * sizeof *vector);
    for (size_t q = 0; q < POINTS; q++) {
        shapes(d, xi[q], shape);
        for (size_t i = 0; i < field->n; i++) {
            long double value;
            const long double x = field->h * ((long double)i + xi[q]);
            const enum br_status status = value_of(f, (double)x, t, &value, err);
            if (status)
                return status;
            for (size_t a = 0; a < 2 * d; a++)
                vector[d * i + a] += field->h * weight[q] * value * shape[a];
        }
    }
    return BR_OK;
}

/* ---- forces ---- */

enum br_status br_discrete_load_init(struct br_discrete_load *load, const struct br_scene *scene,
                                     enum br_field_kind kind, struct br_discrete_field *field,
                                     struct br_error *err)
{
    const bool axial = kind == BR_AXIAL;
    const struct br_load *along = axial ? &scene->axial.load : &scene->bending.load;
    const size_t size = field->d * (field->n + 1);
    *load = (struct br_discrete_load){0};
    enum br_status status = br_load_clone(along, &load->load, err);
    for (size_t i = 0; i < BR_LOAD_TERMS && !status; i++) {
        const struct br_product *p = &load->load.term[i];
        if (br_product_is_zero(p))
            continue;
        load->vector[i] = br_allocate(size, sizeof *load->vector[i]);
        if (!load->vector[i])
            status = br_no_memory(err, "a load vector");
        else if (!p->space.uses_t)
            status = assemble(field, &p->space, 0, load->vector[i], err);
    }
    if (!status)
        status = br_function_clone(axial ? &scene->axial.tip_force : &scene->bending.tip_force,
                                   &load->tip_force, err);
    if (!status && !axial)
        status = br_function_clone(&scene->bending.tip_moment, &load->tip_moment, err);
    return status;
}

void br_discrete_load_clear(struct br_discrete_load *load)
{
    br_load_clear(&load->load);
    for (size_t i = 0; i < BR_LOAD_TERMS; i++)
        free(load->vector[i]);
    br_function_free(&load->tip_force);
    br_function_free(&load->tip_moment);
}

enum br_status br_discrete_load_update(struct br_discrete_load *load,
                                       struct br_discrete_field *field, double t,
                                       struct br_error *err)
{
    enum br_status status = BR_OK;
    const size_t size = field->d * (field->n + 1);
    memset(field->load, 0, size * sizeof *field->load);
    for (size_t i = 0; i < BR_LOAD_TERMS && load->vector[i] && !status; i++) {
        const struct br_product *p = &load->load.term[i];
        long double factor = 0;
        status = value_of(&p->time, 0, t, &factor, err);
        if (!status && p->space.uses_t)
            status = assemble(field, &p->space, t, load->vector[i], err);
        for (size_t j = 0; j < size; j++)
            field->load[j] += factor * load->vector[i][j];
    }
    if (!status)
        status = value_of(&load->tip_force, 0, t, &load->tip[0], err);
    if (!status && field->d == 2) {
        status = value_of(&load->tip_moment, 0, t, &load->tip[1], err);
        load->tip[1] /= field->h; /* on h w_x */
    }
    return status;
}

/* ---- initial data ---- */

/* A function and, for a beam, its slope at the nodes; the clamped one is zero. */
static enum br_status interpolate(const struct br_discrete_field *field,
                                  const struct br_function *f, const struct br_function *slope,
                                  long double *nodal, struct br_error *err)
{
    const size_t d = field->d;
    for (size_t i = 1; i <= field->n; i++) {
        const double x = (double)field->h * (double)i; /* as the data are given: at doubles */
        enum br_status status = value_of(f, x, 0, &nodal[d * i], err);
        if (!status && slope)
            status = value_of(slope, x, 0, &nodal[d * i + 1], err);
        if (status)
            return status;
        if (slope)
            nodal[d * i + 1] *= field->h;
    }
    return BR_OK;
}

static enum br_status interpolate_clone(const struct br_discrete_field *field,
                                        const struct br_function *f,
                                        const struct br_function *slope, long double *nodal,
                                        struct br_error *err)
{
    struct br_function own = {0}, own_slope = {0};
    enum br_status status = br_function_clone(f, &own, err);
    if (!status && slope)
        status = br_function_clone(slope, &own_slope, err);
    if (!status)
        status = interpolate(field, &own, slope ? &own_slope : NULL, nodal, err);
    br_function_free(&own);
    br_function_free(&own_slope);
    return status;
}

enum br_status br_discrete_set_initial(struct br_discrete_field *field,
                                       const struct br_scene *scene, enum br_field_kind kind,
                                       struct br_error *err)
{
    const bool axial = kind == BR_AXIAL;
    const struct br_bending *b = &scene->bending;
    const struct br_function *of[2] = {axial ? &scene->axial.displacement : &b->displacement,
                                       axial ? &scene->axial.velocity : &b->velocity};
    const struct br_function *slope[2] = {axial ? NULL : &b->displacement_slope,
                                          axial ? NULL : &b->velocity_slope};
    if (br_function_is_zero(of[0]) && br_function_is_zero(of[1]))
        return BR_OK;
    const size_t size = field->d * (field->n + 1);
    long double *nodal = br_allocate(2 * size, sizeof *nodal);
    if (!nodal)
        return br_no_memory(err, "the initial data");
    enum br_status status = BR_OK;
    for (int i = 0; i < 2 && !status; i++)
        status = interpolate_clone(field, of[i], slope[i], nodal + (size_t)i * size, err);
    if (!status)
        br_discrete_field_set(field, nodal, nodal + size);
    free(nodal);
    return status;
}
