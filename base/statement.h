/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A request in words: all that its numbers follow from, as one text. Cached work belongs to such
 * a text (base/cache.h), and ranks compare theirs.
 *
 * A line for each thing: its name, the bytes of its value, and the value. So two requests have the
 * same text only where all values are the same. */
#ifndef BR_BASE_STATEMENT_H
#define BR_BASE_STATEMENT_H

#include <stdbool.h>
#include <stdio.h>

struct br_statement {
    FILE *file;
    char *text;
    size_t size;
    bool everywhere; /* set it behind the beginning: the same text on every machine: numbers to nine
                        digits, since the last ones may differ, and no instruction set */
    bool failed;     /* it lacked memory, or a function of the scene is no expression */
};

/* Begins *statement (out), which is not to be moved. The end returns the text, owned by the caller,
 * or NULL. */
void br_statement_begin(struct br_statement *statement);
char *br_statement_end(struct br_statement *statement);

/* One line. */
__attribute__((format(printf, 3, 4))) void br_state(struct br_statement *statement,
                                                    const char *name, const char *format, ...);

#endif
