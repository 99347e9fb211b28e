/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Experiments at the extremes. Each compares predictions with marches: round-off, and the stability
 * of the contact. */
#ifndef BR_STUDY_EXTREMES_EXTREMES_H
#define BR_STUDY_EXTREMES_EXTREMES_H

#include <math.h>

#include "solver/march.h"
#include "study/grid/observer.h"
#include "study/grid/study.h"
#include "study/trade/named_method.h"

/* The request to an experiment. All borrowed; 0 or NULL: its default. */
struct br_extremes_job {
    int threads; /* 0: all cores */
    const size_t *n;
    const double *k; /* s */
    size_t n_count, k_count;
    int rounding; /* as fesetround takes it: of the marches, not of their judges */
    const struct br_observer *observer; /* NULL: none */
};

/* The larger one; NaN if one is NaN. */
static inline double br_worst(double a, double b)
{
    return isnan(a) || isnan(b) ? NAN : fmax(a, b);
}

/* ---- nodal values, laid out as in solver/field.h, as functions of x ---- */

/* The displacement at xi, 0 to 1, in the element whose nodal unknowns begin at `at`; slope (out):
 * of a beam h w_x. */
double br_nodal_value(enum br_field_kind kind, size_t unknowns, const double *at, double xi,
                      double *slope);

struct br_nodal {
    const struct br_field *field;
    const double *value;
    bool slope; /* the function is w_x of a beam, not w */
};

/* A function for the initial data of a scene. It and its clones borrow `nodal`. */
struct br_function br_nodal_function(struct br_nodal *nodal);

/* ---- round-off ---- */

/* How far the displacements of marches are from the exact discrete solution (reference/discrete.h),
 * compared with the round-off that marches predict. One experiment with two lists of marches: the
 * floors of the linear solvers, and the round-off that steps gather. */

/* One march. */
struct br_floor {
    const struct br_scene *scene; /* borrowed */
    const struct br_named_method *by;
    size_t n, of;            /* elements; steps of the duration */
    size_t steps;            /* steps of these that are taken; 0: not marched */
    double k;                /* s */
    double deviation[2];     /* by br_field_kind: at the end, largest of all nodal displacements,
                                relative to the largest displacement of the field */
    double tip[2];           /* of the tip's, relative to the same */
    double predicted;        /* br_march_round_off */
    double time_error;       /* largest error of the march's times, relative to the duration */
    struct br_error refused; /* status BR_OK where it marched */
};

enum { BR_FLOOR_STEPS = 20, BR_GATHERED_N = 10, BR_FLOOR_SCENES = 2, BR_FLOOR_METHODS = 32 };

/* Not to be moved: its marches point to its scenes and methods. */
struct br_floors {
    /* False: floors. Every linear solver takes BR_FLOOR_STEPS steps of implicit Euler with the
     * paper's lagged contact; the tip slips (Example 2), since a free tip is the softest motion,
     * which loses most. So many steps are enough for the memory of inertia at k = 1e-6.
     * True: round-off that steps gather until the end of the duration, of BR_GATHERED_N elements by
     * every time scheme of equal steps, with contact and friction. Example 1 sticks, Example 2
     * slips. */
    bool gathered;
    struct br_scene scene[BR_FLOOR_SCENES]; /* scenes; owned */
    struct br_named_method method[BR_FLOOR_METHODS];
    size_t scenes, methods, n_count, k_count;
    size_t solvers;         /* per scheme and contact; adjacent */
    struct br_floor *floor; /* floors: by scene, method, n, k; owned */
    size_t floors;
};

/* Measures all; a refusal by a march is a result. Defaults of the job: for floors n is 100 to
 * 1,000,000, and k 1e-2, 1e-4, 1e-6 s; for gathered round-off there are from one step to 1e5 steps,
 * to 1e6 where a step is one solve, and to 1e7 in Example 1 by implicit Euler with implicit
 * contact. Clear *floors (out) also after a failure. Fails with BR_UNSUPPORTED where long double
 * has no more digits than double, BR_NO_MEMORY, BR_INTERRUPTED, BR_BAD_INPUT (a k that does not
 * divide the duration), and as the exact discrete solution does. */
enum br_status br_floors_run(struct br_floors *floors, bool gathered,
                             const struct br_extremes_job *job, struct br_error *err);
void br_floors_clear(struct br_floors *floors);

const struct br_floor *br_floor_at(const struct br_floors *floors, size_t scene, size_t method,
                                   size_t n, size_t k);

/* The larger deviation of both fields; NaN where there is none. */
double br_floor_deviation(const struct br_floor *floor);

/* The limit for a march's deviation: its prediction; for the first BR_FLOOR_STEPS steps of riccati
 * also 2e-11 up to n = 12800 and 1e-9 up to n = 1,000,000. */
double br_floor_limit(const struct br_floor *floor);

