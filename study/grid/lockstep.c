/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference is marched a batch of time levels at a time, its two fields apart, and leaves its
 * projections (ladder.h) in one of a few buffers; the cells then take their own steps through the
 * batch and measure their errors, while the reference is already filling the other buffers. Each of
 * these is a lane, which does its batches in their order, on whichever thread is free. The bending
 * field follows the axial one; the axial field waits only for a free buffer. Every march is one
 * sequence of operations whichever threads run it, so the result has the same bits on any number.
 */
#include "study/grid/lockstep.h"

#include <math.h>
#include <stdio.h>

#include "solver/clock.h"
#include "solver/scene.h"
#include "study/base/each.h"
#include "study/base/text.h"

/* ---- measuring ---- */

static bool is_used(const struct br_measured *f, enum br_field_kind kind, bool last)
{
    return f->used && f->at.kind == kind && (last || !f->last_only);
}

/* The projection at the level of that index. */
static double *projection_at(const struct br_lockstep *l, const struct br_measured *f, size_t index)
{
    return f->projection + index % l->buffered_levels * f->size;
}

/* Samples the reference and projects it; returns its norm. */
static double project(struct br_lockstep *l, const struct br_measured *f, double *projection)
{
    struct br_sample_at at = f->at;
    for (at.mesh = 0; at.mesh < (f->ladder ? l->root_meshes : 1); at.mesh++)
        l->reference.judge->sample(l->reference.self, &at, &f->root_view[at.mesh]);
    if (!f->ladder) {
        *projection = l->study->reference_tip[at.kind] = f->root_view[0].values[0];
        return fabs(*projection);
    }
    br_ladder_project(f->ladder, f->root_view, projection);
    return br_ladder_norm(f->ladder, projection);
}

/* The distance of the last sample of the reference from the auditor. */
static double audit(struct br_lockstep *l, struct br_measured *f)
{
    l->auditor.judge->sample(l->auditor.self, &f->at, &f->audit);
    if (!f->own_ladder)
        return fabs(f->audit.values[0] - f->root_view[0].values[0]);
    br_ladder_project(f->own_ladder, f->root_view, f->own_projection);
    return br_ladder_distance(f->own_ladder, 0, &f->audit, f->own_projection);
}

/* Whether the reference is audited at the level of that index. */
static bool is_audited(const struct br_lockstep *l, size_t index)
{
    return l->auditor.judge && (index % l->audit_every == 0 || index + 1 == l->level_count);
}

/* Advances one field of the reference or of the auditor to a level and measures it. */
static enum br_status judge_level(struct br_lockstep *l, const struct br_bench *bench,
                                  enum br_field_kind kind, size_t index, struct br_error *err)
{
    const size_t level = l->level[index];
    const enum br_status status = bench->judge->advance(bench->self, kind, level, err);
    double *size = bench->sample[index % l->buffered_levels].size[kind];
    const bool last = level == l->study->reference.steps;
    for (struct br_measured *f = l->measured; f < l->measured + BR_MEASURED && !status; f++)
        if (f->at.kind == kind)
            size[f->at.measure] = !is_used(f, kind, last) ? 0
                                  : bench == &l->auditor
                                      ? audit(l, f)
                                      : project(l, f, projection_at(l, f, index));
    return status;
}

static void add_to_all(const struct br_lockstep *l, const struct br_sample *sample,
                       struct br_norm_sum *sum)
{
    for (const struct br_study *s = l->study; s; s = s->next_norm)
        br_norm_add(s->norm, s->scene, sample, sum++);
}

/* Adds the sample of a level to the sums, level after level. In an integral over time, a sample has
 * the weight of the time since the sample before. */
static void add_up(const struct br_lockstep *l, struct br_bench *bench, size_t index)
{
    struct br_sample *sample = &bench->sample[index % l->buffered_levels];
    sample->time =
        l->study->scene->duration * (double)l->level[index] / (double)l->study->reference.steps;
    sample->weight = sample->time - bench->time;
    bench->time = sample->time;
    add_to_all(l, sample, bench->sum);
}

