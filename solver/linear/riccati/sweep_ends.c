/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The joins of a strip, and what is carried along its spans to the nodes. */
#include "solver/linear/riccati/sweep_lanes.h"

/* ---- joins ---- */

/* z or q of a piece with its load's */
INLINE void load_end(int d, const double *end, int which, double factor, vec *value)
{
    const int entry = d * BR_LANES;
    for (int i = 0; i < d; i++)
        value[i] = load(end + which * entry + i * BR_LANES) +
                   factor * load(end + (which + BR_END_LOAD_Q - BR_END_Q) * entry + i * BR_LANES);
}

/* One piece further to the left: h goes through its join, and the span's z gathers. */
INLINE void gather_piece(int d, const double *join, double *end, double factor, vec *h, vec *sum)
{
    const int entry = d * BR_LANES;
    vec next[2], drift[2];
    load_end(d, end, BR_END_Q, factor, next);
    load_end(d, end, BR_END_Z, factor, drift);
    store_all(d, h, end + BR_END_H * entry);
    store_all(d, drift, end + BR_END_DRIFT * entry);
    add(d, join + BR_JOIN_LEAD * d * d, drift, sum);
    add(d, join + BR_JOIN_LAG * d * d, h, sum);
    add(d, join + BR_JOIN_TRANSFER * d * d, drift, next);
    add_transposed(d, join + BR_JOIN_PASS * d * d, h, next);
    for (int i = 0; i < d; i++)
        h[i] = next[i];
}

/* A span ends free. */
INLINE void gather_of(int d, const struct br_strip *s, double factor, size_t lane, double *q,
                      double *z)
{
    vec h[VECTORS][2] = {{{0}}}, sum[VECTORS][2] = {{{0}}};
    for (size_t j = s->pieces; j-- > 0;) {
        double *end = piece_at(d, s, j, lane).end;
        for (int i = 0; i < BR_ENDS * d; i++) /* of a piece further on */
            __builtin_prefetch(end - (8 * BR_ENDS * d - i) * BR_LANES);
        for (int v = 0; v < VECTORS; v++)
            gather_piece(d, join_of(d, s, j), end + v * WIDTH, factor, h[v], sum[v]);
    }
    for (int v = 0; v < VECTORS; v++) {
        store_all(d, h[v], q + lane + v * WIDTH);
        store_all(d, sum[v], z + lane + v * WIDTH);
    }
}

/* Lane by lane, but all that does not wait for the neighbour at once. */
INLINE void add_lanewise(int d, const struct br_strip *s, int which, const double *x, double *sum)
{
    const double *a = s->span_join + which * d * d * BR_LANES;
    for (int lane = 0; lane < BR_LANES; lane += WIDTH)
        for (int i = 0; i < d; i++) {
            vec total = load(sum + i * BR_LANES + lane);
            for (int j = 0; j < d; j++)
                total += load(a + (i * d + j) * BR_LANES + lane) * load(x + j * BR_LANES + lane);
            store(total, sum + i * BR_LANES + lane);
        }
}

INLINE void join_left_of(size_t d, const struct br_strip *s, const double *q, const double *z,
                         double *h, double *right)
{
    const double *pass = s->span_join + BR_JOIN_PASS * d * d * BR_LANES;
    _Alignas(64) double own[2 * BR_LANES];
    memcpy(own, q, d * BR_LANES * sizeof *own);
    add_lanewise((int)d, s, BR_JOIN_TRANSFER, z, own);
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

INLINE void join_right_of(size_t d, const struct br_strip *s, const double *z, double *y,
                          double *left, double *right)
{
    const double *pass = s->span_join + BR_JOIN_PASS * d * d * BR_LANES;
    _Alignas(64) double own[2 * BR_LANES] = {0}, away[2 * BR_LANES];
    for (size_t i = 0; i < d * BR_LANES; i++)
        away[i] = -right[i];
    add_lanewise((int)d, s, BR_JOIN_GAIN, z, own);
    add_lanewise((int)d, s, BR_JOIN_YIELD, away, own);
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
    add_lanewise((int)d, s, BR_JOIN_COSTATE, own, right);
}

/* ---- to the nodes ---- */

/* kappa_w or kappa_v, carried from the left ends of the spans. */
INLINE void carry_of(int d, const struct br_strip *s, bool rate, size_t lane, double *across)
{
    const size_t entry = (size_t)d * BR_LANES;
    const double *state = s->state + lane + (rate ? entry : 0);
    vec y[VECTORS][2] = {{{0}}};
    for (size_t e = 0; e < s->pieces * s->length; e++)
        for (int v = 0; v < VECTORS; v++) {
            vec kappa[2];
            load_all(d, state + e * 2 * entry + v * WIDTH, kappa);
            pass_on(d, kappa, y[v]);
        }
    for (int v = 0; v < VECTORS; v++)
        store_all(d, y[v], across + lane + v * WIDTH);
}

/* Block after block of WIDTH values of each lane: rows of lanes become lanes of rows. */
INLINE void expand_of(int d, const struct br_strip *s, bool rate, size_t lane, const double *left,
                      double *nodal)
{
    const size_t entry = (size_t)d * BR_LANES, length = s->pieces * s->length;
    const size_t together = (size_t)(WIDTH / d); /* elements of a block */
    const double *state = s->state + lane + (rate ? entry : 0);
    vec y[VECTORS][2], row[VECTORS][WIDTH];
    for (int v = 0; v < VECTORS; v++)
        load_all(d, left + lane + v * WIDTH, y[v]);
    for (size_t e = 0; e < length; e += together) {
        const size_t live = length - e < together ? length - e : together;
        for (size_t i = 0; i < together; i++)
            for (int v = 0; v < VECTORS; v++) {
                vec kappa[2] = {{0}};
                if (i < live)
                    load_all(d, state + (e + i) * 2 * entry + v * WIDTH, kappa);
                pass_on(d, kappa, y[v]);
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

/* ---- the kernel's functions: d becomes a constant ---- */

void SWEEP(gather)(const struct br_strip *s, double factor, double *q, double *z)
{
    for (size_t lane = 0; lane < s->lanes; lane += GO)
        if (s->d == 1)
            gather_of(1, s, factor, lane, q, z);
        else
            gather_of(2, s, factor, lane, q, z);
}

void SWEEP(join_left)(const struct br_strip *s, const double *q, const double *z, double *h,
                      double *right)
{
    if (s->d == 1)
        join_left_of(1, s, q, z, h, right);
    else
        join_left_of(2, s, q, z, h, right);
}

void SWEEP(join_right)(const struct br_strip *s, const double *z, double *y, double *left,
                       double *right)
{
    if (s->d == 1)
        join_right_of(1, s, z, y, left, right);
    else
        join_right_of(2, s, z, y, left, right);
}

void SWEEP(carry)(const struct br_strip *s, bool rate, double *across)
{
    for (size_t lane = 0; lane < s->lanes; lane += GO)
        if (s->d == 1)
            carry_of(1, s, rate, lane, across);
        else
            carry_of(2, s, rate, lane, across);
}

void SWEEP(expand)(const struct br_strip *s, bool rate, const double *left, double *nodal)
{
    for (size_t lane = 0; lane < s->lanes; lane += GO)
        if (s->d == 1)
            expand_of(1, s, rate, lane, left, nodal);
        else
            expand_of(2, s, rate, lane, left, nodal);
}
