/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops are written once, in the vector extension of GCC and Clang, and compiled for each
 * instruction set with vectors of its own size. Nothing is contracted. */
#include "reference/exact/legendre.h"

#include <math.h>

enum { S = BR_STAGES };

/* Vectors, and rows, at once. */
enum { BLOCK = 4, ROWS = 5 };

#define INLINE static inline __attribute__((always_inline))

struct sum {
    size_t count, width;
    const double *factor, *table; /* from the first row, and the first column on */
    double *out;
};

/* Column by column, for what fills no vector. */
INLINE void combine_columns(const struct sum *s, size_t first)
{
    for (size_t j = first; j < s->width; j++) {
        double sum = 0;
        for (size_t k = 0; k < s->count; k++)
            sum += s->factor[k] * s->table[k * s->width + j];
        s->out[j] = sum;
    }
}

/* Sum of a[i] b[i], or of its square: in LANES sums, so that their order is the same on every
 * machine, and none waits for the one before. */
INLINE double sum_lanes(size_t count, const double *a, const double *b, bool square)
{
    enum { LANES = 8 };
    const size_t whole = count / LANES * LANES;
    double sum[LANES] = {0}, all = 0;
    for (size_t i = 0; i < whole; i += LANES)
        for (size_t l = 0; l < LANES; l++) {
            const double part = a[i + l] * b[i + l];
            sum[l] += square ? part * part : part;
        }
    for (size_t i = whole; i < count; i++)
        sum[i - whole] += square ? a[i] * b[i] * (a[i] * b[i]) : a[i] * b[i];
    for (size_t l = 0; l < LANES; l++)
        all += sum[l];
    return all;
}

double br_sum_products(size_t count, const double *a, const double *b)
{
    return sum_lanes(count, a, b, false);
}

double br_norm(size_t count, const double *weight, const double *x)
{
    return sqrt(weight ? sum_lanes(count, weight, x, true) : sum_lanes(count, x, x, false));
}

void br_stage_factor(struct br_stage_system *s, const struct br_radau *radau)
{
    s->first = radau->integral[0][0];
    s->last = radau->integral[S - 1][S - 1];
    for (size_t k = 1; k < S; k++)
        s->coupling[k] = radau->integral[k][k - 1];
    for (size_t k = 0; k < S; k++) {
        const double diagonal = k == 0 ? s->first : k + 1 == S ? s->last : 0;
        const double square = s->coupling[k] * s->coupling[k];
        double *all_p = &s->pivot[k * s->width], *all_q = all_p + S * s->width;
        for (size_t i = 0; i < s->width; i++) {
            double p = diagonal, q = 1;
            if (k > 0) { /* + coupling^2 over the pivot before */
                p += square * (all_p[i - s->width] + s->b * all_q[i - s->width]);
                q -= square * all_q[i - s->width];
            }
            const double norm = p * p + p * q * s->b + q * q * s->a[i];
            all_p[i] = p / norm;
            all_q[i] = q / norm;
        }
    }
}

/* For both: `attributes` choose the instruction set.
 * block: some rows, ROWS at most, and vectors, BLOCK at most, from column j on.
 * pair: a number u + v theta.
 * divide: by pivot k.
 * solve: down and up again. */
