/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <float.h>
#include <math.h>
#include <string.h>

#include "solver/assembled.h"
#include "solver/traps.h"

enum br_status br_system_init(struct br_system *s, const struct br_field *field,
                              const struct br_linear_options *options,
                              const struct br_factoriser *factoriser, struct br_error *err)
{
    s->field = *field;
    s->unknowns = br_field_unknowns(field);
    s->nodal = br_field_size(field);
    s->factoriser = factoriser;
    s->refinement = factoriser->refines ? 0 : options->refinement;
    s->matrix = (struct br_band){.order = s->unknowns * field->n, .band = 2 * s->unknowns - 1};
    if (field->n > 100 * 1000 * 1000) /* the libraries count entries in int */
        return br_fail(err, BR_BAD_INPUT, "%s: n is %zu, expected at most 1e8", factoriser->name,
                       field->n);
    s->matrix.value = br_allocate(s->matrix.order * (s->matrix.band + 1), sizeof(double));
    s->residual = br_allocate(2 * s->nodal, sizeof *s->residual);
    if (!s->matrix.value || !s->residual)
        return br_no_memory(err, "the stiffness form");
    s->correction = s->residual + s->nodal;
    return factoriser->create(&s->matrix, options, &s->factor, err);
}

void br_system_clear(struct br_system *s)
{
    if (s->factoriser)
        s->factoriser->free(s->factor);
    free(s->matrix.value);
    free(s->residual);
}

enum br_status br_system_factorise(struct br_system *s, struct br_error *err)
{
    const size_t count = s->matrix.order * (s->matrix.band + 1);
    memset(s->matrix.value, 0, count * sizeof *s->matrix.value);
    br_band_assemble(&s->field, &s->matrix);
    for (size_t i = 0; i < count; i++)
        if (!isfinite(s->matrix.value[i]))
            return br_fail(err, BR_SINGULAR, "%s: the matrix has an entry %g, expected numbers",
                           s->factoriser->name, s->matrix.value[i]);
    const int traps = br_traps_lift(); /* libraries may try a pivot of 0 */
    const enum br_status status = s->factoriser->factorise(s->factor, &s->matrix, err);
    br_traps_restore(traps);
    return status;
}

/* NaN where one of them is. */
static double largest(const double *x, size_t count)
{
    double most = 0;
    for (size_t i = 0; i < count; i++)
        most = isnan(most) || fabs(x[i]) <= most ? most : fabs(x[i]);
    return most;
}

static enum br_status solve_once(struct br_system *s, const double *rhs, double *x,
                                 struct br_error *err)
{
    return s->factoriser->solve(s->factor, rhs + s->unknowns, x + s->unknowns, err);
}

/* residual = rhs - A x */
static void form_residual(struct br_system *s, const double *rhs, const double *x)
{
    const struct br_field *f = &s->field;
    memcpy(s->residual, rhs, s->nodal * sizeof *rhs);
    br_add_elements(f, -f->density / f->k, x, f->viscosity + f->k * f->stiffness, x, s->residual);
}

static enum br_status no_digits(const struct br_system *s, struct br_error *err)
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
static enum br_status refine(struct br_system *s, const double *rhs, double *x,
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
        if (size == 0 || size / last * size <= enough)
            break;
        last = size;
    }
    return BR_OK;
}

enum br_status br_system_solve(struct br_system *s, const double *rhs, double *x,
                               struct br_error *err)
{
    const enum br_status status = solve_once(s, rhs, x, err);
    return status ? status : refine(s, rhs, x, err);
}

enum br_status br_system_loss(struct br_system *s, const double *rhs, const double *x, double *loss,
                              struct br_error *err)
{
    form_residual(s, rhs, x);
    const enum br_status status = solve_once(s, s->residual, s->correction, err);
    if (!status)
        *loss = largest(s->correction, s->nodal) / largest(x, s->nodal);
    return status;
}

/* Before a march: upper estimates of what was measured for n = 100 to 100,000 and k = 1e-2 to 1e-6
 * in the paper's examples and a vibration of little damping (study/extremes/floors.h). For bending
 * first like the condition number, n^4, and from n = 1100 like n^3. A march measures its own. */
static double without_refinement(const struct br_field *f)
{
    const double n = (double)f->n;
    if (f->kind == BR_AXIAL)
        return DBL_EPSILON * (100 * n + n * n / 2);
    return DBL_EPSILON * fmax(fmax(16, fmin(n / 4, 25)), fmin(n * n / 400, 3000)) * n * n * n;
}

/* What a refinement step leaves of an error. */
static double left_by_a_step(const struct br_field *f)
{
    const double n = (double)f->n;
    return fmin(0.5, f->kind == BR_AXIAL ? without_refinement(f) : 4000 * DBL_EPSILON * n * n * n);
}

/* UMFPACK's refinement repairs residuals, not errors: with it, up to 10 times as much. */
double br_system_usual_loss(const struct br_field *f, const struct br_factoriser *factoriser,
                            const struct br_linear_options *options)
{
    double loss = without_refinement(f);
    if (options->refinement > 0)
        loss *= factoriser->refines ? f->kind == BR_AXIAL ? 4 : 10
                                    : pow(left_by_a_step(f), options->refinement);
    return fmin(loss, 1);
}

/* No step of refinement repairs the round-off of nodal values. */
double br_system_round_off(const struct br_field *f, const struct br_factoriser *factoriser,
                           const struct br_linear_options *options)
{
    const bool repaired = options->refinement > 0 && !factoriser->refines;
    return br_system_usual_loss(f, factoriser, options) +
           (repaired ? 8 * DBL_EPSILON * ((double)f->n + 1024) : 0);
}

/* Elimination is backward stable: each row is solved for a nodal force that is off by a few last
 * bits of its terms, 24 C/h^3 |v| for bending and 2 C/h |v| for the rod (Higham, chapter 10). Such
 * forces are at random, and what balances them is a sum of them and of their levers: of moments
 * C |v|/L^2 the relative error is 0.5 times 2^-52 n^3.5, of normal forces 0.3 times 2^-52 n^1.5.
 * Eight times as much. */
double br_system_residual(const struct br_field *f)
{
    const double n = (double)f->n;
    return DBL_EPSILON * (f->kind == BR_AXIAL ? 3 * n : 4 * n * n * n) * sqrt(n);
}
