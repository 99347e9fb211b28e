/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of a group of segments: a step of its panels, their joins, and the way to the nodes.
 * Compiled once for each instruction set, BR_SET (instruction_set.h), and each number of unknowns a
 * node, BR_D, and contracted. Two vectors side by side hide the latency of the recursions. */
#include "solver/linear/riccati/kernel.h"
#include "solver/vectors.h"

/* ---- the lanes of a group of segments in vectors ---- */

enum { d = BR_D, VECTORS = 2, GO = VECTORS * WIDTH };

/* The entries of G that are not 0 or 1; see tables.c. */
static const double half = 0.5, lever = 0.28867513459481288225;

INLINE void load_all(const double *from, vec *to)
{
    for (int i = 0; i < d; i++)
        to[i] = load(from + i * BR_LANES);
}

INLINE void store_all(const vec *from, double *to)
{
    for (int i = 0; i < d; i++)
        store(from[i], to + i * BR_LANES);
}

/* sum += sign a x; add_transposed: sum += sign a'x; d by d */
INLINE void add(int sign, const double *a, const vec *x, vec *sum)
{
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            sum[i] += a[i * d + j] * (sign * x[j]);
}

INLINE void add_transposed(int sign, const double *a, const vec *x, vec *sum)
{
    for (int i = 0; i < d; i++)
        for (int j = d; j-- > 0;)
            sum[i] += a[j * d + i] * (sign * x[j]);
}

/* y = T y + G kappa */
INLINE void pass_on(const vec *kappa, vec *y)
{
    if (d == 1) {
        y[0] += kappa[0];
        return;
    }
    y[0] = ((y[0] + y[1]) + half * kappa[0]) - lever * kappa[1];
    y[1] += kappa[0];
}

/* The arrays of a panel, from one lane on. */
struct panel {
    double *state, *end;
    const double *load;
};

INLINE struct panel panel_at(const struct br_segments *s, size_t j, size_t lane)
{
    const size_t entry = (size_t)d * BR_LANES;
    return (struct panel){
        .state = s->state + j * s->length * 2 * entry + lane,
        .end = s->end + j * BR_ENDS * entry + lane,
        .load = s->load ? s->load + j * s->length * entry + lane : NULL,
    };
}

INLINE const double *join_of(const struct br_segments *s, size_t j)
{
    return s->join + j * (size_t)(BR_JOINS * d * d);
}

/* ---- an element ---- */

/* s = g + G'p,    p = A'p - K'g - F, for -F */
INLINE void element_left(const double *gain, const vec *g, const vec *minus_f, vec *p, vec *s)
{
    vec next[2];
    s[0] = d == 1 ? g[0] + p[0] : (g[0] + p[1]) + half * p[0];
    if (d == 2)
        s[1] = g[1] - lever * p[0];
    for (int i = 0; i < d; i++)
        next[i] = minus_f[i];
    add_transposed(-1, gain, g, next);
    add_transposed(1, gain + 2 * d * d, p, next);
    for (int i = 0; i < d; i++)
        p[i] = next[i];
}

/* kappa = -(K y + S^-1 s), and y = T y + G kappa */
INLINE void element_right(const double *gain, const vec *s, vec *y, vec *kappa)
{
    for (int i = 0; i < d; i++)
        kappa[i] = (vec){0};
    add(-1, gain + d * d, s, kappa);
    add(-1, gain, y, kappa);
    pass_on(kappa, y);
}

/* The state after the step. */
INLINE void element_state(double k, const vec *kappa, vec *w, vec *v)
{
    for (int i = 0; i < d; i++) {
        v[i] += kappa[i];
        w[i] += k * v[i];
    }
}

/* g = alpha w + v */
INLINE void strain(double alpha, const vec *w, const vec *v, vec *g)
{
    for (int i = 0; i < d; i++)
        g[i] = alpha * w[i] + v[i];
}

/* ---- a panel ---- */

/* Computes costates p to the left, and s into the scratch; minus_f: minus a uniform load. */
INLINE void panel_left(int vectors, bool loaded, const struct br_segments *s,
                       const struct panel *at, const vec *minus_f, double factor, vec p[VECTORS][2])
{
    const size_t entry = (size_t)d * BR_LANES;
    for (size_t e = s->length; e-- > 0;)
#pragma GCC unroll 2
        for (int v = 0; v < vectors; v++) {
            const double *state = at->state + e * 2 * entry + v * WIDTH;
            vec w[2], rate[2], g[2], sum[2], f[2];
            load_all(state, w);
            load_all(state + entry, rate);
            strain(s->alpha, w, rate, g);
            for (int i = 0; i < d; i++)
                f[i] = minus_f[i];
            if (loaded) {
                load_all(at->load + e * entry + v * WIDTH, f);
                for (int i = 0; i < d; i++)
                    f[i] *= -factor;
            }
            element_left(s->gain + e * (size_t)(3 * d * d), g, f, p[v], sum);
            store_all(sum, s->scratch + e * entry + v * WIDTH);
        }
}

