/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One step of one field of the exact discrete solution, with its law at the tip. */
#include <math.h>
#include <string.h>

#include "reference/discrete_state.h"

typedef long double real;

enum { ROWS = BR_TEXTBOOK_ROWS };

/* ---- laws ---- */

static real positive(real x)
{
    return x < 0 ? 0 : x;
}

static real between(real x, real bound)
{
    return x > bound ? bound : x < -bound ? -bound : x;
}

/* (u - g)_+ at `time` of the step: of the stage there, else by the cubic of the step's ends. */
static real depth_at(const struct br_discrete *d, real time)
{
    const struct br_discrete_path *p = &d->path;
    for (int i = 0; i < p->count; i++)
        if (p->time[i] == time)
            return p->depth[i];
    const real s = time, s2 = s * s, s3 = s2 * s;
    const real u = (1 - 3 * s2 + 2 * s3) * p->u[0] + (s - 2 * s2 + s3) * p->slope[0] +
                   (3 * s2 - 2 * s3) * p->u[1] + (s3 - s2) * p->slope[1];
    return positive(u - d->scene->contact.gap);
}

/* Equation (10), at u_{n-1} or at u_n. */
static real contact_force(const struct br_discrete *d, real u, real free_velocity)
{
    const struct br_contact *c = &d->scene->contact;
    const struct br_discrete_field *f = &d->part[BR_AXIAL].field;
    if (!c->modelled)
        return 0;
    if (!d->implicit)
        return c->stiffness * positive(u - c->gap);
    return c->stiffness * positive(u + f->tau * free_velocity - c->gap) /
           (1 + c->stiffness * f->tau * f->compliance);
}

/* Equation (12), or (29). */
static real friction_force(const struct br_discrete *d, real free_velocity)
{
    const real z = d->part[BR_BENDING].field.compliance, bound = d->tip.friction_bound;
    if (d->scene->friction.law == BR_FRICTIONLESS)
        return 0;
    if (d->regularised)
        return between(bound * free_velocity / (d->scene->friction.regularisation + bound * z),
                       bound);
    return between(free_velocity / z, bound);
}

static real friction_bound(const struct br_discrete *d, real time)
{
    const struct br_friction *f = &d->scene->friction;
    if (f->law == BR_FRICTIONLESS)
        return 0;
    return f->law == BR_TRESCA ? f->coefficient : f->coefficient * depth_at(d, time);
}

static enum br_discrete_regime regime_of(const struct br_discrete *d, enum br_field_kind kind)
{
    const struct br_discrete_tip *t = &d->tip;
    if (kind == BR_AXIAL)
        return !d->scene->contact.modelled ? BR_DISCRETE_NO_LAW
               : t->contact_force > 0      ? BR_DISCRETE_CLOSED
                                           : BR_DISCRETE_OPEN;
    if (!(t->friction_bound > 0))
        return BR_DISCRETE_NO_LAW;
    if (fabsl(t->friction_force) < t->friction_bound)
        return BR_DISCRETE_STICK;
    return t->friction_force > 0 ? BR_DISCRETE_FORWARD : BR_DISCRETE_BACKWARD;
}

/* ---- a stage: an Euler step of tau from state 0 ---- */

static enum br_status stage(struct br_discrete *d, enum br_field_kind kind, real time, real tau,
                            struct br_error *err)
{
    struct br_discrete_part *part = &d->part[kind];
    struct br_discrete_field *f = &part->field;
    const double from = d->scene->duration * (double)d->done / (double)d->steps;
    const double to = d->scene->duration * (double)(d->done + 1) / (double)d->steps;
    const double t = time == 1 ? to : (double)(from + time * ((real)to - from));
    enum br_status status = br_discrete_field_set_step(f, tau, err);
    if (!status)
        status = br_discrete_load_update(&part->load, f, t, err);
    if (status)
        return status;
    const real v = br_discrete_field_predict(f, part->load.tip);
    if (kind == BR_AXIAL)
        d->tip.contact_force = contact_force(d, br_discrete_field_tip(f, false), v);
    else {
        d->tip.friction_bound = friction_bound(d, time);
        d->tip.friction_force = friction_force(d, v);
    }
    const real force = kind == BR_AXIAL ? d->tip.contact_force : d->tip.friction_force;
    br_discrete_field_finish(f, force);
    d->tip.velocity[kind] = v - force * f->compliance;
    if (kind == BR_AXIAL) {
        d->tip.displacement[kind] = br_discrete_field_tip(f, false);
        d->path.time[d->path.count] = time;
        d->path.depth[d->path.count++] =
            positive(d->tip.displacement[kind] - d->scene->contact.gap);
    }
    return BR_OK;
}

/* ---- a step ---- */

