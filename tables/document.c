/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/document.h"

#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>

#include "study/scene/quote.h"

const char *const br_outcome_names[] = {"PASS", "FAIL", "INCONCLUSIVE", "ERROR", "SKIPPED"};

const struct br_document_format *const br_document_formats[] = {&br_document_text,
                                                                &br_document_csv,
                                                                &br_document_markdown,
                                                                &br_document_latex,
                                                                &br_document_json,
                                                                &br_document_html,
                                                                NULL};

const struct br_document_format *br_document_format_find(const char *name)
{
    for (const struct br_document_format *const *f = br_document_formats; *f; f++)
        if (strcmp((*f)->name, name) == 0)
            return *f;
    return NULL;
}

/* ---- memory: pieces that are released together ---- */

enum { PIECE = 1 << 14, ALIGNED = 16 };

struct br_document_memory {
    struct br_document_memory *next;
    size_t used, size;
    _Alignas(ALIGNED) char bytes[];
};

/* Zeros; NULL after any failure. */
static void *take(struct br_document *d, size_t size)
{
    struct br_document_memory *m = d->memory;
    size = (size + ALIGNED - 1) / ALIGNED * ALIGNED;
    if (d->failure.status)
        return NULL;
    if (!m || m->size - m->used < size) {
        const size_t room = size > PIECE ? size : PIECE;
        m = br_allocate(1, sizeof *m + room);
        if (!m) {
            br_no_memory(&d->failure, "a report");
            return NULL;
        }
        m->next = d->memory;
        m->size = room;
        d->memory = m;
    }
    m->used += size;
    return m->bytes + m->used - size;
}

/* The list with room for one more than `count`; NULL after a failure. */
static void *grown(struct br_document *d, void *list, size_t count, size_t *room, size_t size)
{
    if (count < *room)
        return d->failure.status ? NULL : list;
    const size_t wanted = *room ? 2 * *room : 8;
    void *larger = take(d, wanted * size);
    if (!larger)
        return NULL;
    if (count)
        memcpy(larger, list, count * size);
    *room = wanted;
    return larger;
}

static const char *copied(struct br_document *d, const char *text)
{
    const size_t length = text ? strlen(text) : 0;
    char *copy = text ? take(d, length + 1) : NULL;
    if (!copy)
        return NULL;
    d->longest = length > d->longest ? length : d->longest;
    return memcpy(copy, text, length + 1);
}

static const char *formatted(struct br_document *d, const char *format, va_list arguments)
{
    va_list again;
    va_copy(again, arguments);
    const int length = vsnprintf(NULL, 0, format, again);
    va_end(again);
    char *text = length < 0 ? NULL : take(d, (size_t)length + 1);
    if (!text)
        return NULL;
    vsnprintf(text, (size_t)length + 1, format, arguments);
    d->longest = (size_t)length > d->longest ? (size_t)length : d->longest;
    return text;
}