/* Values that are passed from panel to panel along a segment, for one vector. */
struct along {
    vec y[2], velocity[2], displacement;
};

/* Computes the increments y to the right, the new state, and what it adds to z and q. Prefetches
 * the cache lines of the next panel. */
INLINE void panel_right(int vectors, const struct br_segments *s, const struct panel *at,
                        struct along *go)
{
    const size_t entry = (size_t)d * BR_LANES;
    vec z[VECTORS][2], q[VECTORS][2];
    for (int v = 0; v < vectors; v++)
        for (int i = 0; i < d; i++)
            z[v][i] = q[v][i] = (vec){0};
    const double *next = at->state + s->length * 4 * entry; /* its right end is used first */
    for (size_t e = 0; e < s->length; e++) {
        next -= 2 * entry;
#pragma GCC unroll 2
        for (int v = 0; v < vectors; v++) {
            const double *gain = s->gain + e * (size_t)(3 * d * d);
            const double *weight = s->weight + e * (size_t)(2 * d * d);
            double *state = at->state + e * 2 * entry + v * WIDTH;
            vec w[2], rate[2], g[2], sum[2], kappa[2];
            load_all(s->scratch + e * entry + v * WIDTH, sum);
            load_all(state, w);
            load_all(state + entry, rate);
            for (int i = 0; i < 2 * d; i++)
                __builtin_prefetch(next + v * WIDTH + i * BR_LANES);
            element_right(gain, sum, go[v].y, kappa);
            element_state(s->k, kappa, w, rate);
            store_all(w, state);
            store_all(rate, state + entry);
            pass_on(rate, go[v].velocity);
            if (d == 1)
                go[v].displacement += w[0];
            strain(s->alpha, w, rate, g);
            add(1, weight, g, z[v]);
            add(1, weight + d * d, g, q[v]);
        }
    }
    for (int v = 0; v < vectors; v++) {
        store_all(z[v], at->end + BR_END_Z * entry + v * WIDTH);
        store_all(q[v], at->end + BR_END_Q * entry + v * WIDTH);
    }
}

/* ---- segments ---- */

/* The increment at a panel's right end, and the costate there. */
INLINE void cross(const double *join, const double *end, const vec *right, vec *y, vec *costate)
{
    const int entry = d * BR_LANES;
    vec h[2], drift[2], next[2], yield[2];
    load_all(end + BR_END_H * entry, h);
    load_all(end + BR_END_DRIFT * entry, drift);
    add(1, join + BR_JOIN_REACH * d * d, right, h);
    for (int i = 0; i < d; i++)
        next[i] = yield[i] = (vec){0};
    add(1, join + BR_JOIN_YIELD * d * d, h, yield);
    add(1, join + BR_JOIN_GAIN * d * d, drift, next);
    for (int i = 0; i < d; i++)
        next[i] -= yield[i];
    add(1, join + BR_JOIN_PASS * d * d, y, next);
    add(1, join + BR_JOIN_COSTATE * d * d, next, h);
    for (int i = 0; i < d; i++) {
        y[i] = next[i];
        costate[i] = h[i];
    }
}

INLINE void start(size_t lane, const double *left, struct along *go)
{
    load_all(left + lane, go->y);
    for (int i = 0; i < d; i++)
        go->velocity[i] = (vec){0};
    go->displacement = (vec){0};
}

