/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "study/extreme_trial.h"

static const double accurate = 0.05;    /* relative, of displacements */
static const double grown = 10;         /* times the solution, and what Euler makes of it */
static const double refined_work = 1e6; /* elements times linear solves */

static double worst_distance(struct br_extreme_trial *t)
{
    double most = 0;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        t->size[kind] = fmax(t->size[kind], t->other->largest[kind]);
        const double d = br_track_distance(t->own, t->other, (enum br_field_kind)kind, 1);
        most = isnan(d) || d > most ? d : most;
    }
    return most;
}

/* The exact solution knows (12) alone. */
static bool exact_knows(const struct br_extreme_trial *t)
{
    return !t->court->quick && !(t->marched.friction.law != BR_FRICTIONLESS &&
                                 t->method.friction->needs_regularisation);
}

static enum br_status ask_exact(struct br_extreme_trial *t, struct br_error *err)
{
    if (!exact_knows(t))
        return BR_OK;
    const enum br_status status =
        br_track_exact(&t->marched, &t->places, BR_EXTREME_PATIENCE, t->other, err);
    if (status || t->other->failure.status)
        return status;
    t->verdict->by = BR_BY_EXACT;
    t->verdict->error = worst_distance(t);
    return BR_OK;
}

static const struct br_contact_rule *implicit_contact(void)
{
    const struct br_contact_rule *const *rule = br_contact_rules;
    while (!(*rule)->at_new_step)
        rule++;
    return *rule;
}

/* By riccati, whose round-off is least, with contact at the new level, which has no limit. */
static enum br_status ask_refinement(struct br_extreme_trial *t, struct br_error *err)
{
    struct br_track_request request = br_extreme_request(t);
    struct br_method fine = t->method;
    fine.solver = br_linear_solvers[0];
    fine.contact = implicit_contact();
    if (fine.scheme->integrator)
        fine.scheme = br_time_scheme_find("adaptive");
    fine.tolerance = fmax(1e-11, fine.tolerance / 100);
    fine.most_steps = 4 * BR_EXTREME_PATIENCE;
    request.method = &fine;
    request.finer = 2;
    const double room = refined_work / (2 * br_extreme_work(t->one));
    request.shorter = fine.scheme->adaptive ? 1 : (size_t)fmin(64, fmax(2, room));
    const enum br_status status = br_track_march(&request, t->other, err);
    if (status || t->other->failure.status)
        return status;
    t->verdict->by = BR_BY_REFINEMENT;
    t->verdict->error = worst_distance(t);
    return BR_OK;
}

/* A march of few steps may see a load so rarely that its answer is too large, which is no growth:
 * then implicit Euler, which amplifies nothing, has it, too. */
static enum br_status ask_growth(struct br_extreme_trial *t, bool *grew, struct br_error *err)
{
    struct br_track_request request = br_extreme_request(t);
    struct br_method euler = t->method;
    euler.scheme = br_time_schemes[0];
    euler.solver = br_linear_solvers[0];
    euler.contact = implicit_contact();
    request.method = &euler;
    *grew = !(t->own->largest[BR_AXIAL] <= grown * t->size[BR_AXIAL] &&
              t->own->largest[BR_BENDING] <= grown * t->size[BR_BENDING]);
    if (!*grew)
        return BR_OK;
    const enum br_status status = br_track_march(&request, t->other, err);
    *grew = false;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        *grew |= !(t->own->largest[kind] <= grown * fmax(t->size[kind], t->other->largest[kind]));
    return status;
}

static void decide_accuracy(struct br_extreme_trial *t, bool grew)
{
    const struct br_extreme_verdict *v = t->verdict;
    const unsigned helps = 1u << BR_WARN_ROUND_OFF | 1u << BR_WARN_INACCURATE |
                           1u << BR_WARN_LOAD_TIME | 1u << BR_WARN_LOAD_SPACE |
                           1u << BR_WARN_BOUNCE;
    if (v->by == BR_BY_NOBODY)
        br_extreme_decide(t, BR_EXTREME_UNJUDGED, "nobody can judge it: %.150s",
                          t->other->failure.message);
    else if (v->error <= accurate)
        t->verdict->which = BR_EXTREME_RIGHT;
    else if (v->warned & 1u << BR_WARN_UNSTABLE)
        br_extreme_decide(t, BR_EXTREME_UNSTABLE, "beyond the stability limit");
    else if (v->warned & helps)
        br_extreme_decide(t, BR_EXTREME_WARNED, "error %.2g, and says so", v->error);
    else if (grew)
        br_extreme_decide(t, BR_EXTREME_WRONG, "it grew: error %.2g by %s", v->error,
                          br_extreme_by_name(v->by));
    else
        br_extreme_decide(t, BR_EXTREME_UNWARNED, "error %.2g by %s", v->error,
                          br_extreme_by_name(v->by));
}

enum br_status br_extreme_judge_accuracy(struct br_extreme_trial *t, struct br_error *err)
{
    enum br_status status = ask_exact(t, err);
    if (!status && t->verdict->by == BR_BY_NOBODY)
        status = ask_refinement(t, err);
    bool grew = false;
    if (!status && t->verdict->by != BR_BY_NOBODY)
        status = ask_growth(t, &grew, err);
    if (!status)
        decide_accuracy(t, grew);
    return status;
}
