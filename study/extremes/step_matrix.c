/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/extremes/stability.h"

#include <gsl/gsl_complex_math.h>
#include <gsl/gsl_eigen.h>
#include <math.h>
#include <string.h>

#include "solver/march.h"

/* ---- nodal values as functions of x, for the initial data of a scene ---- */

struct nodal {
    const struct br_field *field;
    const double *value; /* laid out as in solver/field.h; borrowed, also by clones */
};

static double value_at(const struct nodal *f, double x)
{
    const size_t d = br_field_unknowns(f->field);
    const double at = x / f->field->h, last = (double)f->field->n - 1;
    const double e = at < last ? floor(at) : last, xi = at - e;
    const double *left = f->value + (size_t)e * d, *right = left + d;
    const double bubble = d > 1 ? right[1] : 0;
    return (1 - xi) * left[0] + xi * right[0] - xi * (1 - xi) * bubble;
}

static void evaluate(void *self, size_t count, const double *x, double t, double *value)
{
    (void)t;
    for (size_t i = 0; i < count; i++)
        value[i] = value_at(self, x[i]);
}

static void *clone(const void *self)
{
    struct nodal *copy = br_allocate(1, sizeof *copy);
    if (copy)
        *copy = *(const struct nodal *)self;
    return copy;
}

static const struct br_function_ops nodal_ops = {
    .evaluate = evaluate, .clone = clone, .free = free};

/* ---- columns ---- */

size_t br_step_states(const struct br_field *rod)
{
    return 2 * br_field_unknowns(rod) * rod->n;
}

/* One step from a state, displacement and k times velocity with their clamped nodes, to another. */
static enum br_status march_once(const struct br_field *rod, double stiffness, double *state,
                                 struct br_error *err)
{
    const size_t size = br_field_size(rod);
    for (size_t i = 0; i < size; i++)
        state[size + i] /= rod->k;
    struct nodal start[2] = {{rod, state}, {rod, state + size}};
    struct br_method method = br_method_default();
    method.axial_degree = rod->degree;
    const struct br_scene scene = {
        .length = (double)rod->n * rod->h,
        .duration = rod->k,
        .density = rod->density,
        .axial = {.modelled = true,
                  .stiffness = rod->stiffness,
                  .viscosity = rod->viscosity,
                  .displacement = {.ops = &nodal_ops, .self = &start[0], .uses_x = true},
                  .velocity = {.ops = &nodal_ops, .self = &start[1], .uses_x = true}},
        .contact = {.modelled = true, .stiffness = stiffness},
    };
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

/* Where entry i of a state stands among nodal values with their clamped nodes. */
static size_t place(const struct br_field *rod, size_t i)
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
        state[place(rod, j)] = 1;
        status = march_once(rod, stiffness, state, err);
        for (size_t i = 0; i < states; i++)
            matrix[i * states + j] = state[place(rod, i)];
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
