/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Round-off that steps gather: how far a march of n = BR_DRIFT_N elements is from the exact
 * discrete solution (reference/discrete.h) at the end of the duration, over the number of steps,
 * for every time scheme of equal steps, with contact and friction; and whether the time levels that
 * it tells are n T/N, however many there are. Example 1 sticks, Example 2 slips. */
#ifndef BR_STUDY_EXTREMES_STEPS_H
#define BR_STUDY_EXTREMES_STEPS_H

#include "study/grid/observer.h"
#include "study/grid/study.h"
#include "study/trade/contender.h"

enum { BR_DRIFT_N = 10, BR_DRIFT_SCENES = 2, BR_DRIFT_CONTENDERS = 32 };

/* What is asked for. Borrowed. */
struct br_drifts_plan {
    const double *k; /* s; NULL: from one step to 1e5, to 1e6 where a step is one solve, and to 1e7
                        in Example 1 by implicit Euler with implicit contact */
    size_t k_count;
    int threads;  /* 0: all cores */
    int rounding; /* of the marches, as fesetround takes it */
};

/* One march. */
struct br_drift {
    size_t steps;        /* 0: not marched */
    double deviation[2]; /* by br_field_kind: at the end, largest of all nodal displacements,
                            relative to the field's largest displacement */
    double predicted;    /* br_march_round_off */
    double time_error;   /* largest of the times told, relative to the duration: against n T/N in
                            whole numbers */
    struct br_error refused; /* status BR_OK where it marched */
};

struct br_drifts {
    struct br_scene scene[BR_DRIFT_SCENES];             /* owned */
    struct br_contender contender[BR_DRIFT_CONTENDERS]; /* by scheme and contact; solvers of one
                                                           of these are neighbours */
    size_t contenders, solvers, k_count;                /* solvers: of each scheme and contact */
    size_t *steps;                                      /* k_count; owned */
    struct br_drift *drift;                             /* by scene, contender, k; owned */
};

/* Measures all; *drifts (out) is to be cleared, also after a failure. Fails with BR_BAD_INPUT (a k
 * that does not divide the duration), BR_UNSUPPORTED where long double has no more digits than
 * double, BR_NO_MEMORY, BR_INTERRUPTED. */
enum br_status br_drifts_run(struct br_drifts *drifts, const struct br_drifts_plan *plan,
                             const struct br_observer *observer, struct br_error *err);
void br_drifts_clear(struct br_drifts *drifts);

const struct br_drift *br_drift_at(const struct br_drifts *drifts, size_t scene, size_t contender,
                                   size_t k);

/* The larger deviation of both fields; NaN where there is none. */
double br_drift_deviation(const struct br_drift *drift);

/* BR_OK, or BR_VERDICT with the first march that is above its prediction, failed (a step that the
 * scheme refuses by rule, BR_BAD_INPUT, is no failure), or whose times drift. */
enum br_status br_drifts_verdict(const struct br_drifts *drifts, struct br_error *err);

#endif
