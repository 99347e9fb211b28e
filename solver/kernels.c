/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/sweep_kernel.h"

#include <string.h>

#define ROW(set) &br_kernel_##set,
const struct br_kernel *const br_kernels[] = {BR_INSTRUCTION_SETS(ROW) NULL};

const struct br_kernel *br_kernel_best(void)
{
    const struct br_kernel *const *kernel = br_kernels;
    while (!(*kernel)->available())
        kernel++;
    return *kernel;
}

const struct br_kernel *br_kernel_find(const char *name)
{
    for (const struct br_kernel *const *kernel = br_kernels; *kernel; kernel++)
        if (strcmp((*kernel)->name, name) == 0)
            return *kernel;
    return NULL;
}
