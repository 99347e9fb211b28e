/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Eigenfunctions, and what loads in space do to them. */
#include <assert.h>
#include <math.h>

#include "tests/modal_oracle.h"

static const real pi = 3.14159265358979323846264338327950288L;
static const real root2 = 1.41421356237309504880168872420969808L;

/* ---- Gauss-Legendre on [0, 1] ---- */

enum { NODES = ORACLE_NODES };

static struct oracle_gauss gauss;

void oracle_legendre(real u, real p[NODES + 1])
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
        oracle_legendre((1 + y) / 2, p);
        slope = NODES * (p[NODES - 1] - y * p[NODES]) / (1 - y * y);
        y -= p[NODES] / slope;
    }
    gauss.node[j] = (1 + y) / 2;
    gauss.weight[j] = 1 / ((1 - y * y) * slope * slope);
    oracle_legendre(gauss.node[j], p);
    gauss.end_value[j] = gauss.end_slope[j] = 0;
    for (int k = 0; k < NODES; k++) {
        gauss.legendre[k][j] = p[k];
        gauss.end_value[j] += gauss.weight[j] * (2 * k + 1) * p[k];
        gauss.end_slope[j] += gauss.weight[j] * (2 * k + 1) * p[k] * k * (k + 1);
    }
}

const struct oracle_gauss *oracle_gauss(void)
{
    static bool ready;
    for (int j = 0; j < NODES && !ready; j++)
        find_node(j);
    ready = true;
    return &gauss;
}

/* ---- eigenfunctions on [0, 1], their mean square is 1 ---- */

real oracle_root(bool bending, size_t i)
{
    real b = ((real)i - 0.5L) * pi;
    for (int k = 0; bending && k < 60; k++) {
        const real e = expl(-b), sech = 2 * e / (1 + e * e);
        b -= (cosl(b) + sech) / (-sinl(b) - sech * (1 - e * e) / (1 + e * e));
    }
    return b;
}

struct oracle_mode oracle_mode(bool bending, size_t i)
{
    struct oracle_mode m = {.bending = bending, .b = oracle_root(bending, i)};
    const real e = expl(-m.b), s = sinl(m.b), c = cosl(m.b), below = 1 - e * e + 2 * e * s;
    m.sine = (1 + e * e + 2 * e * c) / below;
    m.start = (1 + m.sine) / 2;
    m.end = (s - c - e) / below;
    return m;
}

/* Whether a beam's mode is so close to the clamp that its parts cancel. */
static bool is_at_clamp(const struct oracle_mode *m, real x)
{
    return m->bending && m->b * x < 1;
}

/* cosh y - cos y - sine (sinh y - sin y) by its series. */
static real value_at_clamp(const struct oracle_mode *m, real y)
{
    real sum = 0, power = y * y; /* y^k / k!, twice */
    for (int k = 2; k < 26; k += 4) {
        sum += power * (1 - m->sine * y / (k + 1));
        power *= y * y * y * y / (real)((k + 1) * (k + 2) * (k + 3) * (k + 4));
    }
    return sum;
}

real oracle_mode_value(const struct oracle_mode *m, real x)
{
    if (!m->bending)
        return root2 * sinl(m->b * x);
    if (is_at_clamp(m, x))
        return value_at_clamp(m, m->b * x);
    return m->start * expl(-m->b * x) + m->end * expl(-m->b * (1 - x)) - cosl(m->b * x) +
           m->sine * sinl(m->b * x);
}

/* The derivative at x = 1. */
static real mode_slope(const struct oracle_mode *m)
{
    if (!m->bending)
        return root2 * m->b * cosl(m->b);
    return m->b * (m->end - m->start * expl(-m->b) + sinl(m->b) + m->sine * cosl(m->b));
}

/* The integral from x0 to x1, without cancellation where they are close. */
static real mode_integral(const struct oracle_mode *m, real x0, real x1)
{
    const real b = m->b, middle = b * (x0 + x1) / 2, sine = 2 * sinl(b * (x1 - x0) / 2) / b;
    if (!m->bending)
        return root2 * sinl(middle) * sine;
    const real decay = -expm1l(-b * (x1 - x0)) / b;
    return m->start * expl(-b * x0) * decay + m->end * expl(-b * (1 - x1)) * decay -
           cosl(middle) * sine + m->sine * sinl(middle) * sine;
}

/* ---- what a load is weighted with ---- */

real oracle_weight_value(const struct oracle_weight *w, real x)
{
    if (w->mode)
        return oracle_mode_value(w->mode, x);
    if (!w->bending)
        return w->power == 1 ? x : x / 2 - x * x * x / 6;
    if (w->power == 1)
        return x * x * (3 - x) / 6;
    const real x2 = x * x;
    return x2 * (11.0L / 240 - x / 48 + x2 * x2 * (1.0L / 720 - x / 5040));
}

