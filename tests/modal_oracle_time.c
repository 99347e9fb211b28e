/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scalar equations under a load in time: exact for exponentials, whatever their rates. */
#include <math.h>
#include <stdlib.h>

#include "tests/modal_oracle.h"

enum { NODES = ORACLE_NODES };

/* ---- panels of time ---- */

static size_t class_of(struct oracle_panels *p, real length, real last)
{
    for (size_t i = 0; i < p->classes; i++)
        if (fabsl(p->length[i] - length) <= 1e-18L * last)
            return i;
    p->length = realloc(p->length, (p->classes + 1) * sizeof *p->length);
    p->length[p->classes] = length;
    return p->classes++;
}

static void add_panels(struct oracle_panels *p, real from, real to, real longest, real last)
{
    const size_t parts = 1 + (size_t)((to - from) / longest), first = p->count;
    const size_t class = class_of(p, (to - from) / (real)parts, last);
    p->count += parts;
    p->start = realloc(p->start, p->count * sizeof *p->start);
    p->class_of = realloc(p->class_of, p->count * sizeof *p->class_of);
    for (size_t i = 0; i < parts; i++) {
        p->start[first + i] = from + (to - from) * (real)i / (real)parts;
        p->class_of[first + i] = class;
    }
}

void oracle_panels_free(struct oracle_panels *p)
{
    free(p->class_of);
    free(p->reached);
    free(p->start);
    free(p->length);
}

struct edges {
    real *at;
    size_t count;
};

static void add_edge(struct edges *e, real at)
{
    e->at = realloc(e->at, (e->count + 1) * sizeof *e->at);
    e->at[e->count++] = at;
}

static int ascending(const void *a, const void *b)
{
    const real x = *(const real *)a, y = *(const real *)b;
    return (x > y) - (x < y);
}

/* When an edge of a moving load enters and leaves. */
static void add_crossings(struct edges *e, const struct oracle_term *term, real length, real edge)
{
    if (!isfinite(edge) || term->speed == 0)
        return;
    add_edge(e, (-edge - (real)term->start) / (real)term->speed);
    add_edge(e, (length - edge - (real)term->start) / (real)term->speed);
}

static void add_moving_edges(struct edges *e, const struct oracle_term *term, real length)
{
    real edge[ORACLE_EDGES];
    const size_t smooth = oracle_edges(&term->space, edge);
    for (size_t i = 0; i < smooth; i++)
        add_crossings(e, term, length, edge[i]);
    for (size_t i = 0; i < term->space.steps; i++)
        add_crossings(e, term, length, term->space.step[i].at);
}

void oracle_panels(struct oracle_panels *p, const struct oracle_term *term, real length,
                   real longest, size_t times, const double *t)
{
    struct edges e = {0};
    real edge[ORACLE_EDGES], from = 0;
    const size_t smooth = oracle_edges(&term->time, edge);
    for (size_t i = 0; i < smooth; i++)
        add_edge(&e, edge[i]);
    for (size_t i = 0; i < term->time.steps; i++)
        add_edge(&e, term->time.step[i].at);
    if (term->moving)
        add_moving_edges(&e, term, length);
    for (size_t k = 0; k < times; k++)
        add_edge(&e, t[k]);
    qsort(e.at, e.count, sizeof *e.at, ascending);
    p->reached = calloc(times, sizeof *p->reached);
    size_t k = 0;
    for (size_t i = 0; i < e.count; i++) {
        const real to = fminl(e.at[i], t[times - 1]);
        if (to > from)
            add_panels(p, from, to, longest, t[times - 1]);
        from = fmaxl(from, to);
        while (k < times && from >= t[k])
            p->reached[k++] = p->count;
    }
    free(e.at);
}

/* ---- equations with two states: a mode, or two of first order in a row ---- */

/* q and q' of mass q'' + damping q' + stiffness q = impulse. */
static void mode_impulse(const struct oracle_equation *e, real s, real value[2])
{
    const real half = e->damping / (2 * e->mass), d = half * half - e->stiffness / e->mass;
    const real root = sqrtl(fabsl(d));
    if (d < 0) {
        const real decay = expl(-half * s), sine = root > 0 ? sinl(root * s) / root : s;
        value[0] = decay * sine / e->mass;
        value[1] = decay * (cosl(root * s) - half * sine) / e->mass;
        return;
    }
    const real fast = half + root, slow = e->stiffness / e->mass / fast;
    const real gap = root > 0 ? -expm1l(-2 * root * s) / (2 * root) : s;
    const real decay = expl(-slow * s) / e->mass;
    value[0] = decay * gap;
    value[1] = decay * (expl(-2 * root * s) - slow * gap);
}

static void mode_carry(const struct oracle_equation *e, real s, real carry[2][2])
{
    real h[2];
    mode_impulse(e, s, h);
    carry[0][0] = e->mass * h[1] + e->damping * h[0];
    carry[0][1] = e->mass * h[0];
    carry[1][0] = -e->stiffness * h[0];
    carry[1][1] = e->mass * h[1];
}

struct oracle_equation oracle_mode_equation(const struct oracle_problem *p, real b)
{
    const real lambda = powl(b / (real)p->length, p->bending ? 4 : 2);
    struct oracle_equation e = {mode_impulse,          mode_carry,           0, p->density,
                                p->viscosity * lambda, p->stiffness * lambda};
    const real half = e.damping / (2 * e.mass), d = half * half - e.stiffness / e.mass;
    e.rate = d < 0 ? sqrtl(e.stiffness / e.mass) : half + sqrtl(d);
    return e;
}

