/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/laws.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- contact ---- */

double br_penetration(const struct br_contact *contact, double displacement)
{
    const double depth = displacement - contact->gap;
    return depth < 0 ? 0 : depth; /* NaN stays NaN */
}

double br_contact_force(const struct br_contact *contact, double displacement)
{
    return contact->stiffness * br_penetration(contact, displacement);
}

double br_contact_slope(const struct br_contact *contact, double force)
{
    return force > 0 ? contact->stiffness : 0;
}

double br_contact_depth(const struct br_contact *contact, double force)
{
    return force / contact->stiffness;
}

bool br_contact_pushes(const struct br_contact *contact)
{
    return contact->modelled && contact->stiffness > 0;
}

/* r = c_H (u_n - g) with u_n = u_{n-1} + k (v* - r z); depth: u_n - g without the force */
static double force_at_end(const struct br_contact *contact, const struct br_contact_state *s,
                           double depth)
{
    return contact->stiffness * depth / (1 + contact->stiffness * s->k * s->compliance);
}

double br_contact_closed_force(const struct br_contact *contact, const struct br_contact_state *s)
{
    return force_at_end(contact, s, s->displacement + s->k * s->free_velocity - contact->gap);
}

/* r = c_H (u_{n-1} - g)_+ */
static double lagged_force(const struct br_contact *contact, const struct br_contact_state *s)
{
    return br_contact_force(contact, s->displacement);
}

/* r = c_H (u_n - g)_+ */
static double implicit_force(const struct br_contact *contact, const struct br_contact_state *s)
{
    return force_at_end(contact, s,
                        br_penetration(contact, s->displacement + s->k * s->free_velocity));
}

static const struct br_contact_rule lagged = {
    .name = "lagged",
    .title = "contact force from u_{n-1}, as the paper prints it; conditionally stable",
    .citation = "Campo et al. 2006, (16) and (27)",
    .force = lagged_force,
};

static const struct br_contact_rule implicit = {
    .name = "implicit",
    .title = "contact force from u_n, in closed form at the same cost; unconditionally stable",
    .citation = "backward Euler; solver/laws.c",
    .at_new_step = true,
    .force = implicit_force,
};

const struct br_contact_rule *const br_contact_rules[] = {&lagged, &implicit, NULL};

const struct br_contact_rule *br_contact_rule_find(const char *name)
{
    for (const struct br_contact_rule *const *rule = br_contact_rules; *rule; rule++)
        if (strcmp((*rule)->name, name) == 0)
            return *rule;
    return NULL;
}

/* ---- friction ---- */

const struct br_iteration br_iteration_defaults = {
    .parameter = 0.5, .tolerance = 1e-10, .most = 10000};

static double given_bound(const struct br_friction *f, double penetration)
{
    (void)penetration;
    return f->coefficient;
}

static double proportional_bound(const struct br_friction *f, double penetration)
{
    return f->coefficient * penetration;
}

static double proportional_slope(const struct br_friction *f, double penetration)
{
    (void)penetration;
    return f->coefficient;
}

const struct br_friction_model br_friction_models[] = {
    [BR_TRESCA] = {"tresca", "Tresca", "constant", given_bound, NULL},
    [BR_COULOMB] = {"coulomb", "Coulomb", "c_V (u(L) - g)_+", proportional_bound,
                    proportional_slope},
};
_Static_assert(sizeof br_friction_models / sizeof *br_friction_models == BR_FRICTION_LAWS,
               "a law of friction has no row");

static const char *law_name(size_t row)
{
    return row + 1 < BR_FRICTION_LAWS ? br_friction_models[row + 1].name : NULL;
}

const struct br_words br_friction_words = {law_name, NULL, NULL};

bool br_friction_rubs(const struct br_friction *f)
{
    return f->law != BR_FRICTIONLESS;
}

bool br_friction_follows_contact(const struct br_friction *f)
{
    return br_friction_models[f->law].slope != NULL;
}

double br_friction_bound(const struct br_scene *scene, double penetration)
{
    const struct br_friction *f = &scene->friction;
    return br_friction_rubs(f) ? br_friction_models[f->law].bound(f, penetration) : 0;
}

/* lambda into [-bound, bound]; NaN stays NaN, and raises no flag. */
static double clamp(double lambda, double bound)
{
    if (isgreater(lambda, bound))
        return bound;
    return isless(lambda, -bound) ? -bound : lambda;
}

/* (12): stick, v = 0, while |lambda| <= h; slip with |lambda| = h otherwise. Where slip is certain
 * there is no division, which could overflow. */
static double exact_force(struct br_friction_state *s)
{
    if (isgreater(fabs(s->free_velocity), 2 * s->bound * s->compliance))
        return copysign(s->bound, s->free_velocity);
    return clamp(s->free_velocity / s->compliance, s->bound);
}

/* (29), corrected: lambda = h v / mu for |v| <= mu, h sign(v) beyond. With v = v* - lambda z it is
 * h v* / (mu + h z) up to |v*| = mu + h z; no product of h and v* is formed, which could overflow
 * or be lost. */
static double regularised_force(struct br_friction_state *s)
{
    const double width = s->regularisation + s->bound * s->compliance;
    if (isgreaterequal(fabs(s->free_velocity), width))
        return copysign(s->bound, s->free_velocity);
    if (s->bound * s->compliance > s->regularisation)
        return clamp(s->free_velocity / (s->regularisation / s->bound + s->compliance), s->bound);
    return clamp(s->free_velocity / width * s->bound, s->bound);
}

static const struct br_friction_rule exact = {
    .name = "exact",
    .title = "the law itself: stick is v = 0",
    .citation = "Campo et al. 2006, (12) and (17)",
    .force = exact_force,
};

