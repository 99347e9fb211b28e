/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the rows of commands, options and registries in five languages: the manual page,
 * docs/options.md, and the completions of bash, zsh and fish. One function walks over all rows.
 * Each language has a pattern for each kind of row.
 *
 * In a pattern, %n is the field n; a capital, %N, is the same field quoted for the language. Text
 * between { and } is left out if one of its fields is empty; %?n prints nothing, but counts as a
 * field there. %{, %} and %% are these characters. The fields, by their letters:
 *   c a command's name   s its arguments   t its title, or a word's   b about   m more of it
 *   e an example         o all options     g its arguments' words     p the pattern for these
 *   j "*": several arguments may be given
 *   n an option's name   l its letter      a its argument             d its default
 *   h its help           i with the default
 *   w words that may be chosen, or one     v the pattern of a value
 *   u what a word without a title is       q "name:title" as a string of a shell
 *   x the version        z the bundled scenes */
#include "cli/beam/beam.h"

#include <ctype.h>
#include <string.h>

#include "base/quote.h"
#include "cli/provenance.h"
#include "study/scene/file.h"

enum { MOST_SCENES = 8192, MOST_WORDS = 512, MOST_OPTIONS = 1024 };

/* The kinds of an option's value, and of a command's arguments. */
enum value { FLAG, ANYTHING, FILES, FOLDERS, ONE_WORD, SOME_WORDS, VALUES };
enum arguments { NONE, WORDS, SCENES, EITHER, ARGUMENTS };

struct language {
    const char *name;
    const struct br_quoting *quoting, *words_quoting; /* for capitals; for %W */
    const char *head, *listed, *middle; /* before all; of each command; before the commands */
    const char *command;                /* at its start */
    const char *examples, *example, *examples_end;
    bool examples_first; /* examples follow the start, else the end */
    const char *option;
    const char *value[VALUES], *arguments[ARGUMENTS];
    const char *words, *word; /* before the words; for each word */
    const char *end;          /* of a command */
    const char *method; /* stands for the options of the method, which then follow all commands */
    const char *methods, *registry; /* before the registries; before each */
    const char *section, *paragraph, *next_paragraph;
    const char *foot;
};

struct fields {
    const char *of['z' + 1];
};

/* ---- patterns ---- */

/* The end of the group that begins here. */
static const char *group_end(const char *p)
{
    for (int depth = 1;; p++) {
        if (*p == '%')
            p++;
        else if (*p == '{')
            depth++;
        else if (*p == '}' && --depth == 0)
            return p;
    }
}

static const char *field(const struct fields *f, char letter)
{
    const char *text = isalpha((unsigned char)letter) ? f->of[tolower((unsigned char)letter)] : "-";
    return text ? text : "";
}

/* Whether all fields of a group have text. Fields of inner groups do not count. */
static bool is_filled(const char *p, const char *end, const struct fields *f)
{
    bool filled = true;
    for (; p < end; p++)
        if (*p == '{')
            p = group_end(p + 1);
        else if (*p == '%') {
            p += p[1] == '?' ? 2 : 1;
            filled &= *field(f, *p) != '\0';
        }
    return filled;
}

static void put(FILE *out, const struct language *l, const char *p, const char *end,
                const struct fields *f)
{
    for (; p < end; p++) {
        if (*p == '{') {
            const char *close = group_end(p + 1);
            if (is_filled(p + 1, close, f))
                put(out, l, p + 1, close, f);
            p = close;
            continue;
        }
        const bool escaped = *p == '%', question = escaped && p[1] == '?';
        p += question ? 2 : escaped ? 1 : 0;
        const char *text = escaped ? field(f, *p) : "";
        if (question)
            continue;
        if (escaped && (*p == 'v' || *p == 'p')) /* these two are patterns */
            put(out, l, text, text + strlen(text), f);
        else if (escaped && isupper((unsigned char)*p))
            br_quote(out, *p == 'W' ? l->words_quoting : l->quoting, text);
        else if (escaped && isalpha((unsigned char)*p))
            fputs(text, out);
        else
            fputc(*p, out);
    }
}

