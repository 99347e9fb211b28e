/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/linear/plain.h"

#include <math.h>

#include "solver/instruction_set.h"
#include "solver/linear/block.h"

#define INLINE static inline __attribute__((always_inline))

INLINE int gain_size(int d, int m)
{
    return d * d + m * d + m * m + m;
}

/* G of a beam. For a rod G and T are 1 for the elongation, and G is 0 for the bubble. */
static const real g[2][2] = {{(real)0.5, (real)(-1.0L / 6)}, {1, 0}};

/* Row a of G kappa. */
INLINE real control(int d, int a, const real *kappa)
{
    return d == 1 ? kappa[0] : a == 1 ? kappa[0] : g[0][0] * kappa[0] + g[0][1] * kappa[1];
}

/* y = T y + G kappa: from an element's left node to its right one. */
INLINE void cross(int d, const real *kappa, real *y)
{
    y[0] += d == 2 ? y[1] + control(d, 0, kappa) : control(d, 0, kappa);
    if (d == 2)
        y[1] += control(d, 1, kappa);
}

/* Row c of G'p; for a rod the first. */
INLINE real transposed_control(int d, int c, const real *p)
{
    return d == 2 ? g[0][c] * p[0] + g[1][c] * p[1] : p[0];
}

/* ---- tables ---- */

void br_recursion_take(struct br_recursion *s, struct br_store *store)
{
    s->gain = br_store_take(store, s->n * (size_t)gain_size(s->d, s->m), sizeof *s->gain);
    s->drive = br_store_take(store, s->n * (size_t)s->m, sizeof *s->drive);
}

/* The Riccati recursion, from the tip to the clamp. */
struct riccati {
    wide mass, r[2];            /* rho h / k; R */
    struct block p;             /* P */
    wide influence[2];          /* pi */
    wide compliance;            /* sum of zeta'S zeta so far */
    struct block a, k, inverse; /* out, of the current element: A, K, S^-1 */
    wide zeta[2];               /* zeta */
};

/* Each of these turns P_{i+1} and pi_{i+1} into P_i and pi_i; false where S is not positive
 * definite.
 *
 * The rod, of mass m [2 1; 1 2]: Q = 2m + P, S = R + Q, H = Q + m; P = 2m + 2mA + QA^2 + RK^2. */
static bool rod_gain(struct riccati *rec)
{
    const wide m = rec->mass / 6, r = rec->r[0], q = 2 * m + rec->p.e[0][0], s = r + q;
    if (!(s > 0 && isfinite(s)))
        return false;
    const wide feedback = (q + m) / s, closed = (r - m) / s; /* 1 - K */
    rec->zeta[0] = rec->influence[0] / s;
    rec->compliance += rec->zeta[0] * rec->influence[0];
    rec->influence[0] *= closed;
    rec->p.e[0][0] = 2 * m + 2 * m * closed + q * closed * closed + r * feedback * feedback;
    rec->a.e[0][0] = closed;
    rec->k.e[0][0] = feedback;
    rec->inverse.e[0][0] = 1 / s;
    return true;
}

/* (1 -K') N (1 -K')' for m times the mass N of a quadratic element, without cancellation: it is the
 * sum of the squared Legendre modes of the function with nodal values 1 and A and the bubble -K_1.
 */
static wide mass_square(wide m, wide closed, wide elongation, wide bubble)
{
    const wide mean = (1 + closed) / 2 - bubble / 6;
    return m * (mean * mean + elongation * elongation / 12 + bubble * bubble / 180);
}

