/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where does the contact make a march unstable? Measured by marches, and against what
 * solver/laws.h predicts: the lagged contact over the plane of c_H and k, contact at u_n
 * with every scheme, tips that rest, chatter and bounce. */
#ifndef BR_STUDY_EXTREMES_STABILITY_H
#define BR_STUDY_EXTREMES_STABILITY_H

#include "solver/march.h"
#include "study/grid/observer.h"
#include "study/grid/study.h"

/* What is asked for. Borrowed. */
struct br_stability_request {
    size_t n;        /* elements, at most BR_STABILITY_MOST_ELEMENTS; 0: 8 */
    const double *k; /* time steps, s, k_count; NULL: 1e-6 to 1e-1, four a decade */
    size_t k_count;
    int threads;                        /* 0: all cores */
    const struct br_observer *observer; /* NULL: nobody */
};

enum { BR_STABILITY_MOST_ELEMENTS = 20, BR_STABILITY_RODS = 6, BR_STABILITY_COLUMNS = 61 };

/* A rod of 1 m and 1000 N. */
struct br_stability_rod {
    const char *name, *title;
    double density, viscosity; /* kg/m, N s */
    int degree;
};
extern const struct br_stability_rod br_stability_rods[BR_STABILITY_RODS];

/* The closed lagged contact of one rod at one time step. */
struct br_stability_row {
    const struct br_stability_rod *rod;
    double k;        /* s */
    double limit;    /* predicted: the largest stable c_H, N/m */
    double measured; /* where the largest eigenvalue of marched steps leaves the unit circle */
    double bouncing; /* below it no energy is gained, however the contact opens and closes */
    double radius[BR_STABILITY_COLUMNS]; /* measured: largest eigenvalue */
    double growth[BR_STABILITY_COLUMNS]; /* predicted: br_contact_growth */
};

/* Contact at u_n with one scheme: a rod that is pressed to its rest by a constant load, for all c_H
 * up to 1e15 N/m and steps from far above its relaxation time to that. */
struct br_stability_scheme {
    const struct br_time_scheme *scheme;
    size_t marches;
    size_t failed;    /* marches that failed, or were refused */
    size_t uncertain; /* marches with a step beyond its certificate's limits */
    double force;     /* largest error of the contact force at the end, over its value */
    double depth;     /* of the penetration, over the free rod's displacement */
};

/* The lagged contact of a pressed tip. */
struct br_stability_tip {
    double share;     /* c_H over its limit */
    double stiffness; /* c_H, N/m */
    size_t opened;    /* how often in the last quarter of the march */
    double swing;     /* of the last quarter, over the free rod's displacement */
    double farthest;  /* |u|, over the same */
};

/* The lagged contact of an undamped rod that bounces. */
struct br_stability_bounce {
    double stiffness;       /* c_H, N/m */
    double bouncing, limit; /* c_H over the two limits */
    size_t impacts;         /* times that it closed */
    double energy;          /* the largest, over that at the start */
};

enum { BR_STABILITY_TIPS = 9, BR_STABILITY_BOUNCES = 8, BR_STABILITY_SCHEMES = 12 };

struct br_stability {
    size_t n, rows;                         /* rows: of each rod */
    double stiffness[BR_STABILITY_COLUMNS]; /* c_H, N/m */
    struct br_stability_row *row;           /* by rod, k; owned */
    struct br_stability_scheme scheme[BR_STABILITY_SCHEMES];
    size_t schemes;
    double tip_k, bounce_k; /* s */
    struct br_stability_tip tip[BR_STABILITY_TIPS];
    struct br_stability_bounce bounce[BR_STABILITY_BOUNCES];
    /* In all rows: */
    size_t cells, growing; /* growing: predicted */
    double limit_error;    /* largest |measured / predicted - 1| of the limits */
    double growth_error;   /* and of the growth where there is any */
    double excess;         /* how far above 1 the measured eigenvalue is where none is predicted */
};

/* Measured and predicted limits, and growths, agree so far; nothing predicted to be stable has an
 * eigenvalue further outside. The limit is where one is outside by 1e-11, which is at most so far
 * beyond it, for the eigenvalue grows faster than c_H does; the rest is left for the round-off of
 * eigenvalues. */
extern const double br_stability_tolerance; /* 1e-9 */

/* Fails with BR_BAD_INPUT (n, k), BR_NO_MEMORY, BR_INTERRUPTED, BR_NOT_FINITE; clear it even then.
 */
enum br_status br_stability_run(const struct br_stability_request *request, struct br_stability *s,
                                struct br_error *err);
void br_stability_clear(struct br_stability *s);

/* BR_OK where marches do what is predicted, or BR_VERDICT with the first that does not. */
enum br_status br_stability_verdict(const struct br_stability *s, struct br_error *err);

/* ---- its parts ---- */

/* The field of a rod. */
struct br_field br_stability_field(const struct br_stability_rod *rod, size_t n, double k);

/* Fill s->scheme; s->tip and s->bounce. Fail with BR_NO_MEMORY. */
enum br_status br_stability_schemes(struct br_stability *s, struct br_error *err);
enum br_status br_stability_tips(struct br_stability *s, struct br_error *err);
enum br_status br_stability_bounces(struct br_stability *s, struct br_error *err);

/* ---- the matrix of a rod's Euler step against a closed contact with a lagged force, as marches of
 * one step tell it: nothing is known there of the equations ---- */

/* A state is the displacements of the nodes, and then k times their velocities, m; the clamped node
 * is left out. */
size_t br_step_states(const struct br_field *rod);

/* Column by column a state of one unit, whose tip is not away from the obstacle, is marched by one
 * step. rod: an axial field; stiffness: c_H, N/m; matrix (out): br_step_states squared values, by
 * rows. Fails with BR_NO_MEMORY and as marches do. */
enum br_status br_step_matrix(const struct br_field *rod, double stiffness, double *matrix,
                              struct br_error *err);

/* The size of the largest eigenvalue of that step (out). Fails as br_step_matrix, and with
 * BR_NOT_FINITE where the eigenvalues are not found. */
enum br_status br_step_radius(const struct br_field *rod, double stiffness, double *radius,
                              struct br_error *err);

#endif
