/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/modal_oracle.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

typedef long double real;

static const real pi = 3.14159265358979323846264338327950288L;
static const real root2 = 1.41421356237309504880168872420969808L;

/* ---- Gauss-Legendre on [0, 1] ---- */

enum { NODES = 20 };

static struct {
    bool ready;
    real node[NODES], weight[NODES];
    real legendre[NODES][NODES];             /* [k][j]: P_k at node j */
    real end_value[NODES], end_slope[NODES]; /* of the interpolant at 1, by values at the nodes */
} gauss;

static void legendre_at(real u, real p[NODES + 1])
{
    const real y = 2 * u - 1;
    p[0] = 1;
    p[1] = y;
    for (int k = 1; k < NODES; k++)
        p[k + 1] = ((2 * k + 1) * y * p[k] - k * p[k - 1]) / (k + 1);
}

/* Newton's method for the j-th zero of P_NODES. */
static void find_node(int j)
{
    real p[NODES + 1], y = -cosl(pi * (j + 0.75L) / (NODES + 0.5L)), slope = 1;
    for (int i = 0; i < 12; i++) {
        legendre_at((1 + y) / 2, p);
        slope = NODES * (p[NODES - 1] - y * p[NODES]) / (1 - y * y);
        y -= p[NODES] / slope;
    }
    gauss.node[j] = (1 + y) / 2;
    gauss.weight[j] = 1 / ((1 - y * y) * slope * slope);
    legendre_at(gauss.node[j], p);
    gauss.end_value[j] = gauss.end_slope[j] = 0;
    for (int k = 0; k < NODES; k++) {
        gauss.legendre[k][j] = p[k];
        gauss.end_value[j] += gauss.weight[j] * (2 * k + 1) * p[k];
        gauss.end_slope[j] += gauss.weight[j] * (2 * k + 1) * p[k] * k * (k + 1);
    }
}

static void prepare_gauss(void)
{
    for (int j = 0; j < NODES && !gauss.ready; j++)
        find_node(j);
    gauss.ready = true;
}

/* ---- eigenfunctions on [0, 1], their mean square is 1 ---- */

/* sqrt(2) sin(b x), or start e^{-b x} + end e^{-b (1 - x)} - cos(b x) + sine sin(b x), which is
 * cosh - cos - sine (sinh - sin) without its cancellation. */
struct mode {
    bool bending;
    real b, start, end, sine;
};

real oracle_root(bool bending, size_t i)
{
    real b = ((real)i - 0.5L) * pi;
    for (int k = 0; bending && k < 60; k++) {
        const real e = expl(-b), sech = 2 * e / (1 + e * e);
        b -= (cosl(b) + sech) / (-sinl(b) - sech * (1 - e * e) / (1 + e * e));
    }
    return b;
}

static struct mode make_mode(bool bending, size_t i)
{
    struct mode m = {.bending = bending, .b = oracle_root(bending, i)};
    const real e = expl(-m.b), s = sinl(m.b), c = cosl(m.b), below = 1 - e * e + 2 * e * s;
    m.sine = (1 + e * e + 2 * e * c) / below;
    m.start = (1 + m.sine) / 2;
    m.end = (s - c - e) / below;
    return m;
}

static real mode_value(const struct mode *m, real x)
{
    if (!m->bending)
        return root2 * sinl(m->b * x);
    return m->start * expl(-m->b * x) + m->end * expl(-m->b * (1 - x)) - cosl(m->b * x) +
           m->sine * sinl(m->b * x);
}

/* The derivative at x = 1. */
static real mode_slope(const struct mode *m)
{
    if (!m->bending)
        return root2 * m->b * cosl(m->b);
    return m->b * (m->end - m->start * expl(-m->b) + sinl(m->b) + m->sine * cosl(m->b));
}

/* The integral from x0 to x1, without cancellation where they are close. */
static real mode_integral(const struct mode *m, real x0, real x1)
{
    const real b = m->b, middle = b * (x0 + x1) / 2, sine = 2 * sinl(b * (x1 - x0) / 2) / b;
    if (!m->bending)
        return root2 * sinl(middle) * sine;
    const real decay = -expm1l(-b * (x1 - x0)) / b;
    return m->start * expl(-b * x0) * decay + m->end * expl(-b * (1 - x1)) * decay -
           cosl(middle) * sine + m->sine * sinl(middle) * sine;
}

