/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The observed order of a line of errors: the one place where it is found.
 *
 * One power C z^p never fits real errors. Coarse grids are not asymptotic, fine ones reach a floor,
 * a growing lower power, a logarithm bends the line, numbers scatter. So several laws compete,
 * each on several windows of rows. The order is their average, weighted by how well each explains
 * the rows (Bayesian model averaging: Hoeting, Madigan, Raftery and Volinsky, Statistical Science
 * 14, 382-417, 1999), and its interval covers each law that the rows do not rule out.
 * tests/lab/orders.c measures how often that is right. */
#ifndef BR_ORDERS_LINE_LINE_ORDER_H
#define BR_ORDERS_LINE_LINE_ORDER_H

#include "base/status.h"
#include "orders/axis.h"
#include "orders/estimate.h"
#include "orders/line/laws.h"

enum { BR_CELL_NAME = 2 * 64 + 2 /* "n = 40, k = 0.1" */ };

/* One number of a line that is refined in one quantity z (h/L or k/T), or of a grid: the one form
 * in which estimators, verdicts, reports and pictures take it. An error against a finer solution is
 * C (z^p - z_against^p). */
struct br_point {
    size_t row;                      /* of the numbers (orders.h) */
    double x[BR_AXES], ref[BR_AXES]; /* h and k of a grid, and of its reference; 0: the
                                        continuous problem */
    double z, z_against;             /* z_against < z: of the reference; 0: the solution itself */
    double error;                    /* in any unit, in which are also: */
    double value, half;              /* of a line of values, whose difference from the next finer
                                        one is the error (NaN: there is none), with half the width
                                        of its 95 % interval, where it is a mean; else 0 */
    double deviation;                /* its standard deviation, where it is a mean; 0: it is none */
    double rounding;   /* half a unit of its last digit, where it was printed; 0: it was not */
    enum br_flag flag; /* why it is left out */
    /* Of a case (case.h): */
    struct br_resolution at, against; /* against: zeros for the continuous problem */
    double constant;                  /* C of e = C (z^order - z_against^order) */
    char label[BR_CELL_NAME];         /* "n = 40", for messages */
    bool lost;              /* the search for the order left it out, and nothing before it */
    char failure[256];      /* of the march; "": it went well */
    struct br_estimate fit; /* the line of the order there, and its band; NaN: there is none, or
                               the order is that of a joint fit, which is no line */
    /* Of what a digit costs (work.h): */
    size_t program;         /* its place in a list */
    double cost, cost_half; /* with half the width of its 95 % interval; 0: it does not scatter */
    double effort;          /* of equal costs the smaller effort is cheaper */
    bool is_start;          /* its cost is mostly the start of the program */
    bool front, own;        /* it is on the Pareto front of all; on that of its program */
};

/* Compares points, for qsort: from coarse to fine. */
int br_by_size(const void *a, const void *b);

struct br_line_order {
    struct br_estimate order; /* the median and the 95 % interval; NaN: not known */
    struct br_estimate rate; /* of exponential convergence, which has no order: b of exp(-b n^g), */
    double power;            /* and g, with n = 1/z; NaN: it is none */
    double low99, high99;    /* the 99 % interval, of the rate if there is one: what is outside is
                                excluded */
    double law[BR_LAWS];     /* the probability of each law; all together 1, or 0 */
    struct br_estimate left; /* of differences of values: the error of the finest value, if they
                                converge as they did; of two alone, too */
    double converges, diverges; /* the probability of an order above 0.1, and of one below 0 */
    size_t first, last;         /* the most probable window of rows: those outside do not count, */
    size_t outlier;             /* nor does this row inside it; the number of rows: there is none */
    double floor;               /* F of the most probable law, in the unit of the errors; else 0 */
};

/* The order of point[count], from coarse to fine; rows that are left out, or whose error is not
 * above 0 or not finite, are left aside. An order of zero or less means that the errors stay or
 * grow. Not known with less than three rows. Errors weigh by their deviations, if all have one
 * above 0. No law describes a line better than the digits of its errors do, and the interval holds
 * what they leave open. Fails with BR_NO_MEMORY. */
enum br_status br_line_order_find(const struct br_point *point, size_t count,
                                  struct br_line_order *found, struct br_error *err);

/* What one more of n = 1/z divides the errors by: exp(b); NaN: they do not fall as exp(-b n). */
struct br_estimate br_exponential_factor(const struct br_line_order *found);

/* Why the order of a line does not rest on point[i]; BR_FLAG_NONE: it does. */
enum br_flag br_line_order_flag(const struct br_line_order *found, const struct br_point *point,
                                size_t i);

/* The order that two errors show, the coarser one first; NaN: one of them is not above 0, or no
 * order from -60 to 60 makes such differences. */
double br_point_rate(const struct br_point *coarse, const struct br_point *fine);

/* The line C (z^p - z_against^p) of an order p through the middle of the errors, that is, the mean
 * of their logarithms, at point[i]; and its band, by the lines of the order's low and high end,
 * which holds the line itself. Errors that are not above 0, or not finite, are left aside; NaN:
 * there are no others, or no order, or no interval of it. */
struct br_estimate br_line_fit(const struct br_point *point, size_t count, size_t i,
                               const struct br_estimate *order);

#endif
