/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/fit/apart.h"

#include <math.h>
#include <string.h>

enum {
    PAIRS = 4,  /* so many differences in k, and more until they settle the order */
    CHEAP = 10, /* elements of their mesh, at most */
    BESIDE = 60 /* elements' worth of what a step takes beside its elements */
};
/* Element-steps for the order in k that nobody waits for: about half a second. */
static const double no_matter = 28e6;

static double work_of(size_t n, size_t steps)
{
    return (double)steps * (double)(n + BESIDE);
}

void br_apart_clear(struct br_apart *a)
{
    for (size_t m = 0; m < BR_MOST_NORMS; m++)
        for (int axis = 0; axis < BR_AXES; axis++)
            br_study_clear(&a->of[m].over[axis]);
}

/* Marches a grid in all norms of the reports. *why (out): what has failed, which ends the call only
 * where memory or the user does. */
static enum br_status march(const struct br_study *first, const struct br_report *report,
                            size_t norms, struct br_differences *out, int threads,
                            const struct br_observer *observer, struct br_error *why,
                            struct br_error *err)
{
    struct br_study grid[BR_MOST_NORMS];
    for (size_t m = 0; m < norms; m++) {
        grid[m] = *first;
        grid[m].norm = report[m].study->norm;
        grid[m].next_norm = m + 1 < norms ? &grid[m + 1] : NULL;
    }
    const enum br_status status = br_differences_run(grid, out, threads, observer, why);
    return status == BR_NO_MEMORY || status == BR_INTERRUPTED
               ? br_fail(err, status, "%s", why->message)
               : BR_OK;
}

/* ---- over h ---- */

/* The meshes, at the coarsest time step that all of them can march: those of the grid, if they
 * suffice and each nests in the next; else meshes up to about its finest. */
static struct br_study grid_of_meshes(const struct br_study *s, size_t mesh[BR_APART_MESHES])
{
    struct br_study grid = {.scene = s->scene, .method = s->method, .judge = &br_judge_none};
    bool nest = s->n_count >= BR_APART_MESHES, sound = false;
    for (size_t i = 0; i + 1 < s->n_count; i++)
        nest = nest && s->n[i + 1] > s->n[i] && s->n[i + 1] % s->n[i] == 0;
    const size_t finest = s->n[s->n_count - 1], first = finest >> (BR_APART_MESHES - 1);
    for (size_t i = 0; i < BR_APART_MESHES; i++)
        mesh[i] = (first ? first : 1) << i;
    grid.n = nest ? s->n : mesh;
    grid.n_count = nest ? s->n_count : BR_APART_MESHES;
    grid.k_count = 1;
    for (size_t j = 0; j < s->k_count && !sound; j++) {
        grid.steps = &s->steps[j];
        sound = true;
        for (size_t i = 0; i < s->n_count; i++)
            sound &= !br_study_cell(s, i, j)->unstable && !br_study_cell(s, i, j)->failure.status;
    }
    return grid;
}

enum br_status br_apart_meshes(struct br_apart *a, struct br_report *report, size_t norms,
                               int threads, const struct br_observer *observer,
                               struct br_error *err)
{
    const struct br_study grid = grid_of_meshes(report->study, a->mesh);
    if (march(&grid, report, norms, a->of, threads, observer, &a->no_meshes, err))
        return err->status;
    for (size_t m = 0; m < norms; m++)
        if (a->no_meshes.status) {
            report[m].no_meshes = a->no_meshes.message;
        } else {
            br_flag_beside(&a->of[m].over[BR_AXIS_SPACE]);
            report[m].apart[BR_AXIS_SPACE] = &a->of[m].over[BR_AXIS_SPACE];
        }
    return BR_OK;
}

/* ---- over k ---- */

/* Sets the mesh and the steps: from the grid's smallest on, and below the relaxation time if that
 * is within reach, since above it errors have another order. Returns the work of the grid's
 * cells. */
