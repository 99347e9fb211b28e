/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The operations of expression.h on arrays, on intervals and on Taylor series, and bounds of trees.
 * All of these need rounding to nearest. */
#ifndef BR_STUDY_KNOWN_OPERATIONS_H
#define BR_STUDY_KNOWN_OPERATIONS_H

#include <fenv.h>
#include <math.h>

#include "solver/box.h"
#include "solver/instruction_set.h"
#include "study/known/expression.h"

/* ---- on arrays ---- */

/* Elementary functions are SLEEF's without fused operations, whose bits are the same on every
 * processor: at most 1 unit in the last place from the truth. The C library replaces them beyond
 * 709 for sinh and cosh and 1e150 for asinh and acosh: at most 2 units. A power of 1, 2, 3, 4 or -1
 * is products or a quotient. All other operations are correctly rounded. */

/* Loops for one instruction set. */
struct br_elementary {
    size_t width; /* doubles in a vector */
    /* Any operation: out[i] = operation(a[i], b[i], c[i]). count: a multiple of the width. out: not
     * one of the arguments. All arrays are aligned for vectors. */
    void (*apply)(enum br_operation operation, size_t count, const double *const argument[3],
                  double *restrict out);
};

#define BR_ELEMENTARY_DECLARE(set) extern const struct br_elementary br_elementary_##set;
BR_INSTRUCTION_SETS(BR_ELEMENTARY_DECLARE)

/* All instruction sets, the best first; NULL ends the list. Those before br_instruction_set_best
 * are not available on this machine. */
extern const struct br_elementary *const br_elementary_all[];

/* Sets rounding to nearest; returns the mode before, for br_round_as_before. */
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

/* ---- on intervals ---- */

/* Operations on all numbers of the arguments. The result is rounded outward, so that it encloses
 * both the exact values and the evaluated ones. It is "none" (NaN at both ends) where the operation
 * may have no value or a pole. An end is infinite where the operation may overflow. */

static inline bool br_is_none(struct br_interval a)
{
    return isnan(a.low) || isnan(a.high);
}

static inline bool br_is_finite(struct br_interval a) /* both ends, and not none */
{
    return isfinite(a.low) && isfinite(a.high);
}

static inline bool br_is_point(struct br_interval a)
{
    return a.low == a.high;
}

static inline bool br_has_zero(struct br_interval a)
{
    return a.low <= 0 && a.high >= 0;
}

static inline bool br_is_zero(struct br_interval a)
{
    return a.low == 0 && a.high == 0;
}

extern const struct br_interval br_no_interval;

struct br_interval br_interval_add(struct br_interval a, struct br_interval b);
struct br_interval br_interval_subtract(struct br_interval a, struct br_interval b);
struct br_interval br_interval_multiply(struct br_interval a, struct br_interval b);
struct br_interval br_interval_divide(struct br_interval a, struct br_interval b);
struct br_interval br_interval_square(struct br_interval a);
struct br_interval br_interval_hull(struct br_interval a, struct br_interval b);

/* Any operation; `same`: its first two arguments are equal, not only their intervals. */
struct br_interval br_interval_apply(enum br_operation operation,
                                     const struct br_interval *argument, bool same);

/* ---- bounds of trees, by interval arithmetic ---- */

/* The highest order of Taylor coefficients, and the intervals of workspace for each node. */
enum { BR_TREE_MOST_ORDER = 16, BR_TREE_WORK = BR_TREE_MOST_ORDER + 1 };

/* As br_function_bound; work: BR_TREE_WORK intervals for each node. The range of a node is its
 * natural interval extension, intersected with its mean value form, centre + slopes * (box -
 * centre). So a halved box is enclosed four times as tightly. */
bool br_tree_bound(const struct br_tree *tree, struct br_interval *work, struct br_box box,
                   struct br_interval *value);

/* As br_function_taylor, by Moore's recurrences; order: up to BR_TREE_MOST_ORDER. */
bool br_tree_taylor(const struct br_tree *tree, struct br_interval *work, enum br_variable along,
                    struct br_box box, size_t order, struct br_interval *coefficient);

#endif
