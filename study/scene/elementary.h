/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The operations of expression.h on arrays. Elementary functions are SLEEF's, of the kind whose
 * bits do not depend on the processor (no fused operations, which not all have): at most 1 unit in
 * the last place from the truth, and 2 for sinh and cosh beyond 709 and asinh and acosh beyond
 * 1e150, where the C library stands in. A power of 1, 2, 3, 4 or -1 is products or a quotient.
 * Everything else is correctly rounded. All of it needs rounding to nearest. */
#ifndef BR_STUDY_SCENE_ELEMENTARY_H
#define BR_STUDY_SCENE_ELEMENTARY_H

#include <fenv.h>

#include "solver/instruction_set.h"
#include "study/scene/expression.h"

/* Loops for one instruction set. */
struct br_elementary {
    const char *name;
    size_t width; /* the doubles in its vectors */
    bool (*available)(void);
    /* From sin to log10, and pow. count: a multiple of the width; a, b: in; out: not a or b. All
     * are aligned for vectors. */
    void (*apply)(enum br_operation operation, size_t count, const double *a, const double *b,
                  double *out);
};

#define BR_ELEMENTARY_DECLARE(set) extern const struct br_elementary br_elementary_##set;
BR_INSTRUCTION_SETS(BR_ELEMENTARY_DECLARE)

/* All, the best first; NULL behind the last. Those that this processor has not must not be used. */
extern const struct br_elementary *const br_elementary_all[];

/* Any operation with arguments: out[i] = operation(a[i], b[i], c[i]); as `apply`. */
void br_operation_apply(const struct br_elementary *set, enum br_operation operation, size_t count,
                        const double *const argument[3], double *out);

/* Around what needs rounding to nearest: the mode before, to be set again. */
static inline int br_round_to_nearest(void)
{
    const int before = fegetround();
    if (before != FE_TONEAREST)
        fesetround(FE_TONEAREST);
    return before;
}

static inline void br_round_as_before(int before)
{
    if (before != FE_TONEAREST)
        fesetround(before);
}

#endif
