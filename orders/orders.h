/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers of any program on finer and finer grids, and their orders of convergence: the same
 * observations, fits and verdicts as a beam's (study/verify/check.h, study/fit/fit.h). */
#ifndef BR_ORDERS_ORDERS_H
#define BR_ORDERS_ORDERS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/words.h"
#include "orders/expectation/check.h"
#include "orders/grid/joint_fit.h"
#include "orders/limits/limits.h"
#include "orders/reading/columns.h"

/* ---- numbers: they come from a source (request.h) ---- */

/* A column of numbers that is studied. */
struct br_quantity {
    char *name;    /* owned */
    char *unit;    /* owned; NULL: none is given */
    bool is_value; /* true: its limit is not known; false: it is an error, whose limit is 0 */
    int digits, decimals; /* the most that one of its numbers has, if zeros at the end are none */
    bool fixed;           /* printed to these decimals; else to these digits */
    char *window;         /* rows by hand, "the 3 finest of 6"; NULL: all rows have a part; owned */
    size_t case_at;       /* where " [method = P1]" begins in its name; 0: there is one study */
    /* What a source knows besides; zeros: nothing. */
    double formal[BR_AXES]; /* the order of theory: errors that do not fall, or fall slowly and
                               unevenly, show none then */
};

/* One run of the program that made the numbers. */
struct br_numbers_row {
    double given[BR_AXES]; /* as the source has it; NaN: no such column, or a run that failed before
                              it stated its size: z is then about its place */
    double listed[BR_AXES];  /* of a run: as its list has it */
    double z[BR_AXES];       /* size of elements and steps, in a unit of the source; NaN: none */
    double against[BR_AXES]; /* of the reference of its errors; 0: the continuous problem */
    enum br_flag *out;       /* by quantity: why the source leaves a number out; owned */
    double *number;          /* by quantity; NaN: missing; owned */
    double *deviation; /* the standard deviation of each, where it is a mean; NaN, or no array:
                          it is none; within `number` */
    size_t repeat;     /* of a run: which of its cell; of a mean: how many; 0: one run */
    size_t line;       /* in the source file; 0: there is none */
    double seconds, wall, bytes; /* processor time, time by the clock, peak memory; NaN: not
                                    measured */
    bool cached;                 /* whether its numbers are those of an earlier run */
    char *failure;               /* why it has no numbers; NULL: it has; owned */
};

/* A column, a row or a line of a table. */
struct br_left_aside {
    const char *what; /* "column time", "line 9: Overall 2.0" */
    const char *why;
};

/* Of numbers: some seconds are enough for the fits of a grid, and one for those of a line. */
enum {
    BR_MOST_ROWS = 10000,
    BR_MOST_SIZES = 1000,   /* along an axis */
    BR_MOST_DIMENSIONS = 16 /* of a mesh */
};

struct br_numbers {
    const struct br_resolution_column *column[BR_AXES]; /* NULL: that axis is not refined */
    const struct br_resolution_column *listed[BR_AXES]; /* of runs: that of their list */
    char *unit[BR_AXES];                                /* of the numbers; NULL; owned */
    struct br_quantity *quantity;                       /* owned */
    size_t quantities, costs;   /* the columns of costs stand behind the others */
    struct br_numbers_row *row; /* owned; from coarse to fine, first over space */
    size_t rows;
    bool powers; /* the errors of each axis are known to be one power, without scatter and, but for
                    rows that are out, without a floor: joint fits have no other laws, lines leave
                    no row out of them, and only the two finest lines along an axis of known theory
                    have an order */
    double dimension;      /* of the mesh, where unknowns or cells are counted */
    bool assumed;          /* nobody stated it */
    bool samples;          /* n counts samples, and not elements */
    bool all_needed;       /* a verdict fails where a number is missing */
    const char *unsettled; /* what is assumed, and the option that settles it: there is no verdict
                              on it; NULL: nothing is */
    const char *taken;     /* what was taken for what: "h = 1/n from column N; errors: L2"; NULL: a
                              program's */
    struct br_left_aside *left; /* of a table, what has no part in the numbers */
    size_t lefts;
    const char *other_error;            /* one of these that is called an error; NULL: none is */
    struct br_store store;              /* of these texts */
    const struct br_observer *observer; /* stops fits; may be NULL; borrowed */
};

void br_numbers_clear(struct br_numbers *numbers); /* accepts zeros */

/* A source fills zeros with them: rows of NaN with a number for each of the quantities, then each
 * quantity. Fail with BR_NO_MEMORY, or with BR_BAD_INPUT beyond BR_MOST_ROWS. */
enum br_status br_numbers_make_room(struct br_numbers *numbers, size_t rows, size_t quantities,
                                    struct br_error *err);
enum br_status br_numbers_add_quantity(struct br_numbers *numbers, const char *name,
                                       const char *unit, bool is_value, struct br_error *err);

/* From coarse to fine, first over space. */
void br_numbers_sort(struct br_numbers *numbers);

