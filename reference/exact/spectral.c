/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/inside.h"

#include <gsl/gsl_integration.h>
#include <math.h>
#include <string.h>

void br_spectral_init(struct br_spectral_elements *p, double length, size_t count,
                      const double *end, const size_t *terms, struct br_store *store)
{
    *p = (struct br_spectral_elements){.length = length, .count = count};
    p->end = br_store_take(store, count + 1, sizeof *p->end);
    p->terms = br_store_take(store, count, sizeof *p->terms);
    p->first = br_store_take(store, count + 1, sizeof *p->first);
    if (store->failed)
        return;
    memcpy(p->end, end, (count + 1) * sizeof *end);
    memcpy(p->terms, terms, count * sizeof *terms);
    for (size_t e = 0; e < count; e++)
        p->first[e + 1] = p->first[e] + terms[e];
}

double br_spectral_integral(const struct br_spectral_elements *p, size_t extra, const double *c)
{
    double sum = 0;
    for (size_t e = 0; e < p->count; e++)
        sum += sqrt(br_spectral_width(p, e)) * c[br_spectral_at(p, e, extra)];
    return sum;
}

/* Integrates each element by Legendre's recurrence; its integral is a constant in all elements to
 * its right. */
void br_spectral_integrate(const struct br_spectral_elements *p, size_t extra, double *c)
{
    for (size_t e = p->count; e-- > 1;)
        memmove(&c[br_spectral_at(p, e, extra + 1)], &c[br_spectral_at(p, e, extra)],
                (p->terms[e] + extra) * sizeof *c);
    double value = 0; /* of the integral, at the element's left end */
    for (size_t e = 0; e < p->count; e++) {
        const double width = br_spectral_width(p, e), one = sqrt(width); /* 1 = one p_0 / sqrt(h) */
        double *here = &c[br_spectral_at(p, e, extra + 1)];
        const double gain = one * here[0];
        br_legendre_integrate(p->terms[e] + extra, here);
        for (size_t k = 0; k <= p->terms[e] + extra; k++)
            here[k] *= width;
        here[0] += one * value;
        value += gain;
    }
}

/* ---- Gauss's rule on each element ---- */

/* At least twice as many points as a product of polynomials needs. GSL knows the
 * rules with these powers of two to all digits, others to 1e-10 only. */
static size_t rule_points(size_t terms, size_t elements)
{
    size_t points = elements > 1 ? 32 : 64;
    while (points < 2 * terms && points < 1024)
        points *= 2;
    return points;
}

/* A point xi of [low, high], but neither end: a function may jump there. */
static double inside(double low, double high, double xi)
{
    return fmin(fmax(low + (high - low) * xi, nextafter(low, high)), nextafter(high, low));
}

static void fill_rule(struct br_quadrature *q, size_t e, size_t start, struct br_store *store)
{
    const struct br_spectral_elements *p = q->spectral;
    const size_t points = q->points[e], terms = p->terms[e] + q->extra;
    gsl_integration_glfixed_table *gauss = gsl_integration_glfixed_table_alloc(points);
    q->table[e] = br_store_take(store, points * terms, sizeof **q->table);
    store->failed = store->failed || !gauss;
    for (size_t i = 0; !store->failed && i < points; i++) {
        double xi;
        gsl_integration_glfixed_point(0, 1, i, &xi, &q->weight[start + i], gauss);
        q->x[start + i] = inside(p->end[e], p->end[e + 1], xi);
        br_legendre(terms, xi, &q->table[e][i * terms]);
    }
    gsl_integration_glfixed_table_free(gauss);
}

void br_quadrature_init(struct br_quadrature *q, const struct br_spectral_elements *spectral,
                        size_t extra, struct br_store *store)
{
    *q = (struct br_quadrature){.spectral = spectral, .extra = extra};
    q->points = br_store_take(store, spectral->count, sizeof *q->points);
    q->table = br_store_take(store, spectral->count, sizeof *q->table);
    for (size_t e = 0; !store->failed && e < spectral->count; e++)
        q->count += q->points[e] = rule_points(spectral->terms[e] + extra, spectral->count);
    q->x = br_store_take(store, q->count, sizeof *q->x);
    q->weight = br_store_take(store, q->count, sizeof *q->weight);
    q->value = br_store_take(store, q->count, sizeof *q->value);
    for (size_t e = 0, start = 0; !store->failed && e < spectral->count; start += q->points[e++])
        fill_rule(q, e, start, store);
}

/* c[k] += sum over i of here[i] p_k, by Legendre's recurrence at all points y[i] = 2 xi[i] - 1 at
 * once, in LANES sums, so that their order is the same on every machine. count: a multiple of them;
 * here: destroyed; before: zeros, destroyed. */
