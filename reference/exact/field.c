/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/inside.h"

#include <cblas.h>
#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

#include "base/blas.h"

enum { S = BR_STAGES };

size_t br_modes_length(const struct br_modes *modes, size_t order)
{
    return br_spectral_at(&modes->spectral, modes->spectral.count, modes->degree - order);
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
            br_spectral_integrate(&modes->spectral, d, &b[j * rows]);
    }
    br_blas_enter();
    const lapack_int info =
        LAPACKE_dgesdd(LAPACK_COL_MAJOR, 'S', (lapack_int)rows, (lapack_int)m, b, (lapack_int)rows,
                       modes->size, modes->shape, (lapack_int)rows, modes->curve, (lapack_int)m);
    br_blas_leave();
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
 * second one. Loads are tested with these integrals, not with s Y: in a short element at the clamp
 * the modes are small, and Y has the round-off of its largest entries there. */
static enum br_status integrate(struct br_modes *modes, struct br_error *err)
{
    const size_t m = modes->count, rows = br_modes_length(modes, 0);
    double *c = br_allocate(rows, sizeof *c);
    for (size_t i = 0; c && i < m; i++) {
        memcpy(c, &modes->curve[i * m], m * sizeof *c);
        if (modes->degree > 1) {
            modes->slope[i] = br_spectral_integral(&modes->spectral, 0, c);
            br_spectral_integrate(&modes->spectral, 0, c);
        }
        modes->tip[i] = br_spectral_integral(&modes->spectral, modes->degree - 1, c);
        br_spectral_integrate(&modes->spectral, modes->degree - 1, c);
        for (size_t k = 0; k < rows; k++)
            modes->function[k * modes->width + i] = c[k];
    }
    free(c);
    return c ? BR_OK : br_no_memory(err, "the modes");
}

enum br_status br_modes_init(struct br_modes *modes, size_t degree, struct br_store *store,
                             struct br_error *err)
{
    if (store->failed)
        return br_no_memory(err, "the modes");
    const size_t m = modes->count = br_spectral_at(&modes->spectral, modes->spectral.count, 0);
    const size_t lanes = BR_STAGE_LANES, width = (m + lanes - 1) / lanes * lanes;
    modes->width = width;
    modes->degree = degree;
    const size_t rows = br_modes_length(modes, 0);
    modes->size = br_store_take(store, width, sizeof *modes->size);
    modes->shape = br_store_take(store, m * rows, sizeof *modes->shape);
    modes->function = br_store_take(store, rows * width, sizeof *modes->function);
    modes->curve = br_store_take(store, m * m, sizeof *modes->curve);
    modes->tip = br_store_take(store, width, sizeof *modes->tip);
    modes->slope = br_store_take(store, width, sizeof *modes->slope);
    br_quadrature_init(&modes->quadrature, &modes->spectral, degree, store);
    if (store->failed)
        return br_no_memory(err, "the modes");
    const enum br_status status = decompose(modes, err);
    return status ? status : integrate(modes, err);
}

void br_modes_expand(const struct br_modes *modes, size_t order, const double *q, double *c)
{
    br_combine(1, modes->count, q, modes->count, modes->curve, c); /* c = U q */
    for (size_t d = 0; d < modes->degree - order; d++)
        br_spectral_integrate(&modes->spectral, d, c);
}

/* ---- the field on its modes ---- */

/* y = A' x; A has `rows` rows, by columns. */
static void multiply_transposed(size_t rows, size_t columns, const double *a, const double *x,
                                double *y)
{
    for (size_t j = 0; j < columns; j++) {
        y[j] = 0;
        for (size_t i = 0; i < rows; i++)
            y[j] += a[j * rows + i] * x[i];
    }
}

