/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Studies whose cells are kept. What is missing is cut into slices, each of which marches some of
 * the cells and the whole reference; the results of each are kept before the next one begins. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "study/kept/kept.h"
#include "study/ranks/batches.h"

enum { WORK = 2400 };

/* What is kept of a study besides its cells, which went well; the lines of its events follow. */
struct kept_study {
    uint64_t audited;
    struct br_judge_report judged_by;
    double scale, size[2], error[BR_PARTS], tip[2];
};

/* ---- what the work is ---- */

/* Describes the norm, the judge and its method. */
static size_t describe(const struct br_study *s, const char *what, char work[WORK])
{
    char method[BR_KEPT_METHOD];
    const struct br_resolution fine = s->judge->nests ? s->reference : (struct br_resolution){0};
    return (size_t)snprintf(work, WORK, "%s, norm %s, degree %d, judge %s %zu %zu %s", what,
                            s->norm->name, s->method.axial_degree, s->judge->name, fine.n,
                            fine.steps,
                            s->judge->nests ? br_kept_method(&s->reference_method, method) : "");
}

static void key_of_cell(const struct br_study *s, size_t cell, char key[BR_SHA256_TEXT])
{
    char work[WORK], method[BR_KEPT_METHOD];
    const struct br_resolution at = br_study_resolution(s, cell);
    const size_t used = describe(s, "cell", work);
    snprintf(work + used, WORK - used, ", n %zu, steps %zu, %s", at.n, at.steps,
             br_kept_method(br_study_method(s, cell), method));
    br_kept_key(&s->kept->base, work, key);
}

/* A study's results on its reference depend on all cells' meshes and time levels. */
static void key_of_study(const struct br_study *s, char key[BR_SHA256_TEXT])
{
    struct br_sha256 grid = s->kept->base;
    char work[WORK];
    for (size_t c = 0; c < br_study_cells(s); c++) {
        key_of_cell(s, c, key);
        br_kept_add(&grid, key);
    }
    describe(s, s->auditor ? s->auditor->name : "study", work);
    br_kept_key(&grid, work, key);
}

/* ---- reading ---- */

static bool read_cell(struct br_study *s, size_t cell)
{
    char key[BR_SHA256_TEXT];
    struct br_cell k, *c = &s->cell[cell];
    key_of_cell(s, cell, key);
    if (!br_kept_read_into(s->kept, key, &k, sizeof k))
        return false;
    k.against = c->against;
    *c = k;
    return true;
}

static bool read_study(struct br_study *s)
{
    char key[BR_SHA256_TEXT];
    struct kept_study k;
    void *bytes;
    size_t size;
    key_of_study(s, key);
    if (!br_kept_read(s->kept, key, &bytes, &size))
        return false;
    const bool whole = size >= sizeof k;
    if (whole) {
        memcpy(&k, bytes, sizeof k);
        s->judged_by = k.judged_by;
        s->reference_scale = k.scale;
        memcpy(s->reference_size, k.size, sizeof k.size);
        memcpy(s->reference_error, k.error, sizeof k.error);
        memcpy(s->reference_tip, k.tip, sizeof k.tip);
        s->events = strndup((const char *)bytes + sizeof k, size - sizeof k);
        s->auditor = k.audited ? s->auditor : NULL;
    }
    free(bytes);
    return whole && s->events;
}

/* Whether all norms of a cell, or (SIZE_MAX) of a study itself, are kept. */
static bool is_kept(struct br_study *s, size_t cell)
{
    bool kept = true;
    for (; s && kept; s = s->next_norm)
        kept = cell == SIZE_MAX ? read_study(s) : read_cell(s, cell);
    return kept;
}

/* ---- writing ---- */

static void write_cell(const struct br_study *s, size_t cell)
{
    char key[BR_SHA256_TEXT];
    key_of_cell(s, cell, key);
    br_kept_write(s->kept, key, &s->cell[cell], sizeof s->cell[cell]);
}

/* auditor: as requested, since the key must not depend on its success. */
static enum br_status write_study(struct br_study *s, const struct br_judge *auditor,
                                  struct br_error *err)
{
    char key[BR_SHA256_TEXT];
    struct br_study asked = *s;
    struct kept_study k = {.audited = s->auditor != NULL, .scale = s->reference_scale};
    k.judged_by = s->judged_by;
    memcpy(k.size, s->reference_size, sizeof k.size);
    memcpy(k.error, s->reference_error, sizeof k.error);
    memcpy(k.tip, s->reference_tip, sizeof k.tip);
    asked.auditor = auditor;
    key_of_study(&asked, key);
    const char *events = s->events ? s->events : "";
    char *bytes = br_allocate(sizeof k + strlen(events) + 1, 1);
    if (!bytes)
        return br_no_memory(err, "what is kept");
    memcpy(bytes, &k, sizeof k);
    strcpy(bytes + sizeof k, events);
    br_kept_write(s->kept, key, bytes, sizeof k + strlen(events));
    free(bytes);
    return BR_OK;
}

/* ---- slices ---- */

struct work {
    struct br_study *studies;
    size_t count;
    const struct br_judge **auditor; /* of each study, as asked for; owned */
    struct br_batches slices;        /* SIZE_MAX: of a cell that is kept */
    FILE *results;                   /* of all slices, into bytes */
    char *bytes;
    size_t size;
    struct br_observer_share share; /* of the slice at work */
};

