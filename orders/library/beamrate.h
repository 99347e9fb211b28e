/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate as a library: orders of convergence of the numbers of any program, limits of values, and
 * verdicts. What `beamrate` computes of a beam, its command line gives as JSON (docs/library.md).
 *
 * Pointers to handles and structs must not be NULL, unless a comment allows it: NULL, a handle of
 * another kind, an index or a number outside of an enum are refused (BEAMRATE_BAD_INPUT), and a
 * function that has no message then fills *out with zeros, NaN and "". A handle that was freed, and
 * a pointer to anything else, are not recognised. A pointer to const that a function returns is
 * borrowed from its handle, and valid as long as the handle.
 *
 * Errors are values. A function that can fail returns a status, and fills *err (out; may be NULL)
 * with a message for a person: what was found and what was expected. If a function fails to make a
 * handle, the handle is NULL. The library prints nothing and does not end the process, also where
 * memory ends: the call fails with BEAMRATE_NO_MEMORY.
 *
 * Threads: different threads may use different handles at the same time. A handle allows one call
 * at a time. The library starts no threads, and keeps no data between calls except handles. One
 * effect concerns the whole process: while a function of the library runs, the error handler of GSL
 * is off, and the last call that ends restores it. Results do not depend on the locale.
 *
 * ABI: libbeamrate.so.1. Functions may be added; where one goes, or a struct or number below
 * changes, the number in that name does, too. */
#ifndef BEAMRATE_H
#define BEAMRATE_H

#include <stddef.h>

#include "version.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- common types ---- */

enum beamrate_status {
    BEAMRATE_OK = 0,
    BEAMRATE_BAD_INPUT = 1, /* the message names table, line and column if there are any */
    BEAMRATE_NO_MEMORY = 3,
    BEAMRATE_IO = 6 /* a report could not be written */
};

struct beamrate_error {
    enum beamrate_status status;
    char message[1024];
};

/* What is refined. */
enum beamrate_axis { BEAMRATE_SPACE = 0, BEAMRATE_TIME = 1 };

/* A number with its 95 % interval; NaN if it is not known. */
struct beamrate_estimate {
    double value, low, high;
};

/* The version of the library that is loaded: "1.2.3". BEAMRATE_VERSION is that of the header. */
const char *beamrate_version(void);

/* ---- orders ---- */

/* Orders of convergence of the numbers of a program. */
struct beamrate_orders;

/* Numbers on a sequence of grids, in any order; copied. */
struct beamrate_numbers {
    const double *h;      /* count sizes of elements > 0; NULL: space is not refined */
    const double *k;      /* count time steps > 0; NULL: time is not refined */
    const double *number; /* count: errors >= 0, or values whose limit is not known; NaN: missing */
    size_t count;
    int values;    /* 1: values; 0: errors */
    double formal; /* theoretical order of values, for the intervals of their limits; 0: 2 */
};

/* The order along one axis, at the finest size of the other axis. */
struct beamrate_order {
    struct beamrate_estimate order;
    double constant;     /* C of e = C h^order, or k^order; of values: of their differences */
    size_t points, used; /* all points, and those that are not at a floor */
    struct beamrate_estimate limit; /* of values: their limit, by the same mixture of laws */
};

/* Finds the orders. *orders (out): owned by the caller. Fails with BEAMRATE_BAD_INPUT if a size is
 * not above 0 or given twice, if there are fewer than three, or if an error is negative
 * ("numbers:2" is the second number), or with BEAMRATE_NO_MEMORY. */
enum beamrate_status beamrate_orders_find(struct beamrate_orders **orders,
                                          const struct beamrate_numbers *numbers,
                                          struct beamrate_error *err);
void beamrate_orders_free(struct beamrate_orders *orders); /* accepts NULL */

/* The order along an axis (out). Returns 1, or 0 with NaN if no line along it has three sizes. If
 * both axes are refined from each number to the next, the line is one of space. */
int beamrate_orders_line(const struct beamrate_orders *orders, enum beamrate_axis axis,
                         struct beamrate_order *order);

