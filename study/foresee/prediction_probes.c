/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/foresee/prediction_probes.h"
#include "study/foresee/prediction.h"
#include "study/grid/sweep.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>

/* The overhead of a solve, in elements; and the cost of an element whose load must be evaluated at
 * each time level, in elements. */
static const double overhead = 700, evaluated = 30;

/* Work (elements times solves) of all probes: at least, at most, and as a share of the run's. */
static const double least_work = 1e7, most_work = 5e7, most_share = 0.5;
static const double chosen_work = 6e7; /* for an adaptive run */
static const double chosen_stages = 12;
static const double time_share = 0.5, start_share = 0.2, space_share = 0.3;

enum {
    SPACE_N = 128,
    TIME_N = 32,
    MOST_REFINED = 32,
    FINE_N = 32,
    MANY_N = 1000,
    TOLERANCE_LEVELS = 24,
    LEAST_CHOSEN = 40,
    FIRST_STEPS = 4,
    FIRST_REFINED = 1024
};

/* A reference is sure enough if its check differs from it by at most these shares of the run's
 * error or of the solution. */
static const double sure = 0.2, negligible = 1e-5;

/* Tolerances: a probe for extrapolation has at least `loosest`; a reference divides the run's by
 * `tighter`, and its check by the square root of `tighter`. */
static const double loosest = 1e-4, tighter = 25, tightest = 1e-12;

/* The tolerance of a reference for a run with equal steps. */
static const double tight = 1e-6;

static double stages(const struct br_method *m)
{
    return m->scheme->adaptive ? chosen_stages : br_time_scheme_stages(m->scheme);
}

static bool is_evaluated(const struct br_load *load)
{
    bool anew = false;
    for (size_t i = 0; i < BR_LOAD_TERMS; i++)
        anew |= load->term[i].space.uses_x && load->term[i].space.uses_t;
    return anew;
}

/* The work of a solve on so many elements. */
static double solve(const struct br_planned_march *o, double n)
{
    const bool anew = (o->scene->axial.modelled && is_evaluated(&o->scene->axial.load)) ||
                      (o->scene->bending.modelled && is_evaluated(&o->scene->bending.load));
    return n * (anew ? evaluated : 1) + overhead;
}

static double budget(const struct br_planned_march *o)
{
    const double own = solve(o, (double)o->n) * (double)o->steps * stages(o->method);
    if (o->budget > 0)
        return o->budget;
    return o->method->scheme->adaptive ? chosen_work
                                       : fmin(fmax(most_share * own, least_work), most_work);
}

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* ---- methods ---- */

bool br_follows_at_once(const struct br_scene *s, double k)
{
    return s->bending.modelled && s->density == 0 &&
           s->bending.viscosity <= k * s->bending.stiffness && s->friction.law != BR_FRICTIONLESS;
}

static bool follows_at_once(const struct br_planned_march *o)
{
    return br_follows_at_once(o->scene, br_time_step(o->scene, o->steps));
}

struct br_method br_accurate_method(const struct br_method *own, const char *scheme)
{
    struct br_method m = *own;
    m.scheme = br_time_scheme_find(scheme);
    m.solver = br_linear_solvers[0];
    m.contact = br_contact_rule_find("implicit");
    if (m.friction->iterates)
        m.friction = br_friction_rules[0];
    m.most_steps = 0;
    return m;
}

/* The most accurate method with equal steps. */
static struct br_method best_method(const struct br_planned_march *o)
{
    return br_accurate_method(o->method, follows_at_once(o) ? "euler" : "esdirk4");
}

/* The accurate method with adaptive steps: divides the run's tolerance by `times`. */
static struct br_method tight_method(const struct br_method *own, double times)
{
    const double from = own->scheme->adaptive ? own->tolerance : tight * tighter;
    struct br_method m = br_accurate_method(own, "adaptive");
    m.tolerance = fmax(from / times, tightest);
    return m;
}

/* A study of the whole scene against a fine run. */
static void set_study(struct br_probe *p, const struct br_planned_march *o,
                      const struct br_method *method, const struct br_method *reference,
                      struct br_resolution fine)
{
    p->active = true;
    p->scene = *o->scene;
    p->study = (struct br_study){
        .scene = &p->scene,
        .norm = &br_norm_l2,
        .method = *method,
        .judge = &br_judge_fine,
        .reference_method = *reference,
        .reference = fine,
        .n_count = 1,
        .k_count = 1,
        .engine = {br_lockstep, NULL}, /* only the first rank predicts */
        .n = p->n,
        .steps = p->steps,
    };
}

