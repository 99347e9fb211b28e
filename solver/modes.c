/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/modes.h"

#include <math.h>

size_t br_mode_count(enum br_field_kind kind, enum br_measure measure)
{
    const size_t derived = measure == BR_STRAIN_RATE;
    return kind == BR_AXIAL ? 2 - derived : 4 - 2 * derived;
}

size_t br_measure_size(enum br_field_kind kind, enum br_measure measure, size_t n)
{
    return measure == BR_TIP ? 1 : n * br_mode_count(kind, measure);
}

static void axial_modes(double root, const double *nodal, double modes[2])
{
    modes[0] = root * ((nodal[0] + nodal[1]) / 2);
    modes[1] = root * ((nodal[1] - nodal[0]) * (0.5 / sqrt(3)));
}

/* The two highest from the curvature: P_2'' = 12 sqrt(5), P_3'' = 60 sqrt(7) (2x - 1). */
static void bending_modes(double root, const double *nodal, double modes[4])
{
    double curvature[2];
    br_curvature(nodal, curvature);
    const double w0 = nodal[0], s0 = nodal[1], w1 = nodal[2], s1 = nodal[3];
    modes[0] = root * ((w0 + w1) / 2 + (s0 - s1) * (1.0 / 12));
    modes[1] = root * ((w1 - w0) * (sqrt(3) / 5) - (s0 + s1) * (sqrt(3) / 60));
    modes[2] = root * (curvature[0] * (1 / (12 * sqrt(5))));
    modes[3] = root * (curvature[1] * (1 / (60 * sqrt(7))));
}

void br_modes(const struct br_field *field, const double *nodal, double *modes)
{
    const double root = sqrt(field->h);
    for (size_t e = 0; e < field->n; e++)
        if (field->kind == BR_AXIAL)
            axial_modes(root, nodal + e, modes + 2 * e);
        else
            bending_modes(root, nodal + 2 * e, modes + 4 * e);
}

/* u_x = elongation/h;  w_xx = (kappa0 + kappa1 (2 xi - 1))/h^2, P_1 = sqrt(3) (2 xi - 1). */
void br_strain_modes(const struct br_field *field, const double *strain, double *modes)
{
    const double root = sqrt(field->h), h = field->h;
    for (size_t e = 0; e < field->n; e++)
        if (field->kind == BR_AXIAL) {
            modes[e] = root / h * strain[e];
        } else {
            modes[2 * e] = root / (h * h) * strain[2 * e];
            modes[2 * e + 1] = root / (h * h) * (strain[2 * e + 1] * (1 / sqrt(3)));
        }
}