static double choose_steps(struct br_apart *a, const struct br_study *s)
{
    const struct br_scene_field *u = &s->scene->axial;
    const struct br_scene_field *b = &s->scene->bending;
    const double time =
        fmin(u->modelled && u->viscosity > 0 ? u->viscosity / u->stiffness : INFINITY,
             b->modelled && b->viscosity > 0 ? b->viscosity / b->stiffness : INFINITY);
    size_t steps = s->steps[s->k_count - 1];
    for (int i = 0; i < 2 && br_time_step(s->scene, steps) > time; i++)
        steps *= 2;
    a->cheap = s->n[0] < CHEAP ? s->n[0] : CHEAP;
    for (size_t i = 0; i < BR_APART_STEPS; i++)
        a->step[i] = steps << i;
    double work = 0;
    for (size_t c = 0; c < br_study_cells(s); c++)
        work += work_of(s->cell[c].at.n, s->cell[c].at.steps);
    return work;
}

/* Appends the difference of a pair of time steps to those before it. */
static enum br_status append(struct br_study *to, const struct br_study *pair, const size_t *step,
                             struct br_error *err)
{
    struct br_cell *cell = br_allocate(to->k_count + 1, sizeof *cell);
    if (!cell)
        return br_no_memory(err, "the differences");
    if (to->k_count)
        memcpy(cell, to->cell, to->k_count * sizeof *cell);
    cell[to->k_count] = pair->cell[0];
    free(to->cell);
    const size_t count = to->k_count + 1;
    *to = *pair;
    to->cell = cell;
    to->steps = step;
    to->k_count = count;
    br_flag_beside(to);
    return BR_OK;
}

/* Marches pair i of time steps. *failed (out): a march has. */
static enum br_status march_pair(struct br_apart *a, struct br_report *report, size_t norms,
                                 size_t i, int threads, const struct br_observer *observer,
                                 bool *failed, struct br_error *err)
{
    const struct br_study *s = report->study, grid = {.scene = s->scene,
                                                      .method = s->method,
                                                      .judge = &br_judge_none,
                                                      .n = &a->cheap,
                                                      .n_count = 1,
                                                      .steps = &a->step[i],
                                                      .k_count = 2};
    struct br_differences pair[BR_MOST_NORMS] = {0};
    struct br_error why = {0};
    enum br_status status = march(&grid, report, norms, pair, threads, observer, &why, err);
    *failed = why.status != BR_OK;
    for (size_t m = 0; m < norms && !*failed; m++) {
        struct br_study *over = &pair[m].over[BR_AXIS_TIME];
        if (!status)
            status = append(&a->of[m].over[BR_AXIS_TIME], over, a->step, err);
        br_study_clear(over);
    }
    return status;
}

/* Sets the orders in k; settled: out. */
static enum br_status see(const struct br_apart *a, struct br_report *report, size_t norms,
                          bool *settled, struct br_error *err)
{
    *settled = true;
    for (size_t m = 0; m < norms; m++) {
        const struct br_study *over = &a->of[m].over[BR_AXIS_TIME];
        report[m].apart[BR_AXIS_TIME] = over->k_count ? over : NULL;
        if (over->k_count && br_report_see_orders(&report[m], BR_AXIS_TIME, err))
            return err->status;
        *settled = *settled && br_report_settles(&report[m], BR_AXIS_TIME);
    }
    return BR_OK;
}

enum br_status br_apart_steps(struct br_apart *a, struct br_report *report, size_t norms,
                              int threads, const struct br_observer *observer, struct br_error *err)
{
    bool settled, failed = false;
    enum br_status status = see(a, report, norms, &settled, err);
    double left = fmax(choose_steps(a, report->study), no_matter);
    for (size_t i = 0; i + 1 < BR_APART_STEPS && !status && !settled && !failed; i++) {
        left -= work_of(a->cheap, a->step[i] + a->step[i + 1]);
        if (left < 0)
            break;
        status = march_pair(a, report, norms, i, threads, observer, &failed, err);
        if (!status && i + 1 >= PAIRS)
            status = see(a, report, norms, &settled, err);
    }
    return status;
}
