/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sums of rows of a table, which is what a projection consists of. */
#ifndef BR_REFERENCE_EXACT_COMBINE_H
#define BR_REFERENCE_EXACT_COMBINE_H

#include <stdbool.h>
#include <stddef.h>

/* out[j] (out, width) = sum over k < count of factor[k] table[k * width + j]. The same bits
 * on every instruction set: a sum goes from the first k to the last. */
typedef void br_combine(size_t count, const double *factor, size_t width, const double *table,
                        double *out);

struct br_combiner {
    const char *name; /* the instruction set */
    bool (*available)(void);
    br_combine *combine;
};

/* The fastest first; the last one runs anywhere, and ends the list. */
extern const struct br_combiner br_combiners[];
extern const size_t br_combiner_count;

/* The first that is available. */
br_combine *br_combine_best(void);

#endif