/* S = R + N_kk + G'PG, H = N_ky + G'PT, P_i = (1 -K') N (1 -K')' + K'RK + A'PA. */
static bool quadratic_gain(struct riccati *rec)
{
    const wide m = rec->mass, *r = rec->r, p = rec->p.e[0][0];
    const struct block s = {{{r[0] + m / 3 + p, -m / 12}, {-m / 12, r[1] + m / 30}}};
    const struct block h = {{{m / 2 + p}, {-m / 6}}};
    if (!is_positive_definite(s))
        return false;
    rec->inverse = inverse_of(s);
    rec->k = times(rec->inverse, h);
    const wide k0 = rec->k.e[0][0], k1 = rec->k.e[1][0];
    /* 1 - K_0, in which P cancels */
    const wide closed = (r[0] * r[1] + m * (r[0] / 30 - r[1] / 6) + m * m / 720) / determinant(s);
    rec->p.e[0][0] =
        mass_square(m, closed, k0, -k1) + r[0] * k0 * k0 + r[1] * k1 * k1 + closed * closed * p;
    for (int c = 0; c < 2; c++)
        rec->zeta[c] = rec->inverse.e[c][0] * rec->influence[0];
    rec->compliance += rec->zeta[0] * rec->influence[0];
    rec->influence[0] *= closed;
    rec->a.e[0][0] = closed;
    return true;
}

/* The 2 by 2 block of rho h / k times the beam's element mass that starts at (row, column). */
static struct block mass_block(wide mass, int row, int column)
{
    struct block m;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            m.e[i][j] = mass * (real)(roundl(420 * br_bending_mass[row + i][column + j]) / 420);
    return m;
}

/* zeta = S^-1 G'pi;  z += zeta'S zeta = zeta'G'pi;  pi = A'pi. */
static void beam_influence(struct riccati *rec)
{
    const wide pi[2] = {rec->influence[0], rec->influence[1]};
    const wide q[2] = {0.5L * pi[0] + pi[1], -pi[0] / 6};
    for (int c = 0; c < 2; c++) {
        rec->zeta[c] = rec->inverse.e[c][0] * q[0] + rec->inverse.e[c][1] * q[1];
        rec->influence[c] = rec->a.e[0][c] * pi[0] + rec->a.e[1][c] * pi[1];
    }
    rec->compliance += rec->zeta[0] * q[0] + rec->zeta[1] * q[1];
}

static bool beam_gain(struct riccati *rec)
{
    static const struct block t = {{{1, 1}, {0, 1}}}, control = {{{0.5L, -1.0L / 6}, {1, 0}}},
                              minus_control = {{{-0.5L, 1.0L / 6}, {-1, 0}}};
    const struct block maa = mass_block(rec->mass, 0, 0), mab = mass_block(rec->mass, 0, 2);
    const struct block q = plus(mass_block(rec->mass, 2, 2), rec->p), gt = transpose(control);
    struct block s = times(gt, times(q, control)); /* S = R + G'QG */
    for (int c = 0; c < 2; c++)
        s.e[c][c] += rec->r[c];
    if (!is_positive_definite(s))
        return false;
    rec->inverse = inverse_of(s);
    const struct block h = times(gt, plus(times(q, t), transpose(mab))); /* H = G'(QT + Mab') */
    const struct block k = times(rec->inverse, h);                       /* K = S^-1 H */
    const struct block a = plus(t, times(minus_control, k));             /* A = T - GK */
    struct block rk = k;
    for (int j = 0; j < 2; j++)
        for (int c = 0; c < 2; c++)
            rk.e[c][j] *= rec->r[c];
    /* P = Maa + Mab A + (Mab A)' + A'QA + K'RK */
    const struct block ma = times(mab, a), aqa = times(transpose(a), times(q, a));
    rec->p = plus(plus(plus(plus(maa, ma), transpose(ma)), aqa), times(transpose(k), rk));
    rec->a = a;
    rec->k = k;
    beam_influence(rec);
    return true;
}

static void put(int rows, int columns, const struct block *from, real **to)
{
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < columns; j++)
            *(*to)++ = (real)from->e[i][j];
}

