/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One exact solution for all who ask for a scene's while somebody has it: a fine run's auditor
 * and the exact reference beside it need the same one. */
#ifndef BR_REFERENCE_EXACT_SHARED_H
#define BR_REFERENCE_EXACT_SHARED_H

#include "reference/exact/exact.h"

/* *out: as br_exact_create would make it with at most max_modes modes (0: its default), or one
 * that somebody has and that would be the same. Give it back, and not later than the scene ends.
 * For any thread. Fails like br_exact_create. */
enum br_status br_exact_borrow(const struct br_exact **out, const struct br_scene *scene,
                               const struct br_exact_options *options, struct br_error *err);

/* The last one to give it back frees it. Accepts NULL. */
void br_exact_give_back(const struct br_exact *exact);

#endif
