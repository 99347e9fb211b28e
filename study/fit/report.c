/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The orders that a report claims. The error of a cell consists of one of space and one of time,
 * and the larger one hides the order of the other. The order in h comes from the differences of
 * successive meshes at one time step, which have no error of time, or from the joint fit of the
 * grid, if its interval is narrower. The order in k comes from the joint fit, or from the errors on
 * the finest mesh where the error of space is small there; where these do not settle it, from the
 * differences of successive time steps on one mesh, which have no error of space. Errors that do
 * not fall, or fall slowly and unevenly, give no order: the sizes are too coarse. */
#include "study/fit/report.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/words.h"
#include "orders/line/line_order.h"
#include "solver/scene.h"

enum { LEAST = 3 }; /* errors for an order */
/* An error of space above this share of the error of time hides its order. */
static const double hidden = 0.1;
static const double near = 0.1, clear = 0.02; /* of an order */

/* Errors along a line of the grid, from coarse to fine. */
struct line {
    const struct br_study *study;
    int axis;
    size_t at;                                 /* index of the other axis */
    struct br_order_point point[BR_MOST_SEEN]; /* the finest not flagged; z in m or s */
    size_t count, left_out;
    enum br_flag flag; /* of the first that is left out */
};

#define REMARK(o, ...) br_append((o)->remark, sizeof(o)->remark, __VA_ARGS__)

/* ---- lines ---- */

/* The errors along an axis, at index `at` of the other axis. */
static struct line line_of(const struct br_study *s, enum br_part part, int axis, size_t at)
{
    struct line l = {.study = s, .axis = axis, .at = at};
    for (size_t i = 0; i < br_axis_count(s, axis); i++) {
        const struct br_cell *c = &s->cell[br_axis_cell(s, axis, i, at)];
        if (c->flag[part] != BR_FLAG_NONE || !(c->error[part] > 0)) {
            l.flag = l.left_out++ ? l.flag : c->flag[part];
            continue;
        }
        if (l.count == BR_MOST_SEEN)
            memmove(l.point, l.point + 1, --l.count * sizeof *l.point);
        l.point[l.count++] =
            (struct br_order_point){.z = br_axis_size(s->scene, axis, c->at),
                                    .z_against = br_axis_size(s->scene, axis, c->against),
                                    .error = c->error[part]};
    }
    return l;
}

/* The differences along an axis at the coarsest entry of the other one that has enough of them. */
static struct line differences_of(const struct br_study *s, enum br_part part, int axis)
{
    for (size_t at = 0; at < br_axis_count(s, 1 - axis); at++) {
        const struct line l = line_of(s, part, axis, at);
        if (l.count >= LEAST)
            return l;
    }
    return line_of(s, part, axis, 0);
}

/* The order from point i to the next. */
static double rate(const struct line *l, size_t i)
{
    return br_order_rate(&l->point[i], &l->point[i + 1]);
}

/* ---- observed orders ---- */

static void say_rates(struct br_seen_order *o, const struct line *l)
{
    for (size_t i = 0; i + 1 < l->count; i++)
        REMARK(o, "%s%.2f", i ? ", " : " ", rate(l, i));
    REMARK(o, " from row to row");
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
    const double formal = o->theory.formal, first = rate(l, 0);
    const double last = rate(l, l->count - 2);
    return (fabs(first - nearest(o, first)) - fabs(last - nearest(o, last))) / formal;
}

/* Whether the order is that of theory. */
static bool agrees(const struct br_seen_order *o)
{
    const double theory = nearest(o, o->order.value);
    const double off = fabs(o->order.value - theory) / theory;
    return off <= near / 2 || (off <= near && o->order.low <= theory && theory <= o->order.high);
}

/* Sets order and remark. l: its rates follow where the order is not as in theory; NULL: none. */
static void claim(struct br_seen_order *o, struct br_estimate order, const struct line *l)
{
    const double theory = nearest(o, order.value), off = fabs(order.value - theory) / theory;
    const bool fits = order.low <= theory && theory <= order.high;
    o->order = order;
    if (isnan(o->theory.order)) {
        REMARK(o, "no theory: %s", o->theory.reason);
        return;
    }
    if (agrees(o))
        REMARK(o, "agrees with theory");
    else if (off <= near)
        REMARK(o, "close to theory");
    else
        REMARK(o, fits ? "not settled" : order.value < theory ? "below theory" : "above theory");
    if (off <= near || !l)
        return;
    REMARK(o, comes_closer(o, l) > clear ? ", but comes closer:" : ":");
    say_rates(o, l);
}

