/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The round-off floor of every linear solver, over n and k. */
#include "study/extremes/floors.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "study/scene/file.h"

static const size_t usual_n[] = {100, 400, 1600, 6400, 12800, 100000, 1000000};
static const double usual_k[] = {1e-2, 1e-4, 1e-6};

/* ---- who is measured ---- */

__attribute__((format(printf, 2, 3))) static void add_solver(struct br_floors *f,
                                                             const char *format, ...)
{
    char name[BR_METHOD_NAME_SIZE];
    struct br_error ignored;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(name, sizeof name, format, arguments);
    va_end(arguments);
    if (f->solvers < BR_FLOOR_SOLVERS &&
        br_named_method_read(name, &f->solver[f->solvers], &ignored) == BR_OK)
        f->solvers++;
}

/* Every linear solver, and each option that changes its digits. */
static void add_solvers(struct br_floors *f)
{
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++) {
        if (!(*s)->cost) /* a choice of the others */
            continue;
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
    const enum br_status status = find_scene(&f->scene, err);
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
    return BR_OK;
}

void br_floors_clear(struct br_floors *f)
{
    br_scene_clear(&f->scene);
    free(f->n);
    free(f->k);
    free(f->floor);
    *f = (struct br_floors){0};
}

static enum br_status run_tasks(struct br_floors *f, const struct br_floors_plan *plan,
                                const struct br_observer *observer, struct br_error *err)
{
    const size_t count = f->n_count * f->k_count;
    struct br_floor_task *tasks = br_allocate(count, sizeof *tasks);
    enum br_status status = tasks ? BR_OK : br_no_memory(err, "the floors");
    for (size_t i = 0; i < count && !status; i++) {
        struct br_floor_task *t = &tasks[i];
        *t = (struct br_floor_task){.scene = &f->scene,
                                    .n = f->n[i / f->k_count],
                                    .by = f->solver,
                                    .solvers = f->solvers,
                                    .floor = &f->floor[i],
                                    .stride = count};
        status = br_steps_of(&f->scene, f->k[i % f->k_count], &t->steps, err);
        t->taken = t->steps < BR_FLOOR_STEPS ? t->steps : BR_FLOOR_STEPS;
    }
    if (!status)
        status = br_floor_tasks_run(tasks, count, plan->threads, observer, err);
    free(tasks);
    return status;
}

enum br_status br_floors_run(struct br_floors *f, const struct br_floors_plan *plan,
                             const struct br_observer *observer, struct br_error *err)
{
    *f = (struct br_floors){0};
    const enum br_status status = prepare(f, plan, err);
    return status ? status : run_tasks(f, plan, observer, err);
}

/* ---- looking ---- */

const struct br_floor *br_floor_at(const struct br_floors *f, size_t solver, size_t n, size_t k)
{
    return &f->floor[(solver * f->n_count + n) * f->k_count + k];
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
    const struct br_named_method *c = &f->solver[solver];
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
