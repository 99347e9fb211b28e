/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Commands: one const record and one file each. */
#ifndef BR_CLI_COMMAND_H
#define BR_CLI_COMMAND_H

#include "solver/status.h"

struct br_command {
    const char *name;
    const char *arguments; /* for the usage line */
    const char *title;     /* one line for a person */
    /* argv[0] is the command's name. On failure err says why. */
    enum br_status (*run)(int argc, const char **argv, struct br_error *err);
};

/* NULL-terminated, in the order of the help text. */
extern const struct br_command *const br_commands[];

#endif
