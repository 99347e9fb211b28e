/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference is marched a batch of time levels at a time, its two fields apart, and leaves its
 * projections (nested_meshes.h) in one of a few buffers; the cells then take their own steps
 * through the batch and measure their errors, while the reference is already filling the other
 * buffers. Each of these is a lane, which does its batches in their order, on whichever thread is
 * free. The bending field follows the axial one; the axial field waits only for a free buffer.
 * Every march is one sequence of operations whichever threads run it, so the result has the same
 * bits on any number.
 */
#include "study/grid/study_march.h"

#include <math.h>

#include "base/clock.h"
#include "solver/scene.h"

/* ---- measuring ---- */

static bool is_used(const struct br_measured *f, enum br_field_kind kind, bool last)
{
    return f->used && f->at.kind == kind && (last || !f->last_only);
}

/* The projection at the level of that index. */
static double *projection_at(const struct br_study_march *l, const struct br_measured *f,
                             size_t index)
{
    return f->projection + index % l->buffered_levels * f->size;
}

/* Samples the reference and projects it; returns its norm. */
static double project(struct br_study_march *l, const struct br_measured *f, double *projection)
{
    struct br_sample_at at = f->at;
    for (at.mesh = 0; at.mesh < (f->nested ? l->root_meshes : 1); at.mesh++)
        l->reference.reference_kind->sample(l->reference.self, &at, &f->root_view[at.mesh]);
    if (!f->nested) {
        *projection = l->study->reference_tip[at.kind] = f->root_view[0].values[0];
        return fabs(*projection);
    }
    br_nested_meshes_project(f->nested, f->root_view, projection);
    return br_nested_meshes_norm(f->nested, projection);
}

/* The distance of the last sample of the reference from the reference check. */
static double check_reference(struct br_study_march *l, struct br_measured *f)
{
    l->reference_check.reference_kind->sample(l->reference_check.self, &f->at, &f->check);
    if (!f->own_nested)
        return fabs(f->check.values[0] - f->root_view[0].values[0]);
    br_nested_meshes_project(f->own_nested, f->root_view, f->own_projection);
    return br_nested_meshes_distance(f->own_nested, 0, &f->check, f->own_projection);
}

/* Whether the reference is checked at the level of that index. */
static bool is_checked(const struct br_study_march *l, size_t index)
{
    return l->reference_check.reference_kind &&
           (index % l->check_every == 0 || index + 1 == l->level_count);
}

/* Advances one field of the reference or of its check to a level and measures it. */
static enum br_status measure_level(struct br_study_march *l, const struct br_reference_run *run,
                                    enum br_field_kind kind, size_t index, struct br_error *err)
{
    const size_t level = l->level[index];
    const enum br_status status = run->reference_kind->advance(run->self, kind, level, err);
    double *size = run->sample[index % l->buffered_levels].size[kind];
    const bool last = level == l->study->reference.steps;
    for (struct br_measured *f = l->measured; f < l->measured + BR_MEASURED && !status; f++)
        if (f->at.kind == kind)
            size[f->at.measure] = !is_used(f, kind, last) ? 0
                                  : run == &l->reference_check
                                      ? check_reference(l, f)
                                      : project(l, f, projection_at(l, f, index));
    return status;
}

static void add_to_all(const struct br_study_march *l, const struct br_sample *sample,
                       struct br_norm_sum *sum)
{
    for (const struct br_study *s = l->study; s; s = s->next_norm)
        br_norm_add(s->norm, s->scene, sample, sum++);
}

/* Adds the sample of a level to the sums, level after level. In an integral over time, a sample has
 * the weight of the time since the sample before. */
static void add_up(const struct br_study_march *l, struct br_reference_run *run, size_t index)
{
    struct br_sample *sample = &run->sample[index % l->buffered_levels];
    sample->time =
        l->study->scene->duration * (double)l->level[index] / (double)l->study->reference.steps;
    sample->weight = sample->time - run->time;
    run->time = sample->time;
    add_to_all(l, sample, run->sum);
}