INLINE void advance_by(int vectors, bool loaded, const struct br_segments *segments,
                       const struct br_segment_drive *drive, const struct br_segment_ends *ends)
{
    const struct br_segments s = *segments; /* nothing aliases it */
    const double factor = drive->factor;
    vec minus_f[2];
    for (int i = 0; i < d; i++)
        minus_f[i] = -factor * drive->uniform[i] - (vec){0};
    for (size_t lane = 0; lane < s.lanes; lane += GO) {
        struct along go[VECTORS];
        vec y[VECTORS][2], right[VECTORS][2];
        for (int v = 0; v < vectors; v++) {
            start(lane + (size_t)(v * WIDTH), ends->left, &go[v]);
            load_all(ends->right + lane + v * WIDTH, right[v]);
            for (int i = 0; i < d; i++)
                y[v][i] = go[v].y[i];
        }
        for (size_t j = 0; j < s.panels; j++) {
            const struct panel at = panel_at(&s, j, lane);
            vec p[VECTORS][2];
            for (int i = 0; i < BR_ENDS * d; i++)
                __builtin_prefetch(at.end + (BR_ENDS * d + i) * BR_LANES);
            for (int v = 0; v < vectors; v++) {
                for (int i = 0; i < d; i++)
                    go[v].y[i] = y[v][i]; /* as the joins have it */
                cross(join_of(&s, j), at.end + v * WIDTH, right[v], y[v], p[v]);
            }
            panel_left(vectors, loaded, &s, &at, minus_f, factor, p);
            panel_right(vectors, &s, &at, go);
        }
        for (int v = 0; v < vectors; v++) {
            store_all(go[v].velocity, ends->velocity + lane + v * WIDTH);
            if (d == 1)
                store(go[v].displacement, ends->displacement + lane + v * WIDTH);
        }
    }
}

/* The odd rest has one lane and needs no second vector. */
static void advance(const struct br_segments *s, const struct br_segment_drive *drive,
                    const struct br_segment_ends *ends)
{
    if (s->lanes == 1 && s->load)
        advance_by(1, true, s, drive, ends);
    else if (s->lanes == 1)
        advance_by(1, false, s, drive, ends);
    else if (s->load)
        advance_by(VECTORS, true, s, drive, ends);
    else
        advance_by(VECTORS, false, s, drive, ends);
}

/* z and q of a state that is not the result of a step: of a sum of states, or with count 0 of the
 * state itself. */
INLINE void blend_panel(const struct br_segments *s, const struct panel *at, size_t count,
                        const double *const *from, const double *weight)
{
    const size_t entry = (size_t)d * BR_LANES;
    const ptrdiff_t offset = at->state - s->state;
    vec z[2] = {{0}}, q[2] = {{0}};
    for (size_t e = 0; e < s->length; e++) {
        const double *weights = s->weight + e * (size_t)(2 * d * d);
        double *state = at->state + e * 2 * entry;
        const size_t position = (size_t)offset + e * 2 * entry;
        vec w[2] = {{0}}, rate[2] = {{0}}, g[2];
        for (size_t j = 0; j < count; j++)
            for (int i = 0; i < d; i++) {
                w[i] += weight[j] * load(from[j] + position + i * BR_LANES);
                rate[i] += weight[j] * load(from[j] + position + entry + i * BR_LANES);
            }
        if (count > 0) {
            store_all(w, state);
            store_all(rate, state + entry);
        } else {
            load_all(state, w);
            load_all(state + entry, rate);
        }
        strain(s->alpha, w, rate, g);
        add(1, weights, g, z);
        add(1, weights + d * d, g, q);
    }
    store_all(z, at->end + BR_END_Z * entry);
    store_all(q, at->end + BR_END_Q * entry);
}

static void blend(const struct br_segments *segments, size_t count, const double *const *from,
                  const double *weight)
{
    const struct br_segments s = *segments; /* nothing aliases it */
    for (size_t j = 0; j < s.panels; j++)
        for (size_t lane = 0; lane < s.lanes; lane += WIDTH) {
            const struct panel at = panel_at(&s, j, lane);
            blend_panel(&s, &at, count, from, weight);
        }
}

static void square(const struct br_segments *s, const double *state, double total[2])
{
    const size_t entry = (size_t)d * BR_LANES, length = s->panels * s->length;
    _Alignas(64) double sum[2][BR_LANES] = {{0}};
    for (size_t lane = 0; lane < s->lanes; lane += WIDTH) {
        vec of[2] = {{0}};
        for (size_t e = 0; e < length; e++)
            for (int rate = 0; rate < 2; rate++)
                for (int i = 0; i < d; i++) {
                    const vec x =
                        load(state + (2 * e + (size_t)rate) * entry + i * BR_LANES + lane);
                    of[rate] += x * x;
                }
        store(of[0], sum[0] + lane);
        store(of[1], sum[1] + lane);
    }
    for (size_t lane = 0; lane < s->lanes; lane++)
        for (int rate = 0; rate < 2; rate++)
            total[rate] += sum[rate][lane];
}

