/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/each.h"
#include "solver/linear/linear_solver.h"
#include "solver/scene.h"
#include "study/extremes/extremes.h"
#include "study/scene/resolution.h"

#define COUNT(list) (sizeof(list) / sizeof *(list))

/* ---- which methods are measured ---- */

/* Every linear solver. */
static void add_solvers(struct br_floors *f)
{
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++)
        if (!br_linear_solver_chooses(*s))
            br_named_methods_add(&f->method, NULL, "%s", (*s)->name);
    f->solvers = f->method.count;
}

/* Every scheme of equal steps; other solvers lose more in one step. */
static void add_schemes(struct br_floors *f)
{
    static const char *const solvers[] = {"riccati", "plain"};
    f->solvers = COUNT(solvers);
    for (const struct br_time_scheme *const *s = br_time_schemes; *s; s++)
        for (size_t c = 0; br_contact_rules[c]; c++)
            for (size_t i = 0; i < COUNT(solvers); i++)
                if (!(*s)->adaptive && ((*s)->may_lag || br_contact_rules[c]->at_new_step))
                    br_named_methods_add(&f->method, NULL, "%s+%s+%s", (*s)->name,
                                         br_contact_rules[c]->name, solvers[i]);
}

/* ---- what is measured ---- */

static const size_t usual_n[] = {100, 400, 1600, 6400, 12800, 100000, 1000000};
static const size_t usual_steps[] = {100, 10000, 1000000};
static const size_t gathered_n[] = {BR_GATHERED_N};
static const size_t gathered_steps[] = {1, 10, 100, 1000, 10000, 100000, 1000000, 10000000};

/* Whether a number of steps is marched by default. All of them take a minute or two: schemes of
 * several solves a step, of one, and, in the scene that sticks, implicit Euler with implicit
 * contact. */
static bool is_usual(const struct br_method *m, bool sticks, size_t steps)
{
    static const size_t most_of_many = 100000, most_of_one = 1000000;
    if (br_time_scheme_stages(m->scheme) > 1)
        return steps <= most_of_many;
    return steps <= most_of_one || (m->scheme->may_lag && m->contact->at_new_step && sticks);
}

/* Whether a solver is measured on a mesh by default. An assembled matrix has no digits left at
 * 100,000 elements; to factorise a larger one to refuse it takes a third of the time of all. */
static bool is_usual_mesh(const struct br_method *m, size_t n)
{
    static const size_t most_assembled = 100000;
    return !m->solver->bending->round_off || n <= most_assembled;
}

/* All marches of a mesh and a time step; chosen: the user gave the meshes, or the steps of the
 * gathered round-off. */
static void list_marches(struct br_floors *f, size_t at, size_t n, size_t steps, bool chosen)
{
    const size_t most = f->gathered ? SIZE_MAX : BR_FLOOR_STEPS;
    for (size_t i = 0; i < f->scenes * f->method.count; i++) {
        const struct br_scene *scene = f->scene[i / f->method.count];
        const struct br_named_method *by = &f->method.list[i % f->method.count];
        const bool grows =
            br_lagged_contact_grows(&by->method, scene, n, br_time_step(scene, steps));
        const bool usual = f->gathered ? is_usual(&by->method, scene == f->scene[0], steps)
                                       : is_usual_mesh(&by->method, n);
        const bool marched = (chosen || usual) && !(f->gathered && grows);
        f->floor[i * f->n_count * f->k_count + at] = (struct br_floor){
            .scene = scene,
            .by = by,
            .at_new_step = grows,
            .n = n,
            .of = steps,
            .steps = !marched       ? 0
                     : steps < most ? steps
                                    : most,
            .k = br_time_step(scene, steps),
            .deviation = {NAN, NAN},
            .tip = {NAN, NAN},
            .predicted = NAN,
            .time_error = NAN,
        };
    }
}

static enum br_status prepare(struct br_floors *f, const struct br_extremes_job *job,
                              struct br_error *err)
{
    const size_t *n = f->gathered ? gathered_n : job->n ? job->n : usual_n;
    const size_t *steps = job->steps ? job->steps : f->gathered ? gathered_steps : usual_steps;
    f->scenes = job->scenes;
    for (size_t i = 0; i < f->scenes; i++)
        f->scene[i] = job->scene[i];
    if (f->gathered)
        add_schemes(f);
    else
        add_solvers(f);
    f->n_count = f->gathered ? COUNT(gathered_n) : job->n ? job->n_count : COUNT(usual_n);
    f->k_count = job->steps    ? job->step_count
                 : f->gathered ? COUNT(gathered_steps)
                               : COUNT(usual_steps);
    f->floors = f->scenes * f->method.count * f->n_count * f->k_count;
    f->floor = br_allocate(f->floors, sizeof *f->floor);
    if (!f->floor)
        return br_no_memory(err, "the floors");
    for (size_t i = 0; i < f->n_count * f->k_count; i++)
        list_marches(f, i, n[i / f->k_count], steps[i % f->k_count],
                     f->gathered ? job->steps != NULL : job->n != NULL);
    return BR_OK;
}

