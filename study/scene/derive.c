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

static unsigned negate(builder *b, unsigned a)
{
    const bool twice = a != BR_NO_NODE && b->tree.node[a].operation == BR_OP_NEGATE;
    return is(b, a, 0) ? a
           : twice     ? b->tree.node[a].argument[0]
                       : br_tree_node(b, BR_OP_NEGATE, a, 0, 0);
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

/* ---- rules ---- */

/* f'(x) of a function of one argument, whose value f(x) is t; without cancellation. Those of not,
 * sign and step, which are constant between jumps, are 0. */
static const struct {
    enum br_operation operation;
    const char *slope;
} rules[] = {
    {BR_OP_NEGATE, "-1"},
    {BR_OP_SIN, "cos(x)"},
    {BR_OP_COS, "-sin(x)"},
    {BR_OP_TAN, "1 + t^2"},
    {BR_OP_ASIN, "1/sqrt((1 - x)*(1 + x))"},
    {BR_OP_ACOS, "-1/sqrt((1 - x)*(1 + x))"},
    {BR_OP_ATAN, "1/(1 + x^2)"},
    {BR_OP_SINH, "cosh(x)"},
    {BR_OP_COSH, "sinh(x)"},
    {BR_OP_TANH, "1/cosh(x)^2"},
    {BR_OP_ASINH, "1/sqrt(1 + x^2)"},
    {BR_OP_ACOSH, "1/sqrt((x - 1)*(x + 1))"},
    {BR_OP_ATANH, "1/((1 - x)*(1 + x))"},
    {BR_OP_EXP, "t"},
    {BR_OP_EXPM1, "exp(x)"},
    {BR_OP_LOG, "1/x"},
    {BR_OP_LOG2, "1/(0.69314718055994530942*x)"},
    {BR_OP_LOG10, "1/(2.30258509299404568402*x)"},
    {BR_OP_SQRT, "0.5/t"},
    {BR_OP_ABS, "2*step(x) - 1"},
};

/* f'(a), f = node i */
static unsigned outer(builder *b, enum br_operation operation, unsigned i, unsigned a)
{
    struct br_tree rule;
    for (size_t k = 0; k < sizeof rules / sizeof *rules; k++)
        if (rules[k].operation == operation) {
            if (br_expression_parse(rules[k].slope, &rule, NULL)) {
                b->status = BR_NO_MEMORY;
                return BR_NO_NODE;
            }
            const unsigned out = br_tree_substitute(b, &rule, (unsigned)rule.count - 1, a, i);
            br_tree_clear(&rule);
            return out;
        }
    return number(b, 0);
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
    return add(b, base,
               multiply(b, multiply(b, i, br_tree_node(b, BR_OP_LOG, a.value, 0, 0)), c.slope));
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
        const unsigned x = isnan(what->x) ? BR_NO_NODE : number(&b, what->x);
        const unsigned t = isnan(what->t) ? BR_NO_NODE : number(&b, what->t);
        const unsigned there = br_tree_substitute(&b, &one, (unsigned)one.count - 1, x, t);
        sum = add(&b, sum, multiply(&b, factor, there));
        br_tree_clear(&one);
    }
    if (!status)
        return br_tree_finish(&b, sum, out, err);
    br_tree_clear(&b.tree);
    return status;
}
