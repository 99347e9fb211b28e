/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Texts from outside, such as file names, which may hold any bytes. */
#ifndef BR_PLAIN_TEXT_H
#define BR_PLAIN_TEXT_H

#include <stddef.h>
#include <stdio.h>

/* The length of the UTF-8 sequence at text, 0 where it is none that XML allows. */
size_t br_utf8_length(const unsigned char *text);

/* Prints text on one line: control characters become blanks, what is not UTF-8 '?'. */
void br_print_plain(FILE *out, const char *text);

/* A paragraph to the file `out`, wrapped at 100 columns, continued lines indented by two: a
 * br_writer's function (sentences.h). */
void br_print_wrapped(void *out, const char *text);

#endif
