/* SPDX-License-Identifier: GPL-3.0-or-later */
/* GitHub-flavoured Markdown. */
#include <string.h>

#include "tables/markup.h"

static void begin(const struct br_markup_page *p)
{
    br_markup_put(p, "# %s\n\n", p->d->caption);
}

static void open_table(const struct br_markup_page *p, const struct br_document_table *t, int level)
{
    br_markup_heading(p, level, t->title);
    fputc('|', p->out);
}

static void open_rows(const struct br_markup_page *p, const struct br_document_table *t)
{
    static const char *const words[] = {"---:|", "---|", "---|"};
    fputs("\n|", p->out);
    br_markup_columns(p, t, words);
    fputc('\n', p->out);
}

static void picture(struct br_markup_page *p, const struct br_block *b)
{
    br_markup_put(p, "![%s]", b->text);
    br_print(p->out, &br_for_text, "(<%s.svg>)\n", b->what.key);
}

/* Prints the command line between backticks, unless it contains one. */
static void end(const struct br_markup_page *p)
{
    const struct br_provenance *from = &p->d->provenance;
    const char *line = from->command_line;
    if (!from->version)
        return;
    fprintf(p->out, "\nbeamrate %s (%s), %s", from->version, from->commit, from->date);
    if (line && strchr(line, '`'))
        br_markup_put(p, ": %s", line);
    else if (line)
        br_print(p->out, &br_for_text, ": `%s`", line);
    fputc('\n', p->out);
}

static const struct br_markup markdown = {
    .quoting = &br_for_markdown,
    .of_lines = &br_for_text,
    .heading = {"\n## ", "\n\n"},
    .answer = {"- ", "\n"},
    .note = {"- ", "\n"},
    .fact = {"- ", "\n"},
    .label = "%s: ",
    .command = "%s:\n\n",
    .lines = {"````\n", "````\n"}, /* a line of a command cannot end this block */
    .line = {"", "\n"},
    .verdict = {"- ", "\n"},
    .detail = "  - %s\n",
    .head = {" ", " |"},
    .cell = {" ", " |"},
    .mark = " (%s)",
    .row = {"|", "\n"},
    .word = "**%s**",
    .gap = "\n",
    .open_table = open_table,
    .open_rows = open_rows,
    .picture = picture,
    .begin = begin,
    .end = end,
};

const struct br_document_format br_document_markdown = {
    .name = "markdown",
    .extension = ".md",
    .title = "GitHub-flavoured Markdown",
    .markup = &markdown,
};
