/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/fit/grid_differences.h"

#include <math.h>
#include <string.h>

#include "solver/scene.h"

enum {
    PAIRS = 3,  /* differences at least: an order needs three */
    FINER = 8,  /* sizes at most, before these: */
    LARGER = 4, /* time steps that are kept for the end */
    CHEAP = 10, /* elements of the mesh for differences in k, at most */
    BESIDE = 60 /* elements' worth of what a step takes beside its elements */
};
/* Element-steps for an order that nobody waits for: about half a second. */
static const double no_matter = 28e6;

static double work_of(size_t n, size_t steps)
{
    return (double)steps * (double)(n + BESIDE);
}

/* The element-steps of two neighbours. */
static double work_of_pair(const struct br_grid_differences *a, enum br_axis axis, size_t i)
{
    const size_t *size = a->size[axis];
    return axis == BR_AXIS_SPACE
               ? work_of(size[i], a->at[axis]) + work_of(size[i + 1], a->at[axis])
               : work_of(a->at[axis], size[i]) + work_of(a->at[axis], size[i + 1]);
}

void br_grid_differences_clear(struct br_grid_differences *a)
{
    for (size_t m = 0; m < BR_MOST_NORMS; m++)
        for (int axis = 0; axis < BR_AXES; axis++)
            br_study_clear(&a->over[axis][m]);
}

/* ---- what is compared ---- */

/* Sets the meshes: those of the grid, if they suffice and each nests in the next, else meshes up to
 * about its finest; and then finer ones. At the coarsest time step that the grid's can march. */
static void choose_meshes(struct br_grid_differences *a, const struct br_study *s)
{
    const size_t finest = s->n[s->n_count - 1], first = finest >> PAIRS;
    size_t *size = a->size[BR_AXIS_SPACE];
    bool nest = s->n_count > PAIRS && s->n_count <= BR_DIFFERENCE_SIZES, sound = false;
    for (size_t i = 0; i + 1 < s->n_count; i++)
        nest = nest && s->n[i + 1] > s->n[i] && s->n[i + 1] % s->n[i] == 0;
    for (size_t i = 0; i < BR_DIFFERENCE_SIZES; i++)
        size[i] = nest && i < s->n_count ? s->n[i] : i ? 2 * size[i - 1] : first ? first : 1;
    a->end[BR_AXIS_SPACE] = nest ? s->n_count : PAIRS + 1;
    for (size_t j = 0; j < s->k_count && !sound; j++) {
        a->at[BR_AXIS_SPACE] = s->steps[j];
        sound = true;
        for (size_t i = 0; i < s->n_count; i++)
            sound &= !br_study_cell(s, i, j)->unstable && !br_study_cell(s, i, j)->failure.status;
    }
}

/* Sets the time steps: from the grid's smallest on, and below the relaxation time if that is within
 * reach, since above it errors have another order; before them larger ones. */
static void choose_steps(struct br_grid_differences *a, const struct br_study *s)
{
    const struct br_scene_field *u = &s->scene->axial, *b = &s->scene->bending;
    const double time =
        fmin(u->modelled && u->viscosity > 0 ? u->viscosity / u->stiffness : INFINITY,
             b->modelled && b->viscosity > 0 ? b->viscosity / b->stiffness : INFINITY);
    size_t steps = s->steps[s->k_count - 1], *first = &a->first[BR_AXIS_TIME];
    for (int i = 0; i < 2 && br_time_step(s->scene, steps) > time; i++)
        steps *= 2;
    for (; *first < LARGER && steps % 2 == 0 && steps / 2 >= a->at[BR_AXIS_SPACE]; ++*first)
        steps /= 2;
    a->at[BR_AXIS_TIME] = s->n[0] < CHEAP ? s->n[0] : CHEAP;
    for (size_t i = 0; i < BR_DIFFERENCE_SIZES; i++)
        a->size[BR_AXIS_TIME][i] = steps << i;
}

/* ---- differences ---- */

/* Adds differences of neighbours at the front or the back of those that are there. size: of the
 * first one. */
static enum br_status add(struct br_study *to, struct br_study *more, enum br_axis axis, bool front,
                          const size_t *size, struct br_error *err)
{
    const size_t old = to->cell ? br_axis_count(to, (int)axis) : 0,
                 new = br_axis_count(more, (int)axis);
    struct br_cell *cell = br_allocate(old + new, sizeof *cell);
    if (!cell)
        return br_no_memory(err, "the differences");
    br_flag_beside(more); /* each by its own round-off */
    if (old)
        memcpy(cell + (front ? new : 0), to->cell, old * sizeof *cell);
    memcpy(cell + (front ? 0 : old), more->cell, new * sizeof *cell);
    free(to->cell);
    *to = *more;
    to->cell = cell;
    *(axis == BR_AXIS_SPACE ? &to->n : &to->steps) = size;
    *(axis == BR_AXIS_SPACE ? &to->n_count : &to->k_count) = old + new;
    return BR_OK;
}

