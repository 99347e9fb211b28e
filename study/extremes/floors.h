/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Round-off: how far the displacements of marches are from the exact discrete solution
 * (reference/discrete.h), beside what they predict of themselves. One experiment over two lists:
 * the floors of the linear solvers, over n and k; and what steps gather, over their number. */
#ifndef BR_STUDY_EXTREMES_FLOORS_H
#define BR_STUDY_EXTREMES_FLOORS_H

#include "study/grid/observer.h"
#include "study/grid/study.h"
#include "study/trade/named_method.h"

/* ---- the experiment ---- */

/* One march. */
struct br_floor {
    size_t n, steps;     /* elements; steps that were taken; 0: not marched */
    double k;            /* s */
    double deviation[2]; /* by br_field_kind: at the end, largest of all nodal displacements,
                            relative to the largest displacement of the field */
    double tip[2];       /* of the tip's, relative to the same */
    double predicted;    /* br_march_round_off */
    double time_error;   /* largest of the times told, relative to the duration: against n T/N in
                            whole numbers */
    struct br_error refused; /* status BR_OK where it marched */
};

/* Marches of one scene, scheme, contact rule, mesh and number of steps, by several solvers. */
struct br_floor_task {
    const struct br_scene *scene;
    size_t n, steps, taken;           /* elements; steps of the duration; and as many are taken */
    const struct br_named_method *by; /* solvers */
    size_t solvers;
    struct br_floor *floor; /* out: of solver s it is floor[s * stride] */
    size_t stride;
};

/* Does the tasks (sorted: the most work first) on `threads` threads (0: all cores). Solvers that
 * refuse are a result. Fails with BR_UNSUPPORTED where long double has no more digits than double,
 * BR_NO_MEMORY, BR_INTERRUPTED, and as the exact discrete solution does. */
enum br_status br_floor_tasks_run(struct br_floor_task *tasks, size_t count, int threads,
                                  const struct br_observer *observer, struct br_error *err);

/* The larger deviation of both fields; NaN where there is none. */
double br_floor_deviation(const struct br_floor *floor);

/* ---- floors: every linear solver after BR_FLOOR_STEPS steps ---- */

/* Implicit Euler with the paper's lagged contact; the tip slips (Example 2), since a free tip is
 * the softest motion, which loses most. The number of steps is the same everywhere, and enough for
 * what inertia keeps of earlier steps at k = 1e-6. */
enum { BR_FLOOR_STEPS = 20, BR_FLOOR_SOLVERS = 16 };

/* What is asked for. Borrowed. */
struct br_floors_plan {
    const size_t *n; /* NULL: 100 to 1,000,000 */
    const double *k; /* s; NULL: 1e-2, 1e-4, 1e-6 */
    size_t n_count, k_count;
    int threads;  /* 0: all cores */
    int rounding; /* of the marches, as fesetround takes it */
};

struct br_floors {
    struct br_scene scene; /* owned */
    struct br_named_method solver[BR_FLOOR_SOLVERS];
    size_t solvers, n_count, k_count;
    size_t *n;              /* n_count, owned */
    double *k;              /* k_count, s, owned */
    struct br_floor *floor; /* by solver, n, k; owned */
};

/* Measures all; *floors (out) is to be cleared, also after a failure. Fails as br_floor_tasks_run,
 * and with BR_BAD_INPUT (a k that does not divide the duration). */
enum br_status br_floors_run(struct br_floors *floors, const struct br_floors_plan *plan,
                             const struct br_observer *observer, struct br_error *err);
void br_floors_clear(struct br_floors *floors);

const struct br_floor *br_floor_at(const struct br_floors *floors, size_t solver, size_t n,
                                   size_t k);

/* What a floor is held to: the prediction; of riccati also 2e-11 up to n = 12800 and 1e-9 up to n =
 * 1,000,000. */
double br_floor_limit(const struct br_floors *floors, size_t solver, const struct br_floor *floor);

/* BR_OK, or BR_VERDICT with the first floor that is above its limit, or a riccati or plain that
 * refuses. */
enum br_status br_floors_verdict(const struct br_floors *floors, struct br_error *err);

/* ---- steps: what they gather until the end of the duration ---- */

/* A march of BR_DRIFT_N elements by every time scheme of equal steps, with contact and friction.
 * Example 1 sticks, Example 2 slips. */
enum { BR_DRIFT_N = 10, BR_DRIFT_SCENES = 2, BR_DRIFT_METHODS = 32 };

/* What is asked for. Borrowed. */
struct br_drifts_plan {
    const double *k; /* s; NULL: from one step to 1e5, to 1e6 where a step is one solve, and to 1e7
                        in Example 1 by implicit Euler with implicit contact */
    size_t k_count;
    int threads;  /* 0: all cores */
    int rounding; /* of the marches, as fesetround takes it */
};

struct br_drifts {
    struct br_scene scene[BR_DRIFT_SCENES];         /* owned */
    struct br_named_method named[BR_DRIFT_METHODS]; /* by scheme and contact; solvers of one
                                                           of these are neighbours */
    size_t methods, solvers, k_count;               /* solvers: of each scheme and contact */
    size_t *steps;                                  /* k_count; owned */
    struct br_floor *drift;                         /* by scene, named method, k; owned */
};

/* As br_floors_run. */
enum br_status br_drifts_run(struct br_drifts *drifts, const struct br_drifts_plan *plan,
                             const struct br_observer *observer, struct br_error *err);
void br_drifts_clear(struct br_drifts *drifts);

const struct br_floor *br_drift_at(const struct br_drifts *drifts, size_t scene, size_t named,
                                   size_t k);

/* BR_OK, or BR_VERDICT with the first march that is above its prediction, failed (a step that the
 * scheme refuses by rule, BR_BAD_INPUT, is no failure), or whose times drift. */
enum br_status br_drifts_verdict(const struct br_drifts *drifts, struct br_error *err);

#endif
