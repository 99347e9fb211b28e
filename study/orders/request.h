/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is asked of a study of any program, by options or by a study file, and the sources of its
 * numbers: a table in a file (table.c), or a program that is run (program.c; program_reading.c: the
 * numbers in what it prints). */
#ifndef BR_STUDY_ORDERS_REQUEST_H
#define BR_STUDY_ORDERS_REQUEST_H

#include <jansson.h>

#include "study/grid/observer.h"
#include "study/orders/orders.h"

/* How a number is found in standard output. */
enum br_reading_kind {
    BR_READING_REGEX, /* POSIX extended, with one group; it must match once, within a line */
    BR_READING_JSON,  /* a pointer (RFC 6901) into the whole output */
    BR_READING_CSV,   /* a column of the last row; the first line is the heading (RFC 4180) */
};

struct br_reading {
    const char *name; /* of the quantity */
    const char *what; /* expression, pointer or heading */
    enum br_reading_kind kind;
};

/* The resolutions of one axis. */
struct br_program_axis {
    const struct br_resolution_column *column; /* NULL: it is not refined */
    const double *given;                       /* as the column has it, in any order */
    size_t count;
};

enum { BR_PROGRAM_SECONDS = 600 };

/* Begins as br_orders_request_default. Texts and arrays are owned. */
struct br_orders_request {
    char *path;            /* of the table or the study file, for messages */
    char *title;           /* one line; NULL: the path */
    char *errors, *values; /* names of columns or readings, "l2,h1", with errors, and with values
                              whose limit is not known; NULL: see below */
    double dimension;      /* of the mesh, for unknowns (dofs) */
    double formal;         /* order of values that theory gives */
    struct br_order_expectation *expectation; /* expectations */
    size_t expectations;
    char *table;      /* text of a table; NULL: none */
    char *table_path; /* of a table that a study file names; NULL: it is `path` */
    /* The command that is run; NULL: none. Words as a shell has them: blanks, '...', "...", \;
     * nothing else has a meaning. In a word, {n} is the resolution of the column n, {{ a brace. A
     * program's path with a slash, and words that name a file, are looked up in `folder`; the
     * program itself runs elsewhere. */
    char *command;
    char *folder; /* of the study file; NULL: the caller's */
    struct br_program_axis axis[BR_AXES];
    const struct br_reading *reading; /* readings */
    size_t readings;
    double seconds; /* limit of one run */
    /* borrowed, and not of a study file */
    int jobs;                           /* runs at once; 0: one a core */
    const char *kept;                   /* the folder of finished cells, made where it is missing;
                                           NULL: none */
    bool anew;                          /* cells that are kept are run, too */
    const struct br_observer *observer; /* may be NULL */
};
struct br_orders_request br_orders_request_default(void);
void br_orders_request_clear(struct br_orders_request *request);

/* ---- sources ---- */

/* Reads the numbers of the table, or of the program (out; clear them even after a failure), and
 * checks them. Fails as br_table_read, br_program_run and br_numbers_check do, or with BR_BAD_INPUT
 * where there is neither. */
enum br_status br_orders_read(const struct br_orders_request *request, struct br_numbers *numbers,
                              struct br_error *err);

/* The file that the numbers come from, for messages. */
const char *br_orders_path(const struct br_orders_request *request);

/* For sources: refuses (BR_BAD_INPUT) names of errors and values that are no quantity's, or in both
 * lists. */
enum br_status br_orders_check_lists(const struct br_orders_request *request,
                                     const struct br_numbers *numbers, struct br_error *err);

/* ---- tables ---- */

/* More rows would take long: a grid of so many is fitted in some seconds. */
enum { BR_LONGEST_TABLE = 64 << 20 /* bytes */, BR_MOST_TABLE_ROWS = 10000 };

/* Splits a text, CSV (comma) or TSV (tab), into an array of rows, the heading first; a row is an
 * array of its line and its fields, null where one is empty. Empty lines and those that begin with
 * # are left out. Fails with BR_BAD_INPUT, naming path and line, or BR_NO_MEMORY. */
