/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/linear/assembled/assembled.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "solver/arithmetic.h"
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

/* The lower band of A (out, a->value: zeroed by the caller). */
static void band_assemble(const struct br_field *f, struct br_band *m)
{
    const size_t u = br_field_unknowns(f), rows = m->band + 1;
    for (size_t e = 0; e < f->n; e++)
        for (size_t a = 0; a < 2 * u; a++)
            for (size_t b = 0; b <= a; b++) {
                const size_t i = e * u + a, j = e * u + b;
                if (j < u)
                    continue; /* clamped */
                m->value[(j - u) * rows + i - j] += entry(f, a, b);
            }
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

/* ---- the matrix ---- */

/* The first row of a column, of the lower triangle or of both. */
static size_t first_row(const struct br_band *a, bool both, size_t column)
{
    return !both ? column : column > a->band ? column - a->band : 0;
}

void br_band_pattern(const struct br_band *a, bool both, int *column, int *row)
{
    int count = 0;
    for (size_t j = 0; j < a->order; j++) {
        column[j] = count;
        for (size_t i = first_row(a, both, j); i <= j + a->band && i < a->order; i++)
            row[count++] = (int)i;
    }
    column[a->order] = count;
}

void br_band_values(const struct br_band *a, bool both, double *value)
{
    for (size_t j = 0; j < a->order; j++)
        for (size_t i = first_row(a, both, j); i <= j + a->band && i < a->order; i++) {
            const size_t low = i < j ? i : j, high = i < j ? j : i;
            *value++ = a->value[low * (a->band + 1) + high - low];
        }
}

/* ---- the system A x = b ---- */

struct assembled {
    struct br_states states; /* nodal: displacement, then velocity */
    struct br_field field;
    size_t unknowns; /* a node */
    size_t nodal;    /* length of a nodal array, clamped node included */
    size_t tip;      /* index of the tip's displacement in one */
    const struct br_factoriser *factoriser;
    void *factor;
    int refinement; /* largest number of steps a solve; 0 where the factoriser refines */
    struct br_band matrix;
    double *free_velocity;               /* v* */
    double *tip_response;                /* z = A^-1 e_tip, nodal */
    double *rhs, *residual, *correction; /* workspace, nodal */
    double loss;   /* relative loss of a solve (check_digits): the largest for all step lengths */
    double safety; /* a factor on that loss, see march_round_off */
    double usual;  /* loss of a march by usual_loss */
};

/* Assembles and factorises A for s->field. */
static enum br_status factorise_matrix(struct assembled *s, struct br_error *err)
{
    const size_t count = s->matrix.order * (s->matrix.band + 1);
    memset(s->matrix.value, 0, count * sizeof *s->matrix.value);
    band_assemble(&s->field, &s->matrix);
    for (size_t i = 0; i < count; i++)
        if (!isfinite(s->matrix.value[i]))
            return br_fail(err, BR_SINGULAR, "%s: the matrix has an entry %g, expected numbers",
                           s->factoriser->name, s->matrix.value[i]);
    const int traps = br_traps_lift(); /* libraries may divide by a pivot of 0 */
    const enum br_status status = s->factoriser->factorise(s->factor, &s->matrix, err);
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

static enum br_status solve_once(struct assembled *s, const double *rhs, double *x,
                                 struct br_error *err)
{
    return s->factoriser->solve(s->factor, rhs + s->unknowns, x + s->unknowns, err);
}

/* correction = A^-1 (rhs - A x) */
static enum br_status correct(struct assembled *s, const double *x, struct br_error *err)
{
    const struct br_field *f = &s->field;
    memcpy(s->residual, s->rhs, s->nodal * sizeof *s->rhs);
    add_elements(f, -f->density / f->k, x, f->viscosity + f->k * f->stiffness, x, s->residual);
    return solve_once(s, s->residual, s->correction, err);
}

/* x = A^-1 rhs; nodal (out), and the clamped node of x stays as it is, zero. Then x += A^-1 (rhs -
 * A x), in double, until a correction is more than half of the one before, or the next one would be
 * round-off. The residual is formed from the elements' strains, so that it is as exact as one in
 * higher precision, and the error itself shrinks, not only the residual (N. J. Higham, Accuracy and
 * Stability of Numerical Algorithms, 2nd ed., SIAM 2002, section 12.1). The march reports what is
 * not finite. */
static enum br_status solve(struct assembled *s, double *x, struct br_error *err)
{
    enum br_status status = solve_once(s, s->rhs, x, err);
    if (status || s->refinement == 0)
        return status;
    double last = largest(x, s->nodal);
    const double enough = DBL_EPSILON * last;
    for (int step = 0; step < s->refinement; step++) {
        status = correct(s, x, err);
        if (status)
            return status;
        const double size = largest(s->correction, s->nodal);
        if (!(size <= last / 2) && step == 0 && isfinite(size))
            return br_fail(err, BR_SINGULAR,
                           "%s: the refinement does not converge: the matrix of n = %zu elements "
                           "is too ill-conditioned for one correct digit",
                           s->factoriser->name, s->field.n);
        if (!(size <= last / 2))
            break;
        for (size_t i = 0; i < s->nodal; i++)
            x[i] += s->correction[i];
        if (size == 0 || size / last * size <= enough)
            break;
        last = size;
    }
    return BR_OK;
}

/* Before a march: upper estimates of the losses that were measured for n = 100 to 100,000 and k =
 * 1e-2 to 1e-6 in the paper's examples and a vibration of little damping
 * (study/extremes/extremes.h). For bending first like the condition number, n^4, and from n = 1100
 * like n^3. A march measures its own loss. */
static double without_refinement(const struct br_field *f)
{
    const double n = (double)f->n;
    if (f->kind == BR_AXIAL)
        return DBL_EPSILON * (100 * n + n * n / 2);
    return DBL_EPSILON * fmax(fmax(16, fmin(n / 4, 25)), fmin(n * n / 400, 3000)) * n * n * n;
}

/* The factor of an error that remains after a refinement step. */
static double left_by_a_step(const struct br_field *f)
{
    const double n = (double)f->n;
    return fmin(0.5, f->kind == BR_AXIAL ? without_refinement(f) : 4000 * DBL_EPSILON * n * n * n);
}

/* UMFPACK's refinement repairs residuals, not errors: with it the loss is up to 10 times larger. */
static double usual_loss(const struct br_field *f, bool refines,
                         const struct br_linear_options *options)
{
    double loss = without_refinement(f);
    if (options->refinement > 0)
        loss *=
            refines ? f->kind == BR_AXIAL ? 4 : 10 : pow(left_by_a_step(f), options->refinement);
    return fmin(loss, 1);
}

/* No step of refinement repairs the round-off of nodal values. */
double br_assembled_round_off(const struct br_linear_solver *row, const struct br_field *f,
                              const struct br_linear_options *options)
{
    const bool refined = options->refinement > 0 && !row->factoriser->refines;
    return usual_loss(f, row->factoriser->refines, options) +
           (refined ? 8 * DBL_EPSILON * ((double)f->n + 1024) : 0);
}

/* Elimination is backward stable: each row is solved for a nodal force that is off by a few last
 * bits of its terms, 24 C/h^3 |v| for bending and 2 C/h |v| for the rod (Higham, chapter 10). Such
 * forces are random, and a moment or normal force is off by their sum, with their levers: relative
 * to moments C |v|/L^2 by 0.5 times 2^-52 n^3.5, to normal forces by 0.3 times 2^-52 n^1.5. This
 * returns eight times as much. A library's own refinement does not help: it uses the rounded
 * matrix. */
double br_assembled_residual(const struct br_linear_solver *row, const struct br_field *f,
                             const struct br_linear_options *options)
{
    const double n = (double)f->n;
    if (options->refinement > 0 && !row->factoriser->refines)
        return 0;
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
        "%s: the %s matrix of n = %zu elements and k = %g s is too ill-conditioned: %.2g "
        "of the velocity is lost in %g steps, expected at most %g; solver riccati has no "
        "such matrix",
        s->factoriser->name, f->kind == BR_AXIAL ? "axial" : "bending", f->n, f->k, lost, few_steps,
        most_loss);
}

/* Computes all that depends on the step's length. */
static enum br_status factorise(struct assembled *s, struct br_error *err)
{
    enum br_status status = factorise_matrix(s, err);
    memset(s->rhs, 0, s->nodal * sizeof *s->rhs);
    s->rhs[s->tip] = 1;
    if (!status)
        status = solve(s, s->tip_response, err);
    if (status)
        return status;
    const double compliance = s->tip_response[s->tip];
    if (compliance > 0 && isfinite(compliance))
        return check_digits(s, err);
    return br_fail(err, BR_SINGULAR, "%s: the tip's compliance is %g, expected > 0",
                   s->factoriser->name, compliance);
}

static enum br_status allocate(struct assembled *s, struct br_error *err)
{
    double **const nodal[] = {&s->free_velocity, &s->tip_response, &s->rhs, &s->residual,
                              &s->correction};
    struct br_store *store = &s->states.store;
    s->matrix.value = br_store_take(store, s->matrix.order * (s->matrix.band + 1), sizeof(double));
    for (size_t i = 0; i < sizeof nodal / sizeof *nodal; i++)
        *nodal[i] = br_store_take(store, s->nodal, sizeof(double));
    return br_states_add(&s->states, 2 * s->nodal, 1, err);
}

static enum br_status assembled_create(const struct br_linear_solver *row,
                                       const struct br_field *field,
                                       const struct br_linear_options *options, void **self,
                                       struct br_error *err)
{
    const struct br_factoriser *factoriser = row->factoriser;
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
        .factoriser = factoriser,
        .refinement = factoriser->refines ? 0 : options->refinement,
        .matrix = {.order = order, .band = 2 * unknowns - 1},
        .safety = factoriser->refines && options->refinement > 0 ? 15 : 3,
        .usual = usual_loss(field, factoriser->refines, options),
    };
    if (field->n > 100 * 1000 * 1000) /* the libraries count entries in int */
        return br_fail(err, BR_BAD_INPUT, "%s: n is %zu, expected at most 1e8", factoriser->name,
                       field->n);
    enum br_status status = allocate(s, err);
    if (!status)
        status = factoriser->create(&s->matrix, options, &s->factor, err);
    return status ? status : factorise(s, err);
}

static void assembled_free(void *self)
{
    struct assembled *s = self;
    if (s)
        s->factoriser->free(s->factor);
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
    const double sums = 16 * DBL_EPSILON, scatter = 3;
    const double usual = fmin(scatter * s->usual, 1) / (1 + br_field_inertia(f)) + sums;
    return fmax(s->safety * s->loss, usual) * kept(s, (double)steps) +
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
    const enum br_status status = solve(s, s->free_velocity, err);
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

const struct br_field_solver br_assembled = {
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
