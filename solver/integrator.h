/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A time scheme that is not made of Euler steps (scheme.h) and marches a scene by itself. */
#ifndef BR_SOLVER_INTEGRATOR_H
#define BR_SOLVER_INTEGRATOR_H

#include "solver/march.h"

struct br_integrator {
    /* As br_march_create, with checked arguments; free *self even after a failure. */
    enum br_status (*create)(void **self, const struct br_scene *scene, size_t n, size_t steps,
                             const struct br_method *method, struct br_error *err);
    void (*free)(void *self); /* accepts NULL */

    /* On to time level `level` = 1, 2, ... Fails as br_march_step does. */
    enum br_status (*advance)(void *self, size_t level, struct br_error *err);

    /* As br_march_get, br_march_strain_rate and br_march_tip_displacement, of modelled fields. */
    void (*get)(const void *self, enum br_field_kind kind, double *displacement, double *velocity);

    void (*strain_rate)(const void *self, enum br_field_kind kind, double *rate);
    double (*tip_displacement)(const void *self, enum br_field_kind kind);

    void (*tip)(const void *self, struct br_tip *tip);
    void (*counts)(const void *self, struct br_counts *counts);

    /* As br_march_switches. */
    size_t (*switches)(const void *self, const struct br_switch **first);
};

#endif