/* ---- the run itself ---- */

/* Elements and steps of a reference over those of the run. */
struct finer {
    size_t elements, steps;
};

/* The refinement in space; unless n is large, the check's mesh is finer than the run's, too. */
static size_t refinement(size_t n)
{
    size_t ratio = n < MANY_N ? 4 : 2;
    while (ratio < MOST_REFINED && n * ratio < FINE_N)
        ratio *= 2;
    return ratio;
}

static void set_whole_cells(struct br_probe *p, const struct br_planned_march *o,
                            const struct br_method *check, const struct br_method *reference,
                            struct finer by)
{
    const size_t finer = by.elements, shorter = by.steps, steps = p->steps[BR_WHOLE_RUN];
    const size_t fine = o->n * finer, half = steps * shorter / 2;
    const size_t n[] = {o->n, fine / 2, fine, o->n, fine};
    const size_t times[] = {steps, half, steps, half, half};
    struct br_method own_steps = *o->method;
    own_steps.solver = br_linear_solvers[0];
    own_steps.most_steps = check->most_steps;
    const struct br_method method[] = {*o->method, *check, own_steps, *check, *check};
    for (int i = 0; i < BR_WHOLE_CELLS; i++) {
        p->n[i] = n[i];
        p->steps[i] = check->scheme->adaptive ? steps : times[i];
        p->method[i] = method[i];
    }
    p->method[BR_WHOLE_RUN].most_steps = check->most_steps;
    p->measured = true;
    set_study(p, o, o->method, reference,
              (struct br_resolution){fine, check->scheme->adaptive ? steps : steps * shorter});
    p->study.path = true;
    p->study.n_count = p->study.k_count = BR_WHOLE_CELLS;
    p->study.cell_method = p->method;
}

/* Work of the run, of its steps on the fine mesh, and of the marches by the reference's method. */
static double whole_work(const struct br_planned_march *o, const struct br_method *best,
                         struct finer by)
{
    const double n = (double)o->n, fine = n * (double)by.elements;
    const double own = (solve(o, n) + solve(o, fine)) * stages(o->method);
    const double others = (1.5 * solve(o, fine) + (solve(o, fine / 2) + solve(o, n)) / 2) *
                          (double)by.steps * stages(best);
    return (own + others) * (double)o->steps;
}

static bool is_affordable(const struct br_planned_march *o, struct finer by)
{
    const struct br_method best = best_method(o);
    return whole_work(o, &best, by) <= budget(o);
}

/* The most steps of an adaptive scheme, within a share of the budget. */
static size_t most_steps(const struct br_planned_march *o, double n)
{
    return 1 + (size_t)(budget(o) / 4 / (solve(o, n) * chosen_stages));
}

/* Sets nothing if there are so many time levels that a tolerance has little effect. */
static void set_tight(struct br_probe *p, const struct br_planned_march *o)
{
    const size_t finer = refinement(o->n), most = most_steps(o, (double)(o->n * finer));
    struct br_method check = tight_method(o->method, sqrt(tighter));
    struct br_method reference = tight_method(o->method, tighter);
    check.most_steps = reference.most_steps = most;
    p->steps[BR_WHOLE_RUN] =
        o->method->scheme->adaptive ? least(o->steps, TOLERANCE_LEVELS) : o->steps;
    if (!o->method->scheme->adaptive && follows_at_once(o))
        return;
    if (p->steps[BR_WHOLE_RUN] + LEAST_CHOSEN <= most)
        set_whole_cells(p, o, &check, &reference, (struct finer){finer, 1});
}

/* Against equal steps; for an adaptive run, against as many as the budget allows. */
static void set_whole(struct br_probe *p, const struct br_planned_march *o, struct finer by)
{
    struct br_method best = best_method(o);
    p->steps[BR_WHOLE_RUN] = o->steps;
    if (o->method->scheme->adaptive) {
        best.most_steps = most_steps(o, (double)(o->n * by.elements));
        p->steps[BR_WHOLE_RUN] = least(o->steps, TOLERANCE_LEVELS);
        by.steps = 2 * (size_t)fmax(2, (double)best.most_steps / (double)p->steps[BR_WHOLE_RUN]);
    }
    set_whole_cells(p, o, &best, &best, by);
}

