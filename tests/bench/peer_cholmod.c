/* SPDX-License-Identifier: GPL-3.0-or-later */
/* SuiteSparse's CHOLMOD, L L', in AMD's ordering: analysed and factorised once, cholmod_solve2 a
 * step, which keeps its workspaces. The natural ordering, which has no fill here either, is as
 * fast, but at n = 12800 it meets a pivot that is not positive. */
#include <stdlib.h>
#include <suitesparse/cholmod.h>

#include "tests/bench/peers.h"

struct cholmod {
    cholmod_common common;
    cholmod_factor *factor;
    cholmod_dense *solution, *y, *e;
    size_t order;
};

/* The lower band as a sparse matrix; entries that are zero are kept out. */
static cholmod_sparse *sparse_of(const struct peer_matrix *m, cholmod_common *common)
{
    cholmod_sparse *a = cholmod_allocate_sparse(m->order, m->order, m->order * (m->band + 1), 1, 1,
                                                -1, CHOLMOD_REAL, common);
    if (!a)
        return NULL;
    int *column = a->p, *row = a->i, count = 0;
    double *value = a->x;
    for (size_t j = 0; j < m->order; j++) {
        column[j] = count;
        for (size_t i = 0; i <= m->band && j + i < m->order; i++) {
            const double x = m->value[j * (m->band + 1) + i];
            if (i > 0 && x == 0)
                continue;
            row[count] = (int)(j + i);
            value[count++] = x;
        }
    }
    column[m->order] = count;
    return a;
}

static enum br_status create(const struct peer_matrix *m, int supernodal, void **factor,
                             struct br_error *err)
{
    struct cholmod *c = br_allocate(1, sizeof *c);
    *factor = c;
    if (!c)
        return br_no_memory(err, "a peer");
    c->order = m->order;
    cholmod_start(&c->common);
    c->common.supernodal = supernodal;
    c->common.final_ll = 1;
    c->common.nmethods = 1;
    c->common.method[0].ordering = CHOLMOD_AMD;
    c->common.print = 0;
    cholmod_sparse *a = sparse_of(m, &c->common);
    if (!a)
        return br_no_memory(err, "a peer");
    c->factor = cholmod_analyze(a, &c->common);
    cholmod_factorize(a, c->factor, &c->common);
    cholmod_free_sparse(&a, &c->common);
    return c->common.status == CHOLMOD_OK
               ? BR_OK
               : br_fail(err, BR_SINGULAR, "cholmod: %d", c->common.status);
}

static enum br_status create_simplicial(const struct peer_matrix *m, void **factor,
                                        struct br_error *err)
{
    return create(m, CHOLMOD_SIMPLICIAL, factor, err);
}

static enum br_status create_supernodal(const struct peer_matrix *m, void **factor,
                                        struct br_error *err)
{
    return create(m, CHOLMOD_SUPERNODAL, factor, err);
}

static void cholmod_peer_free(void *factor)
{
    struct cholmod *c = factor;
    cholmod_free_dense(&c->solution, &c->common);
    cholmod_free_dense(&c->y, &c->common);
    cholmod_free_dense(&c->e, &c->common);
    cholmod_free_factor(&c->factor, &c->common);
    cholmod_finish(&c->common);
    free(c);
}

static const double *cholmod_peer_solve(void *factor, double *rhs)
{
    struct cholmod *c = factor;
    cholmod_dense b = {.nrow = c->order,
                       .ncol = 1,
                       .nzmax = c->order,
                       .d = c->order,
                       .x = rhs,
                       .xtype = CHOLMOD_REAL,
                       .dtype = CHOLMOD_DOUBLE};
    return cholmod_solve2(CHOLMOD_A, c->factor, &b, NULL, &c->solution, NULL, &c->y, &c->e,
                          &c->common)
               ? c->solution->x
               : NULL;
}

static const struct peer_library simplicial = {create_simplicial, cholmod_peer_free,
                                               cholmod_peer_solve};
static const struct peer_library supernodal = {create_supernodal, cholmod_peer_free,
                                               cholmod_peer_solve};

PEER(peer_cholmod_simplicial, "CHOLMOD simplicial", simplicial)
PEER(peer_cholmod_supernodal, "CHOLMOD supernodal", supernodal)
