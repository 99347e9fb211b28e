/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The request of a study of any program, from options or from a study file, and the sources of its
 * numbers: a table in a file (table.c), or a program that is run (program.c; program_reading.c
 * reads the numbers in its output). */
#ifndef BR_ORDERS_REQUEST_H
#define BR_ORDERS_REQUEST_H

#include <jansson.h>

#include "base/observer.h"
#include "orders/orders.h"
#include "orders/reading/reading.h"

/* How a number is found in what a run prints, or in a file that it writes. */
enum br_reading_kind {
    BR_READING_REGEX, /* POSIX extended, with one group; it must match once, within a line */
    BR_READING_JSON,  /* a pointer (RFC 6901) into the output */
    BR_READING_CSV,   /* a column of the last row; the first line is the heading (RFC 4180) */
};

struct br_reading {
    const char *name; /* of the quantity; that of a resolution: the run states its own */
    const char *what; /* expression, pointer or heading */
    enum br_reading_kind kind;
    const char *file; /* in the folder of the run; NULL: what it prints */
    bool complaints;  /* what it prints on standard error */
    bool last;        /* the last match counts, else there must be one */
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
    char *errors, *values; /* columns or readings, "l2,h1", with errors, and with values without a
                              known limit; NULL: see the sources */
    char *columns;         /* of a table, "dx=h, 3=l2": heading or position, and name; NULL: none */
    char *where;           /* of a table, "method=P1": the rows that are read; NULL: all */
    double dimension;      /* of the mesh, for unknowns (dofs) and cells: br_orders_dimension */
    bool assumed_dimension; /* nobody stated it */
    double formal;          /* the order of theory for values; 0: nobody stated it */
    double finest;          /* so many of the finest sizes along each axis have a part; 0: all */
    char *without;          /* sizes that have none, "8, n=16"; NULL: none */
    struct br_order_expectation *expectation; /* expectations */
    size_t expectations;
    char *table;           /* text of a table; NULL: none */
    char *table_path;      /* of a table that a study file names; NULL: the table is in `path` */
    bool table_is_outside; /* of the study file's folder: messages would quote a file of anybody */
    /* The command that is run; NULL: none. Its words are those of a shell, with quotes, ~ and
     * $VARIABLES, but without patterns and commands. In a word, {n} is the resolution of the column
     * n, and {{ is a brace. A program's path with a slash, and words that name a file, are relative
     * to `folder`; the program itself runs in another one. */
    char *command;
    char *folder; /* of the study file; NULL: the current one */
    struct br_program_axis axis[BR_AXES];
    const struct br_reading *reading; /* readings */
    size_t readings, room;
    double seconds;   /* limit of one run */
    double repeat;    /* runs of each cell, whose mean counts; {repeat} is 1, 2, ... */
    const char *cost; /* of a trade: columns of costs are read, this one too, and runs are repeated
                         until the median of their times is known; "": the usual ones; NULL: not */
    /* borrowed; a study file does not set them */
    int jobs;                           /* runs at once; 0: one a core */
    const char *cache;                  /* the folder of finished cells, made where it is missing;
                                          NULL: none */
    bool anew;                          /* whether cached cells are run again */
    const struct br_observer *observer; /* may be NULL */
};
struct br_orders_request br_orders_request_default(void);
void br_orders_request_clear(struct br_orders_request *request);

/* ---- sources ---- */

/* Reads the numbers of the table, or of the program (out; clear them even after a failure), and
 * checks them. Fails as br_table_read, br_program_run and br_numbers_check do. */
enum br_status br_orders_read(const struct br_orders_request *request, struct br_numbers *numbers,
                              struct br_error *err);

/* Gives BR_FLAG_BY_HAND to the numbers outside of the request's window, which then have no part in
 * orders, limits and verdicts (window.c, for br_orders_read). Fails with BR_NO_MEMORY, or with
 * BR_BAD_INPUT for a size that is not there, or where too few sizes are left. */
enum br_status br_orders_window(const struct br_orders_request *request, struct br_numbers *numbers,
                                struct br_error *err);

/* The file that the numbers come from, for messages. */
const char *br_orders_path(const struct br_orders_request *request);

/* For sources, before a program is run: refuses (BR_BAD_INPUT) errors, values and expectations that
 * name no quantity, names in both lists, and expectations for an axis that is not refined, or of
 * numbers that are not settled. known[count]: all names that a list may have. */
enum br_status br_orders_check_lists(const struct br_orders_request *request,
                                     const struct br_numbers *numbers, const char *const *known,
                                     size_t count, struct br_error *err);

/* The dimension of the mesh whose unknowns or cells a column counts: where nobody stated it, 2, but
 * 1 for cells, which many count along one side. */
double br_orders_dimension(const struct br_orders_request *request,
                           const struct br_resolution_column *column);

/* ---- tables ---- */

