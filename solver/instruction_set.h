/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Loops in the vector extension of GCC and Clang are written once and compiled for each of these
 * instruction sets as BR_SET (solver/meson.build); the program takes the first that the processor
 * has (-DBR_NO_FMA: the portable one). */
#ifndef BR_SOLVER_INSTRUCTION_SET_H
#define BR_SOLVER_INSTRUCTION_SET_H

#include <stdbool.h>
#include <stddef.h>

/* EXPAND(name) for each, the fastest first; the last runs anywhere. */
#define BR_INSTRUCTION_SETS(EXPAND) EXPAND(avx512) EXPAND(avx2) EXPAND(portable)

/* The doubles in its vectors. */
#define BR_WIDTH_avx512 8
#define BR_WIDTH_avx2 4
#define BR_WIDTH_portable 2

/* Whether the processor has the set. */
bool br_has_avx512(void);
bool br_has_avx2(void);
bool br_has_portable(void);

/* Lists with one entry a set have this order, and NULL at the end. The index in such a list of the
 * first set that the processor has, or of the set of that name; if there is no such set, the index
 * of NULL. */
size_t br_instruction_set_best(void);
size_t br_instruction_set_find(const char *name);

/* ---- loops that the compiler makes copies of ---- */

/* How the sweeps are compiled. A sweep is one chain of dependent multiply-adds, and their latency
 * limits its speed. So only the files of the sweeps and study/grid/nested_meshes_loops.c are
 * compiled with contraction (-ffp-contract=fast; all others with =off), and on x86-64 the program
 * picks at run time a copy that uses fused multiply-add where the processor has it (-DBR_NO_FMA:
 * never; nor with BR_LONG, since long double has none). */

#if defined __has_feature
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || \
    __has_feature(memory_sanitizer)
#define BR_SANITIZED 1
#endif
#endif
#if defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__
#define BR_SANITIZED 1
#endif

#if defined __x86_64__ && defined __gnu_linux__ && !defined BR_SANITIZED && !defined BR_NO_FMA && \
    !defined BR_LONG
#define BR_SWEEP __attribute__((target_clones("default", "arch=x86-64-v3")))
#else
#define BR_SWEEP
#endif

#endif
