/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables of numbers that are known exactly, their orders, and verdicts on them. */
#ifndef BR_TESTS_MADE_TABLES_H
#define BR_TESTS_MADE_TABLES_H

#include "checks.h"
#include "orders/request.h"

enum { MOST_TEXT = 1 << 16 };

/* Cells without a dimension are assumed to be those of a plane. */
enum br_status read_table(const char *text, const char *errors, const char *values,
                          struct br_numbers *numbers);
struct br_numbers read_with(const char *text, const char *values);

/* 3 h^p + 0.7 k^q; a size of 0 adds nothing. */
double power_law(double h, double k, double p, double q);

/* A table of that law, of sizes 1/2, 1/4, ...; with both counts a grid. Each table here is there
 * until the next one of its function. */
const char *table_of(int meshes, int steps, double p, double q);

/* A grid of numbers f(h, k), h = k = 1, 1/2, ..., as a table. */
char *grid_of(int meshes, int steps, double (*f)(double h, double k));

/* h = 1, 1/2, ... with errors h^2 that do not fall below a floor; in units of that size. */
const char *scaled_floor_table(int rows, double level, double unit);
const char *floor_table(int rows, double level);

/* What was found last. */
extern struct found {
    struct br_numbers numbers;
    struct br_orders orders;
} found;

void find(const char *text, const char *values);

/* The verdict on the last expectation of the text; BR_BAD_INPUT, in the place of one, where it has
 * none. why: out, the reason. */
int verdict_of(const char *table, const char *values, const char *expected, char why[768]);

#endif
