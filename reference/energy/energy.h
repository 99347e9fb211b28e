/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Energies of a march and what changes them. They are computed from nodal values, in long double,
 * with element matrices that no solver uses.
 *
 * With Y = (w, v) and <Y, Z> = v'Mv + w'Kw of the two, each step of each field satisfies exactly
 *     E_n - E_{n-1} = W - D_viscous - D_friction - D_scheme,    with
 *     E = 1/2 <Y, Y> (+ c_H/2 (u(L) - g)_+^2, axial),
 * and the works summed as the scheme sums rates of change: of a Runge-Kutta method
 *     W = sum_i b_i k F_i'v_i,    D_viscous = sum_i b_i k v_i'C v_i,    and so on over its stages,
 *     D_scheme = k^2/2 sum_ij (b_i a_ij + b_j a_ji - b_i b_j) <Y'_i, Y'_j>
 * (Burrage and Butcher, SIAM J. Numer. Anal. 16 (1979) 46-57), of backward differences
 *     W = k F_n'v_n, ...,    D_scheme = 1/2 |d Y|^2 + <Y_n, d^2 Y/2 (+ d^3 Y/3)>,
 * d being the backward difference. D_scheme is thus found from the states and the tables of
 * textbook.h, and the balance is a check. Implicit Euler's is 1/2 |d Y|^2. A contact force r_i adds
 *     sum_i b_i k r_i u_t,i(L) - the change of the contact's potential,
 * negative where it gives energy, as a lagged one may. What viscosity and friction dissipate in one
 * step is signed like b_i, too.
 */
#ifndef BR_REFERENCE_ENERGY_ENERGY_H
#define BR_REFERENCE_ENERGY_ENERGY_H

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
    double scheme[2];      /* D_scheme of each field, without the next */
    double scheme_contact; /* that of the contact force, of the axial field */
    double noise[2];       /* of each field's sum, by round-off: the sum of the steps' limits */
    size_t steps[2];       /* the scheme's own */
    size_t gaining[2];     /* of those: D_scheme with that of the contact is negative */
    double gained[2];      /* by these steps */
};

double br_energy_total(const struct br_energy *energy);

/* E_now - E_start - (W - D_viscous - D_friction - D_scheme) relative to the sum of the sizes of
 * all terms: round-off. 0 where all are zero, NAN where one is not a number. */
double br_energy_imbalance(const struct br_energy *start, const struct br_energy *now,
                           const struct br_work *work);

/* The energy that a scheme has added to a field in all, beyond round-off, J; 0 where it removed
 * some. Single steps of a sound scheme may add what others remove. */
double br_energy_added(const struct br_work *work, enum br_field_kind kind);

/* What was put into a field: its energy at first and the work of its loads, where that is positive,
 * J. */
double br_energy_put_in(const struct br_energy *start, const struct br_work *work,
                        enum br_field_kind kind);

/* Energies of a march at its time (out), in a scene that models no more than the march does. Fails
 * with BR_NO_MEMORY. */
enum br_status br_energy_sample(const struct br_march *march, const struct br_scene *scene,
                                struct br_energy *energy, struct br_error *err);

/* The limit of the imbalance of a step of one field, relative to the sum of the sizes of its terms,
 * given the predicted relative round-off of the solver's displacements (br_march_round_off).
 * Rounding of nodal values costs 2^-53 where forces are smooth, and 2^-53 n^2 squared in the energy
 * of their noise; residuals that the certificate allows cost more. The terms are those of the
 * balance and, for each stage, those that a residual is relative to, times k and the velocity they
 * work on. At most br_energy_useless: where round-off alone may be more, a balance proves nothing.
 */
extern const double br_energy_useless;
double br_energy_limit(size_t n, double round_off);

/* Sums the works of a march. */
struct br_energy_meter;

/* Samples the march at t = 0 and watches it from then on (br_march_watch). The march, its
 * scene and the method must outlive the meter. Fails with BR_NO_MEMORY and as loads do, *meter then
 * NULL.
 */
enum br_status br_energy_meter_create(struct br_energy_meter **meter, struct br_march *march,
                                      const struct br_scene *scene, const struct br_method *method,
                                      struct br_error *err);
void br_energy_meter_free(struct br_energy_meter *meter); /* accepts NULL */

/* Call this after every step of the march. Returns the largest imbalance of a field in one of the
 * scheme's steps since the last call, to be compared with br_energy_limit; NAN where there was no
 * step or one that is not in the textbook. */
double br_energy_meter_step(struct br_energy_meter *meter);

/* Energies when the meter was created (start) and at its last step (now); the works between. */
void br_energy_meter_read(const struct br_energy_meter *meter, struct br_energy *start,
                          struct br_energy *now, struct br_work *work);

#endif
