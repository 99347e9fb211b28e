/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Derivatives of expressions as expressions. */
#ifndef BR_STUDY_SCENE_DERIVE_H
#define BR_STUDY_SCENE_DERIVE_H

#include "study/scene/tree.h"

/* The derivative by one variable, simplified where something is 0 or 1. At kinks and jumps it is
 * what it is beside them: that of abs(a) is -1 or, from a = 0 on, 1; that of step, sign and
 * comparisons is 0; and min, max and ?: are derived branch by branch. Fails with BR_NO_MEMORY or
 * BR_BAD_INPUT (too long); *out is then empty. */
enum br_status br_tree_derive(const struct br_tree *tree, enum br_variable by, struct br_tree *out,
                              struct br_error *err);

/* A sum of derivatives, as br_function_ops.derive has it. Fails likewise. */
enum br_status br_tree_derivation(const struct br_tree *tree, const struct br_derivation *what,
                                  struct br_tree *out, struct br_error *err);

#endif
