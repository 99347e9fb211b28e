/* SPDX-License-Identifier: GPL-3.0-or-later */
/* |A c|^2 for a tall matrix A that comes in blocks, as |R c|^2 with a triangle: A = Q R. */
#ifndef BR_REFERENCE_EXACT_REMAINDER_H
#define BR_REFERENCE_EXACT_REMAINDER_H

#include "solver/status.h"

struct br_remainder {
    size_t columns, block; /* rows of a block; 0: there is nothing, R stays 0 */
    double
        *a; /* (columns + block) x columns, by columns: R, upper triangle, above the next block */
    double *tau; /* workspace */
};

/* R = 0. Clear it even after a failure, which is BR_NO_MEMORY. */
enum br_status br_remainder_init(struct br_remainder *remainder, size_t columns, size_t block,
                                 struct br_error *err);
void br_remainder_clear(struct br_remainder *remainder);

/* An entry of R or of the next block. */
double *br_remainder_r(const struct br_remainder *remainder, size_t row, size_t column);
double *br_remainder_block(const struct br_remainder *remainder, size_t row, size_t column);

/* Adds the block to R, and clears it. Fails with BR_NO_MEMORY or BR_SINGULAR. */
enum br_status br_remainder_add(struct br_remainder *remainder, struct br_error *err);

#endif
