/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The vectors of the instruction set BR_SET in the extension of GCC and Clang, for files that are
 * compiled for each (instruction_set.h). */
#ifndef BR_SOLVER_VECTORS_H
#define BR_SOLVER_VECTORS_H

#include <string.h>

#include "solver/instruction_set.h"

#define BR_JOINED(a, b) a##b
#define BR_JOIN(a, b) BR_JOINED(a, b)
#define BR_QUOTED(a) #a
#define BR_QUOTE(a) BR_QUOTED(a)

/* Doubles in a vector. */
#define WIDTH BR_JOIN(BR_WIDTH_, BR_SET)

typedef double vec __attribute__((vector_size(8 * WIDTH)));

#define INLINE static inline __attribute__((always_inline))

/* x in all lanes. */
#define ALL(x) ((x) - (vec){0})

#if defined __clang__
#define SHUFFLE(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
#else
typedef long long br_indices __attribute__((vector_size(8 * WIDTH)));
#define SHUFFLE(a, b, ...) __builtin_shuffle(a, b, (br_indices){__VA_ARGS__})
#endif

INLINE vec load(const double *from)
{
    vec v;
    memcpy(&v, from, sizeof v);
    return v;
}

INLINE void store(vec v, double *to)
{
    memcpy(to, &v, sizeof v);
}

/* From a and b, cut into blocks of 4, 2 or 1 lanes: the even blocks, and the odd ones. */
#if WIDTH == 8
#define EVEN_BLOCKS_4(a, b) SHUFFLE(a, b, 0, 1, 2, 3, 8, 9, 10, 11)
#define ODD_BLOCKS_4(a, b) SHUFFLE(a, b, 4, 5, 6, 7, 12, 13, 14, 15)
#define EVEN_BLOCKS_2(a, b) SHUFFLE(a, b, 0, 1, 8, 9, 4, 5, 12, 13)
#define ODD_BLOCKS_2(a, b) SHUFFLE(a, b, 2, 3, 10, 11, 6, 7, 14, 15)
#define EVEN_BLOCKS_1(a, b) SHUFFLE(a, b, 0, 8, 2, 10, 4, 12, 6, 14)
#define ODD_BLOCKS_1(a, b) SHUFFLE(a, b, 1, 9, 3, 11, 5, 13, 7, 15)
#elif WIDTH == 4
#define EVEN_BLOCKS_2(a, b) SHUFFLE(a, b, 0, 1, 4, 5)
#define ODD_BLOCKS_2(a, b) SHUFFLE(a, b, 2, 3, 6, 7)
#define EVEN_BLOCKS_1(a, b) SHUFFLE(a, b, 0, 4, 2, 6)
#define ODD_BLOCKS_1(a, b) SHUFFLE(a, b, 1, 5, 3, 7)
#else
#define EVEN_BLOCKS_1(a, b) SHUFFLE(a, b, 0, 2)
#define ODD_BLOCKS_1(a, b) SHUFFLE(a, b, 1, 3)
#endif

/* One pass of a transposition: exchanges blocks of `far` rows and lanes. */
#define SWAP_BLOCKS(x, far)                           \
    for (int i = 0; i < WIDTH; i++)                   \
        if (!(i & (far))) {                           \
            const vec a = (x)[i], b = (x)[i + (far)]; \
            (x)[i] = EVEN_BLOCKS_##far(a, b);         \
            (x)[i + (far)] = ODD_BLOCKS_##far(a, b);  \
        }

/* Lane j of row i becomes lane i of row j. */
INLINE void transpose(vec x[WIDTH])
{
#if WIDTH == 8
    SWAP_BLOCKS(x, 4)
#endif
#if WIDTH >= 4
    SWAP_BLOCKS(x, 2)
#endif
    SWAP_BLOCKS(x, 1)
}

#endif