real oracle_weight_slope(const struct oracle_weight *w)
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

static bool is_narrow(const struct oracle_factor *f)
{
    return f->kind == ORACLE_GAUSS || f->kind == ORACLE_HAT;
}

/* A narrow factor at its middle + y of its widths. */
static real narrow_value(const struct oracle_factor *f, real y)
{
    return f->kind == ORACLE_GAUSS ? expl(-y * y) : fmaxl(0, 1 - fabsl(y));
}

real oracle_value(const struct oracle_factor *f, real s)
{
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
    default:
        return narrow_value(f, (s - f->p[0]) / f->p[1]);
    }
}

size_t oracle_edges(const struct oracle_factor *f, real edge[ORACLE_EDGES])
{
    const int half = f->kind == ORACLE_GAUSS ? ORACLE_EDGES / 2 : f->kind == ORACLE_HAT ? 1 : -1;
    for (int i = -half; i <= half; i++)
        edge[half + i] = f->p[0] + i * (real)f->p[1];
    return half < 0 ? 0 : (size_t)(2 * half + 1);
}

/* ---- integrals of a load over the beam ---- */

/* The integral of a factor of x - shift times the weight from x0 to x1, in units of the length; of
 * a narrow factor from its middle + x0 to its middle + x1 of its widths, for x itself has lost
 * digits of the distance from the middle. */
static real smooth_piece(const struct oracle_weight *w, const struct oracle_factor *f,
                         const real shift[2], real x0, real x1)
{
    const bool narrow = is_narrow(f);
    const real middle = narrow ? (shift[0] + f->p[0]) / shift[1] : 0;
    const real unit = narrow ? f->p[1] / shift[1] : 1;
    const real wave = f->kind == ORACLE_WAVE ? (real)f->p[0] * shift[1] : 0;
    const real angle = (x1 - x0) * unit * fmaxl(w->mode ? w->mode->b : 0, fabsl(wave));
    const size_t parts = 1 + (size_t)(angle / 12);
    const real width = (x1 - x0) / (real)parts;
    const struct oracle_gauss *g = oracle_gauss();
    real sum = 0;
    for (size_t i = 0; i < parts; i++)
        for (int j = 0; j < NODES; j++) {
            const real x = x0 + width * ((real)i + g->node[j]);
            sum += g->weight[j] * width * unit * oracle_weight_value(w, middle + unit * x) *
                   (narrow ? narrow_value(f, x) : oracle_value(f, x * shift[1] - shift[0]));
        }
    return sum;
}

static real step_piece(const struct oracle_weight *w, real x0, real x1)
{
    static const struct oracle_factor one = {.kind = ORACLE_POWER};
    const real none[] = {0, 1};
    return w->mode && !is_at_clamp(w->mode, x1) ? mode_integral(w->mode, x0, x1)
                                                : smooth_piece(w, &one, none, x0, x1);
}

/* The integral of exp(-((x - s) / w)^2) times a mode over the whole line: the beam's, where the
 * blow is inside. */
static real whole_gauss(const struct oracle_mode *m, real s, real w)
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

real oracle_spread(const struct oracle_weight *w, const struct oracle_factor *f, real shift,
                   real length)
{
    const real by[] = {shift, length};
    real sum = 0, level = 0, edge[ORACLE_EDGES];
    for (size_t i = 0; f->kind == ORACLE_STEPS && i < f->steps; i++) {
        level += f->step[i].height;
        const real x = clipped((shift + f->step[i].at) / length);
        const real next = i + 1 < f->steps ? clipped((shift + f->step[i + 1].at) / length) : 1;
        sum += next > x && level != 0 ? level * step_piece(w, x, next) : 0;
    }
    if (f->kind == ORACLE_STEPS)
        return sum;
    const size_t edges = oracle_edges(f, edge);
    if (f->kind == ORACLE_GAUSS && w->mode && w->mode->b * f->p[1] <= 12 * length &&
        !is_at_clamp(w->mode, (shift + f->p[0]) / length) && shift + edge[0] >= 0 &&
        shift + edge[edges - 1] <= length)
        return whole_gauss(w->mode, (shift + f->p[0]) / length, f->p[1] / length);
    if (!edges)
        return smooth_piece(w, f, by, 0, 1);
    const real low = -(shift + f->p[0]) / f->p[1], high = low + length / f->p[1];
    for (size_t i = 0; i + 1 < edges; i++) { /* nothing is left outside of the edges */
        const real y = (real)i - (real)(edges / 2), y0 = fmaxl(y, low), y1 = fminl(y + 1, high);
        sum += y1 > y0 ? smooth_piece(w, f, by, y0, y1) : 0;
    }
    return sum;
}
