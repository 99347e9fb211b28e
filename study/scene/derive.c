/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/expression.h"

#include <math.h>

/* ---- operations that see what is 0 and what is 1 ---- */

typedef struct br_tree_builder builder;

static bool is(const builder *b, unsigned i, double number)
{
    return i != BR_NO_NODE && b->tree.node[i].operation == BR_OP_NUMBER &&
           b->tree.node[i].number == number;
}

static unsigned number(builder *b, double value)
{
    return br_tree_number(b, value);
}

static unsigned of(builder *b, enum br_operation operation, unsigned a)
{
    return br_tree_node(b, operation, a, 0, 0);
}

static unsigned negate(builder *b, unsigned a)
{
    const bool twice = a != BR_NO_NODE && b->tree.node[a].operation == BR_OP_NEGATE;
    return is(b, a, 0) ? a : twice ? b->tree.node[a].argument[0] : of(b, BR_OP_NEGATE, a);
}

static unsigned add(builder *b, unsigned a, unsigned c)
{
    return is(b, a, 0) ? c : is(b, c, 0) ? a : br_tree_node(b, BR_OP_ADD, a, c, 0);
}

static unsigned subtract(builder *b, unsigned a, unsigned c)
{
    return is(b, c, 0) ? a : is(b, a, 0) ? negate(b, c) : br_tree_node(b, BR_OP_SUBTRACT, a, c, 0);
}

static unsigned multiply(builder *b, unsigned a, unsigned c)
{
    if (is(b, a, 0) || is(b, c, 1))
        return a;
    if (is(b, c, 0) || is(b, a, 1))
        return c;
    return is(b, a, -1)   ? negate(b, c)
           : is(b, c, -1) ? negate(b, a)
                          : br_tree_node(b, BR_OP_MULTIPLY, a, c, 0);
}

static unsigned divide(builder *b, unsigned a, unsigned c)
{
    return is(b, a, 0) || is(b, c, 1) ? a : br_tree_node(b, BR_OP_DIVIDE, a, c, 0);
}

static unsigned power(builder *b, unsigned a, unsigned c)
{
    return is(b, c, 0) ? number(b, 1) : is(b, c, 1) ? a : br_tree_node(b, BR_OP_POW, a, c, 0);
}

static unsigned square(builder *b, unsigned a)
{
    return power(b, a, number(b, 2));
}

/* 1 - a^2 and a^2 - 1, without cancellation */
static unsigned one_minus_square(builder *b, unsigned a)
{
    const unsigned one = number(b, 1);
    return multiply(b, subtract(b, one, a), add(b, one, a));
}

static unsigned square_minus_one(builder *b, unsigned a)
{
    const unsigned one = number(b, 1);
    return multiply(b, subtract(b, a, one), add(b, a, one));
}

/* ---- rules ---- */

/* f'(a) of an inverse function, or of one that is constant between jumps */
static unsigned outer_of_inverse(builder *b, enum br_operation operation, unsigned a)
{
    const unsigned one = number(b, 1);
    switch (operation) {
    case BR_OP_ASIN:
        return divide(b, one, of(b, BR_OP_SQRT, one_minus_square(b, a)));
    case BR_OP_ACOS:
        return divide(b, number(b, -1), of(b, BR_OP_SQRT, one_minus_square(b, a)));
    case BR_OP_ATAN:
        return divide(b, one, add(b, one, square(b, a)));
    case BR_OP_ASINH:
        return divide(b, one, of(b, BR_OP_SQRT, add(b, one, square(b, a))));
    case BR_OP_ACOSH:
        return divide(b, one, of(b, BR_OP_SQRT, square_minus_one(b, a)));
    case BR_OP_ATANH:
        return divide(b, one, one_minus_square(b, a));
    default: /* not, sign, step */
        return number(b, 0);
    }
}

/* f'(a) of a function of one argument, f = node i */
static unsigned outer(builder *b, enum br_operation operation, unsigned i, unsigned a)
{
    const unsigned one = number(b, 1);
    switch (operation) {
    case BR_OP_NEGATE:
        return number(b, -1);
    case BR_OP_SIN:
        return of(b, BR_OP_COS, a);
    case BR_OP_COS:
        return negate(b, of(b, BR_OP_SIN, a));
    case BR_OP_TAN:
        return add(b, one, square(b, i));
    case BR_OP_SINH:
        return of(b, BR_OP_COSH, a);
    case BR_OP_COSH:
        return of(b, BR_OP_SINH, a);
    case BR_OP_TANH:
        return divide(b, one, square(b, of(b, BR_OP_COSH, a)));
    case BR_OP_EXP:
        return i;
    case BR_OP_EXPM1:
        return of(b, BR_OP_EXP, a);
    case BR_OP_LOG:
        return divide(b, one, a);
    case BR_OP_LOG2:
        return divide(b, one, multiply(b, number(b, M_LN2), a));
    case BR_OP_LOG10:
        return divide(b, one, multiply(b, number(b, M_LN10), a));
    case BR_OP_SQRT:
        return divide(b, number(b, 0.5), i);
    case BR_OP_ABS:
        return subtract(b, multiply(b, number(b, 2), of(b, BR_OP_STEP, a)), one);
    default:
        return outer_of_inverse(b, operation, a);
    }
}

/* An argument: its node and its derivative. */
struct argument {
    unsigned value, slope;
};

