/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The semi-discrete equations for SUNDIALS IDA, G(t, y, y') = 0, on the elements of field.h:
 *
 *     w' = v,    rho M v' + C v + K w + (tip forces) = F(t),
 *
 * both fields in one system. At the tip one branch of each law is held, so that the equations are
 * smooth: contact is open, or closed with the force c_H (u - g); friction carries nothing, or
 * slips with lambda = h(t) or -h(t), or sticks. A tip that sticks has v = 0 in place of its
 * row of the equations, and that row tells lambda; so nothing is of a higher index than 1. With
 * the regularised law (29), "stick" is |v| <= mu, where lambda = h v / mu. */
#ifndef BR_SOLVER_IDA_SYSTEM_H
#define BR_SOLVER_IDA_SYSTEM_H

#include <nvector/nvector_serial.h>
#include <sundials/sundials_matrix.h>

#include "solver/load.h"
#include "solver/march.h"

enum br_ida_friction { BR_IDA_FREE, BR_IDA_STICK, BR_IDA_SLIP_UP, BR_IDA_SLIP_DOWN };

/* The branches that are held. */
struct br_ida_regime {
    bool closed;
    enum br_ida_friction friction;
};

struct br_ida_system {
    const struct br_scene *scene; /* borrowed */
    double mu;                    /* of (29), m/s; 0: friction is exact */
    struct br_ida_regime regime;
    bool modelled[2];
    struct br_field field[2];
    size_t count;        /* unknowns */
    size_t node;         /* unknowns a node: displacements, then velocities, of each field */
    size_t lower, upper; /* unknowns before and behind its own that a row may have */
    size_t at[2];        /* where a field's unknowns of a node begin */
    struct br_step_load load[2];
    double loaded;                     /* the time of the loads; NaN: none yet */
    double element_stiffness[2][4][4]; /* K of one element for a = 1 */
    double *cubic, *cubic_mass;        /* z, and rho M z: see br_ida_reaction */
    struct br_error err;               /* of what IDA has called */
};

/* Fails with BR_BAD_INPUT, BR_NOT_FINITE or BR_NO_MEMORY; clear it even then. */
enum br_status br_ida_system_init(struct br_ida_system *s, const struct br_scene *scene, size_t n,
                                  const struct br_method *method, struct br_error *err);
void br_ida_system_clear(struct br_ida_system *s);

/* What K of one element makes of its nodal values (those of field.h, node after node), for a = 1;
 * an entry of its rho M. */
void br_ida_elastic_force(const struct br_field *field, const double node[4], double force[4]);
double br_ida_mass(const struct br_field *field, size_t i, size_t j);

/* Initial displacements and velocities into y (out, count values). Fails with BR_NOT_FINITE or
 * BR_NO_MEMORY. */
enum br_status br_ida_initial(const struct br_ida_system *s, double *y, struct br_error *err);

/* Where the unknowns of a field stand, node = 1 ... n: `unknowns` displacements, m, then as many
 * velocities, m/s. */
static inline size_t br_ida_at(const struct br_ida_system *s, enum br_field_kind kind, size_t node)
{
    return (node - 1) * s->node + s->at[kind];
}

/* Where the velocity of the tip stands, and so the row with the force on it. */
static inline size_t br_ida_tip_row(const struct br_ida_system *s, enum br_field_kind kind)
{
    return br_ida_at(s, kind, s->field[kind].n) + br_field_unknowns(&s->field[kind]);
}

/* Whether that row says v = 0. */
static inline bool br_ida_sticks(const struct br_ida_system *s)
{
    return s->modelled[BR_BENDING] && s->regime.friction == BR_IDA_STICK && !(s->mu > 0);
}

/* The tip's, 0 where the field is not modelled. */
double br_ida_tip_displacement(const struct br_ida_system *s, enum br_field_kind kind,
                               const double *y);
double br_ida_tip_velocity(const struct br_ida_system *s, enum br_field_kind kind, const double *y);

/* One field's nodal values out of y (out, br_field_size values; either may be NULL). */
void br_ida_nodal(const struct br_ida_system *s, enum br_field_kind kind, const double *y,
                  double *displacement, double *velocity);

/* As br_march_strain_rate, out of y. */
void br_ida_strain_rate(const struct br_ida_system *s, enum br_field_kind kind, const double *y,
                        double *rate);

/* The loads at time t. Fails as br_step_load_update. */
enum br_status br_ida_load(struct br_ida_system *s, double t, struct br_error *err);

/* For IDA, with the system as user data: G; dG/dy + cj dG/dy'. What goes wrong stands in s->err. */
int br_ida_residual(double t, N_Vector y, N_Vector rate, N_Vector residual, void *system);
int br_ida_jacobian(double t, double cj, N_Vector y, N_Vector rate, N_Vector residual,
                    SUNMatrix jacobian, void *system, N_Vector a, N_Vector b, N_Vector c);

/* dG/dy' (out; with zeros in it before). */
void br_ida_rate_matrix(const struct br_ida_system *s, SUNMatrix matrix);

#endif
