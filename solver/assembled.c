/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/assembled.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "solver/modes.h"

struct assembled {
    struct br_field field;
    const struct br_factoriser *factoriser;
    void *factor;
    int refinement; /* steps a solve, at most, where the factoriser does not do it */
    struct br_band matrix;
    size_t unknowns;       /* a node */
    size_t nodal;          /* length of a nodal array, clamped node included */
    double *displacement;  /* state 0, nodal, and behind it */
    double *velocity;      /* ... its velocity */
    double *kept;          /* states 1, 2, ..., each as state 0 */
    double *free_velocity; /* v* */
    double *tip_response;  /* z = A^-1 e_tip, nodal */
    double *rhs;           /* workspace, nodal */
    double *residual;      /* workspace, nodal */
    double *correction;    /* workspace, nodal */
};

/* Index of the tip's displacement in a nodal array. */
static size_t tip_index(const struct assembled *s)
{
    return s->field.n * s->unknowns;
}

static double largest(const double *x, size_t count)
{
    double most = 0;
    for (size_t i = 0; i < count; i++)
        most = fmax(most, fabs(x[i]));
    return most;
}

static enum br_status solve_once(struct assembled *s, const double *rhs, double *x,
                                 struct br_error *err)
{
    return s->factoriser->solve(s->factor, rhs + s->unknowns, x + s->unknowns, err);
}

/* residual = rhs - A x */
static void form_residual(struct assembled *s, const double *rhs, const double *x)
{
    const struct br_field *f = &s->field;
    memcpy(s->residual, rhs, s->nodal * sizeof *rhs);
    br_add_elements(f, -f->density / f->k, x, f->viscosity + f->k * f->stiffness, x, s->residual);
}

static enum br_status no_digits(const struct assembled *s, struct br_error *err)
{
    return br_fail(err, BR_SINGULAR,
                   "%s: the refinement does not converge, since the matrix of n = %zu elements is "
                   "too ill-conditioned for a solution with any right digit",
                   s->factoriser->name, s->field.n);
}

/* x += A^-1 (rhs - A x), in double, until a correction is no longer half of the one before, or the
 * next one would be round-off. The residual is formed element by element from what deforms them, so
 * that it is as exact as one of more digits, and the error itself shrinks, not just the residual
 * (N. J. Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., SIAM 2002, section 12.1).
 * What is not finite is left to the march, which tells it. */
static enum br_status refine(struct assembled *s, const double *rhs, double *x,
                             struct br_error *err)
{
    double last = largest(x, s->nodal);
    const double enough = DBL_EPSILON * last;
    for (int step = 0; step < s->refinement; step++) {
        form_residual(s, rhs, x);
        const enum br_status status = solve_once(s, s->residual, s->correction, err);
        if (status)
            return status;
        const double size = largest(s->correction, s->nodal);
        if (!(size <= last / 2))
            return step == 0 && isfinite(size) ? no_digits(s, err) : BR_OK;
        for (size_t i = 0; i < s->nodal; i++)
            x[i] += s->correction[i];
        if (size * size <= enough * last)
            break;
        last = size;
    }
    return BR_OK;
}

/* x = A^-1 rhs; both nodal, and the clamped node of x stays zero. */
static enum br_status solve(struct assembled *s, const double *rhs, double *x, struct br_error *err)
{
    const enum br_status status = solve_once(s, rhs, x, err);
    return status ? status : refine(s, rhs, x, err);
}

static enum br_status find_tip_response(struct assembled *s, struct br_error *err)
{
    memset(s->rhs, 0, s->nodal * sizeof *s->rhs);
    s->rhs[tip_index(s)] = 1;
    const enum br_status status = solve(s, s->rhs, s->tip_response, err);
    const double compliance = s->tip_response[tip_index(s)];
    if (status || (compliance > 0 && isfinite(compliance)))
        return status;
    return br_fail(err, BR_SINGULAR, "%s: the tip's compliance is %g, expected > 0",
                   s->factoriser->name, compliance);
}

