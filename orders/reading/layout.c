/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The layout of a table, by measure. Each way to separate fields, with each mark of decimals,
 * splits the lines; the one whose rows of the commonest width have most numbers, and fewest words,
 * is taken. The rows are the lines of this width whose numbers stand in the columns of numbers. The
 * heading is the line above them, or the comment there. All else is named in fields->left, or
 * refused: what stands between rows, or has numbers that are no row, may be a second table. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/words.h"
#include "orders/reading/layout.h"

/* ---- the way to separate fields ---- */

/* Splits a line into l->token. Empty tokens behind the width are none. */
struct row br_layout_look_at(struct layout *l, size_t line, char *room)
{
    struct row r = {.token = l->token};
    r.count = br_line_split(l->line[line].text, l->by, l->fields->mark, room, l->token);
    while (l->width && r.count > l->width && l->token[r.count - 1].content == BR_NOTHING)
        r.count--;
    for (size_t i = 0; i < r.count; i++) {
        r.numbers += l->token[i].content == BR_NUMBER;
        r.words += l->token[i].content >= BR_WORD;
    }
    return r;
}

/* How well this way explains the lines; l->width (out): the commonest. A number counts three, and a
 * word costs one; sentences count a third of it, if their names differ. Each line counts with and
 * without its empty tokens at the end; a heading decides between the two. */
static long measure(struct layout *l)
{
    memset(l->gain, 0, sizeof l->gain);
    memset(l->names, 0, sizeof l->names);
    l->width = 0;
    for (size_t i = 0; i < l->lines; i++) {
        if (i == SAMPLE && l->lines > 2 * SAMPLE)
            i = l->lines - SAMPLE;
        if (l->line[i].kind != BR_LINE_TEXT)
            continue;
        const struct row r = br_layout_look_at(l, i, l->room);
        const bool is_lone = l->by == BR_BY_WORDS && r.count < 2;
        const long more = r.numbers && !is_lone ? 3 * (long)r.numbers - (long)r.words : 0;
        size_t filled = r.count;
        while (filled > 1 && l->token[filled - 1].content == BR_NOTHING)
            filled--;
        l->gain[r.count] += more;
        l->gain[filled] += filled < r.count ? more : 0;
        l->names[r.count] += !r.numbers;
    }
    size_t best = 1;
    for (size_t i = 1; i < WIDEST; i++)
        best = l->gain[i] > l->gain[best] ||
                       (l->gain[i] == l->gain[best] && l->names[i] > l->names[best])
                   ? i
                   : best;
    l->width = best;
    return l->gain[best];
}

/* Whether all rows, by words, have the names of the first one: "dt 0.25  error 0.078". */
static bool have_names(struct layout *l)
{
    const struct br_token *first = NULL;
    size_t rows = 0;
    for (size_t i = 0; i < l->lines; i++) {
        char *room =
            first ? l->room : br_store_take(&l->fields->store, BR_ROOM(l->line[i].text), 1);
        if (l->line[i].kind != BR_LINE_TEXT || !room ||
            br_layout_look_at(l, i, room).count != l->width)
            continue;
        for (size_t c = 0; c < l->width && first; c++)
            if (strcmp(first[c].name, l->token[c].name) != 0)
                return false;
        struct br_token *const copy =
            first ? NULL : br_store_take(&l->fields->store, l->width, sizeof *copy);
        if (copy)
            first = memcpy(copy, l->token, l->width * sizeof *copy);
        rows++;
    }
    return l->width > 1 && rows > 1;
}

/* Chooses the way. Where none has numbers, the first line tells the widest. Refuses lines that are
 * too wide, before anything takes time. */
static enum br_status choose(struct layout *l, size_t first)
{
    long most = 0;
    size_t widest = 0, width = 0;
    int best = 0;
    for (int i = 2 * BR_BY_WORDS; i < 2 * BR_SEPARATORS; i++) {
        l->by = (enum br_separator)(i / 2);
        l->fields->mark = ".,"[i % 2];
        const long all = measure(l), score = l->by > BR_BY_WORDS || have_names(l) ? all : all / 3;
        if (score > most && (i % 2 == 0 || l->width > 1)) {
            most = score;
            best = i;
            width = l->width;
        }
        const size_t count = l->by < BR_BY_TABS ? 0 : br_layout_look_at(l, first, l->room).count;
        widest = count > widest ? count : widest;
    }
    l->by = (enum br_separator)(best / 2);
    l->fields->mark = ".,"[best % 2];
    l->width = l->fields->columns = width;
    const bool wide = width > BR_MOST_COLUMNS || (!width && widest > BR_MOST_COLUMNS);
    return width && !wide
               ? BR_OK
               : br_fail(l->err, BR_BAD_INPUT, "%s:%zu: found %s", l->path, l->line[first].number,
                         wide ? "more than 1000 columns, expected fewer" : "no row of numbers");
}