/* ---- time ---- */

/* The few steps of the run against many times as many. A second cell between them has more levels,
 * at which the size of the solution is sampled. */
static void measure_time(struct br_probe *p, const struct br_planned_march *o, double most)
{
    const struct br_method best = best_method(o);
    const double a_step = (double)o->steps * stages(&best);
    const size_t ratio = a_step * 31 <= most ? 27 : a_step * 11 <= most ? 9 : 3;
    p->measured = true;
    p->ratio = (double)ratio;
    p->beyond = 1;
    p->steps[0] = o->steps;
    p->steps[1] = o->steps * ratio / 3;
    set_study(p, o, o->method, &best, (struct br_resolution){p->n[0], o->steps * ratio});
    p->study.k_count = ratio > 3 ? 2 : 1;
}

static bool is_prime(size_t a)
{
    size_t divisor = 2;
    while (divisor * divisor <= a && a % divisor > 0)
        divisor++;
    return a > 1 && divisor * divisor > a;
}

/* a and 2a steps against 8a steps. A prime a avoids levels at which a periodic load is zero or
 * largest. */
static void extrapolate_time(struct br_probe *p, const struct br_planned_march *o, double most)
{
    const struct br_method best = best_method(o);
    size_t a = (size_t)(most / (3 * stages(o->method) + 8 * stages(&best))) | 1;
    while (a > 3 && !is_prime(a))
        a -= 2;
    p->ratio = 4;
    p->beyond = (double)o->steps / (2 * (double)a);
    p->steps[0] = a;
    p->steps[1] = 2 * a;
    set_study(p, o, o->method, &best, (struct br_resolution){p->n[0], 8 * a});
    p->study.k_count = 2;
}

static void compare_tolerances(struct br_probe *p, const struct br_planned_march *o)
{
    struct br_method method = *o->method;
    method.tolerance = fmax(method.tolerance, loosest);
    method.most_steps = most_steps(o, (double)p->n[0]);
    p->measured = method.tolerance == o->method->tolerance;
    p->beyond = method.tolerance / o->method->tolerance;
    p->ratio = tighter;
    p->steps[0] = TOLERANCE_LEVELS;
    struct br_method reference = tight_method(&method, tighter);
    reference.most_steps = method.most_steps;
    set_study(p, o, &method, &reference, (struct br_resolution){p->n[0], TOLERANCE_LEVELS});
}

static void set_time(struct br_probe *p, const struct br_planned_march *o)
{
    const struct br_method best = best_method(o);
    p->n[0] = least(o->n, TIME_N);
    const double most = time_share * budget(o) / solve(o, (double)p->n[0]);
    if (o->method->scheme->adaptive)
        compare_tolerances(p, o);
    else if ((double)o->steps * (stages(o->method) + 3 * stages(&best)) <= most)
        measure_time(p, o, most);
    else
        extrapolate_time(p, o, most);
}

/* The error of an iteration accumulates over the steps; in an extrapolation from few steps other
 * errors would hide it. */
static void set_iteration(struct br_probe *p, const struct br_probe *time,
                          const struct br_planned_march *o)
{
    struct br_method direct = *o->method;
    direct.friction = br_friction_rules[0];
    if (time->measured || o->scene->friction.law == BR_FRICTIONLESS ||
        !o->method->friction->iterates)
        return;
    p->beyond = time->beyond;
    p->n[0] = time->n[0];
    p->steps[0] = time->steps[1];
    set_study(p, o, o->method, &direct, (struct br_resolution){p->n[0], p->steps[0]});
}

/* The first steps of the run against adaptive steps, which resolve what decays within a step; if
 * `equal`, more first steps against smaller equal steps. If the beam follows its load at once, few
 * steps against far smaller ones: a tip that slips at t = 0 may stick soon after. */
