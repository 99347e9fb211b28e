/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "study/extremes/trial.h"

static const double accurate = 0.05;    /* relative, of displacements */
static const double refined_work = 3e6; /* elements times linear solves */
static const double of_distance = 1.5;  /* between a judge and a finer one */

/* How far the march is from the judge, against what is stated. */
static void compare(struct br_extreme_trial *t)
{
    struct br_extreme_verdict *v = t->verdict;
    v->error = v->stated = 0;
    t->beyond = t->error = 0;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        double sure;
        const double e = br_track_error(t->own, t->other, (enum br_field_kind)kind, &sure);
        const double boast = t->court->boast > 0 ? t->court->boast : 1;
        const double stated = br_predicted_most(&t->prediction, (enum br_field_kind)kind) / boast;
        const double slack = fmax(sure, of_distance * t->judge_error[kind]);
        const double beyond = e <= slack + stated ? 0 : (e - slack) / fmax(stated, 1e-300);
        if (isnan(beyond) || beyond > t->beyond || (beyond == t->beyond && !(e <= t->error))) {
            v->stated = stated;
            t->error = e;
        }
        v->error = isnan(e) || e > v->error ? e : v->error;
        t->beyond = isnan(beyond) || beyond > t->beyond ? beyond : t->beyond;
    }
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
    compare(t);
    return BR_OK;
}

static const struct br_contact_rule *implicit_contact(void)
{
    const struct br_contact_rule *const *rule = br_contact_rules;
    while (!(*rule)->at_new_step)
        rule++;
    return *rule;
}

/* A beam without density whose viscosity is gone within a step k, s, follows its load at once, and
 * friction keeps what the load's peaks and jumps have left. Stages of a higher order go beyond
 * these; Euler's steps do not. */
static bool follows_at_once(const struct br_scene *s, double k)
{
    return s->bending.modelled && s->density == 0 &&
           s->bending.viscosity <= k * s->bending.stiffness && s->friction.law != BR_FRICTIONLESS;
}

/* By riccati, whose round-off is least, with contact at the new level, which has no limit, and a
 * scheme that takes little energy from a vibration, but is not the one that errors are predicted
 * by. */
static enum br_status march_finer(struct br_extreme_trial *t, size_t finer, double times,
                                  struct br_track *track, struct br_error *err)
{
    struct br_track_request request = br_extreme_request(t);
    struct br_method fine = t->method;
    const bool chosen = fine.scheme->adaptive;
    fine.solver = br_linear_solvers[0];
    fine.contact = implicit_contact();
    if (fine.friction->iterates) /* what an iteration leaves adds up over many steps */
        fine.friction = br_friction_rules[0];
    const bool at_once = follows_at_once(&t->marched, br_time_step(&t->marched, t->one->steps));
    fine.scheme = br_time_scheme_find(chosen ? "adaptive" : at_once ? "euler" : "esdirk3");
    fine.tolerance = fmax(1e-11, fine.tolerance / (100 * times));
    fine.most_steps = 4 * BR_EXTREME_PATIENCE;
    request.method = &fine;
    request.finer = finer;
    const double solves =
        (double)t->one->n * (double)t->one->steps * br_time_scheme_stages(fine.scheme);
    const double room = refined_work / ((double)finer * solves);
    request.shorter = chosen ? 1 : (size_t)(times * floor(fmin(32, fmax(2, room))));
    return br_track_march(&request, track, err);
}

static size_t finer_mesh(const struct br_extreme_trial *t)
{
    return t->one->n < 16 ? 8 : t->one->n < 200 ? 4 : 2;
}

static enum br_status ask_refinement(struct br_extreme_trial *t, struct br_error *err)
{
    const enum br_status status = march_finer(t, finer_mesh(t), 1, t->other, err);
    if (status || t->other->failure.status)
        return status;
    t->verdict->by = BR_BY_REFINEMENT;
    compare(t);
    return BR_OK;
}

/* Before anything is called wrong, the judge itself is judged: by a march that is finer still. */
static enum br_status ask_again(struct br_extreme_trial *t, struct br_error *err)
{
    struct br_track *finest = br_allocate(1, sizeof *finest), *other = t->other;
    if (!finest)
        return br_no_memory(err, "a march");
    const enum br_status status = march_finer(t, 2 * finer_mesh(t), 2, finest, err);
    if (!status && !finest->failure.status) {
        double sure;
        for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
            t->judge_error[kind] = br_track_error(other, finest, (enum br_field_kind)kind, &sure);
        t->other = finest;
        compare(t);
        t->other = other;
    }
    free(finest);
    return status;
}

static bool is_stated(const struct br_extreme_trial *t)
{
    return t->verdict->error <= accurate || t->prediction.known;
}

static void decide_accuracy(struct br_extreme_trial *t)
{
    const struct br_extreme_verdict *v = t->verdict;
    const unsigned helps = 1u << BR_WARN_LOAD_TIME | 1u << BR_WARN_LOAD_SPACE |
                           1u << BR_WARN_INITIAL | 1u << BR_WARN_BOUNCE;
    if (v->by == BR_BY_NOBODY)
        br_extreme_decide(t, BR_EXTREME_UNJUDGED, "nobody can judge it: %.150s",
                          t->other->failure.message);
    else if (t->beyond <= 0 && v->error <= accurate)
        t->verdict->which = BR_EXTREME_RIGHT;
    else if (v->warned & 1u << BR_WARN_UNSTABLE)
        br_extreme_decide(t, BR_EXTREME_UNSTABLE, "beyond the stability limit");
    else if (!is_stated(t))
        br_extreme_decide(t, BR_EXTREME_UNKNOWN, "error %.2g, said to be not known: %.100s",
                          v->error, t->prediction.why);
    else if (t->beyond <= 0 || v->warned & helps)
        br_extreme_decide(t, BR_EXTREME_WARNED, "error %.2g, and says so", v->error);
    else
        br_extreme_decide(t, BR_EXTREME_WRONG, "error %.2g by %s, stated to be at most %.2g",
                          t->error, br_extreme_by_name(v->by), v->stated);
}

enum br_status br_extreme_judge_accuracy(struct br_extreme_trial *t, struct br_error *err)
{
    enum br_status status = ask_exact(t, err);
    if (!status && t->verdict->by == BR_BY_NOBODY)
        status = ask_refinement(t, err);
    if (!status && t->verdict->by == BR_BY_REFINEMENT && !(t->beyond <= 0))
        status = ask_again(t, err);
    if (!status)
        decide_accuracy(t);
    return status;
}
