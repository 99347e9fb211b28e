/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What an expression is, between its text (expression.h) and those who evaluate, derive and bound
 * it: a list of nodes in which each stands behind its arguments. Equal nodes stand once. */
#ifndef BR_TREE_H
#define BR_TREE_H

#include "solver/function.h"

/* X(name, arguments, word): the operations. The word is how a person writes a function, or what
 * stands between both arguments. `not`, `and`, `or` and the comparisons are 1 or 0; `pow` is a^b;
 * `choose` is a != 0 ? b : c; `step` is 0 below zero and 1 from zero on. */
#define BR_OPERATION_LIST(X) \
    X(NUMBER, 0, "")         \
    X(X, 0, "x")             \
    X(T, 0, "t")             \
    X(NEGATE, 1, "-")        \
    X(NOT, 1, "!")           \
    X(SIN, 1, "sin")         \
    X(COS, 1, "cos")         \
    X(TAN, 1, "tan")         \
    X(ASIN, 1, "asin")       \
    X(ACOS, 1, "acos")       \
    X(ATAN, 1, "atan")       \
    X(SINH, 1, "sinh")       \
    X(COSH, 1, "cosh")       \
    X(TANH, 1, "tanh")       \
    X(ASINH, 1, "asinh")     \
    X(ACOSH, 1, "acosh")     \
    X(ATANH, 1, "atanh")     \
    X(EXP, 1, "exp")         \
    X(EXPM1, 1, "expm1")     \
    X(LOG, 1, "log")         \
    X(LOG2, 1, "log2")       \
    X(LOG10, 1, "log10")     \
    X(SQRT, 1, "sqrt")       \
    X(ABS, 1, "abs")         \
    X(SIGN, 1, "sign")       \
    X(STEP, 1, "step")       \
    X(ADD, 2, "+")           \
    X(SUBTRACT, 2, "-")      \
    X(MULTIPLY, 2, "*")      \
    X(DIVIDE, 2, "/")        \
    X(POW, 2, "^")           \
    X(MIN, 2, "min")         \
    X(MAX, 2, "max")         \
    X(LESS, 2, "<")          \
    X(LESS_EQUAL, 2, "<=")   \
    X(GREATER, 2, ">")       \
    X(GREATER_EQUAL, 2, ">=")\
    X(EQUAL, 2, "==")        \
    X(NOT_EQUAL, 2, "!=")    \
    X(AND, 2, "&&")          \
    X(OR, 2, "||")           \
    X(CHOOSE, 3, "?:")

enum br_operation {
#define X(name, arguments, word) BR_OP_##name,
    BR_OPERATION_LIST(X)
#undef X
};

struct br_node {
    enum br_operation operation;
    unsigned argument[3]; /* of nodes that stand before this one */
    double number;        /* of BR_OP_NUMBER */
    bool uses_x, uses_t;  /* itself or through its arguments */
};

/* The last node is the expression's value. */
struct br_tree {
    struct br_node *node; /* count; owned */
    size_t count;
};

#endif
