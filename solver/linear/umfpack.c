/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The usual way: the assembled stiffness form of (27) and (28),
 *     A v_n = F_n + M v_{n-1}/k - K w_{n-1},    A = M/k + C + kK,
 * factorised once by SuiteSparse's UMFPACK and solved once a step, without scaling of rows and
 * without its refinement, which repairs residuals, not errors.
 * A's condition number grows like h^-4 for bending: see usual_loss. */
#include <float.h>
#include <math.h>
#include <string.h>
#include <suitesparse/umfpack.h>

#include "base/blas.h"
#include "solver/arithmetic.h"
#include "solver/linear/linear_solver.h"
#include "solver/linear/states.h"
#include "solver/modes.h"

/* ---- the elements ---- */

enum { MOST = 4 }; /* unknowns of an element */

/* Element stiffness for unit material: B'B / h, or B' diag(1, 1/3) B / h^3. */
static double stiffness_entry(const struct br_field *f, size_t a, size_t b)
{
    if (f->kind == BR_AXIAL)
        return (a == b ? 1 : -1) / f->h;
    static const double first[MOST] = {0, -1, 0, 1}, second[MOST] = {6, 3, -6, 3};
    return (first[a] * first[b] + second[a] * second[b] / 3) / (f->h * f->h * f->h);
}

/* Entry of the element's M/k + C + kK. */
static double entry(const struct br_field *f, size_t a, size_t b)
{
    const double mass = f->kind == BR_AXIAL ? br_axial_mass[a][b] : br_bending_mass[a][b];
    const double stiff = f->viscosity + f->k * f->stiffness;
    return f->density * f->h * mass / f->k + stiff * stiffness_entry(f, a, b);
}

/* `carried`: what an element adds to its right node. */
static void add_axial(const struct br_field *f, double mass, const double *v, double stiffness,
                      const double *w, double *out)
{
    const double stiff = stiffness / f->h;
    double carried = 0;
    for (size_t i = 0; i < f->n; i++) {
        const double force = stiff * (w[i + 1] - w[i]);
        out[i] += carried + mass * (v[i] / 3 + v[i + 1] / 6) + force;
        carried = mass * (v[i] / 6 + v[i + 1] / 3) - force;
    }
    out[f->n] += carried;
}

static void add_bending(const struct br_field *f, double mass, const double *v, double stiffness,
                        const double *w, double *out)
{
    const double rigidity = stiffness / (f->h * f->h * f->h);
    double carried[2] = {0, 0};
    for (size_t i = 0; i < f->n; i++) {
        const double *x = v + 2 * i;
        double kappa[2], momentum[MOST];
        br_curvature(w + 2 * i, kappa);
        const double m0 = rigidity * kappa[0], m1 = rigidity / 3 * kappa[1];
        for (int a = 0; a < MOST; a++)
            momentum[a] = mass * (br_bending_mass[a][0] * x[0] + br_bending_mass[a][1] * x[1] +
                                  br_bending_mass[a][2] * x[2] + br_bending_mass[a][3] * x[3]);
        out[2 * i] += carried[0] + momentum[0] - 6 * m1;
        out[2 * i + 1] += carried[1] + momentum[1] - (3 * m1 - m0);
        carried[0] = momentum[2] + 6 * m1;
        carried[1] = momentum[3] - (3 * m1 + m0);
    }
    out[2 * f->n] += carried[0];
    out[2 * f->n + 1] += carried[1];
}

/* out += mass (consistent mass over h) v - stiffness (K of unit material) w, clamped node included.
 * Nodal arrays as in field.h: v, w in; out in/out. mass: kg or kg/s; stiffness: N, N m^2, or times
 * s. K w is formed from each element's strain, which loses less than an assembled K. */
static void add_elements(const struct br_field *f, double mass, const double *v, double stiffness,
                         const double *w, double *out)
{
    if (f->kind == BR_AXIAL)
        add_axial(f, mass * f->h, v, stiffness, w, out);
    else
        add_bending(f, mass * f->h, v, stiffness, w, out);
}

/* ---- the system A x = b ---- */

