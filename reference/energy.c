/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/energy.h"

#include <math.h>
#include <string.h>

typedef long double real;

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

/* |a - b|_M^2 and |a - b|^2 of the stiffness without its coefficient. */
static real mass_square(const struct br_field *f, const double *a, const double *b)
{
    return (real)f->density * (real)f->h * sum_form(mass_form, f, a, b);
}

static real bend_square(const struct br_field *f, const double *a, const double *b)
{
    const real h = (real)f->h;
    return sum_form(stiffness_form, f, a, b) / (f->kind == BR_AXIAL ? h : h * h * h);
}

double br_energy_kinetic(const struct br_field *field, const double *velocity)
{
    return (double)(mass_square(field, velocity, NULL) / 2);
}

double br_energy_stored(const struct br_field *field, const double *displacement)
{
    return (double)((real)field->stiffness * bend_square(field, displacement, NULL) / 2);
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

/* ---- the meter ---- */

struct br_energy_meter {
    const struct br_march *march;
    const struct br_scene *scene;
    double *before[2][2], *after[2][2]; /* by br_field_kind: displacement and velocity */
    double *load[2];
    double *memory;
    struct br_energy start, now;
    struct work {
        real loads[2], viscous[2], friction, scheme, scheme_contact;
    } work;
};

/* Where the tip's u is. */
static size_t axial_tip(const struct br_energy_meter *m)
{
    const struct br_field *field = br_march_field(m->march, BR_AXIAL);
    return field->n * br_field_unknowns(field);
}

static void look(struct br_energy_meter *m)
{
    m->now = (struct br_energy){0};
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct br_field *field = br_march_field(m->march, (enum br_field_kind)kind);
        if (!br_march_models(m->march, (enum br_field_kind)kind))
            continue;
        br_march_get(m->march, (enum br_field_kind)kind, m->after[kind][0], m->after[kind][1]);
        m->now.kinetic[kind] = br_energy_kinetic(field, m->after[kind][1]);
        m->now.stored[kind] = br_energy_stored(field, m->after[kind][0]);
    }
    const struct br_contact *c = &m->scene->contact;
    if (!c->modelled)
        return;
    const double depth = m->after[BR_AXIAL][0][axial_tip(m)] - c->gap;
    m->now.contact = depth <= 0 ? 0 : c->stiffness * depth * depth / 2;
}

enum br_status br_energy_meter_create(struct br_energy_meter **out, const struct br_march *march,
                                      const struct br_scene *scene, struct br_error *err)
{
    *out = NULL;
    const size_t sizes[2] = {br_field_size(br_march_field(march, BR_AXIAL)),
                             br_field_size(br_march_field(march, BR_BENDING))};
    struct br_energy_meter *m = br_allocate(1, sizeof *m);
    double *memory = br_allocate(5 * (sizes[0] + sizes[1]), sizeof *memory);
    if (!m || !memory) {
        free(m);
        free(memory);
        return br_no_memory(err, "the energies");
    }
    m->march = march;
    m->scene = scene;
    m->memory = memory;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        double **const arrays[] = {&m->before[kind][0], &m->before[kind][1], &m->after[kind][0],
                                   &m->after[kind][1], &m->load[kind]};
        for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++) {
            *arrays[a] = memory;
            memory += sizes[kind];
        }
    }
    look(m);
    m->start = m->now;
    *out = m;
    return BR_OK;
}

void br_energy_meter_free(struct br_energy_meter *m)
{
    if (!m)
        return;
    free(m->memory);
    free(m);
}

static void add_field(struct br_energy_meter *m, enum br_field_kind kind)
{
    const struct br_field *f = br_march_field(m->march, kind);
    const double *velocity = m->after[kind][1];
    br_march_load(m->march, kind, m->load[kind]);
    real power = 0;
    for (size_t i = 0; i < br_field_size(f); i++)
        power += (real)m->load[kind][i] * velocity[i];
    m->work.loads[kind] += (real)f->k * power;
    m->work.viscous[kind] += (real)f->k * (real)f->viscosity * bend_square(f, velocity, NULL);
    m->work.scheme +=
        mass_square(f, velocity, m->before[kind][1]) / 2 +
        (real)f->stiffness * bend_square(f, m->after[kind][0], m->before[kind][0]) / 2;
}

void br_energy_meter_step(struct br_energy_meter *m)
{
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        for (int i = 0; i < 2; i++) {
            double *const swap = m->before[kind][i];
            m->before[kind][i] = m->after[kind][i];
            m->after[kind][i] = swap;
        }
    const double potential = m->now.contact;
    look(m);
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        if (br_march_models(m->march, (enum br_field_kind)kind))
            add_field(m, (enum br_field_kind)kind);
    const struct br_tip *tip = br_march_tip(m->march);
    const size_t n = br_march_field(m->march, BR_AXIAL)->n;
    const real k = (real)br_march_field(m->march, BR_AXIAL)->k;
    m->work.friction += k * (real)tip->friction_force * (real)m->after[BR_BENDING][1][2 * n];
    const size_t tip_of_rod = axial_tip(m);
    const real way = (real)m->after[BR_AXIAL][0][tip_of_rod] - m->before[BR_AXIAL][0][tip_of_rod];
    m->work.scheme_contact +=
        (real)tip->contact_force * way - ((real)m->now.contact - (real)potential);
}

void br_energy_meter_read(const struct br_energy_meter *m, struct br_energy *start,
                          struct br_energy *now, struct br_work *work)
{
    *start = m->start;
    *now = m->now;
    *work = (struct br_work){
        .loads = {(double)m->work.loads[0], (double)m->work.loads[1]},
        .viscous = {(double)m->work.viscous[0], (double)m->work.viscous[1]},
        .friction = (double)m->work.friction,
        .scheme = (double)m->work.scheme,
        .scheme_contact = (double)m->work.scheme_contact,
    };
}
