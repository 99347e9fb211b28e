/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/study_run.h"

#include <errno.h>
#include <math.h>
#include <string.h>
#include <time.h>

#include "cli/output.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/signals.h"
#include "plots/plots.h"
#include "reference/printed.h"
#include "study/scene_file.h"

/* A job on its way. */
struct work {
    char path[1024]; /* the scene's file */
    char *text;      /* its contents */
    struct br_scene scene;
    size_t *n, *steps; /* the grid */
};

/* A report, and its name if that is not borrowed. */
struct page {
    struct br_report report;
    char name[512];
};

struct session {
    const struct br_study_options *options;
    struct br_study_request request;
    struct work *work;      /* jobs */
    struct page *page;      /* jobs * norms */
    struct br_study *study; /* heads * norms, in the first norm first, which br_study_run takes */
    size_t jobs;
    size_t heads; /* jobs, or twice that: each job, then each against the exact solution */
    struct br_output output;
    struct br_provenance provenance;
};

/* Study h of the heads in norm m. */
static struct br_study *study_of(const struct session *s, size_t h, size_t m)
{
    return &s->study[m * s->heads + h];
}

static enum br_status read_whole(const char *path, char **text, struct br_error *err)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return br_fail(err, BR_BAD_INPUT, "%s: %s", path, strerror(errno));
    const size_t most = 1u << 20;
    *text = br_allocate(most, 1);
    if (*text)
        (*text)[fread(*text, 1, most - 1, file)] = '\0';
    fclose(file);
    return *text ? BR_OK : br_no_memory(err, "the scene");
}

/* ---- the grid ---- */

/* Without --n: 25, 50, 100, 200; without --k: T over 100, 200, 400, 800; without
 * --reference: exact. */
enum { DEFAULT_COUNT = 4, DEFAULT_N = 25, DEFAULT_STEPS = 100 };

/* values, sorted in ascending order, or the default sequence. */
static enum br_status fill_counts(const size_t *given, size_t count, size_t first, size_t **out,
                                  struct br_error *err)
{
    *out = br_allocate(count, sizeof **out);
    if (!*out)
        return br_no_memory(err, "the grid");
    for (size_t i = 0; i < count; i++) {
        const size_t value = given ? given[i] : first << i;
        size_t j = i;
        for (; j > 0 && (*out)[j - 1] > value; j--)
            (*out)[j] = (*out)[j - 1];
        (*out)[j] = value;
    }
    return BR_OK;
}

static enum br_status make_steps(const struct br_scene *scene, const struct br_study_request *r,
                                 size_t **steps, struct br_error *err)
{
    if (!r->k)
        return fill_counts(NULL, DEFAULT_COUNT, DEFAULT_STEPS, steps, err);
    size_t *given = br_allocate(r->k_count, sizeof *given);
    enum br_status status = given ? BR_OK : br_no_memory(err, "the grid");
    struct br_error inner = {0};
    for (size_t j = 0; j < r->k_count && !status; j++)
        if (br_steps_of(scene, r->k[j], &given[j], &inner))
            status = br_fail(err, BR_BAD_INPUT, "--k: %s", inner.message);
    if (!status)
        status = fill_counts(given, r->k_count, 0, steps, err);
    for (size_t j = 1; j < r->k_count && !status; j++)
        if ((*steps)[j] == (*steps)[j - 1])
            status = br_fail(err, BR_BAD_INPUT, "--k: %g is given twice",
                             br_time_step(scene, (*steps)[j]));
    free(given);
    return status;
}

/* The fine run's resolution, and who measures its own error. */
static enum br_status set_fine(const struct session *s, struct br_study *study,
                               struct br_error *err)
{
    struct br_error inner = {0};
    study->reference.n = s->request.reference_n;
    if (br_steps_of(study->scene, s->request.reference_k, &study->reference.steps, &inner))
        return br_fail(err, BR_BAD_INPUT, "--reference: %s", inner.message);
    study->auditor = &br_judge_exact;
    return BR_OK;
}