/* Compares the sizes [from, to) of an axis in all norms. *why (out): what has failed, which ends
 * the call only where memory or the user does. */
static enum br_status compare(struct br_grid_differences *a, enum br_axis axis, size_t from,
                              size_t to, struct br_error *why, struct br_error *err)
{
    const bool over_h = axis == BR_AXIS_SPACE, front = from < a->first[axis];
    const size_t *size = a->size[axis];
    const struct br_study *s = a->report->study;
    struct br_study grid[BR_MOST_NORMS] = {0};
    struct br_study found[BR_MOST_NORMS] = {0};
    for (size_t m = 0; m < a->norms; m++)
        grid[m] = (struct br_study){.scene = s->scene,
                                    .method = s->method,
                                    .reference_kind = &br_reference_none,
                                    .norm = a->report[m].study->norm,
                                    .n = over_h ? size + from : &a->at[axis],
                                    .n_count = over_h ? to - from : 1,
                                    .steps = over_h ? &a->at[axis] : size + from,
                                    .k_count = over_h ? 1 : to - from,
                                    .next_norm = m + 1 < a->norms ? &grid[m + 1] : NULL};
    enum br_status status = br_differences_run(grid, axis, found, a->threads, a->observer, why);
    if (status == BR_NO_MEMORY || status == BR_INTERRUPTED)
        return br_fail(err, status, "%s", why->message);
    a->first[axis] = front ? from : a->first[axis];
    a->end[axis] = front ? a->end[axis] : to;
    status = BR_OK;
    for (size_t m = 0; m < a->norms && !why->status; m++) {
        if (!status)
            status = add(&a->over[axis][m], &found[m], axis, front, size + a->first[axis], err);
        br_study_clear(&found[m]);
    }
    return status;
}

enum br_status br_grid_differences_meshes(struct br_grid_differences *a, struct br_error *err)
{
    choose_meshes(a, a->report->study);
    choose_steps(a, a->report->study);
    if (compare(a, BR_AXIS_SPACE, 0, a->end[BR_AXIS_SPACE], &a->no_meshes, err))
        return err->status;
    for (size_t m = 0; m < a->norms; m++)
        if (a->no_meshes.status)
            a->report[m].no_meshes = a->no_meshes.message;
        else
            a->report[m].compared[BR_AXIS_SPACE] = &a->over[BR_AXIS_SPACE][m];
    return BR_OK;
}

/* Sets the orders along an axis; settled: out. larger: the sizes that have come last; they may
 * settle an order, and then it is taken, but they take none away. */
static enum br_status see(const struct br_grid_differences *a, enum br_axis axis, bool larger,
                          bool *settled, struct br_error *err)
{
    *settled = true;
    for (size_t m = 0; m < a->norms; m++) {
        const struct br_study *over = &a->over[axis][m];
        struct br_report *report = &a->report[m];
        struct br_observed_order before[BR_PARTS];
        for (int part = 0; part < BR_PARTS; part++)
            before[part] = report->observed[part][axis];
        report->compared[axis] = over->cell ? over : NULL;
        if (over->cell && br_report_observe_orders(report, axis, err))
            return err->status;
        for (int part = 0; part < BR_PARTS && larger; part++) {
            struct br_observed_order *o = &report->observed[part][axis];
            const struct br_estimate *old = &before[part].order, *new = &o->order;
            if (br_order_determined(old) && !br_observed_settles(o) &&
                !(new->high - new->low < old->high - old->low))
                *o = before[part];
        }
        *settled = *settled && br_report_settles(report, axis);
    }
    return BR_OK;
}

enum br_status br_grid_differences_settle(struct br_grid_differences *a, enum br_axis axis,
                                          struct br_error *err)
{
    const struct br_study *s = a->report->study;
    struct br_error why = axis == BR_AXIS_SPACE ? a->no_meshes : (struct br_error){0};
    const size_t most = a->first[axis] + FINER;
    bool settled = false;
    double left = 0;
    for (size_t c = 0; c < br_study_cells(s); c++)
        left += work_of(s->cell[c].at.n, s->cell[c].at.steps);
    left = fmax(left, no_matter);
    enum br_status status = see(a, axis, false, &settled, err);
    while (!status && !settled && !why.status) {
        const size_t end = a->end[axis], first = a->first[axis];
        size_t from = end ? end - 1 : first, to = end ? end + 1 : first + PAIRS + 2;
        for (size_t i = from; i + 1 < to && to <= most; i++)
            left -= work_of_pair(a, axis, i);
        if (to > most || left < 0) {
            if (first == 0 || end == 0)
                break;
            from = first - 1, to = first + 1;
        }
        status = compare(a, axis, from, to, &why, err);
        if (!status)
            status = see(a, axis, from < first, &settled, err);
    }
    return status;
}
