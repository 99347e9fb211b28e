/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A report for a terminal, and its .txt file. */
#include <string.h>

#include "study/scene/quote.h"
#include "tables/document.h"

enum {
    WIDTH = 100,    /* columns of a paragraph */
    WRAPPED = 44,   /* of a cell in a column that is wrapped */
    LONG_TABLE = 24 /* rows: a terminal does not show more, but of a BR_LONG table */
};

/* A report on its way out. */
struct page {
    FILE *out;
    const struct br_document *d;
    bool terminal;
    /* Buffers of `size` bytes: any text of the report has room in them, quoted. */
    char *visible, *piece;
    size_t size;
};

/* Its columns: characters, not bytes. */
static int width_of(const struct page *p, const char *text)
{
    int width = 0;
    for (const char *c = br_quoted(p->visible, p->size, &br_for_text, text); *c; c++)
        width += ((unsigned char)*c & 0xc0) != 0x80;
    return width;
}

static void print(const struct page *p, const char *text)
{
    br_quote(p->out, &br_for_text, text);
}

static void print_blanks(const struct page *p, int count)
{
    fprintf(p->out, "%*s", count > 0 ? count : 0, "");
}

static void print_underlined(const struct page *p, const char *title, char line)
{
    print(p, title);
    fputc('\n', p->out);
    for (int i = width_of(p, title); i > 0; i--)
        fputc(line, p->out);
    fputc('\n', p->out);
}

/* In lines of at most WIDTH columns; those after the first are indented. */
static void print_paragraph(const struct page *p, const char *paragraph)
{
    const char *text = br_quoted(p->visible, p->size, &br_for_text, paragraph);
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
    fputc('\n', p->out);
}

/* Lines as they are, indented. */
static void print_lines(const struct page *p, const char *lines)
{
    br_document_print_lines(p->out, &br_for_text, "  ", lines, "\n");
}

/* ---- tables ---- */

struct layout {
    const struct br_column *column;
    int width, mark; /* of values and of what stands behind them */
    bool shown, left;
    const char *rest; /* of the text of the row's cell */
};

/* "time step, s"; overwrites p->piece. */
static const char *heading_of(const struct page *p, const struct br_column *c)
{
    snprintf(p->piece, p->size, "%s%s%s", c->heading, c->unit ? ", " : "", c->unit ? c->unit : "");
    return p->piece;
}

static int larger(int a, int b)
{
    return a > b ? a : b;
}

