/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate study SCENE: a grid of cells against one reference; and beamrate tables: the paper's
 * Tables 1 and 2 on their printed grids, two studies at once. */
#include "cli/beam/studies.h"
#include "cli/command.h"
#include "plots/beam/pictures.h"
#include "study/estimate/warnings.h"
#include "tables/beam/reports.h"

static enum br_status write_all(struct br_studies *r, struct br_error *err)
{
    struct br_session *session = r->session;
    const size_t norms = r->request->norms;
    if (br_session_report(session, r->jobs * norms, err))
        return err->status;
    for (size_t i = 0; i < r->jobs * norms; i++) {
        const struct br_study_work *w = &r->work[i / norms];
        const struct br_report *report = &w->report[i % norms];
        const struct br_provenance provenance = br_provenance_of(&w->opened, session->threads);
        struct br_document *d = &session->document[i];
        br_report_study(report, d);
        for (const struct br_convergence_picture *p = br_convergence_pictures; p->name; p++)
            br_session_draw(session, d, br_convergence_draw(p, report), p->title);
        br_put_provenance(d, &provenance);
    }
    return br_session_finish(session, err);
}

/* A failed cell fails the run, after everything has been written. */
static enum br_status run_jobs(const struct br_study_request *request, struct br_session *session,
                               const struct br_study_job *job, size_t jobs, bool with_exact,
                               struct br_error *err)
{
    struct br_studies r = {request, session, .jobs = jobs};
    const bool writes = session->writes;
    struct br_costs work = {.together = true};
    bool failed = br_studies_prepare(&r, job, with_exact, err);
    if (!failed) {
        br_studies_estimate_cost(&r, &work);
        br_session_announce(session, &work);
        failed = br_session_open(session, err) ||
                 (writes && br_warn_of_studies(r.study, jobs, err)) ||
                 br_studies_compute(&r, err) || (writes && write_all(&r, err)) ||
                 br_studies_check_cells(&r, err);
    }
    br_studies_clear(&r);
    return failed ? err->status : BR_OK;
}

/* ---- the commands ---- */

static enum br_status run_study(const struct br_options *options, struct br_session *session,
                                struct br_error *err)
{
    const struct br_study_job job = {.scene = options->word[0]};
    struct br_study_request request;
    return br_study_request_read(options, &request, err)
               ? err->status
               : run_jobs(&request, session, &job, 1, false, err);
}

static enum br_status run_tables(const struct br_options *options, struct br_session *session,
                                 struct br_error *err)
{
    static const struct br_study_job printed[] = {
        {.name = "table1",
         .scene = "example1",
         .printed = &br_printed_table1,
         .caption = "Table 1: Example 1, stick"},
        {.name = "table2",
         .scene = "example2",
         .printed = &br_printed_table2,
         .caption = "Table 2: Example 2, slip"},
    };
    struct br_study_request request;
    return br_study_request_read(options, &request, err)
               ? err->status
               : run_jobs(&request, session, printed, sizeof printed / sizeof *printed, true, err);
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
    .example = {"study example4 -n 50,100,200 -k 0.03,0.015 --reference fine:800,1e-3",
                "study example2 --norm l2,energy,tip",
                "study example2 --set 'contact.stiffness=2e3 N/m'"},
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
    .example = {"tables --out results",
                "tables --n 100,200,400 --k 0.01,0.005 --reference fine:1600,1e-3"},
    .run = run_tables,
};