static void emit(FILE *out, const struct language *l, const char *pattern, const struct fields *f)
{
    if (pattern)
        put(out, l, pattern, pattern + strlen(pattern), f);
}

/* ---- the walk ---- */

/* words (out): the possible values, separated by blanks. A reference that needs numbers ends with
 * its colon. */
static enum value value_of(const struct br_option *row, char words[MOST_WORDS])
{
    const struct br_words *names =
        row->id == BR_OPT_METHODS ? br_method_fields[BR_METHOD_SCHEME].words : row->words;
    words[0] = '\0';
    if (row->kind == BR_TAKES_FILE || row->kind == BR_TAKES_DIR)
        return row->kind == BR_TAKES_FILE ? FILES : FOLDERS;
    if (!names)
        return row->argument ? ANYTHING : FLAG;
    for (size_t i = 0; names->name(i); i++) {
        const char *name = names->name(i);
        const size_t colon = strcspn(name, ":"), length = colon + (name[colon] == ':');
        br_append(words, MOST_WORDS, "%s%.*s", i ? " " : "", (int)length, name);
    }
    return strcmp(row->argument, "LIST") == 0 ? SOME_WORDS : ONE_WORD;
}

static void write_option(FILE *out, const struct language *l, const struct br_option *row,
                         struct fields f)
{
    char words[MOST_WORDS], help[512], standard[BR_OPTION_TEXT];
    const char letter[] = {row->letter, '\0'};
    f.of['n'] = row->name;
    f.of['l'] = letter;
    f.of['a'] = row->argument;
    f.of['d'] = br_option_default(row, standard);
    f.of['h'] = row->help;
    f.of['i'] = br_option_help(row, help, sizeof help);
    f.of['m'] = row->more;
    f.of['v'] = l->value[value_of(row, words)];
    f.of['w'] = words;
    emit(out, l, l->option, &f);
}

static void write_words(FILE *out, const struct language *l, const struct br_words *words,
                        struct fields f)
{
    emit(out, l, l->words, &f);
    for (size_t i = 0; words->name(i); i++) {
        f.of['w'] = words->name(i);
        f.of['t'] = words->title ? words->title(i) : NULL;
        f.of['u'] = words->title ? NULL : "an instruction set";
        emit(out, l, l->word, &f);
    }
}

static void write_examples(FILE *out, const struct language *l, const struct br_command *c,
                           struct fields f)
{
    emit(out, l, l->examples, &f);
    for (size_t i = 0; i < BR_MOST_EXAMPLES && c->example[i]; i++) {
        f.of['e'] = c->example[i];
        emit(out, l, l->example, &f);
    }
    emit(out, l, l->examples_end, &f);
}

/* Writes a command with its options, arguments and examples. */
static void write_command(FILE *out, const struct language *l, const struct br_command *c,
                          struct fields f)
{
    struct br_option row[BR_OPTIONS];
    const size_t count = br_options_of(c, row);
    char words[MOST_WORDS] = "", options[MOST_OPTIONS] = "";
    for (size_t i = 0; i < count; i++)
        br_append(options, sizeof options, "%s--%s", i ? " " : "", row[i].name);
    if (c->words)
        br_words_join(c->words, " ", words, sizeof words);
    f.of['s'] = c->arguments;
    f.of['b'] = c->about;
    f.of['m'] = c->more;
    f.of['o'] = options;
    f.of['g'] = words;
    f.of['j'] = c->most_words > 1 ? "*" : "";
    f.of['p'] = l->arguments[c->or_scenes                     ? EITHER
                             : *words                         ? WORDS
                             : !c->words && c->most_words > 0 ? SCENES
                                                              : NONE];
    emit(out, l, l->command, &f);
    if (l->examples_first)
        write_examples(out, l, c, f);
    for (size_t i = 0; i < count; i++)
        if (!l->method || row[i].id < BR_OPT_METHOD)
            write_option(out, l, &row[i], f);
    if (row[count - 1].id >= BR_OPT_METHOD)
        emit(out, l, l->method, &f);
    if (c->words && c->words->title)
        write_words(out, l, c->words, f);
    if (!l->examples_first)
        write_examples(out, l, c, f);
    emit(out, l, l->end, &f);
}

