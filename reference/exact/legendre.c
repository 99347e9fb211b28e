/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/legendre.h"

#include <assert.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_sf_legendre.h>
#include <math.h>
#include <string.h>

/* GSL refuses arguments outside [-1, 1] by a rounding error. */
static double to_gsl(double xi)
{
    return fmin(fmax(2 * xi - 1, -1), 1);
}

/* Square roots and quotients cost the most: those of low degrees are stored. */
enum { KEPT = 32 };
static double norms[KEPT], couplings[KEPT], inverses[KEPT];

static double find_norm(size_t k)
{
    return sqrt(2.0 * (double)k + 1);
}

static double find_coupling(size_t k)
{
    return 0.5 / sqrt(4.0 * (double)k * (double)k - 1);
}

__attribute__((constructor)) static void keep_roots(void)
{
    for (size_t k = 0; k < KEPT; k++) {
        norms[k] = find_norm(k);
        inverses[k] = 1.0 / ((double)k + 1);
        couplings[k] = k ? find_coupling(k) : 0; /* nothing comes from below degree 0 */
    }
}

static double norm(size_t k)
{
    return k < KEPT ? norms[k] : find_norm(k);
}

void br_legendre(size_t count, double xi, double *p)
{
    if (!count)
        return;
    gsl_sf_legendre_Pl_array((int)count - 1, to_gsl(xi), p);
    for (size_t k = 0; k < count; k++)
        p[k] *= norm(k);
}

double br_legendre_coupling(size_t k)
{
    return k && k < KEPT ? couplings[k] : find_coupling(k);
}

void br_legendre_integral(size_t count, double xi, double *p, double *q)
{
    assert(count <= BR_MOST_INTEGRALS);
    const double y = to_gsl(xi);
    double all[BR_MOST_INTEGRALS + 1], before = 0, here = 1;
    for (size_t k = 0; k <= count; k++) {
        const double n = (double)k;
        all[k] = norms[k] * here;
        if (k == count)
            break;
        const double next = ((2 * n + 1) * y * here - n * before) * inverses[k];
        before = here;
        here = next;
    }
    for (size_t k = 0; k < count; k++) {
        p[k] = all[k];
        q[k] = k ? couplings[k + 1] * all[k + 1] - couplings[k] * all[k - 1] : xi;
    }
}

void br_legendre_integrate(size_t count, double *c)
{
    double before = 0; /* the integrand's coefficient k - 1 */
    c[count] = 0;
    for (size_t k = 0; k <= count; k++) {
        const double here = c[k];
        const double after = k + 1 <= count ? c[k + 1] : 0;
        c[k] = k ? br_legendre_coupling(k) * before : here / 2;
        c[k] -= br_legendre_coupling(k + 1) * after;
        before = here;
    }
}

/* ---- Radau IIA ---- */

enum { S = BR_STAGES };

/* The interior nodes are those of Gauss-Jacobi quadrature with weight 1 - x. */
static enum br_status find_nodes(double node[S], struct br_error *err)
{
    gsl_integration_fixed_workspace *gauss =
        gsl_integration_fixed_alloc(gsl_integration_fixed_jacobi, S - 1, 0, 1, 1, 0);
    if (!gauss)
        return br_no_memory(err, "the Radau nodes");
    memcpy(node, gsl_integration_fixed_nodes(gauss), (S - 1) * sizeof *node);
    node[S - 1] = 1;
    gsl_integration_fixed_free(gauss);
    return BR_OK;
}

static bool all_finite(size_t count, const double *x)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(x[i]))
            return false;
    return true;
}

static void exchange(size_t count, double *x, double *y)
{
    for (size_t i = 0; i < count; i++) {
        const double kept = x[i];
        x[i] = y[i];
        y[i] = kept;
    }
}

/* y -= factor x */
static void subtract(size_t count, double factor, const double *x, double *y)
{
    for (size_t i = 0; i < count; i++)
        y[i] -= factor * x[i];
}

/* Gauss, with the largest entry of a column as its pivot. */
enum br_status br_radau_solve(double a[S][S], size_t columns, double *b)
{
    if (!all_finite((size_t)S * S, &a[0][0]) || !all_finite(S * columns, b))
        return BR_NOT_FINITE;
    for (size_t k = 0; k < S; k++) {
        size_t pivot = k;
        for (size_t i = k + 1; i < S; i++)
            pivot = fabs(a[i][k]) > fabs(a[pivot][k]) ? i : pivot;
        if (!(fabs(a[pivot][k]) > 0))
            return BR_SINGULAR;
        if (pivot != k) {
            exchange(S, a[k], a[pivot]);
            exchange(columns, &b[k * columns], &b[pivot * columns]);
        }
        for (size_t i = k + 1; i < S; i++) {
            const double factor = a[i][k] / a[k][k];
            subtract(S - k, factor, &a[k][k], &a[i][k]);
            subtract(columns, factor, &b[k * columns], &b[i * columns]);
        }
    }
    for (size_t k = S; k-- > 0;)
        for (size_t j = 0; j < columns; j++) {
            double *x = &b[k * columns + j];
            for (size_t i = k + 1; i < S; i++)
                *x -= a[k][i] * b[i * columns + j];
            *x /= a[k][k];
        }
    return BR_OK;
}

