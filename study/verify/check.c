/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/verify/check.h"

#include "solver/scene.h"
#include "study/grid/sweep.h"

#include <math.h>
#include <stdio.h>

/* The studies of one kind of one check: over space and time a chain of norms for each pair of
 * neighbours, jointly one for the whole path. */
struct section {
    const struct br_scene_check *check;
    enum br_verify_kind kind;
    const struct br_norm *norm[BR_MOST_NORMS];
    size_t norms;
    size_t first, cases; /* cases chains, from `first` on */
};

/* Everything that is marched. */
struct plan {
    struct section *section;
    size_t sections;
    struct br_study *study; /* the first norms of all chains, then the second ones, ... */
    size_t cases, norms;    /* in the longest chain */
};

static const struct br_verify_study *study_of(const struct section *s)
{
    return &s->check->verify->study[s->kind];
}

static size_t norm_index(const struct section *s, const struct br_norm *norm)
{
    size_t i = 0;
    while (i < s->norms && s->norm[i] != norm)
        i++;
    return i;
}

/* ---- the plan ---- */

static void add_section(struct plan *plan, const struct br_scene_check *check,
                        enum br_verify_kind kind)
{
    struct section *s = &plan->section[plan->sections];
    *s = (struct section){.check = check, .kind = kind, .first = plan->cases};
    const struct br_verify_study *v = study_of(s);
    if (v->count == 0)
        return;
    for (size_t i = 0; i < v->expectations; i++)
        if (norm_index(s, v->expectation[i].norm) == s->norms)
            s->norm[s->norms++] = v->expectation[i].norm;
    s->cases = kind == BR_VERIFY_JOINT ? 1 : v->count - 1;
    plan->cases += s->cases;
    plan->norms = s->norms > plan->norms ? s->norms : plan->norms;
    plan->sections++;
}

struct br_study br_check_study(const struct br_scene_check *check, enum br_verify_kind kind,
                               size_t h)
{
    const struct br_verify_study *v = &check->verify->study[kind];
    const bool joint = kind == BR_VERIFY_JOINT;
    return (struct br_study){
        .scene = check->scene,
        .method = v->method,
        .reference_kind = joint ? br_reference_best(check->scene) : &br_reference_fine,
        .reference_method = v->method,
        .reference = joint ? (struct br_resolution){0, 0}
                           : (struct br_resolution){v->n[h + 1], v->steps[h + 1]},
        .n_count = joint ? v->count : 1,
        .k_count = joint ? v->count : 1,
        .path = true,
        .n = &v->n[h],
        .steps = &v->steps[h],
    };
}

/* The study of a section's case h in norm m. */
static struct br_study *study_in(const struct plan *plan, const struct section *s, size_t h,
                                 size_t m)
{
    return &plan->study[m * plan->cases + s->first + h];
}

static void fill_section(const struct plan *plan, const struct section *s)
{
    for (size_t h = 0; h < s->cases; h++)
        for (size_t m = 0; m < s->norms; m++) {
            struct br_study *study = study_in(plan, s, h, m);
            *study = br_check_study(s->check, s->kind, h);
            study->norm = s->norm[m];
            study->next_norm = m + 1 < s->norms ? study_in(plan, s, h, m + 1) : NULL;
        }
}

static enum br_status make_plan(struct plan *plan, const struct br_scene_check *checks,
                                size_t count, struct br_error *err)
{
    plan->section = br_allocate(count * BR_VERIFY_KINDS, sizeof *plan->section);
    if (!plan->section)
        return br_no_memory(err, "the check");
    for (size_t i = 0; i < count; i++)
        for (int kind = 0; kind < BR_VERIFY_KINDS; kind++)
            add_section(plan, &checks[i], (enum br_verify_kind)kind);
    plan->study = br_allocate(plan->cases * plan->norms, sizeof *plan->study);
    if (!plan->study)
        return br_no_memory(err, "the check");
    for (size_t i = 0; i < plan->sections; i++)
        fill_section(plan, &plan->section[i]);
    return BR_OK;
}

static void clear_plan(struct plan *plan)
{
    for (size_t i = 0; plan->study && i < plan->cases * plan->norms; i++)
        br_study_clear(&plan->study[i]);
    free(plan->study);
    free(plan->section);
}

/* ---- the results ---- */

/* h/L or k/T, the variable of a study's order; 0 for the continuous problem. */
static double refinement(enum br_verify_kind kind, struct br_resolution at)
{
    const size_t parts = kind == BR_VERIFY_SPACE ? at.n : at.steps;
    return parts ? 1 / (double)parts : 0;
}

/* Point i of a section in one norm and component. */
static struct br_point point_at(const struct plan *plan, const struct section *s, size_t i,
                                const struct br_verify_expectation *e)
{
    const bool joint = s->kind == BR_VERIFY_JOINT;
    const struct br_study *study = study_in(plan, s, joint ? 0 : i, norm_index(s, e->norm));
    const struct br_verify_study *v = study_of(s);
    struct br_point p = {
        .at = {v->n[i], v->steps[i]},
        .error = NAN,
        .flag = BR_FLAG_FAILED,
    };
    if (!joint)
        p.against = study->reference;
    p.z = refinement(s->kind, p.at);
    p.z_against = refinement(s->kind, p.against);
    const struct br_error *failure = &study->failure;
    if (!failure->status) {
        const struct br_cell *cell = &study->cell[joint ? i : 0];
        failure = &cell->failure;
        p.error = cell->error[e->part];
        p.flag = cell->flag[e->part];
        if (p.flag == BR_FLAG_NONE && study->reference_report.unstable)
            p.flag = BR_FLAG_UNSTABLE; /* the march that it is compared with */
    }
    if (s->kind == BR_VERIFY_SPACE)
        snprintf(p.label, sizeof p.label, "n = %zu", p.at.n);
    else if (s->kind == BR_VERIFY_TIME)
        snprintf(p.label, sizeof p.label, "k = T/%zu", p.at.steps);
    else
        snprintf(p.label, sizeof p.label, "(n = %zu, k = T/%zu)", p.at.n, p.at.steps);
    snprintf(p.failure, sizeof p.failure, "%.255s", failure->status ? failure->message : "");
    return p;
}

