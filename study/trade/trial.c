/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/trade/trial.h"
#include "study/grid/observer.h"

#include <math.h>

const char *br_trial_end_name(enum br_trial_end end)
{
    static const char *const words[] = {
#define X(name, word) [name] = word,
        BR_TRIAL_LIST(X)
#undef X
    };
    return words[end];
}

struct br_trial_request br_trial_request_default(const struct br_scene *scene)
{
    return (struct br_trial_request){
        .scene = scene,
        .reference_method = br_method_default(),
        .norm = br_norms,
        .norms = 1,
        .repeats = 3,
        .repeat_seconds = 0.1,
        .time_limit = 10,
    };
}

struct br_method br_trial_method(const struct br_trial *trial)
{
    struct br_method method = trial->named->method;
    if (br_named_method_adaptive(trial->named))
        method.tolerance = trial->tolerance;
    return method;
}

double br_trial_seconds(const struct br_trial *trial)
{
    return trial->cost.set_up + trial->cost.march;
}

double br_trial_relative(const struct br_trial *trial, size_t m, enum br_part part)
{
    return trial->scale[m] > 0 ? trial->error[m][part] / trial->scale[m] : NAN;
}

double br_trial_bound(const struct br_trial *trial, size_t m)
{
    const double own = isfinite(trial->own[m]) ? trial->own[m] : 0;
    const bool counts = trial->end == BR_TRIAL_DONE || trial->end == BR_TRIAL_DOUBTFUL;
    return counts && trial->scale[m] > 0 ? (trial->error[m][BR_PART_TOTAL] + own) / trial->scale[m]
                                         : NAN;
}

/* A share of the whole work, for the observer. */
struct share {
    const struct br_observer *whole;
    double from, length;
};

static void tell_share(void *self, double fraction)
{
    const struct share *share = self;
    share->whole->progress(share->whole->self, share->from + share->length * fraction);
}

static void tell_preparing(void *self, double fraction)
{
    const struct share *share = self;
    share->whole->preparing(share->whole->self, fraction);
}

static bool stop_share(void *self)
{
    const struct share *share = self;
    return share->whole->stop && share->whole->stop(share->whole->self);
}

/* Seconds take about three quarters of the time. */
enum br_status br_trials_hold(struct br_trial *trial, size_t count,
                              const struct br_trial_request *request, struct br_error *err)
{
    struct share share = {.whole = request->observer, .length = 0.75};
    const struct br_observer part = {
        .progress = request->observer && request->observer->progress ? tell_share : NULL,
        .stop = stop_share,
        .self = &share,
        .preparing = request->observer && request->observer->preparing ? tell_preparing : NULL,
    };
    struct br_trial_request own = *request;
    own.observer = request->observer ? &part : NULL;
    enum br_status status = br_trials_time(trial, count, &own, err);
    share = (struct share){request->observer, 0.75, 0.25};
    return status ? status : br_trials_judge(trial, count, &own, err);
}