enum br_status br_table_split(const char *text, const char *path, json_t *table,
                              struct br_error *err);

/* The source: CSV, TSV or JSON lines (an object a line). A heading is a name, with a unit in
 * brackets if it has one: "dt [s]". Columns are told by br_resolution_columns; where an axis has
 * several, they must agree. Without errors and values every other column of numbers is an error;
 * columns of words are left alone. An empty field is a run without a number. At most
 * BR_MOST_TABLE_ROWS rows. */
enum br_status br_table_read(const struct br_orders_request *request, struct br_numbers *numbers,
                             struct br_error *err);

/* ---- programs ---- */

/* The source. Runs each cell of the list, or of the grid of two lists, that is not kept, in a
 * folder of its own, which is removed afterwards, with LC_ALL=C and no input, and reads its
 * numbers; no shell has a part in it. All that is left of its process group ends with it. A reading
 * is an error, unless it is listed as a value.
 *
 * numbers (out; zeros after a failure): the whole grid, from coarse to fine, first over space. A
 * run that fails, prints more than 16 MiB or prints a number that is not whole and finite has a
 * row with its failure. A row's seconds count all processes that the program has waited for; its
 * bytes are of the greatest one, NaN where that is not above this process's own peak, since then
 * the kernel does not tell them apart.
 *
 * BR_BAD_INPUT: a command, list or reading is none, the program cannot be found or begun.
 * BR_INTERRUPTED: the observer says stop; runs are killed, finished cells stay kept.
 * BR_IO: no folder to run in, a cell cannot be kept, or SIGCHLD is ignored: then no ends are told.
 */
enum br_status br_program_run(const struct br_orders_request *request, struct br_numbers *numbers,
                              struct br_error *err);

/* A command at one resolution. */
struct br_command_words {
    char **word;   /* owned, as they are; a NULL at the end */
    char *program; /* absolute path; owned */
};
enum br_status br_command_split(const struct br_orders_request *request,
                                const struct br_numbers_row *row, struct br_command_words *words,
                                struct br_error *err);
void br_command_clear(struct br_command_words *words); /* accepts zeros */

/* BR_BAD_INPUT: it cannot find a number in any output. */
enum br_status br_reading_check(const struct br_reading *reading, struct br_error *err);

/* The number in an output of so many bytes and a zero. BR_BAD_INPUT: there is none, or more than
 * one; the message begins with the reading's name. */
enum br_status br_reading_take(const struct br_reading *reading, const char *output, size_t length,
                               double *number, struct br_error *err);

/* Removes a folder with all that is in it; "": none. What has just been killed may still be there
 * for a moment, and write, so it is tried for a while. */
void br_remove_folder(const char *folder);

/* ---- parts of a request, as options and study files write them ---- */

/* The list of an axis: "10,20,40", of the column n, h, dofs, k, dt or steps: positive, counts
 * whole, each once. */
enum br_status br_orders_request_axis(struct br_orders_request *request, const char *column,
                                      const char *list, struct br_error *err);

/* A reading: NAME and REGEX, json:POINTER or csv:COLUMN. */
enum br_status br_orders_request_reading(struct br_orders_request *request, const char *name,
                                         const char *what, struct br_error *err);

/* ---- study files ---- */

/* Whether a YAML text is a study file: it has 'run' or 'table' at the top; a scene has neither. */
bool br_is_study_file(const char *text);

/* Reads a study file's text; its table is looked for in its folder. Every refusal names path, line
 * and key. Fails with BR_BAD_INPUT or BR_NO_MEMORY. */
enum br_status br_orders_request_read(const char *path, const char *text,
                                      struct br_orders_request *request, struct br_error *err);

/* What is run or read, and expected, as a hash (out). */
void br_orders_problem(const struct br_orders_request *request, char problem[40]);

#endif
