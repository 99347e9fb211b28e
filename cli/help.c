/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate help: what commands and options do, for a person, as a manual page, and for docs/. All
 * of it comes from the commands' records, the options' rows and the registries. */
#include <ctype.h>
#include <string.h>

#include "cli/command.h"
#include "cli/manual.h"
#include "cli/provenance.h"
#include "study/trade/contender.h"

enum { WIDTH = 98, COLUMN = 34 };

static const char methods_hint[] =
    "'beamrate help methods' lists schemes, solvers, rules, references, norms and formats.";

/* ---- text ---- */

/* Writes words in lines up to WIDTH; the first begins where the line stands, `at` letters in. */
static void wrap(FILE *out, const char *text, size_t at, size_t indent)
{
    for (const char *word = text; *word; word += strspn(word, " ")) {
        const size_t length = strcspn(word, " ");
        if (at > indent && at + 1 + length > WIDTH) {
            fprintf(out, "\n%*s", (int)indent, "");
            at = indent;
        } else if (at > indent) {
            fputc(' ', out);
            at++;
        }
        fprintf(out, "%.*s", (int)length, word);
        at += length;
        word += length;
    }
    fputc('\n', out);
}

/* "elements (default 100)" */
static const char *help_of(const struct br_option *row, char *text, size_t size)
{
    char value[BR_METHOD_VALUE];
    const char *standard = br_option_default(row, value);
    snprintf(text, size, "%s%s%s%s", row->help, standard ? " (default " : "",
             standard ? standard : "", standard ? ")" : "");
    return text;
}

static void print_option(FILE *out, const struct br_option *row)
{
    char name[64], help[512];
    const char letter[] = {'-', row->letter, ',', '\0'};
    const int length =
        snprintf(name, sizeof name, "  %3s --%s%s%s", row->letter ? letter : "", row->name,
                 row->argument ? " " : "", row->argument ? row->argument : "");
    const size_t at = (size_t)length < COLUMN ? COLUMN : (size_t)length + 1;
    fprintf(out, "%-*s", (int)at, name);
    help_of(row, help, sizeof help);
    if (at > COLUMN)
        fprintf(out, "\n%*s", COLUMN, "");
    wrap(out, help, COLUMN, COLUMN);
}

void br_print_command_help(FILE *out, const struct br_command *c)
{
    struct br_option row[BR_OPTIONS];
    const size_t count = br_options_of(c, row);
    fprintf(out, "Usage: beamrate %s%s%s [OPTION...]\n\n", c->name, *c->arguments ? " " : "",
            c->arguments);
    wrap(out, c->about, 0, 0);
    fprintf(out, "\nOptions:\n");
    for (size_t i = 0; i < count; i++) {
        if (row[i].id == BR_OPT_METHOD)
            fprintf(out, "\nMethod:\n");
        print_option(out, &row[i]);
    }
    if (c->words && c->words->title) {
        fputc('\n', out);
        for (size_t i = 0; c->words->name(i); i++) {
            fprintf(out, "  %-12s ", c->words->name(i));
            wrap(out, c->words->title(i), 15, 15);
        }
    }
    fprintf(out, "\nExamples:\n");
    for (size_t i = 0; i < BR_MOST_EXAMPLES && c->example[i]; i++)
        fprintf(out, "  %s\n", c->example[i]);
    fprintf(out, "\n%s\n", methods_hint);
}

static void print_commands(FILE *out)
{
    fprintf(out,
            "beamrate: convergence studies of the dynamic frictional contact of a viscoelastic "
            "beam\n\nUsage: beamrate COMMAND [OPTION...]\n\nCommands:\n");
    for (const struct br_command *const *c = br_commands; *c; c++)
        fprintf(out, "  %-11s %-13s %s\n", (*c)->name, (*c)->arguments, (*c)->title);
    fprintf(out,
            "\nTo begin with:\n"
            "  beamrate tables --n 100,200,400 --k 0.01,0.005 --reference fine:1600,1e-3\n"
            "  beamrate study example2 --norm l2,energy,tip\n"
            "  beamrate check example2 example3\n"
            "  beamrate scenes --new my_scene.yaml\n\n"
            "'beamrate COMMAND --help' lists a command's options, with examples;\n%s\n"
            "Exit codes: 0 done, 1 a verdict failed, 2 bad input, 3 the computation failed.\n",
            methods_hint);
}

