/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A source of numbers: a table in a file. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/orders/request.h"
#include "study/scene/words.h"

/* ---- CSV and TSV (RFC 4180) ---- */

/* The position in a text. */
struct cursor {
    const char *path, *at;
    char separator;
    size_t line;
    char *field; /* a buffer for the longest one; owned */
};

/* Skips empty lines and comments ("# ..."); false: the text has ended. */
static bool next_line(struct cursor *c)
{
    for (;;) {
        const char *end = c->at + strcspn(c->at, "\n");
        const char *first = c->at + strspn(c->at, " \t\r");
        if (first < end && *first != '#')
            return true;
        if (!*end)
            return false;
        c->at = end + 1;
        c->line++;
    }
}

/* Takes the text of a quoted field; returns where its next letter goes; NULL: the quote is not
 * closed. */
static char *take_quoted(struct cursor *c)
{
    char *to = c->field;
    for (c->at++; *c->at && (*c->at != '"' || c->at[1] == '"'); c->at++) {
        c->at += *c->at == '"';
        c->line += *c->at == '\n';
        *to++ = *c->at;
    }
    return *c->at++ ? to : NULL;
}

/* Takes a field without the blanks around it; *more (out): whether the line goes on. */
static enum br_status take_field(struct cursor *c, json_t *row, bool *more, struct br_error *err)
{
    const char stop[] = {c->separator, '\n', '\0'};
    const char *const blanks = c->separator == '\t' ? " \r" : " \t\r";
    const size_t line = c->line;
    c->at += strspn(c->at, blanks);
    const bool quoted = *c->at == '"';
    char *to = quoted ? take_quoted(c) : c->field;
    if (!to)
        return br_fail(err, BR_BAD_INPUT, "%s:%zu: a quote is open to the end", c->path, line);
    if (quoted && !strchr(stop, c->at[strspn(c->at, blanks)]))
        return br_fail(err, BR_BAD_INPUT, "%s:%zu: found text behind a quote in its field", c->path,
                       line);
    while (!strchr(stop, *c->at))
        *to++ = *c->at++;
    while (to > c->field && isspace((unsigned char)to[-1]))
        to--;
    *to = '\0';
    *more = *c->at == c->separator;
    c->line += *c->at == '\n';
    c->at += *c->at != '\0';
    json_t *field = *c->field ? json_string_nocheck(c->field) : json_null();
    return json_array_append_new(row, field) ? br_no_memory(err, "the table") : BR_OK;
}

/* Adds the row of a line, without fields; *row (out) is the table's. Fails where it is one row, or
 * one field, too many. */
static enum br_status add_row(json_t *table, size_t line, const char *path, json_t **row,
                              struct br_error *err)
{
    const size_t rows = json_array_size(table), columns = json_array_size(json_array_get(table, 0));
    *row = json_pack("[I]", (json_int_t)line);
    if (json_array_append_new(table, *row))
        return br_no_memory(err, "the table");
    if (rows > BR_MOST_ROWS)
        return br_fail(err, BR_BAD_INPUT, "%s:%zu: found row %zu, expected at most %d", path, line,
                       rows, BR_MOST_ROWS);
    if (rows > 0 && rows * (columns - 1) > BR_MOST_FIELDS)
        return br_fail(err, BR_BAD_INPUT,
                       "%s:%zu: found row %zu of %zu fields, expected at most %d "
                       "fields in all",
                       path, line, rows, columns - 1, BR_MOST_FIELDS);
    return BR_OK;
}

static enum br_status take_line(struct cursor *c, json_t *table, struct br_error *err)
{
    const size_t line = c->line;
    json_t *row;
    enum br_status status = add_row(table, line, c->path, &row, err);
    for (bool more = true; more && !status;)
        status =
            json_array_size(row) > BR_MOST_COLUMNS
                ? br_fail(err, BR_BAD_INPUT, "%s:%zu: found more than %d columns, expected fewer",
                          c->path, line, BR_MOST_COLUMNS)
                : take_field(c, row, &more, err);
    const size_t fields = json_array_size(row),
                 expected = json_array_size(json_array_get(table, 0));
    if (status || fields == expected)
        return status;
    return br_fail(err, BR_BAD_INPUT, "%s:%zu: found %s than %zu fields, as the heading has",
                   c->path, line, fields > expected ? "more" : "fewer", expected - 1);
}

