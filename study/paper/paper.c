/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/paper/paper.h"

#include <math.h>
#include <stdio.h>

#include "solver/clock.h"
#include "study/grid/observer.h"
#include "study/grid/threads.h"
#include "study/scene/file.h"

/* The times of the curves, s. Example 3 has the two at which its tip is said to let go. */
static const double figure_times[BR_EXAMPLES][BR_FIGURE_TIMES] = {
    {0.2, 0.4, 0.6, 0.8, 1},
    {0.2, 0.4, 0.6, 0.8, 1},
    {0.2, 0.4, 0.68, 0.8, 0.9, 1},
    {0.5, 1, 1.5, 2, 2.5, 3},
};

const double *br_figure_times(size_t example, size_t *count)
{
    *count = 0;
    while (*count < BR_FIGURE_TIMES && figure_times[example][*count] > 0)
        ++*count;
    return figure_times[example];
}

struct br_paper_request br_paper_request_default(void)
{
    return (struct br_paper_request){.n = 1000, .per_second = 1000, .per_decade = 4};
}

/* ---- examples ---- */

/* All rows, and the fields at the figures' times. */
static enum br_status record(const struct br_scene *scene, size_t n, size_t steps,
                             const double *time, size_t times, struct br_history_record *out,
                             struct br_error *err)
{
    size_t level[BR_FIGURE_TIMES];
    for (size_t i = 0; i < times; i++)
        level[i] = (size_t)lround(time[i] / scene->duration * (double)steps);
    const struct br_method method = br_method_default();
    const struct br_history_observer recorder = br_history_recorder(out, n);
    const struct br_history_request request = {
        .scene = scene,
        .method = &method,
        .n = n,
        .steps = steps,
        .stride = 1,
        .level = level,
        .levels = times,
        .observer = &recorder,
        .observers = 1,
    };
    struct br_history_end end;
    return br_history_run(&request, NULL, &end, err);
}

static enum br_status run_example(struct br_paper *p, size_t i, struct br_error *err)
{
    struct br_example *e = &p->example[i];
    const size_t steps = p->request.per_second * (size_t)lround(e->scene.duration);
    size_t times;
    const double *time = br_figure_times(i, &times);
    return record(&e->scene, p->request.n, steps, time, times, &e->record, err);
}

/* Example 1 up to 100 microseconds, with k = 0.1 microseconds. */
enum br_status br_paper_early(struct br_paper *p, struct br_error *err)
{
    struct br_scene scene = p->example[0].scene; /* borrows its functions */
    scene.duration = p->early.duration = 1e-4;
    return record(&scene, p->request.n, 1000, NULL, 0, &p->early.record, err);
}

/* Example 3 with the axial field, contact and load of Example 1 added: bending must not notice. */
static enum br_status run_coupled(struct br_paper *p, struct br_error *err)
{
    struct br_scene scene = p->example[2].scene;
    scene.axial = p->example[0].scene.axial;
    scene.contact = p->example[0].scene.contact;
    struct br_history_record both = {0}, alone = {0};
    const size_t n = p->request.n, steps = p->request.per_second;
    enum br_status status = record(&scene, n, steps, NULL, 0, &both, err);
    if (!status)
        status = record(&p->example[2].scene, n, steps, NULL, 0, &alone, err);
    p->coupled = 0;
    for (size_t i = 0; i < both.rows && !status; i++) {
        const double moved =
            fabs(both.row[i].displacement[BR_BENDING] - alone.row[i].displacement[BR_BENDING]);
        p->coupled = moved <= p->coupled ? p->coupled : moved; /* keeps a NaN */
    }
    br_history_record_clear(&both);
    br_history_record_clear(&alone);
    return status;
}

/* ---- tasks ---- */

struct work {
    struct br_paper *paper;
    size_t sweep[BR_SWEEPS]; /* points */
    size_t tasks;
};