void br_floors_clear(struct br_floors *f)
{
    free(f->floor);
    *f = (struct br_floors){0};
}

/* ---- a march against the exact discrete solution ---- */

/* The work of a turn: marches that differ only by their solver. */
struct floors_work {
    struct br_floor *first; /* the others follow, with a stride */
    const struct br_observer *observer;
    double *nodal[2];  /* of the exact discrete solution at the end, by br_field_kind; owned */
    double largest[2]; /* displacement of that solution at all time levels, m */
    double *march;     /* workspace, 2 (n + 1); owned */
};

static struct br_method method_of(const struct br_floor *f)
{
    struct br_method m = f->by->method;
    if (f->at_new_step)
        m.contact = br_contact_rule_find("implicit");
    return m;
}

/* Checks so often that on any mesh little time passes between two checks. */
static bool stopped(const struct floors_work *w, size_t step)
{
    return step % (40960 / w->first->n + 1) == 0 && br_observer_stops(w->observer);
}

/* The nodal values of a displacement: slopes belong to the same function and need no comparison. */
static size_t stride_of(enum br_field_kind kind)
{
    return kind == BR_AXIAL ? 1 : 2;
}

/* Takes the displacements of a level. A vibration may have died down at the end: its round-off is
 * that of the times before, so the largest displacement of all levels is the scale. */
static void take_level(struct floors_work *w, const struct br_march *march)
{
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        br_march_get(march, kind, w->nodal[kind], NULL);
        for (size_t i = 0; i <= w->first->n; i++)
            w->largest[kind] = fmax(w->largest[kind], fabs(w->nodal[kind][i * stride_of(kind)]));
    }
}

/* The same march by `plain` in long double. Where it is refused, or fails, there is nothing to
 * compare with: no values are left. */
static enum br_status find_exact(struct floors_work *w, struct br_error *err)
{
    const struct br_floor *f = w->first;
    struct br_method method = method_of(f);
    method.solver = &br_long_plain;
    struct br_march *march;
    enum br_status status = br_march_create(&march, f->scene, f->n, f->of, &method, err);
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
        w->nodal[kind] = br_allocate(2 * (f->n + 1), sizeof *w->nodal[kind]);
        if (!w->nodal[kind])
            status = br_no_memory(err, "the exact discrete solution");
    }
    if (!status)
        take_level(w, march);
    for (size_t i = 0; i < f->steps && !status; i++) {
        status =
            stopped(w, i) ? br_fail(err, BR_INTERRUPTED, "interrupted") : br_march_step(march, err);
        if (!status)
            take_level(w, march);
    }
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && status; kind++) {
        free(w->nodal[kind]);
        w->nodal[kind] = NULL;
    }
    br_march_free(march);
    return status == BR_NO_MEMORY || status == BR_INTERRUPTED ? status : BR_OK;
}

/* Compares nodal displacements. */
static void compare(const struct floors_work *w, const struct br_march *march,
                    enum br_field_kind kind, struct br_floor *floor)
{
    const size_t stride = stride_of(kind), last = stride * floor->n;
    const double *exact = w->nodal[kind], largest = w->largest[kind];
    double most = 0;
    if (!exact)
        return; /* the deviation stays NaN */
    br_march_get(march, kind, w->march, NULL);
    for (size_t i = 0; i <= last; i += stride) {
        const double error = fabs(exact[i] - w->march[i]);
        most = isnan(most) || error <= most ? most : error;
    }
    floor->deviation[kind] = largest > 0 ? most / largest : most;
    floor->tip[kind] = largest > 0 ? fabs(exact[last] - w->march[last]) / largest : most;
}

/* The difference of the march's time from i T/N, which long double has to 64 bits. */
static double time_error(const struct br_floor *f, const struct br_march *march, size_t i)
{
    const long double exact = (long double)f->scene->duration * (long double)i / (long double)f->of;
    return (double)fabsl(br_march_time(march) - exact) / f->scene->duration;
}

