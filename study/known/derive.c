/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/known/expression.h"

#include <math.h>

/* ---- rules ---- */

/* The derivatives of f(x, t) with respect to each argument, without cancellation. An operation that
 * is not listed is constant between jumps, or is handled in slope_of. */
static const struct rule {
    enum br_operation operation;
    const char *by[2];
} rules[] = {
    {BR_OP_NEGATE, {"-1"}},
    {BR_OP_SIN, {"cos(x)"}},
    {BR_OP_COS, {"-sin(x)"}},
    {BR_OP_TAN, {"1 + tan(x)^2"}},
    {BR_OP_ASIN, {"1/sqrt((1 - x)*(1 + x))"}},
    {BR_OP_ACOS, {"-1/sqrt((1 - x)*(1 + x))"}},
    {BR_OP_ATAN, {"1/(1 + x^2)"}},
    {BR_OP_SINH, {"cosh(x)"}},
    {BR_OP_COSH, {"sinh(x)"}},
    {BR_OP_TANH, {"1/cosh(x)^2"}},
    {BR_OP_ASINH, {"1/sqrt(1 + x^2)"}},
    {BR_OP_ACOSH, {"1/sqrt((x - 1)*(x + 1))"}},
    {BR_OP_ATANH, {"1/((1 - x)*(1 + x))"}},
    {BR_OP_EXP, {"exp(x)"}},
    {BR_OP_EXPM1, {"exp(x)"}},
    {BR_OP_LOG, {"1/x"}},
    {BR_OP_LOG2, {"1/(0.69314718055994530942*x)"}},
    {BR_OP_LOG10, {"1/(2.30258509299404568402*x)"}},
    {BR_OP_SQRT, {"0.5/sqrt(x)"}},
    {BR_OP_ABS, {"2*step(x) - 1"}},
    {BR_OP_ADD, {"1", "1"}},
    {BR_OP_MULTIPLY, {"t", "x"}},
    {BR_OP_POW, {"t*x^(t - 1)", "x^t*log(x)"}},
};

typedef struct br_tree_builder builder;

/* The nodes of an argument and of its derivative. */
struct argument {
    unsigned value, slope;
};

static unsigned node(builder *b, enum br_operation operation, unsigned a, unsigned c)
{
    return br_tree_node(b, operation, a, c, 0);
}

/* Parses a rule and inserts both arguments. */
static unsigned follow(builder *b, const char *text, const struct argument a[2])
{
    struct br_tree rule;
    if (br_expression_parse(text, &rule, NULL)) {
        b->status = BR_NO_MEMORY;
        return BR_NO_NODE;
    }
    const unsigned out =
        br_tree_substitute(b, &rule, (unsigned)rule.count - 1, a[0].value, a[1].value);
    br_tree_clear(&rule);
    return out;
}

/* Applies the chain rule, without arguments of derivative 0: their factor may have no value, as the
 * logarithm of a negative number. The order of factors decides which nodes are shared. */
static unsigned by_rule(builder *b, enum br_operation operation, const struct argument a[2])
{
    unsigned sum = br_tree_number(b, 0);
    const unsigned zero = sum;
    for (const struct rule *r = rules; r < rules + sizeof rules / sizeof *rules; r++)
        for (int k = 0; k < 2 && r->operation == operation && r->by[k]; k++)
            if (a[k].slope != zero) {
                const unsigned partial = follow(b, r->by[k], a), slope = a[k].slope;
                const bool behind = k == 1 || operation == BR_OP_POW;
                sum = node(
                    b, BR_OP_ADD, sum,
                    node(b, BR_OP_MULTIPLY, behind ? partial : slope, behind ? slope : partial));
            }
    return sum;
}

static unsigned of_branches(builder *b, unsigned condition, unsigned yes, unsigned no)
{
    return yes == no ? yes : br_tree_node(b, BR_OP_CHOOSE, condition, yes, no);
}

static unsigned slope_of(builder *b, enum br_operation operation, unsigned value,
                         const struct argument a[3])
{
    switch (operation) {
    case BR_OP_SUBTRACT:
        return node(b, BR_OP_SUBTRACT, a[0].slope, a[1].slope);
    case BR_OP_DIVIDE: /* (a' - (a/b) b') / b */
        return node(b, BR_OP_DIVIDE,
                    node(b, BR_OP_SUBTRACT, a[0].slope, node(b, BR_OP_MULTIPLY, value, a[1].slope)),
                    a[1].value);
    case BR_OP_MIN:
        return of_branches(b, node(b, BR_OP_LESS, a[0].value, a[1].value), a[0].slope, a[1].slope);
    case BR_OP_MAX:
        return of_branches(b, node(b, BR_OP_LESS, a[1].value, a[0].value), a[0].slope, a[1].slope);
    case BR_OP_CHOOSE:
        return of_branches(b, a[0].value, a[1].slope, a[2].slope);
    default:
        return by_rule(b, operation, a);
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
        b.simplifies = false; /* keeps the expression as written */
        at[i].value = n->operation == BR_OP_NUMBER
                          ? br_tree_number(&b, n->number)
                          : br_tree_node(&b, n->operation, a[0].value, a[1].value, a[2].value);
        b.simplifies = true;
        at[i].slope = n->operation == (by == BR_X ? BR_OP_X : BR_OP_T)
                          ? br_tree_number(&b, 1)
                          : slope_of(&b, n->operation, at[i].value, a);
    }
    const unsigned root = at[tree->count - 1].slope;
    free(at);
    return br_tree_finish(&b, root, out, err);
}

/* ---- sums of derivatives ---- */

static enum br_status derive_often(const struct br_tree *tree, struct br_partial order,
                                   struct br_tree *out, struct br_error *err)
{
    enum br_status status = br_tree_part(tree, (unsigned)tree->count - 1, out, err);
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
    unsigned sum = br_tree_number(&b, 0);
    enum br_status status = BR_OK;
    *out = (struct br_tree){0};
    for (size_t i = 0; i < what->count && !status; i++) {
        struct br_tree one;
        if (what->term[i].factor == 0)
            continue;
        status = derive_often(tree, what->term[i].order, &one, err);
        if (status)
            break;
        const unsigned factor = br_tree_number(&b, what->term[i].factor);
        const unsigned x = isnan(what->x) ? BR_NO_NODE : br_tree_number(&b, what->x);
        const unsigned t = isnan(what->t) ? BR_NO_NODE : br_tree_number(&b, what->t);
        const unsigned there = br_tree_substitute(&b, &one, (unsigned)one.count - 1, x, t);
        b.simplifies = true;
        sum = node(&b, BR_OP_ADD, sum, node(&b, BR_OP_MULTIPLY, factor, there));
        b.simplifies = false;
        br_tree_clear(&one);
    }
    if (!status)
        return br_tree_finish(&b, sum, out, err);
    br_tree_clear(&b.tree);
    return status;
}
