/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The orders that a report claims: those that orders/ finds of the grid's errors and of differences
 * that have no error of the other axis, with the remark of theory. */
#include "study/fit/report.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/words.h"
#include "solver/scene.h"

static const double near = 0.1, clear = 0.02; /* of an order */

#define REMARK(o, ...) br_append((o)->remark, sizeof(o)->remark, __VA_ARGS__)

/* ---- the remark ---- */

/* The errors that an order was sought in, without those that are left out beforehand. */
struct sought {
    const struct br_point *point[BR_MOST_OBSERVED]; /* the finest ones, from coarse to fine */
    size_t count, left_out;
    enum br_flag flag; /* of the first that is left out */
};

static struct sought sought_in(const struct br_orders_line *line)
{
    struct sought l = {0};
    for (size_t i = 0; line && i < line->observed.points; i++) {
        const struct br_point *p = &line->observed.point[i];
        if (p->flag && !p->lost) {
            l.flag = l.left_out++ ? l.flag : p->flag;
            continue;
        }
        if (l.count == BR_MOST_OBSERVED)
            memmove(l.point, l.point + 1, --l.count * sizeof *l.point);
        l.point[l.count++] = p;
    }
    return l;
}

/* The order from point i to the next. */
static double rate(const struct sought *l, size_t i)
{
    return br_point_rate(l->point[i], l->point[i + 1]);
}

static void say_rates(struct br_observed_order *o, const struct sought *l)
{
    for (size_t i = 0; i + 1 < l->count; i++)
        REMARK(o, "%s%.2f", i ? ", " : " ", rate(l, i));
    REMARK(o, " from row to row");
}

/* The order of theory that is nearest to an observed one. */
static double nearest(const struct br_observed_order *o, double order)
{
    const struct br_theory *t = &o->theory;
    return isnan(t->order) ? t->formal : fmin(fmax(order, t->order), t->highest);
}

/* By how much the last rate is nearer to theory than the first one, relative to theory. */
static double comes_closer(const struct br_observed_order *o, const struct sought *l)
{
    const double formal = o->theory.formal, first = rate(l, 0);
    const double last = rate(l, l->count - 2);
    return (fabs(first - nearest(o, first)) - fabs(last - nearest(o, last))) / formal;
}

/* Whether the order is that of theory. */
static bool agrees(const struct br_observed_order *o)
{
    const double theory = nearest(o, o->order.value);
    const double off = fabs(o->order.value - theory) / theory;
    return off <= near / 2 || (off <= near && o->order.low <= theory && theory <= o->order.high);
}

/* How the order compares to theory. l: its rates follow where it is another one. */
static void compare(struct br_observed_order *o, const struct sought *l)
{
    const struct br_estimate *order = &o->order;
    const double theory = nearest(o, order->value), off = fabs(order->value - theory) / theory;
    const bool fits = order->low <= theory && theory <= order->high;
    if (isnan(o->theory.order)) {
        REMARK(o, "no theory: %s", o->theory.reason);
        return;
    }
    if (agrees(o))
        REMARK(o, "agrees with theory");
    else if (off <= near)
        REMARK(o, "close to theory");
    else
        REMARK(o, fits ? "not settled" : order->value < theory ? "below theory" : "above theory");
    if (off <= near || o->joint)
        return;
    REMARK(o, comes_closer(o, l) > clear ? ", but comes closer:" : ":");
    say_rates(o, l);
}

static void say_too_few(struct br_observed_order *o, const struct sought *l, const char *what)
{
    if (l->left_out)
        REMARK(o, "not measurable: %zu of %zu %ss are left out%s%s; an order needs %d", l->left_out,
               l->count + l->left_out, what, l->flag ? ", the first: " : "", br_flag_name(l->flag),
               BR_ORDERS_LEAST);
    else
        REMARK(o, "not measurable: %zu %s%s, an order needs %d", l->count, what,
               l->count == 1 ? "" : "s", BR_ORDERS_LEAST);
}

/* Why errors that do not fall as an order does show none, with what they do. advised: smaller sizes
 * are advised then. Returns whether larger ones may show the order. */