enum br_status br_layout_count_row(struct layout *l, size_t line)
{
    if (++l->rows > BR_MOST_TABLE_ROWS)
        return br_fail(l->err, BR_BAD_INPUT, "%s:%zu: found row %zu, expected at most %d", l->path,
                       l->line[line].number, l->rows, BR_MOST_TABLE_ROWS);
    if (l->rows * l->width > BR_MOST_FIELDS)
        return br_fail(l->err, BR_BAD_INPUT,
                       "%s:%zu: found row %zu of %zu fields, expected at most %d fields in all",
                       l->path, l->line[line].number, l->rows, l->width, BR_MOST_FIELDS);
    return BR_OK;
}

/* Splits all lines, and counts the numbers of columns. */
static enum br_status split_lines(struct layout *l)
{
    struct br_store *store = &l->fields->store;
    for (size_t i = 0; i < l->lines; i++) {
        if (l->line[i].kind != BR_LINE_TEXT)
            continue;
        if (br_observer_check(l->observer, l->err))
            return l->err->status;
        char *room = br_store_take(store, BR_ROOM(l->line[i].text), 1);
        if (!room)
            return br_no_memory(l->err, "the table");
        struct row *r = &l->row[i];
        *r = br_layout_look_at(l, i, room);
        r->token = br_store_take(store, r->count + 1, sizeof *r->token);
        if (!r->token)
            return br_no_memory(l->err, "the table");
        memcpy(r->token, l->token, r->count * sizeof *r->token);
        if (r->count != l->width || !r->numbers)
            continue;
        if (br_layout_count_row(l, i))
            return l->err->status;
        for (size_t c = 0; c < l->width; c++)
            l->has_number[c] +=
                r->token[c].content == BR_NUMBER || r->token[c].content == BR_MISSING;
    }
    return BR_OK;
}

/* ---- fields ---- */

/* The column of each token of a row that has fewer than columns: the gaps are in columns of rates,
 * by their names, or behind the first row of a table without names; false: they are not known. */
static bool place_tokens(const struct layout *l, size_t line, size_t *column)
{
    const size_t count = l->row[line].count;
    size_t rates = 0, used = 0;
    for (size_t i = 0; i < l->width; i++)
        rates += l->skipped[i] || br_layout_is_rate(l->fields->heading[i]);
    const bool behind = count == l->width || (line == l->first && !l->fields->heading_line) ||
                        (line == l->first && l->by < BR_BY_WIDE_BLANKS);
    if (!behind && count + rates != l->width)
        return false;
    for (size_t i = 0; i < l->width && used < count; i++)
        if (behind || !(l->skipped[i] || br_layout_is_rate(l->fields->heading[i])))
            column[used++] = i;
    return true;
}

static enum br_status take_row(struct layout *l, size_t line, size_t *column)
{
    struct br_fields *f = l->fields;
    const size_t row = f->rows++;
    l->row[line].is_used = true;
    if (!place_tokens(l, line, column))
        return br_layout_refuse_row(l, line, f->heading_line ? "heading" : "first row");
    f->line[row] = l->line[line].number;
    for (size_t i = 0; i < l->row[line].count; i++) {
        const struct br_token *token = &l->row[line].token[i];
        const char *const name = f->heading[column[i]];
        if (token->name && strcmp(token->name, name) != 0)
            return br_fail(l->err, BR_BAD_INPUT, "%s:%zu: found '%s=%s', expected '%s = ...'",
                           l->path, f->line[row], token->name, token->text, name);
        if (token->content == BR_BROKEN)
            return br_fail(l->err, BR_BAD_INPUT, "%s:%zu: found text behind a quote in its field",
                           l->path, f->line[row]);
        f->field[row * f->columns + column[i]] = *token->text ? token->text : NULL;
    }
    return BR_OK;
}

/* Whether a column has fractions. */
static bool has_fractions(const struct br_fields *f, size_t column)
{
    bool fractions = false;
    for (size_t i = column; i < f->rows * f->columns && !fractions; i += f->columns)
        fractions = f->field[i] && strchr(f->field[i], f->mark);
    return fractions;
}

/* Refuses numbers whose sign before decimals is not the table's. The other sign may stand before
 * thousands: a point in counts only, a comma beside points. */
