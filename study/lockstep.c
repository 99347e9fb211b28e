/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference is marched a batch of time levels at a time and leaves their
 * projections (ladder.h) in one of two buffers; each cell then takes its own
 * steps through the batch and measures its errors, while the reference is
 * already filling the other buffer. These are OpenMP tasks whose dependences are
 * the buffers and the marches. Every march is one sequence of operations
 * whichever threads run it, so the result has the same bits on any number. */
#include "study/lockstep.h"

#include <math.h>
#include <stdatomic.h>
#include <time.h>
#ifdef _OPENMP
#include <omp.h>
#endif

#include "study/ladder.h"

enum { BUFFERS = 2 };
static const size_t buffer_bytes = 8u << 20; /* of a batch's projections, at most */
static const size_t most_levels = 32;        /* in a batch */
static const size_t most_audits = 1000;      /* of the reference, about */

/* One field of the reference and the cells. */
struct channel {
    bool modelled;
    struct br_ladder *ladder;
    struct br_root_value *root;  /* the reference on its meshes */
    double *projection[BUFFERS]; /* batch * ladder size */
    double *audit;               /* the auditor's modes on the reference's mesh */
};

/* A judge at work. */
struct bench {
    const struct br_judge *judge;
    void *self;
    struct br_error error; /* status BR_OK while all is well */
};

/* A march with room to look at it. */
struct runner {
    struct br_march *march;
    double *nodal, *modes;
    double seconds;
    struct br_error error; /* status BR_OK while all is well */
};

struct lockstep {
    struct br_study *study;
    struct channel channel[2];       /* by br_field_kind */
    struct bench reference, auditor; /* the auditor's judge may be NULL */
    size_t *root;                    /* the meshes on which the reference is looked at */
    size_t roots;
    size_t audit_every;  /* of the levels, so that there are not too many audits */
    struct runner *cell; /* n_count * k_count */
    size_t *level;       /* reference steps at which some cell has a time level */
    size_t level_count, batch, batches;
    const struct br_observer *observer;
    atomic_bool stopped;
    char token[BUFFERS]; /* what the tasks depend on: the buffers */
};

static double seconds_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void runner_clear(struct runner *r)
{
    br_march_free(r->march);
    free(r->nodal);
    free(r->modes);
    *r = (struct runner){0};
}

static enum br_status runner_start(struct runner *r, const struct br_scene *scene,
                                   struct br_resolution at, const struct br_method *method)
{
    const double start = seconds_now();
    const enum br_status status =
        br_march_create(&r->march, scene, at.n, at.steps, method, &r->error);
    r->seconds += seconds_now() - start;
    if (status)
        return r->error.status = status;
    r->nodal = br_allocate(2 * (at.n + 1), sizeof *r->nodal);
    r->modes = br_allocate(4 * at.n, sizeof *r->modes);
    if (!r->nodal || !r->modes)
        return br_no_memory(&r->error, "a cell");
    return BR_OK;
}

/* Steps on to its time level `step`. */
static enum br_status runner_advance(struct runner *r, size_t step)
{
    const double start = seconds_now();
    while (!r->error.status && br_march_steps_done(r->march) < step)
        br_march_step(r->march, &r->error);
    r->seconds += seconds_now() - start;
    return r->error.status;
}

static void runner_look(struct runner *r, enum br_field_kind kind)
{
    br_march_get(r->march, kind, r->nodal, NULL);
    br_modes(br_march_field(r->march, kind), r->nodal, r->modes);
}

/* ---- the reference ---- */

static double norm(const double *modes, size_t count, double rest)
{
    double sum = rest;
    for (size_t i = 0; i < count; i++)
        sum += modes[i] * modes[i];
    return sqrt(sum);
}

/* The field's L2 norm, from the first root mesh. */
static double look_at_reference(struct lockstep *l, enum br_field_kind kind)
{
    struct channel *c = &l->channel[kind];
    for (size_t i = 0; i < l->roots; i++)
        l->reference.judge->look(l->reference.self, kind, i, c->root[i].modes, &c->root[i].rest);
    return norm(c->root[0].modes, l->root[0] * br_mode_count(kind), c->root[0].rest);
}