/* BR_OK, or BR_VERDICT with the first march that is above its limit or whose times drift, or that
 * failed. Allowed are a refused assembled matrix, and a step that the scheme refuses by rule
 * (BR_BAD_INPUT). */
enum br_status br_floors_verdict(const struct br_floors *floors, struct br_error *err);

/* ---- stability ---- */

/* Where does the contact make a march unstable? Measured by marches, and compared with
 * solver/laws.h: the lagged contact over the plane of c_H and k, contact at u_n with every scheme,
 * tips that rest, chatter and bounce. */

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

/* Contact at u_n with one scheme: a constant load presses a rod until it rests, for all c_H up to
 * 1e15 N/m and time steps from far above its relaxation time down to it. */
struct br_stability_scheme {
    const struct br_time_scheme *scheme;
    size_t marches;
    size_t failed;    /* marches that failed, or were refused */
    size_t uncertain; /* marches with a step beyond its certificate's limits */
    double force;     /* largest error of the contact force at the end, over its value */
    double depth;     /* of the penetration, over the free rod's displacement */
};

/* A rod's tip by the lagged contact: pressed to the obstacle, or thrown at it without damping. */
struct br_stability_tip {
    double stiffness;       /* c_H, N/m */
    double bouncing, limit; /* c_H over the two limits */
    size_t impacts;         /* times that it closed, */
    size_t opened;          /* and that it opened in the last quarter of the march */
    double swing;           /* of the last quarter, over the free pressed rod's displacement */
    double farthest;        /* |u|, over the same */
    double energy;          /* of a thrown rod: the largest, over that at the start */
};

enum { BR_STABILITY_TIPS = 9, BR_STABILITY_BOUNCES = 8, BR_STABILITY_SCHEMES = 12 };

struct br_stability {
    size_t n, rows;                         /* rows: of each rod */
    double stiffness[BR_STABILITY_COLUMNS]; /* c_H, N/m */
    struct br_stability_row *row;           /* by rod, k; owned */
    struct br_stability_scheme scheme[BR_STABILITY_SCHEMES];
    size_t schemes;
    double tip_k, bounce_k; /* s */
    struct br_stability_tip tip[BR_STABILITY_TIPS], bounce[BR_STABILITY_BOUNCES];
    /* In all rows: */
    size_t cells, growing; /* growing: predicted */
    double limit_error;    /* largest |measured / predicted - 1| of the limits */
    double growth_error;   /* and of the growth where there is any */
    double excess;         /* how far above 1 the measured eigenvalue is where none is predicted */
};

/* The largest allowed relative difference of measured and predicted limits and growths, and the
 * largest allowed excess over 1 of an eigenvalue where stability is predicted. At a measured limit
 * an eigenvalue is outside the unit circle by 1e-11. That is at most 1e-11 beyond the limit, since
 * the eigenvalue grows faster than c_H. The rest is for the round-off of eigenvalues. */
extern const double br_stability_tolerance; /* 1e-9 */

/* Of the job: n is one number, at most BR_STABILITY_MOST_ELEMENTS, by default 8; k is by default
 * 1e-6 to 1e-1 s, four per decade. Fails with BR_BAD_INPUT (n, k), BR_NO_MEMORY, BR_INTERRUPTED,
 * BR_NOT_FINITE; clear it even then. */
enum br_status br_stability_run(struct br_stability *s, const struct br_extremes_job *job,
                                struct br_error *err);
void br_stability_clear(struct br_stability *s);

/* BR_OK where marches do what is predicted, or BR_VERDICT with the first that does not. */
enum br_status br_stability_verdict(const struct br_stability *s, struct br_error *err);

/* ---- building blocks of this experiment ---- */

/* The field of a rod, and the scene of a field, whose contact stiffness is 0. */
struct br_field br_stability_field(const struct br_stability_rod *rod, size_t n, double k);
struct br_scene br_stability_scene(const struct br_field *field, double duration);

/* ---- the matrix of a rod's Euler step against a closed contact with a lagged force, measured by
 * marches of one step, without use of the equations ---- */

/* A state is the displacements of the nodes, and then k times their velocities, m; the clamped node
 * is left out. */
size_t br_step_states(const struct br_field *rod);

/* Marches one step from each unit state, with the tip in contact; each gives a column. rod: an
 * axial field; stiffness: c_H, N/m; matrix (out): br_step_states squared values, by rows. Fails
 * with BR_NO_MEMORY and as marches do. */
enum br_status br_step_matrix(const struct br_field *rod, double stiffness, double *matrix,
                              struct br_error *err);

/* The size of the largest eigenvalue of that step (out). Fails as br_step_matrix, and with
 * BR_NOT_FINITE where the eigenvalues are not found. */
enum br_status br_step_radius(const struct br_field *rod, double stiffness, double *radius,
                              struct br_error *err);

#endif
