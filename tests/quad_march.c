/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "quad_march.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#if defined __SIZEOF_FLOAT128__ && !defined __clang_analyzer__
typedef __float128 real;
#define BR_HAS_QUAD 1
#else
typedef long double real;
#define BR_HAS_QUAD 0
#endif

enum { STATES = BR_KNOWN + 1, Z = BR_KNOWN }; /* Y by what it is, and where a stage starts */

struct quad_field {
    bool modelled;
    size_t u, order, band; /* unknowns a node; of the matrix, without the clamped node */
    real *factor;          /* L and D of A = L D L', lower band by rows */
    real *response;        /* z */
    real *rhs, *free;      /* workspace */
    real *state[STATES];   /* displacement, and behind it velocity; clamped node left out */
    real tau, rate_tau;
    size_t since;
    real largest[2];
};

struct br_quad_march {
    struct br_march *march;
    const struct br_scene *scene;
    struct br_method method;
    size_t n, steps;
    struct quad_field field[2];
    int stage_count;
    real stage_time[BR_MOST_STAGES], penetration[BR_MOST_STAGES]; /* of the axial field's step */
    real path[4];                                                 /* u, k u_t at both ends */
    double *nodal;                                                /* workspace, twice */
};

static real absolute(real x)
{
    return x < 0 ? -x : x;
}

/* ---- the matrix ---- */

static const int axial_mass[2][2] = {{2, 1}, {1, 2}};
static const int axial_stiffness[2][2] = {{1, -1}, {-1, 1}};
static const int bending_mass[4][4] = {
    {156, 22, 54, -13}, {22, 4, 13, -3}, {54, 13, 156, -22}, {-13, -3, -22, 4}};
static const int bending_stiffness[4][4] = {
    {12, 6, -12, 6}, {6, 4, -6, 2}, {-12, -6, 12, -6}, {6, 2, -6, 4}};

static real length_of(const struct br_quad_march *q)
{
    return (real)q->scene->length / (real)q->n;
}

/* An element's rho h mass, or K over the stiffness; for (w, h w_x). */
static real mass_entry(const struct br_quad_march *q, int kind, size_t a, size_t b)
{
    const real factor = (real)q->scene->density * length_of(q);
    return kind == BR_AXIAL ? factor * axial_mass[a][b] / 6 : factor * bending_mass[a][b] / 420;
}

static real stiffness_entry(const struct br_quad_march *q, int kind, size_t a, size_t b)
{
    const real h = length_of(q);
    return kind == BR_AXIAL ? axial_stiffness[a][b] / h : bending_stiffness[a][b] / (h * h * h);
}

static real stiffness_of(const struct br_quad_march *q, int kind)
{
    return kind == BR_AXIAL ? q->scene->axial.stiffness : q->scene->bending.stiffness;
}

static real viscosity_of(const struct br_quad_march *q, int kind)
{
    return kind == BR_AXIAL ? q->scene->axial.viscosity : q->scene->bending.viscosity;
}

static real *at(struct quad_field *f, size_t i, size_t j)
{
    return &f->factor[i * (f->band + 1) + i - j];
}

static void solve(struct quad_field *f, real *x)
{
    for (size_t i = 0; i < f->order; i++)
        for (size_t j = i > f->band ? i - f->band : 0; j < i; j++)
            x[i] -= *at(f, i, j) * x[j];
    for (size_t i = 0; i < f->order; i++)
        x[i] /= *at(f, i, i);
    for (size_t i = f->order; i-- > 0;)
        for (size_t j = i + 1; j <= i + f->band && j < f->order; j++)
            x[i] -= *at(f, j, i) * x[j];
}

static void factorise(struct br_quad_march *q, int kind, real tau)
{
    struct quad_field *f = &q->field[kind];
    const real stiff = viscosity_of(q, kind) + tau * stiffness_of(q, kind);
    if (tau == f->tau)
        return;
    f->tau = tau;
    memset(f->factor, 0, f->order * (f->band + 1) * sizeof *f->factor);
    for (size_t e = 0; e < q->n; e++)
        for (size_t a = 0; a < 2 * f->u; a++)
            for (size_t b = 0; b <= a; b++)
                if (e * f->u + b >= f->u)
                    *at(f, (e - 1) * f->u + a, (e - 1) * f->u + b) +=
                        mass_entry(q, kind, a, b) / tau + stiff * stiffness_entry(q, kind, a, b);
    for (size_t i = 0; i < f->order; i++) {
        const size_t low = i > f->band ? i - f->band : 0;
        for (size_t j = low; j < i; j++) {
            for (size_t l = low; l < j; l++)
                if (l + f->band >= j)
                    *at(f, i, j) -= *at(f, i, l) * *at(f, j, l) * *at(f, l, l);
            *at(f, i, j) /= *at(f, j, j);
        }
        for (size_t j = low; j < i; j++)
            *at(f, i, i) -= *at(f, i, j) * *at(f, i, j) * *at(f, j, j);
    }
    memset(f->response, 0, f->order * sizeof *f->response);
    f->response[f->order - f->u] = 1;
    solve(f, f->response);
}

