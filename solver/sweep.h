/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How the sweeps are compiled. A sweep is one chain of dependent multiply-adds,
 * bound by their latency, so these files, and the ladder's kernels (study/grid/ladder_loops.c),
 * alone are compiled with contraction (-ffp-contract=fast; all others with =off), and on x86-64 the
 * program picks at run time a copy that uses fused multiply-add where the processor has it
 * (-DBR_NO_FMA: never). */
#ifndef BR_SOLVER_SWEEP_H
#define BR_SOLVER_SWEEP_H

#if defined __has_feature
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || \
    __has_feature(memory_sanitizer)
#define BR_SANITIZED 1
#endif
#endif
#if defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__
#define BR_SANITIZED 1
#endif

#if defined __x86_64__ && defined __gnu_linux__ && !defined BR_SANITIZED && !defined BR_NO_FMA
#define BR_SWEEP __attribute__((target_clones("default", "arch=x86-64-v3")))
#else
#define BR_SWEEP
#endif

#endif
