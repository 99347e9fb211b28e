/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far a field's tip is from leaving the branch of its law that a step holds, over that step: at
 * its start, its stages and its end, and by their polynomial in between. A tip may leave its branch
 * and be back on it at the end of the step. */
#ifndef BR_SOLVER_MARGINS_H
#define BR_SOLVER_MARGINS_H

#include "solver/scheme.h"

struct br_margins {
    size_t count;
    double time[BR_MOST_STAGES + 1];   /* over k, from the start of the step */
    double margin[BR_MOST_STAGES + 1]; /* not negative on the branch */
};

/* Adds one; no two are of one time. */
void br_margins_add(struct br_margins *margins, double time, double margin);

/* Where in the step, over k, a margin is negative: the first that is, or, where none is, the lowest
 * point of their polynomial if that is. 0: nowhere. */
double br_margins_dip(const struct br_margins *margins);

#endif
