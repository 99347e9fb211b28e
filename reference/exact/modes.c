/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/modes.h"

#include <cblas.h>
#include <gsl/gsl_integration.h>
#include <lapacke.h>

#include "reference/exact/combine.h"
#include "reference/exact/legendre.h"

size_t br_modes_length(const struct br_modes *modes, size_t order)
{
    return modes->count + modes->degree - order;
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
            br_legendre_integrate(m + d, &b[j * rows]);
    }
    const lapack_int info =
        LAPACKE_dgesdd(LAPACK_COL_MAJOR, 'S', (lapack_int)rows, (lapack_int)m, b, (lapack_int)rows,
                       modes->size, modes->shape, (lapack_int)rows, modes->curve, (lapack_int)m);
    free(b);
    if (info)
        return br_fail(err, info == LAPACK_WORK_MEMORY_ERROR ? BR_NO_MEMORY : BR_SINGULAR,
                       "the decomposition into %zu modes failed (%d)", m, (int)info);
    transpose(m, modes->curve); /* LAPACK gives U' */
    return BR_OK;
}

/* The tip's value is the integral over [0, 1] of the first derivative, its
 * coefficient of p_0 = 1; and the tip's slope that of the second one. */
static enum br_status find_tip(struct br_modes *modes, struct br_error *err)
{
    const size_t m = modes->count;
    double *series = br_allocate(m + modes->degree, sizeof *series);
    double *q = br_allocate(m, sizeof *q);
    if (series && q)
        for (size_t i = 0; i < m; i++) {
            q[i] = 1;
            br_modes_expand(modes, 1, q, series);
            modes->tip[i] = series[0];
            if (modes->degree > 1) {
                br_modes_expand(modes, 2, q, series);
                modes->slope[i] = series[0];
            }
            q[i] = 0;
        }
    const bool done = series && q;
    free(series);
    free(q);
    return done ? BR_OK : br_no_memory(err, "the modes");
}

enum br_status br_modes_create(struct br_modes **out, size_t count, size_t degree,
                               struct br_error *err)
{
    *out = NULL;
    struct br_modes *modes = br_allocate(1, sizeof *modes);
    if (!modes)
        return br_no_memory(err, "the modes");
    modes->count = count;
    modes->degree = degree;
    modes->size = br_allocate(count, sizeof *modes->size);
    modes->shape = br_allocate(count * (count + degree), sizeof *modes->shape);
    modes->curve = br_allocate(count * count, sizeof *modes->curve);
    modes->tip = br_allocate(count, sizeof *modes->tip);
    modes->slope = br_allocate(count, sizeof *modes->slope);
    enum br_status status = BR_OK;
    if (!modes->size || !modes->shape || !modes->curve || !modes->tip || !modes->slope)
        status = br_no_memory(err, "the modes");
    if (!status)
        status = decompose(modes, err);
    if (!status)
        status = find_tip(modes, err);
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
    free(modes->size);
    free(modes->shape);
    free(modes->curve);
    free(modes->tip);
    free(modes->slope);
    free(modes);
}

void br_modes_expand(const struct br_modes *modes, size_t order, const double *q, double *c)
{
    br_combine_best()(modes->count, q, modes->count, modes->curve, c); /* c = U q */
    for (size_t d = 0; d < modes->degree - order; d++)
        br_legendre_integrate(modes->count + d, c);
}

/* At least twice as many points as a product of polynomials needs. GSL knows the
 * rules with these powers of two to all digits, others to 1e-10 only. */
static size_t quadrature_points(size_t count)
{
    size_t points = 64;
    while (points < 2 * count && points < 1024)
        points *= 2;
    return points;
}

/* c[k] = integral of f p_k over [0, 1] and, if asked for, dc[k] = integral of
 * f p_k', k < count. */
static enum br_status transform(const struct br_function *f, double length, double t, size_t count,
                                double *c, double *dc, struct br_error *err)
{
    const size_t points = quadrature_points(count);
    gsl_integration_glfixed_table *gauss = gsl_integration_glfixed_table_alloc(points);
    double *p = br_allocate(2 * count, sizeof *p);
    const bool done = gauss && p;
    for (size_t k = 0; k < count; k++)
        c[k] = 0;
    for (size_t k = 0; dc && k < count; k++)
        dc[k] = 0;
    for (size_t i = 0; done && i < points; i++) {
        double xi, weight, value;
        gsl_integration_glfixed_point(0, 1, i, &xi, &weight, gauss);
        const double x = length * xi;
        br_function_evaluate(f, 1, &x, t, &value);
        br_legendre_derivative(count, xi, p, p + count);
        cblas_daxpy((int)count, weight * value, p, 1, c, 1);
        if (dc)
            cblas_daxpy((int)count, weight * value, p + count, 1, dc, 1);
    }
    gsl_integration_glfixed_table_free(gauss);
    free(p);
    return done ? BR_OK : br_no_memory(err, "a projection");
}

/* out = diag(s)^power Y' c, c the Legendre coefficients of f */
static enum br_status test_with_shapes(const struct br_modes *modes, const struct br_function *f,
                                       double length, double t, bool divide, double *out,
                                       struct br_error *err)
{
    const size_t rows = br_modes_length(modes, 0);
    double *c = br_allocate(rows, sizeof *c);
    if (!c)
        return br_no_memory(err, "a projection");
    const enum br_status status = transform(f, length, t, rows, c, NULL, err);
    cblas_dgemv(CblasColMajor, CblasTrans, (int)rows, (int)modes->count, 1, modes->shape, (int)rows,
                c, 1, 0, out, 1);
    for (size_t i = 0; i < modes->count; i++)
        out[i] = divide ? out[i] / modes->size[i] : out[i] * modes->size[i];
    free(c);
    return status;
}

enum br_status br_modes_load(const struct br_modes *modes, const struct br_function *f,
                             double length, double t, double *out, struct br_error *err)
{
    return test_with_shapes(modes, f, length, t, false, out, err);
}

enum br_status br_modes_project(const struct br_modes *modes, const struct br_function *f,
                                double length, double *q, struct br_error *err)
{
    return test_with_shapes(modes, f, length, 0, true, q, err);
}

/* With g the given function, g(0) = 0 at the clamp: the coefficients of g' are
 * g(1) p_k(1) - integral of g p_k'. */
enum br_status br_modes_project_energy(const struct br_modes *modes, const struct br_function *f,
                                       double length, double scale, double *q, struct br_error *err)
{
    const size_t m = modes->count;
    double *work = br_allocate(3 * m, sizeof *work);
    if (!work)
        return br_no_memory(err, "a projection");
    double *unused = work, *rate = work + m, *end = work + 2 * m, tip;
    const enum br_status status = transform(f, length, 0, m, unused, rate, err);
    br_function_evaluate(f, 1, &length, 0, &tip);
    br_legendre(m, 1, end);
    for (size_t k = 0; k < m; k++)
        rate[k] = scale * (tip * end[k] - rate[k]);
    cblas_dgemv(CblasColMajor, CblasTrans, (int)m, (int)m, 1, modes->curve, (int)m, rate, 1, 0, q,
                1); /* q = U' c */
    free(work);
    return status;
}
