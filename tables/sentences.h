/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a table says in words, the same in every format: plain ASCII lines. */
#ifndef BR_TABLES_SENTENCES_H
#define BR_TABLES_SENTENCES_H

#include <stdio.h>

/* Where the sentences go: one call a paragraph, without a line end. */
struct br_writer {
    void (*paragraph)(void *self, const char *text);
    void *self;
};

/* A paragraph's way to a terminal or a text file (out: a FILE): lines of at most 100 columns. */
void br_print_wrapped(void *out, const char *text);

/* How many columns a text takes there: characters, not bytes. */
int br_width_of(const char *text);

/* An underlined line. */
void br_print_caption(FILE *out, const char *caption);

/* One paragraph of at most 4095 characters; the text is a format. */
__attribute__((format(printf, 2, 3))) void br_say(const struct br_writer *w, const char *format,
                                                  ...);

#endif
