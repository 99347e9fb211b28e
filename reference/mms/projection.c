/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/mms/projection.h"

#include <gsl/gsl_integration.h>
#include <math.h>
#include <string.h>

#include "reference/exact/legendre.h"

/* Twelve Gauss points know the modes up to degree 10 of a polynomial of degree 13. */
enum { POINTS = 12, MODES = 11, TAIL = 2 };

struct br_projection {
    struct br_function derivative;
    size_t kept, n;
    double h;                     /* m */
    double weight[POINTS][MODES]; /* Gauss weight times mode */
    double *x;                    /* n * POINTS, m */
    double *value;                /* there */
};

static enum br_status fill_points(struct br_projection *p, struct br_error *err)
{
    gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(POINTS);
    if (!table)
        return br_no_memory(err, "a Gauss rule");
    for (size_t q = 0; q < POINTS; q++) {
        double xi, weight, legendre[MODES];
        gsl_integration_glfixed_point(0, 1, q, &xi, &weight, table);
        br_legendre(MODES, xi, legendre);
        for (size_t m = 0; m < MODES; m++)
            p->weight[q][m] = weight * legendre[m];
        for (size_t e = 0; e < p->n; e++)
            p->x[e * POINTS + q] = p->h * ((double)e + xi);
    }
    gsl_integration_glfixed_table_free(table);
    return BR_OK;
}

static enum br_status set_up(struct br_projection *p, const struct br_function *solution,
                             struct br_partial order, struct br_error *err)
{
    p->x = br_allocate(2 * p->n * POINTS, sizeof *p->x);
    if (!p->x)
        return br_no_memory(err, "a projection");
    p->value = p->x + p->n * POINTS;
    const enum br_status status = fill_points(p, err);
    return status ? status : br_function_derivative(solution, order, &p->derivative, err);
}

enum br_status br_projection_create(struct br_projection **out, const struct br_function *solution,
                                    const struct br_projected *what,
                                    const struct br_projection_mesh *mesh, struct br_error *err)
{
    *out = NULL;
    if (what->kept > BR_PROJECTION_MOST_KEPT)
        return br_fail(err, BR_BAD_INPUT, "%zu modes are to be kept, expected at most %d",
                       what->kept, BR_PROJECTION_MOST_KEPT);
    struct br_projection *p = br_allocate(1, sizeof *p);
    if (!p)
        return br_no_memory(err, "a projection");
    p->kept = what->kept;
    p->n = mesh->n;
    p->h = mesh->length / (double)mesh->n;
    const enum br_status status = set_up(p, solution, what->order, err);
    if (status) {
        br_projection_free(p);
        return status;
    }
    *out = p;
    return BR_OK;
}

void br_projection_free(struct br_projection *p)
{
    if (!p)
        return;
    br_function_free(&p->derivative);
    free(p->x);
    free(p);
}

/* All modes of an element from its values. */
static void element_modes(const struct br_projection *p, const double *value, double mode[MODES])
{
    memset(mode, 0, MODES * sizeof *mode);
    for (size_t q = 0; q < POINTS; q++)
        for (size_t m = 0; m < MODES; m++)
            mode[m] += sqrt(p->h) * value[q] * p->weight[q][m];
}

struct br_projection_rest br_projection_apply(struct br_projection *p, double t, double *modes)
{
    struct br_projection_rest sums = {0};
    br_function_evaluate(&p->derivative, p->n * POINTS, p->x, t, p->value);
    for (size_t e = 0; e < p->n; e++) {
        double mode[MODES];
        element_modes(p, p->value + e * POINTS, mode);
        memcpy(modes + e * p->kept, mode, p->kept * sizeof *mode);
        for (size_t m = p->kept; m < MODES; m++)
            sums.rest += mode[m] * mode[m];
        for (size_t m = MODES - TAIL; m < MODES; m++)
            sums.tail += mode[m] * mode[m];
    }
    return sums;
}
