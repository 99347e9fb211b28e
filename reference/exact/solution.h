/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Inside of the exact reference. */
#ifndef BR_REFERENCE_EXACT_SOLUTION_H
#define BR_REFERENCE_EXACT_SOLUTION_H

#include "reference/exact/march.h"

/* One march of each modelled field; the others are NULL. */
struct br_exact_solution {
    struct br_oscillators *field[BR_EXACT_FIELDS];
    struct br_law law[BR_EXACT_FIELDS];
    struct br_history *track[BR_EXACT_FIELDS];
    struct br_store store; /* of the fields */
};

struct br_exact {
    double duration; /* T, s */
    struct br_exact_solution *solution;
    struct br_exact_report report[BR_EXACT_FIELDS];
    double noise[BR_EXACT_FIELDS]; /* m/s: where a force at the tip cancels all motion, this much
                                      of the velocity is round-off */
    size_t events;
    struct br_exact_event *event;
};

#endif
