/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A method: a row of each registry, and which rows can be combined. */
#ifndef BR_SOLVER_METHOD_H
#define BR_SOLVER_METHOD_H

#include "solver/laws.h"
#include "solver/scheme.h"

struct br_kernel;
struct br_linear_solver;

/* How a scene is marched. */
struct br_method {
    const struct br_time_scheme *scheme;
    double tolerance; /* of an adaptive scheme: error a step, relative to the largest strain */
    const struct br_linear_solver *solver;
    const struct br_kernel *kernel; /* of the solver riccati; NULL: the best that is available */
    const struct br_contact_rule *contact;
    const struct br_friction_rule *friction;
    struct br_iteration iteration; /* of friction rules that iterate */
    int axial_degree;              /* of the axial elements: 1, the paper's, or 2 */
    size_t most_steps; /* of an adaptive scheme, rejected ones included: more end the march with
                          BR_INTERRUPTED; 0: no limit */
};

/* The defaults: the first row of each registry, elements of degree 1. */
struct br_method br_method_default(void);

/* The linear solver of a field: the method's row, or, if that is a choice, the chosen row. */
const struct br_linear_solver *br_method_solver(const struct br_method *method,
                                                const struct br_field *field);

/* The round_off of that solver, and its residual (0 if it has none). */
double br_method_round_off(const struct br_method *method, const struct br_field *field);
double br_method_residual(const struct br_method *method, const struct br_field *field);

/* Estimated time of the linear solves of one step, ns: of all modelled fields on n elements. The
 * number of steps of an adaptive scheme is not known. */
double br_method_cost(const struct br_method *method, const struct br_scene *scene, size_t n);

/* The contact rule of a time scheme where none is chosen: the paper's where the scheme may lag,
 * else the first that takes its force at the new time level. */
const struct br_contact_rule *br_contact_rule_of(const struct br_time_scheme *scheme);

/* Refuses (BR_BAD_INPUT) a method that is invalid for this scene; rules for what the scene does not
 * model are not checked. scene: NULL refuses what is invalid for every scene. */
enum br_status br_method_check(const struct br_method *method, const struct br_scene *scene,
                               struct br_error *err);

/* Whether a march of n elements and steps of k, s, has a lagged contact beyond its stability limit
 * (laws.h): while it is closed, every step multiplies errors, and round-off. */
bool br_lagged_contact_grows(const struct br_method *method, const struct br_scene *scene, size_t n,
                             double k);

/* ---- damping ---- */

/* The largest step, s, with which a scheme that needs damping lets no mode of a field grow:
 * INFINITY where any will do. spring: whether an undamped spring at the tip, the contact, may
 * contribute to a mode's stiffness. */
double br_damping_largest_step(const struct br_field *field, bool spring);

/* Refuses (BR_BAD_INPUT) a march of a scheme that needs damping on n elements with a step of k, s,
 * where a mode would grow. */
enum br_status br_damping_check(const struct br_method *method, const struct br_scene *scene,
                                size_t n, double k, struct br_error *err);

#endif
