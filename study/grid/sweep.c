/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/grid/sweep.h"

#include <math.h>
#include <stdio.h>

#include "base/each.h"
#include "base/text.h"
#include "study/grid/costs.h"
#include "study/grid/study_march.h"

/* ---- the set-up ---- */

/* The studies of a call. */
struct sweep_work {
    struct br_study *studies;
    struct br_study_march *step; /* of each study */
    size_t count;
    const struct br_observer *observer;
};

static void create(struct sweep_work *work, size_t s)
{
    struct br_study_march *l = &work->step[s];
    struct br_study *study = &work->studies[s];
    if (study->failure.status)
        l->study = study;
    else if (br_study_march_create(l, study, work->observer, &study->failure))
        l->batches = 0; /* nothing to march */
}

/* Sets up all studies of the scene of study `first`, unless a study before it has that scene; an
 * exact reference computes its solution here. Studies of one scene are set up one after the other,
 * since all of them use its functions (scene.h). */
static enum br_status create_of_scene(void *self, size_t first, struct br_error *err)
{
    struct sweep_work *work = self;
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

/* ---- the results ---- */

/* Writes the results of one cell in one norm. */
static void conclude_cell(const struct br_study_march *l, struct br_study *s, size_t index,
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
static void conclude_norms(struct br_study_march *l)
{
    size_t m = 0;
    for (struct br_study *s = l->study; s; s = s->next_norm, m++) {
        s->reference_check = l->study->reference_check;
        s->reference_report = l->reference.reference_kind->report(l->reference.self);
        s->reference_scale = br_norm_value(s->norm, &l->reference.sum[m], BR_PART_TOTAL);
        for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
            const enum br_part part = br_part_of(kind);
            s->reference_size[kind] = br_norm_value(s->norm, &l->reference.sum[m], part);
            s->reference_tip[kind] = l->study->reference_tip[kind];
        }
        for (enum br_part part = 0; part < BR_PARTS; part++)
            s->reference_error[part] =
                s->reference_check ? br_norm_value(s->norm, &l->reference_check.sum[m], part) : NAN;
        for (size_t i = 0; i < br_study_cells(s); i++)
            conclude_cell(l, s, i, &l->cell_sum[i * l->norms + m]);
    }
}

/* Keeps the reference's lines of events with the study. */
static enum br_status keep_events(struct br_study_march *l, struct br_study *study,
                                  struct br_error *err)
{
    size_t size;
    FILE *out = br_text_open(&study->events, &size);
    if (out)
        l->reference.reference_kind->print_notes(l->reference.self, out);
    return out && fclose(out) == 0 ? BR_OK : br_no_memory(err, "the events");
}

/* Whether a failure ends the whole call, not only one study. */
static bool is_fatal(const struct br_error *failure)
{
    return failure->status == BR_NO_MEMORY || failure->status == BR_INTERRUPTED;
}

static enum br_status conclude(struct br_study_march *l, struct br_error *err)
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
    if (l->study->failure.status)
        return BR_OK;
    conclude_norms(l);
    enum br_status status = BR_OK;
    for (struct br_study *study = l->study; study && !status; study = study->next_norm)
        status = keep_events(l, study, err);
    return status;
}

/* ---- studies ---- */

enum br_status br_march_studies(struct br_study *studies, size_t count, int threads,
                                const struct br_observer *observer, struct br_error *err)
{
    struct sweep_work work = {studies, NULL, count, observer};
    if (br_fit_together(studies, count, br_memory_available(), err))
        return err->status;
    work.step = br_allocate(count, sizeof *work.step);
    if (!work.step)
        return br_no_memory(err, "the studies");
    br_each(&(struct br_each){count, br_threads(threads), NULL, create_of_scene, NULL, &work},
            NULL);
    bool fatal = false;
    for (size_t s = 0; s < count; s++)
        fatal |= is_fatal(&studies[s].failure);
    if (!fatal)
        br_lanes_run(work.step, count, threads, observer);
    enum br_status status = BR_OK;
    for (size_t s = 0; s < count && !status; s++)
        status = conclude(&work.step[s], err);
    for (size_t s = 0; s < count; s++)
        br_study_march_clear(&work.step[s]);
    free(work.step);
    return status;
}

static br_engine *usual = br_march_studies;

void br_engine_set(br_engine *engine)
{
    usual = engine;
}

enum br_status br_study_run_each(struct br_study *studies, size_t count, int threads,
                                 const struct br_observer *observer, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < count; i++)
        for (struct br_study *s = &studies[i]; s; s = s->next_norm)
            s->cell = NULL, s->events = NULL, s->failure = (struct br_error){0};
    for (size_t i = 0; i < count && !status; i++)
        if (br_study_prepare(&studies[i], &studies[i].failure) == BR_NO_MEMORY)
            status = br_fail(err, BR_NO_MEMORY, "%s", studies[i].failure.message);
    br_engine *const march = count && studies->here ? br_march_studies : usual;
    if (!status)
        status = march(studies, count, threads, observer, err);
    for (size_t i = 0; i < count; i++)
        for (struct br_study *s = &studies[i]; s; s = s->next_norm) {
            s->failure = studies[i].failure;
            if (status)
                br_study_clear(s);
        }
    return status;
}

enum br_status br_study_run(struct br_study *studies, size_t count, int threads,
                            const struct br_observer *observer, struct br_error *err)
{
    enum br_status status = br_study_run_each(studies, count, threads, observer, err);
    for (size_t i = 0; i < count && !status; i++)
        if (studies[i].failure.status)
            status = br_fail(err, studies[i].failure.status, "%s", studies[i].failure.message);
    for (size_t i = 0; i < count && status; i++)
        for (struct br_study *s = &studies[i]; s; s = s->next_norm)
            br_study_clear(s);
    return status;
}
