/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/kernel_option.h"

#include "cli/names.h"

enum br_status br_read_kernel_option(const char *text, const struct br_kernel **kernel,
                                     struct br_error *err)
{
    if (!text)
        return BR_OK;
    *kernel = br_kernel_find(text);
    if (*kernel && (*kernel)->available())
        return BR_OK;
    return br_fail(err, BR_BAD_INPUT, "--kernel: found '%s'%s, expected one of: %s", text,
                   *kernel ? ", which this machine does not have" : "", br_kernel_names());
}

void br_print_kernels(FILE *out)
{
    fprintf(out, "Kernels (--kernel), the first that is available is the default:\n");
    for (const struct br_kernel *const *k = br_kernels; *k; k++)
        fprintf(out, "  %-12s %s\n", (*k)->name,
                (*k)->available() ? "available here" : "not available on this machine");
}
