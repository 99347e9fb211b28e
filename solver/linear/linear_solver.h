/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Linear solvers: one interface, one row each in the registry.
 *
 * A solver owns the state (displacement and velocity) of one field and takes it
 * through implicit Euler steps of equation (27) or (28). Contact and friction
 * act on the tip alone, so a step is two halves: `predict` solves with no tip
 * force and gives the tip's velocity v*; the laws then find the force r that
 * resists the tip's motion; `finish` completes the step with v = v* - r z, where
 * z = (M/k + C + kK)^-1 e_tip is computed once.
 *
 * To add a solver: one file that defines a `const struct br_linear_solver`, and
 * one row in linear_solver.c. */
#ifndef BR_SOLVER_LINEAR_SOLVER_H
#define BR_SOLVER_LINEAR_SOLVER_H

#include "solver/field.h"
#include "solver/linear/riccati/kernel.h"

/* The loads on a field in one step: the load vector factor * vector, and forces on the tip. */
struct br_drive {
    const double *vector; /* br_field_size values, N; NULL: none */
    double factor;
    bool changed;  /* the vector differs from that of the step before */
    double tip[2]; /* on the tip's unknowns, N; bending: force and moment over h */
};

struct br_linear_solver;

/* A march of one field: create, then predict and finish once a step. Every function but
 * round_off is needed. */
struct br_field_solver {
    /* Prepares the field's operator; the state starts at rest. kernel: of riccati; NULL: the best
     * that is available. Fails with BR_SINGULAR, BR_BAD_INPUT (a kernel that the machine has not),
     * BR_NO_MEMORY; free *self even then. */
    enum br_status (*create)(const struct br_field *field, const struct br_kernel *kernel,
                             void **self, struct br_error *err);
    void (*free)(void *self); /* accepts NULL */

    /* The tip's velocity per unit of tip force, z_tip > 0, m/s per N. */
    double (*tip_compliance)(const void *self);

    /* Like a row's round_off, for a march of so many steps, but from measurements made when the
     * step was set; NULL: there are none. */
    double (*round_off)(const void *self, size_t steps);

    /* Set or get nodal displacement, m, and velocity, m/s: arrays of
     * br_field_size values laid out as in field.h. get: either may be NULL. */
    void (*set)(void *self, const double *displacement, const double *velocity);
    void (*get)(const void *self, double *displacement, double *velocity);

    /* The strain rates of the elements: the rate of the elongation h u_x (if quadratic, of the pair
     * elongation and bubble), or of the two curvature coefficients of br_curvature; n *
     * br_field_unknowns values (out), m/s. */
    void (*strain_rate)(const void *self, double *rate);

    /* First half of a step: solves with the loads, but without contact and friction; *velocity is
     * the tip's free velocity v*, m/s. Fails with BR_SINGULAR where the solver itself finds it. */
    enum br_status (*predict)(void *self, const struct br_drive *drive, double *velocity,
                              struct br_error *err);

    /* Second half: the force r, N, resists the tip; advances the state by k and
     * returns the tip's velocity, m/s. */
    double (*finish)(void *self, double force);

    /* The tip's displacement, m. Cheap for axial; for bending, whose laws do not need it, a pass
     * over the elements. */
    double (*tip_displacement)(const void *self);

    /* ---- for schemes of more than an Euler step (scheme.h); states.h has keep, exchange and
     * combine for a solver whose states are rows of numbers ---- */

    /* Changes the length of the steps, s; the state does not change. Fails as create does. */
    enum br_status (*set_step)(void *self, double k, struct br_error *err);

    /* Adds `count` states, 1, 2, ..., at rest; state 0 is the one that all other functions use.
     * Called at most once. Fails with BR_NO_MEMORY. */
    enum br_status (*keep)(void *self, size_t count, struct br_error *err);

    /* Exchanges two states. */
    void (*exchange)(void *self, size_t a, size_t b);

    /* State `into` = sum of weight[j] times state j, j < count; `into` may be one of them. States
     * with weight 0 are skipped, and need not be finite. */
    void (*combine)(void *self, size_t into, size_t count, const double *weight);

