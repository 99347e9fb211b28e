/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A table in JSON by one walk: each value has a path of keys and positions. The first position
 * tells its row, or else the first key that is a number; the keys behind it, or the one before it,
 * its column; those before that, its table. What has no row stands beside the table. */
#include <jansson.h>
#include <stdio.h>
#include <string.h>

#include "base/words.h"
#include "orders/reading/reading.h"
#include "orders/reading/roles.h"

enum { DEEPEST = 12, LONGEST = 400 };

struct source {
    const char *path;
    struct br_fields *fields;
    struct br_error *err;
    struct step {
        const char *key;
        size_t at;
        bool is_list;
    } step[DEEPEST];               /* to a value */
    json_t *tables;                /* names to objects, of names to arrays of values; owned */
    json_t *names, *index, *types; /* of columns, rows, and columns, as pandas has them; borrowed */
    bool has_records;              /* they may lack columns */
    bool failed;                   /* no memory */
};

static const char *skip_blanks(const char *text)
{
    text += strncmp(text, "\ufeff", 3) == 0 ? 3 : 0;
    return text + strspn(text, " \t\r\n");
}

bool br_json_is_table(const char *text)
{
    text = skip_blanks(text);
    const char *next = *text ? skip_blanks(text + 1) : text;
    return *next &&
           ((*text == '{' && strchr("\"}", *next)) || (*text == '[' && strchr("{[]", *next)));
}

/* ---- values ---- */

/* A copy of a value's text, with the fewest digits that give a number again; NULL: it is empty. */
static const char *text_of(struct source *s, const json_t *value)
{
    char text[40];
    const char *from = json_is_string(value) ? json_string_value(value)
                       : json_is_real(value)
                           ? br_shortest(json_real_value(value), text, sizeof text)
                       : json_is_true(value)           ? "true"
                       : json_is_false(value)          ? "false"
                       : json_is_null(value) || !value ? ""
                                                       : "[...]";
    return *from ? br_store_copy(&s->fields->store, from) : NULL;
}

static enum br_status refuse(const struct source *s, const char *why, const char *name)
{
    return br_fail(s->err, BR_BAD_INPUT,
                   "%s: found %s%.40s, expected one table: records, or columns of as many values "
                   "each",
                   s->path, why, name);
}

/* Names a value that stands beside the table. */
static void leave(struct source *s, const char *name, const json_t *value)
{
    struct br_fields *f = s->fields;
    char *text = json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT);
    const size_t size = strlen(name) + (text ? strlen(text) : 0) + 3;
    char *line = br_store_take(&f->store, size, 1);
    if (text && line) {
        snprintf(line, size, "%s: %s", name, text);
        br_fields_leave(f, 0, line, "beside the table");
    }
    s->failed |= !text || f->store.failed;
    free(text);
}

/* The keys of some steps, as a name. */
static void join(const struct source *s, size_t from, size_t to, char text[LONGEST])
{
    *text = '\0';
    for (size_t i = from; i < to; i++)
        br_append(text, LONGEST, "%s%s", *text ? " " : "", s->step[i].key);
}

/* An array or object with this name in an object. */
static json_t *member(struct source *s, json_t *object, const char *name, json_t *(*new_one)(void))
{
    if (!json_object_get(object, name))
        s->failed |= json_object_set_new(object, name, new_one()) != 0;
    return json_object_get(object, name);
}

/* Sets a value of a row, which may be set to the same. */
static void set(struct source *s, json_t *table, size_t row, const char *name, json_t *value)
{
    json_t *column = member(s, table, name, json_array);
    if (json_array_size(column) < row && !s->has_records)
        refuse(s, "rows of several lengths at ", name);
    while (!s->failed && json_array_size(column) < row)
        s->failed |= json_array_append_new(column, json_null()) != 0;
    if (json_array_size(column) == row)
        s->failed |= json_array_append(column, value) != 0;
    else if (!s->failed && !json_equal(json_array_get(column, row), value))
        refuse(s, *name ? "two values of a row of " : "columns with other rows", name);
}

