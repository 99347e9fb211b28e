/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/grid/differences.h"

#include <math.h>

#include "study/grid/sweep.h"

/* Each pair of neighbouring cells is a study of one cell, in a chain of as many norms as the grid
 * has; all pairs run at once. */
struct pairs {
    const struct br_study *grid;
    size_t norms, count;
    struct br_study *study; /* count of the first norm, then of the next, ... */
};

/* The pair that begins at cell (i, j) and goes to the next mesh or the next time step. */
static size_t pair_index(const struct br_study *grid, bool over_h, size_t i, size_t j)
{
    return over_h ? i * grid->k_count + j
                  : (grid->n_count - 1) * grid->k_count + i * (grid->k_count - 1) + j;
}

static void set_pair(const struct pairs *p, bool over_h, size_t i, size_t j)
{
    const struct br_study *grid = p->grid;
    const size_t first = pair_index(grid, over_h, i, j);
    size_t m = 0;
    for (const struct br_study *norm = grid; norm; norm = norm->next_norm, m++)
        p->study[m * p->count + first] = (struct br_study){
            .scene = grid->scene,
            .norm = norm->norm,
            .method = grid->method,
            .judge = &br_judge_fine,
            .reference_method = grid->method,
            .reference = {grid->n[i + over_h], grid->steps[j + !over_h]},
            .n_count = 1,
            .k_count = 1,
            .n = &grid->n[i],
            .steps = &grid->steps[j],
            .next_norm = norm->next_norm ? &p->study[(m + 1) * p->count + first] : NULL,
        };
}

static enum br_status check_grid(const struct br_study *grid, struct br_error *err)
{
    if (grid->n_count < 1 || grid->k_count < 1 || grid->n_count + grid->k_count < 3)
        return br_fail(err, BR_BAD_INPUT,
                       "found %zu meshes and %zu time steps, expected at least two of one of them: "
                       "successive grids are compared",
                       grid->n_count, grid->k_count);
    for (size_t i = 0; i + 1 < grid->n_count; i++)
        if (grid->n[i] == 0 || grid->n[i + 1] % grid->n[i] != 0)
            return br_fail(err, BR_BAD_INPUT,
                           "n = %zu does not divide n = %zu, the next finer mesh, which it is "
                           "compared with",
                           grid->n[i], grid->n[i + 1]);
    for (size_t j = 0; j + 1 < grid->k_count; j++)
        if (grid->steps[j] == 0 || grid->steps[j + 1] % grid->steps[j] != 0)
            return br_fail(err, BR_BAD_INPUT,
                           "the time levels of k = %g s are not all among those of k = %g s, the "
                           "next smaller step, which it is compared with",
                           br_time_step(grid->scene, grid->steps[j]),
                           br_time_step(grid->scene, grid->steps[j + 1]));
    return BR_OK;
}

static enum br_status create_pairs(struct pairs *p, struct br_error *err)
{
    const struct br_study *grid = p->grid;
    for (const struct br_study *norm = grid; norm; norm = norm->next_norm)
        p->norms++;
    p->count = (grid->n_count - 1) * grid->k_count + grid->n_count * (grid->k_count - 1);
    p->study = br_allocate(p->count * p->norms, sizeof *p->study);
    if (!p->study)
        return br_no_memory(err, "the differences");
    for (size_t i = 0; i < grid->n_count; i++)
        for (size_t j = 0; j < grid->k_count; j++) {
            if (i + 1 < grid->n_count)
                set_pair(p, true, i, j);
            if (j + 1 < grid->k_count)
                set_pair(p, false, i, j);
        }
    return BR_OK;
}

/* A pair is unstable if one of its two marches is. */
static struct br_cell cell_of(const struct br_study *pair)
{
    struct br_cell cell = pair->cell[0];
    cell.unstable |= pair->judged_by.unstable;
    return cell;
}

/* The pairs of one direction and norm as one study. */
static enum br_status gather(const struct pairs *p, bool over_h, size_t m, struct br_study *out,
                             struct br_error *err)
{
    const struct br_study *first = &p->study[m * p->count + pair_index(p->grid, over_h, 0, 0)];
    *out = *p->grid;
    out->norm = first->norm;
    out->judge = &br_judge_none;
    out->auditor = NULL;
    out->next_norm = NULL;
    out->events = NULL;
    out->reference = (struct br_resolution){0};
    out->judged_by = first->judged_by;
    out->reference_scale = first->reference_scale;
    out->n_count -= over_h;
    out->k_count -= !over_h;
    out->cell = br_allocate(out->n_count * out->k_count, sizeof *out->cell);
    if (!out->cell)
        return br_no_memory(err, "the differences");
    for (size_t i = 0; i < out->n_count; i++)
        for (size_t j = 0; j < out->k_count; j++)
            out->cell[i * out->k_count + j] =
                cell_of(&p->study[m * p->count + pair_index(p->grid, over_h, i, j)]);
    return BR_OK;
}

enum br_status br_differences_run(const struct br_study *grid, struct br_differences *out,
                                  int threads, const struct br_observer *observer,
                                  struct br_error *err)
{
    struct pairs p = {.grid = grid};
    enum br_status status = check_grid(grid, err);
    if (!status)
        status = create_pairs(&p, err);
    if (!status)
        status = br_study_run(p.study, p.count, threads, observer, err);
    for (size_t m = 0; m < p.norms && !status; m++) {
        for (int axis = 0; axis < BR_AXES && !status; axis++)
            if (br_axis_count(grid, axis) > 1)
                status = gather(&p, axis == BR_AXIS_SPACE, m, &out[m].over[axis], err);
    }
    for (size_t i = 0; p.study && i < p.count * p.norms; i++)
        br_study_clear(&p.study[i]);
    free(p.study);
    return status;
}
