/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of others, read whole: tables, scenes, study files, baselines. */
#ifndef BR_BASE_LOAD_H
#define BR_BASE_LOAD_H

#include <stddef.h>

#include "base/status.h"
#include "base/words.h"

#define BR_STANDARD_INPUT "/dev/stdin"

/* Loads the whole text of a file, of standard input or of a pipe. *text (out): owned by the caller.
 * Fails with BR_BAD_INPUT if it is longer than `longest` bytes, is not text, or is a named pipe
 * that nothing opens for writing within some seconds; the message names what was expected, as
 * "scene". Also fails with BR_IO, BR_INTERRUPTED or BR_NO_MEMORY. */
enum br_status br_text_load(const char *path, size_t longest, const char *what, char **text,
                            struct br_error *err);

/* How the refusal of a path ends that is not there: "; did you mean 'errors.csv'?", a file of the
 * same folder, or nothing; returns text (out). */
char *br_suggest_file(const char *path, char text[BR_SUGGESTION]);

#endif