void br_document_clear(struct br_document *d)
{
    for (struct br_document_memory *m = d->memory, *next; m; m = next) {
        next = m->next;
        free(m);
    }
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

/* A report that is built wrongly is not printed. */
static void refuse(struct br_document *d, const char *what, const char *key)
{
    if (!d->failure.status)
        br_fail(&d->failure, BR_IO, "the report %.100s was built wrongly: %s '%.100s'",
                d->name ? d->name : "", what, key ? key : "");
}

/* NULL after a failure. */
static struct br_block *put_block(struct br_document *d, enum br_block_kind kind)
{
    d->block = grown(d, d->block, d->blocks, &d->block_room, sizeof *d->block);
    if (!d->block)
        return NULL;
    d->last = NULL;
    d->block[d->blocks] = (struct br_block){.kind = kind};
    return &d->block[d->blocks++];
}

static void put_paragraph(struct br_document *d, enum br_block_kind kind, const char *text)
{
    struct br_block *block = put_block(d, kind);
    if (block)
        block->text = text;
}

void br_put_answer(struct br_document *d, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const char *text = formatted(d, format, arguments);
    va_end(arguments);
    if (text && d->answers < BR_MOST_ANSWERS)
        d->answer[d->answers++] = text;
    else if (text)
        put_paragraph(d, BR_BLOCK_NOTE, text);
}

void br_put_section(struct br_document *d, const char *title)
{
    put_paragraph(d, BR_BLOCK_SECTION, copied(d, title));
}

void br_put_note(struct br_document *d, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    put_paragraph(d, BR_BLOCK_NOTE, formatted(d, format, arguments));
    va_end(arguments);
}

/* Whether printf may be called with it and one double. */
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
    if (for_programs && (!*key || strpbrk(key, " ,\"\n")))
        refuse(d, "no key for programs:", key);
    if (c->format && !is_number_format(c->format))
        refuse(d, "no format of a number:", c->format);
    return (struct br_column){.key = copied(d, key),
                              .heading = copied(d, c->heading ? c->heading : c->key),
                              .unit = copied(d, c->unit && *c->unit ? c->unit : NULL),
                              .format = copied(d, c->format ? c->format : "%.6g"),
                              .flags = c->flags};
}

static struct br_value copied_value(struct br_document *d, struct br_value value)
{
    if (value.kind == BR_TEXT)
        return br_text(copied(d, value.text));
    return value.kind == BR_NUMBER && !isfinite(value.number) ? br_nothing() : value;
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
}

