/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What sweep_march.c and sweep_ends.c share: the lanes of a strip in vectors. For these alone,
 * which are compiled once for each instruction set, BR_SET (instruction_set.h), and contracted. Two
 * vectors side by side hide the latency of the recursions. */
#ifndef BR_SOLVER_SWEEP_LANES_H
#define BR_SOLVER_SWEEP_LANES_H

#include "solver/linear/riccati/kernel.h"
#include "solver/vectors.h"

enum { VECTORS = 2, GO = VECTORS * WIDTH };

/* The entries of G that are not 0 or 1; see lq.h. */
static const double half = 0.5, lever = 0.28867513459481288225;

INLINE void load_all(int d, const double *from, vec *to)
{
    for (int i = 0; i < d; i++)
        to[i] = load(from + i * BR_LANES);
}

INLINE void store_all(int d, const vec *from, double *to)
{
    for (int i = 0; i < d; i++)
        store(from[i], to + i * BR_LANES);
}

/* sum += a x, sum -= a x, and so with a'; d by d */
INLINE void add(int d, const double *a, const vec *x, vec *sum)
{
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            sum[i] += a[i * d + j] * x[j];
}

INLINE void subtract(int d, const double *a, const vec *x, vec *sum)
{
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            sum[i] -= a[i * d + j] * x[j];
}

INLINE void add_transposed(int d, const double *a, const vec *x, vec *sum)
{
    for (int i = 0; i < d; i++)
        for (int j = d; j-- > 0;)
            sum[i] += a[j * d + i] * x[j];
}

INLINE void subtract_transposed(int d, const double *a, const vec *x, vec *sum)
{
    for (int i = 0; i < d; i++)
        for (int j = d; j-- > 0;)
            sum[i] -= a[j * d + i] * x[j];
}

/* y = T y + G kappa */
INLINE void pass_on(int d, const vec *kappa, vec *y)
{
    if (d == 1) {
        y[0] += kappa[0];
        return;
    }
    y[0] = ((y[0] + y[1]) + half * kappa[0]) - lever * kappa[1];
    y[1] += kappa[0];
}

/* Where a piece's lanes begin. */
struct piece {
    double *state, *end;
    const double *load;
};

INLINE struct piece piece_at(int d, const struct br_strip *s, size_t j, size_t lane)
{
    const size_t entry = (size_t)d * BR_LANES;
    return (struct piece){
        .state = s->state + j * s->length * 2 * entry + lane,
        .end = s->end + j * BR_ENDS * entry + lane,
        .load = s->load ? s->load + j * s->length * entry + lane : NULL,
    };
}

INLINE const double *join_of(int d, const struct br_strip *s, size_t j)
{
    return s->join + j * (size_t)(BR_JOINS * d * d);
}

/* The functions of a kernel; see kernel.h. */
#define SWEEP(name) BR_JOIN(br_sweep_##name##_, BR_SET)
void SWEEP(gather)(const struct br_strip *s, double factor, double *q, double *z);
void SWEEP(join_left)(const struct br_strip *s, const double *q, const double *z, double *h,
                      double *right);
void SWEEP(join_right)(const struct br_strip *s, const double *z, double *y, double *left,
                       double *right);
void SWEEP(carry)(const struct br_strip *s, bool rate, double *across);
void SWEEP(expand)(const struct br_strip *s, bool rate, const double *left, double *nodal);

#endif
