/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A step of the pieces of a strip, element by element, and the kernel that it makes with
 * sweep_ends.c. */
#include "solver/linear/riccati/sweep_lanes.h"

/* ---- an element ---- */

/* s = g + G'p,    p = A'p - K'g - F, for -F */
INLINE void element_left(int d, const double *gain, const vec *g, const vec *minus_f, vec *p,
                         vec *s)
{
    vec next[2];
    s[0] = d == 1 ? g[0] + p[0] : (g[0] + p[1]) + half * p[0];
    if (d == 2)
        s[1] = g[1] - lever * p[0];
    for (int i = 0; i < d; i++)
        next[i] = minus_f[i];
    subtract_transposed(d, gain, g, next);
    add_transposed(d, gain + 2 * d * d, p, next);
    for (int i = 0; i < d; i++)
        p[i] = next[i];
}

/* kappa = -(K y + S^-1 s), and y goes on */
INLINE void element_right(int d, const double *gain, const vec *s, vec *y, vec *kappa)
{
    for (int i = 0; i < d; i++)
        kappa[i] = (vec){0};
    subtract(d, gain + d * d, s, kappa);
    subtract(d, gain, y, kappa);
    pass_on(d, kappa, y);
}

/* The state after the step. */
INLINE void element_state(int d, double k, const vec *kappa, vec *w, vec *v)
{
    for (int i = 0; i < d; i++) {
        v[i] += kappa[i];
        w[i] += k * v[i];
    }
}

/* g = alpha w + v */
INLINE void strain(int d, double alpha, const vec *w, const vec *v, vec *g)
{
    for (int i = 0; i < d; i++)
        g[i] = alpha * w[i] + v[i];
}

/* ---- a piece ---- */

/* Costates p to the left, s into the scratch; minus_f: the load that is the same everywhere. */
INLINE void piece_left(int d, int vectors, bool loaded, const struct br_strip *s,
                       const struct piece *at, const vec *minus_f, double factor, vec p[VECTORS][2])
{
    const size_t entry = (size_t)d * BR_LANES;
    for (size_t e = s->length; e-- > 0;)
#pragma GCC unroll 2
        for (int v = 0; v < vectors; v++) {
            const double *state = at->state + e * 2 * entry + v * WIDTH;
            vec w[2], rate[2], g[2], sum[2], f[2];
            load_all(d, state, w);
            load_all(d, state + entry, rate);
            strain(d, s->alpha, w, rate, g);
            for (int i = 0; i < d; i++)
                f[i] = minus_f[i];
            if (loaded) {
                load_all(d, at->load + e * entry + v * WIDTH, f);
                for (int i = 0; i < d; i++)
                    f[i] *= -factor;
            }
            element_left(d, s->gain + e * (size_t)(3 * d * d), g, f, p[v], sum);
            store_all(d, sum, s->scratch + e * entry + v * WIDTH);
        }
}

/* What goes from piece to piece along a span, for one vector. */
struct along {
    vec y[2], velocity[2], displacement;
};

/* Increments y to the right, the new state, and what it adds to z and q. The lines of the piece
 * that comes next are asked for meanwhile. */
INLINE void piece_right(int d, int vectors, const struct br_strip *s, const struct piece *at,
                        struct along *go)
{
    const size_t entry = (size_t)d * BR_LANES;
    vec z[VECTORS][2], q[VECTORS][2];
    for (int v = 0; v < vectors; v++)
        for (int i = 0; i < d; i++)
            z[v][i] = q[v][i] = (vec){0};
    const double *next = at->state + s->length * 4 * entry; /* its right end is wanted first */
    for (size_t e = 0; e < s->length; e++) {
        next -= 2 * entry;
#pragma GCC unroll 2
        for (int v = 0; v < vectors; v++) {
            const double *gain = s->gain + e * (size_t)(3 * d * d);
            const double *weight = s->weight + e * (size_t)(2 * d * d);
            double *state = at->state + e * 2 * entry + v * WIDTH;
            vec w[2], rate[2], g[2], sum[2], kappa[2];
            load_all(d, s->scratch + e * entry + v * WIDTH, sum);
            load_all(d, state, w);
            load_all(d, state + entry, rate);
            for (int i = 0; i < 2 * d; i++)
                __builtin_prefetch(next + v * WIDTH + i * BR_LANES);
            element_right(d, gain, sum, go[v].y, kappa);
            element_state(d, s->k, kappa, w, rate);
            store_all(d, w, state);
            store_all(d, rate, state + entry);
            pass_on(d, rate, go[v].velocity);
            if (d == 1)
                go[v].displacement += w[0];
            strain(d, s->alpha, w, rate, g);
            add(d, weight, g, z[v]);
            add(d, weight + d * d, g, q[v]);
        }
    }
    for (int v = 0; v < vectors; v++) {
        store_all(d, z[v], at->end + BR_END_Z * entry + v * WIDTH);
        store_all(d, q[v], at->end + BR_END_Q * entry + v * WIDTH);
    }
}