static void say_too_few(struct br_seen_order *o, const struct line *l)
{
    const char *what = l->study->judge == &br_judge_none ? "difference" : "error";
    if (l->left_out)
        REMARK(o, "not measurable: %zu of %zu %ss are left out%s%s; an order needs %d", l->left_out,
               l->count + l->left_out, what, l->flag ? ", the first: " : "", br_flag_name(l->flag),
               LEAST);
    else
        REMARK(o, "not measurable: %zu %s%s, an order needs %d", l->count, what,
               l->count == 1 ? "" : "s", LEAST);
}

/* ---- what a picture shows ---- */

/* The point of the order that a cell is; its flag says why the order does not rest on it. */
static struct br_seen_point point_of(const struct line *l, const struct br_line_order *found,
                                     const struct br_cell *c, enum br_part part)
{
    struct br_seen_point p = {br_axis_size(l->study->scene, l->axis, c->at),
                              c->error[part],
                              c->flag[part],
                              {NAN, NAN, NAN}};
    size_t i = 0;
    while (i < l->count && l->point[i].z != p.z)
        i++;
    if (found && i < l->count && isfinite(found->order.value))
        p.flag = br_line_order_flag(found, l->point, i);
    return p;
}

/* Keeps the errors of a line, and which of them count. found: NULL for a joint fit. */
static void keep_points(struct br_seen_order *o, const struct line *l, enum br_part part,
                        const struct br_line_order *found)
{
    const size_t count = br_axis_count(l->study, l->axis);
    o->points = 0;
    for (size_t i = count > BR_MOST_SEEN ? count - BR_MOST_SEEN : 0; i < count; i++)
        o->point[o->points++] =
            point_of(l, found, &l->study->cell[br_axis_cell(l->study, l->axis, i, l->at)], part);
}

/* The cell of a kept point. */
static const struct br_cell *cell_of(const struct line *l, const struct br_seen_order *o, size_t i)
{
    const size_t along = br_axis_count(l->study, l->axis) - o->points + i;
    return &l->study->cell[br_axis_cell(l->study, l->axis, along, l->at)];
}

/* Draws the line of the order and its band through the errors that count. */
static void fit_line(struct br_seen_order *o, const struct line *l)
{
    struct br_order_point counts[BR_MOST_SEEN];
    for (size_t i = 0; i < o->points; i++)
        counts[i] = (struct br_order_point){
            .z = o->point[i].z,
            .z_against = br_axis_size(l->study->scene, l->axis, cell_of(l, o, i)->against),
            .error = o->point[i].flag ? (double)NAN : o->point[i].error};
    for (size_t i = 0; i < o->points; i++)
        o->point[i].fit = br_line_fit(counts, o->points, i, &o->order);
}

/* Sets the order from the errors of a line. */
static enum br_status judge_line(struct br_seen_order *o, const struct line *l, enum br_part part,
                                 struct br_error *err)
{
    struct br_line_order found = {.order = {NAN, NAN, NAN}};
    bool falls = true;
    keep_points(o, l, part, NULL);
    if (l->count < LEAST) {
        say_too_few(o, l);
        return BR_OK;
    }
    const enum br_status status = br_line_order_find(l->point, l->count, &found, err);
    const struct br_estimate order = found.order;
    if (status)
        return status;
    double before = INFINITY; /* the last error that counts */
    for (size_t i = 0; i < l->count; i++)
        if (!br_order_determined(&order) ||
            br_line_order_flag(&found, l->point, i) == BR_FLAG_NONE) {
            falls = falls && l->point[i].error < before;
            before = l->point[i].error;
        }
    const bool settled = order.high - order.low <= near * order.value;
    if (falls && br_order_determined(&order) && (settled || order.value > o->theory.formal / 2)) {
        claim(o, order, l);
        keep_points(o, l, part, &found);
        fit_line(o, l);
        return BR_OK;
    }
    if (falls) {
        REMARK(o, "not measurable: the errors fall with the orders");
        say_rates(o, l);
    } else {
        REMARK(o, "not measurable: the errors do not fall:");
        for (size_t i = 0; i < l->count; i++)
            REMARK(o, "%s%.1e", i ? ", " : " ", l->point[i].error);
    }
    const double closer = falls ? comes_closer(o, l) : 1;
    if (fabs(closer) > clear)
        REMARK(o, "; a %s %s may show the order", closer > 0 ? "smaller" : "larger",
               br_axis_letters[l->axis]);
    return BR_OK;
}

/* Whether the joint fit determines an order that can be believed. */
static bool determines(const struct br_joint_fit *fit, int axis, double theory)
{
    return br_joint_describes(fit) && br_order_determined(&fit->order[axis]) &&
           fit->order[axis].value > theory / 2;
}

