/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rounding mode of a march. It belongs to a thread; threads of OpenMP do not hand it on. */
#ifndef BR_SOLVER_ROUNDING_H
#define BR_SOLVER_ROUNDING_H

#include <fenv.h>

/* Sets a mode, as fesetround takes it; FE_TONEAREST leaves what the thread has. Returns what was
 * set, for br_rounding_restore. */
static inline int br_rounding_set(int mode)
{
    const int before = fegetround();
    if (mode != FE_TONEAREST)
        fesetround(mode);
    return before;
}

static inline void br_rounding_restore(int before)
{
    if (fegetround() != before)
        fesetround(before);
}

#endif
