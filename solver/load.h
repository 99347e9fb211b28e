/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The load vector F_n of one field as a march steps through it. Zero terms cost nothing. Terms F(x)
 * G(t) are assembled once; if there are several, they are summed in every step. A term f(x, t) is
 * fitted by sums of products in cells (load_fit.c), or is assembled in every step. */
#ifndef BR_SOLVER_LOAD_H
#define BR_SOLVER_LOAD_H

#include "solver/linear/linear_solver.h"
#include "solver/scene.h"

/* The largest magnitude of a load at some points of a field's mesh at time t, s; NaN is ignored. */
double br_load_peak(const struct br_field *field, const struct br_function *f, double t);

/* ---- a load f(x, t) that is no product, as a sum of few: load_fit.c ---- */

struct br_load_fit;

/* Fits f, N/m, on a field's mesh for t in [0, duration], s. *fit: out; NULL where f cannot be
 * fitted. Fails with BR_NO_MEMORY. */
enum br_status br_load_fit_create(const struct br_field *field, const struct br_function *f,
                                  double duration, struct br_load_fit **fit, struct br_error *err);
void br_load_fit_free(struct br_load_fit *fit); /* accepts NULL */

/* The load vector (out, as br_assemble_load has it) of f at time t, s, to the round-off of f's
 * largest value there. False: this accuracy is not proved at this t. f is the function that was
 * fitted, or a clone. */
bool br_load_fit_assemble(struct br_load_fit *fit, const struct br_function *f, double t,
                          double *vector);

/* ---- the load of a step ---- */

struct br_step_load {
    struct br_drive drive;                    /* at the time of the last update */
    struct br_load functions;                 /* clones, without terms that are zero */
    size_t terms;                             /* number of terms; private from here on */
    double *vector[BR_LOAD_TERMS];            /* of each term */
    struct br_load_fit *fit[BR_LOAD_TERMS];   /* of each f(x, t), or NULL */
    double factor[BR_LOAD_TERMS];             /* of each term, at the last update */
    double *sum;                              /* of several terms */
    struct br_store store;                    /* of the vectors */
    struct br_function tip_force, tip_moment; /* clones */
};

/* The forces of a scene on one field, per length and at the tip; their functions are cloned. Fails
 * with BR_NOT_FINITE or BR_NO_MEMORY; clear it even then. */
enum br_status br_step_load_init(struct br_step_load *load, const struct br_scene *scene,
                                 const struct br_field *field, struct br_error *err);
void br_step_load_clear(struct br_step_load *load);

/* The load at time t, s. Fails with BR_NOT_FINITE, naming x and t, or BR_NO_MEMORY. */
enum br_status br_step_load_update(struct br_step_load *load, const struct br_field *field,
                                   double t, struct br_error *err);

#endif
