/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The seconds that trials will take. Each method marches a few steps on two meshes, and the judge
 * samples a few time levels on one mesh. Costs are assumed linear in elements and in time levels.
 */
#include <math.h>

#include "solver/clock.h"
#include "study/base/each.h"
#include "study/foresee/warnings.h"
#include "study/trade/trial.h"

/* ---- a method ---- */

static const size_t probe_mesh[2] = {25, 400};
enum { LEVELS = 100 };                    /* time levels of a probe with equal steps */
static const double longest_probe = 0.02; /* s of steps */

/* Seconds of a march on the two meshes: of its set-up, and of one time level. */
struct pace {
    double set_up[2], level[2];
};

/* Marches until that has taken `longest_probe`. A march that fails costs nothing more; only
 * BR_NO_MEMORY and BR_INTERRUPTED fail the call. Trials with the same method and the same tolerance
 * have the same pace. */
static enum br_status find_pace(const struct br_trial_request *r, const struct br_trial *trial,
                                size_t i, struct pace *pace, struct br_error *err)
{
    struct br_trial_request little = *r;
    little.time_limit = longest_probe;
    for (size_t j = 0; j < i; j++)
        if (trial[j].named == trial[i].named && trial[j].tolerance == trial[i].tolerance) {
            pace[i] = pace[j];
            return BR_OK;
        }
    for (int mesh = 0; mesh < 2; mesh++) {
        struct br_trial probe = trial[i];
        struct br_trial_cost cost;
        probe.at.n = probe_mesh[mesh];
        probe.at.steps = probe.named->method.scheme->adaptive ? probe.at.steps : LEVELS;
        const enum br_status status = br_trial_march(&probe, &little, &cost, err);
        if (status == BR_INTERRUPTED)
            return status;
        if (status == BR_NO_MEMORY)
            return br_fail(err, status, "%s", probe.failure.message);
        pace[i].set_up[mesh] = isnan(cost.set_up) ? 0 : cost.set_up;
        pace[i].level[mesh] = 0;
        if (!status || status == BR_VERDICT) /* an unfinished first level counts as half of one */
            pace[i].level[mesh] = cost.march / fmax(0.5, (double)cost.levels);
    }
    return BR_OK;
}

/* The value at n elements, linear in n; it never decreases and is never negative. */
static double at_mesh(const double on[2], size_t n)
{
    const double slope = (on[1] - on[0]) / (double)(probe_mesh[1] - probe_mesh[0]);
    return fmax(0, on[0] + fmax(0, slope) * ((double)n - (double)probe_mesh[0]));
}

/* s of one march. */
static double march_seconds(const struct br_trial *t, const struct pace *pace)
{
    return at_mesh(pace->set_up, t->at.n) + (double)t->at.steps * at_mesh(pace->level, t->at.n);
}

/* ---- the judge ---- */

/* Seconds of the judge: for each mesh, and for one element at one time level. */
struct judging {
    double mesh, level;
};

static enum br_status create_judge(const struct br_trial_request *r,
                                   struct br_judge_request *request, void **self,
                                   struct br_error *err)
{
    const struct br_observer none = {0}, *o = r->observer ? r->observer : &none;
    request->scene = r->scene;
    request->lead = request->levels;
    request->stop = o->stop;
    request->stop_self = o->self;
    request->preparing = o->preparing;
    return br_trials_judge(r)->create(self, request, err);
}

enum br_status br_trials_keep_judge(const struct br_trial_request *r, void **self,
                                    struct br_error *err)
{
    const struct br_judge *judge = br_trials_judge(r);
    *self = NULL;
    return !judge->create || judge->nests
               ? BR_OK
               : create_judge(r, &(struct br_judge_request){.levels = 1}, self, err);
}

void br_trials_forget_judge(const struct br_trial_request *r, void *self)
{
    if (self)
        br_trials_judge(r)->free(self);
}

/* Samples a field at all levels. */
static enum br_status sample(const struct br_judge *judge, void *self,
                             const struct br_judge_request *request, enum br_field_kind kind,
                             double *values, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t level = 1; level <= request->levels && !status; level++) {
        status = judge->advance(self, kind, level, err);
        for (int measure = 0; measure < BR_TIP && !status; measure++) {
            const struct br_sample_at at = {kind, (enum br_measure)measure, 0};
            struct br_view view = {.values = values};
            if (request->measured[kind][measure])
                judge->sample(self, &at, &view);
        }
    }
    return status;
}

