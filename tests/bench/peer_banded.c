/* SPDX-License-Identifier: GPL-3.0-or-later */
/* LAPACK's banded Cholesky: dpbtrf once, dpbtrs a step. */
#include <lapacke.h>
#include <stdlib.h>

#include "tests/bench/peers.h"

static enum br_status banded_create(const struct peer_matrix *m, void **factor,
                                    struct br_error *err)
{
    struct peer_matrix *f = br_allocate(1, sizeof *f);
    *factor = f;
    if (!f)
        return br_no_memory(err, "a peer");
    *f = *m;
    const lapack_int order = (lapack_int)m->order, band = (lapack_int)m->band;
    const lapack_int info =
        LAPACKE_dpbtrf_work(LAPACK_COL_MAJOR, 'L', order, band, m->value, band + 1);
    return info ? br_fail(err, BR_SINGULAR, "dpbtrf: %d", (int)info) : BR_OK;
}

static const double *banded_solve(void *factor, double *rhs)
{
    const struct peer_matrix *f = factor;
    const lapack_int order = (lapack_int)f->order, band = (lapack_int)f->band;
    return LAPACKE_dpbtrs_work(LAPACK_COL_MAJOR, 'L', order, band, 1, f->value, band + 1, rhs,
                               order) == 0
               ? rhs
               : NULL;
}

static const struct peer_library banded = {banded_create, free, banded_solve};

PEER(peer_banded, "LAPACK dpbtrs", banded)
