/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the element loops of sweep_kernel.c do for one element of BR_LANES pieces, for the
 * benchmark, which holds their time against the machine's limits. To be counted anew when the loops
 * change: objdump -d build/release/solver/libbeamrate-sweeps.a.p/sweep_kernel.c.o in step_avx512,
 * the loop to the left with a uniform load and the loop to the right of each field. Instructions
 * that only move values are not counted, nor are the joins. */
#ifndef BR_SWEEP_COST_H
#define BR_SWEEP_COST_H

struct br_sweep_cost {
    int fma, multiply, add; /* instructions on vectors of BR_LANES */
    int state;              /* doubles of a piece that stay from step to step; each is read and
                               written once a step from where all pieces fit */
};

/* By br_field_kind. To the left, then to the right. */
static const struct br_sweep_cost br_sweep_costs[2] = {
    {.fma = 3 + 8, .multiply = 0, .add = 1 + 3, .state = 2},
    {.fma = 12 + 28, .multiply = 0 + 2, .add = 1 + 5, .state = 4},
};

#endif
