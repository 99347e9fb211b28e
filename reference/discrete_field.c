/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One field of the exact discrete solution (discrete.h): loads and initial data in long double, and
 * steps by the recursions of the solver `plain` in long double. */
#include "reference/discrete_field.h"

#include <math.h>
#include <string.h>

enum { MOST = 4 }; /* unknowns of an element */

/* ---- quadrature ---- */

enum { POINTS = 5 };

/* Gauss and Legendre's rule on [0, 1]: the roots of P_5 are 0 and -+ sqrt(5 -+ 2 sqrt(10/7)) / 3,
 * the weights 128/225 and (322 +- 13 sqrt 70) / 900, here halved (Abramowitz and Stegun 25.4.30).
 */
static void gauss(real x[POINTS], real weight[POINTS])
{
    const real inner = sqrtl(5 - 2 * sqrtl(10 / 7.0L)) / 6;
    const real outer = sqrtl(5 + 2 * sqrtl(10 / 7.0L)) / 6;
    const real point[POINTS] = {-outer, -inner, 0, inner, outer};
    const real heavy = (322 + 13 * sqrtl(70)) / 1800, light = (322 - 13 * sqrtl(70)) / 1800;
    const real share[POINTS] = {light, heavy, 64 / 225.0L, heavy, light};
    for (int q = 0; q < POINTS; q++) {
        x[q] = 0.5L + point[q];
        weight[q] = share[q];
    }
}

/* The shape functions of an element at xi: Lagrange's two; the same and the bubble of the right
 * node; or Hermite's four for (w, h w_x). */
static void shapes(const struct br_recursion *r, real xi, real shape[MOST])
{
    const real square = xi * xi, cube = square * xi;
    shape[0] = r->d == 1 ? 1 - xi : 1 - 3 * square + 2 * cube;
    shape[1] = r->m == 1 ? xi : r->d == 1 ? 0 : xi - 2 * square + cube;
    shape[2] = r->d == 1 ? xi : 3 * square - 2 * cube;
    shape[3] = r->d == 1 ? square - xi : cube - square;
}

/* One value of f at a time. */
static enum br_status value_of(const struct br_function *f, double x, double t, real *value,
                               struct br_error *err)
{
    const double y = br_function_at(f, x, t);
    *value = y;
    return isfinite(y) ? BR_OK
                       : br_fail(err, BR_NOT_FINITE,
                                 "an expression is %g at x = %.17g m, t = %.17g s", y, x, t);
}

/* Numbers of a nodal array. */
static size_t nodal_size(const struct br_discrete_field *f)
{
    return (size_t)f->recursion.m * (f->recursion.n + 1);
}

/* vector = int f(x, t) shape; the rule is exact where f depends on t alone. */
static enum br_status assemble(const struct br_discrete_field *field, const struct br_function *f,
                               double t, real *vector, struct br_error *err)
{
    const struct br_recursion *r = &field->recursion;
    const size_t m = (size_t)r->m;
    real xi[POINTS], weight[POINTS], shape[MOST];
    gauss(xi, weight);
    memset(vector, 0, nodal_size(field) * sizeof *vector);
    for (size_t q = 0; q < POINTS; q++) {
        shapes(r, xi[q], shape);
        for (size_t i = 0; i < r->n; i++) {
            real value;
            const real x = r->h * ((real)i + xi[q]);
            const enum br_status status = value_of(f, (double)x, t, &value, err);
            if (status)
                return status;
            for (size_t a = 0; a < 2 * m; a++)
                vector[m * i + a] += r->h * weight[q] * value * shape[a];
        }
    }
    return BR_OK;
}

/* ---- forces ---- */

/* The functions of the forces, and the load vectors that do not change. */
static enum br_status take_forces(struct br_discrete_field *f, const struct br_scene *scene,
                                  struct br_error *err)
{
    const bool axial = f->recursion.d == 1;
    const struct br_function none = {0};
    enum br_status status =
        br_load_clone(axial ? &scene->axial.load : &scene->bending.load, &f->functions, err);
    for (size_t i = 0; i < BR_LOAD_TERMS && !status; i++) {
        const struct br_product *p = &f->functions.term[i];
        if (br_product_is_zero(p))
            continue;
        f->vector[i] = br_store_take(&f->store, nodal_size(f), sizeof *f->vector[i]);
        if (!f->vector[i])
            status = br_no_memory(err, "a load vector");
        else if (!p->space.uses_t)
            status = assemble(f, &p->space, 0, f->vector[i], err);
    }
    if (!status)
        status = br_function_clone(axial ? &scene->axial.tip_force : &scene->bending.tip_force,
                                   &f->tip_force, err);
    if (!status)
        status = br_function_clone(axial ? &none : &scene->bending.tip_moment, &f->tip_moment, err);
    return status;
}

