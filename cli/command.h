/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Commands: one const record and one file each. Help, man page and completions come from the record
 * and the rows of its options. */
#ifndef BR_CLI_COMMAND_H
#define BR_CLI_COMMAND_H

#include "cli/option.h"

enum { BR_MOST_EXAMPLES = 8, BR_MOST_WORDS = 1 << 20 };

struct br_command {
    unsigned bit; /* of br_option.commands */
    const char *name;
    const char *arguments; /* for the usage line */
    const char *title;     /* one line for a person */
    const char *about;     /* what it does: sentences for the help */
    const char *more;      /* and more of them for the manual; NULL: none */
    const char *example[BR_MOST_EXAMPLES];
    size_t least_words, most_words; /* that are no options */
    const struct br_words *words;   /* what they are; NULL: scenes */
    /* The options are parsed. On failure err says why. */
    enum br_status (*run)(const struct br_options *options, struct br_error *err);
};

/* NULL-terminated, in the order of the help text. */
extern const struct br_command *const br_commands[];

#endif
