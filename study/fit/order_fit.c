/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/fit/order_fit.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>
#include <math.h>

struct regression {
    double slope, deviation;
};

/* log((1 - ratio^p) / p), which is smooth at p = 0: what is lost beside z^p. */
static double log_loss(double ratio, double p)
{
    if (ratio == 0)
        return 0;
    const double decay = p * log(ratio);
    return fabs(decay) < 1e-8 ? log(-log(ratio)) : log(-expm1(decay) / p);
}

/* The regression for given losses, without the point `left_out` (count: with all). x, y: room for
 * count values each. */
static struct regression regress(const struct br_order_point *point, size_t count, size_t left_out,
                                 double p, double *x, double *y)
{
    size_t used = 0;
    for (size_t i = 0; i < count; i++) {
        if (i == left_out)
            continue;
        x[used] = log(point[i].z);
        y[used++] = log(point[i].error) - log_loss(point[i].z_against / point[i].z, p);
    }
    double constant, slope, cov00, cov01, cov11, sum;
    gsl_fit_linear(x, 1, y, 1, used, &constant, &slope, &cov00, &cov01, &cov11, &sum);
    return (struct regression){slope, sqrt(cov11 < 0 ? 0 : cov11)}; /* NaN stays */
}

/* The losses depend on p, but hardly: where all ratios are the same, not at all. */
static struct regression solve(const struct br_order_point *point, size_t count, size_t left_out,
                               double *x, double *y)
{
    struct regression r = regress(point, count, left_out, 1, x, y);
    for (int i = 0; i < 1000; i++) {
        const double before = r.slope;
        r = regress(point, count, left_out, before, x, y);
        if (fabs(r.slope - before) <= 1e-12 * fmax(1, fabs(before)))
            return r;
    }
    return (struct regression){NAN, NAN};
}

/* The standard deviation of the slope, from what leaving out one point does to it. */
static double jackknife(const struct br_order_point *point, size_t count, double *x, double *y)
{
    double sum = 0, squares = 0;
    const double all = solve(point, count, count, x, y).slope, n = (double)count;
    for (size_t i = 0; i < count; i++) {
        const double shift = solve(point, count, i, x, y).slope - all;
        sum += shift;
        squares += shift * shift;
    }
    const double spread = squares - sum * sum / n;
    return sqrt((n - 1) / n * (spread < 0 ? 0 : spread)); /* NaN stays */
}

enum br_status br_order_fit(const struct br_order_point *point, size_t count,
                            struct br_estimate *order, struct br_error *err)
{
    *order = (struct br_estimate){NAN, NAN, NAN};
    for (size_t i = 0; i < count; i++)
        if (!(point[i].error > 0 && isfinite(point[i].error)))
            return BR_OK;
    if (count < 3)
        return BR_OK;
    double *x = br_allocate(2 * count, sizeof *x);
    if (!x)
        return br_no_memory(err, "the fit");
    const struct regression r = solve(point, count, count, x, x + count);
    const double n = (double)count;
    const double noise = gsl_cdf_tdist_Pinv(0.975, n - 2) * r.deviation;
    const double drift = gsl_cdf_tdist_Pinv(0.975, n - 1) * jackknife(point, count, x, x + count);
    free(x);
    const double half = noise + drift >= 0 ? fmax(noise, drift) : NAN;
    *order = (struct br_estimate){r.slope, r.slope - half, r.slope + half};
    return BR_OK;
}