/* The displacement's energy projection, and the velocity's L2 projection. */
static enum br_status set_initial(struct br_oscillators *f, struct br_error *err)
{
    const struct br_modes *modes = &f->modes;
    const struct br_scene_field *d = f->data;
    const struct br_function *slope = br_initial_slope(d, modes->degree);
    const size_t m = modes->count, rows = br_modes_length(modes, 0);
    const double scale = modes->degree == 1 ? 1 : f->length; /* dw/dxi = L dw/dx */
    double *c = f->load_series;
    enum br_status status = BR_OK;
    if (!br_function_is_zero(slope)) {
        status = br_quadrature_project_slope(&modes->quadrature, slope, c, err);
        multiply_transposed(m, m, modes->curve, c, f->displacement); /* U' c */
        for (size_t i = 0; i < m; i++)
            f->displacement[i] *= scale;
    }
    if (!status && !br_function_is_zero(&d->velocity)) {
        status = br_quadrature_project(&modes->quadrature, &d->velocity, 0, NULL, c, err);
        multiply_transposed(rows, m, modes->shape, c, f->velocity); /* Y' c */
        for (size_t i = 0; i < m; i++) /* modes below round-off carry none */
            f->velocity[i] *=
                modes->size[i] > DBL_EPSILON * modes->size[0] ? 1 / modes->size[i] : 0;
    }
    br_function_evaluate(&d->displacement, 1, &f->length, 0, &f->tip_displacement);
    br_function_evaluate(&d->velocity, 1, &f->length, 0, &f->tip_velocity);
    return status;
}

/* out (rows x width) = the modes' integrals of functions whose coefficients are the rows of c. */
static void test(const struct br_oscillators *f, size_t rows, const double *c, double *out)
{
    const struct br_modes *m = &f->modes;
    br_combine(rows, br_modes_length(m, 0), c, m->width, m->function, out);
}

static enum br_status set_space(struct br_oscillators *f, struct br_error *err)
{
    const size_t width = f->modes.width;
    enum br_status status = BR_OK;
    for (size_t term = 0; term < BR_LOAD_TERMS && !status; term++) {
        const struct br_product *p = &f->data->load.term[term];
        double *space = f->load_space + term * width;
        if (p->space.uses_t || br_product_is_zero(p))
            continue;
        status =
            br_quadrature_project(&f->modes.quadrature, &p->space, 0, NULL, f->load_series, err);
        test(f, 1, f->load_series, space);
        for (size_t i = 0; i < width; i++)
            space[i] *= f->length;
    }
    return status;
}

enum br_status br_oscillators_create(struct br_oscillators **out, const struct br_scene *scene,
                                     const struct br_data_mesh *data_mesh, size_t modes,
                                     struct br_store *store, struct br_error *err)
{
    const size_t elements = data_mesh->end[BR_X].count - 1;
    const double power = pow(scene->length, 1 - 2 * (double)data_mesh->degree);
    struct br_oscillators *f = *out = br_store_take(store, 1, sizeof *f);
    size_t *terms = br_store_take(store, elements, sizeof *terms);
    if (!terms)
        return br_no_memory(err, "the modes");
    f->length = scene->length;
    f->data = data_mesh->data;
    f->fronts = data_mesh->fronts;
    f->damping = f->data->viscosity * power;
    f->stiffness = f->data->stiffness * power;
    for (size_t e = 0; e < elements; e++)
        terms[e] = br_data_mesh_terms(data_mesh, e, modes);
    br_spectral_init(&f->modes.spectral, f->length, elements, data_mesh->end[BR_X].at, terms,
                     store);
    enum br_status status = br_modes_init(&f->modes, data_mesh->degree, store, err);
    if (status)
        return status;
    const size_t m = f->modes.count, width = f->modes.width, rows = br_modes_length(&f->modes, 0);
    f->mass = br_store_take(store, width, sizeof *f->mass);
    f->load_space = br_store_take(store, width * BR_LOAD_TERMS, sizeof *f->load_space);
    f->load_series = br_store_take(store, S * rows, sizeof *f->load_series);
    f->load_sum = br_store_take(store, S * width, sizeof *f->load_sum);
    f->displacement = br_store_take(store, m, sizeof *f->displacement);
    f->velocity = br_store_take(store, m, sizeof *f->velocity);
    if (store->failed)
        return br_no_memory(err, "the modes");
    for (size_t i = 0; i < width; i++)
        f->mass[i] = i < m ? scene->density * f->length * f->modes.size[i] * f->modes.size[i] : 1;
    status = set_space(f, err);
    return status ? status : set_initial(f, err);
}

