/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/operation_oracle.h"

#include <assert.h>
#include <math.h>

typedef long double real;

static real truth(bool is)
{
    return is ? 1 : 0;
}

/* Operations that are functions of the C library. */
static real (*const unary[])(real) = {
    [BR_OP_SIN] = sinl,     [BR_OP_COS] = cosl,     [BR_OP_TAN] = tanl,     [BR_OP_ASIN] = asinl,
    [BR_OP_ACOS] = acosl,   [BR_OP_ATAN] = atanl,   [BR_OP_SINH] = sinhl,   [BR_OP_COSH] = coshl,
    [BR_OP_TANH] = tanhl,   [BR_OP_ASINH] = asinhl, [BR_OP_ACOSH] = acoshl, [BR_OP_ATANH] = atanhl,
    [BR_OP_EXP] = expl,     [BR_OP_EXPM1] = expm1l, [BR_OP_LOG] = logl,     [BR_OP_LOG2] = log2l,
    [BR_OP_LOG10] = log10l, [BR_OP_SQRT] = sqrtl,   [BR_OP_ABS] = fabsl,
};

/* Comparisons and what else is 1, 0 or -1. */
static real decide(enum br_operation operation, real a, real b)
{
    switch (operation) {
    case BR_OP_NOT:
        return truth(a == 0);
    case BR_OP_SIGN:
        return truth(a > 0) - truth(a < 0);
    case BR_OP_STEP:
        return truth(a >= 0);
    case BR_OP_LESS:
        return truth(a < b);
    case BR_OP_LESS_EQUAL:
        return truth(a <= b);
    case BR_OP_EQUAL:
        return truth(a == b);
    case BR_OP_AND:
        return truth(a != 0 && b != 0);
    case BR_OP_OR:
        return truth(a != 0 || b != 0);
    default:
        return NAN;
    }
}

real oracle_operation(enum br_operation operation, const real a[3])
{
    if (operation < sizeof unary / sizeof *unary && unary[operation])
        return unary[operation](a[0]);
    switch (operation) {
    case BR_OP_NEGATE:
        return -a[0];
    case BR_OP_ADD:
        return a[0] + a[1];
    case BR_OP_SUBTRACT:
        return a[0] - a[1];
    case BR_OP_MULTIPLY:
        return a[0] * a[1];
    case BR_OP_DIVIDE:
        return a[0] / a[1];
    case BR_OP_POW:
        return powl(a[0], a[1]);
    case BR_OP_MIN:
        return fminl(a[0], a[1]);
    case BR_OP_MAX:
        return fmaxl(a[0], a[1]);
    case BR_OP_CHOOSE:
        return a[0] != 0 ? a[1] : a[2];
    default:
        return decide(operation, a[0], a[1]);
    }
}

static real value_of(const struct br_node *n, const real *value, real x, real t)
{
    real a[3] = {0};
    if (n->operation <= BR_OP_T)
        return n->operation == BR_OP_NUMBER ? n->number : n->operation == BR_OP_X ? x : t;
    for (unsigned k = 0; k < br_operations[n->operation].arguments; k++) {
        a[k] = value[n->argument[k]];
        if (!isfinite(a[k]))
            return NAN;
    }
    return oracle_operation(n->operation, a);
}

real oracle_tree(const struct br_tree *tree, real x, real t)
{
    real value[1000];
    assert(tree->count <= 1000);
    for (size_t i = 0; i < tree->count; i++)
        value[i] = value_of(&tree->node[i], value, x, t);
    return value[tree->count - 1];
}
