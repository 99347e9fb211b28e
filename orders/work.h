/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a digit costs: errors over costs of several programs, a work-precision diagram. A point is a
 * run of a program at one size; without an error or a cost (NaN) it does not count. */
#ifndef BR_ORDERS_WORK_H
#define BR_ORDERS_WORK_H

#include "orders/orders.h"

/* The cheapest point of a program (SIZE_MAX: of all but `other`) whose error is at most the target;
 * of equals the first. `count`: there is none. */
size_t br_work_cheapest(const struct br_point *point, size_t count, double target, size_t program,
                        size_t other);

/* Marks the points of the Pareto fronts (front, own): no other one is better in error or cost and
 * at least as good in the other; of equals the first is marked. The error of a dearer point must be
 * smaller by more than a millionth. */
void br_work_front(struct br_point *point, size_t count);

/* The point of the front of all that is the next dearer one after `last`; count: the first, and the
 * end. */
size_t br_work_next(const struct br_point *point, size_t count, size_t last);

/* ---- of the numbers of programs ---- */

struct br_work_source {
    char name[300];
    const char *path; /* for messages; borrowed */
    struct br_numbers numbers;
};
void br_work_sources_clear(struct br_work_source *source, size_t count); /* frees the list, too */

/* Names sources by their paths: "fd" of "programs/fd.yaml", but the whole path where two would have
 * one name. */
void br_work_name_sources(struct br_work_source *source, size_t count);

/* Numbers may be NaN: not known. */
struct br_work_program {
    char name[400];            /* "fd", "table [method = P1]" */
    enum br_axis axis;         /* along which it is refined alone; BR_AXES: there is none */
    struct br_estimate growth; /* the cost grows as the size to the power -growth */
    struct br_estimate tenth;  /* a tenth of the error costs so many times as much */
    double wanted;             /* 1e-6, or the next power of ten that it does not reach */
    struct br_estimate needed; /* what that costs, if both orders stay, */
    char at[64];               /* and its size, "n = 1024" */
    double start;              /* of the program, part of each of its costs */
    char starts[BR_CELL_NAME]; /* up to this size the cost is mostly the start; "": nowhere */
    char odd[BR_CELL_NAME];    /* the cost there is no part of the growth; "": all are */
    bool stalls;               /* the finest errors no longer fall: no forecast */
    struct br_point *point;    /* from coarse to fine; borrowed */
    size_t points, failed;     /* runs with error and cost; without */
    char first[BR_CELL_NAME];  /* the first that failed, */
    const char *failure;       /* and why; borrowed */
};

/* One quantity of all programs. */
struct br_work_precision {
    char quantity[200], cost[200]; /* "l2", "processor time" */
    const char *unit, *cost_unit;  /* NULL: none is given; "s", or "": it has none; borrowed */
    bool is_time;
    struct br_work_program *program; /* owned */
    struct br_point *point;          /* program after program, from coarse to fine; owned */
    size_t programs, points;
};

/* The errors that all programs measure, and the cost that all have: the column `cost`, or of that
 * kind; "": the first of processor time, wall time, dofs, iterations and memory. *works (out):
 * owned, `count` of them; clear them even after a failure. Fails with BR_BAD_INPUT where the
 * programs have no error or no cost in common, and where costs fall with finer sizes; with
 * BR_NOT_FINITE where no run has both. */
enum br_status br_work_find(const struct br_work_source *source, size_t sources, const char *cost,
                            struct br_work_precision **works, size_t *count, struct br_error *err);
void br_work_clear(struct br_work_precision *works, size_t count); /* accepts NULL */

/* Powers of ten from the largest error to the smallest that is reached (out); returns how many. */
enum { BR_WORK_DIGITS = 20 };
size_t br_work_targets(const struct br_work_precision *work, double target[BR_WORK_DIGITS]);

#endif
