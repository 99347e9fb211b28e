/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The march of one field through all phases of its tip. */
#ifndef BR_REFERENCE_EXACT_MARCH_H
#define BR_REFERENCE_EXACT_MARCH_H

#include "reference/exact/field.h"
#include "reference/exact/tip.h"

/* How much work an exact solution may take, and who may end it and gets its progress. */
struct br_effort {
    double done, most; /* units of about 1.4 microseconds of a core: counted, not measured */
    const struct br_exact_options *who;
};

/* Fails with BR_INTERRUPTED, or BR_NOT_FINITE where no work is left. */
enum br_status br_effort_spend(struct br_effort *effort, double work, struct br_error *err);

/* ---- one step ---- */

/* A field at one time. The tip's own values are carried along by increments,
 * and set when an event fixes them: summed over modes they would lose what is
 * small just after an event. */
struct br_stepper {
    const struct br_oscillators *field; /* borrowed */
    const struct br_law *law;           /* borrowed */
    struct br_radau radau;

    double time;     /* s */
    double from, to; /* s: the load is taken between these, where it does not jump */
    double blur;     /* of the load: what the rounding of t does to it, relative */
    enum br_phase phase;
    double *q, *v;                         /* modes: m, m/s */
    double tip_displacement, tip_velocity; /* less the gap, m, m/s */

    struct br_tip_step tip; /* the last trial step */
    double *series;         /* BR_STAGES x width of the modes: its velocity, m/s */
    double free_size;       /* m^(3/2)/s: mean velocity in L2 as if the tip were free: where a tip
                               force cancels it, its round-off is what remains */

    double work; /* of the trial steps, see br_effort; whoever reads it sets it to zero */

    double length;                 /* s, of the step that the responses are for */
    struct br_stage_system system; /* of this length, over stiffness h */
    double *gain;      /* width: mean velocity in a step over a constant force, m/(N s) */
    double tip_length; /* s, of the step that this is for: only phases that need it have it */
    double tip_response[BR_STAGES][BR_STAGES]; /* velocity over force, m/(N s) */
    double *load;                              /* BR_STAGES x width, at the stages, N */
    double *rest;          /* the same size: series of what the state leaves of it, N */
    double load_noise;     /* m^(3/2)/s: what a load's round-off may do to the velocity, in L2 */
    double impulse;        /* m^(3/2)/s: velocity that the loads alone give in the step, in L2 */
    double noise_response; /* the same of a load of 1 N of every shape */
};

/* s: in, with its field and law, all else zero; gap in m. Starts at t = 0. Fails with BR_NO_MEMORY.
 */
enum br_status br_stepper_init(struct br_stepper *s, double gap, struct br_store *store,
                               struct br_error *err);

/* Sets tip and series to a step of length h from the current state, which stays.
 * Fails with BR_NO_MEMORY, BR_SINGULAR or BR_NOT_FINITE. */
enum br_status br_stepper_try(struct br_stepper *s, double h, struct br_error *err);

/* Moves the state to the end of the last trial step, called `time`. */
void br_stepper_accept(struct br_stepper *s, double time);

/* Sets exactly what the end of the state's phase fixes: the tip's displacement
 * where a contact opens or closes, its velocity where a slip ends. */
void br_stepper_settle(struct br_stepper *s);

/* ---- the march ---- */

struct br_march_options {
    double duration;                     /* T, s */
    const struct br_outline *outline[2]; /* of this field, and NULL or the one that it depends on:
                                            the steps that they ask for */
    double gap;                          /* of the contact, m; 0 for friction */
    double tolerance;  /* what the last coefficients of a step may be of the largest value */
    double first_step; /* s: length of the first step of a phase, always accepted */
    size_t max_steps;
    struct br_effort *effort;
};

/* *out (owned by the caller): the history of the field under the law, both of
 * which are only read. Fails with BR_NO_MEMORY, BR_SINGULAR, BR_INTERRUPTED, or BR_NOT_FINITE
 * where the solution blows up, asks for too many steps, or has phases that
 * follow each other without end. */
enum br_status br_march(const struct br_oscillators *field, const struct br_law *law,
                        const struct br_march_options *options, struct br_history **out,
                        struct br_error *err);

#endif
