/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kernels, apart from those who take one: a program may put another choice in the place of this
 * one when it is linked (tests/golden). */
#include "solver/linear/riccati/kernel.h"

#define ROW(set) &br_kernel_##set,
const struct br_kernel *const br_kernels[] = {BR_INSTRUCTION_SETS(ROW) NULL};

const struct br_kernel *br_kernel_best(void)
{
    return br_kernels[br_instruction_set_best()];
}

const struct br_kernel *br_kernel_find(const char *name)
{
    return br_kernels[br_instruction_set_find(name)];
}
