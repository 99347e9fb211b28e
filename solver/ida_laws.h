/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contact and friction at the tip for IDA: what the branches that are held carry, and how far each
 * is from being the wrong one. */
#ifndef BR_SOLVER_IDA_LAWS_H
#define BR_SOLVER_IDA_LAWS_H

#include "solver/ida_system.h"

/* Margins of the two laws, not negative while a branch is the right one. */
enum { BR_IDA_CONTACT, BR_IDA_FRICTION, BR_IDA_LAWS };

/* u - g of a tip that is held closed, else 0, m. */
double br_ida_penetration(const struct br_ida_system *s, const double *y);

/* h(t) of the branch that is held, N. */
double br_ida_bound(const struct br_ida_system *s, const double *y);

/* lambda of a tip that slips or creeps, N; 0 where it is free or sticks. */
double br_ida_given_friction(const struct br_ida_system *s, const double *y);

/* lambda of a tip that is held, from the loads at the time of y, N. Its own row would tell it, at
 * the price of differences of round-off a/h^3. All rows together, weighted by a z(x) that is 1 at
 * the tip, tell the same: with z = x^2 (3L - x) / (2 L^3), a cubic and so in the space of the
 * elements, z'''' = 0 and z''(L) = 0 leave of the elastic part z'K w = 3 w(L) / L^3, and
 *     lambda = z'F - rho z'M v' - 3 (a w(L) + c v(L)) / L^3.
 * size (out, or NULL): of the terms, N. */
double br_ida_reaction(const struct br_ida_system *s, const double *y, const double *rate,
                       double *size);

/* The margins at time t: g - u of a tip that is open, u - g of one that is closed (m); h - |lambda|
 * (N) of one that sticks, mu - |v| of one that creeps, |v| - mu with the right sign of one that
 * slips (m/s); 1 where there is no law. Loads are those of br_ida_load. */
void br_ida_margins(const struct br_ida_system *s, const double *y, const double *rate,
                    double margin[BR_IDA_LAWS]);

/* For IDA's root finding. */
int br_ida_roots(double t, N_Vector y, N_Vector rate, double *margin, void *system);

/* The tip as the regime has it. */
void br_ida_tip(const struct br_ida_system *s, const double *y, const double *rate,
                struct br_tip *tip);

#endif
