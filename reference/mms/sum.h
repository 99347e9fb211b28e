/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sum of derivatives of one expression, as a function of x and t. */
#ifndef BR_MMS_SUM_H
#define BR_MMS_SUM_H

#include "reference/mms/derivative.h"

enum { BR_SUM_MOST_TERMS = 3 };

/* factor * derivative of that order */
struct br_term {
    double factor;
    struct br_order order;
};

struct br_sum {
    size_t count;
    struct br_term term[BR_SUM_MOST_TERMS];
    double x, t; /* m, s: where it is taken, whatever is asked for; NaN: as asked */
};

/* Makes a function of it; constant where neither x nor t occurs. Terms with the factor
 * zero cost nothing. Fails with BR_BAD_INPUT or BR_NO_MEMORY; *f is then zero. */
enum br_status br_sum_function(const struct br_sum *sum, const char *text, struct br_function *f,
                               struct br_error *err);

#endif