struct assembled {
    struct br_states states; /* nodal: displacement, then velocity */
    struct br_field field;
    size_t unknowns;   /* a node */
    size_t nodal;      /* length of a nodal array, clamped node included */
    size_t tip;        /* index of the tip's displacement in one */
    size_t order;      /* of A, which is without the clamped node */
    size_t band;       /* of A, on each side of the diagonal: 1 axial, 3 bending */
    int *column, *row; /* of A, by compressed columns: order + 1 numbers, and one a value */
    int *iwork;        /* workspace: 2 * order, of which the solve needs one */
    double *value;     /* of A, by columns */
    double *work;      /* workspace for the solve: 5 * order */
    void *symbolic, *numeric;
    double control[UMFPACK_CONTROL], info[UMFPACK_INFO];
    double *free_velocity;               /* v* */
    double *tip_response;                /* z = A^-1 e_tip, nodal */
    double *rhs, *residual, *correction; /* workspace, nodal */
    double loss;  /* relative loss of a solve (check_digits): the largest for all step lengths */
    double usual; /* loss of a march by usual_loss */
};

/* The first row of a column of A's band, with its zeros. */
static size_t first_row(const struct assembled *s, size_t column)
{
    return column > s->band ? column - s->band : 0;
}

/* The pattern of A's whole band, which is the same for all values. */
static void write_pattern(struct assembled *s)
{
    int count = 0;
    for (size_t j = 0; j < s->order; j++) {
        s->column[j] = count;
        for (size_t i = first_row(s, j); i <= j + s->band && i < s->order; i++)
            s->row[count++] = (int)i;
    }
    s->column[s->order] = count;
}

static void write_values(struct assembled *s)
{
    const struct br_field *f = &s->field;
    const size_t u = s->unknowns;
    memset(s->value, 0, (size_t)s->column[s->order] * sizeof *s->value);
    for (size_t e = 0; e < f->n; e++)
        for (size_t b = 0; b < 2 * u; b++)
            for (size_t a = 0; a < 2 * u; a++) {
                if (e == 0 && (a < u || b < u))
                    continue; /* clamped */
                const size_t i = e * u + a - u, j = e * u + b - u;
                s->value[(size_t)s->column[j] + i - first_row(s, j)] += entry(f, a, b);
            }
}

static enum br_status failed(struct br_error *err, const char *what, int status)
{
    if (status == UMFPACK_ERROR_out_of_memory)
        return br_no_memory(err, what);
    return br_fail(err, BR_SINGULAR, "umfpack: %s failed with status %d%s", what, status,
                   status == UMFPACK_WARNING_singular_matrix ? " (singular matrix)" : "");
}

/* LU also factorises indefinite matrices. Where rows and columns were permuted alike, the diagonal
 * of U has the signs of the pivots of a symmetric elimination: all positive if and only if A is
 * positive definite (Sylvester's law of inertia). Else only the tip's compliance is checked. */
static enum br_status check_definite(struct assembled *s, struct br_error *err)
{
    const int order = (int)s->order;
    int *rows = s->iwork, *columns = s->iwork + order, scaled;
    double *pivot = s->work;
    const int result = umfpack_di_get_numeric(NULL, NULL, NULL, NULL, NULL, NULL, rows, columns,
                                              pivot, &scaled, NULL, s->numeric);
    if (result != UMFPACK_OK)
        return failed(err, "a look at the factors", result);
    if (memcmp(rows, columns, (size_t)order * sizeof *rows) != 0)
        return BR_OK;
    for (int i = 0; i < order; i++)
        if (!(pivot[i] > 0))
            return br_fail(err, BR_SINGULAR,
                           "umfpack: the matrix is not positive definite to round-off (pivot %d of "
                           "%d is %g)",
                           i + 1, order, pivot[i]);
    return BR_OK;
}

static enum br_status factorise_values(struct assembled *s, struct br_error *err)
{
    if (s->numeric)
        umfpack_di_free_numeric(&s->numeric);
    br_blas_enter();
    const int result = umfpack_di_numeric(s->column, s->row, s->value, s->symbolic, &s->numeric,
                                          s->control, s->info);
    br_blas_leave();
    return result == UMFPACK_OK ? check_definite(s, err) : failed(err, "the factorisation", result);
}

/* Assembles and factorises A for s->field. */
static enum br_status factorise_matrix(struct assembled *s, struct br_error *err)
{
    write_values(s);
    for (int i = 0; i < s->column[s->order]; i++)
        if (!isfinite(s->value[i]))
            return br_fail(err, BR_SINGULAR,
                           "umfpack: the matrix has an entry %g, expected numbers", s->value[i]);
    const int traps = br_traps_lift(); /* UMFPACK may divide by a pivot of 0 */
    const enum br_status status = factorise_values(s, err);
    br_traps_restore(traps);
    return status;
}