enum br_status br_table_split(const char *text, const char *path, bool only_last,
                              const struct br_observer *observer, json_t *table,
                              struct br_error *err)
{
    struct cursor c = {.path = path, .at = text, .line = 1};
    if (!next_line(&c))
        return br_fail(err, BR_BAD_INPUT, "%s:1: the table is empty", path);
    const size_t heading = strcspn(c.at, "\n");
    c.separator = memchr(c.at, '\t', heading) ? '\t' : ',';
    if (c.separator == ',' && memchr(c.at, ';', heading) && !memchr(c.at, ',', heading))
        return br_fail(err, BR_BAD_INPUT, "%s:%zu: found ';' between columns, expected ',' or tabs",
                       path, c.line);
    c.field = br_allocate(strlen(text) + 1, 1);
    enum br_status status = c.field ? BR_OK : br_no_memory(err, "the table");
    while (!status && next_line(&c)) {
        if (only_last)
            json_array_remove(table, 1);
        status = br_observer_stops(observer) ? br_fail(err, BR_INTERRUPTED, "interrupted")
                                             : take_line(&c, table, err);
    }
    free(c.field);
    return status;
}

/* ---- columns ---- */

/* A table that is made into numbers. Rows and columns count from 1. */
struct source {
    const struct br_orders_request *request;
    const char *path;
    json_t *table;
    size_t rows, columns;
    struct br_numbers *numbers;
};

static json_t *field_at(const struct source *s, size_t row, size_t column)
{
    return json_array_get(json_array_get(s->table, row), column);
}

static const char *heading(const struct source *s, size_t column)
{
    return json_string_value(field_at(s, 0, column));
}

static size_t line_of(const struct source *s, size_t row)
{
    return (size_t)json_integer_value(field_at(s, row, 0));
}

/* Splits "dt [s]" or "dt (s)" in place, at the last bracket; NULL: there is no unit. */
static char *split_unit(char *heading)
{
    const size_t length = strlen(heading);
    const char last = length ? heading[length - 1] : '\0';
    char *open = last == ']' ? strrchr(heading, '[') : last == ')' ? strrchr(heading, '(') : NULL;
    if (!open || open == heading)
        return NULL;
    heading[length - 1] = '\0';
    char *end = open;
    while (end > heading && isspace((unsigned char)end[-1]))
        end--;
    *end = '\0';
    return open[1] ? open + 1 : NULL;
}

/* Reads the number of a field; an empty field is NaN. */
static bool is_number(const json_t *field, double *value)
{
    if (json_is_string(field)) {
        const char *end = br_read_number(json_string_value(field), value);
        return end && !*end;
    }
    *value = NAN;
    return json_is_null(field);
}

/* Whether a column has a number; then all its fields must be numbers. Else it is not studied. */
static bool has_number(const struct source *s, size_t column)
{
    double value;
    for (size_t i = 1; i <= s->rows; i++)
        if (!json_is_null(field_at(s, i, column)) && is_number(field_at(s, i, column), &value))
            return true;
    return false;
}

static enum br_status number_at(const struct source *s, size_t row, size_t column, double *value,
                                struct br_error *err)
{
    const json_t *field = field_at(s, row, column);
    if (is_number(field, value))
        return BR_OK;
    return br_fail(err, BR_BAD_INPUT, "%s:%zu: %s: found '%.40s', expected a number", s->path,
                   line_of(s, row), heading(s, column), json_string_value(field));
}

/* Takes a column of resolutions. Where its axis has one already, both must agree, but for a
 * constant factor. */
static enum br_status take_sizes(const struct source *s, size_t position, const char *unit,
                                 struct br_error *err)
{
    struct br_numbers *numbers = s->numbers;
    const struct br_resolution_column *column = br_resolution_column_find(heading(s, position));
    const enum br_axis axis = column->axis;
    const struct br_resolution_column *before = numbers->column[axis];
    double factor = NAN;
    if (!before && unit && !(numbers->unit[axis] = strdup(unit)))
        return br_no_memory(err, "the table");
    for (size_t i = 0; i < s->rows; i++) {
        struct br_numbers_row *row = &numbers->row[i];
        double given;
        if (number_at(s, i + 1, position, &given, err))
            return err->status;
        const double z = br_numbers_z(column, given, s->request->dimension);
        factor = i ? factor : z / row->z[axis];
        if (before && !(fabs(z / row->z[axis] / factor - 1) <= 1e-6))
            return br_fail(err, BR_BAD_INPUT, "%s:%zu: %s: found %g, which contradicts %s", s->path,
                           row->line, column->name, given, before->name);
        if (!before) {
            row->given[axis] = given;
            row->z[axis] = z;
        }
    }
    numbers->column[axis] = before ? before : column;
    return BR_OK;
}

