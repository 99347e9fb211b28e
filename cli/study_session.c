/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/study_session.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/progress.h"
#include "cli/signals.h"
#include "reference/printed.h"
#include "solver/clock.h"
#include "study/grid/differences.h"
#include "study/grid/sweep.h"
#include "study/scene/file.h"

/* ---- the grid ---- */

static int ascending(const void *a, const void *b)
{
    const size_t x = *(const size_t *)a, y = *(const size_t *)b;
    return (x > y) - (x < y);
}

/* The fine run's resolution, and who measures its own error. */
static enum br_status set_fine(const struct br_session *s, struct br_study *study,
                               struct br_error *err)
{
    const enum br_status status =
        br_study_request_fine(&s->request, study->scene, &study->reference, err);
    study->auditor = br_judge_best(study->scene);
    return status;
}

static enum br_status make_grid(struct br_session *s, size_t i, const struct br_options *options,
                                struct br_error *err)
{
    struct br_work *w = &s->work[i];
    struct br_study *study = br_session_study(s, i, 0);
    const struct br_study_request *r = &s->request;
    enum br_status status = br_option_counts(options, BR_OPT_N, &w->n, &study->n_count, err);
    if (!status)
        status = br_option_steps(options, &w->scene, &w->steps, &study->k_count, err);
    if (status)
        return status;
    qsort(w->n, study->n_count, sizeof *w->n, ascending);
    qsort(w->steps, study->k_count, sizeof *w->steps, ascending);
    study->scene = &w->scene;
    study->norm = r->norm[0];
    study->method = r->method;
    study->reference_method = r->reference_method;
    study->n = w->n;
    study->steps = w->steps;
    study->judge = r->judge ? r->judge : br_judge_best(&w->scene);
    return study->judge->nests ? set_fine(s, study, err) : BR_OK;
}

/* ---- the printed values ---- */

static enum br_status read_printed(const char *relative, struct br_report *report,
                                   struct br_error *err)
{
    char path[1024];
    const struct br_study *study = report->study;
    br_data_path(relative, path, sizeof path);
    struct br_printed printed;
    enum br_status status = br_printed_read(path, &printed, err);
    const size_t cells = study->n_count * study->k_count;
    if (!status && !(report->printed = br_allocate(cells, sizeof(double))))
        status = br_no_memory(err, "the printed values");
    for (size_t c = 0; c < cells && !status; c++)
        report->printed[c] =
            br_printed_error(&printed, study->n[c / study->k_count],
                             br_time_step(study->scene, study->steps[c % study->k_count]));
    br_printed_clear(&printed);
    return status;
}

/* ---- studies and reports ---- */

struct br_study *br_session_study(const struct br_session *s, size_t h, size_t m)
{
    return &s->study[m * s->heads + h];
}

const struct br_work *br_session_work(const struct br_session *s, size_t page)
{
    return &s->work[page / (s->pages / s->jobs)];
}

static bool without_reference(const struct br_session *s)
{
    return s->request.judge == &br_judge_none;
}

/* From the job's study in the first norm: the same cells against the exact solution, and
 * both in the other norms. */
static void spread_study(struct br_session *s, size_t job)
{
    if (s->heads > s->jobs) {
        struct br_study *exact = br_session_study(s, s->jobs + job, 0);
        *exact = *br_session_study(s, job, 0);
        exact->judge = &br_judge_exact;
        exact->auditor = NULL;
        exact->reference = (struct br_resolution){0};
    }
    for (size_t h = job; h < s->heads; h += s->jobs)
        for (size_t m = 1; m < s->request.norms; m++) {
            struct br_study *study = br_session_study(s, h, m);
            *study = *br_session_study(s, h, m - 1);
            study->norm = s->request.norm[m];
            br_session_study(s, h, m - 1)->next_norm = study;
        }
}

/* Where a report stands: a job, a norm, and without a reference over h (0) or k (1). */
struct place {
    size_t job, norm, variant;
};

/* Names end with the norm, but for the default one, and with what is compared. */
static void name_page(const struct br_session *s, const struct place *at,
                      const struct br_study_job *job, struct br_page *page)
{
    static const char *const compared[][2] = {{"meshes", "successive meshes"},
                                              {"steps", "successive time steps"}};
    const struct br_work *w = &s->work[at->job];
    const struct br_norm *norm = s->request.norm[at->norm];
    const bool plain = norm == br_norms[0], none = without_reference(s);
    snprintf(page->name, sizeof page->name, "%s%s%s%s%s", job->name ? job->name : w->scene.name,
             plain ? "" : "-", plain ? "" : norm->name, none ? "-" : "",
             none ? compared[at->variant][0] : "");
    snprintf(page->caption, sizeof page->caption, "%s%s%s",
             job->caption ? job->caption : w->scene.title, none ? ": differences of " : "",
             none ? compared[at->variant][1] : "");
}

