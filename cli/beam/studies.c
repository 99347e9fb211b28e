/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/beam/studies.h"

#include <stdio.h>

#include "base/clock.h"
#include "cli/progress.h"
#include "reference/printed.h"
#include "study/grid/sweep.h"
#include "study/scene/file.h"

/* Study h of the cases in norm m. */
static struct br_study *study_of(const struct br_studies *r, size_t h, size_t m)
{
    return &r->study[m * r->cases + h];
}

/* ---- the grid ---- */

static enum br_status make_grid(struct br_studies *r, size_t job, struct br_error *err)
{
    struct br_study_work *w = &r->work[job];
    const struct br_study_request *q = r->request;
    const struct br_scene *scene = &w->opened.scene;
    struct br_study *study = study_of(r, job, 0);
    *study = (struct br_study){
        .scene = scene,
        .norm = q->norm[0],
        .method = q->method,
        .reference_method = q->method,
        .reference_kind = q->reference_kind ? q->reference_kind : br_reference_best(scene),
        .n = q->n,
        .n_count = q->n_count,
    };
    if (br_steps_read(q->k, scene, &w->steps, &study->k_count, err))
        return err->status;
    if (q->n_count * study->k_count > BR_MOST_ROWS)
        return br_fail(err, BR_BAD_INPUT,
                       "found %zu meshes and %zu time steps, expected at most %d cells", q->n_count,
                       study->k_count, BR_MOST_ROWS);
    br_sort_counts(q->n, q->n_count);
    br_sort_counts(w->steps, study->k_count);
    study->steps = w->steps;
    if (!study->reference_kind->nests)
        return BR_OK;
    study->reference_check = br_reference_best(scene); /* it measures the fine run's own error */
    return br_study_request_fine(q, scene, &study->reference, err);
}

/* Copies the job's study in the first norm: the same cells against the exact solution, and both in
 * the other norms. */
static void spread_study(struct br_studies *r, size_t job)
{
    if (r->cases > r->jobs) {
        struct br_study *exact = study_of(r, r->jobs + job, 0);
        *exact = *study_of(r, job, 0);
        exact->reference_kind = &br_reference_exact;
        exact->reference_check = NULL;
        exact->reference = (struct br_resolution){0};
    }
    for (size_t h = job; h < r->cases; h += r->jobs)
        for (size_t m = 1; m < r->request->norms; m++) {
            struct br_study *study = study_of(r, h, m);
            *study = *study_of(r, h, m - 1);
            study->norm = r->request->norm[m];
            study_of(r, h, m - 1)->next_norm = study;
        }
}

/* ---- reports ---- */

static enum br_status set_printed(const struct br_printed *printed, struct br_report *report,
                                  struct br_error *err)
{
    const struct br_study *study = report->study;
    const size_t cells = study->n_count * study->k_count;
    report->printed = br_allocate(cells, sizeof(double));
    for (size_t c = 0; c < cells && report->printed; c++)
        report->printed[c] =
            br_printed_error(printed, study->n[c / study->k_count],
                             br_time_step(study->scene, study->steps[c % study->k_count]));
    return report->printed ? BR_OK : br_no_memory(err, "the printed values");
}

/* Starts a job's report in norm m. Name and caption end with the norm, unless that is the default.
 */
static enum br_status start_report(struct br_studies *r, const struct br_study_job *job, size_t i,
                                   size_t m, struct br_error *err)
{
    struct br_study_work *w = &r->work[i];
    const struct br_norm *norm = r->request->norm[m];
    const struct br_scene *scene = &w->opened.scene;
    const bool usual = norm == br_norms[0];
    snprintf(w->name[m], sizeof w->name[m], "%s%s%s", job->name ? job->name : scene->name,
             usual ? "" : "-", usual ? "" : norm->name);
    if (asprintf(&w->caption[m], "%s%s%s", job->caption ? job->caption : scene->title,
                 usual ? "" : ": ", usual ? "" : norm->symbol) < 0) {
        w->caption[m] = NULL;
        return br_no_memory(err, "the studies");
    }
    w->report[m] = (struct br_report){
        .name = w->name[m],
        .caption = w->caption[m],
        .study = study_of(r, i, m),
        .exact = r->cases > r->jobs ? study_of(r, r->jobs + i, m) : NULL,
        .fitted = study_of(r, r->cases - r->jobs + i, m),
    };
    return job->printed && norm->printed ? set_printed(job->printed, &w->report[m], err) : BR_OK;
}

/* ---- from the options to studies ---- */

