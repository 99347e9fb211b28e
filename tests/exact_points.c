/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/exact_points.h"

#include <gsl/gsl_sf_legendre.h>
#include <math.h>

#include "reference/exact/inside.h"

/* The element that contains x, m; where two meet the left one. */
static size_t element_of(const struct br_spectral_elements *p, double x)
{
    size_t e = 0;
    while (e + 1 < p->count && p->end[e + 1] < x)
        e++;
    return e;
}

/* The sum of c_k p_k(xi), or of c_k p_k'(xi), k < count. p, dp: workspace. */
static double sum_of(size_t count, const double *c, double xi, bool derived, double *p, double *dp)
{
    const double inside = fmin(fmax(2 * xi - 1, -1), 1); /* GSL refuses a last bit beyond */
    double sum = 0;
    gsl_sf_legendre_Pl_deriv_array((int)count - 1, inside, p, dp);
    for (size_t k = 0; k < count; k++)
        sum += c[k] * sqrt(2 * (double)k + 1) * (derived ? 2 * dp[k] : p[k]);
    return sum;
}

enum br_status exact_points(const struct br_exact *exact, const struct br_exact_state *state,
                            const struct br_exact_quantity *quantity, size_t count, const double *x,
                            double *value, struct br_error *err)
{
    const struct br_oscillators *field = exact->solution->field[quantity->field];
    const struct br_spectral_elements *spectral = &field->modes.spectral;
    const size_t room = br_modes_length(&field->modes, 0), degree = field->modes.degree;
    const bool derived = quantity->order > degree; /* the series is derived once more */
    const size_t order = derived ? degree : quantity->order, extra = degree - order;
    double *c = br_allocate(3 * room, sizeof *c);
    if (!c)
        return br_no_memory(err, "a series");
    br_modes_expand(&field->modes, order, state->mode[quantity->field][quantity->velocity], c);
    for (size_t i = 0; i < count; i++) {
        const size_t e = element_of(spectral, x[i]), terms = spectral->terms[e] + extra;
        const double h = br_spectral_width(spectral, e), xi = (x[i] - spectral->end[e]) / h;
        value[i] = sum_of(terms, &c[br_spectral_at(spectral, e, extra)], xi / field->length,
                          derived, c + room, c + 2 * room) /
                   sqrt(h) / (derived ? h : 1) * pow(field->length, -(double)quantity->order);
    }
    free(c);
    return BR_OK;
}
