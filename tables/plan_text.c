/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The page for a terminal and its .txt file. */
#include <string.h>

#include "tables/plain_text.h"
#include "tables/plan_emitter.h"

enum { MOST_COLUMNS = 12 };

static void fit_widths(const struct br_plan_page *page, const struct br_plan_sheet *s,
                       int width[MOST_COLUMNS])
{
    char text[BR_PLAN_CELL];
    bool number;
    for (size_t c = 0; c < s->columns; c++) {
        width[c] = (int)strlen(s->heading(c, &number));
        for (size_t r = 0; r < s->rows(page); r++) {
            s->cell(page, r, c, text);
            width[c] = (int)strlen(text) > width[c] ? (int)strlen(text) : width[c];
        }
    }
}

static void print_cell(FILE *out, const char *text, bool number, int width, bool last)
{
    if (last && !number)
        fprintf(out, "%s\n", text);
    else
        fprintf(out, number ? "%*s%s" : "%-*s%s", width, text, last ? "\n" : "  ");
}

static void print_sheet(FILE *out, const struct br_plan_page *page, const struct br_plan_sheet *s)
{
    char text[BR_PLAN_CELL];
    int width[MOST_COLUMNS];
    bool number;
    fit_widths(page, s, width);
    fprintf(out, "\n%s\n", s->title);
    for (size_t c = 0; c < s->columns; c++) {
        const char *heading = s->heading(c, &number);
        print_cell(out, heading, number, width[c], c + 1 == s->columns);
    }
    for (size_t r = 0; r < s->rows(page); r++)
        for (size_t c = 0; c < s->columns; c++) {
            s->heading(c, &number);
            s->cell(page, r, c, text);
            print_cell(out, text, number, width[c], c + 1 == s->columns);
        }
}

static enum br_status emit(FILE *out, const struct br_plan_page *page, struct br_error *err)
{
    (void)err;
    const struct br_writer w = {br_print_wrapped, out};
    br_print_plain(out, page->caption);
    fputc('\n', out);
    for (size_t i = 0; i < strlen(page->caption); i++)
        fputc('=', out);
    fputc('\n', out);
    br_say_plan(page, &w);
    for (const struct br_plan_sheet *const *s = br_plan_sheets; *s; s++)
        print_sheet(out, page, *s);
    fputc('\n', out);
    br_say_plan_notes(page, &w);
    return BR_OK;
}

const struct br_plan_emitter br_plan_text = {"text", ".txt", emit};
