/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/mms/projection.h"

#include <gsl/gsl_integration.h>
#include <math.h>
#include <string.h>

#include "reference/exact/legendre.h"

/* Twelve Gauss points know the modes up to degree 10 of a polynomial of degree 13. */
enum { POINTS = 12, MODES = 11, TAIL = 2 };

struct br_projection {
    struct br_derivative *derivative;
    size_t kept;
    double xi[POINTS];            /* in [0, 1] */
    double weight[POINTS][MODES]; /* Gauss weight times mode */
};

static enum br_status fill_weights(struct br_projection *p, struct br_error *err)
{
    gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(POINTS);
    if (!table)
        return br_no_memory(err, "a Gauss rule");
    for (size_t q = 0; q < POINTS; q++) {
        double weight, legendre[MODES];
        gsl_integration_glfixed_point(0, 1, q, &p->xi[q], &weight, table);
        br_legendre(MODES, p->xi[q], legendre);
        for (size_t m = 0; m < MODES; m++)
            p->weight[q][m] = weight * legendre[m];
    }
    gsl_integration_glfixed_table_free(table);
    return BR_OK;
}

enum br_status br_projection_create(struct br_projection **out, const char *text,
                                    const struct br_projected *what, struct br_error *err)
{
    *out = NULL;
    if (what->kept > BR_PROJECTION_MOST_KEPT)
        return br_fail(err, BR_BAD_INPUT, "%zu modes are to be kept, expected at most %d",
                       what->kept, BR_PROJECTION_MOST_KEPT);
    struct br_projection *p = br_allocate(1, sizeof *p);
    if (!p)
        return br_no_memory(err, "a projection");
    p->kept = what->kept;
    enum br_status status = fill_weights(p, err);
    if (!status)
        status = br_derivative_create(&p->derivative, text, what->order, err);
    if (status) {
        br_projection_free(p);
        return status;
    }
    *out = p;
    return BR_OK;
}

void br_projection_free(struct br_projection *p)
{
    if (p)
        br_derivative_free(p->derivative);
    free(p);
}

/* All modes of element e, without the factor sqrt(h). */
static void element_modes(const struct br_projection *p, double h, size_t e, double t,
                          double mode[MODES])
{
    memset(mode, 0, MODES * sizeof *mode);
    for (size_t q = 0; q < POINTS; q++) {
        const double value = br_derivative_at(p->derivative, h * ((double)e + p->xi[q]), t);
        for (size_t m = 0; m < MODES; m++)
            mode[m] += value * p->weight[q][m];
    }
}

struct br_projection_rest br_projection_apply(const struct br_projection *p, double length,
                                              size_t n, double t, double *modes)
{
    const double h = length / (double)n, root = sqrt(h);
    struct br_projection_rest sums = {0};
    for (size_t e = 0; e < n; e++) {
        double mode[MODES];
        element_modes(p, h, e, t, mode);
        for (size_t m = 0; m < p->kept; m++)
            modes[e * p->kept + m] = root * mode[m];
        for (size_t m = p->kept; m < MODES; m++)
            sums.rest += h * mode[m] * mode[m];
        for (size_t m = MODES - TAIL; m < MODES; m++)
            sums.tail += h * mode[m] * mode[m];
    }
    return sums;
}