/* ---- registries ---- */

/* One row a registry; words: what a person reads above it. */
struct registry {
    const char *option, *title;
    const struct br_words *words;
};

static size_t registries(struct registry list[BR_METHOD_FIELDS + 3])
{
    size_t count = 0;
    for (size_t i = 0; i < BR_METHOD_FIELDS; i++) {
        const struct br_method_field *f = &br_method_fields[i];
        if (f->words && (f->words->title || f->words->available))
            list[count++] = (struct registry){f->name, f->help, f->words};
    }
    list[count++] =
        (struct registry){"reference", "what errors are measured against", &br_judge_words};
    list[count++] = (struct registry){"norm", "norms of the error", &br_norm_words};
    list[count++] = (struct registry){"format", "formats of the results", &br_format_words};
    return count;
}

/* "riccati, umfpack": the rows that heed the field. */
static const char *heeders(const struct br_method_field *f, char *text, size_t size)
{
    const struct br_method_field *by = &br_method_fields[f->by];
    struct br_method m = br_method_default();
    size_t used = 0;
    text[0] = '\0';
    for (size_t row = 0; by->words->name(row) && used < size; row++) {
        by->set(&m, (double)row);
        if (f->heeds(&m))
            used += (size_t)snprintf(text + used, size - used, "%s%s", used ? ", " : "",
                                     by->words->name(row));
    }
    return text;
}

static void print_methods(FILE *out)
{
    struct registry list[BR_METHOD_FIELDS + 3];
    char text[256];
    const size_t count = registries(list);
    for (size_t i = 0; i < count; i++) {
        fprintf(out, "--%s: %s\n", list[i].option, list[i].title);
        for (size_t row = 0; list[i].words->name(row); row++)
            fprintf(out, "  %-15s %s\n", list[i].words->name(row),
                    list[i].words->title                    ? list[i].words->title(row)
                    : br_word_available(list[i].words, row) ? "available here"
                                                            : "not available on this machine");
    }
    fprintf(out, "\nOptions that some of these heed:\n");
    for (size_t i = 0; i < BR_METHOD_FIELDS; i++)
        if (br_method_fields[i].heeds)
            fprintf(out, "  --%-21s --%s %s\n", br_method_fields[i].name,
                    br_method_fields[br_method_fields[i].by].name,
                    heeders(&br_method_fields[i], text, sizeof text));
    fprintf(out,
            "\nNames of methods (--methods): these words joined by '+', at most one of a kind:\n");
    for (size_t i = 0; i < br_contender_kinds(); i++) {
        const char *title = br_contender_kind(i, text, sizeof text);
        fprintf(out, "  %-30s %s\n", title, text);
    }
}

/* ---- docs/options.md ---- */

static void print_markdown_text(FILE *out, const char *text)
{
    for (const char *c = text; *c; c++)
        fprintf(out, strchr("|<*_", *c) ? "\\%c" : "%c", *c);
}

static void print_markdown_row(FILE *out, const struct br_option *row)
{
    char value[BR_METHOD_VALUE];
    const char *standard = br_option_default(row, value);
    fprintf(out, "| ");
    if (row->letter)
        fprintf(out, "`-%c`, ", row->letter);
    fprintf(out, "`--%s%s%s` | %s | ", row->name, row->argument ? " " : "",
            row->argument ? row->argument : "", standard ? standard : "");
    print_markdown_text(out, row->help);
    if (row->more) {
        fprintf(out, ". ");
        print_markdown_text(out, row->more);
    }
    fprintf(out, " |\n");
}

