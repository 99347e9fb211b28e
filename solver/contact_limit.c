/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/contact_limit.h"

#include <math.h>

/* An element without its bubble: [d o; o d] works on its two nodes. What is needed, over N/m, is
 * d + o, which is inertia alone, and d - o. Neither subtracts anything. */
struct element {
    double sum, difference;
};

/* m = s^2 rho h, r = (c s + a)/h, N/m. */
static struct element element_of(const struct br_field *field, double m, double r)
{
    struct element e = {m / 2, 2 * r + m / 6};
    if (br_field_is_quadratic(field)) /* the bubble has r/3 + m/30, and couples with -m/12 */
        e.sum = m * ((r / 6 + m / 360) / (r / 3 + m / 30));
    return e;
}

/* A chain of n such elements, clamped at one end: with tanh^2(theta/2) = (d + o)/(d - o),
 * displacements are sinh(i theta), and 1/G = (d - o) tanh(theta/2) coth(n theta). Where d + o
 * exceeds d - o neighbours alternate, and the ratio's inverse stands for it. */
double br_tip_flexibility(const struct br_field *field, double s)
{
    const double n = (double)field->n;
    const double m = s * s * field->density * field->h;
    const double r = (field->viscosity * s + field->stiffness) / field->h;
    const struct element e = element_of(field, m, r);
    if (!(e.sum > 0)) /* no inertia: springs in series */
        return 2 * n / e.difference;
    if (!isfinite(e.sum) || !isfinite(e.difference))
        return 0;
    const double half = sqrt(e.sum / e.difference);
    return tanh(2 * n * atanh(half < 1 ? half : 1 / half)) / (e.difference * half);
}

double br_contact_limit_stiffness(const struct br_field *field)
{
    return 1 / br_tip_flexibility(field, 2 / field->k);
}

double br_contact_limit_bouncing(const struct br_field *field)
{
    return (field->stiffness + 2 * field->viscosity / field->k) / ((double)field->n * field->h);
}

bool br_contact_grows(const struct br_field *field, double stiffness)
{
    return !(stiffness * br_tip_flexibility(field, 2 / field->k) <= 1 + 1e-12);
}

/* ---- roots ---- */

/* A value that is not positive below a root and positive above it. */
typedef double (*rising)(const struct br_field *field, double stiffness, double x);

/* The root between low and high, both positive, to the last digits; the end below it. Halving needs
 * no memory and cannot fail. */
static double root_of(rising f, const struct br_field *field, double stiffness, double low,
                      double high)
{
    for (int i = 0; i < 200; i++) {
        const double middle = sqrt(low) * sqrt(high);
        if (!(middle > low && middle < high))
            break;
        if (f(field, stiffness, middle) > 0)
            high = middle;
        else
            low = middle;
    }
    return low;
}

static double beyond_step(const struct br_field *field, double stiffness, double k)
{
    return stiffness * br_tip_flexibility(field, 2 / k) - 1;
}

double br_contact_limit_step(const struct br_field *field, double stiffness)
{
    const double least = 1e-150, most = 1e150;
    if (!(beyond_step(field, stiffness, most) > 0))
        return INFINITY;
    if (beyond_step(field, stiffness, least) > 0)
        return 0;
    return root_of(beyond_step, field, stiffness, least, most);
}

/* z = -r: r - c_H G((1 + 1/r)/k), from where it is negative, r = 1, to where it is not. */
static double beyond_growth(const struct br_field *field, double stiffness, double r)
{
    return r - stiffness * br_tip_flexibility(field, (1 + 1 / r) / field->k);
}

double br_contact_growth(const struct br_field *field, double stiffness)
{
    if (!br_contact_grows(field, stiffness))
        return 1;
    return root_of(beyond_growth, field, stiffness, 1,
                   stiffness * br_tip_flexibility(field, 1 / field->k));
}
