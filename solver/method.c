/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/method.h"

const struct br_contact_rule *br_contact_rule_of(const struct br_time_scheme *scheme)
{
    const struct br_contact_rule *const *rule = br_contact_rules;
    while (!scheme->may_lag && rule[1] && !(*rule)->at_new_step)
        rule++;
    return *rule;
}

/* Smaller tolerances are round-off's, larger ones are none. */
static enum br_status check_scheme(const struct br_method *m, struct br_error *err)
{
    if (!m->scheme->may_lag && !m->contact->at_new_step)
        return br_fail(err, BR_BAD_INPUT,
                       "contact rule '%s' does not go with time scheme '%s', expected '%s'",
                       m->contact->name, m->scheme->name, br_contact_rule_of(m->scheme)->name);
    if (m->scheme->adaptive && !(m->tolerance > 1e-14 && m->tolerance < 1))
        return br_fail(err, BR_BAD_INPUT,
                       "the tolerance of time scheme '%s' is %g, expected a number above 1e-14 and "
                       "below 1",
                       m->scheme->name, m->tolerance);
    return BR_OK;
}

enum br_status br_method_check(const struct br_method *m, struct br_error *err)
{
    if (m->axial_degree != 1 && m->axial_degree != 2)
        return br_fail(err, BR_BAD_INPUT, "the axial degree is %d, expected 1 or 2",
                       m->axial_degree);
    const enum br_status status = check_scheme(m, err);
    return status ? status : br_friction_check(m->friction, &m->iteration, err);
}
