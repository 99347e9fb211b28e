/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exact discrete solution: laws at the tip, stages and steps. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "reference/discrete_field.h"
#include "reference/textbook.h"

enum { ROWS = BR_TEXTBOOK_ROWS };

/* The rod's tip over one step, for the friction bound. */
struct path {
    int count;
    real time[ROWS], depth[ROWS]; /* of the stages: over k, and (u - g)_+, m */
    real u[2], slope[2];          /* u and k u_t at both ends, m */
};

/* One field and the state of its scheme. */
struct marched {
    bool modelled;
    struct br_discrete_field field;
    size_t since; /* steps since t = 0 or the last switch */
    enum br_regime regime;
};

struct br_discrete {
    const struct br_scene *scene;
    const char *scheme;
    bool implicit, regularised;
    size_t n, steps, done;
    int degree;                /* of the axial elements */
    struct marched marched[2]; /* by br_field_kind */
    struct path path;
    struct {
        real displacement[2], velocity[2];   /* m, m/s, by br_field_kind */
        real contact_force;                  /* N */
        real friction_force, friction_bound; /* N */
    } tip;                                   /* after a step */
};

bool br_discrete_judges(void)
{
    volatile long double one = 1, tiny = DBL_EPSILON / 1024; /* valgrind's has 53 bits */
    return one + tiny > one;
}

/* ---- laws ---- */

static real positive(real x)
{
    return x < 0 ? 0 : x;
}

static real between(real x, real bound)
{
    return x > bound ? bound : x < -bound ? -bound : x;
}

/* (u - g)_+ at `time` of the step: that of a stage at this time, else of the cubic through the
 * step's ends. */
static real depth_at(const struct br_discrete *d, real time)
{
    const struct path *p = &d->path;
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
    const struct br_discrete_field *f = &d->marched[BR_AXIAL].field;
    if (!c->modelled)
        return 0;
    if (!d->implicit)
        return c->stiffness * positive(u - c->gap);
    return c->stiffness * positive(u + f->recursion.k * free_velocity - c->gap) /
           (1 + c->stiffness * f->recursion.k * f->recursion.compliance);
}

