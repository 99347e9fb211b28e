/* SPDX-License-Identifier: GPL-3.0-or-later */
/* GitHub-flavoured Markdown. */
#include <string.h>

#include "study/scene/quote.h"
#include "tables/document.h"

static void print(FILE *out, const char *text)
{
    br_quote(out, &br_for_markdown, text ? text : "");
}

static void print_item(FILE *out, const char *text)
{
    fputs("- ", out);
    print(out, text);
    fputc('\n', out);
}

static void print_head(FILE *out, const struct br_document_table *t)
{
    fputs("\n## ", out);
    print(out, t->title);
    fputs("\n\n|", out);
    for (size_t c = 0; c < t->columns; c++) {
        const struct br_column *column = &t->column[c];
        if (!br_document_is_seen(t, c))
            continue;
        fputc(' ', out);
        print(out, column->heading);
        fputs(column->unit ? ", " : "", out);
        print(out, column->unit);
        fputs(" |", out);
    }
    fputs("\n|", out);
    for (size_t c = 0; c < t->columns; c++)
        if (br_document_is_seen(t, c))
            fputs(br_document_is_text(t, c) ? "---|" : "---:|", out);
    fputc('\n', out);
}

static void print_value(FILE *out, const struct br_column *column,
                        const struct br_document_cell *cell)
{
    char buffer[BR_SHOWN];
    print(out, br_document_shown(column, cell, buffer));
    if (!cell->mark)
        return;
    fputs(" (", out);
    print(out, cell->mark);
    fputc(')', out);
}

static void print_table(FILE *out, const struct br_document_table *t)
{
    if (!br_for_people(t->flags) || t->rows == 0)
        return;
    print_head(out, t);
    for (size_t r = 0; r < t->rows; r++) {
        fputc('|', out);
        for (size_t c = 0; c < t->columns; c++)
            if (br_document_is_seen(t, c)) {
                fputc(' ', out);
                print_value(out, &t->column[c], br_document_cell_at(t, r, c));
                fputs(" |", out);
            }
        fputc('\n', out);
    }
}

static void print_fact(FILE *out, const struct br_block *b)
{
    if (!br_for_people(b->what.flags))
        return;
    fputs("- ", out);
    print(out, b->what.heading);
    fputs(": ", out);
    print_value(out, &b->what, &b->cell);
    fputs(b->what.unit ? " " : "", out);
    print(out, b->what.unit);
    fputc('\n', out);
}

/* In a block that no line of a command ends. */
static void print_command(FILE *out, const struct br_block *b)
{
    const char *rest = b->cell.value.text;
    print(out, b->what.heading);
    fputs(":\n\n````\n", out);
    while (*rest) {
        const size_t length = strcspn(rest, "\n");
        char line[2048];
        snprintf(line, sizeof line, "%.*s", (int)length, rest);
        br_quote(out, &br_for_text, line);
        fputc('\n', out);
        rest += length + (rest[length] == '\n');
    }
    fputs("````\n", out);
}

static void print_block(FILE *out, const struct br_block *b)
{
    switch (b->kind) {
    case BR_BLOCK_TABLE:
        print_table(out, b->table);
        break;
    case BR_BLOCK_SECTION:
        fputs("\n## ", out);
        print(out, b->text);
        fputs("\n\n", out);
        break;
    case BR_BLOCK_NOTE:
        print_item(out, b->text);
        break;
    case BR_BLOCK_FACT:
        print_fact(out, b);
        break;
    case BR_BLOCK_COMMAND:
        print_command(out, b);
        break;
    case BR_BLOCK_PICTURE:
        fputs("![", out);
        print(out, b->text);
        fputs("](<", out);
        br_quote(out, &br_for_text, b->what.key);
        fputs(".svg>)\n", out);
    }
}

static void print_verdict(FILE *out, const struct br_document_verdict *v)
{
    fprintf(out, "- **%s** ", br_outcome_names[v->outcome]);
    print(out, v->group);
    fputs(v->group ? ", " : "", out);
    print(out, v->name);
    fputs(v->message ? ": " : "", out);
    print(out, v->message);
    fputc('\n', out);
    for (size_t i = 0; i < v->details; i++) {
        fputs("  ", out);
        print_item(out, v->detail[i]);
    }
}

static void print_verdicts(FILE *out, const struct br_document *d)
{
    bool first = true;
    for (size_t i = 0; i < d->verdicts; i++)
        if (br_document_verdict_matters(&d->verdict[i])) {
            fputs(first ? "\n## Verdicts\n\n" : "", out);
            print_verdict(out, &d->verdict[i]);
            first = false;
        }
}

/* Between backticks, unless it has one of its own. */
static void print_code(FILE *out, const char *text)
{
    const bool plain = !strchr(text, '`');
    fputs(plain ? "`" : "", out);
    br_quote(out, plain ? &br_for_text : &br_for_markdown, text);
    fputs(plain ? "`" : "", out);
}

static void print_provenance(FILE *out, const struct br_provenance *p)
{
    if (!p->version)
        return;
    fprintf(out, "\nbeamrate %s (%s), %s", p->version, p->commit, p->date);
    if (p->command_line) {
        fputs(": ", out);
        print_code(out, p->command_line);
    }
    fputc('\n', out);
}

static enum br_status write(FILE *out, const struct br_document *d,
                            const struct br_document_table *table, struct br_error *err)
{
    (void)table, (void)err;
    enum br_block_kind before = BR_BLOCK_SECTION;
    fputs("# ", out);
    print(out, d->caption);
    fputs("\n\n", out);
    for (size_t i = 0; i < d->answers; i++)
        print_item(out, d->answer[i]);
    for (size_t i = 0; i < d->blocks; i++) {
        const struct br_block *b = &d->block[i];
        if (b->kind != before && b->kind != BR_BLOCK_TABLE && b->kind != BR_BLOCK_SECTION &&
            !(i > 0 && before == BR_BLOCK_SECTION))
            fputc('\n', out);
        print_block(out, b);
        before = b->kind;
    }
    print_verdicts(out, d);
    print_provenance(out, &d->provenance);
    return BR_OK;
}

const struct br_document_format br_document_markdown = {
    .name = "markdown",
    .extension = ".md",
    .title = "GitHub-flavoured Markdown",
    .write = write,
};
