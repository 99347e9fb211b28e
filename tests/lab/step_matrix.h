/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The eigenvalues of a rod's step: what the limit of the lagged contact (solver/laws.h) is held to.
 */
#ifndef BR_LAB_STEP_MATRIX_H
#define BR_LAB_STEP_MATRIX_H

#include "solver/march.h"

/* ---- nodal values, laid out as in solver/field.h, as functions of x ---- */

/* The displacement at xi, 0 to 1, in the element whose nodal unknowns begin at `at`; slope (out):
 * of a beam h w_x. */
double br_nodal_value(enum br_field_kind kind, size_t unknowns, const double *at, double xi,
                      double *slope);

struct br_nodal_shape {
    const struct br_field *field;
    const double *value;
    bool slope; /* the function is w_x of a beam, not w */
};

/* A function for the initial data of a scene. It and its clones borrow `nodal`. */
struct br_function br_nodal_function(struct br_nodal_shape *nodal);

/* ---- the matrix of a rod's Euler step against a closed contact with a lagged force, measured by
 * marches of one step, without use of the equations ---- */

/* A state is the displacements of the nodes, and then k times their velocities, m; the clamped node
 * is left out. */
size_t br_step_states(const struct br_field *rod);

/* Marches one step from each unit state, with the tip in contact; each gives a column. rod: an
 * axial field; stiffness: c_H, N/m; matrix (out): br_step_states squared values, by rows. Fails
 * with BR_NO_MEMORY and as marches do. */
enum br_status br_step_matrix(const struct br_field *rod, double stiffness, double *matrix,
                              struct br_error *err);

/* The size of the largest eigenvalue of that step (out). Fails as br_step_matrix, and with
 * BR_NOT_FINITE where the eigenvalues are not found. */
enum br_status br_step_radius(const struct br_field *rod, double stiffness, double *radius,
                              struct br_error *err);

#endif