/* Both orders from all rows that are not left out: e^2 = a^2 + 2 r a b + b^2, a = C_h h^p,
 * b = C_k k^q. Numbers of a part of the error that is too small to see are NaN. */
struct beamrate_fit {
    int describes; /* 1: the model describes the errors with a misfit of at most 2 %; else 0 */
    struct beamrate_estimate p, c_h, q, c_k, r;
    double misfit; /* root mean square of log(model/error) */
    size_t points;
};

/* The joint fit of errors on a grid of h and k (out); for other numbers only NaN. Of a table with
 * several columns of numbers this and beamrate_orders_line are about the first. */
enum beamrate_status beamrate_orders_fit(const struct beamrate_orders *orders,
                                         struct beamrate_fit *fit);

/* A table, as `beamrate orders FILE` reads it: text or JSON, with any separator. Evidence says
 * which column is what; where it is not enough, the call fails and names the member that decides.
 */
struct beamrate_table {
    const char *name;    /* of the file, for messages; NULL: "table" */
    const char *text;    /* UTF-8 */
    const char *errors;  /* columns of errors, "l2,h1"; NULL: all where values is NULL, too */
    const char *values;  /* columns of values whose limit is not known; NULL: none */
    double dimension;    /* of the mesh whose unknowns or cells a column counts, at most 16; 0: not
                            stated */
    double formal;       /* theoretical order of values; 0: 2 */
    const char *columns; /* what columns are, as of --column: "dx=h, 3=l2"; NULL: not stated */
    const char *where;   /* the rows of one case, as of --where: "method=P1"; NULL: each case */
    size_t finest;       /* so many of the finest sizes have a part, as of --finest; 0: all */
    const char *without; /* sizes that have none, as of --without: "8,16"; NULL: none */
};

/* Reads the table and finds the orders of each of its columns of numbers. *orders (out): owned by
 * the caller. Fails as beamrate_orders_find; the message names table, line and column. */
enum beamrate_status beamrate_orders_read(struct beamrate_orders **orders,
                                          const struct beamrate_table *table,
                                          struct beamrate_error *err);

/* What the numbers show of one column's order. */
struct beamrate_answer {
    const char *quantity; /* the column's name */
    int values;           /* 1: values; 0: errors */
    int refined;          /* 1: there is a line along the axis; else 0, and order is NaN */
    struct beamrate_estimate order; /* by the joint fit if it describes the errors, else by the line
                                       at the finest size of the other axis */
    const char *open; /* why the order is not settled, as where the dimension of the mesh is
                         assumed, and what settles it; "": it is */
};

/* The answer (out) for column `quantity`, from 0 on, along an axis. Returns 1, or 0 with NaN and ""
 * if there is no such column. */
int beamrate_orders_answer(const struct beamrate_orders *orders, size_t quantity,
                           enum beamrate_axis axis, struct beamrate_answer *answer);

/* A point of a line. */
struct beamrate_order_point {
    double size;                  /* h or k */
    double error;                 /* or the difference of a value from the next finer one */
    double rate;                  /* the order from the point before it to this one; NaN: none */
    struct beamrate_estimate fit; /* the order's line there, and its band; NaN: none */
    const char *left_out;         /* why the order does not rest on it; "": it does */
};

/* Point i (out), from coarse to fine, of the line of a column along an axis, at the finest size of
 * the other axis. Returns 1, or 0 with NaN and "" if there is no such point. */
int beamrate_orders_point(const struct beamrate_orders *orders, size_t quantity,
                          enum beamrate_axis axis, size_t i, struct beamrate_order_point *point);

/* The whole report, as `beamrate orders --json` writes it: the answer in words, and the tables of
 * orders, joint fits, limits with the grid convergence index, and all rows. *json (out): borrowed
 * from the orders, valid until the next call of this function; NULL after a failure. Fails with
 * BEAMRATE_NO_MEMORY. */
enum beamrate_status beamrate_orders_report(struct beamrate_orders *orders, const char **json,
                                            struct beamrate_error *err);

/* ---- what a digit costs ---- */

/* Errors over costs of several programs. */
struct beamrate_trade;

