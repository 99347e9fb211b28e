/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The errors of trials, as cells of studies: one study for each mesh and degree, whose cells are
 * marched by as many methods, so that the judge looks at that mesh once. */
#include <math.h>
#include <string.h>

#include "study/fit/fit.h"
#include "study/grid/sweep.h"
#include "study/trade/trial.h"

/* Trials on the same elements, as a chain of studies over the norms. */
struct group {
    struct br_trial **member; /* members, borrowed; likewise the next two */
    size_t *steps;
    struct br_method *method;
    size_t members;
};

struct groups {
    const struct br_trial_request *request;
    size_t count;
    struct group *group;      /* count; their lists lie in the next three, one after the other */
    struct br_trial **member; /* all owned */
    size_t *steps;
    struct br_method *method;
    struct br_study *study; /* count in the first norm, then the next norms of each */
};

/* Whether two trials are judged, on the same elements. */
static bool same_group(const struct br_trial *a, const struct br_trial *b)
{
    return a->end == BR_TRIAL_DONE && b->end == BR_TRIAL_DONE && a->at.n == b->at.n &&
           a->named->method.axial_degree == b->named->method.axial_degree;
}

/* Whether a trial is to be judged, and none before it on its elements. */
static bool is_first(const struct br_trial *trial, size_t i)
{
    for (size_t j = 0; j < i; j++)
        if (same_group(&trial[j], &trial[i]))
            return false;
    return trial[i].end == BR_TRIAL_DONE;
}

static void add_member(struct group *group, struct br_trial *trial)
{
    group->member[group->members] = trial;
    group->steps[group->members] = trial->at.steps;
    group->method[group->members++] = br_trial_method(trial);
}

static void collect(struct groups *g, struct br_trial *trial, size_t count)
{
    size_t used = 0;
    for (size_t i = 0; i < count; i++) {
        if (!is_first(trial, i))
            continue;
        struct group *group = &g->group[g->count++];
        *group = (struct group){&g->member[used], &g->steps[used], &g->method[used], 0};
        for (size_t j = i; j < count; j++)
            if (same_group(&trial[j], &trial[i]))
                add_member(group, &trial[j]);
        used += group->members;
    }
}

static struct br_study *study_of(const struct groups *g, size_t i, size_t m)
{
    return &g->study[m == 0 ? i : g->count + i * (g->request->norms - 1) + m - 1];
}

static void fill_studies(const struct groups *g, const struct br_judge *judge)
{
    const struct br_trial_request *r = g->request;
    for (size_t i = 0; i < g->count; i++)
        for (size_t m = 0; m < r->norms; m++) {
            struct br_study *s = study_of(g, i, m);
            *s = (struct br_study){
                .scene = r->scene,
                .norm = r->norm[m],
                .method = g->group[i].method[0],
                .cell_method = g->group[i].method,
                .judge = judge,
                .reference_method = r->reference_method,
                .reference = r->reference,
                .n_count = 1,
                .k_count = g->group[i].members,
                .n = &g->group[i].member[0]->at.n,
                .steps = g->group[i].steps,
                .next_norm = m + 1 < r->norms ? study_of(g, i, m + 1) : NULL,
            };
            s->reference_method.axial_degree = s->method.axial_degree;
        }
}

/* The judge's own error and round-off, in a norm. */
static double own_error(const struct br_study *s)
{
    const double told =
        br_norm_of_constant(s->norm, s->scene, s->judged_by.own_error, BR_PART_TOTAL);
    return isfinite(told) ? told + s->judged_by.round_off * s->reference_scale : NAN;
}

static void take_cell(struct br_trial *t, size_t m, const struct br_study *s,
                      const struct br_cell *cell)
{
    t->scale[m] = s->reference_scale;
    t->own[m] = own_error(s);
    memcpy(t->error[m], cell->error, sizeof cell->error);
    const double error = cell->error[BR_PART_TOTAL];
    if (cell->failure.status || !isfinite(error)) {
        t->end = BR_TRIAL_FAILED;
        t->failure = cell->failure;
        if (!cell->failure.status)
            br_fail(&t->failure, BR_NOT_FINITE, "its error is not a number");
    } else if (!(s->reference_scale > 0)) {
        t->end = BR_TRIAL_FAILED;
        br_fail(&t->failure, BR_NOT_FINITE, "the solution is zero: no error is relative to it");
    } else if (t->end == BR_TRIAL_DONE && cell->unstable) {
        t->end = BR_TRIAL_UNSTABLE;
        br_fail(&t->failure, BR_VERDICT,
                "the lagged contact is beyond its stability limit: bounded chatter");
    } else if (t->end == BR_TRIAL_DONE && !(error >= br_flag_margin * t->own[m]) &&
               isfinite(t->own[m])) {
        t->end = BR_TRIAL_DOUBTFUL;
    }
}

static void take_cells(const struct groups *g)
{
    for (size_t i = 0; i < g->count; i++)
        for (size_t m = 0; m < g->request->norms; m++) {
            const struct br_study *s = study_of(g, i, m);
            for (size_t c = 0; c < g->group[i].members; c++)
                take_cell(g->group[i].member[c], m, s, &s->cell[c]);
        }
}

static enum br_status allocate(struct groups *g, size_t count, struct br_error *err)
{
    g->group = br_allocate(count, sizeof *g->group);
    g->member = br_allocate(count, sizeof(struct br_trial *));
    g->steps = br_allocate(count, sizeof *g->steps);
    g->method = br_allocate(count, sizeof *g->method);
    g->study = br_allocate(count * g->request->norms, sizeof *g->study);
    return g->group && g->member && g->steps && g->method && g->study
               ? BR_OK
               : br_no_memory(err, "the trials");
}

static void clear(struct groups *g)
{
    for (size_t i = 0; g->study && i < g->count * g->request->norms; i++)
        br_study_clear(&g->study[i]);
    free(g->group);
    free(g->member);
    free(g->steps);
    free(g->method);
    free(g->study);
}

enum br_status br_trials_judge(struct br_trial *trial, size_t count,
                               const struct br_trial_request *request, struct br_error *err)
{
    const struct br_judge *judge = request->judge ? request->judge : br_judge_best(request->scene);
    if (!judge->create)
        return br_fail(err, BR_BAD_INPUT, "there is no judge of this scene's errors: %s",
                       judge->title);
    if (count == 0)
        return BR_OK;
    struct groups g = {.request = request};
    enum br_status status = allocate(&g, count, err);
    if (!status) {
        collect(&g, trial, count);
        fill_studies(&g, judge);
        if (g.count)
            status = br_study_run(g.study, g.count, request->threads, request->observer, err);
    }
    if (!status)
        take_cells(&g);
    clear(&g);
    return status;
}