/* The largest magnitude; NaN if one value is NaN. */
static double largest(const double *x, size_t count)
{
    double most = 0;
    for (size_t i = 0; i < count; i++)
        most = isnan(most) || fabs(x[i]) <= most ? most : fabs(x[i]);
    return most;
}

/* x = A^-1 rhs; nodal (out), and the clamped node of x stays as it is, zero. The march reports what
 * is not finite. */
static enum br_status solve(struct assembled *s, const double *rhs, double *x, struct br_error *err)
{
    const int result =
        umfpack_di_wsolve(UMFPACK_A, s->column, s->row, s->value, x + s->unknowns,
                          rhs + s->unknowns, s->numeric, s->control, s->info, s->iwork, s->work);
    return result == UMFPACK_OK ? BR_OK : failed(err, "a solve", result);
}

/* correction = A^-1 (rhs - A x). The residual is formed from the elements' strains, so that it is
 * as exact as one in higher precision (N. J. Higham, Accuracy and Stability of Numerical
 * Algorithms, 2nd ed., SIAM 2002, section 12.1). */
static enum br_status correct(struct assembled *s, const double *x, struct br_error *err)
{
    const struct br_field *f = &s->field;
    memcpy(s->residual, s->rhs, s->nodal * sizeof *s->rhs);
    add_elements(f, -f->density / f->k, x, f->viscosity + f->k * f->stiffness, x, s->residual);
    return solve(s, s->residual, s->correction, err);
}

/* Before a march: an upper estimate of the losses that were measured for n = 100 to 100,000 and k =
 * 1e-2 to 1e-6 in the paper's examples and a vibration of little damping
 * (study/extremes/extremes.h), relative to the largest displacement. For bending first like the
 * condition number, n^4, and from n = 1100 like n^3. A march measures its own loss. */
static double usual_loss(const struct br_field *f)
{
    const double n = (double)f->n;
    const double loss =
        f->kind == BR_AXIAL
            ? DBL_EPSILON * (100 * n + n * n / 2)
            : DBL_EPSILON * fmax(fmax(16, fmin(n / 4, 25)), fmin(n * n / 400, 3000)) * n * n * n;
    return fmin(loss, 1);
}

/* Elimination is backward stable: each row is solved for a nodal force that is off by a few last
 * bits of its terms, 24 C/h^3 |v| for bending and 2 C/h |v| for the rod (Higham, chapter 10). Such
 * forces are random, and a moment or normal force is off by their sum, with their levers: relative
 * to moments C |v|/L^2 by 0.5 times 2^-52 n^3.5, to normal forces by 0.3 times 2^-52 n^1.5. This
 * returns eight times as much. */
static double residual(const struct br_field *f)
{
    const double n = (double)f->n;
    return DBL_EPSILON * (f->kind == BR_AXIAL ? 3 * n : 4 * n * n * n) * sqrt(n);
}

/* ---- a field solver ---- */

/* Each step's velocity is off by the loss of a solve, and inertia keeps that error for so many
 * steps. */
static double kept(const struct assembled *s, double steps)
{
    return fmin(1 + br_field_inertia(&s->field), steps);
}

/* A march with an error above a twentieth has hardly one correct digit. With a loss near 1 the
 * factors contain neither the mass nor the clamp, and the steps grow without bound. */
static const double most_loss = 0.05, few_steps = 10;

/* The loss of a solve is measured, not predicted: n, k, damping and the order of elimination change
 * it by factors of thousands, and only sometimes a pivot becomes negative. The response to a force
 * at the tip is the softest motion, which loses most. The measure is the correction that one more
 * refinement step makes to it, relative to its largest value. */
static enum br_status check_digits(struct assembled *s, struct br_error *err)
{
    const struct br_field *f = &s->field;
    const enum br_status status = correct(s, s->tip_response, err);
    if (status)
        return status;
    const double loss = largest(s->correction, s->nodal) / largest(s->tip_response, s->nodal);
    s->loss = fmax(s->loss, loss);
    const double lost = loss * kept(s, few_steps);
    if (lost <= most_loss)
        return BR_OK;
    return br_fail(
        err, BR_SINGULAR,
        "umfpack: the %s matrix of n = %zu elements and k = %g s is too ill-conditioned: %.2g "
        "of the velocity is lost in %g steps, expected at most %g; solver riccati has no "
        "such matrix",
        br_field_names[f->kind], f->n, f->k, lost, few_steps, most_loss);
}