/* (a^c)' = c a^(c-1) a' + a^c log(a) c' */
static unsigned of_power(builder *b, unsigned i, struct argument a, struct argument c)
{
    const unsigned less = power(b, a.value, subtract(b, c.value, number(b, 1)));
    const unsigned base = multiply(b, multiply(b, c.value, less), a.slope);
    if (is(b, c.slope, 0))
        return base;
    return add(b, base, multiply(b, multiply(b, i, of(b, BR_OP_LOG, a.value)), c.slope));
}

/* What a.slope and c.slope contribute where a is less (or greater) and elsewhere. */
static unsigned of_branches(builder *b, unsigned condition, unsigned yes, unsigned no)
{
    return yes == no ? yes : br_tree_node(b, BR_OP_CHOOSE, condition, yes, no);
}

static unsigned slope_of(builder *b, enum br_operation operation, unsigned i,
                         const struct argument a[3])
{
    switch (operation) {
    case BR_OP_ADD:
        return add(b, a[0].slope, a[1].slope);
    case BR_OP_SUBTRACT:
        return subtract(b, a[0].slope, a[1].slope);
    case BR_OP_MULTIPLY:
        return add(b, multiply(b, a[0].slope, a[1].value), multiply(b, a[0].value, a[1].slope));
    case BR_OP_DIVIDE: /* (a' - (a/b) b') / b */
        return divide(b, subtract(b, a[0].slope, multiply(b, i, a[1].slope)), a[1].value);
    case BR_OP_POW:
        return of_power(b, i, a[0], a[1]);
    case BR_OP_MIN:
        return of_branches(b, br_tree_node(b, BR_OP_LESS, a[0].value, a[1].value, 0), a[0].slope,
                           a[1].slope);
    case BR_OP_MAX:
        return of_branches(b, br_tree_node(b, BR_OP_GREATER, a[0].value, a[1].value, 0), a[0].slope,
                           a[1].slope);
    case BR_OP_CHOOSE:
        return of_branches(b, a[0].value, a[1].slope, a[2].slope);
    default:
        if (br_operation_arguments(operation) != 1 || is(b, a[0].slope, 0))
            return number(b, 0); /* numbers, variables, comparisons, and, or */
        return multiply(b, a[0].slope, outer(b, operation, i, a[0].value));
    }
}

enum br_status br_tree_derive(const struct br_tree *tree, enum br_variable by, struct br_tree *out,
                              struct br_error *err)
{
    builder b = {0};
    struct argument *at = br_allocate(tree->count, sizeof *at);
    *out = (struct br_tree){0};
    if (!at)
        return br_no_memory(err, "a derivative");
    for (size_t i = 0; i < tree->count; i++) {
        const struct br_node *n = &tree->node[i];
        const struct argument a[] = {at[n->argument[0]], at[n->argument[1]], at[n->argument[2]]};
        at[i].value = n->operation == BR_OP_NUMBER
                          ? number(&b, n->number)
                          : br_tree_node(&b, n->operation, a[0].value, a[1].value, a[2].value);
        if (n->operation == (by == BR_X ? BR_OP_X : BR_OP_T))
            at[i].slope = number(&b, 1);
        else
            at[i].slope = slope_of(&b, n->operation, at[i].value, a);
    }
    const unsigned root = at[tree->count - 1].slope;
    free(at);
    return br_tree_finish(&b, root, out, err);
}

/* ---- sums of them ---- */

static enum br_status derive_often(const struct br_tree *tree, struct br_partial order,
                                   struct br_tree *out, struct br_error *err)
{
    struct br_tree_builder copy = {0};
    enum br_status status =
        br_tree_finish(&copy, br_tree_graft(&copy, tree, (unsigned)tree->count - 1), out, err);
    for (int i = 0; i < order.x + order.t && !status; i++) {
        struct br_tree last = *out;
        status = br_tree_derive(&last, i < order.x ? BR_X : BR_T, out, err);
        br_tree_clear(&last);
    }
    return status;
}

/* A tree with numbers in the place of x and t (NaN: x and t). */
static unsigned graft_at(builder *b, const struct br_tree *tree, double x, double t)
{
    unsigned *place = br_allocate(tree->count, sizeof *place);
    if (!place) {
        b->status = BR_NO_MEMORY;
        return BR_NO_NODE;
    }
    for (size_t i = 0; i < tree->count; i++) {
        const struct br_node *n = &tree->node[i];
        if (n->operation == BR_OP_NUMBER)
            place[i] = number(b, n->number);
        else if (n->operation == BR_OP_X && !isnan(x))
            place[i] = number(b, x);
        else if (n->operation == BR_OP_T && !isnan(t))
            place[i] = number(b, t);
        else
            place[i] = br_tree_node(b, n->operation, place[n->argument[0]], place[n->argument[1]],
                                    place[n->argument[2]]);
    }
    const unsigned root = place[tree->count - 1];
    free(place);
    return root;
}

enum br_status br_tree_derivation(const struct br_tree *tree, const struct br_derivation *what,
                                  struct br_tree *out, struct br_error *err)
{
    builder b = {0};
    unsigned sum = number(&b, 0);
    enum br_status status = BR_OK;
    *out = (struct br_tree){0};
    for (size_t i = 0; i < what->count && !status; i++) {
        struct br_tree one;
        if (what->term[i].factor == 0)
            continue;
        status = derive_often(tree, what->term[i].order, &one, err);
        if (status)
            break;
        const unsigned factor = number(&b, what->term[i].factor);
        sum = add(&b, sum, multiply(&b, factor, graft_at(&b, &one, what->x, what->t)));
        br_tree_clear(&one);
    }
    if (!status)
        return br_tree_finish(&b, sum, out, err);
    br_tree_clear(&b.tree);
    return status;
}