/* Measures a cell at its present time against the reference at the level of that index. */
static void measure_cell(struct br_study_march *l, size_t index, size_t level)
{
    struct br_runner *r = &l->cell[index];
    struct br_cell *cell = &l->study->cell[index];
    const bool last = br_march_steps_done(r->march) == cell->at.steps;
    const double t = br_march_time(r->march);
    struct br_sample sample = {
        .time = t,
        .weight = t > 0 ? br_time_step(l->study->scene, cell->at.steps) : 0,
    };
    for (const struct br_measured *f = l->measured; f < l->measured + BR_MEASURED; f++) {
        if (!is_used(f, f->at.kind, last))
            continue;
        const double *reference = projection_at(l, f, level);
        br_march_sample(r->march, f->at.kind, f->at.measure, &r->view);
        const double size =
            f->nested ? br_nested_meshes_distance(f->nested, br_study_row(l->study, index),
                                                  &r->view, reference)
                      : fabs(r->view.values[0] - *reference);
        if (!isfinite(size))
            br_fail(&r->error, BR_NOT_FINITE, "the error at t = %g s is %g", t, size);
        sample.size[f->at.kind][f->at.measure] = size;
        if (f->at.measure == BR_TIP)
            cell->tip[f->at.kind] = r->view.values[0];
    }
    if (r->error.status)
        br_cell_failed(l->study, index, &r->error);
    else
        add_to_all(l, &sample, l->cell_sum + index * l->norms);
}

void br_cell_failed(struct br_study *study, size_t index, const struct br_error *error)
{
    for (struct br_study *s = study; s; s = s->next_norm) {
        struct br_cell *cell = &s->cell[index];
        cell->failure = *error;
        for (enum br_part part = 0; part < BR_PARTS; part++) {
            cell->error[part] = NAN;
            cell->flag[part] = BR_FLAG_FAILED;
        }
    }
}

/* ---- one batch ---- */

static size_t batch_end(const struct br_study_march *l, size_t b)
{
    const size_t end = (b + 1) * l->batch;
    return end < l->level_count ? end : l->level_count;
}

static bool should_stop(struct br_study_march *l)
{
    if (br_observer_stops(l->observer))
        atomic_store(&l->stopped, true);
    return atomic_load(&l->stopped);
}

/* Whether the reference, in one field or the other, has failed before that level. */
static bool failed_before(const struct br_study_march *l, size_t index)
{
    return atomic_load(&l->first_failed) <= index;
}

/* The failure that counts is that of the first level, and at that level that of the axial field,
 * whichever thread was faster. Therefore the other field goes on up to that level. */
static void keep_failure(struct br_study_march *l, enum br_field_kind kind, size_t index,
                         const struct br_error *failure)
{
    pthread_mutex_lock(&l->lock);
    if (index < atomic_load(&l->first_failed) ||
        (index == atomic_load(&l->first_failed) && kind == BR_AXIAL)) {
        l->failure = *failure;
        atomic_store(&l->first_failed, index);
    }
    pthread_mutex_unlock(&l->lock);
}

void br_reference_batch(struct br_study_march *l, enum br_field_kind kind, size_t b)
{
    struct br_error failure = {0};
    for (size_t i = b * l->batch; i < batch_end(l, b) && l->study->scene->field[kind].modelled;
         i++) {
        if (should_stop(l) || failed_before(l, i))
            return;
        if (measure_level(l, &l->reference, kind, i, &failure) ||
            (is_checked(l, i) && measure_level(l, &l->reference_check, kind, i, &failure)))
            keep_failure(l, kind, i, &failure);
    }
}

void br_sums_batch(struct br_study_march *l, size_t b)
{
    for (size_t i = b * l->batch; i < batch_end(l, b) && !failed_before(l, i); i++) {
        add_up(l, &l->reference, i);
        if (is_checked(l, i))
            add_up(l, &l->reference_check, i);
    }
}

/* Steps on to the cell's time level `step`, and counts the seconds. */
static enum br_status advance(struct br_runner *r, size_t step)
{
    const double start = br_seconds();
    while (!r->error.status && br_march_steps_done(r->march) < step)
        br_march_step(r->march, &r->error);
    r->seconds += br_seconds() - start;
    return r->error.status;
}

/* Advances a cell to the level of that index, if the cell has it, and measures it there. */
static void cell_level(struct br_study_march *l, size_t index, size_t cell)
{
    struct br_runner *r = &l->cell[cell];
    const size_t ratio = l->study->reference.steps / l->study->cell[cell].at.steps;
    if (r->error.status || l->level[index] % ratio != 0)
        return;
    if (advance(r, l->level[index] / ratio))
        br_cell_failed(l->study, cell, &r->error);
    else
        measure_cell(l, cell, index);
}

/* Level by level: the cells of a task read the same projection while it is in the cache. */
void br_cells_batch(struct br_study_march *l, size_t b, size_t task)
{
    for (size_t i = b * l->batch; i < batch_end(l, b); i++) {
        if (atomic_load(&l->stopped) || failed_before(l, i))
            return;
        for (size_t c = l->task_cell[task]; c < l->task_cell[task + 1]; c++)
            cell_level(l, i, c);
    }
}