/* The inverse of the matrix of p_k(c_j). Radau's weights would give it in closed
 * form, but are ten times more sensitive to the nodes' rounding. */
static enum br_status invert(struct br_radau *r, struct br_error *err)
{
    double value[S][S];
    for (size_t j = 0; j < S; j++) {
        br_legendre(S, r->node[j], value[j]);
        r->to_coefficients[j][j] = 1;
    }
    const enum br_status status = br_radau_solve(value, S, &r->to_coefficients[0][0]);
    return status ? br_fail(err, status, "the Radau nodes have no polynomials") : BR_OK;
}

enum br_status br_radau_init(struct br_radau *r, struct br_error *err)
{
    *r = (struct br_radau){0};
    br_legendre(S, 1, r->end);
    r->integral[0][0] = 0.5;
    for (size_t k = 1; k < S; k++) {
        r->integral[k][k - 1] = br_legendre_coupling(k);
        r->integral[k - 1][k] = -br_legendre_coupling(k);
    }
    r->integral[S - 1][S - 1] = 1.0 / (4 * S - 2); /* p_S seen at the nodes is a p_{S-1} */
    const enum br_status status = find_nodes(r->node, err);
    return status ? status : invert(r, err);
}

void br_radau_fit(const struct br_radau *r, const double value[S], double out[S])
{
    for (size_t k = 0; k < S; k++)
        out[k] = br_radau_sum(r->to_coefficients[k], value);
}

/* ---- the loops that take most of the time ---- */

#define ROW(set) &br_combiner_##set,
const struct br_combiner *const br_combiners[] = {BR_INSTRUCTION_SETS(ROW) NULL};

void br_combine(size_t rows, size_t count, const double *factor, size_t width, const double *table,
                double *out)
{
    br_combiners[br_instruction_set_best()]->combine(rows, count, factor, width, table, out);
}

void br_stage_solve(const struct br_stage_system *system, size_t first, double *x)
{
    br_combiners[br_instruction_set_best()]->solve(system, first, x);
}

/* Sum of a[i] b[i], or of its square: in LANES sums, so that their order is the same on every
 * machine, and none waits for the one before. */
static inline double sum_lanes(size_t count, const double *a, const double *b, bool square)
{
    enum { LANES = 8 };
    const size_t whole = count / LANES * LANES;
    double sum[LANES] = {0}, all = 0;
    for (size_t i = 0; i < whole; i += LANES)
        for (size_t l = 0; l < LANES; l++) {
            const double part = a[i + l] * b[i + l];
            sum[l] += square ? part * part : part;
        }
    for (size_t i = whole; i < count; i++)
        sum[i - whole] += square ? a[i] * b[i] * (a[i] * b[i]) : a[i] * b[i];
    for (size_t l = 0; l < LANES; l++)
        all += sum[l];
    return all;
}

double br_sum_products(size_t count, const double *a, const double *b)
{
    return sum_lanes(count, a, b, false);
}

double br_norm(size_t count, const double *weight, const double *x)
{
    return sqrt(weight ? sum_lanes(count, weight, x, true) : sum_lanes(count, x, x, false));
}

void br_stage_factor(struct br_stage_system *s, const struct br_radau *radau)
{
    s->first = radau->integral[0][0];
    s->last = radau->integral[S - 1][S - 1];
    for (size_t k = 1; k < S; k++)
        s->coupling[k] = radau->integral[k][k - 1];
    for (size_t k = 0; k < S; k++) {
        const double diagonal = k == 0 ? s->first : k + 1 == S ? s->last : 0;
        const double square = s->coupling[k] * s->coupling[k];
        double *all_p = &s->pivot[k * s->width], *all_q = all_p + S * s->width;
        for (size_t i = 0; i < s->width; i++) {
            double p = diagonal, q = 1;
            if (k > 0) { /* + coupling^2 over the pivot before */
                const double *const before_p = all_p - s->width, *const before_q = all_q - s->width;
                p += square * (before_p[i] + s->b * before_q[i]);
                q -= square * before_q[i];
            }
            const double norm = p * p + p * q * s->b + q * q * s->a[i];
            all_p[i] = p / norm;
            all_q[i] = q / norm;
        }
    }
}