/* ---- what a load is weighted with ---- */

/* A mode, or the static deflection under a unit force at the tip (power 1), or the deflection under
 * that deflection as a load (power 2): the sums of phi_i(1) phi_i(x) / lambda_i^power. */
struct weight {
    const struct mode *mode; /* NULL: a deflection */
    bool bending;
    int power;
};

static real weight_value(const struct weight *w, real x)
{
    if (w->mode)
        return mode_value(w->mode, x);
    if (!w->bending)
        return w->power == 1 ? x : x / 2 - x * x * x / 6;
    if (w->power == 1)
        return x * x * (3 - x) / 6;
    const real x2 = x * x;
    return x2 * (11.0L / 240 - x / 48 + x2 * x2 * (1.0L / 720 - x / 5040));
}

static real weight_slope(const struct weight *w)
{
    if (w->mode)
        return mode_slope(w->mode);
    assert(w->bending);
    return w->power == 1 ? 0.5L : 13.0L / 360;
}

/* ---- factors ---- */

struct oracle_factor oracle_one(void)
{
    static const struct oracle_step step = {-INFINITY, 1};
    return (struct oracle_factor){.kind = ORACLE_STEPS, .step = &step, .steps = 1};
}

real oracle_value(const struct oracle_factor *f, real s)
{
    const real y = (s - f->p[0]) / (f->kind == ORACLE_GAUSS || f->kind == ORACLE_HAT ? f->p[1] : 1);
    real sum = 0;
    switch (f->kind) {
    case ORACLE_STEPS:
        for (size_t i = 0; i < f->steps && f->step[i].at <= s; i++)
            sum += f->step[i].height;
        return sum;
    case ORACLE_POWER:
        return powl(s, f->p[0]);
    case ORACLE_WAVE:
        return sinl(f->p[0] * s);
    case ORACLE_GAUSS:
        return expl(-y * y);
    default:
        return fmaxl(0, 1 - fabsl(y));
    }
}

enum { SMOOTH_EDGES = 15 };

/* edge (out): places between which a factor that is no sum of steps is smooth and wide. */
static size_t factor_edges(const struct oracle_factor *f, real edge[SMOOTH_EDGES])
{
    const int half = f->kind == ORACLE_GAUSS ? SMOOTH_EDGES / 2 : f->kind == ORACLE_HAT ? 1 : -1;
    for (int i = -half; i <= half; i++)
        edge[half + i] = f->p[0] + i * (real)f->p[1];
    return half < 0 ? 0 : (size_t)(2 * half + 1);
}

/* ---- integrals of a load over the beam ---- */

/* The integral of a factor of x - shift times the weight from x0 to x1, in units of the length. */
static real smooth_piece(const struct weight *w, const struct oracle_factor *f, const real shift[2],
                         real x0, real x1)
{
    const real wave = f->kind == ORACLE_WAVE ? (real)f->p[0] * shift[1] : 0;
    const real angle = (x1 - x0) * fmaxl(w->mode ? w->mode->b : 0, fabsl(wave));
    const size_t parts = 1 + (size_t)(angle / 12);
    const real width = (x1 - x0) / (real)parts;
    real sum = 0;
    for (size_t i = 0; i < parts; i++)
        for (int j = 0; j < NODES; j++) {
            const real x = x0 + width * ((real)i + gauss.node[j]);
            sum += gauss.weight[j] * width * weight_value(w, x) *
                   oracle_value(f, x * shift[1] - shift[0]);
        }
    return sum;
}

static real step_piece(const struct weight *w, real x0, real x1)
{
    static const struct oracle_factor one = {.kind = ORACLE_POWER};
    const real none[] = {0, 1};
    return w->mode ? mode_integral(w->mode, x0, x1) : smooth_piece(w, &one, none, x0, x1);
}

