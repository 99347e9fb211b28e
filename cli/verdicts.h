/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a command with verdicts writes: the terminal's report, a file for each format that an option
 * names, and a comparison with an earlier check, the baseline. */
#ifndef BR_CLI_VERDICTS_H
#define BR_CLI_VERDICTS_H

#include "cli/session.h"
#include "orders/expectation/comparison.h"
#include "orders/request.h"
#include "tables/reports.h"

/* The files of a command: one for each format that has an option, and the baseline. */
enum { BR_VERDICT_FILES = 8 };

/* Begins as zeros. */
struct br_verdicts {
    const char *compare; /* --compare; NULL: not given, or there is none yet */
    struct br_whole_file file[BR_VERDICT_FILES], baseline;
    struct br_old_check old;
    struct br_comparison comparison;
};

/* Prepares the reports before a long computation: reads the baseline, and refuses one of other
 * problems; opens the files. Two of them must not be the same, and none may replace a file that is
 * read. Fails with BR_BAD_INPUT, BR_NO_MEMORY. Clear it even then. */
enum br_status br_verdicts_open(struct br_verdicts *verdicts, const struct br_options *options,
                                const struct br_check *checks, size_t count, struct br_error *err);

/* Fails with BR_BAD_INPUT if one of them would replace this file; NULL: none. */
enum br_status br_verdicts_spare(const struct br_verdicts *verdicts, const char *path,
                                 struct br_error *err);

/* Builds the report of the verdicts, the session's last, finishes the session and writes the files;
 * if one of them is standard output, no report is shown there. findings: without comparison and
 * provenance. whole: all scenes were checked (--all). Fails as br_session_finish, br_document_print
 * and br_whole_file_commit; then, when all is written, with BR_VERDICT where not all passed or the
 * comparison is serious, and BR_BAD_INPUT where something could not be verified. */
enum br_status br_verdicts_finish(struct br_verdicts *verdicts, struct br_session *session,
                                  const struct br_check_findings *findings, bool whole,
                                  struct br_error *err);

/* Finishes the session and writes its last report to the files; if one of them is standard output,
 * no report is shown there. findings: of that report, for its picture; NULL: it has none. */
enum br_status br_verdicts_write(struct br_verdicts *verdicts, struct br_session *session,
                                 const struct br_check_findings *findings, struct br_error *err);

void br_verdicts_clear(struct br_verdicts *verdicts);

/* ---- study files of any program: read, trusted, and checked ---- */

/* One study: its request, numbers and orders. Begins as zeros. */
struct br_study_file {
    struct br_orders_request request;
    struct br_numbers numbers;
    struct br_orders orders;
};
void br_study_file_clear(struct br_study_file *file);

/* Reads a study file's text. One that has a command is refused (BR_BAD_INPUT) among several ranks,
 * and, with the command, unless --trust is given; and so is one with a table outside its folder.
 * Clear it even then. */
enum br_status br_study_file_read(const char *path, const char *text,
                                  const struct br_options *options, struct br_study_file *file,
                                  struct br_error *err);

/* Reads a study file, which ends in .yaml or .yml, or else a table; "-": of standard input. Fails
 * as br_text_load and br_study_file_read do; clear it even then. */
bool br_is_yaml(const char *path);
enum br_status br_study_file_open(const char *path, const struct br_options *options,
                                  struct br_study_file *file, struct br_error *err);

/* Applies the options for its runs; returns the check for its verdicts, with its path, name and
 * problem. */
struct br_check br_study_file_check(struct br_study_file *file, const struct br_options *options);

/* Gets the numbers, finds the orders, and fills the check's cases. Fails as
 * br_orders_read, br_orders_find and br_orders_check do. */
enum br_status br_study_file_run(struct br_study_file *file, struct br_check *check,
                                 struct br_error *err);

#endif
