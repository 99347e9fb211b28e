/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/markdown_text.h"
#include "tables/trade_emitter.h"

static void item(void *self, const char *text)
{
    FILE *out = self;
    fputs("- ", out);
    br_print_markdown(out, text);
    fputc('\n', out);
}

static void print_sheet(FILE *out, const struct br_sheet_view *v)
{
    char text[BR_SHEET_CELL];
    bool number;
    fprintf(out, "\n## %s\n\n|", v->sheet->title);
    for (size_t c = 0; c < v->sheet->columns; c++)
        fprintf(out, " %s |", v->sheet->heading(c, &number));
    fputs("\n|", out);
    for (size_t c = 0; c < v->sheet->columns; c++) {
        v->sheet->heading(c, &number);
        fputs(number ? "---:|" : "---|", out);
    }
    for (size_t r = 0; r < v->sheet->rows(v); r++) {
        fputs("\n|", out);
        for (size_t c = 0; c < v->sheet->columns; c++) {
            v->sheet->cell(v, r, c, text, sizeof text);
            fputc(' ', out);
            br_print_markdown(out, text);
            fputs(" |", out);
        }
    }
    fputc('\n', out);
}

static void print_foot(FILE *out, const struct br_provenance *p)
{
    fprintf(out, "\nbeamrate %s (%s), %s: `%s`\n", p->version, p->commit, p->date, p->command_line);
}

static enum br_status emit(FILE *out, const struct br_trade_page *page, struct br_error *err)
{
    (void)err;
    const struct br_writer w = {item, out};
    fputs("# ", out);
    br_print_markdown(out, page->caption);
    fputs("\n\n", out);
    br_say_trade(page, &w);
    for (const struct br_sheet *const *s = br_trade_sheets; *s; s++)
        print_sheet(out, &(struct br_sheet_view){*s, page, 1});
    fputs("\n## How trials ended\n\n", out);
    br_say_trade_ends(page, &w);
    print_foot(out, page->provenance);
    return BR_OK;
}

static enum br_status summarise(FILE *out, const struct br_trade_page *page, size_t pages,
                                struct br_error *err)
{
    (void)err;
    fputs("# What a digit costs\n", out);
    print_sheet(out, &(struct br_sheet_view){&br_sheet_summary, page, pages});
    print_foot(out, page->provenance);
    return BR_OK;
}

const struct br_trade_emitter br_trade_markdown = {"markdown", ".md", emit, summarise};
