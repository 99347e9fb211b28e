/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Energies of a march and what changes them, from nodal values with element matrices of its own in
 * long double, and nothing of a solver's numerics.
 *
 * Tested with k v_n, a step of (27) and (28) says, exactly,
 *     E_n - E_{n-1} = W - D_viscous - D_friction - D_scheme,    with
 *     E          = 1/2 v'Mv + 1/2 w'Kw + c_H/2 (u(L) - g)_+^2,
 *     W          = k F'v_n,    D_viscous = k v_n'C v_n,    D_friction = k lambda v_n(L),
 *     D_scheme   = 1/2 |v_n - v_{n-1}|_M^2 + 1/2 |w_n - w_{n-1}|_K^2
 *                + r (u_n - u_{n-1})(L) - the change of the contact's potential,
 * r being the contact force of the step. D_scheme is what implicit Euler takes away; the part of a
 * lagged contact force is negative where it adds energy.
 *
 * For other schemes the works are summed by the trapezoidal rule, and D_scheme is what the balance
 * leaves: measured as the remainder, with that rule's error in it. Nothing is then checked by it.
 */
#ifndef BR_ENERGY_H
#define BR_ENERGY_H

#include "solver/march.h"

/* Of one state, J. */
struct br_energy {
    double kinetic[2], stored[2]; /* by br_field_kind */
    double contact;               /* c_H/2 (u(L) - g)_+^2 */
};

/* Since t = 0, J. */
struct br_work {
    double loads[2], viscous[2]; /* by br_field_kind */
    double friction;
    double scheme;         /* D_scheme without the next */
    double scheme_contact; /* that of the contact force */
    bool remainder;        /* scheme is what the balance leaves; scheme_contact is 0 */
};

double br_energy_total(const struct br_energy *energy);

/* E_now - E_start - (W - D_viscous - D_friction - D_scheme) relative to the sum of the sizes of
 * all terms: round-off. 0 where all are zero, NAN where one is not a number; without meaning where
 * the works have a remainder. */
double br_energy_imbalance(const struct br_energy *start, const struct br_energy *now,
                           const struct br_work *work);

/* Of nodal values, laid out as in solver/field.h: of one field, J. displacement, velocity: in,
 * br_field_size values. */
double br_energy_kinetic(const struct br_field *field, const double *velocity);
double br_energy_stored(const struct br_field *field, const double *displacement);

/* Sums the works of a march. */
struct br_energy_meter;

/* Looks at the march as it is now, at t = 0; it and its scene must outlive the meter. scheme: of
 * the march; k: the length of its steps, s. Fails with BR_NO_MEMORY and as loads do, *meter then
 * NULL.
 */
enum br_status br_energy_meter_create(struct br_energy_meter **meter, const struct br_march *march,
                                      const struct br_scene *scene,
                                      const struct br_time_scheme *scheme, double k,
                                      struct br_error *err);
void br_energy_meter_free(struct br_energy_meter *meter); /* accepts NULL */

/* To be called after every step. */
void br_energy_meter_step(struct br_energy_meter *meter);

/* When it was created, at its last look, and between. */
void br_energy_meter_read(const struct br_energy_meter *meter, struct br_energy *start,
                          struct br_energy *now, struct br_work *work);

#endif
