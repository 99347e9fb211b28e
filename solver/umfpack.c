/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The usual way: the assembled stiffness form of (27) and (28),
 *     (M/k + C + kK) v_n = F_n + M v_{n-1}/k - K w_{n-1},
 * factorised once by SuiteSparse's UMFPACK and solved once a step. The matrix is
 * assembled; the right side is formed element by element, from nodal
 * differences, which loses less than the product with an assembled K would.
 * Its condition number grows like h^-4 for bending: see round_off below. */
#include <float.h>
#include <math.h>
#include <string.h>
#include <suitesparse/umfpack.h>

#include "solver/linear_solver.h"

struct stiffness_form {
    struct br_field field;
    size_t unknowns; /* a node */
    int order;       /* unknowns * n: the clamped node is left out */
    int *column;     /* the matrix, by columns */
    int *row;
    double *value;
    void *symbolic, *numeric;
    double control[UMFPACK_CONTROL], info[UMFPACK_INFO];
    double *displacement, *velocity; /* nodal, clamped node included */
    double *free_velocity;           /* v* */
    double *tip_response;            /* z = A^-1 e_tip, nodal */
    double *rhs;                     /* workspace, nodal */
    int *iwork;                      /* workspace for the solve: order */
    double *work;                    /* workspace for the solve: 5 * order */
};

enum { MOST = 4 }; /* unknowns of an element */

/* rho h times the element's consistent mass. */
static double mass_entry(const struct br_field *f, size_t a, size_t b)
{
    return f->density * f->h * (f->kind == BR_AXIAL ? br_axial_mass[a][b] : br_bending_mass[a][b]);
}

/* Element stiffness for unit material: B'B / h, or B' diag(1, 1/3) B / h^3. */
static double stiffness_entry(const struct br_field *f, size_t a, size_t b)
{
    if (f->kind == BR_AXIAL)
        return (a == b ? 1 : -1) / f->h;
    static const double first[MOST] = {0, -1, 0, 1}, second[MOST] = {6, 3, -6, 3};
    return (first[a] * first[b] + second[a] * second[b] / 3) / (f->h * f->h * f->h);
}

/* Triplets of the element matrices of M/k + C + kK without the clamped node. */
static int fill_triplets(const struct stiffness_form *s, int *row, int *column, double *value)
{
    const struct br_field *f = &s->field;
    const double stiff = f->viscosity + f->k * f->stiffness;
    int count = 0;
    for (size_t i = 0; i < f->n; i++)
        for (size_t a = 0; a < 2 * s->unknowns; a++)
            for (size_t b = 0; b < 2 * s->unknowns; b++) {
                const size_t p = i * s->unknowns + a, q = i * s->unknowns + b;
                if (p < s->unknowns || q < s->unknowns)
                    continue;
                row[count] = (int)(p - s->unknowns);
                column[count] = (int)(q - s->unknowns);
                value[count++] = mass_entry(f, a, b) / f->k + stiff * stiffness_entry(f, a, b);
            }
    return count;
}

static enum br_status failed(struct br_error *err, const char *what, int status)
{
    if (status == UMFPACK_ERROR_out_of_memory)
        return br_no_memory(err, what);
    return br_fail(err, BR_SINGULAR, "umfpack: %s failed with status %d%s", what, status,
                   status == UMFPACK_WARNING_singular_matrix ? " (singular matrix)" : "");
}

static enum br_status assemble(struct stiffness_form *s, struct br_error *err)
{
    const size_t most = s->field.n * 4 * s->unknowns * s->unknowns;
    int *row = br_allocate(2 * most, sizeof *row);
    double *value = br_allocate(most, sizeof *value);
    enum br_status status = BR_OK;
    if (!row || !value) {
        status = br_no_memory(err, "the matrix");
        goto done;
    }
    const int count = fill_triplets(s, row, row + most, value);
    const int result = umfpack_di_triplet_to_col(s->order, s->order, count, row, row + most, value,
                                                 s->column, s->row, s->value, NULL);
    if (result != UMFPACK_OK)
        status = failed(err, "the assembly", result);
done:
    free(row);
    free(value);
    return status;
}

static enum br_status factorise(struct stiffness_form *s, struct br_error *err)
{
    int result = umfpack_di_symbolic(s->order, s->order, s->column, s->row, s->value, &s->symbolic,
                                     s->control, s->info);
    if (result == UMFPACK_OK)
        result = umfpack_di_numeric(s->column, s->row, s->value, s->symbolic, &s->numeric,
                                    s->control, s->info);
    return result == UMFPACK_OK ? BR_OK : failed(err, "the factorisation", result);
}

