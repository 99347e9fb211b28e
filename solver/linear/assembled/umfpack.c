/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The assembled form by SuiteSparse's UMFPACK, with its own scaling and refinement. */
#include <string.h>
#include <suitesparse/umfpack.h>

#include "solver/linear/assembled/assembled.h"

struct umfpack {
    int order;
    int *column, *row; /* both triangles, by columns: order + 1 numbers, and one a value */
    int *iwork;        /* workspace: 2 * order, of which the solve needs one */
    double *value;
    double *work; /* workspace for the solve: 5 * order */
    void *symbolic, *numeric;
    double control[UMFPACK_CONTROL], info[UMFPACK_INFO];
};

static enum br_status failed(struct br_error *err, const char *what, int status)
{
    if (status == UMFPACK_ERROR_out_of_memory)
        return br_no_memory(err, what);
    return br_fail(err, BR_SINGULAR, "umfpack: %s failed with status %d%s", what, status,
                   status == UMFPACK_WARNING_singular_matrix ? " (singular matrix)" : "");
}

static enum br_status read_options(struct umfpack *u, const struct br_linear_options *options,
                                   struct br_error *err)
{
    static const struct {
        const char *name;
        double value;
    } scalings[] = {
        {"none", UMFPACK_SCALE_NONE}, {"sum", UMFPACK_SCALE_SUM}, {"max", UMFPACK_SCALE_MAX}};
    umfpack_di_defaults(u->control);
    u->control[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
    u->control[UMFPACK_IRSTEP] = options->refinement;
    for (size_t i = 0; i < sizeof scalings / sizeof *scalings; i++)
        if (strcmp(scalings[i].name, options->scaling) == 0) {
            u->control[UMFPACK_SCALE] = scalings[i].value;
            return BR_OK;
        }
    return br_fail(err, BR_BAD_INPUT, "scaling is '%s', expected none, sum or max",
                   options->scaling);
}

static enum br_status umfpack_create(const struct br_band *a,
                                     const struct br_linear_options *options, void **factor,
                                     struct br_error *err)
{
    struct umfpack *u = br_allocate(1, sizeof *u);
    *factor = u;
    if (!u)
        return br_no_memory(err, "umfpack's factor");
    u->order = (int)a->order;
    const size_t most = a->order * (2 * a->band + 1);
    u->column = br_allocate(3 * a->order + 1 + most, sizeof *u->column);
    u->value = br_allocate(5 * a->order + most, sizeof *u->value);
    if (!u->column || !u->value)
        return br_no_memory(err, "umfpack's factor");
    u->iwork = u->column + a->order + 1;
    u->row = u->iwork + 2 * a->order;
    u->work = u->value + most;
    br_band_pattern(a, true, u->column, u->row);
    const enum br_status status = read_options(u, options, err);
    if (status)
        return status;
    const int result = umfpack_di_symbolic(u->order, u->order, u->column, u->row, NULL,
                                           &u->symbolic, u->control, u->info);
    return result == UMFPACK_OK ? BR_OK : failed(err, "the analysis", result);
}

static void umfpack_destroy(void *factor)
{
    struct umfpack *u = factor;
    if (!u)
        return;
    if (u->symbolic)
        umfpack_di_free_symbolic(&u->symbolic);
    if (u->numeric)
        umfpack_di_free_numeric(&u->numeric);
    free(u->column);
    free(u->value);
    free(u);
}

/* LU also factorises indefinite matrices. Where rows and columns were permuted alike, the diagonal
 * of U has the signs of the pivots of a symmetric elimination: all positive if and only if A is
 * positive definite (Sylvester's law of inertia). Else only the tip's compliance is checked, as for
 * all libraries. */
static enum br_status check_definite(struct umfpack *u, struct br_error *err)
{
    int *rows = u->iwork, *columns = u->iwork + u->order, scaled;
    double *pivot = u->work;
    const int result = umfpack_di_get_numeric(NULL, NULL, NULL, NULL, NULL, NULL, rows, columns,
                                              pivot, &scaled, NULL, u->numeric);
    if (result != UMFPACK_OK)
        return failed(err, "a look at the factors", result);
    if (memcmp(rows, columns, (size_t)u->order * sizeof *rows) != 0)
        return BR_OK;
    for (int i = 0; i < u->order; i++)
        if (!(pivot[i] > 0))
            return br_fail(err, BR_SINGULAR,
                           "umfpack: the matrix is not positive definite to round-off (pivot %d of "
                           "%d is %g)",
                           i + 1, u->order, pivot[i]);
    return BR_OK;
}

static enum br_status umfpack_factorise(void *factor, const struct br_band *a, struct br_error *err)
{
    struct umfpack *u = factor;
    br_band_values(a, true, u->value);
    if (u->numeric)
        umfpack_di_free_numeric(&u->numeric);
    const int result = umfpack_di_numeric(u->column, u->row, u->value, u->symbolic, &u->numeric,
                                          u->control, u->info);
    return result == UMFPACK_OK ? check_definite(u, err) : failed(err, "the factorisation", result);
}

static enum br_status umfpack_solve(void *factor, const double *rhs, double *x,
                                    struct br_error *err)
{
    struct umfpack *u = factor;
    const int result = umfpack_di_wsolve(UMFPACK_A, u->column, u->row, u->value, x, rhs, u->numeric,
                                         u->control, u->info, u->iwork, u->work);
    return result == UMFPACK_OK ? BR_OK : failed(err, "a solve", result);
}

static const struct br_factoriser umfpack = {
    .name = "umfpack",
    .refines = true,
    .create = umfpack_create,
    .free = umfpack_destroy,
    .factorise = umfpack_factorise,
    .solve = umfpack_solve,
};

const struct br_linear_solver br_umfpack = {
    .name = "umfpack",
    .title = "assembled stiffness form, factorised once by SuiteSparse's UMFPACK",
    .citation = "T. A. Davis, Algorithm 832: UMFPACK V4.3, ACM Trans. Math. Softw. 30 (2004)",
    .options = "--scaling, --refinement",
    .axial = &br_assembled,
    .bending = &br_assembled,
    .factoriser = &umfpack,
    .round_off = br_assembled_round_off,
    .residual = br_assembled_residual,
    .bytes = {410, 1110, 0},
    .state_bytes = {16, 32, 0},
    .cost = br_cost_by_elements,
    .step_cost = 170,
    .element_cost = {18.9, 36.2, 0},
};
