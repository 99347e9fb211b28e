/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How a column states a resolution. */
#ifndef BR_ORDERS_READING_COLUMNS_H
#define BR_ORDERS_READING_COLUMNS_H

#include <stdbool.h>

#include "orders/axis.h"

/* Const records. z is the number itself for a size; one over it for a number of elements or steps;
 * number^(-1/dimension) for unknowns. */
struct br_resolution_column {
    const char *name; /* "n", "h", "dofs", "cells", "points", "interior", "level", "k", "dt" ... */
    const char *states; /* "h = 1/n" */
    enum br_axis axis;
    bool is_size;   /* z is the number itself */
    bool is_volume; /* z is the number^(-1/dimension) */
    bool is_power;  /* z is 2^-number; where all are false, one over the number and `more` */
    int more;       /* intervals that a number of points has more than points: -1, or 1 */
    bool is_degree; /* of polynomials: errors over it have no order, but may fall exponentially */
};
enum { BR_RESOLUTIONS = 10 };
extern const struct br_resolution_column
    br_resolution_columns[BR_RESOLUTIONS + 1]; /* ends with a NULL name */
const struct br_resolution_column *br_resolution_column_find(const char *name);
extern const struct br_resolution_column br_degree_column; /* no row: a table alone has it */

/* What a column of costs has. */
enum br_cost {
    BR_COST_CPU,
    BR_COST_WALL,
    BR_COST_TIME, /* one of the two */
    BR_COST_DOFS,
    BR_COST_ITERATIONS,
    BR_COST_MEMORY,
    BR_COSTS
};
extern const struct br_cost_row {
    const char *words; /* that say it in headings, between blanks */
    const char *name, *unit;
} br_costs[BR_COSTS];

/* z of a number of the column. */
double br_numbers_z(const struct br_resolution_column *column, double given, double dimension);

/* The number that states a size z, or the next finer whole one. */
double br_numbers_given(const struct br_resolution_column *column, double z, double dimension);

/* A number of the column as all outputs have it: a count with all its digits. Returns text. */
char *br_numbers_text(const struct br_resolution_column *column, double given, char text[32]);

#endif
