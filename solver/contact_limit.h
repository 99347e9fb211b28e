/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the lagged contact of (16) ceases to be stable: exactly, for the discretisation that is
 * marched, in closed form.
 *
 * While the contact is closed, a step with the force of u_{n-1} is linear. For u_n = z^n U, with
 * s = (1 - 1/z)/k, it reads
 *     (s^2 M + s C + K) U = -(c_H / z) U_tip e_tip,
 * so that the step's eigenvalues are the zeros of
 *     z + c_H G(s(z)),    G(s) = e_tip'(s^2 M + s C + K)^-1 e_tip,
 * the tip's displacement per unit of force. For c_H = 0 all of them lie inside the unit circle. As
 * c_H grows they leave it only where G(s)/z is real and negative on |z| = 1. With z = e^{i theta},
 * 0 < theta < pi, the argument of s^2 is pi - theta, and so that of every x'(s^2 M + s C + K)x lies
 * in [0, pi - theta], and not at its upper end, since K is definite. So the argument of G lies in
 * (theta - pi, 0] and that of G/z in (-pi, -theta]: never negative. At z = 1 it is positive. What
 * remains is z = -1, s = 2/k:
 *     stable if and only if    c_H G(2/k) <= 1,
 * whatever the inertia and the viscosity are. Beyond it exactly one eigenvalue is outside, real and
 * below -1, and the closed tip's error grows by it in every step, with alternating sign. Without
 * inertia this is c_H L <= a + 2c/k.
 *
 * An opening and closing contact is another matter: multiply a step with its v_n, and the energies
 * with the contact's own do not grow, whatever the tip does, as long as
 *     c_H <= min over v of (2/k v'Cv + v'Kv) / v_tip^2 = (a + 2c/k)/L,
 * the limit without inertia. Between the two an impact may gain energy. */
#ifndef BR_SOLVER_CONTACT_LIMIT_H
#define BR_SOLVER_CONTACT_LIMIT_H

#include "solver/field.h"

/* G(s) of an axial field, m/N, for real s > 0, 1/s; its step k does not matter. A uniform rod of
 * linear elements, or of quadratic ones whose bubbles are eliminated, is a chain of equal springs
 * and masses. */
double br_tip_flexibility(const struct br_field *field, double s);

/* The largest c_H, N/m, with which a lagged contact that stays closed is stable with the field's
 * step; INFINITY where none is too large. */
double br_contact_limit_stiffness(const struct br_field *field);

/* The largest c_H, N/m, with which a lagged contact gains no energy however it opens and closes. */
double br_contact_limit_bouncing(const struct br_field *field);

/* The longest step, s, with which a closed lagged contact of that c_H, N/m, is stable: INFINITY
 * where all are, 0 where none is. */
double br_contact_limit_step(const struct br_field *field, double stiffness);

/* Whether a closed lagged contact grows with the field's step; at the limit, to round-off, it does
 * not. */
bool br_contact_grows(const struct br_field *field, double stiffness);

/* How much it grows in a step: the size of the eigenvalue outside the unit circle; 1 where there is
 * none. */
double br_contact_growth(const struct br_field *field, double stiffness);

#endif