static const struct br_friction_rule regularised = {
    .name = "regularised",
    .title = "smoothed over |v| <= mu with the scene's mu",
    .citation = "Campo et al. 2006, (29)-(30), misprints corrected",
    .needs_regularisation = true,
    .force = regularised_force,
};

/* ---- friction by iteration ---- */

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

/* f = v* / (z b), without overflow or underflow in between. The limit of 1e50 changes no lambda,
 * and keeps later values finite. */
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

/* lambda; it is exact where slip is certain. A bound of 0 means no friction; NaN gives NaN. */
static double iterated_force(struct br_friction_state *s, bool reflects)
{
    if (s->bound == 0 && !isnan(s->free_velocity) && !isnan(s->compliance))
        return 0;
    const double parameter = s->iteration.parameter;
    const double a = reflects ? 2 * parameter / (1 + parameter) : parameter, left = fabs(1 - a);
    const double f = relative_force(s), last = relative_last(s);
    double x = reflects ? last - parameter * (f - last) : last;
    if (!(left < 1) || isnan(f) || isnan(x))
        return NAN;
    for (size_t count = 0; count < s->iteration.most; count++) {
        s->iterations++;
        const double g = x + a * (f - x), lambda = clamp(g, 1);
        const double next = reflects ? 2 * lambda - g : lambda;
        /* an upper bound of |g - its limit|, round-off included */
        const double round_off = 4 * DBL_EPSILON * (fabs(g) + fabs(x) + fabs(a * f));
        const double error = (left * fabs(next - x) + round_off) / (1 - left);
        if (error <= s->iteration.tolerance || fabs(g) - error >= 1)
            return s->bound * lambda;
        x = next;
    }
    return NAN;
}

static double uzawa_force(struct br_friction_state *s)
{
    return iterated_force(s, false);
}

static double penalty_duality_force(struct br_friction_state *s)
{
    return iterated_force(s, true);
}

static const struct br_friction_rule penalty_duality = {
    .name = "penalty-duality",
    .title = "the law itself by the paper's iteration; its parameter is omega z_tip > 0",
    .citation = "Bermudez and Moreno, Comput. Math. Appl. 7 (1981) 43-58",
    .iterates = true,
    .parameter_below = INFINITY,
    .force = penalty_duality_force,
};

static const struct br_friction_rule uzawa = {
    .name = "uzawa",
    .title = "the law itself by Uzawa's iteration; its parameter is rho z_tip, below 2",
    .citation = "Glowinski, Numerical methods for nonlinear variational problems, 1984; Cheng and "
                "Han, Comput. Methods Appl. Mech. Eng. 192 (2003) 1451-1462",
    .iterates = true,
    .parameter_below = 2,
    .force = uzawa_force,
};

/* ---- the friction rules ---- */

const struct br_friction_rule *const br_friction_rules[] = {&exact, &regularised, &penalty_duality,
                                                            &uzawa, NULL};

const struct br_friction_rule *br_friction_rule_find(const char *name)
{
    for (const struct br_friction_rule *const *rule = br_friction_rules; *rule; rule++)
        if (strcmp((*rule)->name, name) == 0)
            return *rule;
    return NULL;
}

enum br_status br_friction_check(const struct br_friction_rule *rule, const struct br_iteration *i,
                                 struct br_error *err)
{
    if (!rule->iterates)
        return BR_OK;
    char below[32] = "";
    if (isfinite(rule->parameter_below))
        snprintf(below, sizeof below, " and below %g", rule->parameter_below);
    if (!(i->parameter > 0 && i->parameter < rule->parameter_below))
        return br_fail(
            err, BR_BAD_INPUT,
            "the parameter of friction rule '%s' is %g, expected a number above 0%s, where "
            "it converges",
            rule->name, i->parameter, below);
    if (!(i->tolerance > 1e-14 && i->tolerance < 1) || i->most < 1)
        return br_fail(err, BR_BAD_INPUT,
                       "friction rule '%s' is to iterate to %g, at most %zu times, expected a "
                       "tolerance above 1e-14 and below 1, and at least once",
                       rule->name, i->tolerance, i->most);
    return BR_OK;
}

/* ---- the limit of the lagged contact ---- */

/* An element without its bubble: [d o; o d] works on its two nodes. Needed are d + o, which is
 * inertia alone, and d - o, N/m. Neither is computed by a subtraction. A chain of n of them,
 * clamped at one end: with tanh^2(theta/2) = (d + o)/(d - o), displacements are sinh(i theta), and
 * 1/G = (d - o) tanh(theta/2) coth(n theta). Where d + o exceeds d - o, displacements of neighbours
 * alternate in sign, and the inverse ratio is used. */
double br_tip_flexibility(const struct br_field *field, double s)
{
    const double n = (double)field->n;
    const double m = s * s * field->density * field->h;
    const double r = (field->viscosity * s + field->stiffness) / field->h;
    const double difference = 2 * r + m / 6;
    const double sum = br_field_is_quadratic(field) /* the bubble has r/3 + m/30, and -m/12 */
                           ? m * ((r / 6 + m / 360) / (r / 3 + m / 30))
                           : m / 2;
    if (!(sum > 0)) /* no inertia: springs in series */
        return 2 * n / difference;
    if (!isfinite(sum) || !isfinite(difference))
        return 0;
    const double half = sqrt(sum / difference);
    return tanh(2 * n * atanh(half < 1 ? half : 1 / half)) / (difference * half);
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

/* A value that is not positive below a root and positive above it. */
typedef double (*rising)(const struct br_field *field, double stiffness, double x);

/* The root between low and high, both positive, to the last digits, from below. Bisection needs no
 * memory and cannot fail. */
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
