/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate study SCENE: a grid of cells against one reference; and beamrate tables: the paper's
 * Tables 1 and 2 on their printed grids, two studies at once. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/progress.h"
#include "cli/study_request.h"
#include "cli/vary.h"
#include "plots/pictures.h"
#include "reference/printed.h"
#include "solver/clock.h"
#include "study/fit/report.h"
#include "study/foresee/warnings.h"
#include "study/grid/differences.h"
#include "study/grid/sweep.h"
#include "study/ranks/ranks.h"
#include "study/scene/file.h"
#include "tables/reports.h"

/* One study: a scene, and the printed table to compare it with, if any. */
struct job {
    const char *name;           /* of the result files; NULL: the scene's */
    const char *scene;          /* a file, or a bundled scene */
    const char *printed;        /* a data file below the data folder, or NULL */
    const char *caption;        /* NULL: the scene's title */
    const struct br_vary *vary; /* of --vary: gives the scene instead of `scene` */
    size_t value;
};

enum {
    SIZES = 12, /* meshes or time steps at most, each half of the one before; differences: */
    PAIRS = 3,  /* ... so many at least, and more until they settle the order */
    LARGER = 4, /* time steps that are kept for the end */
    CHEAP = 10, /* elements of the mesh for those in k, at most */
    BESIDE = 60 /* elements' worth of what a step takes beside its elements */
};
/* Element-steps for an order that nobody waits for: about half a second. */
static const double no_matter = 28e6;

static double work_of(size_t n, size_t steps)
{
    return (double)steps * (double)(n + BESIDE);
}

/* The data of a job while it is computed. Each mesh is compared with the next at one time step, and
 * where the grid does not settle the order in k, each step with the next on one mesh. */
struct work {
    struct br_opened_scene opened;
    size_t *steps;               /* numbers of steps of the grid, ascending; owned */
    size_t size[BR_AXES][SIZES]; /* meshes, and numbers of steps, that are compared: */
    size_t first[BR_AXES], end[BR_AXES]; /* ... those that have been marched; end 0: none */
    size_t at[BR_AXES];          /* the number of steps, or the mesh, at which they are */
    struct br_error no_meshes;   /* why there are no differences */
    struct br_kept kept;
    struct br_differences apart[BR_MOST_NORMS];
};

/* A report with its name and caption. */
struct page {
    struct br_report report;
    const struct work *work;
    char name[512], caption[512];
};

struct run {
    struct br_session *session; /* borrowed */
    struct br_study_request request;
    const char *what; /* for the progress */
    size_t jobs, pages;
    size_t heads;           /* jobs, or 2 * jobs: each job, then each against the exact solution */
    struct work *work;      /* `jobs` of them */
    struct page *page;      /* `pages` of them, those of a job together */
    struct br_study *study; /* heads * norms; those in the first norm, for br_study_run, first */
};

/* Study h of the heads in norm m. */
static struct br_study *study_of(const struct run *r, size_t h, size_t m)
{
    return &r->study[m * r->heads + h];
}

/* ---- the grid ---- */

static enum br_status make_grid(struct run *r, size_t i, struct br_error *err)
{
    struct work *w = &r->work[i];
    const struct br_study_request *q = &r->request;
    const struct br_options *o = r->session->options;
    const struct br_scene *scene = &w->opened.scene;
    struct br_study *study = study_of(r, i, 0);
    *study = (struct br_study){
        .scene = scene,
        .norm = q->norm[0],
        .method = q->method,
        .reference_method = q->method,
        .judge = q->judge ? q->judge : br_judge_best(scene),
        .n = o->whole[BR_OPT_N],
        .n_count = o->count[BR_OPT_N],
    };
    if (br_option_steps(o, scene, &w->steps, &study->k_count, err))
        return err->status;
    br_sort_counts(o->whole[BR_OPT_N], study->n_count);
    br_sort_counts(w->steps, study->k_count);
    study->steps = w->steps;
    if (!study->judge->nests)
        return BR_OK;
    study->auditor = br_judge_best(scene); /* it measures the fine run's own error */
    return br_study_request_fine(q, scene, &study->reference, err);
}