/* Writes all rows, also of solvers that this machine lacks: the text is the same everywhere. */
static void write_methods(FILE *out, const struct language *l, struct fields f)
{
    struct br_registry list[BR_REGISTRIES];
    struct br_option row[BR_OPTIONS];
    const size_t count = br_registries(list), options = br_options_of(br_find_command("run"), row);
    emit(out, l, l->methods, &f);
    for (size_t i = 0; i < options; i++)
        if (row[i].id >= BR_OPT_METHOD)
            write_option(out, l, &row[i], f);
    for (size_t i = 0; i < count; i++) {
        f.of['n'] = list[i].option;
        f.of['h'] = list[i].title;
        emit(out, l, l->registry, &f);
        write_words(out, l, list[i].words, f);
    }
}

/* Sections of the manual page that come from no row; each line is a paragraph. */
static const struct {
    const char *title, *text[8];
} sections[] = {
    {"WHAT IS SAID BEFORE A MARCH",
     {"run predicts two errors, both relative to the solution: the discretisation error, with "
      "bounds, from coarse marches, and the round-off of the linear solver. If it cannot predict "
      "an error, it says so. It warns on standard error, with a remedy, in these cases: round-off "
      "is larger than the discretisation error; the discretisation error is above 5 %; a load "
      "changes faster than the time steps or the quadrature of the elements resolve; a lagged "
      "contact will be unstable, or may gain energy. A march that needs more memory than there is, "
      "or more than a century, is refused before a folder is made. A march of more than a day "
      "gives a warning. The other commands give the warnings that are cheap to compute; study and "
      "tables add up the memory of marches that run at once."}},
    {"MORE MACHINES",
     {"If mpirun or srun starts the program (with MPI built in), the ranks share the work, and "
      "only rank 0 prints and writes. The results are those of one process, to the bit. --threads "
      "is the number for each rank; by default a rank uses the cores that it is bound to, shared "
      "with the ranks that are bound to the same ones. All ranks must see the same scenes. A build "
      "without MPI refuses to be started several times."}},
    {"SCENES",
     {"A scene is a YAML file; every number carries its unit, loads and initial data are "
      "expressions in x and t. What it leaves out is not modelled. 'beamrate scenes "
      "--new' explains every key. It is read once, from a file, a pipe, or standard input "
      "(-), and is refused beyond 1 MiB."}},
    {"FILES",
     {"Every table NAME is written as NAME.txt, .csv, .md, .tex and .json. Every plot is written "
      "as a gnuplot script NAME-*.gp with its data NAME-*.dat and, where gnuplot is installed, as "
      ".svg and .png. If gnuplot fails on a picture, a warning names it and only that picture is "
      "missing; the exit code is that of the results. The NAME of a scene is that of its file, at "
      "most 100 bytes, where _ replaces all but letters, digits, blanks and _ . - +.",
      "A folder holds the files of one run, a set. The list .beamrate-set names them, a line each. "
      "New files are written in the hidden folder .beamrate-new, under the lock of .beamrate-lock: "
      "a second program that would write there is refused. Then the new list is put into the "
      "hidden folder: from now on the new set counts. The files are renamed into place, the other "
      "files of the old set are removed, and the new list replaces the old one last. A program "
      "that is killed before the new set counts leaves the old set; if it is killed later, the "
      "next command with the same folder completes the new set first. A file that the list does "
      "not name is never replaced or removed: if it is in the way, the results go into the folder "
      "set-1 beside it (or the next free number), and the exit code is 3.",
      "Installed: share/beamrate/study/scenes (the bundled scenes), "
      "and the completions of bash, zsh and fish."}},
    {"ENVIRONMENT",
     {"BEAMRATE_DATA: the folder that holds study/scenes, instead "
      "of the one the program was built or installed with.",
      "BEAMRATE_SILENCE: seconds after which a rank that sends nothing is regarded as dead, 60 by "
      "default.",
      "BEAMRATE_GNUPLOT_SECONDS: seconds that gnuplot may take for one script, 60 by default; then "
      "it is killed. An interrupt kills it, too.",
      "TMPDIR: the folder for the runs of orders --run, /tmp by default."}},
    {"EXIT STATUS",
     {"0 done; 1 a verdict failed; 2 bad input; 3 the computation failed. If a cell failed, the "
      "exit code is 3 after the results have been written; a march of run that stops early keeps "
      "what it has written. An interrupted program ends by its signal and leaves no file half "
      "written. A second signal may leave a hidden folder; the next command that writes there "
      "removes it, or puts its set in place."}},
    {"SEE ALSO", {"gnuplot(1), mpirun(1)"}},
};

