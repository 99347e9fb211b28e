/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The round-off floor of every linear solver: how far its displacements are from the exact discrete
 * solution (reference/discrete.h) after BR_FLOOR_STEPS steps, over n and k, beside what it predicts
 * of itself. Implicit Euler with the paper's lagged contact; the tip slips (Example 2), since a
 * free tip is the softest motion, which loses most. The number of steps is the same everywhere, and
 * enough for what inertia keeps of earlier steps at k = 1e-6. */
#ifndef BR_STUDY_EXTREMES_FLOORS_H
#define BR_STUDY_EXTREMES_FLOORS_H

#include "study/grid/observer.h"
#include "study/grid/study.h"
#include "study/trade/contender.h"

enum { BR_FLOOR_STEPS = 20, BR_FLOOR_SOLVERS = 16 };

/* What is asked for. Borrowed. */
struct br_floors_plan {
    const size_t *n; /* NULL: 100 to 1,000,000 */
    const double *k; /* s; NULL: 1e-2, 1e-4, 1e-6 */
    size_t n_count, k_count;
    int threads;  /* 0: all cores */
    int rounding; /* of the marches, as fesetround takes it */
};

/* One solver at one resolution. */
struct br_floor {
    size_t n, steps;     /* elements; steps that were taken */
    double k;            /* s */
    double deviation[2]; /* by br_field_kind: largest of all nodal displacements, relative to the
                            largest displacement of the field */
    double tip[2];       /* of the tip's, relative to the same */
    double predicted;    /* br_march_round_off */
    struct br_error refused; /* status BR_OK where it marched */
};

struct br_floors {
    struct br_scene scene; /* owned */
    struct br_contender solver[BR_FLOOR_SOLVERS];
    size_t solvers, n_count, k_count;
    size_t *n;              /* n_count, owned */
    double *k;              /* k_count, s, owned */
    struct br_floor *floor; /* by solver, n, k; owned */
};

/* Measures all; *floors (out) is to be cleared, also after a failure. Solvers that refuse are a
 * result. Fails with BR_BAD_INPUT (a k that does not divide the duration), BR_UNSUPPORTED where
 * long double has no more digits than double, BR_NO_MEMORY, BR_INTERRUPTED. */
enum br_status br_floors_run(struct br_floors *floors, const struct br_floors_plan *plan,
                             const struct br_observer *observer, struct br_error *err);
void br_floors_clear(struct br_floors *floors);

const struct br_floor *br_floor_at(const struct br_floors *floors, size_t solver, size_t n,
                                   size_t k);

/* The larger deviation of both fields; NaN where there is none. */
double br_floor_deviation(const struct br_floor *floor);

/* What a floor is held to: the prediction; of riccati also 2e-11 up to n = 12800 and 1e-9 up to n =
 * 1,000,000. */
double br_floor_limit(const struct br_floors *floors, size_t solver, const struct br_floor *floor);

/* BR_OK, or BR_VERDICT with the first floor that is above its limit, or a riccati or plain that
 * refuses. */
enum br_status br_floors_verdict(const struct br_floors *floors, struct br_error *err);

#endif