static enum br_status prepare_job(struct br_studies *r, const struct br_study_job *job, size_t i,
                                  struct br_error *err)
{
    struct br_opened_scene *opened = &r->work[i].opened;
    if (br_opened_scene_read(opened, r->session, job->scene, err) || make_grid(r, i, err))
        return err->status;
    spread_study(r, i);
    for (size_t m = 0; m < r->request->norms; m++)
        if (start_report(r, job, i, m, err))
            return err->status;
    return BR_OK;
}

enum br_status br_studies_prepare(struct br_studies *r, const struct br_study_job *job,
                                  bool with_exact, struct br_error *err)
{
    const struct br_study_request *q = r->request;
    bool axial = false;
    r->cases = with_exact && q->reference_kind && q->reference_kind->nests ? 2 * r->jobs : r->jobs;
    r->work = br_allocate(r->jobs, sizeof *r->work);
    r->study = br_allocate(r->cases * q->norms, sizeof *r->study);
    if (!r->work || !r->study)
        return br_no_memory(err, "the studies");
    for (size_t i = 0; i < r->jobs; i++) {
        if (prepare_job(r, &job[i], i, err))
            return err->status;
        axial |= r->work[i].opened.scene.axial.modelled;
    }
    return axial || q->method.axial_degree == 1
               ? BR_OK
               : br_fail(err, BR_BAD_INPUT, "--axial-degree: no scene has an axial field");
}

void br_studies_clear(struct br_studies *r)
{
    for (size_t i = 0; r->study && i < r->cases * r->request->norms; i++)
        br_study_clear(&r->study[i]);
    for (size_t i = 0; r->work && i < r->jobs; i++) {
        for (size_t m = 0; m < r->request->norms; m++) {
            br_report_clear(&r->work[i].report[m]);
            free(r->work[i].caption[m]);
        }
        br_grid_differences_clear(&r->work[i].compared);
        br_opened_scene_clear(&r->work[i].opened);
        free(r->work[i].steps);
    }
    free(r->work);
    free(r->study);
}

/* ---- before the marches ---- */

void br_studies_estimate_cost(const struct br_studies *r, struct br_costs *work)
{
    for (size_t h = 0; h < r->cases; h++)
        br_costs_add_study(work, study_of(r, h, 0));
}

/* ---- the marches, and what follows from them ---- */

enum br_status br_studies_compute(struct br_studies *r, struct br_error *err)
{
    const double start = br_seconds();
    const int threads = r->session->threads;
    const size_t norms = r->request->norms;
    struct br_study_work *const end = r->work + r->jobs;
    const struct br_observer *observer = br_progress_start("marching", r->session->quiet);
    enum br_status status = br_study_run(r->study, r->cases, threads, observer, err);
    for (struct br_study_work *w = r->work; w < end && !status; w++) {
        w->compared = (struct br_grid_differences){
            .report = w->report, .norms = norms, .threads = threads, .observer = observer};
        status = br_grid_differences_meshes(&w->compared, err);
    }
    for (struct br_study_work *w = r->work; w < end; w++)
        for (size_t m = 0; m < norms && !status; m++)
            status = br_report_finish(&w->report[m], threads, err);
    for (struct br_study_work *w = r->work; w < end && !status; w++)
        for (enum br_axis axis = 0; axis < BR_AXES && !status; axis++)
            status = br_grid_differences_settle(&w->compared, axis, err);
    br_progress_end();
    for (struct br_study_work *w = r->work; w < end; w++)
        for (size_t m = 0; m < norms; m++)
            w->report[m].wall_seconds = br_seconds() - start;
    return br_progress_result(status, err);
}

enum br_status br_studies_check_cells(const struct br_studies *r, struct br_error *err)
{
    size_t failed = 0, cells = 0;
    const struct br_cell *first = NULL;
    for (size_t job = 0; job < r->jobs; job++)
        for (size_t h = job; h < r->cases; h += r->jobs) {
            const struct br_study *s = study_of(r, h, 0);
            for (size_t c = 0; c < br_study_cells(s); c++, cells++) {
                const bool bad = s->cell[c].flag[BR_PART_TOTAL] == BR_FLAG_FAILED;
                first = bad && !first ? &s->cell[c] : first;
                failed += bad;
            }
        }
    if (!failed)
        return BR_OK;
    return br_fail(err, BR_NOT_FINITE, "%zu of %zu cells failed; the first is n = %zu: %s", failed,
                   cells, first->at.n,
                   first->failure.status ? first->failure.message : "its error is not a number");
}
