/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A block a table, with its headings; blocks are separated by an empty line, and every line begins
 * with its table's name ("table" above the names), so that one table is easily taken out. A cell
 * that is not there is an empty field (RFC 4180). Sentences are left to the other formats. */
#include <string.h>

#include "study/scene/quote.h"
#include "tables/sheet.h"

static void print_table(FILE *out, const struct br_table *t)
{
    char text[BR_CELL];
    bool number;
    fputs("table", out);
    for (size_t c = 0; c < t->columns; c++) {
        fputc(',', out);
        br_quote(out, &br_for_csv, t->heading(t->self, c, &number));
    }
    fputc('\n', out);
    for (size_t r = 0; r < t->rows; r++) {
        br_quote(out, &br_for_csv, t->name);
        for (size_t c = 0; c < t->columns; c++) {
            t->cell(t->self, r, c, text);
            fputc(',', out);
            br_quote(out, &br_for_csv, strcmp(text, "-") == 0 ? "" : text);
        }
        fputc('\n', out);
    }
}

static enum br_status emit(FILE *out, const struct br_page *page, struct br_error *err)
{
    (void)err;
    for (size_t i = 0; i < page->tables; i++) {
        fputs(i ? "\n" : "", out);
        print_table(out, &page->table[i]);
    }
    return BR_OK;
}

const struct br_page_emitter br_page_csv = {"csv", ".csv", emit};
