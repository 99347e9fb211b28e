/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/trade/split.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "solver/linear/linear_solver.h"
#include "solver/scene.h"
#include "study/estimate/prediction.h"
#include "study/grid/sweep.h"

/* ---- the sources of error, in the order in which the chain removes them ---- */

/* The rule that gives directly the result of an iterating rule. */
static const struct br_friction_rule *direct(const struct br_friction_rule *rule)
{
    for (const struct br_friction_rule *const *r = br_friction_rules; *r; r++)
        if (!(*r)->iterates && (*r)->needs_regularisation == rule->needs_regularisation)
            return *r;
    return rule;
}

/* As in the tables and in JSON. */
static const char *const names[BR_SOURCES] = {
    [BR_SOURCE_ROUND_OFF] = "round-off", /* of the linear solver */
    [BR_SOURCE_ITERATION] = "iteration", /* the tolerance of the friction's iteration */
    [BR_SOURCE_SMOOTHING] = "mu",        /* friction smoothed over |v| <= mu */
    [BR_SOURCE_LAG] = "lag",             /* the contact force of the step before */
    [BR_SOURCE_TIME] = "time",           /* the time steps */
    [BR_SOURCE_SPACE] = "space",         /* the elements */
};

/* Removes a source from a run of the scene and returns NULL; or returns, in a few words, why the
 * run has no such source. */
static const char *take_away(enum br_source source, const struct br_scene *scene,
                             const struct br_variant *refined, struct br_variant *variant)
{
    struct br_method *m = &variant->method;
    const bool friction = source == BR_SOURCE_ITERATION || source == BR_SOURCE_SMOOTHING;
    if (friction && (scene->friction.law == BR_FRICTIONLESS || !scene->bending.modelled))
        return "the scene has no friction";
    switch (source) {
    case BR_SOURCE_ROUND_OFF:
        if (m->solver == &br_riccati)
            return "solver riccati has the least round-off, which is below the floor";
        if (m->solver == &br_auto)
            return "auto chooses a solver with the least round-off, which is below the floor";
        m->solver = &br_riccati;
        break;
    case BR_SOURCE_ITERATION:
        if (!m->friction->iterates)
            return "the friction law is solved directly";
        m->friction = direct(m->friction);
        break;
    case BR_SOURCE_SMOOTHING:
        if (!m->friction->needs_regularisation)
            return "the friction law is not smoothed";
        m->friction = br_friction_rules[0];
        break;
    case BR_SOURCE_LAG:
        if (!scene->contact.modelled || !scene->axial.modelled)
            return "the scene has no contact";
        if (m->contact->at_new_step || !m->scheme->may_lag)
            return "the method's contact is implicit";
        m->contact = br_contact_rule_find("implicit");
        break;
    case BR_SOURCE_TIME:
        m->scheme = refined->method.scheme;
        m->tolerance = refined->method.tolerance;
        m->contact = br_contact_rule_find("implicit");
        variant->steps = refined->steps;
        break;
    case BR_SOURCE_SPACE:
        variant->continuous = true;
        break;
    case BR_SOURCES:
        break;
    }
    return NULL;
}

/* ---- distances of two marches, or of a march from the solution: studies of one cell ---- */

/* `cases` distances, each in all norms. */
enum { MOST_CASES = BR_SOURCES + 3 };
struct distances {
    const struct br_split *split;
    struct br_study study[BR_MOST_NORMS][MOST_CASES];
    size_t steps[MOST_CASES]; /* of the cells */
    size_t cases;
};

static void distances_free(struct distances *d)
{
    for (size_t m = 0; d && m < d->split->norms; m++)
        for (size_t index = 0; index < d->cases; index++)
            br_study_clear(&d->study[m][index]);
    free(d);
}

/* Adds the distance of two links; returns its index. */
static size_t add_distance(struct distances *d, const struct br_variant *from,
                           const struct br_variant *to)
{
    const struct br_split *split = d->split;
    const size_t index = d->cases++;
    d->steps[index] = from->steps;
    for (size_t m = 0; m < split->norms; m++)
        d->study[m][index] = (struct br_study){
            .scene = split->scene,
            .norm = split->norm[m],
            .method = from->method,
            .reference_kind = to->continuous ? split->reference_kind : &br_reference_fine,
            .reference_method = to->method,
            .reference = {to->continuous ? 0 : split->at.n, to->continuous ? 0 : to->steps},
            .n_count = 1,
            .k_count = 1,
            .n = &split->at.n,
            .steps = &d->steps[index],
            .next_norm = m + 1 < split->norms ? &d->study[m + 1][index] : NULL,
        };
    return index;
}

/* The failure of a distance: of the reference, or of the cell. */
static const struct br_error *failure_of(const struct distances *d, size_t index)
{
    const struct br_study *s = &d->study[0][index];
    return s->failure.status || !s->cell ? &s->failure : &s->cell[0].failure;
}

static bool failed(const struct distances *d, size_t index)
{
    return failure_of(d, index)->status ||
           !isfinite(d->study[0][index].cell[0].error[BR_PART_TOTAL]);
}

