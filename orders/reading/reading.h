/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a stranger's table means. First its text becomes fields (layout.c, json.c), then evidence
 * says which column is what (evidence.c, roles.c): no heading, separator or order decides alone. */
#ifndef BR_ORDERS_READING_READING_H
#define BR_ORDERS_READING_READING_H

#include <stdbool.h>
#include <stddef.h>

#include "base/observer.h"
#include "base/status.h"

/* ---- fields: a table without a meaning ---- */

/* A line of the source that is in no row: a title, a footer, "Overall 2.0". */
struct br_left_line {
    size_t line;
    const char *text; /* one line, without the blanks around it */
    const char *why;  /* "title", "footer", "comment", "summary", "between rows" ...; static */
};

struct br_fields {
    size_t rows, columns;
    const char **heading; /* columns: NULL, it has no name */
    const char **field; /* rows x columns, row after row, without the blanks and quotes around them,
                           as the source has them; NULL: empty */
    size_t *line;       /* rows: of the source; 0: it has no lines */
    size_t heading_line;       /* 0: there is no heading */
    bool *is_words;            /* columns: the types of the source say that it has no numbers */
    char mark;                 /* of decimals: '.' or ',' */
    struct br_left_line *left; /* lefts, from top to bottom */
    size_t lefts, left_room;
    struct br_store store; /* of all that is pointed to */
};

/* In a table; a row without its heading. A report takes 20 microseconds for each field. */
enum {
    BR_LONGEST_TABLE = 64 << 20, /* bytes */
    BR_MOST_COLUMNS = 1000,
    BR_MOST_FIELDS = 40000,
    BR_MOST_TABLE_ROWS = 10000,
};

/* Splits a text into fields (out; clear them even after a failure). Fails with BR_BAD_INPUT, naming
 * path and line, also beyond the limits above; with BR_INTERRUPTED by the observer,
 * which may be NULL; or with BR_NO_MEMORY. */
enum br_status br_fields_read(const char *text, const char *path,
                              const struct br_observer *observer, struct br_fields *fields,
                              struct br_error *err);
void br_fields_clear(struct br_fields *fields); /* accepts zeros */

/* Names a text that is in no row (in the store of fields, which may fail). */
void br_fields_leave(struct br_fields *fields, size_t line, const char *text, const char *why);
/* Whether a line says that a run failed: "solver diverged". */
bool br_says_failure(const char *line);

/* Whether a text is meant to be JSON (json.c, for br_fields_read). */
bool br_json_is_table(const char *text);

/* Takes the fields of records, columns, lines of records, the orients of pandas, or an object
 * around one of them. Fails as br_fields_read does. */
enum br_status br_json_fields(const char *text, const char *path, struct br_fields *fields,
                              struct br_error *err);

/* Finds the lists of a program, or of its output, and makes JSON of them (json, out, in the store
 * of fields; NULL: there are none). Lists that are no columns go to fields->left. Fails with
 * BR_BAD_INPUT where a line changes a list, or BR_NO_MEMORY. */
enum br_status br_lists_find(const char *text, const char *path, struct br_fields *fields,
                             const char **json, struct br_error *err);

/* ---- numbers in fields ---- */

struct br_field_number {
    double value;
    double deviation; /* of "1.2 +- 0.1", "1.2(1)"; NaN: none is given */
    double of_power;  /* of "1.2(1)" where others of the column are "1.2(-1)": 12; NaN */
};

/* Whether a field has no number: empty (NULL), "-", "nan", "inf", stars. */
bool br_field_is_missing(const char *text);

/* Reads a number as tables have it, with this mark of decimals: 1.5D-3, 1.5-103,
 * 1.5(-3), $1.5\times10^{-3}$, 3/8, pi/8, 2^-4, 8x8, 5 %. Dates, times and versions are words. */
bool br_field_read(const char *text, char mark, struct br_field_number *number);

#endif