/* Reads the sources: tables with a column of a cost, and texts of study files, whose commands it
 * runs, one at a time, again and again until the median of their times is known: read them before.
 * cost: as of --cost; NULL: the first that all have. *trade (out): owned by the caller; it keeps no
 * text of the sources. Fails with BEAMRATE_BAD_INPUT where the programs have no error, or no cost,
 * in common, and as beamrate_orders_read. */
enum beamrate_status beamrate_trade_read(struct beamrate_trade **trade,
                                         const struct beamrate_table *sources, size_t count,
                                         const char *cost, struct beamrate_error *err);
void beamrate_trade_free(struct beamrate_trade *trade); /* accepts NULL */

/* The whole report, as `beamrate trade` writes it in JSON: the answer in words, and the tables of
 * the cheapest programs, of how costs grow, and of all runs. *json (out): as of
 * beamrate_orders_report.
 */
enum beamrate_status beamrate_trade_report(struct beamrate_trade *trade, const char **json,
                                           struct beamrate_error *err);

/* ---- verdicts ---- */

/* Expected and observed orders, and verdicts from their 95 % intervals. */
struct beamrate_check;

enum beamrate_verdict {
    BEAMRATE_PASS = 0,        /* the interval lies within the band */
    BEAMRATE_FAIL = 1,        /* it lies outside; or an error is missing */
    BEAMRATE_INCONCLUSIVE = 2 /* it straddles an end, or points are too few: fails, too */
};

/* One expectation. */
struct beamrate_case {
    const char *study;          /* "space" or "time" */
    const char *measure;        /* "error", "value", or the column */
    double expected, tolerance; /* the interval must lie within expected -+ tolerance; tolerance
                                   0: above expected */
    struct beamrate_estimate order;
    double constant;     /* C of e = C h^expected, or k^expected; NaN: none */
    double margin;       /* from the interval to the nearer end of the band; < 0: it is outside */
    size_t points, used; /* all errors, and those in the fit */
    enum beamrate_verdict verdict;
    const char *reason; /* why it does not pass, and a remedy; "": it passes */
    const char *note;   /* which errors were left out; "": none */
};

void beamrate_check_free(struct beamrate_check *check); /* accepts NULL */

/* The number of expectations, 0 for no check; and expectation i (out). */
size_t beamrate_check_count(const struct beamrate_check *check);
enum beamrate_status beamrate_check_case(const struct beamrate_check *check, size_t i,
                                         struct beamrate_case *c);

/* The expectation of an order. */
struct beamrate_expectation {
    enum beamrate_axis axis;
    double order, tolerance; /* 0 <= tolerance < order; 0: the order is the least */
    double down_to;          /* the errors are expected to stop falling there; 0: nowhere */
};

/* A verdict on each of `count` >= 1 expectations, by the joint fit if it describes the errors, else
 * by the line. *check (out): owned by the caller; it does not need the orders any more. Fails with
 * BEAMRATE_BAD_INPUT if there is no such line or an expectation makes no sense, or with
 * BEAMRATE_NO_MEMORY. */
enum beamrate_status beamrate_orders_check(struct beamrate_check **check,
                                           const struct beamrate_orders *orders,
                                           const struct beamrate_expectation *expectation,
                                           size_t count, struct beamrate_error *err);

/* The same of column `quantity`, from 0 on. Refuses an order in h of a table where the dimension of
 * the mesh is assumed. */
enum beamrate_status beamrate_orders_check_quantity(struct beamrate_check **check,
                                                    const struct beamrate_orders *orders,
                                                    size_t quantity,
                                                    const struct beamrate_expectation *expectation,
                                                    size_t count, struct beamrate_error *err);

/* The same of a text as --expect has it: "L2: h 2 +- 0.1, k 1; H1 >= 0.9", or "2" of one column.
 * Names are found without regard to case. */
enum beamrate_status beamrate_orders_expect(struct beamrate_check **check,
                                            const struct beamrate_orders *orders, const char *text,
                                            struct beamrate_error *err);

#ifdef __cplusplus
}
#endif

#endif
