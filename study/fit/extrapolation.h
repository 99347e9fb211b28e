/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the tips of a grid's cells say of the tip at h = k = 0, without any reference:
 * Richardson extrapolation with observed orders, first over k on each mesh, then over h. */
#ifndef BR_STUDY_FIT_EXTRAPOLATION_H
#define BR_STUDY_FIT_EXTRAPOLATION_H

#include "study/fit/fit.h"

/* The displacement of the tip at t = T in all cells of a grid. */
struct br_tips {
    size_t n_count, k_count;
    const size_t *n, *steps; /* ascending; borrowed */
    int axial_degree;        /* of the elements */
    double *value[2];        /* by br_field_kind: n_count * k_count by rows of equal n, m; NaN
                                where a cell failed or is unstable; owned */
};

/* Room for the tips of a grid, all NaN. Fails with BR_NO_MEMORY. */
enum br_status br_tips_create(struct br_tips *tips, const struct br_study *grid,
                              struct br_error *err);
enum br_status br_tips_of_study(struct br_tips *tips, const struct br_study *study,
                                struct br_error *err);
void br_tips_clear(struct br_tips *tips);

/* The value at h = k = 0, m. The interval is Roache's (1998): the distance from what the
 * formal order and the next coarser three cells would give, times 1.25; or, where no order
 * is observed, 3 times the last difference. NaN with less than three meshes or time steps.
 * What the intervals are worth is tested against the exact solution. */
struct br_estimate br_extrapolate(const struct br_tips *tips, enum br_field_kind kind);

#endif
