/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The friction law as the literature solves it, with v = v* - lambda z: find lambda in b Sign(v).
 *
 * Uzawa (Glowinski 1984; Cheng and Han 2003) with rho > 0, N per m/s:
 *     lambda <- P(lambda + rho v),  P the projection onto [-b, b].
 *
 * Penalty-duality (Bermudez and Moreno 1981) with omega > 0 and the dual variable
 * q = lambda - omega v, which is in G(v) = b Sign(v) - omega v:
 *     v (1 + omega z) = v* - z q,    q <- G_zeta(v + zeta q),
 * G_zeta being the Yosida regularisation (I - J)/zeta, J = (I + zeta G)^-1. With zeta omega = 1/2,
 * the largest for which they prove convergence, and g = 2 omega v + q it is, for stick and slip,
 *     q <- 2 P(g) - g,    lambda = P(g).
 *
 * In units of b, with f = v* / (z b), v = z b (f - lambda), both are one iteration, with a
 * projection or a reflection:
 *     g = x + a (f - x),    x <- P(g) or 2 P(g) - g,    lambda = P(g),
 *     Uzawa:              x = lambda,  a = rho z,
 *     penalty-duality:    x = q,       a = 2 omega z / (1 + omega z).
 * Neither P nor 2 P - I takes points apart, so an iteration leaves |1 - a| of an error at most:
 * Uzawa converges for 0 < rho z < 2, penalty-duality for all omega z > 0, both at once for 1. */
#include "solver/friction_iteration.h"

#include <float.h>
#include <math.h>

/* The projection onto [-1, 1]; NaN stays NaN, and raises no flag. */
static double project(double g)
{
    if (isgreater(g, 1))
        return 1;
    return isless(g, -1) ? -1 : g;
}

struct iteration {
    double a;
    bool reflects;
    double x; /* where it starts */
    double f;
};

/* An upper bound of |g - its limit| after an iteration by `change`, round-off included. */
static double error_bound(const struct iteration *i, double g, double change)
{
    const double left = fabs(1 - i->a);
    const double round_off = 4 * DBL_EPSILON * (fabs(g) + fabs(i->x) + fabs(i->a * i->f));
    return (left * fabs(change) + round_off) / (1 - left);
}

/* lambda/b; it is exact where the slip is certain. */
static double iterate(struct iteration *i, struct br_friction_state *s)
{
    if (!(fabs(1 - i->a) < 1) || isnan(i->f) || isnan(i->x))
        return NAN;
    for (size_t count = 0; count < s->iteration.most; count++) {
        s->iterations++;
        const double g = i->x + i->a * (i->f - i->x), lambda = project(g);
        const double next = i->reflects ? 2 * lambda - g : lambda;
        const double error = error_bound(i, g, next - i->x);
        if (error <= s->iteration.tolerance || fabs(g) - error >= 1)
            return lambda;
        i->x = next;
    }
    return NAN;
}

/* f = v* / (z b), without a product or quotient on the way that is no double. Its limit, 1e50,
 * changes no lambda, and keeps what follows finite. */
static double relative_force(const struct br_friction_state *s)
{
    const int most = 166; /* 2^166 is about 1e50 */
    if (isinf(s->free_velocity))
        return copysign(1e50, s->free_velocity);
    int v = 0, z = 0, b = 0;
    const double f = frexp(s->free_velocity, &v) / frexp(s->compliance, &z) / frexp(s->bound, &b);
    return ldexp(f, v - z - b < most ? v - z - b : most);
}

/* lambda / b of the step before, into [-1, 1]. */
static double relative_last(const struct br_friction_state *s)
{
    return isgreaterequal(fabs(s->last), s->bound) ? copysign(1, s->last) : s->last / s->bound;
}

/* Without a bound there is no friction; what is not a number stays so. */
static bool has_no_bound(const struct br_friction_state *s)
{
    return s->bound == 0 && !isnan(s->free_velocity) && !isnan(s->compliance);
}

static double uzawa_contraction(double parameter)
{
    return fabs(1 - parameter);
}

static double uzawa_force(struct br_friction_state *s)
{
    if (has_no_bound(s))
        return 0;
    struct iteration i = {
        .a = s->iteration.parameter,
        .x = relative_last(s),
        .f = relative_force(s),
    };
    return s->bound * iterate(&i, s);
}

static double penalty_duality_contraction(double parameter)
{
    return fabs(1 - parameter) / (1 + parameter);
}

static double penalty_duality_force(struct br_friction_state *s)
{
    if (has_no_bound(s))
        return 0;
    const double omega = s->iteration.parameter, f = relative_force(s);
    const double lambda = relative_last(s);
    struct iteration i = {
        .a = 2 * omega / (1 + omega),
        .reflects = true,
        .x = lambda - omega * (f - lambda),
        .f = f,
    };
    return s->bound * iterate(&i, s);
}

const struct br_friction_rule br_penalty_duality = {
    .name = "penalty-duality",
    .title = "the law itself by the paper's iteration; its parameter is omega z_tip > 0",
    .citation = "Bermudez and Moreno, Comput. Math. Appl. 7 (1981) 43-58",
    .iterates = true,
    .parameter_below = INFINITY,
    .contraction = penalty_duality_contraction,
    .force = penalty_duality_force,
};

const struct br_friction_rule br_uzawa = {
    .name = "uzawa",
    .title = "the law itself by Uzawa's iteration; its parameter is rho z_tip, below 2",
    .citation = "Glowinski, Numerical methods for nonlinear variational problems, 1984; Cheng and "
                "Han, Comput. Methods Appl. Mech. Eng. 192 (2003) 1451-1462",
    .iterates = true,
    .parameter_below = 2,
    .contraction = uzawa_contraction,
    .force = uzawa_force,
};
