/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sources of error, in the order in which the chain takes them away. */
#include <math.h>
#include <stdio.h>

#include "study/trade/split.h"

static const char *without_friction(const struct br_scene *scene)
{
    return scene->friction.law == BR_FRICTIONLESS || !scene->bending.modelled
               ? "the scene has no friction"
               : NULL;
}

static const char *round_off(const struct br_scene *scene, const struct br_refinement *refined,
                             struct br_stand *stand)
{
    (void)scene, (void)refined;
    if (stand->method.solver == &br_riccati)
        return "riccati, the solver with the least of it: within the floor";
    stand->method.solver = &br_riccati;
    return NULL;
}

/* The rule that gives at once what another one iterates towards. */
static const struct br_friction_rule *direct(const struct br_friction_rule *rule)
{
    for (const struct br_friction_rule *const *r = br_friction_rules; *r; r++)
        if (!(*r)->iterates && (*r)->needs_regularisation == rule->needs_regularisation)
            return *r;
    return rule;
}

static const char *iteration(const struct br_scene *scene, const struct br_refinement *refined,
                             struct br_stand *stand)
{
    (void)refined;
    if (without_friction(scene))
        return without_friction(scene);
    if (!stand->method.friction->iterates)
        return "the friction law is solved directly";
    stand->method.friction = direct(stand->method.friction);
    return NULL;
}

static const char *smoothing(const struct br_scene *scene, const struct br_refinement *refined,
                             struct br_stand *stand)
{
    (void)refined;
    if (without_friction(scene))
        return without_friction(scene);
    if (!stand->method.friction->needs_regularisation)
        return "the friction law is not smoothed";
    stand->method.friction = br_friction_rules[0];
    return NULL;
}

static const char *lag(const struct br_scene *scene, const struct br_refinement *refined,
                       struct br_stand *stand)
{
    (void)refined;
    if (!scene->contact.modelled || !scene->axial.modelled)
        return "the scene has no contact";
    if (stand->method.contact->at_new_step || !stand->method.scheme->may_lag)
        return "the method's contact is implicit";
    stand->method.contact = br_contact_rule_find("implicit");
    return NULL;
}

static const char *time_steps(const struct br_scene *scene, const struct br_refinement *refined,
                              struct br_stand *stand)
{
    (void)scene;
    stand->method.scheme = refined->stand.method.scheme;
    stand->method.tolerance = refined->stand.method.tolerance;
    stand->method.contact = br_contact_rule_find("implicit");
    stand->steps = refined->stand.steps;
    return NULL;
}

static const char *space(const struct br_scene *scene, const struct br_refinement *refined,
                         struct br_stand *stand)
{
    (void)scene, (void)refined;
    stand->continuous = true;
    return NULL;
}

static const struct br_source all[] = {
    {"round-off", "round-off of the linear solver", round_off, false},
    {"iteration", "tolerance of the friction's iteration", iteration, false},
    {"mu", "friction smoothed over |v| <= mu", smoothing, false},
    {"lag", "contact force from the step before", lag, false},
    {"time", "time steps", time_steps, true},
    {"space", "elements", space, true},
};

const struct br_source *const br_sources[] = {&all[0], &all[1], &all[2], &all[3],
                                              &all[4], &all[5], NULL};

/* ---- refinements ---- */

/* An adaptive scheme's error a step: a digit or two above the round-off of strains. */
static const double finest_tolerance = 1e-11;

/* Steps of a fixed length, at least; and of the run's, at least so many to one. */
enum { FINE_STEPS = 20000, LEAST_RATIO = 8 };

static struct br_refinement by_tolerance(const struct br_split *split,
                                         const struct br_time_scheme *scheme)
{
    struct br_refinement r = {.stand = {.method = split->method, .steps = split->at.steps}};
    r.stand.method.scheme = scheme;
    r.stand.method.tolerance = finest_tolerance;
    snprintf(r.name, sizeof r.name, "%s, tolerance %.0e", scheme->name, finest_tolerance);
    return r;
}

static struct br_refinement by_steps(const struct br_split *split,
                                     const struct br_time_scheme *scheme)
{
    struct br_refinement r = {.stand = {.method = split->method}};
    size_t ratio = LEAST_RATIO;
    while (ratio * split->at.steps < FINE_STEPS)
        ratio *= 2; /* even: the same with half as many steps tells its error */
    r.stand.method.scheme = scheme;
    r.stand.steps = ratio * split->at.steps;
    snprintf(r.name, sizeof r.name, "%s, k = %.3g s", scheme->name,
             br_time_step(split->scene, r.stand.steps));
    return r;
}

size_t br_refinements(const struct br_split *split, size_t most, struct br_refinement *out)
{
    const struct br_time_scheme *highest = br_time_schemes[0];
    size_t count = 0;
    for (const struct br_time_scheme *const *s = br_time_schemes; *s; s++) {
        if ((*s)->adaptive && count + 1 < most)
            out[count++] = by_tolerance(split, *s);
        if (!(*s)->adaptive && (*s)->order > highest->order)
            highest = *s;
    }
    if (count < most)
        out[count++] = by_steps(split, highest);
    return count;
}