/* Equation (12), or (29). */
static real friction_force(const struct br_discrete *d, real free_velocity)
{
    const real z = d->marched[BR_BENDING].field.recursion.compliance, bound = d->tip.friction_bound;
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

/* ---- a stage: an Euler step of tau from state 0 ---- */

static enum br_status stage(struct br_discrete *d, enum br_field_kind kind, real time, real tau,
                            struct br_error *err)
{
    struct br_discrete_field *f = &d->marched[kind].field;
    const double from = d->scene->duration * (double)d->done / (double)d->steps;
    const double to = d->scene->duration * (double)(d->done + 1) / (double)d->steps;
    const double t = time == 1 ? to : (double)(from + time * ((real)to - from));
    enum br_status status = BR_OK;
    real v = 0;
    if (tau != f->recursion.k) {
        f->recursion.k = tau;
        status = br_recursion_fill(&f->recursion, "the exact discrete solution", err);
    }
    if (!status)
        status = br_discrete_field_predict(f, t, &v, err);
    if (status)
        return status;
    if (kind == BR_AXIAL)
        d->tip.contact_force = contact_force(d, br_recursion_tip(&f->recursion, f->state[0]), v);
    else {
        d->tip.friction_bound = friction_bound(d, time);
        d->tip.friction_force = friction_force(d, v);
    }
    const real force = kind == BR_AXIAL ? d->tip.contact_force : d->tip.friction_force;
    d->tip.velocity[kind] = br_recursion_finish(&f->recursion, f->state[0], force);
    if (kind == BR_AXIAL) {
        d->tip.displacement[kind] = br_recursion_tip(&f->recursion, f->state[0]);
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
    for (size_t i = 0; i < br_recursion_size(&f->recursion); i++) {
        real sum = 0;
        for (int j = 0; j < count; j++)
            sum += weight[j] * f->state[state[j]][i];
        f->state[into][i] = sum;
    }
}

static void copy_state(struct br_discrete_field *f, int from, int into)
{
    memcpy(f->state[into], f->state[from], br_recursion_size(&f->recursion) * sizeof(real));
}

/* Y' of the stage that has ended in state 0. The rate of the displacement is the velocity. The rate
 * of the velocity is its change from Z, which is in state `into`, over tau. */
static void find_rate(struct br_discrete_field *f, int into)
{
    const size_t m = (size_t)f->recursion.m, size = br_recursion_size(&f->recursion);
    real *rate = f->state[into], *y = f->state[BR_DISCRETE_NOW];
    for (size_t e = 0; e < size; e += 2 * m)
        for (size_t i = e; i < e + m; i++) {
            rate[i] = y[i + m];
            rate[i + m] = (y[i + m] - rate[i + m]) / f->recursion.k;
        }
}

/* Y_i = Y_{n-1} + k sum_j a_ij Y'_j, row by row. */
static enum br_status runge_kutta(struct br_discrete *d, enum br_field_kind kind,
                                  const struct br_textbook *book, real k, struct br_error *err)
{
    struct br_discrete_field *f = &d->marched[kind].field;
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
static enum br_status difference_step(struct br_discrete *d, enum br_field_kind kind,
                                      const struct br_textbook *book, real k, struct br_error *err)
{
    static const int state[3] = {BR_DISCRETE_START, BR_DISCRETE_PAST, BR_DISCRETE_PAST + 1};
    struct br_discrete_field *f = &d->marched[kind].field;
    copy_state(f, BR_DISCRETE_NOW, BR_DISCRETE_START);
    sum_states(f, BR_DISCRETE_NOW, book->back, state, book->past);
    return stage(d, kind, 1, k * book->beta, err);
}

static enum br_status step_field(struct br_discrete *d, enum br_field_kind kind,
                                 struct br_error *err)
{
    struct marched *marched = &d->marched[kind];
    struct br_discrete_field *f = &marched->field;
    const real k = (real)d->scene->duration / (real)d->steps;
    const struct br_textbook *book = br_textbook_step(d->scheme, marched->since);
    struct path *path = &d->path;
    if (kind == BR_AXIAL) {
        path->count = 0;
        path->u[0] = d->tip.displacement[kind];
        path->slope[0] = k * d->tip.velocity[kind];
    }
    const enum br_status status =
        (book->back ? difference_step : runge_kutta)(d, kind, book, k, err);
    if (status)
        return status;
    if (kind == BR_AXIAL) {
        path->u[1] = d->tip.displacement[kind];
        path->slope[1] = k * d->tip.velocity[kind];
    }
    if (f->states > 1) { /* the oldest is dropped */
        copy_state(f, BR_DISCRETE_PAST, BR_DISCRETE_PAST + 1);
        copy_state(f, BR_DISCRETE_START, BR_DISCRETE_PAST);
    }
    const enum br_regime before = marched->regime;
    marched->regime = br_textbook_regime(
        d->scene, kind, kind == BR_AXIAL ? d->tip.contact_force : d->tip.friction_force,
        d->tip.friction_bound);
    marched->since = d->done > 0 && marched->regime != before ? 0 : marched->since + 1;
    if (!isfinite(d->tip.velocity[kind]))
        return br_fail(err, BR_NOT_FINITE, "the exact discrete solution is %Lg m/s at step %zu",
                       d->tip.velocity[kind], d->done + 1);
    return BR_OK;
}

enum br_status br_discrete_step(struct br_discrete *d, struct br_error *err)
{
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const enum br_status status = d->marched[kind].modelled ? step_field(d, kind, err) : BR_OK;
        if (status)
            return status;
    }
    d->done++;
    return BR_OK;
}

/* ---- creation ---- */

static enum br_status check_method(const struct br_method *m, struct br_error *err)
{
    if (!br_textbook_step(m->scheme->name, 0) || m->scheme->adaptive)
        return br_fail(err, BR_BAD_INPUT,
                       "the exact discrete solution does not know the scheme '%s'",
                       m->scheme->name);
    if (strcmp(m->contact->name, "lagged") != 0 && strcmp(m->contact->name, "implicit") != 0)
        return br_fail(err, BR_BAD_INPUT, "the exact discrete solution does not know contact '%s'",
                       m->contact->name);
    if (strcmp(m->friction->name, "exact") != 0 && strcmp(m->friction->name, "regularised") != 0)
        return br_fail(err, BR_BAD_INPUT, "the exact discrete solution does not know friction '%s'",
                       m->friction->name);
    return BR_OK;
}

/* The tip as the field has it. */
static void sample_tip(struct br_discrete *d, enum br_field_kind kind)
{
    const struct br_discrete_field *f = &d->marched[kind].field;
    d->tip.displacement[kind] = br_recursion_tip(&f->recursion, f->state[0]);
    d->tip.velocity[kind] = f->state[0][br_recursion_tip_rate(&f->recursion)];
}

static enum br_status create_field(struct br_discrete *d, enum br_field_kind kind,
                                   struct br_error *err)
{
    struct marched *marched = &d->marched[kind];
    marched->modelled = kind == BR_AXIAL ? d->scene->axial.modelled : d->scene->bending.modelled;
    if (!marched->modelled)
        return BR_OK;
    const size_t states = strcmp(d->scheme, "euler") == 0 ? 1 : BR_DISCRETE_STATES;
    const enum br_status status =
        br_discrete_field_init(&marched->field, d->scene, kind, d->n, d->degree, states, err);
    if (!status)
        sample_tip(d, kind);
    return status;
}

enum br_status br_discrete_create(struct br_discrete **out, const struct br_scene *scene, size_t n,
                                  size_t steps, const struct br_method *method,
                                  struct br_error *err)
{
    *out = NULL;
    enum br_status status = check_method(method, err);
    if (status)
        return status;
    if (n < 1 || steps < 1)
        return br_fail(err, BR_BAD_INPUT, "found %zu elements and %zu steps, expected some", n,
                       steps);
    struct br_discrete *d = br_allocate(1, sizeof *d);
    if (!d)
        return br_no_memory(err, "the exact discrete solution");
    d->scene = scene;
    d->scheme = method->scheme->name;
    d->implicit = strcmp(method->contact->name, "implicit") == 0;
    d->regularised = strcmp(method->friction->name, "regularised") == 0;
    d->degree = method->axial_degree;
    d->n = n;
    d->steps = steps;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++)
        status = create_field(d, kind, err);
    if (status)
        br_discrete_free(d);
    else
        *out = d;
    return status;
}

void br_discrete_free(struct br_discrete *d)
{
    if (!d)
        return;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        br_discrete_field_clear(&d->marched[kind].field);
    free(d);
}

/* ---- sampling ---- */

void br_discrete_get(const struct br_discrete *d, enum br_field_kind kind,
                     long double *displacement, long double *velocity)
{
    const struct marched *marched = &d->marched[kind];
    const size_t unknowns = kind == BR_AXIAL ? (size_t)d->degree : 2;
    const size_t bytes = unknowns * (d->n + 1) * sizeof(long double);
    if (marched->modelled) {
        br_recursion_get(&marched->field.recursion, marched->field.state[0], displacement,
                         velocity);
        return;
    }
    if (displacement)
        memset(displacement, 0, bytes);
    if (velocity)
        memset(velocity, 0, bytes);
}
