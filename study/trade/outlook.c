/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What trials will take. Each method marches a few steps on two meshes, the judge looks at a few
 * time levels on one; costs elsewhere are linear in elements and in time levels. */
#include <math.h>

#include "study/foresee/warnings.h"
#include "study/grid/each.h"
#include "study/grid/sweep.h"
#include "study/trade/trial.h"

/* ---- a method ---- */

static const size_t probe_mesh[2] = {25, 400};
enum { LEVELS = 100 };                    /* of the duration, for steps that do not choose */
static const double longest_probe = 0.02; /* s of steps */

/* What a march takes on the two meshes: s, and s a time level. */
struct pace {
    double set_up[2], level[2];
};

/* Marches until that has taken long enough. A march that fails takes nothing more; only
 * BR_NO_MEMORY and BR_INTERRUPTED fail the call. Trials of one method, and of one tolerance, have
 * the same. */
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
        if (!status || status == BR_VERDICT) /* the level that it is in counts by half */
            pace[i].level[mesh] = cost.march / fmax(0.5, (double)cost.levels);
    }
    return BR_OK;
}

/* Linear in n, and growing. */
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

/* What it takes: s for each mesh, and s for a time level and an element. */
struct judging {
    double mesh, level;
};

/* It looks at few time levels of one mesh, and at more of them. A fine run marches anew for each
 * mesh. */
static enum br_status look_at_judge(const struct br_trial_request *r,
                                    const struct br_method *method, struct judging *judging,
                                    struct br_error *err)
{
    static const size_t n = 100, steps[2] = {10, 2000};
    const struct br_judge *judge = br_trials_judge(r);
    const struct br_planned_march fine = {.scene = r->scene,
                                          .method = &r->reference_method,
                                          .n = r->reference.n,
                                          .steps = r->reference.steps};
    struct br_observer quiet = r->observer ? *r->observer : (struct br_observer){0};
    double seconds[2] = {0, 0};
    enum br_status status = BR_OK;
    quiet.progress = NULL;
    for (int i = 0; i < 2 && judge->create && !judge->nests && !status; i++) {
        struct br_study s = {.scene = r->scene,
                             .norm = r->norm,
                             .method = *method,
                             .judge = judge,
                             .n_count = 1,
                             .k_count = 1,
                             .n = &n,
                             .steps = &steps[i]};
        status = br_study_run(&s, 1, 1, &quiet, err);
        seconds[i] = s.judged_by.seconds;
        br_study_clear(&s);
    }
    const double levels = (double)(n * (steps[1] - steps[0]));
    judging->level = fmax(0, seconds[1] - seconds[0]) / levels;
    judging->mesh = judge->nests ? br_march_seconds(&fine)
                                 : fmax(0, seconds[0] - judging->level * (double)(n * steps[0]));
    return status;
}

/* ---- a trial ---- */

/* An early end of a march that is over the limit, s. */
static const double soon = 0.1;

/* Of the marches for its seconds, and of the one for its error. */
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

/* The judge looks at a mesh once, and at its time levels that several trials have. */
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

/* Leaves out the dearest until the others take no longer than allowed; one is always held. */
static void leave_out(struct br_trial *trial, size_t count, double allowed,
                      struct br_trial_outlook *outlook)
{
    while (outlook->held > 1 && outlook->seconds > allowed) {
        struct br_trial *dearest = NULL;
        for (size_t i = 0; i < count; i++)
            if (trial[i].end != BR_TRIAL_LEFT &&
                (!dearest || trial[i].foreseen > dearest->foreseen))
                dearest = &trial[i];
        dearest->end = BR_TRIAL_LEFT;
        outlook->seconds -= dearest->foreseen;
        outlook->left_seconds += dearest->foreseen;
        outlook->held--;
        outlook->left++;
    }
}

enum br_status br_trials_foresee(struct br_trial *trial, size_t count,
                                 const struct br_trial_request *r, struct br_trial_outlook *outlook,
                                 struct br_error *err)
{
    *outlook = (struct br_trial_outlook){.held = count};
    struct judging judging;
    struct pace *pace = br_allocate(count, sizeof *pace);
    const struct br_method method = br_trial_method(trial);
    enum br_status status =
        pace ? look_at_judge(r, &method, &judging, err) : br_no_memory(err, "the trials");
    for (size_t i = 0; i < count && !status; i++) {
        status = find_pace(r, trial, i, pace, err);
        trial[i].foreseen = marches(r, &trial[i], march_seconds(&trial[i], &pace[i])) +
                            judged(trial, i, &judging) / br_threads(r->threads);
        outlook->seconds += trial[i].foreseen;
    }
    free(pace);
    if (!status && r->seconds > 0)
        leave_out(trial, count, r->seconds, outlook);
    return status;
}
