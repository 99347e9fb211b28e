/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A report for a terminal, and its .txt file. */
#include <string.h>

#include "tables/markup.h"

enum {
    WIDTH = 100, /* columns of a paragraph */
    WRAPPED = 44 /* of a cell in a wrapped column */
};

/* Buffers of `size` bytes: enough for any text of the report, quoted. */
struct buffers {
    char *visible, *piece;
    size_t size;
};

/* The number of columns of a text: characters, not bytes. */
static int width_of(const struct br_markup_page *p, const char *text)
{
    const struct buffers *b = p->own;
    int width = 0;
    for (const char *c = br_quoted(b->visible, b->size, &br_for_text, text); *c; c++)
        width += ((unsigned char)*c & 0xc0) != 0x80;
    return width;
}

static void print_blanks(const struct br_markup_page *p, int count)
{
    fprintf(p->out, "%*s", count > 0 ? count : 0, "");
}

static void print_title(const struct br_markup_page *p, int level, const char *title)
{
    br_markup_put(p, level == p->level ? "" : "\n", title, "\n");
    for (int i = width_of(p, title); i > 0; i--)
        fputc(level == p->level ? '=' : '-', p->out);
    fputc('\n', p->out);
}

/* Prints lines of at most WIDTH columns; all but the first are indented. */
static void print_paragraph(const struct br_markup_page *p, const char *paragraph)
{
    const struct buffers *b = p->own;
    const char *text = br_quoted(b->visible, b->size, &br_for_text, paragraph);
    size_t column = 0;
    while (*text) {
        const size_t word = strcspn(text, " ");
        if (column && column + 1 + word > WIDTH) {
            fputs("\n  ", p->out);
            column = 2;
        } else if (column) {
            fputc(' ', p->out);
            column++;
        }
        fprintf(p->out, "%.*s", (int)word, text);
        column += word;
        text += word;
        text += strspn(text, " ");
    }
}

struct layout {
    const struct br_column *column;
    int width, mark; /* of the values and of the marks behind them */
    bool shown, left;
    const char *rest; /* the rest of the cell's text, for the next line */
};

/* The heading "time step, s"; it overwrites the buffer `piece`. */
static const char *heading_of(const struct br_markup_page *p, const struct br_column *c)
{
    const struct buffers *b = p->own;
    snprintf(b->piece, b->size, "%s%s%s", c->heading, c->unit ? ", " : "", c->unit ? c->unit : "");
    return b->piece;
}

static int larger(int a, int b)
{
    return a > b ? a : b;
}

static struct layout lay_out(const struct br_markup_page *p, const struct br_document_table *t,
                             size_t c)
{
    char buffer[BR_SHOWN];
    const unsigned flags = t->column[c].flags;
    struct layout l = {
        .column = &t->column[c],
        .shown = br_document_is_seen(t, c) && !(p->terminal && flags & BR_FILES_ONLY),
        .left = flags & BR_TEXTUAL,
    };
    for (size_t r = 0; r < t->rows; r++) {
        const struct br_document_cell *cell = br_document_cell_at(t, r, c);
        l.width = larger(l.width, width_of(p, br_document_shown(l.column, cell, buffer)));
        l.mark = larger(l.mark, cell->mark ? width_of(p, cell->mark) : 0);
    }
    if (flags & BR_WRAP && l.width > WRAPPED)
        l.width = WRAPPED;
    l.width = larger(l.width, width_of(p, heading_of(p, l.column)));
    return l;
}

/* The number of bytes of a text on one line of its cell: as many whole words as fit. */
static size_t bytes_of_line(const struct layout *l, const char *text)
{
    size_t bytes = 0;
    int columns = 0;
    if (!(l->column->flags & BR_WRAP))
        return strlen(text);
    for (size_t i = 0; text[i]; i++) {
        columns += ((unsigned char)text[i] & 0xc0) != 0x80;
        if (columns > l->width)
            return bytes ? bytes : strcspn(text, " ");
        if (text[i + 1] == ' ' || !text[i + 1])
            bytes = i + 1;
    }
    return bytes;
}

