/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Round-off: how far the displacements of marches are from the exact discrete solution
 * (reference/discrete.h), beside what they predict of themselves. One experiment with two lists of
 * marches: the floors of the linear solvers, and what steps gather. */
#ifndef BR_STUDY_EXTREMES_FLOORS_H
#define BR_STUDY_EXTREMES_FLOORS_H

#include "study/grid/observer.h"
#include "study/grid/study.h"
#include "study/trade/named_method.h"

/* One march. */
struct br_floor {
    const struct br_scene *scene; /* borrowed */
    const struct br_named_method *by;
    size_t n, of;        /* elements; steps of the duration */
    size_t steps;        /* of these, those that are taken; 0: not marched */
    double k;            /* s */
    double deviation[2]; /* by br_field_kind: at the end, largest of all nodal displacements,
                            relative to the largest displacement of the field */
    double tip[2];       /* of the tip's, relative to the same */
    double predicted;    /* br_march_round_off */
    double time_error;   /* largest of the times told, relative to the duration: against n T/N in
                            whole numbers */
    struct br_error refused; /* status BR_OK where it marched */
};

enum { BR_FLOOR_STEPS = 20, BR_GATHERED_N = 10, BR_FLOOR_SCENES = 2, BR_FLOOR_METHODS = 32 };

/* What is asked for. Borrowed. */
struct br_floors_plan {
    /* False: floors. Every linear solver takes BR_FLOOR_STEPS steps of implicit Euler with the
     * paper's lagged contact; the tip slips (Example 2), since a free tip is the softest motion,
     * which loses most. So many steps are enough for what inertia keeps of earlier ones at
     * k = 1e-6.
     * True: what steps gather until the end of the duration, of BR_GATHERED_N elements by every
     * time scheme of equal steps, with contact and friction. Example 1 sticks, Example 2 slips. */
    bool gathered;
    const size_t *n; /* of floors; NULL: 100 to 1,000,000 */
    const double *k; /* s; NULL: 1e-2, 1e-4, 1e-6; of what steps gather from one step to 1e5, to
                        1e6 where a step is one solve, and to 1e7 in Example 1 by implicit Euler
                        with implicit contact */
    size_t n_count, k_count;
    int threads;  /* 0: all cores */
    int rounding; /* of the marches, as fesetround takes it */
};

/* Not to be moved: its marches point to its scenes and methods. */
struct br_floors {
    bool gathered;
    struct br_scene scene[BR_FLOOR_SCENES]; /* scenes; owned */
    struct br_named_method method[BR_FLOOR_METHODS];
    size_t scenes, methods, n_count, k_count;
    size_t solvers;         /* of each scheme and contact; they are neighbours */
    struct br_floor *floor; /* floors: by scene, method, n, k; owned */
    size_t floors;
};

/* Measures all; what a march refuses is a result. *floors (out) is to be cleared, also after a
 * failure. Fails with BR_UNSUPPORTED where long double has no more digits than double,
 * BR_NO_MEMORY, BR_INTERRUPTED, BR_BAD_INPUT (a k that does not divide the duration), and as the
 * exact discrete solution does. */
enum br_status br_floors_run(struct br_floors *floors, const struct br_floors_plan *plan,
                             const struct br_observer *observer, struct br_error *err);
void br_floors_clear(struct br_floors *floors);

const struct br_floor *br_floor_at(const struct br_floors *floors, size_t scene, size_t method,
                                   size_t n, size_t k);

/* The larger deviation of both fields; NaN where there is none. */
double br_floor_deviation(const struct br_floor *floor);

/* What a march is held to: its prediction; of the first BR_FLOOR_STEPS steps of riccati also 2e-11
 * up to n = 12800 and 1e-9 up to n = 1,000,000. */
double br_floor_limit(const struct br_floor *floor);

/* BR_OK, or BR_VERDICT with the first march that is above its limit or whose times drift, or that
 * failed: an assembled matrix may be refused, and a step that the scheme refuses by rule
 * (BR_BAD_INPUT). */
enum br_status br_floors_verdict(const struct br_floors *floors, struct br_error *err);

#endif
