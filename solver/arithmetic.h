/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The floating-point environment of a march: its rounding mode, and traps. */
#ifndef BR_SOLVER_ARITHMETIC_H
#define BR_SOLVER_ARITHMETIC_H

#include <fenv.h>

/* ---- rounding ---- */

/* The mode belongs to a thread; threads of OpenMP do not hand it on. */

enum { BR_ROUNDING_KEPT = -1 }; /* no mode has this value (C17, 7.6) */

/* Sets a mode, as fesetround takes it; FE_TONEAREST leaves what the thread has, and costs nothing.
 * Returns what was set, or BR_ROUNDING_KEPT, for br_rounding_restore. */
static inline int br_rounding_set(int mode)
{
    if (mode == FE_TONEAREST)
        return BR_ROUNDING_KEPT;
    const int before = fegetround();
    fesetround(mode);
    return before;
}

static inline void br_rounding_restore(int before)
{
    if (before != BR_ROUNDING_KEPT)
        fesetround(before);
}

/* ---- traps ---- */

/* Traps for what no sound march does: an invalid operation, a division by zero, an overflow. On in
 * builds with -Dtraps (debug ones), where they stop the program at the operation; else nothing is
 * done here. They belong to the thread that sets them. */

#ifdef BR_TRAPS

/* Sets the traps, after forgetting what was raised before; returns those that were set. */
static inline int br_traps_set(void)
{
    feclearexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
    return feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
}

/* No traps, around what others have written: libraries, a person's expressions. Returns those that
 * were set. */
static inline int br_traps_lift(void)
{
    return fedisableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
}

/* As they were before one of these. */
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
