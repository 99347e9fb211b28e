/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One field of the exact discrete solution: what discrete.c and discrete_field.c share. */
#ifndef BR_REFERENCE_DISCRETE_FIELD_H
#define BR_REFERENCE_DISCRETE_FIELD_H

#include "reference/discrete.h"

enum {
    BR_DISCRETE_MOST = 2,       /* unknowns a node */
    BR_DISCRETE_NOW = 0,        /* the state that steps are taken with */
    BR_DISCRETE_START,          /* of the step */
    BR_DISCRETE_PAST,           /* Y_{n-2}, Y_{n-3} */
    BR_DISCRETE_RATE = 4,       /* Y' of the rows of a tableau */
    BR_DISCRETE_LAST_RATE = 10, /* of the step before */
    BR_DISCRETE_STATES,
};

/* Of an element, by its distance to the tip: q = -(gain y + inverse (g - G'p)). */
struct br_discrete_gain {
    long double gain[BR_DISCRETE_MOST][BR_DISCRETE_MOST];
    long double inverse[BR_DISCRETE_MOST][BR_DISCRETE_MOST]; /* S^-1, m/s per N */
};

struct br_discrete_field {
    size_t n, d; /* elements; unknowns a node, and strains an element */
    long double h, density, stiffness, viscosity;
    long double tau;                        /* s, that of the gains; 0: none yet */
    struct br_discrete_gain *gain;          /* n */
    long double *state[BR_DISCRETE_STATES]; /* 2 d n: strains, m; rates, m/s */
    size_t states;                          /* 1, or all */
    long double *response;                  /* d n: the rates for a unit force at
                                               the tip, m/s per N */
    long double compliance;                 /* its own at the tip, m/s per N */
    long double *free_rate;                 /* d n: without a force from the laws */
    long double *nodal;                     /* workspace, d (n + 1) */
    struct br_load functions;               /* clones, as the next two */
    struct br_function tip_force, tip_moment;
    long double *vector[BR_LOAD_TERMS]; /* of each term; NULL: there is none */
    long double *load;                  /* d (n + 1), N: now, without those at the tip */
};

/* A field of a scene at t = 0; `states`: 1, or BR_DISCRETE_STATES. Fails with BR_NOT_FINITE,
 * BR_NO_MEMORY; clear it even then. */
enum br_status br_discrete_field_init(struct br_discrete_field *f, const struct br_scene *scene,
                                      enum br_field_kind kind, size_t n, size_t states,
                                      struct br_error *err);
void br_discrete_field_clear(struct br_discrete_field *f);

/* Nodal values of state 0 (out, d (n + 1) each, m and m/s; either may be NULL). */
void br_discrete_field_get(const struct br_discrete_field *f, long double *displacement,
                           long double *velocity);

/* The tip's displacement, m, or velocity, m/s, in state 0. */
long double br_discrete_field_tip(const struct br_discrete_field *f, bool velocity);

/* The gains and the tip's response for steps of tau, s. Fails with BR_SINGULAR. */
enum br_status br_discrete_field_set_step(struct br_discrete_field *f, long double tau,
                                          struct br_error *err);

/* The tip's velocity (out), m/s, at the end of a step from state 0 without contact or friction,
 * with the forces of time t, s. Fails with BR_NOT_FINITE, BR_NO_MEMORY. */
enum br_status br_discrete_field_predict(struct br_discrete_field *f, double t,
                                         long double *velocity, struct br_error *err);

/* Ends that step: a force, N, resists the tip. */
void br_discrete_field_finish(struct br_discrete_field *f, long double force);

#endif
