/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The orders that a report claims. The error of a cell consists of one of space and one of time,
 * and the larger one hides the order of the other. The order in h comes from the differences of
 * successive meshes at one time step, which have no error of time, or from the joint fit of the
 * grid, if its interval is narrower. The order in k comes from the joint fit, or from the errors on
 * the finest mesh where the error of space is small there. Errors that do not fall, or fall slowly
 * and unevenly, give no order: the sizes are too coarse. */
#include "study/fit/report.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/fit/line_order.h"
#include "study/scene/words.h"

enum { LEAST = 3, MOST = 5 }; /* number of errors for an order; of more, the finest are used */
/* An error of space above this share of the error of time hides its order. */
static const double hidden = 0.1;
static const double near = 0.1, clear = 0.02; /* of an order */

/* Errors along a line of the grid, from coarse to fine. */
struct line {
    struct br_order_point point[MOST]; /* the finest that are not flagged; z in m or s */
    size_t count, left_out;
    enum br_flag flag; /* of the first that is left out */
};

#define REMARK(o, ...) br_append((o)->remark, sizeof(o)->remark, __VA_ARGS__)

struct br_study *br_report_fitted(const struct br_report *r)
{
    return r->exact ? r->exact : r->study;
}

/* ---- lines ---- */

/* The errors along an axis, at index `at` of the other axis. */
static struct line line_of(const struct br_study *s, enum br_part part, int axis, size_t at)
{
    struct line l = {0};
    for (size_t i = 0; i < br_axis_count(s, axis); i++) {
        const struct br_cell *c = &s->cell[br_axis_cell(s, axis, i, at)];
        if (c->flag[part] != BR_FLAG_NONE || !(c->error[part] > 0)) {
            l.flag = l.left_out++ ? l.flag : c->flag[part];
            continue;
        }
        if (l.count == MOST)
            memmove(l.point, l.point + 1, --l.count * sizeof *l.point);
        l.point[l.count++] =
            (struct br_order_point){br_axis_size(s->scene, axis, c->at),
                                    br_axis_size(s->scene, axis, c->against), c->error[part]};
    }
    return l;
}

/* The errors over h at the coarsest time step that has enough of them. *column: out. */
static struct line meshes_of(const struct br_study *s, enum br_part part, size_t *column)
{
    for (*column = 0; *column < s->k_count; ++*column) {
        const struct line l = line_of(s, part, BR_AXIS_SPACE, *column);
        if (l.count >= LEAST)
            return l;
    }
    return line_of(s, part, BR_AXIS_SPACE, *column = 0);
}

/* The order from point i to the next; the loss by finite references is that of theory. */
static double rate(const struct line *l, size_t i, double theory)
{
    const struct br_order_point *a = &l->point[i], *b = a + 1;
    const double lost =
        log(1 - pow(a->z_against / a->z, theory)) - log(1 - pow(b->z_against / b->z, theory));
    return (log(a->error / b->error) - lost) / log(a->z / b->z);
}

/* ---- observed orders ---- */

static void say_rates(struct br_seen_order *o, const struct line *l)
{
    for (size_t i = 0; i + 1 < l->count; i++)
        REMARK(o, "%s%.2f", i ? ", " : " ", rate(l, i, o->theory.formal));
    REMARK(o, " from size to size");
}

/* The order of theory that is nearest to an observed one. */
static double nearest(const struct br_seen_order *o, double order)
{
    const struct br_theory *t = &o->theory;
    return isnan(t->order) ? t->formal : fmin(fmax(order, t->order), t->highest);
}

/* By how much the last rate is nearer to theory than the first one, relative to theory. */
static double comes_closer(const struct br_seen_order *o, const struct line *l)
{
    const double formal = o->theory.formal, first = rate(l, 0, formal);
    const double last = rate(l, l->count - 2, formal);
    return (fabs(first - nearest(o, first)) - fabs(last - nearest(o, last))) / formal;
}

