/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Expressions in x and t, by muParser: + - * / ^, ?:, comparisons, sin cos tan
 * asin acos atan sinh cosh tanh exp expm1 ln log (both natural) log10 sqrt abs
 * sign min max, step (0 below zero, 1 from zero on), and the constants pi and e. */
#ifndef BR_EXPRESSION_H
#define BR_EXPRESSION_H

#include "solver/scene.h"

/* Makes a function of an expression. A constant expression becomes a constant;
 * uses_x and uses_t tell which variables occur. Fails with BR_BAD_INPUT and
 * muParser's reason, or BR_NO_MEMORY. */
enum br_status br_expression(const char *text, struct br_function *function, struct br_error *err);

#endif