static void take_value(struct source *s, json_t *value, size_t depth)
{
    char table_name[LONGEST], name[LONGEST];
    struct br_field_number number;
    size_t row = 0;
    while (row < depth && !s->step[row].is_list)
        row++;
    for (row = row < depth ? row : 0; row < depth && !s->step[row].is_list; row++)
        if (br_field_read(s->step[row].key, '.', &number))
            break;
    const bool is_column = row + 1 == depth;
    if (row == depth || depth < 2) {
        join(s, 0, depth, name);
        leave(s, name, value);
        return;
    }
    s->has_records |= !is_column && !s->step[row + 1].is_list;
    join(s, 0, row - is_column, table_name);
    join(s, is_column ? row - 1 : row + 1, is_column ? row : depth, name);
    json_t *const table = member(s, s->tables, table_name, json_object);
    json_t *const key = json_string(s->step[row].key);
    if (!s->step[row].is_list || s->index)
        set(s, table, s->step[row].at, "", key);
    json_decref(key);
    set(s, table, s->step[row].at, name, value);
}

/* Whether an array begins with an array of names. */
static bool has_names(const json_t *value)
{
    size_t i;
    json_t *name, *first = json_array_get(value, 0);
    bool names = json_array_size(first) > 0;
    bool numbers = true;
    struct br_field_number number;
    json_array_foreach(first, i, name)
    {
        names &= json_is_string(name);
        numbers &= names && br_field_read(json_string_value(name), '.', &number);
    }
    return names && !numbers;
}

static void visit(struct source *s, json_t *value, size_t depth)
{
    json_t *data = json_object_get(value, "data"), *names = json_object_get(value, "columns"),
           *types = json_object_get(json_object_get(value, "schema"), "fields"), *part;
    const char *key;
    size_t i;
    if (json_is_array(data) && (json_is_array(names) || types)) {
        s->names = names;
        s->index = json_object_get(value, "index");
        s->types = types;
        value = data;
    }
    const size_t from = has_names(value);
    s->names = from ? json_array_get(value, 0) : s->names;
    if (depth == DEEPEST || !(json_is_array(value) || json_is_object(value))) {
        take_value(s, value, depth);
        return;
    }
    const bool is_row = depth > 0 && s->step[depth - 1].is_list;
    const json_t *const list = is_row ? s->names : s->index;
    json_array_foreach(value, i, part)
    {
        char position[24];
        snprintf(position, sizeof position, "%zu", i + 1);
        if (i < from || s->err->status)
            continue;
        const char *const text = list ? text_of(s, json_array_get(list, i)) : position;
        s->step[depth] = (struct step){text ? text : "", i - from, true};
        visit(s, part, depth + 1);
    }
    i = 0;
    json_object_foreach (value, key, part) {
        s->step[depth] = (struct step){key, i++, false};
        visit(s, part, depth + 1);
    }
}

/* ---- the table ---- */

/* Removes an index that is 0, 1, 2 ... */
static void drop_count(struct source *s, json_t *table)
{
    size_t i;
    json_t *value;
    struct br_field_number number;
    bool counts = true;
    json_array_foreach(json_object_get(table, ""), i, value) counts &=
        json_is_string(value) && br_field_read(json_string_value(value), '.', &number) &&
        number.value == (double)i;
    if (counts)
        json_object_del(table, "");
    s->fields->columns = json_object_size(table);
}

/* The one table of several columns, or else the only one; names the others. NULL: refused. */
static json_t *choose(struct source *s)
{
    const char *name, *of;
    json_t *table, *column, *chosen = NULL;
    size_t tables = 0;
    json_object_foreach (s->tables, name, table)
        if (json_object_size(table) > 1 || json_object_size(s->tables) == 1) {
            chosen = table;
            tables++;
        } else
            leave(s, name, table);
    if (tables == 1)
        json_object_foreach (chosen, of, column)
            s->fields->rows = json_array_size(column) > s->fields->rows ? json_array_size(column)
                                                                        : s->fields->rows;
    if (tables != 1)
        refuse(s,
               json_object_size(s->tables) ? "several tables"
               : s->fields->lefts          ? "a single record"
                                           : "an empty table",
               "");
    else if (!s->has_records)
        json_object_foreach (chosen, of, column) {
            const enum br_kind kind = br_kind_of(of);
            if ((kind == BR_KIND_RATE || kind == BR_KIND_FACTOR) && /* from row to row */
                json_array_size(column) + 1 == s->fields->rows)
                s->failed |= json_array_insert_new(column, 0, json_null()) != 0;
            if (json_array_size(column) != s->fields->rows) {
                char why[60];
                snprintf(why, sizeof why, "%zu values, but %zu of ", s->fields->rows,
                         json_array_size(column));
                refuse(s, why, of);
            }
        }
    return s->err->status ? NULL : chosen;
}