static enum br_status check_marks(const struct layout *l)
{
    const struct br_fields *f = l->fields;
    const char other = f->mark == '.' ? ',' : '.';
    size_t doubt = 0;
    bool points = f->mark == ',';
    for (size_t i = 0; i < f->rows * f->columns; i++) {
        const char *const text = f->field[i] ? f->field[i] : "";
        struct br_field_number number;
        const size_t line = f->line[i / f->columns], digits = strspn(text, "+-0123456789.");
        points |= memchr(text, '.', digits) != NULL;
        if (!strchr(text, other) || strspn(text, "+-0123456789.,eE") < strlen(text))
            continue;
        const bool reads = br_field_read(text, f->mark, &number);
        if (reads ? f->mark == ',' && has_fractions(f, i % f->columns)
                  : br_field_read(text, other, &number) || strchr(text, f->mark))
            return br_fail(l->err, BR_BAD_INPUT,
                           "%s:%zu: found '%.40s' beside numbers with '%c': use one decimal mark "
                           "in the whole table, and no thousands separators",
                           l->path, line, text, f->mark);
        doubt = doubt || !reads || strlen(strchr(text, other)) != 4 ? doubt : line;
    }
    return !doubt || points
               ? BR_OK
               : br_fail(l->err, BR_BAD_INPUT,
                         "%s:%zu: each comma stands before three digits: remove thousands "
                         "separators, or write decimals with a point",
                         l->path, doubt);
}

static bool is_empty(const struct br_fields *f, size_t column)
{
    bool empty = !f->heading[column];
    for (size_t i = 0; i < f->rows && empty; i++)
        empty = !f->field[i * f->columns + column];
    return empty;
}

/* Drops empty columns at the sides; refuses one between two tables. */
static enum br_status trim_columns(const struct layout *l)
{
    struct br_fields *f = l->fields;
    size_t from = 0, to = f->columns;
    while (from < to && is_empty(f, from))
        from++;
    while (to > from && is_empty(f, to - 1))
        to--;
    for (size_t i = from; i < to; i++)
        if (is_empty(f, i))
            return br_fail(l->err, BR_BAD_INPUT,
                           "%s:%zu: found an empty column %zu between others, expected one table",
                           l->path, f->heading_line ? f->heading_line : f->line[0], i + 1);
    const size_t columns = f->columns;
    f->columns = to - from;
    memmove(f->heading, f->heading + from, f->columns * sizeof *f->heading);
    for (size_t i = 0; i < f->rows && f->columns < columns; i++)
        memmove(f->field + i * f->columns, f->field + i * columns + from,
                f->columns * sizeof *f->field);
    return BR_OK;
}

static enum br_status take_fields(struct layout *l)
{
    struct br_fields *f = l->fields;
    size_t rows = 0;
    for (size_t i = l->first; i <= l->last; i++)
        rows += br_layout_is_row(l, i);
    size_t *column = br_store_take(&f->store, l->width, sizeof *column);
    f->field = br_store_take(&f->store, rows * l->width, sizeof *f->field);
    f->line = br_store_take(&f->store, rows, sizeof *f->line);
    f->is_words = br_store_take(&f->store, l->width, sizeof *f->is_words);
    if (f->store.failed)
        return br_no_memory(l->err, "the table");
    for (size_t i = 0; i < l->width; i++)
        column[i] = i;
    for (size_t i = l->first; i <= l->last; i++)
        if (br_layout_is_row(l, i) && take_row(l, i, column))
            return l->err->status;
    return check_marks(l) || trim_columns(l) ? l->err->status : BR_OK;
}

/* Whether numbers behind a name halve, or double. */
static bool halves(const struct br_fields *f, const char *const *field)
{
    double last = NAN;
    for (size_t j = 1; j < f->columns; j++) {
        struct br_field_number number;
        if (!field[j] || !br_field_read(field[j], f->mark, &number) ||
            (j > 1 && !(number.value == 2 * last || last == 2 * number.value)))
            return false;
        last = number.value;
    }
    return true;
}

/* Whether the rows are the sizes and the errors: "h,1/2,1/4,1/8", numbers behind names. "h" may
 * also be a method, beside "p" and "hp", or a case of several rows: so another row is called an
 * error, or the first one has sizes that halve. */
