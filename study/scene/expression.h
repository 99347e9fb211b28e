/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Expressions: read from a text, as trees, as functions, derived, and multiplied out. A tree is a
 * list of nodes in which each stands behind its arguments. Equal nodes stand once. */
#ifndef BR_STUDY_SCENE_EXPRESSION_H
#define BR_STUDY_SCENE_EXPRESSION_H

#include "solver/function.h"
#include "solver/scene.h"

/* X(name, arguments, word): the operations. The word is how a person writes a function, or what
 * stands between both arguments; a > b is b < a, and a != b is !(a == b). `not`, `and`, `or` and
 * the comparisons are 1 or 0; `pow` is a^b; `choose` is a != 0 ? b : c; `step` is 0 below zero and
 * 1 from zero on. Where an argument is no number, a condition's, too, neither is the value (but of
 * x^0). */
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
    X(EQUAL, 2, "==")        \
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
    bool simplifies;       /* new nodes: a + 0 is a, a * 1 is a, and a * 0 is 0, whatever a is */
};

/* A node, found or appended: its place. An operation on numbers is a number. Arguments that the
 * operation does not take are ignored. */
unsigned br_tree_number(struct br_tree_builder *builder, double number);
unsigned br_tree_node(struct br_tree_builder *builder, enum br_operation operation, unsigned a,
                      unsigned b, unsigned c);

/* Node `root` of another tree with all it uses: its place. */
unsigned br_tree_graft(struct br_tree_builder *builder, const struct br_tree *from, unsigned root);

/* The same with nodes of the builder in the place of x and t; BR_NO_NODE: x and t. */
unsigned br_tree_substitute(struct br_tree_builder *builder, const struct br_tree *from,
                            unsigned root, unsigned x, unsigned t);

/* What `root` uses, as a tree. Fails with BR_NO_MEMORY or BR_BAD_INPUT (too many nodes); *part is
 * then empty. */
enum br_status br_tree_part(const struct br_tree *from, unsigned root, struct br_tree *part,
                            struct br_error *err);

/* The same of a builder, which it clears in any case. */
enum br_status br_tree_finish(struct br_tree_builder *builder, unsigned root, struct br_tree *tree,
                              struct br_error *err);

/* ---- as a function ---- */

/* A function that evaluates a tree, which it takes over, even where it fails (BR_NO_MEMORY; *f is
 * then zero). A tree of one number becomes a constant. */
enum br_status br_tree_function(struct br_tree *tree, struct br_function *f, struct br_error *err);

/* The tree of such a function, borrowed; NULL for a constant and for other functions. */
const struct br_tree *br_tree_of(const struct br_function *f);

/* ---- from a text ---- */

/* Expressions in x and t, as a person writes them. From what binds least to what binds most:
 *
 *     a ? b : c   ||   &&   < <= > >= == !=   + -   * /   - + ! (in front)   ^
 *
 * ?: and ^ group from the right, + - * / from the left, and comparisons not at all. Functions: sin
 * cos tan asin acos atan sinh cosh tanh asinh acosh atanh exp expm1 ln log (both natural) log2
 * log10 sqrt abs sign step (0 below zero, 1 from zero on), and min max of two or more. Constants:
 * pi, e. A decimal point is a point in any locale. A comparison is 1 or 0, and not zero is true. */

/* The most operations of a text, and how deep its brackets, signs and powers may nest. */
enum { BR_EXPRESSION_MOST_NODES = 1000, BR_EXPRESSION_MOST_DEPTH = 100 };

/* Reads it. Fails with BR_BAD_INPUT, naming the column, what was found and what was expected, or
 * BR_NO_MEMORY; *tree is then empty. */
enum br_status br_expression_parse(const char *text, struct br_tree *tree, struct br_error *err);

/* Makes a function of it. Without x and t it is a constant, which must be finite. Fails likewise;
 * *function is then zero. */
enum br_status br_expression(const char *text, struct br_function *function, struct br_error *err);

/* ---- derivatives ---- */

/* Derivatives of expressions as expressions. */

/* The derivative by one variable, simplified where something is 0 or 1. At kinks and jumps it is
 * what it is beside them: that of abs(a) is -1 or, from a = 0 on, 1; that of step, sign and
 * comparisons is 0; and min, max and ?: are derived branch by branch. Fails with BR_NO_MEMORY or
 * BR_BAD_INPUT (too long); *out is then empty. */
enum br_status br_tree_derive(const struct br_tree *tree, enum br_variable by, struct br_tree *out,
                              struct br_error *err);

/* A sum of derivatives, as br_function_ops.derive has it. Fails likewise. */
enum br_status br_tree_derivation(const struct br_tree *tree, const struct br_derivation *what,
                                  struct br_tree *out, struct br_error *err);

/* ---- products ---- */

/* A load as a sum of products F(x) G(t), which a march assembles once. */

/* Multiplies out what is a sum of products: sums, signs, quotients and integer powers of products.
 * What mixes x and t, and the product of two sums that do (multiplied out, it may cancel), remains
 * one term f(x, t). f is taken over, even where it fails (BR_NO_MEMORY; *load is then zero). */
enum br_status br_products(struct br_function *f, struct br_load *load, struct br_error *err);

#endif
