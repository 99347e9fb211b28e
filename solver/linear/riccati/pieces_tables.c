/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables of a piece, of its joins and of those of the spans, in long double; see pieces.h. */
#include <string.h>

#include "solver/linear/riccati/pieces.h"

typedef br_real block[BR_LQ_MOST][BR_LQ_MOST];

static void add_product(int d, const block a, const block b, block c)
{
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            for (int l = 0; l < d; l++)
                c[i][j] += a[i][l] * b[l][j];
}

static void transpose(int d, const block a, block b)
{
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            b[j][i] = a[i][j];
}

static void set_identity(int d, block a)
{
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            a[i][j] = i == j;
}

/* As d by d doubles, by rows. */
static void pack(int d, const block a, double *to)
{
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            to[i * d + j] = (double)a[i][j];
}

/* c = a b */
static void set_product(int d, const block a, const block b, block c)
{
    block product = {{0}};
    add_product(d, a, b, product);
    memcpy(c, product, sizeof product);
}

/* What a piece or a span does as a whole. */
struct whole {
    block phi, z, p;
};

/* ---- pieces ---- */

/* The gains of the elements of a piece by their distance to its right end, and P in front of each:
 * longest + 1 of them. `gains`: of the leftmost element first. */
static bool fill_gains(const struct br_lq *lq, size_t longest, double *gains,
                       struct br_lq_gain *gain, block *p)
{
    const int d = lq->d;
    memset(p[0], 0, sizeof *p);
    for (size_t e = 0; e < longest; e++) {
        memcpy(p[e + 1], p[e], sizeof *p);
        if (!br_lq_step(lq, p[e + 1], &gain[e]))
            return false;
        double *to = gains + (longest - 1 - e) * (size_t)(3 * d * d);
        pack(d, gain[e].feedback, to);
        pack(d, gain[e].inverse, to + d * d);
        pack(d, gain[e].closed, to + 2 * d * d);
    }
    return true;
}

/* zeta = S^-1 G'pi of every element, for pi = 1 at the right end. */
static void fill_reaction(const struct br_lq *lq, const struct br_lq_gain *gain, size_t length,
                          block *zeta)
{
    const int d = lq->d;
    block pi, gt, at, q;
    set_identity(d, pi);
    transpose(d, lq->g, gt);
    for (size_t e = 0; e < length; e++) {
        set_product(d, gt, pi, q);
        set_product(d, gain[e].inverse, q, zeta[e]);
        transpose(d, gain[e].closed, at);
        set_product(d, at, pi, pi);
    }
}

/* The weights of a piece, transposed responses of -kappa to c and of kappa to y_l, and what it does
 * as a whole. zeta: workspace, length of them. */
static void fill_weights(const struct br_lq *lq, const struct br_lq_gain *gain, size_t length,
                         block *zeta, double *weight, struct whole *whole)
{
    const int d = lq->d;
    block y = {{0}}, from_left = {{0}}, to_right, turned, step;
    fill_reaction(lq, gain, length, zeta);
    set_identity(d, from_left);
    for (size_t e = length; e-- > 0; weight += 2 * d * d) {
        set_product(d, gain[e].feedback, y, to_right); /* -kappa = K y + zeta */
        for (int i = 0; i < d; i++)
            for (int j = 0; j < d; j++)
                to_right[i][j] += zeta[e][i][j];
        transpose(d, to_right, turned);
        for (int i = 0; i < d; i++)
            for (int j = 0; j < d; j++)
                turned[i][j] = -turned[i][j];
        pack(d, turned, weight);
        set_product(d, gain[e].feedback, from_left, step); /* -kappa = K y */
        transpose(d, step, turned);
        for (int i = 0; i < d; i++)
            for (int j = 0; j < d; j++)
                turned[i][j] = -turned[i][j];
        pack(d, turned, weight + d * d);
        set_product(d, lq->g, to_right, step); /* y = T y + G kappa */
        set_product(d, lq->t, y, y);
        for (int i = 0; i < d; i++)
            for (int j = 0; j < d; j++)
                y[i][j] -= step[i][j];
        set_product(d, gain[e].closed, from_left, from_left);
    }
    memcpy(whole->phi, from_left, sizeof whole->phi);
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            whole->z[i][j] = -y[i][j];
}

/* ---- joins ---- */

struct join {
    block pass, gain, yield, costate, transfer;
};

/* (1 + Z C)^-1; its determinant is at least 1. */
static void join_inverse(int d, const block z, const block c, block m)
{
    block a;
    set_identity(d, a);
    add_product(d, z, c, a);
    if (d == 1) {
        m[0][0] = 1 / a[0][0];
        return;
    }
    const br_real det = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    m[0][0] = a[1][1] / det;
    m[0][1] = -a[0][1] / det;
    m[1][0] = -a[1][0] / det;
    m[1][1] = a[0][0] / det;
}

