/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A folder of results, written whole or not at all: files go to a hidden folder
 * inside it and are renamed into place at the end. */
#ifndef BR_OUTPUT_H
#define BR_OUTPUT_H

#include <stdbool.h>
#include <stdio.h>

#include "solver/status.h"

struct br_output {
    char folder[1024];  /* where the results will be */
    char staging[1088]; /* where they are being written */
    int lock;           /* of the latter */
    bool made;          /* the folder was not there before */
};

/* Makes the folder (and its parents) and the hidden one; those that were left behind in it are
 * removed. Fails with BR_BAD_INPUT
 * where that cannot be written, so call it before a long computation. */
enum br_status br_output_open(struct br_output *output, const char *folder, struct br_error *err);

/* Opens a file in the hidden folder for writing. */
enum br_status br_output_file(const struct br_output *output, const char *name, FILE **file,
                              struct br_error *err);

/* Closes a written file: fails with BR_IO if any write did (a full disk). */
enum br_status br_output_close(FILE *file, const char *name, struct br_error *err);

/* Moves all files into place. */
enum br_status br_output_commit(struct br_output *output, struct br_error *err);

/* Says on the terminal where they are. */
void br_output_announce(const struct br_output *output);

/* Removes what has not been moved, and the folder if it was made for nothing; does
 * nothing after a commit. */
void br_output_discard(struct br_output *output);

#endif
