/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The operations of expression.h on arrays, on intervals and on Taylor series, and what is proved
 * of trees. All of it needs rounding to nearest. */
#ifndef BR_STUDY_SCENE_OPERATIONS_H
#define BR_STUDY_SCENE_OPERATIONS_H

#include <fenv.h>
#include <math.h>

#include "solver/instruction_set.h"
#include "study/scene/expression.h"

/* ---- on arrays ---- */

/* Elementary functions are SLEEF's, of the kind whose bits do not depend on the processor (no fused
 * operations, which not all have): at most 1 unit in the last place from the truth, and 2 for sinh
 * and cosh beyond 709 and asinh and acosh beyond 1e150, where the C library stands in. A power of
 * 1, 2, 3, 4 or -1 is products or a quotient. Everything else is correctly rounded. */

/* Loops for one instruction set. */
struct br_elementary {
    size_t width; /* the doubles in its vectors */
    /* Any operation with arguments a, b and c: out[i] = operation(a[i], b[i], c[i]). count: a
     * multiple of the width; out: none of the arguments. All are aligned for vectors. */
    void (*apply)(enum br_operation operation, size_t count, const double *const argument[3],
                  double *restrict out);
};

#define BR_ELEMENTARY_DECLARE(set) extern const struct br_elementary br_elementary_##set;
BR_INSTRUCTION_SETS(BR_ELEMENTARY_DECLARE)

/* All, the best first; NULL behind the last. Those before br_instruction_set_best must not be used.
 */
extern const struct br_elementary *const br_elementary_all[];

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

/* ---- on intervals ---- */

/* Each operation over all numbers of its arguments, rounded outward so that it encloses what exact
 * arithmetic gives and what evaluation gives, both. No number ("none", NaN at both ends) is where
 * the operation may have no value or a pole; an end may be infinite where it may overflow. */

static inline struct br_interval br_point(double a)
{
    return (struct br_interval){a, a};
}

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

static inline double br_magnitude(struct br_interval a) /* the largest |a| */
{
    return fmax(fabs(a.low), fabs(a.high));
}

extern const struct br_interval br_no_interval;

struct br_interval br_interval_add(struct br_interval a, struct br_interval b);
struct br_interval br_interval_subtract(struct br_interval a, struct br_interval b);
struct br_interval br_interval_multiply(struct br_interval a, struct br_interval b);
struct br_interval br_interval_divide(struct br_interval a, struct br_interval b);
struct br_interval br_interval_square(struct br_interval a);
struct br_interval br_interval_hull(struct br_interval a, struct br_interval b);

/* Any operation; `same`: its first and second argument are equal, not only their intervals. */
struct br_interval br_interval_apply(enum br_operation operation,
                                     const struct br_interval *argument, bool same);

/* ---- proofs of trees ---- */

/* What is proved of a tree over a box of x and t, by interval arithmetic. */

/* The highest order of Taylor coefficients, and how many intervals of workspace a node needs. */
enum { BR_TREE_MOST_ORDER = 16, BR_TREE_WORK = BR_TREE_MOST_ORDER + 1 };

/* As br_function_bound; work: BR_TREE_WORK intervals a node. Each node's natural extension is cut
 * with its mean value form: centre + slopes * (box - centre), so that halved boxes are enclosed
 * four times as tightly. */
bool br_tree_bound(const struct br_tree *tree, struct br_interval *work, struct br_box box,
                   struct br_interval *value);

/* As br_function_taylor, by the recurrences of Moore; order: up to BR_TREE_MOST_ORDER. */
bool br_tree_taylor(const struct br_tree *tree, struct br_interval *work, enum br_variable along,
                    struct br_box box, size_t order, struct br_interval *coefficient);

#endif
