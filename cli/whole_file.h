/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A file that is written whole or not at all: beside its place first, then renamed into it. */
#ifndef BR_WHOLE_FILE_H
#define BR_WHOLE_FILE_H

#include <stdio.h>

#include "solver/status.h"

struct br_whole_file {
    const char *path;   /* borrowed; NULL: not wanted, and all calls do nothing */
    char staging[4096]; /* where it is being written; "": in place, being no plain file */
    FILE *file;
};

/* Opens a file for writing; "-" is standard output. Fails with BR_BAD_INPUT, naming the option,
 * where it cannot be written, so call it before a long computation. */
enum br_status br_whole_file_open(struct br_whole_file *whole, const char *option, const char *path,
                                  struct br_error *err);

/* Puts what was written in its place. Fails with BR_IO; discard it all the same. */
enum br_status br_whole_file_commit(struct br_whole_file *whole, struct br_error *err);

/* Removes what has not been put in its place; does nothing after a commit. */
void br_whole_file_discard(struct br_whole_file *whole);

#endif