static void print_markdown_words(FILE *out, const struct br_words *words)
{
    fputc('\n', out);
    for (size_t i = 0; words->name(i); i++) {
        fprintf(out, "- `%s`%s", words->name(i), words->title ? ": " : "");
        print_markdown_text(out, words->title ? words->title(i) : "");
        fputc('\n', out);
    }
}

static void print_markdown_command(FILE *out, const struct br_command *c)
{
    struct br_option row[BR_OPTIONS];
    const size_t count = br_options_of(c, row);
    fprintf(out, "\n## beamrate %s%s%s\n\n", c->name, *c->arguments ? " " : "", c->arguments);
    print_markdown_text(out, c->about);
    if (c->more) {
        fputc(' ', out);
        print_markdown_text(out, c->more);
    }
    fprintf(out, "\n\n```sh\n");
    for (size_t i = 0; i < BR_MOST_EXAMPLES && c->example[i]; i++)
        fprintf(out, "%s\n", c->example[i]);
    fprintf(out, "```\n\n| option | default | what it does |\n|---|---|---|\n");
    for (size_t i = 0; i < count && row[i].id < BR_OPT_METHOD; i++)
        print_markdown_row(out, &row[i]);
    if (row[count - 1].id >= BR_OPT_METHOD)
        fprintf(out, "\nAnd the [options of the method](#options-of-the-method).\n");
    if (c->words && c->words->title)
        print_markdown_words(out, c->words);
}

/* Not what is available: that differs from machine to machine. */
static void print_markdown(FILE *out)
{
    struct registry list[BR_METHOD_FIELDS + 3];
    struct br_option row[BR_OPTIONS];
    const size_t count = registries(list), options = br_options_of(br_commands[0], row);
    fprintf(out, "# Options\n\nWritten by `beamrate help --markdown`. `T` is the duration of the "
                 "scene: `--k T/100` makes 100 steps.\n");
    for (const struct br_command *const *c = br_commands; *c; c++)
        print_markdown_command(out, *c);
    fprintf(out, "\n## Options of the method\n\nAn option that the chosen method does not heed is "
                 "refused.\n\n| option | default | what it does |\n|---|---|---|\n");
    for (size_t i = 0; i < options; i++)
        if (row[i].id >= BR_OPT_METHOD)
            print_markdown_row(out, &row[i]);
    for (size_t i = 0; i < count; i++) {
        fprintf(out, "\n### --%s: %s\n", list[i].option, list[i].title);
        print_markdown_words(out, list[i].words);
    }
}

/* ---- the manual page ---- */

/* Whatever roff would take for its own. */
static void print_roff(FILE *out, const char *text)
{
    if (*text == '.' || *text == '\'')
        fputs("\\&", out);
    for (const char *c = text; *c; c++)
        fprintf(out, *c == '-' ? "\\-" : *c == '\\' ? "\\e" : "%c", *c);
}

static void print_man_option(FILE *out, const struct br_option *row)
{
    char help[512];
    fprintf(out, ".TP\n.B ");
    if (row->letter)
        fprintf(out, "\\-%c, ", row->letter);
    fprintf(out, "\\-\\-");
    print_roff(out, row->name);
    if (row->argument)
        fprintf(out, " \\fI%s\\fR", row->argument);
    fputc('\n', out);
    print_roff(out, help_of(row, help, sizeof help));
    fprintf(out, ".\n");
    if (row->more) {
        print_roff(out, row->more);
        fputc('\n', out);
    }
}

static void print_man_words(FILE *out, const struct br_words *words)
{
    for (size_t i = 0; words->name(i); i++) {
        fprintf(out, ".TP\n.B %s\n", words->name(i));
        print_roff(out, words->title ? words->title(i) : "an instruction set");
        fputc('\n', out);
    }
}

