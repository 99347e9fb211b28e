/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A source of numbers: a table in a file. */
#ifndef BR_STUDY_ORDERS_TABLE_H
#define BR_STUDY_ORDERS_TABLE_H

#include "study/orders/numbers.h"

/* How a table is to be read. Strings are borrowed. */
struct br_table_request {
    const char *path;   /* for messages */
    const char *errors; /* names of columns with errors, "l2,h1"; NULL: see below */
    const char *values; /* names of columns with values whose limit is not known; NULL: none */
    double dimension;   /* of the mesh, for unknowns (dofs) */
};

/* More rows would take long: a grid of so many is fitted in some seconds. */
enum { BR_LONGEST_TABLE = 64 << 20 /* bytes */, BR_MOST_TABLE_ROWS = 10000 };

/* The text of a file (to be freed by the caller). Fails with BR_BAD_INPUT where it cannot be read,
 * is longer than BR_LONGEST_TABLE or has a zero byte, with BR_IO or BR_NO_MEMORY. */
enum br_status br_table_load(const char *path, char **text, struct br_error *err);

/* Reads a text: CSV (comma), TSV (tab), both with a heading, or JSON lines (an object a line). A
 * heading is a name, with a unit in brackets if it has one: "dt [s]". Columns are told by
 * br_resolution_columns; where an axis has several, they must agree. Without errors and values
 * every other column of numbers is an error; columns of words are left alone. An empty field is a
 * run without a number. At most BR_MOST_TABLE_ROWS rows. *numbers (out); clear it even after a
 * failure. Fails with BR_BAD_INPUT, naming line and column, or BR_NO_MEMORY. */
enum br_status br_table_read(const char *text, const struct br_table_request *request,
                             struct br_numbers *numbers, struct br_error *err);

#endif
