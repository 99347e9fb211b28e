/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A report for a terminal, and its .txt file. */
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "tables/markup.h"

enum {
    WIDTH = 100,  /* columns of a paragraph */
    WRAPPED = 48, /* of a cell in a wrapped column */
    LEAST = 16,   /* of one on a narrow terminal */
    GAP = 2,      /* between two columns */
    INDENT = 4,   /* of a row's further lines */
    NARROW = 20   /* a terminal is not taken to be narrower */
};

/* Buffers of `size` bytes: enough for any text of the report, quoted. */
struct buffers {
    char *visible, *piece, *heading;
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

/* Prints lines of at most WIDTH columns, and no more than the terminal has; all but the first are
 * indented. */
static void print_paragraph(const struct br_markup_page *p, const char *paragraph)
{
    const struct buffers *b = p->own;
    const char *text = br_quoted(b->visible, b->size, &br_for_text, paragraph);
    const size_t width = p->columns && p->columns < WIDTH ? (size_t)p->columns : WIDTH;
    size_t column = 0;
    while (*text) {
        const size_t word = strcspn(text, " ");
        if (column && column + 1 + word > width) {
            fputs("\n  ", p->out);
            column = 2;
        } else if (column) {
            fputc(' ', p->out);
            column++;
        }
        column += word;
        const size_t name = column == word ? strcspn(text, " ,:") : 0;
        const size_t told = br_markup_word(p, text, name) ? name : 0;
        fprintf(p->out, "%.*s", (int)(word - told), text + told);
        text += word;
        text += strspn(text, " ");
    }
}

/* In one line, unless a terminal is narrower. */
static int print_heading(const struct br_markup_page *p, const char *text)
{
    const int width = width_of(p, text);
    if (!p->columns || width <= p->columns) {
        br_markup_put(p, "%s", text);
        return width;
    }
    print_paragraph(p, text);
    return p->columns;
}

static void print_title(const struct br_markup_page *p, int level, const char *title)
{
    fputs(level == p->level ? "" : "\n", p->out);
    const int width = print_heading(p, title);
    fputc('\n', p->out);
    for (int i = 0; i < width; i++)
        fputc(level == p->level ? '=' : '-', p->out);
    fputc('\n', p->out);
}

struct layout {
    const struct br_column *column;
    int width, least, mark; /* of the values, also at least, and of the marks behind them */
    int line;               /* of its row, from 0 on */
    bool shown, left, ends; /* ends: the last one of its line */
    size_t done;            /* bytes of the cell's text that stand on lines above */
};

/* The heading "time step, s"; it overwrites the buffer `heading`. */
static const char *heading_of(const struct br_markup_page *p, const struct br_column *c)
{
    const struct buffers *b = p->own;
    snprintf(b->heading, b->size, "%s%s%s", c->heading, c->unit ? ", " : "",
             c->unit ? c->unit : "");
    return b->heading;
}

static int larger(int a, int b)
{
    return a > b ? a : b;
}

/* The columns of the longest word. */
static int width_of_word(const char *text)
{
    int longest = 0, columns = 0;
    for (const char *c = text; *c; c++) {
        columns = *c == ' ' ? 0 : columns + (((unsigned char)*c & 0xc0) != 0x80);
        longest = larger(longest, columns);
    }
    return longest;
}

static struct layout lay_out(const struct br_markup_page *p, const struct br_document_table *t,
                             size_t c)
{
    char buffer[BR_SHOWN];
    const unsigned flags = t->column[c].flags;
    struct layout l = {
        .column = &t->column[c],
        .shown = br_document_is_shown(t, c) && !(p->terminal && flags & BR_FILES_ONLY),
        .left = flags & BR_TEXTUAL,
    };
    const char *heading = heading_of(p, l.column);
    int word = 0; /* the longest */
    for (size_t r = 0; r < t->rows; r++) {
        const struct br_document_cell *cell = br_document_cell_at(t, r, c);
        const char *text = br_document_shown(l.column, cell, buffer);
        const int width = width_of(p, text);
        l.width = larger(l.width, width);
        word = larger(word, width_of_word(text));
        l.mark = larger(l.mark, cell->mark ? width_of(p, cell->mark) : 0);
    }
    l.least = l.width;
    if (flags & BR_WRAP || l.width > WRAPPED)
        l.least = larger(word, l.width < LEAST ? l.width : LEAST);
    if (flags & BR_WRAP && l.width > WRAPPED)
        l.width = WRAPPED;
    l.width = larger(l.width, width_of(p, heading));
    l.least = larger(l.least, width_of_word(heading));
    return l;
}

/* Ends a line of the columns from l to `end`: makes the widest one that can be wrapped narrower,
 * until the line fits or none can. columns: of the terminal; 0: any number. */
static void end_line(int columns, struct layout *l, struct layout *end)
{
    struct layout *widest = NULL, *last = NULL;
    do {
        int width = l->line ? INDENT - GAP : -GAP;
        widest = NULL;
        for (struct layout *c = l; c < end; c++) {
            width += c->shown ? c->width + c->mark + GAP : 0;
            last = c->shown ? c : last;
            if (c->shown && c->width > c->least && (!widest || c->width > widest->width))
                widest = c;
        }
        if (!columns || width <= columns)
            widest = NULL;
        if (widest)
            widest->width--;
    } while (widest);
    if (last)
        last->ends = true;
}

/* Puts the columns on the lines of a row: one, if the terminal has room. */
static void arrange(int columns, struct layout *l, struct layout *end)
{
    struct layout *begin = l;
    int line = 0, width = 0;
    for (struct layout *c = l; c < end; c++) {
        if (c->shown && columns && c > begin && width + c->least + c->mark > columns) {
            end_line(columns, begin, c);
            begin = c;
            width = INDENT;
            line++;
        }
        width += c->shown ? c->least + c->mark + GAP : 0;
        c->line = line;
    }
    end_line(columns, begin, end);
}

/* The number of bytes of a text on one line of its cell: as many whole words as fit. */
static size_t bytes_of_line(const struct layout *l, const char *text)
{
    size_t bytes = 0;
    int columns = 0;
    for (size_t i = 0; text[i]; i++) {
        columns += ((unsigned char)text[i] & 0xc0) != 0x80;
        if (columns > l->width)
            return bytes ? bytes : strcspn(text, " ");
        if (text[i + 1] == ' ' || !text[i + 1])
            bytes = i + 1;
    }
    return bytes;
}

/* Prints one line of what is left of a cell's text, and a mark. */
static void print_piece(const struct br_markup_page *p, struct layout *l, const char *text,
                        const char *mark)
{
    const struct buffers *b = p->own;
    const size_t bytes = bytes_of_line(l, text + l->done);
    snprintf(b->piece, b->size, "%.*s", (int)bytes, text + l->done);
    l->done += bytes;
    l->done += strspn(text + l->done, " ");
    const int missing = l->width - width_of(p, b->piece);
    print_blanks(p, l->left ? 0 : missing);
    if (!br_markup_word(p, b->piece, bytes))
        br_markup_put(p, "%s", b->piece);
    br_markup_put(p, "%s", mark);
    if (!l->ends)
        print_blanks(p, (l->left ? missing : 0) + l->mark - width_of(p, mark) + GAP);
}

/* Prints a row, or the headings (t->rows), on several lines where cells are wrapped or the terminal
 * is too narrow. */
static void print_row(const struct br_markup_page *p, const struct br_document_table *t,
                      struct layout *l, size_t last, size_t row)
{
    char buffer[BR_SHOWN];
    for (size_t c = 0; c < last; c++)
        l[c].done = 0;
    for (int line = 0; line <= (last ? l[last - 1].line : -1); line++) {
        bool first = true, more;
        do {
            more = false;
            print_blanks(p, line ? INDENT : 0);
            for (size_t c = 0; c < last; c++) {
                const struct br_document_cell *cell =
                    row < t->rows ? br_document_cell_at(t, row, c) : NULL;
                if (!l[c].shown || l[c].line != line)
                    continue;
                const char *text = cell ? br_document_shown(l[c].column, cell, buffer)
                                        : heading_of(p, l[c].column);
                print_piece(p, &l[c], text, first && cell && cell->mark ? cell->mark : "");
                more |= text[l[c].done] != '\0';
            }
            fputc('\n', p->out);
            first = false;
        } while (more);
    }
}

static void print_table(struct br_markup_page *p, const struct br_document_table *t)
{
    struct layout *l = br_allocate(t->columns + 1, sizeof *l);
    size_t last = 0; /* one more than the last column that is shown */
    if (!l) {
        p->status = br_no_memory(p->err, "the columns of a table");
        return;
    }
    for (size_t c = 0; c < t->columns; c++) {
        l[c] = lay_out(p, t, c);
        last = l[c].shown ? c + 1 : last;
    }
    arrange(p->columns, l, l + last);
    fputc('\n', p->out);
    print_heading(p, t->title);
    fputc('\n', p->out);
    print_row(p, t, l, last, t->rows);
    for (size_t r = 0; r < t->rows; r++)
        print_row(p, t, l, last, r);
    free(l);
}

static void print_picture(struct br_markup_page *p, const struct br_block *b)
{
    br_markup_put(p, "Picture %s: %s\n", b->what.key, b->text);
}

static const struct br_markup text = {
    .quoting = &br_for_text,
    .of_lines = &br_for_text,
    .answer = {"", "\n"},
    .note = {"", "\n"},
    .fact = {"", "\n"},
    .label = "%s: ",
    .command = "%s:\n",
    .line = {"  ", "\n"},
    .verdict = {"\n", "\n"},
    .detail = "  %s\n",
    .mark = "%s",
    .word = "%s",
    .gap = "\n",
    .title = print_title,
    .paragraph = print_paragraph,
    .table = print_table,
    .picture = print_picture,
};

int br_document_columns(FILE *out)
{
    struct winsize size;
    const int descriptor = fileno(out); /* -1: memory */
    const bool known = isatty(descriptor) == 1 && ioctl(descriptor, TIOCGWINSZ, &size) == 0;
    return known && size.ws_col > 0 ? larger(size.ws_col, NARROW) : 0;
}

/* What the terminal has, if there is one behind `out`. */
static void ask_terminal(struct br_markup_page *p)
{
    const char *plain = getenv("NO_COLOR"), *term = getenv("TERM");
    p->columns = br_document_columns(p->out);
    p->colour =
        isatty(fileno(p->out)) == 1 && !(plain && *plain) && term && strcmp(term, "dumb") != 0;
}

static bool has_failed(const struct br_document *d)
{
    bool failed = false;
    for (size_t i = 0; i < d->verdicts; i++)
        failed |= d->verdict[i].outcome != BR_OUTCOME_PASS;
    return failed;
}

/* Prints the heads of all documents, those with failures first. */
static void print_heads(struct br_markup_page *p, const struct br_document *d, size_t count)
{
    bool any = false;
    for (int passed = 0; passed < 2; passed++)
        for (size_t i = 0; i < count && !p->status; i++) {
            if (has_failed(&d[i]) == passed)
                continue;
            fputs(any ? "\n" : "", p->out);
            p->d = &d[i];
            br_markup_head(p);
            any = true;
        }
}

/* Prints the heads of all documents, and then their bodies, with a title where there are several.
 */
static enum br_status print_pages(FILE *out, const struct br_document *d, size_t count,
                                  bool terminal, struct br_error *err)
{
    struct buffers b = {.size = BR_SHOWN};
    struct br_markup_page p = {
        .out = out, .markup = &text, .terminal = terminal, .own = &b, .err = err};
    for (size_t i = 0; i < count && !p.status; i++) {
        p.status = br_document_status(&d[i], err);
        b.size += 4 * d[i].longest; /* \xff for a byte; heading and unit */
    }
    if (p.status)
        return p.status;
    if (terminal)
        ask_terminal(&p);
    b.visible = br_allocate(3, b.size);
    if (!b.visible)
        return br_no_memory(err, "the text of a report");
    b.piece = b.visible + b.size;
    b.heading = b.piece + b.size;
    print_heads(&p, d, count);
    for (size_t i = 0; i < count && !p.status; i++) {
        p.d = &d[i];
        if (br_markup_has_body(&p)) {
            if (count > 1) {
                fputc('\n', out);
                br_markup_heading(&p, p.level, p.d->caption);
            }
            br_markup_body(&p);
        }
    }
    free(b.visible);
    return p.status;
}

enum br_status br_document_show(FILE *out, const struct br_document *d, size_t count,
                                struct br_error *err)
{
    return print_pages(out, d, count, true, err);
}

static enum br_status write_text(FILE *out, const struct br_document *d,
                                 const struct br_document_table *table, struct br_error *err)
{
    (void)table;
    return print_pages(out, d, 1, false, err);
}

const struct br_document_format br_document_text = {
    .name = "text",
    .extension = ".txt",
    .title = "for a person",
    .write = write_text,
};