#define COMBINER(suffix, lanes, attributes, condition)                                            \
    typedef double vec_##suffix __attribute__((vector_size(8 * (lanes)), aligned(8), may_alias)); \
    INLINE attributes void block_##suffix(const struct sum *s, size_t j, int rows, int vectors)   \
    {                                                                                             \
        vec_##suffix sum[ROWS][BLOCK] = {{{0}}};                                                  \
        for (size_t k = 0; k < s->count; k++)                                                     \
            for (int i = 0; i < vectors; i++) {                                                   \
                const vec_##suffix x = ((const vec_##suffix *)(s->table + k * s->width + j))[i];  \
                for (int r = 0; r < rows; r++)                                                    \
                    sum[r][i] += s->factor[(size_t)r * s->count + k] * x;                         \
            }                                                                                     \
        for (int r = 0; r < rows; r++)                                                            \
            for (int i = 0; i < vectors; i++)                                                     \
                ((vec_##suffix *)(s->out + (size_t)r * s->width + j))[i] = sum[r][i];             \
    }                                                                                             \
    INLINE attributes void rows_##suffix(const struct sum *s, int rows)                           \
    {                                                                                             \
        size_t j = 0;                                                                             \
        for (; j + BLOCK * (lanes) <= s->width; j += BLOCK * (lanes))                             \
            block_##suffix(s, j, rows, BLOCK);                                                    \
        for (; j + (lanes) <= s->width; j += (lanes))                                             \
            block_##suffix(s, j, rows, 1);                                                        \
        for (int r = 0; r < rows; r++) {                                                          \
            const size_t row = (size_t)r;                                                         \
            const struct sum one = {s->count, s->width, s->factor + row * s->count, s->table,     \
                                    s->out + row * s->width};                                     \
            combine_columns(&one, j);                                                             \
        }                                                                                         \
    }                                                                                             \
    attributes static void combine_##suffix(size_t rows, size_t count, const double *factor,      \
                                            size_t width, const double *table, double *out)       \
    {                                                                                             \
        struct sum s = {count, width, factor, table, out};                                        \
        size_t r = 0;                                                                             \
        for (; r + ROWS <= rows; r += ROWS, s.factor += ROWS * count, s.out += ROWS * width)      \
            rows_##suffix(&s, ROWS);                                                              \
        for (; r + 2 <= rows; r += 2, s.factor += 2 * count, s.out += 2 * width)                  \
            rows_##suffix(&s, 2);                                                                 \
        for (; r < rows; r++, s.factor += count, s.out += width)                                  \
            rows_##suffix(&s, 1);                                                                 \
    }                                                                                             \
    struct pair_##suffix {                                                                        \
        vec_##suffix u, v;                                                                        \
    };                                                                                            \
    INLINE attributes struct pair_##suffix divide_##suffix(                                       \
        const struct br_stage_system *s, size_t k, size_t i, struct pair_##suffix x)              \
    {                                                                                             \
        const double *at = s->pivot + k * s->width + i;                                           \
        const vec_##suffix a = *(const vec_##suffix *)(s->a + i);                                 \
        const vec_##suffix p = *(const vec_##suffix *)at;                                         \
        const vec_##suffix q = *(const vec_##suffix *)(at + S * s->width);                        \
        return (struct pair_##suffix){x.u * p - x.v * (q * a), x.u * q + x.v * (p + q * s->b)};   \
    }                                                                                             \
    attributes static void solve_##suffix(const struct br_stage_system *s, size_t first,          \
                                          double *x)                                              \
    {                                                                                             \
        for (size_t i = 0; i < s->width; i += (lanes)) {                                          \
            struct pair_##suffix down[S], here = {{0}, {0}};                                      \
            for (size_t k = first; k < S; k++) {                                                  \
                here.u = *(vec_##suffix *)(x + k * s->width + i) - s->coupling[k] * here.u;       \
                here.v = -s->coupling[k] * here.v;                                                \
                down[k] = here = divide_##suffix(s, k, i, here);                                  \
            }                                                                                     \
            for (size_t k = S; k-- > first;) {                                                    \
                *(vec_##suffix *)(x + k * s->width + i) = here.u;                                 \
                if (k == first)                                                                   \
                    break;                                                                        \
                here.u = s->coupling[k] * here.u;                                                 \
                here.v = s->coupling[k] * here.v;                                                 \
                here = divide_##suffix(s, k - 1, i, here);                                        \
                here.u += down[k - 1].u;                                                          \
                here.v += down[k - 1].v;                                                          \
            }                                                                                     \
        }                                                                                         \
    }                                                                                             \
    static bool available_##suffix(void)                                                          \
    {                                                                                             \
        return condition;                                                                         \
    }

#ifdef __x86_64__
COMBINER(avx512, 8, __attribute__((target("avx512f"))), __builtin_cpu_supports("avx512f"))
COMBINER(avx2, 4, __attribute__((target("avx2"))), __builtin_cpu_supports("avx2"))
#endif
COMBINER(portable, 2, , true)

const struct br_combiner br_combiners[] = {
#ifdef __x86_64__
    {available_avx512, combine_avx512, solve_avx512},
    {available_avx2, combine_avx2, solve_avx2},
#endif
    {available_portable, combine_portable, solve_portable},
};
const size_t br_combiner_count = sizeof br_combiners / sizeof *br_combiners;

static const struct br_combiner *best(void)
{
    size_t i = 0;
    while (!br_combiners[i].available())
        i++;
    return &br_combiners[i];
}

void br_combine(size_t rows, size_t count, const double *factor, size_t width, const double *table,
                double *out)
{
    best()->combine(rows, count, factor, width, table, out);
}

void br_stage_solve(const struct br_stage_system *system, size_t first, double *x)
{
    best()->solve(system, first, x);
}