static enum br_status conclude_case(const struct plan *plan, const struct section *s,
                                    const struct br_verify_expectation *e, struct br_case *c,
                                    struct br_error *err)
{
    c->kind = s->kind;
    c->expected = e->band;
    c->measure = e->norm->name;
    c->part = br_part_names[e->part];
    c->unit = e->norm->unit;
    c->duration = s->check->scene->duration;
    c->points = br_verify_points(s->kind, study_of(s)->count);
    c->point = br_allocate(c->points, sizeof *c->point);
    if (!c->point)
        return br_no_memory(err, "the verdict");
    for (size_t i = 0; i < c->points; i++)
        c->point[i] = point_at(plan, s, i, e);
    const enum br_status status = br_case_observe(c, BR_VERIFY_LEAST_POINTS, err);
    if (!status)
        br_case_decide(c);
    return status;
}

/* Where a method refuses the scene, or the reference cannot solve it, there is nothing to verify.
 * Any other failure of a march is a verdict. */
static enum br_status check_verifiable(const struct plan *plan, const struct section *s,
                                       struct br_error *err)
{
    for (size_t h = 0; h < s->cases; h++) {
        const struct br_error *failure = &plan->study[s->first + h].failure;
        if (failure->status && (failure->status == BR_BAD_INPUT || s->kind == BR_VERIFY_JOINT))
            return br_fail(err, BR_BAD_INPUT,
                           "%s:%zu: verify: %s: the scene cannot be verified: %s",
                           s->check->check->path, study_of(s)->line, br_verify_names[s->kind],
                           failure->message);
    }
    return BR_OK;
}

static void add_cost(const struct br_study *study, const struct br_scene *scene,
                     struct br_check *check)
{
    const double fields = scene->axial.modelled + scene->bending.modelled;
    if (study->failure.status)
        return;
    for (size_t i = 0; i < br_study_cells(study); i++) {
        const struct br_resolution at = study->cell[i].at;
        check->seconds += study->cell[i].seconds;
        check->element_steps += fields * (double)at.n * (double)at.steps;
    }
    if (!study->reference_kind->nests)
        return;
    check->seconds += study->reference_report.seconds;
    check->element_steps += fields * (double)study->reference.n * (double)study->reference.steps;
}

static enum br_status conclude_section(const struct plan *plan, const struct section *s,
                                       struct br_error *err)
{
    const struct br_verify_study *v = study_of(s);
    struct br_check *check = s->check->check;
    enum br_status status = check_verifiable(plan, s, err);
    for (size_t h = 0; h < s->cases && !status; h++) {
        for (size_t m = 0; m < s->norms; m++)
            if (!study_in(plan, s, h, m)->failure.status)
                br_flag_beside(study_in(plan, s, h, m));
        add_cost(study_in(plan, s, h, 0), s->check->scene, check);
    }
    for (size_t i = 0; i < v->expectations && !status; i++)
        status = conclude_case(plan, s, &v->expectation[i], &check->cases[check->count++], err);
    return status;
}

static enum br_status conclude_check(const struct plan *plan, const struct br_scene_check *of,
                                     struct br_error *err)
{
    struct br_check *check = of->check;
    size_t cases = 0;
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++)
        cases += of->verify->study[kind].expectations;
    check->cases = br_allocate(cases, sizeof *check->cases);
    if (!check->cases)
        return br_no_memory(err, "the verdicts");
    struct br_error failure = {0};
    for (size_t i = 0; i < plan->sections && !failure.status; i++)
        if (plan->section[i].check == of)
            conclude_section(plan, &plan->section[i], &failure);
    if (failure.status && failure.status != BR_BAD_INPUT)
        return br_fail(err, failure.status, "%s", failure.message);
    if (failure.status)
        br_check_clear(check);
    check->failure = failure;
    return BR_OK;
}

enum br_status br_check_run(const struct br_scene_check *checks, size_t count, int threads,
                            const struct br_observer *observer, struct br_error *err)
{
    for (size_t i = 0; i < count; i++) {
        struct br_check *check = checks[i].check;
        check->failure = (struct br_error){0};
        check->cases = NULL;
        check->count = 0;
        check->seconds = check->element_steps = 0;
    }
    struct plan plan = {0};
    enum br_status status = make_plan(&plan, checks, count, err);
    if (!status)
        status = br_study_run_each(plan.study, plan.cases, threads, observer, err);
    for (size_t i = 0; i < count && !status; i++)
        status = conclude_check(&plan, &checks[i], err);
    for (size_t i = 0; i < count && status; i++)
        br_check_clear(checks[i].check);
    clear_plan(&plan);
    return status;
}
