/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Marches against the exact discrete solution. */
#include <math.h>

#include "reference/discrete.h"
#include "study/extremes/floors.h"
#include "study/grid/each.h"

/* A task at work. */
struct work {
    const struct br_floor_task *task;
    const struct br_observer *observer;
    long double *nodal[2]; /* of the exact discrete solution, by br_field_kind; owned */
    double *march;         /* workspace, 2 (n + 1); owned */
};

/* Looked at so often that steps of any mesh take no long time. */
static bool stopped(const struct work *w, size_t step)
{
    const struct br_observer *o = w->observer;
    return step % (40960 / w->task->n + 1) == 0 && o && o->stop && o->stop(o->self);
}

static enum br_status interrupted(struct br_error *err)
{
    return br_fail(err, BR_INTERRUPTED, "interrupted");
}

static enum br_status find_exact(struct work *w, struct br_error *err)
{
    const struct br_floor_task *t = w->task;
    struct br_discrete *d;
    enum br_status status = br_discrete_create(&d, t->scene, t->n, t->steps, &t->by[0].method, err);
    for (size_t i = 0; i < t->taken && !status; i++)
        status = stopped(w, i) ? interrupted(err) : br_discrete_step(d, err);
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
        w->nodal[kind] = br_allocate((size_t)(kind + 1) * (t->n + 1), sizeof(long double));
        if (w->nodal[kind])
            br_discrete_get(d, (enum br_field_kind)kind, w->nodal[kind], NULL);
        else
            status = br_no_memory(err, "the exact discrete solution");
    }
    br_discrete_free(d);
    return status;
}

/* Differences of the nodal displacements; slopes are those of the same functions. */
static void compare(const struct work *w, const struct br_march *march, enum br_field_kind kind,
                    struct br_floor *floor)
{
    const size_t stride = kind == BR_AXIAL ? 1 : 2, last = stride * w->task->n;
    const long double *exact = w->nodal[kind];
    long double most = 0, largest = 0;
    br_march_get(march, kind, w->march, NULL);
    for (size_t i = 0; i <= last; i += stride) {
        const long double error = fabsl(exact[i] - w->march[i]);
        largest = fmaxl(largest, fabsl(exact[i]));
        most = isnan(most) || error <= most ? most : error;
    }
    floor->deviation[kind] = (double)(most / largest);
    floor->tip[kind] = (double)(fabsl(exact[last] - w->march[last]) / largest);
}

/* How far the time told is from i T/N, which long double has to 64 bits. */
static double time_error(const struct br_floor_task *t, const struct br_march *march, size_t i)
{
    const long double exact =
        (long double)t->scene->duration * (long double)i / (long double)t->steps;
    return (double)fabsl(br_march_time(march) - exact) / t->scene->duration;
}

/* What the solver refuses, or fails with, is kept. */
static enum br_status measure(const struct work *w, const struct br_method *method,
                              struct br_floor *floor, struct br_error *err)
{
    const struct br_floor_task *t = w->task;
    struct br_march *march;
    bool stop = false;
    *floor = (struct br_floor){.n = t->n,
                               .steps = t->taken,
                               .k = br_time_step(t->scene, t->steps),
                               .deviation = {NAN, NAN},
                               .tip = {NAN, NAN},
                               .predicted = NAN};
    enum br_status status =
        br_march_create(&march, t->scene, t->n, t->steps, method, &floor->refused);
    for (size_t i = 0; i < t->taken && !status && !stop; i++) {
        stop = stopped(w, i);
        status = br_march_step(march, &floor->refused);
        floor->time_error = fmax(floor->time_error, time_error(t, march, i + 1));
    }
    if (march)
        floor->predicted = br_march_round_off(march);
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++)
        compare(w, march, (enum br_field_kind)kind, floor);
    br_march_free(march);
    return stop ? interrupted(err) : BR_OK;
}

static enum br_status run_task(const struct br_floor_task *t, const struct br_observer *observer,
                               struct br_error *err)
{
    struct work w = {.task = t, .observer = observer};
    w.march = br_allocate(2 * (t->n + 1), sizeof *w.march);
    enum br_status status = w.march ? find_exact(&w, err) : br_no_memory(err, "the floors");
    for (size_t s = 0; s < t->solvers && !status; s++)
        status = measure(&w, &t->by[s].method, &t->floor[s * t->stride], err);
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        free(w.nodal[kind]);
    free(w.march);
    return status;
}

static double work_of(const struct br_floor_task *t)
{
    return (double)t->n * (double)t->taken;
}

/* Those of as much work in the order of their results. */
static int most_work_first(const void *a, const void *b)
{
    const struct br_floor_task *x = a, *y = b;
    if (work_of(x) != work_of(y))
        return work_of(x) < work_of(y) ? 1 : -1;
    return (x->floor > y->floor) - (x->floor < y->floor);
}

struct loop {
    const struct br_floor_task *task;
    const struct br_observer *observer;
};

static enum br_status take_turn(void *self, size_t i, struct br_error *err)
{
    const struct loop *l = self;
    return run_task(&l->task[i], l->observer, err);
}

static double work_of_turn(const void *self, size_t i)
{
    const struct loop *l = self;
    return work_of(&l->task[i]);
}

enum br_status br_floor_tasks_run(struct br_floor_task *tasks, size_t count, int threads,
                                  const struct br_observer *observer, struct br_error *err)
{
    struct loop loop = {tasks, observer};
    const struct br_each each = {count, threads, observer, take_turn, work_of_turn, &loop};
    if (!br_discrete_judges())
        return br_fail(err, BR_UNSUPPORTED,
                       "long double has no more digits than double on this machine: there is "
                       "nothing to measure round-off by");
    qsort(tasks, count, sizeof *tasks, most_work_first);
    return br_each(&each, err);
}

double br_floor_deviation(const struct br_floor *floor)
{
    const double *d = floor->deviation;
    return isnan(d[0]) || d[0] > d[1] ? d[0] : d[1];
}
