/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is proved of a tree over a box of x and t, by interval arithmetic (interval.h). */
#ifndef BR_STUDY_SCENE_ENCLOSURE_H
#define BR_STUDY_SCENE_ENCLOSURE_H

#include "study/scene/tree.h"

/* The highest order of Taylor coefficients, and how many intervals of workspace a node needs. */
enum { BR_TREE_MOST_ORDER = 16, BR_TREE_WORK = BR_TREE_MOST_ORDER + 1 };

/* As br_function_bound; work: BR_TREE_WORK intervals a node. Each node's natural extension is cut
 * with its mean value form: centre + slopes * (box - centre), so that halved boxes are enclosed
 * four times as tightly. */
bool br_tree_bound(const struct br_tree *tree, struct br_interval *work, struct br_box box,
                   struct br_interval *value);

/* As br_function_taylor, by the recurrences of Moore; order: up to BR_TREE_MOST_ORDER. */
bool br_tree_taylor(const struct br_tree *tree, struct br_interval *work, enum br_variable along,
                    struct br_box box, size_t order, struct br_interval *coefficient);

/* What a function of a tree needs for its proofs. */
struct br_proofs {
    struct br_interval *work;
    struct br_function *guard; /* guards: they work in `work`; clone them to keep them */
    size_t guards;
};

/* Makes them. Fails with BR_NO_MEMORY; clear it even then. */
enum br_status br_proofs_init(struct br_proofs *proofs, const struct br_tree *tree,
                              struct br_error *err);
void br_proofs_clear(struct br_proofs *proofs);

#endif
