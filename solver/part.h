/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One field of a march: its solver, its load, and the states that its time scheme looks back to. */
#ifndef BR_SOLVER_PART_H
#define BR_SOLVER_PART_H

#include "solver/load.h"
#include "solver/march.h"
#include "solver/states.h"

struct br_part {
    bool modelled;
    struct br_field field; /* with the step of the stages, tau */
    const struct br_field_solver *solver;
    void *state;
    struct br_step_load load;
    size_t done;  /* steps */
    size_t since; /* steps since the last start, see scheme.h */
    size_t kept;  /* states that the solver keeps, its own not counted; 0: none is needed */
    size_t slot[BR_KNOWN]; /* which of them is what; 0: none */
    double rate_tau;       /* of BR_RATE, s */
    struct br_counts counts;
    long double load_size; /* of the load vector's largest entry for a factor of 1, N */
    long double moved_by;  /* the largest nodal force so far, N */
    double started_with;   /* the largest nodal value of the initial data, velocities times k, m */
};

/* Larger forces, N, initial data and tip values are refused: their squares are beyond a double. */
extern const double br_most_size;

/* A field of a scene at rest or as it starts, with its initial step, s, by a method. Where the
 * scheme looks back or has several stages, room is made for what it keeps. Fails as
 * br_march_create; clear it even then. */
enum br_status br_part_create(struct br_part *part, const struct br_scene *scene,
                              const struct br_field *field, const struct br_method *method,
                              struct br_error *err);
void br_part_clear(struct br_part *part);

/* The solver's state becomes one of those that are kept, BR_NOW say, if it is kept at all; and the
 * other way round. */
void br_part_keep(struct br_part *part, int known);
void br_part_recall(struct br_part *part, int known);

/* The state that the solver has is kept, where later stages or steps look back to it, and goes to
 * where stage i starts; the solver's step becomes its tau, for a step of k, s. Fails with
 * BR_SINGULAR or BR_NO_MEMORY. */
enum br_status br_part_start_stage(struct br_part *part, const struct br_stages *stages, int i,
                                   double k, struct br_error *err);

/* The tip's free velocity v* at time t, s. Fails as br_march_step. */
enum br_status br_part_predict(struct br_part *part, double t, double *velocity,
                               struct br_error *err);

/* The step of these stages is taken: what was BR_NOW is BR_BEFORE. switched: the next one starts
 * anew. */
void br_part_accept(struct br_part *part, const struct br_stages *stages, bool switched);

/* Sizes (out), as br_field_solver's size has them, of the error's estimate, the larger of its
 * strain by displacement and of what its strain rate leads to, and of the state's strain by
 * displacement. The last stage has not been followed by another. */
void br_part_estimate(struct br_part *part, const struct br_stages *stages, double *error,
                      double *state);

#endif
