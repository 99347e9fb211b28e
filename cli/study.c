/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate study SCENE: a grid of cells against one reference; and beamrate tables: the paper's
 * Tables 1 and 2 on their printed grids, two studies at once. */
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/studies.h"
#include "plots/pictures.h"
#include "study/foresee/warnings.h"
#include "tables/reports.h"

static enum br_status write_all(struct br_studies *r, struct br_error *err)
{
    struct br_session *session = r->session;
    const size_t norms = r->request.norms;
    if (br_session_report(session, r->jobs * norms, err))
        return err->status;
    for (size_t i = 0; i < r->jobs * norms; i++) {
        const struct br_study_work *w = &r->work[i / norms];
        const struct br_report *report = &w->report[i % norms];
        const struct br_provenance provenance = br_provenance_of(&w->opened, session->threads);
        struct br_document *d = &session->document[i];
        br_report_study(report, d);
        for (const struct br_convergence_picture *const *p = br_convergence_pictures; *p; p++)
            if ((*p)->applies(report))
                br_session_draw(session, d, br_convergence_draw(*p, report), (*p)->title);
        br_put_provenance(d, &provenance);
    }
    return br_session_finish(session, err);
}

/* A failed cell fails the run, after everything has been written. */
static enum br_status run_jobs(const struct br_options *options, const struct br_study_job *job,
                               size_t jobs, bool with_exact, struct br_error *err)
{
    struct br_session session = br_session_begin(options);
    struct br_studies r = {.session = &session, .jobs = jobs, .what = "marching"};
    const bool writes = session.writes;
    struct br_foreseen work = {.together = true};
    bool failed = br_studies_prepare(&r, job, with_exact, err);
    if (!failed) {
        br_studies_foresee(&r, &work);
        br_session_announce(&session, &work);
        failed = br_studies_check_memory(&r, err) || br_session_open(&session, err) ||
                 br_studies_keep(&r, err) || (writes && br_warn_of_studies(r.study, jobs, err)) ||
                 br_studies_compute(&r, false, err) || (writes && write_all(&r, err)) ||
                 br_studies_check_cells(&r, err);
    }
    br_studies_clear(&r);
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

static void take_point(const struct br_studies *r, struct br_variation *found, size_t i)
{
    double *value = &found->value[i * SWEPT];
    const struct br_report *report = r->work->report;
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
    struct br_studies *r = self;
    const struct br_study_job job = {.vary = v, .value = i};
    *r = (struct br_studies){.session = &v->session, .jobs = 1};
    if (br_studies_prepare(r, &job, false, err) || br_studies_check_memory(r, err))
        return err->status;
    v->column = name_columns(r->request.norm[0]);
    return BR_OK;
}

static enum br_status march_value(struct br_vary *v, size_t i, void *self, struct br_error *failure,
                                  struct br_error *err)
{
    struct br_studies *r = self;
    struct br_study named = *r->study;
    struct br_scene scene = *named.scene;
    static char what[64];
    char text[BR_VARIED_TEXT];
    named.scene = &scene;
    scene.name = (char *)br_varied_text(&v->varied, i, text);
    snprintf(what, sizeof what, "marching (value %zu of %zu)", i + 1, v->points);
    r->what = what;
    if (br_studies_keep(r, err))
        return err->status;
    if ((v->session.writes && br_warn_of_studies(&named, 1, failure)) ||
        br_studies_compute(r, true, failure))
        return BR_OK;
    take_point(r, &v->found, i);
    br_studies_check_cells(r, failure);
    return BR_OK;
}

static const struct br_vary_command varied = {
    .format = "beamrate study variation",
    .size = sizeof(struct br_studies),
    .columns = SWEPT,
    .prepare = prepare_value,
    .foresee = br_studies_foresee,
    .march = march_value,
    .clear = br_studies_clear,
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
    const struct br_study_job job = {.scene = options->word[0]};
    return run_jobs(options, &job, 1, false, err);
}

static enum br_status run_tables(const struct br_options *options, struct br_error *err)
{
    static const struct br_study_job printed[] = {
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
