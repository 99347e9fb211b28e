/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Study files of any program on the command line: read, trusted, and checked. */
#ifndef BR_CLI_STUDY_FILE_H
#define BR_CLI_STUDY_FILE_H

#include "cli/option.h"
#include "study/orders/request.h"

/* What belongs to one study: its request, numbers and orders. Begins as zeros. */
struct br_study_file {
    struct br_orders_request request;
    struct br_numbers numbers;
    struct br_orders orders;
};
void br_study_file_clear(struct br_study_file *file);

/* Reads a study file's text. One that has a command is refused (BR_BAD_INPUT), with the command,
 * unless --trust is given, or was once for the same text. Clear it even then. */
enum br_status br_study_file_read(const char *path, const char *text,
                                  const struct br_options *options, struct br_study_file *file,
                                  struct br_error *err);

/* Takes what the options say of its runs; returns the check that will hold its verdicts, with its
 * path, name and problem. */
struct br_check br_study_file_check(struct br_study_file *file, const struct br_options *options);

/* Gets the numbers, finds the orders, and fills the check's cases. Fails as
 * br_orders_read, br_orders_find and br_orders_check do. */
enum br_status br_study_file_run(struct br_study_file *file, struct br_check *check,
                                 struct br_error *err);

#endif