enum br_status br_recursion_fill(struct br_recursion *s, const char *who, struct br_error *err)
{
    const bool axial = s->d == 1, quadratic = s->m > s->d;
    const wide h = s->h, stiff = (wide)s->viscosity + (wide)s->k * s->stiffness;
    const wide volume = axial ? h : h * h * h;
    struct riccati rec = {.mass = (wide)s->density * h / s->k,
                          .r = {stiff / volume, axial ? stiff / h / 3 : stiff / (3 * h * h * h)},
                          .influence = {1, 0}};
    for (size_t i = s->n; i-- > 0;) {
        if (!(quadratic ? quadratic_gain : axial ? rod_gain : beam_gain)(&rec))
            return br_fail(err, BR_SINGULAR,
                           "%s: the step is not positive definite at element %zu of %zu", who, i,
                           s->n);
        real *gain = s->gain + i * (size_t)gain_size(s->d, s->m);
        put(s->d, s->d, &rec.a, &gain);
        put(s->m, s->d, &rec.k, &gain);
        put(s->m, s->m, &rec.inverse, &gain);
        for (int c = 0; c < s->m; c++)
            *gain++ = (real)rec.zeta[c];
    }
    s->alpha = quadratic ? (real)(s->stiffness / stiff)
                         : s->stiffness / (s->viscosity + s->k * s->stiffness);
    for (int c = 0; c < 2; c++)
        s->r[c] = (real)rec.r[c];
    s->compliance = (real)rec.compliance;
    return BR_OK;
}

/* ---- a step ---- */

/* Backward sweep: drive = S^-1 s on every element. Returns v*. */
INLINE real sweep_left(int d, int m, struct br_recursion *s, const real *state,
                       const struct br_drive *by)
{
    static const double none[4] = {0};
    const size_t n = s->n, stride = by->vector ? (size_t)m : 0;
    const double *load = by->vector ? by->vector : none;
    const real factor = by->factor, alpha = s->alpha, r[2] = {s->r[0], s->r[1]};
    const real *restrict gain = s->gain;
    real *restrict out = s->drive;
    real p[2], tip[2] = {0};
    for (int a = 0; a < d; a++)
        p[a] = -factor * load[stride * n + (size_t)a] - by->tip[a];
    for (size_t i = n; i-- > 0;) {
        const real *closed = gain + i * (size_t)gain_size(d, m), *feedback = closed + d * d;
        const real *inverse = feedback + m * d, *zeta = inverse + m * m;
        const real *e = state + 2 * (size_t)m * i;
        real rg[2], x[2], next[2];
        for (int c = 0; c < m; c++)
            rg[c] = r[c] * (alpha * e[c] + e[m + c]); /* R g */
        if (m > d)
            rg[1] -= factor * load[stride * (i + 1) + 1];
        for (int c = 0; c < m; c++) /* s = R g + G'p */
            x[c] = d == 1 && c == 1 ? rg[c] : rg[c] + transposed_control(d, c, p);
        for (int c = 0; c < m; c++) { /* S^-1 s */
            real sum = inverse[c] * x[0];
            if (m == 2)
                sum += inverse[m + c] * x[1];
            out[(size_t)m * i + (size_t)c] = sum;
        }
        if (d < m) /* - zeta's */
            tip[0] -= zeta[0] * x[0] + zeta[1] * x[1];
        else
            for (int c = 0; c < m; c++)
                tip[c] -= zeta[c] * x[c];
        for (int a = 0; a < d; a++) { /* A'p - (K'R g + F) */
            real sum = feedback[a] * rg[0];
            if (m == 2)
                sum += feedback[d + a] * rg[1];
            next[a] = -(sum + factor * load[stride * i + (size_t)a]);
            for (int j = 0; j < d; j++)
                next[a] += closed[j * d + a] * p[j];
        }
        for (int a = 0; a < d; a++)
            p[a] = next[a];
    }
    return state[2 * (size_t)m * n + (size_t)m] + (tip[0] + tip[1]);
}

/* Forward sweep: the increment kappa of every element's rate, with the tip's force in it, and the
 * update of the state. The tip's motion is summed from the strains: a motion that is only
 * incremented would drift. */
