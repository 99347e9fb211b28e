/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The assembled form by SuiteSparse's CHOLMOD: L L', analysed once, factorised for each length of
 * the steps, solved once a step by cholmod_solve2, which keeps its workspaces. Simplicial: a band
 * of 3 has no blocks that would repay supernodes (as fast, and no more exact). AMD's ordering
 * begins at the tip; banded.c explains why the other order is worse. */
#include <string.h>
#include <suitesparse/cholmod.h>

#include "solver/linear/assembled/assembled.h"

struct cholmod {
    cholmod_common common;
    cholmod_sparse *matrix;
    cholmod_factor *factor;
    cholmod_dense *solution, *y, *e;
};

static enum br_status failed(const struct cholmod *c, struct br_error *err)
{
    if (c->common.status == CHOLMOD_OUT_OF_MEMORY)
        return br_no_memory(err, "cholmod's factor");
    if (c->common.status == CHOLMOD_NOT_POSDEF)
        return br_fail(err, BR_SINGULAR,
                       "cholmod: the matrix is not positive definite to round-off (stopped in "
                       "column %zu of %zu)",
                       c->factor->minor + 1, c->factor->n);
    return br_fail(err, BR_SINGULAR, "cholmod: status %d", c->common.status);
}

static enum br_status cholmod_create(const struct br_band *a,
                                     const struct br_linear_options *options, void **factor,
                                     struct br_error *err)
{
    (void)options;
    struct cholmod *c = br_allocate(1, sizeof *c);
    *factor = c;
    if (!c)
        return br_no_memory(err, "cholmod's factor");
    cholmod_start(&c->common);
    c->common.print = 0;
    c->common.supernodal = CHOLMOD_SIMPLICIAL;
    c->common.final_ll = 1;
    c->common.nmethods = 1;
    c->common.method[0].ordering = CHOLMOD_AMD;
    c->matrix = cholmod_allocate_sparse(a->order, a->order, a->order * (a->band + 1), 1, 1, -1,
                                        CHOLMOD_REAL, &c->common);
    if (!c->matrix)
        return failed(c, err);
    br_band_pattern(a, false, c->matrix->p, c->matrix->i);
    c->factor = cholmod_analyze(c->matrix, &c->common);
    return c->factor ? BR_OK : failed(c, err);
}

static void cholmod_destroy(void *factor)
{
    struct cholmod *c = factor;
    if (!c)
        return;
    cholmod_free_dense(&c->solution, &c->common);
    cholmod_free_dense(&c->y, &c->common);
    cholmod_free_dense(&c->e, &c->common);
    cholmod_free_factor(&c->factor, &c->common);
    cholmod_free_sparse(&c->matrix, &c->common);
    cholmod_finish(&c->common);
    free(c);
}

static enum br_status cholmod_refactorise(void *factor, const struct br_band *a,
                                          struct br_error *err)
{
    struct cholmod *c = factor;
    br_band_values(a, false, c->matrix->x);
    const int done = cholmod_factorize(c->matrix, c->factor, &c->common);
    return done && c->common.status == CHOLMOD_OK ? BR_OK : failed(c, err);
}

static enum br_status cholmod_solve_it(void *factor, const double *rhs, double *x,
                                       struct br_error *err)
{
    struct cholmod *c = factor;
    cholmod_dense b = {.nrow = c->factor->n,
                       .ncol = 1,
                       .nzmax = c->factor->n,
                       .d = c->factor->n,
                       .x = x,
                       .xtype = CHOLMOD_REAL,
                       .dtype = CHOLMOD_DOUBLE};
    memcpy(x, rhs, c->factor->n * sizeof *x); /* avoids a cast: b is not const */
    if (!cholmod_solve2(CHOLMOD_A, c->factor, &b, NULL, &c->solution, NULL, &c->y, &c->e,
                        &c->common))
        return failed(c, err);
    memcpy(x, c->solution->x, c->factor->n * sizeof *x);
    return BR_OK;
}

static const struct br_factoriser cholmod = {
    .name = "cholmod",
    .create = cholmod_create,
    .free = cholmod_destroy,
    .factorise = cholmod_refactorise,
    .solve = cholmod_solve_it,
};

const struct br_linear_solver br_cholmod = {
    .name = "cholmod",
    .title = "assembled stiffness form, factorised once by SuiteSparse's CHOLMOD",
    .citation = "Y. Chen, T. A. Davis, W. W. Hager, S. Rajamanickam, Algorithm 887: CHOLMOD, ACM "
                "Trans. Math. Softw. 35 (2008)",
    .options = "--refinement",
    .axial = &br_assembled,
    .bending = &br_assembled,
    .factoriser = &cholmod,
    .round_off = br_assembled_round_off,
    .residual = br_assembled_residual,
    .bytes = {260, 650, 0},
    .state_bytes = {16, 32, 0},
    .cost = br_cost_by_elements,
    .step_cost = 170,
    .element_cost = {23.6, 44.8, 0},
};
