/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/extremes/floors.h"

#include "reference/discrete.h"
#include "study/grid/observer.h"
#include "study/grid/threads.h"
#include "study/scene/file.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const size_t usual_n[] = {100, 400, 1600, 6400, 12800, 100000, 1000000};
static const double usual_k[] = {1e-2, 1e-4, 1e-6};

/* ---- who is measured ---- */

__attribute__((format(printf, 2, 3))) static void add_solver(struct br_floors *f,
                                                             const char *format, ...)
{
    char name[BR_CONTENDER_NAME];
    struct br_error ignored;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(name, sizeof name, format, arguments);
    va_end(arguments);
    if (f->solvers < BR_FLOOR_SOLVERS &&
        br_contender_read(name, &f->solver[f->solvers], &ignored) == BR_OK)
        f->solvers++;
}

/* Every linear solver, and each option that changes its digits. */
static void add_solvers(struct br_floors *f)
{
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++) {
        add_solver(f, "%s", (*s)->name);
        if (br_linear_solver_heeds(*s, "--scaling"))
            add_solver(f, "%s+scaled", (*s)->name);
        if (br_linear_solver_heeds(*s, "--refinement"))
            add_solver(f, "%s+refined", (*s)->name);
    }
}

static enum br_status find_scene(struct br_scene *scene, struct br_error *err)
{
    char path[1024];
    br_data_path("study/scenes/example2.yaml", path, sizeof path);
    return br_scene_read(path, scene, err);
}

static enum br_status prepare(struct br_floors *f, const struct br_floors_plan *plan,
                              struct br_error *err)
{
    if (!br_discrete_judges())
        return br_fail(err, BR_UNSUPPORTED,
                       "long double has no more digits than double on this machine: there is "
                       "nothing to measure round-off by");
    enum br_status status = find_scene(&f->scene, err);
    if (status)
        return status;
    add_solvers(f);
    for (size_t s = 0; s < f->solvers; s++)
        f->solver[s].method.rounding = plan->rounding;
    f->n_count = plan->n ? plan->n_count : sizeof usual_n / sizeof *usual_n;
    f->k_count = plan->k ? plan->k_count : sizeof usual_k / sizeof *usual_k;
    f->n = br_allocate(f->n_count, sizeof *f->n);
    f->k = br_allocate(f->k_count, sizeof *f->k);
    f->floor = br_allocate(f->solvers * f->n_count * f->k_count, sizeof *f->floor);
    if (!f->n || !f->k || !f->floor)
        return br_no_memory(err, "the floors");
    memcpy(f->n, plan->n ? plan->n : usual_n, f->n_count * sizeof *f->n);
    memcpy(f->k, plan->k ? plan->k : usual_k, f->k_count * sizeof *f->k);
    for (size_t j = 0; j < f->k_count && !status; j++) {
        size_t steps;
        status = br_steps_of(&f->scene, f->k[j], &steps, err);
    }
    return status;
}

void br_floors_clear(struct br_floors *f)
{
    br_scene_clear(&f->scene);
    free(f->n);
    free(f->k);
    free(f->floor);
    *f = (struct br_floors){0};
}

/* ---- a measurement: one mesh and one step, all solvers ---- */

struct task {
    struct br_floors *floors;
    size_t i, j;           /* of n and k */
    size_t steps, taken;   /* of the whole duration, and as many as are taken */
    long double *nodal[2]; /* of the exact discrete solution then, by br_field_kind; owned */
    double *march;         /* workspace, 2 (n + 1) */
    const struct br_observer *observer;
};

static bool stopped(const struct br_observer *o)
{
    return o && o->stop && o->stop(o->self);
}

static enum br_status interrupted(struct br_error *err)
{
    return br_fail(err, BR_INTERRUPTED, "interrupted");
}

static enum br_status find_exact(struct task *t, struct br_error *err)
{
    struct br_floors *f = t->floors;
    const size_t nodes = f->n[t->i] + 1;
    struct br_discrete *d;
    enum br_status status =
        br_discrete_create(&d, &f->scene, f->n[t->i], t->steps, &f->solver[0].method, err);
    for (size_t step = 0; step < t->taken && !status; step++)
        status = stopped(t->observer) ? interrupted(err) : br_discrete_step(d, err);
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
        t->nodal[kind] = br_allocate((size_t)(kind + 1) * nodes, sizeof(long double));
        if (t->nodal[kind])
            br_discrete_get(d, (enum br_field_kind)kind, t->nodal[kind], NULL);
        else
            status = br_no_memory(err, "the exact discrete solution");
    }
    br_discrete_free(d);
    t->march = br_allocate(2 * nodes, sizeof *t->march);
    return !status && !t->march ? br_no_memory(err, "the floors") : status;
}

/* Differences of the nodal displacements; slopes are those of the same functions. */
static void compare(struct task *t, const struct br_march *march, enum br_field_kind kind,
                    struct br_floor *floor)
{
    const size_t stride = kind == BR_AXIAL ? 1 : 2, last = stride * t->floors->n[t->i];
    const long double *exact = t->nodal[kind];
    long double most = 0, largest = 0;
    br_march_get(march, kind, t->march, NULL);
    for (size_t i = 0; i <= last; i += stride) {
        const long double error = fabsl(exact[i] - t->march[i]);
        largest = fmaxl(largest, fabsl(exact[i]));
        most = isnan(most) || error <= most ? most : error;
    }
    floor->deviation[kind] = (double)(most / largest);
    floor->tip[kind] = (double)(fabsl(exact[last] - t->march[last]) / largest);
}