/* Cuts the missing cells of a study (of: SIZE_MAX or 0; in/out) into slices. */
static size_t cut(const struct br_study *s, size_t *of)
{
    const double reference = br_reference_cost(s);
    double cells = 0, done = 0;
    size_t missing = 0;
    for (size_t c = 0; c < br_study_cells(s); c++)
        if (of[c] != SIZE_MAX) {
            cells += br_cell_cost(s, c);
            missing++;
        }
    const double least = fmax(1e9 * s->kept->slice, reference / s->kept->most_reference);
    const double slices = fmax(1, fmin(floor(cells / least), (double)missing));
    for (size_t c = 0; c < br_study_cells(s); c++)
        if (of[c] != SIZE_MAX) {
            of[c] = (size_t)fmin(floor(slices * done / cells), slices - 1);
            done += br_cell_cost(s, c);
        }
    return missing ? (size_t)slices : 0;
}

/* A study that is not whole in the folder marches its reference, at least beside one cell. */
static enum br_status find_missing(struct work *w, struct br_error *err)
{
    size_t cells = 0;
    for (size_t s = 0; s < w->count; s++)
        cells += br_study_cells(&w->studies[s]);
    w->slices.of = br_allocate(cells, sizeof *w->slices.of);
    w->auditor = br_allocate(w->count, sizeof(struct br_judge *));
    if (!w->slices.of || !w->auditor)
        return br_no_memory(err, "what is kept");
    size_t *of = w->slices.of;
    for (size_t s = 0; s < w->count; of += br_study_cells(&w->studies[s++])) {
        struct br_study *study = &w->studies[s];
        bool missing = false;
        w->auditor[s] = study->auditor;
        for (size_t c = 0; c < br_study_cells(study); c++) {
            of[c] = study->failure.status || is_kept(study, c) ? SIZE_MAX : 0;
            missing |= of[c] == 0;
            atomic_fetch_add(&study->kept->taken, of[c] == 0 || study->failure.status ? 0 : 1);
        }
        if (!missing && !study->failure.status && !is_kept(study, SIZE_MAX))
            of[0] = 0;
        const size_t slices = study->failure.status ? 0 : cut(study, of);
        w->slices.count = slices > w->slices.count ? slices : w->slices.count;
    }
    return BR_OK;
}

/* The cells of a slice that went well, in all norms. */
static void keep_cells(const struct work *w, size_t slice)
{
    const size_t *of = w->slices.of;
    for (size_t s = 0; s < w->count; of += br_study_cells(&w->studies[s++]))
        for (struct br_study *norm = &w->studies[s]; norm; norm = norm->next_norm)
            for (size_t c = 0; c < br_study_cells(norm); c++)
                if (of[c] == slice && !norm->cell[c].failure.status &&
                    isfinite(norm->cell[c].error[BR_PART_TOTAL]))
                    write_cell(norm, c);
}

static enum br_status march(struct work *w, int threads, struct br_error *err)
{
    struct br_observer of_share;
    if (w->share.whole)
        of_share = br_observer_of(&w->share);
    enum br_status status = BR_OK;
    if (!(w->results = open_memstream(&w->bytes, &w->size)))
        return br_no_memory(err, "what is kept");
    w->share.length = 1 / (double)w->slices.count;
    for (size_t i = 0; i < w->slices.count && !status; i++) {
        w->share.from = (double)i * w->share.length;
        status = br_batch_march(w->studies, w->count, &w->slices, i, threads,
                                w->share.whole ? &of_share : NULL, w->results, err);
        if (!status)
            keep_cells(w, i);
    }
    const bool lost = fclose(w->results) != 0;
    return lost && !status ? br_no_memory(err, "what is kept") : status;
}

/* From the slices' results and the folder, whole studies. */
static enum br_status put_together(struct work *w, struct br_error *err)
{
    enum br_status status =
        w->slices.count ? br_batches_read(w->studies, w->count, &w->slices, w->bytes, w->size, err)
                        : BR_OK;
    const size_t *of = w->slices.of;
    for (size_t s = 0; s < w->count && !status; of += br_study_cells(&w->studies[s++])) {
        struct br_study *first = &w->studies[s];
        bool marched = false;
        for (size_t c = 0; c < br_study_cells(first) && !first->failure.status; c++) {
            marched |= of[c] != SIZE_MAX;
            if (of[c] == SIZE_MAX && !is_kept(first, c))
                status =
                    br_fail(err, BR_IO, "%s: an entry has gone meanwhile", first->kept->folder);
        }
        for (struct br_study *norm = first; norm && marched && !status; norm = norm->next_norm)
            if (!norm->failure.status)
                status = write_study(norm, w->auditor[s], err);
    }
    return status;
}

enum br_status br_kept_lockstep(struct br_study *studies, size_t count, int threads,
                                const struct br_observer *observer, struct br_error *err)
{
    struct work w = {.studies = studies, .count = count, .share.whole = observer};
    enum br_status status = find_missing(&w, err);
    if (!status && w.slices.count)
        status = march(&w, threads, err);
    if (!status)
        status = put_together(&w, err);
    free(w.bytes);
    free(w.auditor);
    br_batches_clear(&w.slices);
    return status;
}
