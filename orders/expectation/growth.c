/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Errors that fall, then grow: C z^p + D z^-q, as of a scheme that is not stable. Round-off grows,
 * too, but scatters: no such law describes it as well as one power describes the coarse rows. */
#include <gsl/gsl_cdf.h>
#include <math.h>

#include "orders/expectation/case.h"

/* ---- the law ---- */

struct law {
    double p, q, squares; /* of what is left of the errors, over themselves */
};

/* An error of this order, without its constant. */
static double share(const struct br_point *p, double order)
{
    return fabs(pow(p->z, order) - (p->z_against > 0 ? pow(p->z_against, order) : 0));
}

/* The best C and D, both positive; else there is no such law. */
static double squares_of(const struct br_case *c, double p, double q)
{
    double uu = 0, uv = 0, vv = 0, u = 0, v = 0;
    for (size_t i = 0; i < c->points; i++) {
        const double falls = share(&c->point[i], p) / c->point[i].error,
                     grows = share(&c->point[i], -q) / c->point[i].error;
        uu += falls * falls, uv += falls * grows, vv += grows * grows;
        u += falls, v += grows;
    }
    const double det = uu * vv - uv * uv, falls = (u * vv - v * uv) / det,
                 grows = (v * uu - u * uv) / det;
    return falls > 0 && grows > 0 ? (double)c->points - falls * u - grows * v : INFINITY;
}

/* By steps along p and q that are halved where none is better. */
static struct law find_law(const struct br_case *c, double p, double q)
{
    static const double first = 0.5, last = 1e-5;
    struct law best = {p, q, squares_of(c, p, q)};
    for (double step = first; step > last;) {
        const struct law before = best;
        for (int i = 0; i < 4; i++) {
            struct law next = {before.p + (i < 2 ? step * (2 * i - 1) : 0),
                               before.q + (i < 2 ? 0 : step * (2 * i - 5)), 0};
            next.squares = squares_of(c, next.p, next.q);
            best = next.squares < best.squares ? next : best;
        }
        step /= best.squares < before.squares ? 1 : 2;
    }
    return best;
}

/* ---- the rows before ---- */

double br_squares_of_power(const struct br_case *c, size_t rows)
{
    double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    for (size_t i = 0; i < rows; i++) {
        const double log_z = log(c->point[i].z), log_e = log(c->point[i].error);
        if (!isfinite(log_e))
            continue;
        n++, x += log_z, y += log_e, xx += log_z * log_z, xy += log_z * log_e, yy += log_e * log_e;
    }
    xx -= x * x / n, xy -= x * y / n, yy -= y * y / n;
    return fmax(0, yy - xy * xy / xx);
}

/* Whether the last two orders are those of errors that grow, or turn to it; one may be anything. */
static bool grows(const struct br_case *c)
{
    static const double falls = 0.2, deep = 1e-6;
    const struct br_point *last = c->point + c->points - 1;
    return br_point_rate(&last[-1], last) < 0 && br_point_rate(&last[-2], &last[-1]) < falls &&
           last->error > deep * c->point[0].error && !(last->error <= c->expected.down_to);
}

const struct br_point *br_turning_point(const struct br_case *c)
{
    enum { UNKNOWNS = 4, BENT = 3 }; /* so many rows before the least error are bent by growth */
    static const double least_growth = 0.25, most = 0.1, sure = 0.01;
    static const double digits = 1e-3; /* errors are not known to more */
    size_t least = 0;
    for (size_t i = 0; i < c->points; i++) {
        if (c->point[i].deviation > 0 || !(c->point[i].error > 0)) /* NaN: there is no such law */
            return NULL;
        least = c->point[i].error < c->point[least].error ? i : least;
    }
    if (!(c->points > UNKNOWNS && least > 0 && grows(c)))
        return NULL;
    const struct br_point *last = c->point + c->points - 1;
    const struct law law =
        find_law(c, br_point_rate(&c->point[0], &c->point[1]), -br_point_rate(&last[-1], last));
    const double freedom = (double)(c->points - UNKNOWNS), left = law.squares / freedom;
    if (!(law.p > 0 && law.q > least_growth && left < most * most))
        return NULL;
    const double before = least > BENT ? (double)(least - BENT) : 0;
    const bool scatters =
        before > 0 &&
        gsl_cdf_fdist_Q((left + digits * digits) /
                            (br_squares_of_power(c, least - 1) / before + digits * digits),
                        freedom, before) < sure;
    return scatters ? NULL : c->point + least;
}
