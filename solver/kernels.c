/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which kernels there are, and which of them this machine can run. */
#include "solver/sweep_kernel.h"

#include <string.h>

bool br_kernel_available_portable(void);
bool br_kernel_available_avx2(void);
bool br_kernel_available_avx512(void);

bool br_kernel_available_portable(void)
{
    return true;
}

#ifdef BR_X86_KERNELS
bool br_kernel_available_avx2(void)
{
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}

bool br_kernel_available_avx512(void)
{
    return br_kernel_available_avx2() && __builtin_cpu_supports("avx512f") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}
#endif

extern const struct br_kernel br_kernel_avx512, br_kernel_avx2, br_kernel_portable;

const struct br_kernel *const br_kernels[] = {
#ifdef BR_X86_KERNELS
    &br_kernel_avx512,
    &br_kernel_avx2,
#endif
    &br_kernel_portable,
    NULL,
};

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
