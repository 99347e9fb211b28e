/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One field of the exact discrete solution: what discrete.c and discrete_field.c share. */
#ifndef BR_REFERENCE_DISCRETE_FIELD_H
#define BR_REFERENCE_DISCRETE_FIELD_H

#include "reference/discrete.h"

#define BR_LONG
#include "solver/linear/plain.h"

enum {
    BR_DISCRETE_NOW = 0,        /* the current state */
    BR_DISCRETE_START,          /* of the step */
    BR_DISCRETE_PAST,           /* Y_{n-2}, Y_{n-3} */
    BR_DISCRETE_RATE = 4,       /* Y' of the rows of a tableau */
    BR_DISCRETE_LAST_RATE = 10, /* of the step before */
    BR_DISCRETE_STATES,
};

struct br_discrete_field {
    struct br_store store;           /* of all arrays */
    struct br_recursion recursion;   /* its step is 0 until one is set */
    real *state[BR_DISCRETE_STATES]; /* br_recursion_size each */
    size_t states;                   /* 1, or all */
    struct br_load functions;        /* clones, as the next two */
    struct br_function tip_force, tip_moment;
    real *vector[BR_LOAD_TERMS]; /* of each term, by nodes; NULL: there is none */
    real *load;                  /* N: at the current time, without those at the tip */
};

/* A field of a scene at t = 0; degree: of axial elements; `states`: 1, or BR_DISCRETE_STATES. Fails
 * with BR_NOT_FINITE, BR_NO_MEMORY; clear it even then. */
enum br_status br_discrete_field_init(struct br_discrete_field *f, const struct br_scene *scene,
                                      enum br_field_kind kind, size_t n, int degree, size_t states,
                                      struct br_error *err);
void br_discrete_field_clear(struct br_discrete_field *f);

/* The tip's velocity (out), m/s, at the end of a step from state 0 without contact or friction,
 * with the forces of time t, s. Fails with BR_NOT_FINITE, BR_NO_MEMORY. */
enum br_status br_discrete_field_predict(struct br_discrete_field *f, double t, real *velocity,
                                         struct br_error *err);

#endif
