/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All that tables and plots show of one study: they compute nothing themselves. */
#ifndef BR_STUDY_FIT_REPORT_H
#define BR_STUDY_FIT_REPORT_H

#include "study/fit/fit.h"
#include "study/grid/sweep.h"

enum { BR_MOST_TRIANGLES = 4 };

/* The order of one part of the errors in h or in k, as far as it can be believed. */
struct br_seen_order {
    bool asked; /* false: what is compared does not differ in that direction, or the scheme chooses
                   its own steps */
    struct br_estimate order; /* NaN: none is claimed, and the remark says why */
    double theory;            /* the order where the solution is smooth */
    char by[80];              /* which errors show it */
    char remark[240];         /* how it stands to theory, or why none is seen */
};

struct br_report {
    const char *name;           /* file name stem: "table1", or the scene's name; borrowed */
    const char *caption;        /* one line; borrowed */
    struct br_study *study;     /* borrowed */
    struct br_study *exact;     /* the same cells against the exact solution, where `study` is not
                                   already; NULL: not there. Borrowed */
    double *printed;            /* n_count * k_count, m^(3/2), by rows, NaN where the paper has
                                   none; NULL: there is no printed table. Owned */
    const struct br_tips *tips; /* of the cells; NULL: those of the study. Borrowed */
    const struct br_study *meshes; /* each mesh against the next, the study itself where it is of
                                      such differences; NULL: none. Flagged; borrowed */
    const char
        *no_meshes; /* why there are none; NULL: there are, or none are asked for. Borrowed */
    bool rates;     /* people see the slope of every row and column of the grid, too */
    struct br_fits fits[BR_PARTS];
    struct br_seen_order seen[BR_PARTS][BR_AXES];
    struct br_estimate tip[2]; /* by br_field_kind: the tip at t = T for h, k -> 0, by
                                  extrapolation of those tips alone, m; NaN: not known */
    struct br_triangle triangle[BR_MOST_TRIANGLES];
    size_t triangles;
    double wall_seconds; /* of the whole study */
};

/* The study whose errors are fitted and drawn: the one against the exact solution,
 * where there is one, since no cell of it is limited by the reference. */
struct br_study *br_report_fitted(const struct br_report *report);

/* Which orders in h and k those errors, and the differences of meshes, show: after the fits. Fails
 * with BR_NO_MEMORY. */
enum br_status br_report_see_orders(struct br_report *report, struct br_error *err);

/* Fits all parts of those errors, sees their orders, extrapolates the tips, and holds the printed
 * values, where there are some, against the triangle inequality. What is borrowed and printed
 * have been set. Fails with BR_NO_MEMORY or as br_study_run does. */
enum br_status br_report_finish(struct br_report *report, int threads, struct br_error *err);
void br_report_clear(struct br_report *report);

/* Ours over printed, of a cell; NaN where nothing is printed. */
double br_report_ratio(const struct br_report *report, size_t cell);

#endif
