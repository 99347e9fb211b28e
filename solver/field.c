/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/field.h"

#include <math.h>
#include <string.h>

#include "solver/scene.h"

const double br_axial_mass[2][2] = {{1.0 / 3, 1.0 / 6}, {1.0 / 6, 1.0 / 3}};

const double br_bending_mass[4][4] = {
    {156.0 / 420, 22.0 / 420, 54.0 / 420, -13.0 / 420},
    {22.0 / 420, 4.0 / 420, 13.0 / 420, -3.0 / 420},
    {54.0 / 420, 13.0 / 420, 156.0 / 420, -22.0 / 420},
    {-13.0 / 420, -3.0 / 420, -22.0 / 420, 4.0 / 420},
};

/* Integrals over one element of the shape functions, over h. */
static const double axial_mean[2] = {1.0 / 2, 1.0 / 2};
static const double bending_mean[4] = {1.0 / 2, 1.0 / 12, 1.0 / 2, -1.0 / 12};
/* The bubble of the element before has no integral here. */
static const double quadratic_mean[4] = {1.0 / 2, 0, 1.0 / 2, -1.0 / 6};

enum { GAUSS = 5 };

/* Gauss-Legendre on [0, 1]: exact up to degree 9 (Abramowitz and Stegun 25.4.30). */
static const double gauss_x[GAUSS] = {
    0.046910077030668003601, 0.23076534494715845448, 0.5,
    0.76923465505284154552,  0.95308992296933199640,
};
static const double gauss_weight[GAUSS] = {
    0.11846344252809454376, 0.23931433524968323402, 0.28444444444444444444,
    0.23931433524968323402, 0.11846344252809454376,
};

struct br_field br_field_of_scene(const struct br_scene *s, enum br_field_kind kind, size_t n,
                                  double k, int axial_degree)
{
    return (struct br_field){
        .kind = kind,
        .n = n,
        .h = s->length / (double)n,
        .density = s->density,
        .stiffness = s->field[kind].stiffness,
        .viscosity = s->field[kind].viscosity,
        .k = k,
        .degree = axial_degree,
    };
}

size_t br_field_unknowns(const struct br_field *field)
{
    return field->kind == BR_AXIAL && !br_field_is_quadratic(field) ? 1 : 2;
}

double br_field_lowest_mode(const struct br_field *field)
{
    const double length = (double)field->n * field->h, square = length * length;
    return field->kind == BR_AXIAL ? 2.467401100272340 / square
                                   : 12.36236336833 / (square * square);
}

double br_field_inertia(const struct br_field *f)
{
    return f->density / (f->k * (f->viscosity + f->k * f->stiffness) * br_field_lowest_mode(f));
}

size_t br_field_size(const struct br_field *field)
{
    return br_field_unknowns(field) * (field->n + 1);
}

/* Values of the element's shape functions at xi in [0, 1]; returns their number. */
static size_t shape_values(const struct br_field *field, double xi, double shape[4])
{
    const double eta = 1 - xi;
    if (br_field_is_quadratic(field)) {
        shape[0] = eta;
        shape[1] = 0;
        shape[2] = xi;
        shape[3] = -xi * eta;
        return 4;
    }
    if (field->kind == BR_AXIAL) {
        shape[0] = eta;
        shape[1] = xi;
        return 2;
    }
    shape[0] = eta * eta * (1 + 2 * xi);
    shape[1] = xi * eta * eta;
    shape[2] = xi * xi * (1 + 2 * eta);
    shape[3] = -xi * xi * eta;
    return 4;
}

/* vector += h * f * mean on every element, for a load without x. */
static void assemble_uniform(const struct br_field *field, double f, double *vector)
{
    const size_t unknowns = br_field_unknowns(field);
    const double *mean = field->kind == BR_AXIAL ? axial_mean : bending_mean;
    if (br_field_is_quadratic(field))
        mean = quadratic_mean;
    for (size_t i = 0; i < field->n; i++)
        for (size_t a = 0; a < 2 * unknowns; a++)
            vector[i * unknowns + a] += field->h * f * mean[a];
}

