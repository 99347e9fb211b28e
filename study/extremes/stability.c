/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>

#include "base/each.h"
#include "solver/laws.h"
#include "study/extremes/extremes.h"
#include "study/run/run.h"
#include "study/scene/resolution.h"

const char *const br_stability_words[] = {"stable", "unstable", "refused"};

/* ---- one march ---- */

double br_stability_most(const struct br_method *method)
{
    return method->scheme->may_lag ? 0.1 : 10;
}

enum br_stability_outcome br_stability_outcome_of(const struct br_method *method, double share)
{
    return share <= br_stability_most(method) ? BR_STABLE : BR_UNSTABLE; /* NaN is unstable */
}

/* The workspace of a column. */
struct stability_work {
    const struct br_stability *s;
    const struct br_stability_plane *plane;
    struct br_stability_column *column;
    struct br_scene scene; /* borrows; with the column's c_H */
    struct br_observer stop;
    struct br_run_report *report; /* owned */
};

static enum br_status march(struct stability_work *w, const struct br_method *method, size_t steps,
                            struct br_error *err)
{
    const struct br_run_request request = {
        .scene = &w->scene,
        .wanted = (w->scene.axial.modelled ? BR_WANT_AXIAL : 0) |
                  (w->scene.bending.modelled ? BR_WANT_BENDING : 0),
        .method = *method,
        .n = w->column->n,
        .steps = steps,
        .energies = true,
        .progress = w->stop.stop ? &w->stop : NULL,
    };
    return br_run(&request, w->report, err);
}

static double put_in(const struct br_run_report *r)
{
    return br_energy_put_in(&r->energy_start, &r->work, BR_AXIAL) +
           br_energy_put_in(&r->energy_start, &r->work, BR_BENDING);
}

/* part / whole, where nothing of nothing is 0. */
static double share_of(double part, double whole)
{
    return part == 0 ? 0 : part / whole;
}

/* What implicit Euler has added, by its balance, to the field that got the larger share. */
static double added(const struct br_run_report *r)
{
    double share = 0;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        share = br_worst(share, share_of(br_energy_added(&r->work, kind),
                                         br_energy_put_in(&r->energy_start, &r->work, kind)));
    return share;
}

/* The share of energy that decides on a march. Other schemes than Euler's need a second march,
 * which replaces the report. */
static enum br_status measure(struct stability_work *w, const struct br_method *method,
                              size_t steps, double *share, struct br_error *err)
{
    const struct br_run_report *r = w->report;
    if (method->scheme->may_lag) {
        *share = added(r);
        return BR_OK;
    }
    const double energy = br_energy_total(&r->energy_now), own = put_in(r);
    struct br_method euler = br_method_default();
    euler.contact = br_contact_rule_find("implicit");
    euler.axial_degree = method->axial_degree;
    const enum br_status status = march(w, &euler, steps, err);
    *share = share_of(energy, own + put_in(r));
    return status;
}

/* A march that cannot begin is a refusal, one that stops a break; both are results. */
static enum br_status try_steps(struct stability_work *w, struct br_stability_point *p,
                                struct br_error *err)
{
    const struct br_method *method = &w->plane->by->method;
    enum br_status status = march(w, method, p->steps, err);
    p->share = NAN;
    p->outcome = status ? BR_REFUSED : BR_UNSTABLE;
    if (status == BR_BAD_INPUT || status == BR_SINGULAR || (!status && w->report->failure.status)) {
        const char *why = status ? err->message : w->report->failure.message;
        snprintf(p->why, sizeof p->why, "%.150s", why);
        return BR_OK;
    }
    if (!status)
        status = measure(w, method, p->steps, &p->share, err);
    if (!status)
        p->outcome = br_stability_outcome_of(method, p->share);
    return status;
}

/* ---- a column: from the smallest step on ---- */

/* Bisects between a number of steps that is stable and a smaller one that is not. */
static enum br_status find_largest(struct stability_work *w, size_t stable, size_t broken,
                                   struct br_error *err)
{
    enum br_status status = BR_OK;
    while (stable - broken > 1 && (double)stable > 1.02 * (double)broken && !status) {
        struct br_stability_point p = {.steps =
                                           (size_t)llround(sqrt((double)stable * (double)broken))};
        if (p.steps <= broken || p.steps >= stable)
            p.steps = broken + (stable - broken) / 2;
        status = try_steps(w, &p, err);
        if (p.outcome == BR_STABLE) {
            stable = p.steps;
        } else {
            broken = p.steps;
            w->column->by = p.outcome;
        }
    }
    w->column->largest = br_time_step(w->s->scene, stable);
    w->column->broken = br_time_step(w->s->scene, broken);
    return status;
}

