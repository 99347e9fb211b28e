/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the element loops of sweep_march.c do for one element in each lane of a vector, for the
 * benchmark, which holds their time against the machine's limits. To be counted anew when the loops
 * change: element_left, element_right, element_state, strain, pass_on and the weights. Instructions
 * that only move values are not counted, nor are the joins. */
#ifndef BR_SOLVER_SWEEP_COST_H
#define BR_SOLVER_SWEEP_COST_H

struct br_sweep_cost {
    int fma, multiply, add; /* instructions on vectors of BR_LANES */
    int state;              /* doubles of a piece that stay from step to step; each is read and
                               written once a step from where all pieces fit */
};

/* By br_field_kind. To the left, then to the right. */
static const struct br_sweep_cost br_sweep_costs[2] = {
    {.fma = 3 + 6, .multiply = 0, .add = 1 + 4, .state = 2},
    {.fma = 12 + 24, .multiply = 0, .add = 1 + 6, .state = 4},
};

#endif