static void print_man_command(FILE *out, const struct br_command *c)
{
    struct br_option row[BR_OPTIONS];
    const size_t count = br_options_of(c, row);
    fprintf(out, ".SS beamrate %s%s%s\n", c->name, *c->arguments ? " " : "", c->arguments);
    print_roff(out, c->about);
    fputc('\n', out);
    if (c->more) {
        print_roff(out, c->more);
        fputc('\n', out);
    }
    for (size_t i = 0; i < count && row[i].id < BR_OPT_METHOD; i++)
        print_man_option(out, &row[i]);
    if (row[count - 1].id >= BR_OPT_METHOD)
        fprintf(out, ".PP\nAnd the options of the method, below.\n");
    if (c->words && c->words->title)
        print_man_words(out, c->words);
    fprintf(out, ".PP\n.nf\n");
    for (size_t i = 0; i < BR_MOST_EXAMPLES && c->example[i]; i++) {
        print_roff(out, c->example[i]);
        fputc('\n', out);
    }
    fprintf(out, ".fi\n");
}

static void print_man(FILE *out)
{
    struct registry list[BR_METHOD_FIELDS + 3];
    struct br_option row[BR_OPTIONS];
    const size_t count = registries(list), options = br_options_of(br_commands[0], row);
    fprintf(
        out,
        ".\\\" SPDX-License-Identifier: GPL-3.0-or-later\n.\\\" Written by 'beamrate help --man'.\n"
        ".TH BEAMRATE 1 2026 \"beamrate %s\" \"User Commands\"\n.SH NAME\nbeamrate \\- convergence "
        "studies of the dynamic frictional contact of a viscoelastic beam\n.SH SYNOPSIS\n"
        ".B beamrate\n.I command\n.RI [ option ...]\n.SH COMMANDS\n",
        br_version());
    for (const struct br_command *const *c = br_commands; *c; c++)
        print_man_command(out, *c);
    fprintf(out, ".SH OPTIONS OF THE METHOD\nAn option that the chosen method does not heed is "
                 "refused.\n");
    for (size_t i = 0; i < options; i++)
        if (row[i].id >= BR_OPT_METHOD)
            print_man_option(out, &row[i]);
    for (size_t i = 0; i < count; i++) {
        fprintf(out, ".SS \"\\-\\-%s: %s\"\n", list[i].option, list[i].title);
        print_man_words(out, list[i].words);
    }
    for (const struct br_manual_section *s = br_manual_sections; s->title; s++) {
        fprintf(out, ".SH %s\n", s->title);
        print_roff(out, s->text);
        fputc('\n', out);
    }
}

/* ---- the command ---- */

static enum br_status run(const struct br_options *o, struct br_error *err)
{
    const bool man = br_option_given(o, BR_OPT_MAN), markdown = br_option_given(o, BR_OPT_MARKDOWN);
    if (man + markdown + (o->words > 0) > 1)
        return br_fail(err, BR_BAD_INPUT, "expected one of: a topic, --man, --markdown");
    if (man)
        print_man(stdout);
    else if (markdown)
        print_markdown(stdout);
    else if (!o->words)
        print_commands(stdout);
    else if (strcmp(o->word[0], "methods") == 0)
        print_methods(stdout);
    for (const struct br_command *const *c = br_commands; *c && o->words; c++)
        if (strcmp((*c)->name, o->word[0]) == 0)
            br_print_command_help(stdout, *c);
    return BR_OK;
}

static const char *topic(size_t row)
{
    size_t count = 0;
    while (br_commands[count])
        count++;
    return row < count ? br_commands[row]->name : row == count ? "methods" : NULL;
}

static const struct br_words topics = {topic, NULL, NULL};

const struct br_command br_command_help = {
    .bit = BR_FOR_HELP,
    .name = "help",
    .arguments = "[TOPIC]",
    .title = "the commands, one of them, or the methods",
    .about =
        "Without a TOPIC the commands; with one a command's options, or with 'methods' all that "
        "may be chosen by name.",
    .example = {"beamrate help", "beamrate help run", "beamrate help methods"},
    .most_words = 1,
    .words = &topics,
    .run = run,
};
