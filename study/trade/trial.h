/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Trials measure the cost and the error of a result. A trial is one named method at one resolution;
 * its march is timed alone, and a reference gives its errors.
 *
 * Seconds are those of the processor in one thread, the least of several repeats after a warm-up.
 * Errors come from br_study_run, as in the cells that `study` shows. */
#ifndef BR_STUDY_TRADE_TRIAL_H
#define BR_STUDY_TRADE_TRIAL_H

#include <math.h>

#include "base/observer.h"
#include "study/grid/study.h"
#include "study/scene/named_method.h"

/* How a trial ended. */
enum br_trial_end {
    BR_TRIAL_DONE,
    BR_TRIAL_DOUBTFUL, /* the reference's own error is not far below the trial's */
    BR_TRIAL_UNSTABLE, /* lagged contact beyond its limit */
    BR_TRIAL_OVER,     /* takes longer than the time limit */
    BR_TRIAL_FAILED,
    BR_TRIAL_LEFT, /* left out to save time, by br_trials_estimate */
    BR_TRIAL_ENDS
};
extern const char *const br_trial_end_names[BR_TRIAL_ENDS];

/* The cost of a march: the least of the repeats. */
struct br_trial_cost {
    double set_up, march; /* s of the processor, one thread; NaN: it did not end */
    size_t repeats;       /* marches that were timed */
    struct br_counts counts;
};

struct br_trial {
    /* in */
    const struct br_named_method *named; /* borrowed */
    struct br_resolution at; /* of an adaptive named method, at.steps are the sampled levels */
    double tolerance;        /* of an adaptive named method; otherwise 0 */
    bool printed;            /* the paper's method at a resolution of its printed tables */
    double estimated;        /* by br_trials_estimate, s; 0: not forecast */
    /* out */
    enum br_trial_end end;
    struct br_trial_cost cost;
    double error[BR_PARTS];  /* in the request's norm and its unit; NaN: none */
    double scale;            /* the norm of the solution, same unit */
    double own;              /* the reference's own error, same unit; NaN: not known */
    struct br_error failure; /* why it is BR_TRIAL_FAILED or BR_TRIAL_OVER */
};

/* A trial of a named method: with so many steps or, if the method is adaptive, with a tolerance and
 * BR_TRIAL_LEVELS sampled levels, each of which is the end of a step. */
enum { BR_TRIAL_LEVELS = 20 };
struct br_trial br_trial_at(const struct br_named_method *named, size_t n, size_t steps,
                            double tolerance);

/* How trials are run. All borrowed. */
struct br_trial_request {
    const struct br_scene *scene;
    const struct br_reference *reference_kind; /* NULL: br_reference_best of the scene */
    struct br_method reference_method;         /* of a reference that nests */
    struct br_resolution reference;            /* likewise */
    const struct br_norm *norm;
    size_t repeats;                     /* timed marches of a trial, at least 1 */
    double repeat_seconds;              /* no more repeats after this time, s */
    double time_limit;                  /* of one march with its set-up, s; 0: none */
    double seconds;                     /* of all trials, about; 0: no limit */
    double pace;                        /* s, of a second of br_trial_work; 0: a few steps tell */
    int threads;                        /* of the errors; 0: all cores */
    const struct br_observer *observer; /* NULL: nobody */
};

/* The default request: l2, 3 repeats within 0.01 s, 10 s a march. */
struct br_trial_request br_trial_request_default(const struct br_scene *scene);

/* Estimated seconds of all trials on an idle machine: marches, repeats and the reference. */
struct br_trial_forecast {
    double seconds;      /* of the planned trials */
    double left_seconds; /* of the trials that are left out */
    size_t planned, left;
};

/* The work of a trial, s on the machine of the registry's costs: what `trade` forecasts by.
 * Of an adaptive scheme its growth with n and the tolerance alone is right. */
double br_trial_work(const struct br_scene *scene, const struct br_trial *trial);

/* Forecasts the seconds of trials by their work and a few steps. Where they exceed
 * request->seconds, the dearest trials end as BR_TRIAL_LEFT, and br_trials_run does not run them.
 * Fails with BR_NO_MEMORY, BR_INTERRUPTED, or as the reference does. */
enum br_status br_trials_estimate(struct br_trial *trial, size_t count,
                                  const struct br_trial_request *request,
                                  struct br_trial_forecast *forecast, struct br_error *err);

/* Runs trials: times all, one after the other, then finds the errors of the complete ones, all at
 * once. A march that fails is a result, and a march over the limit is ended as soon as that is
 * sure. Fails as br_study_run does. */
enum br_status br_trials_run(struct br_trial *trial, size_t count,
                             const struct br_trial_request *request, struct br_error *err);

/* Whether it is the same method at the same resolution. */
static inline bool br_trials_same(const struct br_trial *a, const struct br_trial *b)
{
    return a->named == b->named && a->at.n == b->at.n && a->at.steps == b->at.steps &&
           a->tolerance == b->tolerance;
}

/* The reference of the request, or the best reference of the scene. */
static inline const struct br_reference *br_trials_reference(const struct br_trial_request *r)
{
    return r->reference_kind ? r->reference_kind : br_reference_best(r->scene);
}

/* Seconds of set-up and march; NaN: the march is not complete. */
static inline double br_trial_seconds(const struct br_trial *trial)
{
    return trial->cost.set_up + trial->cost.march;
}

/* The error over the norm of the solution; NaN: none. */
static inline double br_trial_relative(const struct br_trial *trial)
{
    return trial->scale > 0 ? trial->error[BR_PART_TOTAL] / trial->scale : NAN;
}

/* An upper bound of the relative error: the reference's own error is added. NaN: the trial has no
 * error that counts. */
static inline double br_trial_bound(const struct br_trial *trial)
{
    const double own = isfinite(trial->own) ? trial->own : 0;
    const bool counts = trial->end == BR_TRIAL_DONE || trial->end == BR_TRIAL_DOUBTFUL;
    return counts && trial->scale > 0 ? (trial->error[BR_PART_TOTAL] + own) / trial->scale : NAN;
}

/* The method that a trial marches with: its named method's, with the trial's tolerance. */
static inline struct br_method br_trial_method(const struct br_trial *trial)
{
    struct br_method method = trial->named->method;
    if (trial->named->method.scheme->adaptive)
        method.tolerance = trial->tolerance;
    return method;
}

#endif