/* The integral of exp(-((x - s) / w)^2) times a mode over the whole line: the beam's, where the
 * blow is inside. */
static real whole_gauss(const struct mode *m, real s, real w)
{
    const real b = m->b, bend = b * b * w * w / 4, area = w * sqrtl(pi);
    if (!m->bending)
        return root2 * area * expl(-bend) * sinl(b * s);
    return area * (m->start * expl(bend - b * s) + m->end * expl(bend - b * (1 - s)) +
                   expl(-bend) * (m->sine * sinl(b * s) - cosl(b * s)));
}

static real clipped(real x)
{
    return fminl(fmaxl(x, 0), 1);
}

/* The mean over the beam of f(x - shift) times the weight. */
static real spread(const struct weight *w, const struct oracle_factor *f, real shift, real length)
{
    const real by[] = {shift, length};
    real sum = 0, level = 0, edge[SMOOTH_EDGES], x0 = 0;
    for (size_t i = 0; f->kind == ORACLE_STEPS && i < f->steps; i++) {
        level += f->step[i].height;
        const real x = clipped((shift + f->step[i].at) / length);
        const real next = i + 1 < f->steps ? clipped((shift + f->step[i + 1].at) / length) : 1;
        sum += next > x && level != 0 ? level * step_piece(w, x, next) : 0;
    }
    if (f->kind == ORACLE_STEPS)
        return sum;
    const size_t edges = factor_edges(f, edge);
    if (f->kind == ORACLE_GAUSS && w->mode && w->mode->b * f->p[1] <= 12 * length &&
        shift + edge[0] >= 0 && shift + edge[edges - 1] <= length)
        return whole_gauss(w->mode, (shift + f->p[0]) / length, f->p[1] / length);
    for (size_t i = 0; i <= edges; i++) {
        const real x1 = i < edges ? clipped((shift + edge[i]) / length) : 1;
        const bool outside = edges && (i == 0 || i == edges); /* nothing is left there */
        sum += x1 > x0 && !outside ? smooth_piece(w, f, by, x0, x1) : 0;
        x0 = x1;
    }
    return sum;
}

/* ---- panels of time ---- */

struct panels {
    size_t count, classes, *class_of, *reached; /* reached[k]: panels before the k-th time */
    real *start, *length;                       /* of a panel; of a class */
};

static size_t class_of(struct panels *p, real length, real last)
{
    for (size_t i = 0; i < p->classes; i++)
        if (fabsl(p->length[i] - length) <= 1e-18L * last)
            return i;
    p->length = realloc(p->length, (p->classes + 1) * sizeof *p->length);
    p->length[p->classes] = length;
    return p->classes++;
}

static void add_panels(struct panels *p, real from, real to, real longest, real last)
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

static void free_panels(struct panels *p)
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
    real edge[SMOOTH_EDGES];
    const size_t smooth = factor_edges(&term->space, edge);
    for (size_t i = 0; i < smooth; i++)
        add_crossings(e, term, length, edge[i]);
    for (size_t i = 0; i < term->space.steps; i++)
        add_crossings(e, term, length, term->space.step[i].at);
}