/* The source: a table (orders/reading/roles.h says how it is read). Without errors and values in
 * the request, every column that falls as errors do is an error. Where a column tells several
 * studies apart, each of its errors is a quantity of its own, "L2 [method = P1]". A field that is
 * empty,
 * "-", "nan" or "***" is a run without a number. numbers->taken (out) says what was taken for what.
 */
enum br_status br_table_read(const struct br_orders_request *request, struct br_numbers *numbers,
                             struct br_error *err);

/* ---- programs ---- */

/* The source. Runs each cell of the list, or of the grid of two lists, that is not cached, and
 * reads its numbers. A cell runs without a shell, in a folder of its own, which is removed
 * afterwards, with LC_ALL=C and no input. When it ends, all that it has started is killed
 * (process.h). A reading is an error, unless it is listed as a value.
 *
 * numbers (out; zeros after a failure): the whole grid, from coarse to fine, first over space. A
 * run that fails, prints more than 16 MiB or prints a number that is not whole and finite has a
 * row with its failure. A row's seconds include all processes that the program has waited for; its
 * bytes are those of the largest one, NaN where they are not above this process's own peak, since
 * the kernel's number includes that.
 *
 * BR_BAD_INPUT: a command, list or reading is not valid, the program cannot be found or started.
 * BR_INTERRUPTED: the observer stops it; runs are killed, finished cells stay cached.
 * BR_IO: no folder to run in, or a cell cannot be cached. */
enum br_status br_program_run(const struct br_orders_request *request, struct br_numbers *numbers,
                              struct br_error *err);

/* A command at one resolution. */
struct br_command_words {
    char **word;   /* owned; ends with NULL */
    char *program; /* absolute path; owned */
    char **file;   /* files, by reading that looks into one: its name in the run's folder; owned */
    size_t files;
};
enum br_status br_command_split(const struct br_orders_request *request,
                                const struct br_numbers_row *row, struct br_command_words *words,
                                struct br_error *err);
void br_command_clear(struct br_command_words *words); /* accepts zeros */

/* Runs a command and reads the numbers of the row (out), or sets its failure. Fails as
 * br_program_run. */
enum br_status br_run_command(const struct br_orders_request *request,
                              const struct br_command_words *words, struct br_numbers_row *row,
                              struct br_error *err);

/* A run without numbers: it failed for this reason (format). */
__attribute__((format(printf, 4, 5))) enum br_status br_run_failed(
    const struct br_orders_request *request, struct br_numbers_row *row, struct br_error *err,
    const char *format, ...);

/* BR_BAD_INPUT: the reading is not valid, so it finds no number in any output. */
enum br_status br_reading_check(const struct br_reading *reading, struct br_error *err);

/* The number that a request's reading finds in an output of `length` bytes and a zero.
 * BR_BAD_INPUT: there is none, or more than one, or the search takes longer than a run may; the
 * message begins with the name of the reading. BR_INTERRUPTED: the request's observer stops it. */
enum br_status br_reading_take(const struct br_orders_request *request, size_t reading,
                               const char *output, size_t length, double *number,
                               struct br_error *err);

/* ---- items of a request, as options and study files write them ---- */

/* The list of an axis, "10,20,40", for the column n, h, dofs, cells, level, k, dt or steps.
 * Numbers are positive, but the first level may be 0; each is there once; counts are whole. */
enum br_status br_orders_request_axis(struct br_orders_request *request, const char *column,
                                      const char *list, struct br_error *err);

/* A reading: NAME and REGEX, last:REGEX, json:POINTER or csv:COLUMN, behind nothing, stderr: or
 * file:PATH: of a file in the folder of the run. */
enum br_status br_orders_request_reading(struct br_orders_request *request, const char *name,
                                         const char *what, struct br_error *err);

/* Sets what a key of study files says: "title", "run", "column", "where", "finest", "without",
 * "error", "value", "dimension", "formal_order" or "repeat", once. Fails with BR_BAD_INPUT, "found
 * '0', expected a whole number from 1 to 16", or BR_NO_MEMORY. */
enum br_status br_orders_request_set(struct br_orders_request *request, const char *key,
                                     const char *text, struct br_error *err);

/* ---- study files ---- */

enum { BR_LONGEST_STUDY = 1 << 20 }; /* bytes */

/* Whether a YAML text is a study file: it has 'run' or 'table' at the top; a scene has neither. */
bool br_is_study_file(const char *text);

/* Reads a study file's text; the path of its table is relative to its folder. Every refusal names
 * path, line and key. Fails with BR_BAD_INPUT or BR_NO_MEMORY. */
enum br_status br_orders_request_read(const char *path, const char *text,
                                      struct br_orders_request *request, struct br_error *err);

/* A hash (out) of what is run or read, and of the expectations. */
void br_orders_problem(const struct br_orders_request *request, char problem[40]);

#endif
