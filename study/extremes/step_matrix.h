/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The matrix of a rod's Euler step against a closed contact with a lagged force, as marches of one
 * step tell it: nothing is known here of the equations. */
#ifndef BR_STUDY_EXTREMES_STEP_MATRIX_H
#define BR_STUDY_EXTREMES_STEP_MATRIX_H

#include "solver/field.h"

/* A state is the displacements of the nodes, and then k times their velocities, m; the clamped node
 * is left out. */
size_t br_step_states(const struct br_field *rod);

/* Column by column a state of one unit, whose tip is not away from the obstacle, is marched by one
 * step. rod: an axial field; stiffness: c_H, N/m; matrix (out): br_step_states squared values, by
 * rows. Fails with BR_NO_MEMORY and as marches do. */
enum br_status br_step_matrix(const struct br_field *rod, double stiffness, double *matrix,
                              struct br_error *err);

/* The size of the largest eigenvalue of that step (out). Fails as br_step_matrix, and with
 * BR_NOT_FINITE where the eigenvalues are not found. */
enum br_status br_step_radius(const struct br_field *rod, double stiffness, double *radius,
                              struct br_error *err);

#endif