/* ---- the refinement in time ---- */

/* The finest tolerance of a step: a digit or two above the round-off of strains. */
static const double finest_tolerance = 1e-11;

/* The least number of equal steps, and the least number of them for one step of the run. */
enum { FINE_STEPS = 20000, LEAST_RATIO = 8 };

static const double good_enough = 1e-8; /* relative to the solution */

static struct br_variant start(const struct br_split *split)
{
    return (struct br_variant){.method = split->method, .steps = split->at.steps};
}

/* The run without any source but the elements, marched by this scheme. */
static struct br_refinement refined_by(const struct br_split *split,
                                       const struct br_time_scheme *scheme)
{
    struct br_refinement r = {.variant = start(split)};
    struct br_variant variant = r.variant;
    r.variant.method.scheme = scheme;
    if (scheme->adaptive) {
        r.variant.method.tolerance = finest_tolerance;
        snprintf(r.name, sizeof r.name, "%s, tolerance %.0e", scheme->name, finest_tolerance);
    } else {
        r.variant.steps *= LEAST_RATIO;
        while (r.variant.steps < FINE_STEPS)
            r.variant.steps *= 2; /* even: a march of half as many steps gives its error */
        snprintf(r.name, sizeof r.name, "%s, k = %.3g s", scheme->name,
                 br_time_step(split->scene, r.variant.steps));
    }
    for (enum br_source source = 0; source < BR_SOURCE_SPACE; source++)
        take_away(source, split->scene, &r.variant, &variant);
    r.variant = variant;
    return r;
}

/* By norm and component. */
typedef double by_norm[BR_MOST_NORMS][BR_PARTS];

struct refining {
    int threads;
    struct br_observer observer;
    by_norm error;           /* bounds for the best refinement */
    double least;            /* the same, relative, in the first norm */
    struct br_error failure; /* the first */
};

static void take_errors(const struct distances *d, size_t index, by_norm error)
{
    for (size_t m = 0; m < d->split->norms; m++)
        memcpy(error[m], d->study[m][index].cell[0].error, sizeof error[m]);
}

/* Measures how far a march refined by a scheme is from one with ten times the tolerance, or half as
 * many steps, in the first norm and relative to the solution. Keeps the refinement and its errors
 * if they are the least so far; the first failure is kept in `failure`. */
static enum br_status try_refinement(struct br_split *split, const struct br_time_scheme *scheme,
                                     struct refining *r, struct br_error *err)
{
    const struct br_refinement fine = refined_by(split, scheme);
    struct br_variant coarse = fine.variant;
    coarse.method.tolerance *= scheme->adaptive ? 10 : 1;
    coarse.steps /= scheme->adaptive ? 1 : 2;
    struct distances *d = br_allocate(1, sizeof *d);
    if (!d)
        return br_no_memory(err, "the parts of the error");
    d->split = split;
    add_distance(d, &coarse, &fine.variant);
    const struct br_study *s = d->study[0];
    const enum br_status status = br_study_run_each(d->study[0], 1, r->threads, &r->observer, err);
    const bool is_known = !status && !failed(d, 0);
    const double error = is_known ? s->cell[0].error[BR_PART_TOTAL] / s->reference_scale : NAN;
    if (!status && !r->failure.status && !is_known)
        r->failure = *failure_of(d, 0);
    else if (!status && !r->failure.status && !(s->reference_scale > 0))
        br_fail(&r->failure, BR_NOT_FINITE, "the solution is zero: no error is relative to it");
    if (error < r->least) {
        r->least = error;
        split->refined = fine;
        take_errors(d, 0, r->error);
    }
    distances_free(d);
    return status;
}

/* The first refinement that is good enough, or the best: tries the adaptive schemes, then the one
 * of the highest order. */
static enum br_status refine(struct br_split *split, struct refining *r, struct br_error *err)
{
    const struct br_time_scheme *highest = br_highest_scheme();
    enum br_status status = BR_OK;
    r->least = INFINITY;
    for (const struct br_time_scheme *const *s = br_time_schemes; *s && !status; s++)
        if ((*s)->adaptive && !(r->least <= good_enough))
            status = try_refinement(split, *s, r, err);
    if (!status && !(r->least <= good_enough))
        status = try_refinement(split, highest, r, err);
    if (status || isfinite(r->least))
        return status;
    return br_fail(err, r->failure.status ? r->failure.status : BR_NOT_FINITE,
                   "no march without time error: %.900s", r->failure.message);
}

/* ---- the chain ---- */

struct chain {
    struct distances *d;
    size_t whole;                /* case: the run and the solution */
    size_t solver_difference[2]; /* cases: riccati against plain, for the run and before the first
                        source in time */
    size_t link[BR_SOURCES];     /* cases */
    struct refining refining;
};

/* Two solvers of the same step: their difference is round-off, as the march amplifies it. */
static size_t add_solver_difference(struct chain *c, const struct br_variant *variant)
{
    struct br_variant plain = *variant, riccati = *variant;
    plain.method.solver = &br_plain;
    riccati.method.solver = &br_riccati;
    return add_distance(c->d, &plain, &riccati);
}

