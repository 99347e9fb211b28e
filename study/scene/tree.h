/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What an expression is, between its text (expression.h) and those who evaluate, derive and bound
 * it: a list of nodes in which each stands behind its arguments. Equal nodes stand once. */
#ifndef BR_STUDY_SCENE_TREE_H
#define BR_STUDY_SCENE_TREE_H

#include "solver/function.h"

/* X(name, arguments, word): the operations. The word is how a person writes a function, or what
 * stands between both arguments. `not`, `and`, `or` and the comparisons are 1 or 0; `pow` is a^b;
 * `choose` is a != 0 ? b : c; `step` is 0 below zero and 1 from zero on. Where an argument is no
 * number, a condition's, too, neither is the value (but of x^0). */
#define BR_OPERATION_LIST(X)  \
    X(NUMBER, 0, "")          \
    X(X, 0, "x")              \
    X(T, 0, "t")              \
    X(NEGATE, 1, "-")         \
    X(NOT, 1, "!")            \
    X(SIN, 1, "sin")          \
    X(COS, 1, "cos")          \
    X(TAN, 1, "tan")          \
    X(ASIN, 1, "asin")        \
    X(ACOS, 1, "acos")        \
    X(ATAN, 1, "atan")        \
    X(SINH, 1, "sinh")        \
    X(COSH, 1, "cosh")        \
    X(TANH, 1, "tanh")        \
    X(ASINH, 1, "asinh")      \
    X(ACOSH, 1, "acosh")      \
    X(ATANH, 1, "atanh")      \
    X(EXP, 1, "exp")          \
    X(EXPM1, 1, "expm1")      \
    X(LOG, 1, "log")          \
    X(LOG2, 1, "log2")        \
    X(LOG10, 1, "log10")      \
    X(SQRT, 1, "sqrt")        \
    X(ABS, 1, "abs")          \
    X(SIGN, 1, "sign")        \
    X(STEP, 1, "step")        \
    X(ADD, 2, "+")            \
    X(SUBTRACT, 2, "-")       \
    X(MULTIPLY, 2, "*")       \
    X(DIVIDE, 2, "/")         \
    X(POW, 2, "^")            \
    X(MIN, 2, "min")          \
    X(MAX, 2, "max")          \
    X(LESS, 2, "<")           \
    X(LESS_EQUAL, 2, "<=")    \
    X(GREATER, 2, ">")        \
    X(GREATER_EQUAL, 2, ">=") \
    X(EQUAL, 2, "==")         \
    X(NOT_EQUAL, 2, "!=")     \
    X(AND, 2, "&&")           \
    X(OR, 2, "||")            \
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

void br_tree_clear(struct br_tree *tree);

/* One operation on numbers: what evaluation gives, bit for bit. */
double br_operation_value(enum br_operation operation, double a, double b, double c);

/* How many arguments it takes, and its word. */
unsigned br_operation_arguments(enum br_operation operation);
const char *br_operation_word(enum br_operation operation);

/* ---- to make one ---- */

enum { BR_TREE_MOST_NODES = 10000 };

/* Stands for a node that could not be made; what is made of it is none, either. */
#define BR_NO_NODE ((unsigned)-1)

/* A tree that grows; zeroed at first. Its last node is not its value. */
struct br_tree_builder {
    struct br_tree tree;
    size_t room;
    enum br_status status; /* BR_NO_MEMORY, or BR_BAD_INPUT: too many nodes */
};

/* A node, found or appended: its place. An operation on numbers is a number. Arguments that the
 * operation does not take are ignored. */
unsigned br_tree_number(struct br_tree_builder *builder, double number);
unsigned br_tree_node(struct br_tree_builder *builder, enum br_operation operation, unsigned a,
                      unsigned b, unsigned c);

/* Node `root` of another tree with all it uses: its place. */
unsigned br_tree_graft(struct br_tree_builder *builder, const struct br_tree *from, unsigned root);

/* What `root` uses, as a tree. Clears the builder in any case. Fails with BR_NO_MEMORY or
 * BR_BAD_INPUT (too many nodes); *tree is then empty. */
enum br_status br_tree_finish(struct br_tree_builder *builder, unsigned root, struct br_tree *tree,
                              struct br_error *err);

/* ---- as a function ---- */

/* A function that evaluates a tree, which it takes over, even where it fails (BR_NO_MEMORY; *f is
 * then zero). A tree of one number becomes a constant. */
enum br_status br_tree_function(struct br_tree *tree, struct br_function *f, struct br_error *err);

/* The tree of such a function, borrowed; NULL for a constant and for other functions. */
const struct br_tree *br_tree_of(const struct br_function *f);

#endif
