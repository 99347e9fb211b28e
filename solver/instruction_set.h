/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Loops in the vector extension of GCC and Clang are written once and compiled for each of these
 * instruction sets; the program takes the first that the processor has (-DBR_NO_FMA: the portable
 * one). */
#ifndef BR_INSTRUCTION_SET_H
#define BR_INSTRUCTION_SET_H

#include <stdbool.h>

/* For each, the fastest first: EXPAND(name, the attributes of functions compiled for it). */
#if defined __x86_64__ && !defined BR_NO_FMA
#define BR_INSTRUCTION_SETS(EXPAND)                                                    \
    EXPAND(avx512, __attribute__((target("avx512f,avx512dq,avx512vl,fma,avx2")))) \
    EXPAND(avx2, __attribute__((target("avx2,fma"))))                             \
    EXPAND(portable, )
#else
#define BR_INSTRUCTION_SETS(EXPAND) EXPAND(portable, )
#endif

/* Whether the processor has it. */
bool br_has_avx512(void);
bool br_has_avx2(void);
bool br_has_portable(void); /* every one */

#endif
