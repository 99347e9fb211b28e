/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/modes.h"

#include <cblas.h>
#include <float.h>
#include <lapacke.h>

size_t br_modes_length(const struct br_modes *modes, size_t order)
{
    return br_pieces_at(&modes->pieces, modes->pieces.count, modes->degree - order);
}

static void transpose(size_t m, double *a)
{
    for (size_t i = 0; i < m; i++)
        for (size_t j = 0; j < i; j++) {
            const double swap = a[i * m + j];
            a[i * m + j] = a[j * m + i];
            a[j * m + i] = swap;
        }
}

/* B = Y diag(s) U' */
static enum br_status decompose(struct br_modes *modes, struct br_error *err)
{
    const size_t m = modes->count, rows = br_modes_length(modes, 0);
    double *b = br_allocate(rows * m, sizeof *b);
    if (!b)
        return br_no_memory(err, "the modes");
    for (size_t j = 0; j < m; j++) {
        b[j * rows + j] = 1;
        for (size_t d = 0; d < modes->degree; d++)
            br_pieces_integrate(&modes->pieces, d, &b[j * rows]);
    }
    const lapack_int info =
        LAPACKE_dgesdd(LAPACK_COL_MAJOR, 'S', (lapack_int)rows, (lapack_int)m, b, (lapack_int)rows,
                       modes->size, modes->shape, (lapack_int)rows, modes->curve, (lapack_int)m);
    free(b);
    if (info == LAPACK_WORK_MEMORY_ERROR)
        return br_no_memory(err, "the modes");
    if (info)
        return br_fail(err, BR_SINGULAR, "the decomposition into %zu modes failed (%d)", m,
                       (int)info);
    transpose(m, modes->curve); /* LAPACK gives U' */
    return BR_OK;
}

/* The tip's value is the integral over [0, 1] of the first derivative, and its slope that of the
 * second one. */
static enum br_status integrate(struct br_modes *modes, struct br_error *err)
{
    const size_t m = modes->count, rows = br_modes_length(modes, 0);
    double *q = br_allocate(m, sizeof *q);
    for (size_t i = 0; q && i < m; i++) {
        double *c = &modes->function[i * rows];
        q[i] = 1;
        br_modes_expand(modes, modes->degree, q, c);
        if (modes->degree > 1) {
            modes->slope[i] = br_pieces_integral(&modes->pieces, 0, c);
            br_pieces_integrate(&modes->pieces, 0, c);
        }
        modes->tip[i] = br_pieces_integral(&modes->pieces, modes->degree - 1, c);
        br_pieces_integrate(&modes->pieces, modes->degree - 1, c);
        q[i] = 0;
    }
    free(q);
    return q ? BR_OK : br_no_memory(err, "the modes");
}

static enum br_status allocate(struct br_modes *modes, struct br_error *err)
{
    const size_t m = modes->count, rows = br_modes_length(modes, 0);
    modes->size = br_allocate(m, sizeof *modes->size);
    modes->shape = br_allocate(m * rows, sizeof *modes->shape);
    modes->function = br_allocate(m * rows, sizeof *modes->function);
    modes->curve = br_allocate(m * m, sizeof *modes->curve);
    modes->tip = br_allocate(m, sizeof *modes->tip);
    modes->slope = br_allocate(m, sizeof *modes->slope);
    modes->series = br_allocate(rows, sizeof *modes->series);
    const bool done = modes->size && modes->shape && modes->function && modes->curve &&
                      modes->tip && modes->slope && modes->series;
    return done ? br_quadrature_init(&modes->quadrature, &modes->pieces, modes->degree, err)
                : br_no_memory(err, "the modes");
}

enum br_status br_modes_create(struct br_modes **out, const struct br_pieces *pieces, size_t degree,
                               struct br_error *err)
{
    *out = NULL;
    struct br_modes *modes = br_allocate(1, sizeof *modes);
    if (!modes)
        return br_no_memory(err, "the modes");
    modes->count = br_pieces_at(pieces, pieces->count, 0);
    modes->degree = degree;
    enum br_status status = br_pieces_init(&modes->pieces, pieces->length, pieces->count,
                                           pieces->end, pieces->terms, err);
    if (!status)
        status = allocate(modes, err);
    if (!status)
        status = decompose(modes, err);
    if (!status)
        status = integrate(modes, err);
    if (status)
        br_modes_free(modes);
    else
        *out = modes;
    return status;
}

void br_modes_free(struct br_modes *modes)
{
    if (!modes)
        return;
    br_quadrature_clear(&modes->quadrature);
    br_pieces_clear(&modes->pieces);
    free(modes->size);
    free(modes->shape);
    free(modes->function);
    free(modes->curve);
    free(modes->tip);
    free(modes->slope);
    free(modes->series);
    free(modes);
}

void br_modes_expand(const struct br_modes *modes, size_t order, const double *q, double *c)
{
    br_combine_best()(modes->count, q, modes->count, modes->curve, c); /* c = U q */
    for (size_t d = 0; d < modes->degree - order; d++)
        br_pieces_integrate(&modes->pieces, d, c);
}

/* out = A' c, A one of the matrices of all functions, c the Legendre coefficients of f. */
static enum br_status test_with(struct br_modes *modes, const double *a,
                                const struct br_function *f, double t, struct br_places fronts,
                                double *out, struct br_error *err)
{
    const int rows = (int)br_modes_length(modes, 0);
    const enum br_status status =
        br_quadrature_project(&modes->quadrature, f, t, fronts, modes->series, err);
    cblas_dgemv(CblasColMajor, CblasTrans, rows, (int)modes->count, 1, a, rows, modes->series, 1, 0,
                out, 1);
    return status;
}

/* With the integrals, not with s Y: in a short element at the clamp the modes are small, and Y has
 * the round-off of its largest entries there. */
enum br_status br_modes_load(struct br_modes *modes, const struct br_function *f, double t,
                             struct br_places fronts, double *out, struct br_error *err)
{
    return test_with(modes, modes->function, f, t, fronts, out, err);
}

/* A mode that is smaller than round-off carries no velocity. */
enum br_status br_modes_project(struct br_modes *modes, const struct br_function *f, double *q,
                                struct br_error *err)
{
    const enum br_status status =
        test_with(modes, modes->shape, f, 0, (struct br_places){0}, q, err);
    for (size_t i = 0; i < modes->count; i++)
        q[i] = modes->size[i] > DBL_EPSILON * modes->size[0] ? q[i] / modes->size[i] : 0;
    return status;
}

enum br_status br_modes_project_energy(struct br_modes *modes, const struct br_function *f,
                                       double scale, double *q, struct br_error *err)
{
    const int m = (int)modes->count;
    double *rate = br_allocate(modes->count, sizeof *rate);
    if (!rate)
        return br_no_memory(err, "a projection");
    const enum br_status status = br_quadrature_project_slope(&modes->quadrature, f, rate, err);
    cblas_dgemv(CblasColMajor, CblasTrans, m, m, scale, modes->curve, m, rate, 1, 0, q,
                1); /* q = U' c */
    free(rate);
    return status;
}
