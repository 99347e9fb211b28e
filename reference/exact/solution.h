/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Inside of the exact reference: one solution of a scene, and a pair compared. */
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

/* Fills exact->report with the size of exact->solution and its distance to
 * another, infinite where their events differ. Its work counts. Fails with BR_NO_MEMORY or
 * BR_INTERRUPTED. */
enum br_status br_exact_compare(struct br_exact *exact, const struct br_exact_solution *other,
                                const struct br_outline outline[BR_EXACT_FIELDS],
                                struct br_effort *effort, struct br_error *err);

/* Fills exact->event from exact->solution, with error bars from another that
 * has the same events. Fails with BR_NO_MEMORY. */
enum br_status br_exact_list_events(struct br_exact *exact, const struct br_exact_solution *other,
                                    struct br_error *err);

#endif
