/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference is marched a batch of time levels at a time and leaves their
 * projections (ladder.h) in one of two buffers; each cell then takes its own
 * steps through the batch and measures its errors, while the reference is
 * already filling the other buffer. These are OpenMP tasks whose dependences are
 * the buffers and the marches. Every march is one sequence of operations
 * whichever threads run it, so the result has the same bits on any number. */
#include "study/lockstep.h"

#include <math.h>
#include <stdio.h>
#ifdef _OPENMP
#include <omp.h>
#endif

#include "study/lockstep_state.h"

/* ---- the reference ---- */

static double norm(const double *modes, size_t count, double rest)
{
    double sum = rest;
    for (size_t i = 0; i < count; i++)
        sum += modes[i] * modes[i];
    return sqrt(sum);
}

/* The field's L2 norm, from the first root mesh. */
static double look_at_reference(struct br_lockstep *l, enum br_field_kind kind)
{
    struct br_channel *c = &l->channel[kind];
    for (size_t i = 0; i < l->roots; i++)
        l->reference.judge->look(l->reference.self, kind, i, c->root[i].modes, &c->root[i].rest);
    return norm(c->root[0].modes, l->root[0] * br_mode_count(kind), c->root[0].rest);
}

static void project_reference(struct br_lockstep *l, size_t buffer, size_t slot)
{
    double scale = 0;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        struct br_channel *c = &l->channel[kind];
        if (!c->modelled)
            continue;
        scale += look_at_reference(l, (enum br_field_kind)kind);
        br_ladder_project(c->ladder, c->root,
                          c->projection[buffer] + slot * br_ladder_size(c->ladder));
    }
    l->study->reference_scale = fmax(l->study->reference_scale, scale);
}

/* Keeps the larger of each part; a NaN stays. */
static void keep_largest(double largest[BR_PARTS], const double error[BR_PARTS])
{
    for (int part = 0; part < BR_PARTS; part++)
        if (!(error[part] <= largest[part]) && !isnan(largest[part]))
            largest[part] = error[part];
}

/* The distance of the reference, as last looked at, from the auditor. */
static enum br_status audit(struct br_lockstep *l, size_t level, struct br_error *err)
{
    const enum br_status status = l->auditor.judge->advance(l->auditor.self, level, err);
    double error[BR_PARTS] = {0};
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
        struct br_channel *c = &l->channel[kind];
        if (!c->modelled)
            continue;
        double rest;
        l->auditor.judge->look(l->auditor.self, (enum br_field_kind)kind, 0, c->audit, &rest);
        const size_t count = l->root[0] * br_mode_count((enum br_field_kind)kind);
        for (size_t i = 0; i < count; i++)
            c->audit[i] -= c->root[0].modes[i];
        const double distance = norm(c->audit, count, rest);
        error[kind == BR_AXIAL ? BR_PART_AXIAL : BR_PART_BENDING] = distance;
        error[BR_PART_TOTAL] += distance;
    }
    keep_largest(l->study->reference_error, error);
    return status;
}

static size_t batch_end(const struct br_lockstep *l, size_t b)
{
    const size_t end = (b + 1) * l->batch;
    return end < l->level_count ? end : l->level_count;
}

static bool should_stop(struct br_lockstep *l)
{
    if (l->observer && l->observer->stop && l->observer->stop(l->observer->self))
        atomic_store(&l->stopped, true);
    return atomic_load(&l->stopped);
}

static void reference_batch(struct br_lockstep *l, size_t b)
{
    for (size_t i = b * l->batch; i < batch_end(l, b) && !should_stop(l); i++) {
        struct br_error *error = &l->reference.error;
        if (l->reference.judge->advance(l->reference.self, l->level[i], error)) {
            atomic_store(&l->stopped, true);
            return;
        }
        project_reference(l, b % BR_LOCKSTEP_BUFFERS, i % l->batch);
        const bool audited =
            l->auditor.judge && (i % l->audit_every == 0 || i + 1 == l->level_count);
        if (audited && audit(l, l->level[i], error)) {
            atomic_store(&l->stopped, true);
            return;
        }
    }
}

/* ---- a cell ---- */

static void measure(struct br_lockstep *l, size_t index, size_t buffer, size_t slot)
{
    struct br_cell *cell = &l->study->cell[index];
    struct br_runner *r = &l->cell[index];
    const size_t rung = index / l->study->k_count;
    double error[BR_PARTS] = {0};
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct br_channel *c = &l->channel[kind];
        if (!c->modelled)
            continue;
        br_runner_look(r, (enum br_field_kind)kind);
        const double distance = br_ladder_distance(
            c->ladder, rung, r->modes, c->projection[buffer] + slot * br_ladder_size(c->ladder));
        error[kind == BR_AXIAL ? BR_PART_AXIAL : BR_PART_BENDING] = distance;
        error[BR_PART_TOTAL] += distance;
    }
    if (!isfinite(error[BR_PART_TOTAL])) {
        br_fail(&r->error, BR_NOT_FINITE, "the error at t = %g s is %g", br_march_time(r->march),
                error[BR_PART_TOTAL]);
        br_cell_failed(cell, &r->error);
        return;
    }
    for (int part = 0; part < BR_PARTS; part++)
        if (error[part] > cell->error[part]) {
            cell->error[part] = error[part];
            cell->worst_time[part] = br_march_time(r->march);
        }
}

