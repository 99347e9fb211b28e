/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/friction.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "solver/friction_iteration.h"

const struct br_iteration br_iteration_defaults = {
    .parameter = 0.5, .tolerance = 1e-10, .most = 10000};

double br_friction_bound(const struct br_scene *scene, double penetration)
{
    switch (scene->friction.law) {
    case BR_TRESCA:
        return scene->friction.coefficient;
    case BR_COULOMB:
        return scene->friction.coefficient * penetration;
    case BR_FRICTIONLESS:
        break;
    }
    return 0;
}

/* lambda into [-bound, bound]; NaN stays NaN, and raises no flag. */
static double clamp(double lambda, double bound)
{
    if (isgreater(lambda, bound))
        return bound;
    return isless(lambda, -bound) ? -bound : lambda;
}

/* (12): stick, v = 0, while |lambda| <= h; slip with |lambda| = h otherwise. Where that is certain
 * nothing is divided, which could overflow. */
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

const struct br_friction_rule *const br_friction_rules[] = {&exact, &regularised,
                                                            &br_penalty_duality, &br_uzawa, NULL};

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
