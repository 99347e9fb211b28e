/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/subinterval.h"

#include <math.h>

enum br_status br_subinterval_init(struct br_subinterval *v, size_t count, struct br_error *err)
{
    v->count = count;
    v->coupling = br_allocate(count + 1, sizeof *v->coupling);
    v->r = br_allocate(count * count, sizeof *v->r);
    if (!v->coupling || !v->r)
        return br_no_memory(err, "a projection");
    for (size_t k = 0; k <= count; k++) {
        const long double x = (long double)k;
        v->coupling[k] = k ? x / (2 * sqrtl(4 * x * x - 1)) : 0;
    }
    return BR_OK;
}

void br_subinterval_clear(struct br_subinterval *v)
{
    free(v->coupling);
    free(v->r);
    *v = (struct br_subinterval){0};
}

/* The recurrence of p_{k+1} in x = first + width xi, where a product with xi is the same
 * recurrence in l. Small coefficients keep their digits: they only come from each other. */
void br_subinterval_move(struct br_subinterval *v, long double first, long double width)
{
    const size_t count = v->count;
    const long double *b = v->coupling;
    v->r[0] = 1;
    for (size_t k = 0; k + 1 < count; k++) {
        const long double *here = v->r + k * count, *before = k ? here - count : here;
        long double *next = v->r + (k + 1) * count;
        for (size_t l = 0; l <= k + 1; l++) {
            const long double left = l ? b[l] * here[l - 1] : 0;
            const long double right = l < k ? b[l + 1] * here[l + 1] : 0;
            next[l] =
                ((first - 0.5L + width / 2) * here[l] + width * (left + right) - b[k] * before[l]) /
                b[k + 1];
        }
    }
}
