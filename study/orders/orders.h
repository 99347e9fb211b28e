/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Orders of convergence of any program's numbers: the same observations, fits and verdicts as a
 * beam's (study/verify/check.h, study/fit/fit.h). */
#ifndef BR_STUDY_ORDERS_ORDERS_H
#define BR_STUDY_ORDERS_ORDERS_H

#include "study/fit/grid_convergence.h"
#include "study/orders/numbers.h"
#include "study/verify/check.h"

/* What is seen of a quantity along one axis, at one size of the other. */
struct br_orders_line {
    enum br_axis axis;
    char at[64]; /* "k = 0.01"; "": the other axis is not refined, or goes along */
    size_t *row; /* of the numbers, from coarse to fine; observed.points of them, and one
                    more of a value; owned */
    struct br_case observed; /* of a value: of its differences from the next finer one */
    /* Of a value, by all its rows that have a number: */
    struct br_grid_limit limit; /* method: as many rows as there are */
    struct br_gci gci;          /* of the three finest */
};

/* Where a row is on a line; line: NULL, it is on none. */
struct br_row_point {
    const struct br_orders_line *line;
    size_t index; /* of the point */
};

struct br_quantity_orders {
    size_t quantity;             /* of the numbers */
    struct br_orders_line *line; /* lines over space, then over time, each from the coarsest size of
                                    the other axis to the finest; owned */
    size_t lines;
    struct br_row_point *point[BR_AXES]; /* by row; NULL: no lines; owned */
    struct br_joint_fit joint;           /* of an error on a grid; not converged: none */
};

struct br_orders {
    const struct br_numbers *numbers;
    double formal;                 /* order of values */
    struct br_quantity_orders *of; /* count; owned */
    size_t count;
    bool tied; /* both axes are refined from each row to the next: they go along in one line */
};

/* Finds all orders. Rows without a number, at a floor or beyond stagnation are left out by name.
 * formal: the order that theory gives values, for the intervals of their limits. The numbers are
 * borrowed. Fails with BR_NO_MEMORY; clear it even then. */
enum br_status br_orders_find(const struct br_numbers *numbers, double formal,
                              struct br_orders *orders, struct br_error *err);
void br_orders_clear(struct br_orders *orders);

/* The line along an axis at the finest size of the other one; NULL: there is none. */
const struct br_orders_line *br_orders_finest(const struct br_quantity_orders *of,
                                              enum br_axis axis);

/* The order that point i and the coarser one before it show; NaN: none. That of values is the one
 * that their differences show, whatever the ratios of their sizes are. */
double br_orders_rate(const struct br_orders_line *line, size_t i);

/* ---- costs ---- */

/* The exponent by which processor time grows with finer elements or steps, on the line at the
 * finest size of the other axis; NaN with less than three runs of 0.02 s or more. Fails with
 * BR_NO_MEMORY. */
enum br_status br_orders_growth(const struct br_orders *orders, enum br_axis axis,
                                struct br_estimate *growth, struct br_error *err);

/* The cheapest run whose error in a quantity is at most so large; NULL: none, or no run was timed.
 */
const struct br_numbers_row *br_orders_cheapest(const struct br_orders *orders, size_t quantity,
                                                double error);

/* ---- verdicts ---- */

struct br_order_expectation {
    char quantity[64];
    enum br_axis axis;
    double order, tolerance;
    double down_to; /* errors stop falling there, as is expected; 0: nowhere */
    size_t line;    /* in a study file; 0: none */
};

/* Reads "l2: h 2 +- 0.1, k 1 +- 0.05; drag: h 2 +- 0.2 down to 1e-9", on that line, and adds it to
 * a list, which is owned by the caller. Fails with BR_BAD_INPUT, beginning with `where`, or
 * BR_NO_MEMORY. */
enum br_status br_expectations_read(const char *where, const char *text, size_t line,
                                    struct br_order_expectation **expectations, size_t *count,
                                    struct br_error *err);

/* Judges each expectation: by the joint fit where it describes the errors, else on the line at the
 * finest size of the other axis. check->cases (out, owned). Fails with BR_BAD_INPUT where a
 * quantity or an axis is not there, or with BR_NO_MEMORY. */
enum br_status br_orders_check(const struct br_orders *orders,
                               const struct br_order_expectation *expectations, size_t count,
                               struct br_check *check, struct br_error *err);

#endif