/* Prints one line of l->rest, and a mark. */
static void print_piece(const struct br_markup_page *p, struct layout *l, const char *mark,
                        bool last)
{
    const struct buffers *b = p->own;
    const size_t bytes = bytes_of_line(l, l->rest);
    snprintf(b->piece, b->size, "%.*s", (int)bytes, l->rest);
    l->rest += bytes;
    l->rest += strspn(l->rest, " ");
    const int missing = l->width - width_of(p, b->piece);
    print_blanks(p, l->left ? 0 : missing);
    br_markup_text(p, b->piece);
    br_markup_text(p, mark);
    if (!last)
        print_blanks(p, (l->left ? missing : 0) + l->mark - width_of(p, mark) + 2);
}

static size_t last_shown(const struct br_document_table *t, const struct layout *l)
{
    size_t last = t->columns;
    while (last > 0 && !l[last - 1].shown)
        last--;
    return last;
}

/* Prints a row, on several lines where cells are wrapped. */
static void print_row(const struct br_markup_page *p, const struct br_document_table *t,
                      struct layout *l, size_t r)
{
    char buffer[BR_SHOWN];
    bool first = true, more;
    const size_t last = last_shown(t, l);
    do {
        more = false;
        for (size_t c = 0; c < last; c++) {
            const struct br_document_cell *cell = br_document_cell_at(t, r, c);
            if (!l[c].shown)
                continue;
            if (first)
                l[c].rest = br_document_shown(l[c].column, cell, buffer);
            print_piece(p, &l[c], first && cell->mark ? cell->mark : "", c + 1 == last);
            if (!*l[c].rest)
                l[c].rest = ""; /* the next cell overwrites the buffer */
            more |= *l[c].rest != '\0';
        }
        fputc('\n', p->out);
        first = false;
    } while (more);
}

static void print_table(struct br_markup_page *p, const struct br_document_table *t)
{
    struct layout *l = br_allocate(t->columns + 1, sizeof *l);
    if (!l) {
        p->status = br_no_memory(p->err, "the columns of a table");
        return;
    }
    for (size_t c = 0; c < t->columns; c++)
        l[c] = lay_out(p, t, c);
    br_markup_put(p, "\n", t->title, "\n");
    const size_t last = last_shown(t, l);
    for (size_t c = 0; c < last; c++)
        if (l[c].shown) {
            const int missing = l[c].width - width_of(p, heading_of(p, l[c].column));
            print_blanks(p, l[c].left ? 0 : missing);
            br_markup_text(p, heading_of(p, l[c].column));
            if (c + 1 < last)
                print_blanks(p, (l[c].left ? missing : 0) + l[c].mark + 2);
        }
    fputc('\n', p->out);
    for (size_t r = 0; r < t->rows; r++)
        print_row(p, t, l, r);
    free(l);
}

static void print_picture(struct br_markup_page *p, const struct br_block *b)
{
    br_markup_put(p, "Picture ", b->what.key, ": ");
    br_markup_put(p, "", b->text, "\n");
}

static const struct br_markup text = {
    .quoting = &br_for_text,
    .of_lines = &br_for_text,
    .answer = {"", "\n"},
    .note = {"", "\n"},
    .fact = {"", "\n"},
    .label = {"", ": "},
    .command = {"", ":\n"},
    .line = {"  ", "\n"},
    .verdict = {"\n", "\n"},
    .detail = {"  ", "\n"},
    .word = "%s",
    .gap = "\n",
    .title = print_title,
    .paragraph = print_paragraph,
    .table = print_table,
    .picture = print_picture,
};

static enum br_status print_page(FILE *out, const struct br_document *d, bool terminal,
                                 struct br_error *err)
{
    struct buffers b = {.size = 4 * d->longest + BR_SHOWN}; /* \xff for a byte; heading and unit */
    struct br_markup_page p = {
        .out = out, .markup = &text, .d = d, .terminal = terminal, .own = &b, .err = err};
    b.visible = br_allocate(2, b.size);
    if (!b.visible)
        return br_no_memory(err, "the text of a report");
    b.piece = b.visible + b.size;
    const enum br_status status = br_markup_print(&p);
    free(b.visible);
    return status;
}

enum br_status br_document_show(FILE *out, const struct br_document *d, struct br_error *err)
{
    const enum br_status status = br_document_status(d, err);
    return status ? status : print_page(out, d, true, err);
}

static enum br_status write(FILE *out, const struct br_document *d,
                            const struct br_document_table *table, struct br_error *err)
{
    (void)table;
    return print_page(out, d, false, err);
}

const struct br_document_format br_document_text = {
    .name = "text",
    .extension = ".txt",
    .title = "for a person",
    .write = write,
};