/* Computes all that depends on the step's length. */
static enum br_status factorise(struct assembled *s, struct br_error *err)
{
    enum br_status status = factorise_matrix(s, err);
    memset(s->rhs, 0, s->nodal * sizeof *s->rhs);
    s->rhs[s->tip] = 1;
    if (!status)
        status = solve(s, s->rhs, s->tip_response, err);
    if (status)
        return status;
    const double compliance = s->tip_response[s->tip];
    if (compliance > 0 && isfinite(compliance))
        return check_digits(s, err);
    return br_fail(err, BR_SINGULAR, "umfpack: the tip's compliance is %g, expected > 0",
                   compliance);
}

static enum br_status allocate(struct assembled *s, struct br_error *err)
{
    double **const nodal[] = {&s->free_velocity, &s->tip_response, &s->rhs, &s->residual,
                              &s->correction};
    struct br_store *store = &s->states.store;
    const size_t order = s->order, most = order * (2 * s->band + 1);
    for (size_t i = 0; i < sizeof nodal / sizeof *nodal; i++)
        *nodal[i] = br_store_take(store, s->nodal, sizeof(double));
    s->column = br_store_take(store, order + 1, sizeof *s->column);
    s->row = br_store_take(store, most, sizeof *s->row);
    s->iwork = br_store_take(store, 2 * order, sizeof *s->iwork);
    s->value = br_store_take(store, most, sizeof *s->value);
    s->work = br_store_take(store, 5 * order, sizeof *s->work);
    return br_states_add(&s->states, 2 * s->nodal, 1, err);
}

