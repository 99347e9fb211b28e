/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop is written once, in the vector extension of GCC and Clang, and compiled for each
 * instruction set with vectors of its own size. Nothing is contracted. */
#include "reference/exact/combine.h"

enum { BLOCK = 4 }; /* vectors at once */

#define INLINE static inline __attribute__((always_inline))

/* Column by column, for what fills no vector. */
INLINE void combine_columns(size_t count, const double *factor, size_t width, const double *table,
                            size_t first, double *out)
{
    for (size_t j = first; j < width; j++) {
        double sum = 0;
        for (size_t k = 0; k < count; k++)
            sum += factor[k] * table[k * width + j];
        out[j] = sum;
    }
}

/* block: `vectors` of them, BLOCK at most, the table and out from their column on. */
#define COMBINER(suffix, lanes, attributes, condition)                                            \
    typedef double vec_##suffix __attribute__((vector_size(8 * (lanes)), aligned(8), may_alias)); \
    INLINE attributes void block_##suffix(size_t count, const double *factor, size_t width,       \
                                          const double *table, double *out, int vectors)          \
    {                                                                                             \
        vec_##suffix sum[BLOCK] = {{0}};                                                          \
        for (size_t k = 0; k < count; k++)                                                        \
            for (int i = 0; i < vectors; i++)                                                     \
                sum[i] += factor[k] * ((const vec_##suffix *)(table + k * width))[i];             \
        for (int i = 0; i < vectors; i++)                                                         \
            ((vec_##suffix *)out)[i] = sum[i];                                                    \
    }                                                                                             \
    attributes static void combine_##suffix(size_t count, const double *factor, size_t width,     \
                                            const double *table, double *out)                     \
    {                                                                                             \
        size_t j = 0;                                                                             \
        for (; j + BLOCK * (lanes) <= width; j += BLOCK * (lanes))                                \
            block_##suffix(count, factor, width, table + j, out + j, BLOCK);                      \
        for (; j + (lanes) <= width; j += (lanes))                                                \
            block_##suffix(count, factor, width, table + j, out + j, 1);                          \
        combine_columns(count, factor, width, table, j, out);                                     \
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
