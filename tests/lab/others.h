/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What others do with a line of errors, or of values: short programs of our own after the papers,
 * to stand beside the estimator on the same lines. They share no code with it. */
#ifndef BR_TESTS_LAB_OTHERS_H
#define BR_TESTS_LAB_OTHERS_H

#include "tests/lab/errors.h"

enum br_other {
    BR_OTHER_TRIPLE,    /* the finest rows. Orders: the last rate +- its change from the one before;
                         * limits: the finest value +- the GCI (Roache 1998, factor 1.25) */
    BR_OTHER_SQUARES,   /* all rows. Orders: regression of logarithms, its 95 % interval; limits:
                         * least squares of Eca and Hoekstra 2014, theoretical order 2 */
    BR_OTHER_BOOTSTRAP, /* of the residuals of the fit of all rows (Efron 1979) */
    BR_OTHER_ROBUST,    /* fits of every window to the finest row, three weights and two norms, each
                         * with bootstraps, all together: after Rider et al. 2016 and StREEQ */
    BR_OTHERS,
};
extern const char *const br_other_names[BR_OTHERS];

struct br_other_interval {
    double low, high; /* NaN: the method states none */
};

/* The interval of the order of errors. */
struct br_other_interval br_other_order(enum br_other other, const struct br_error_line *line);

/* The interval of the limit of values. */
struct br_other_interval br_other_limit(enum br_other other, const struct br_error_line *line);

#endif
