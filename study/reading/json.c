/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every form of a table in JSON becomes records, an array of objects from names to values; these
 * become fields. A JSON number is written with the fewest digits that give it again. */
#include <jansson.h>
#include <stdio.h>
#include <string.h>

#include "study/base/words.h"
#include "study/reading/json.h"

struct source {
    const char *path;
    struct br_fields *fields;
    struct br_error *err;
    json_t *records; /* owned */
    json_t *words;   /* names of columns that a schema says to have no numbers; owned */
    size_t room;     /* of fields->left */
    bool failed;     /* no memory */
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

/* ---- to records ---- */

/* Adds the values of an object to a record; those of an object in it with the names of both. */
static void flatten(struct source *s, json_t *record, const char *prefix, json_t *object)
{
    const char *key;
    json_t *value;
    json_object_foreach (object, key, value) {
        char name[200];
        snprintf(name, sizeof name, "%s%s%s", prefix, *prefix ? " " : "", key);
        if (json_is_object(value) && strlen(name) + 2 < sizeof name)
            flatten(s, record, name, value);
        else
            s->failed |= json_object_set(record, name, value) != 0;
    }
}

static json_t *add_record(struct source *s)
{
    json_t *record = json_object();
    s->failed |= json_array_append_new(s->records, record) != 0;
    return record;
}

/* Sets a value of the record `row`, which may be the next one. */
static void set(struct source *s, size_t row, const char *name, json_t *value)
{
    json_t *record =
        row < json_array_size(s->records) ? json_array_get(s->records, row) : add_record(s);
    s->failed |= json_object_set(record, name, value) != 0;
}

/* Whether all values of an array or object are of one kind: arrays, objects, or neither. */
enum kind { PLAIN, ARRAYS, OBJECTS, MIXED };

static enum kind kind_of_value(const json_t *value)
{
    return json_is_array(value) ? ARRAYS : json_is_object(value) ? OBJECTS : PLAIN;
}

static enum kind kind_in(json_t *values)
{
    enum kind kind = MIXED;
    const char *key;
    json_t *value;
    size_t i;
    json_array_foreach(values, i, value) kind =
        i && kind != kind_of_value(value) ? MIXED : kind_of_value(value);
    bool first = true;
    json_object_foreach (values, key, value) {
        kind = !first && kind != kind_of_value(value) ? MIXED : kind_of_value(value);
        first = false;
    }
    return kind;
}

static enum br_status take_value(struct source *s, json_t *value);

static enum br_status refuse(const struct source *s, const char *why)
{
    return br_fail(s->err, BR_BAD_INPUT,
                   "%s: %s, expected one table: records, or columns of as many "
                   "values each",
                   s->path, why);
}

/* Rows of values; names: NULL, the first row has them. */
static enum br_status take_rows(struct source *s, json_t *rows, json_t *names)
{
    size_t i, j;
    json_t *row, *value;
    const bool named = names || json_is_string(json_array_get(json_array_get(rows, 0), 0));
    json_t *const heading = names ? names : json_array_get(rows, 0);
    json_array_foreach(rows, i, row)
    {
        if (i == 0 && !names && named)
            continue;
        if (json_array_size(row) != json_array_size(heading))
            return refuse(s, "found rows of several lengths");
        json_t *record = add_record(s);
        json_array_foreach(row, j, value)
        {
            char position[24];
            snprintf(position, sizeof position, "%zu", j + 1);
            json_t *name = json_array_get(heading, j);
            s->failed |=
                json_object_set(record,
                                json_is_string(name) && named ? json_string_value(name) : position,
                                value) != 0;
        }
    }
    return BR_OK;
}

static enum br_status take_records(struct source *s, json_t *records)
{
    size_t i;
    json_t *record;
    json_array_foreach(records, i, record) flatten(s, add_record(s), "", record);
    return BR_OK;
}

/* Names a value that stands beside the table. */
static void leave(struct source *s, const char *name, const json_t *value)
{
    struct br_fields *f = s->fields;
    char *text = json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT);
    const size_t size = strlen(name) + (text ? strlen(text) : 0) + 3;
    char *line = br_store_take(&f->store, size, 1);
    f->left = br_store_grow(&f->store, f->left, f->lefts, &s->room, sizeof *f->left);
    if (text && line && f->left) {
        snprintf(line, size, "%s: %s", name, text);
        f->left[f->lefts++] = (struct br_left_line){0, line, "beside the table"};
    }
    s->failed |= !text || !line || !f->left;
    free(text);
}

