/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The seconds of trials: each marches alone, in this thread, with nothing else at work. */
#include <math.h>

#include "solver/clock.h"
#include "study/foresee/resources.h"
#include "study/trade/trial.h"

/* Element-steps between two looks at the clock, which takes some 0.3 us. */
static const double between_looks = 1e5;

/* A march is given up early where its first steps say that it will take so many times the limit;
 * what an adaptive scheme will do, they do not say. */
static const double sure_excess = 1.5;
static const double least_evidence = 0.05; /* s of steps that an extrapolation is made from */

/* A trial at work. */
struct clocked {
    struct br_trial *trial;
    const struct br_trial_request *request;
    struct br_march *march;
    double set_up; /* s */
    double start;  /* of its steps, s of this thread */
};

static bool is_stopped(const struct br_trial_request *request)
{
    const struct br_observer *o = request->observer;
    return o && o->stop && o->stop(o->self);
}

/* What the march will have taken at its end, if it goes on like this, s; less where the steps so
 * far say nothing. */
static double foreseen(const struct clocked *c, double spent)
{
    const double done = (double)br_march_steps_done(c->march);
    if (br_named_method_adaptive(c->trial->named) || !(spent >= least_evidence))
        return spent;
    return c->set_up + spent * (double)c->trial->at.steps / (sure_excess * done);
}

/* Ends a march that takes too long, its set-up included. */
static enum br_status look_at_clock(const struct clocked *c, struct br_error *err)
{
    const double limit = c->request->time_limit, steps = br_thread_seconds() - c->start;
    const double spent = c->set_up + steps;
    if (is_stopped(c->request))
        return br_fail(err, BR_INTERRUPTED, "interrupted");
    if (!(limit > 0) || (spent <= limit && foreseen(c, steps) <= limit))
        return BR_OK;
    c->trial->end = BR_TRIAL_OVER;
    return br_fail(&c->trial->failure, BR_VERDICT,
                   "over the time limit of %g s: %.2g s for set-up and %zu of %zu time levels",
                   limit, spent, br_march_steps_done(c->march), c->trial->at.steps);
}

static enum br_status make_steps(const struct clocked *c, struct br_error *err)
{
    const size_t steps = c->trial->at.steps;
    const size_t every = 1 + (size_t)(between_looks / (double)c->trial->at.n);
    const bool adaptive = br_named_method_adaptive(c->trial->named);
    enum br_status status = BR_OK;
    for (size_t i = 1; i <= steps && !status; i++) {
        status = br_march_step(c->march, &c->trial->failure);
        if (!status && (i % every == 0 || i == steps || adaptive))
            status = look_at_clock(c, err);
    }
    return status;
}

/* Marches once; *cost (out) is what it took. */
static enum br_status march_once(struct clocked *c, struct br_trial_cost *cost,
                                 struct br_error *err)
{
    struct br_trial *t = c->trial;
    const struct br_method method = br_trial_method(t);
    const double start = br_thread_seconds();
    const struct br_planned_march planned = {
        .scene = c->request->scene, .method = &method, .n = t->at.n, .steps = t->at.steps};
    enum br_status status = br_fits_memory(&planned, br_memory_available(), &t->failure);
    if (!status)
        status = br_march_create(&c->march, c->request->scene, t->at.n, t->at.steps, &method,
                                 &t->failure);
    c->start = br_thread_seconds();
    cost->set_up = c->set_up = c->start - start;
    if (!status)
        status = look_at_clock(c, err);
    if (!status)
        status = make_steps(c, err);
    cost->march = br_thread_seconds() - c->start;
    if (!status)
        cost->counts = br_march_counts(c->march);
    br_march_free(c->march);
    c->march = NULL;
    return status;
}

/* The first march warms up, and counts where it takes so long that it is not repeated. */
static enum br_status repeat(struct clocked *c, struct br_error *err)
{
    const struct br_trial_request *r = c->request;
    struct br_trial_cost least = {.set_up = INFINITY}, now = {0};
    enum br_status status = march_once(c, &now, err);
    double spent = now.set_up + now.march;
    if (!status && !(spent <= r->repeat_seconds))
        least = now, least.repeats = 1;
    for (spent = 0; !status && least.repeats < r->repeats && spent <= r->repeat_seconds;) {
        if (least.repeats == 1 && least.set_up + least.march > r->repeat_seconds)
            break;
        status = march_once(c, &now, err);
        spent += now.set_up + now.march;
        now.repeats = least.repeats + 1;
        if (now.set_up + now.march < least.set_up + least.march)
            least = now;
        least.repeats = now.repeats;
    }
    if (!status)
        c->trial->cost = least;
    return status;
}

/* What a march does is a result; the rest ends the call. */
static enum br_status time_one(struct br_trial *trial, const struct br_trial_request *request,
                               struct br_error *err)
{
    struct clocked c = {.trial = trial, .request = request};
    const enum br_status status = repeat(&c, err);
    if (status == BR_INTERRUPTED)
        return status;
    if (status && trial->end != BR_TRIAL_OVER)
        trial->end = BR_TRIAL_FAILED;
    return BR_OK;
}

/* What a trial costs, about, for the observer. */
static double work_of(const struct br_trial *trial)
{
    return (double)trial->at.n * (double)trial->at.steps *
               br_time_scheme_stages(trial->named->method.scheme) +
           1e5;
}

static void begin(struct br_trial *t, const struct br_trial_request *request)
{
    t->end = BR_TRIAL_DONE;
    t->cost = (struct br_trial_cost){.set_up = NAN, .march = NAN};
    t->failure = (struct br_error){0};
    for (size_t m = 0; m < request->norms; m++) {
        t->scale[m] = t->own[m] = NAN;
        for (int part = 0; part < BR_PARTS; part++)
            t->error[m][part] = NAN;
    }
}

enum br_status br_trials_time(struct br_trial *trial, size_t count,
                              const struct br_trial_request *request, struct br_error *err)
{
    const struct br_observer *o = request->observer;
    double whole = 0, done = 0;
    for (size_t i = 0; i < count; i++)
        begin(&trial[i], request), whole += work_of(&trial[i]);
    enum br_status status = BR_OK;
    for (size_t i = 0; i < count && !status; i++) {
        status = is_stopped(request) ? br_fail(err, BR_INTERRUPTED, "interrupted")
                                     : time_one(&trial[i], request, err);
        done += work_of(&trial[i]);
        if (o && o->progress)
            o->progress(o->self, done / whole);
    }
    return status;
}
