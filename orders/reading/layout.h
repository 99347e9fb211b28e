/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The lines of a table, each split as the table is: for layout.c, line_kinds.c and heading_line.c.
 */
#ifndef BR_ORDERS_READING_LAYOUT_H
#define BR_ORDERS_READING_LAYOUT_H

#include "orders/reading/lines.h"
#include "orders/reading/roles.h"

struct row {
    struct br_token *token;
    size_t count;          /* of tokens */
    size_t numbers, words; /* of tokens that are neither missing nor empty */
    bool is_row, is_used;
};

enum { WIDEST = BR_MOST_COLUMNS + 3 /* tokens */, SAMPLE = 100 /* lines at each end */ };

struct layout {
    const char *path;
    const struct br_observer *observer;
    struct br_error *err;
    struct br_fields *fields;
    struct br_line *line;
    struct row *row; /* by line */
    size_t lines;
    char *room; /* for the longest line */
    enum br_separator by;
    size_t width, rows;
    size_t first, last;            /* rows, as lines */
    bool has_failed;               /* one of them is a run that failed */
    struct br_token token[WIDEST]; /* of the last line that was split */
    const char *field[WIDEST];     /* by column: what the last line states that is no row; NULL */
    long gain[WIDEST];             /* by width: how well it explains the lines */
    size_t names[WIDEST];          /* by width: lines without a number */
    bool skipped[WIDEST];          /* by column: the heading has no name of it */
    size_t has_number[WIDEST];     /* by column: the rows that have one there, or a missing one */
};

/* ---- the way to separate fields ---- */

/* Splits a line into l->token. Empty tokens behind the width are none. */
struct row br_layout_look_at(struct layout *l, size_t line, char *room);

/* Counts a row; refuses it beyond the limits. */
enum br_status br_layout_count_row(struct layout *l, size_t line);

/* Says what each line is (line_kinds.c): finds the rows and the heading. Refuses what is no row
 * between rows, or has numbers that are no row: it may be a second table. */
enum br_status br_layout_find_kinds(struct layout *l);

/* Finds the names of the columns (heading_line.c). Refuses a line above the rows that has another
 * number of names. */
enum br_status br_layout_find_heading(struct layout *l);

/* The next line of text above (step -1) or below one; l->lines: there is none. */
size_t br_layout_next_text(const struct layout *l, size_t line, int step);

/* Whether a line has numbers only, fewer than a row. */
bool br_layout_is_short(const struct layout *l, size_t line);

/* Whether a line is a row of the fields; it may be short. */
bool br_layout_is_row(const struct layout *l, size_t line);

/* Refuses a row of another number of fields than those it should be like. */
enum br_status br_layout_refuse_row(const struct layout *l, size_t line, const char *like);

/* Names all lines that are in no row, but comments at the top. */
void br_layout_leave_lines(const struct layout *l);

static inline bool br_layout_is_rate(const char *name)
{
    const enum br_kind kind = br_kind_of(name);
    return kind == BR_KIND_RATE || kind == BR_KIND_FACTOR;
}

#endif
