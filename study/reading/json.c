/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A table in JSON is a container of containers: of rows, or of columns. Where an array's values
 * have their positions for keys, all forms are objects of objects, and one walk takes them. */
#include <jansson.h>
#include <stdio.h>
#include <string.h>

#include "study/base/words.h"
#include "study/reading/json.h"

struct source {
    const char *path;
    struct br_fields *fields;
    struct br_error *err;
    json_t *columns; /* names to arrays of values; owned */
    json_t *types;   /* the fields of pandas' schema; borrowed; may be NULL */
    size_t rows;
    size_t room; /* of fields->left */
    bool failed; /* no memory */
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
    if (!*from)
        return NULL;
    char *to = br_store_take(&s->fields->store, strlen(from) + 1, 1);
    return to ? strcpy(to, from) : NULL;
}

/* Sets a value of a row; those of an object in it with the names of both. */
static void set(struct source *s, size_t row, const char *name, json_t *value)
{
    const char *key;
    json_t *part, *column = json_object_get(s->columns, name);
    if (json_is_object(value) && strlen(name) < 400) {
        json_object_foreach (value, key, part) {
            char both[600];
            snprintf(both, sizeof both, "%s%s%.180s", name, *name ? " " : "", key);
            set(s, row, both, part);
        }
        return;
    }
    if (!column)
        s->failed |= json_object_set_new(s->columns, name, column = json_array()) != 0;
    while (!s->failed && json_array_size(column) < row)
        s->failed |= json_array_append_new(column, json_null()) != 0;
    s->failed |= json_array_append(column, value) != 0;
    s->rows = row < s->rows ? s->rows : row + 1;
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
    f->left = br_store_grow(&f->store, f->left, f->lefts, &s->room, sizeof *f->left);
    if (text && line && f->left) {
        snprintf(line, size, "%s: %s", name, text);
        f->left[f->lefts++] = (struct br_left_line){0, line, "beside the table"};
    }
    s->failed |= !text || !line || !f->left;
    free(text);
}

/* ---- containers ---- */

static size_t size_of(const json_t *value)
{
    return json_is_array(value) ? json_array_size(value) : json_object_size(value);
}

/* What the values of a container are, if all are alike. */
enum kind { MIXED, PLAIN, LISTS, MAPS };

static enum kind kind_of(const json_t *value)
{
    return json_is_array(value) ? LISTS : json_is_object(value) ? MAPS : PLAIN;
}

static enum kind kind_in(json_t *container)
{
    size_t i;
    const char *key;
    json_t *value;
    enum kind kind =
        kind_of(json_is_array(container) ? json_array_get(container, 0)
                                         : json_object_iter_value(json_object_iter(container)));
    json_array_foreach(container, i, value) kind = kind_of(value) == kind ? kind : MIXED;
    json_object_foreach (container, key, value)
        kind = kind_of(value) == kind ? kind : MIXED;
    return size_of(container) ? kind : MIXED;
}

/* A new object of the values of an array with these names, or else their positions; or the object
 * itself. NULL: it is refused. */
static json_t *with_keys(struct source *s, json_t *value, const json_t *names)
{
    size_t i;
    json_t *element, *object = json_is_object(value) ? json_incref(value) : json_object();
    const bool named = json_is_array(value) && json_is_array(names);
    const char *why = named && size_of(names) != size_of(value) ? "rows of several lengths" : NULL;
    json_array_foreach(value, i, element)
    {
        char position[24];
        snprintf(position, sizeof position, "%zu", i + 1);
        const char *name = named ? text_of(s, json_array_get(names, i)) : position;
        why = json_object_get(object, name ? name : "") ? "two columns or rows of one name" : why;
        s->failed |= json_object_set(object, name ? name : "", element) != 0;
    }
    if (!why)
        return object;
    refuse(s, why, "");
    json_decref(object);
    return NULL;
}

/* Whether the keys of an object are 0, 1, 2 ...; numbers (out): all are numbers. */
static bool counts(json_t *object, bool *numbers)
{
    const char *key;
    json_t *value;
    struct br_field_number number;
    bool counts = *numbers = true;
    double next = 0;
    json_object_foreach (object, key, value) {
        *numbers &= br_field_read(key, '.', &number);
        counts &= *numbers && number.value == next++;
    }
    return counts;
}

static bool have_same_keys(json_t *a, json_t *b)
{
    const char *key;
    json_t *value;
    void *other = json_object_iter(b);
    json_object_foreach (a, key, value) {
        if (!other || strcmp(key, json_object_iter_key(other)) != 0)
            return false;
        other = json_object_iter_next(b, other);
    }
    return !other;
}

static void set_index(struct source *s, size_t row, const char *key)
{
    json_t *text = json_string(key);
    set(s, row, "", text);
    json_decref(text);
}

/* ---- tables ---- */

/* Takes all rows, or columns. names: of the values in arrays that are rows; index: of rows; both
 * may be NULL. Keys of rows that do not count them are a column without a name. */
