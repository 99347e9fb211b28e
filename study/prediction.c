/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/prediction.h"

#include <math.h>
#include <stdio.h>

#include "solver/clock.h"
#include "study/prediction_probes.h"

/* What an error that was measured, or extrapolated, is unsure by: a factor. */
static const double doubt = 3;

/* Beyond this factor between its bounds nothing is claimed. */
static const double widest = 300;

/* Exponents of the tolerance: least, expected, most. */
static const double by_tolerance[] = {0.6, 0.9, 1.2};

/* Orders below are no convergence. */
static const double least_order = 0.5;

/* Why a probe tells nothing; false: it does. */
static bool failed(const struct br_probe *p, char why[200])
{
    const struct br_study *s = &p->study;
    const struct br_error *failure = &s->failure;
    for (size_t i = 0; p->held && !failure->status && i < br_study_cells(s); i++) {
        if (s->cell[i].unstable) {
            snprintf(why, 200, "the lagged contact is beyond its stability limit%s",
                     p->measured ? "" : " at the steps of a cheap march");
            return true;
        }
        failure = &s->cell[i].failure;
    }
    if (!p->held || !failure->status)
        return false;
    snprintf(why, 200, "a coarse march failed: %.150s", failure->message);
    return true;
}

static double solution_size(const struct br_probe_set *s)
{
    double size = 0;
    for (int i = 0; i < BR_PROBES; i++)
        if (s->probe[i].held)
            size = fmax(size, s->probe[i].study.reference_scale);
    return size;
}

static double cell_error(const struct br_probe *p, size_t cell, enum br_part part)
{
    return p->study.cell[cell].error[part];
}

/* What e, which is beyond its cell, may be elsewhere: by the least order, the expected one and the
 * most. */
static struct br_predicted by_orders(double e, double beyond, const double order[3])
{
    return (struct br_predicted){
        .error = e * pow(beyond, -order[1]),
        .low = e * pow(beyond, -order[2]) / doubt,
        .high = e * pow(beyond, -order[0]) * doubt,
        .order = NAN,
    };
}

/* With errors C h^q of cells h and h/2 against h/4 their ratio is 2^q + 1. */
static double observed_order(double coarse, double fine)
{
    return log2(coarse / fine - 1);
}

/* Orders between which the run's lies, when so much was observed and theory says q; and, if it
 * is spoilt, at least `spoilt`. */
static void bracket(double observed, double q, double spoilt, double order[3])
{
    const bool trusted = observed >= least_order;
    order[1] = trusted ? fmin(observed, q) : fmin(q, 1);
    order[0] = trusted ? fmin(order[1], spoilt) : 0;
    order[2] = fmax(q, order[1]);
}

/* ---- time ---- */

static bool can_switch(const struct br_scene *scene)
{
    return (scene->contact.modelled && scene->contact.stiffness > 0) ||
           scene->friction.law != BR_FRICTIONLESS;
}

static double order_in_time(const struct br_outlook *o)
{
    return o->method->contact->at_new_step ? o->method->scheme->order : 1;
}

/* Against a run that has itself at least the share of what the cell between them lacks. */
static struct br_predicted measured_time(const struct br_probe *p)
{
    static const double same[3] = {0, 0, 0};
    double e = cell_error(p, 0, BR_PART_TOTAL) / (1 - 1 / p->ratio);
    if (p->study.k_count > 1)
        e += cell_error(p, 1, BR_PART_TOTAL) / 2;
    return by_orders(e, 1, same);
}

static struct br_predicted extrapolated_time(const struct br_probe *p, const struct br_outlook *o)
{
    const double q = order_in_time(o), fine = cell_error(p, 1, BR_PART_TOTAL);
    const double observed = observed_order(cell_error(p, 0, BR_PART_TOTAL), fine);
    double order[3];
    bracket(observed, q, can_switch(o->scene) ? fmin(1, q) : q, order);
    const double e = fine / (1 - exp2(-fmax(order[1], least_order)));
    struct br_predicted predicted = by_orders(e, p->beyond, order);
    predicted.order = observed;
    return predicted;
}