/* ---- a stage ---- */

static real constant_load(const struct br_load *load, double t)
{
    double factor;
    const double x = 0;
    br_function_evaluate(&load->term[0].time, 1, &x, t, &factor);
    return (real)load->term[0].space.constant * factor;
}

/* f + M v / tau - K w, in f->rhs. */
static void form_rhs(struct br_quad_march *q, int kind, double t)
{
    static const real rod[2] = {0.5Q, 0.5Q};
    static const real beam[4] = {0.5Q, 1 / 12.0Q, 0.5Q, -1 / 12.0Q};
    struct quad_field *f = &q->field[kind];
    const struct br_scene *s = q->scene;
    const real load = constant_load(kind == BR_AXIAL ? &s->axial.load : &s->bending.load, t);
    const real *w = f->state[Z], *v = w + f->order, stiff = stiffness_of(q, kind);
    double tip;
    const double x = 0;
    br_function_evaluate(kind == BR_AXIAL ? &s->axial.tip_force : &s->bending.tip_force, 1, &x, t,
                         &tip);
    memset(f->rhs, 0, f->order * sizeof *f->rhs);
    for (size_t e = 0; e < q->n; e++)
        for (size_t a = e > 0 ? 0 : f->u; a < 2 * f->u; a++) {
            real *sum = &f->rhs[(e - 1) * f->u + a];
            *sum += load * length_of(q) * (kind == BR_AXIAL ? rod[a] : beam[a]);
            for (size_t b = e > 0 ? 0 : f->u; b < 2 * f->u; b++) {
                const size_t j = (e - 1) * f->u + b;
                *sum += mass_entry(q, kind, a, b) / f->tau * v[j] -
                        stiff * stiffness_entry(q, kind, a, b) * w[j];
            }
        }
    f->rhs[f->order - f->u] += tip;
}

static real positive(real x)
{
    return x > 0 ? x : 0;
}

static real contact_force(const struct br_quad_march *q, real u, real v, real z, real tau)
{
    const struct br_contact *c = &q->scene->contact;
    if (!c->modelled)
        return 0;
    if (!q->method.contact->at_new_step)
        return c->stiffness * positive(u - c->gap);
    return c->stiffness * positive(u + tau * v - c->gap) / (1 + c->stiffness * tau * z);
}

static real penetration_at(const struct br_quad_march *q, real part)
{
    for (int i = 0; i < q->stage_count; i++)
        if (q->stage_time[i] == part)
            return q->penetration[i];
    const real s = part, r = 1 - part;
    return positive((1 + 2 * s) * r * r * q->path[0] + s * r * r * q->path[1] +
                    s * s * (3 - 2 * s) * q->path[2] - s * s * r * q->path[3] -
                    q->scene->contact.gap);
}

static real friction_force(const struct br_quad_march *q, real part, real v, real z)
{
    const struct br_friction *law = &q->scene->friction;
    if (law->law == BR_FRICTIONLESS)
        return 0;
    const real mu = q->method.friction->needs_regularisation ? law->regularisation : 0;
    const real bound = law->coefficient * (law->law == BR_TRESCA ? 1 : penetration_at(q, part));
    if (absolute(v) >= mu + bound * z)
        return v > 0 ? bound : v < 0 ? -bound : 0;
    return mu > 0 ? bound * v / (mu + bound * z) : v / z;
}

static void add(struct quad_field *f, int into, real weight, int of)
{
    for (size_t i = 0; i < 2 * f->order && weight != 0; i++)
        f->state[into][i] += weight * f->state[of][i];
}

static void copy(struct quad_field *f, int into, int of)
{
    memcpy(f->state[into], f->state[of], 2 * f->order * sizeof **f->state);
}

/* Z of a stage; BR_RATE is tau Y' of the step's end, with that step's tau. */
static void start(struct quad_field *f, const struct br_stage *stage)
{
    memset(f->state[Z], 0, 2 * f->order * sizeof **f->state);
    for (int i = 0; i < BR_KNOWN; i++)
        add(f, Z,
            i == BR_RATE ? stage->weight[i] * f->tau / (f->rate_tau != 0 ? f->rate_tau : 1)
                         : stage->weight[i],
            i);
}

static void see(real value, real *most)
{
    if (absolute(value) > *most)
        *most = absolute(value);
}

/* What is subtracted is seen, too: round-off is relative to it. */
static void finish(struct quad_field *f, real force, real *to)
{
    for (size_t i = 0; i < f->order; i++) {
        to[f->order + i] = f->free[i] - force * f->response[i];
        to[i] = f->state[Z][i] + f->tau * to[f->order + i];
        see(f->free[i], &f->largest[1]);
        see(f->state[Z][f->order + i], &f->largest[1]);
        see(to[f->order + i], &f->largest[1]);
        see(f->state[Z][i], &f->largest[0]);
        see(f->tau * f->free[i], &f->largest[0]);
        see(to[i], &f->largest[0]);
    }
}

