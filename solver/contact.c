/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/contact.h"

#include <string.h>

double br_penetration(const struct br_contact *contact, double displacement)
{
    const double depth = displacement - contact->gap;
    return depth < 0 ? 0 : depth; /* NaN stays NaN */
}

/* r = c_H (u_{n-1} - g)_+ */
static double lagged_force(const struct br_contact *contact, const struct br_contact_state *s)
{
    return contact->stiffness * br_penetration(contact, s->displacement);
}

/* r = c_H (u_n - g)_+ with u_n = u_{n-1} + k (v* - r z): piecewise linear in r. */
static double implicit_force(const struct br_contact *contact, const struct br_contact_state *s)
{
    const double depth = br_penetration(contact, s->displacement + s->k * s->free_velocity);
    return contact->stiffness * depth / (1 + contact->stiffness * s->k * s->compliance);
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
    .citation = "backward Euler; solver/contact.c",
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
