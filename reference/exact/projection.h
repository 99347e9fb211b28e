/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The L2 projection of a series on the elements of pieces.h on polynomials on equal elements. */
#ifndef BR_REFERENCE_EXACT_PROJECTION_H
#define BR_REFERENCE_EXACT_PROJECTION_H

#include "reference/exact/exact.h"
#include "reference/exact/pieces.h"

struct br_piecewise;

/* *out (owned by the store). Series have `extra` more terms. Fails with BR_NO_MEMORY or
 * BR_SINGULAR. */
enum br_status br_piecewise_create(struct br_piecewise **out, const struct br_pieces *pieces,
                                   size_t extra, const struct br_exact_mesh *mesh,
                                   struct br_store *store, struct br_error *err);

/* c and rest as br_exact_projection_apply has them. For one thread at a time. */
void br_piecewise_apply(struct br_piecewise *piecewise, const double *series, double *c,
                        double *rest);

#endif
