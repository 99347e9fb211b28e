/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The values of a tree over a box, and its Taylor coefficients there (series.c), and its guards. */
#include "study/scene/operations.h"

#include <float.h>
#include <math.h>
#include <string.h>

typedef struct br_interval iv;

static iv variable_of(const struct br_node *n, struct br_box box)
{
    return n->operation == BR_OP_NUMBER ? br_point(n->number)
           : n->operation == BR_OP_X    ? box.x
                                        : box.t;
}

/* ---- Taylor coefficients ---- */

bool br_tree_taylor(const struct br_tree *tree, iv *work, enum br_variable along, struct br_box box,
                    size_t order, iv *coefficient)
{
    const enum br_operation variable = along == BR_X ? BR_OP_X : BR_OP_T;
    const size_t size = order + 1;
    const int rounding = br_round_to_nearest();
    for (size_t i = 0; i < tree->count; i++) {
        const struct br_node *n = &tree->node[i];
        iv *out = work + i * size;
        if (br_operation_arguments(n->operation)) {
            const iv *const argument[] = {work + n->argument[0] * size,
                                          work + n->argument[1] * size,
                                          work + n->argument[2] * size};
            br_series_apply(n->operation, order, argument, out);
            continue;
        }
        out[0] = variable_of(n, box);
        for (size_t k = 1; k <= order; k++)
            out[k] = br_point(k == 1 && n->operation == variable);
    }
    br_round_as_before(rounding);
    memcpy(coefficient, work + (tree->count - 1) * size, size * sizeof *coefficient);
    bool finite = true;
    for (size_t k = 0; k <= order; k++)
        finite &= br_is_finite(coefficient[k]);
    return finite;
}

/* ---- bounds ---- */

/* A node over a box: its range, its value at the box's centre, and its derivatives over the box by
 * x and by t; where these jump, all they may be between. And how far its evaluation may be from the
 * truth, which grows from node to node as a derivative does. */
enum { ERROR = 2, DIRECTIONS };
struct form {
    iv range, centre, slope[DIRECTIONS];
};

_Static_assert(sizeof(struct form) <= BR_TREE_WORK * sizeof(iv), "the workspace of a node");

/* The derivative in a direction, by the first Taylor coefficient. */
static iv slope_of(enum br_operation o, const struct form *const argument[3], int direction)
{
    iv series[3][2], out[2];
    bool constant = true;
    for (unsigned k = 0; k < 3; k++) {
        series[k][0] = argument[k]->range;
        series[k][1] = argument[k]->slope[direction];
        constant &= k >= br_operation_arguments(o) || br_is_zero(series[k][1]);
    }
    if (constant)
        return br_point(0);
    if (o == BR_OP_ABS && br_has_zero(series[0][0]))
        return br_interval_multiply((iv){-1, 1}, series[0][1]);
    if ((o == BR_OP_MIN || o == BR_OP_MAX) &&
        br_has_zero(br_interval_subtract(series[0][0], series[1][0])))
        return br_interval_hull(series[0][1], series[1][1]);
    br_series_apply(o, 1, (const iv *const[]){series[0], series[1], series[2]}, out);
    return out[1];
}

static void differentiate(enum br_operation o, const struct form *const argument[3], struct form *f)
{
    const bool exact = o == BR_OP_NEGATE || o == BR_OP_ABS || o == BR_OP_MIN || o == BR_OP_MAX ||
                       o == BR_OP_CHOOSE;
    for (int direction = 0; direction < DIRECTIONS; direction++)
        f->slope[direction] = slope_of(o, argument, direction);
    if (exact)
        return;
    /* 2.5 units, and that these sums are rounded, too */
    const double error = br_magnitude(f->slope[ERROR]) * (1 + 8 * DBL_EPSILON) +
                         3 * DBL_EPSILON * br_magnitude(f->range) + 8 * 0x1p-1074;
    f->slope[ERROR] = (iv){-error, error};
}