/* Finds the order of elimination, which does not depend on A's values. */
static enum br_status analyse(struct assembled *s, struct br_error *err)
{
    const int order = (int)s->order;
    write_pattern(s);
    umfpack_di_defaults(s->control);
    s->control[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
    s->control[UMFPACK_IRSTEP] = 0;
    s->control[UMFPACK_SCALE] = UMFPACK_SCALE_NONE;
    const int result = umfpack_di_symbolic(order, order, s->column, s->row, NULL, &s->symbolic,
                                           s->control, s->info);
    return result == UMFPACK_OK ? BR_OK : failed(err, "the analysis", result);
}

static enum br_status assembled_create(const struct br_field *field, const struct br_kernel *kernel,
                                       void **self, struct br_error *err)
{
    (void)kernel;
    const size_t unknowns = br_field_unknowns(field), order = unknowns * field->n;
    struct assembled *s = br_allocate(1, sizeof *s);
    *self = s;
    if (!s)
        return br_no_memory(err, "the stiffness form");
    *s = (struct assembled){
        .field = *field,
        .unknowns = unknowns,
        .nodal = br_field_size(field),
        .tip = order,
        .order = order,
        .band = 2 * unknowns - 1,
        .usual = usual_loss(field),
    };
    if (field->n > 100 * 1000 * 1000) /* UMFPACK counts entries in int */
        return br_fail(err, BR_BAD_INPUT, "umfpack: n is %zu, expected at most 1e8", field->n);
    const bool bad = allocate(s, err) || analyse(s, err) || factorise(s, err);
    return bad ? err->status : BR_OK;
}

static void assembled_free(void *self)
{
    struct assembled *s = self;
    if (s && s->symbolic)
        umfpack_di_free_symbolic(&s->symbolic);
    if (s && s->numeric)
        umfpack_di_free_numeric(&s->numeric);
    br_free_states(s);
}

static enum br_status assembled_set_step(void *self, double k, struct br_error *err)
{
    struct assembled *s = self;
    s->field.k = k;
    return factorise(s, err);
}

/* The measurement is for one right side and one length of the step. With another length the
 * factors' errors differ, and a measured loss may be small by chance: of 6000 random scenes on up
 * to 12800 elements, in all schemes, the worst lost 30 times as much. So the prediction is at least
 * the usual loss, spread over the 1 + inertia solves whose errors inertia keeps, and at least the
 * loss of a solve's sums. In those scenes some lost 1.7 times the usual. */
static double march_round_off(const void *self, size_t steps)
{
    const struct assembled *s = self;
    const struct br_field *f = &s->field;
    const double sums = 16 * DBL_EPSILON, scatter = 3, safety = 3;
    const double usual = fmin(scatter * s->usual, 1) / (1 + br_field_inertia(f)) + sums;
    return fmax(safety * s->loss, usual) * kept(s, (double)steps) +
           8 * DBL_EPSILON * ((double)f->n + 1024);
}

static double assembled_compliance(const void *self)
{
    const struct assembled *s = self;
    return s->tip_response[s->tip];
}

static void assembled_set(void *self, const double *displacement, const double *velocity)
{
    struct assembled *s = self;
    memcpy(s->states.of[0], displacement, s->nodal * sizeof *displacement);
    memcpy(s->states.of[0] + s->nodal, velocity, s->nodal * sizeof *velocity);
}

static void assembled_get(const void *self, double *displacement, double *velocity)
{
    const struct assembled *s = self;
    const size_t bytes = s->nodal * sizeof *displacement;
    if (displacement)
        memcpy(displacement, s->states.of[0], bytes);
    if (velocity)
        memcpy(velocity, s->states.of[0] + s->nodal, bytes);
}

/* The strain of element i, from nodal values: its elongation or its two curvatures. */
static void strain(const struct assembled *s, const double *nodal, size_t i, double *out)
{
    if (s->field.kind == BR_AXIAL)
        out[0] = nodal[i + 1] - nodal[i];
    else
        br_curvature(nodal + 2 * i, out);
}

static void assembled_strain_rate(const void *self, double *rate)
{
    const struct assembled *s = self;
    for (size_t i = 0; i < s->field.n; i++)
        strain(s, s->states.of[0] + s->nodal, i, rate + i * s->unknowns);
}

/* rhs = factor F + tip + M v/k - K w */
static enum br_status assembled_predict(void *self, const struct br_drive *drive, double *velocity,
                                        struct br_error *err)
{
    struct assembled *s = self;
    const struct br_field *f = &s->field;
    const double *w = s->states.of[0], *v = w + s->nodal;
    for (size_t i = 0; i < s->nodal; i++)
        s->rhs[i] = drive->vector ? drive->factor * drive->vector[i] : 0;
    for (size_t c = 0; c < s->unknowns; c++)
        s->rhs[s->tip + c] += drive->tip[c];
    add_elements(f, f->density / f->k, v, f->stiffness, w, s->rhs);
    const enum br_status status = solve(s, s->rhs, s->free_velocity, err);
    *velocity = s->free_velocity[s->tip];
    return status;
}

/* v = v* - r z,  w += k v */
static double assembled_finish(void *self, double force)
{
    struct assembled *s = self;
    double *w = s->states.of[0], *v = w + s->nodal;
    for (size_t i = 0; i < s->nodal; i++) {
        v[i] = s->free_velocity[i] - force * s->tip_response[i];
        w[i] += s->field.k * v[i];
    }
    return v[s->tip];
}

static double assembled_tip_displacement(const void *self)
{
    const struct assembled *s = self;
    return s->states.of[0][s->tip];
}

static void assembled_size(void *self, size_t which, double size[2])
{
    const struct assembled *s = self;
    struct br_view view;
    br_view_field(&view, &s->field, BR_STRAIN_RATE); /* the modes of a strain: the same scales */
    for (int rate = 0; rate < 2; rate++) {
        const double *nodal = s->states.of[which] + (rate ? s->nodal : 0);
        long double squares = 0; /* squares of small numbers underflow in double */
        double modes[2];
        for (size_t i = 0; i < s->field.n; i++) {
            strain(s, nodal, i, modes);
            for (size_t c = 0; c < s->unknowns; c++) {
                const long double mode = (long double)view.scale[c] * modes[c];
                squares += mode * mode;
            }
        }
        size[rate] = (double)sqrtl(squares);
    }
}

static const struct br_field_solver assembled = {
    .create = assembled_create,
    .free = assembled_free,
    .tip_compliance = assembled_compliance,
    .round_off = march_round_off,
    .set = assembled_set,
    .get = assembled_get,
    .strain_rate = assembled_strain_rate,
    .predict = assembled_predict,
    .finish = assembled_finish,
    .tip_displacement = assembled_tip_displacement,
    .set_step = assembled_set_step,
    .keep = br_keep_states,
    .exchange = br_exchange_states,
    .combine = br_combine_states,
    .size = assembled_size,
};

const struct br_linear_solver br_umfpack = {
    .name = "umfpack",
    .title = "assembled stiffness form, factorised once by SuiteSparse's UMFPACK",
    .citation = "T. A. Davis, Algorithm 832: UMFPACK V4.3, ACM Trans. Math. Softw. 30 (2004)",
    .axial = &assembled,
    .bending = &assembled,
    .round_off = usual_loss,
    .residual = residual,
    .bytes = {394, 1046, 0},
    .state_bytes = {16, 32, 0},
    .step_cost = 170,
    .element_cost = {18.9, 36.2, 0},
};
