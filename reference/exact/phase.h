/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the tip does. A contact is open or closed; with friction the tip sticks,
 * or slips up (towards positive w) or down; where no law acts it is free. */
#ifndef BR_REFERENCE_EXACT_PHASE_H
#define BR_REFERENCE_EXACT_PHASE_H

/* X(name, what happens when it begins) */
#define BR_PHASE_LIST(X)           \
    X(BR_FREE, "is free")          \
    X(BR_OPEN, "contact opens")    \
    X(BR_CLOSED, "contact closes") \
    X(BR_STICK, "sticks")          \
    X(BR_SLIP_UP, "slips up")      \
    X(BR_SLIP_DOWN, "slips down")

enum br_phase {
#define X(name, text) name,
    BR_PHASE_LIST(X)
#undef X
};

#endif