    /* L2 norms (out) of a state's strain (u_x or w_xx) by displacement and by velocity, from the
     * elements: the size of an error estimate. */
    void (*size)(void *self, size_t state, double size[2]);
};

/* A number for each kind of element. */
struct br_by_element {
    double axial, bending, quadratic; /* the last: axial, of degree 2; 0: there is none */
};

double br_by_element_of(const struct br_by_element *values, const struct br_field *field);

/* A row of the registry. */
struct br_linear_solver {
    const char *name;     /* as on the command line */
    const char *title;    /* one line for a person */
    const char *citation; /* where the method comes from */
    bool takes_kernel;    /* whether the choice of a kernel changes its digits */
    const struct br_field_solver *axial, *bending;
    const struct br_field_solver *axial_quadratic; /* for elements of degree 2; NULL: it has none */

    /* Predicted round-off of a march's displacement at its end, the deviation from the exact
     * discrete solution over the largest displacement of the march, from measurements (`beamrate
     * extremes floors`; the benchmark). */
    double (*round_off)(const struct br_field *field);

    /* The residual of its solves in the equations (27) and (28), beyond the rounding of nodal
     * values: the norm of the error in the normal force or the moment, relative to the terms' sum.
     * NULL: none. */
    double (*residual)(const struct br_field *field);

    /* The largest measured number of bytes an element: of the solver with one state, during its
     * set-up and after; and of each further state that a scheme keeps. tests/test_resources.c
     * checks them. */
    struct br_by_element bytes, state_bytes;

    /* The measured time of a step of one stage for a field, ns, with the march's own work; sums:
     * passes over the states that the scheme adds to a stage (br_time_scheme_sums). NULL: by the
     * two members below, on an AMD EPYC with AVX-512 at about 3 GHz; where these are 0, too, the
     * cost is not known: no choice takes the row, and that of `plain` stands for it. */
    double (*cost)(const struct br_field *field, double sums);
    double step_cost;                  /* ns, without sums: of a step and the start of its solve */
    struct br_by_element element_cost; /* and of each element */
};

/* Whether the row has no solver of its own: it is a choice, of the row that costs least. */
bool br_linear_solver_chooses(const struct br_linear_solver *row);

/* See br_linear_solver.cost. */
double br_linear_solver_cost(const struct br_linear_solver *row, const struct br_field *field,
                             double sums);

extern const struct br_linear_solver br_auto, br_riccati, br_plain, br_umfpack;

/* The solver `plain` in long double: the same recursions with 64 bits in place of 53, and a row
 * that is in no registry. A march by it loses only the rounding of loads and tip forces, which are
 * doubles, so the difference of another march from it is that march's round-off. Whether the
 * equations are right is checked by references that share nothing with the solver.
 *
 * Against quadruple precision it is right to 1e-14 of a field's largest displacement, but to 1e-12
 * where friction holds the tip: the held tip creeps by the rounding of the force. */
extern const struct br_linear_solver br_long_plain;

/* Whether long double has more digits than double, so that it can check anything. */
bool br_long_plain_resolves(void);

/* The functions of `plain`, for both fields, and both degrees of the axial one. */
extern const struct br_field_solver br_plain_form;

/* The registry, in the order of help texts; NULL-terminated. The first is the default. */
extern const struct br_linear_solver *const br_linear_solvers[];

/* The solver of that name, or NULL. */
const struct br_linear_solver *br_linear_solver_find(const char *name);

/* The row itself, or for a choice the cheapest row that has a solver for the field (the first of
 * equal ones). That depends on the field's kind, n and degree and on `sums` alone, not on the
 * machine. NULL: no row has a solver. */
const struct br_linear_solver *br_linear_solver_taken(const struct br_linear_solver *solver,
                                                      const struct br_field *field, double sums);

/* The row's solver for a field (for a choice with `sums` of 0); NULL: it has none for elements of
 * that degree. */
const struct br_field_solver *br_linear_solver_for(const struct br_linear_solver *solver,
                                                   const struct br_field *field);

#endif