static void cell_batch(struct br_lockstep *l, size_t b, size_t index)
{
    struct br_runner *r = &l->cell[index];
    struct br_cell *cell = &l->study->cell[index];
    const size_t ratio = l->study->reference.steps / cell->at.steps;
    for (size_t i = b * l->batch; i < batch_end(l, b) && !r->error.status; i++) {
        if (l->level[i] % ratio != 0)
            continue;
        if (atomic_load(&l->stopped))
            return;
        if (br_runner_advance(r, l->level[i] / ratio))
            br_cell_failed(cell, &r->error);
        else
            measure(l, index, b % BR_LOCKSTEP_BUFFERS, i % l->batch);
    }
    cell->seconds = r->seconds;
}

/* ---- running ---- */

/* All the studies of a call, and how far they are. */
struct crew {
    struct br_lockstep *step;
    size_t count;
    atomic_size_t finished_batches;
    size_t all_batches;
    const struct br_observer *observer;
};

static void tell(struct crew *crew, struct br_lockstep *l)
{
    if (atomic_load(&l->stopped))
        return;
    const size_t done = atomic_fetch_add(&crew->finished_batches, 1) + 1;
    if (crew->observer && crew->observer->progress)
        crew->observer->progress(crew->observer->self, (double)done / (double)crew->all_batches);
}

/* The tasks of batch b: the reference fills a buffer, then the cells read it. */
static void spawn_batch(struct crew *crew, struct br_lockstep *l, size_t b)
{
    (void)crew; /* without OpenMP */
    struct br_bench *reference = &l->reference;
    char *buffer = &l->token[b % BR_LOCKSTEP_BUFFERS];
    (void)reference, (void)buffer;
#pragma omp task depend(inout : reference[0]) depend(inout : buffer[0])
    {
        reference_batch(l, b);
        tell(crew, l);
    }
    for (size_t i = 0; i < l->study->n_count * l->study->k_count; i++) {
        struct br_runner *cell = &l->cell[i];
        (void)cell;
#pragma omp task depend(inout : cell[0]) depend(in : buffer[0])
        cell_batch(l, b, i);
    }
}

static void spawn_all(struct crew *crew)
{
    size_t most = 0;
    for (size_t s = 0; s < crew->count; s++)
        most = crew->step[s].batches > most ? crew->step[s].batches : most;
    for (size_t b = 0; b < most; b++)
        for (size_t s = 0; s < crew->count; s++)
            if (b < crew->step[s].batches)
                spawn_batch(crew, &crew->step[s], b);
}

/* What the reference tells, kept with the study. */
static enum br_status keep_events(struct br_lockstep *l, struct br_error *err)
{
    size_t size;
    FILE *out = open_memstream(&l->study->events, &size);
    if (!out)
        return br_no_memory(err, "the events");
    l->reference.judge->tell(l->reference.self, out);
    return fclose(out) == 0 ? BR_OK : br_no_memory(err, "the events");
}

static enum br_status outcome(struct crew *crew, struct br_error *err)
{
    for (size_t s = 0; s < crew->count; s++) {
        struct br_lockstep *l = &crew->step[s];
        l->study->judged_by = l->reference.judge->report(l->reference.self);
        if (l->reference.error.status)
            return br_fail(err, l->reference.error.status, "%s", l->reference.error.message);
        if (atomic_load(&l->stopped))
            return br_fail(err, BR_INTERRUPTED, "interrupted");
        const enum br_status status = keep_events(l, err);
        if (status)
            return status;
    }
    return BR_OK;
}

enum br_status br_lockstep(struct br_study *studies, size_t count, int threads,
                           const struct br_observer *observer, struct br_error *err)
{
    struct crew crew = {.count = count, .observer = observer};
    crew.step = br_allocate(count, sizeof *crew.step);
    if (!crew.step)
        return br_no_memory(err, "the studies");
    enum br_status status = BR_OK;
    for (size_t s = 0; s < count && !status; s++) {
        status = br_lockstep_create(&crew.step[s], &studies[s], observer, err);
        crew.all_batches += crew.step[s].batches;
    }
    if (!status) {
#ifdef _OPENMP
        if (threads <= 0)
            threads = omp_get_num_procs();
#endif
#pragma omp parallel num_threads(threads)
#pragma omp single
        spawn_all(&crew);
        status = outcome(&crew, err);
    }
    for (size_t s = 0; s < count; s++)
        if (crew.step[s].study)
            br_lockstep_clear(&crew.step[s]);
    free(crew.step);
    return status;
}