/* {"h": [...], "l2": [...]}; what is no list stands beside the table. */
static enum br_status take_columns(struct source *s, json_t *columns)
{
    const char *name;
    json_t *column, *value;
    size_t i, size = 0;
    json_object_foreach (columns, name, column) {
        if (!json_is_array(column)) {
            leave(s, name, column);
            continue;
        }
        if (size && size != json_array_size(column))
            return refuse(s, "found columns of several lengths");
        size = json_array_size(column);
        json_array_foreach(column, i, value) set(s, i, name, value);
    }
    return BR_OK;
}

static bool counts(json_t *object)
{
    const char *key;
    json_t *value;
    size_t i = 0;
    char text[24];
    bool counted = true;
    json_object_foreach (object, key, value) {
        snprintf(text, sizeof text, "%zu", i++);
        counted &= strcmp(text, key) == 0;
    }
    return counted;
}

static bool has_numbers_as_keys(json_t *object)
{
    const char *key;
    json_t *value;
    struct br_field_number number;
    bool numbers = true;
    json_object_foreach (object, key, value)
        numbers &= br_field_read(key, '.', &number);
    return numbers;
}

static bool have_same_keys(json_t *a, json_t *b)
{
    void *of_a = json_object_iter(a), *of_b = json_object_iter(b);
    while (of_a && of_b && strcmp(json_object_iter_key(of_a), json_object_iter_key(of_b)) == 0) {
        of_a = json_object_iter_next(a, of_a);
        of_b = json_object_iter_next(b, of_b);
    }
    return !of_a && !of_b;
}

/* {"h": {"0": 0.1, ...}, ...}, or with numbers outside {"0": {"h": 0.1, ...}, ...}. An index that
 * does not count from 0 is a column without a name. */
static enum br_status take_maps(struct source *s, json_t *maps)
{
    const char *outer, *inner;
    json_t *map, *value;
    const bool by_row = has_numbers_as_keys(maps);
    size_t row = 0;
    json_object_foreach (maps, outer, map) {
        if (by_row) {
            json_t *record = add_record(s), *index = json_string(outer);
            if (!counts(maps))
                s->failed |= json_object_set(record, "", index) != 0;
            json_decref(index);
            flatten(s, record, "", map);
            continue;
        }
        row = 0;
        if (!have_same_keys(json_object_iter_value(json_object_iter(maps)), map))
            return refuse(s, "found columns with other rows");
        json_object_foreach (map, inner, value) {
            json_t *index = json_string(inner);
            if (!counts(map))
                set(s, row, "", index);
            json_decref(index);
            set(s, row++, outer, value);
        }
    }
    return BR_OK;
}

/* Keeps the columns that pandas' schema says to have no numbers. */
static void take_schema(struct source *s, const json_t *schema)
{
    static const char types[] = " datetime duration string boolean any ";
    size_t i;
    json_t *field;
    json_array_foreach(json_object_get(schema, "fields"), i, field)
    {
        const char *type = json_string_value(json_object_get(field, "type"));
        char word[24];
        snprintf(word, sizeof word, " %.20s ", type ? type : "");
        if (type && strstr(types, word) && json_object_get(field, "name"))
            s->failed |= json_array_append(s->words, json_object_get(field, "name")) != 0;
    }
}

/* An object around one table; the rest of it is named in fields->left. */
static enum br_status take_member(struct source *s, json_t *object)
{
    const char *key;
    json_t *value, *table = NULL;
    json_object_foreach (object, key, value) {
        const enum kind kind = kind_in(value);
        if (kind != OBJECTS && kind != ARRAYS) {
            leave(s, key, value);
            continue;
        }
        if (table)
            return refuse(s, "found several tables");
        table = value;
    }
    return table ? take_value(s, table) : refuse(s, "found no table");
}

static enum br_status take_value(struct source *s, json_t *value)
{
    json_t *data = json_object_get(value, "data"), *names = json_object_get(value, "columns");
    const enum kind kind = kind_in(value);
    if (json_is_array(value))
        return kind == OBJECTS  ? take_records(s, value)
               : kind == ARRAYS ? take_rows(s, value, NULL)
                                : refuse(s, "found a list of values");
    if (json_is_array(data) && json_is_array(names) && kind_in(data) == ARRAYS)
        return take_rows(s, data, names);
    if (json_is_array(data) && json_object_get(value, "schema")) {
        take_schema(s, json_object_get(value, "schema"));
        return take_records(s, data);
    }
    size_t lists = 0;
    const char *key;
    json_t *member;
    json_object_foreach (value, key, member)
        lists += json_is_array(member) && kind_in(member) == PLAIN;
    if (lists > 1 || (lists && kind == ARRAYS))
        return take_columns(s, value);
    size_t maps = 0;
    json_object_foreach (value, key, member)
        maps += json_is_object(member) && kind_in(member) == PLAIN;
    if (maps > 1 && maps == json_object_size(value))
        return take_maps(s, value);
    return take_member(s, value);
}