INLINE void sweep_right(int d, int m, struct br_recursion *s, real *state, real force)
{
    const size_t n = s->n;
    const real k = s->k;
    real y[2] = {0}, u[2] = {0}, v[2] = {0}; /* at the node: of increment, displacement, velocity */
    const real *restrict gain = s->gain, *restrict drive = s->drive;
    real *restrict e = state;
    for (size_t i = 0; i < n; i++, e += 2 * m) {
        const real *closed = gain + i * (size_t)gain_size(d, m), *feedback = closed + d * d;
        const real *zeta = feedback + m * d + m * m;
        real q[2], next[2];
        for (int c = 0; c < m; c++)
            q[c] = -(drive[(size_t)m * i + (size_t)c] + force * zeta[c]);
        for (int a = 0; a < d; a++) { /* A y - G S^-1 s */
            next[a] = control(d, a, q);
            for (int j = 0; j < d; j++)
                next[a] += closed[a * d + j] * y[j];
        }
        for (int c = 0; c < m; c++) { /* kappa = -(K y + S^-1 s) */
            for (int j = 0; j < d; j++)
                q[c] -= feedback[c * d + j] * y[j];
            e[m + c] += q[c];
            e[c] += k * e[m + c];
        }
        for (int a = 0; a < d; a++)
            y[a] = next[a];
        if (d == 1) /* the laws do not need that of a beam */
            cross(d, e, u);
        cross(d, e + m, v);
    }
    e[0] = u[0];
    e[m] = v[0];
}

/* Both sweeps, with constants d and m. Functions with copies are static, since Clang 14 gives
 * others no name that other files see. */

BR_SWEEP
static real predict(struct br_recursion *s, const real *state, const struct br_drive *by)
{
    return s->d == 2   ? sweep_left(2, 2, s, state, by)
           : s->m == 2 ? sweep_left(1, 2, s, state, by)
                       : sweep_left(1, 1, s, state, by);
}

BR_SWEEP
static void finish(struct br_recursion *s, real *state, real force)
{
    if (s->d == 2)
        sweep_right(2, 2, s, state, force);
    else if (s->m == 2)
        sweep_right(1, 2, s, state, force);
    else
        sweep_right(1, 1, s, state, force);
}

real br_recursion_predict(struct br_recursion *s, const real *state, const struct br_drive *by)
{
    return predict(s, state, by);
}

real br_recursion_finish(struct br_recursion *s, real *state, real force)
{
    finish(s, state, force);
    return state[br_recursion_tip_rate(s)];
}

/* ---- states ---- */

real br_recursion_tip(const struct br_recursion *s, const real *state)
{
    const size_t m = (size_t)s->m;
    if (s->d == 1)
        return state[2 * m * s->n];
    real w[2] = {0};
    for (size_t i = 0; i < s->n; i++)
        cross(2, state + 2 * m * i, w);
    return w[0];
}

void br_recursion_set(const struct br_recursion *s, const double *displacement,
                      const double *velocity, real *state)
{
    const double *const nodal[2] = {displacement, velocity};
    const size_t m = (size_t)s->m, n = s->n;
    for (size_t j = 0; j < 2; j++) {
        for (size_t i = 0; i < n; i++) { /* the controls of an element, from its nodes */
            real node[4], *kappa = state + (2 * i + j) * m;
            for (size_t a = 0; a < 2 * m; a++)
                node[a] = nodal[j][m * i + a];
            kappa[0] = s->d == 2 ? node[3] - node[1] : node[m] - node[0];
            if (m == 2)
                kappa[1] = s->d == 2 ? 3 * (node[1] + node[3]) - 6 * (node[2] - node[0]) : node[3];
        }
        for (size_t a = 0; a < m; a++)
            state[(2 * n + j) * m + a] = nodal[j][m * n + a];
    }
}

void br_recursion_get(const struct br_recursion *s, const real *state, double *displacement,
                      double *velocity)
{
    double *const nodal[2] = {displacement, velocity};
    const size_t m = (size_t)s->m;
    for (size_t j = 0; j < 2; j++) {
        real y[2] = {0};
        double *to = nodal[j];
        for (size_t a = 0; to && a < m; a++)
            *to++ = 0;
        for (size_t i = 0; to && i < s->n; i++) {
            const real *kappa = state + (2 * i + j) * m;
            cross(s->d, kappa, y);
            if (s->m > s->d)
                y[1] = kappa[1];
            for (size_t a = 0; a < m; a++)
                *to++ = (double)y[a];
        }
    }
}
