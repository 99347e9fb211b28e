/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the tolerance of IDA is relative to: each kind of unknown (u, w, h w_x and their
 * velocities) has a scale, its largest value at any node so far. A start from rest has none yet, so
 * a scale is at least a thousandth of what the largest of the loads would do at rest, for
 * velocities that over the duration. */
#ifndef BR_SOLVER_IDA_SCALE_H
#define BR_SOLVER_IDA_SCALE_H

#include "solver/ida_system.h"

struct br_ida_scale {
    struct br_ida_system *system; /* borrowed */
    double tolerance;
    double largest[6]; /* by the unknowns of a node, m and m/s */
};

/* Fails as br_ida_load. */
enum br_status br_ida_scale_init(struct br_ida_scale *scale, struct br_ida_system *system,
                                 double tolerance, struct br_error *err);

/* Makes the scales hold for y (in, count values), too. */
void br_ida_scale_see(struct br_ida_scale *scale, const double *y);

/* Weights of the unknowns' errors (out, count values), 1/m and s/m. */
void br_ida_scale_weights(const struct br_ida_scale *scale, double *weight);

/* The scale of the tip's displacement (0) or velocity (1), m or m/s. */
double br_ida_scale_of_tip(const struct br_ida_scale *scale, enum br_field_kind kind,
                           int derivative);

#endif
