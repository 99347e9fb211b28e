/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A text in memory that is written as a file. The C library's open_memstream loses a write that
 * lacks memory and says nothing of it, neither by ferror nor by fclose. */
#ifndef BR_STUDY_BASE_TEXT_H
#define BR_STUDY_BASE_TEXT_H

#include <stdio.h>

/* Opens it; NULL: out of memory. fclose is 0 where all that was written is in *text (out, owned by
 * the caller): *size bytes (out) and a zero. Else *text is NULL and *size 0. */
FILE *br_text_open(char **text, size_t *size);

#endif
