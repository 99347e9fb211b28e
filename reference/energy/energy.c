/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/energy/energy.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "reference/textbook.h"

typedef long double real;

/* ---- products of two sets of an element's nodal values ---- */

/* The middle of a quadratic element, for (u, b) of its nodes. */
static real middle(const real *v)
{
    return (v[0] + v[2]) / 2 - v[3] / 4;
}

/* A quadratic rod in Legendre polynomials: v = mean + slope P_1 + curve P_2. */
static void legendre(const real *v, real out[3])
{
    const real m = middle(v);
    out[0] = (v[0] + 4 * m + v[2]) / 6;
    out[1] = (v[2] - v[0]) / 2;
    out[2] = (v[0] - 2 * m + v[2]) / 3;
}

/* a'Mb over rho h. */
static real mass_form(const struct br_field *field, const real *a, const real *b)
{
    if (br_field_is_quadratic(field)) {
        real p[3], q[3];
        legendre(a, p);
        legendre(b, q);
        return p[0] * q[0] + p[1] * q[1] / 3 + p[2] * q[2] / 5;
    }
    if (field->kind == BR_AXIAL)
        return (2 * (a[0] * b[0] + a[1] * b[1]) + a[0] * b[1] + a[1] * b[0]) / 6;
    real sum = 0;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            sum += (real)br_beam_mass[i][j] * a[i] * b[j];
    return sum / 420;
}

/* h u_x at the beginning, the middle and the end of a quadratic element. */
static void slopes(const real *w, real out[3])
{
    const real m = 4 * (middle(w) - w[0]), chord = w[2] - w[0];
    out[0] = m - chord;
    out[1] = chord;
    out[2] = 3 * chord - m;
}

/* h int u_x y_x, or h^3 int w_xx y_xx: the rigid motion of the first node is taken off first. With
 * the deflection d and the rotation r that remain, the latter is 12 dd - 6 (dr + rd) + 4 rr. Of a
 * quadratic rod Simpson's rule has the former. */
static real stiffness_form(const struct br_field *field, const real *a, const real *b)
{
    if (br_field_is_quadratic(field)) {
        real p[3], q[3];
        slopes(a, p);
        slopes(b, q);
        return (p[0] * q[0] + 4 * p[1] * q[1] + p[2] * q[2]) / 6;
    }
    if (field->kind == BR_AXIAL)
        return (a[1] - a[0]) * (b[1] - b[0]);
    const real d = a[2] - a[0] - a[1], r = a[3] - a[1];
    const real e = b[2] - b[0] - b[1], s = b[3] - b[1];
    return 12 * d * e - 6 * (d * s + r * e) + 4 * r * s;
}

typedef real (*form)(const struct br_field *field, const real *a, const real *b);

/* The sum over the elements. */
static real sum_form(form f, const struct br_field *field, const double *a, const double *b)
{
    const size_t d = br_field_unknowns(field);
    real sum = 0;
    for (size_t e = 0; e < field->n; e++) {
        real v[4], w[4];
        for (size_t i = 0; i < 2 * d; i++) {
            v[i] = a[e * d + i];
            w[i] = b[e * d + i];
        }
        sum += f(field, v, w);
    }
    return sum;
}

real br_mass_product(const struct br_field *f, const double *a, const double *b)
{
    return (real)f->density * (real)f->h * sum_form(mass_form, f, a, b);
}

real br_bend_product(const struct br_field *f, const double *a, const double *b)
{
    const real h = (real)f->h;
    return sum_form(stiffness_form, f, a, b) / (f->kind == BR_AXIAL ? h : h * h * h);
}

/* ---- of a state ---- */

double br_energy_kinetic(const struct br_field *field, const double *velocity)
{
    return (double)(br_mass_product(field, velocity, velocity) / 2);
}

double br_energy_stored(const struct br_field *field, const double *displacement)
{
    return (double)((real)field->stiffness * br_bend_product(field, displacement, displacement) /
                    2);
}

struct br_field_energy br_energy_of_field(const struct br_field *f,
                                          const struct br_contact *contact,
                                          const double *displacement, const double *velocity)
{
    struct br_field_energy e = {
        .kinetic = br_mass_product(f, velocity, velocity) / 2,
        .stored = (real)f->stiffness * br_bend_product(f, displacement, displacement) / 2,
    };
    if (f->kind != BR_AXIAL || !contact->modelled)
        return e;
    const real depth = (real)displacement[f->n * br_field_unknowns(f)] - contact->gap;
    e.contact = depth <= 0 ? 0 : contact->stiffness * depth * depth / 2;
    return e;
}

enum br_status br_energy_sample(const struct br_march *march, const struct br_scene *scene,
                                struct br_energy *energy, struct br_error *err)
{
    *energy = (struct br_energy){0};
    const size_t size = 2 * (br_march_field(march, BR_AXIAL)->n + 1); /* of either field at most */
    double *y = br_allocate(2 * size, sizeof *y);
    if (!y)
        return br_no_memory(err, "the energies");
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct br_field *f = br_march_field(march, (enum br_field_kind)kind);
        if (!br_march_models(march, (enum br_field_kind)kind))
            continue;
        br_march_get(march, (enum br_field_kind)kind, y, y + size);
        const struct br_field_energy e = br_energy_of_field(f, &scene->contact, y, y + size);
        energy->kinetic[kind] = (double)e.kinetic;
        energy->stored[kind] = (double)e.stored;
        energy->contact += (double)e.contact;
    }
    free(y);
    return BR_OK;
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
        {w->friction, 1},          {w->scheme[0], 1},
        {w->scheme[1], 1},         {w->scheme_contact, 1},
    };
    for (size_t i = 0; i < sizeof terms / sizeof *terms; i++) {
        error += (real)terms[i][0] * (real)terms[i][1];
        size += fabsl((real)terms[i][0]);
    }
    return size == 0 ? 0 : (double)(error / size);
}

double br_energy_added(const struct br_work *w, enum br_field_kind kind)
{
    const double lost = w->scheme[kind] + (kind == BR_AXIAL ? w->scheme_contact : 0);
    return lost < -w->noise[kind] ? -lost : 0;
}

double br_energy_put_in(const struct br_energy *start, const struct br_work *w,
                        enum br_field_kind kind)
{
    const double first =
        start->kinetic[kind] + start->stored[kind] + (kind == BR_AXIAL ? start->contact : 0);
    return first + fmax(w->loads[kind], 0);
}

const double br_energy_useless = 1e-3;

double br_energy_limit(size_t n, double round_off)
{
    const double nodes = (double)n + 1, noise = 64 * DBL_EPSILON * nodes * nodes;
    return fmin(64 * DBL_EPSILON * nodes + 16 * round_off + noise * noise, br_energy_useless);
}
