/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/completion.h"
#include "study/scene/quote.h"

/* Bash splits a word at = (and :), so that --solver=x comes as three words. */
static const char head[] =
    "# Completion of beamrate in bash; written by 'beamrate completions bash'.\n"
    "\n"
    "_beamrate_words() { mapfile -t COMPREPLY < <(compgen -W \"$1\" -- \"$cur\"); }\n"
    "\n"
    "# Some of the words, separated by commas.\n"
    "_beamrate_list() {\n"
    "    local done=''\n"
    "    case $cur in *,*) done=${cur%,*}, ;; esac\n"
    "    mapfile -t COMPREPLY < <(compgen -P \"$done\" -W \"$1\" -- \"${cur##*,}\")\n"
    "    compopt -o nospace 2>/dev/null\n"
    "}\n"
    "\n"
    "_beamrate_files() {\n"
    "    mapfile -t COMPREPLY < <(compgen \"$@\" -- \"$cur\")\n"
    "    compopt -o filenames 2>/dev/null\n"
    "}\n"
    "\n"
    "_beamrate_scenes() {\n"
    "    mapfile -t COMPREPLY < <(compgen -W \"$1\" -- \"$cur\"\n"
    "        compgen -f -X '!*.yaml' -- \"$cur\"\n"
    "        compgen -d -- \"$cur\")\n"
    "    compopt -o filenames 2>/dev/null\n"
    "}\n"
    "\n"
    "_beamrate() {\n"
    "    local cur=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]} i=$((COMP_CWORD - 1))\n"
    "    [ \"$cur\" = '=' ] && cur='' i=$COMP_CWORD\n"
    "    [ \"${COMP_WORDS[i]}\" = '=' ] && i=$((i - 1))\n"
    "    local prev=${COMP_WORDS[i]}\n"
    "    COMPREPLY=()\n";

static void write_value(FILE *out, const char *command, const struct br_help_option *option)
{
    static const char *const actions[] = {
        [BR_VALUE_NONE] = "return",
        [BR_VALUE_FILE] = "_beamrate_files -f",
        [BR_VALUE_DIR] = "_beamrate_files -d",
        [BR_VALUE_WORD] = "_beamrate_words ",
        [BR_VALUE_LIST] = "_beamrate_list ",
    };
    const char *words;
    const enum br_value_kind kind = br_option_values(option, &words);
    if (!*option->argument)
        return;
    fprintf(out, "    %s,--%s) %s", command, option->name, actions[kind]);
    if (*words)
        br_quote(out, &br_for_completion, words);
    fprintf(out, " ;;\n");
}

static void write_command(FILE *out, const struct br_completions *all,
                          const struct br_completion *one)
{
    const char *name = one->command->name;
    for (size_t i = 0; i < one->help.count; i++)
        write_value(out, name, &one->help.option[i]);
    fprintf(out, "    %s,*) case $cur in -*) _beamrate_words '", name);
    for (size_t i = 0; i < one->help.count; i++)
        fprintf(out, "%s--%s", i ? " " : "", one->help.option[i].name);
    fprintf(out, "' ;; *) ");
    if (one->scenes)
        fprintf(out, "_beamrate_scenes '%s'", all->scenes);
    else
        fprintf(out, "_beamrate_words '%s'", one->words);
    fprintf(out, " ;; esac ;;\n");
}

static void write_bash(FILE *out, const struct br_completions *all)
{
    fprintf(out, "%s    if [ \"$COMP_CWORD\" -eq 1 ]; then\n        _beamrate_words '", head);
    for (size_t i = 0; i < all->count; i++)
        fprintf(out, "%s ", all->command[i].command->name);
    fprintf(out, "help --help --version'\n        return\n    fi\n    case $command,$prev in\n");
    for (size_t i = 0; i < all->count; i++)
        write_command(out, all, &all->command[i]);
    fprintf(out, "    help,*) _beamrate_words '");
    for (size_t i = 0; i < all->count; i++)
        fprintf(out, "%s%s", i ? " " : "", all->command[i].command->name);
    fprintf(out, "' ;;\n    esac\n}\n\ncomplete -F _beamrate beamrate\n");
}

const struct br_shell br_bash = {"bash", write_bash};
