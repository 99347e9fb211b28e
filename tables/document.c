/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/document.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include "base/observer.h"
#include "tables/markup.h"

const char *const br_outcome_names[] = {"PASS", "FAIL", "INCONCLUSIVE", "ERROR"};

const struct br_document_format *const br_document_formats[] = {&br_document_text,
                                                                &br_document_csv,
                                                                &br_document_markdown,
                                                                &br_document_latex,
                                                                &br_document_json,
                                                                &br_document_html,
                                                                NULL};

/* ---- memory: small pieces of large ones, released together ---- */

enum { PIECE = 1 << 14, ALIGNED = 16 };

/* Memory of zeros; NULL after any failure. */
static void *take(struct br_document *d, size_t size)
{
    size = (size + ALIGNED - 1) / ALIGNED * ALIGNED;
    if (d->failure.status)
        return NULL;
    if (d->left < size) {
        d->left = size > PIECE ? size : PIECE;
        d->piece = br_store_take(&d->store, 1, d->left);
        if (!d->piece) {
            br_no_memory(&d->failure, "a report");
            return NULL;
        }
    }
    d->left -= size;
    d->piece += size;
    return d->piece - size;
}

/* A list with room for one more than `count` elements; NULL after a failure. */
static void *grown(struct br_document *d, void *list, size_t count, size_t *room, size_t size)
{
    void *larger = d->failure.status ? NULL : br_store_grow(&d->store, list, count, room, size);
    if (!larger && !d->failure.status)
        br_no_memory(&d->failure, "a report");
    return larger;
}

/* Stores the failure of a report that is built wrongly; it is not printed. */
static void refuse(struct br_document *d, const char *what, const char *key)
{
    if (!d->failure.status)
        br_fail(&d->failure, BR_IO, "the report %.100s was built wrongly: %s '%.100s'",
                d->name ? d->name : "", what, key ? key : "");
}

static const char *note_length(struct br_document *d, const char *text)
{
    const size_t length = strlen(text);
    d->longest = length > d->longest ? length : d->longest;
    return text;
}

static const char *copied(struct br_document *d, const char *text)
{
    char *copy = text ? take(d, strlen(text) + 1) : NULL;
    return copy ? note_length(d, strcpy(copy, text)) : NULL;
}

/* Removes the minus from each number of a text whose digits are all zeros. "-0.00 [-0.01, 0.00]"
 * becomes "0.00 [-0.01, 0.00]". */
static const char *without_signs_of_zero(char *text)
{
    for (char *c = text; (c = strchr(c, '-')); c++) {
        const char *end = c + 1 + strspn(c + 1, "0.");
        const bool zeros = memchr(c + 1, '0', (size_t)(end - c - 1));
        if (*end == 'e' && (end[1] == '+' || end[1] == '-'))
            end += 2 + strspn(end + 2, "0123456789");
        if (zeros && (c == text || strchr(" [(", c[-1])) && !isalnum((unsigned char)*end))
            memmove(c, c + 1, strlen(c));
    }
    return text;
}

const char *br_format(struct br_document *d, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    if (length < 0)
        refuse(d, "no text by the format", format);
    char *text = take(d, (size_t)length + 1);
    if (!text)
        return "";
    va_start(arguments, format);
    vsnprintf(text, (size_t)length + 1, format, arguments);
    va_end(arguments);
    return note_length(d, without_signs_of_zero(text));
}

void br_document_clear(struct br_document *d)
{
    br_store_clear(&d->store);
    *d = (struct br_document){.name = NULL};
}

/* ---- building ---- */

void br_document_begin(struct br_document *d, const char *name, const char *format, int version,
                       const char *caption)
{
    br_document_clear(d);
    d->name = copied(d, name);
    d->format = copied(d, format);
    d->version = version;
    d->caption = copied(d, caption);
}

/* Makes the document fail where the program must stop. */
static void ask(struct br_document *d)
{
    if (!d->failure.status)
        br_document_status(d, &d->failure);
}

