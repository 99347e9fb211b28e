/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <cblas.h>
#include <gsl/gsl_integration.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

#include "reference/exact/legendre.h"
#include "reference/exact/query.h"

/* Both matrices act on the part's Legendre coefficients. The local coefficients
 * above the degree are only ever needed as a sum of squares over all elements,
 * |T c|^2 = |R c|^2 with T = Q R, so that a triangle is all that is kept. */
struct br_exact_projection {
    struct br_exact_part part;
    size_t length;  /* number of the part's Legendre coefficients */
    size_t rows;    /* elements x (degree + 1) */
    double *matrix; /* rows x length, by rows */
    double *rest;   /* R, length x length, upper triangle by columns */
    double *series; /* 2 length + 2, workspace */
};

/* Gauss's rule on an element, and polynomials at its points. */
struct rule {
    size_t points, degree;
    gsl_integration_glfixed_table *gauss;
    double *local;  /* points x points: weight times p_l at each point, by rows l */
    double *global; /* points x length: p_k at each point, by rows */
    double *stack;  /* (length + rest rows) x length, by columns */
};

/* Enough for the local coefficients to fall below round-off: p_k oscillates
 * like cos(k phi), most on the end elements, where phi spans 2 sqrt(h). GSL
 * knows the rules with these numbers of points to all digits. */
static size_t rule_points(size_t length, const struct br_exact_mesh *mesh)
{
    static const size_t known[] = {20, 32, 64, 96, 128, 256, 512, 1024};
    const double h = 1 / (double)mesh->elements;
    const double wanted =
        fmin((double)(length + mesh->degree) / 2 + 1, 18 + 2 * (double)length * sqrt(h));
    size_t i = 0;
    while (i + 1 < sizeof known / sizeof *known && (double)known[i] < wanted)
        i++;
    return known[i];
}

static enum br_status rule_init(struct rule *r, size_t length, const struct br_exact_mesh *mesh,
                                struct br_error *err)
{
    const size_t n = rule_points(length, mesh);
    r->points = n;
    r->degree = mesh->degree;
    r->gauss = gsl_integration_glfixed_table_alloc(n);
    r->local = br_allocate(n * n, sizeof *r->local);
    r->global = br_allocate(n * length, sizeof *r->global);
    r->stack = br_allocate((length + n) * length, sizeof *r->stack);
    if (!r->gauss || !r->local || !r->global || !r->stack)
        return br_no_memory(err, "a projection");
    for (size_t i = 0; i < n; i++) {
        double xi, weight, *p = r->global; /* not in use yet, and long enough */
        gsl_integration_glfixed_point(0, 1, i, &xi, &weight, r->gauss);
        br_legendre(n, xi, p);
        for (size_t l = 0; l < n; l++)
            r->local[l * n + i] = weight * p[l];
    }
    return BR_OK;
}

static void rule_clear(struct rule *r)
{
    gsl_integration_glfixed_table_free(r->gauss);
    free(r->local);
    free(r->global);
    free(r->stack);
}

/* R of [R; block], both in the stack: R in its first `length` rows */
static enum br_status reduce(struct rule *r, size_t length, double *tau, struct br_error *err)
{
    const int rows = (int)(length + r->points - r->degree - 1), columns = (int)length;
    const lapack_int info = LAPACKE_dgeqrf(LAPACK_COL_MAJOR, rows, columns, r->stack, rows, tau);
    for (int k = 0; k < columns; k++) /* the reflectors below the diagonal are not needed */
        memset(&r->stack[k * rows + k + 1], 0, (size_t)(rows - k - 1) * sizeof(double));
    return info ? br_fail(err, BR_SINGULAR, "a projection's remainder failed (%d)", (int)info)
                : BR_OK;
}

/* Element e of n: its rows of the matrix, and its share of the rest. */
static enum br_status add_element(struct br_exact_projection *p, struct rule *r, size_t e, size_t n,
                                  double root_h, struct br_error *err)
{
    const size_t kept = r->degree + 1, dropped = r->points - kept, length = p->length;
    const int points = (int)r->points, columns = (int)length, rows = (int)(length + dropped);
    for (size_t i = 0; i < r->points; i++) {
        double xi, weight;
        gsl_integration_glfixed_point(0, 1, i, &xi, &weight, r->gauss);
        br_legendre(length, ((double)e + xi) / (double)n, &r->global[i * length]);
    }
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, (int)kept, columns, points, root_h,
                r->local, points, r->global, columns, 0, &p->matrix[e * kept * length], columns);
    cblas_dgemm(CblasColMajor, CblasTrans, CblasTrans, (int)dropped, columns, points, root_h,
                r->local + kept * r->points, points, r->global, columns, 0, r->stack + length,
                rows);
    return reduce(r, length, p->series, err);
}

static enum br_status fill(struct br_exact_projection *p, const struct br_exact_mesh *mesh,
                           double beam, struct br_error *err)
{
    struct rule r = {0};
    const double root_h = sqrt(beam / (double)mesh->elements);
    enum br_status status = rule_init(&r, p->length, mesh, err);
    for (size_t e = 0; e < mesh->elements && !status; e++)
        status = add_element(p, &r, e, mesh->elements, root_h, err);
    for (size_t k = 0; k < p->length && !status; k++)
        memcpy(&p->rest[k * p->length], &r.stack[k * (p->length + r.points - r.degree - 1)],
               p->length * sizeof(double));
    rule_clear(&r);
    return status;
}

enum br_status br_exact_projection_create(struct br_exact_projection **out,
                                          const struct br_exact *exact,
                                          const struct br_exact_part *part,
                                          const struct br_exact_mesh *mesh, struct br_error *err)
{
    *out = NULL;
    enum br_status status = br_exact_check_part(exact, part, 0, err);
    if (!status && (!mesh->elements || mesh->degree > 8))
        status = br_fail(err, BR_BAD_INPUT,
                         "%zu elements of degree %zu, expected 1 or more of at most 8",
                         mesh->elements, mesh->degree);
    if (status)
        return status;
    struct br_exact_projection *p = br_allocate(1, sizeof *p);
    if (!p)
        return br_no_memory(err, "a projection");
    const struct br_field *field = exact->solution->field[part->field];
    p->part = *part;
    p->length = br_modes_length(field->modes, part->order);
    p->rows = mesh->elements * (mesh->degree + 1);
    p->matrix = br_allocate(p->rows * p->length, sizeof *p->matrix);
    p->rest = br_allocate(p->length * p->length, sizeof *p->rest);
    p->series = br_allocate(2 * p->length + 2, sizeof *p->series);
    if (!p->matrix || !p->rest || !p->series)
        status = br_no_memory(err, "a projection");
    if (!status)
        status = fill(p, mesh, field->length, err);
    if (status)
        br_exact_projection_free(p);
    else
        *out = p;
    return status;
}

void br_exact_projection_free(struct br_exact_projection *p)
{
    if (!p)
        return;
    free(p->matrix);
    free(p->rest);
    free(p->series);
    free(p);
}

void br_exact_projection_apply(struct br_exact_projection *p, const struct br_exact *exact,
                               const struct br_exact_state *state, double *c, double *rest)
{
    const int length = (int)p->length;
    br_exact_series(exact, state, &p->part, p->series);
    cblas_dgemv(CblasRowMajor, CblasNoTrans, (int)p->rows, length, 1, p->matrix, length, p->series,
                1, 0, c, 1);
    cblas_dtrmv(CblasColMajor, CblasUpper, CblasNoTrans, CblasNonUnit, length, p->rest, length,
                p->series, 1);
    *rest = cblas_ddot(length, p->series, 1, p->series, 1);
}
