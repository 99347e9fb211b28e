/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The two halves of `run`: what its command line says of a scene, and the files that it writes. */
#ifndef BR_CLI_RUN_H
#define BR_CLI_RUN_H

#include "cli/option.h"
#include "cli/output.h"
#include "study/foresee/prediction.h"
#include "study/run/run.h"
#include "tables/fields_file.h"
#include "tables/reports.h"

/* ---- run_plan.c ---- */

struct br_run_plan {
    struct br_method method;
    size_t n, steps, stride;
    unsigned wanted; /* see study/run/run.h */
    size_t *level;   /* levels, ascending; owned; the output times */
    size_t levels;
};

/* Checks the options against the scene. Fails with BR_BAD_INPUT, naming the option, what was found
 * and what was expected; clear the plan even then. */
enum br_status br_run_plan_make(const struct br_options *options, const struct br_scene *scene,
                                struct br_run_plan *plan, struct br_error *err);
void br_run_plan_clear(struct br_run_plan *plan);

/* ---- run_files.c ---- */

/* The files of --out: the tip's history and the fields, written while it marches, and its summary.
 * They are put in place together, also where a march stopped early. */
struct br_run_files {
    struct br_output output;
    const struct br_scene *scene; /* as it is marched; borrowed */
    FILE *history;
    const struct br_fields_format *format;
    struct br_fields_file *fields;
    char path[2048]; /* of the fields */
};

/* Opens them in a folder. request->path is not needed. Fails with BR_BAD_INPUT, BR_IO,
 * BR_NO_MEMORY; discard them even then. */
enum br_status br_run_files_open(struct br_run_files *files, const char *folder,
                                 const struct br_fields_request *request, struct br_error *err);

/* An observer that writes them; they must outlive the march. */
struct br_history_observer br_run_files_observer(struct br_run_files *files);

/* Writes the summary, and puts all in place. stopped: why the march did not reach T; NULL: it did.
 * Fails with BR_IO or BR_NO_MEMORY. */
enum br_status br_run_files_commit(struct br_run_files *files, const struct br_document *summary,
                                   const char *stopped, struct br_error *err);
void br_run_files_discard(struct br_run_files *files);

#endif
