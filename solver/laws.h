/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The laws at the tip, one scalar problem a step each: normal compliance (10) and friction (12) as
 * registries of rules, and where the lagged contact of (16) ceases to be stable. */
#ifndef BR_SOLVER_LAWS_H
#define BR_SOLVER_LAWS_H

#include "base/words.h"
#include "solver/field.h"
#include "solver/scene.h"

/* ---- contact ---- */

/* The tip before and during a step. */
struct br_contact_state {
    double displacement;  /* u_{n-1}(L), m */
    double free_velocity; /* v*, the tip's velocity without contact, m/s */
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

/* The law itself. All of the solver and of study/ that needs a force or a slope asks here. */

/* Penetration (u - g)_+, m. */
double br_penetration(const struct br_contact *contact, double displacement);

/* c_H (u - g)_+, N, and its derivative by u where the force is that, N/m. */
double br_contact_force(const struct br_contact *contact, double displacement);
double br_contact_slope(const struct br_contact *contact, double force);

/* The penetration, m, that has that force > 0. */
double br_contact_depth(const struct br_contact *contact, double force);

/* Whether a contact is modelled and has a force. */
bool br_contact_pushes(const struct br_contact *contact);

/* The force at u_n of a contact that stays closed in the step, whatever its sign, N. */
double br_contact_closed_force(const struct br_contact *contact,
                               const struct br_contact_state *state);

/* ---- friction ---- */

/* A law of friction. All of the solver and of study/ asks here; references have its bound once
 * more, in tables of their own, and refuse a law that is not in them. */
struct br_friction_model {
    const char *name;  /* in scenes */
    const char *title; /* in a sentence */
    const char *words; /* its bound, for a person */
    /* The bound h, N, at the penetration (u - g)_+, m. An adaptive scheme prolongs a contact: the
     * penetration may be negative, and then the bound, too. */
    double (*bound)(const struct br_friction *friction, double penetration);
    /* Its derivative, N/m; NULL where it does not depend on the penetration. Where it does, h is 0
     * without penetration. */
    double (*slope)(const struct br_friction *friction, double penetration);
};

/* By enum br_friction_law; all NULL: no friction. */
extern const struct br_friction_model br_friction_models[];

/* Their names; row 0 is the law after BR_FRICTIONLESS. */
extern const struct br_words br_friction_words;

/* Whether there is friction, and whether its bound depends on the penetration of the contact. */
bool br_friction_rubs(const struct br_friction *friction);
bool br_friction_follows_contact(const struct br_friction *friction);

/* Parameters of rules that iterate. */
struct br_iteration {
    double parameter; /* relative to 1 / z_tip, which converges fastest */
    double tolerance; /* of lambda, relative to the bound */
    size_t most;      /* iterations a step; a march that needs more fails */
};

/* The parameter 1/2 suits a user who knows z_tip within a factor of 2 and takes the larger, safe
 * value. The parameter 1 needs z_tip itself, and then one iteration gives the solution. */
extern const struct br_iteration br_iteration_defaults;

/* With v = v* - lambda z: find lambda in bound * Sign(v), or its regularisation. */
struct br_friction_state {
    double free_velocity;  /* v*, m/s */
    double compliance;     /* z_tip, m/s per N */
    double bound;          /* h(t_n) >= 0, N */
    double regularisation; /* mu, m/s */
    double last;           /* lambda of the step before, N: the start of iterations */
    struct br_iteration iteration;
    size_t iterations; /* out: added to by rules that iterate */
};

struct br_friction_rule {
    const char *name;  /* as on the command line */
    const char *title; /* one line for a person */
    const char *citation;
    bool needs_regularisation; /* the scene must give mu > 0 */
    bool iterates;             /* uses br_iteration */
    double parameter_below;    /* iterations converge for parameters > 0 below this */
    /* lambda = -sigma_V(L), N: the friction force that resists the tip. NaN: the data are NaN, or
     * the iterations did not converge. */
    double (*force)(struct br_friction_state *state);
};

/* NULL-terminated; the first is the default. */
extern const struct br_friction_rule *const br_friction_rules[];
const struct br_friction_rule *br_friction_rule_find(const char *name);

/* Refuses (BR_BAD_INPUT) an iteration with which the rule does not converge. */
enum br_status br_friction_check(const struct br_friction_rule *rule,
                                 const struct br_iteration *iteration, struct br_error *err);

/* The friction bound h, N, at the penetration (u - g)_+, m; 0 without friction. */
double br_friction_bound(const struct br_scene *scene, double penetration);

/* ---- the limit of the lagged contact ---- */

/* Where the lagged contact of (16) ceases to be stable: exactly, for the discretisation that is
 * marched, in closed form.
 *
 * While the contact is closed, it is stable if and only if
 *     c_H G(2/k) <= 1,    G(s) = e_tip'(s^2 M + s C + K)^-1 e_tip,
 * whatever the inertia and the viscosity are (solver/README.md has the proof). Beyond it exactly
 * one eigenvalue of a step is outside of the unit circle, real and below -1, and the closed tip's
 * error grows by it in every step, with alternating sign. Without inertia this is c_H L <= a +
 * 2c/k.
 *
 * For a contact that opens and closes, multiply a step with its v_n: the energy, with the contact's
 * own, does not grow, whatever the tip does, as long as
 *     c_H <= min over v of (2/k v'Cv + v'Kv) / v_tip^2 = (a + 2c/k)/L,
 * the limit without inertia. Between the two an impact may gain energy. */

/* G(s) of an axial field, m/N, for real s > 0, 1/s; its step k does not matter. A uniform rod of
 * linear elements, or of quadratic ones whose bubbles are eliminated, is a chain of equal springs
 * and masses. */
double br_tip_flexibility(const struct br_field *field, double s);

/* The largest c_H, N/m, with which a lagged contact that stays closed is stable with the field's
 * step; INFINITY where none is too large. */
double br_contact_limit_stiffness(const struct br_field *field);

/* The largest c_H, N/m, with which a lagged contact never gains energy. */
double br_contact_limit_bouncing(const struct br_field *field);

/* The longest step, s, with which a closed lagged contact of that c_H, N/m, is stable: INFINITY
 * where all steps are, 0 where no step is. */
double br_contact_limit_step(const struct br_field *field, double stiffness);

/* Whether errors of a closed lagged contact grow with the field's step; at the limit, within
 * round-off, they do not. */
bool br_contact_grows(const struct br_field *field, double stiffness);

/* The factor by which errors grow in a step: the size of the eigenvalue outside the unit circle; 1
 * where there is none. */
double br_contact_growth(const struct br_field *field, double stiffness);

#endif
