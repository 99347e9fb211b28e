/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An order that is expected, what was observed, and the verdict: from the order's 95 % interval,
 * not from a slope. */
#ifndef BR_ORDERS_EXPECTATION_CASE_H
#define BR_ORDERS_EXPECTATION_CASE_H

#include "orders/line/line_order.h"

enum br_verify_kind {
    BR_VERIFY_SPACE, /* over h, at one k: each mesh against the next, so the time error is the same
                      */
    BR_VERIFY_TIME,  /* over k, on one mesh: each step against the next, likewise */
    BR_VERIFY_JOINT, /* h and k together, against the solution of the continuous problem: a scheme
                        for another problem converges, too, but not to this solution */
    BR_VERIFY_KINDS,
};
extern const char *const br_verify_names[BR_VERIFY_KINDS];

/* A verdict needs at least four errors: two to fit an order, two to check it. Of more, all that
 * show the order count for it, and the finest five for the constant. */
enum { BR_VERIFY_LEAST_POINTS = 4, BR_VERIFY_MOST_POINTS = 5 };

/* e = C z^order, with z = h/L over space and z = k/T over time and jointly. */
struct br_expectation {
    double order, tolerance; /* the order's 95 % interval is to lie within order -+ tolerance;
                                tolerance 0: above order, which is the least */
    double floor, ceiling;   /* of C at the expected order, in the norm's unit; NaN: none */
    size_t line;             /* in the file that says so; 0: a default, or an option */
    double highest;   /* > order: or the errors fall by orders up to highest + tolerance, which
                         do not rise with refinement: two powers of z; else 0 */
    bool exponential; /* `order` is what one more of 1/z divides the errors by */
    double down_to;   /* the errors stop falling there; 0: nowhere */
    char why[160];    /* of a default: why not the formal order; or "" */
};

/* The ends of the band; infinite: there is none. */
double br_expectation_low(const struct br_expectation *expected);
double br_expectation_high(const struct br_expectation *expected);

/* What is expected of the order, as it is read: "2 +- 0.1", "2 to 4 +- 0.2 down to 1e-09",
 * "exponential 8 +- 0.5", ">= 1.8"; returns text. */
enum { BR_EXPECTATION_TEXT = 120 };
char *br_expectation_text(const struct br_expectation *expected, char text[BR_EXPECTATION_TEXT]);

/* Reads that, and what follows it of the constant: ", at most 3e-4 m", or ", constant 2e-4 to 3e-4
 * m", in that unit ("": none). Before it may stand h or k, the axis (out; BR_AXES: neither). An
 * order without a tolerance has a tenth. *at: moved to what follows. Fails with BR_BAD_INPUT. */
enum br_status br_expectation_read(const char **at, const char *unit, enum br_axis *axis,
                                   struct br_expectation *expected, struct br_error *err);

/* Refuses (BR_BAD_INPUT) a band without sense: it contains 0, or has no order above 0. */
enum br_status br_expectation_check(const struct br_expectation *expected, struct br_error *err);

enum br_verdict {
    BR_PASS,         /* the interval lies within the band */
    BR_FAIL,         /* it lies outside; or the constant is out of its range; or an error is not
                        a number, or missing */
    BR_INCONCLUSIVE, /* it straddles, or too few points are left: counts as failing */
};
extern const char *const br_verdict_names[]; /* "PASS", "FAIL", "INCONCLUSIVE" */

/* An expectation and what was observed. */
struct br_case {
    enum br_verify_kind kind;
    struct br_expectation expected; /* order: NaN where nothing is expected */
    const char *measure, *part;     /* norm, or column, of the errors; borrowed */
    const char *unit;               /* of the errors; "": not known; borrowed */
    struct br_point *point;         /* points, from coarse to fine; owned */
    size_t points, used;
    bool may_miss; /* a point without a number is left out by name; else it fails the case */
    struct br_estimate order;
    double low99, high99;      /* the 99 % interval of the order, or of the factor's logarithm: what
                                  lies outside is excluded */
    struct br_estimate factor; /* exponential convergence: one more of 1/z divides the error by it;
                                  NaN: it is none, or that of n^g */
    double exponential;        /* the probability of such convergence, of any g */
    const char *window;        /* rows by hand, "the 3 finest of 6"; NULL: all; borrowed */
    enum br_law law;           /* what explains the errors best; BR_LAW_POWER: one power alone */
    double constant;           /* the largest of the finest five used points'; NaN: none */
    const char *open; /* why there is no verdict, and what would show an order; NULL; borrowed */
    bool of_degree;   /* z is one over a degree and one: there is no order */
    bool of_grid; /* the order is that of a joint fit, orders from point to point are another axis's
                   */
    double margin; /* from the interval to the nearer end of the band; < 0: outside */
    enum br_verdict verdict;
    char reason[768]; /* why it does not pass, and what would make it pass or fail; or "" */
    char note[512];   /* what was left out; or "" */
};

/* Finds the order of a case, and leaves out the points that do not show it (line_order.h), whose
 * kind, expected, measure, part, unit and points (at, against, z, z_against, error, label, flag,
 * failure) are set, from at least so many that are not left out; without a verdict. Fails with
 * BR_NO_MEMORY. */
enum br_status br_case_observe(struct br_case *c, size_t least, struct br_error *err);

/* The note, and the law that the errors also show; returns text. */
enum { BR_CASE_NOTE = 640 };
char *br_case_note(const struct br_case *c, char text[BR_CASE_NOTE]);

/* Takes an order and a constant from elsewhere, the joint fit of a grid, which describes all
 * points: none is left out. */
void br_case_take_order(struct br_case *c, struct br_estimate order, double constant);

/* The verdict on what was observed. */
void br_case_decide(struct br_case *c);

/* ---- growth.c ---- */

/* Where the errors begin to grow, by one law over all of them; NULL: they do not grow so. */
const struct br_point *br_turning_point(const struct br_case *c);

/* What one power leaves of so many coarse rows, in squares of logarithms; rows without an error are
 * left aside. */
double br_squares_of_power(const struct br_case *c, size_t rows);

#endif
