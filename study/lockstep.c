/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference is marched a batch of time levels at a time and leaves their
 * projections (ladder.h) in one of two buffers; each cell then takes its own
 * steps through the batch and measures its errors, while the reference is
 * already filling the other buffer. These are OpenMP tasks whose dependences are
 * the buffers and the marches. Every march is one sequence of operations
 * whichever threads run it, so the result has the same bits on any number. */
#include "study/lockstep.h"

#include <stdio.h>
#ifdef _OPENMP
#include <omp.h>
#endif

#include "study/lockstep_state.h"

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
    struct br_error *error = &l->reference.error;
    for (size_t i = b * l->batch; i < batch_end(l, b) && !should_stop(l); i++) {
        const struct br_slot slot = {b % BR_LOCKSTEP_BUFFERS, i % l->batch};
        const bool audited =
            l->auditor.judge && (i % l->audit_every == 0 || i + 1 == l->level_count);
        enum br_status status = l->reference.judge->advance(l->reference.self, l->level[i], error);
        if (!status)
            br_lockstep_project(l, slot, l->level[i]);
        if (!status && audited)
            status = br_lockstep_audit(l, l->level[i], error);
        if (status)
            atomic_store(&l->stopped, true);
    }
}

static void cell_batch(struct br_lockstep *l, size_t b, size_t index)
{
    struct br_runner *r = &l->cell[index];
    const size_t ratio = l->study->reference.steps / l->study->cell[index].at.steps;
    for (size_t i = b * l->batch; i < batch_end(l, b) && !r->error.status; i++) {
        if (l->level[i] % ratio != 0)
            continue;
        if (atomic_load(&l->stopped))
            return;
        if (br_runner_advance(r, l->level[i] / ratio))
            br_cell_failed(l->study, index, &r->error);
        else
            br_lockstep_measure(l, index, (struct br_slot){b % BR_LOCKSTEP_BUFFERS, i % l->batch});
    }
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
    for (size_t i = 0; i < br_study_cells(l->study); i++) {
        struct br_runner *cell = &l->cell[i];
        (void)cell;
#pragma omp task depend(inout : cell[0]) depend(in : buffer[0])
        cell_batch(l, b, i);
    }
}

/* Batches of each study that wait to be run, at most: time and memory of the tasks that
 * are known at once grow faster than their number. */
enum { MOST_AHEAD = 64 };

static void spawn_all(struct crew *crew)
{
    size_t most = 0;
    for (size_t s = 0; s < crew->count; s++)
        most = crew->step[s].batches > most ? crew->step[s].batches : most;
    for (size_t b = 0; b < most; b++) {
        for (size_t s = 0; s < crew->count; s++)
            if (b < crew->step[s].batches && !atomic_load(&crew->step[s].stopped))
                spawn_batch(crew, &crew->step[s], b);
        if (b % MOST_AHEAD == MOST_AHEAD - 1) {
#pragma omp taskwait
        }
    }
}

/* What the reference tells, kept with the study. */
static enum br_status keep_events(struct br_lockstep *l, struct br_study *study,
                                  struct br_error *err)
{
    size_t size;
    FILE *out = open_memstream(&study->events, &size);
    if (!out)
        return br_no_memory(err, "the events");
    l->reference.judge->tell(l->reference.self, out);
    return fclose(out) == 0 ? BR_OK : br_no_memory(err, "the events");
}

/* What concerns the whole call, not one study. */
static bool is_fatal(const struct br_error *failure)
{
    return failure->status == BR_NO_MEMORY || failure->status == BR_INTERRUPTED;
}

/* Whether a study went well; if not, its failure is known to all its norms. */
static bool succeeded(struct br_study *first)
{
    for (struct br_study *s = first; s; s = s->next_norm)
        s->failure = first->failure;
    return !first->failure.status;
}

static enum br_status conclude(struct br_lockstep *l, struct br_error *err)
{
    if (l->reference.error.status)
        l->study->failure = l->reference.error;
    for (size_t i = 0; l->cell && i < br_study_cells(l->study); i++)
        if (l->cell[i].error.status == BR_NO_MEMORY)
            l->study->failure = l->cell[i].error;
    if (!l->study->failure.status && atomic_load(&l->stopped))
        br_fail(&l->study->failure, BR_INTERRUPTED, "interrupted");
    if (is_fatal(&l->study->failure))
        return br_fail(err, l->study->failure.status, "%s", l->study->failure.message);
    if (!succeeded(l->study))
        return BR_OK;
    br_lockstep_conclude(l);
    enum br_status status = BR_OK;
    for (struct br_study *study = l->study; study && !status; study = study->next_norm)
        status = keep_events(l, study, err);
    return status;
}

static void create(struct crew *crew, struct br_study *studies, size_t s)
{
    struct br_lockstep *l = &crew->step[s];
    if (studies[s].failure.status)
        l->study = &studies[s];
    else if (br_lockstep_create(l, &studies[s], crew->observer, &studies[s].failure))
        l->batches = 0; /* nothing to march */
}

/* Sets up all studies: an exact reference works its solution out there. Those of one scene
 * one after the other, since they all read its functions (scene.h). */
static void create_all(struct crew *crew, struct br_study *studies, int threads)
{
    (void)threads; /* without OpenMP */
#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (size_t first = 0; first < crew->count; first++) {
        bool is_first = true;
        for (size_t s = 0; s < first; s++)
            is_first &= studies[s].scene != studies[first].scene;
        for (size_t s = first; s < crew->count && is_first; s++)
            if (studies[s].scene == studies[first].scene)
                create(crew, studies, s);
    }
    for (size_t s = 0; s < crew->count; s++)
        crew->all_batches += crew->step[s].batches;
}

enum br_status br_lockstep(struct br_study *studies, size_t count, int threads,
                           const struct br_observer *observer, struct br_error *err)
{
    struct crew crew = {.count = count, .observer = observer};
    crew.step = br_allocate(count, sizeof *crew.step);
    if (!crew.step)
        return br_no_memory(err, "the studies");
#ifdef _OPENMP
    if (threads <= 0)
        threads = omp_get_num_procs();
#endif
    create_all(&crew, studies, threads);
    bool fatal = false;
    for (size_t s = 0; s < count; s++)
        fatal |= is_fatal(&studies[s].failure);
#pragma omp parallel num_threads(threads) if (!fatal)
#pragma omp single
    if (!fatal)
        spawn_all(&crew);
    enum br_status status = BR_OK;
    for (size_t s = 0; s < count && !status; s++)
        status = conclude(&crew.step[s], err);
    for (size_t s = 0; s < count; s++)
        br_lockstep_clear(&crew.step[s]);
    free(crew.step);
    return status;
}
