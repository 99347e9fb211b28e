/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The operations of expressions by the C library's long double: what evaluation, enclosures and
 * derivatives are checked by. */
#ifndef BR_TESTS_OPERATION_ORACLE_H
#define BR_TESTS_OPERATION_ORACLE_H

#include "study/known/expression.h"

/* One operation with arguments. */
long double oracle_operation(enum br_operation operation, const long double a[3]);

/* The value of a tree; NaN where an argument of an operation, used or not, is not finite. */
long double oracle_tree(const struct br_tree *tree, long double x, long double t);

#endif
