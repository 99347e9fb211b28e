/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>

#include "cli/completion.h"
#include "study/scene/quote.h"

/* "--name=[text]", in which _arguments would take brackets and colons for its own. */
static void write_option(FILE *out, const struct br_help_option *option)
{
    fprintf(out, "            '--%s%s['", option->name, *option->argument ? "=" : "");
    br_quote(out, &br_for_zsh, option->help);
    fputs("']", out);
    const char *words;
    const enum br_value_kind kind = br_option_values(option, &words);
    if (*option->argument)
        fprintf(out, ":%s:", option->argument);
    switch (kind) {
    case BR_VALUE_NONE:
        break;
    case BR_VALUE_FILE:
        fprintf(out, "_files");
        break;
    case BR_VALUE_DIR:
        fprintf(out, "_files -/");
        break;
    case BR_VALUE_WORD:
    case BR_VALUE_LIST:
        fprintf(out, kind == BR_VALUE_LIST ? "_sequence compadd - " : "(");
        for (const char *c = words; *c; c++)
            *c == ':' ? fprintf(out, "\\:") : fputc(*c, out);
        fprintf(out, kind == BR_VALUE_LIST ? "" : ")");
        break;
    }
    fprintf(out, "' \\\n");
}

static void write_command(FILE *out, const struct br_completion *one)
{
    fprintf(out, "        %s)\n            _arguments \\\n", one->command->name);
    for (size_t i = 0; i < one->help.count; i++)
        write_option(out, &one->help.option[i]);
    if (one->scenes)
        fprintf(out, "            '*:scene:_beamrate_scenes'\n");
    else if (*one->words)
        fprintf(out, "            '%s:argument:(%s)'\n", one->many ? "*" : "", one->words);
    else
        fprintf(out, "            && return\n");
    fprintf(out, "            ;;\n");
}

static void write_zsh(FILE *out, const struct br_completions *all)
{
    fprintf(out,
            "#compdef beamrate\n# Completion of beamrate in zsh; written by 'beamrate completions "
            "zsh'.\n\n_beamrate_scenes() {\n    _alternative 'scenes:bundled scene:(%s)' "
            "'files:file:_files -g \"*.yaml\"'\n}\n\n_beamrate() {\n    local -a commands\n"
            "    commands=(\n",
            all->scenes);
    for (size_t i = 0; i < all->count; i++) {
        char line[256];
        snprintf(line, sizeof line, "%s:%s", all->command[i].command->name,
                 all->command[i].command->title);
        fprintf(out, "        ");
        br_quote(out, &br_for_completion, line);
        fputc('\n', out);
    }
    fprintf(out,
            "    )\n    local state line curcontext=$curcontext\n"
            "    _arguments -C '(- *)--help[lists the commands]' '(- *)--version[the version]' \\\n"
            "        '1:command:->command' '*::argument:->argument'\n"
            "    case $state in\n    command) _describe command commands ;;\n    argument)\n"
            "        case $words[1] in\n");
    for (size_t i = 0; i < all->count; i++)
        write_command(out, &all->command[i]);
    fprintf(out, "        esac\n        ;;\n    esac\n}\n\n"
                 "if [[ $funcstack[1] = _beamrate ]]; then\n    _beamrate \"$@\"\nelse\n"
                 "    compdef _beamrate beamrate\nfi\n");
}

const struct br_shell br_zsh = {"zsh", write_zsh};
