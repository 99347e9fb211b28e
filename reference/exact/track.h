/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The history of one field: the steps' polynomials, and the phases of its tip. */
#ifndef BR_REFERENCE_EXACT_TRACK_H
#define BR_REFERENCE_EXACT_TRACK_H

#include <stddef.h>

#include "reference/exact/phase.h"
#include "reference/exact/radau.h"
#include "solver/status.h"

/* The tip along one step; series in p_k((t - start) / length). */
struct br_tip {
    double start, length; /* s */
    enum br_phase phase;
    double displacement;        /* at the start, less the gap of a contact, m */
    double velocity[BR_STAGES]; /* m/s */
    double force[BR_STAGES];    /* of the obstacle on the beam, against +displacement, N */
};

struct br_entry {
    double time;  /* s */
    double error; /* of the time, from round-off alone, s */
    enum br_phase phase;
};

struct br_track {
    size_t modes;
    double gap;           /* m */
    double free_velocity; /* largest root mean square over the beam of a step's mean velocity,
                             had the tip been let go for that step, m/s */
    double impulse;       /* sum over the steps of the velocity that their loads alone give, L2 */
    double blurred;       /* sum of squares of what the rounding of t may do to it */
    size_t steps, step_room;
    struct br_tip *tip;   /* steps */
    double *displacement; /* steps x modes: at each step's start, m */
    double *velocity;     /* steps x modes x BR_STAGES: series, m/s */
    size_t entries, entry_room;
    struct br_entry *entry; /* phases in order of time, the first at t = 0 */
};

/* Values at one time. */
struct br_tip_state {
    double displacement; /* less the gap of a contact, m */
    double velocity;     /* m/s */
    double force;        /* N */
    enum br_phase phase;
};

enum br_status br_track_create(struct br_track **out, size_t modes, double gap,
                               struct br_error *err);
void br_track_free(struct br_track *track);

/* Appends a step: tip, q (modes) and v (modes x BR_STAGES) are copied. */
enum br_status br_track_append(struct br_track *track, const struct br_tip *tip, const double *q,
                               const double *v, struct br_error *err);

/* Appends the entry into a phase; at the time of the last one its phase is replaced. */
enum br_status br_track_enter(struct br_track *track, const struct br_entry *entry,
                              struct br_error *err);

/* The step that holds t; where two steps meet the later one. */
size_t br_track_find(const struct br_track *track, double t);

/* The tip at the time start + theta length. */
struct br_tip_state br_tip_at(const struct br_tip *tip, double theta);

/* q and v (out, modes each, may be NULL): coefficients of displacement and
 * velocity at t. Returns the tip's values. */
struct br_tip_state br_track_at(const struct br_track *track, double t, double *q, double *v);

#endif
