/* SPDX-License-Identifier: GPL-3.0-or-later */
/* --kernel: what every command with --solver makes of it. */
#ifndef BR_CLI_KERNEL_OPTION_H
#define BR_CLI_KERNEL_OPTION_H

#include <stdio.h>

#include "solver/status.h"
#include "solver/sweep_kernel.h"

/* The kernel of a name, which must be available here; text NULL: not given, *kernel stays. Fails
 * with BR_BAD_INPUT, naming what was found and what is expected. */
enum br_status br_read_kernel_option(const char *text, const struct br_kernel **kernel,
                                     struct br_error *err);

/* One line a kernel for help, with whether it is available here. */
void br_print_kernels(FILE *out);

#endif
