/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The friction law (12) at the tip, one scalar problem a step: a registry. */
#ifndef BR_SOLVER_FRICTION_H
#define BR_SOLVER_FRICTION_H

#include "solver/scene.h"

/* How rules that iterate do so. */
struct br_iteration {
    double parameter; /* over the one that converges fastest, 1 / z_tip: 1 is that one */
    double tolerance; /* of lambda, relative to the bound */
    size_t most;      /* iterations a step; a march that needs more fails */
};

/* 1/2: as if z_tip were known within a factor of 2, and taken on its safe side, too large. 1 would
 * be the solution in one iteration, which nobody has who does not solve for z_tip first. */
extern const struct br_iteration br_iteration_defaults;

/* With v = v* - lambda z: find lambda in bound * Sign(v), or its regularisation. */
struct br_friction_state {
    double free_velocity;  /* v*, m/s */
    double compliance;     /* z_tip, m/s per N */
    double bound;          /* h(t_n) >= 0, N */
    double regularisation; /* mu, m/s */
    double last;           /* lambda of the step before, N: where iterations start */
    struct br_iteration iteration;
    size_t iterations; /* out: added to by rules that iterate */
};

struct br_friction_rule {
    const char *name;  /* as on the command line */
    const char *title; /* one line for a person */
    const char *citation;
    bool needs_regularisation; /* the scene must give mu > 0 */
    bool iterates;             /* heeds br_iteration */
    double parameter_below;    /* iterations converge for parameters > 0 below this */
    /* What an iteration leaves of an error, at most, for such a parameter; NULL: none is made. */
    double (*contraction)(double parameter);
    /* lambda = -sigma_V(L), N: the friction force that resists the tip. NaN: the data are, or the
     * iterations did not converge. */
    double (*force)(struct br_friction_state *state);
};

/* NULL-terminated; the first is the default. */
extern const struct br_friction_rule *const br_friction_rules[];
const struct br_friction_rule *br_friction_rule_find(const char *name);

/* Refuses (BR_BAD_INPUT) an iteration with which the rule does not converge. */
enum br_status br_friction_check(const struct br_friction_rule *rule,
                                 const struct br_iteration *iteration, struct br_error *err);

/* The friction bound h, N, at the penetration (u - g)_+, m. */
double br_friction_bound(const struct br_scene *scene, double penetration);

#endif
