/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Commands: one const record and one file each. Help, man page and completions come from the record
 * and the rows of its options. */
#ifndef BR_CLI_COMMAND_H
#define BR_CLI_COMMAND_H

#include "cli/option.h"

enum { BR_MOST_EXAMPLES = 8, BR_MOST_WORDS = 1 << 20 };

struct br_session;

struct br_command {
    unsigned bit; /* its bit in br_option.commands */
    const char *name;
    const char *arguments; /* for the usage line */
    const char *title;     /* one line for a person */
    const char *about;     /* what it does: sentences for the help */
    const char *more;      /* further sentences for the manual; NULL: none */
    const char *example[BR_MOST_EXAMPLES];
    size_t least_words, most_words; /* number of arguments that are no options */
    const struct br_words *words;   /* the values that these may have; NULL: scenes */
    bool or_scenes;                 /* or scenes; `run` reads which is which */
    /* The options are parsed; the session is closed afterwards. On failure err says why. */
    enum br_status (*run)(const struct br_options *options, struct br_session *session,
                          struct br_error *err);
};

/* NULL-terminated, in the order of the help text. */
extern const struct br_command *const br_commands[];

/* NULL: there is none. */
const struct br_command *br_find_command(const char *name);

/* ---- the documentation and the completions, made from commands, options and registries ---- */

void br_print_command_help(FILE *out, const struct br_command *command);

/* Writes the "man" page, docs/options.md ("markdown"), or the completions of "bash", "zsh" or
 * "fish" with the names of scenes, separated by blanks (NULL: none). */
void br_write_language(FILE *out, const char *name, const char *scenes);

/* The help of an option, as "elements (default 100)"; returns text (out). */
const char *br_option_help(const struct br_option *row, char *text, size_t size);

/* The registries whose rows are chosen by name, with their headings; returns their number. */
enum { BR_REGISTRIES = BR_METHOD_FIELDS + 3 };
struct br_registry {
    const char *option, *title;
    const struct br_words *words;
};
size_t br_registries(struct br_registry list[BR_REGISTRIES]);

#endif