/* "n = 40", with the number as given; "the run of n = 40" where a run did not state its size. */
void br_numbers_name(const struct br_numbers *numbers, const struct br_numbers_row *row,
                     enum br_axis axis, char text[64]);

/* "n = 8, k = 0.1" */
void br_numbers_name_cell(const struct br_numbers *numbers, const struct br_numbers_row *row,
                          char text[BR_CELL_NAME]);

/* Sorts the rows, and makes sizes one that differ by round-off. Refuses (BR_BAD_INPUT, with `path`
 * and the line first) resolutions that are not above 0 or are there twice, fewer than three
 * resolutions or more than BR_MOST_SIZES, errors below 0, and numbers whose differences may
 * overflow. */
enum br_status br_numbers_check(struct br_numbers *numbers, const char *path, struct br_error *err);

/* Fails with BR_NOT_FINITE where runs of a program have no numbers: a command says so after it has
 * written what the others give. */
enum br_status br_numbers_check_runs(const struct br_numbers *numbers, struct br_error *err);

/* ---- orders ---- */

/* The observed order of a quantity along one axis, at one size of the other axis. */
struct br_orders_line {
    enum br_axis axis;
    char at[64]; /* "k = 0.01"; "": the other axis is not refined, or tied to this one */
    struct br_case observed; /* of a value, the differences from the next finer one; then the
                                finest value stands behind its points */
    /* For a value, from all its rows that have a number: */
    struct br_limits limits;
};

/* The position of a row on a line; line: NULL, it is on none. */
struct br_row_point {
    const struct br_orders_line *line;
    size_t index; /* of the point */
};

/* What the numbers show of the order along an axis. */
struct br_orders_answer {
    struct br_estimate order;
    const char *open; /* why it is not settled, and what would settle it; NULL: it is known */
    bool joint;       /* it is that of the joint fit; else of a line: */
    const struct br_orders_line
        *line; /* of the errors, or of the differences; NULL: there is none */
};
extern const char br_orders_uneven[]; /* open: the errors of the line do not fall, or fall slowly */

struct br_quantity_orders {
    size_t quantity;             /* of the numbers */
    struct br_orders_line *line; /* lines over space, then over time, each from the coarsest size of
                                    the other axis to the finest; owned */
    size_t lines;
    struct br_row_point *point[BR_AXES]; /* by row; NULL: no lines; owned */
    struct br_grid_limit limit;          /* for a value: that of its line; on a grid over h and k */
    struct br_joint_fit joint;           /* for an error on a grid; not converged: there is none */
    enum br_flag *flag; /* by row: why that does not rest on it; NULL: there is none; owned */
    struct br_orders_line differences[BR_AXES]; /* of the source, with their orders */
    struct br_orders_answer answer[BR_AXES];    /* by the joint fit where that describes the errors,
                       else by the line at the finest size of the other axis; on a grid of errors only
                       if the line at the next size shows the same order, so that the error of the
                       other axis does not disturb it; by differences, where they show it better */
};

struct br_orders {
    const struct br_numbers *numbers;
    double formal;                 /* order of values */
    bool assumed_formal;           /* nobody stated it */
    struct br_quantity_orders *of; /* count; owned */
    size_t count;
    bool tied; /* both axes are refined from each row to the next, along one line */
};

static inline const struct br_quantity *br_quantity_of(const struct br_orders *orders,
                                                       const struct br_quantity_orders *of)
{
    return &orders->numbers->quantity[of->quantity];
}

/* Finds all orders. Rows without a number, at a floor or beyond stagnation are left out, with a
 * flag. formal: the order of theory for values, for the intervals of their limits; 0: nobody stated
 * it, and it is 2. The numbers are borrowed. Fails with BR_NO_MEMORY or BR_INTERRUPTED; clear it
 * even then. */
enum br_status br_orders_find(const struct br_numbers *numbers, double formal,
                              struct br_orders *orders, struct br_error *err);
void br_orders_clear(struct br_orders *orders);

/* Makes room for differences of successive sizes of one axis, from coarse to fine, at one size of
 * the other axis, whose error they do not have: points of of->differences[axis] (0: there are
 * none), of which the caller sets what br_case_observe needs. br_orders_renew then finds the answer
 * along that axis anew. Both fail with BR_NO_MEMORY. */
enum br_status br_orders_begin_differences(const struct br_orders *orders,
                                           struct br_quantity_orders *of, enum br_axis axis,
                                           size_t points, struct br_error *err);
enum br_status br_orders_renew(const struct br_orders *orders, struct br_quantity_orders *of,
                               enum br_axis axis, struct br_error *err);

/* Adds the lines of a quantity along an axis, from the coarsest size of the other one to the
 * finest, with their limits, but not their orders (lines.c, for br_orders_find). */
enum { BR_ORDERS_LEAST = 3 /* sizes of a line, for an order with an interval */ };
enum br_status br_orders_add_lines(const struct br_orders *orders, struct br_quantity_orders *of,
                                   enum br_axis axis, struct br_error *err);