static void make_panels(struct panels *p, const struct oracle_term *term, real length, real longest,
                        size_t times, const double *t)
{
    struct edges e = {0};
    real edge[SMOOTH_EDGES], from = 0;
    const size_t smooth = factor_edges(&term->time, edge);
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

/* value (out): the states a time s after a unit impulse. carry (out): what they become of given
 * ones after a time s. rate, 1/s: of the fastest decay or oscillation. */
struct equation {
    void (*impulse)(const struct equation *e, real s, real value[2]);
    void (*carry)(const struct equation *e, real s, real carry[2][2]);
    real rate, mass, damping, stiffness;
};

/* q and q' of mass q'' + damping q' + stiffness q = impulse. */
static void mode_impulse(const struct equation *e, real s, real value[2])
{
    const real half = e->damping / (2 * e->mass), d = half * half - e->stiffness / e->mass;
    const real root = sqrtl(fabsl(d));
    if (d < 0) {
        const real decay = expl(-half * s), sine = root * s > 1e-9L ? sinl(root * s) / root : s;
        value[0] = decay * sine / e->mass;
        value[1] = decay * (cosl(root * s) - half * sine) / e->mass;
        return;
    }
    const real fast = half + root, slow = e->stiffness / e->mass / fast;
    const real gap = root * s > 1e-9L ? -expm1l(-2 * root * s) / (2 * root) : s;
    const real decay = expl(-slow * s) / e->mass;
    value[0] = decay * gap;
    value[1] = decay * (expl(-2 * root * s) - slow * gap);
}

static void mode_carry(const struct equation *e, real s, real carry[2][2])
{
    real h[2];
    mode_impulse(e, s, h);
    carry[0][0] = e->mass * h[1] + e->damping * h[0];
    carry[0][1] = e->mass * h[0];
    carry[1][0] = -e->stiffness * h[0];
    carry[1][1] = e->mass * h[1];
}

static struct equation mode_equation(const struct oracle_problem *p, real b)
{
    const real lambda = powl(b / (real)p->length, p->bending ? 4 : 2);
    struct equation e = {mode_impulse,          mode_carry,           0, p->density,
                         p->viscosity * lambda, p->stiffness * lambda};
    const real half = e.damping / (2 * e.mass), d = half * half - e.stiffness / e.mass;
    e.rate = d < 0 ? sqrtl(e.stiffness / e.mass) : half + sqrtl(d);
    return e;
}

/* y and z of damping y' + stiffness y = impulse, damping z' + stiffness z = y. */
static void slow_impulse(const struct equation *e, real s, real value[2])
{
    value[0] = expl(-e->stiffness / e->damping * s) / e->damping;
    value[1] = s * value[0] / e->damping;
}

static void slow_carry(const struct equation *e, real s, real carry[2][2])
{
    carry[0][0] = carry[1][1] = expl(-e->stiffness / e->damping * s);
    carry[0][1] = 0;
    carry[1][0] = s / e->damping * carry[0][0];
}

static struct equation slow_equation(const struct oracle_problem *p)
{
    const real rate = (real)p->stiffness / (real)p->viscosity;
    return (struct equation){slow_impulse, slow_carry, rate, 0, p->viscosity, p->stiffness};
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
static void slow_moments(const struct equation *e, real length, real moment[NODES][2])
{
    const size_t parts = 1 + (size_t)(e->rate * length / 4);
    const real width = length / (real)parts;
    for (size_t n = 0; n < parts * NODES; n++) {
        real h[2], p[NODES + 1];
        const real s = width * ((real)(n / NODES) + gauss.node[n % NODES]);
        e->impulse(e, s, h);
        legendre_at(1 - s / length, p);
        for (int k = 0; k < NODES; k++)
            for (int i = 0; i < 2; i++)
                moment[k][i] += gauss.weight[n % NODES] * width * h[i] * p[k];
    }
}

/* The same; where a mode's impulse response is two decays of which one is fast, from theirs. */
static void moments(const struct equation *e, real length, real moment[NODES][2])
{
    for (int k = 0; k < NODES; k++)
        moment[k][0] = moment[k][1] = 0;
    if (e->rate * length <= 12) {
        slow_moments(e, length, moment);
        return;
    }
    const real slow = e->stiffness / e->mass / e->rate, apart = (e->rate - slow) * e->mass;
    real late[NODES], early[NODES];
    decay_moments(slow, length, late);
    decay_moments(e->rate, length, early);
    for (int k = 0; k < NODES; k++) {
        moment[k][0] = (late[k] - early[k]) / apart;
        moment[k][1] = (e->rate * early[k] - slow * late[k]) / apart;
    }
}

/* What a panel of one class does to the states: they are carried, and the drive at the nodes
 * adds to them. */
struct passage {
    real carry[2][2], add[NODES][2];
};

static void make_passage(const struct equation *e, real length, struct passage *out)
{
    real moment[NODES][2];
    moments(e, length, moment);
    e->carry(e, length, out->carry);
    for (int j = 0; j < NODES; j++)
        for (int i = 0; i < 2; i++) {
            out->add[j][i] = 0;
            for (int k = 0; k < NODES; k++)
                out->add[j][i] +=
                    gauss.weight[j] * (2 * k + 1) * gauss.legendre[k][j] * moment[k][i];
        }
}

/* state[k] (out) at the times, from rest, under a drive that is given at the panels' nodes. */
static void respond(const struct equation *e, const struct panels *p, const real *drive,
                    size_t times, real state[][2])
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

/* The states a time s after a unit step: integrals of the equations give them. */
static void step_response(const struct equation *e, real s, real value[2])
{
    real h[2];
    e->impulse(e, s, h);
    if (e->mass > 0) {
        value[0] = (1 - e->mass * h[1] - e->damping * h[0]) / e->stiffness;
        value[1] = h[0];
    } else {
        value[0] = -expm1l(-e->rate * s) / e->stiffness;
        value[1] = (value[0] - e->damping * h[1]) / e->stiffness;
    }
}

static void respond_to_steps(const struct equation *e, const struct oracle_factor *f, size_t times,
                             const double *t, real state[][2])
{
    for (size_t k = 0; k < times; k++) {
        state[k][0] = state[k][1] = 0;
        for (size_t i = 0; i < f->steps && f->step[i].at < t[k]; i++) {
            real h[2];
            step_response(e, t[k] - fmaxl(f->step[i].at, 0), h);
            for (int s = 0; s < 2; s++)
                state[k][s] += f->step[i].height * h[s];
        }
    }
}

/* ---- one term: the sum over the modes and what the others add ---- */

/* The modes that are left out follow their load almost at once:
 *     q = p / (lambda k) - rho s^2 p / (lambda k)^2 + ..., k = c s + a,
 * in Laplace's variable s. The sums over all modes of both terms are known, so the rest of the sums
 * times these two responses is the tail. */
struct solver {
    const struct oracle_problem *problem;
    const struct oracle_term *term;
    size_t times;
    const double *t;
    bool by_steps; /* the time's factor is steps and nothing moves: all in closed form */
    struct panels panels;
    real *time, *shift; /* at the panels' nodes */
    real *drive;        /* one mode's, where the load moves */
    real *rest[2];      /* the sums' rests: at the nodes where the load moves, else one */
    real (*slow)[4];    /* by times: y, z, G, G' of a G(t) that does not move */
    real (*state)[2];   /* one mode's */
    struct oracle_tip *sum;
};

static void make_solver(struct solver *s, size_t most)
{
    const struct oracle_problem *p = s->problem;
    const struct oracle_term *term = s->term;
    real fastest = (real)p->stiffness / (real)p->viscosity;
    if (term->moving)
        fastest = fmaxl(fastest, oracle_root(p->bending, most) / p->length *
                                     (fabs(term->speed) + fabs(term->swing * term->rate)));
    if (term->time.kind == ORACLE_WAVE)
        fastest = fmaxl(fastest, fabs(term->time.p[0]));
    s->by_steps = !term->moving && term->time.kind == ORACLE_STEPS;
    if (!s->by_steps)
        make_panels(&s->panels, term, p->length, (p->finer ? 1 : 2) / fastest, s->times, s->t);
    const size_t nodes = s->panels.count * NODES, rests = term->moving ? nodes : 1;
    s->time = calloc(nodes + 1, sizeof *s->time);
    s->shift = calloc(nodes + 1, sizeof *s->shift);
    s->drive = calloc(nodes + 1, sizeof *s->drive);
    s->rest[0] = calloc(rests, sizeof *s->rest[0]);
    s->rest[1] = calloc(rests, sizeof *s->rest[1]);
    s->slow = calloc(s->times, sizeof *s->slow);
    s->state = calloc(s->times, sizeof *s->state);
    s->sum = calloc(s->times, sizeof *s->sum);
    for (size_t i = 0; i < nodes; i++) {
        const size_t panel = i / NODES;
        const real length = s->panels.length[s->panels.class_of[panel]];
        const real t = s->panels.start[panel] + length * gauss.node[i % NODES];
        s->time[i] = oracle_value(&term->time, t);
        s->shift[i] = term->start + term->speed * t + term->swing * sinl(term->rate * t);
    }
}

static void clear_solver(struct solver *s)
{
    free_panels(&s->panels);
    free(s->time);
    free(s->shift);
    free(s->drive);
    free(s->rest[0]);
    free(s->rest[1]);
    free(s->slow);
    free(s->state);
    free(s->sum);
}

/* The load's part in a weight, where it does not move. */
static real part(const struct solver *s, const struct weight *w)
{
    const real length = s->problem->length;
    switch (s->term->place) {
    case ORACLE_FORCE:
        return weight_value(w, 1) / length;
    case ORACLE_MOMENT:
        return weight_slope(w) / (length * length);
    default:
        return spread(w, &s->term->space, 0, length);
    }
}

/* drive (out, nodes): the same over time, where it moves. */
static void moving_part(const struct solver *s, const struct weight *w, real *drive)
{
    for (size_t i = 0; i < s->panels.count * NODES; i++)
        drive[i] = s->time[i] * spread(w, &s->term->space, s->shift[i], s->problem->length);
}

/* y, z, G, G' (out) at the times of a G at the nodes. */
static void slow_response(const struct solver *s, const real *drive, real (*slow)[4])
{
    const struct equation e = slow_equation(s->problem);
    real(*state)[2] = calloc(s->times, sizeof *state);
    if (s->by_steps)
        respond_to_steps(&e, &s->term->time, s->times, s->t, state);
    else
        respond(&e, &s->panels, drive, s->times, state);
    for (size_t k = 0; k < s->times; k++) {
        real value = s->by_steps ? oracle_value(&s->term->time, s->t[k]) : 0, slope = 0;
        const size_t last = s->by_steps ? 0 : s->panels.reached[k] - 1;
        for (size_t j = 0; j < NODES && !s->by_steps; j++) {
            const real length = s->panels.length[s->panels.class_of[last]];
            value += gauss.end_value[j] * drive[last * NODES + j];
            slope += gauss.end_slope[j] * drive[last * NODES + j] * 2 / length;
        }
        slow[k][0] = state[k][0];
        slow[k][1] = state[k][1];
        slow[k][2] = value;
        slow[k][3] = slope;
    }
    free(state);
}

/* value (out): y, z (power 2 only: rho s^2 / k^2) of one time, and their derivatives. */
static void tail_terms(const struct oracle_problem *p, const real slow[4], int power, real value[2])
{
    const real a = p->stiffness, c = p->viscosity, y = slow[0], z = slow[1], g = slow[2];
    const real dy = (g - a * y) / c, dz = (y - a * z) / c;
    value[0] = power == 1 ? y : -(real)p->density * (g - 2 * a * y + a * a * z) / (c * c);
    value[1] = power == 1 ? dy : -(real)p->density * (slow[3] - 2 * a * dy + a * a * dz) / (c * c);
}

/* tip (out): the sums and the tail. */
static void finish(const struct solver *s, struct oracle_tip *tip)
{
    real(*slow)[4] = s->term->moving ? calloc(s->times, sizeof *slow) : s->slow;
    for (size_t k = 0; k < s->times; k++)
        tip[k] = s->sum[k];
    for (int power = 1; power <= 2; power++) {
        if (s->term->moving)
            slow_response(s, s->rest[power - 1], slow);
        for (size_t k = 0; k < s->times; k++) {
            const real rest = s->term->moving ? 1 : *s->rest[power - 1];
            real value[2];
            tail_terms(s->problem, slow[k], power, value);
            tip[k].displacement += rest * value[0];
            tip[k].velocity += rest * value[1];
        }
    }
    if (s->term->moving)
        free(slow);
}

static void begin(struct solver *s)
{
    const real scale = powl(s->problem->length, s->problem->bending ? 4 : 2);
    for (int power = 1; power <= 2; power++) {
        const struct weight w = {NULL, s->problem->bending, power};
        real *rest = s->rest[power - 1], factor = powl(scale, power);
        if (s->term->moving)
            moving_part(s, &w, rest);
        else
            *rest = part(s, &w);
        for (size_t i = 0; i < (s->term->moving ? s->panels.count * NODES : 1); i++)
            rest[i] *= factor;
    }
    if (!s->term->moving)
        slow_response(s, s->time, s->slow);
}

static void add_mode(struct solver *s, size_t i)
{
    const struct mode mode = make_mode(s->problem->bending, i);
    const struct weight w = {&mode, s->problem->bending, 0};
    const struct equation e = mode_equation(s->problem, mode.b);
    const real lambda = e.stiffness / (real)s->problem->stiffness, tip = mode_value(&mode, 1);
    const real p = s->term->moving ? 1 : part(s, &w);
    if (s->by_steps) {
        respond_to_steps(&e, &s->term->time, s->times, s->t, s->state);
    } else {
        if (s->term->moving)
            moving_part(s, &w, s->drive);
        respond(&e, &s->panels, s->term->moving ? s->drive : s->time, s->times, s->state);
    }
    for (size_t k = 0; k < s->times; k++) {
        s->sum[k].displacement += tip * p * s->state[k][0];
        s->sum[k].velocity += tip * p * s->state[k][1];
    }
    for (size_t j = 0; j < (s->term->moving ? s->panels.count * NODES : 1); j++) {
        const real q = s->term->moving ? s->drive[j] : p;
        s->rest[0][j] -= tip * q / lambda;
        s->rest[1][j] -= tip * q / (lambda * lambda);
    }
}

/* Whether the modes are enough; the errors are how far the last doubling has gone. */
static bool settled(size_t times, const struct oracle_tip *before, struct oracle_tip *tip)
{
    real most[2] = {0, 0}, error[2] = {0, 0};
    for (size_t k = 0; k < times; k++) {
        tip[k].displacement_error = fabsl(tip[k].displacement - before[k].displacement);
        tip[k].velocity_error = fabsl(tip[k].velocity - before[k].velocity);
        most[0] = fmaxl(most[0], fabsl(tip[k].displacement));
        most[1] = fmaxl(most[1], fabsl(tip[k].velocity));
        error[0] = fmaxl(error[0], tip[k].displacement_error);
        error[1] = fmaxl(error[1], tip[k].velocity_error);
    }
    return error[0] <= 1e-13L * most[0] && error[1] <= 1e-11L * most[1];
}

void oracle_term(const struct oracle_problem *problem, const struct oracle_term *term, size_t times,
                 const double *t, struct oracle_tip *tip)
{
    const size_t least = problem->finer ? 64 : 32;
    const size_t most = (term->moving ? 4 : problem->bending ? 8 : 32) * least;
    prepare_gauss();
    struct solver s = {.problem = problem, .term = term, .times = times, .t = t};
    make_solver(&s, most);
    struct oracle_tip *before = calloc(times, sizeof *before);
    begin(&s);
    size_t modes = 0;
    for (size_t goal = least; goal <= most; goal *= 2) {
        while (modes < goal)
            add_mode(&s, ++modes);
        for (size_t k = 0; k < times; k++)
            before[k] = tip[k];
        finish(&s, tip);
        if (settled(times, before, tip) && goal > least)
            break;
    }
    for (size_t k = 0; k < times; k++) {
        tip[k].displacement *= term->amplitude;
        tip[k].velocity *= term->amplitude;
        tip[k].displacement_error *= fabs(term->amplitude);
        tip[k].velocity_error *= fabs(term->amplitude);
    }
    free(before);
    clear_solver(&s);
}

void oracle_initial(const struct oracle_problem *problem, size_t times, const double *t,
                    struct oracle_tip *tip)
{
    const struct mode mode = make_mode(problem->bending, 1);
    const struct equation e = mode_equation(problem, mode.b);
    const real scale = mode_value(&mode, 1), given[] = {problem->displacement, problem->velocity};
    for (size_t k = 0; k < times; k++) {
        real carry[2][2], now[2];
        e.carry(&e, t[k], carry);
        for (int i = 0; i < 2; i++)
            now[i] = scale * (carry[i][0] * given[0] + carry[i][1] * given[1]);
        tip[k] = (struct oracle_tip){.displacement = now[0], .velocity = now[1]};
    }
}