static enum br_status make_grid(struct session *s, size_t i, struct br_error *err)
{
    struct work *w = &s->work[i];
    struct br_study *study = study_of(s, i, 0);
    const struct br_study_request *r = &s->request;
    study->n_count = r->n ? r->n_count : DEFAULT_COUNT;
    study->k_count = r->k ? r->k_count : DEFAULT_COUNT;
    enum br_status status = fill_counts(r->n, study->n_count, DEFAULT_N, &w->n, err);
    if (!status)
        status = make_steps(&w->scene, r, &w->steps, err);
    if (status)
        return status;
    study->scene = &w->scene;
    study->norm = r->norm[0];
    study->method = r->method;
    study->reference_method = r->reference_method;
    study->n = w->n;
    study->steps = w->steps;
    study->judge = r->judge;
    return r->judge->nests ? set_fine(s, study, err) : BR_OK;
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

/* From the job's study in the first norm: the same cells against the exact solution, and
 * both in the other norms. */
static void spread_study(struct session *s, size_t job)
{
    if (s->heads > s->jobs) {
        struct br_study *exact = study_of(s, s->jobs + job, 0);
        *exact = *study_of(s, job, 0);
        exact->judge = &br_judge_exact;
        exact->auditor = NULL;
        exact->reference = (struct br_resolution){0};
    }
    for (size_t h = job; h < s->heads; h += s->jobs)
        for (size_t m = 1; m < s->request.norms; m++) {
            struct br_study *study = study_of(s, h, m);
            *study = *study_of(s, h, m - 1);
            study->norm = s->request.norm[m];
            study_of(s, h, m - 1)->next_norm = study;
        }
}

/* The report of a job in norm m; in other norms than the first of the registry its name
 * ends with the norm's. */
static enum br_status start_report(struct session *s, size_t i, size_t m,
                                   const struct br_study_job *job, struct br_error *err)
{
    const struct work *w = &s->work[i];
    struct page *page = &s->page[i * s->request.norms + m];
    const struct br_norm *norm = s->request.norm[m];
    const char *name = job->name ? job->name : w->scene.name;
    const bool plain = norm == br_norms[0];
    snprintf(page->name, sizeof page->name, "%s%s%s", name, plain ? "" : "-",
             plain ? "" : norm->name);
    page->report = (struct br_report){
        .name = page->name,
        .caption = job->caption ? job->caption : w->scene.title,
        .study = study_of(s, i, m),
        .exact = s->heads > s->jobs ? study_of(s, s->jobs + i, m) : NULL,
    };
    return job->printed && norm->printed ? read_printed(job->printed, &page->report, err) : BR_OK;
}

static enum br_status prepare(struct session *s, size_t i, const struct br_study_job *job,
                              struct br_error *err)
{
    struct work *w = &s->work[i];
    enum br_status status = br_scene_find(job->scene, w->path, sizeof w->path, err);
    if (!status)
        status = br_scene_read(w->path, &w->scene, err);
    if (!status)
        status = read_whole(w->path, &w->text, err);
    if (!status)
        status = make_grid(s, i, err);
    if (!status)
        spread_study(s, i);
    for (size_t m = 0; m < s->request.norms && !status; m++)
        status = start_report(s, i, m, job, err);
    return status;
}

/* ---- running and writing ---- */

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static size_t pages(const struct session *s)
{
    return s->jobs * s->request.norms;
}

static enum br_status compute(struct session *s, struct br_error *err)
{
    const double start = now();
    const struct br_observer *observer = br_progress_start("marching", s->options->quiet);
    enum br_status status = br_study_run(s->study, s->heads, s->request.threads, observer, err);
    br_progress_end();
    const double wall = now() - start;
    for (size_t i = 0; i < pages(s) && !status; i++) {
        s->page[i].report.wall_seconds = wall;
        status = br_report_finish(&s->page[i].report, s->request.threads, err);
    }
    if (!status && br_signals_caught())
        status = br_fail(err, BR_INTERRUPTED, "interrupted");
    return status;
}

static void describe(struct session *s, size_t page)
{
    const struct work *w = &s->work[page / s->request.norms];
    s->provenance.scene_path = w->path;
    s->provenance.scene_text = w->text;
}

static bool wanted(const char *list, const char *name)
{
    if (!list)
        return true;
    const size_t length = strlen(name);
    for (const char *rest = list; *rest; rest += strcspn(rest, ","), rest += *rest == ',')
        if (strcspn(rest, ",") == length && strncmp(rest, name, length) == 0)
            return true;
    return false;
}

static enum br_status write_tables(struct session *s, size_t i, struct br_error *err)
{
    describe(s, i);
    for (const struct br_emitter *const *e = br_emitters; *e; e++) {
        if (!wanted(s->options->format, (*e)->name))
            continue;
        char name[512];
        snprintf(name, sizeof name, "%s%s", s->page[i].report.name, (*e)->extension);
        FILE *file;
        enum br_status status = br_output_file(&s->output, name, &file, err);
        if (status)
            return status;
        status = (*e)->emit(file, &s->page[i].report, &s->provenance, err);
        struct br_error closing = {0};
        if (br_output_close(file, name, &closing) && !status)
            status = br_fail(err, closing.status, "%s", closing.message);
        if (status)
            return status;
    }
    return BR_OK;
}

static enum br_status write_plots(struct session *s, size_t i, bool *missing, struct br_error *err)
{
    const struct br_report *report = &s->page[i].report;
    for (const struct br_plot *const *p = br_plots; *p; p++) {
        char script[512];
        if (!(*p)->applies(report))
            continue;
        enum br_status status = br_plot_file(*p, report, "gp", script, sizeof script, err);
        if (!status)
            status = br_plot_write(*p, report, s->output.staging, err);
        if (status)
            return status;
        if (!*missing)
            status = br_plot_render(s->output.staging, script, missing, err);
        if (br_signals_caught()) /* Ctrl-C ends gnuplot, too: that is no failure of its own */
            return br_fail(err, BR_INTERRUPTED, "interrupted");
        if (status && !*missing)
            return status;
    }
    return BR_OK;
}

static enum br_status write_all(struct session *s, struct br_error *err)
{
    bool missing = false;
    for (size_t i = 0; i < pages(s); i++) {
        enum br_status status = write_tables(s, i, err);
        if (!status && !s->options->no_plots)
            status = write_plots(s, i, &missing, err);
        if (status)
            return status;
    }
    if (missing)
        fprintf(stderr, "beamrate: gnuplot is not installed: the plots are written as scripts "
                        "(*.gp) and data, but not rendered\n");
    return br_output_commit(&s->output, err);
}

static enum br_status show(struct session *s, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < pages(s) && !status && !s->options->quiet; i++) {
        describe(s, i);
        status = br_emitters[0]->emit(stdout, &s->page[i].report, &s->provenance, err);
        putchar('\n');
    }
    return status;
}