static enum br_status start_report(struct br_session *s, const struct place *at,
                                   const struct br_study_job *job, struct br_error *err)
{
    const size_t variants = without_reference(s) ? 2 : 1;
    struct br_page *page =
        &s->page[(at->job * s->request.norms + at->norm) * variants + at->variant];
    const bool companion = variants == 1 && s->heads > s->jobs;
    name_page(s, at, job, page);
    page->report = (struct br_report){
        .name = page->name,
        .caption = page->caption,
        .study = br_session_study(s, at->variant * s->jobs + at->job, at->norm),
        .exact = companion ? br_session_study(s, s->jobs + at->job, at->norm) : NULL,
        .tips = variants == 2 ? &s->work[at->job].tips : NULL,
    };
    const bool printed = job->printed && s->request.norm[at->norm]->printed && variants == 1;
    return printed ? read_printed(job->printed, &page->report, err) : BR_OK;
}

static enum br_status start_reports(struct br_session *s, size_t i, const struct br_study_job *job,
                                    struct br_error *err)
{
    const size_t variants = without_reference(s) ? 2 : 1;
    enum br_status status = BR_OK;
    for (size_t m = 0; m < s->request.norms; m++)
        for (size_t v = 0; v < variants && !status; v++)
            status = start_report(s, &(struct place){i, m, v}, job, err);
    return status;
}

static enum br_status prepare(struct br_session *s, size_t i, const struct br_study_job *job,
                              const struct br_options *options, struct br_error *err)
{
    struct br_work *w = &s->work[i];
    enum br_status status =
        br_scene_open(job->scene, w->path, sizeof w->path, &w->text, &w->scene, err);
    if (!status)
        status = make_grid(s, i, options, err);
    if (!status)
        spread_study(s, i);
    if (!status)
        status = start_reports(s, i, job, err);
    return status;
}

static enum br_status allocate(struct br_session *s, struct br_error *err)
{
    s->work = br_allocate(s->jobs, sizeof *s->work);
    s->page = br_allocate(s->pages, sizeof *s->page);
    s->study = br_allocate(s->heads * s->request.norms, sizeof *s->study);
    return s->work && s->page && s->study ? BR_OK : br_no_memory(err, "the studies");
}

static enum br_status check_degree(const struct br_session *s, struct br_error *err)
{
    bool axial = s->request.method.axial_degree == 1;
    for (size_t i = 0; i < s->jobs; i++)
        axial |= s->work[i].scene.axial.modelled;
    return axial ? BR_OK
                 : br_fail(err, BR_BAD_INPUT, "--axial-degree: no scene has an axial field");
}

enum br_status br_session_prepare(struct br_session *s, const struct br_study_job *jobs,
                                  size_t count, const struct br_options *options, bool with_exact,
                                  struct br_error *err)
{
    *s = (struct br_session){.jobs = count};
    enum br_status status = br_study_request_read(options, &s->request, err);
    if (status)
        return status;
    const bool companion = with_exact && s->request.judge && s->request.judge->nests;
    s->heads = companion || without_reference(s) ? 2 * count : count;
    s->pages = count * s->request.norms * (without_reference(s) ? 2 : 1);
    status = allocate(s, err);
    for (size_t i = 0; i < count && !status; i++)
        status = prepare(s, i, &jobs[i], options, err);
    return status ? status : check_degree(s, err);
}

void br_session_clear(struct br_session *s)
{
    for (size_t i = 0; s->page && i < s->pages; i++)
        br_report_clear(&s->page[i].report);
    for (size_t i = 0; s->study && i < s->heads * s->request.norms; i++)
        br_study_clear(&s->study[i]);
    for (size_t i = 0; s->work && i < s->jobs; i++) {
        br_scene_clear(&s->work[i].scene);
        br_tips_clear(&s->work[i].tips);
        free(s->work[i].text);
        free(s->work[i].n);
        free(s->work[i].steps);
    }
    free(s->page);
    free(s->work);
    free(s->study);
    br_study_request_clear(&s->request);
}

/* ---- computing ---- */

/* The differences of one job's grids, into its studies. */
static enum br_status run_differences(struct br_session *s, size_t job,
                                      const struct br_observer *observer, struct br_error *err)
{
    struct br_differences out[BR_MOST_NORMS] = {0};
    const enum br_status status = br_differences_run(
        br_session_study(s, job, 0), out, &s->work[job].tips, s->request.threads, observer, err);
    for (size_t m = 0; m < s->request.norms; m++) {
        *br_session_study(s, job, m) = out[m].over_h;
        *br_session_study(s, s->jobs + job, m) = out[m].over_k;
    }
    return status;
}

static enum br_status march(struct br_session *s, const struct br_observer *observer,
                            struct br_error *err)
{
    if (!without_reference(s))
        return br_study_run(s->study, s->heads, s->request.threads, observer, err);
    enum br_status status = BR_OK;
    for (size_t i = 0; i < s->jobs && !status; i++)
        status = run_differences(s, i, observer, err);
    return status;
}

enum br_status br_session_compute(struct br_session *s, bool quiet, struct br_error *err)
{
    const double start = br_seconds();
    const struct br_observer *observer = br_progress_start("marching", quiet);
    enum br_status status = march(s, observer, err);
    br_progress_end();
    const double wall = br_seconds() - start;
    for (size_t i = 0; i < s->pages && !status; i++) {
        s->page[i].report.wall_seconds = wall;
        status = br_report_finish(&s->page[i].report, s->request.threads, err);
    }
    if (!status && br_signals_caught())
        status = br_fail(err, BR_INTERRUPTED, "interrupted");
    return status;
}