/* Times the judge at a few levels of one mesh; a judge that nests marches anew for each mesh. */
static enum br_status time_judge(const struct br_trial_request *r, struct judging *judging,
                                 struct br_error *err)
{
    enum { N = 100, FEW = 10 };
    static const size_t mesh = N;
    double values[BR_MOST_MODES * N];
    struct br_judge_request request = {
        .axial_degree = 1, .levels = FEW, .mesh_count = 1, .mesh = &mesh};
    const struct br_judge *judge = br_trials_judge(r);
    const bool modelled[2] = {r->scene->axial.modelled, r->scene->bending.modelled};
    const struct br_planned_march fine = {.scene = r->scene,
                                          .method = &r->reference_method,
                                          .n = r->reference.n,
                                          .steps = r->reference.steps};
    *judging = (struct judging){judge->nests ? br_march_seconds(&fine) : 0, 0};
    if (!judge->create || judge->nests)
        return BR_OK;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        for (int measure = 0; measure < BR_TIP; measure++)
            request.measured[kind][measure] =
                modelled[kind] && br_norm_needs(r->norm, (enum br_measure)measure);
    void *self = NULL;
    const double start = br_thread_seconds();
    enum br_status status = create_judge(r, &request, &self, err);
    const double created = br_thread_seconds();
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++)
        if (modelled[kind])
            status = sample(judge, self, &request, (enum br_field_kind)kind, values, err);
    *judging = (struct judging){created - start, (br_thread_seconds() - created) / (N * FEW)};
    judge->free(self);
    return status;
}

/* ---- a trial ---- */

/* A march that is far over the limit ends after this time, s. */
static const double soon = 0.1;

/* Seconds of a trial's timed marches and of the march for its error. */
static double marches(const struct br_trial_request *r, const struct br_trial *t, double march)
{
    const bool adaptive = t->named->method.scheme->adaptive;
    if (r->time_limit > 0 && march > r->time_limit)
        return adaptive || march < 2 * r->time_limit ? r->time_limit : fmin(soon, r->time_limit);
    const double repeats =
        march > r->repeat_seconds
            ? 0
            : fmin((double)r->repeats, 1 + floor(r->repeat_seconds / fmax(march, 1e-9)));
    return march * (1 + repeats) + march / br_threads(r->threads);
}

/* Seconds of the judge for trial i. A mesh, or a number of steps on it, costs only once. */
static double judged(const struct br_trial *trial, size_t i, const struct judging *judging)
{
    bool mesh = true, levels = true;
    for (size_t j = 0; j < i; j++)
        if (trial[j].at.n == trial[i].at.n &&
            trial[j].named->method.axial_degree == trial[i].named->method.axial_degree) {
            mesh = false;
            levels = levels && trial[j].at.steps != trial[i].at.steps;
        }
    return mesh * judging->mesh +
           levels * judging->level * (double)trial[i].at.n * (double)trial[i].at.steps;
}

/* ---- all of them ---- */

/* Leaves out the dearest trials until the others take no longer than allowed; one always remains.
 */
static void leave_out(struct br_trial *trial, size_t count, double allowed,
                      struct br_trial_forecast *forecast)
{
    while (forecast->planned > 1 && forecast->seconds > allowed) {
        struct br_trial *dearest = NULL;
        for (size_t i = 0; i < count; i++)
            if (trial[i].end != BR_TRIAL_LEFT &&
                (!dearest || trial[i].foreseen > dearest->foreseen))
                dearest = &trial[i];
        dearest->end = BR_TRIAL_LEFT;
        forecast->seconds -= dearest->foreseen;
        forecast->left_seconds += dearest->foreseen;
        forecast->planned--;
        forecast->left++;
    }
}

enum br_status br_trials_foresee(struct br_trial *trial, size_t count,
                                 const struct br_trial_request *r,
                                 struct br_trial_forecast *forecast, struct br_error *err)
{
    *forecast = (struct br_trial_forecast){.planned = count};
    struct judging judging;
    struct pace *pace = br_allocate(count, sizeof *pace);
    enum br_status status = pace ? time_judge(r, &judging, err) : br_no_memory(err, "the trials");
    for (size_t i = 0; i < count && !status; i++) {
        status = find_pace(r, trial, i, pace, err);
        trial[i].foreseen = marches(r, &trial[i], march_seconds(&trial[i], &pace[i])) +
                            judged(trial, i, &judging) / br_threads(r->threads);
        forecast->seconds += trial[i].foreseen;
    }
    free(pace);
    if (!status && r->seconds > 0)
        leave_out(trial, count, r->seconds, forecast);
    return status;
}