static bool say_uneven(struct br_observed_order *o, const struct sought *l, enum br_axis axis,
                       bool advised)
{
    bool falls = true;
    for (size_t i = 0; i + 1 < l->count; i++)
        falls = falls && l->point[i + 1]->error < l->point[i]->error;
    if (falls) {
        REMARK(o, "not measurable: the errors fall with the orders");
        say_rates(o, l);
    } else {
        REMARK(o, "not measurable: the errors do not fall:");
        for (size_t i = 0; i < l->count; i++)
            REMARK(o, "%s%.1e", i ? ", " : " ", l->point[i]->error);
    }
    const double closer = falls ? comes_closer(o, l) : 1;
    if (fabs(closer) > clear && !(advised && closer > 0))
        REMARK(o, "; a %s %s may show the order", closer > 0 ? "smaller" : "larger",
               br_axis_letters[axis]);
    return closer < -clear;
}

/* What more marches may settle an order that differences leave open. */
static void advise(struct br_observed_order *o, const struct br_study *s, enum br_axis axis,
                   enum br_flag first_out)
{
    const bool lost = first_out == BR_FLAG_ROUND_OFF;
    size_t n = s->n[s->n_count - 1];
    const size_t steps = 16 * s->steps[s->k_count - 1];
    n = !lost ? n : n < 32 ? 1 : n / 32;
    if (axis == BR_AXIS_SPACE)
        REMARK(o, "; %s meshes may settle it: -n %zu,%zu,%zu,%zu", lost ? "coarser" : "finer", n,
               2 * n, 4 * n, 8 * n);
    else
        REMARK(o, "; smaller time steps may settle it: -k T/%zu,T/%zu,T/%zu", steps, 2 * steps,
               4 * steps);
}

/* ---- the answer ---- */

/* Names the errors that the answer comes from. */
static void name_source(struct br_observed_order *o, const struct br_study *s,
                        const struct br_study *compared, const struct br_quantity_orders *of,
                        enum br_axis axis)
{
    static const char *const of_grid[BR_AXES] = {"errors at the smallest time step",
                                                 "errors on the finest mesh"};
    static const char *const differences[BR_AXES] = {"differences of successive meshes",
                                                     "differences of successive time steps"};
    const struct br_orders_answer *a = &of->answer[axis];
    const bool by_differences = a->line == &of->differences[axis];
    const struct br_study *from = by_differences ? compared : s;
    const char *what = (by_differences ? differences : of_grid)[axis];
    if (a->joint)
        snprintf(o->by, sizeof o->by, "the joint fit of %zu cells, misfit %.2g %%",
                 of->joint.points, 100 * of->joint.misfit);
    else if (axis == BR_AXIS_SPACE)
        snprintf(o->by, sizeof o->by, "%s%s k = %g s", what, by_differences ? " at" : ",",
                 br_time_step(s->scene, from->steps[from->k_count - 1]));
    else
        snprintf(o->by, sizeof o->by, "%s%s n = %zu", what, by_differences ? " at" : ",",
                 from->n[from->n_count - 1]);
}

/* Keeps the finest errors of the answer's line. Those of a joint fit lie on its model, which the
 * errors of the other axis bend. */
static void keep_points(struct br_observed_order *o, const struct br_quantity_orders *of,
                        enum br_axis axis)
{
    const struct br_orders_line *line = of->answer[axis].line;
    const size_t points = line ? line->observed.points : 0;
    const size_t first = points > BR_MOST_OBSERVED ? points - BR_MOST_OBSERVED : 0;
    for (size_t i = first; i < points; i++)
        o->point[o->points++] = line->observed.point[i];
    for (size_t i = 0; i < o->points; i++) {
        const double middle = sqrt(o->point[0].z * o->point[o->points - 1].z);
        struct br_point *p = &o->point[i];
        if (o->joint)
            p->fit = br_joint_band(&of->joint, axis, middle, p->x, p->ref);
        else if (isnan(o->order.value)) {
            p->flag = p->lost ? BR_FLAG_NONE : p->flag;
            p->fit = o->order;
        }
    }
}