/* Draws the model and its band along the line: the errors of the other axis bend it, and where they
 * subtract, an order inside the interval may show the least error. */
static void fit_model(struct br_seen_order *o, const struct br_joint_fit *fit, const struct line *l)
{
    enum { ORDERS = 32 }; /* of the interval, from end to end; the last one is the order itself */
    const double middle = sqrt(o->point[0].z * o->point[o->points - 1].z);
    for (size_t i = 0; i < o->points; i++) {
        const struct br_cell *c = cell_of(l, o, i);
        struct br_estimate *e = &o->point[i].fit;
        double size[BR_AXES], against[BR_AXES];
        for (int axis = 0; axis < BR_AXES; axis++) {
            size[axis] = br_axis_size(l->study->scene, axis, c->at);
            against[axis] = br_axis_size(l->study->scene, axis, c->against);
        }
        for (size_t j = 0; j <= ORDERS + 1; j++) {
            struct br_joint_fit other = *fit;
            double *order = &other.order[l->axis].value;
            if (j <= ORDERS)
                *order = o->order.low + (double)j / ORDERS * (o->order.high - o->order.low);
            other.c[l->axis].value *= pow(middle, o->order.value - *order);
            e->value = br_joint_model(&other, size, against);
            e->low = fmin(e->low, e->value); /* without the NaN of before */
            e->high = fmax(e->high, e->value);
        }
    }
}

static void claim_joint(struct br_seen_order *o, const struct br_joint_fit *fit,
                        const struct br_study *s, enum br_part part, int axis)
{
    const struct line l = line_of(s, part, axis, br_axis_count(s, 1 - axis) - 1);
    snprintf(o->by, sizeof o->by, "the joint fit of %zu cells, misfit %.2g %%", fit->points,
             100 * fit->misfit);
    *o->remark = '\0';
    o->joint = true;
    claim(o, fit->order[axis], NULL);
    /* all count */
    keep_points(o, &(struct line){.study = s, .axis = axis, .at = l.at}, part, NULL);
    fit_model(o, fit, &l);
}

static double width_of(const struct br_estimate *order)
{
    return order->high - order->low;
}

/* Sets the order from the differences along an axis. */
static enum br_status see_apart(const struct br_study *s, enum br_part part, int axis,
                                struct br_seen_order *o, struct br_error *err)
{
    const struct line l = differences_of(s, part, axis);
    if (axis == BR_AXIS_SPACE)
        snprintf(o->by, sizeof o->by, "differences of successive meshes at k = %g s",
                 br_time_step(s->scene, s->steps[l.at]));
    else
        snprintf(o->by, sizeof o->by, "differences of successive time steps at n = %zu",
                 s->n[l.at]);
    return judge_line(o, &l, part, err);
}

/* Differences do not depend on the other axis: where they show the order so well, no fit shows
 * more. */
static const double narrow = 0.02;

static enum br_status see_in_h(const struct br_report *r, enum br_part part,
                               struct br_seen_order *o, struct br_error *err)
{
    const struct br_joint_fit *fit = &r->fits[part].joint;
    const struct br_study *apart = r->apart[BR_AXIS_SPACE];
    const enum br_status status = apart ? see_apart(apart, part, BR_AXIS_SPACE, o, err) : BR_OK;
    if (status)
        return status;
    if (determines(fit, BR_AXIS_SPACE, o->theory.formal) &&
        !(width_of(&o->order) <= fmax(narrow, width_of(&fit->order[BR_AXIS_SPACE]))))
        claim_joint(o, fit, r->fitted, part, BR_AXIS_SPACE);
    else if (!apart)
        REMARK(o, "not measurable: %s", r->no_meshes ? r->no_meshes : "no meshes are compared");
    if (apart && !agrees(o) && isfinite(o->theory.order) && !r->printed) {
        const struct br_study *s = r->fitted;
        const bool lost = differences_of(apart, part, BR_AXIS_SPACE).flag == BR_FLAG_ROUND_OFF;
        size_t n = s->n[s->n_count - 1];
        n = !lost ? n : n < 32 ? 1 : n / 32;
        REMARK(o, "; %s meshes may settle it: -n %zu,%zu,%zu,%zu", lost ? "coarser" : "finer", n,
               2 * n, 4 * n, 8 * n);
    }
    return BR_OK;
}

