/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Blocks of the tables of the flexibility form, 2 by 2 in long double, for recursion.c and
 * riccati/tables.c. For a rod only the first entry is not 0. */
#ifndef BR_SOLVER_BLOCK_H
#define BR_SOLVER_BLOCK_H

#include <math.h>
#include <stdbool.h>

typedef long double wide;

struct block {
    wide e[2][2];
};

static const struct block identity = {{{1, 0}, {0, 1}}};

/* c + a b */
static inline struct block plus_times(struct block c, struct block a, struct block b)
{
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            for (int l = 0; l < 2; l++)
                c.e[i][j] += a.e[i][l] * b.e[l][j];
    return c;
}

static inline struct block times(struct block a, struct block b)
{
    return plus_times((struct block){{{0}}}, a, b);
}

static inline struct block plus(struct block a, struct block b)
{
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            a.e[i][j] += b.e[i][j];
    return a;
}

static inline struct block minus(struct block a, struct block b)
{
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            a.e[i][j] -= b.e[i][j];
    return a;
}

static inline struct block transpose(struct block a)
{
    return (struct block){{{a.e[0][0], a.e[1][0]}, {a.e[0][1], a.e[1][1]}}};
}

static inline wide determinant(struct block a)
{
    return a.e[0][0] * a.e[1][1] - a.e[0][1] * a.e[1][0];
}

static inline struct block inverse_of(struct block a)
{
    const wide det = determinant(a);
    return (struct block){
        {{a.e[1][1] / det, -a.e[0][1] / det}, {-a.e[1][0] / det, a.e[0][0] / det}}};
}

/* For a symmetric block. */
static inline bool is_positive_definite(struct block a)
{
    const wide det = determinant(a);
    return a.e[0][0] > 0 && det > 0 && isfinite(det);
}

#endif