/* A refusal or failure of the solver is stored in floor->refused, but for want of memory. */
static enum br_status measure(const struct floors_work *w, struct br_floor *floor,
                              struct br_error *err)
{
    struct br_march *march;
    bool stop = false;
    const struct br_method method = method_of(floor);
    enum br_status status =
        br_march_create(&march, floor->scene, floor->n, floor->of, &method, &floor->refused);
    floor->time_error = 0;
    for (size_t i = 0; i < floor->steps && !status && !stop; i++) {
        stop = stopped(w, i);
        status = br_march_step(march, &floor->refused);
        floor->time_error = fmax(floor->time_error, time_error(floor, march, i + 1));
    }
    if (march)
        floor->predicted = br_march_round_off(march);
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++)
        compare(w, march, kind, floor);
    br_march_free(march);
    if (status == BR_NO_MEMORY)
        return br_fail(err, status, "%s", floor->refused.message);
    return stop ? br_fail(err, BR_INTERRUPTED, "interrupted") : BR_OK;
}

/* ---- all ---- */

struct loop {
    struct br_floors *f;
    const struct br_observer *observer;
};

/* The first march of a turn. Turns of the finest meshes and most steps come first. */
static struct br_floor *first_of(const struct br_floors *f, size_t turn)
{
    const size_t groups = f->scenes * f->method.count / f->solvers, grids = f->n_count * f->k_count;
    return &f->floor[turn % groups * f->solvers * grids + grids - 1 - turn / groups];
}

static enum br_status take_turn(void *self, size_t i, struct br_error *err)
{
    const struct loop *l = self;
    struct floors_work w = {.first = first_of(l->f, i), .observer = l->observer};
    if (!w.first->steps)
        return BR_OK;
    w.march = br_allocate(2 * (w.first->n + 1), sizeof *w.march);
    enum br_status status = w.march ? find_exact(&w, err) : br_no_memory(err, "the floors");
    for (size_t s = 0; s < l->f->solvers && !status; s++) {
        struct br_floor *floor = w.first + s * l->f->n_count * l->f->k_count;
        status = floor->steps ? measure(&w, floor, err) : BR_OK;
    }
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        free(w.nodal[kind]);
    free(w.march);
    return status;
}

static double work_of_turn(const void *self, size_t i)
{
    const struct br_floor *first = first_of(((const struct loop *)self)->f, i);
    return (double)first->n * (double)first->steps;
}

enum br_status br_floors_run(struct br_floors *f, bool gathered, const struct br_extremes_job *job,
                             struct br_error *err)
{
    *f = (struct br_floors){.gathered = gathered};
    const enum br_status status = prepare(f, job, err);
    if (!status && !br_long_plain_resolves())
        return br_fail(err, BR_UNSUPPORTED,
                       "long double has no more digits than double on this machine: there is "
                       "nothing to measure round-off by");
    if (status)
        return status;
    struct loop loop = {f, job->observer};
    const struct br_each each = {.count = f->floors / f->solvers,
                                 .threads = job->threads,
                                 .observer = job->observer,
                                 .turn = take_turn,
                                 .work = work_of_turn,
                                 .self = &loop};
    return br_each(&each, err);
}

/* ---- reading the results ---- */

double br_floor_limit(const struct br_floor *f)
{
    const bool promised = f->by->method.solver == &br_riccati && f->steps <= BR_FLOOR_STEPS;
    const double most = !promised         ? INFINITY
                        : f->n <= 12800   ? 2e-11
                        : f->n <= 1000000 ? 1e-9
                                          : INFINITY;
    return most < f->predicted ? most : f->predicted; /* NaN stays */
}

static enum br_status check(const struct br_floor *f, struct br_error *err)
{
    char what[200];
    const bool assembled = f->by->method.solver->bending->round_off != NULL;
    if (!f->steps || (f->refused.status && (assembled || f->refused.status == BR_BAD_INPUT)))
        return BR_OK; /* right, or refused */
    snprintf(what, sizeof what, "%s of %s, n = %zu, %zu steps of %g s", f->by->name, f->scene->name,
             f->n, f->steps, f->k);
    if (f->refused.status)
        return br_fail(err, BR_VERDICT, "%s: %.700s", what, f->refused.message);
    if (!(br_floor_deviation(f) <= br_floor_limit(f) && isfinite(br_floor_deviation(f))))
        return br_fail(err, BR_VERDICT, "%s: the round-off is %.2g, expected at most %.2g", what,
                       br_floor_deviation(f), br_floor_limit(f));
    if (!(f->time_error <= DBL_EPSILON))
        return br_fail(err, BR_VERDICT,
                       "%s: a time level is %.2g of the duration off, expected at most %.2g", what,
                       f->time_error, DBL_EPSILON);
    return BR_OK;
}

enum br_status br_floors_verdict(const struct br_floors *f, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < f->floors && !status; i++)
        status = check(&f->floor[i], err);
    return status;
}