/* ---- to fields ---- */

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
    if (!*from)
        return NULL;
    char *to = br_store_take(&s->fields->store, strlen(from) + 1, 1);
    return to ? strcpy(to, from) : NULL;
}

static enum br_status name_columns(struct source *s, json_t *columns)
{
    struct br_fields *f = s->fields;
    size_t i = 0, j;
    const char *name;
    json_t *place, *word;
    json_object_foreach (columns, name, place) {
        json_t *text = json_string(name);
        f->heading[i] = text_of(s, text);
        json_decref(text);
        json_array_foreach(s->words, j, word) f->is_words[i] |=
            json_is_string(word) && strcmp(json_string_value(word), name) == 0;
        i++;
    }
    return s->failed || f->store.failed ? br_no_memory(s->err, "the table") : BR_OK;
}

static enum br_status take_fields(struct source *s, json_t *columns)
{
    struct br_fields *f = s->fields;
    json_t *record, *value;
    const char *name;
    size_t i;
    json_array_foreach(s->records, i, record)
        json_object_foreach (record, name, value) if (!json_object_get(columns, name)) s->failed |=
        json_object_set_new(columns, name, json_integer((json_int_t)json_object_size(columns))) !=
        0;
    f->columns = json_object_size(columns);
    f->rows = json_array_size(s->records);
    if (f->columns > BR_MOST_COLUMNS || f->rows > BR_MOST_TABLE_ROWS ||
        f->rows * f->columns > BR_MOST_FIELDS)
        return br_fail(
            s->err, BR_BAD_INPUT,
            "%s: found %zu rows of %zu fields, expected at most %d columns, %d rows and %d "
            "fields in all",
            s->path, f->rows, f->columns, BR_MOST_COLUMNS, BR_MOST_TABLE_ROWS, BR_MOST_FIELDS);
    if (!f->rows || !f->columns)
        return br_fail(s->err, BR_BAD_INPUT, "%s:1: the table is empty", s->path);
    f->heading = br_store_take(&f->store, f->columns, sizeof *f->heading);
    f->is_words = br_store_take(&f->store, f->columns, sizeof *f->is_words);
    f->field = br_store_take(&f->store, f->rows * f->columns, sizeof *f->field);
    f->line = br_store_take(&f->store, f->rows, sizeof *f->line);
    if (f->store.failed || name_columns(s, columns))
        return br_no_memory(s->err, "the table");
    f->heading_line = 1;
    json_array_foreach(s->records, i, record) json_object_foreach (record, name, value)
    {
        const size_t column = (size_t)json_integer_value(json_object_get(columns, name));
        f->field[i * f->columns + column] = text_of(s, value);
    }
    return f->store.failed ? br_no_memory(s->err, "the table") : BR_OK;
}

/* ---- the text ---- */

/* Copies a text with null for NaN and Infinity, which Python writes. */
static char *without_nan(const char *text)
{
    static const char *const words[] = {"NaN", "-Infinity", "Infinity"};
    char *const copy = br_allocate(strlen(text) * 4 / 3 + 8, 1);
    bool quoted = false;
    for (char *to = copy; copy && *text;) {
        size_t length = 0;
        for (size_t i = 0; i < 3 && !quoted && !length; i++)
            length = strncmp(text, words[i], strlen(words[i])) == 0 ? strlen(words[i]) : 0;
        if (length) {
            memcpy(to, "null", 4);
            to += 4;
            text += length;
            continue;
        }
        quoted ^= *text == '"';
        if (quoted && *text == '\\' && text[1])
            *to++ = *text++;
        *to++ = *text++;
    }
    return copy;
}

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
    struct source s = {path, fields, err, json_array(), json_array(), 0, false};
    char *copy = without_nan(text);
    json_t *columns = json_object(), *all = NULL;
    enum br_status status = !copy || !columns || !s.records || !s.words
                                ? br_no_memory(err, "the table")
                            : (all = load(&s, copy)) ? BR_OK
                                                     : err->status;
    if (!status)
        status = take_value(&s, json_array_size(all) == 1 ? json_array_get(all, 0) : all);
    if (!status)
        status = s.failed ? br_no_memory(err, "the table") : take_fields(&s, columns);
    free(copy);
    json_decref(all);
    json_decref(columns);
    json_decref(s.records);
    json_decref(s.words);
    return status;
}