static void take_answer(struct br_observed_order *o, const struct br_report *r,
                        const struct br_orders *orders, enum br_axis axis)
{
    const struct br_quantity_orders *of = orders->of;
    const struct br_orders_answer *a = &of->answer[axis];
    const struct br_study *compared = r->compared[axis];
    const struct sought l = sought_in(a->line);
    bool larger = false;
    o->order = a->order;
    o->joint = a->joint && !a->open;
    name_source(o, r->fitted, compared, of, axis);
    keep_points(o, of, axis);
    if (!a->open)
        compare(o, &l);
    else if (axis == BR_AXIS_SPACE && !compared)
        REMARK(o, "not measurable: %s", r->no_meshes ? r->no_meshes : "no meshes are compared");
    else if (!a->joint && a->line && l.count < BR_ORDERS_LEAST)
        say_too_few(o, &l, compared ? "difference" : "error");
    else if (a->joint || a->open != br_orders_uneven)
        REMARK(o, "not measurable: %s", a->open);
    else
        larger = say_uneven(o, &l, axis, compared && !r->printed);
    if (compared && !agrees(o) && !r->printed && (a->open || isfinite(o->theory.order)) && !larger)
        advise(o, r->fitted, axis, l.flag);
}

static void fill_differences(const struct br_study *s, enum br_part part, enum br_axis axis,
                             struct br_case *differences)
{
    for (size_t i = 0; i < differences->points; i++) {
        const struct br_cell *c = &s->cell[br_axis_cell(s, (int)axis, i, 0)];
        struct br_point *p = &differences->point[i];
        *p = (struct br_point){.z = br_axis_size(s->scene, (int)axis, c->at),
                               .z_against = br_axis_size(s->scene, (int)axis, c->against),
                               .error = c->error[part],
                               .flag = c->flag[part]};
        if (!p->flag && !(p->error > 0))
            p->flag = BR_FLAG_FAILED;
    }
}

static enum br_status ask(struct br_report *r, enum br_part part, enum br_axis axis,
                          struct br_observed_order *o, struct br_error *err)
{
    const struct br_orders *orders = &r->fits[part].orders;
    const struct br_study *compared = r->compared[axis];
    const size_t points = compared ? br_axis_count(compared, (int)axis) : 0;
    if (br_orders_begin_differences(orders, orders->of, axis, points, err))
        return err->status;
    fill_differences(compared, part, axis, &orders->of->differences[axis].observed);
    if (br_orders_renew(orders, orders->of, axis, err))
        return err->status;
    take_answer(o, r, orders, axis);
    return BR_OK;
}

bool br_observed_settles(const struct br_observed_order *o)
{
    return br_order_determined(&o->order) &&
           o->order.high - o->order.low <= 2 * near * o->order.value && agrees(o);
}

bool br_report_settles(const struct br_report *r, enum br_axis axis)
{
    bool all = true;
    for (enum br_part part = 0; part < BR_PARTS; part++)
        all = all &&
              (!r->observed[part][axis].asked || br_observed_settles(&r->observed[part][axis]));
    return all;
}

enum br_status br_report_observe_orders(struct br_report *r, enum br_axis axis,
                                        struct br_error *err)
{
    const struct br_study *s = r->fitted;
    enum br_status status = BR_OK;
    for (enum br_part part = 0; part < BR_PARTS && !status; part++) {
        struct br_observed_order *o = &r->observed[part][axis];
        *o = (struct br_observed_order){
            .asked = br_models(s->scene, part) && br_study_cells(s) > 0 &&
                     (axis == BR_AXIS_SPACE || !s->method.scheme->adaptive),
            .order = {NAN, NAN, NAN},
            .theory = br_theory_of(s, part, axis),
        };
        if (o->asked && part != BR_PART_TOTAL &&
            s->scene->axial.modelled != s->scene->bending.modelled)
            *o = r->observed[BR_PART_TOTAL][axis]; /* it is the total */
        else if (o->asked)
            status = ask(r, part, axis, o, err);
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
        status = br_report_observe_orders(r, axis, err);
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
    for (enum br_part part = 0; part < BR_PARTS; part++)
        br_fits_clear(&r->fits[part]);
}

double br_report_ratio(const struct br_report *r, size_t cell)
{
    return r->printed ? r->study->cell[cell].error[BR_PART_TOTAL] / r->printed[cell] : NAN;
}
