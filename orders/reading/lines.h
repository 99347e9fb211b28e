/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The lines of a text, and the tokens of a line by one separator: for layout.c. */
#ifndef BR_ORDERS_READING_LINES_H
#define BR_ORDERS_READING_LINES_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

enum br_line_kind {
    BR_LINE_EMPTY, /* also rules, types of columns, commands that lay out LaTeX, "sep=;" */
    BR_LINE_COMMENT,
    BR_LINE_TEXT,
};

struct br_line {
    char *text; /* ends with a zero; has newlines in quotes only; of a comment, behind its sign */
    size_t number;
    size_t indent; /* blanks before the text */
    enum br_line_kind kind;
};

/* Cuts a text into lines, in place. Box drawing becomes bars (BR_BOX_BAR) and dashes, blanks of any
 * kind are blanks. A LaTeX line ends at "\\". Fails with BR_BAD_INPUT where a quote is open to the
 * end. */
enum { BR_BOX_BAR = '\x01' };
enum br_status br_lines_cut(char *text, const char *path, struct br_store *store,
                            struct br_line **line, size_t *count, struct br_error *err);

/* Makes lines of the tables of HTML in a text (in, out: then in the store), if there are any: rows
 * as LaTeX has them, and comments. Fails with BR_NO_MEMORY. */
enum br_status br_markup_flatten(char **text, struct br_store *store, struct br_error *err);

/* Joins the lines of each run of a log to one, where its size and its errors have lines of their
 * own (log.c). Fails with BR_NO_MEMORY. */
enum br_status br_log_fold(struct br_line *line, size_t lines, struct br_store *store,
                           struct br_error *err);

/* The first three are sentences, with a name before each number: "N = 8: error 0.1". Those of pairs
 * have values behind signs, which may be words: "h = 0.1  m = P1", "n: 8, e: 0.1". */
enum br_separator {
    BR_BY_WORDS,
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

enum br_content { BR_NOTHING, BR_MISSING, BR_NUMBER, BR_WORD, BR_BROKEN /* text behind a quote */ };

/* A token of a line, without its quotes and the blanks around it. */
struct br_token {
    char *text;
    const char *name; /* of a pair, or NULL */
    enum br_content content;
};

/* Splits a line, with this mark of decimals; room (out) has BR_ROOM(line) bytes for the tokens.
 * Returns their number, at most BR_MOST_COLUMNS + 2; 0: there are no pairs. */
#define BR_ROOM(line) (3 * strlen(line) + 4)
size_t br_line_split(const char *line, enum br_separator by, char mark, char *room,
                     struct br_token *token);

/* The same of any line, as a sentence, up to a value without a name; *whole (out): there is none.
 */
size_t br_line_stated(const char *line, enum br_separator by, char mark, char *room,
                      struct br_token *token, bool *whole);

/* ---- names by where they stand ---- */

/* Characters of a line, from begin to end. */
struct br_span {
    size_t begin, end;
};

/* Widens the spans of all columns by those of a row; they begin as zero. False: the row has another
 * number of words. */
bool br_spans_widen(struct br_span *span, size_t columns, const struct br_line *row);

/* Names each column that is not skipped by the words of the heading that stand above it; room (out)
 * has BR_ROOM(heading) bytes. False: the columns are not aligned, each word has a column of its
 * own, or a word or a column has none. */
bool br_names_above(const struct br_line *heading, const struct br_span *span, const bool *skipped,
                    size_t columns, char *room, const char **name);

#endif