static enum br_status fill_column(struct stability_work *w, struct br_error *err)
{
    const struct br_stability *s = w->s;
    struct br_stability_column *c = w->column;
    enum br_status status = BR_OK;
    size_t stable = 0;
    for (size_t i = 0; i < s->rows && !status; i++) {
        c->point[i].steps = s->steps[i];
        status = try_steps(w, &c->point[i], err);
    }
    while (stable < s->rows && c->point[stable].outcome == BR_STABLE)
        stable++;
    c->largest = stable ? br_time_step(s->scene, s->steps[stable - 1]) : 0;
    c->broken = stable < s->rows ? br_time_step(s->scene, s->steps[stable]) : INFINITY;
    c->by = stable < s->rows ? c->point[stable].outcome : BR_STABLE;
    return status || stable == 0 || stable == s->rows
               ? status
               : find_largest(w, s->steps[stable - 1], s->steps[stable], err);
}

/* By theory, for a contact that stays closed. */
static double predict(const struct br_stability *s, const struct br_method *method,
                      const struct br_stability_column *c)
{
    if (isnan(c->stiffness) || method->contact->at_new_step)
        return INFINITY;
    const struct br_field field =
        br_field_of_scene(s->scene, BR_AXIAL, c->n, 1, method->axial_degree);
    const double limit = br_contact_limit_step(&field, c->stiffness);
    return limit > 1e6 * s->scene->duration ? INFINITY : limit;
}

struct loop {
    struct br_stability *s;
    const struct br_observer *observer;
};

static enum br_status take_turn(void *self, size_t i, struct br_error *err)
{
    const struct loop *l = self;
    struct br_stability_plane *plane = l->s->plane;
    for (; i >= plane->columns; plane++)
        i -= plane->columns;
    struct stability_work w = {
        .s = l->s, .plane = plane, .column = &plane->column[i], .scene = *l->s->scene};
    if (l->observer)
        w.stop = (struct br_observer){.stop = l->observer->stop, .self = l->observer->self};
    if (plane->over_stiffness)
        w.scene.contact.stiffness = w.column->stiffness;
    w.report = br_allocate(1, sizeof *w.report);
    enum br_status status = w.report ? BR_OK : br_no_memory(err, "a march");
    if (!status)
        status = fill_column(&w, err);
    w.column->predicted = predict(l->s, &plane->by->method, w.column);
    free(w.report);
    return status;
}

/* ---- what is tried ---- */

static const size_t usual_n[] = {10, 20, 50, 100, 200};
static const size_t usual_steps[] = {10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000};
enum { STIFFNESSES = 13, OWN = 4, A_DECADE = 2 }; /* column OWN has the scene's c_H */

#define COUNT(list) (sizeof(list) / sizeof *(list))

/* A plane over the numbers n; with one number, over stiffnesses on that mesh if it is asked for. */
static enum br_status add_plane(struct br_stability *s, const struct br_named_method *by,
                                bool over_stiffness, const size_t *n, size_t n_count,
                                struct br_error *err)
{
    struct br_stability_plane *p = &s->plane[s->planes++];
    p->by = by;
    p->over_stiffness = over_stiffness;
    p->columns = over_stiffness ? STIFFNESSES : n_count;
    p->column = br_allocate(p->columns, sizeof *p->column);
    p->point = br_allocate(p->columns * s->rows, sizeof *p->point);
    if (!p->column || !p->point)
        return br_no_memory(err, "the planes of stability");
    for (size_t i = 0; i < p->columns; i++)
        p->column[i] = (struct br_stability_column){
            .n = n[over_stiffness ? 0 : i],
            .stiffness = over_stiffness ? s->own * pow(10, ((double)i - OWN) / A_DECADE) : s->own,
            .point = p->point + i * s->rows,
        };
    return BR_OK;
}

static enum br_status take_steps(struct br_stability *s, const struct br_extremes_job *job,
                                 struct br_error *err)
{
    const size_t *steps = job->step_count ? job->steps : usual_steps;
    s->rows = job->step_count ? job->step_count : COUNT(usual_steps);
    s->steps = br_allocate(s->rows, sizeof *s->steps);
    if (!s->steps)
        return br_no_memory(err, "the time steps");
    for (size_t i = 0; i < s->rows; i++)
        s->steps[i] = steps[i];
    br_sort_counts(s->steps, s->rows);
    for (size_t i = 0; i < s->rows / 2; i++) {
        const size_t last = s->steps[s->rows - 1 - i];
        s->steps[s->rows - 1 - i] = s->steps[i];
        s->steps[i] = last;
    }
    return BR_OK;
}

