/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/dense_march.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solver/field.h"
#include "solver/function.h"
#include "solver/method.h"
#include "solver/scene.h"

#if defined __SIZEOF_FLOAT128__ && !defined __clang_analyzer__
typedef __float128 real;
#define BR_HAS_QUAD 1
#else
typedef long double real;
#define BR_HAS_QUAD 0
#endif

enum { STATES = BR_KNOWN + 1, Z = BR_KNOWN }; /* Y by what it is, and where a stage starts */

struct dense_field {
    size_t u, order, band; /* unknowns a node; of the matrix, without the clamped node */
    const real (*mass)[4], (*stiffness)[4]; /* of an element: see below */
    real heavy, stiff, viscous;             /* what these are multiplied by: rho h; a and c, over h
                                               or h^3 */
    real *factor;                           /* L and D of A = L D L', lower band by rows */
    real *response;                         /* z */
    real *rhs, *free;                       /* workspace */
    real *state[STATES]; /* displacement, and behind it velocity; clamped node left out */
    real tau, rate_tau;
    size_t since;
    real largest[2];
};

struct dense_march {
    struct br_march *march;
    const struct br_scene *scene;
    struct br_method method;
    size_t n;
    real h;
    struct dense_field field[2];
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

/* Of an element, for its unknowns at both nodes: (u), (u, b) with the bubble b of the element that
 * ends there, u = (1 - xi) u0 + xi u1 - xi (1 - xi) b, or (w, h w_x); mass over rho h, stiffness
 * over that of the material and h or h^3. */
static const real linear_mass[4][4] = {{1 / 3.0Q, 1 / 6.0Q}, {1 / 6.0Q, 1 / 3.0Q}};
static const real linear_stiffness[4][4] = {{1, -1}, {-1, 1}};
static const real quadratic_mass[4][4] = {{1 / 3.0Q, 0, 1 / 6.0Q, -1 / 12.0Q},
                                          {0},
                                          {1 / 6.0Q, 0, 1 / 3.0Q, -1 / 12.0Q},
                                          {-1 / 12.0Q, 0, -1 / 12.0Q, 1 / 30.0Q}};
static const real quadratic_stiffness[4][4] = {
    {1, 0, -1, 0}, {0}, {-1, 0, 1, 0}, {0, 0, 0, 1 / 3.0Q}};
static const real bending_mass[4][4] = {{156 / 420.0Q, 22 / 420.0Q, 54 / 420.0Q, -13 / 420.0Q},
                                        {22 / 420.0Q, 4 / 420.0Q, 13 / 420.0Q, -3 / 420.0Q},
                                        {54 / 420.0Q, 13 / 420.0Q, 156 / 420.0Q, -22 / 420.0Q},
                                        {-13 / 420.0Q, -3 / 420.0Q, -22 / 420.0Q, 4 / 420.0Q}};
static const real bending_stiffness[4][4] = {
    {12, 6, -12, 6}, {6, 4, -6, 2}, {-12, -6, 12, -6}, {6, 2, -6, 4}};

/* Of the same unknowns at xi. */
static void fill_shape(const struct dense_field *f, real xi, real shape[4])
{
    const real eta = 1 - xi;
    if (f->mass == bending_mass) {
        shape[0] = eta * eta * (1 + 2 * xi);
        shape[1] = xi * eta * eta;
        shape[2] = xi * xi * (1 + 2 * eta);
        shape[3] = -xi * xi * eta;
        return;
    }
    memset(shape, 0, 4 * sizeof *shape);
    shape[0] = eta;
    shape[f->u] = xi;
    if (f->u == 2)
        shape[3] = -xi * eta;
}

static real *at(struct dense_field *f, size_t i, size_t j)
{
    return &f->factor[i * (f->band + 1) + i - j];
}

static void solve(struct dense_field *f, real *x)
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

static void factorise(struct dense_march *q, int kind, real tau)
{
    struct dense_field *f = &q->field[kind];
    const real stiff = f->viscous + tau * f->stiff;
    if (tau == f->tau)
        return;
    f->tau = tau;
    memset(f->factor, 0, f->order * (f->band + 1) * sizeof *f->factor);
    for (size_t e = 0; e < q->n; e++)
        for (size_t a = 0; a < 2 * f->u; a++)
            for (size_t b = 0; b <= a; b++)
                if (e * f->u + b >= f->u)
                    *at(f, (e - 1) * f->u + a, (e - 1) * f->u + b) +=
                        f->heavy * f->mass[a][b] / tau + stiff * f->stiffness[a][b];
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

/* Five Gauss points an element, as the solver has them: exact for polynomials of x. */
static void add_load(const struct dense_march *q, struct dense_field *f, const struct br_load *load,
                     double t)
{
    static const real weight[5] = {0.118463442528094543757132020359958681Q,
                                   0.239314335249683234020645757417819097Q, 64 / 225.0Q,
                                   0.239314335249683234020645757417819097Q,
                                   0.118463442528094543757132020359958681Q};
    static const real point[5] = {
        0.0469100770306680036011865608503035174Q, 0.230765344947158454481842789649895597Q, 0.5Q,
        0.769234655052841545518157210350104403Q, 0.953089922969331996398813439149696483Q};
    const real h = q->h;
    for (size_t e = 0; e < q->n; e++)
        for (int g = 0; g < 5; g++) {
            real shape[4];
            const double x = (double)(h * (e + point[g]));
            const real force = h * weight[g] * br_load_value(load, x, t);
            fill_shape(f, point[g], shape);
            for (size_t a = e > 0 ? 0 : f->u; a < 2 * f->u; a++)
                f->rhs[(e - 1) * f->u + a] += force * shape[a];
        }
}

static real value_at(const struct br_function *f, real x, double t)
{
    const double at = (double)x;
    double value;
    br_function_evaluate(f, 1, &at, t, &value);
    return value;
}

/* f + M v / tau - K w, in f->rhs. */
static void form_rhs(struct dense_march *q, int kind, double t)
{
    struct dense_field *f = &q->field[kind];
    const struct br_scene *s = q->scene;
    const bool axial = kind == BR_AXIAL;
    const real *w = f->state[Z], *v = w + f->order;
    memset(f->rhs, 0, f->order * sizeof *f->rhs);
    add_load(q, f, &s->field[kind].load, t);
    for (size_t e = 0; e < q->n; e++)
        for (size_t a = e > 0 ? 0 : f->u; a < 2 * f->u; a++)
            for (size_t b = e > 0 ? 0 : f->u; b < 2 * f->u; b++) {
                const size_t j = (e - 1) * f->u + b;
                f->rhs[(e - 1) * f->u + a] +=
                    f->heavy * f->mass[a][b] / f->tau * v[j] - f->stiff * f->stiffness[a][b] * w[j];
            }
    f->rhs[f->order - f->u] += value_at(&s->field[kind].tip_force, 0, t);
    if (!axial)
        f->rhs[f->order - 1] += value_at(&s->bending.tip_moment, 0, t) / q->h;
}

static real positive(real x)
{
    return x > 0 ? x : 0;
}

static real contact_force(const struct dense_march *q, real u, real v, real z, real tau)
{
    const struct br_contact *c = &q->scene->contact;
    if (!c->modelled)
        return 0;
    if (!q->method.contact->at_new_step)
        return c->stiffness * positive(u - c->gap);
    return c->stiffness * positive(u + tau * v - c->gap) / (1 + c->stiffness * tau * z);
}

static real penetration_at(const struct dense_march *q, real part)
{
    for (int i = 0; i < q->stage_count; i++)
        if (q->stage_time[i] == part)
            return q->penetration[i];
    const real s = part, r = 1 - part;
    return positive((1 + 2 * s) * r * r * q->path[0] + s * r * r * q->path[1] +
                    s * s * (3 - 2 * s) * q->path[2] - s * s * r * q->path[3] -
                    q->scene->contact.gap);
}

static real friction_force(const struct dense_march *q, real part, real v, real z)
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

static void add(struct dense_field *f, int into, real weight, int of)
{
    for (size_t i = 0; i < 2 * f->order && weight != 0; i++)
        f->state[into][i] += weight * f->state[of][i];
}

static void copy(struct dense_field *f, int into, int of)
{
    memcpy(f->state[into], f->state[of], 2 * f->order * sizeof **f->state);
}

/* Z of a stage; BR_RATE is tau Y' of the step's end, with that step's tau. */
static void start(struct dense_field *f, const struct br_stage *stage)
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
static void finish(struct dense_field *f, real force, real *to)
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
    struct dense_march *q = self;
    struct dense_field *f = &q->field[told->kind];
    struct br_stages stages;
    br_time_scheme_step(q->method.scheme, f->since, &stages);
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
    struct dense_march *q = self;
    struct dense_field *f = &q->field[kind];
    struct br_stages stages;
    br_time_scheme_step(q->method.scheme, f->since, &stages);
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

static bool init_field(struct dense_march *q, enum br_field_kind kind, int degree)
{
    struct dense_field *f = &q->field[kind];
    const struct br_scene *s = q->scene;
    const bool axial = kind == BR_AXIAL;
    const real volume = axial ? q->h : q->h * q->h * q->h;
    const bool quadratic = kind == BR_AXIAL && degree == 2, linear = kind == BR_AXIAL && !quadratic;
    f->mass = linear ? linear_mass : quadratic ? quadratic_mass : bending_mass;
    f->stiffness = linear ? linear_stiffness : quadratic ? quadratic_stiffness : bending_stiffness;
    f->u = linear ? 1 : 2;
    f->heavy = s->density * q->h;
    f->stiff = s->field[kind].stiffness / volume;
    f->viscous = s->field[kind].viscosity / volume;
    f->order = f->u * q->n;
    f->band = 2 * f->u - 1;
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

/* The interpolant of a function of x, with its slope for bending. */
static void interpolate(const struct dense_march *q, const struct dense_field *f,
                        const struct br_function *value, const struct br_function *slope, real *to)
{
    const real h = q->h;
    for (size_t i = 1; i <= q->n; i++) {
        real *node = to + (i - 1) * f->u;
        node[0] = value_at(value, h * i, 0);
        if (slope)
            node[1] = h * value_at(slope, h * i, 0);
        else if (f->u == 2)
            node[1] =
                2 * (node[0] + (i > 1 ? node[-2] : 0)) - 4 * value_at(value, h * i - h / 2, 0);
    }
}

static void start_from(struct dense_march *q)
{
    const struct br_scene_field *a = &q->scene->axial;
    const struct br_scene_field *b = &q->scene->bending;
    struct dense_field *rod = &q->field[BR_AXIAL], *beam = &q->field[BR_BENDING];
    interpolate(q, rod, &a->displacement, NULL, rod->state[BR_NOW]);
    interpolate(q, rod, &a->velocity, NULL, rod->state[BR_NOW] + rod->order);
    interpolate(q, beam, &b->displacement, &b->displacement_slope, beam->state[BR_NOW]);
    interpolate(q, beam, &b->velocity, &b->velocity_slope, beam->state[BR_NOW] + beam->order);
}

struct dense_march *dense_follow(struct br_march *march, const struct br_scene *scene,
                                 const struct br_method *method)
{
    struct dense_march *q = BR_HAS_QUAD ? calloc(1, sizeof *q) : NULL;
    if (!q)
        return NULL;
    q->march = march;
    q->scene = scene;
    q->method = *method;
    q->n = br_march_field(march, BR_AXIAL)->n;
    q->h = (real)scene->length / (real)q->n;
    q->nodal = calloc(4 * (q->n + 1), sizeof *q->nodal);
    if (!q->nodal || !init_field(q, BR_AXIAL, method->axial_degree) ||
        !init_field(q, BR_BENDING, 1)) {
        dense_free(q);
        return NULL;
    }
    start_from(q);
    br_march_watch(march, &(struct br_march_watcher){q, follow_stage, follow_step});
    return q;
}

void dense_free(struct dense_march *q)
{
    if (!q)
        return;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        free(q->field[kind].factor);
    free(q->nodal);
    free(q);
}

double dense_deviation(struct dense_march *q, enum br_field_kind kind, int derivative)
{
    struct dense_field *f = &q->field[kind];
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

long double dense_displacement(const struct dense_march *q, enum br_field_kind kind, size_t node)
{
    const struct dense_field *f = &q->field[kind];
    return node == 0 ? 0 : (long double)f->state[BR_NOW][(node - 1) * f->u];
}