/* All that depends on the step's length. */
static enum br_status factorise(struct assembled *s, struct br_error *err)
{
    const size_t count = s->matrix.order * (s->matrix.band + 1);
    memset(s->matrix.value, 0, count * sizeof *s->matrix.value);
    br_band_assemble(&s->field, &s->matrix);
    for (size_t i = 0; i < count; i++)
        if (!isfinite(s->matrix.value[i]))
            return br_fail(err, BR_SINGULAR, "%s: the matrix has an entry %g, expected numbers",
                           s->factoriser->name, s->matrix.value[i]);
    const enum br_status status = s->factoriser->factorise(s->factor, &s->matrix, err);
    return status ? status : find_tip_response(s, err);
}

static enum br_status allocate(struct assembled *s, struct br_error *err)
{
    s->displacement = br_allocate(7 * s->nodal, sizeof *s->displacement);
    s->matrix.value = br_allocate(s->matrix.order * (s->matrix.band + 1), sizeof(double));
    if (!s->displacement || !s->matrix.value)
        return br_no_memory(err, "the stiffness form");
    s->velocity = s->displacement + s->nodal;
    s->free_velocity = s->velocity + s->nodal;
    s->tip_response = s->free_velocity + s->nodal;
    s->rhs = s->tip_response + s->nodal;
    s->residual = s->rhs + s->nodal;
    s->correction = s->residual + s->nodal;
    return BR_OK;
}

enum br_status br_assembled_create(const struct br_field *field,
                                   const struct br_linear_options *options,
                                   const struct br_factoriser *factoriser, void **self,
                                   struct br_error *err)
{
    struct assembled *s = br_allocate(1, sizeof *s);
    *self = s;
    if (!s)
        return br_no_memory(err, "the stiffness form");
    s->field = *field;
    s->factoriser = factoriser;
    s->refinement = factoriser->refines ? 0 : options->refinement;
    s->unknowns = br_field_unknowns(field->kind);
    s->nodal = br_field_size(field);
    s->matrix = (struct br_band){.order = s->unknowns * field->n, .band = 2 * s->unknowns - 1};
    if (field->n > 100 * 1000 * 1000) /* the libraries count entries in int */
        return br_fail(err, BR_BAD_INPUT, "%s: n is %zu, expected at most 1e8", factoriser->name,
                       field->n);
    enum br_status status = allocate(s, err);
    if (!status)
        status = factoriser->create(&s->matrix, options, &s->factor, err);
    return status ? status : factorise(s, err);
}

void br_assembled_free(void *self)
{
    struct assembled *s = self;
    if (!s)
        return;
    s->factoriser->free(s->factor);
    free(s->displacement);
    free(s->kept);
    free(s->matrix.value);
    free(s);
}

enum br_status br_assembled_set_step(void *self, double k, struct br_error *err)
{
    struct assembled *s = self;
    s->field.k = k;
    return factorise(s, err);
}

double br_assembled_compliance(const void *self)
{
    const struct assembled *s = self;
    return s->tip_response[tip_index(s)];
}

void br_assembled_set(void *self, const double *displacement, const double *velocity)
{
    struct assembled *s = self;
    memcpy(s->displacement, displacement, s->nodal * sizeof *displacement);
    memcpy(s->velocity, velocity, s->nodal * sizeof *velocity);
}

void br_assembled_get(const void *self, double *displacement, double *velocity)
{
    const struct assembled *s = self;
    const size_t bytes = s->nodal * sizeof *displacement;
    if (displacement)
        memcpy(displacement, s->displacement, bytes);
    if (velocity)
        memcpy(velocity, s->velocity, bytes);
}

/* What deforms element i, from nodal values: its elongation or its two curvatures. */
static void strain(const struct assembled *s, const double *nodal, size_t i, double *out)
{
    if (s->field.kind == BR_AXIAL)
        out[0] = nodal[i + 1] - nodal[i];
    else
        br_curvature(nodal + 2 * i, out);
}

void br_assembled_strain_rate(const void *self, double *rate)
{
    const struct assembled *s = self;
    for (size_t i = 0; i < s->field.n; i++)
        strain(s, s->velocity, i, rate + i * s->unknowns);
}

