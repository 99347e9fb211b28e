/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate completions SHELL: what makes a shell complete commands, options and their values, from
 * the rows of the options. */
#include <string.h>

#include "cli/command.h"
#include "study/scene/file.h"
#include "study/scene/quote.h"

enum { MOST_SCENES = 8192, MOST_WORDS = 512 };

/* ---- what may stand where ---- */

enum value_kind { NOTHING, FILES, FOLDERS, ONE_WORD, SOME_WORDS };

/* What is known of an option's value; words (out): separated by blanks. A reference that wants
 * numbers ends with its colon. */
static enum value_kind value_of(const struct br_option *row, char words[MOST_WORDS])
{
    words[0] = '\0';
    if (row->kind == BR_TAKES_FILE || row->kind == BR_TAKES_DIR)
        return row->kind == BR_TAKES_FILE ? FILES : FOLDERS;
    const struct br_words *names =
        row->id == BR_OPT_METHODS ? br_method_fields[BR_METHOD_SCHEME].words : row->words;
    size_t used = 0;
    for (size_t i = 0; names && names->name(i) && used < MOST_WORDS; i++) {
        const char *name = names->name(i);
        const size_t colon = strcspn(name, ":"), length = colon + (name[colon] == ':');
        used += (size_t)snprintf(words + used, MOST_WORDS - used, "%s%.*s", i ? " " : "",
                                 (int)length, name);
    }
    if (!names)
        return NOTHING;
    return strcmp(row->argument, "LIST") == 0 ? SOME_WORDS : ONE_WORD;
}

/* The words of a command that are no options; "": none, or scenes. */
static const char *argument_words(const struct br_command *c, char words[MOST_WORDS])
{
    words[0] = '\0';
    return c->words ? br_words_join(c->words, " ", words, MOST_WORDS) : words;
}

static bool takes_scenes(const struct br_command *c)
{
    return !c->words && c->most_words > 0;
}

/* Bundled scenes, separated by blanks. */
static enum br_status collect_scenes(char text[MOST_SCENES], struct br_error *err)
{
    char **name;
    size_t count, used = 0;
    const enum br_status status = br_scene_list(&name, &count, err);
    text[0] = '\0';
    for (size_t i = 0; i < count && !status && used < MOST_SCENES; i++)
        if (br_is_name(name[i]) && !strchr(name[i], ' ')) /* else no shell could complete it */
            used +=
                (size_t)snprintf(text + used, MOST_SCENES - used, "%s%s", used ? " " : "", name[i]);
    br_scene_list_free(name, count);
    return status;
}

/* ---- bash ---- */

/* Bash splits a word at = (and :), so that --solver=x comes as three words. */
static const char bash_head[] =
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

static void bash_value(FILE *out, const char *command, const struct br_option *row)
{
    static const char *const actions[] = {
        [NOTHING] = "return",
        [FILES] = "_beamrate_files -f",
        [FOLDERS] = "_beamrate_files -d",
        [ONE_WORD] = "_beamrate_words ",
        [SOME_WORDS] = "_beamrate_list ",
    };
    char words[MOST_WORDS];
    const enum value_kind kind = value_of(row, words);
    if (!row->argument)
        return;
    fprintf(out, "    %s,--%s", command, row->name);
    if (row->letter)
        fprintf(out, " | %s,-%c", command, row->letter);
    fprintf(out, ") %s", actions[kind]);
    if (*words)
        br_quote(out, &br_for_completion, words);
    fprintf(out, " ;;\n");
}

static void bash_command(FILE *out, const struct br_command *c, const char *scenes)
{
    struct br_option row[BR_OPTIONS];
    const size_t count = br_options_of(c, row);
    char words[MOST_WORDS];
    for (size_t i = 0; i < count; i++)
        bash_value(out, c->name, &row[i]);
    fprintf(out, "    %s,*) case $cur in -*) _beamrate_words '", c->name);
    for (size_t i = 0; i < count; i++)
        fprintf(out, "%s--%s", i ? " " : "", row[i].name);
    fprintf(out, "' ;; *) ");
    if (takes_scenes(c))
        fprintf(out, "_beamrate_scenes '%s'", scenes);
    else
        fprintf(out, "_beamrate_words '%s'", argument_words(c, words));
    fprintf(out, " ;; esac ;;\n");
}