static void follow_stage(void *self, const struct br_march_stage *told)
{
    struct br_quad_march *q = self;
    struct quad_field *f = &q->field[told->kind];
    struct br_stages stages;
    q->method.scheme->stages(f->since, &stages);
    const struct br_stage *stage = &stages.stage[told->index];
    const size_t tip = f->order - f->u;
    factorise(q, (int)told->kind, told->tau);
    start(f, stage);
    form_rhs(q, (int)told->kind, told->time);
    memcpy(f->free, f->rhs, f->order * sizeof *f->rhs);
    solve(f, f->free);
    real *to = f->state[BR_STAGE + told->index], force;
    if (told->kind == BR_AXIAL)
        force = contact_force(q, f->state[Z][tip], f->free[tip], f->response[tip], f->tau);
    else
        force = friction_force(q, stage->time, f->free[tip], f->response[tip]);
    finish(f, force, to);
    if (told->kind == BR_BENDING)
        return;
    if (told->index == 0) {
        q->path[0] = f->state[BR_NOW][tip];
        q->path[1] = told->k * f->state[BR_NOW][f->order + tip];
    }
    q->stage_count = told->count;
    q->stage_time[told->index] = stage->time;
    q->penetration[told->index] = positive(to[tip] - q->scene->contact.gap);
    q->path[2] = to[tip];
    q->path[3] = told->k * to[f->order + tip];
}

static void follow_step(void *self, enum br_field_kind kind, bool switched)
{
    struct br_quad_march *q = self;
    struct quad_field *f = &q->field[kind];
    struct br_stages stages;
    q->method.scheme->stages(f->since, &stages);
    const int last = BR_STAGE + stages.count - 1;
    copy(f, BR_RATE, last); /* Y - Z */
    add(f, BR_RATE, -1, Z);
    f->rate_tau = f->tau;
    copy(f, BR_BEFORE_THAT, BR_BEFORE);
    copy(f, BR_BEFORE, BR_NOW);
    copy(f, BR_NOW, last);
    f->since = switched ? 0 : f->since + 1;
}

/* ---- from outside ---- */

static void clear_field(struct quad_field *f)
{
    free(f->factor);
}

static bool init_field(struct quad_field *f, size_t u, size_t n)
{
    f->u = u;
    f->order = u * n;
    f->band = 2 * u - 1;
    const size_t count = f->order * (f->band + 1 + 3 + 2 * STATES);
    real *p = f->factor = calloc(count, sizeof *p);
    if (!p)
        return false;
    f->response = p += f->order * (f->band + 1);
    f->rhs = p += f->order;
    f->free = p += f->order;
    for (int i = 0; i < STATES; i++)
        f->state[i] = p += i == 0 ? f->order : 2 * f->order;
    return true;
}

struct br_quad_march *br_quad_follow(struct br_march *march, const struct br_scene *scene,
                                     const struct br_method *method, size_t steps)
{
    struct br_quad_march *q = BR_HAS_QUAD ? calloc(1, sizeof *q) : NULL;
    if (!q)
        return NULL;
    q->march = march;
    q->scene = scene;
    q->method = *method;
    q->steps = steps;
    q->n = br_march_field(march, BR_AXIAL)->n;
    q->nodal = calloc(4 * (q->n + 1), sizeof *q->nodal);
    bool made = q->nodal;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        made = made && init_field(&q->field[kind], kind == BR_AXIAL ? 1 : 2, q->n);
        q->field[kind].modelled = br_march_models(march, (enum br_field_kind)kind);
    }
    if (!made) {
        br_quad_free(q);
        return NULL;
    }
    br_march_watch(march, &(struct br_march_watcher){q, follow_stage, follow_step});
    return q;
}

void br_quad_free(struct br_quad_march *q)
{
    if (!q)
        return;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        clear_field(&q->field[kind]);
    free(q->nodal);
    free(q);
}

double br_quad_deviation(struct br_quad_march *q, enum br_field_kind kind, int derivative)
{
    struct quad_field *f = &q->field[kind];
    const real *exact = f->state[BR_NOW] + (derivative ? f->order : 0);
    real most = 0;
    br_march_get(q->march, kind, derivative ? NULL : q->nodal, derivative ? q->nodal : NULL);
    for (size_t i = 0; i < f->order; i++) {
        const real error = absolute((real)q->nodal[f->u + i] - exact[i]);
        if (!(error <= most))
            most = error;
    }
    if (most == 0)
        return 0;
    const double deviation = (double)(most / f->largest[derivative]);
    return isnan(deviation) ? INFINITY : deviation;
}

double br_quad_largest(const struct br_quad_march *q, enum br_field_kind kind, int derivative)
{
    return (double)q->field[kind].largest[derivative];
}