/* Sets order and remark. l: its rates follow where the order is not as in theory; NULL: none. */
static void claim(struct br_seen_order *o, struct br_estimate order, const struct line *l)
{
    const double theory = nearest(o, order.value), off = fabs(order.value - theory) / theory;
    const bool fits = order.low <= theory && theory <= order.high;
    o->order = order;
    if (isnan(o->theory.order)) {
        REMARK(o, "theory states none: %s", o->theory.reason);
        return;
    }
    if (off <= near && (fits || off <= near / 2))
        REMARK(o, "as in theory");
    else if (off <= near)
        REMARK(o, "near theory");
    else
        REMARK(o, fits ? "not settled" : order.value < theory ? "below theory" : "above theory");
    if (off <= near || !l)
        return;
    REMARK(o, comes_closer(o, l) > clear ? ", but comes closer:" : ":");
    say_rates(o, l);
}

static void say_too_few(struct br_seen_order *o, const struct line *l)
{
    REMARK(o, "not seen: %zu error%s, an order needs %d", l->count, l->count == 1 ? "" : "s",
           LEAST);
    if (l->left_out)
        REMARK(o, "; %zu left out%s%s", l->left_out, l->flag ? ", the first: " : "",
               l->flag == BR_FLAG_ROUND_OFF ? "at the round-off" : br_flag_name(l->flag));
}

/* Sets the order from the errors of a line. */
static enum br_status judge_line(struct br_seen_order *o, const struct line *l, int axis,
                                 struct br_error *err)
{
    struct br_line_order found;
    bool falls = true;
    if (l->count < LEAST) {
        say_too_few(o, l);
        return BR_OK;
    }
    for (size_t i = 1; i < l->count; i++)
        falls = falls && l->point[i].error < l->point[i - 1].error;
    const enum br_status status = br_line_order_find(l->point, l->count, &found, err);
    const struct br_estimate order = found.order;
    if (status)
        return status;
    const bool settled = order.high - order.low <= near * order.value;
    if (falls && br_order_determined(&order) && (settled || order.value > o->theory.formal / 2)) {
        claim(o, order, l);
        return BR_OK;
    }
    if (falls) {
        REMARK(o, "not seen: the errors fall by orders of");
        say_rates(o, l);
    } else {
        REMARK(o, "not seen: the errors do not fall,");
        for (size_t i = 0; i < l->count; i++)
            REMARK(o, "%s%.1e", i ? ", " : " ", l->point[i].error);
    }
    const double closer = falls ? comes_closer(o, l) : 1;
    if (fabs(closer) > clear)
        REMARK(o, "; a %s %s may show it", closer > 0 ? "smaller" : "larger",
               br_axis_letters[axis]);
    return BR_OK;
}

/* Whether the joint fit determines an order that can be believed. */
static bool determines(const struct br_joint_fit *fit, int axis, double theory)
{
    return br_joint_describes(fit) && br_order_determined(&fit->order[axis]) &&
           fit->order[axis].value > theory / 2;
}

static void claim_joint(struct br_seen_order *o, const struct br_joint_fit *fit, int axis)
{
    snprintf(o->by, sizeof o->by, "joint fit of %zu cells, misfit %.2g %%", fit->points,
             100 * fit->misfit);
    *o->remark = '\0';
    claim(o, fit->order[axis], NULL);
}

static enum br_status see_in_h(const struct br_report *r, enum br_part part,
                               struct br_seen_order *o, struct br_error *err)
{
    const struct br_joint_fit *fit = &r->fits[part].joint;
    if (r->meshes) {
        size_t column;
        const struct line l = meshes_of(r->meshes, part, &column);
        snprintf(o->by, sizeof o->by, "each mesh against the next at k = %g s",
                 br_time_step(r->meshes->scene, r->meshes->steps[column]));
        const enum br_status status = judge_line(o, &l, BR_AXIS_SPACE, err);
        if (status)
            return status;
    }
    const struct br_estimate *p = &fit->order[BR_AXIS_SPACE];
    const double width = o->order.high - o->order.low;
    if (determines(fit, BR_AXIS_SPACE, o->theory.formal) && !(width <= p->high - p->low))
        claim_joint(o, fit, BR_AXIS_SPACE);
    else if (!r->meshes)
        REMARK(o, "not seen: %s", r->no_meshes ? r->no_meshes : "no meshes are compared");
    return BR_OK;
}