/* The recursions without a state, for a load of factor 1. */
INLINE void charge_panel(const struct br_segments *s, const double *uniform, size_t j, size_t lane)
{
    const size_t entry = (size_t)d * BR_LANES;
    const struct panel at = panel_at(s, j, lane);
    const vec g[2] = {{0}};
    vec p[2] = {{0}}, y[2] = {{0}}, sum[2], kappa[2], f[2];
    for (int i = 0; i < d; i++)
        f[i] = -uniform[i] - (vec){0};
    for (size_t e = s->length; e-- > 0;) {
        if (at.load)
            load_all(at.load + e * entry, f);
        for (int i = 0; i < d && at.load; i++)
            f[i] = -f[i];
        element_left(s->gain + e * (size_t)(3 * d * d), g, f, p, sum);
        store_all(sum, s->scratch + e * entry);
    }
    for (size_t e = 0; e < s->length; e++) {
        load_all(s->scratch + e * entry, sum);
        element_right(s->gain + e * (size_t)(3 * d * d), sum, y, kappa);
    }
    store_all(p, at.end + BR_END_LOAD_Q * entry);
    store_all(y, at.end + BR_END_LOAD_Z * entry);
}

static void charge(const struct br_segments *s, const double uniform[2])
{
    for (size_t j = 0; j < s->panels; j++)
        for (size_t lane = 0; lane < s->lanes; lane += WIDTH)
            charge_panel(s, uniform, j, lane);
}

/* ---- joins ---- */

/* z or q of a panel, with that of its load */
INLINE void load_end(const double *end, int which, double factor, vec *value)
{
    const int entry = d * BR_LANES;
    for (int i = 0; i < d; i++)
        value[i] = load(end + which * entry + i * BR_LANES) +
                   factor * load(end + (which + BR_END_LOAD_Q - BR_END_Q) * entry + i * BR_LANES);
}

/* Goes one panel to the left: h passes the join, and the segment's z is summed. */
INLINE void gather_panel(const double *join, double *end, double factor, vec *h, vec *sum)
{
    const int entry = d * BR_LANES;
    vec next[2], drift[2];
    load_end(end, BR_END_Q, factor, next);
    load_end(end, BR_END_Z, factor, drift);
    store_all(h, end + BR_END_H * entry);
    store_all(drift, end + BR_END_DRIFT * entry);
    add(1, join + BR_JOIN_LEAD * d * d, drift, sum);
    add(1, join + BR_JOIN_LAG * d * d, h, sum);
    add(1, join + BR_JOIN_TRANSFER * d * d, drift, next);
    add_transposed(1, join + BR_JOIN_PASS * d * d, h, next);
    for (int i = 0; i < d; i++)
        h[i] = next[i];
}

/* A segment has a free right end here: h = 0. */
static void gather(const struct br_segments *s, double factor, double *q, double *z)
{
    for (size_t lane = 0; lane < s->lanes; lane += GO) {
        vec h[VECTORS][2] = {{{0}}}, sum[VECTORS][2] = {{{0}}};
        for (size_t j = s->panels; j-- > 0;) {
            double *end = panel_at(s, j, lane).end;
            for (int i = 0; i < BR_ENDS * d; i++) /* of a panel further on */
                __builtin_prefetch(end - (8 * BR_ENDS * d - i) * BR_LANES);
            for (int v = 0; v < VECTORS; v++)
                gather_panel(join_of(s, j), end + v * WIDTH, factor, h[v], sum[v]);
        }
        for (int v = 0; v < VECTORS; v++) {
            store_all(h[v], q + lane + v * WIDTH);
            store_all(sum[v], z + lane + v * WIDTH);
        }
    }
}

/* sum += a x, with a matrix of the segment joins in each lane: all lanes at once. Only the
 * recursion over the lanes goes lane by lane. */
INLINE void add_lanewise(const struct br_segments *s, int which, const double *x, double *sum)
{
    const double *a = s->segment_join + which * d * d * BR_LANES;
    for (int lane = 0; lane < BR_LANES; lane += WIDTH)
        for (int i = 0; i < d; i++) {
            vec total = load(sum + i * BR_LANES + lane);
            for (int j = 0; j < d; j++)
                total += load(a + (i * d + j) * BR_LANES + lane) * load(x + j * BR_LANES + lane);
            store(total, sum + i * BR_LANES + lane);
        }
}

