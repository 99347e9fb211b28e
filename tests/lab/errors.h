/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random lines of errors, or of values, with an order that is known. */
#ifndef BR_TESTS_LAB_ERRORS_H
#define BR_TESTS_LAB_ERRORS_H

#include <stdbool.h>

#include "tests/checks.h"

enum { BR_MOST_ERRORS = 16 };

struct br_error_line {
    size_t rows;
    double h[BR_MOST_ERRORS];         /* from coarse to fine */
    double e[BR_MOST_ERRORS];         /* errors, or values */
    double deviation[BR_MOST_ERRORS]; /* of errors that are means; 0: they are not */
    bool values;                      /* their limit is not known */
    double truth; /* the order as h -> 0, floors and round-off aside; NaN: none */
    double other; /* the order may as well be this one: an interval holds both; NaN: it may not */
    double limit; /* of the values; NaN: none */
};

enum br_error_group {
    BR_SMOOTH_ERRORS,
    BR_NOISY_ERRORS,
    BR_HARD_ERRORS,
    BR_NO_ORDER,
    BR_TWO_ORDERS, /* of the finest rows, and of the coarse ones */
    BR_GROWTH,     /* at the fine end: a verdict is FAIL */
    BR_GROUPS,
};

/* Classes of lines; const records, the last one without a name. */
struct br_error_class {
    const char *name;
    enum br_error_group group;
    void (*draw)(struct br_test_random *random, struct br_error_line *line);
};
extern const struct br_error_class br_error_classes[];
extern const struct br_error_class br_limit_classes[];    /* of values, for their limits */
extern const struct br_error_class br_later_classes[];    /* held out at first (held_out.c) */
extern const struct br_error_class br_held_out_classes[]; /* chosen after the laws (held_out.c) */

#endif