/* y and z of damping y' + stiffness y = impulse, damping z' + stiffness z = y. */
static void slow_impulse(const struct oracle_equation *e, real s, real value[2])
{
    value[0] = expl(-e->stiffness / e->damping * s) / e->damping;
    value[1] = s * value[0] / e->damping;
}

static void slow_carry(const struct oracle_equation *e, real s, real carry[2][2])
{
    carry[0][0] = carry[1][1] = expl(-e->stiffness / e->damping * s);
    carry[0][1] = 0;
    carry[1][0] = s / e->damping * carry[0][0];
}

struct oracle_equation oracle_slow_equation(const struct oracle_problem *p)
{
    const real rate = (real)p->stiffness / (real)p->viscosity;
    return (struct oracle_equation){slow_impulse, slow_carry, rate, 0, p->viscosity, p->stiffness};
}

/* ---- responses ---- */

/* moment[k] (out) of e^{-rate s} with P_k(1 - 2 s / length) over [0, length]: modified spherical
 * Bessel functions i_k(z) e^{-z}, upward where z is large and downward else. */
static void decay_moments(real rate, real length, real moment[NODES])
{
    enum { FAR = 60 };
    const real z = rate * length / 2;
    real value[FAR + 2] = {0};
    value[0] = z > 1e-30L ? -expm1l(-2 * z) / (2 * z) : 1;
    if (z > 25) {
        value[1] = (-expm1l(-2 * z) * -1 / z + 1 + expl(-2 * z)) / (2 * z);
        for (int k = 1; k + 1 < NODES; k++)
            value[k + 1] = value[k - 1] - (2 * k + 1) / z * value[k];
    } else if (z > 1e-30L) {
        real scale = value[0];
        value[FAR] = 1e-4000L;
        for (int k = FAR; k >= 1; k--)
            value[k - 1] = value[k + 1] + (2 * k + 1) / z * value[k];
        scale /= value[0];
        for (int k = 0; k < NODES; k++)
            value[k] *= scale;
    }
    for (int k = 0; k < NODES; k++)
        moment[k] = length * value[k];
}

/* moment[k][i] (out): of state i's impulse response with P_k over a panel, from its end back, by
 * pieces that are as short as the rate asks for. */
static void slow_moments(const struct oracle_equation *e, real length, real moment[NODES][2])
{
    const size_t parts = 1 + (size_t)(e->rate * length / 4);
    const real width = length / (real)parts;
    for (size_t n = 0; n < parts * NODES; n++) {
        real h[2], p[NODES + 1];
        const real s = width * ((real)(n / NODES) + oracle_gauss()->node[n % NODES]);
        e->impulse(e, s, h);
        oracle_legendre(1 - s / length, p);
        for (int k = 0; k < NODES; k++)
            for (int i = 0; i < 2; i++)
                moment[k][i] += oracle_gauss()->weight[n % NODES] * width * h[i] * p[k];
    }
}

/* The same; where a mode's impulse response is two decays of which one is fast, from theirs. */
static void moments(const struct oracle_equation *e, real length, real moment[NODES][2])
{
    for (int k = 0; k < NODES; k++)
        moment[k][0] = moment[k][1] = 0;
    if (e->rate * length <= 12) {
        slow_moments(e, length, moment);
        return;
    }
    const real slow = e->stiffness / e->mass / e->rate, gap = (e->rate - slow) * e->mass;
    real late[NODES], early[NODES];
    decay_moments(slow, length, late);
    decay_moments(e->rate, length, early);
    for (int k = 0; k < NODES; k++) {
        moment[k][0] = (late[k] - early[k]) / gap;
        moment[k][1] = (e->rate * early[k] - slow * late[k]) / gap;
    }
}

/* What a panel of one class does to the states: they are carried, and the drive at the nodes
 * adds to them. */
struct passage {
    real carry[2][2], add[NODES][2];
};

static void make_passage(const struct oracle_equation *e, real length, struct passage *out)
{
    real moment[NODES][2];
    moments(e, length, moment);
    e->carry(e, length, out->carry);
    for (int j = 0; j < NODES; j++)
        for (int i = 0; i < 2; i++) {
            out->add[j][i] = 0;
            for (int k = 0; k < NODES; k++)
                out->add[j][i] += oracle_gauss()->weight[j] * (2 * k + 1) *
                                  oracle_gauss()->legendre[k][j] * moment[k][i];
        }
}

void oracle_respond(const struct oracle_equation *e, const struct oracle_panels *p,
                    const real *drive, size_t times, real state[][2])
{
    struct passage *passage = calloc(p->classes, sizeof *passage);
    for (size_t i = 0; i < p->classes; i++)
        make_passage(e, p->length[i], &passage[i]);
    real now[2] = {0, 0};
    size_t k = 0;
    for (size_t i = 0; i <= p->count; i++) {
        for (; k < times && p->reached[k] == i; k++)
            for (int s = 0; s < 2; s++)
                state[k][s] = now[s];
        if (i == p->count)
            break;
        const struct passage *q = &passage[p->class_of[i]];
        real next[2];
        for (int s = 0; s < 2; s++) {
            next[s] = q->carry[s][0] * now[0] + q->carry[s][1] * now[1];
            for (int j = 0; j < NODES; j++)
                next[s] += q->add[j][s] * drive[i * NODES + (size_t)j];
        }
        now[0] = next[0];
        now[1] = next[1];
    }
    free(passage);
}