static enum br_status take_quantity(const struct source *s, size_t position, const char *unit,
                                    struct br_error *err)
{
    struct br_numbers *numbers = s->numbers;
    const size_t index = numbers->quantities;
    const char *name = heading(s, position);
    enum br_status status =
        br_numbers_add_quantity(numbers, name, unit, br_lists(s->request->values, name), err);
    for (size_t i = 0; i < s->rows && !status; i++)
        status = number_at(s, i + 1, position, &numbers->row[i].number[index], err);
    return status;
}

static bool is_studied(const struct source *s, size_t position)
{
    const struct br_orders_request *q = s->request;
    const char *name = heading(s, position);
    if (q->errors || q->values)
        return br_lists(q->errors, name) || br_lists(q->values, name);
    return has_number(s, position);
}

static enum br_status take_column(const struct source *s, size_t position, struct br_error *err)
{
    const char *given = heading(s, position);
    if (!given)
        return br_fail(err, BR_BAD_INPUT, "%s:%zu: heading %zu is empty, expected a name", s->path,
                       line_of(s, 0), position);
    char *name = strdup(given);
    if (!name)
        return br_no_memory(err, "the table");
    const char *unit = split_unit(name);
    enum br_status status = BR_OK;
    if (json_array_set_new(json_array_get(s->table, 0), position, json_string_nocheck(name)))
        status = br_no_memory(err, "the table");
    for (size_t i = 1; i < position && !status; i++)
        if (strcmp(name, heading(s, i)) == 0)
            status = br_fail(err, BR_BAD_INPUT, "%s:%zu: the column '%s' is there twice", s->path,
                             line_of(s, 0), name);
    if (!status && br_resolution_column_find(name))
        status = take_sizes(s, position, unit, err);
    else if (!status && is_studied(s, position))
        status = take_quantity(s, position, unit, err);
    free(name);
    return status;
}

enum br_status br_table_read(const struct br_orders_request *q, struct br_numbers *numbers,
                             struct br_error *err)
{
    static const char byte_order_mark[] = "\xef\xbb\xbf"; /* spreadsheet programs write it first */
    const bool marked = strncmp(q->table, byte_order_mark, strlen(byte_order_mark)) == 0;
    const char *text = q->table + (marked ? strlen(byte_order_mark) : 0);
    struct source s = {.request = q, .path = br_orders_path(q), json_array(), .numbers = numbers};
    enum br_status status =
        text[strspn(text, " \t\r\n")] == '{'
            ? br_fail(
                  err, BR_BAD_INPUT,
                  "%s: found JSON, expected columns separated by commas or tabs; jq makes them: "
                  "jq -r '[.h, .error] | @csv'",
                  s.path)
            : br_table_split(text, s.path, false, q->observer, s.table, err);
    s.rows = json_array_size(s.table) ? json_array_size(s.table) - 1 : 0;
    s.columns = json_array_size(json_array_get(s.table, 0)) - 1;
    if (!status)
        status = br_numbers_make_room(numbers, s.rows, s.columns, err);
    for (size_t i = 0; i < s.rows && !status; i++)
        numbers->row[i].line = line_of(&s, i + 1);
    for (size_t i = 1; i <= s.columns && !status; i++)
        status = br_observer_stops(q->observer) ? br_fail(err, BR_INTERRUPTED, "interrupted")
                                                : take_column(&s, i, err);
    if (!status)
        status = br_orders_check_lists(q, numbers, err);
    const size_t heading_line = status ? 0 : line_of(&s, 0);
    json_decref(s.table);
    if (status)
        return status;
    if (!numbers->column[BR_AXIS_SPACE] && !numbers->column[BR_AXIS_TIME])
        return br_fail(
            err, BR_BAD_INPUT,
            "%s:%zu: found no column of a resolution, expected h, n or dofs, or k, dt or "
            "steps",
            s.path, heading_line);
    return numbers->quantities ? BR_OK
                               : br_fail(err, BR_BAD_INPUT,
                                         "%s:%zu: found no column of numbers beside the resolution",
                                         s.path, heading_line);
}
