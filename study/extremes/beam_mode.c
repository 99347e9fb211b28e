/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/extremes/beam_mode.h"

#include <gsl/gsl_eigen.h>
#include <math.h>
#include <stdint.h>

#include "reference/textbook.h"

/* ---- the matrices ---- */

static void assemble(const struct br_field *f, gsl_matrix *k, gsl_matrix *m)
{
    const size_t d = br_field_unknowns(f);
    const bool axial = f->kind == BR_AXIAL;
    const double bend = f->stiffness / (axial ? f->h : f->h * f->h * f->h);
    for (size_t e = 0; e < f->n; e++)
        for (size_t i = 0; i < 2 * d; i++)
            for (size_t j = 0; j < 2 * d; j++) {
                const size_t row = e * d + i, column = e * d + j;
                if (row < d || column < d)
                    continue; /* clamped */
                const double mass = axial ? br_rod_mass[i][j] / 6.0 : br_beam_mass[i][j] / 420.0;
                *gsl_matrix_ptr(k, row - d, column - d) +=
                    bend * (axial ? br_rod_stiffness[i][j] : br_beam_stiffness[i][j]);
                *gsl_matrix_ptr(m, row - d, column - d) += f->density * f->h * mass;
            }
}

/* ---- the mode ---- */

static void take_lowest(struct br_beam_mode *mode, const gsl_vector *values,
                        const gsl_matrix *vectors, const gsl_matrix *m)
{
    const size_t size = values->size, tip = mode->kind == BR_AXIAL ? size - 1 : size - 2;
    const size_t lowest = gsl_vector_min_index(values);
    double square = 0;
    mode->omega = sqrt(gsl_vector_get(values, lowest));
    for (size_t i = 0; i < size; i++)
        mode->phi[i] = gsl_matrix_get(vectors, i, lowest) / gsl_matrix_get(vectors, tip, lowest);
    for (size_t i = 0; i < size; i++) {
        mode->weight[i] = 0;
        for (size_t j = 0; j < size; j++)
            mode->weight[i] += gsl_matrix_get(m, i, j) * mode->phi[j];
        square += mode->weight[i] * mode->phi[i];
    }
    for (size_t i = 0; i < size; i++)
        mode->weight[i] /= square;
}

enum br_status br_beam_mode_find(struct br_beam_mode *mode, const struct br_scene *scene,
                                 enum br_field_kind kind, struct br_error *err)
{
    const struct br_field f = br_field_of_scene(scene, kind, BR_MODE_ELEMENTS, NAN);
    const size_t size = br_field_unknowns(&f) * f.n;
    *mode = (struct br_beam_mode){.kind = kind, .length = scene->length};
    gsl_matrix *k = gsl_matrix_calloc(size, size), *m = gsl_matrix_calloc(size, size),
               *kept = gsl_matrix_calloc(size, size), *vectors = gsl_matrix_calloc(size, size);
    gsl_vector *values = gsl_vector_calloc(size);
    gsl_eigen_gensymmv_workspace *w = gsl_eigen_gensymmv_alloc(size);
    enum br_status status = BR_OK;
    if (!k || !m || !kept || !vectors || !values || !w) {
        status = br_no_memory(err, "a mode");
        goto done;
    }
    assemble(&f, k, m);
    gsl_matrix_memcpy(kept, m);
    if (gsl_eigen_gensymmv(k, m, values, vectors, w))
        status = br_fail(err, BR_SINGULAR, "the modes of %zu elements were not found", f.n);
    else
        take_lowest(mode, values, vectors, kept);
done:
    gsl_eigen_gensymmv_free(w);
    gsl_vector_free(values);
    gsl_matrix_free(vectors);
    gsl_matrix_free(kept);
    gsl_matrix_free(m);
    gsl_matrix_free(k);
    return status;
}

/* ---- as initial data ---- */

/* Nodal values are all that is asked for: Lagrange or Hermite interpolation. */
static void evaluate(const struct br_beam_mode *mode, bool slope, size_t count, const double *x,
                     double *value)
{
    const size_t d = mode->kind == BR_AXIAL ? 1 : 2;
    const double h = mode->length / BR_MODE_ELEMENTS;
    for (size_t i = 0; i < count; i++) {
        const size_t node = (size_t)lround(x[i] / h);
        value[i] = node == 0 ? 0 : mode->phi[(node - 1) * d + slope] / (slope ? h : 1);
    }
}

static void evaluate_value(void *self, size_t count, const double *x, double t, double *value)
{
    (void)t;
    evaluate(self, false, count, x, value);
}

static void evaluate_slope(void *self, size_t count, const double *x, double t, double *value)
{
    (void)t;
    evaluate(self, true, count, x, value);
}

static void *same(const void *self)
{
    return (void *)(uintptr_t)self;
}

static void nothing(void *self)
{
    (void)self;
}

struct br_function br_beam_mode_function(const struct br_beam_mode *mode, bool slope)
{
    static const struct br_function_ops value_ops = {.evaluate = evaluate_value,
                                                     .clone = same,
                                                     .free = nothing},
                                        slope_ops = {.evaluate = evaluate_slope,
                                                     .clone = same,
                                                     .free = nothing};
    return (struct br_function){
        .ops = slope ? &slope_ops : &value_ops, .self = same(mode), .uses_x = true};
}

double br_beam_mode_part(const struct br_beam_mode *mode, const double *nodal)
{
    const size_t d = mode->kind == BR_AXIAL ? 1 : 2;
    double part = 0;
    for (size_t i = 0; i < d * BR_MODE_ELEMENTS; i++)
        part += mode->weight[i] * nodal[d + i];
    return part;
}