static void project_reference(struct lockstep *l, size_t buffer, size_t slot)
{
    double scale = 0;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        struct channel *c = &l->channel[kind];
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
        if (!(error[part] <= largest[part]))
            largest[part] = error[part];
}

/* The distance of the reference, as last looked at, from the auditor. */
static enum br_status audit(struct lockstep *l, size_t level, struct br_error *err)
{
    const enum br_status status = l->auditor.judge->advance(l->auditor.self, level, err);
    double error[BR_PARTS] = {0};
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
        struct channel *c = &l->channel[kind];
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

static size_t batch_end(const struct lockstep *l, size_t b)
{
    const size_t end = (b + 1) * l->batch;
    return end < l->level_count ? end : l->level_count;
}

static bool should_stop(struct lockstep *l)
{
    if (l->observer && l->observer->stop && l->observer->stop(l->observer->self))
        atomic_store(&l->stopped, true);
    return atomic_load(&l->stopped);
}

static void reference_batch(struct lockstep *l, size_t b)
{
    for (size_t i = b * l->batch; i < batch_end(l, b) && !should_stop(l); i++) {
        struct br_error *error = &l->reference.error;
        if (l->reference.judge->advance(l->reference.self, l->level[i], error)) {
            atomic_store(&l->stopped, true);
            return;
        }
        project_reference(l, b % BUFFERS, i % l->batch);
        const bool audited =
            l->auditor.judge && (i % l->audit_every == 0 || i + 1 == l->level_count);
        if (audited && audit(l, l->level[i], error)) {
            atomic_store(&l->stopped, true);
            return;
        }
    }
}

/* ---- a cell ---- */

static void cell_failed(struct br_cell *cell, const struct br_error *error)
{
    cell->failure = *error;
    for (int part = 0; part < BR_PARTS; part++) {
        cell->error[part] = NAN;
        cell->flag[part] = BR_FLAG_FAILED;
    }
}

static void measure(struct lockstep *l, size_t index, size_t buffer, size_t slot)
{
    struct br_cell *cell = &l->study->cell[index];
    struct runner *r = &l->cell[index];
    const size_t rung = index / l->study->k_count;
    double error[BR_PARTS] = {0};
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct channel *c = &l->channel[kind];
        if (!c->modelled)
            continue;
        runner_look(r, (enum br_field_kind)kind);
        const double distance = br_ladder_distance(
            c->ladder, rung, r->modes, c->projection[buffer] + slot * br_ladder_size(c->ladder));
        error[kind == BR_AXIAL ? BR_PART_AXIAL : BR_PART_BENDING] = distance;
        error[BR_PART_TOTAL] += distance;
    }
    if (!isfinite(error[BR_PART_TOTAL])) {
        br_fail(&r->error, BR_NOT_FINITE, "the error at t = %g s is %g", br_march_time(r->march),
                error[BR_PART_TOTAL]);
        cell_failed(cell, &r->error);
        return;
    }
    for (int part = 0; part < BR_PARTS; part++)
        if (error[part] > cell->error[part]) {
            cell->error[part] = error[part];
            cell->worst_time[part] = br_march_time(r->march);
        }
}

static void cell_batch(struct lockstep *l, size_t b, size_t index)
{
    struct runner *r = &l->cell[index];
    struct br_cell *cell = &l->study->cell[index];
    const size_t ratio = l->study->reference.steps / cell->at.steps;
    for (size_t i = b * l->batch; i < batch_end(l, b) && !r->error.status; i++) {
        if (l->level[i] % ratio != 0)
            continue;
        if (atomic_load(&l->stopped))
            return;
        if (runner_advance(r, l->level[i] / ratio))
            cell_failed(cell, &r->error);
        else
            measure(l, index, b % BUFFERS, i % l->batch);
    }
    cell->seconds = r->seconds;
}

/* ---- setting up ---- */

/* Every reference step that is a time level of some cell, 0 included. */
static enum br_status list_levels(struct lockstep *l, struct br_error *err)
{
    const struct br_study *s = l->study;
    size_t most = 1;
    for (size_t j = 0; j < s->k_count; j++)
        most += s->steps[j];
    l->level = br_allocate(most, sizeof *l->level);
    if (!l->level)
        return br_no_memory(err, "the time levels");
    l->level_count = 1; /* t = 0 */
    for (size_t last = 0; last < s->reference.steps;) {
        size_t next = s->reference.steps;
        for (size_t j = 0; j < s->k_count; j++) {
            const size_t ratio = s->reference.steps / s->steps[j];
            const size_t candidate = (last / ratio + 1) * ratio;
            next = candidate < next ? candidate : next;
        }
        l->level[l->level_count++] = last = next;
    }
    return BR_OK;
}

