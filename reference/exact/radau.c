/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/radau.h"

#include <gsl/gsl_integration.h>
#include <lapacke.h>
#include <string.h>

#include "reference/exact/legendre.h"

enum { S = BR_STAGES };

/* The interior nodes are those of Gauss-Jacobi quadrature with weight 1 - x. */
static enum br_status find_nodes(double node[S], struct br_error *err)
{
    gsl_integration_fixed_workspace *gauss =
        gsl_integration_fixed_alloc(gsl_integration_fixed_jacobi, S - 1, 0, 1, 1, 0);
    if (!gauss)
        return br_no_memory(err, "the Radau nodes");
    memcpy(node, gsl_integration_fixed_nodes(gauss), (S - 1) * sizeof *node);
    node[S - 1] = 1;
    gsl_integration_fixed_free(gauss);
    return BR_OK;
}

/* The inverse of the matrix of p_k(c_j). Radau's weights would give it in closed
 * form, but are ten times more sensitive to the nodes' rounding. */
static enum br_status invert(struct br_radau *r, struct br_error *err)
{
    double value[S][S];
    lapack_int pivot[S];
    for (size_t j = 0; j < S; j++) {
        br_legendre(S, r->node[j], value[j]);
        r->to_coefficients[j][j] = 1;
    }
    const lapack_int info =
        LAPACKE_dgesv(LAPACK_ROW_MAJOR, S, S, &value[0][0], S, pivot, &r->to_coefficients[0][0], S);
    return info ? br_no_memory(err, "the Radau nodes") : BR_OK;
}

enum br_status br_radau_init(struct br_radau *r, struct br_error *err)
{
    *r = (struct br_radau){0};
    br_legendre(S, 1, r->end);
    r->integral[0][0] = 0.5;
    for (size_t k = 1; k < S; k++) {
        r->integral[k][k - 1] = br_legendre_coupling(k);
        r->integral[k - 1][k] = -br_legendre_coupling(k);
    }
    r->integral[S - 1][S - 1] = 1.0 / (4 * S - 2); /* p_S seen at the nodes is a p_{S-1} */
    const enum br_status status = find_nodes(r->node, err);
    return status ? status : invert(r, err);
}

void br_radau_fit(const struct br_radau *r, const double value[S], double out[S])
{
    for (size_t k = 0; k < S; k++)
        out[k] = br_radau_sum(r->to_coefficients[k], value);
}