/* NULL after a failure. */
static struct br_block *put_block(struct br_document *d, enum br_block_kind kind)
{
    ask(d);
    d->block = grown(d, d->block, d->blocks, &d->block_room, sizeof *d->block);
    if (!d->block)
        return NULL;
    d->last = NULL;
    d->open = NULL;
    d->block[d->blocks] = (struct br_block){.kind = kind};
    return &d->block[d->blocks++];
}

static void put_paragraph(struct br_document *d, enum br_block_kind kind, const char *text)
{
    struct br_block *block = put_block(d, kind);
    if (!block)
        return;
    block->text = text;
    d->open = &block->text;
}

void br_put_answer_text(struct br_document *d, const char *text)
{
    d->open = &d->answer[d->answers];
    if (d->answers < BR_MOST_ANSWERS)
        d->answer[d->answers++] = text;
    else
        put_paragraph(d, BR_BLOCK_NOTE, text);
}

void br_put_section(struct br_document *d, const char *title)
{
    put_paragraph(d, BR_BLOCK_SECTION, copied(d, title));
}

void br_put_note_text(struct br_document *d, const char *text)
{
    put_paragraph(d, BR_BLOCK_NOTE, text);
}

void br_put_more_text(struct br_document *d, const char *more)
{
    if (!d->open)
        refuse(d, "there is no text before", more);
    else if (!d->failure.status)
        *d->open = br_format(d, "%s%s", *d->open, more);
}

void br_put_list(struct br_document *d, const char *before, const char *between)
{
    d->before = before;
    d->between = between;
    d->items = 0;
}

void br_put_item_text(struct br_document *d, const char *text)
{
    br_put_more(d, "%s%s", d->items++ ? d->between : d->before, text);
}

/* Whether printf may be called with this format and one double. */
static bool is_number_format(const char *format)
{
    size_t conversions = 0;
    for (const char *c = strchr(format, '%'); c; c = strchr(c + 1, '%')) {
        if (c[1] != '%') {
            c += 1 + strspn(c + 1, "+- #0.123456789");
            conversions++;
            if (!*c || !strchr("aefgAEFG", *c))
                return false;
        } else
            c++;
    }
    return conversions == 1;
}

static struct br_column copied_column(struct br_document *d, const struct br_column *c,
                                      bool for_programs)
{
    const char *key = c->key ? c->key : for_programs ? "" : c->heading;
    if (for_programs && (!*key || strpbrk(key, " ,\"\n") || br_not_utf8(key)))
        refuse(d, "no key for programs:", key);
    if (c->format && !is_number_format(c->format))
        refuse(d, "no format of a number:", c->format);
    return (struct br_column){.key = copied(d, key),
                              .heading = copied(d, c->heading ? c->heading : c->key),
                              .unit = copied(d, c->unit && *c->unit ? c->unit : NULL),
                              .format = copied(d, c->format ? c->format : "%.6g"),
                              .flags = c->flags};
}

static bool is_nothing(struct br_value value)
{
    return value.kind == BR_NOTHING || (value.kind == BR_NUMBER && !isfinite(value.number));
}

static struct br_value copied_value(struct br_document *d, struct br_value value)
{
    if (value.kind == BR_TEXT)
        return br_text(copied(d, value.text));
    return br_if(!is_nothing(value), value);
}

static void put_what(struct br_document *d, enum br_block_kind kind, const struct br_column *what,
                     struct br_value value)
{
    const struct br_column column = copied_column(d, what, true);
    const struct br_value copy = copied_value(d, value);
    struct br_block *block = put_block(d, kind);
    if (!block)
        return;
    block->what = column;
    block->cell.value = copy;
    d->last = &block->cell;
    d->open = copy.kind == BR_TEXT ? &block->cell.value.text : NULL;
}

void br_put_fact(struct br_document *d, const struct br_column *what, struct br_value value)
{
    struct br_column column = *what;
    if (!what->heading || is_nothing(value))
        column.flags |= BR_FOR_PROGRAMS;
    put_what(d, BR_BLOCK_FACT, &column, value);
}