static void write_all(FILE *out, const struct language *l, const char *scenes)
{
    struct fields f = {.of = {['x'] = br_version(), ['z'] = scenes}};
    char line[256], quoted[300];
    emit(out, l, l->head, &f);
    for (int body = 0; body < 2; body++) {
        for (const struct br_command *const *c = br_program.commands; *c; c++) {
            snprintf(line, sizeof line, "%s:%s", (*c)->name, (*c)->title);
            f.of['c'] = (*c)->name;
            f.of['t'] = (*c)->title;
            f.of['q'] = br_quoted(quoted, sizeof quoted, &br_for_completion, line);
            if (body)
                write_command(out, l, *c, f);
            else
                emit(out, l, l->listed, &f);
        }
        emit(out, l, body ? NULL : l->middle, &f);
    }
    if (l->methods)
        write_methods(out, l, f);
    for (size_t i = 0; l->section && i < sizeof sections / sizeof *sections; i++) {
        f.of['t'] = sections[i].title;
        emit(out, l, l->section, &f);
        for (size_t j = 0; sections[i].text[j]; j++) {
            f.of['b'] = sections[i].text[j];
            emit(out, l, j ? l->next_paragraph : l->paragraph, &f);
        }
    }
    emit(out, l, l->foot, &f);
}

/* ---- the languages ---- */

/* Escapes the characters that roff, or Markdown, would take as markup. */
static const struct br_quoting for_roff = {
    .around = "", .start = ".'", .prefix = "\\&", .stead = {{'-', "\\-"}, {'\\', "\\e"}}};
static const struct br_quoting for_page = {
    .around = "", .stead = {{'|', "\\|"}, {'<', "\\<"}, {'*', "\\*"}, {'_', "\\_"}}};
static const struct br_quoting for_zsh_words = {.around = "", .stead = {{':', "\\:"}}};

#define NOT_HEEDED "An option that the chosen method does not use is refused."
#define TABLE_OF_OPTIONS "| option | default | what it does |\n|---|---|---|\n"

