/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers of a foreign program, which is run at each resolution of a list, or of a grid of two
 * lists. No shell has a part in it.
 *
 * program.c: the command, its runs. program_reading.c: numbers in what it prints. program_cache.c:
 * finished cells in a folder. */
#ifndef BR_STUDY_ORDERS_PROGRAM_H
#define BR_STUDY_ORDERS_PROGRAM_H

#include <stdbool.h>
#include <stddef.h>

#include "solver/status.h"
#include "study/grid/observer.h"
#include "study/orders/numbers.h"

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
    bool is_value; /* its limit is not known; else it is an error */
};

/* The resolutions of one axis. */
struct br_program_axis {
    const struct br_resolution_column *column; /* NULL: it is not refined */
    const double *given;                       /* as the column has it, in any order */
    size_t count;
};

enum { BR_PROGRAM_SECONDS = 600 };

/* All borrowed. */
struct br_program {
    /* Words as a shell has them: blanks, '...', "...", \; nothing else has a meaning. In a word,
     * {n} is the resolution of the column n, {{ a brace. A program's path with a slash, and words
     * that name a file, are looked up in `folder`; the program itself runs elsewhere. */
    const char *command;
    const char *folder; /* NULL: the caller's */
    struct br_program_axis axis[BR_AXES];
    double dimension; /* of the domain: for a number of unknowns */
    const struct br_reading *reading;
    size_t readings;
    int jobs;         /* runs at once; 0: one a core */
    double seconds;   /* limit of one run; 0: BR_PROGRAM_SECONDS */
    const char *kept; /* the folder of finished cells, made where it is missing; NULL: none */
    bool anew;        /* cells that are kept are run, too */
    const struct br_observer *observer; /* may be NULL */
};

/* Runs each cell that is not kept in a folder of its own, which is removed afterwards, with
 * LC_ALL=C and no input, and reads its numbers. All that is left of its process group ends with it.
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
enum br_status br_program_run(const struct br_program *program, struct br_numbers *numbers,
                              struct br_error *err);

/* ---- among the files above ---- */

/* BR_BAD_INPUT: it cannot find a number in any output. */
enum br_status br_reading_check(const struct br_reading *reading, struct br_error *err);

/* The number in an output of so many bytes and a zero. BR_BAD_INPUT: there is none, or more than
 * one; the message begins with the reading's name. */
enum br_status br_reading_take(const struct br_reading *reading, const char *output, size_t length,
                               double *number, struct br_error *err);

enum { BR_CELL_KEY = 65 };

/* Names a cell after all that its numbers follow from, as far as that can be seen: the words, the
 * contents of the program (an absolute path) and of files that words name, also behind a "=" (above
 * 64 MiB their size and time stand for them), and the readings. Relative names are looked up
 * in the caller's folder. Files that the program reads without being told are not seen. */
enum br_status br_cell_key(const char *program, char *const *words,
                           const struct br_reading *reading, size_t readings, char key[BR_CELL_KEY],
                           struct br_error *err);

/* Fills the row's numbers, seconds and bytes, and says that it was kept. false: there is no such
 * cell that can be read. */
bool br_cell_find(const char *folder, const char *key, size_t readings, struct br_numbers_row *row);

/* Removes a folder with all that is in it; "": none. What has just been killed may still be there
 * for a moment, and write, so it is tried for a while. */
void br_remove_folder(const char *folder);

/* Keeps a row, whole or not at all. */
enum br_status br_cell_keep(const char *folder, const char *key, char *const *words,
                            size_t readings, const struct br_numbers_row *row,
                            struct br_error *err);

#endif