static void write_bash(FILE *out, const char *scenes)
{
    fprintf(out, "%s    if [ \"$COMP_CWORD\" -eq 1 ]; then\n        _beamrate_words '", bash_head);
    for (const struct br_command *const *c = br_commands; *c; c++)
        fprintf(out, "%s ", (*c)->name);
    fprintf(out, "--help --version'\n        return\n    fi\n    case $command,$prev in\n");
    for (const struct br_command *const *c = br_commands; *c; c++)
        bash_command(out, *c, scenes);
    fprintf(out, "    esac\n}\n\ncomplete -F _beamrate beamrate\n");
}

/* ---- zsh ---- */

static void zsh_values(FILE *out, const struct br_option *row)
{
    char words[MOST_WORDS];
    const enum value_kind kind = value_of(row, words);
    if (row->argument)
        fprintf(out, ":%s:", row->argument);
    if (kind == FILES || kind == FOLDERS)
        fprintf(out, kind == FILES ? "_files" : "_files -/");
    if (kind == ONE_WORD || kind == SOME_WORDS) {
        fprintf(out, kind == SOME_WORDS ? "_sequence compadd - " : "(");
        for (const char *c = words; *c; c++)
            *c == ':' ? fprintf(out, "\\:") : fputc(*c, out);
        fprintf(out, kind == SOME_WORDS ? "" : ")");
    }
}

/* "--name=[text]", in which _arguments would take brackets and colons for its own. */
static void zsh_option(FILE *out, const struct br_option *row)
{
    for (int is_short = row->letter ? 1 : 0; is_short >= 0; is_short--) {
        if (is_short)
            fprintf(out, "            '-%c%s[", row->letter, row->argument ? "+" : "");
        else
            fprintf(out, "            '--%s%s[", row->name, row->argument ? "=" : "");
        br_quote(out, &br_for_zsh, row->help);
        fputc(']', out);
        zsh_values(out, row);
        fprintf(out, "' \\\n");
    }
}

static void zsh_command(FILE *out, const struct br_command *c)
{
    struct br_option row[BR_OPTIONS];
    const size_t count = br_options_of(c, row);
    char words[MOST_WORDS];
    fprintf(out, "        %s)\n            _arguments \\\n", c->name);
    for (size_t i = 0; i < count; i++)
        zsh_option(out, &row[i]);
    if (takes_scenes(c))
        fprintf(out, "            '*:scene:_beamrate_scenes'\n");
    else if (*argument_words(c, words))
        fprintf(out, "            '%s:argument:(%s)'\n", c->most_words > 1 ? "*" : "", words);
    else
        fprintf(out, "            && return\n");
    fprintf(out, "            ;;\n");
}