static struct br_predicted time_error(const struct br_probe_set *s)
{
    const struct br_probe *p = &s->probe[BR_PROBE_TIME], *start = &s->probe[BR_PROBE_START];
    struct br_predicted e;
    if (s->outlook->method->scheme->adaptive)
        e = by_orders(cell_error(p, 0, BR_PART_TOTAL), p->beyond, by_tolerance);
    else
        e = p->measured ? measured_time(p) : extrapolated_time(p, s->outlook);
    if (start->held) {
        const double first = cell_error(start, 0, BR_PART_TOTAL) / (1 - 1 / start->ratio);
        e.error = fmax(e.error, first);
        e.low = fmax(e.low, first / doubt);
        e.high = fmax(e.high, first * doubt);
    }
    return e;
}

/* ---- space ---- */

static struct br_predicted space_error(const struct br_probe_set *s)
{
    const struct br_probe *p = &s->probe[BR_PROBE_SPACE];
    struct br_predicted sum = {.order = NAN};
    for (int part = BR_PART_AXIAL; part <= BR_PART_BENDING; part++) {
        const double q = part == BR_PART_AXIAL ? s->outlook->method->axial_degree + 1 : 4;
        const double fine = cell_error(p, p->study.n_count - 1, (enum br_part)part);
        if (fine == 0) /* not modelled, or at rest */
            continue;
        const double observed =
            p->measured ? q : observed_order(cell_error(p, 0, (enum br_part)part), fine);
        double order[3];
        bracket(observed, q, q, order);
        const struct br_predicted e =
            by_orders(fine / (1 - pow(p->ratio, -fmax(order[1], least_order))), p->beyond, order);
        sum.error += e.error;
        sum.low += e.low;
        sum.high += e.high;
    }
    return sum;
}

/* ---- both ---- */

static struct br_predicted relative(struct br_predicted e, double size)
{
    return (struct br_predicted){e.error / size, e.low / size, e.high / size, e.order};
}

static void judge(struct br_prediction *p, const struct br_probe_set *s)
{
    const double size = solution_size(s);
    for (int i = 0; i < BR_PROBES; i++)
        if (failed(&s->probe[i], p->why))
            return;
    if (!(size > 0)) {
        snprintf(p->why, sizeof p->why, "no error is relative to a solution that is zero");
        return;
    }
    p->time = relative(time_error(s), size);
    p->space = relative(space_error(s), size);
    p->whole = (struct br_predicted){
        .error = p->time.error + p->space.error,
        .low = fmax(p->time.low, p->space.low), /* they may point against each other */
        .high = p->time.high + p->space.high,
        .order = NAN,
    };
    p->bounded = isfinite(p->whole.high);
    p->known = p->bounded && p->whole.high <= widest * p->whole.low;
    if (!p->known)
        snprintf(p->why, sizeof p->why, "cheap marches do not tell the order of convergence");
}

double br_predict_round_off(const struct br_outlook *o)
{
    double largest = 0;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        struct br_field field = br_field_of_scene(o->scene, (enum br_field_kind)kind, o->n,
                                                  br_time_step(o->scene, o->steps));
        if (kind == BR_AXIAL)
            field.degree = o->method->axial_degree;
        if (kind == BR_AXIAL ? o->scene->axial.modelled : o->scene->bending.modelled)
            largest = fmax(largest, o->method->solver->round_off(&field, &o->method->linear));
    }
    return largest;
}

enum br_status br_predict(const struct br_outlook *outlook, struct br_prediction *p,
                          struct br_error *err)
{
    const double begun = br_seconds();
    struct br_probe_set set;
    struct br_error failure = {0};
    *p = (struct br_prediction){.round_off = br_predict_round_off(outlook)};
    const enum br_status status = br_probes_hold(&set, outlook, &failure);
    if (!status)
        judge(p, &set);
    else
        snprintf(p->why, sizeof p->why, "coarse marches take too long");
    br_probes_clear(&set);
    p->seconds = br_seconds() - begun;
    return status == BR_NO_MEMORY ? br_fail(err, status, "%s", failure.message) : BR_OK;
}