static void join_left(const struct br_segments *s, const double *q, const double *z, double *h,
                      double *right)
{
    const double *pass = s->segment_join + BR_JOIN_PASS * d * d * BR_LANES;
    _Alignas(64) double own[2 * BR_LANES];
    memcpy(own, q, d * BR_LANES * sizeof *own);
    add_lanewise(s, BR_JOIN_TRANSFER, z, own);
    for (size_t lane = s->lanes; lane-- > 0;) {
        double next[2];
        for (size_t i = 0; i < d; i++) {
            right[i * BR_LANES + lane] = h[i];
            next[i] = own[i * BR_LANES + lane];
            for (size_t j = 0; j < d; j++)
                next[i] += pass[(j * d + i) * BR_LANES + lane] * h[j];
        }
        for (size_t i = 0; i < d; i++)
            h[i] = next[i];
    }
}

static void join_right(const struct br_segments *s, const double *z, double *y, double *left,
                       double *right)
{
    const double *pass = s->segment_join + BR_JOIN_PASS * d * d * BR_LANES;
    _Alignas(64) double own[2 * BR_LANES] = {0}, away[2 * BR_LANES];
    for (size_t i = 0; i < d * BR_LANES; i++)
        away[i] = -right[i];
    add_lanewise(s, BR_JOIN_GAIN, z, own);
    add_lanewise(s, BR_JOIN_YIELD, away, own);
    for (size_t lane = 0; lane < s->lanes; lane++) {
        double next[2];
        for (size_t i = 0; i < d; i++) {
            left[i * BR_LANES + lane] = y[i];
            next[i] = own[i * BR_LANES + lane];
            for (size_t j = 0; j < d; j++)
                next[i] += pass[(i * d + j) * BR_LANES + lane] * y[j];
            own[i * BR_LANES + lane] = next[i];
        }
        for (size_t i = 0; i < d; i++)
            y[i] = next[i];
    }
    add_lanewise(s, BR_JOIN_COSTATE, own, right);
}

/* ---- to the nodes ---- */

/* kappa_w or kappa_v, carried from the left ends of the segments. */
static void carry(const struct br_segments *s, bool rate, double *across)
{
    for (size_t lane = 0; lane < s->lanes; lane += GO) {
        const size_t entry = (size_t)d * BR_LANES;
        const double *state = s->state + lane + (rate ? entry : 0);
        vec y[VECTORS][2] = {{{0}}};
        for (size_t e = 0; e < s->panels * s->length; e++)
            for (int v = 0; v < VECTORS; v++) {
                vec kappa[2];
                load_all(state + e * 2 * entry + v * WIDTH, kappa);
                pass_on(kappa, y[v]);
            }
        for (int v = 0; v < VECTORS; v++)
            store_all(y[v], across + lane + v * WIDTH);
    }
}

/* Transposes block after block of WIDTH values of each lane. */
static void expand(const struct br_segments *s, bool rate, const double *left, double *nodal)
{
    for (size_t lane = 0; lane < s->lanes; lane += GO) {
        const size_t entry = (size_t)d * BR_LANES, length = s->panels * s->length;
        const size_t together = (size_t)(WIDTH / d); /* elements of a block */
        const double *state = s->state + lane + (rate ? entry : 0);
        vec y[VECTORS][2], row[VECTORS][WIDTH];
        for (int v = 0; v < VECTORS; v++)
            load_all(left + lane + v * WIDTH, y[v]);
        for (size_t e = 0; e < length; e += together) {
            const size_t live = length - e < together ? length - e : together;
            for (size_t i = 0; i < together; i++)
                for (int v = 0; v < VECTORS; v++) {
                    vec kappa[2] = {{0}};
                    if (i < live)
                        load_all(state + (e + i) * 2 * entry + v * WIDTH, kappa);
                    pass_on(kappa, y[v]);
                    for (int c = 0; c < d; c++)
                        row[v][i * (size_t)d + (size_t)c] = y[v][c];
                }
            for (int v = 0; v < VECTORS; v++) {
                transpose(row[v]);
                const size_t first = lane + (size_t)(v * WIDTH);
                for (size_t l = 0; l < WIDTH && first + l < s->lanes; l++) {
                    double *to = nodal + ((first + l) * length + e) * (size_t)d;
                    if (live == together)
                        store(row[v][l], to);
                    else
                        memcpy(to, &row[v][l], live * (size_t)d * sizeof *to);
                }
            }
        }
    }
}

const struct br_loops BR_JOIN(br_loops_, BR_JOIN(BR_SET, BR_JOIN(_, BR_D))) = {
    .gather = gather,
    .join_left = join_left,
    .join_right = join_right,
    .advance = advance,
    .charge = charge,
    .blend = blend,
    .square = square,
    .carry = carry,
    .expand = expand,
};
