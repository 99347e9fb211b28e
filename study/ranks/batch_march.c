/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A batch at work, and its results as bytes. */
#include <stdint.h>
#include <string.h>

#include "study/grid/sweep.h"
#include "study/ranks/batches.h"

/* of: the batch of each of the study's cells. */
static bool takes_part(const struct br_study *s, const size_t *of, size_t batch)
{
    bool takes = false;
    for (size_t i = 0; i < br_study_cells(s); i++)
        takes |= of[i] == batch;
    return takes;
}

/* The cells of other batches take one step only. So the reference is sampled on the same meshes and
 * at the same time levels, and every bit is that of the whole study. */
static void set_cells(struct br_study *s, const size_t *of, size_t batch)
{
    for (; s; s = s->next_norm)
        for (size_t i = 0; i < br_study_cells(s); i++) {
            const struct br_resolution against = s->cell[i].against;
            s->cell[i] = (struct br_cell){.at = br_study_resolution(s, i), .against = against};
            if (of[i] != batch)
                s->cell[i].at.steps = 1;
        }
}

/* ---- results: the batch's number, then what each of its studies has come to ---- */

/* Writes bytes, or reads them. */
struct transfer {
    FILE *file;
    bool reads;
    enum br_status failure; /* nothing passes any more */
};

static void pass(struct transfer *t, void *bytes, size_t size)
{
    if (t->failure || size == 0)
        return;
    if (!t->reads && fwrite(bytes, size, 1, t->file) != 1)
        t->failure = BR_NO_MEMORY;
    if (t->reads && fread(bytes, size, 1, t->file) != 1)
        t->failure = BR_IO;
}

static void pass_events(struct transfer *t, struct br_study *s)
{
    size_t size = s->events && !t->reads ? strlen(s->events) + 1 : 0;
    pass(t, &size, sizeof size);
    if (t->reads) {
        free(s->events);
        s->events = size && !t->failure ? br_allocate(size, 1) : NULL;
        if (size && !t->failure && !s->events)
            t->failure = BR_NO_MEMORY;
    }
    pass(t, s->events, size);
}

/* All batches of a study report the same of it, but for times; a failure is kept. */
static void pass_study(struct transfer *t, struct br_study *s, const size_t *of, size_t batch)
{
    bool audited = s->auditor != NULL;
    const struct br_error before = s->failure;
    pass(t, &audited, sizeof audited);
    pass(t, &s->judged_by, sizeof s->judged_by);
    pass(t, &s->reference_scale, sizeof s->reference_scale);
    pass(t, s->reference_size, sizeof s->reference_size);
    pass(t, s->reference_error, sizeof s->reference_error);
    pass(t, s->reference_tip, sizeof s->reference_tip);
    pass(t, &s->failure, sizeof s->failure);
    pass_events(t, s);
    for (size_t i = 0; i < br_study_cells(s); i++)
        if (of[i] == batch)
            pass(t, &s->cell[i], sizeof s->cell[i]);
    if (!audited)
        s->auditor = NULL;
    if (before.status)
        s->failure = before;
}

/* ---- at work ---- */

enum br_status br_batch_march(struct br_study *studies, size_t count, const struct br_batches *b,
                              size_t batch, int threads, const struct br_observer *observer,
                              FILE *results, struct br_error *err)
{
    struct transfer t = {.file = results};
    struct br_study *copy = br_allocate(count, sizeof *copy);
    size_t copies = 0, written = 0;
    const size_t *of = b->of;
    if (!copy)
        return br_no_memory(err, "a batch of studies");
    for (size_t s = 0; s < count; of += br_study_cells(&studies[s++]))
        if (takes_part(&studies[s], of, batch)) {
            set_cells(&studies[s], of, batch);
            copy[copies++] = studies[s];
        }
    enum br_status status = br_lockstep(copy, copies, threads, observer, err);
    pass(&t, &batch, sizeof batch);
    of = b->of;
    for (size_t s = 0; s < count; of += br_study_cells(&studies[s++])) {
        const bool takes = takes_part(&studies[s], of, batch);
        for (struct br_study *norm = takes ? &copy[written++] : NULL; norm;
             norm = norm->next_norm) {
            pass_study(&t, norm, of, batch);
            free(norm->events);
            norm->events = NULL;
        }
    }
    free(copy);
    return !status && t.failure ? br_no_memory(err, "the results") : status;
}

static void read_batch(struct transfer *t, struct br_study *studies, size_t count,
                       const struct br_batches *b)
{
    size_t batch = SIZE_MAX;
    const size_t *of = b->of;
    pass(t, &batch, sizeof batch);
    for (size_t s = 0; s < count; of += br_study_cells(&studies[s++]))
        for (struct br_study *norm = &studies[s]; norm; norm = norm->next_norm)
            if (takes_part(&studies[s], of, batch))
                pass_study(t, norm, of, batch);
}

enum br_status br_batches_read(struct br_study *studies, size_t count, const struct br_batches *b,
                               char *bytes, size_t size, struct br_error *err)
{
    struct transfer t = {.file = fmemopen(bytes, size, "r"), .reads = true};
    if (!t.file)
        return br_no_memory(err, "the results");
    for (size_t i = 0; i < b->count && !t.failure; i++)
        read_batch(&t, studies, count, b);
    if (!t.failure && fgetc(t.file) != EOF)
        t.failure = BR_IO;
    fclose(t.file);
    if (t.failure)
        return br_fail(err, t.failure, "the results of the ranks: %s",
                       t.failure == BR_IO ? "cut off, or too long" : "out of memory");
    for (size_t s = 0; s < count; s++) /* a study that failed has failed in all its norms */
        for (struct br_study *norm = studies[s].next_norm; norm; norm = norm->next_norm)
            norm->failure = studies[s].failure;
    return BR_OK;
}