/* What the solver refuses, or fails with, is kept. */
static void measure(struct task *t, const struct br_method *method, struct br_floor *floor)
{
    struct br_march *march;
    enum br_status status =
        br_march_create(&march, &t->floors->scene, floor->n, t->steps, method, &floor->refused);
    for (size_t step = 0; step < t->taken && !status; step++)
        status = br_march_step(march, &floor->refused);
    if (march)
        floor->predicted = br_march_round_off(march);
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++)
        compare(t, march, (enum br_field_kind)kind, floor);
    br_march_free(march);
}

static enum br_status run_task(struct task *t, struct br_error *err)
{
    struct br_floors *f = t->floors;
    enum br_status status = br_steps_of(&f->scene, f->k[t->j], &t->steps, err);
    t->taken = t->steps < BR_FLOOR_STEPS ? t->steps : BR_FLOOR_STEPS;
    if (!status)
        status = find_exact(t, err);
    for (size_t s = 0; s < f->solvers && !status; s++) {
        struct br_floor *floor = &f->floor[(s * f->n_count + t->i) * f->k_count + t->j];
        *floor = (struct br_floor){.n = f->n[t->i],
                                   .steps = t->taken,
                                   .k = br_time_step(&f->scene, t->steps),
                                   .deviation = {NAN, NAN},
                                   .tip = {NAN, NAN},
                                   .predicted = NAN};
        if (stopped(t->observer))
            status = interrupted(err);
        else
            measure(t, &f->solver[s].method, floor);
    }
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        free(t->nodal[kind]);
    free(t->march);
    return status;
}

/* The largest meshes first, since they take longest. */
static size_t rank_of(const struct br_floors *f, size_t task)
{
    size_t rank = 0;
    for (size_t i = 0; i < f->n_count; i++)
        rank += f->n[i] > f->n[task] || (f->n[i] == f->n[task] && i < task);
    return rank;
}

enum br_status br_floors_run(struct br_floors *f, const struct br_floors_plan *plan,
                             const struct br_observer *observer, struct br_error *err)
{
    *f = (struct br_floors){0};
    const enum br_status status = prepare(f, plan, err);
    if (status)
        return status;
    struct br_error first = {0};
    double done = 0, all = 0;
    const int threads = br_threads(plan->threads);
    for (size_t i = 0; i < f->n_count; i++)
        all += (double)f->n[i] * (double)f->k_count;
    (void)threads;
#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (size_t task = 0; task < f->n_count * f->k_count; task++) {
        struct br_error failure = {0};
        struct task t = {.floors = f, .j = task % f->k_count, .observer = observer};
        while (rank_of(f, t.i) != task / f->k_count)
            t.i++;
        run_task(&t, &failure);
#pragma omp critical(floors)
        {
            if (failure.status && !first.status)
                first = failure;
            done += (double)f->n[t.i];
            if (observer && observer->progress)
                observer->progress(observer->self, done / all);
        }
    }
    return first.status ? br_fail(err, first.status, "%s", first.message) : BR_OK;
}

/* ---- looking ---- */

const struct br_floor *br_floor_at(const struct br_floors *f, size_t solver, size_t n, size_t k)
{
    return &f->floor[(solver * f->n_count + n) * f->k_count + k];
}

double br_floor_deviation(const struct br_floor *floor)
{
    const double *d = floor->deviation;
    return isnan(d[0]) || d[0] > d[1] ? d[0] : d[1];
}

double br_floor_limit(const struct br_floors *f, size_t solver, const struct br_floor *floor)
{
    const double promised = f->solver[solver].method.solver != &br_riccati ? INFINITY
                            : floor->n <= 12800                            ? 2e-11
                            : floor->n <= 1000000                          ? 1e-9
                                                                           : INFINITY;
    return floor->predicted < promised ? floor->predicted : promised;
}

static enum br_status check(const struct br_floors *f, size_t solver, const struct br_floor *floor,
                            struct br_error *err)
{
    const struct br_contender *c = &f->solver[solver];
    const bool assembled = c->method.solver->bending->round_off != NULL;
    if (floor->refused.status && assembled)
        return BR_OK; /* right, or refused */
    if (floor->refused.status)
        return br_fail(err, BR_VERDICT, "%s, n = %zu, k = %g s: %.700s", c->name, floor->n,
                       floor->k, floor->refused.message);
    const double limit = br_floor_limit(f, solver, floor);
    if (!(br_floor_deviation(floor) <= limit))
        return br_fail(err, BR_VERDICT,
                       "%s, n = %zu, k = %g s: the round-off is %.2g, expected at most %.2g",
                       c->name, floor->n, floor->k, br_floor_deviation(floor), limit);
    return BR_OK;
}

enum br_status br_floors_verdict(const struct br_floors *f, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t s = 0; s < f->solvers; s++)
        for (size_t i = 0; i < f->n_count * f->k_count && !status; i++)
            status = check(f, s, &f->floor[s * f->n_count * f->k_count + i], err);
    return status;
}
