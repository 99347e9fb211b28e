/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>

#include "tables/trade_emitter.h"

enum { WIDTH = 100, MOST_COLUMNS = 16, MOST_ENDS = 6 };

/* Paragraphs, of which only the first ones are printed where `most` says so. */
struct paragraphs {
    FILE *out;
    size_t count, most; /* 0: all */
};

/* A paragraph wrapped at WIDTH, continued lines indented by two. */
static void wrap(void *self, const char *text)
{
    struct paragraphs *p = self;
    if (p->count++ >= p->most && p->most)
        return;
    for (size_t column = 0; *text;) {
        const size_t word = strcspn(text, " ");
        if (column && column + 1 + word > WIDTH)
            column = (size_t)fprintf(p->out, "\n  ") - 1;
        else if (column)
            column += (size_t)fprintf(p->out, " ");
        column += (size_t)fprintf(p->out, "%.*s", (int)word, text);
        text += word;
        text += strspn(text, " ");
    }
    fputc('\n', p->out);
}

static void fit_widths(const struct br_sheet_view *v, size_t rows, int width[MOST_COLUMNS])
{
    char text[BR_SHEET_CELL];
    bool number;
    for (size_t c = 0; c < v->sheet->columns; c++) {
        width[c] = (int)strlen(v->sheet->heading(c, &number));
        for (size_t r = 0; r < rows; r++) {
            v->sheet->cell(v, r, c, text, sizeof text);
            width[c] = (int)strlen(text) > width[c] ? (int)strlen(text) : width[c];
        }
    }
}

static void print_sheet(FILE *out, const struct br_sheet_view *v)
{
    char text[BR_SHEET_CELL];
    int width[MOST_COLUMNS];
    bool number;
    const size_t rows = v->sheet->rows(v), last = v->sheet->columns - 1;
    fit_widths(v, rows, width);
    fprintf(out, "\n%s\n", v->sheet->title);
    for (size_t c = 0; c <= last; c++) {
        const char *heading = v->sheet->heading(c, &number);
        fprintf(out, number ? "%*s%s" : "%-*s%s", width[c], heading, c < last ? "  " : "\n");
    }
    for (size_t r = 0; r < rows; r++)
        for (size_t c = 0; c <= last; c++) {
            v->sheet->heading(c, &number);
            v->sheet->cell(v, r, c, text, sizeof text);
            fprintf(out, number ? "%*s%s" : "%-*s%s", c < last || number ? width[c] : 0, text,
                    c < last ? "  " : "\n");
        }
}

static void print_head(FILE *out, const char *caption)
{
    fprintf(out, "%s\n", caption);
    for (size_t i = 0; i < strlen(caption); i++)
        fputc('=', out);
    fputc('\n', out);
}

static void print_page(FILE *out, const struct br_trade_page *page, bool whole)
{
    struct paragraphs all = {.out = out}, ends = {.out = out, .most = whole ? 0 : MOST_ENDS};
    const struct br_writer w = {wrap, &all}, some = {wrap, &ends};
    print_head(out, page->caption);
    br_say_trade(page, &w);
    for (const struct br_sheet *const *s = br_trade_sheets; *s; s++)
        if (whole || *s != &br_sheet_trials)
            print_sheet(out, &(struct br_sheet_view){*s, page, 1});
    fputc('\n', out);
    br_say_trade_ends(page, &some);
    if (ends.most && ends.count > ends.most)
        fprintf(out, "... and %zu more: the tables that are written have them all\n",
                ends.count - ends.most);
}

void br_trade_show(FILE *out, const struct br_trade_page *page)
{
    print_page(out, page, false);
}

static enum br_status emit(FILE *out, const struct br_trade_page *page, struct br_error *err)
{
    (void)err;
    print_page(out, page, true);
    return BR_OK;
}

static enum br_status summarise(FILE *out, const struct br_trade_page *page, size_t pages,
                                struct br_error *err)
{
    (void)err;
    print_sheet(out, &(struct br_sheet_view){&br_sheet_summary, page, pages});
    return BR_OK;
}

const struct br_trade_emitter br_trade_text = {"text", ".txt", emit, summarise};
