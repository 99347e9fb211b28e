/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The element loops of ladder.h, elements of a rung side by side in the lanes of vectors.
 * Every sum is taken in an order that depends on the mesh alone. */
#ifndef BR_STUDY_GRID_LADDER_KERNEL_H
#define BR_STUDY_GRID_LADDER_KERNEL_H

#include "solver/instruction_set.h"
#include "solver/modes.h"

/* One rung from its parent. */
struct br_projecting {
    struct br_view fine;    /* a function on ratio * n elements */
    size_t n, ratio;        /* elements of the rung; of its parent's, those in one of the rung */
    const double *transfer; /* E_j of the first (ratio + 1)/2 children, modes^2 by rows each, zero
                               below the diagonal; the others' are their mirror images */
    double *coarse;         /* out: modes in lanes (BR_IN_LANES) */
};

struct br_ladder_kernel {
    const char *name; /* the instruction set */
    size_t lanes;     /* of its vectors, at most BR_MOST_LANES, and of the modes in lanes */
    bool (*available)(void);

    /* coarse = sum_j E_j' fine_j; returns the sum of the squares of what that loses,
     * fine_j - E_j coarse. */
    double (*project)(const struct br_projecting *p);

    /* The sum of the squares of a - b, n elements; b has the modes in lanes. */
    double (*distance)(const struct br_view *a, size_t n, const double *b);
};

#define BR_LADDER_KERNEL(set) extern const struct br_ladder_kernel br_ladder_##set;
BR_INSTRUCTION_SETS(BR_LADDER_KERNEL)

/* NULL-terminated, the fastest first; the last runs anywhere. */
extern const struct br_ladder_kernel *const br_ladder_kernels[];

/* The first that is available. */
const struct br_ladder_kernel *br_ladder_kernel_best(void);

/* That of an instruction set by name; NULL: there is none. */
const struct br_ladder_kernel *br_ladder_kernel_find(const char *name);

#endif
