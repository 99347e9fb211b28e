/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/legendre.h"

#include <assert.h>
#include <gsl/gsl_sf_legendre.h>
#include <math.h>

/* GSL refuses arguments outside [-1, 1] by a rounding error. */
static double to_gsl(double xi)
{
    return fmin(fmax(2 * xi - 1, -1), 1);
}

static double norm(size_t k)
{
    return sqrt(2.0 * (double)k + 1);
}

void br_legendre(size_t count, double xi, double *p)
{
    if (!count)
        return;
    gsl_sf_legendre_Pl_array((int)count - 1, to_gsl(xi), p);
    for (size_t k = 0; k < count; k++)
        p[k] *= norm(k);
}

void br_legendre_derivative(size_t count, double xi, double *p, double *dp)
{
    if (!count)
        return;
    gsl_sf_legendre_Pl_deriv_array((int)count - 1, to_gsl(xi), p, dp);
    for (size_t k = 0; k < count; k++) {
        p[k] *= norm(k);
        dp[k] *= 2 * norm(k); /* d(2 xi - 1) = 2 d xi */
    }
}

double br_legendre_coupling(size_t k)
{
    return 0.5 / sqrt(4.0 * (double)k * (double)k - 1);
}

void br_legendre_integral(size_t count, double xi, double *q)
{
    assert(count <= BR_MOST_INTEGRALS);
    double p[BR_MOST_INTEGRALS + 1];
    br_legendre(count + 1, xi, p);
    for (size_t k = 1; k < count; k++)
        q[k] = br_legendre_coupling(k + 1) * p[k + 1] - br_legendre_coupling(k) * p[k - 1];
    if (count)
        q[0] = xi;
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