/* Sets the load at time t, s. tip (out): the forces on the tip's unknowns, N. */
static enum br_status update_forces(struct br_discrete_field *f, double t, real tip[2],
                                    struct br_error *err)
{
    enum br_status status = BR_OK;
    const size_t size = nodal_size(f);
    memset(f->load, 0, size * sizeof *f->load);
    for (size_t i = 0; i < BR_LOAD_TERMS && f->vector[i] && !status; i++) {
        const struct br_product *p = &f->functions.term[i];
        real factor = 0;
        status = value_of(&p->time, 0, t, &factor, err);
        if (!status && p->space.uses_t)
            status = assemble(f, &p->space, t, f->vector[i], err);
        for (size_t j = 0; j < size; j++)
            f->load[j] += factor * f->vector[i][j];
    }
    if (!status)
        status = value_of(&f->tip_force, 0, t, &tip[0], err);
    if (!status)
        status = value_of(&f->tip_moment, 0, t, &tip[1], err);
    tip[1] /= f->recursion.h; /* on h w_x */
    return status;
}

/* ---- initial data ---- */

/* nodal[stride i] = unit f(first + i h), i < count. Other threads may use f, too. x is a double, as
 * the data are given. */
static enum br_status fill(const struct br_discrete_field *field, const struct br_function *f,
                           double first, size_t count, real unit, real *nodal, struct br_error *err)
{
    struct br_function own;
    enum br_status status = br_function_clone(f, &own, err);
    for (size_t i = 0; i < count && !status; i++) {
        real value = 0;
        const double x = (double)field->recursion.h * ((double)i + first);
        status = value_of(&own, x, 0, &value, err);
        nodal[(size_t)field->recursion.m * i] = unit * value;
    }
    br_function_free(&own);
    return status;
}

/* Interpolates a function: nodal values, with the slopes of a beam, or with the bubbles of a
 * quadratic rod: four times the distance of the middle from the chord. The clamped node stays zero.
 */
static enum br_status interpolate(const struct br_discrete_field *field,
                                  const struct br_function *f, const struct br_function *slope,
                                  real *nodal, struct br_error *err)
{
    const struct br_recursion *r = &field->recursion;
    const size_t m = (size_t)r->m;
    enum br_status status = fill(field, f, 1, r->n, 1, nodal + m, err);
    if (!status && r->d == 2)
        status = fill(field, slope, 1, r->n, r->h, nodal + m + 1, err);
    if (!status && m > (size_t)r->d)
        status = fill(field, f, 0.5, r->n, 1, nodal + m + 1, err);
    for (real *node = nodal; node < nodal + m * r->n && m > (size_t)r->d; node += m)
        node[3] = 2 * (node[0] - node[3] + (node[2] - node[3]));
    return status;
}

static enum br_status set_initial(struct br_discrete_field *f, const struct br_scene *scene,
                                  struct br_error *err)
{
    const bool axial = f->recursion.d == 1;
    const struct br_axial *rod = &scene->axial;
    const struct br_bending *beam = &scene->bending;
    real *nodal = br_allocate(2 * nodal_size(f), sizeof *nodal);
    if (!nodal)
        return br_no_memory(err, "the initial data");
    enum br_status status = interpolate(f, axial ? &rod->displacement : &beam->displacement,
                                        &beam->displacement_slope, nodal, err);
    real *rate = nodal + nodal_size(f);
    if (!status)
        status = interpolate(f, axial ? &rod->velocity : &beam->velocity, &beam->velocity_slope,
                             rate, err);
    if (!status)
        br_recursion_set(&f->recursion, nodal, rate, f->state[0]);
    free(nodal);
    return status;
}

/* ---- a field ---- */

enum br_status br_discrete_field_init(struct br_discrete_field *f, const struct br_scene *scene,
                                      enum br_field_kind kind, size_t n, int degree, size_t states,
                                      struct br_error *err)
{
    const bool axial = kind == BR_AXIAL;
    *f = (struct br_discrete_field){
        .recursion = {.n = n,
                      .d = axial ? 1 : 2,
                      .m = axial ? degree : 2,
                      .h = (real)scene->length / (real)n,
                      .density = scene->density,
                      .stiffness = axial ? scene->axial.stiffness : scene->bending.stiffness,
                      .viscosity = axial ? scene->axial.viscosity : scene->bending.viscosity},
        .states = states,
    };
    br_recursion_take(&f->recursion, &f->store);
    for (size_t i = 0; i < states; i++)
        f->state[i] = br_store_take(&f->store, br_recursion_size(&f->recursion), sizeof(real));
    f->load = br_store_take(&f->store, nodal_size(f), sizeof *f->load);
    enum br_status status =
        f->store.failed ? br_no_memory(err, "the exact discrete solution") : BR_OK;
    if (!status)
        status = take_forces(f, scene, err);
    return status ? status : set_initial(f, scene, err);
}

void br_discrete_field_clear(struct br_discrete_field *f)
{
    br_store_clear(&f->store);
    br_load_clear(&f->functions);
    br_function_free(&f->tip_force);
    br_function_free(&f->tip_moment);
    *f = (struct br_discrete_field){0};
}

enum br_status br_discrete_field_predict(struct br_discrete_field *f, double t, real *velocity,
                                         struct br_error *err)
{
    struct br_recursion_load load = {.vector = f->load, .factor = 1};
    const enum br_status status = update_forces(f, t, load.tip, err);
    if (!status)
        *velocity = br_recursion_predict(&f->recursion, f->state[0], &load);
    return status;
}
