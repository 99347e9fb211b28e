/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a shell may complete, from the registries, and the shells: one const record and one file
 * each. */
#ifndef BR_CLI_COMPLETION_H
#define BR_CLI_COMPLETION_H

#include <stdbool.h>
#include <stdio.h>

#include "cli/command_help.h"

enum br_value_kind {
    BR_VALUE_NONE, /* nothing is known of it */
    BR_VALUE_FILE,
    BR_VALUE_DIR,
    BR_VALUE_WORD, /* one of some words */
    BR_VALUE_LIST, /* some of them, separated by commas */
};

struct br_completion {
    const struct br_command *command;
    struct br_command_help help;
    bool scenes;     /* its arguments are scenes: names, or files *.yaml */
    char words[256]; /* its argument is one of these; "": not so */
    bool many;       /* arguments, not one */
};

enum { BR_MOST_COMMANDS = 16 };

struct br_completions {
    struct br_completion command[BR_MOST_COMMANDS];
    size_t count;
    char scenes[2048]; /* the bundled ones, separated by blanks */
};

/* What an option takes; words (out): separated by blanks, static. */
enum br_value_kind br_option_values(const struct br_help_option *option, const char **words);

/* The words that "bash|zsh|fish" offers, or [PART...]; others: none. */
void br_argument_words(const char *arguments, char *words, size_t size);

/* A shell. */
struct br_shell {
    const char *name;
    void (*write)(FILE *out, const struct br_completions *completions);
};

extern const struct br_shell br_bash, br_zsh, br_fish;

/* NULL-terminated. */
extern const struct br_shell *const br_shells[];

#endif