/* ---- spans ---- */

/* The increment at a piece's right end, and the costate there. */
INLINE void cross(int d, const double *join, const double *end, const vec *right, vec *y,
                  vec *costate)
{
    const int entry = d * BR_LANES;
    vec h[2], drift[2], next[2], yield[2];
    load_all(d, end + BR_END_H * entry, h);
    load_all(d, end + BR_END_DRIFT * entry, drift);
    add(d, join + BR_JOIN_REACH * d * d, right, h);
    for (int i = 0; i < d; i++)
        next[i] = yield[i] = (vec){0};
    add(d, join + BR_JOIN_YIELD * d * d, h, yield);
    add(d, join + BR_JOIN_GAIN * d * d, drift, next);
    for (int i = 0; i < d; i++)
        next[i] -= yield[i];
    add(d, join + BR_JOIN_PASS * d * d, y, next);
    add(d, join + BR_JOIN_COSTATE * d * d, next, h);
    for (int i = 0; i < d; i++) {
        y[i] = next[i];
        costate[i] = h[i];
    }
}

INLINE void start(int d, size_t lane, const double *left, struct along *go)
{
    load_all(d, left + lane, go->y);
    for (int i = 0; i < d; i++)
        go->velocity[i] = (vec){0};
    go->displacement = (vec){0};
}

INLINE void advance_of(int d, int vectors, bool loaded, const struct br_strip *strip,
                       const struct br_strip_drive *drive, const struct br_strip_ends *ends)
{
    const struct br_strip s = *strip; /* nothing aliases it */
    const double factor = drive->factor;
    vec minus_f[2];
    for (int i = 0; i < d; i++)
        minus_f[i] = -factor * drive->uniform[i] - (vec){0};
    for (size_t lane = 0; lane < s.lanes; lane += GO) {
        struct along go[VECTORS];
        vec y[VECTORS][2], right[VECTORS][2];
        for (int v = 0; v < vectors; v++) {
            start(d, lane + (size_t)(v * WIDTH), ends->left, &go[v]);
            load_all(d, ends->right + lane + v * WIDTH, right[v]);
            for (int i = 0; i < d; i++)
                y[v][i] = go[v].y[i];
        }
        for (size_t j = 0; j < s.pieces; j++) {
            const struct piece at = piece_at(d, &s, j, lane);
            vec p[VECTORS][2];
            for (int i = 0; i < BR_ENDS * d; i++)
                __builtin_prefetch(at.end + (BR_ENDS * d + i) * BR_LANES);
            for (int v = 0; v < vectors; v++) {
                for (int i = 0; i < d; i++)
                    go[v].y[i] = y[v][i]; /* as the joins have it */
                cross(d, join_of(d, &s, j), at.end + v * WIDTH, right[v], y[v], p[v]);
            }
            piece_left(d, vectors, loaded, &s, &at, minus_f, factor, p);
            piece_right(d, vectors, &s, &at, go);
        }
        for (int v = 0; v < vectors; v++) {
            store_all(d, go[v].velocity, ends->velocity + lane + v * WIDTH);
            if (d == 1)
                store(go[v].displacement, ends->displacement + lane + v * WIDTH);
        }
    }
}

/* z and q of a state that no step has led to: the sum of others, or with none its own. */
INLINE void blend_piece(int d, const struct br_strip *s, const struct piece *at, size_t count,
                        const double *const *from, const double *weight)
{
    const size_t entry = (size_t)d * BR_LANES;
    const ptrdiff_t offset = at->state - s->state;
    vec z[2] = {{0}}, q[2] = {{0}};
    for (size_t e = 0; e < s->length; e++) {
        const double *weights = s->weight + e * (size_t)(2 * d * d);
        double *state = at->state + e * 2 * entry;
        const size_t place = (size_t)offset + e * 2 * entry;
        vec w[2] = {{0}}, rate[2] = {{0}}, g[2];
        for (size_t j = 0; j < count; j++)
            for (int i = 0; i < d; i++) {
                w[i] += weight[j] * load(from[j] + place + i * BR_LANES);
                rate[i] += weight[j] * load(from[j] + place + entry + i * BR_LANES);
            }
        if (count > 0) {
            store_all(d, w, state);
            store_all(d, rate, state + entry);
        } else {
            load_all(d, state, w);
            load_all(d, state + entry, rate);
        }
        strain(d, s->alpha, w, rate, g);
        add(d, weights, g, z);
        add(d, weights + d * d, g, q);
    }
    store_all(d, z, at->end + BR_END_Z * entry);
    store_all(d, q, at->end + BR_END_Q * entry);
}

