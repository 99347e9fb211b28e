/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The page for a terminal and its .txt file. */
#include <string.h>

#include "study/scene/quote.h"
#include "tables/sheet.h"

static int column_width(const struct br_table *t, size_t column, bool *number)
{
    char text[BR_CELL];
    int widest = br_width_of(t->heading(t->self, column, number));
    for (size_t r = 0; r < t->rows; r++) {
        t->cell(t->self, r, column, text);
        widest = br_width_of(text) > widest ? br_width_of(text) : widest;
    }
    return widest;
}

static void print_cell(FILE *out, const char *text, bool number, int width, bool last)
{
    const int blanks = width - br_width_of(text);
    fprintf(out, "%*s", number ? blanks : 0, "");
    br_quote(out, &br_for_text, text);
    if (last)
        fputc('\n', out);
    else
        fprintf(out, "%*s  ", number ? 0 : blanks, "");
}

static enum br_status print_table(FILE *out, const struct br_table *t, struct br_error *err)
{
    struct {
        int width;
        bool number;
    } *column = br_allocate(t->columns + 1, sizeof *column);
    char text[BR_CELL];
    bool number;
    if (!column)
        return br_no_memory(err, "the columns of a table");
    for (size_t c = 0; c < t->columns; c++)
        column[c].width = column_width(t, c, &column[c].number);
    fprintf(out, "\n%s\n", t->title);
    for (size_t c = 0; c < t->columns; c++)
        print_cell(out, t->heading(t->self, c, &number), column[c].number, column[c].width,
                   c + 1 == t->columns);
    for (size_t r = 0; r < t->rows; r++)
        for (size_t c = 0; c < t->columns; c++) {
            t->cell(t->self, r, c, text);
            print_cell(out, text, column[c].number, column[c].width, c + 1 == t->columns);
        }
    free(column);
    return BR_OK;
}

/* Paragraphs, of which only the first ones are printed where `most` says so. */
struct paragraphs {
    FILE *out;
    size_t count, most; /* 0: all */
};

static void print_some(void *self, const char *text)
{
    struct paragraphs *p = self;
    if (p->count++ < p->most || !p->most)
        br_print_wrapped(p->out, text);
}

static void print_notes(FILE *out, const struct br_page *page, bool whole)
{
    struct paragraphs some = {.out = out, .most = whole ? 0 : page->notes_shown};
    fputc('\n', out);
    page->say_notes(page->self, &(struct br_writer){print_some, &some});
    if (some.most && some.count > some.most)
        fprintf(out, "... and %zu more: the tables that are written have them all\n",
                some.count - some.most);
}

static enum br_status print_page(FILE *out, const struct br_page *page, bool whole,
                                 struct br_error *err)
{
    enum br_status status = BR_OK;
    br_print_caption(out, page->caption);
    if (page->say)
        page->say(page->self, &(struct br_writer){br_print_wrapped, out});
    for (size_t i = 0; i < page->tables && !status; i++)
        if (whole || !page->table[i].only_in_files)
            status = print_table(out, &page->table[i], err);
    if (page->say_notes && !status)
        print_notes(out, page, whole);
    return status;
}

enum br_status br_page_show(FILE *out, const struct br_page *page, struct br_error *err)
{
    return print_page(out, page, false, err);
}

static enum br_status emit(FILE *out, const struct br_page *page, struct br_error *err)
{
    return print_page(out, page, true, err);
}

const struct br_page_emitter br_page_text = {"text", ".txt", emit};
