/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the error of one run comes from. A chain of marches leads from the run to the solution:
 * each takes one source of error away and keeps the rest, so that the differences of neighbours,
 * as functions of x and t, add up to the whole error. Where a source acts differently beside
 * another one, its share is what goes when the sources are taken away in this order.
 *
 * To add a source: one row in split.c, where the chain has it. */
#ifndef BR_STUDY_TRADE_SPLIT_H
#define BR_STUDY_TRADE_SPLIT_H

#include "study/grid/observer.h"
#include "study/grid/study.h"
#include "study/trade/named_method.h"

enum { BR_MOST_SOURCES = 8 };

/* How far a run has been taken towards the solution. */
struct br_stand {
    struct br_method method;
    size_t steps;    /* time levels; a multiple of the run's */
    bool continuous; /* the continuous problem: the rest means nothing */
};

/* A way to have no time error, or nearly none: the same mesh and laws. */
struct br_refinement {
    struct br_stand stand; /* scheme, tolerance and steps count */
    char name[64];         /* "adaptive, tolerance 1e-11" */
};

struct br_source {
    const char *name;  /* as in the tables and in JSON */
    const char *title; /* a few words for a person */
    /* Takes this source away from a run of the scene, where it is there at all; otherwise returns
     * why not, a few words. */
    const char *(*remove)(const struct br_scene *scene, const struct br_refinement *refined,
                          struct br_stand *stand);
    bool in_time; /* its share comes from the refined march alone */
};

/* The chain, in its order; ends with a NULL name. */
extern const struct br_source br_sources[];

/* One part of the error, the sum of the parts' norms, or the whole. */
struct br_share {
    const struct br_source *source;        /* NULL: no part */
    const char *none;                      /* why there is no such part; NULL: there is */
    double error[BR_MOST_NORMS][BR_PARTS]; /* its norm, in the norm's unit; 0 where there is none */
    double floor[BR_MOST_NORMS][BR_PARTS]; /* below it the part cannot be separated from what else
                                              the two marches differ by; same unit */
    double tip[2]; /* signed, at x = L and t = T, by br_field_kind, m; these add up */
};

struct br_split {
    /* in */
    const struct br_scene *scene;
    struct br_method method;
    struct br_resolution at;
    const struct br_norm *norm[BR_MOST_NORMS];
    size_t norms;
    /* out */
    const struct br_judge *judge;           /* who knows the solution */
    struct br_share share[BR_MOST_SOURCES]; /* in the order of br_sources */
    size_t shares;
    struct br_share whole;
    struct br_share sum; /* its norms are at least the whole's, its tip is; without floors */
    double tip[2], solution_tip[2]; /* of the run and of the solution, at t = T, m */
    double scale[BR_MOST_NORMS];    /* the norm of the solution */
    struct br_refinement refined;
    double predicted_round_off; /* of the run's linear solver, relative */
    bool unstable;              /* br_march_contact_unstable */
};

/* Marches the chain, all its links at once on `threads` threads (0: all cores). Fails with
 * BR_NOT_FINITE where the run fails or nobody can promise a solution of the scene, and as
 * br_study_run does. */
enum br_status br_split_run(struct br_split *split, int threads, const struct br_observer *observer,
                            struct br_error *err);

/* Whether a part is above its floor. */
bool br_share_told(const struct br_share *share, size_t norm, enum br_part part);

/* Its norm over the sum of all parts' norms; NaN where that is 0. */
double br_share_of_sum(const struct br_split *split, const struct br_share *share, size_t norm,
                       enum br_part part);

#endif