static struct layout lay_out(const struct page *p, const struct br_document_table *t, size_t c)
{
    char buffer[BR_SHOWN];
    const unsigned flags = t->column[c].flags;
    struct layout l = {
        .column = &t->column[c],
        .shown = br_document_is_seen(t, c) && !(p->terminal && flags & BR_FILES_ONLY),
        .left = br_document_is_text(t, c),
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

/* How many bytes of a text stand on a line of its cell: whole words, as many as have room. */
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

/* Prints a line of l->rest, and a mark. */
static void print_piece(const struct page *p, struct layout *l, const char *mark, bool last)
{
    const size_t bytes = bytes_of_line(l, l->rest);
    snprintf(p->piece, p->size, "%.*s", (int)bytes, l->rest);
    l->rest += bytes;
    l->rest += strspn(l->rest, " ");
    const int missing = l->width - width_of(p, p->piece);
    print_blanks(p, l->left ? 0 : missing);
    print(p, p->piece);
    print(p, mark);
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

/* Several lines where cells are wrapped. */
static void print_row(const struct page *p, const struct br_document_table *t, struct layout *l,
                      size_t r)
{
    char buffer[BR_SHOWN];
    bool more = false;
    const size_t last = last_shown(t, l);
    for (size_t c = 0; c < last; c++) {
        const struct br_document_cell *cell = br_document_cell_at(t, r, c);
        if (!l[c].shown)
            continue;
        l[c].rest = br_document_shown(l[c].column, cell, buffer);
        print_piece(p, &l[c], cell->mark ? cell->mark : "", c + 1 == last);
        if (!*l[c].rest)
            l[c].rest = ""; /* not what the buffer will have */
        more |= *l[c].rest != '\0';
    }
    fputc('\n', p->out);
    while (more) {
        more = false;
        for (size_t c = 0; c < last; c++)
            if (l[c].shown) {
                print_piece(p, &l[c], "", c + 1 == last);
                more |= *l[c].rest != '\0';
            }
        fputc('\n', p->out);
    }
}

static enum br_status print_table(const struct page *p, const struct br_document_table *t,
                                  struct br_error *err)
{
    struct layout *l = br_allocate(t->columns + 1, sizeof *l);
    if (!l)
        return br_no_memory(err, "the columns of a table");
    for (size_t c = 0; c < t->columns; c++)
        l[c] = lay_out(p, t, c);
    fputc('\n', p->out);
    print(p, t->title);
    fputc('\n', p->out);
    const size_t last = last_shown(t, l);
    for (size_t c = 0; c < last; c++)
        if (l[c].shown) {
            const int missing = l[c].width - width_of(p, heading_of(p, l[c].column));
            print_blanks(p, l[c].left ? 0 : missing);
            print(p, heading_of(p, l[c].column));
            if (c + 1 < last)
                print_blanks(p, (l[c].left ? missing : 0) + l[c].mark + 2);
        }
    fputc('\n', p->out);
    for (size_t r = 0; r < t->rows; r++)
        print_row(p, t, l, r);
    free(l);
    return BR_OK;
}

/* ---- the rest ---- */

static void print_fact(const struct page *p, const struct br_block *b)
{
    char buffer[BR_SHOWN];
    print(p, b->what.heading);
    fputs(": ", p->out);
    print(p, br_document_shown(&b->what, &b->cell, buffer));
    print(p, b->cell.mark ? b->cell.mark : "");
    fputs(b->what.unit ? " " : "", p->out);
    print(p, b->what.unit ? b->what.unit : "");
    fputc('\n', p->out);
}

static void print_command(const struct page *p, const struct br_block *b)
{
    print(p, b->what.heading);
    fputs(":\n", p->out);
    print_lines(p, b->cell.value.text);
}

static bool is_shown(const struct page *p, const struct br_block *b)
{
    const unsigned flags = b->kind == BR_BLOCK_TABLE ? b->table->flags : b->what.flags;
    if (!p->terminal || !br_document_has(b))
        return br_document_has(b);
    if (b->kind == BR_BLOCK_TABLE && b->table->rows > LONG_TABLE && !(flags & BR_LONG))
        return false;
    return !(flags & BR_FILES_ONLY) && (b->kind == BR_BLOCK_TABLE || b->kind == BR_BLOCK_FACT);
}

static enum br_status print_block(const struct page *p, const struct br_block *b,
                                  struct br_error *err)
{
    switch (b->kind) {
    case BR_BLOCK_TABLE:
        return print_table(p, b->table, err);
    case BR_BLOCK_SECTION:
        print_underlined(p, b->text, '-');
        break;
    case BR_BLOCK_NOTE:
        print_paragraph(p, b->text);
        break;
    case BR_BLOCK_FACT:
        print_fact(p, b);
        break;
    case BR_BLOCK_COMMAND:
        print_command(p, b);
        break;
    case BR_BLOCK_PICTURE:
        fputs("Picture ", p->out);
        print(p, b->what.key);
        fputs(": ", p->out);
        print(p, b->text);
        fputc('\n', p->out);
    }
    return BR_OK;
}

static enum br_status print_blocks(const struct page *p, struct br_error *err)
{
    enum br_status status = BR_OK;
    enum br_block_kind before = BR_BLOCK_TABLE;
    const struct br_block *section = NULL; /* on a terminal: a title that facts will need */
    for (size_t i = 0; i < p->d->blocks && !status; i++) {
        const struct br_block *b = &p->d->block[i];
        if (p->terminal && b->kind == BR_BLOCK_SECTION)
            section = b;
        if (!is_shown(p, b))
            continue;
        if (section && b->kind == BR_BLOCK_FACT) {
            fputc('\n', p->out);
            status = print_block(p, section, err);
            before = BR_BLOCK_SECTION;
        }
        section = NULL;
        if (b->kind != BR_BLOCK_TABLE && b->kind != before && before != BR_BLOCK_SECTION)
            fputc('\n', p->out);
        status = print_block(p, b, err);
        before = b->kind;
    }
    return status;
}

static void print_verdict(const struct page *p, const struct br_document_verdict *v)
{
    fprintf(p->out, "\n%s  ", br_outcome_names[v->outcome]);
    print(p, v->group ? v->group : "");
    fputs(v->group ? ", " : "", p->out);
    print(p, v->name);
    fputs(v->message ? ": " : "", p->out);
    print(p, v->message ? v->message : "");
    fputc('\n', p->out);
    for (size_t i = 0; i < v->details; i++)
        print_lines(p, v->detail[i]);
}

static void print_answer(const struct page *p)
{
    for (size_t i = 0; i < p->d->answers; i++)
        print_paragraph(p, p->d->answer[i]);
}

/* What a terminal shows last: the answer, and what may be typed next. */
static void print_end(const struct page *p)
{
    fputs(p->d->answers ? "\n" : "", p->out);
    print_answer(p);
    for (size_t i = 0; i < p->d->blocks; i++)
        if (p->d->block[i].kind == BR_BLOCK_COMMAND)
            print_command(p, &p->d->block[i]);
}

static enum br_status print_page(FILE *out, const struct br_document *d, bool terminal,
                                 struct br_error *err)
{
    struct page p = {.out = out, .d = d, .terminal = terminal};
    p.size = 4 * d->longest + BR_SHOWN; /* \xff for a byte; a heading and its unit */
    p.visible = br_allocate(2, p.size);
    if (!p.visible)
        return br_no_memory(err, "the text of a report");
    p.piece = p.visible + p.size;
    print_underlined(&p, d->caption, '=');
    if (!terminal)
        print_answer(&p);
    const enum br_status status = print_blocks(&p, err);
    for (size_t i = 0; i < d->verdicts && !status; i++)
        if (br_document_verdict_matters(&d->verdict[i]))
            print_verdict(&p, &d->verdict[i]);
    if (terminal)
        print_end(&p);
    free(p.visible);
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
