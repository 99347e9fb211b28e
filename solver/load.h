/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The load vector F_n of one field as a march steps through it. What a scene leaves
 * out costs nothing: terms F(x) G(t) are assembled once and summed every step, where there is more
 * than one; one of f(x, t) is a sum of such in cells (load_fit.h), or is assembled every step. */
#ifndef BR_SOLVER_LOAD_H
#define BR_SOLVER_LOAD_H

#include "solver/linear/linear_solver.h"
#include "solver/load_fit.h"

/* The forces on one field: per length and at the tip. Borrowed. */
struct br_forces {
    const struct br_load *load;           /* N/m */
    const struct br_function *tip_force;  /* of t, N */
    const struct br_function *tip_moment; /* of t, N m; NULL for axial */
    double duration;                      /* s: for t in [0, duration] */
};

/* Those of a scene. */
struct br_forces br_forces_of_scene(const struct br_scene *scene, enum br_field_kind kind);

struct br_step_load {
    struct br_drive drive;                    /* at the time of the last update */
    struct br_load functions;                 /* clones, without terms that are zero */
    size_t terms;                             /* private from here on: of them */
    double *vector[BR_LOAD_TERMS];            /* of each term */
    struct br_load_fit *fit[BR_LOAD_TERMS];   /* of f(x, t), where it has one */
    double factor[BR_LOAD_TERMS];             /* of each, at the last update */
    double *sum;                              /* of more than one */
    struct br_function tip_force, tip_moment; /* clones */
};

/* Clones the functions of a field's forces. Fails with BR_NOT_FINITE or BR_NO_MEMORY;
 * clear it even then. */
enum br_status br_step_load_init(struct br_step_load *load, const struct br_forces *forces,
                                 const struct br_field *field, struct br_error *err);
void br_step_load_clear(struct br_step_load *load);

/* The load at time t, s. Fails with BR_NOT_FINITE, naming x and t, or BR_NO_MEMORY. */
enum br_status br_step_load_update(struct br_step_load *load, const struct br_field *field,
                                   double t, struct br_error *err);

#endif