/* x = A^-1 rhs; both nodal, and the clamped node of x stays zero. */
static enum br_status solve(struct stiffness_form *s, const double *rhs, double *x,
                            struct br_error *err)
{
    const int result =
        umfpack_di_wsolve(UMFPACK_A, s->column, s->row, s->value, x + s->unknowns,
                          rhs + s->unknowns, s->numeric, s->control, s->info, s->iwork, s->work);
    return result == UMFPACK_OK ? BR_OK : failed(err, "a solve", result);
}

static enum br_status read_options(struct stiffness_form *s,
                                   const struct br_linear_options *options, struct br_error *err)
{
    static const struct {
        const char *name;
        double value;
    } scalings[] = {
        {"none", UMFPACK_SCALE_NONE}, {"sum", UMFPACK_SCALE_SUM}, {"max", UMFPACK_SCALE_MAX}};
    umfpack_di_defaults(s->control);
    s->control[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
    s->control[UMFPACK_IRSTEP] = options->refinement;
    for (size_t i = 0; i < sizeof scalings / sizeof *scalings; i++)
        if (strcmp(scalings[i].name, options->scaling) == 0) {
            s->control[UMFPACK_SCALE] = scalings[i].value;
            return BR_OK;
        }
    return br_fail(err, BR_BAD_INPUT, "scaling is '%s', expected none, sum or max",
                   options->scaling);
}

static void stiffness_free(void *self)
{
    struct stiffness_form *s = self;
    if (!s)
        return;
    if (s->symbolic)
        umfpack_di_free_symbolic(&s->symbolic);
    if (s->numeric)
        umfpack_di_free_numeric(&s->numeric);
    free(s->column);
    free(s->row);
    free(s->value);
    free(s->displacement);
    free(s->iwork);
    free(s);
}

static enum br_status allocate(struct stiffness_form *s, struct br_error *err)
{
    const size_t nodal = br_field_size(&s->field), order = (size_t)s->order;
    s->column = br_allocate(order + 1, sizeof *s->column);
    s->row = br_allocate(s->field.n * 4 * s->unknowns * s->unknowns, sizeof *s->row);
    s->value = br_allocate(s->field.n * 4 * s->unknowns * s->unknowns, sizeof *s->value);
    s->iwork = br_allocate(order, sizeof *s->iwork);
    s->displacement = br_allocate(5 * nodal + 5 * order, sizeof *s->displacement);
    if (!s->column || !s->row || !s->value || !s->iwork || !s->displacement)
        return br_no_memory(err, "the stiffness form");
    s->velocity = s->displacement + nodal;
    s->free_velocity = s->velocity + nodal;
    s->tip_response = s->free_velocity + nodal;
    s->rhs = s->tip_response + nodal;
    s->work = s->rhs + nodal;
    return BR_OK;
}

/* Index of the tip's displacement in a nodal array. */
static size_t tip_index(const struct stiffness_form *s)
{
    return s->field.n * s->unknowns;
}

static enum br_status stiffness_create(const struct br_field *field,
                                       const struct br_linear_options *options, void **self,
                                       struct br_error *err)
{
    struct stiffness_form *s = br_allocate(1, sizeof *s);
    *self = s;
    if (!s)
        return br_no_memory(err, "the stiffness form");
    s->field = *field;
    s->unknowns = br_field_unknowns(field);
    if (field->n > 100 * 1000 * 1000)
        return br_fail(err, BR_BAD_INPUT, "umfpack: n is %zu, expected at most 1e8", field->n);
    s->order = (int)(s->unknowns * field->n);
    enum br_status status = allocate(s, err);
    if (!status)
        status = read_options(s, options, err);
    if (!status)
        status = assemble(s, err);
    if (!status)
        status = factorise(s, err);
    if (!status) {
        s->rhs[tip_index(s)] = 1;
        status = solve(s, s->rhs, s->tip_response, err);
    }
    if (!status && !(s->tip_response[tip_index(s)] > 0))
        status = br_fail(err, BR_SINGULAR, "umfpack: the tip's compliance is %g, expected > 0",
                         s->tip_response[tip_index(s)]);
    return status;
}

static double stiffness_compliance(const void *self)
{
    const struct stiffness_form *s = self;
    return s->tip_response[tip_index(s)];
}

static void stiffness_set(void *self, const double *displacement, const double *velocity)
{
    struct stiffness_form *s = self;
    const size_t bytes = br_field_size(&s->field) * sizeof *displacement;
    memcpy(s->displacement, displacement, bytes);
    memcpy(s->velocity, velocity, bytes);
}

static void stiffness_get(const void *self, double *displacement, double *velocity)
{
    const struct stiffness_form *s = self;
    const size_t bytes = br_field_size(&s->field) * sizeof *displacement;
    if (displacement)
        memcpy(displacement, s->displacement, bytes);
    if (velocity)
        memcpy(velocity, s->velocity, bytes);
}

static void stiffness_strain_rate(const void *self, double *rate)
{
    const struct stiffness_form *s = self;
    for (size_t i = 0; i < s->field.n; i++)
        if (s->field.kind == BR_AXIAL)
            rate[i] = s->velocity[i + 1] - s->velocity[i];
        else
            br_curvature(s->velocity + 2 * i, rate + 2 * i);
}

/* out -= K u on one element, u in its nodal values, from what deforms it. */
static void subtract_elastic(const struct br_field *f, const double *u, double *out)
{
    if (f->kind == BR_AXIAL) {
        const double force = f->stiffness / f->h * (u[1] - u[0]);
        out[0] += force;
        out[1] -= force;
        return;
    }
    double curvature[2];
    br_curvature(u, curvature);
    const double rigidity = f->stiffness / (f->h * f->h * f->h);
    const double m0 = rigidity * curvature[0], m1 = rigidity / 3 * curvature[1];
    out[0] -= 6 * m1;
    out[1] -= 3 * m1 - m0;
    out[2] += 6 * m1;
    out[3] -= 3 * m1 + m0;
}

/* rhs = factor F + tip + M v/k - K w */
static void form_rhs(struct stiffness_form *s, const struct br_drive *drive)
{
    const struct br_field *f = &s->field;
    for (size_t i = 0; i < br_field_size(f); i++)
        s->rhs[i] = drive->vector ? drive->factor * drive->vector[i] : 0;
    for (size_t c = 0; c < s->unknowns; c++)
        s->rhs[tip_index(s) + c] += drive->tip[c];
    for (size_t i = 0; i < f->n; i++) {
        const size_t first = i * s->unknowns;
        for (size_t a = 0; a < 2 * s->unknowns; a++) {
            double momentum = 0;
            for (size_t b = 0; b < 2 * s->unknowns; b++)
                momentum += mass_entry(f, a, b) * s->velocity[first + b];
            s->rhs[first + a] += momentum / f->k;
        }
        subtract_elastic(f, s->displacement + first, s->rhs + first);
    }
}

static enum br_status stiffness_predict(void *self, const struct br_drive *drive, double *velocity,
                                        struct br_error *err)
{
    struct stiffness_form *s = self;
    form_rhs(s, drive);
    const enum br_status status = solve(s, s->rhs, s->free_velocity, err);
    *velocity = s->free_velocity[tip_index(s)];
    return status;
}

/* v = v* - r z,  w += k v */
static double stiffness_finish(void *self, double force)
{
    struct stiffness_form *s = self;
    for (size_t i = 0; i < br_field_size(&s->field); i++) {
        s->velocity[i] = s->free_velocity[i] - force * s->tip_response[i];
        s->displacement[i] += s->field.k * s->velocity[i];
    }
    return s->velocity[tip_index(s)];
}

static double stiffness_tip_displacement(const void *self)
{
    const struct stiffness_form *s = self;
    return s->displacement[tip_index(s)];
}

/* An upper estimate of what was measured for n = 100 to 12800 and k = 1e-2 to 1e-4: about
 * n^3, below the bound n^4 of the condition number. Refinement repairs residuals, not
 * errors: with it, up to 100 times more was seen. */
static double stiffness_round_off(const struct br_field *f, const struct br_linear_options *options)
{
    const double n = (double)f->n;
    if (f->kind == BR_AXIAL)
        return DBL_EPSILON * (10 * n + n * n / 100) * (options->refinement > 0 ? 20 : 1);
    return DBL_EPSILON * n * n * n * (options->refinement > 0 ? 1600 : 16);
}

static const struct br_field_solver stiffness_form = {
    .create = stiffness_create,
    .free = stiffness_free,
    .tip_compliance = stiffness_compliance,
    .set = stiffness_set,
    .get = stiffness_get,
    .strain_rate = stiffness_strain_rate,
    .predict = stiffness_predict,
    .finish = stiffness_finish,
    .tip_displacement = stiffness_tip_displacement,
};

const struct br_linear_solver br_umfpack = {
    .name = "umfpack",
    .title = "assembled stiffness form, factorised once by SuiteSparse's UMFPACK",
    .citation = "T. A. Davis, Algorithm 832: UMFPACK V4.3, ACM Trans. Math. Softw. 30 (2004)",
    .options = "--scaling, --refinement",
    .axial = &stiffness_form,
    .bending = &stiffness_form,
    .round_off = stiffness_round_off,
};
