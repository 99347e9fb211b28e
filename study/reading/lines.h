/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The lines of a text, and the pieces of a line by one separator: for layout.c. */
#ifndef BR_STUDY_READING_LINES_H
#define BR_STUDY_READING_LINES_H

#include <stdbool.h>
#include <stddef.h>

#include "solver/status.h"

enum br_line_kind {
    BR_LINE_EMPTY, /* also rules, types of columns, commands that lay out LaTeX, "sep=;" */
    BR_LINE_COMMENT,
    BR_LINE_TEXT,
};

struct br_line {
    char *text; /* ends with a zero; has newlines in quotes only; of a comment, behind its sign */
    size_t number;
    enum br_line_kind kind;
};

/* Cuts a text into lines, in place. Box drawing becomes bars (BR_BOX_BAR) and dashes, blanks of any
 * kind are blanks. A LaTeX line ends at "\\". Fails with BR_BAD_INPUT where a quote is open to the
 * end. */
enum { BR_BOX_BAR = '\x01' };
enum br_status br_lines_cut(char *text, const char *path, struct br_store *store,
                            struct br_line **line, size_t *count, struct br_error *err);

/* Pairs: "h = 0.1  e = 0.2", "n: 8, e: 0.1". */
enum br_separator {
    BR_BY_EQUALS,
    BR_BY_COLONS,
    BR_BY_TABS,
    BR_BY_LONE_BARS, /* with a blank on each side: others stand in names, ||u|| */
    BR_BY_BARS,
    BR_BY_AMPERSANDS,
    BR_BY_SEMICOLONS,
    BR_BY_COMMAS,
    BR_BY_WIDE_BLANKS, /* two or more */
    BR_BY_BLANKS,
    BR_SEPARATORS
};

/* A piece of a line, with its quotes and without the blanks around it. */
struct br_piece {
    char *text, *name; /* name: of a pair, or NULL */
    size_t length, name_length;
};

/* Splits a line; returns the number of pieces, at most BR_MOST_COLUMNS + 1; 0: there are no pairs.
 */
size_t br_line_split(char *line, enum br_separator by, struct br_piece *piece);

/* Ends a piece with a zero, in place, and takes its quotes away; "": it is empty; NULL: there is
 * text behind a quote. */
char *br_piece_close(const struct br_piece *piece, enum br_separator by);

#endif
