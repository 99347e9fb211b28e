/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A file that is written whole or not at all: beside its place first, then renamed into it. */
#ifndef BR_WHOLE_FILE_H
#define BR_WHOLE_FILE_H

#include <stdbool.h>
#include <stdio.h>

#include "solver/status.h"

struct br_whole_file {
    const char *path;   /* as given; borrowed; NULL: not wanted, and all calls do nothing */
    char *place;        /* where that is, symbolic links followed; owned; NULL: standard output */
    char staging[4096]; /* where it is being written; "": in place, being no plain file */
    FILE *file;
};

/* Opens a file for writing; "-", or whatever else standard output is, is standard output. Fails
 * with BR_BAD_INPUT, naming the option, where it cannot be written, so call it before a long
 * computation. Discard it even then. */
enum br_status br_whole_file_open(struct br_whole_file *whole, const char *option, const char *path,
                                  struct br_error *err);

/* Whether two open ones would end in the same place; whether one would replace a given file. */
bool br_whole_file_same(const struct br_whole_file *a, const struct br_whole_file *b);
bool br_whole_file_replaces(const struct br_whole_file *whole, const char *path);

/* Whether it is that folder, which need not be there yet, or would stand in it. */
bool br_whole_file_is_in(const struct br_whole_file *file, const char *folder);

/* Puts what was written in its place. Fails with BR_IO; discard it all the same. */
enum br_status br_whole_file_commit(struct br_whole_file *whole, struct br_error *err);

/* Removes what has not been put in its place, and releases the rest. */
void br_whole_file_discard(struct br_whole_file *whole);

#endif
