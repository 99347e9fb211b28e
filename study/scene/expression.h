/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Expressions in x and t, as a person writes them. From what binds least to what binds most:
 *
 *     a ? b : c   ||   &&   < <= > >= == !=   + -   * /   - + ! (in front)   ^
 *
 * ?: and ^ group from the right, + - * / from the left, and comparisons not at all. Functions: sin
 * cos tan asin acos atan sinh cosh tanh asinh acosh atanh exp expm1 ln log (both natural) log2
 * log10 sqrt abs sign step (0 below zero, 1 from zero on), and min max of two or more. Constants:
 * pi, e. A decimal point is a point in any locale. A comparison is 1 or 0, and not zero is true. */
#ifndef BR_STUDY_SCENE_EXPRESSION_H
#define BR_STUDY_SCENE_EXPRESSION_H

#include "study/scene/tree.h"

/* The most operations of a text, and how deep its brackets, signs and powers may nest. */
enum { BR_EXPRESSION_MOST_NODES = 1000, BR_EXPRESSION_MOST_DEPTH = 100 };

/* Reads it. Fails with BR_BAD_INPUT, naming the column, what was found and what was expected, or
 * BR_NO_MEMORY; *tree is then empty. */
enum br_status br_expression_parse(const char *text, struct br_tree *tree, struct br_error *err);

/* Makes a function of it. Without x and t it is a constant, which must be finite. Fails likewise;
 * *function is then zero. */
enum br_status br_expression(const char *text, struct br_function *function, struct br_error *err);

#endif
