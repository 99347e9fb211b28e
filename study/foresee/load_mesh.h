/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Meshes on which loads are integrated, so that nothing of them can hide between the places. */
#ifndef BR_STUDY_FORESEE_LOAD_MESH_H
#define BR_STUDY_FORESEE_LOAD_MESH_H

#include "solver/proof.h"

/* Gauss's rule on [0, 1], exact for degree 9. */
enum { BR_LOAD_PLACES = 5 };
extern const double br_load_place[BR_LOAD_PLACES], br_load_weight[BR_LOAD_PLACES];

/* Values of f at the places of [from, to] along one variable, at the other's lower end in `box`. */
void br_load_values(const struct br_function *f, enum br_variable along, struct br_box box,
                    struct br_interval piece, double value[BR_LOAD_PLACES]);

/* Resolves f along one variable, where the other is one point, until what is not resolved is no
 * more than 1 % of *size: out, the integral of |f|. *mesh: out. Fails as br_resolve. */
enum br_status br_load_mesh(const struct br_function *f, enum br_variable along, struct br_box box,
                            struct br_mesh *mesh, double *size, struct br_error *err);

#endif
