/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables of one piece and of its joins, in long double; see pieces.c. */
#include <string.h>

#include "solver/pieces_state.h"

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

static void keep(int d, const block a, double to[BR_LQ_MOST][BR_LQ_MOST])
{
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            to[i][j] = (double)a[i][j];
}

/* What a piece of some length does as a whole. */
struct whole {
    block phi, z, p;
};

/* Fills the gains; P of every length goes into `p`, longest + 1 of them. */
static bool fill_gains(struct br_pieces *s, const struct br_lq *lq, struct br_lq_gain *gain,
                       block *p)
{
    const int d = s->d;
    memset(p[0], 0, sizeof *p);
    for (size_t e = 0; e < s->longest; e++) {
        memcpy(p[e + 1], p[e], sizeof *p);
        if (!br_lq_step(lq, p[e + 1], &gain[e]))
            return false;
        double *to = s->gain + e * (size_t)(4 * d * d);
        for (int i = 0; i < d; i++)
            for (int j = 0; j < d; j++) {
                to[i * d + j] = (double)gain[e].closed[j][i];
                to[d * d + i * d + j] = (double)-(gain[e].feedback[j][i] * lq->r[j]);
                to[2 * d * d + i * d + j] = (double)-gain[e].inverse[i][j];
                to[3 * d * d + i * d + j] = (double)-gain[e].feedback[i][j];
            }
    }
    return true;
}

/* The responses to unit y_l and unit c of a piece of `length` elements, times R, and what the piece
 * does as a whole. costate: workspace, length of them. */
static void fill_weights(const struct br_pieces *s, const struct br_lq *lq,
                         const struct br_lq_gain *gain, size_t length, block *costate,
                         double *weight, struct whole *whole)
{
    const int d = s->d;
    block pi, gt, y = {{0}}, from_left;
    set_identity(d, pi);
    set_identity(d, from_left);
    transpose(d, lq->g, gt);
    for (size_t e = 0; e < length; e++) { /* costate[e] = S^-1 G' pi */
        block q = {{0}}, at, next = {{0}};
        add_product(d, gt, pi, q);
        memset(costate[e], 0, sizeof *costate);
        add_product(d, gain[e].inverse, q, costate[e]);
        transpose(d, gain[e].closed, at);
        add_product(d, at, pi, next);
        memcpy(pi, next, sizeof pi);
    }
    for (size_t e = length; e-- > 0;) {
        block by_left = {{0}}, by_right, ky = {{0}}, gk = {{0}}, next = {{0}};
        add_product(d, gain[e].feedback, from_left, by_left);
        add_product(d, gain[e].feedback, y, ky);
        double *to = weight + e * (size_t)(2 * d * d);
        for (int i = 0; i < d; i++)
            for (int j = 0; j < d; j++) {
                by_right[i][j] = -(ky[i][j] + costate[e][i][j]);
                to[j * d + i] = (double)(lq->r[i] * by_right[i][j]);
                to[d * d + j * d + i] = (double)-(lq->r[i] * by_left[i][j]);
            }
        add_product(d, lq->g, by_right, gk);
        add_product(d, lq->t, y, gk);
        memcpy(y, gk, sizeof y);
        add_product(d, gain[e].closed, from_left, next);
        memcpy(from_left, next, sizeof from_left);
    }
    memcpy(whole->phi, from_left, sizeof whole->phi);
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            whole->z[i][j] = -y[i][j];
}

/* (I + Z C)^-1; its determinant is at least 1. */
static void join_inverse(int d, const block z, const block ph, block m)
{
    block a;
    set_identity(d, a);
    add_product(d, z, ph, a);
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

/* From the tip to the clamped end; ph: of the right end, becomes that of the left end. */
static void fill_join(int d, const struct whole *w, block ph, struct br_join *join)
{
    block m, pass = {{0}}, yield = {{0}}, phi_t, phi_t_ph = {{0}}, transfer = {{0}}, next;
    join_inverse(d, w->z, ph, m);
    add_product(d, m, w->phi, pass);
    add_product(d, m, w->z, yield);
    transpose(d, w->phi, phi_t);
    add_product(d, phi_t, ph, phi_t_ph);
    add_product(d, phi_t_ph, m, transfer);
    keep(d, m, join->gain);
    keep(d, pass, join->pass);
    keep(d, yield, join->yield);
    keep(d, ph, join->costate);
    keep(d, transfer, join->transfer);
    memcpy(next, w->p, sizeof next);
    add_product(d, transfer, w->phi, next);
    for (int i = 0; i < d; i++) /* symmetric but for round-off */
        for (int j = 0; j < d; j++)
            ph[i][j] = (next[i][j] + next[j][i]) / 2;
}

enum br_status br_pieces_tables(struct br_pieces *s, struct br_error *err)
{
    const struct br_lq lq = br_lq_of_field(&s->field);
    const size_t longest = s->longest;
    s->alpha = (double)lq.alpha;
    for (int i = 0; i < s->d; i++)
        s->r[i] = (double)lq.r[i];
    struct br_lq_gain *gain = br_allocate(longest, sizeof *gain);
    block *p = br_allocate(2 * longest + 1, sizeof *p);
    enum br_status status = gain && p ? BR_OK : br_no_memory(err, "the tables of a solver");
    if (!status && !fill_gains(s, &lq, gain, p))
        status = br_fail(err, BR_SINGULAR, "%s: the step is not positive definite",
                         s->field.kind == BR_AXIAL ? "axial" : "bending");
    if (!status) {
        struct whole regular, odd;
        fill_weights(s, &lq, gain, s->length, p + longest + 1, s->weight, &regular);
        memcpy(regular.p, p[s->length], sizeof regular.p);
        if (s->odd) {
            fill_weights(s, &lq, gain, s->odd, p + longest + 1, s->odd_weight, &odd);
            memcpy(odd.p, p[s->odd], sizeof odd.p);
        }
        block ph = {{0}};
        for (size_t i = s->pieces; i-- > 0;)
            fill_join(s->d, i == 0 && s->odd ? &odd : &regular, ph, &s->join[i]);
    }
    free(gain);
    free(p);
    return status;
}
