/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate help: what commands and options do, from the commands' records, the options' rows and
 * the registries. */
#include <string.h>

#include "cli/command.h"
#include "study/scene/named_method.h"
#include "tables/document.h"

enum { WIDTH = 98, COLUMN = 34 };

static const char methods_hint[] =
    "'beamrate help methods' lists schemes, solvers, rules, references, norms and formats.";

/* ---- text ---- */

/* Writes words in lines up to WIDTH, or as wide as the terminal is. The first line has `at` letters
 * already. */
static void wrap(FILE *out, const char *text, size_t at, size_t indent)
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
    wrap(out, br_option_help(row, help, sizeof help), COLUMN, COLUMN);
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
    fputc('\n', out);
    wrap(out, methods_hint, 0, 0);
}

static void print_commands(FILE *out)
{
    wrap(out,
         "beamrate: convergence studies of the dynamic frictional contact of a viscoelastic beam", 0,
         0);
    fprintf(out, "\nUsage: beamrate COMMAND [OPTION...]\n\nCommands:\n");
    for (const struct br_command *const *c = br_commands; *c; c++) {
        fprintf(out, "  %-11s %-17s ", (*c)->name, (*c)->arguments);
        wrap(out, (*c)->title, 32, 32);
    }
    fprintf(out,
            "\nTo begin with:\n"
            "  beamrate tables --n 100,200,400 --k 0.01,0.005 --reference fine:1600,1e-3\n"
            "  beamrate study example2 --norm l2,energy,tip\n"
            "  beamrate check example2 example3\n"
            "  beamrate scenes --new my_scene.yaml\n\n");
    wrap(out, "'beamrate COMMAND --help' lists a command's options, with examples.", 0, 0);
    wrap(out, methods_hint, 0, 0);
    wrap(out, "Exit codes: 0 done, 1 a verdict failed, 2 bad input, 3 the computation failed.", 0,
         0);
}

/* ---- registries ---- */

/* "--kernel   --solver auto, riccati": the rows that use field i of a method. */
static void print_users(FILE *out, size_t i)
{
    const struct br_method_field *f = &br_method_fields[i], *by = &br_method_fields[f->by];
    struct br_method m = br_method_default();
    const char *between = " ";
    if (!f->argument || !br_method_field_depends(f))
        return;
    fprintf(out, "  --%-21s --%s", br_method_fields[i].name, br_method_fields[f->by].name);
    for (size_t row = 0; by->words->name(row); row++) {
        by->set(&m, (double)row);
        if (br_method_field_used(f, &m)) {
            fprintf(out, "%s%s", between, by->words->name(row));
            between = ", ";
        }
    }
    fputc('\n', out);
}

static void print_methods(FILE *out)
{
    struct br_registry list[BR_REGISTRIES];
    char text[256];
    const size_t count = br_registries(list);
    for (size_t i = 0; i < count; i++) {
        fprintf(out, "--%s: %s\n", list[i].option, list[i].title);
        for (size_t row = 0; list[i].words->name(row); row++) {
            fprintf(out, "  %-15s ", list[i].words->name(row));
            wrap(out,
                 list[i].words->title                    ? list[i].words->title(row)
                 : br_word_available(list[i].words, row) ? "available here"
                                                         : "not available on this machine",
                 18, 18);
        }
    }
    fprintf(out, "\nOptions that some of these use:\n");
    for (size_t i = 0; i < BR_METHOD_FIELDS; i++)
        print_users(out, i);
    fputc('\n', out);
    wrap(out, "Names of methods (--methods): these words joined by '+', at most one of a kind:", 0,
         0);
    const char *title;
    for (size_t i = 0; (title = br_named_method_kind(i, text, sizeof text)); i++) {
        fprintf(out, "  %-30s ", title);
        wrap(out, text, 33, 33);
    }
}

/* ---- the command ---- */

/* The topics besides the commands. */
static const char *const others[] = {"methods", "man", "markdown", NULL};

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
        print_commands(stdout);
    else if (strcmp(topic, others[0]) == 0)
        print_methods(stdout);
    else
        br_write_language(stdout, topic, NULL);
    return BR_OK;
}

static const char *topic(size_t row)
{
    size_t count = 0;
    while (br_commands[count])
        count++;
    return row < count ? br_commands[row]->name : others[row - count];
}

static const struct br_words topics = {topic, NULL, NULL};

const struct br_command br_command_help = {
    .bit = BR_FOR_HELP,
    .name = "help",
    .arguments = "[TOPIC]",
    .title = "lists the commands, the options of one command, or the methods",
    .about =
        "Without a TOPIC: lists the commands. With a command: lists its options. 'methods' lists "
        "all names that can be chosen, 'man' prints the manual page, 'markdown' prints "
        "docs/options.md.",
    .example = {"beamrate help", "beamrate help run", "beamrate help methods"},
    .most_words = 1,
    .words = &topics,
    .run = run,
};
