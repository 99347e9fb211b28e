/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What `study` and `tables` share: run studies at once, show and write their reports. */
#ifndef BR_CLI_STUDY_RUN_H
#define BR_CLI_STUDY_RUN_H

#include <stdbool.h>

#include "cli/option.h"

/* One study: a scene, and the printed table to hold it against, if any. */
struct br_study_job {
    const char *name;    /* of the result files; NULL: the scene's */
    const char *scene;   /* a file, or a bundled scene */
    const char *printed; /* a data file below the data folder, or NULL */
    const char *caption; /* NULL: the scene's title */
};

/* Runs the jobs, prints their tables and writes all results into the folder of --out.
 * with_exact: a fine reference gets the exact one beside it.
 * Fails with the status of what failed; a failed cell is BR_NOT_FINITE, after
 * everything has been written. */
enum br_status br_study_run_jobs(const struct br_study_job *jobs, size_t count,
                                 const struct br_options *options, bool with_exact,
                                 struct br_error *err);

#endif
