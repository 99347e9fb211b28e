/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What commands, options and registries become in other languages than a terminal's. */
#ifndef BR_CLI_LANGUAGES_H
#define BR_CLI_LANGUAGES_H

#include "cli/command.h"

/* Writes the "man" page, docs/options.md ("markdown"), or the completions of "bash", "zsh" or
 * "fish" with the names of scenes, separated by blanks (NULL: none). */
void br_write_language(FILE *out, const char *name, const char *scenes);

/* "elements (default 100)"; returns text (out). */
const char *br_option_help(const struct br_option *row, char *text, size_t size);

/* What may be chosen by name, with what a person reads above it; returns how many (out). */
enum { BR_REGISTRIES = BR_METHOD_FIELDS + 3 };
struct br_registry {
    const char *option, *title;
    const struct br_words *words;
};
size_t br_registries(struct br_registry list[BR_REGISTRIES]);

#endif
