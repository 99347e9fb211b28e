/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Experiments at the extremes. Each compares predictions with marches: round-off, and the stability
 * of the contact. */
#ifndef BR_STUDY_EXTREMES_EXTREMES_H
#define BR_STUDY_EXTREMES_EXTREMES_H

#include <math.h>

#include "base/observer.h"
#include "solver/march.h"
#include "study/scene/named_method.h"

/* The request to an experiment. All borrowed; 0 or NULL: its default. */
struct br_extremes_job {
    int threads;                         /* 0: all cores */
    const struct br_scene *const *scene; /* `scenes` of them, 1 to BR_FLOOR_SCENES */
    size_t scenes;
    const size_t *n, *steps; /* elements; numbers of steps of the duration */
    size_t n_count, step_count;
    const struct br_named_methods *methods;
    const struct br_observer *observer; /* NULL: none */
};

/* The larger one; NaN if one is NaN. */
static inline double br_worst(double a, double b)
{
    return isnan(a) || isnan(b) ? NAN : fmax(a, b);
}

/* ---- round-off ---- */

/* How far the displacements of marches are from the exact discrete solution
 * (br_long_plain), compared with the round-off that marches predict. One experiment with
 * two lists of marches: the floors of the linear solvers, and the round-off that steps gather. */

/* One march. */
struct br_floor {
    const struct br_scene *scene; /* borrowed */
    const struct br_named_method *by;
    bool at_new_step;        /* floors: contact at u_n, since the lagged one is beyond its limit */
    size_t n, of;            /* elements; steps of the duration */
    size_t steps;            /* steps of these that are taken; 0: not marched */
    double k;                /* s */
    double deviation[2];     /* by br_field_kind: at the end, largest of all nodal displacements,
                                relative to the largest displacement of the field at all
                                time levels */
    double tip[2];           /* of the tip's, relative to the same */
    double predicted;        /* br_march_round_off */
    double time_error;       /* largest error of the march's times, relative to the duration */
    struct br_error refused; /* status BR_OK where it marched */
};

enum { BR_FLOOR_STEPS = 20, BR_GATHERED_N = 10, BR_FLOOR_SCENES = 2 };

/* Not to be moved: its marches point to its scenes and methods. */
struct br_floors {
    /* False: floors. Every linear solver takes BR_FLOOR_STEPS steps of implicit Euler with the
     * paper's lagged contact, or with contact at u_n where that is beyond its limit and would
     * multiply round-off. A tip that slips (example2) is best, since a free tip is the softest
     * motion, which loses most. So many steps are enough for the memory of inertia at k = 1e-6.
     * True: round-off that steps gather until the end of the duration, of BR_GATHERED_N elements by
     * every time scheme of equal steps, with contact and friction (example1 sticks, example2
     * slips); a lagged contact beyond its limit is not marched. */
    bool gathered;
    const struct br_scene *scene[BR_FLOOR_SCENES]; /* borrowed */
    struct br_named_methods method;
    size_t scenes, n_count, k_count;
    size_t solvers;         /* per scheme and contact; adjacent */
    struct br_floor *floor; /* floors: by scene, method, n, k; owned */
    size_t floors;
};

/* Measures all; a refusal by a march is a result. Defaults of the job: for floors n is 100 to
 * 1,000,000, to 100,000 for assembled matrices, which are refused there, with 1e2, 1e4, 1e6 steps
 * of the duration; for gathered round-off there are from one
 * step to 1e5 steps, to 1e6 where a step is one solve, and to 1e7 in the first scene by implicit
 * Euler with implicit contact. Clear *floors (out) also after a failure. Fails with BR_UNSUPPORTED
 * where long double has no more digits than double, BR_NO_MEMORY, BR_INTERRUPTED, and as the
 * reference march does. */
enum br_status br_floors_run(struct br_floors *floors, bool gathered,
                             const struct br_extremes_job *job, struct br_error *err);
void br_floors_clear(struct br_floors *floors);

static inline const struct br_floor *br_floor_at(const struct br_floors *f, size_t scene,
                                                 size_t method, size_t n, size_t k)
{
    return &f->floor[((scene * f->method.count + method) * f->n_count + n) * f->k_count + k];
}

/* The larger deviation of both fields; NaN where there is none. */
static inline double br_floor_deviation(const struct br_floor *floor)
{
    return br_worst(floor->deviation[BR_AXIAL], floor->deviation[BR_BENDING]);
}

