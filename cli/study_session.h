/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The studies behind `study` and `tables`: from jobs and options to finished reports. */
#ifndef BR_CLI_STUDY_SESSION_H
#define BR_CLI_STUDY_SESSION_H

#include "cli/study_request.h"
#include "cli/study_run.h"
#include "study/fit/report.h"

/* A job on its way. */
struct br_work {
    char path[1024]; /* the scene's file */
    char *text;      /* its contents */
    struct br_scene scene;
    size_t *n, *steps;   /* the grid */
    struct br_tips tips; /* only without a reference */
};

/* A report with its name and caption. */
struct br_page {
    struct br_report report;
    char name[512], caption[512];
};

struct br_session {
    struct br_study_request request;
    struct br_work *work;   /* jobs */
    struct br_page *page;   /* pages, those of a job together */
    struct br_study *study; /* heads * norms, in the first norm first, which br_study_run takes */
    size_t jobs, pages;
    size_t heads; /* jobs, or twice that: each job, then each against the exact solution, or
                     without a reference over h, then over k */
};

/* Reads the options and the jobs' scenes and lays out studies and reports. Fails with
 * BR_BAD_INPUT or BR_NO_MEMORY; clear the session even then. */
enum br_status br_session_prepare(struct br_session *session, const struct br_study_job *jobs,
                                  size_t count, const struct br_options *options, bool with_exact,
                                  struct br_error *err);
void br_session_clear(struct br_session *session);

/* Marches and fits; quiet: without progress. Fails as br_study_run does. */
enum br_status br_session_compute(struct br_session *session, bool quiet, struct br_error *err);

/* The job that a page belongs to. */
const struct br_work *br_session_work(const struct br_session *session, size_t page);

/* Study h of the heads in norm m. */
struct br_study *br_session_study(const struct br_session *session, size_t h, size_t m);

#endif