/* vector = sum over Gauss points of h * weight * f(x) * shape(x), node by node. */
static void assemble_quadrature(const struct br_field *field, const double *f, double *vector)
{
    const size_t unknowns = br_field_unknowns(field), n = field->n;
    double shape[GAUSS][4], weight[GAUSS];
    for (int q = 0; q < GAUSS; q++) {
        shape_values(field, gauss_x[q], shape[q]);
        weight[q] = field->h * gauss_weight[q];
    }
    for (size_t i = 0; i <= n; i++)
        for (size_t a = 0; a < unknowns; a++) {
            double sum = 0;
            for (int q = 0; q < GAUSS; q++) {
                if (i > 0)
                    sum += weight[q] * f[(i - 1) * GAUSS + (size_t)q] * shape[q][unknowns + a];
                if (i < n)
                    sum += weight[q] * f[i * GAUSS + (size_t)q] * shape[q][a];
            }
            vector[i * unknowns + a] = sum;
        }
}

/* Values of f at the points x with a check that each is finite. */
static enum br_status evaluate_finite(const struct br_function *f, size_t count, const double *x,
                                      double t, double *value, struct br_error *err)
{
    br_function_evaluate(f, count, x, t, value);
    for (size_t i = 0; i < count; i++)
        if (!isfinite(value[i]))
            return br_fail(err, BR_NOT_FINITE, "an expression is %g at x = %.17g m, t = %.17g s",
                           value[i], x[i], t);
    return BR_OK;
}

enum br_status br_assemble_load(const struct br_field *field, const struct br_function *space,
                                double t, double *vector, struct br_error *err)
{
    memset(vector, 0, br_field_size(field) * sizeof *vector);
    const size_t count = space->uses_x ? field->n * GAUSS : 1;
    double *x = br_allocate(2 * count, sizeof *x);
    if (!x)
        return br_no_memory(err, "the quadrature points");
    double *f = x + count;
    for (size_t i = 0; i < field->n && space->uses_x; i++)
        for (size_t q = 0; q < GAUSS; q++)
            x[i * GAUSS + q] = field->h * ((double)i + gauss_x[q]);
    const enum br_status status = evaluate_finite(space, count, x, t, f, err);
    if (!status && space->uses_x)
        assemble_quadrature(field, f, vector);
    else if (!status)
        assemble_uniform(field, f[0], vector);
    free(x);
    return status;
}

enum br_status br_interpolate(const struct br_field *field, const struct br_function *value,
                              const struct br_function *slope, double *nodal, struct br_error *err)
{
    const size_t unknowns = br_field_unknowns(field), nodes = field->n + 1;
    struct br_function own = {0}, own_slope = {0};
    double *x = br_allocate(2 * nodes, sizeof *x);
    if (!x)
        return br_no_memory(err, "the initial data");
    double *f = x + nodes;
    for (size_t i = 0; i < nodes; i++)
        x[i] = field->h * (double)i;
    enum br_status status = br_function_clone(value, &own, err);
    if (!status && field->kind == BR_BENDING)
        status = br_function_clone(slope, &own_slope, err);
    if (!status)
        status = evaluate_finite(&own, nodes, x, 0, f, err);
    for (size_t i = 0; i < nodes && !status; i++)
        nodal[i * unknowns] = f[i];
    if (!status && field->kind == BR_BENDING) {
        status = evaluate_finite(&own_slope, nodes, x, 0, f, err);
        for (size_t i = 0; i < nodes && !status; i++)
            nodal[2 * i + 1] = field->h * f[i];
    }
    for (size_t a = 0; a < unknowns; a++)
        nodal[a] = 0;
    /* four times the chord minus the value at the middle of each element */
    if (!status && br_field_is_quadratic(field)) {
        for (size_t e = 0; e < field->n; e++)
            x[e] = field->h * ((double)e + 0.5);
        status = evaluate_finite(&own, field->n, x, 0, f, err);
        for (size_t e = 0; e < field->n && !status; e++)
            nodal[2 * e + 3] = 2 * ((nodal[2 * e] - f[e]) + (nodal[2 * e + 2] - f[e]));
    }
    br_function_free(&own);
    br_function_free(&own_slope);
    free(x);
    return status;
}