INLINE void blend_of(int d, const struct br_strip *strip, size_t count, const double *const *from,
                     const double *weight)
{
    const struct br_strip s = *strip; /* nothing aliases it */
    for (size_t j = 0; j < s.pieces; j++)
        for (size_t lane = 0; lane < s.lanes; lane += WIDTH) {
            const struct piece at = piece_at(d, &s, j, lane);
            blend_piece(d, &s, &at, count, from, weight);
        }
}

INLINE void square_of(int d, const struct br_strip *s, const double *state, double total[2])
{
    const size_t entry = (size_t)d * BR_LANES, length = s->pieces * s->length;
    _Alignas(64) double sum[2][BR_LANES] = {{0}};
    for (size_t lane = 0; lane < s->lanes; lane += WIDTH) {
        vec of[2] = {{0}};
        for (size_t e = 0; e < length; e++)
            for (int part = 0; part < 2; part++)
                for (int i = 0; i < d; i++) {
                    const vec x =
                        load(state + (2 * e + (size_t)part) * entry + i * BR_LANES + lane);
                    of[part] += x * x;
                }
        store(of[0], sum[0] + lane);
        store(of[1], sum[1] + lane);
    }
    for (size_t lane = 0; lane < s->lanes; lane++)
        for (int part = 0; part < 2; part++)
            total[part] += sum[part][lane];
}

/* The recursions with no state. */
INLINE void charge_of(int d, const struct br_strip *s, const double *uniform, size_t j, size_t lane)
{
    const size_t entry = (size_t)d * BR_LANES;
    const struct piece at = piece_at(d, s, j, lane);
    const vec g[2] = {{0}};
    vec p[2] = {{0}}, y[2] = {{0}}, sum[2], kappa[2], f[2];
    for (int i = 0; i < d; i++)
        f[i] = -uniform[i] - (vec){0};
    for (size_t e = s->length; e-- > 0;) {
        if (at.load)
            load_all(d, at.load + e * entry, f);
        for (int i = 0; i < d && at.load; i++)
            f[i] = -f[i];
        element_left(d, s->gain + e * (size_t)(3 * d * d), g, f, p, sum);
        store_all(d, sum, s->scratch + e * entry);
    }
    for (size_t e = 0; e < s->length; e++) {
        load_all(d, s->scratch + e * entry, sum);
        element_right(d, s->gain + e * (size_t)(3 * d * d), sum, y, kappa);
    }
    store_all(d, p, at.end + BR_END_LOAD_Q * entry);
    store_all(d, y, at.end + BR_END_LOAD_Z * entry);
}

/* ---- the kernel: d becomes a constant ---- */

/* The odd rest, one lane, has no use for a second vector. */
INLINE void advance_lanes(int d, bool loaded, const struct br_strip *s,
                          const struct br_strip_drive *drive, const struct br_strip_ends *ends)
{
    if (s->lanes == 1)
        advance_of(d, 1, loaded, s, drive, ends);
    else
        advance_of(d, VECTORS, loaded, s, drive, ends);
}

static void advance(const struct br_strip *s, const struct br_strip_drive *drive,
                    const struct br_strip_ends *ends)
{
    if (s->d == 1 && !s->load)
        advance_lanes(1, false, s, drive, ends);
    else if (s->d == 1)
        advance_lanes(1, true, s, drive, ends);
    else if (!s->load)
        advance_lanes(2, false, s, drive, ends);
    else
        advance_lanes(2, true, s, drive, ends);
}

static void charge(const struct br_strip *s, const double uniform[2])
{
    for (size_t j = 0; j < s->pieces; j++)
        for (size_t lane = 0; lane < s->lanes; lane += WIDTH)
            if (s->d == 1)
                charge_of(1, s, uniform, j, lane);
            else
                charge_of(2, s, uniform, j, lane);
}

static void blend(const struct br_strip *s, size_t count, const double *const *from,
                  const double *weight)
{
    if (s->d == 1)
        blend_of(1, s, count, from, weight);
    else
        blend_of(2, s, count, from, weight);
}

static void weigh(const struct br_strip *s)
{
    blend(s, 0, NULL, NULL);
}

static void square(const struct br_strip *s, const double *state, double sum[2])
{
    if (s->d == 1)
        square_of(1, s, state, sum);
    else
        square_of(2, s, state, sum);
}

const struct br_kernel BR_JOIN(br_kernel_, BR_SET) = {
    .name = BR_QUOTE(BR_SET),
    .available = BR_JOIN(br_has_, BR_SET),
    .gather = SWEEP(gather),
    .join_left = SWEEP(join_left),
    .join_right = SWEEP(join_right),
    .advance = advance,
    .charge = charge,
    .weigh = weigh,
    .blend = blend,
    .square = square,
    .carry = SWEEP(carry),
    .expand = SWEEP(expand),
};