static const struct language languages[] = {
    {
        .name = "man",
        .quoting = &for_roff,
        .head = ".\\\" SPDX-License-Identifier: GPL-3.0-or-later\n"
                ".\\\" Written by 'beamrate help man'.\n"
                ".TH BEAMRATE 1 2026 \"beamrate %x\" \"User Commands\"\n.SH NAME\n"
                "beamrate \\- convergence studies of the dynamic frictional contact of a "
                "viscoelastic beam\n.SH SYNOPSIS\n"
                ".B beamrate\n.I command\n.RI [ option ...]\n.SH COMMANDS\n",
        .command = ".SS beamrate %c{ %s}\n%B\n{%M\n}",
        .option = ".TP\n.B {\\-%l, }\\-\\-%N{ \\fI%a\\fR}\n%I.\n{%M\n}",
        .method = ".PP\nThe options of the method apply, too; see below.\n",
        .word = ".TP\n.B %w\n%T%u\n",
        .examples = ".PP\n.nf\n",
        .example = "%E\n",
        .examples_end = ".fi\n",
        .methods = ".SH OPTIONS OF THE METHOD\n" NOT_HEEDED "\n",
        .registry = ".SS \"\\-\\-%n: %h\"\n",
        .section = ".SH %t\n",
        .paragraph = "%B\n",
        .next_paragraph = ".PP\n%B\n",
    },
    {
        .name = "markdown",
        .quoting = &for_page,
        .head = "# Options\n\nWritten by `beamrate help markdown`. `T` is the duration of the "
                "scene: `--k T/100` makes 100 steps.\n",
        .command = "\n## beamrate %c{ %s}\n\n%B{ %M}\n\n",
        .examples = "```sh\n",
        .example = "%e\n",
        .examples_end = "```\n\n" TABLE_OF_OPTIONS,
        .examples_first = true,
        .option = "| {`-%l`, }`--%n{ %a}` | %d | %H{. %M} |\n",
        .method = "\nThe [options of the method](#options-of-the-method) apply, too.\n",
        .words = "\n",
        .word = "- `%w`{: %T}\n",
        .methods = "\n## Options of the method\n\n" NOT_HEEDED "\n\n" TABLE_OF_OPTIONS,
        .registry = "\n### --%n: %h\n",
    },
    {
        .name = "bash",
        .words_quoting = &br_for_completion,
        /* Bash splits a word at = (and :), so that --solver=x comes as three words. */
        .head =
            "# Completion of beamrate in bash; written by 'beamrate completions bash'.\n"
            "\n"
            "_beamrate_words() %{ mapfile -t COMPREPLY < <(compgen -W \"$1\" -- \"$cur\"); %}\n"
            "\n"
            "# Some of the words, separated by commas.\n"
            "_beamrate_list() %{\n"
            "    local done=''\n"
            "    case $cur in *,*) done=$%{cur%%,*%}, ;; esac\n"
            "    mapfile -t COMPREPLY < <(compgen -P \"$done\" -W \"$1\" -- \"$%{cur##*,%}\")\n"
            "    compopt -o nospace 2>/dev/null\n"
            "%}\n"
            "\n"
            "_beamrate_files() %{\n"
            "    mapfile -t COMPREPLY < <(compgen \"$@\" -- \"$cur\")\n"
            "    compopt -o filenames 2>/dev/null\n"
            "%}\n"
            "\n"
            "_beamrate_scenes() %{\n"
            "    mapfile -t COMPREPLY < <(compgen -W \"$1\" -- \"$cur\"\n"
            "        compgen -f -X '!*.yaml' -- \"$cur\"\n"
            "        compgen -d -- \"$cur\")\n"
            "    compopt -o filenames 2>/dev/null\n"
            "%}\n"
            "\n"
            "_beamrate() %{\n"
            "    local cur=$%{COMP_WORDS[COMP_CWORD]%} command=$%{COMP_WORDS[1]%} i=$((COMP_CWORD - 1))\n"
            "    [ \"$cur\" = '=' ] && cur='' i=$COMP_CWORD\n"
            "    [ \"$%{COMP_WORDS[i]%}\" = '=' ] && i=$((i - 1))\n"
            "    local prev=$%{COMP_WORDS[i]%}\n"
            "    COMPREPLY=()\n"
            "    if [ \"$COMP_CWORD\" -eq 1 ]; then\n        _beamrate_words '",
        .listed = "%c ",
        .middle = "--help --version'\n        return\n    fi\n    case $command,$prev in\n",
        .option = "{%?a    %c,--%n{ | %c,-%l}) %v ;;\n}",
        .value = {"", "return", "_beamrate_files -f", "_beamrate_files -d", "_beamrate_words %W",
                  "_beamrate_list %W"},
        .end = "    %c,*) case $cur in -*) _beamrate_words '%o' ;; *) %p ;; esac ;;\n",
        .arguments = {"_beamrate_words ''", "_beamrate_words '%g'", "_beamrate_scenes '%z'",
                      "_beamrate_scenes '%g %z'"},
        .foot = "    esac\n%}\n\ncomplete -F _beamrate beamrate\n",
    },
    {
        .name = "zsh",
        .quoting = &br_for_zsh,
        .words_quoting = &for_zsh_words,
        .head = "#compdef beamrate\n"
                "# Completion of beamrate in zsh; written by 'beamrate completions zsh'.\n\n"
                "_beamrate_scenes() %{\n    _alternative 'scenes:bundled scene:(%z)' "
                "'files:file:_files -g \"*.yaml\"'\n%}\n\n"
                "_beamrate() %{\n    local -a commands\n    commands=(\n",
        .listed = "        %q\n",
        .middle = "    )\n    local state line curcontext=$curcontext\n"
                  "    _arguments -C '(- *)--help[lists the commands]' "
                  "'(- *)--version[the version]' \\\n"
                  "        '1:command:->command' '*::argument:->argument'\n"
                  "    case $state in\n    command) _describe command commands ;;\n    argument)\n"
                  "        case $words[1] in\n",
        .command = "        %c)\n            _arguments \\\n",
        .option = "{            '-%l{%?a+}[%H]{%v}' \\\n}            '--%n{%?a=}[%H]%v' \\\n",
        .value = {"", ":%a:", ":%a:_files", ":%a:_files -/", ":%a:(%W)",
                  ":%a:_sequence compadd - %W"},
        .end = "            %p\n            ;;\n",
        .arguments = {"&& return", "'%j:argument:(%g)'", "'*:scene:_beamrate_scenes'",
                      "'*:part or scene:_alternative \"parts:part:(%g)\" "
                      "\"scenes:scene:_beamrate_scenes\"'"},
        .foot = "        esac\n        ;;\n    esac\n%}\n\n"
                "if [[ $funcstack[1] = _beamrate ]]; then\n    _beamrate \"$@\"\nelse\n"
                "    compdef _beamrate beamrate\nfi\n",
    },
    {
        .name = "fish",
        .quoting = &br_for_completion,
        .head = "# Completion of beamrate in fish; written by 'beamrate completions fish'.\n"
                "set -g __beamrate_scenes %z\n\ncomplete -c beamrate -f\n"
                "complete -c beamrate -n __fish_use_subcommand -l help -d 'lists the commands'\n"
                "complete -c beamrate -n __fish_use_subcommand -l version -d 'the version'\n",
        .command = "\ncomplete -c beamrate -n __fish_use_subcommand -a %c -d %T\n"
                   "{complete -c beamrate -n '__fish_seen_subcommand_from %c' -a '%p'\n}",
        .option =
            "complete -c beamrate -n '__fish_seen_subcommand_from %c' -l %n{ -s %l}%v -d %H\n",
        .value = {"", " -x", " -r -F", " -x -a '(__fish_complete_directories)'", " -x -a '%w'",
                  " -x -a '(__fish_append , %w)'"},
        .arguments = {"", "%g", "$__beamrate_scenes (__fish_complete_suffix .yaml)",
                      "%g $__beamrate_scenes (__fish_complete_suffix .yaml)"},
    },
};