/* out[i] += force * tip_i + moment * slope_i / L */
static void add_tip(const struct br_oscillators *f, double t, double *out)
{
    const double force = br_function_at(&f->data->tip_force, f->length, t),
                 moment = br_function_at(&f->data->tip_moment, f->length, t);
    for (size_t i = 0; i < f->modes.count; i++)
        out[i] += force * f->modes.tip[i] + moment / f->length * f->modes.slope[i];
}

/* c (out): coefficients of a load that no product gives, at one time: cut where it jumps there. */
static enum br_status load_at(const struct br_oscillators *f, const struct br_function *space,
                              double t, double *c, struct br_error *err)
{
    struct br_breaks breaks = {0};
    enum br_status status = BR_OK;
    if (f->fronts && space->uses_x)
        status = br_breaks_add(space, BR_X, (struct br_box){{0, f->length}, {t, t}}, &breaks, err);
    if (!status)
        status = br_quadrature_project(&f->modes.quadrature, space, t, &breaks, c, err);
    br_breaks_free(&breaks);
    return status;
}

/* Adds a load that no product gives at all stages, times `factor`; the square of its size, too. */
static enum br_status add_moving(const struct br_oscillators *f, const struct br_function *space,
                                 const double t[S], const double factor[S], double *out,
                                 double size[S], struct br_error *err)
{
    const size_t rows = br_modes_length(&f->modes, 0);
    enum br_status status = BR_OK;
    for (size_t j = 0; j < S && !status; j++) {
        double *c = &f->load_series[j * rows];
        status = load_at(f, space, t[j], c, err);
        cblas_dscal((int)rows, factor[j] * f->length, c, 1);
        size[j] += cblas_dnrm2((int)rows, c, 1);
    }
    test(f, S, f->load_series, f->load_sum);
    for (size_t i = 0; i < S * f->modes.width; i++)
        out[i] += f->load_sum[i];
    return status;
}

enum br_status br_oscillators_load(const struct br_oscillators *f, const double t[S], double *out,
                                   double *size, struct br_error *err)
{
    const size_t width = f->modes.width;
    double factor[S], sizes[S] = {0};
    memset(out, 0, S * width * sizeof *out);
    for (size_t term = 0; term < BR_LOAD_TERMS; term++) {
        const struct br_product *p = &f->data->load.term[term];
        const double *space = f->load_space + term * width;
        enum br_status status = BR_OK;
        if (br_product_is_zero(p))
            continue;
        for (size_t j = 0; j < S; j++)
            br_function_evaluate(&p->time, 1, &f->length, t[j], &factor[j]);
        if (p->space.uses_t)
            status = add_moving(f, &p->space, t, factor, out, sizes, err);
        if (status)
            return status;
        for (size_t j = 0; j < S && !p->space.uses_t; j++)
            for (size_t i = 0; i < width; i++)
                out[j * width + i] += factor[j] * space[i];
    }
    *size = 0;
    for (size_t j = 0; j < S; j++) {
        add_tip(f, t[j], out + j * width);
        *size = fmax(*size, sizes[j]);
    }
    return BR_OK;
}

double br_oscillators_work(const struct br_oscillators *f)
{
    const double points = (double)f->modes.quadrature.count, m = (double)f->modes.count;
    const double elements = (double)f->modes.spectral.count;
    double work = 4 + 0.15 * m;
    for (size_t term = 0; term < BR_LOAD_TERMS; term++) {
        const struct br_product *p = &f->data->load.term[term];
        if (p->space.uses_t && !br_product_is_zero(p))
            work += S * (0.05 * points + 1.5e-4 * points * m / elements + 7e-5 * m * m) +
                    (f->fronts ? 100 : 0);
    }
    return work;
}

double br_oscillators_norm(const struct br_oscillators *f, const double *q)
{
    return sqrt(f->length) * br_norm(f->modes.count, f->modes.size, q);
}
