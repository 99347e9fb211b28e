/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <gsl/gsl_complex_math.h>
#include <gsl/gsl_eigen.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "solver/field.h"
#include "solver/function.h"
#include "solver/method.h"
#include "solver/scene.h"

#include "tests/lab/step_matrix.h"

/* ---- nodal values as functions of x, for the initial data of a scene ---- */

double br_nodal_value(enum br_field_kind kind, size_t unknowns, const double *at, double xi,
                      double *slope)
{
    const double *end = at + unknowns, r = 1 - xi;
    *slope = 0;
    if (kind == BR_AXIAL)
        return at[0] * r + end[0] * xi - (unknowns == 2 ? end[1] * xi * r : 0);
    *slope = 6 * xi * r * (end[0] - at[0]) + r * (1 - 3 * xi) * at[1] - xi * (2 - 3 * xi) * end[1];
    return (1 + 2 * xi) * r * r * at[0] + xi * r * r * at[1] + xi * xi * (3 - 2 * xi) * end[0] -
           xi * xi * r * end[1];
}

static void evaluate(void *self, size_t count, const double *x, double t, double *value)
{
    const struct br_nodal_shape *f = self;
    const size_t unknowns = br_field_unknowns(f->field);
    const double last = (double)f->field->n - 1;
    (void)t;
    for (size_t i = 0; i < count; i++) {
        const double at = x[i] / f->field->h, e = at < last ? floor(at) : last;
        double slope;
        value[i] = br_nodal_value(f->field->kind, unknowns, f->value + (size_t)e * unknowns, at - e,
                                  &slope);
        value[i] = f->slope ? slope / f->field->h : value[i];
    }
}

static void *same(const void *self)
{
    return (void *)(uintptr_t)self;
}

static void nothing(void *self)
{
    (void)self;
}

struct br_function br_nodal_function(struct br_nodal_shape *nodal)
{
    static const struct br_function_ops ops = {
        .evaluate = evaluate, .clone = same, .free = nothing};
    return (struct br_function){.ops = &ops, .self = nodal, .uses_x = true};
}

/* ---- columns ---- */

size_t br_step_states(const struct br_field *rod)
{
    return 2 * br_field_unknowns(rod) * rod->n;
}

/* Marches `state` by one step: displacements and k times velocities, with their clamped nodes. */
static enum br_status march_once(const struct br_field *rod, double stiffness, double *state,
                                 struct br_error *err)
{
    const size_t size = br_field_size(rod);
    for (size_t i = 0; i < size; i++)
        state[size + i] /= rod->k;
    struct br_nodal_shape start[2] = {{rod, state, false}, {rod, state + size, false}};
    struct br_method method = br_method_default();
    method.axial_degree = rod->degree;
    struct br_scene scene = {
        .length = (double)rod->n * rod->h,
        .duration = rod->k,
        .density = rod->density,
        .axial = {.modelled = true, .stiffness = rod->stiffness, .viscosity = rod->viscosity},
        .contact = {.modelled = true},
    };
    scene.axial.displacement = br_nodal_function(&start[0]);
    scene.axial.velocity = br_nodal_function(&start[1]);
    scene.contact.stiffness = stiffness;
    struct br_march *march;
    enum br_status status = br_march_create(&march, &scene, rod->n, 1, &method, err);
    if (!status)
        status = br_march_step(march, err);
    if (!status)
        br_march_get(march, BR_AXIAL, state, state + size);
    br_march_free(march);
    for (size_t i = 0; i < size; i++)
        state[size + i] *= rod->k;
    return status;
}

/* The index of entry i of a state among nodal values with their clamped nodes. */
static size_t nodal_index(const struct br_field *rod, size_t i)
{
    const size_t half = br_step_states(rod) / 2, d = br_field_unknowns(rod);
    return i < half ? d + i : 2 * d + i;
}

enum br_status br_step_matrix(const struct br_field *rod, double stiffness, double *matrix,
                              struct br_error *err)
{
    const size_t states = br_step_states(rod), size = 2 * br_field_size(rod);
    double *state = br_allocate(size, sizeof *state);
    enum br_status status = state ? BR_OK : br_no_memory(err, "a step's matrix");
    for (size_t j = 0; j < states && !status; j++) {
        memset(state, 0, size * sizeof *state);
        state[nodal_index(rod, j)] = 1;
        status = march_once(rod, stiffness, state, err);
        for (size_t i = 0; i < states; i++)
            matrix[i * states + j] = state[nodal_index(rod, i)];
    }
    free(state);
    return status;
}

/* ---- eigenvalues ---- */

static bool all_finite(const double *matrix, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(matrix[i]))
            return false;
    return true;
}

enum br_status br_step_radius(const struct br_field *rod, double stiffness, double *radius,
                              struct br_error *err)
{
    const size_t states = br_step_states(rod);
    gsl_matrix *matrix = gsl_matrix_alloc(states, states);
    gsl_eigen_nonsymm_workspace *work = gsl_eigen_nonsymm_alloc(states);
    gsl_vector_complex *eigenvalues = gsl_vector_complex_alloc(states);
    enum br_status status = BR_OK;
    *radius = 0;
    if (!matrix || !work || !eigenvalues)
        status = br_no_memory(err, "a step's eigenvalues");
    if (!status)
        status = br_step_matrix(rod, stiffness, matrix->data, err);
    if (!status && !all_finite(matrix->data, states * states))
        status = br_fail(err, BR_NOT_FINITE, "a step's matrix has entries that are not finite");
    if (!status)
        gsl_eigen_nonsymm_params(0, 1, work); /* balanced */
    if (!status && gsl_eigen_nonsymm(matrix, eigenvalues, work))
        status = br_fail(err, BR_NOT_FINITE, "the eigenvalues of a step were not found");
    for (size_t i = 0; i < states && !status; i++) {
        const double size = gsl_complex_abs(gsl_vector_complex_get(eigenvalues, i));
        if (!(size <= *radius))
            *radius = size;
    }
    gsl_matrix_free(matrix); /* these accept NULL */
    gsl_eigen_nonsymm_free(work);
    gsl_vector_complex_free(eigenvalues);
    return status;
}