static bool is_turned(const struct br_fields *f)
{
    bool has_size = false, has_error = false;
    for (size_t i = 0; i < f->rows; i++) {
        const char *const *field = &f->field[i * f->columns];
        struct br_field_number number;
        for (size_t j = 0; j < f->columns; j++)
            if ((j == 0) != (field[j] && !br_field_is_missing(field[j]) &&
                             !br_field_read(field[j], f->mark, &number)))
                return false;
        const bool is_size = br_size_name_odds(field[0]) > BR_ANY_NAME;
        for (size_t k = 0; k < i && is_size; k++)
            if (strcmp(f->field[k * f->columns], field[0]) == 0)
                return false;
        has_size |= is_size;
        has_error |= br_kind_of(field[0]) == BR_KIND_ERROR;
    }
    return has_size &&
           (has_error || (br_size_name_odds(f->field[0]) > BR_ANY_NAME && halves(f, f->field)));
}

static enum br_status turn(const struct layout *l)
{
    enum { LEAST_SIZES = 3 };
    struct br_fields *f = l->fields;
    const size_t rows = f->columns ? f->columns - 1 : 0, columns = f->rows;
    if (f->heading_line || rows < LEAST_SIZES || columns > BR_MOST_COLUMNS || !is_turned(f))
        return BR_OK;
    const char **turned = br_store_take(&f->store, rows * columns, sizeof *turned);
    size_t *line = br_store_take(&f->store, rows, sizeof *line);
    f->is_words = br_store_take(&f->store, columns, sizeof *f->is_words);
    if (f->store.failed)
        return br_no_memory(l->err, "the table");
    for (size_t i = 0; i < columns; i++)
        f->heading[i] = f->field[i * f->columns];
    for (size_t i = 0; i < rows * columns; i++)
        turned[i] = f->field[i % columns * f->columns + i / columns + 1];
    for (size_t i = 0; i < rows; i++)
        line[i] = f->line[0];
    f->heading_line = f->line[0];
    f->field = turned;
    f->line = line;
    f->rows = rows;
    f->columns = columns;
    return BR_OK;
}

static enum br_status lay_out(struct layout *l)
{
    struct br_store *store = &l->fields->store;
    size_t first = l->lines, longest = 0;
    for (size_t i = l->lines; i-- > 0;)
        if (l->line[i].kind != BR_LINE_EMPTY) {
            const size_t size = BR_ROOM(l->line[i].text);
            longest = size > longest ? size : longest;
            first = l->line[i].kind == BR_LINE_TEXT ? i : first;
        }
    if (first == l->lines)
        return br_fail(l->err, BR_BAD_INPUT, "%s:1: the table is empty", l->path);
    l->row = br_store_take(store, l->lines + 1, sizeof *l->row);
    l->room = br_store_take(store, longest, 1);
    l->fields->left = br_store_take(store, l->lines, sizeof *l->fields->left);
    l->fields->heading = br_store_take(store, WIDEST, sizeof *l->fields->heading);
    if (store->failed)
        return br_no_memory(l->err, "the table");
    if (choose(l, first) || split_lines(l) || br_layout_find_kinds(l) || take_fields(l) || turn(l))
        return l->err->status;
    br_layout_leave_lines(l);
    return BR_OK;
}

enum br_status br_fields_read(const char *text, const char *path,
                              const struct br_observer *observer, struct br_fields *fields,
                              struct br_error *err)
{
    *fields = (struct br_fields){.mark = '.'};
    err->status = BR_OK;
    const char *lists = NULL;
    if (!br_json_is_table(text) && br_lists_find(text, path, fields, &lists, err))
        return err->status;
    if (lists || br_json_is_table(text))
        return br_json_fields(lists ? lists : text, path, fields, err);
    struct layout *l = br_store_take(&fields->store, 1, sizeof *l);
    char *copy = br_store_copy(&fields->store, text);
    if (!l || !copy)
        return br_no_memory(err, "the table");
    *l = (struct layout){.path = path, .observer = observer, .err = err, .fields = fields};
    return br_markup_flatten(&copy, &fields->store, err) ||
                   br_lines_cut(copy, path, &fields->store, &l->line, &l->lines, err) ||
                   br_log_fold(l->line, l->lines, &fields->store, err)
               ? err->status
               : lay_out(l);
}

void br_fields_leave(struct br_fields *fields, size_t line, const char *text, const char *why)
{
    struct br_left_line *const left = br_store_grow(&fields->store, fields->left, fields->lefts,
                                                    &fields->left_room, sizeof *left);
    if (!left)
        return;
    left[fields->lefts++] = (struct br_left_line){line, text, why};
    fields->left = left;
}

void br_fields_clear(struct br_fields *fields)
{
    br_store_clear(&fields->store);
    *fields = (struct br_fields){0};
}