enum br_status br_orders_begin_case(const struct br_orders *orders, size_t quantity,
                                    enum br_axis axis, size_t points, struct br_case *c,
                                    struct br_error *err);

/* br_case_observe of a line over sizes of this column. Errors over degrees that are few, or have
 * few digits, may fit powers of 1/(degree + 1) as well as exponential convergence. */
enum br_status br_orders_observe(const struct br_resolution_column *size, size_t least,
                                 struct br_case *c, struct br_error *err);

/* The number of a row as a point, before it has a size along a line, its label and, of a value, a
 * difference from a finer one. */
struct br_point br_orders_point(const struct br_orders *orders, size_t quantity, size_t row);

/* The case of a grid of errors in an axis: the order of the joint fit, with the error at each size
 * that is at the finest size of the other axis. Fails with BR_NO_MEMORY; free its points even
 * then. */
enum br_status br_orders_joint_case(const struct br_orders *orders,
                                    const struct br_quantity_orders *of, enum br_axis axis,
                                    struct br_case *c, struct br_error *err);

/* Whether both axes are refined, each at several sizes of the other. */
bool br_orders_is_grid(const struct br_orders *orders);

/* The line along an axis at the finest size of the other one; NULL: there is none. */
const struct br_orders_line *br_orders_finest(const struct br_quantity_orders *of,
                                              enum br_axis axis);

/* The order from the coarser point before point i to point i; NaN: none. For values it is the order
 * of their differences, whatever the ratios of their sizes are. */
double br_orders_rate(const struct br_orders_line *line, size_t i);

/* ---- what a finer mesh, or a shorter time step, would give ---- */

/* Along the one axis that is refined, if the errors go on to fall as they do; also of values. */
struct br_orders_forecast {
    const struct br_orders_line *line; /* NULL: no forecast, as for grids, floors, open orders */
    double number;                     /* the finest error; of a value its GCI */
    double order, z, ratio;            /* order; size of that row, over the next coarser one */
};
struct br_orders_forecast br_orders_forecast_of(const struct br_orders *orders,
                                                const struct br_quantity_orders *of);

/* The error, or GCI, one step finer, by the same ratio; *given (out): the size, as it is stated. */
double br_orders_next(const struct br_orders *orders, const struct br_orders_forecast *f,
                      double *given);

/* The size that an error, or GCI, needs, as it is stated. NaN: more than 100 times as fine as the
 * finest, or as many cells. */
double br_orders_needed(const struct br_orders *orders, const struct br_orders_forecast *f,
                        double wanted);

/* Whether a column of errors hardly changes along its line, as a value does. */
bool br_orders_stays(const struct br_orders_line *line);

/* ---- costs ---- */

/* Whether the longest run takes clearly longer than the shortest one. */
bool br_orders_costs_differ(const struct br_orders *orders);

/* The exponent by which processor time grows with finer elements or steps, on the line at the
 * finest size of the other axis; NaN with less than three runs of 0.02 s or more. Fails with
 * BR_NO_MEMORY. */
enum br_status br_orders_growth(const struct br_orders *orders, enum br_axis axis,
                                struct br_estimate *growth, struct br_error *err);

/* ---- verdicts ---- */

struct br_order_expectation {
    char quantity[64]; /* "": the only one */
    enum br_axis axis; /* BR_AXES: the only one that is refined */
    struct br_expectation band;
};

/* Reads the expectations of a text on that line, "l2: h 2 +- 0.1, k 1; H1 >= 0.9; drag = 2 down to
 * 1e-9", or "2", and adds them to a list, which the caller owns. Fails with BR_BAD_INPUT or
 * BR_NO_MEMORY. */
enum br_status br_expectations_read(const char *text, size_t line,
                                    struct br_order_expectation **expectations, size_t *count,
                                    struct br_error *err);

/* The quantity (out) that an expectation names: the same letters, else without regard to case; the
 * number of quantities: there is none. Sets its axis, where it has none. Fails with BR_BAD_INPUT
 * where several may be meant. */
enum br_status br_expectation_find(const struct br_numbers *numbers,
                                   struct br_order_expectation *expected, size_t *quantity,
                                   struct br_error *err);

/* Adds the verdict on the order of a quantity along the expectation's axis to a check's cases: on a
 * grid of errors by the answer, else on the line at the finest size of the other axis. Fails with
 * BR_BAD_INPUT where there is no line, or with BR_NO_MEMORY. */
enum br_status br_orders_decide(const struct br_orders *orders, const struct br_quantity_orders *of,
                                const struct br_order_expectation *expected, struct br_check *check,
                                struct br_error *err);

/* Adds that on each expectation. Fails as br_expectation_find and br_orders_decide do, and with
 * BR_BAD_INPUT where there is no such quantity. */
enum br_status br_orders_check(const struct br_orders *orders,
                               const struct br_order_expectation *expectations, size_t count,
                               struct br_check *check, struct br_error *err);

#endif
