/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops that take most of the time (legendre.h), compiled once for each instruction set, BR_SET
 * (solver/instruction_set.h). Nothing is contracted. */
#include "reference/exact/legendre.h"
#include "solver/vectors.h"

/* Vectors, and rows, at once. */
enum { S = BR_STAGES, BLOCK = 4, ROWS = 5 };

struct sum {
    size_t count, width;
    const double *factor, *table; /* from the first row, and the first column on */
    double *out;
};

/* Some rows, ROWS at most, and vectors, BLOCK at most, from column j on. */
INLINE void sum_block(const struct sum *s, size_t j, size_t rows, size_t vectors)
{
    vec sum[ROWS][BLOCK] = {{{0}}};
    for (size_t k = 0; k < s->count; k++)
        for (size_t i = 0; i < vectors; i++) {
            const vec x = load(s->table + k * s->width + j + i * WIDTH);
            for (size_t r = 0; r < rows; r++)
                sum[r][i] += s->factor[r * s->count + k] * x;
        }
    for (size_t r = 0; r < rows; r++)
        for (size_t i = 0; i < vectors; i++)
            store(sum[r][i], s->out + r * s->width + j + i * WIDTH);
}

/* Some rows; columns that fill no vector one by one. */
INLINE void sum_rows(const struct sum *s, size_t rows)
{
    size_t j = 0;
    for (; j + BLOCK * WIDTH <= s->width; j += BLOCK * WIDTH)
        sum_block(s, j, rows, BLOCK);
    for (; j + WIDTH <= s->width; j += WIDTH)
        sum_block(s, j, rows, 1);
    for (size_t r = 0; r < rows; r++)
        for (size_t i = j; i < s->width; i++) {
            double sum = 0;
            for (size_t k = 0; k < s->count; k++)
                sum += s->factor[r * s->count + k] * s->table[k * s->width + i];
            s->out[r * s->width + i] = sum;
        }
}

static void combine(size_t rows, size_t count, const double *factor, size_t width,
                    const double *table, double *out)
{
    struct sum s = {count, width, factor, table, out};
    size_t r = 0;
    for (; r + ROWS <= rows; r += ROWS, s.factor += ROWS * count, s.out += ROWS * width)
        sum_rows(&s, ROWS);
    for (; r + 2 <= rows; r += 2, s.factor += 2 * count, s.out += 2 * width)
        sum_rows(&s, 2);
    for (; r < rows; r++, s.factor += count, s.out += width)
        sum_rows(&s, 1);
}

/* Numbers u + v theta. */
struct pair {
    vec u, v;
};

/* By pivot k. */
INLINE struct pair divide(const struct br_stage_system *s, size_t k, size_t i, struct pair x)
{
    const double *at = s->pivot + k * s->width + i;
    const vec a = load(s->a + i), p = load(at), q = load(at + S * s->width);
    return (struct pair){x.u * p - x.v * (q * a), x.u * q + x.v * (p + q * s->b)};
}

/* Down and up again. */
static void solve(const struct br_stage_system *s, size_t first, double *x)
{
    for (size_t i = 0; i < s->width; i += WIDTH) {
        struct pair down[S], here = {{0}, {0}};
        for (size_t k = first; k < S; k++) {
            here.u = load(x + k * s->width + i) - s->coupling[k] * here.u;
            here.v = -s->coupling[k] * here.v;
            down[k] = here = divide(s, k, i, here);
        }
        for (size_t k = S; k-- > first;) {
            store(here.u, x + k * s->width + i);
            if (k == first)
                break;
            here.u = s->coupling[k] * here.u;
            here.v = s->coupling[k] * here.v;
            here = divide(s, k - 1, i, here);
            here.u += down[k - 1].u;
            here.v += down[k - 1].v;
        }
    }
}

const struct br_combiner BR_JOIN(br_combiner_, BR_SET) = {combine, solve};