/* rhs = factor F + tip + M v/k - K w */
static void form_rhs(struct assembled *s, const struct br_drive *drive)
{
    const struct br_field *f = &s->field;
    for (size_t i = 0; i < s->nodal; i++)
        s->rhs[i] = drive->vector ? drive->factor * drive->vector[i] : 0;
    for (size_t c = 0; c < s->unknowns; c++)
        s->rhs[tip_index(s) + c] += drive->tip[c];
    br_add_elements(f, f->density / f->k, s->velocity, f->stiffness, s->displacement, s->rhs);
}

enum br_status br_assembled_predict(void *self, const struct br_drive *drive, double *velocity,
                                    struct br_error *err)
{
    struct assembled *s = self;
    form_rhs(s, drive);
    const enum br_status status = solve(s, s->rhs, s->free_velocity, err);
    *velocity = s->free_velocity[tip_index(s)];
    return status;
}

/* v = v* - r z,  w += k v */
double br_assembled_finish(void *self, double force)
{
    struct assembled *s = self;
    for (size_t i = 0; i < s->nodal; i++) {
        s->velocity[i] = s->free_velocity[i] - force * s->tip_response[i];
        s->displacement[i] += s->field.k * s->velocity[i];
    }
    return s->velocity[tip_index(s)];
}

double br_assembled_tip_displacement(const void *self)
{
    const struct assembled *s = self;
    return s->displacement[tip_index(s)];
}

/* ---- more states ---- */

static double *state(const struct assembled *s, size_t j)
{
    return j == 0 ? s->displacement : s->kept + (j - 1) * 2 * s->nodal;
}

enum br_status br_assembled_keep(void *self, size_t count, struct br_error *err)
{
    struct assembled *s = self;
    s->kept = br_allocate(count * 2 * s->nodal, sizeof *s->kept);
    return s->kept ? BR_OK : br_no_memory(err, "the states that are kept");
}

void br_assembled_combine(void *self, size_t into, size_t count, const double *weight)
{
    struct assembled *s = self;
    const size_t size = 2 * s->nodal; /* displacement and velocity */
    double *sum = state(s, into);
    const double own = into < count ? weight[into] : 0;
    for (size_t i = 0; i < size; i++)
        sum[i] = own == 0 ? 0 : own * sum[i];
    for (size_t j = 0; j < count; j++) {
        if (weight[j] == 0 || j == into)
            continue;
        const double *term = state(s, j);
        for (size_t i = 0; i < size; i++)
            sum[i] += weight[j] * term[i];
    }
}

void br_assembled_size(void *self, size_t which, double size[2])
{
    const struct assembled *s = self;
    struct br_view view;
    br_view_field(&view, &s->field, BR_STRAIN_RATE); /* the modes of a strain: the same scales */
    for (int part = 0; part < 2; part++) {
        const double *nodal = state(s, which) + (part ? s->nodal : 0);
        double squares = 0, modes[2];
        for (size_t i = 0; i < s->field.n; i++) {
            strain(s, nodal, i, modes);
            for (size_t c = 0; c < s->unknowns; c++)
                squares += view.scale[c] * modes[c] * (view.scale[c] * modes[c]);
        }
        size[part] = sqrt(squares);
    }
}

/* Upper estimates of what was measured for n = 100 to 12800 and k = 1e-2 to 1e-4. Without
 * refinement: for bending about n^3, below the bound n^4 of the condition number. */
static double without_refinement(const struct br_field *f)
{
    const double n = (double)f->n;
    if (f->kind == BR_AXIAL)
        return DBL_EPSILON * (10 * n + n * n / 100);
    return DBL_EPSILON * 16 * n * n * n;
}

/* What a refinement step leaves of an error, and what no step repairs: that of nodal values. */
double br_assembled_round_off(const struct br_field *f, int refinement)
{
    const double n = (double)f->n, at_first = without_refinement(f);
    if (refinement < 1)
        return at_first;
    const double left = fmin(0.5, f->kind == BR_AXIAL ? at_first : 250 * at_first);
    return at_first * pow(left, refinement) + DBL_EPSILON * (50 + n / 10);
}
