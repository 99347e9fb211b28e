/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Studies whose cells are kept. What is missing is cut into slices, each of which marches some of
 * the cells and the whole reference; the results of each are kept before the next one begins. */
#include <float.h>
#include <math.h>
#include <stdint.h>

#include "study/kept/kept_study.h"
#include "reference/exact/exact.h"
#include "study/grid/batches.h"

enum { MOST_EVENTS = 1 << 20 }; /* bytes of the lines that a reference prints */

static struct br_kept *kept_of(const struct br_study *study)
{
    return study->engine.self;
}

/* ---- the entries: of a cell, and (SIZE_MAX) of a study itself ---- */

static char *text_of(const struct br_study *s, size_t cell)
{
    struct br_statement text;
    br_kept_begin(kept_of(s), cell == SIZE_MAX ? "study" : "cell", &text);
    br_state_study(&text, s, cell);
    return br_statement_end(&text);
}

static void pass_size(struct br_record *r, double *x)
{
    br_record_or_nan(r, x, 0, DBL_MAX);
}

/* A cell that went well; its resolution is the one that was asked for. */
static void pass_cell(struct br_record *r, void *self)
{
    struct br_cell *c = self;
    br_record_count(r, &c->at.n, c->at.n, c->at.n);
    br_record_count(r, &c->at.steps, c->at.steps, c->at.steps);
    br_record_number(r, &c->error[BR_PART_TOTAL], 0, DBL_MAX);
    for (enum br_part part = 0; part < BR_PARTS; part++) {
        pass_size(r, &c->error[part]);
        pass_size(r, &c->worst_time[part]);
    }
    for (int field = 0; field < 2; field++)
        br_record_number(r, &c->tip[field], -DBL_MAX, DBL_MAX);
    br_record_number(r, &c->seconds, 0, DBL_MAX);
    br_record_flag(r, &c->unstable);
}

/* A study's results on its reference; they depend on all cells' meshes and time levels. */
struct reference {
    struct br_study *study;
    size_t cells;
    bool audited;
};

static void pass_judge(struct br_record *r, struct br_judge_report *j)
{
    const size_t phases = sizeof((const char[]){
#define X(name, text) 0,
        BR_PHASE_LIST(X)
#undef X
    });
    size_t phase = (size_t)j->shortest.phase;
    for (int field = 0; field < 2; field++)
        for (int m = 0; m < BR_MEASURES; m++)
            pass_size(r, &j->own_error[field][m]);
    pass_size(r, &j->round_off);
    pass_size(r, &j->seconds);
    br_record_flag(r, &j->unstable);
    pass_size(r, &j->shortest.from);
    pass_size(r, &j->shortest.length);
    br_record_count(r, &phase, 0, phases - 1);
    j->shortest.phase = (int)phase;
}

static void pass_reference(struct br_record *r, void *self)
{
    struct reference *of = self;
    struct br_study *s = of->study;
    br_record_count(r, &of->cells, of->cells, of->cells);
    br_record_flag(r, &of->audited);
    pass_judge(r, &s->judged_by);
    pass_size(r, &s->reference_scale);
    for (int field = 0; field < 2; field++) {
        pass_size(r, &s->reference_size[field]);
        br_record_or_nan(r, &s->reference_tip[field], -DBL_MAX, DBL_MAX);
    }
    for (enum br_part part = 0; part < BR_PARTS; part++)
        pass_size(r, &s->reference_error[part]);
    br_record_text(r, &s->events, MOST_EVENTS);
}

/* Takes an entry into *s (in/out) only if all of it is right. */
static bool read_entry(struct br_study *s, size_t cell)
{
    char *text = text_of(s, cell);
    struct br_study found = *s;
    struct br_cell one = {.at = br_study_resolution(s, cell == SIZE_MAX ? 0 : cell)};
    struct reference all = {&found, br_study_cells(s), false};
    found.events = NULL;
    const bool taken = cell == SIZE_MAX ? br_kept_take(kept_of(s), text, pass_reference, &all)
                                        : br_kept_take(kept_of(s), text, pass_cell, &one);
    free(text);
    if (taken && cell == SIZE_MAX) {
        free(s->events);
        *s = found;
        s->auditor = all.audited ? s->auditor : NULL;
    } else if (taken) {
        one.against = s->cell[cell].against;
        s->cell[cell] = one;
    } else
        free(found.events);
    return taken;
}

/* Whether all norms of a cell, or (SIZE_MAX) of a study itself, are kept. */
static bool is_kept(struct br_study *s, size_t cell)
{
    bool kept = true;
    for (; s && kept; s = s->next_norm)
        kept = read_entry(s, cell);
    return kept;
}

/* auditor: as it was requested; it may have failed. */
static void write_entry(struct br_study *s, size_t cell, const struct br_judge *auditor)
{
    struct reference all = {s, br_study_cells(s), s->auditor != NULL};
    struct br_study asked = *s;
    asked.auditor = auditor;
    char *text = text_of(&asked, cell);
    if (cell == SIZE_MAX)
        br_kept_put(kept_of(s), text, pass_reference, &all);
    else
        br_kept_put(kept_of(s), text, pass_cell, &s->cell[cell]);
    free(text);
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
    const double least = fmax(1e9 * kept_of(s)->slice, reference / kept_of(s)->most_reference);
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
            atomic_fetch_add(&kept_of(study)->taken, of[c] == 0 || study->failure.status ? 0 : 1);
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
                    write_entry(norm, c, NULL);
}

static enum br_status march(struct work *w, int threads, struct br_error *err)
{
    const struct br_observer of_share = br_observer_of(&w->share);
    enum br_status status = BR_OK;
    if (!(w->results = br_text_open(&w->bytes, &w->size)))
        return br_no_memory(err, "what is kept");
    w->share.length = 1 / (double)w->slices.count;
    for (size_t i = 0; i < w->slices.count && !status; i++) {
        w->share.from = (double)i * w->share.length;
        status = br_batch_march(w->studies, w->count, &w->slices, i, threads, &of_share, w->results,
                                err);
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
                status = br_fail(err, BR_IO, "%s: an entry was removed in the meantime",
                                 kept_of(first)->folder);
        }
        for (struct br_study *norm = first; norm && marched && !status; norm = norm->next_norm)
            if (!norm->failure.status)
                write_entry(norm, SIZE_MAX, w->auditor[s]);
    }
    return status;
}

static enum br_status march_missing(struct br_study *studies, size_t count, int threads,
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

struct br_engine br_kept_engine(struct br_kept *kept)
{
    return kept ? (struct br_engine){march_missing, kept} : (struct br_engine){NULL, NULL};
}