static void add_moments(size_t count, const double *y, double *here, double *before, size_t terms,
                        double *c)
{
    enum { LANES = 8 };
    for (size_t k = 0; k < terms; k++) {
        const double n = (double)k, a = (2 * n + 1) / (n + 1), b = n / (n + 1);
        double sum[LANES] = {0}, all = 0;
        for (size_t i = 0; i < count; i += LANES)
            for (size_t l = 0; l < LANES; l++) {
                const double p = here[i + l];
                sum[l] += p;
                here[i + l] = a * y[i + l] * p - b * before[i + l];
                before[i + l] = p;
            }
        for (size_t l = 0; l < LANES; l++)
            all += sum[l];
        c[k] += sqrt(2 * n + 1) * all;
    }
}

/* c += the integrals over the part [low, high] of element e, m, of a function that is smooth
 * there. start: the element's first point; its values are workspace. */
static enum br_status add_part(const struct br_quadrature *q, const struct br_function *f, double t,
                               size_t e, size_t start, const double part[2], double *c,
                               struct br_error *err)
{
    const struct br_spectral_elements *p = q->spectral;
    const size_t points = q->points[e]; /* a multiple of 32 */
    const double a = p->end[e], h = p->end[e + 1] - a;
    double *at = br_allocate(3 * points, sizeof *at), *here = at + points, *before = here + points;
    if (!at)
        return br_no_memory(err, "a quadrature");
    for (size_t i = 0; i < points; i++) /* the rule's own points are those of the whole element */
        at[i] = inside(part[0], part[1], (q->x[start + i] - a) / h);
    br_function_evaluate(f, points, at, t, here);
    const double factor = sqrt(br_spectral_width(p, e)) * (part[1] - part[0]) / h;
    for (size_t i = 0; i < points; i++) {
        here[i] *= factor * q->weight[start + i];
        at[i] = 2 * (at[i] - a) / h - 1;
    }
    add_moments(points, at, here, before, p->terms[e] + q->extra, c);
    free(at);
    return BR_OK;
}

/* An element that holds `count` fronts. */
static enum br_status project_parts(const struct br_quadrature *q, const struct br_function *f,
                                    double t, size_t e, size_t start,
                                    const struct br_interval *front, size_t count, double *c,
                                    struct br_error *err)
{
    double part[2] = {q->spectral->end[e], 0};
    enum br_status status = BR_OK;
    memset(c, 0, (q->spectral->terms[e] + q->extra) * sizeof *c);
    for (size_t i = 0; i <= count && !status; i++) {
        part[1] = i < count ? front[i].high : q->spectral->end[e + 1];
        if (part[1] > part[0])
            status = add_part(q, f, t, e, start, part, c, err);
        part[0] = part[1];
    }
    return status;
}

enum br_status br_quadrature_project(const struct br_quadrature *q, const struct br_function *f,
                                     double t, const struct br_breaks *fronts, double *c,
                                     struct br_error *err)
{
    const struct br_spectral_elements *p = q->spectral;
    const size_t count = fronts ? fronts->count : 0;
    enum br_status status = BR_OK;
    br_function_evaluate(f, q->count, q->x, t, q->value);
    for (size_t e = 0, start = 0, i = 0; e < p->count && !status; start += q->points[e++]) {
        const size_t terms = p->terms[e] + q->extra;
        double *out = &c[br_spectral_at(p, e, q->extra)], *value = &q->value[start];
        while (i < count && fronts->at[i].high <= p->end[e])
            i++;
        const size_t first = i;
        while (i < count && fronts->at[i].high < p->end[e + 1])
            i++;
        if (i > first) {
            status = project_parts(q, f, t, e, start, &fronts->at[first], i - first, out, err);
            continue;
        }
        const double root = sqrt(br_spectral_width(p, e));
        for (size_t k = 0; k < q->points[e]; k++)
            value[k] *= q->weight[start + k];
        br_combine(1, q->points[e], value, terms, q->table[e], out);
        for (size_t k = 0; k < terms; k++)
            out[k] *= root;
    }
    return status;
}

/* On each element, less its value at the left end: f(b) p_k(1) - integral of f p_k', where p_k' is
 * the sum of 2 p_k(1) p_j(1) p_j over j = k - 1, k - 3, ... */
enum br_status br_quadrature_project_slope(const struct br_quadrature *q,
                                           const struct br_function *f, double *c,
                                           struct br_error *err)
{
    const struct br_spectral_elements *p = q->spectral;
    double *all = br_allocate(br_spectral_at(p, p->count, q->extra), sizeof *all);
    if (!all)
        return br_no_memory(err, "a quadrature");
    const enum br_status status = br_quadrature_project(q, f, 0, NULL, all, err);
    for (size_t e = 0; e < p->count && !status; e++) {
        const double root = sqrt(br_spectral_width(p, e)),
                     *here = &all[br_spectral_at(p, e, q->extra)];
        double end[2], sum[2], *out = &c[br_spectral_at(p, e, 0)];
        br_function_evaluate(f, 2, &p->end[e], 0, end);
        sum[0] = -end[0];
        sum[1] = 0;
        for (size_t k = 0; k < p->terms[e]; k++) {
            const double one = sqrt(2 * (double)k + 1); /* p_k(1) */
            out[k] = one * (end[1] - end[0] - 2 * sum[(k + 1) % 2]) / root;
            sum[k % 2] += one * here[k] / root;
        }
    }
    free(all);
    return status;
}