static void add_links(struct br_split *split, struct chain *c)
{
    struct br_variant variant = start(split);
    const struct br_variant solution = {.method = split->method, .continuous = true};
    c->whole = add_distance(c->d, &variant, &solution);
    c->solver_difference[0] = add_solver_difference(c, &variant);
    for (enum br_source source = 0; source < BR_SOURCES; source++) {
        struct br_share *share = &split->share[source];
        struct br_variant next = variant;
        share->name = names[source];
        share->none = take_away(source, split->scene, &split->refined.variant, &next);
        if (source == BR_SOURCE_TIME)
            c->solver_difference[1] = add_solver_difference(c, &variant);
        if (!share->none)
            c->link[source] = add_distance(c->d, &variant, &next);
        variant = next;
    }
}

/* Fails if any link has failed. */
static enum br_status check_links(const struct br_split *split, const struct chain *c,
                                  struct br_error *err)
{
    const struct br_error *whole = failure_of(c->d, c->whole);
    if (whole->status)
        return br_fail(err, whole->status, "%.1000s", whole->message);
    for (size_t i = 0; i < BR_SOURCES; i++) {
        if (split->share[i].none || !failed(c->d, c->link[i]))
            continue;
        const struct br_error *failure = failure_of(c->d, c->link[i]);
        return br_fail(err, failure->status ? failure->status : BR_NOT_FINITE,
                       "the part of the error called %s: %.900s", names[i],
                       failure->status ? failure->message : "it is not a number");
    }
    return BR_OK;
}

/* The round-off of a march, measured or, where the difference of the solvers fails, predicted; and
 * the errors of the refined march and of the reference. */
static double floor_of(const struct br_split *split, const struct chain *c,
                       const struct br_study *s, bool in_time, size_t norm, enum br_part part)
{
    const size_t solver_difference = c->solver_difference[in_time];
    double floor = failed(c->d, solver_difference)
                       ? split->predicted_round_off * split->scale[norm]
                       : 2 * c->d->study[norm][solver_difference].cell[0].error[part];
    if (in_time)
        floor += c->refining.error[norm][part];
    if (s->reference_kind == split->reference_kind)
        floor += br_norm_of_constant(s->norm, s->scene, s->reference_report.own_error, part);
    return floor;
}

/* in_time: the component needs the refined march. */
static void set_share(const struct br_split *split, const struct chain *c, size_t index,
                      bool in_time, struct br_share *share)
{
    const struct br_study *s = &c->d->study[0][index];
    take_errors(c->d, index, share->error);
    for (size_t m = 0; m < split->norms; m++)
        for (enum br_part part = 0; part < BR_PARTS; part++)
            share->floor[m][part] = floor_of(split, c, &c->d->study[m][index], in_time, m, part);
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        share->tip[kind] = s->cell[0].tip[kind] - s->reference_tip[kind];
}

static void set_whole(struct br_split *split, const struct chain *c)
{
    const struct br_study *s = &c->d->study[0][c->whole];
    const struct br_planned_march run = br_planned(split->scene, &split->method, split->at);
    split->unstable = s->cell[0].unstable;
    split->predicted_round_off = br_predict_round_off(&run);
    for (size_t m = 0; m < split->norms; m++)
        split->scale[m] = c->d->study[m][c->whole].reference_scale;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        split->tip[kind] = s->cell[0].tip[kind];
        split->solution_tip[kind] = s->reference_tip[kind];
    }
    split->sum.name = "sum";
    split->whole.name = "whole";
    set_share(split, c, c->whole, false, &split->whole);
}

static void set_shares(struct br_split *split, const struct chain *c)
{
    for (size_t i = 0; i < BR_SOURCES; i++) {
        struct br_share *share = &split->share[i];
        if (!share->none)
            set_share(split, c, c->link[i], i >= BR_SOURCE_TIME, share);
        for (size_t m = 0; m < split->norms; m++)
            for (enum br_part part = 0; part < BR_PARTS; part++)
                split->sum.error[m][part] += share->error[m][part];
        for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
            split->sum.tip[kind] += share->tip[kind];
    }
}

enum br_status br_split_run(struct br_split *split, int threads, const struct br_observer *observer,
                            struct br_error *err)
{
    struct chain c = {.refining.threads = threads};
    split->reference_kind = br_reference_best(split->scene);
    c.refining.observer = observer ? *observer : (struct br_observer){0};
    c.refining.observer.progress = NULL; /* the chain takes longer */
    enum br_status status = refine(split, &c.refining, err);
    if (status)
        return status;
    c.d = br_allocate(1, sizeof *c.d);
    if (!c.d)
        return br_no_memory(err, "the parts of the error");
    c.d->split = split;
    add_links(split, &c);
    status = br_study_run_each(c.d->study[0], c.d->cases, threads, observer, err);
    if (!status)
        status = check_links(split, &c, err);
    if (!status) {
        set_whole(split, &c);
        set_shares(split, &c);
    }
    distances_free(c.d);
    return status;
}