void br_put_command(struct br_document *d, const char *key, const char *label, const char *lines)
{
    if (lines && *lines)
        put_what(d, BR_BLOCK_COMMAND, &(struct br_column){.key = key, .heading = label},
                 br_text(lines));
}

/* ---- tables ---- */

/* The table that is being filled; NULL after a failure. */
static struct br_document_table *open_table(struct br_document *d)
{
    if (d->failure.status)
        return NULL;
    if (d->blocks && d->block[d->blocks - 1].kind == BR_BLOCK_TABLE)
        return d->block[d->blocks - 1].table;
    refuse(d, "a cell outside of a table, after", d->blocks ? d->block[d->blocks - 1].text : NULL);
    return NULL;
}

void br_put_table(struct br_document *d, const char *key, const char *title, unsigned flags)
{
    struct br_document_table *t = take(d, sizeof *t);
    struct br_block *block = put_block(d, BR_BLOCK_TABLE);
    if (!t || !block)
        return;
    block->table = t;
    t->key = copied(d, key);
    t->title = copied(d, title);
    t->flags = flags;
}

static const char *key_of(const struct br_column *column)
{
    return column->key ? column->key : column->heading ? column->heading : "";
}

/* The column of a key; the search begins at column `next`. t->columns: there is none. */
static size_t find_column(const struct br_document_table *t, const char *key, size_t next)
{
    for (size_t i = 0; i < t->columns; i++) {
        const size_t at = (next + i) % t->columns;
        if (strcmp(t->column[at].key, key) == 0)
            return at;
    }
    return t->columns;
}

static void add_column(struct br_document *d, struct br_document_table *t,
                       const struct br_column *column)
{
    const struct br_column copy =
        copied_column(d, column, br_for_programs(t->flags | column->flags));
    t->column = grown(d, t->column, t->columns, &t->column_room, sizeof *t->column);
    if (t->rows)
        t->row->cell = grown(d, t->row->cell, t->columns, &t->cell_room, sizeof *t->row->cell);
    if (!d->failure.status)
        t->column[t->columns++] = copy;
}

void br_put_row(struct br_document *d)
{
    ask(d);
    struct br_document_table *t = open_table(d);
    if (!t)
        return;
    t->row = grown(d, t->row, t->rows, &t->row_room, sizeof *t->row);
    t->cell_room = t->columns + !t->columns; /* of the first row, which gets more columns */
    struct br_document_cell *cell = take(d, t->cell_room * sizeof *cell);
    if (!t->row || !cell)
        return;
    t->row[t->rows++] = (struct br_document_row){.cell = cell};
    d->last = NULL;
    d->open = NULL;
    d->next = 0;
    d->blank = false;
}

void br_put_no_row(struct br_document *d)
{
    struct br_document_table *t = open_table(d);
    for (size_t c = 0; t && c < t->columns; c++)
        t->column[c].flags &= ~(unsigned)(BR_FILLED | BR_TEXTUAL | BR_UNLIKE);
    if (t)
        t->rows -= t->rows > 0;
}

/* The index of the column of a key, which the first row makes. t->columns: there is none. */
static size_t column_of(struct br_document *d, struct br_document_table *t,
                        const struct br_column *column)
{
    const size_t at = find_column(t, key_of(column), d->next);
    if (at >= t->columns && t->rows == 1)
        add_column(d, t, column);
    if (at >= t->columns || !t->rows)
        refuse(d, "no cell for", key_of(column));
    return at;
}

/* Of texts and counts; numbers are taken to differ. */
static bool is_same(const struct br_value *a, const struct br_value *b)
{
    if (a->kind != b->kind || a->kind == BR_NUMBER || a->kind == BR_TRUTH)
        return false;
    return a->kind == BR_TEXT ? strcmp(a->text, b->text) == 0 : a->count == b->count;
}

