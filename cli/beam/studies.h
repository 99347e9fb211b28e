/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Studies from the options to finished reports: shared by `study` and `tables`. */
#ifndef BR_CLI_BEAM_STUDIES_H
#define BR_CLI_BEAM_STUDIES_H

#include "cli/beam/session.h"
#include "cli/beam/study_request.h"
#include "reference/printed.h"
#include "study/fit/grid_differences.h"

/* One study: a scene, and the printed table to compare it with, if any. */
struct br_study_job {
    const char *name;                 /* of the result files; NULL: the scene's */
    const char *scene;                /* a file, or a bundled scene */
    const struct br_printed *printed; /* the paper's table, or NULL */
    const char *caption;              /* NULL: the scene's title */
};

/* What is computed for a job. */
struct br_study_work {
    struct br_opened_scene opened;
    size_t *steps; /* numbers of steps of the grid, ascending; owned */
    struct br_grid_differences compared;
    char name[BR_MOST_NORMS][512];          /* of the reports */
    char *caption[BR_MOST_NORMS];           /* the same; owned */
    struct br_report report[BR_MOST_NORMS]; /* request.norms of them */
};

struct br_studies {
    const struct br_study_request *request; /* borrowed */
    struct br_session *session;             /* borrowed */
    size_t jobs;
    struct br_study_work *work; /* jobs */
    size_t cases;               /* jobs, or 2 * jobs: each against its reference, then each against
                                   the exact solution */
    struct br_study *study;     /* cases * norms: those in the first norm come first */
};

/* Sets up the jobs; request, session and jobs are set before. with_exact: a fine reference is
 * followed by the exact one. Fails with BR_BAD_INPUT or BR_NO_MEMORY; clear the studies even then.
 */
enum br_status br_studies_prepare(struct br_studies *studies, const struct br_study_job *job,
                                  bool with_exact, struct br_error *err);
void br_studies_clear(struct br_studies *studies);

void br_studies_estimate_cost(const struct br_studies *studies, struct br_costs *work);

/* Marches all and finishes the reports. */
enum br_status br_studies_compute(struct br_studies *studies, struct br_error *err);

/* Fails with BR_NOT_FINITE where cells have failed. */
enum br_status br_studies_check_cells(const struct br_studies *studies, struct br_error *err);

#endif
