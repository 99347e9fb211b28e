/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Expressions: parsed from text, evaluated as functions, differentiated and multiplied out. A tree
 * is a list of nodes. Each node comes after its arguments, and equal nodes are stored once. */
#ifndef BR_STUDY_KNOWN_EXPRESSION_H
#define BR_STUDY_KNOWN_EXPRESSION_H

#include "solver/function.h"
#include "solver/kind.h"

struct br_load;
struct br_scene;

/* X(name, arguments, word): the operations. The word is the name of a function in a text, or the
 * operator between two arguments; a > b is stored as b < a, and a != b as !(a == b). `not`, `and`,
 * `or` and the comparisons give 1 or 0; `pow` is a^b; `choose` is a != 0 ? b : c; `step` is 0 below
 * zero and 1 from zero on. Of NaN, also as a condition, the value is NaN, except of x^0. */
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
    unsigned argument[3]; /* indices of earlier nodes */
    double number;        /* of BR_OP_NUMBER */
    bool uses_x, uses_t;  /* directly or through its arguments */
};

/* The last node is the value of the expression. */
struct br_tree {
    struct br_node *node; /* count; owned */
    size_t count;
};

void br_tree_clear(struct br_tree *tree);

/* The value of one operation on numbers, bit for bit as in evaluation. */
double br_operation_value(enum br_operation operation, double a, double b, double c);

/* The number of arguments of an operation, and its word. */
extern const struct br_operation_row {
    unsigned arguments;
    const char *word;
} br_operations[];

/* ---- construction ---- */

enum { BR_TREE_MOST_NODES = 10000 };

/* Stands for a node that could not be made. A node made from it is BR_NO_NODE, too. */
#define BR_NO_NODE ((unsigned)-1)

/* A tree under construction. It starts as zeros. Its last node is not yet its value. */
struct br_tree_builder {
    struct br_tree tree;
    size_t room;
    enum br_status status; /* BR_NO_MEMORY, or BR_BAD_INPUT: too many nodes */
    bool simplifies;       /* simplifies new nodes: a + 0 to a, a * 1 to a, a * 0 to 0 for any a */
};

/* Finds or appends a node; returns its index. An operation on numbers becomes a number. Arguments
 * that the operation does not take are ignored. */
unsigned br_tree_number(struct br_tree_builder *builder, double number);
unsigned br_tree_node(struct br_tree_builder *builder, enum br_operation operation, unsigned a,
                      unsigned b, unsigned c);

/* Copies node `root` of another tree and all nodes that it uses; returns its new index. */
unsigned br_tree_graft(struct br_tree_builder *builder, const struct br_tree *from, unsigned root);

/* The same, with nodes of the builder instead of x and t; BR_NO_NODE: x and t stay. */
unsigned br_tree_substitute(struct br_tree_builder *builder, const struct br_tree *from,
                            unsigned root, unsigned x, unsigned t);

/* Copies node `root` and all nodes that it uses into a tree. Fails with BR_NO_MEMORY or
 * BR_BAD_INPUT (too many nodes); *part is then empty. */
enum br_status br_tree_part(const struct br_tree *from, unsigned root, struct br_tree *part,
                            struct br_error *err);

/* The same from a builder, which is cleared in any case. */
enum br_status br_tree_finish(struct br_tree_builder *builder, unsigned root, struct br_tree *tree,
                              struct br_error *err);

/* ---- as a function ---- */

/* Makes a function that evaluates a tree. It takes the tree over, even after a failure
 * (BR_NO_MEMORY; *f is then zero). A tree of one number becomes a constant. */
enum br_status br_tree_function(struct br_tree *tree, struct br_function *f, struct br_error *err);

/* The tree of such a function, borrowed; NULL for a constant and for other functions. */
const struct br_tree *br_tree_of(const struct br_function *f);

/* ---- from a text ---- */

/* Expressions in x and t, as text. Operators from the loosest to the tightest binding:
 *
 *     a ? b : c   ||   &&   < <= > >= == !=   + -   * /   - + ! (in front)   ^
 *
 * ?: and ^ group from the right, + - * / from the left, and comparisons not at all. Functions: sin
 * cos tan asin acos atan sinh cosh tanh asinh acosh atanh exp expm1 ln log (both natural) log2
 * log10 sqrt abs sign step (0 below zero, 1 from zero on), and min max of two or more. Constants:
 * pi, e. The decimal point is a point in any locale. A comparison gives 1 or 0; as a condition, any
 * number but zero is true. */

/* Limits of a text: its operations, and the nesting depth of its brackets, signs and powers. */
enum { BR_EXPRESSION_MOST_NODES = 1000, BR_EXPRESSION_MOST_DEPTH = 100 };

/* Parses a text. Fails with BR_BAD_INPUT, naming the column, what was found and what was expected,
 * or BR_NO_MEMORY; *tree is then empty. */
enum br_status br_expression_parse(const char *text, struct br_tree *tree, struct br_error *err);

/* Parses a text into a function. Without x and t it is a constant, which must be finite. Fails
 * likewise; *function is then zero. */
enum br_status br_expression(const char *text, struct br_function *function, struct br_error *err);

/* ---- derivatives ---- */

/* The derivative with respect to one variable, simplified where a factor or term is 0 or 1. At a
 * kink or jump it is the derivative on one side: for abs(a) it is -1 below a = 0 and 1 from a = 0
 * on. For step, sign and comparisons it is 0. min, max and ?: are differentiated branch by branch.
 * Fails with BR_NO_MEMORY or BR_BAD_INPUT (too long); *out is then empty. */
enum br_status br_tree_derive(const struct br_tree *tree, enum br_variable by, struct br_tree *out,
                              struct br_error *err);

/* A sum of derivatives, as defined by br_function_ops.derive. Fails likewise. */
enum br_status br_tree_derivation(const struct br_tree *tree, const struct br_derivation *what,
                                  struct br_tree *out, struct br_error *err);

/* ---- products ---- */

/* Makes a load, a sum of products F(x) G(t), each of which a march assembles once. Multiplies out
 * sums, signs, quotients and integer powers of products. Any other expression in x and t remains
 * one term f(x, t). So does the product of two sums in x and t, since its terms might cancel. f is
 * taken over, even after a failure (BR_NO_MEMORY; *load is then zero). */
enum br_status br_products(struct br_function *f, struct br_load *load, struct br_error *err);

/* ---- manufactured solutions ---- */

/* Fills the loads, tip forces and initial data of a scene whose axial.solution or
 * bending.solution is given, so that these solve (1)-(12); a scene without one stays as it
 * is. A load is left as one term f(x, t). Refuses (BR_BAD_INPUT) a scene of which only one
 * modelled part has a solution, a solution beside what it determines, and what
 * br_given_check refuses; *culprit is then the part whose solution it is about. Fails with
 * BR_NO_MEMORY; br_scene_clear releases what was made until then. */
enum br_status br_manufactured_apply(struct br_scene *scene, enum br_field_kind *culprit,
                                     struct br_error *err);

#endif