/* Measures a cell at its present time against the reference at the level of that index. */
static void measure_cell(struct br_lockstep *l, size_t index, size_t level)
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
        const double size = f->ladder ? br_ladder_distance(f->ladder, br_study_row(l->study, index),
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

/* Writes the results of one cell in one norm. */
static void conclude_cell(const struct br_lockstep *l, struct br_study *s, size_t index,
                          const struct br_norm_sum *sum)
{
    struct br_cell *cell = &s->cell[index];
    const struct br_cell *first = &l->study->cell[index];
    cell->seconds = l->cell[index].seconds;
    cell->unstable = l->cell[index].march && br_march_contact_unstable(l->cell[index].march);
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        cell->tip[kind] = first->tip[kind];
    for (enum br_part part = 0; part < BR_PARTS && !cell->failure.status; part++) {
        cell->error[part] = br_norm_value(s->norm, sum, part);
        cell->worst_time[part] = sum->time[part];
    }
}

/* Writes what was measured into the studies. */
static void conclude_norms(struct br_lockstep *l)
{
    size_t m = 0;
    for (struct br_study *s = l->study; s; s = s->next_norm, m++) {
        s->auditor = l->study->auditor;
        s->judged_by = l->reference.judge->report(l->reference.self);
        s->reference_scale = br_norm_value(s->norm, &l->reference.sum[m], BR_PART_TOTAL);
        for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
            const enum br_part part = br_part_of(kind);
            s->reference_size[kind] = br_norm_value(s->norm, &l->reference.sum[m], part);
            s->reference_tip[kind] = l->study->reference_tip[kind];
        }
        for (enum br_part part = 0; part < BR_PARTS; part++)
            s->reference_error[part] =
                s->auditor ? br_norm_value(s->norm, &l->auditor.sum[m], part) : NAN;
        for (size_t i = 0; i < br_study_cells(s); i++)
            conclude_cell(l, s, i, &l->cell_sum[i * l->norms + m]);
    }
}

/* ---- one batch ---- */

static size_t batch_end(const struct br_lockstep *l, size_t b)
{
    const size_t end = (b + 1) * l->batch;
    return end < l->level_count ? end : l->level_count;
}

static bool should_stop(struct br_lockstep *l)
{
    if (br_observer_stops(l->observer))
        atomic_store(&l->stopped, true);
    return atomic_load(&l->stopped);
}

/* Whether the reference, in one field or the other, has failed before that level. */
static bool failed_before(const struct br_lockstep *l, size_t index)
{
    return atomic_load(&l->first_failed) <= index;
}

/* The failure that counts is that of the first level, and at that level that of the axial field,
 * whichever thread was faster. Therefore the other field goes on up to that level. */