/* From the right to the left; c: of the right end, becomes that of the left end. */
static struct join join_of(int d, const struct whole *w, block c)
{
    struct join join = {.pass = {{0}}};
    block phi_t, next;
    join_inverse(d, w->z, c, join.gain);
    set_product(d, join.gain, w->phi, join.pass);
    set_product(d, join.gain, w->z, join.yield);
    memcpy(join.costate, c, sizeof join.costate);
    transpose(d, w->phi, phi_t);
    set_product(d, phi_t, c, join.transfer);
    set_product(d, join.transfer, join.gain, join.transfer);
    memcpy(next, w->p, sizeof next);
    add_product(d, join.transfer, w->phi, next);
    for (int i = 0; i < d; i++) /* symmetric but for round-off */
        for (int j = 0; j < d; j++)
            c[i][j] = (next[i][j] + next[j][i]) / 2;
    return join;
}

/* The joins of a span, and what it does as a whole. */
static void fill_span(int d, const struct whole *piece, size_t pieces, double *to,
                      struct whole *span)
{
    block c = {{0}}, ahead, reach, response = {{0}}, part;
    set_identity(d, ahead);
    set_identity(d, reach);
    for (size_t j = pieces; j-- > 0;) {
        const struct join join = join_of(d, piece, c);
        double *at = to + j * (size_t)(BR_JOINS * d * d);
        block pass_t;
        pack(d, join.pass, at + BR_JOIN_PASS * d * d);
        pack(d, join.gain, at + BR_JOIN_GAIN * d * d);
        pack(d, join.yield, at + BR_JOIN_YIELD * d * d);
        pack(d, join.costate, at + BR_JOIN_COSTATE * d * d);
        pack(d, join.transfer, at + BR_JOIN_TRANSFER * d * d);
        set_product(d, ahead, join.gain, part);
        pack(d, part, at + BR_JOIN_LEAD * d * d);
        set_product(d, ahead, join.yield, part);
        for (int i = 0; i < d; i++)
            for (int l = 0; l < d; l++)
                at[BR_JOIN_LAG * d * d + i * d + l] = (double)-part[i][l];
        pack(d, reach, at + BR_JOIN_REACH * d * d);
        add_product(d, part, reach, response);
        set_product(d, ahead, join.pass, ahead);
        transpose(d, join.pass, pass_t);
        set_product(d, pass_t, reach, reach);
    }
    memcpy(span->phi, ahead, sizeof ahead);
    memcpy(span->z, response, sizeof response);
    memcpy(span->p, c, sizeof c);
}

static void pack_lane(int d, const block a, int which, size_t lane, double *to)
{
    for (int i = 0; i < d * d; i++)
        to[(size_t)(which * d * d + i) * BR_LANES + lane] = (double)a[i / d][i % d];
}

/* The joins of the spans, from the tip to the clamped end. */
static void fill_ends(struct br_pieces *s, const struct whole span[BR_MOST_STRANDS])
{
    const int d = s->d;
    block c = {{0}};
    for (int i = s->strands; i-- > 0;) {
        double *to = s->strand[i].strip.span_join;
        for (size_t lane = s->strand[i].strip.lanes; lane-- > 0;) {
            const struct join join = join_of(d, &span[i], c);
            pack_lane(d, join.pass, BR_JOIN_PASS, lane, to);
            pack_lane(d, join.gain, BR_JOIN_GAIN, lane, to);
            pack_lane(d, join.yield, BR_JOIN_YIELD, lane, to);
            pack_lane(d, join.costate, BR_JOIN_COSTATE, lane, to);
            pack_lane(d, join.transfer, BR_JOIN_TRANSFER, lane, to);
        }
    }
}

static void fill_strand(struct br_strand *t, const struct br_lq *lq, double k,
                        const struct br_lq_gain *gain, block *p, size_t longest, struct whole *span)
{
    struct whole piece;
    struct br_strip *strip = &t->strip;
    strip->k = k;
    strip->alpha = (double)lq->alpha;
    fill_weights(lq, gain, strip->length, p + longest + 1, strip->weight, &piece);
    memcpy(piece.p, p[strip->length], sizeof piece.p);
    fill_span(lq->d, &piece, strip->pieces, strip->join, span);
}

enum br_status br_pieces_tables(struct br_pieces *s, struct br_error *err)
{
    const struct br_lq lq = br_lq_of_field(&s->field);
    const struct br_strip *of = &s->strand[0].strip; /* the longest pieces have all gains */
    if (s->strand[s->strands - 1].strip.length > of->length)
        of = &s->strand[s->strands - 1].strip;
    const size_t longest = of->length;
    s->r = (double)lq.r;
    struct br_lq_gain *gain = br_allocate(longest, sizeof *gain);
    block *p = br_allocate(2 * longest + 1, sizeof *p);
    enum br_status status = gain && p ? BR_OK : br_no_memory(err, "the tables of a solver");
    if (!status && !fill_gains(&lq, longest, of->gain, gain, p))
        status = br_fail(err, BR_SINGULAR, "%s: the step is not positive definite",
                         s->field.kind == BR_AXIAL ? "axial" : "bending");
    struct whole span[BR_MOST_STRANDS];
    for (int i = 0; i < s->strands && !status; i++)
        fill_strand(&s->strand[i], &lq, s->k, gain, p, longest, &span[i]);
    if (!status)
        fill_ends(s, span);
    free(gain);
    free(p);
    return status;
}
