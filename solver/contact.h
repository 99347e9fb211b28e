/* SPDX-License-Identifier: GPL-3.0-or-later */
/* When normal compliance (10) takes its penetration: a registry of two rules. */
#ifndef BR_SOLVER_CONTACT_H
#define BR_SOLVER_CONTACT_H

#include "solver/scene.h"

/* The tip before and during a step. */
struct br_contact_state {
    double displacement;  /* u_{n-1}(L), m */
    double free_velocity; /* v*, the tip's velocity were there no contact, m/s */
    double compliance;    /* z_tip, m/s per N */
    double k;             /* time step, s */
};

struct br_contact_rule {
    const char *name;  /* as on the command line */
    const char *title; /* one line for a person */
    const char *citation;
    bool at_new_step; /* the force is that at u_n */
    /* The contact force c_H (u - g)_+ >= 0, N, that resists the tip in this step. */
    double (*force)(const struct br_contact *contact, const struct br_contact_state *state);
};

/* NULL-terminated; the first is the default, the paper's. */
extern const struct br_contact_rule *const br_contact_rules[];
const struct br_contact_rule *br_contact_rule_find(const char *name);

/* Penetration (u - g)_+, m. */
double br_penetration(const struct br_contact *contact, double displacement);

#endif
