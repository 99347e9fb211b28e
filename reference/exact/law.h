/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The laws at the tip, (10) and (12), one phase at a time. In each phase the law
 * is linear and a guard tells how far the phase is from its end. */
#ifndef BR_REFERENCE_EXACT_LAW_H
#define BR_REFERENCE_EXACT_LAW_H

#include "reference/exact/track.h"
#include "solver/scene.h"

struct br_law {
    bool contact;                  /* (10), on the axial field; else (12), on the bending field */
    bool obstacle;                 /* whether there is one to be in contact with */
    double stiffness;              /* c_H, N/m; 0 without a contact */
    enum br_friction_law friction; /* of the bending field */
    double coefficient;            /* c_V */
    const struct br_track *axial;  /* whose tip sets Coulomb's bound; borrowed */
};

/* The friction bound b(t), N. */
double br_law_bound(const struct br_law *law, double t);

/* The force on a tip in this state, N: the series' value only where the law does
 * not give it. */
double br_law_force_at(const struct br_law *law, double t, const struct br_tip_state *tip);

/* The phase at t of a tip with this displacement (less the gap) and velocity;
 * `now` is the phase before t, BR_FREE at t = 0. */
enum br_phase br_law_phase(const struct br_law *law, double t, enum br_phase now,
                           double displacement, double velocity);

/* The phase that follows when the guard of one with this tip ends it. */
enum br_phase br_law_next(const struct br_tip_state *tip);

/* Distance to the end of the phase: negative when it is over. */
double br_law_guard(const struct br_law *law, double t, const struct br_tip_state *tip);

/* tip->force (in: zero; out): series of the force over a step, from the velocity
 * tip->velocity that the tip has without it, and the velocity's response z (row
 * by row) to the force's coefficients. While the tip sticks, a second call with
 * the velocity that is left improves the force. Fails with BR_SINGULAR
 * or BR_NOT_FINITE. */
enum br_status br_law_force(const struct br_law *law, const struct br_radau *radau,
                            const double z[BR_STAGES][BR_STAGES], struct br_tip *tip,
                            struct br_error *err);

#endif
