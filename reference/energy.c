/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/energy_forms.h"

#include <math.h>

/* ---- quadratic forms of one element ---- */

/* The middle of a quadratic element, for (u, b) of its nodes. */
static real middle(const real *v)
{
    return (v[0] + v[2]) / 2 - v[3] / 4;
}

/* v'Mv over rho h. Rod: 1/6 [2 1; 1 2]; quadratic, for its ends and its middle: Simpson's rule is
 * short of it by the square of its P_2 alone. Beam, for (w, h w_x): 1/420 [...]. */
static real mass_form(const struct br_field *field, const real *v)
{
    if (br_field_is_quadratic(field)) {
        const real m = middle(v), mean = (v[0] + 4 * m + v[2]) / 6, slope = (v[2] - v[0]) / 2,
                   curve = (v[0] - 2 * m + v[2]) / 3;
        return mean * mean + slope * slope / 3 + curve * curve / 5;
    }
    if (field->kind == BR_AXIAL)
        return (v[0] * v[0] + v[0] * v[1] + v[1] * v[1]) / 3;
    static const int beam[4][4] = {
        {156, 22, 54, -13}, {22, 4, 13, -3}, {54, 13, 156, -22}, {-13, -3, -22, 4}};
    real sum = 0;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            sum += (real)beam[i][j] * v[i] * v[j];
    return sum / 420;
}

/* h int u_x^2, or h^3 int w_xx^2: the rigid motion of the first node is taken off first. With the
 * deflection d and the rotation r that remain, the latter is 12 d^2 - 12 d r + 4 r^2. Of a
 * quadratic rod Simpson's rule has the former, from h u_x = -3 u0 + 4 um - u1 and so on. */
static real stiffness_form(const struct br_field *field, const real *w)
{
    if (br_field_is_quadratic(field)) {
        const real m = 4 * (middle(w) - w[0]), chord = w[2] - w[0];
        const real begin = m - chord, end = 3 * chord - m;
        return (begin * begin + 4 * chord * chord + end * end) / 6;
    }
    if (field->kind == BR_AXIAL)
        return (w[1] - w[0]) * (w[1] - w[0]);
    const real d = w[2] - w[0] - w[1], r = w[3] - w[1];
    return 12 * d * d - 12 * d * r + 4 * r * r;
}

typedef real (*form)(const struct br_field *field, const real *values);

/* The sum over the elements of the form of a - b; b NULL: of a. */
static real sum_form(form f, const struct br_field *field, const double *a, const double *b)
{
    const size_t d = br_field_unknowns(field);
    real sum = 0;
    for (size_t e = 0; e < field->n; e++) {
        real v[4];
        for (size_t i = 0; i < 2 * d; i++)
            v[i] = (real)a[e * d + i] - (b ? (real)b[e * d + i] : 0);
        sum += f(field, v);
    }
    return sum;
}

real br_mass_square(const struct br_field *f, const double *a, const double *b)
{
    return (real)f->density * (real)f->h * sum_form(mass_form, f, a, b);
}

real br_bend_square(const struct br_field *f, const double *a, const double *b)
{
    const real h = (real)f->h;
    return sum_form(stiffness_form, f, a, b) / (f->kind == BR_AXIAL ? h : h * h * h);
}

double br_energy_kinetic(const struct br_field *field, const double *velocity)
{
    return (double)(br_mass_square(field, velocity, NULL) / 2);
}

double br_energy_stored(const struct br_field *field, const double *displacement)
{
    return (double)((real)field->stiffness * br_bend_square(field, displacement, NULL) / 2);
}

/* ---- sums of terms ---- */

double br_energy_total(const struct br_energy *e)
{
    return e->kinetic[0] + e->kinetic[1] + e->stored[0] + e->stored[1] + e->contact;
}

double br_energy_imbalance(const struct br_energy *start, const struct br_energy *now,
                           const struct br_work *w)
{
    real error = 0, size = 0;
    const double terms[][2] = {
        {br_energy_total(now), 1}, {br_energy_total(start), -1},
        {w->loads[0], -1},         {w->loads[1], -1},
        {w->viscous[0], 1},        {w->viscous[1], 1},
        {w->friction, 1},          {w->scheme, 1},
        {w->scheme_contact, 1},
    };
    for (size_t i = 0; i < sizeof terms / sizeof *terms; i++) {
        error += (real)terms[i][0] * (real)terms[i][1];
        size += fabsl((real)terms[i][0]);
    }
    return size == 0 ? 0 : (double)(error / size);
}
