/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a table says in words, the same in every format: plain ASCII lines. */
#ifndef BR_TABLES_SENTENCES_H
#define BR_TABLES_SENTENCES_H

#include <stdio.h>

#include "study/fit/report.h"

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

/* What was measured and how: the error, the reference, the method. */
void br_say_method(const struct br_report *report, const struct br_writer *w);

/* The fitted orders of all modelled parts, with the theory's beside them, and the tips
 * that the cells alone tell. */
void br_say_orders(const struct br_report *report, const struct br_writer *w);

/* Which cells are flagged, and why. */
void br_say_flags(const struct br_report *report, const struct br_writer *w);

/* The events at the tip, where the reference knows them, and the scene's remark; whether
 * there is any of these. */
bool br_has_events(const struct br_report *report);
void br_say_events(const struct br_report *report, const struct br_writer *w);

/* How ours and the printed values differ, and the triangle inequality. */
void br_say_printed(const struct br_report *report, const struct br_writer *w);

/* Whether a part is worth showing: with one field alone it is the total. */
bool br_part_shown(const struct br_report *report, enum br_part part);

#endif
