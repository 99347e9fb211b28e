/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/grid/sweep.h"

/* Each pair of neighbouring cells is a study of one cell, against the finer one as a fine run.
 * study (out): the pairs of the first norm, then of the next, ... */
static void set_pairs(const struct br_study *grid, bool over_h, size_t pairs,
                      struct br_study *study)
{
    const size_t columns = grid->k_count - !over_h;
    for (const struct br_study *norm = grid; norm; norm = norm->next_norm, study += pairs)
        for (size_t c = 0; c < pairs; c++) {
            const size_t i = c / columns, j = c % columns;
            study[c] = (struct br_study){
                .scene = grid->scene,
                .norm = norm->norm,
                .method = grid->method,
                .reference_kind = &br_reference_fine,
                .reference_method = grid->method,
                .reference = {grid->n[i + over_h], grid->steps[j + !over_h]},
                .n_count = 1,
                .k_count = 1,
                .n = &grid->n[i],
                .steps = &grid->steps[j],
                .next_norm = norm->next_norm ? &study[c + pairs] : NULL,
            };
        }
}

/* The pairs of one norm as one study. */
static enum br_status gather(const struct br_study *grid, bool over_h, size_t pairs,
                             const struct br_study *pair, struct br_study *out,
                             struct br_error *err)
{
    *out = *grid;
    out->norm = pair->norm;
    out->reference_kind = &br_reference_none;
    out->reference_check = NULL;
    out->next_norm = NULL;
    out->events = NULL;
    out->reference = (struct br_resolution){0};
    out->reference_report = pair->reference_report;
    out->reference_scale = pair->reference_scale;
    out->n_count -= over_h;
    out->k_count -= !over_h;
    out->cell = br_allocate(pairs, sizeof *out->cell);
    if (!out->cell)
        return br_no_memory(err, "the differences");
    for (size_t c = 0; c < pairs; c++) {
        out->cell[c] = pair[c].cell[0];
        out->cell[c].unstable |= pair[c].reference_report.unstable; /* one of the two marches is */
    }
    return BR_OK;
}

enum br_status br_differences_run(const struct br_study *grid, enum br_axis axis,
                                  struct br_study *out, int threads,
                                  const struct br_observer *observer, struct br_error *err)
{
    const bool over_h = axis == BR_AXIS_SPACE;
    size_t norms = 0;
    if (grid->n_count < 1u + over_h || grid->k_count < 1u + !over_h)
        return br_fail(err, BR_BAD_INPUT,
                       "found %zu meshes and %zu time steps, expected at least two of those that "
                       "are compared",
                       grid->n_count, grid->k_count);
    for (const struct br_study *norm = grid; norm; norm = norm->next_norm)
        norms++;
    const size_t pairs = (grid->n_count - over_h) * (grid->k_count - !over_h);
    struct br_study *study = br_allocate(pairs * norms, sizeof *study);
    if (!study)
        return br_no_memory(err, "the differences");
    set_pairs(grid, over_h, pairs, study);
    enum br_status status = br_study_run(study, pairs, threads, observer, err);
    for (size_t m = 0; m < norms && !status; m++)
        status = gather(grid, over_h, pairs, &study[m * pairs], &out[m], err);
    for (size_t i = 0; i < pairs * norms; i++)
        br_study_clear(&study[i]);
    free(study);
    return status;
}