static void keep_failure(struct br_lockstep *l, enum br_field_kind kind, size_t index,
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

static void reference_batch(struct br_lockstep *l, enum br_field_kind kind, size_t b)
{
    struct br_error failure = {0};
    for (size_t i = b * l->batch; i < batch_end(l, b) && l->study->scene->field[kind].modelled;
         i++) {
        if (should_stop(l) || failed_before(l, i))
            return;
        if (judge_level(l, &l->reference, kind, i, &failure) ||
            (is_audited(l, i) && judge_level(l, &l->auditor, kind, i, &failure)))
            keep_failure(l, kind, i, &failure);
    }
}

static void add_up_batch(struct br_lockstep *l, size_t b)
{
    for (size_t i = b * l->batch; i < batch_end(l, b) && !failed_before(l, i); i++) {
        add_up(l, &l->reference, i);
        if (is_audited(l, i))
            add_up(l, &l->auditor, i);
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
static void cell_level(struct br_lockstep *l, size_t index, size_t cell)
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
static void cells_batch(struct br_lockstep *l, size_t b, size_t task)
{
    for (size_t i = b * l->batch; i < batch_end(l, b); i++) {
        if (atomic_load(&l->stopped) || failed_before(l, i))
            return;
        for (size_t c = l->task_cell[task]; c < l->task_cell[task + 1]; c++)
            cell_level(l, i, c);
    }
}

/* ---- running ---- */

/* All the studies of a call, and their progress. */
struct work {
    struct br_study *studies;
    struct br_lockstep *step;
    size_t count;
    pthread_mutex_t lock; /* of all lanes */
    pthread_cond_t done;  /* a lane has done a batch */
    atomic_size_t finished_batches;
    size_t all_batches;
    const struct br_observer *observer;
};

static void report_progress(struct work *work, struct br_lockstep *l)
{
    if (atomic_load(&l->stopped) || failed_before(l, l->level_count))
        return;
    const size_t done = atomic_fetch_add(&work->finished_batches, 1) + 1;
    if (work->observer && work->observer->progress)
        work->observer->progress(work->observer->self, (double)done / (double)work->all_batches);
}

/* The batches that are to be done: after a failure those up to it, so that it is the first one. */
static size_t last_batch(struct br_lockstep *l)
{
    const size_t failed = atomic_load(&l->first_failed);
    if (atomic_load(&l->stopped))
        return 0;
    return failed / l->batch < l->batches ? failed / l->batch + 1 : l->batches;
}

/* Whether a lane's next batch has what it reads, and a buffer that nobody reads any more. */
static bool is_ready(const struct br_lockstep *l, size_t lane)
{
    const size_t b = l->lane[lane].done;
    if (l->lane[lane].busy || (lane > BR_LANE_AXIAL && b == l->lane[BR_LANE_AXIAL].done))
        return false;
    if (lane > BR_LANE_BENDING)
        return b < l->lane[BR_LANE_BENDING].done;
    for (size_t reader = lane + 1; reader < BR_LANE_CELLS + l->tasks; reader++)
        if (b == l->lane[reader].done + BR_LOCKSTEP_BUFFERS)
            return false;
    return true;
}

/* Chooses the ready lane with the earliest batch: *l and *lane (out). Returns whether anything is
 * left to do; *l is NULL if others do it, or have to end before it can begin. */
static bool choose_lane(const struct work *work, struct br_lockstep **l, size_t *lane)
{
    bool left = false;
    *l = NULL;
    for (struct br_lockstep *s = work->step; s < work->step + work->count; s++) {
        const size_t end = s->batches ? last_batch(s) : 0;
        for (size_t i = 0; i < BR_LANE_CELLS + s->tasks && end; i++) {
            if (s->lane[i].done >= end)
                continue;
            left = true;
            if (is_ready(s, i) && (!*l || s->lane[i].done < (*l)->lane[*lane].done)) {
                *l = s;
                *lane = i;
            }
        }
    }
    return left;
}

static void do_batch(struct work *work, struct br_lockstep *l, size_t lane, size_t b)
{
    if (lane <= BR_LANE_BENDING)
        reference_batch(l, lane == BR_LANE_AXIAL ? BR_AXIAL : BR_BENDING, b);
    if (lane == BR_LANE_BENDING)
        report_progress(work, l);
    if (lane == BR_LANE_SUMS)
        add_up_batch(l, b);
    if (lane >= BR_LANE_CELLS)
        cells_batch(l, b, lane - BR_LANE_CELLS);
}

/* What each thread does. */
static void do_batches(void *self)
{
    struct work *work = self;
    struct br_lockstep *l;
    size_t i = 0;
    pthread_mutex_lock(&work->lock);
    while (choose_lane(work, &l, &i)) {
        if (!l) {
            pthread_cond_wait(&work->done, &work->lock);
            continue;
        }
        struct br_lane *lane = &l->lane[i];
        lane->busy = true;
        pthread_mutex_unlock(&work->lock);
        do_batch(work, l, i, lane->done);
        pthread_mutex_lock(&work->lock);
        lane->busy = false;
        lane->done++;
        pthread_cond_broadcast(&work->done);
    }
    pthread_mutex_unlock(&work->lock);
}

/* Keeps the reference's lines of events with the study. */
static enum br_status keep_events(struct br_lockstep *l, struct br_study *study,
                                  struct br_error *err)
{
    size_t size;
    FILE *out = br_text_open(&study->events, &size);
    if (out)
        l->reference.judge->print_notes(l->reference.self, out);
    return out && fclose(out) == 0 ? BR_OK : br_no_memory(err, "the events");
}

/* Whether a failure ends the whole call, not only one study. */
static bool is_fatal(const struct br_error *failure)
{
    return failure->status == BR_NO_MEMORY || failure->status == BR_INTERRUPTED;
}

/* Whether a study succeeded. Copies its failure to all its norms. */
static bool succeeded(struct br_study *first)
{
    for (struct br_study *s = first; s; s = s->next_norm)
        s->failure = first->failure;
    return !first->failure.status;
}

static enum br_status conclude(struct br_lockstep *l, struct br_error *err)
{
    if (l->failure.status)
        l->study->failure = l->failure;
    for (size_t i = 0; l->cell && i < br_study_cells(l->study); i++)
        if (l->cell[i].error.status == BR_NO_MEMORY)
            l->study->failure = l->cell[i].error;
    if (!l->study->failure.status && atomic_load(&l->stopped))
        br_fail(&l->study->failure, BR_INTERRUPTED, "interrupted");
    if (is_fatal(&l->study->failure))
        return br_fail(err, l->study->failure.status, "%s", l->study->failure.message);
    if (!succeeded(l->study))
        return BR_OK;
    conclude_norms(l);
    enum br_status status = BR_OK;
    for (struct br_study *study = l->study; study && !status; study = study->next_norm)
        status = keep_events(l, study, err);
    return status;
}

static void create(struct work *work, size_t s)
{
    struct br_lockstep *l = &work->step[s];
    struct br_study *study = &work->studies[s];
    if (study->failure.status)
        l->study = study;
    else if (br_lockstep_create(l, study, work->observer, &study->failure))
        l->batches = 0; /* nothing to march */
}

/* Sets up all studies of the scene of study `first`, unless a study before it has that scene; an
 * exact reference computes its solution here. Studies of one scene are set up one after the other,
 * since all of them use its functions (scene.h). */
static enum br_status create_of_scene(void *self, size_t first, struct br_error *err)
{
    struct work *work = self;
    const struct br_study *studies = work->studies;
    (void)err;
    for (size_t s = 0; s < first; s++)
        if (studies[s].scene == studies[first].scene)
            return BR_OK;
    for (size_t s = first; s < work->count; s++)
        if (studies[s].scene == studies[first].scene)
            create(work, s);
    return BR_OK;
}

static size_t most_lanes(const struct work *work)
{
    size_t most = 0;
    for (size_t s = 0; s < work->count; s++)
        most += BR_LANE_CELLS + work->step[s].tasks;
    return most;
}

enum br_status br_lockstep(struct br_study *studies, size_t count, int threads,
                           const struct br_observer *observer, struct br_error *err)
{
    struct work work = {.studies = studies,
                        .count = count,
                        .lock = PTHREAD_MUTEX_INITIALIZER,
                        .done = PTHREAD_COND_INITIALIZER,
                        .observer = observer};
    work.step = br_allocate(count, sizeof *work.step);
    if (!work.step)
        return br_no_memory(err, "the studies");
    threads = br_threads(threads);
    br_each(&(struct br_each){count, threads, NULL, create_of_scene, NULL, &work}, NULL);
    bool fatal = false;
    for (size_t s = 0; s < count; s++) {
        work.all_batches += work.step[s].batches;
        fatal |= is_fatal(&studies[s].failure);
    }
    if (!fatal)
        br_team(most_lanes(&work) < (size_t)threads ? (int)most_lanes(&work) : threads, do_batches,
                &work);
    enum br_status status = BR_OK;
    for (size_t s = 0; s < count && !status; s++)
        status = conclude(&work.step[s], err);
    for (size_t s = 0; s < count; s++)
        br_lockstep_clear(&work.step[s]);
    free(work.step);
    return status;
}
