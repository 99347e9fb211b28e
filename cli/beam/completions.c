/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate completions bash: a script by which the shell completes commands, options, values and
 * scenes. Other shells: docs/results.md. */
#include <stdio.h>
#include <string.h>

#include "base/quote.h"
#include "cli/beam/beam.h"
#include "study/scene/file.h"

/* Bash splits a word at = (and :), so that --solver=x comes as three words. The script also runs in
 * zsh (bashcompinit), which lacks mapfile and compopt. */
static const char head[] =
    "# Offers the lines of standard input.\n"
    "_beamrate_offer() {\n"
    "    local line\n"
    "    while IFS= read -r line; do COMPREPLY+=(\"$line\"); done\n"
    "}\n"
    "\n"
    "_beamrate_words() { _beamrate_offer < <(compgen -W \"$1\" -- \"$cur\"); }\n"
    "\n"
    "# Some of the words, separated by commas.\n"
    "_beamrate_list() {\n"
    "    local before=''\n"
    "    case $cur in *,*) before=${cur%,*}, ;; esac\n"
    "    _beamrate_offer < <(compgen -P \"$before\" -W \"$1\" -- \"${cur##*,}\")\n"
    "    compopt -o nospace 2>/dev/null\n"
    "}\n"
    "\n"
    "# Files, by the options of compgen.\n"
    "_beamrate_files() {\n"
    "    _beamrate_offer < <(compgen \"$@\" -- \"$cur\")\n"
    "    compopt -o filenames 2>/dev/null\n"
    "}\n"
    "\n"
    "# The words, and scenes.\n"
    "_beamrate_scenes() {\n"
    "    _beamrate_words \"$1 $_beamrate_bundled\"\n"
    "    _beamrate_files -f -X '!*.yaml'\n"
    "    _beamrate_files -d\n"
    "}\n"
    "\n"
    "_beamrate() {\n"
    "    local cur=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]} i=$((COMP_CWORD - 1))\n"
    "    [ \"$cur\" = '=' ] && cur='' i=$COMP_CWORD\n"
    "    [ \"${COMP_WORDS[i]}\" = '=' ] && i=$((i - 1))\n"
    "    local prev=${COMP_WORDS[i]}\n"
    "    COMPREPLY=()\n";

/* The bundled scenes. No shell could complete the names that are left out. */
static enum br_status write_scenes(struct br_error *err)
{
    char **name;
    size_t count;
    const enum br_status status = br_scene_list(&name, &count, err);
    printf("_beamrate_bundled='");
    for (size_t i = 0; i < count && !status; i++)
        if (br_is_name(name[i]) && !strchr(name[i], ' '))
            printf("%s%s", i ? " " : "", name[i]);
    printf("'\n\n");
    br_scene_list_free(name, count);
    return status;
}

/* The words that may be chosen; NULL: none. A reference that needs numbers ends with its colon. */
static void write_words(const struct br_words *words)
{
    for (size_t i = 0; words && words->name(i); i++) {
        const char *name = words->name(i);
        const size_t colon = strcspn(name, ":"), length = colon + (name[colon] == ':');
        printf("%s%.*s", i ? " " : "", (int)length, name);
    }
}

/* What follows an option; a flag has nothing. */
static void write_option(const char *command, const struct br_option *row)
{
    const struct br_words *words =
        row->id == BR_OPT_METHODS ? br_method_fields[BR_METHOD_SCHEME].words : row->words;
    if (!row->argument)
        return;
    printf("    %s,--%s", command, row->name);
    if (row->letter)
        printf(" | %s,-%c", command, row->letter);
    if (row->kind == BR_TAKES_FILE || row->kind == BR_TAKES_DIR)
        printf(") _beamrate_files -%c ;;\n", row->kind == BR_TAKES_FILE ? 'f' : 'd');
    else if (words) {
        printf(") _beamrate_%s '", strcmp(row->argument, "LIST") == 0 ? "list" : "words");
        write_words(words);
        printf("' ;;\n");
    } else
        printf(") return ;;\n");
}

/* Its options' values, then all options and arguments. */
static void write_command(const struct br_command *c)
{
    struct br_option row[BR_OPTIONS];
    const size_t count = br_options_of(c, row);
    const bool scenes = c->or_scenes || (!c->words && c->most_words > 0);
    for (size_t i = 0; i < count; i++)
        write_option(c->name, &row[i]);
    printf("    %s,*) case $cur in -*) _beamrate_words '", c->name);
    for (size_t i = 0; i < count; i++)
        printf("%s--%s", i ? " " : "", row[i].name);
    printf("' ;; *) ");
    if (c->bit == BR_FOR_ORDERS)
        printf("_beamrate_files -f");
    else {
        printf("_beamrate_%s '", scenes ? "scenes" : "words");
        write_words(c->words);
        printf("'%s", c->bit == BR_FOR_TRADE ? "; _beamrate_files -f" : "");
    }
    printf(" ;; esac ;;\n");
}

static enum br_status run(const struct br_options *o, struct br_session *session,
                          struct br_error *err)
{
    (void)o;
    (void)session;
    printf("# Completion of beamrate in bash; written by 'beamrate completions bash'.\n\n");
    if (write_scenes(err))
        return err->status;
    printf("%s    if [ \"$COMP_CWORD\" -eq 1 ]; then\n        _beamrate_words '", head);
    for (const struct br_command *const *c = br_program.commands; *c; c++)
        printf("%s ", (*c)->name);
    printf("--help --version'\n        return\n    fi\n    case $command,$prev in\n");
    for (const struct br_command *const *c = br_program.commands; *c; c++)
        write_command(*c);
    printf("    esac\n}\n\ncomplete -F _beamrate beamrate\n");
    return BR_OK;
}

static const char *shell_name(size_t row)
{
    return row == 0 ? "bash" : NULL;
}

static const struct br_words shell_words = {shell_name, NULL, NULL};

const struct br_command br_command_completions = {
    .bit = BR_FOR_COMPLETIONS,
    .name = "completions",
    .arguments = "bash",
    .title = "makes the shell complete commands, options, values and scenes",
    .about = "Prints a script by which bash completes the commands, their options, values and "
             "scenes. zsh reads it after 'autoload -U bashcompinit && bashcompinit'.",
    .more = "It is installed where bash looks for it. fish makes completions of its own from the "
            "manual page, by fish_update_completions.",
    .example = {"completions bash > beamrate.bash"},
    .least_words = 1,
    .most_words = 1,
    .words = &shell_words,
    .run = run,
};