static void set_start(struct br_probe *p, const struct br_planned_march *o, bool equal)
{
    const bool at_once = follows_at_once(o);
    const struct br_method best = best_method(o);
    struct br_method fine = equal ? best : tight_method(o->method, tighter);
    p->n[0] = least(o->n, TIME_N);
    const double most = start_share * budget(o) / solve(o, (double)p->n[0]);
    const double many =
        equal && !at_once ? most / (stages(o->method) + 3 * stages(&best)) + 1 : FIRST_STEPS;
    const size_t finer = at_once ? FIRST_REFINED : equal ? 3 : 1;
    fine.most_steps = most_steps(o, (double)p->n[0]);
    p->steps[0] = least(o->steps, (size_t)many);
    p->measured = true;
    p->ratio = 3;
    set_study(p, o, o->method, &fine, (struct br_resolution){p->n[0], finer * p->steps[0]});
    p->scene.duration *= (double)p->steps[0] / (double)o->steps;
}

/* ---- space ---- */

static void set_space(struct br_probe *p, const struct br_planned_march *o)
{
    const struct br_method best = best_method(o);
    size_t finest = 2 * SPACE_N;
    p->measured = o->n <= SPACE_N;
    if (p->measured) {
        size_t ratio = 4;
        while (ratio < MOST_REFINED && o->n * ratio < SPACE_N)
            ratio *= 2;
        finest = ratio * o->n;
    }
    p->n[0] = p->measured ? o->n : SPACE_N / 2;
    p->n[1] = finest / 2;
    p->ratio = (double)finest / (double)p->n[p->measured ? 0 : 1];
    p->beyond = p->measured ? 1 : (double)o->n / (double)p->n[1];
    const double a_step =
        (solve(o, (double)finest) + solve(o, (double)p->n[0]) + solve(o, (double)p->n[1])) *
        stages(&best);
    /* For an adaptive run, the levels say nothing about the number of steps. */
    p->steps[0] = least(o->method->scheme->adaptive ? SIZE_MAX : o->steps,
                        (size_t)(space_share * budget(o) / a_step) + 1);
    set_study(p, o, &best, &best, (struct br_resolution){finest, p->steps[0]});
    p->study.n_count = 2;
}

/* ---- marching ---- */

bool br_probe_failed(const struct br_probe *p, char why[200])
{
    const struct br_study *s = &p->study;
    const struct br_error *failure = &s->failure;
    for (size_t i = 0; p->active && !failure->status && i < br_study_cells(s); i++) {
        if (s->path && (i == BR_WHOLE_TIME || i == BR_WHOLE_SPACE))
            continue; /* these only split the error into time and space */
        if (s->cell[i].unstable) {
            snprintf(why, 200, "the lagged contact is beyond its stability limit%s",
                     p->measured ? "" : " at the steps of a cheap march");
            return true;
        }
        failure = &s->cell[i].failure;
    }
    if (!p->active || !failure->status)
        return false;
    snprintf(why, 200, "a march that predicts it failed: %.150s", failure->message);
    return true;
}

static void forget(struct br_probe *p)
{
    br_study_clear(&p->study);
    *p = (struct br_probe){0};
}

/* Marches a probe if it is active. A reference with too many steps is a failure of the probe, not
 * of the call. */
static enum br_status march(struct br_probe *p, struct br_error *err)
{
    struct br_error failure = {0};
    if (!p->active || !br_study_run_each(&p->study, 1, 1, NULL, &failure))
        return BR_OK;
    p->study.failure = failure;             /* it has no cells any more */
    return failure.status == BR_INTERRUPTED /* by itself: there is no observer */
               ? BR_OK
               : br_fail(err, failure.status, "%s", failure.message);
}

/* Marches a probe, and clears it if it fails. */
static enum br_status try_probe(struct br_probe *p, struct br_error *err)
{
    char why[200];
    const enum br_status status = march(p, err);
    if (!status && br_probe_failed(p, why))
        forget(p);
    return status;
}

/* Whether the check is near enough to the reference. */
static bool is_sure(const struct br_probe *p)
{
    bool all = p->active;
    for (int kind = BR_AXIAL; kind <= BR_BENDING && all; kind++) {
        const enum br_part part = kind == BR_AXIAL ? BR_PART_AXIAL : BR_PART_BENDING;
        const double error = p->study.cell[BR_WHOLE_RUN].error[part];
        all = p->study.cell[BR_WHOLE_CHECK].error[part] <=
              fmax(sure * error, negligible * p->study.reference_size[kind]);
    }
    return all;
}

