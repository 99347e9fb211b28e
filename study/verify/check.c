/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/verify/check.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/words.h"
#include "solver/scene.h"
#include "study/grid/sweep.h"

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

/* What is refined; of both, the order is one in k. */
static enum br_axis axis_of(enum br_verify_kind kind)
{
    return kind == BR_VERIFY_SPACE ? BR_AXIS_SPACE : BR_AXIS_TIME;
}

/* What cell i is compared with. */
static struct br_resolution against(const struct section *s, size_t i)
{
    const struct br_verify_study *v = study_of(s);
    return s->kind == BR_VERIFY_JOINT ? (struct br_resolution){0, 0}
                                      : (struct br_resolution){v->n[i + 1], v->steps[i + 1]};
}

/* h/L or k/T, the variable of a study's order; 0 for the continuous problem. */
static double refinement(enum br_verify_kind kind, struct br_resolution at)
{
    const size_t parts = kind == BR_VERIFY_SPACE ? at.n : at.steps;
    return parts ? 1 / (double)parts : 0;
}

/* Row i of a section's numbers. */
static enum br_status fill_row(const struct plan *plan, const struct section *s, size_t i,
                               struct br_numbers_row *row, struct br_error *err)
{
    const struct br_verify_study *v = study_of(s);
    const bool joint = s->kind == BR_VERIFY_JOINT;
    const enum br_axis axis = axis_of(s->kind);
    const size_t head = joint ? 0 : i, at = joint ? i : 0;
    const struct br_study *first = study_in(plan, s, head, 0);
    const struct br_error *failure =
        first->failure.status ? &first->failure : &first->cell[at].failure;
    row->given[axis] =
        axis == BR_AXIS_SPACE ? (double)v->n[i] : br_time_step(s->check->scene, v->steps[i]);
    row->z[axis] = refinement(s->kind, (struct br_resolution){v->n[i], v->steps[i]});
    row->against[axis] = refinement(s->kind, against(s, i));
    for (size_t e = 0; e < v->expectations && !failure->status; e++) {
        const struct br_verify_expectation *x = &v->expectation[e];
        const struct br_study *study = study_in(plan, s, head, norm_index(s, x->norm));
        row->number[e] = study->cell[at].error[x->part];
        row->out[e] = study->cell[at].flag[x->part];
        if (!row->out[e] && study->reference_report.unstable)
            row->out[e] = BR_FLAG_UNSTABLE; /* the march that it is compared with */
    }
    row->failure = failure->status ? strdup(failure->message) : NULL;
    return failure->status && !row->failure ? br_no_memory(err, "the verdict") : BR_OK;
}

/* The errors of a section, a quantity for each expectation, over its one size. */
static enum br_status fill_numbers(const struct plan *plan, const struct section *s,
                                   struct br_numbers *n, struct br_error *err)
{
    const struct br_verify_study *v = study_of(s);
    const enum br_axis axis = axis_of(s->kind);
    *n = (struct br_numbers){.all_needed = true};
    n->column[axis] = br_resolution_column_find(axis == BR_AXIS_SPACE ? "n" : "k");
    enum br_status status =
        br_numbers_make_room(n, br_verify_points(s->kind, v->count), v->expectations, err);
    for (size_t e = 0; e < v->expectations && !status; e++) {
        const struct br_verify_expectation *x = &v->expectation[e];
        status = br_numbers_add_quantity(n, x->norm->name, x->norm->unit, false, err);
        n->quantity[e].digits = DBL_DECIMAL_DIG;
    }
    for (size_t i = 0; i < n->rows && !status; i++)
        status = fill_row(plan, s, i, &n->row[i], err);
    return status;
}

/* The sizes along an axis, and one more: a finer one, or a coarser one where fine ones are lost. */
static void name_axis(struct br_case *c, const size_t *size, size_t count, double duration,
                      bool lost)
{
    const double a = (double)size[lost ? 0 : count - 1], b = (double)size[lost ? 1 : count - 2];
    if (size[0] == size[count - 1])
        return;
    br_append(c->reason, sizeof c->reason, duration > 0 ? " k: " : " n: ");
    for (size_t i = 0; i <= count; i++) {
        const bool more = i == (lost ? 0 : count);
        const double parts = more ? floor(a * a / b) : (double)size[lost ? i - 1 : i];
        br_append(c->reason, sizeof c->reason, duration > 0 ? "%s%.6g" : "%s%.15g", i ? ", " : "",
                  duration > 0 ? duration / parts : parts);
    }
    br_append(c->reason, sizeof c->reason, duration > 0 ? " s" : "");
}

/* What orders/ does not know of a case, and what would settle it: a line of the part `verify`. */
static void finish_case(const struct section *s, const struct br_verify_expectation *e,
                        struct br_case *c)
{
    const struct br_verify_study *v = study_of(s);
    const enum br_flag last = c->point[c->points - 1].flag;
    const bool lost = last == BR_FLAG_ROUND_OFF || last == BR_FLAG_REFERENCE;
    c->kind = s->kind;
    c->measure = e->norm->name;
    c->part = br_part_names[e->part];
    c->unit = e->norm->unit;
    for (size_t i = 0; i < c->points; i++) {
        c->point[i].at = (struct br_resolution){v->n[i], v->steps[i]};
        c->point[i].against = against(s, i);
    }
    if (c->verdict != BR_INCONCLUSIVE)
        return;
    br_append(c->reason, sizeof c->reason, "; expect it of");
    name_axis(c, v->n, v->count, 0, lost);
    name_axis(c, v->steps, v->count, s->check->scene->duration, lost);
}

/* The verdicts of a section, as those of a table. */
static enum br_status decide_section(const struct plan *plan, const struct section *s,
                                     struct br_error *err)
{
    const struct br_verify_study *v = study_of(s);
    struct br_check *check = s->check->check;
    struct br_numbers numbers;
    struct br_orders orders = {0};
    enum br_status status = fill_numbers(plan, s, &numbers, err);
    if (!status)
        status = br_orders_find(&numbers, 0, &orders, err);
    for (size_t i = 0; i < v->expectations && !status; i++) {
        const struct br_order_expectation e = {.axis = axis_of(s->kind),
                                               .band = v->expectation[i].band};
        status = br_orders_decide(&orders, &orders.of[i], &e, check, err);
        if (!status)
            finish_case(s, &v->expectation[i], &check->cases[check->count - 1]);
    }
    br_orders_clear(&orders);
    br_numbers_clear(&numbers);
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
    struct br_check *check = s->check->check;
    enum br_status status = check_verifiable(plan, s, err);
    for (size_t h = 0; h < s->cases && !status; h++) {
        for (size_t m = 0; m < s->norms; m++)
            if (!study_in(plan, s, h, m)->failure.status)
                br_flag_beside(study_in(plan, s, h, m));
        add_cost(study_in(plan, s, h, 0), s->check->scene, check);
    }
    return status ? status : decide_section(plan, s, err);
}

static enum br_status conclude_check(const struct plan *plan, const struct br_scene_check *of,
                                     struct br_error *err)
{
    struct br_check *check = of->check;
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
