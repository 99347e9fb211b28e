/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/linear/riccati/lq.h"

#include <math.h>
#include <string.h>

enum { MOST = BR_LQ_MOST };

static void fill_axial(struct br_lq *lq, br_real mass)
{
    lq->d = 1;
    lq->t[0][0] = lq->g[0][0] = 1;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            lq->mass[i][j] = mass * (i == j ? 2 : 1) / 6;
}

static void fill_bending(struct br_lq *lq, br_real mass)
{
    static const br_real t[2][2] = {{1, 1}, {0, 1}}, g[2][2] = {{0.5L, -BR_LQ_LEVER}, {1, 0}};
    lq->d = 2;
    memcpy(lq->t, t, sizeof t);
    memcpy(lq->g, g, sizeof g);
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            lq->mass[i][j] = mass * roundl(420 * br_bending_mass[i][j]) / 420;
}

struct br_lq br_lq_of_field(const struct br_field *field)
{
    struct br_lq lq = {0};
    const br_real h = field->h,
                  stiff = (br_real)field->viscosity + (br_real)field->k * field->stiffness;
    const br_real mass = (br_real)field->density * h / field->k;
    lq.alpha = field->stiffness / stiff;
    lq.r = field->kind == BR_AXIAL ? stiff / h : stiff / (h * h * h);
    if (field->kind == BR_AXIAL)
        fill_axial(&lq, mass / lq.r);
    else
        fill_bending(&lq, mass / lq.r);
    return lq;
}

typedef br_real block[MOST][MOST];

/* c += a b, or a' b */
static void add_product(int d, bool transposed, const block a, const block b, block c)
{
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            for (int l = 0; l < d; l++)
                c[i][j] += (transposed ? a[l][i] : a[i][l]) * b[l][j];
}

static bool invert(int d, const block s, block inverse)
{
    if (d == 1) {
        inverse[0][0] = 1 / s[0][0];
        return s[0][0] > 0 && isfinite(s[0][0]);
    }
    const br_real det = s[0][0] * s[1][1] - s[0][1] * s[1][0];
    inverse[0][0] = s[1][1] / det;
    inverse[1][1] = s[0][0] / det;
    inverse[0][1] = inverse[1][0] = -s[0][1] / det;
    return s[0][0] > 0 && det > 0 && isfinite(det);
}

bool br_lq_step(const struct br_lq *lq, block p, struct br_lq_gain *gain)
{
    const int d = lq->d;
    block maa = {{0}}, mab = {{0}}, q = {{0}}, qg = {{0}}, s = {{0}}, inner = {{0}}, h = {{0}};
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++) {
            maa[i][j] = lq->mass[i][j];
            mab[i][j] = lq->mass[i][d + j];
            inner[i][j] = lq->mass[d + i][j];
            q[i][j] = lq->mass[d + i][d + j] + p[i][j]; /* Q = Mbb + P_{i+1} */
        }
    add_product(d, false, q, lq->g, qg);
    add_product(d, true, lq->g, qg, s); /* S = 1 + G'QG */
    for (int i = 0; i < d; i++)
        s[i][i] += 1;
    *gain = (struct br_lq_gain){0};
    if (!invert(d, s, gain->inverse))
        return false;
    add_product(d, false, q, lq->t, inner);
    add_product(d, true, lq->g, inner, h);                   /* H = G'(QT + Mab') */
    add_product(d, false, gain->inverse, h, gain->feedback); /* K = S^-1 H */
    block gk = {{0}}, mab_a = {{0}}, qa = {{0}}, next = {{0}};
    add_product(d, false, lq->g, gain->feedback, gk);
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            gain->closed[i][j] = lq->t[i][j] - gk[i][j]; /* A = T - GK */
    /* P = Maa + Mab A + (Mab A)' + A'QA + K'K: nothing is subtracted */
    add_product(d, false, mab, gain->closed, mab_a);
    add_product(d, false, q, gain->closed, qa);
    add_product(d, true, gain->closed, qa, next);
    add_product(d, true, gain->feedback, gain->feedback, next);
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            p[i][j] = next[i][j] + maa[i][j] + mab_a[i][j] + mab_a[j][i];
    return true;
}