void br_put_fact(struct br_document *d, const struct br_column *what, struct br_value value)
{
    put_what(d, BR_BLOCK_FACT, what, value);
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

void br_put_table(struct br_document *d, const char *key, const char *title, unsigned flags,
                  const struct br_column *columns, size_t count)
{
    struct br_document_table *t = take(d, sizeof *t);
    struct br_block *block = put_block(d, BR_BLOCK_TABLE);
    if (!t || !block)
        return;
    block->table = t;
    t->key = copied(d, key);
    t->title = copied(d, title);
    t->flags = flags;
    for (size_t i = 0; i < count; i++)
        br_put_column(d, &columns[i]);
}

void br_put_column(struct br_document *d, const struct br_column *column)
{
    struct br_document_table *t = open_table(d);
    if (t && t->rows)
        refuse(d, "a column after the first row:", column->key ? column->key : column->heading);
    if (!t || d->failure.status)
        return;
    const struct br_column copy =
        copied_column(d, column, br_for_programs(t->flags | column->flags));
    t->column = grown(d, t->column, t->columns, &t->column_room, sizeof *t->column);
    for (size_t i = 0; i < t->columns && t->column; i++)
        if (strcmp(t->column[i].key, copy.key) == 0)
            refuse(d, "two columns with the key", copy.key);
    if (!d->failure.status)
        t->column[t->columns++] = copy;
}

void br_put_row(struct br_document *d)
{
    struct br_document_table *t = open_table(d);
    if (!t)
        return;
    size_t room = t->row_room;
    t->cell = grown(d, t->cell, t->rows, &room, t->columns * sizeof *t->cell);
    t->rule = grown(d, t->rule, t->rows, &t->row_room, sizeof *t->rule);
    if (!t->cell || !t->rule)
        return;
    t->rows++;
    d->last = NULL;
    d->next = 0;
}

void br_put_rule(struct br_document *d)
{
    struct br_document_table *t = open_table(d);
    if (t && t->rows)
        t->rule[t->rows - 1] = true;
}

/* The column of a key, from the next one on and around; t->columns: none. */
static size_t find_column(const struct br_document_table *t, const char *key, size_t next)
{
    if (!key)
        return next;
    for (size_t i = 0; i < t->columns; i++) {
        const size_t at = (next + i) % t->columns;
        if (strcmp(t->column[at].key, key) == 0)
            return at;
    }
    return t->columns;
}

static void put_copied(struct br_document *d, const char *key, struct br_value value)
{
    struct br_document_table *t = open_table(d);
    if (!t)
        return;
    const size_t column = find_column(t, key, d->next);
    if (column == t->columns || !t->rows) {
        refuse(d, "no cell for", key ? key : t->key);
        return;
    }
    d->last = &t->cell[(t->rows - 1) * t->columns + column];
    d->last->value = value;
    d->next = column + 1;
    if (value.kind != BR_NOTHING)
        t->column[column].flags |= BR_FILLED;
    if (value.kind == BR_TEXT || value.kind == BR_TRUTH)
        t->column[column].flags |= BR_TEXTUAL;
}

void br_put(struct br_document *d, const char *key, struct br_value value)
{
    put_copied(d, key, copied_value(d, value));
}

void br_put_text(struct br_document *d, const char *key, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    put_copied(d, key, br_text(formatted(d, format, arguments)));
    va_end(arguments);
}

void br_put_shown(struct br_document *d, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const char *text = formatted(d, format, arguments);
    va_end(arguments);
    if (!d->last)
        refuse(d, "there is no value that is shown as", text);
    if (d->failure.status)
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

void br_put_verdict_detail(struct br_document *d, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const char *text = formatted(d, format, arguments);
    va_end(arguments);
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

void br_put_provenance(struct br_document *d, const struct br_provenance *p)
{
    d->provenance = (struct br_provenance){
        .version = copied(d, p->version),
        .commit = copied(d, p->commit),
        .compiler = copied(d, p->compiler),
        .flags = copied(d, p->flags),
        .command_line = copied(d, p->command_line),
        .machine = copied(d, p->machine),
        .date = copied(d, p->date),
        .threads = p->threads,
        .scene_path = copied(d, p->scene_path),
        .scene_text = copied(d, p->scene_text),
    };
}

/* ---- printing ---- */

enum br_status br_document_status(const struct br_document *d, struct br_error *err)
{
    return d->failure.status ? br_fail(err, d->failure.status, "%s", d->failure.message) : BR_OK;
}

enum br_status br_document_print(FILE *out, const struct br_document_format *format,
                                 const struct br_document *d, const struct br_document_table *table,
                                 struct br_error *err)
{
    const enum br_status status = br_document_status(d, err);
    return status ? status : format->write(out, d, table, err);
}

const struct br_document_table *br_document_next_table(const struct br_document *d, size_t *block)
{
    while (!d->failure.status && *block < d->blocks) {
        const struct br_block *b = &d->block[(*block)++];
        if (b->kind == BR_BLOCK_TABLE && br_for_programs(b->table->flags))
            return b->table;
    }
    return NULL;
}

/* What rounds to zero has no sign. */
static const char *without_sign_of_zero(const char *text)
{
    return *text == '-' && !text[strcspn(text, "123456789")] ? text + 1 : text;
}

const char *br_document_shown(const struct br_column *column, const struct br_document_cell *cell,
                              char buffer[BR_SHOWN])
{
    if (cell->shown)
        return cell->shown;
    switch (cell->value.kind) {
    case BR_NUMBER:
        snprintf(buffer, BR_SHOWN, column->format, cell->value.number);
        return without_sign_of_zero(buffer);
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

const struct br_document_cell *br_document_cell_at(const struct br_document_table *table,
                                                   size_t row, size_t column)
{
    return &table->cell[row * table->columns + column];
}

bool br_document_is_seen(const struct br_document_table *table, size_t column)
{
    const unsigned flags = table->column[column].flags;
    return br_for_people(flags) && flags & BR_FILLED;
}

bool br_document_is_text(const struct br_document_table *table, size_t column)
{
    return table->column[column].flags & BR_TEXTUAL;
}

bool br_document_verdict_matters(const struct br_document_verdict *verdict)
{
    return verdict->outcome != BR_OUTCOME_PASS || verdict->message;
}