void br_put_cell(struct br_document *d, const struct br_column *column, struct br_value value)
{
    struct br_document_table *t = open_table(d);
    const size_t at = t ? column_of(d, t, column) : 0;
    const struct br_value copy = d->blank ? br_nothing() : copied_value(d, value);
    if (d->failure.status)
        return;
    d->last = &t->row[t->rows - 1].cell[at];
    if (d->last->value.kind != BR_NOTHING)
        refuse(d, "two values in a row for", t->column[at].key);
    d->last->value = copy;
    d->next = at + 1;
    if (copy.kind != BR_NOTHING && !(copy.kind == BR_TEXT && !*copy.text))
        t->column[at].flags |= BR_FILLED;
    if (!is_same(&copy, &t->row[0].cell[at].value))
        t->column[at].flags |= BR_UNLIKE;
    if (copy.kind == BR_TEXT || copy.kind == BR_TRUTH)
        t->column[at].flags |= BR_TEXTUAL;
}

void br_hide(struct br_document *d, const char *key, const char *unit, struct br_value value)
{
    BR_PUT(d, value, .key = key, .unit = unit, .flags = BR_FOR_PROGRAMS);
}

void br_put_across(struct br_document *d)
{
    struct br_document_table *t = open_table(d);
    char text[BR_SHOWN];
    if (!t || t->rows == 0 || t->columns < BR_ACROSS * t->rows)
        return;
    br_put_table(d, "", t->title, BR_FOR_PEOPLE | t->flags);
    for (size_t c = 1; c < t->columns && !d->failure.status; c++) {
        const struct br_column *of = &t->column[c];
        if (!br_document_is_shown(t, c))
            continue;
        br_put_row(d);
        BR_PUT(d,
               br_text(br_format(d, "%s%s%s", of->heading, of->unit ? ", " : "",
                                 of->unit ? of->unit : "")),
               .key = "", .heading = t->column->heading);
        for (size_t r = 0; r < t->rows; r++) {
            const struct br_document_cell *head = t->row[r].cell, *cell = &head[c];
            BR_PUT(d, cell->value, .key = br_format(d, "%zu", r),
                   .heading = br_document_shown(t->column, head, text));
            br_put_shown(d, "%s", br_document_shown(of, cell, text));
        }
    }
    t->flags |= BR_FOR_PROGRAMS;
}

void br_put_blank(struct br_document *d, bool blank)
{
    d->blank = blank;
}

void br_put_shown_text(struct br_document *d, const char *text)
{
    if (!d->last)
        refuse(d, "there is no value that is shown as", text);
    if (d->failure.status || (d->blank && d->last->value.kind == BR_NOTHING))
        return;
    d->last->shown = text;
    if (d->block[d->blocks - 1].kind == BR_BLOCK_TABLE)
        open_table(d)->column[d->next - 1].flags |= BR_FILLED;
}

void br_put_mark(struct br_document *d, const char *mark)
{
    if (!d->last)
        refuse(d, "there is no value before the mark", mark);
    if (!d->failure.status)
        d->last->mark = mark && *mark ? copied(d, mark) : NULL;
}

/* ---- verdicts and the rest ---- */

void br_put_verdict(struct br_document *d, const struct br_document_verdict *verdict)
{
    struct br_document_verdict v = *verdict;
    const struct br_document_table *t = v.of_row ? open_table(d) : NULL;
    v.group = copied(d, v.group);
    v.name = copied(d, v.name);
    v.message = v.message && *v.message ? copied(d, v.message) : NULL;
    v.file = copied(d, v.file);
    v.detail = NULL;
    v.details = v.room = 0;
    if (t && !t->rows)
        refuse(d, "no row for the verdict", v.name);
    d->verdict = grown(d, d->verdict, d->verdicts, &d->verdict_room, sizeof *d->verdict);
    if (!d->verdict)
        return;
    v.table = t ? d->blocks - 1 : 0;
    v.row = t ? t->rows - 1 : 0;
    d->verdict[d->verdicts++] = v;
}

