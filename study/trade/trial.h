/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a result costs and what it is worth: trials. A trial is one named method at one resolution;
 * it gets the seconds of its march, undisturbed and alone, and its errors against a judge.
 *
 * Seconds are those of the processor in one thread, the least of several repeats after a warm-up.
 * Errors come from br_study_run, the same cells that `study` shows. */
#ifndef BR_STUDY_TRADE_TRIAL_H
#define BR_STUDY_TRADE_TRIAL_H

#include "study/grid/observer.h"
#include "study/grid/study.h"
#include "study/trade/named_method.h"

/* How a trial ended. */
enum br_trial_end {
    BR_TRIAL_DONE,
    BR_TRIAL_DOUBTFUL, /* the judge's own error is not far below */
    BR_TRIAL_UNSTABLE, /* lagged contact beyond its limit */
    BR_TRIAL_OVER,     /* takes longer than the time limit */
    BR_TRIAL_FAILED,
    BR_TRIAL_LEFT, /* for time: br_trials_foresee */
    BR_TRIAL_ENDS
};
extern const char *const br_trial_end_names[BR_TRIAL_ENDS];

/* What a march takes; the least of the repeats. */
struct br_trial_cost {
    double set_up, march; /* s of the processor, one thread; NaN: it did not end */
    size_t repeats;       /* marches that were timed */
    struct br_counts counts;
    size_t levels; /* time levels that were reached */
};

struct br_trial {
    /* in */
    const struct br_named_method *named; /* borrowed */
    struct br_resolution at; /* of an adaptive named method, at.steps are the levels looked at */
    double tolerance;        /* of an adaptive named method; otherwise 0 */
    bool printed;            /* the paper's method at a resolution of its printed tables */
    double foreseen;         /* by br_trials_foresee, s; 0: nobody has looked */
    /* out */
    enum br_trial_end end;
    struct br_trial_cost cost;
    double error[BR_PARTS];  /* in the request's norm and its unit; NaN: none */
    double scale;            /* the norm of the solution, same unit */
    double own;              /* the judge's own error, same unit; NaN: not known */
    struct br_error failure; /* why it is BR_TRIAL_FAILED or BR_TRIAL_OVER */
};

/* A trial by a named method: with so many steps or, of an adaptive one, to a tolerance, looked at
 * so often that each look is the end of a step. */
enum { BR_TRIAL_LEVELS = 20 };
struct br_trial br_trial_at(const struct br_named_method *named, size_t n, size_t steps,
                            double tolerance);

/* How trials are held. All borrowed. */
struct br_trial_request {
    const struct br_scene *scene;
    const struct br_judge *judge;      /* NULL: br_judge_best of the scene */
    struct br_method reference_method; /* of a judge that nests */
    struct br_resolution reference;    /* likewise */
    const struct br_norm *norm;
    size_t repeats;                     /* timed marches of a trial, at least 1 */
    double repeat_seconds;              /* no more repeats once they have taken so long, s */
    double time_limit;                  /* of one march with its set-up, s; 0: none */
    double seconds;                     /* of all trials, about; 0: however long they take */
    int threads;                        /* of the errors; 0: all cores */
    const struct br_observer *observer; /* NULL: nobody */
    struct br_kept *kept;               /* where trials are kept; NULL: nowhere */
};

/* What is asked for where nobody says otherwise: l2, 3 repeats within 0.1 s, 10 s a march. */
struct br_trial_request br_trial_request_default(const struct br_scene *scene);

/* What trials take together: marches, repeats and the judge, s of an idle machine, about. */
struct br_trial_outlook {
    double seconds;      /* of those that are held */
    double left_seconds; /* of those that are left out */
    size_t held, left;
};

/* Foresees what trials take, from a few steps of each method; where that is more than
 * request->seconds the dearest end as BR_TRIAL_LEFT, and br_trials_hold leaves them as they are.
 * Fails with BR_NO_MEMORY, BR_INTERRUPTED, or as the judge does. */
enum br_status br_trials_foresee(struct br_trial *trial, size_t count,
                                 const struct br_trial_request *request,
                                 struct br_trial_outlook *outlook, struct br_error *err);

/* Holds on to what the judge knows, so that it is found out once and not in every call: *self
 * (out), NULL where it need not be. Fails as the judge does; forget it even then. */
enum br_status br_trials_keep_judge(const struct br_trial_request *request, void **self,
                                    struct br_error *err);
void br_trials_forget_judge(const struct br_trial_request *request, void *self); /* accepts NULL */

/* Holds trials: the seconds of all, one after the other, then the errors of those that came to
 * their end, all at once. A march that fails is a result, and one over the limit is ended as soon
 * as that is sure. Fails with BR_BAD_INPUT (the judge cannot judge this scene), BR_NO_MEMORY,
 * BR_INTERRUPTED. */
enum br_status br_trials_hold(struct br_trial *trial, size_t count,
                              const struct br_trial_request *request, struct br_error *err);

/* Whether it is the same method at the same resolution. */
bool br_trials_same(const struct br_trial *a, const struct br_trial *b);

/* Marches a trial once, until its end or the time limit. *cost (out): what it took so far. Fails as
 * the march does, the reason in trial->failure; with BR_VERDICT where it is over the limit, which
 * trial->end is then; or with BR_INTERRUPTED. */
enum br_status br_trial_march(struct br_trial *trial, const struct br_trial_request *request,
                              struct br_trial_cost *cost, struct br_error *err);

/* Who judges: the request's, or the best of the scene. */
const struct br_judge *br_trials_judge(const struct br_trial_request *request);

/* Set-up and march, s; NaN: it did not come to its end. */
double br_trial_seconds(const struct br_trial *trial);

/* The error over the norm of the solution; NaN: none. */
double br_trial_relative(const struct br_trial *trial);

/* What the relative error is at most, the judge's own error added; NaN: no trial that counts. */
double br_trial_bound(const struct br_trial *trial);

/* The method that a trial marches with: its named method's, with the trial's tolerance. */
struct br_method br_trial_method(const struct br_trial *trial);

#endif
