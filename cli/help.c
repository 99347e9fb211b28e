/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate help: what commands and options do, from the commands' records, the options' rows and
 * the registries. */
#include <string.h>

#include "cli/command.h"
#include "tables/document.h"

enum { WIDTH = 98, COLUMN = 34 };

/* ---- text ---- */

/* Writes words in lines up to WIDTH, or as wide as the terminal is. The first line has `at` letters
 * already. */
void br_print_wrapped(FILE *out, const char *text, size_t at, size_t indent)
{
    const int columns = br_document_columns(out);
    const size_t width = columns && columns < WIDTH ? (size_t)columns : WIDTH;
    for (const char *word = text; *word; word += strspn(word, " ")) {
        const size_t length = strcspn(word, " ");
        if (at > indent && at + 1 + length > width) {
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

static void print_option(FILE *out, const struct br_option *row)
{
    char name[64], help[512];
    const char letter[] = {'-', row->letter, ',', '\0'};
    const int length =
        snprintf(name, sizeof name, "  %3s --%s%s%s", row->letter ? letter : "", row->name,
                 row->argument ? " " : "", row->argument ? row->argument : "");
    const size_t at = (size_t)length < COLUMN ? COLUMN : (size_t)length + 1;
    fprintf(out, "%-*s", (int)at, name);
    if (at > COLUMN)
        fprintf(out, "\n%*s", COLUMN, "");
    br_print_wrapped(out, br_option_help(row, help, sizeof help), COLUMN, COLUMN);
}

void br_print_command_help(FILE *out, const struct br_command *c)
{
    struct br_option row[BR_OPTIONS];
    const size_t count = br_options_of(c, row);
    fprintf(out, "Usage: %s %s%s%s [OPTION...]\n\n", br_program.name, c->name,
            *c->arguments ? " " : "", c->arguments);
    br_print_wrapped(out, c->about, 0, 0);
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
            br_print_wrapped(out, c->words->title(i), 15, 15);
        }
    }
    fprintf(out, "\nExamples:\n");
    for (size_t i = 0; i < BR_MOST_EXAMPLES && c->example[i]; i++)
        fprintf(out, "  %s %s\n", br_program.name, c->example[i]);
    fputc('\n', out);
    br_print_wrapped(out, br_program.hint, 0, 0);
}

void br_print_help(FILE *out)
{
    char line[256];
    snprintf(line, sizeof line, "%s: %s", br_program.name, br_program.about);
    br_print_wrapped(out, line, 0, 0);
    fprintf(out, "\nUsage: %s COMMAND [OPTION...]\n\nCommands:\n", br_program.name);
    for (const struct br_command *const *c = br_program.commands; *c; c++) {
        fprintf(out, "  %-11s %-17s ", (*c)->name, (*c)->arguments);
        br_print_wrapped(out, (*c)->title, 32, 32);
    }
    fprintf(out, "\nTo begin with:\n");
    for (size_t i = 0; i < BR_MOST_EXAMPLES && br_program.example[i]; i++)
        fprintf(out, "  %s %s\n", br_program.name, br_program.example[i]);
    snprintf(line, sizeof line,
             "'%s COMMAND --help' lists a command's options, with examples. Their names may be cut "
             "short: --dim is --dimension.",
             br_program.name);
    fputc('\n', out);
    br_print_wrapped(out, line, 0, 0);
    br_print_wrapped(out, br_program.hint, 0, 0);
    br_print_wrapped(
        out, "Exit codes: 0 done, 1 a verdict failed, 2 bad input, 3 the computation failed.", 0,
        0);
    br_print_wrapped(
        out, "docs/ci.md shows jobs for GitHub, GitLab and Docker, and tests for pytest.", 0, 0);
}

/* ---- the command ---- */

static enum br_status run(const struct br_options *o, struct br_session *session,
                          struct br_error *err)
{
    (void)session;
    (void)err;
    const char *topic = o->words ? o->word[0] : "";
    const struct br_command *command = br_find_command(topic);
    if (command)
        br_print_command_help(stdout, command);
    else if (!*topic)
        br_print_help(stdout);
    else
        br_program.beam->print_topic(topic);
    return BR_OK;
}

static const char *topic(size_t row)
{
    size_t count = 0;
    while (br_program.commands[count])
        count++;
    return row < count       ? br_program.commands[row]->name
           : br_program.beam ? br_program.beam->topics[row - count]
                             : NULL;
}

static const struct br_words topics = {topic, NULL, NULL};

const struct br_command br_command_help = {
    .bit = BR_FOR_HELP,
    .name = "help",
    .arguments = "[TOPIC]",
    .title = "lists the commands, the options of one command, or the methods",
    .about = "Without a TOPIC: lists the commands. With a command: lists its options.",
    .more =
        "'methods' lists all names that can be chosen, 'man' prints the manual page, 'markdown' "
        "prints docs/options.md.",
    .example = {"help", "help orders"},
    .most_words = 1,
    .words = &topics,
    .run = run,
};
