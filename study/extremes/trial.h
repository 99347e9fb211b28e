/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A case before the court, for extreme_judge.c, extreme_accuracy.c and extreme_units.c alone. */
#ifndef BR_STUDY_EXTREMES_TRIAL_H
#define BR_STUDY_EXTREMES_TRIAL_H

#include "study/extremes/judge.h"
#include "study/extremes/track.h"
#include "study/foresee/prediction.h"

enum { BR_EXTREME_PATIENCE = 2500 }; /* steps of the exact solution, and of adaptive schemes */

struct br_extreme_trial {
    const struct br_extreme_case *one;
    const struct br_extreme_court *court;
    struct br_extreme_verdict *verdict;
    struct br_scene scene, marched; /* the latter borrows */
    struct br_method method;
    struct br_track_places places;
    struct br_track *own, *other;
    struct br_prediction prediction;
    double judge_error[2]; /* of those who judge, by br_field_kind, relative; 0: not known */
    double beyond;         /* an error over what is stated, where it is more; 0: it is not */
    double error;          /* that error, or the largest */
    struct br_warnings warnings;
    bool done;
};

/* Decides a case, once and for all; the format is of what is to be said. */
__attribute__((format(printf, 3, 4))) void br_extreme_decide(struct br_extreme_trial *trial,
                                                             enum br_extreme_class which,
                                                             const char *format, ...);

/* What is marched where nothing is changed. */
struct br_track_request br_extreme_request(const struct br_extreme_trial *trial);

/* How accurate the march is, by the exact solution or by refinement, against what is stated;
 * decides. Fails with
 * BR_NO_MEMORY. */
enum br_status br_extreme_judge_accuracy(struct br_extreme_trial *trial, struct br_error *err);

/* Whether other units change the answer; decides where they do. Fails with BR_NO_MEMORY. */
enum br_status br_extreme_judge_units(struct br_extreme_trial *trial, struct br_error *err);

#endif