/* Cuts the range with centre + slopes * (box - middle) +- error. */
static void cut(struct br_box box, struct br_box middle, struct form *f)
{
    const iv along_x = br_interval_multiply(f->slope[0], br_interval_subtract(box.x, middle.x));
    const iv along_t = br_interval_multiply(f->slope[1], br_interval_subtract(box.t, middle.t));
    const iv mean = br_interval_add(br_interval_add(f->centre, along_x),
                                    br_interval_add(along_t, f->slope[ERROR]));
    if (!br_is_finite(mean) || mean.low > f->range.high || mean.high < f->range.low)
        return;
    f->range = (iv){fmax(f->range.low, mean.low), fmin(f->range.high, mean.high)};
}

static iv centre_of(iv a)
{
    return br_point(a.low + (a.high - a.low) / 2);
}

static bool are_equal(const struct br_node *n)
{
    return br_operation_arguments(n->operation) == 2 && n->argument[0] == n->argument[1];
}

static void bound_node(const struct br_node *n, const struct form *forms, bool wide,
                       struct br_box box, struct br_box middle, struct form *f)
{
    const struct form *const argument[] = {&forms[n->argument[0]], &forms[n->argument[1]],
                                           &forms[n->argument[2]]};
    iv range[3], centre[3];
    for (unsigned k = 0; k < 3; k++) {
        range[k] = argument[k]->range;
        centre[k] = argument[k]->centre;
    }
    f->range = br_interval_apply(n->operation, range, are_equal(n));
    if (!wide)
        return;
    f->centre = br_interval_apply(n->operation, centre, are_equal(n));
    differentiate(n->operation, argument, f);
    if (br_is_finite(f->range) && !br_is_point(f->range))
        cut(box, middle, f);
}

bool br_tree_bound(const struct br_tree *tree, iv *work, struct br_box box, iv *value)
{
    struct form *forms = (struct form *)work;
    const int rounding = br_round_to_nearest();
    const struct br_box middle = {centre_of(box.x), centre_of(box.t)};
    const bool wide = !br_is_point(box.x) || !br_is_point(box.t);
    for (size_t i = 0; i < tree->count; i++) {
        const struct br_node *n = &tree->node[i];
        struct form *f = &forms[i];
        if (br_operation_arguments(n->operation))
            bound_node(n, forms, wide, box, middle, f);
        else
            *f = (struct form){
                .range = variable_of(n, box),
                .centre = variable_of(n, middle),
                .slope = {br_point(n->operation == BR_OP_X), br_point(n->operation == BR_OP_T)}};
    }
    br_round_as_before(rounding);
    *value = forms[tree->count - 1].range;
    return br_is_finite(*value);
}

/* ---- guards ---- */

static bool is_truth(enum br_operation o)
{
    return o == BR_OP_NOT || (o >= BR_OP_LESS && o <= BR_OP_OR);
}

unsigned br_tree_guard(const struct br_tree *tree, const struct br_node *n, unsigned k,
                       struct br_tree_builder *b)
{
    const enum br_operation o = n->operation;
    const unsigned a = n->argument[k];
    const bool compares = o >= BR_OP_MIN && o <= BR_OP_EQUAL;
    const bool itself =
        o == BR_OP_ABS || o == BR_OP_SIGN || o == BR_OP_STEP ||
        (!is_truth(tree->node[a].operation) &&
         (o == BR_OP_NOT || o == BR_OP_AND || o == BR_OP_OR || (o == BR_OP_CHOOSE && k == 0)));
    if ((compares ? k > 0 : !itself) || !(n->uses_x || n->uses_t))
        return BR_NO_NODE;
    const unsigned first = br_tree_graft(b, tree, a);
    return compares
               ? br_tree_node(b, BR_OP_SUBTRACT, first, br_tree_graft(b, tree, n->argument[1]), 0)
               : first;
}