/* The meshes that the reference is looked at on: its own where it has one; else
 * those of the cells that are no divisor of another's. */
static enum br_status list_roots(struct lockstep *l, struct br_error *err)
{
    const struct br_study *s = l->study;
    l->root = br_allocate(s->n_count, sizeof *l->root);
    if (!l->root)
        return br_no_memory(err, "the meshes");
    if (s->judge->nests) {
        l->root[l->roots++] = s->reference.n;
        return BR_OK;
    }
    for (size_t i = 0; i < s->n_count; i++) {
        bool divides = false;
        for (size_t j = 0; j < s->n_count; j++)
            divides |= s->n[j] % s->n[i] == 0 && (s->n[j] > s->n[i] || j < i);
        if (!divides)
            l->root[l->roots++] = s->n[i];
    }
    return BR_OK;
}

static enum br_status create_roots(struct lockstep *l, enum br_field_kind kind,
                                   struct br_error *err)
{
    struct channel *c = &l->channel[kind];
    c->root = br_allocate(l->roots, sizeof *c->root);
    if (!c->root)
        return br_no_memory(err, "the reference's values");
    for (size_t i = 0; i < l->roots; i++) {
        c->root[i].modes = br_allocate(l->root[i] * br_mode_count(kind), sizeof(double));
        if (!c->root[i].modes)
            return br_no_memory(err, "the reference's values");
    }
    c->audit = br_allocate(l->root[0] * br_mode_count(kind), sizeof(double));
    return c->audit ? BR_OK : br_no_memory(err, "the reference's values");
}

static enum br_status create_ladders(struct lockstep *l, struct br_error *err)
{
    const struct br_study *s = l->study;
    const struct br_mesh_list roots = {l->roots, l->root}, rungs = {s->n_count, s->n};
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        struct channel *c = &l->channel[kind];
        c->modelled = kind == BR_AXIAL ? s->scene->axial.modelled : s->scene->bending.modelled;
        if (!c->modelled)
            continue;
        enum br_status status =
            br_ladder_create(&c->ladder, (enum br_field_kind)kind, &roots, &rungs, err);
        if (!status)
            status = create_roots(l, (enum br_field_kind)kind, err);
        if (status)
            return status;
    }
    return BR_OK;
}

static enum br_status create_buffers(struct lockstep *l, struct br_error *err)
{
    size_t doubles = 0;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        doubles += l->channel[kind].modelled ? br_ladder_size(l->channel[kind].ladder) : 0;
    l->batch = buffer_bytes / (doubles * sizeof(double));
    l->batch = l->batch < 1 ? 1 : l->batch > most_levels ? most_levels : l->batch;
    l->batches = (l->level_count + l->batch - 1) / l->batch;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        for (int b = 0; b < BUFFERS && l->channel[kind].modelled; b++) {
            struct channel *c = &l->channel[kind];
            c->projection[b] = br_allocate(l->batch * br_ladder_size(c->ladder), sizeof(double));
            if (!c->projection[b])
                return br_no_memory(err, "the reference's projections");
        }
    return BR_OK;
}

/* An auditor that cannot promise a solution of this scene is done without. */
static void dismiss_auditor(struct lockstep *l)
{
    l->auditor.judge->free(l->auditor.self);
    l->auditor = (struct bench){0};
    l->study->auditor = NULL;
    for (int part = 0; part < BR_PARTS; part++)
        l->study->reference_error[part] = NAN;
}

