/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers of any program on finer and finer grids: what orders of convergence are found from. They
 * come from a source: a table in a file, a program that is run, ... */
#ifndef BR_STUDY_ORDERS_NUMBERS_H
#define BR_STUDY_ORDERS_NUMBERS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "solver/status.h"

/* What is refined. */
enum br_axis { BR_AXIS_SPACE, BR_AXIS_TIME, BR_AXES };
extern const char *const br_axis_letters[BR_AXES]; /* "h", "k" */

/* How a column tells a resolution; const records. z = given for a size; 1/given for a number of
 * elements or steps; given^(-1/dimension) for unknowns. */
struct br_resolution_column {
    const char *name; /* "n", "h", "dofs", "k", "dt", "steps" */
    enum br_axis axis;
    bool is_size;   /* z is what is given; else one over it */
    bool is_volume; /* its root by the dimension counts */
};
extern const struct br_resolution_column br_resolution_columns[]; /* ends with a NULL name */
const struct br_resolution_column *br_resolution_column_find(const char *name);

/* A column of numbers that is studied. */
struct br_quantity {
    char *name;    /* owned */
    char *unit;    /* owned; NULL: none is given */
    bool is_value; /* its limit is not known; else it is an error, whose limit is 0 */
};

/* One run of the program that made them. */
struct br_numbers_row {
    double given[BR_AXES]; /* as the source has it; NaN: no such column */
    double z[BR_AXES];     /* size of elements and steps, in a unit of the source; NaN likewise */
    double *number;        /* by quantity; NaN: missing; owned */
    size_t line;           /* in the file it is from; 0: none */
    double seconds, bytes; /* processor time and peak memory; NaN: not measured */
    bool kept;             /* it was not run, but found among what was kept */
    char *failure;         /* why it has no numbers; NULL: it has; owned */
};

struct br_numbers {
    const struct br_resolution_column *column[BR_AXES]; /* NULL: that axis is not refined */
    char *unit[BR_AXES];                                /* of what is given; NULL; owned */
    struct br_quantity *quantity;                       /* owned */
    size_t quantities;
    struct br_numbers_row *row; /* owned; from coarse to fine, first over space */
    size_t rows;
};

void br_numbers_clear(struct br_numbers *numbers); /* accepts zeros */

/* What a source fills zeros by: rows of NaN and so many quantities' numbers, and each quantity.
 * Fail with BR_NO_MEMORY. */
enum br_status br_numbers_make_room(struct br_numbers *numbers, size_t rows, size_t quantities,
                                    struct br_error *err);
enum br_status br_numbers_add_quantity(struct br_numbers *numbers, const char *name,
                                       const char *unit, bool is_value, struct br_error *err);

/* From coarse to fine, first over space. */
void br_numbers_sort(struct br_numbers *numbers);

/* z of what a column gives. */
double br_numbers_z(const struct br_resolution_column *column, double given, double dimension);

/* The first name of a list "a, b" (out: not ended by a zero; without the blanks around it); returns
 * the rest of the list, or NULL. */
const char *br_list_next(const char *list, const char **name, size_t *length);

/* Whether a list (NULL: an empty one) has a name. */
bool br_lists(const char *list, const char *name);

/* Brings the rows into their order, takes sizes that differ by round-off for one, and refuses
 * (BR_BAD_INPUT, beginning with `path` and the line) resolutions that are not above 0 or are there
 * twice, fewer than three of them, errors below 0, and numbers too large for their differences.
 * Fails with BR_NO_MEMORY, too. */
enum br_status br_numbers_check(struct br_numbers *numbers, const char *path, struct br_error *err);

#endif
