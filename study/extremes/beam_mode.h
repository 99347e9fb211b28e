/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The lowest mode of a field on a mesh, as its elements have it, to start a free vibration with. */
#ifndef BR_STUDY_EXTREMES_BEAM_MODE_H
#define BR_STUDY_EXTREMES_BEAM_MODE_H

#include "solver/field.h"

enum { BR_MODE_ELEMENTS = 8, BR_MODE_UNKNOWNS = 2 * BR_MODE_ELEMENTS };

/* Of BR_MODE_ELEMENTS linear (axial) or Hermite (bending) elements: K phi = omega^2 M phi. */
struct br_beam_mode {
    enum br_field_kind kind;
    double length, omega;            /* m, 1/s */
    double phi[BR_MODE_UNKNOWNS];    /* without the clamped node: 1 at the tip */
    double weight[BR_MODE_UNKNOWNS]; /* M phi over phi'M phi: the part of the mode in a state */
};

/* Fails with BR_NO_MEMORY, and with BR_SINGULAR where the eigenvalues are not found. */
enum br_status br_beam_mode_find(struct br_beam_mode *mode, const struct br_scene *scene,
                                 enum br_field_kind kind, struct br_error *err);

/* The mode times an amplitude, m, as initial data: the nodal values are exact. It borrows the mode.
 * slope: of w, for bending. */
struct br_function br_beam_mode_function(const struct br_beam_mode *mode, bool slope);

/* How much of the mode is in nodal values of the field (in: clamped node included), m or m/s. */
double br_beam_mode_part(const struct br_beam_mode *mode, const double *nodal);

#endif
