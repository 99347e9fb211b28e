/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The assembled form by LAPACK's banded Cholesky: dpbtrf once, dpbtrs a step.
 *
 * The unknowns are numbered from the tip to the clamp. In the other order, elimination from the
 * clamp leaves pivots as soft as a cantilever, n^-3 of an element's stiffness, as differences of
 * numbers as large as that stiffness: w(L) loses a hundred times more at n = 12800, and pivots
 * become negative. After elimination of the free end only its mass resists, and every pivot is
 * about as large as an element's stiffness. */
#include <lapacke.h>

#include "solver/linear/assembled/assembled.h"

struct banded {
    lapack_int order, band;
    double *value; /* A's upper band in that order, then U of A = U'U */
    double *work;  /* workspace for the solve: order */
    struct br_store store;
};

static enum br_status banded_create(const struct br_band *a,
                                    const struct br_linear_options *options, void **factor,
                                    struct br_error *err)
{
    (void)options;
    struct banded *b = br_allocate(1, sizeof *b);
    *factor = b;
    if (!b)
        return br_no_memory(err, "the banded factor");
    b->order = (lapack_int)a->order;
    b->band = (lapack_int)a->band;
    b->value = br_store_take(&b->store, a->order * (a->band + 1), sizeof *b->value);
    b->work = br_store_take(&b->store, a->order, sizeof *b->work);
    return b->store.failed ? br_no_memory(err, "the banded factor") : BR_OK;
}

static void banded_free(void *factor)
{
    struct banded *b = factor;
    if (b)
        br_store_clear(&b->store);
    free(b);
}

/* A lower band by columns, read backwards, is the upper band for the reversed numbering. */
static void reverse(const double *from, double *to, size_t count)
{
    for (size_t i = 0; i < count; i++)
        to[i] = from[count - 1 - i];
}

static enum br_status banded_factorise(void *factor, const struct br_band *a, struct br_error *err)
{
    struct banded *b = factor;
    reverse(a->value, b->value, a->order * (a->band + 1));
    const lapack_int info =
        LAPACKE_dpbtrf_work(LAPACK_COL_MAJOR, 'U', b->order, b->band, b->value, b->band + 1);
    if (info == 0)
        return BR_OK;
    return br_fail(err, BR_SINGULAR,
                   "banded: the matrix is not positive definite to round-off (dpbtrf stopped at "
                   "unknown %d of %d from the tip)",
                   (int)info, (int)b->order);
}

static enum br_status banded_solve(void *factor, const double *rhs, double *x, struct br_error *err)
{
    const struct banded *b = factor;
    reverse(rhs, b->work, (size_t)b->order);
    const lapack_int info = LAPACKE_dpbtrs_work(LAPACK_COL_MAJOR, 'U', b->order, b->band, 1,
                                                b->value, b->band + 1, b->work, b->order);
    if (info != 0)
        return br_fail(err, BR_SINGULAR, "banded: dpbtrs failed with %d", (int)info);
    reverse(b->work, x, (size_t)b->order);
    return BR_OK;
}

static const struct br_factoriser banded = {
    .name = "banded",
    .create = banded_create,
    .free = banded_free,
    .factorise = banded_factorise,
    .solve = banded_solve,
};

const struct br_linear_solver br_banded = {
    .name = "banded",
    .title = "assembled stiffness form, factorised once by LAPACK's banded Cholesky",
    .citation = "E. Anderson et al., LAPACK Users' Guide, 3rd ed., SIAM (1999)",
    .options = "--refinement",
    .axial = &br_assembled,
    .bending = &br_assembled,
    .factoriser = &banded,
    .round_off = br_assembled_round_off,
    .residual = br_assembled_residual,
    .bytes = {135, 310, 0},
    .state_bytes = {16, 32, 0},
    .cost = br_cost_by_elements,
    .step_cost = 170,
    .element_cost = {22.1, 39, 0},
};