static enum br_status take_methods(struct br_stability *s, const struct br_extremes_job *job,
                                   struct br_error *err)
{
    if (job->methods)
        s->method = *job->methods;
    if (!s->method.count)
        br_named_methods_add(&s->method, NULL, "euler+lagged");
    return s->method.count <= BR_STABILITY_METHODS
               ? BR_OK
               : br_fail(err, BR_BAD_INPUT, "--methods: found %zu methods, expected at most %d",
                         s->method.count, BR_STABILITY_METHODS);
}

static enum br_status prepare(struct br_stability *s, const struct br_extremes_job *job,
                              struct br_error *err)
{
    const size_t *n = job->n_count ? job->n : usual_n;
    const size_t n_count = job->n_count ? job->n_count : COUNT(usual_n);
    s->scene = job->scene[0];
    const struct br_contact *contact = &s->scene->contact;
    s->own = contact->modelled ? br_contact_stiffness(contact) : NAN;
    if (take_steps(s, job, err) || take_methods(s, job, err))
        return err->status;
    for (const struct br_named_method *m = s->method.list; m < s->method.list + s->method.count;
         m++)
        if (br_method_check(&m->method, s->scene, err) || add_plane(s, m, false, n, n_count, err) ||
            (s->own > 0 && add_plane(s, m, true, n, n_count, err)))
            return err->status;
    return BR_OK;
}

enum br_status br_stability_run(struct br_stability *s, const struct br_extremes_job *job,
                                struct br_error *err)
{
    *s = (struct br_stability){0};
    const enum br_status status = prepare(s, job, err);
    struct loop loop = {s, job->observer};
    struct br_each each = {
        .threads = job->threads, .observer = job->observer, .turn = take_turn, .self = &loop};
    for (size_t i = 0; i < s->planes; i++)
        each.count += s->plane[i].columns;
    return status ? status : br_each(&each, err);
}

void br_stability_clear(struct br_stability *s)
{
    for (size_t i = 0; i < s->planes; i++) {
        free(s->plane[i].column);
        free(s->plane[i].point);
    }
    free(s->steps);
    *s = (struct br_stability){0};
}

/* ---- what has come out ---- */

size_t br_stability_count(const struct br_stability *s, const struct br_stability_plane *plane,
                          enum br_stability_outcome outcome)
{
    size_t count = 0;
    for (size_t i = 0; i < plane->columns * s->rows; i++)
        count += plane->point[i].outcome == outcome;
    return count;
}

/* Whether theory allows a break: a lagged contact beyond the limit within which it gains nothing.
 */
static bool may_break(const struct br_stability *s, const struct br_method *method,
                      const struct br_stability_column *c, size_t steps)
{
    if (isnan(c->stiffness) || method->contact->at_new_step)
        return false;
    const struct br_field field = br_field_of_scene(
        s->scene, BR_AXIAL, c->n, br_time_step(s->scene, steps), method->axial_degree);
    return !(c->stiffness <= br_contact_limit_bouncing(&field));
}

static enum br_status check(const struct br_stability *s, const struct br_stability_plane *plane,
                            size_t column, size_t row, struct br_error *err)
{
    const struct br_stability_column *c = &plane->column[column];
    const struct br_stability_point *p = &c->point[row];
    if (p->outcome != BR_UNSTABLE || may_break(s, &plane->by->method, c, p->steps))
        return BR_OK;
    return br_fail(err, BR_VERDICT,
                   "%s by %s is unstable at n = %zu, k = %g s, c_H = %g N/m, where theory has no "
                   "limit: the share of energy is %.3g, expected at most %g",
                   s->scene->name, plane->by->name, c->n, br_time_step(s->scene, p->steps),
                   c->stiffness, p->share, br_stability_most(&plane->by->method));
}

enum br_status br_stability_verdict(const struct br_stability *s, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (const struct br_stability_plane *p = s->plane; p < s->plane + s->planes; p++)
        for (size_t i = 0; i < p->columns * s->rows && !status; i++)
            status = check(s, p, i / s->rows, i % s->rows, err);
    return status;
}
