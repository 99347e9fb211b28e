/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/study_run.h"

#include <stdio.h>
#include <stdlib.h>

#include "cli/documents.h"
#include "cli/picture_files.h"
#include "cli/provenance.h"
#include "cli/study_session.h"
#include "cli/warn_marches.h"
#include "plots/pictures.h"
#include "study/foresee/resources.h"
#include "study/ranks/ranks.h"
#include "tables/reports.h"

/* A run on its way to its files. */
struct run {
    const struct br_options *options;
    struct br_session session;
    struct br_document *document; /* session.pages; owned */
    struct br_output output;
    struct br_picture_files pictures;
};

/* Names the pictures, which stand beside the report. */
static void put_pictures(struct br_document *d, const struct br_report *report)
{
    char stem[600];
    for (const struct br_convergence_picture *const *p = br_convergence_pictures; *p; p++)
        if ((*p)->applies(report)) {
            snprintf(stem, sizeof stem, "%s-%s", report->name, (*p)->name);
            br_put_picture(d, stem, (*p)->title);
        }
}

static enum br_status build_reports(struct run *r, struct br_error *err)
{
    struct br_provenance provenance;
    br_provenance_fill(&provenance, r->session.request.threads);
    r->document = br_allocate(r->session.pages, sizeof *r->document);
    if (!r->document)
        return br_no_memory(err, "the reports");
    for (size_t i = 0; i < r->session.pages; i++) {
        const struct br_work *w = br_session_work(&r->session, i);
        provenance.scene_path = w->path;
        provenance.scene_text = w->text;
        br_report_study(&r->session.page[i].report, &r->document[i]);
        if (!br_option_given(r->options, BR_OPT_NO_PLOTS))
            put_pictures(&r->document[i], &r->session.page[i].report);
        br_put_provenance(&r->document[i], &provenance);
    }
    return BR_OK;
}

static enum br_status write_plots(struct run *r, size_t i, struct br_error *err)
{
    const struct br_report *report = &r->session.page[i].report;
    enum br_status status = BR_OK;
    for (const struct br_convergence_picture *const *p = br_convergence_pictures; *p && !status;
         p++) {
        struct br_figure figure;
        if (!(*p)->applies(report))
            continue;
        status = br_convergence_draw(*p, report, &figure, err);
        if (!status)
            status = br_picture_files_draw(&r->pictures, &figure, err);
        br_figure_clear(&figure);
    }
    return status;
}

/* The plots first: they are rendered while the tables are written. */
static enum br_status write_all(struct run *r, struct br_error *err)
{
    enum br_status status = BR_OK;
    r->pictures.output = &r->output;
    for (size_t i = 0;
         i < r->session.pages && !status && !br_option_given(r->options, BR_OPT_NO_PLOTS); i++)
        status = write_plots(r, i, err);
    if (!status)
        status = br_documents_write(&r->pictures, r->options, r->document, r->session.pages, err);
    const enum br_status drawn = br_picture_files_finish(&r->pictures, status ? NULL : err);
    if (!status)
        status = drawn;
    return status ? status : br_output_commit(&r->output, err);
}

/* A failed cell fails the run, after everything has been written. */
static enum br_status check_cells(const struct br_session *s, struct br_error *err)
{
    size_t failed = 0;
    const struct br_cell *first = NULL;
    for (size_t i = 0; i < s->heads; i++) {
        const struct br_study *study = br_session_study(s, i, 0);
        for (size_t c = 0; c < study->n_count * study->k_count; c++)
            if (study->cell[c].flag[BR_PART_TOTAL] == BR_FLAG_FAILED) {
                first = first ? first : &study->cell[c];
                failed++;
            }
    }
    if (!failed)
        return BR_OK;
    return br_fail(err, BR_NOT_FINITE, "%zu cells failed; the first is n = %zu: %s", failed,
                   first->at.n,
                   first->failure.status ? first->failure.message : "its error is not a number");
}

/* Of what marches at once: without a reference one job after the other. */
static enum br_status check_memory(const struct br_session *s, struct br_error *err)
{
    const double available = br_memory_available();
    if (s->request.judge != &br_judge_none)
        return br_fit_together(s->study, s->heads, available, err);
    enum br_status status = BR_OK;
    for (size_t i = 0; i < s->jobs && !status; i++)
        status = br_fit_together(br_session_study(s, i, 0), 1, available, err);
    return status;
}

enum br_status br_study_run_jobs(const struct br_study_job *jobs, size_t count,
                                 const struct br_options *options, bool with_exact,
                                 struct br_error *err)
{
    struct run r = {.options = options};
    const bool writes = br_ranks_first(), quiet = br_option_given(options, BR_OPT_QUIET);
    enum br_status status = br_session_prepare(&r.session, jobs, count, options, with_exact, err);
    if (!status && br_ranks_size() == 1)
        status = check_memory(&r.session, err);
    if (!status && writes)
        status = br_output_open(&r.output, br_option_text(options, BR_OPT_OUT), err);
    if (!status && writes)
        status = br_warn_of_studies(r.session.study, r.session.jobs, err);
    if (!status)
        status = br_session_compute(&r.session, quiet || !writes, err);
    if (!status && writes)
        status = build_reports(&r, err);
    if (!status && writes && !quiet)
        status = br_documents_show(r.document, r.session.pages, err);
    if (!status && writes)
        status = write_all(&r, err);
    if (!status && writes && !quiet)
        br_output_announce(&r.output);
    if (!status)
        status = check_cells(&r.session, err);
    for (size_t i = 0; r.document && i < r.session.pages; i++)
        br_document_clear(&r.document[i]);
    free(r.document);
    br_session_clear(&r.session);
    br_output_discard(&r.output);
    return status;
}