/* State `into` = sum over count states of weight times state. */
static void sum_states(struct br_discrete_field *f, int into, int count, const int *state,
                       const real *weight)
{
    for (size_t i = 0; i < 2 * f->d * f->n; i++) {
        real sum = 0;
        for (int j = 0; j < count; j++)
            sum += weight[j] * f->state[state[j]][i];
        f->state[into][i] = sum;
    }
}

static void copy_state(struct br_discrete_field *f, int from, int into)
{
    memcpy(f->state[into], f->state[from], 2 * f->d * f->n * sizeof(real));
}

/* Y' of the stage that has ended in state 0: of displacement the velocity, of velocity what the
 * step has added to Z, which is in state `into`, over tau. */
static void find_rate(struct br_discrete_field *f, int into)
{
    const size_t count = f->d * f->n;
    real *rate = f->state[into], *y = f->state[BR_DISCRETE_NOW];
    for (size_t i = 0; i < count; i++) {
        rate[count + i] = (y[count + i] - rate[count + i]) / f->tau;
        rate[i] = y[count + i];
    }
}

/* Y_i = Y_{n-1} + k sum_j a_ij Y'_j, row by row. */
static enum br_status runge_kutta(struct br_discrete *d, enum br_field_kind kind,
                                  const struct br_textbook *book, real k, struct br_error *err)
{
    struct br_discrete_field *f = &d->part[kind].field;
    const bool keeps = f->states > 1;
    int state[ROWS + 1] = {BR_DISCRETE_START};
    real weight[ROWS + 1] = {1};
    if (keeps)
        copy_state(f, BR_DISCRETE_NOW, BR_DISCRETE_START);
    for (int i = 0; i < book->rows; i++) {
        const int rate = BR_DISCRETE_RATE + i;
        state[i + 1] = rate;
        if (book->a[i][i] == 0) {
            copy_state(f, BR_DISCRETE_LAST_RATE, rate);
            continue;
        }
        for (int j = 0; j < i; j++)
            weight[j + 1] = k * book->a[i][j];
        if (keeps) {
            sum_states(f, BR_DISCRETE_NOW, i + 1, state, weight);
            copy_state(f, BR_DISCRETE_NOW, rate);
        }
        const enum br_status status = stage(d, kind, book->c[i], k * book->a[i][i], err);
        if (status)
            return status;
        if (keeps)
            find_rate(f, rate);
    }
    if (keeps)
        copy_state(f, BR_DISCRETE_RATE + book->rows - 1, BR_DISCRETE_LAST_RATE);
    return BR_OK;
}

/* Y_n = sum_j past_j Y_{n-1-j} + beta k Y'_n */
static enum br_status look_back(struct br_discrete *d, enum br_field_kind kind,
                                const struct br_textbook *book, real k, struct br_error *err)
{
    static const int state[3] = {BR_DISCRETE_START, BR_DISCRETE_PAST, BR_DISCRETE_PAST + 1};
    struct br_discrete_field *f = &d->part[kind].field;
    copy_state(f, BR_DISCRETE_NOW, BR_DISCRETE_START);
    sum_states(f, BR_DISCRETE_NOW, book->back, state, book->past);
    return stage(d, kind, 1, k * book->beta, err);
}

enum br_status br_discrete_step_field(struct br_discrete *d, enum br_field_kind kind,
                                      struct br_error *err)
{
    struct br_discrete_part *part = &d->part[kind];
    struct br_discrete_field *f = &part->field;
    const real k = (real)d->scene->duration / (real)d->steps;
    const struct br_textbook *book = br_textbook_step(d->scheme, part->since);
    struct br_discrete_path *path = &d->path;
    if (kind == BR_AXIAL) {
        path->count = 0;
        path->u[0] = d->tip.displacement[kind];
        path->slope[0] = k * d->tip.velocity[kind];
    }
    const enum br_status status = (book->back ? look_back : runge_kutta)(d, kind, book, k, err);
    if (status)
        return status;
    if (kind == BR_AXIAL) {
        path->u[1] = d->tip.displacement[kind];
        path->slope[1] = k * d->tip.velocity[kind];
    }
    if (f->states > 1) { /* the oldest is forgotten */
        copy_state(f, BR_DISCRETE_PAST, BR_DISCRETE_PAST + 1);
        copy_state(f, BR_DISCRETE_START, BR_DISCRETE_PAST);
    }
    const enum br_discrete_regime before = part->regime;
    part->regime = regime_of(d, kind);
    part->since = d->done > 0 && part->regime != before ? 0 : part->since + 1;
    if (!isfinite(d->tip.velocity[kind]))
        return br_fail(err, BR_NOT_FINITE, "the exact discrete solution is %Lg m/s at step %zu",
                       d->tip.velocity[kind], d->done + 1);
    return BR_OK;
}
