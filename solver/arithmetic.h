/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The floating-point environment of a march: its traps. */
#ifndef BR_SOLVER_ARITHMETIC_H
#define BR_SOLVER_ARITHMETIC_H

#include <fenv.h>

/* Traps for operations that a correct march never does: an invalid operation, a division by zero,
 * an overflow. In builds with -Dtraps (debug builds) they stop the program at the operation; in
 * others these functions do nothing. Each thread has its own traps. */

#ifdef BR_TRAPS

/* Clears the exception flags and sets the traps; returns the traps that were set before. */
static inline int br_traps_set(void)
{
    feclearexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
    return feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
}

/* Removes the traps, around code that may raise exceptions: libraries, expressions of a user.
 * Returns the traps that were set before. */
static inline int br_traps_lift(void)
{
    return fedisableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
}

/* Sets the traps to a result of br_traps_set or br_traps_lift. */
static inline void br_traps_restore(int before)
{
    fedisableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
    feclearexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
    feenableexcept(before);
}

#else

static inline int br_traps_set(void)
{
    return 0;
}

static inline int br_traps_lift(void)
{
    return 0;
}

static inline void br_traps_restore(int before)
{
    (void)before;
}

#endif

#endif
