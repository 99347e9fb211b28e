/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/grid/ladder_kernel.h"

#include <string.h>

#define ROW(set) &br_ladder_##set,
const struct br_ladder_kernel *const br_ladder_kernels[] = {BR_INSTRUCTION_SETS(ROW) NULL};

const struct br_ladder_kernel *br_ladder_kernel_best(void)
{
    const struct br_ladder_kernel *const *kernel = br_ladder_kernels;
    while (!(*kernel)->available())
        kernel++;
    return *kernel;
}

const struct br_ladder_kernel *br_ladder_kernel_find(const char *name)
{
    for (const struct br_ladder_kernel *const *kernel = br_ladder_kernels; *kernel; kernel++)
        if (strcmp((*kernel)->name, name) == 0)
            return *kernel;
    return NULL;
}
