/* SPDX-License-Identifier: GPL-3.0-or-later */
/* GitHub-flavoured Markdown. */
#include "tables/markdown_text.h"
#include "tables/plan_emitter.h"

static void item(void *self, const char *text)
{
    FILE *out = self;
    fputs("- ", out);
    br_print_markdown(out, text);
    fputc('\n', out);
}

static void cell(FILE *out, const char *text)
{
    fputc(' ', out);
    br_print_markdown(out, text);
    fputs(" |", out);
}

static void print_sheet(FILE *out, const struct br_plan_page *page, const struct br_plan_sheet *s)
{
    char text[BR_PLAN_CELL];
    bool number;
    fprintf(out, "\n## %s\n\n|", s->title);
    for (size_t c = 0; c < s->columns; c++)
        cell(out, s->heading(c, &number));
    fputs("\n|", out);
    for (size_t c = 0; c < s->columns; c++) {
        s->heading(c, &number);
        fputs(number ? "---:|" : "---|", out);
    }
    fputc('\n', out);
    for (size_t r = 0; r < s->rows(page); r++) {
        fputc('|', out);
        for (size_t c = 0; c < s->columns; c++) {
            s->cell(page, r, c, text);
            cell(out, text);
        }
        fputc('\n', out);
    }
}

static enum br_status emit(FILE *out, const struct br_plan_page *page, struct br_error *err)
{
    (void)err;
    const struct br_writer w = {item, out};
    fputs("# ", out);
    br_print_markdown(out, page->caption);
    fputs("\n\n", out);
    br_say_plan(page, &w);
    for (const struct br_plan_sheet *const *s = br_plan_sheets; *s; s++)
        print_sheet(out, page, *s);
    fputc('\n', out);
    br_say_plan_notes(page, &w);
    fprintf(out, "\nbeamrate %s (%s), %s\n", page->provenance->version, page->provenance->commit,
            page->provenance->date);
    return BR_OK;
}

const struct br_plan_emitter br_plan_markdown = {"markdown", ".md", emit};