/* The error of space on the finest mesh, from the finest difference of meshes; 0: not known. */
static double error_of_space(const struct br_report *r, enum br_part part)
{
    const struct br_study *s = br_report_fitted(r);
    const double order = br_theory_of(s, part, BR_AXIS_SPACE).formal;
    size_t column;
    if (!r->meshes)
        return 0; /* not known */
    const struct line l = meshes_of(r->meshes, part, &column);
    if (!l.count)
        return 0;
    const struct br_order_point *p = &l.point[l.count - 1];
    const double h = br_mesh_size(s->scene, s->n[s->n_count - 1]);
    return p->error * pow(h, order) / (pow(p->z, order) - pow(p->z_against, order));
}

static enum br_status see_in_k(const struct br_report *r, enum br_part part,
                               struct br_seen_order *o, struct br_error *err)
{
    const struct br_study *s = br_report_fitted(r);
    const struct br_joint_fit *fit = &r->fits[part].joint;
    const struct line l = line_of(s, part, BR_AXIS_TIME, s->n_count - 1); /* the finest mesh */
    if (determines(fit, BR_AXIS_TIME, o->theory.formal)) {
        claim_joint(o, fit, BR_AXIS_TIME);
        return BR_OK;
    }
    const double space = error_of_space(r, part);
    snprintf(o->by, sizeof o->by, "%s on the finest mesh, n = %zu",
             s->judge == &br_judge_none ? "each step against the next" : "errors",
             s->n[s->n_count - 1]);
    if (l.count && space > hidden * l.point[l.count - 1].error) {
        REMARK(o, "hidden by the error in h, about %.1e beside %.1e: a finer mesh shows it", space,
               l.point[l.count - 1].error);
        return BR_OK;
    }
    return judge_line(o, &l, BR_AXIS_TIME, err);
}

static bool is_modelled(const struct br_scene *scene, enum br_part part)
{
    return (part != BR_PART_AXIAL || scene->axial.modelled) &&
           (part != BR_PART_BENDING || scene->bending.modelled);
}

enum br_status br_report_see_orders(struct br_report *r, struct br_error *err)
{
    const struct br_study *s = br_report_fitted(r);
    const bool none = s->judge == &br_judge_none;
    enum br_status status = BR_OK;
    for (enum br_part part = 0; part < BR_PARTS && !status; part++) {
        const bool has = is_modelled(s->scene, part) && br_study_cells(s) > 0;
        const bool asked[BR_AXES] = {has && (!none || r->meshes),
                                     has && (!none || !r->meshes) && !s->method.scheme->adaptive};
        for (int axis = 0; axis < BR_AXES && !status; axis++) {
            struct br_seen_order *o = &r->seen[part][axis];
            *o = (struct br_seen_order){.asked = asked[axis],
                                        .order = {NAN, NAN, NAN},
                                        .theory = br_theory_of(s, part, (enum br_axis)axis)};
            if (asked[axis])
                status = (axis == BR_AXIS_SPACE ? see_in_h : see_in_k)(r, part, o, err);
        }
    }
    return status;
}

/* ---- the report ---- */

static enum br_status extrapolate_tips(struct br_report *r, struct br_error *err)
{
    struct br_tips own = {0};
    const enum br_status status = r->tips ? BR_OK : br_tips_of_study(&own, r->study, err);
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++)
        r->tip[kind] = br_extrapolate(r->tips ? r->tips : &own, (enum br_field_kind)kind);
    br_tips_clear(&own);
    return status;
}

enum br_status br_report_finish(struct br_report *r, int threads, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (int part = 0; part < BR_PARTS && !status; part++)
        status = br_fit(br_report_fitted(r), (enum br_part)part, &r->fits[part], err);
    if (!status)
        status = br_report_see_orders(r, err);
    if (!status)
        status = extrapolate_tips(r, err);
    if (!status && r->exact)
        br_flag_beside(r->study);
    if (!status && r->printed)
        status = br_triangles(r->study, r->printed, BR_MOST_TRIANGLES, r->triangle, &r->triangles,
                              threads, err);
    return status;
}

void br_report_clear(struct br_report *r)
{
    free(r->printed);
    r->printed = NULL;
}

double br_report_ratio(const struct br_report *r, size_t cell)
{
    return r->printed ? r->study->cell[cell].error[BR_PART_TOTAL] / r->printed[cell] : NAN;
}