/* Copies the job's study in the first norm: the same cells against the exact solution, and both in
 * the other norms. */
static void spread_study(struct run *r, size_t job)
{
    if (r->heads > r->jobs) {
        struct br_study *exact = study_of(r, r->jobs + job, 0);
        *exact = *study_of(r, job, 0);
        exact->judge = &br_judge_exact;
        exact->auditor = NULL;
        exact->reference = (struct br_resolution){0};
    }
    for (size_t h = job; h < r->heads; h += r->jobs)
        for (size_t m = 1; m < r->request.norms; m++) {
            struct br_study *study = study_of(r, h, m);
            *study = *study_of(r, h, m - 1);
            study->norm = r->request.norm[m];
            study_of(r, h, m - 1)->next_norm = study;
        }
}

/* ---- reports ---- */

static enum br_status read_printed(const char *relative, struct br_report *report,
                                   struct br_error *err)
{
    char path[1024];
    struct br_printed printed;
    const struct br_study *study = report->study;
    const size_t cells = study->n_count * study->k_count;
    br_data_path(relative, path, sizeof path);
    const bool read = !br_printed_read(path, &printed, err);
    report->printed = read ? br_allocate(cells, sizeof(double)) : NULL;
    for (size_t c = 0; c < cells && report->printed; c++)
        report->printed[c] =
            br_printed_error(&printed, study->n[c / study->k_count],
                             br_time_step(study->scene, study->steps[c % study->k_count]));
    br_printed_clear(&printed);
    return report->printed ? BR_OK : read ? br_no_memory(err, "the printed values") : err->status;
}

/* Starts report i of a job in norm m. Its name ends with the norm, unless that is the default. */
static enum br_status start_report(struct run *r, const struct job *job, size_t i, size_t m,
                                   struct br_error *err)
{
    struct work *w = &r->work[i];
    const struct br_norm *norm = r->request.norm[m];
    const struct br_scene *scene = &w->opened.scene;
    const bool usual = norm == br_norms[0];
    struct page *page = &r->page[r->pages++];
    page->work = w;
    snprintf(page->name, sizeof page->name, "%s%s%s", job->name ? job->name : scene->name,
             usual ? "" : "-", usual ? "" : norm->name);
    snprintf(page->caption, sizeof page->caption, "%s", job->caption ? job->caption : scene->title);
    page->report = (struct br_report){
        .name = page->name,
        .caption = page->caption,
        .study = study_of(r, i, m),
        .exact = r->heads > r->jobs ? study_of(r, r->jobs + i, m) : NULL,
        .apart = {&w->apart[m].over[BR_AXIS_SPACE]},
    };
    return job->printed && norm->printed ? read_printed(job->printed, &page->report, err) : BR_OK;
}

static enum br_status prepare_job(struct run *r, const struct job *job, size_t i,
                                  struct br_error *err)
{
    struct br_opened_scene *opened = &r->work[i].opened;
    if ((job->vary ? br_vary_scene(job->vary, job->value, opened, err)
                   : br_opened_scene_read(opened, job->scene, err)) ||
        make_grid(r, i, err))
        return err->status;
    spread_study(r, i);
    for (size_t m = 0; m < r->request.norms; m++)
        if (start_report(r, job, i, m, err))
            return err->status;
    return BR_OK;
}

