/* SPDX-License-Identifier: GPL-3.0-or-later */
/* GitHub-flavoured Markdown. */
#include <string.h>

#include "study/scene/quote.h"
#include "tables/sheet.h"

static void item(void *self, const char *text)
{
    FILE *out = self;
    fputs("- ", out);
    br_quote(out, &br_for_markdown, text);
    fputc('\n', out);
}

static void print_cell(FILE *out, const char *text)
{
    fputc(' ', out);
    br_quote(out, &br_for_markdown, text);
    fputs(" |", out);
}

static void print_table(FILE *out, const struct br_table *t)
{
    char text[BR_CELL];
    bool number;
    fputs("\n## ", out);
    br_quote(out, &br_for_markdown, t->title);
    fputs("\n\n|", out);
    for (size_t c = 0; c < t->columns; c++)
        print_cell(out, t->heading(t->self, c, &number));
    fputs("\n|", out);
    for (size_t c = 0; c < t->columns; c++) {
        t->heading(t->self, c, &number);
        fputs(number ? "---:|" : "---|", out);
    }
    fputc('\n', out);
    for (size_t r = 0; r < t->rows; r++) {
        fputc('|', out);
        for (size_t c = 0; c < t->columns; c++) {
            t->cell(t->self, r, c, text);
            print_cell(out, text);
        }
        fputc('\n', out);
    }
}

static void print_notes(FILE *out, const struct br_page *page)
{
    if (page->notes_title) {
        fputs("\n## ", out);
        br_quote(out, &br_for_markdown, page->notes_title);
        fputc('\n', out);
    }
    fputc('\n', out);
    page->say_notes(page->self, &(struct br_writer){item, out});
}

/* Between backticks, unless it has one of its own. */
static void print_code(FILE *out, const char *text)
{
    const bool plain = !strchr(text, '`');
    fputs(plain ? "`" : "", out);
    br_quote(out, plain ? &br_for_text : &br_for_markdown, text);
    fputs(plain ? "`" : "", out);
}

static enum br_status emit(FILE *out, const struct br_page *page, struct br_error *err)
{
    (void)err;
    const struct br_provenance *p = page->provenance;
    fputs("# ", out);
    br_quote(out, &br_for_markdown, page->caption);
    fputc('\n', out);
    if (page->say) {
        fputc('\n', out);
        page->say(page->self, &(struct br_writer){item, out});
    }
    for (size_t i = 0; i < page->tables; i++)
        print_table(out, &page->table[i]);
    if (page->say_notes)
        print_notes(out, page);
    fprintf(out, "\nbeamrate %s (%s), %s: ", p->version, p->commit, p->date);
    print_code(out, p->command_line);
    fputc('\n', out);
    return BR_OK;
}

const struct br_page_emitter br_page_markdown = {"markdown", ".md", emit};