/* Whether a schema says that a column has no numbers. */
static bool has_words(const struct source *s, const char *column)
{
    size_t i;
    json_t *field;
    bool words = false;
    json_array_foreach(s->types, i, field)
    {
        const char *type = NULL, *name = NULL;
        char word[24];
        json_unpack(field, "{s:s, s:s}", "name", &name, "type", &type);
        snprintf(word, sizeof word, " %.20s ", type ? type : "?");
        words |= name && strcmp(name, column) == 0 &&
                 strstr(" datetime duration string boolean any ", word);
    }
    return words;
}

static enum br_status take_fields(struct source *s)
{
    struct br_fields *f = s->fields;
    json_t *column, *value, *const table = choose(s);
    const char *name;
    size_t i, j = 0;
    if (!table)
        return s->err->status;
    drop_count(s, table);
    if (f->columns > BR_MOST_COLUMNS || f->rows > BR_MOST_TABLE_ROWS ||
        f->rows * f->columns > BR_MOST_FIELDS)
        return br_fail(
            s->err, BR_BAD_INPUT,
            "%s: found %zu rows of %zu fields, expected at most %d columns, %d rows and %d "
            "fields in all",
            s->path, f->rows, f->columns, BR_MOST_COLUMNS, BR_MOST_TABLE_ROWS, BR_MOST_FIELDS);
    f->heading = br_store_take(&f->store, f->columns, sizeof *f->heading);
    f->is_words = br_store_take(&f->store, f->columns, sizeof *f->is_words);
    f->field = br_store_take(&f->store, f->rows * f->columns, sizeof *f->field);
    f->line = br_store_take(&f->store, f->rows, sizeof *f->line);
    f->heading_line = 1;
    if (f->store.failed)
        return br_no_memory(s->err, "the table");
    json_object_foreach (table, name, column) {
        f->heading[j] = *name ? br_store_copy(&f->store, name) : NULL;
        f->is_words[j] = has_words(s, name);
        json_array_foreach(column, i, value) f->field[i * f->columns + j] = text_of(s, value);
        j++;
    }
    return f->store.failed ? br_no_memory(s->err, "the table") : BR_OK;
}

/* ---- the text ---- */

/* One value, or lines of them. */
static json_t *load(const struct source *s, const char *text)
{
    json_t *all = json_array();
    json_error_t why;
    for (const char *at = skip_blanks(text); all && *at;) {
        json_t *value = json_loads(
            at, JSON_DISABLE_EOF_CHECK | JSON_DECODE_INT_AS_REAL | JSON_REJECT_DUPLICATES, &why);
        if (!value || json_array_append_new(all, value)) {
            size_t line = (size_t)(why.line > 0 ? why.line : 1);
            for (const char *c = text; c < at; c++)
                line += *c == '\n';
            br_fail(s->err, BR_BAD_INPUT, "%s:%zu: found no valid JSON: %s", s->path, line,
                    why.text);
            json_decref(all);
            return NULL;
        }
        at = skip_blanks(at + why.position);
    }
    return all;
}

enum br_status br_json_fields(const char *text, const char *path, struct br_fields *fields,
                              struct br_error *err)
{
    struct source s = {.path = path, .fields = fields, .err = err, .tables = json_object()};
    const char *lists = NULL;
    struct br_error other = {0};
    json_t *all = s.tables ? load(&s, text) : NULL;
    if (s.tables && !all && !br_lists_find(text, path, fields, &lists, &other) && lists) {
        err->status = BR_OK; /* Python's NaN, its dictionaries, numpy */
        all = load(&s, lists);
    }
    enum br_status status =
        !s.tables || fields->store.failed ? br_no_memory(err, "the table") : err->status;
    if (!status)
        visit(&s, json_array_size(all) == 1 ? json_array_get(all, 0) : all, 0);
    if (!status)
        status = s.failed      ? br_no_memory(err, "the table")
                 : err->status ? err->status
                               : take_fields(&s);
    json_decref(all);
    json_decref(s.tables);
    return status;
}