/* with_exact: a fine reference is followed by the exact one. */
static enum br_status prepare(struct run *r, const struct job *job, bool with_exact,
                              struct br_error *err)
{
    const struct br_study_request *q = &r->request;
    bool axial = false;
    if (br_study_request_read(r->session->options, &r->request, err))
        return err->status;
    r->heads = with_exact && q->judge && q->judge->nests ? 2 * r->jobs : r->jobs;
    r->work = br_allocate(r->jobs, sizeof *r->work);
    r->page = br_allocate(r->jobs * q->norms, sizeof *r->page);
    r->study = br_allocate(r->heads * q->norms, sizeof *r->study);
    if (!r->work || !r->page || !r->study)
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

static void clear(void *self)
{
    struct run *r = self;
    for (size_t i = 0; i < r->pages; i++)
        br_report_clear(&r->page[i].report);
    for (size_t i = 0; r->study && i < r->heads * r->request.norms; i++)
        br_study_clear(&r->study[i]);
    for (size_t i = 0; r->work && i < r->jobs; i++) {
        for (size_t m = 0; m < r->request.norms; m++) {
            br_study_clear(&r->work[i].apart[m].over[BR_AXIS_SPACE]);
            br_study_clear(&r->work[i].apart[m].over[BR_AXIS_TIME]);
        }
        br_opened_scene_clear(&r->work[i].opened);
        free(r->work[i].steps);
    }
    free(r->page);
    free(r->work);
    free(r->study);
}

/* ---- computing ---- */

/* Finished cells are kept with their scene; the differences of neighbours are not. */
static enum br_status keep(struct run *r, struct br_error *err)
{
    for (size_t i = 0; i < r->jobs; i++)
        if (br_session_keep(r->session, &r->work[i].kept, err))
            return err->status;
    for (size_t h = 0; h < r->heads && *r->work->kept.folder; h++)
        for (struct br_study *s = study_of(r, h, 0); s; s = s->next_norm)
            s->engine = br_kept_engine(&r->work[h % r->jobs].kept);
    return BR_OK;
}

/* Checks the memory of the studies, which march at once. */
static enum br_status check_memory(const struct run *r, struct br_error *err)
{
    return br_ranks_size() == 1
               ? br_fit_together(study_of(r, 0, 0), r->heads, br_memory_available(), err)
               : BR_OK;
}

/* ---- differences of neighbours ---- */

/* Sets the meshes: those of the grid, if they suffice and each nests in the next, else meshes up to
 * about its finest; and then finer ones. At the coarsest time step that the grid's can march. */
static void choose_meshes(struct work *w, const struct br_study *s)
{
    const size_t finest = s->n[s->n_count - 1], first = finest >> PAIRS;
    size_t *size = w->size[BR_AXIS_SPACE];
    bool nest = s->n_count > PAIRS && s->n_count <= SIZES, sound = false;
    for (size_t i = 0; i + 1 < s->n_count; i++)
        nest = nest && s->n[i + 1] > s->n[i] && s->n[i + 1] % s->n[i] == 0;
    for (size_t i = 0; i < SIZES; i++)
        size[i] = nest && i < s->n_count ? s->n[i] : i ? 2 * size[i - 1] : first ? first : 1;
    w->end[BR_AXIS_SPACE] = nest ? s->n_count : PAIRS + 1;
    for (size_t j = 0; j < s->k_count && !sound; j++) {
        w->at[BR_AXIS_SPACE] = s->steps[j];
        sound = true;
        for (size_t i = 0; i < s->n_count; i++)
            sound &= !br_study_cell(s, i, j)->unstable && !br_study_cell(s, i, j)->failure.status;
    }
}

/* Sets the time steps: from the grid's smallest on, and below the relaxation time if that is within
 * reach, since above it errors have another order; before them larger ones. */
static void choose_steps(struct work *w, const struct br_study *s)
{
    const struct br_axial *u = &s->scene->axial;
    const struct br_bending *b = &s->scene->bending;
    const double time =
        fmin(u->modelled && u->viscosity > 0 ? u->viscosity / u->stiffness : INFINITY,
             b->modelled && b->viscosity > 0 ? b->viscosity / b->stiffness : INFINITY);
    size_t steps = s->steps[s->k_count - 1], *first = &w->first[BR_AXIS_TIME];
    for (int i = 0; i < 2 && br_time_step(s->scene, steps) > time; i++)
        steps *= 2;
    for (; *first < LARGER && steps % 2 == 0 && steps / 2 >= w->at[BR_AXIS_SPACE]; ++*first)
        steps /= 2;
    w->at[BR_AXIS_TIME] = s->n[0] < CHEAP ? s->n[0] : CHEAP;
    for (size_t i = 0; i < SIZES; i++)
        w->size[BR_AXIS_TIME][i] = steps << i;
}

/* Adds differences of neighbours at the front or the back of those that are there. size: of the
 * first one. */
static enum br_status add(struct br_study *to, struct br_study *more, int axis, bool front,
                          const size_t *size, struct br_error *err)
{
    const size_t old = to->cell ? br_axis_count(to, axis) : 0, new = br_axis_count(more, axis);
    struct br_cell *cell = br_allocate(old + new, sizeof *cell);
    if (!cell)
        return br_no_memory(err, "the differences");
    br_flag_beside(more); /* each by its own round-off */
    if (old)
        memcpy(cell + (front ? new : 0), to->cell, old * sizeof *cell);
    memcpy(cell + (front ? 0 : old), more->cell, new * sizeof *cell);
    free(to->cell);
    *to = *more;
    to->cell = cell;
    *(axis == BR_AXIS_SPACE ? &to->n : &to->steps) = size;
    *(axis == BR_AXIS_SPACE ? &to->n_count : &to->k_count) = old + new;
    return BR_OK;
}

/* Compares the sizes [from, to) of an axis in all norms. A march that fails (why) ends what there is
 * to see. */
static enum br_status compare(struct run *r, struct work *w, int axis, size_t from, size_t to,
                              const struct br_observer *observer, struct br_error *why,
                              struct br_error *err)
{
    const size_t norms = r->request.norms, *size = w->size[axis];
    const bool over_h = axis == BR_AXIS_SPACE, front = from < w->first[axis];
    struct br_study grid[BR_MOST_NORMS] = {0};
    struct br_differences found[BR_MOST_NORMS] = {0};
    for (size_t m = 0; m < norms; m++)
        grid[m] = (struct br_study){.scene = &w->opened.scene,
                                    .method = r->request.method,
                                    .judge = &br_judge_none,
                                    .norm = r->request.norm[m],
                                    .n = over_h ? size + from : &w->at[axis],
                                    .n_count = over_h ? to - from : 1,
                                    .steps = over_h ? &w->at[axis] : size + from,
                                    .k_count = over_h ? 1 : to - from,
                                    .next_norm = m + 1 < norms ? &grid[m + 1] : NULL};
    enum br_status status = br_differences_run(grid, found, r->session->threads, observer, why);
    if (status == BR_NO_MEMORY || status == BR_INTERRUPTED)
        return br_fail(err, status, "%s", why->message);
    w->first[axis] = front ? from : w->first[axis];
    w->end[axis] = front ? w->end[axis] : to;
    status = BR_OK;
    for (size_t m = 0; m < norms && !why->status; m++) {
        if (!status)
            status = add(&w->apart[m].over[axis], &found[m].over[axis], axis, front,
                         size + w->first[axis], err);
        br_study_clear(&found[m].over[axis]);
    }
    return status;
}

/* The pages of a job stand together, one for each norm. settled: out. */
static enum br_status see_job(struct run *r, size_t job, enum br_axis axis, bool *settled,
                              struct br_error *err)
{
    *settled = true;
    for (size_t m = 0; m < r->request.norms; m++) {
        struct br_report *report = &r->page[job * r->request.norms + m].report;
        const struct br_study *apart = &r->work[job].apart[m].over[axis];
        report->apart[axis] = apart->cell ? apart : NULL;
        if (apart->cell && br_report_see_orders(report, axis, err))
            return err->status;
        *settled = *settled && br_report_settles(report, axis);
    }
    return BR_OK;
}

/* The element-steps of two neighbours. */
static double work_of_pair(const struct work *w, int axis, size_t i)
{
    const size_t *size = w->size[axis];
    return axis == BR_AXIS_SPACE
               ? work_of(size[i], w->at[axis]) + work_of(size[i + 1], w->at[axis])
               : work_of(w->at[axis], size[i]) + work_of(w->at[axis], size[i + 1]);
}

/* Where the order is not settled, differences of ever smaller sizes do it, and then of larger ones:
 * until they settle it, or cost more than the grid. */
static enum br_status search(struct run *r, size_t job, enum br_axis axis,
                             const struct br_observer *observer, struct br_error *err)
{
    struct work *w = &r->work[job];
    const struct br_study *s = study_of(r, job, 0);
    struct br_error why = {0};
    bool settled;
    enum br_status status = see_job(r, job, axis, &settled, err);
    double left = 0;
    for (size_t c = 0; c < br_study_cells(s); c++)
        left += work_of(s->cell[c].at.n, s->cell[c].at.steps);
    left = fmax(left, no_matter);
    while (!status && !settled && !why.status) {
        const size_t end = w->end[axis], first = w->first[axis];
        size_t from = end ? end - 1 : first, to = end ? end + 1 : first + PAIRS + 2;
        for (size_t i = from; i + 1 < to && to <= SIZES; i++)
            left -= work_of_pair(w, axis, i);
        if (to > SIZES || left < 0)
            from = first - 1, to = first + 1;
        if (first == 0 && to == 1)
            break;
        status = compare(r, w, axis, from, to, observer, &why, err);
        if (!status)
            status = see_job(r, job, axis, &settled, err);
    }
    return status;
}

static enum br_status compute(struct run *r, struct br_error *err)
{
    const double start = br_seconds();
    const bool varies = br_option_given(r->session->options, BR_OPT_VARY);
    const struct br_observer *observer = br_progress_start(r->what, r->session->quiet);
    enum br_status status = br_study_run(r->study, r->heads, r->session->threads, observer, err);
    for (size_t i = 0; i < r->jobs && !status; i++) {
        struct work *w = &r->work[i];
        choose_meshes(w, study_of(r, i, 0));
        choose_steps(w, study_of(r, i, 0));
        status = compare(r, w, BR_AXIS_SPACE, 0, w->end[BR_AXIS_SPACE], observer, &w->no_meshes,
                         err);
    }
    for (struct page *page = r->page; page < r->page + r->pages && !status; page++) {
        const struct br_error *no_meshes = &page->work->no_meshes;
        if (no_meshes->status) {
            page->report.apart[BR_AXIS_SPACE] = NULL;
            page->report.no_meshes = no_meshes->message;
        }
        status = br_report_finish(&page->report, r->session->threads, err);
    }
    for (size_t i = 0; i < r->jobs && !status && !varies; i++) {
        if (!r->work[i].no_meshes.status)
            status = search(r, i, BR_AXIS_SPACE, observer, err);
        if (!status)
            status = search(r, i, BR_AXIS_TIME, observer, err);
    }
    br_progress_end();
    for (size_t i = 0; i < r->jobs; i++)
        br_session_report_kept(r->session, &r->work[i].kept);
    for (size_t i = 0; i < r->pages; i++)
        r->page[i].report.wall_seconds = br_seconds() - start;
    return br_progress_result(status, err);
}

/* ---- results ---- */

static enum br_status write_all(struct run *r, struct br_error *err)
{
    struct br_session *session = r->session;
    if (br_session_report(session, r->pages, err))
        return err->status;
    for (size_t i = 0; i < r->pages; i++) {
        const struct br_report *report = &r->page[i].report;
        const struct br_provenance provenance =
            br_provenance_of(&r->page[i].work->opened, session->threads);
        struct br_document *d = &session->document[i];
        br_report_study(report, d);
        for (const struct br_convergence_picture *const *p = br_convergence_pictures; *p; p++)
            if ((*p)->applies(report))
                br_session_draw(session, d, br_convergence_draw(*p, report), (*p)->title);
        br_put_provenance(d, &provenance);
    }
    return br_session_finish(session, err);
}

static void foresee(void *self, struct br_foreseen *work)
{
    const struct run *r = self;
    for (size_t h = 0; h < r->heads; h++)
        br_foreseen_add_study(work, study_of(r, h, 0));
}

/* A failed cell fails the run, after everything has been written. */
static enum br_status check_cells(const struct run *r, struct br_error *err)
{
    size_t failed = 0, cells = 0;
    const struct br_cell *first = NULL;
    for (size_t i = 0; i < 2 * r->pages; i++) {
        const struct br_report *report = &r->page[i / 2].report;
        const struct br_study *s = i % 2 ? report->exact : report->study;
        for (size_t c = 0; s && s->norm == r->request.norm[0] && c < br_study_cells(s); c++) {
            const bool bad = s->cell[c].flag[BR_PART_TOTAL] == BR_FLAG_FAILED;
            first = bad && !first ? &s->cell[c] : first;
            failed += bad;
            cells++;
        }
    }
    if (!failed)
        return BR_OK;
    return br_fail(err, BR_NOT_FINITE, "%zu of %zu cells failed; the first is n = %zu: %s", failed,
                   cells, first->at.n,
                   first->failure.status ? first->failure.message : "its error is not a number");
}

static enum br_status run_jobs(const struct br_options *options, const struct job *job, size_t jobs,
                               bool with_exact, struct br_error *err)
{
    struct br_session session = br_session_begin(options);
    struct run r = {.session = &session, .jobs = jobs, .what = "marching"};
    const bool writes = session.writes;
    struct br_foreseen work = {.together = true};
    bool failed = prepare(&r, job, with_exact, err);
    if (!failed) {
        foresee(&r, &work);
        br_session_announce(&session, &work);
        failed = check_memory(&r, err) || br_session_open(&session, err) || keep(&r, err) ||
                 (writes && br_warn_of_studies(r.study, jobs, err)) || compute(&r, err) ||
                 (writes && write_all(&r, err)) || check_cells(&r, err);
    }
    clear(&r);
    br_session_close(&session);
    return failed ? err->status : BR_OK;
}

/* ---- a parameter that varies ---- */

enum { ERROR, RELATIVE, OWN, P, P_LOW, P_HIGH, Q, Q_LOW, Q_HIGH, MISFIT, POINTS, SWEPT };

static const struct br_variation_column *name_columns(const struct br_norm *norm)
{
    static char axis[160];
    static struct br_variation_column column[SWEPT];
    snprintf(axis, sizeof axis, "%s of the finest cell (%s)", norm->symbol, norm->unit_markup);
    const struct br_variation_column columns[SWEPT] = {
        [ERROR] = {"error", "error of the finest cell", norm->unit, "%.3e", .axis = axis,
                   .logarithmic = true},
        [RELATIVE] = {"relative", "relative", .format = "%.2e"},
        [OWN] = {"reference_error", .unit = norm->unit, .for_programs = true},
        [P] = {"p", "order in h", .format = "%.3f", .axis = "order"},
        [P_LOW] = {"p_low", .for_programs = true},
        [P_HIGH] = {"p_high", .for_programs = true},
        [Q] = {"q", "order in k", .format = "%.3f", .axis = "order"},
        [Q_LOW] = {"q_low", .for_programs = true},
        [Q_HIGH] = {"q_high", .for_programs = true},
        [MISFIT] = {"misfit", "misfit", .format = "%.2g"},
        [POINTS] = {"points", "cells used", .format = "%.0f"},
    };
    memcpy(column, columns, sizeof column);
    return column;
}

/* Takes an order by the rule of a study's report for claiming it. */
static void take_order(double *value, const struct br_joint_fit *fit, const struct br_estimate *e)
{
    if (!br_joint_describes(fit) || !br_order_determined(e))
        return;
    value[0] = e->value;
    value[1] = e->low;
    value[2] = e->high;
}

static void take_point(const struct run *r, struct br_variation *found, size_t i)
{
    double *value = &found->value[i * SWEPT];
    const struct br_report *report = &r->page[0].report;
    const struct br_study *s = report->study;
    const struct br_joint_fit *fit = &report->fits[BR_PART_TOTAL].joint;
    const struct br_cell *finest = &s->cell[br_study_cells(s) - 1];
    value[ERROR] = finest->error[BR_PART_TOTAL];
    value[RELATIVE] = value[ERROR] / s->reference_scale;
    value[OWN] = report->fits[BR_PART_TOTAL].reference_error;
    take_order(&value[P], fit, &fit->order[BR_AXIS_SPACE]);
    take_order(&value[Q], fit, &fit->order[BR_AXIS_TIME]);
    value[MISFIT] = fit->misfit;
    value[POINTS] = (double)fit->points;
    if (finest->flag[BR_PART_TOTAL])
        found->remark[i] = br_flag_name(finest->flag[BR_PART_TOTAL]);
    found->unstable[i] = finest->unstable;
}

static enum br_status prepare_value(struct br_vary *v, size_t i, void *self, struct br_error *err)
{
    struct run *r = self;
    const struct job job = {.vary = v, .value = i};
    *r = (struct run){.session = &v->session, .jobs = 1};
    if (prepare(r, &job, false, err) || check_memory(r, err))
        return err->status;
    v->column = name_columns(r->request.norm[0]);
    return BR_OK;
}

static enum br_status march_value(struct br_vary *v, size_t i, void *self, struct br_error *failure,
                                  struct br_error *err)
{
    struct run *r = self;
    struct br_study named = *r->study;
    struct br_scene scene = *named.scene;
    static char what[64];
    char text[BR_VARIED_TEXT];
    named.scene = &scene;
    scene.name = (char *)br_varied_text(&v->varied, i, text);
    snprintf(what, sizeof what, "marching (value %zu of %zu)", i + 1, v->points);
    r->what = what;
    if (keep(r, err))
        return err->status;
    if ((v->session.writes && br_warn_of_studies(&named, 1, failure)) || compute(r, failure))
        return BR_OK;
    take_point(r, &v->found, i);
    check_cells(r, failure);
    return BR_OK;
}

static const struct br_vary_command varied = {
    .format = "beamrate study variation",
    .size = sizeof(struct run),
    .columns = SWEPT,
    .prepare = prepare_value,
    .foresee = foresee,
    .march = march_value,
    .clear = clear,
};

static enum br_status run_varied(const struct br_options *o, struct br_error *err)
{
    if (o->count[BR_OPT_NORM] > 1)
        return br_fail(err, BR_BAD_INPUT, "--norm: found %zu norms, expected one with --vary",
                       o->count[BR_OPT_NORM]);
    return br_vary_run(o, &varied, err);
}

/* ---- the commands ---- */

static enum br_status run_study(const struct br_options *options, struct br_error *err)
{
    if (br_option_given(options, BR_OPT_VARY))
        return run_varied(options, err);
    const struct job job = {.scene = options->word[0]};
    return run_jobs(options, &job, 1, false, err);
}

static enum br_status run_tables(const struct br_options *options, struct br_error *err)
{
    static const struct job printed[] = {
        {.name = "table1",
         .scene = "example1",
         .printed = "reference/printed/table1.csv",
         .caption = "Table 1: Example 1, stick"},
        {.name = "table2",
         .scene = "example2",
         .printed = "reference/printed/table2.csv",
         .caption = "Table 2: Example 2, slip"},
    };
    return run_jobs(options, printed, sizeof printed / sizeof *printed, true, err);
}

const struct br_command br_command_study = {
    .bit = BR_FOR_STUDY,
    .name = "study",
    .arguments = "SCENE",
    .title = "the errors of a grid of meshes and time steps, and their orders",
    .about = "Measures the errors of a grid of cells (n, k) of a scene against the exact solution "
             "or a fine run.",
    .more =
        "A scene is a file, or one of the bundled scenes that 'beamrate scenes' lists. The errors "
        "are measured in exact norms over all time levels, and the orders of convergence are "
        "fitted with 95 % intervals.",
    .example = {"beamrate study example4 -n 50,100,200 -k 0.03,0.015 --reference fine:800,1e-3",
                "beamrate study example2 --norm l2,energy,tip",
                "beamrate study example2 --vary 'contact.stiffness=1e2..1e4 log 5'"},
    .least_words = 1,
    .most_words = 1,
    .run = run_study,
};

const struct br_command br_command_tables = {
    .bit = BR_FOR_TABLES,
    .name = "tables",
    .arguments = "",
    .title = "the paper's two error tables, computed, beside the printed ones",
    .about =
        "Computes the paper's Tables 1 and 2 on the printed grids with the printed reference, "
        "beside the printed values. The errors against the exact solution are measured, too; the "
        "orders are fitted to these.",
    .example = {"beamrate tables --out results", "mpirun -n 4 beamrate tables"},
    .run = run_tables,
};
