/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Loops in the vector extension of GCC and Clang are written once and compiled for each of these
 * instruction sets as BR_SET (solver/meson.build); the program takes the first that the processor
 * has (-DBR_NO_FMA: the portable one). */
#ifndef BR_SOLVER_INSTRUCTION_SET_H
#define BR_SOLVER_INSTRUCTION_SET_H

#include <stdbool.h>

/* EXPAND(name) for each, the fastest first; the last runs anywhere. */
#define BR_INSTRUCTION_SETS(EXPAND) EXPAND(avx512) EXPAND(avx2) EXPAND(portable)

/* The doubles in its vectors. */
#define BR_WIDTH_avx512 8
#define BR_WIDTH_avx2 4
#define BR_WIDTH_portable 2

/* Whether the processor has it. */
bool br_has_avx512(void);
bool br_has_avx2(void);
bool br_has_portable(void);

#endif
