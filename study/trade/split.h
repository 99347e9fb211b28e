/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the error of one run comes from. A chain of marches leads from the run to the solution:
 * each march removes one more source of error. The differences of neighbours, as functions of x and
 * t, add up to the whole error. Sources may interact; then their components depend on this order.
 *
 * To add a source: a name here, at its position in the chain, and what removes it in split.c. */
#ifndef BR_STUDY_TRADE_SPLIT_H
#define BR_STUDY_TRADE_SPLIT_H

#include "base/observer.h"
#include "study/grid/study.h"
#include "study/scene/named_method.h"

/* The sources, in the order of the chain. From BR_SOURCE_TIME on a component needs the refined
 * march. */
enum br_source {
    BR_SOURCE_ROUND_OFF,
    BR_SOURCE_ITERATION,
    BR_SOURCE_SMOOTHING,
    BR_SOURCE_LAG,
    BR_SOURCE_TIME,
    BR_SOURCE_SPACE,
    BR_SOURCES
};

/* A link of the chain from a run to the solution. */
struct br_variant {
    struct br_method method;
    size_t steps;    /* time levels; a multiple of the run's */
    bool continuous; /* the continuous problem; the other fields are unused */
};

/* A march with next to no time error, on the same mesh and with the same laws. */
struct br_refinement {
    struct br_variant variant; /* its scheme, tolerance and steps are used */
    char name[64];             /* "adaptive, tolerance 1e-11" */
};

/* One component of the error, the sum of the components' norms, or the whole. */
struct br_share {
    const char *name;                      /* as in the tables and in JSON */
    const char *none;                      /* why there is no such component; NULL: there is */
    double error[BR_MOST_NORMS][BR_PARTS]; /* its norm, in the norm's unit; 0 where there is none */
    double floor[BR_MOST_NORMS][BR_PARTS]; /* below it the component cannot be separated from
                                              other differences of the marches; same unit */
    double tip[2]; /* signed, at x = L and t = T, by br_field_kind, m; these add up */
};

struct br_split {
    /* in */
    const struct br_scene *scene;
    struct br_method method;
    struct br_resolution at;
    const struct br_norm *norm[BR_MOST_NORMS];
    size_t norms;
    /* out; in: zeros */
    const struct br_reference *reference_kind; /* of the whole and of the last component */
    struct br_share share[BR_SOURCES];
    struct br_share whole;
    struct br_share sum; /* its norms are at least the whole's, its tip is; without floors */
    double tip[2], solution_tip[2]; /* of the run and of the solution, at t = T, m */
    double scale[BR_MOST_NORMS];    /* the norm of the solution */
    struct br_refinement refined;
    double predicted_round_off; /* of the run's linear solver, relative */
    bool unstable;              /* br_march_contact_unstable */
};

/* Marches the chain, all its links at once on `threads` threads (0: all cores). Fails with
 * BR_NOT_FINITE where the run fails or no reference can promise a solution of the scene, and as
 * br_study_run does. */
enum br_status br_split_run(struct br_split *split, int threads, const struct br_observer *observer,
                            struct br_error *err);

/* Whether a component is above its floor. */
static inline bool br_share_known(const struct br_share *share, size_t norm, enum br_part part)
{
    return share->error[norm][part] > share->floor[norm][part];
}

/* The norm of a component over the sum of all components' norms; NaN where that sum is 0. */
static inline double br_share_of_sum(const struct br_split *split, const struct br_share *share,
                                     size_t norm, enum br_part part)
{
    return share->error[norm][part] / split->sum.error[norm][part];
}

#endif
