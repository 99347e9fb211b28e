/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/assembled.h"

enum { MOST = 4 }; /* unknowns of an element */

/* Element stiffness for unit material: B'B / h, or B' diag(1, 1/3) B / h^3. */
static double stiffness_entry(const struct br_field *f, size_t a, size_t b)
{
    if (f->kind == BR_AXIAL)
        return (a == b ? 1 : -1) / f->h;
    static const double first[MOST] = {0, -1, 0, 1}, second[MOST] = {6, 3, -6, 3};
    return (first[a] * first[b] + second[a] * second[b] / 3) / (f->h * f->h * f->h);
}

/* Of the element's M/k + C + kK. */
static double entry(const struct br_field *f, size_t a, size_t b)
{
    const double mass = f->kind == BR_AXIAL ? br_axial_mass[a][b] : br_bending_mass[a][b];
    const double stiff = f->viscosity + f->k * f->stiffness;
    return f->density * f->h * mass / f->k + stiff * stiffness_entry(f, a, b);
}

void br_band_assemble(const struct br_field *f, struct br_band *m)
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

/* Each element's right half is carried on to the next node. */
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

void br_add_elements(const struct br_field *f, double mass, const double *v, double stiffness,
                     const double *w, double *out)
{
    if (f->kind == BR_AXIAL)
        add_axial(f, mass * f->h, v, stiffness, w, out);
    else
        add_bending(f, mass * f->h, v, stiffness, w, out);
}