/* A failed cell fails the run, after everything has been written. */
static enum br_status check_cells(const struct session *s, struct br_error *err)
{
    size_t failed = 0;
    const struct br_cell *first = NULL;
    for (size_t i = 0; i < s->jobs; i++) {
        const struct br_study *study = study_of(s, i, 0);
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

static void session_clear(struct session *s)
{
    for (size_t i = 0; s->page && i < pages(s); i++)
        br_report_clear(&s->page[i].report);
    for (size_t i = 0; s->work && i < s->jobs; i++) {
        br_scene_clear(&s->work[i].scene);
        free(s->work[i].text);
        free(s->work[i].n);
        free(s->work[i].steps);
    }
    for (size_t i = 0; s->study && i < s->heads * s->request.norms; i++)
        br_study_clear(&s->study[i]);
    free(s->page);
    free(s->work);
    free(s->study);
    br_output_discard(&s->output);
    br_study_request_clear(&s->request);
}

static enum br_status allocate(struct session *s, struct br_error *err)
{
    s->work = br_allocate(s->jobs, sizeof *s->work);
    s->page = br_allocate(pages(s), sizeof *s->page);
    s->study = br_allocate(s->heads * s->request.norms, sizeof *s->study);
    return s->work && s->page && s->study ? BR_OK : br_no_memory(err, "the studies");
}

enum br_status br_study_run_jobs(const struct br_study_job *jobs, size_t count,
                                 const struct br_study_options *options, bool with_exact,
                                 struct br_error *err)
{
    struct session s = {.options = options, .jobs = count};
    enum br_status status = br_study_request_read(options, &s.request, err);
    if (!s.request.judge)
        s.request.judge = &br_judge_exact;
    s.heads = with_exact && s.request.judge->nests ? 2 * count : count;
    if (!status)
        status = allocate(&s, err);
    for (size_t i = 0; i < count && !status; i++)
        status = prepare(&s, i, &jobs[i], err);
    if (!status)
        status = br_output_open(&s.output, options->out ? options->out : "results", err);
    br_provenance_fill(&s.provenance, s.request.threads);
    if (!status)
        status = compute(&s, err);
    if (!status)
        status = show(&s, err);
    if (!status)
        status = write_all(&s, err);
    if (!status && !options->quiet)
        printf("Written to %s/\n", s.output.folder);
    if (!status)
        status = check_cells(&s, err);
    session_clear(&s);
    return status;
}