static void write_zsh(FILE *out, const char *scenes)
{
    fprintf(out,
            "#compdef beamrate\n# Completion of beamrate in zsh; written by 'beamrate completions "
            "zsh'.\n\n_beamrate_scenes() {\n    _alternative 'scenes:bundled scene:(%s)' "
            "'files:file:_files -g \"*.yaml\"'\n}\n\n_beamrate() {\n    local -a commands\n"
            "    commands=(\n",
            scenes);
    for (const struct br_command *const *c = br_commands; *c; c++) {
        char line[256];
        snprintf(line, sizeof line, "%s:%s", (*c)->name, (*c)->title);
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
    for (const struct br_command *const *c = br_commands; *c; c++)
        zsh_command(out, *c);
    fprintf(out, "        esac\n        ;;\n    esac\n}\n\n"
                 "if [[ $funcstack[1] = _beamrate ]]; then\n    _beamrate \"$@\"\nelse\n"
                 "    compdef _beamrate beamrate\nfi\n");
}

/* ---- fish ---- */

static void fish_condition(FILE *out, const struct br_command *c)
{
    fprintf(out, "complete -c beamrate -n '__fish_seen_subcommand_from %s'", c->name);
}

static void fish_option(FILE *out, const struct br_command *c, const struct br_option *row)
{
    char words[MOST_WORDS];
    const enum value_kind kind = value_of(row, words);
    fish_condition(out, c);
    fprintf(out, " -l %s", row->name);
    if (row->letter)
        fprintf(out, " -s %c", row->letter);
    if (kind == FILES)
        fprintf(out, " -r -F");
    else if (kind == FOLDERS)
        fprintf(out, " -x -a '(__fish_complete_directories)'");
    else if (kind == SOME_WORDS)
        fprintf(out, " -x -a '(__fish_append , %s)'", words);
    else if (kind == ONE_WORD)
        fprintf(out, " -x -a '%s'", words);
    else if (row->argument)
        fprintf(out, " -x");
    fprintf(out, " -d ");
    br_quote(out, &br_for_completion, row->help);
    fputc('\n', out);
}

static void fish_command(FILE *out, const struct br_command *c)
{
    struct br_option row[BR_OPTIONS];
    const size_t count = br_options_of(c, row);
    char words[MOST_WORDS];
    fprintf(out, "\ncomplete -c beamrate -n __fish_use_subcommand -a %s -d ", c->name);
    br_quote(out, &br_for_completion, c->title);
    fputc('\n', out);
    if (takes_scenes(c) || *argument_words(c, words)) {
        fish_condition(out, c);
        fprintf(out, " -a '%s'\n",
                takes_scenes(c) ? "$__beamrate_scenes (__fish_complete_suffix .yaml)" : words);
    }
    for (size_t i = 0; i < count; i++)
        fish_option(out, c, &row[i]);
}

static void write_fish(FILE *out, const char *scenes)
{
    fprintf(out,
            "# Completion of beamrate in fish; written by 'beamrate completions fish'.\n"
            "set -g __beamrate_scenes %s\n\ncomplete -c beamrate -f\n"
            "complete -c beamrate -n __fish_use_subcommand -l help -d 'lists the commands'\n"
            "complete -c beamrate -n __fish_use_subcommand -l version -d 'the version'\n",
            scenes);
    for (const struct br_command *const *c = br_commands; *c; c++)
        fish_command(out, *c);
}

/* ---- the command ---- */

static const struct {
    const char *name;
    void (*write)(FILE *out, const char *scenes);
} shells[] = {{"bash", write_bash}, {"zsh", write_zsh}, {"fish", write_fish}, {NULL, NULL}};

static const char *shell_name(size_t row)
{
    return shells[row].name;
}

static const struct br_words shell_words = {shell_name, NULL, NULL};

static enum br_status run(const struct br_options *o, struct br_error *err)
{
    static char scenes[MOST_SCENES];
    size_t row;
    enum br_status status = br_words_read(&shell_words, o->word[0], strlen(o->word[0]), &row, err);
    if (!status)
        status = collect_scenes(scenes, err);
    if (!status)
        shells[row].write(stdout, scenes);
    return status;
}

const struct br_command br_command_completions = {
    .bit = BR_FOR_COMPLETIONS,
    .name = "completions",
    .arguments = "bash|zsh|fish",
    .title = "makes a shell complete commands, options, values and scenes",
    .about = "Prints what makes a shell complete the commands, their options, values and scenes.",
    .more = "It is installed where the shells look for it.",
    .example = {"beamrate completions bash > beamrate.bash", "beamrate completions zsh > _beamrate",
                "beamrate completions fish > beamrate.fish"},
    .least_words = 1,
    .most_words = 1,
    .words = &shell_words,
    .run = run,
};
