/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The seconds that trials will take, by the costs of their marches and of references
 * (study/grid/costs.h). */
#include <math.h>

#include "base/each.h"
#include "study/grid/costs.h"
#include "study/trade/trial.h"

/* ---- a method ---- */

double br_trial_work(const struct br_scene *scene, const struct br_trial *t)
{
    const struct br_method method = br_trial_method(t);
    const struct br_planned_march march = br_planned(scene, &method, t->at);
    return br_march_seconds(&march);
}

/* All equal steps have one pace. The costs do not know how many steps an adaptive method makes at a
 * tolerance. */
static bool share_pace(const struct br_trial *a, const struct br_trial *b)
{
    return a->tolerance == b->tolerance && (a->tolerance == 0 || a->named == b->named);
}

/* The pace of trial i: that of the dearest one of those that share it. */
static enum br_status find_pace(const struct br_trial_request *r, const struct br_trial *trial,
                                size_t count, size_t i, double *pace, struct br_error *err)
{
    size_t dearest = i;
    pace[i] = r->pace;
    if (r->pace > 0)
        return BR_OK;
    for (size_t j = 0; j < count; j++) {
        if (!share_pace(&trial[j], &trial[i]))
            continue;
        if (j < i) {
            pace[i] = pace[j];
            return BR_OK;
        }
        if (br_trial_work(r->scene, &trial[j]) > br_trial_work(r->scene, &trial[dearest]))
            dearest = j;
    }
    const struct br_method method = br_trial_method(&trial[dearest]);
    const struct br_planned_march march = br_planned(r->scene, &method, trial[dearest].at);
    return br_observer_stops(r->observer) ? br_fail(err, BR_INTERRUPTED, "interrupted")
                                          : br_march_pace(&march, &pace[i], err);
}

/* ---- the reference ---- */

static bool on_one_mesh(const struct br_trial *a, const struct br_trial *b)
{
    return a->at.n == b->at.n && a->named->method.axial_degree == b->named->method.axial_degree;
}

/* Seconds of the reference for trial i: levels on a mesh that no trial before it has and, if the
 * reference marches for each mesh, its march. */
static double reference_seconds(const struct br_trial_request *r, const struct br_trial *trial,
                                size_t i)
{
    static const size_t none = 0;
    const struct br_resolution *at = &trial[i].at;
    struct br_study s = {.scene = r->scene,
                         .reference_kind = br_trials_reference(r),
                         .reference_method = r->reference_method,
                         .reference = r->reference,
                         .n_count = 1,
                         .k_count = 1,
                         .n = &at->n,
                         .steps = &at->steps};
    bool mesh = true, levels = true;
    for (size_t j = 0; j < i; j++)
        if (trial[j].end != BR_TRIAL_LEFT && on_one_mesh(&trial[j], &trial[i])) {
            mesh = false;
            levels = levels && trial[j].at.steps != at->steps;
        }
    const double whole = br_reference_seconds(&s);
    s.steps = &none;
    const double set_up = br_reference_seconds(&s);
    return levels * (whole - set_up) + (mesh && s.reference_kind->nests) * set_up;
}

/* ---- a trial ---- */

/* Seconds of a trial's timed marches (trial.c) and of the march whose error is measured; pace: of
 * this machine. */
static double marches(const struct br_trial_request *r, const struct br_trial *t, double pace)
{
    const struct br_method *m = &t->named->method;
    const double march = pace * br_trial_work(r->scene, t), soon = r->repeat_seconds;
    const double measured = march + br_measure_seconds(r->scene, t->at.n, t->at.steps);
    const bool whole = m->scheme->adaptive || m->friction->iterates;
    if (r->time_limit > 0 && march > r->time_limit)
        return whole ? r->time_limit : soon;
    const double repeats = fmin((double)r->repeats, 1 + floor(soon / fmax(march, 1e-9)));
    const double timed = march <= soon ? march * (1 + repeats) : whole ? march : soon;
    return timed + measured / br_threads(r->threads);
}

/* ---- all of them ---- */

/* What the seconds of trials are made from. */
struct forecasting {
    const struct br_trial_request *request;
    double *march; /* s, without the reference */
};

static void estimate(const struct forecasting *f, struct br_trial *trial, size_t i)
{
    trial[i].estimated =
        f->march[i] + reference_seconds(f->request, trial, i) / br_threads(f->request->threads);
}

static double sum_of(const struct br_trial *trial, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += trial[i].end == BR_TRIAL_LEFT ? 0 : trial[i].estimated;
    return sum;
}

/* Leaves out the dearest trials until the others take no longer than allowed; one always remains.
 * What the reference did for a trial passes on to the next ones on its mesh. */
static void leave_out(const struct forecasting *f, struct br_trial *trial, size_t count,
                      struct br_trial_forecast *forecast)
{
    const double all = forecast->seconds;
    while (forecast->planned > 1 && forecast->seconds > f->request->seconds) {
        size_t dearest = count;
        for (size_t i = 0; i < count; i++)
            if (trial[i].end != BR_TRIAL_LEFT &&
                (dearest == count || trial[i].estimated > trial[dearest].estimated))
                dearest = i;
        trial[dearest].end = BR_TRIAL_LEFT;
        for (size_t i = dearest + 1; i < count; i++)
            if (on_one_mesh(&trial[i], &trial[dearest]))
                estimate(f, trial, i);
        forecast->seconds = sum_of(trial, count);
        forecast->planned--;
        forecast->left++;
    }
    forecast->left_seconds = all - forecast->seconds;
}

enum br_status br_trials_estimate(struct br_trial *trial, size_t count,
                                  const struct br_trial_request *r,
                                  struct br_trial_forecast *forecast, struct br_error *err)
{
    *forecast = (struct br_trial_forecast){.planned = count};
    struct forecasting f = {.request = r, .march = br_allocate(count, sizeof *f.march)};
    double *pace = br_allocate(count, sizeof *pace);
    enum br_status status = pace && f.march ? BR_OK : br_no_memory(err, "the trials");
    for (size_t i = 0; i < count && !status; i++) {
        trial[i].end = BR_TRIAL_DONE;
        status = find_pace(r, trial, count, i, pace, err);
        f.march[i] = marches(r, &trial[i], pace[i]);
    }
    for (size_t i = 0; i < count && !status; i++)
        estimate(&f, trial, i);
    forecast->seconds = status ? 0 : sum_of(trial, count);
    if (!status && r->seconds > 0)
        leave_out(&f, trial, count, forecast);
    free(pace);
    free(f.march);
    return status;
}
