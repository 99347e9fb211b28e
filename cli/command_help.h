/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options of a command, as its own help lists them: popt's tables live in the commands. */
#ifndef BR_CLI_COMMAND_HELP_H
#define BR_CLI_COMMAND_HELP_H

#include "cli/command.h"

enum { BR_MOST_OPTIONS = 48 };

struct br_help_option {
    char name[32];     /* without -- */
    char argument[16]; /* FILE, DIR, NAME, LIST, COUNT...; "": none */
    char help[256];    /* one line */
};

struct br_command_help {
    struct br_help_option option[BR_MOST_OPTIONS];
    size_t count;
};

/* Runs the command with --help and reads what it prints; standard output is another one
 * meanwhile. Fails with BR_IO, or as the command does. */
enum br_status br_command_help_read(const struct br_command *command, struct br_command_help *help,
                                    struct br_error *err);

#endif