/* The error of space on the finest mesh, from the finest difference of meshes; 0: not known. */
static double error_of_space(const struct br_report *r, enum br_part part)
{
    const struct br_study *s = r->fitted, *meshes = r->apart[BR_AXIS_SPACE];
    const double order = br_theory_of(s, part, BR_AXIS_SPACE).formal;
    if (!meshes)
        return 0; /* not known */
    const struct line l = differences_of(meshes, part, BR_AXIS_SPACE);
    if (!l.count)
        return 0;
    const struct br_order_point *p = &l.point[l.count - 1];
    const double h = br_mesh_size(s->scene, s->n[s->n_count - 1]);
    return p->error * pow(h, order) / (pow(p->z, order) - pow(p->z_against, order));
}

/* From the cells of the grid. */
static enum br_status see_in_grid(const struct br_report *r, enum br_part part,
                                  struct br_seen_order *o, struct br_error *err)
{
    const struct br_study *s = r->fitted;
    const struct br_joint_fit *fit = &r->fits[part].joint;
    const struct line l = line_of(s, part, BR_AXIS_TIME, s->n_count - 1); /* the finest mesh */
    if (determines(fit, BR_AXIS_TIME, o->theory.formal)) {
        claim_joint(o, fit, s, part, BR_AXIS_TIME);
        return BR_OK;
    }
    const double space = error_of_space(r, part);
    snprintf(o->by, sizeof o->by, "errors on the finest mesh, n = %zu", s->n[s->n_count - 1]);
    if (l.count && space > hidden * l.point[l.count - 1].error) {
        keep_points(o, &l, part, NULL);
        REMARK(o, "hidden by the error in h, about %.1e beside %.1e: a finer mesh shows the order",
               space, l.point[l.count - 1].error);
        return BR_OK;
    }
    return judge_line(o, &l, part, err);
}

bool br_seen_settles(const struct br_seen_order *o)
{
    return br_order_determined(&o->order) && width_of(&o->order) <= 2 * near * o->order.value &&
           agrees(o);
}

/* From the grid, and where that does not settle it, from the differences of time steps, if these
 * tell more. */
static enum br_status see_in_k(const struct br_report *r, enum br_part part,
                               struct br_seen_order *o, struct br_error *err)
{
    const struct br_study *s = r->fitted;
    struct br_seen_order apart = *o;
    enum br_status status = see_in_grid(r, part, o, err);
    if (status || !r->apart[BR_AXIS_TIME] || br_seen_settles(o))
        return status;
    status = see_apart(r->apart[BR_AXIS_TIME], part, BR_AXIS_TIME, &apart, err);
    if (isnan(o->order.value) || br_seen_settles(&apart) ||
        width_of(&apart.order) < width_of(&o->order))
        *o = apart;
    if (!agrees(o) && !r->printed) { /* a printed grid is as it is */
        const size_t finest = 16 * s->steps[s->k_count - 1];
        REMARK(o, "; smaller time steps may settle it: -k T/%zu,T/%zu,T/%zu", finest, 2 * finest,
               4 * finest);
    }
    return status;
}

bool br_report_settles(const struct br_report *r, enum br_axis axis)
{
    bool all = true;
    for (enum br_part part = 0; part < BR_PARTS; part++)
        all = all && (!r->seen[part][axis].asked || br_seen_settles(&r->seen[part][axis]));
    return all;
}

enum br_status br_report_see_orders(struct br_report *r, enum br_axis axis, struct br_error *err)
{
    const struct br_study *s = r->fitted;
    const bool over_h = axis == BR_AXIS_SPACE;
    enum br_status status = BR_OK;
    for (enum br_part part = 0; part < BR_PARTS && !status; part++) {
        struct br_seen_order *o = &r->seen[part][axis];
        *o = (struct br_seen_order){
            .asked = br_models(s->scene, part) && br_study_cells(s) > 0 &&
                     (over_h || !s->method.scheme->adaptive),
            .order = {NAN, NAN, NAN},
            .theory = br_theory_of(s, part, axis),
        };
        if (o->asked && part != BR_PART_TOTAL &&
            s->scene->axial.modelled != s->scene->bending.modelled)
            *o = r->seen[BR_PART_TOTAL][axis]; /* it is the total */
        else if (o->asked)
            status = (over_h ? see_in_h : see_in_k)(r, part, o, err);
    }
    return status;
}

/* ---- the report ---- */

enum br_status br_report_finish(struct br_report *r, int threads, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (enum br_part part = 0; part < BR_PARTS && !status; part++)
        status = br_fit(r->fitted, part, &r->fits[part], err);
    for (enum br_axis axis = 0; axis < BR_AXES && !status; axis++)
        status = br_report_see_orders(r, axis, err);
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
