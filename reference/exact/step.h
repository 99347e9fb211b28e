/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One Radau IIA step of a field and its tip, within one phase. */
#ifndef BR_REFERENCE_EXACT_STEP_H
#define BR_REFERENCE_EXACT_STEP_H

#include "reference/exact/field.h"
#include "reference/exact/law.h"

/* A field at one time. The tip's own values are carried along by increments,
 * and set when an event fixes them: summed over modes they would lose what is
 * small just after an event. */
struct br_stepper {
    const struct br_field *field;
    const struct br_law *law;
    struct br_radau radau;

    double time;     /* s */
    double from, to; /* s: the load is taken between these, where it does not jump */
    double blur;     /* of the load: what the rounding of t does to it, relative */
    enum br_phase phase;
    double *q, *v;                         /* modes: m, m/s */
    double tip_displacement, tip_velocity; /* less the gap, m, m/s */

    struct br_tip tip; /* the last trial step */
    double *series;    /* modes x BR_STAGES: its velocity, m/s */
    double free_size;  /* m^(3/2)/s: mean velocity in L2 as if the tip were free: where a tip
                          force cancels it, its round-off is what remains */

    double work; /* of the trial steps, see effort.h; whoever reads it sets it to zero */

    double length;    /* s, of the step that the responses are for */
    double *response; /* modes x BR_STAGES x BR_STAGES: velocity over force, m/(N s) */
    double tip_response[BR_STAGES][BR_STAGES];
    double *load;          /* BR_STAGES x modes, workspace, N */
    double load_noise;     /* m^(3/2)/s: what a load's round-off may do to the velocity, in L2 */
    double impulse;        /* m^(3/2)/s: velocity that the loads alone give in the step, in L2 */
    double noise_response; /* the same of a load of 1 N of every shape */
};

/* Field and law are borrowed; gap in m. Starts at t = 0. Fails with BR_NO_MEMORY. */
enum br_status br_stepper_create(struct br_stepper **out, const struct br_field *field,
                                 const struct br_law *law, double gap, struct br_error *err);
void br_stepper_free(struct br_stepper *s);

/* Sets tip and series to a step of length h from the current state, which stays.
 * Fails with BR_NO_MEMORY, BR_SINGULAR or BR_NOT_FINITE. */
enum br_status br_stepper_try(struct br_stepper *s, double h, struct br_error *err);

/* Moves the state to the end of the last trial step, called `time`. */
void br_stepper_accept(struct br_stepper *s, double time);

/* Sets exactly what the end of the state's phase fixes: the tip's displacement
 * where a contact opens or closes, its velocity where a slip ends. */
void br_stepper_settle(struct br_stepper *s);

#endif
