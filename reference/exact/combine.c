/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop is written once, in the vector extension of GCC and Clang, and compiled for each
 * instruction set. Nothing is contracted. */
#include "reference/exact/combine.h"

#include <string.h>

enum { LANES = 8, BLOCK = 4 };

typedef double vec __attribute__((vector_size(8 * LANES)));

#define INLINE static inline __attribute__((always_inline))

/* `vectors` of them, BLOCK at most, from column j on. */
INLINE void combine_block(size_t count, const double *factor, size_t width, const double *table,
                          double *out, int vectors)
{
    vec sum[BLOCK] = {{0}};
    for (size_t k = 0; k < count; k++)
        for (int i = 0; i < vectors; i++) {
            vec row;
            memcpy(&row, table + k * width + (size_t)i * LANES, sizeof row);
            sum[i] += factor[k] * row;
        }
    for (int i = 0; i < vectors; i++)
        memcpy(out + i * LANES, &sum[i], sizeof *sum);
}

INLINE void combine(size_t count, const double *factor, size_t width, const double *table,
                    double *out)
{
    size_t j = 0;
    for (; j + BLOCK * LANES <= width; j += BLOCK * LANES)
        combine_block(count, factor, width, table + j, out + j, BLOCK);
    for (; j + LANES <= width; j += LANES)
        combine_block(count, factor, width, table + j, out + j, 1);
    for (; j < width; j++) {
        double sum = 0;
        for (size_t k = 0; k < count; k++)
            sum += factor[k] * table[k * width + j];
        out[j] = sum;
    }
}

#define COMBINER(suffix, attributes, condition)                                               \
    attributes static void combine_##suffix(size_t count, const double *factor, size_t width, \
                                            const double *table, double *out)                 \
    {                                                                                         \
        combine(count, factor, width, table, out);                                            \
    }                                                                                         \
    static bool available_##suffix(void)                                                      \
    {                                                                                         \
        return condition;                                                                     \
    }

#ifdef __x86_64__
COMBINER(avx512, __attribute__((target("avx512f"))), __builtin_cpu_supports("avx512f"))
COMBINER(avx2, __attribute__((target("avx2"))), __builtin_cpu_supports("avx2"))
#endif
COMBINER(portable, , true)

const struct br_combiner br_combiners[] = {
#ifdef __x86_64__
    {"avx512", available_avx512, combine_avx512},
    {"avx2", available_avx2, combine_avx2},
#endif
    {"portable", available_portable, combine_portable},
};
const size_t br_combiner_count = sizeof br_combiners / sizeof *br_combiners;

br_combine *br_combine_best(void)
{
    size_t i = 0;
    while (!br_combiners[i].available())
        i++;
    return br_combiners[i].combine;
}