/* The reference, and who audits it. */
static enum br_status create_judges(struct lockstep *l, struct br_error *err)
{
    struct br_study *s = l->study;
    const struct br_judge_request request = {
        .scene = s->scene,
        .method = s->reference_method,
        .n = s->reference.n,
        .levels = s->reference.steps,
        .mesh_count = l->roots,
        .mesh = l->root,
    };
    l->reference.judge = s->judge;
    const enum br_status status = s->judge->create(&l->reference.self, &request, err);
    if (status || !s->auditor)
        return status;
    l->auditor.judge = s->auditor;
    l->audit_every = l->level_count / most_audits + 1;
    if (!s->auditor->create(&l->auditor.self, &request, &l->auditor.error))
        return BR_OK;
    if (l->auditor.error.status == BR_NO_MEMORY) {
        *err = l->auditor.error;
        return BR_NO_MEMORY;
    }
    dismiss_auditor(l);
    return BR_OK;
}

static enum br_status create_cells(struct lockstep *l, struct br_error *err)
{
    const struct br_study *s = l->study;
    const size_t cells = s->n_count * s->k_count;
    l->cell = br_allocate(cells, sizeof *l->cell);
    if (!l->cell)
        return br_no_memory(err, "the cells");
    for (size_t i = 0; i < cells; i++) {
        runner_start(&l->cell[i], s->scene, s->cell[i].at, &s->method);
        const enum br_status failure = l->cell[i].error.status;
        if (failure == BR_BAD_INPUT || failure == BR_NO_MEMORY) {
            *err = l->cell[i].error;
            return failure;
        }
        if (failure)
            cell_failed(&s->cell[i], &l->cell[i].error);
    }
    return BR_OK;
}

static enum br_status lockstep_create(struct lockstep *l, struct br_study *s,
                                      const struct br_observer *observer, struct br_error *err)
{
    l->study = s;
    l->observer = observer;
    enum br_status status = list_levels(l, err);
    if (!status)
        status = list_roots(l, err);
    if (!status)
        status = create_ladders(l, err);
    if (!status)
        status = create_buffers(l, err);
    if (!status)
        status = create_judges(l, err);
    if (!status)
        status = create_cells(l, err);
    return status;
}

static void channel_clear(struct channel *c, size_t roots)
{
    br_ladder_free(c->ladder);
    for (size_t i = 0; c->root && i < roots; i++)
        free(c->root[i].modes);
    free(c->root);
    free(c->audit);
    for (int b = 0; b < BUFFERS; b++)
        free(c->projection[b]);
}

static void lockstep_clear(struct lockstep *l)
{
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        channel_clear(&l->channel[kind], l->roots);
    if (l->reference.judge)
        l->reference.judge->free(l->reference.self);
    if (l->auditor.judge)
        l->auditor.judge->free(l->auditor.self);
    for (size_t i = 0; l->cell && i < l->study->n_count * l->study->k_count; i++)
        runner_clear(&l->cell[i]);
    free(l->cell);
    free(l->root);
    free(l->level);
}

/* ---- running ---- */

/* All the studies of a call, and how far they are. */
struct crew {
    struct lockstep *step;
    size_t count;
    atomic_size_t finished_batches;
    size_t all_batches;
    const struct br_observer *observer;
};

static void tell(struct crew *crew, struct lockstep *l)
{
    if (atomic_load(&l->stopped))
        return;
    const size_t done = atomic_fetch_add(&crew->finished_batches, 1) + 1;
    if (crew->observer && crew->observer->progress)
        crew->observer->progress(crew->observer->self, (double)done / (double)crew->all_batches);
}

/* The tasks of batch b: the reference fills a buffer, then the cells read it. */
static void spawn_batch(struct crew *crew, struct lockstep *l, size_t b)
{
    (void)crew; /* without OpenMP */
    struct bench *reference = &l->reference;
    char *buffer = &l->token[b % BUFFERS];
    (void)reference, (void)buffer;
#pragma omp task depend(inout : reference[0]) depend(inout : buffer[0])
    {
        reference_batch(l, b);
        tell(crew, l);
    }
    for (size_t i = 0; i < l->study->n_count * l->study->k_count; i++) {
        struct runner *cell = &l->cell[i];
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
static enum br_status keep_events(struct lockstep *l, struct br_error *err)
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
        struct lockstep *l = &crew->step[s];
        l->study->judged_by = l->reference.judge->report(l->reference.self);
        if (l->reference.error.status) {
            *err = l->reference.error;
            return err->status;
        }
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
        status = lockstep_create(&crew.step[s], &studies[s], observer, err);
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
            lockstep_clear(&crew.step[s]);
    free(crew.step);
    return status;
}
