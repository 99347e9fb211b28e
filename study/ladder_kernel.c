/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/ladder_kernel.h"

#define ROW(set) &br_ladder_##set,
const struct br_ladder_kernel *const br_ladder_kernels[] = {BR_INSTRUCTION_SETS(ROW) NULL};

const struct br_ladder_kernel *br_ladder_kernel_best(void)
{
    const struct br_ladder_kernel *const *kernel = br_ladder_kernels;
    while (!(*kernel)->available())
        kernel++;
    return *kernel;
}