void br_put_verdict_detail_text(struct br_document *d, const char *text)
{
    if (!d->verdicts)
        refuse(d, "there is no verdict before", text);
    if (d->failure.status)
        return;
    struct br_document_verdict *v = &d->verdict[d->verdicts - 1];
    v->detail = grown(d, v->detail, v->details, &v->room, sizeof *v->detail);
    if (v->detail)
        v->detail[v->details++] = text;
}

void br_put_picture(struct br_document *d, const char *stem, const char *caption)
{
    const char *stem_copy = copied(d, stem), *caption_copy = copied(d, caption);
    struct br_block *block = put_block(d, BR_BLOCK_PICTURE);
    if (!block)
        return;
    block->what.key = stem_copy;
    block->text = caption_copy;
}

const struct br_provenance_text br_provenance_texts[] = {
    {"version", offsetof(struct br_provenance, version)},
    {"commit", offsetof(struct br_provenance, commit)},
    {"compiler", offsetof(struct br_provenance, compiler)},
    {"flags", offsetof(struct br_provenance, flags)},
    {"command_line", offsetof(struct br_provenance, command_line)},
    {"machine", offsetof(struct br_provenance, machine)},
    {"date", offsetof(struct br_provenance, date)},
    {"scene_path", offsetof(struct br_provenance, scene_path)},
    {"scene_text", offsetof(struct br_provenance, scene_text)},
    {NULL, 0},
};

void br_put_provenance(struct br_document *d, const struct br_provenance *p)
{
    d->provenance.threads = p->threads;
    for (const struct br_provenance_text *t = br_provenance_texts; t->key; t++)
        *(const char **)((char *)&d->provenance + t->at) =
            copied(d, *(const char *const *)((const char *)p + t->at));
}

/* ---- printing ---- */

enum br_status br_document_status(const struct br_document *d, struct br_error *err)
{
    if (d->failure.status)
        return br_fail(err, d->failure.status, "%s", d->failure.message);
    return br_must_stop() ? br_fail(err, BR_INTERRUPTED, "interrupted") : BR_OK;
}

enum br_status br_document_print(FILE *out, const struct br_document_format *format,
                                 const struct br_document *d, const struct br_document_table *table,
                                 struct br_error *err)
{
    struct br_markup_page page = {.out = out, .markup = format->markup, .d = d, .err = err};
    const enum br_status status = br_document_status(d, err);
    if (status)
        return status;
    return format->markup ? br_markup_print(&page) : format->write(out, d, table, err);
}

const struct br_document_table *br_document_next_table(const struct br_document *d, size_t *block)
{
    while (!d->failure.status && *block < d->blocks) {
        const struct br_block *b = &d->block[(*block)++];
        if (b->kind == BR_BLOCK_TABLE && br_for_programs(b->table->flags) && b->table->rows)
            return b->table;
    }
    return NULL;
}

const char *br_document_shown(const struct br_column *column, const struct br_document_cell *cell,
                              char buffer[BR_SHOWN])
{
    if (cell->shown)
        return cell->shown;
    switch (cell->value.kind) {
    case BR_NUMBER:
        snprintf(buffer, BR_SHOWN, column->format, cell->value.number);
        return without_signs_of_zero(buffer);
    case BR_COUNT:
        snprintf(buffer, BR_SHOWN, "%lld", cell->value.count);
        return buffer;
    case BR_TRUTH:
        return cell->value.truth ? "yes" : "no";
    case BR_TEXT:
        return cell->value.text;
    default:
        return "-";
    }
}

void br_document_print_value(FILE *out, const struct br_quoting *target, const char *nothing,
                             const struct br_value *value)
{
    switch (value->kind) {
    case BR_NUMBER:
        fprintf(out, "%.17g", value->number);
        break;
    case BR_COUNT:
        fprintf(out, "%lld", value->count);
        break;
    case BR_TRUTH:
        fputs(value->truth ? "true" : "false", out);
        break;
    case BR_TEXT:
        br_quote(out, target, value->text);
        break;
    case BR_NOTHING:
        fputs(nothing, out);
        break;
    }
}