/* ---- the interface ---- */

void br_write_language(FILE *out, const char *name, const char *scenes)
{
    for (size_t i = 0; i < sizeof languages / sizeof *languages; i++)
        if (strcmp(languages[i].name, name) == 0)
            write_all(out, &languages[i], scenes);
}

static const char *shell_name(size_t row)
{
    static const char *const shells[] = {"bash", "zsh", "fish", NULL};
    return shells[row];
}

static const struct br_words shell_words = {shell_name, NULL, NULL};

static enum br_status run(const struct br_options *o, struct br_session *session,
                          struct br_error *err)
{
    (void)session;
    static char scenes[MOST_SCENES]; /* the bundled ones, separated by blanks */
    char **name;
    size_t count;
    const enum br_status status = br_scene_list(&name, &count, err);
    for (size_t i = 0; i < count && !status; i++)
        if (br_is_name(name[i]) && !strchr(name[i], ' ')) /* else no shell could complete it */
            br_append(scenes, sizeof scenes, "%s%s", *scenes ? " " : "", name[i]);
    br_scene_list_free(name, count);
    if (!status)
        br_write_language(stdout, o->word[0], scenes);
    return status;
}

const struct br_command br_command_completions = {
    .bit = BR_FOR_COMPLETIONS,
    .name = "completions",
    .arguments = "bash|zsh|fish",
    .title = "makes a shell complete commands, options, values and scenes",
    .about = "Prints a script by which a shell completes the commands, their options, values and "
             "scenes.",
    .more = "The scripts are installed where the shells look for them.",
    .example = {"beamrate completions bash > beamrate.bash", "beamrate completions zsh > _beamrate",
                "beamrate completions fish > beamrate.fish"},
    .least_words = 1,
    .most_words = 1,
    .words = &shell_words,
    .run = run,
};
