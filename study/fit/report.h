/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All that tables and plots show of one study: they compute nothing themselves. */
#ifndef BR_STUDY_FIT_REPORT_H
#define BR_STUDY_FIT_REPORT_H

#include "study/fit/theory.h"
#include "study/fit/triangle.h"

enum { BR_MOST_TRIANGLES = 4, BR_MOST_OBSERVED = 12 };

/* The order of one component of the errors in h or in k, as far as it can be believed. */
struct br_observed_order {
    bool asked; /* false: what is compared has the same h (or k), or the scheme chooses its own
                   steps */
    struct br_estimate order; /* NaN: none is claimed, and the remark says why */
    bool joint;               /* it is that of the joint fit */
    struct br_theory theory;
    char by[80];                             /* the errors that it comes from */
    char remark[400];                        /* how it compares to theory, or why none is claimed */
    struct br_point point[BR_MOST_OBSERVED]; /* the errors, or differences, that it was sought in,
                                            from coarse to fine: the finest ones */
    size_t points;
};

struct br_report {
    const char *name;        /* file name stem: "table1", or the scene's name; borrowed */
    const char *caption;     /* one line; borrowed */
    struct br_study *study;  /* borrowed */
    struct br_study *exact;  /* the same cells against the exact solution; NULL: `study` is that,
                                or there is none. Borrowed */
    struct br_study *fitted; /* whose errors are fitted and drawn: `exact` where there is one,
                                since there the reference limits no cell. Borrowed */
    double *printed;         /* n_count * k_count, m^(3/2), by rows, NaN where the paper has
                                none; NULL: there is no printed table. Owned */
    const struct br_study *compared[BR_AXES]; /* each mesh against the next; the study itself where
                                              it has such differences. Each time step against the
                                              next smaller one on one mesh. NULL: none. Flagged;
                                              borrowed */
    const char *no_meshes; /* why the former is NULL; NULL: it is not, or none are asked for.
                              Borrowed */
    struct br_fits fits[BR_PARTS]; /* of `fitted`, with the differences */
    struct br_observed_order observed[BR_PARTS][BR_AXES];
    struct br_triangle triangle[BR_MOST_TRIANGLES];
    size_t triangles;
    double wall_seconds; /* of the whole study */
};

/* Sets the orders in h, or in k, from those errors and from the differences; after the fits. Until
 * the report is cleared, only the differences of that axis may change. Fails with BR_NO_MEMORY. */
enum br_status br_report_observe_orders(struct br_report *report, enum br_axis axis,
                                        struct br_error *err);

/* Whether an order is known to a tenth either way, and is the one of theory. Another one needs all
 * steps that can be had: errors may fall evenly for a while by an order that is not theirs. */
bool br_observed_settles(const struct br_observed_order *order);

/* Whether all orders in h, or in k, that are asked for are known to a tenth either way, the usual
 * tolerance of a check, and are as in theory. */
bool br_report_settles(const struct br_report *report, enum br_axis axis);

/* Fits all components of those errors, sets their orders, and checks the printed values, where
 * there are some, by the triangle inequality. The borrowed members and `printed` must be set
 * before. Fails with BR_NO_MEMORY or as br_study_run does. */
enum br_status br_report_finish(struct br_report *report, int threads, struct br_error *err);
void br_report_clear(struct br_report *report);

/* The error of a cell over the printed one; NaN where nothing is printed. */
double br_report_ratio(const struct br_report *report, size_t cell);

#endif