static enum br_status walk(struct source *s, json_t *table, const json_t *names,
                           const json_t *index)
{
    const char *key, *name;
    json_t *part, *value, *outer = with_keys(s, table, index), *first = NULL;
    bool numbers, inner_numbers;
    const bool no_index = counts(outer, &numbers) || (json_is_array(table) && !index);
    const bool by_row = json_is_array(table) || numbers;
    size_t row = 0, i;
    s->err->status = outer ? BR_OK : s->err->status;
    json_object_foreach (outer, key, part) {
        json_t *inner = with_keys(s, part, by_row ? names : NULL);
        if (inner && first && (!by_row || json_is_array(part)) && !have_same_keys(first, inner)) {
            char why[80];
            snprintf(why, sizeof why, "%zu values, but %zu or others in ", size_of(first),
                     size_of(inner));
            refuse(s, why, key);
        }
        if (by_row && !no_index)
            set_index(s, row, key);
        i = 0;
        if (!by_row && !first && json_is_object(part) && !counts(part, &inner_numbers))
            json_object_foreach (inner, name, value)
                set_index(s, i++, name);
        i = 0;
        json_object_foreach (inner, name, value) {
            set(s, by_row ? row : i, by_row ? name : key, value);
            i++;
        }
        row++;
        first = first ? first : json_incref(inner);
        json_decref(inner);
        if (s->err->status)
            break;
    }
    json_decref(first);
    json_decref(outer);
    return s->err->status;
}

static enum br_status take_value(struct source *s, json_t *value);

/* Takes the one table in an object; the rest of it is named in fields->left. */
static enum br_status take_member(struct source *s, json_t *object)
{
    const char *key;
    json_t *value, *table = NULL;
    json_object_foreach (object, key, value) {
        const enum kind kind = kind_in(value);
        if (kind != LISTS && kind != MAPS)
            leave(s, key, value);
        else if (table)
            return refuse(s, "several tables", "");
        else
            table = value;
    }
    return table                      ? take_value(s, table)
           : kind_in(object) == PLAIN ? refuse(s, "a single record", "")
                                      : refuse(s, "no table", "");
}

/* {"h": [...], "l2": [...]}; what is no list stands beside the table. */
static enum br_status take_lists(struct source *s, json_t *object)
{
    const char *key;
    json_t *value, *lists = json_object();
    json_object_foreach (object, key, value)
        if (!json_is_array(value))
            leave(s, key, value);
        else
            s->failed |= json_object_set(lists, key, value) != 0;
    const enum br_status status = walk(s, lists, NULL, NULL);
    json_decref(lists);
    return status;
}

static enum br_status take_value(struct source *s, json_t *value)
{
    json_t *data = json_object_get(value, "data"), *names = json_object_get(value, "columns");
    const char *key;
    json_t *member;
    const enum kind kind = kind_in(value);
    if (json_is_array(data) && json_is_array(names) && kind_in(data) == LISTS)
        return walk(s, data, names, json_object_get(value, "index"));
    json_t *const types = json_object_get(json_object_get(value, "schema"), "fields");
    if (json_is_array(data) && types) {
        s->types = types;
        return take_value(s, data);
    }
    if (json_is_array(value) && kind == LISTS &&
        json_is_string(json_array_get(json_array_get(value, 0), 0))) {
        names = json_incref(json_array_get(value, 0));
        json_array_remove(value, 0);
        const enum br_status status = walk(s, value, names, NULL);
        json_decref(names);
        return status;
    }
    if (json_is_array(value))
        return kind == LISTS || kind == MAPS ? walk(s, value, NULL, NULL)
                                             : refuse(s, "a list of values", "");
    size_t lists = 0, maps = 0;
    json_object_foreach (value, key, member) {
        lists += json_is_array(member) && kind_in(member) == PLAIN;
        maps += json_is_object(member) && kind_in(member) == PLAIN;
    }
    return lists > 1 || (lists && kind == LISTS)         ? take_lists(s, value)
           : maps > 1 && maps == json_object_size(value) ? walk(s, value, NULL, NULL)
                                                         : take_member(s, value);
}

/* ---- to fields ---- */

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
    json_t *column, *value;
    const char *name;
    size_t i, j = 0;
    f->columns = json_object_size(s->columns);
    f->rows = s->rows;
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
    f->heading_line = 1;
    if (f->store.failed)
        return br_no_memory(s->err, "the table");
    json_object_foreach (s->columns, name, column) {
        char *text = br_store_take(&f->store, strlen(name) + 1, 1);
        f->heading[j] = text && *name ? strcpy(text, name) : NULL;
        f->is_words[j] = has_words(s, name);
        json_array_foreach(column, i, value) f->field[i * f->columns + j] = text_of(s, value);
        j++;
    }
    return s->failed || f->store.failed ? br_no_memory(s->err, "the table") : BR_OK;
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
    struct source s = {path, fields, err, json_object(), NULL, 0, 0, false};
    char *copy = without_nan(text);
    json_t *all = NULL;
    enum br_status status = !copy || !s.columns      ? br_no_memory(err, "the table")
                            : (all = load(&s, copy)) ? BR_OK
                                                     : err->status;
    if (!status)
        status = take_value(&s, json_array_size(all) == 1 ? json_array_get(all, 0) : all);
    if (!status)
        status = s.failed ? br_no_memory(err, "the table") : take_fields(&s);
    free(copy);
    json_decref(all);
    json_decref(s.columns);
    return status;
}
