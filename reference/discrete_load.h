/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The load vector and the initial data of the exact discrete solution; for discrete.c alone. */
#ifndef BR_REFERENCE_DISCRETE_LOAD_H
#define BR_REFERENCE_DISCRETE_LOAD_H

#include "reference/discrete_field.h"

/* The forces on a field, as functions of its own. */
struct br_discrete_load {
    struct br_load load;                      /* clones */
    struct br_function tip_force, tip_moment; /* clones */
    long double *vector[BR_LOAD_TERMS];       /* of each term; NULL: there is none */
    long double tip[BR_DISCRETE_MOST];        /* now: N on the tip's unknowns */
};

/* Fails with BR_NOT_FINITE, BR_NO_MEMORY; clear it even then. */
enum br_status br_discrete_load_init(struct br_discrete_load *load, const struct br_scene *scene,
                                     enum br_field_kind kind, struct br_discrete_field *field,
                                     struct br_error *err);
void br_discrete_load_clear(struct br_discrete_load *load);

/* At time t, s. Fails with BR_NOT_FINITE, BR_NO_MEMORY. */
enum br_status br_discrete_load_update(struct br_discrete_load *load,
                                       struct br_discrete_field *field, double t,
                                       struct br_error *err);

/* The interpolant of the scene's initial data as the field's state. Fails with BR_NOT_FINITE,
 * BR_NO_MEMORY. */
enum br_status br_discrete_set_initial(struct br_discrete_field *field,
                                       const struct br_scene *scene, enum br_field_kind kind,
                                       struct br_error *err);

#endif
