/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mode of frequency om has z = om k (-xi +- i sqrt(1 - xi^2)) with xi = c om / (2 a), and grows
 * with bdf3 where z lies in one of the two lobes that
 *     z = 11/6 - 3 e + 3/2 e^2 - 1/3 e^3,    e = exp(-i theta),
 * bounds to the left of the imaginary axis. Along it -Re z / |z|^2, which is c / (2 a k), is at
 * most |z|^2 / 4 and at most 0.0710, and |z| at most 1.937 (Hairer and Wanner, Solving Ordinary
 * Differential Equations II, V.1, figure 1.1). */
#include "solver/damping.h"

#include <math.h>

static const double lobe_ends = 1.937, lobe_depth = 0.0710;

/* The least that the elements have of a mode's stiffness where a spring at the tip has the rest: a
 * rod's lowest mode with c_H L / a of about 2 has 0.64. */
static const double beside_spring = 0.6;

/* The squares of the lowest and an upper bound of the highest frequency, 1/s^2; those of a free
 * element bound the mesh's. */
static void frequencies(const struct br_field *f, double square[2])
{
    const double h = f->h, rod = br_field_is_quadratic(f) ? 60 : 12;
    const double highest = f->kind == BR_AXIAL ? rod / (h * h) : 8400 / (h * h * h * h);
    square[0] = f->stiffness / f->density * br_field_lowest_mode(f);
    square[1] = f->stiffness / f->density * highest;
}

/* With all of the lobe in reach, c / (2 a k) >= depth; with z to |om k| alone, c / (2 a k) >=
 * (om k)^2 / 4, so that k^3 <= 2 c / (a om^2). */
double br_damping_largest_step(const struct br_field *f, bool spring)
{
    double square[2];
    if (f->density == 0 || f->stiffness == 0)
        return INFINITY;
    frequencies(f, square);
    const double damping = (spring ? beside_spring : 1) * f->viscosity / f->stiffness;
    return fmax(damping / (2 * lobe_depth), cbrt(2 * damping / square[1]));
}

/* Beyond the lobes even the slowest mode is damped by the scheme; a spring only makes it faster. */
static bool beyond_lobes(const struct br_field *f)
{
    double square[2];
    if (f->density == 0 || f->stiffness == 0)
        return true;
    frequencies(f, square);
    return f->k * sqrt(square[0]) > lobe_ends;
}

enum br_status br_damping_check(const struct br_method *method, const struct br_scene *scene,
                                size_t n, double k, struct br_error *err)
{
    for (int kind = BR_AXIAL; kind <= BR_BENDING && method->scheme->needs_damping; kind++) {
        const bool axial = kind == BR_AXIAL;
        struct br_field field = br_field_of_scene(scene, (enum br_field_kind)kind, n, k);
        field.degree = method->axial_degree;
        const double most = br_damping_largest_step(&field, axial && scene->contact.modelled);
        if (!(axial ? scene->axial.modelled : scene->bending.modelled) || k <= most ||
            beyond_lobes(&field))
            continue;
        return br_fail(err, BR_BAD_INPUT,
                       "scheme %s with k = %g s and a viscosity of %g in %s: it lets vibration of "
                       "so little damping grow, expected k of at most %g s, or another scheme",
                       method->scheme->name, k, field.viscosity, axial ? "axial" : "bending", most);
    }
    return BR_OK;
}
