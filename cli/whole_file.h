/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A file that is written whole or not at all: in memory, then to the disk under a hidden name
 * beside its place, then renamed into it. */
#ifndef BR_CLI_WHOLE_FILE_H
#define BR_CLI_WHOLE_FILE_H

#include <stdbool.h>
#include <stdio.h>

#include "solver/status.h"

/* Begins as zeros. */
struct br_whole_file {
    const char *path; /* as given; borrowed; NULL: not wanted, and all calls do nothing */
    char *place;      /* where that is, symbolic links followed; owned; NULL: standard output */
    bool renamed;     /* else it is no plain file, and written in place */
    FILE *file;       /* to be written */
    char *text;       /* size bytes: what was written; owned */
    size_t size;
};

/* Opens a file for writing; "-", or whatever else standard output is, is standard output. Fails
 * with BR_BAD_INPUT, naming the option, where it cannot be written, so call it before a long
 * computation; with BR_NO_MEMORY. Discard it even then. */
enum br_status br_whole_file_open(struct br_whole_file *whole, const char *option, const char *path,
                                  struct br_error *err);

/* Whether two open ones would end in the same place; whether one would replace a given file. */
bool br_whole_file_same(const struct br_whole_file *a, const struct br_whole_file *b);
bool br_whole_file_replaces(const struct br_whole_file *w, const char *path);

/* Whether it is that folder, which need not be there yet, or would stand in it. */
bool br_whole_file_is_in(const struct br_whole_file *file, const char *folder);

/* Puts what was written in its place. Fails with BR_IO or BR_NO_MEMORY; discard it all the same. */
enum br_status br_whole_file_commit(struct br_whole_file *whole, struct br_error *err);

/* Releases it; what has not been put in its place is lost. */
void br_whole_file_discard(struct br_whole_file *whole);

#endif