/* The largest, over the fields, of a cell's distance from the reference, relative. */
static double off(const struct br_probe *p, enum br_whole_cell cell)
{
    const double *error = p->study.cell[cell].error, *size = p->study.reference_size;
    const double axial = size[BR_AXIAL] > 0 ? error[BR_PART_AXIAL] / size[BR_AXIAL] : 0;
    const double bending = size[BR_BENDING] > 0 ? error[BR_PART_BENDING] / size[BR_BENDING] : 0;
    return fmax(axial, bending);
}

/* Refines the elements and steps of the reference; if the budget does not allow both, the one of
 * which the last reference was less sure. False: the budget allows none. */
static bool refine(const struct br_planned_march *o, const struct br_probe *last, struct finer *by)
{
    const struct finer both = {4 * by->elements, 4 * by->steps}, space = {both.elements, by->steps},
                       time = {by->elements, both.steps};
    const bool of_space = 2 * off(last, BR_WHOLE_STEPS) < off(last, BR_WHOLE_CHECK);
    const struct finer tries[] = {both, of_space ? space : time, of_space ? time : space};
    for (size_t i = 0; i < sizeof tries / sizeof *tries; i++)
        if (is_affordable(o, tries[i])) {
            *by = tries[i];
            return true;
        }
    return false;
}

/* The refinement of the first reference. Two references that both step over a peak of the load
 * agree, but friction keeps the effect of the peak: a beam that follows its load at once therefore
 * gets as many steps as the budget allows. */
static struct finer first_refinement(const struct br_planned_march *o)
{
    struct finer by = {refinement(o->n), 4};
    while (follows_at_once(o) && is_affordable(o, (struct finer){by.elements, 4 * by.steps}))
        by.steps *= 4;
    return by;
}

/* Refines the reference until it is sure or the budget is used up. */
static enum br_status march_whole(struct br_probe *whole, const struct br_planned_march *o,
                                  struct br_error *err)
{
    struct finer by = first_refinement(o);
    enum br_status status = BR_OK;
    bool more = is_affordable(o, by);
    while (more && !status) {
        forget(whole);
        set_whole(whole, o, by);
        status = try_probe(whole, err);
        more = !status && whole->active && !is_sure(whole) && refine(o, whole, &by);
    }
    return status;
}

static enum br_status march_itself(struct br_probe *probe, const struct br_planned_march *o,
                                   struct br_error *err)
{
    struct br_probe *chosen = &probe[BR_PROBE_TIGHT], *whole = &probe[BR_PROBE_WHOLE];
    set_tight(chosen, o);
    const enum br_status status = try_probe(chosen, err);
    if (status || is_sure(chosen))
        return status;
    if (!o->method->scheme->adaptive)
        return march_whole(whole, o, err);
    if (chosen->active)
        return BR_OK;
    set_whole(whole, o, (struct finer){.elements = refinement(o->n)});
    return try_probe(whole, err);
}

/* The start of the run, by adaptive steps where possible. */
static enum br_status march_start(struct br_probe *probe, const struct br_planned_march *o,
                                  struct br_error *err)
{
    struct br_probe *start = &probe[BR_PROBE_START];
    const bool at_once = follows_at_once(o);
    enum br_status status = BR_OK;
    if (!at_once) {
        set_start(start, o, false);
        status = try_probe(start, err);
    }
    if (status || start->active || (probe[BR_PROBE_WHOLE].active && !at_once))
        return status;
    set_start(start, o, true);
    return march(start, err);
}

enum br_status br_probes_march(struct br_probe_set *set, const struct br_planned_march *o,
                               struct br_error *err)
{
    *set = (struct br_probe_set){.planned = o};
    struct br_probe *probe = set->probe;
    enum br_status status = march_itself(probe, o, err);
    if (status || probe[BR_PROBE_TIGHT].active)
        return status;
    if (!probe[BR_PROBE_WHOLE].active) {
        set_time(&probe[BR_PROBE_TIME], o);
        set_iteration(&probe[BR_PROBE_ITERATION], &probe[BR_PROBE_TIME], o);
        set_space(&probe[BR_PROBE_SPACE], o);
        for (int i = BR_PROBE_TIME; i <= BR_PROBE_SPACE && !status; i++)
            status = march(&probe[i], err);
    }
    return status || o->method->scheme->adaptive ? status : march_start(probe, o, err);
}

void br_probes_clear(struct br_probe_set *set)
{
    for (int i = 0; i < BR_PROBES; i++)
        br_study_clear(&set->probe[i].study);
}