/* The limit for a march's deviation: its prediction; for the first BR_FLOOR_STEPS steps of riccati
 * also 2e-11 up to n = 12800 and 1e-9 up to n = 1,000,000. */
double br_floor_limit(const struct br_floor *floor);

/* BR_OK, or BR_VERDICT with the first march that is above its limit or whose times drift, or that
 * failed. Allowed are a refused assembled matrix, and a step that the scheme refuses by rule
 * (BR_BAD_INPUT). */
enum br_status br_floors_verdict(const struct br_floors *floors, struct br_error *err);

/* ---- stability ---- */

/* Where does a scene break? It is marched over (n, k) and, if it has a contact, over (c_H, k). A
 * point is unstable if its march is not finite, or if the scheme itself made energy; work of loads
 * and energy of the start are no sign of it.
 *
 * Implicit Euler, by its energy balance (reference/energy/energy.h): more than a tenth of what was
 * put into a field, by the start and the loads, was added by the scheme. With contact at u_n it
 * adds nothing, whatever the scene; the lagged contact adds nothing within its limit
 * (solver/laws.h). For other schemes coarse steps make the balance itself inexact. There the energy
 * at the end counts: more than 10 times what the loads put in, in its own march or in one of
 * implicit Euler with contact at u_n on the same mesh and steps, which is stable. */

enum { BR_STABILITY_METHODS = 3, BR_STABILITY_PLANES = 2 * BR_STABILITY_METHODS };

enum br_stability_outcome { BR_STABLE, BR_UNSTABLE, BR_REFUSED };
extern const char *const br_stability_words[]; /* by outcome */

/* One march. */
struct br_stability_point {
    size_t steps;
    enum br_stability_outcome outcome;
    double share;  /* of energy, as above; NaN: not finite, or refused */
    char why[160]; /* of a refusal, or of a march that ended early */
};

/* The marches of one mesh and contact stiffness. */
struct br_stability_column {
    size_t n;
    double stiffness;                 /* c_H, N/m; NaN: there is no contact */
    struct br_stability_point *point; /* by steps; borrowed from the plane */
    double largest;                   /* the largest stable step, s: all smaller ones that were
                                         tried are stable, too; 0: not even the smallest is */
    double broken;                    /* the next step that is not stable, s; INFINITY: none */
    enum br_stability_outcome by;     /* of that one: unstable or refused; BR_STABLE: none */
    double predicted; /* the longest stable step of a closed contact, s; INFINITY: any, or above a
                         million durations */
};

struct br_stability_plane {
    const struct br_named_method *by; /* borrowed */
    bool over_stiffness;              /* else over n */
    struct br_stability_column *column;
    struct br_stability_point *point; /* of all columns; these two are owned */
    size_t columns;
};

/* Not to be moved. */
struct br_stability {
    const struct br_scene *scene; /* borrowed */
    struct br_named_methods method;
    size_t *steps; /* rows, descending: the smallest step first; owned */
    size_t rows;
    struct br_stability_plane plane[BR_STABILITY_PLANES];
    size_t planes;
    double own; /* c_H of the scene, N/m; NaN: it has no contact */
};

/* Of the job: the first scene; at most BR_STABILITY_METHODS methods, by default that of `run`; n,
 * by default 10 to 200; steps, by default 10 to 10,000 of the duration. c_H runs from a hundredth
 * of the scene's to 10,000 times it, on the first n. Where a column breaks, its largest stable step
 * is found to 2 %. Fails with BR_BAD_INPUT, BR_NO_MEMORY, BR_INTERRUPTED; clear it even then. */
enum br_status br_stability_run(struct br_stability *s, const struct br_extremes_job *job,
                                struct br_error *err);
void br_stability_clear(struct br_stability *s);

/* The largest share of a stable march by a method. */
double br_stability_most(const struct br_method *method);

/* What a share of energy means. */
enum br_stability_outcome br_stability_outcome_of(const struct br_method *method, double share);

/* How many points of a plane have an outcome. */
size_t br_stability_count(const struct br_stability *s, const struct br_stability_plane *plane,
                          enum br_stability_outcome outcome);

/* BR_OK, or BR_VERDICT with the first point that breaks where theory has no break: with contact at
 * u_n or no contact, or with a lagged contact that gains no energy however it opens and closes. */
enum br_status br_stability_verdict(const struct br_stability *s, struct br_error *err);

#endif
