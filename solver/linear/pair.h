/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pairs of doubles and 2 by 2 matrices for the sweeps, in the vector extension
 * that GCC and Clang share: + - * act entry by entry. */
#ifndef BR_SOLVER_PAIR_H
#define BR_SOLVER_PAIR_H

typedef double br_pair __attribute__((vector_size(16)));

struct br_matrix {
    br_pair row[2];
};

static inline br_pair br_splat(double a)
{
    return (br_pair){a, a};
}

/* c + m' x, in the order that leaves the shortest chain from x to the result. */
static inline br_pair br_add_transposed_times(br_pair c, const struct br_matrix *m, br_pair x)
{
    return (c + m->row[0] * br_splat(x[0])) + m->row[1] * br_splat(x[1]);
}

/* c + m x */
static inline br_pair br_add_times(br_pair c, const struct br_matrix *m, br_pair x)
{
    const br_pair column0 = __builtin_shufflevector(m->row[0], m->row[1], 0, 2);
    const br_pair column1 = __builtin_shufflevector(m->row[0], m->row[1], 1, 3);
    return (c + column0 * br_splat(x[0])) + column1 * br_splat(x[1]);
}

/* m' x */
static inline br_pair br_transposed_times(const struct br_matrix *m, br_pair x)
{
    return m->row[0] * br_splat(x[0]) + m->row[1] * br_splat(x[1]);
}

#endif