/* The long ones first: exact solutions, examples, the sweep, the rest. */
static enum br_status run_task(const struct work *w, size_t task,
                               const struct br_observer *observer, struct br_error *err)
{
    if (task < BR_EXAMPLES)
        return br_paper_exact(w->paper, task, observer, err);
    task -= BR_EXAMPLES;
    if (task < BR_EXAMPLES)
        return run_example(w->paper, task, err);
    task -= BR_EXAMPLES;
    for (size_t s = 0; s < BR_SWEEPS; task -= w->sweep[s++])
        if (task < w->sweep[s])
            return br_paper_sweep_point(w->paper, s, task, err);
    return task ? run_coupled(w->paper, err) : br_paper_early(w->paper, err);
}

/* Runs all tasks; the first failure, by number, is what the call fails with. */
static enum br_status run_tasks(const struct work *w, const struct br_observer *observer,
                                struct br_error *err)
{
    struct br_error first = {0};
    size_t failed = w->tasks, done = 0;
    const int threads = br_threads(w->paper->request.threads);
    (void)threads;
#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (size_t i = 0; i < w->tasks; i++) {
        struct br_error failure = {0};
        if (observer && observer->stop && observer->stop(observer->self))
            br_fail(&failure, BR_INTERRUPTED, "interrupted");
        else
            run_task(w, i, observer, &failure);
#pragma omp critical(paper)
        {
            if (failure.status && i < failed) {
                failed = i;
                first = failure;
            }
            done++;
            if (observer && observer->progress)
                observer->progress(observer->self, (double)done / (double)w->tasks);
        }
    }
    return first.status ? br_fail(err, first.status, "%s", first.message) : BR_OK;
}

enum br_status br_paper_scene(size_t i, struct br_scene *scene, struct br_error *err)
{
    char name[32], path[1024];
    *scene = (struct br_scene){0};
    snprintf(name, sizeof name, "example%zu", i + 1);
    const enum br_status status = br_scene_find(name, path, sizeof path, err);
    return status ? status : br_scene_read(path, scene, err);
}

static enum br_status read_scenes(struct br_paper *p, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < BR_EXAMPLES && !status; i++)
        status = br_paper_scene(i, &p->example[i].scene, err);
    return status;
}

enum br_status br_paper_run(struct br_paper *p, const struct br_paper_request *request,
                            const struct br_observer *observer, struct br_error *err)
{
    const double start = br_seconds();
    *p = (struct br_paper){.request = *request};
    if (request->n < 2 || request->n % 2 || request->per_second < 100 ||
        request->per_second % 100 || !request->per_decade)
        return br_fail(
            err, BR_BAD_INPUT,
            "figures: n is %zu, expected an even number; steps of a second %zu, expected a "
            "multiple of 100",
            request->n, request->per_second);
    enum br_status status = read_scenes(p, err);
    if (!status)
        status = br_paper_sweep_create(p, err);
    struct work work = {.paper = p};
    for (size_t s = 0; s < BR_SWEEPS; s++)
        work.sweep[s] = p->sweep[s].points;
    work.tasks = 2 * BR_EXAMPLES + work.sweep[0] + work.sweep[1] + 2;
    if (!status)
        status = run_tasks(&work, observer, err);
    if (!status)
        status = br_paper_tables(p, observer, err);
    p->wall_seconds = br_seconds() - start;
    return status;
}

void br_paper_clear(struct br_paper *p)
{
    for (size_t i = 0; i < BR_EXAMPLES; i++) {
        struct br_example *e = &p->example[i];
        br_scene_clear(&e->scene);
        br_history_record_clear(&e->record);
        free(e->exact);
        free(e->event);
    }
    br_history_record_clear(&p->early.record);
    for (size_t s = 0; s < BR_SWEEPS; s++)
        free(p->sweep[s].point);
    for (size_t t = 0; t < BR_PAPER_TABLES; t++)
        br_study_clear(&p->table[t].study);
    *p = (struct br_paper){0};
}
