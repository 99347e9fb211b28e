/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mixture of laws behind an order (line_order.h), between its parts: the rows, the windows of
 * rows that a law is fitted to (windows.c), two powers in one line (kinks.c), and the average of
 * all (mixture.c). */
#ifndef BR_ORDERS_LINE_MIXTURE_H
#define BR_ORDERS_LINE_MIXTURE_H

#include "orders/line/line_order.h"

/* ---- the mixture ---- */

/* Student's distribution of the order, from one parameter of one law in one window. */
struct br_law_part {
    double weight; /* its logarithm, until all are known */
    double mean, scale, freedom, floor, curve;
    double there, curve_there;    /* of values: the corrections at the finest one */
    double left, left_scale, own; /* logarithm of the error that is left there; its scatter, too */
    double power;                 /* g of the exponential law */
    double misfit;                /* the standard deviation of logarithms */
    enum br_law law;
    size_t first, last, outlier;
};

/* The windows from row first to first_most, and to row last to last_most, that matter, with the
 * logarithm of the largest weight in them, and the misfit of that one; outlier: whether a row
 * inside may not count. */
struct br_windows {
    double best, misfit;
    size_t first, first_most, last, last_most;
    bool outlier;
};

struct br_mixture {
    struct br_law_part *part; /* owned */
    struct br_windows within; /* the windows to try */
    struct br_windows found;  /* out, if only_best: those that matter */
    size_t rows;
    size_t count, room;
    double best;   /* the largest logarithm of a weight */
    double far;    /* of values: x of the finest one; NaN: they are errors */
    double finest; /* weight of the finest row by its scatter; 1: it is relative, as of all rows */
    double prior;  /* logarithm of that of the scatter */
    double within_cell; /* what a parameter that stands for others leaves of them, in logarithms */
    const double *log_gamma; /* by degrees of freedom, of half of them */
    bool few;                /* of two differences: their order is its prior alone */
    double keeps;            /* logarithm of weights below the best that are kept */
    bool only_best, starved;
};

void br_windows_join(struct br_windows *box, const struct br_windows *other);
void br_mixture_add(struct br_mixture *all, const struct br_law_part *p);

/* From logarithms to weights of sum 1; the least, together 0.2 %, are left out. */
void br_mixture_normalise(struct br_mixture *all);

/* Of parts with less than a share of the whole, one stands for as many as make that share. */
void br_mixture_thin(struct br_mixture *all);

double br_mixture_below(const struct br_mixture *all, double order);

/* The interval of 95 % of all parts, with the median; low99, high99: that of 99 %, or NULL. */
struct br_estimate br_mixture_estimate(const struct br_mixture *all, double *low99, double *high99);

/* ---- rows and windows ---- */

struct br_rows {
    size_t count;
    size_t *index;         /* in the points */
    double *z, *x, *y;     /* x, y: of the regression, slope p */
    double *ratio;         /* z_against / z */
    double *given;         /* the weight that is given, relative; 1: none is */
    double *log_given;     /* half its logarithm */
    double *rounded;       /* the variance of y by its printed digits; 0: it is not rounded */
    double order;          /* of the regression over all rows */
    double *bent, *weight; /* of a law: y - correction; relative to 1/sigma^2 */
    double *curve;         /* of a law: z^curve, 1 at the coarsest row; 0: it has none */
    double *log_density;   /* the part of the density of y that the weight does not cancel */
    double *change;        /* of a law: how large the correction is, 0 to 1 */
    double *noise;         /* log of the density of all rows behind this one, if they are noise */
    double *error;         /* log e */
    double *log_gamma;     /* by degrees of freedom, of half of them */
    double *other;         /* x of the exponential law */
    double *behind_x, *behind_y; /* means of x, and of y by a law, of all rows behind this one */
    struct br_law_place *place;  /* of a law */
};

/* log of 1 - ratio^p over p, and its derivative: the loss by a reference of finite resolution. */
double br_row_loss(double ratio, double p, double *slope);

struct br_sums {
    double w, x, y, xx, xy, yy, log_density; /* y: less start + order x, else digits cancel */
    double q, xq, yq, qq, unit;              /* q: the curve; unit: it at the first row */
    double v, xv, xxv; /* v: the variance by rounding, with the square of the weight */
    double start, order;
    double elsewhere, freedom; /* of a part of the rows with its own line: squares, and freedom */
    bool parted;               /* whether there is such a part */
    bool behind;               /* the curve is of the fine rows */
    double noise_x, noise_y; /* means of the rows that are left out as noise; NaN: there are none */
    size_t rows;
};

/* Sets the rows of a law without a correction. */
void br_rows_plain(const struct br_rows *r);

/* Adds a row to a window, or (sign < 0) takes it out again. */
void br_window_row(struct br_sums *s, const struct br_rows *r, size_t i, double sign);

/* Adds the distribution of the order of these sums. of: its law and window, and the logarithm of
 * their prior; least: the smallest standard deviation of a logarithm. */
void br_window_add(struct br_mixture *all, const struct br_sums *s, const struct br_law_part *of,
                   double least);

/* The logarithm of the density of so many rows at the coarse end that do not count. */
double br_window_coarse(size_t rows);

/* All windows of a law whose correction is set. Of many rows, not every window is tried. */
void br_window_all(struct br_mixture *all, const struct br_rows *r, struct br_law_part p);

/* One power whose constant drifts: not errors, but what they change by from row to row is scattered
 * independently. */
void br_window_drifts(struct br_mixture *all, const struct br_rows *r);

/* Sets the densities of the fine rows as noise. */
void br_window_take_noise(const struct br_rows *r);

/* One power, and from a row on, or from between two rows, another one. */
void br_kinks_add(struct br_mixture *all, const struct br_rows *r);

#endif
