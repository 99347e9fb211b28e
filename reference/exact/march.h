/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The march of one field through all phases of its tip. */
#ifndef BR_REFERENCE_EXACT_MARCH_H
#define BR_REFERENCE_EXACT_MARCH_H

#include "reference/exact/exact.h"
#include "reference/exact/field.h"

/* How much work an exact solution may take, and who may end it and gets its progress. */
struct br_effort {
    double done, most; /* units of about 1.4 microseconds of a core: counted, not measured */
    const struct br_exact_options *who;
};

/* Fails with BR_INTERRUPTED, or BR_NOT_FINITE where no work is left. */
enum br_status br_effort_spend(struct br_effort *effort, double work, struct br_error *err);

/* ---- the tip (tip.c) ----
 *
 * The laws (10) and (12), one phase at a time. In each phase the law is linear, and a guard
 * measures how far the phase is from its end. */

/* The tip along one step; series in p_k((t - start) / length). */
struct br_tip_step {
    double start, length; /* s */
    enum br_phase phase;
    double displacement;        /* at the start, less the gap of a contact, m */
    double velocity[BR_STAGES]; /* m/s */
    double force[BR_STAGES];    /* of the obstacle on the beam, against +displacement, N */
    double *values; /* BR_HISTORY_ROWS x modes: series of the velocity, m/s, and the displacement
                       at the start, m; of a step that is kept */
};
enum { BR_HISTORY_ROWS = BR_STAGES + 1 };

struct br_entry {
    double time;  /* s */
    double error; /* of the time, from round-off alone, s */
    enum br_phase phase;
};

struct br_history {
    size_t modes;
    double gap;           /* m */
    double free_velocity; /* largest root mean square over the beam of a step's mean velocity,
                             had the tip been let go for that step, m/s */
    double impulse;       /* sum over the steps of the velocity that their loads alone give, L2 */
    double blurred;       /* sum of squares of what the rounding of t may do to it */
    size_t steps, step_room;
    struct br_tip_step *tip; /* steps */
    size_t entries, entry_room;
    struct br_entry *entry; /* phases in order of time, the first at t = 0 */
    struct br_store *store; /* that it is from */
};

/* Values at one time. */
struct br_tip_state {
    double displacement; /* less the gap of a contact, m */
    double velocity;     /* m/s */
    double force;        /* N */
    enum br_phase phase;
};

/* The step that holds t; where two steps meet the later one. */
size_t br_history_find(const struct br_history *track, double t);

/* The tip at the time start + theta length. */
struct br_tip_state br_tip_at(const struct br_tip_step *tip, double theta);

/* q and v (out, modes each, may be NULL): coefficients of displacement and
 * velocity at t. Returns the tip's values. */
struct br_tip_state br_history_at(const struct br_history *track, double t, double *q, double *v);

struct br_law {
    bool contact;                   /* (10), on the axial field; else (12), on the bending field */
    bool obstacle;                  /* whether there is one to be in contact with */
    double stiffness;               /* c_H, N/m; 0 without a contact */
    enum br_friction_law friction;  /* of the bending field */
    double coefficient;             /* c_V */
    const struct br_history *axial; /* whose tip sets Coulomb's bound; borrowed */
};

/* The friction bound b(t), N. */
double br_law_bound(const struct br_law *law, double t);

/* What the law says of a tip in its phase. */
struct br_law_state {
    double force;       /* on it, N: the series' value only where the law does not give it */
    double guard;       /* distance to the end of the phase: negative when it is over */
    enum br_phase next; /* the phase that follows when the guard ends it */
};
struct br_law_state br_law_at(const struct br_law *law, double t, const struct br_tip_state *tip);

/* The phase at t of a tip with this displacement (less the gap) and velocity;
 * `now` is the phase before t, BR_FREE at t = 0. */
enum br_phase br_law_phase(const struct br_law *law, double t, enum br_phase now,
                           double displacement, double velocity);

/* ---- one step (step.c) ---- */

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

/* s: in, with its field and law, all else zero; gap in m. Starts at t = 0. Fails with
 * BR_NO_MEMORY. */
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

/* *out (owned by the store): the history of the field under the law, both of
 * which are only read. Fails with BR_NO_MEMORY, BR_SINGULAR, BR_INTERRUPTED, or BR_NOT_FINITE
 * where the solution blows up, asks for too many steps, or has phases that
 * follow each other without end. */
enum br_status br_march(const struct br_oscillators *field, const struct br_law *law,
                        const struct br_march_options *options, struct br_store *store,
                        struct br_history **out, struct br_error *err);

/* ---- a solution ---- */

/* One march of each modelled field; the others are NULL. */
struct br_exact_solution {
    struct br_oscillators *field[BR_EXACT_FIELDS];
    struct br_law law[BR_EXACT_FIELDS];
    struct br_history *track[BR_EXACT_FIELDS];
    struct br_store store; /* of the fields */
};

struct br_exact {
    double duration; /* T, s */
    struct br_exact_solution *solution;
    struct br_exact_report report[BR_EXACT_FIELDS];
    double noise[BR_EXACT_FIELDS]; /* m/s: where a force at the tip cancels all motion, this much
                                      of the velocity is round-off */
    size_t events;
    struct br_exact_event *event;
};

#endif
