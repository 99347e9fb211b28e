/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/orders/table.h"

#include <ctype.h>
#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/scene/words.h"

/* The table as text: a heading, and fields by rows; all owned. NULL: an empty field. */
struct grid {
    char **heading; /* columns */
    size_t columns;
    char **field; /* rows * columns */
    size_t *line; /* rows */
    size_t rows, room;
};

static void clear_grid(struct grid *g)
{
    for (size_t i = 0; i < g->columns; i++)
        free(g->heading[i]);
    for (size_t i = 0; i < g->rows * g->columns; i++)
        free(g->field[i]);
    free(g->heading);
    free(g->field);
    free(g->line);
}

/* Makes the array larger, zeros behind; NULL without memory, the old one then stays. */
static void *grown(void *old, size_t count, size_t room, size_t size)
{
    char *new = br_allocate(room, size);
    if (new &&count)
        memcpy(new, old, count * size);
    if (new)
        free(old);
    return new;
}

static enum br_status add_row(struct grid *g, size_t line, struct br_error *err)
{
    if (g->rows == g->room) {
        const size_t room = 2 * g->room + 64;
        char **field = grown(g->field, g->rows * g->columns, room * g->columns, sizeof *field);
        g->field = field ? field : g->field;
        size_t *lines = field ? grown(g->line, g->rows, room, sizeof *lines) : NULL;
        g->line = lines ? lines : g->line;
        if (!lines)
            return br_no_memory(err, "the table");
        g->room = room;
    }
    g->line[g->rows++] = line;
    return BR_OK;
}

/* ---- CSV and TSV (RFC 4180) ---- */

/* A text on its way. */
struct cursor {
    const char *path, *at;
    char separator;
    size_t line;
};

/* Skips empty lines and comments ("# ..."); false: the text ends. */
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

/* How many bytes are left of the field that begins at `at`, with its quotes. */
static size_t field_length(const char *at, const char *stop)
{
    const char *end = at;
    if (*end == '"')
        for (end++; *end && (*end != '"' || end[1] == '"'); end++)
            end += *end == '"';
    return (size_t)(end - at) + strcspn(end, stop);
}

/* Takes a field of the line; *field (out) is owned, NULL where it is empty. *more: out, whether the
 * line goes on. */
static enum br_status take_field(struct cursor *c, char **field, bool *more, struct br_error *err)
{
    const size_t line = c->line;
    const char stop[] = {c->separator, '\n', '\0'};
    c->at += strspn(c->at, c->separator == '\t' ? " " : " \t");
    const bool quoted = *c->at == '"';
    char *text = br_allocate(field_length(c->at, stop) + 1, 1), *to = text;
    if (!text)
        return br_no_memory(err, "the table");
    if (quoted)
        for (c->at++; *c->at && (*c->at != '"' || c->at[1] == '"'); c->at++) {
            c->at += *c->at == '"';
            c->line += *c->at == '\n';
            *to++ = *c->at;
        }
    if (quoted && !*c->at) {
        free(text);
        return br_fail(err, BR_BAD_INPUT, "%s:%zu: a quote is open to the end", c->path, line);
    }
    c->at += quoted;
    while (!strchr(stop, *c->at))
        *to++ = *c->at++;
    while (to > text && isspace((unsigned char)to[-1]))
        *--to = '\0';
    *more = *c->at == c->separator;
    c->line += *c->at == '\n';
    c->at += *c->at != '\0';
    *field = *text ? strdup(text) : NULL;
    const bool lost = *text && !*field;
    free(text);
    return lost ? br_no_memory(err, "the table") : BR_OK;
}

static enum br_status add_heading(struct grid *g, char *name, size_t *room, struct br_error *err)
{
    if (g->columns == *room) {
        char **more = grown(g->heading, g->columns, 2 * *room + 16, sizeof *more);
        if (!more) {
            free(name);
            return br_no_memory(err, "the table");
        }
        g->heading = more;
        *room = 2 * *room + 16;
    }
    g->heading[g->columns++] = name;
    return BR_OK;
}

static enum br_status read_heading(struct cursor *c, struct grid *g, struct br_error *err)
{
    const size_t line = c->line;
    size_t room = 0;
    for (bool more = true; more;) {
        char *field;
        if (take_field(c, &field, &more, err))
            return err->status;
        if (!field)
            return br_fail(err, BR_BAD_INPUT, "%s:%zu: heading %zu is empty, expected a name",
                           c->path, line, g->columns + 1);
        if (add_heading(g, field, &room, err))
            return err->status;
    }
    return BR_OK;
}

static enum br_status read_line(struct cursor *c, struct grid *g, struct br_error *err)
{
    const size_t line = c->line;
    if (add_row(g, line, err))
        return err->status;
    char **field = &g->field[(g->rows - 1) * g->columns];
    bool more = true;
    size_t count = 0;
    for (; more && count < g->columns; count++)
        if (take_field(c, &field[count], &more, err))
            return err->status;
    if (more || count < g->columns)
        return br_fail(err, BR_BAD_INPUT, "%s:%zu: found %s than %zu fields, as the heading has",
                       c->path, line, more ? "more" : "fewer", g->columns);
    return BR_OK;
}

static enum br_status read_separated(const char *text, const char *path, struct grid *g,
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
    enum br_status status = read_heading(&c, g, err);
    while (!status && next_line(&c))
        status = read_line(&c, g, err);
    return status;
}

/* ---- JSON lines ---- */

static enum br_status take_object(json_t *object, size_t line, const char *path, struct grid *g,
                                  struct br_error *err)
{
    const char *key;
    json_t *value;
    if (g->columns == 0) {
        g->heading = br_allocate(json_object_size(object) + 1, sizeof *g->heading);
        if (!g->heading)
            return br_no_memory(err, "the table");
        json_object_foreach(object, key,
                            value) if (!(g->heading[g->columns++] =
                                             strdup(key))) return br_no_memory(err, "the table");
    }
    if (json_object_size(object) != g->columns)
        return br_fail(err, BR_BAD_INPUT, "%s:%zu: found %zu keys, expected the first line's %zu",
                       path, line, json_object_size(object), g->columns);
    if (add_row(g, line, err))
        return err->status;
    for (size_t i = 0; i < g->columns; i++) {
        char **field = &g->field[(g->rows - 1) * g->columns + i], text[32];
        value = json_object_get(object, g->heading[i]);
        if (!value)
            return br_fail(err, BR_BAD_INPUT, "%s:%zu: there is no key '%s', as in the first line",
                           path, line, g->heading[i]);
        if (json_is_null(value))
            continue;
        *field = json_is_number(value)
                     ? strdup(br_shortest(json_number_value(value), text, sizeof text))
                     : strdup(json_is_string(value) ? json_string_value(value) : "(no number)");
        if (!*field)
            return br_no_memory(err, "the table");
    }
    return BR_OK;
}

static enum br_status read_objects(const char *text, const char *path, struct grid *g,
                                   struct br_error *err)
{
    enum br_status status = BR_OK;
    size_t line = 1;
    for (const char *at = text; *at && !status; line++) {
        const size_t length = strcspn(at, "\n");
        json_error_t why;
        if (strspn(at, " \t\r\n") < length) {
            json_t *object = json_loadb(at, length, JSON_REJECT_DUPLICATES, &why);
            status = json_is_object(object)
                         ? take_object(object, line, path, g, err)
                         : br_fail(err, BR_BAD_INPUT, "%s:%zu: expected a JSON object: %s", path,
                                   line, object ? "found another value" : why.text);
            json_decref(object);
        }
        at += length + (at[length] == '\n');
    }
    return status;
}

/* ---- what the columns are ---- */

/* Splits "dt [s]" or "dt (s)" in place, at the last bracket; the unit is NULL where there is none.
 */
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

static bool is_number(const char *field, double *value)
{
    const char *end = br_read_number(field, value);
    return end && !*end;
}

/* A column of words is not studied; one with a number has to be of numbers. */
static bool has_number(const struct grid *g, size_t column)
{
    double value;
    for (size_t i = 0; i < g->rows; i++) {
        const char *field = g->field[i * g->columns + column];
        if (field && is_number(field, &value))
            return true;
    }
    return false;
}

static enum br_status number_at(const struct grid *g, const struct br_table_request *q, size_t row,
                                size_t column, double *value, struct br_error *err)
{
    const char *field = g->field[row * g->columns + column];
    *value = NAN;
    if (!field || is_number(field, value))
        return BR_OK;
    return br_fail(err, BR_BAD_INPUT, "%s:%zu: %s: found '%.40s', expected a number", q->path,
                   g->line[row], g->heading[column], field);
}

/* A resolution of an axis that has a column before: it must say the same, to a constant factor. */
static enum br_status compare_sizes(const struct grid *g, const struct br_table_request *q,
                                    const struct br_resolution_column *column, size_t place,
                                    const struct br_numbers *numbers, struct br_error *err)
{
    double factor = NAN;
    for (size_t i = 0; i < g->rows; i++) {
        double given;
        if (number_at(g, q, i, place, &given, err))
            return err->status;
        const double ratio =
            br_numbers_z(column, given, q->dimension) / numbers->row[i].z[column->axis];
        factor = i ? factor : ratio;
        if (!(fabs(ratio / factor - 1) <= 1e-6))
            return br_fail(err, BR_BAD_INPUT, "%s:%zu: %s: found %g, which contradicts %s", q->path,
                           g->line[i], column->name, given, numbers->column[column->axis]->name);
    }
    return BR_OK;
}

static enum br_status take_sizes(const struct grid *g, const struct br_table_request *q,
                                 size_t place, const char *unit, struct br_numbers *numbers,
                                 struct br_error *err)
{
    const struct br_resolution_column *column = br_resolution_column_find(g->heading[place]);
    const enum br_axis axis = column->axis;
    if (numbers->column[axis])
        return compare_sizes(g, q, column, place, numbers, err);
    numbers->column[axis] = column;
    if (unit && !(numbers->unit[axis] = strdup(unit)))
        return br_no_memory(err, "the table");
    for (size_t i = 0; i < g->rows; i++) {
        struct br_numbers_row *row = &numbers->row[i];
        if (number_at(g, q, i, place, &row->given[axis], err))
            return err->status;
        row->z[axis] = br_numbers_z(column, row->given[axis], q->dimension);
    }
    return BR_OK;
}

static enum br_status take_quantity(const struct grid *g, const struct br_table_request *q,
                                    size_t place, const char *unit, struct br_numbers *numbers,
                                    struct br_error *err)
{
    const size_t index = numbers->quantities++;
    struct br_quantity *quantity = &numbers->quantity[index];
    *quantity = (struct br_quantity){.name = strdup(g->heading[place]),
                                     .unit = unit ? strdup(unit) : NULL,
                                     .is_value = br_lists(q->values, g->heading[place])};
    if (!quantity->name || (unit && !quantity->unit))
        return br_no_memory(err, "the table");
    for (size_t i = 0; i < g->rows; i++) {
        if (number_at(g, q, i, place, &numbers->row[i].number[index], err))
            return err->status;
    }
    return BR_OK;
}

static bool is_studied(const struct grid *g, const struct br_table_request *q, size_t place)
{
    const char *name = g->heading[place];
    if (q->errors || q->values)
        return br_lists(q->errors, name) || br_lists(q->values, name);
    return has_number(g, place);
}

/* Every name of a list is a column, and in no other list. */
static enum br_status check_list(const struct grid *g, const struct br_table_request *q,
                                 const char *option, const char *list, const char *other,
                                 struct br_error *err)
{
    const char *name;
    size_t length;
    while (list) {
        list = br_list_next(list, &name, &length);
        const char *heading = NULL;
        for (size_t i = 0; i < g->columns && !heading; i++)
            if (strlen(g->heading[i]) == length && memcmp(g->heading[i], name, length) == 0)
                heading = g->heading[i];
        if (!heading)
            return br_fail(err, BR_BAD_INPUT, "%s: %s: there is no column '%.*s'", q->path, option,
                           (int)length, name);
        if (br_resolution_column_find(heading))
            return br_fail(err, BR_BAD_INPUT, "%s: %s: '%s' is a resolution, expected numbers",
                           q->path, option, heading);
        if (br_lists(other, heading))
            return br_fail(err, BR_BAD_INPUT, "%s: '%s' is given as an error and as a value",
                           option, heading);
    }
    return BR_OK;
}

static enum br_status make_rows(const struct grid *g, struct br_numbers *numbers,
                                struct br_error *err)
{
    numbers->row = br_allocate(g->rows + 1, sizeof *numbers->row);
    numbers->quantity = br_allocate(g->columns + 1, sizeof *numbers->quantity);
    if (!numbers->row || !numbers->quantity)
        return br_no_memory(err, "the table");
    for (size_t i = 0; i < g->rows; i++) {
        struct br_numbers_row *row = &numbers->row[numbers->rows++];
        *row = (struct br_numbers_row){.given = {NAN, NAN},
                                       .z = {NAN, NAN},
                                       .number = br_allocate(g->columns + 1, sizeof(double)),
                                       .line = g->line[i],
                                       .seconds = NAN,
                                       .bytes = NAN};
        if (!row->number)
            return br_no_memory(err, "the table");
    }
    return BR_OK;
}

static enum br_status take_columns(struct grid *g, const struct br_table_request *q,
                                   struct br_numbers *numbers, struct br_error *err)
{
    enum br_status status = make_rows(g, numbers, err);
    for (size_t i = 0; i < g->columns && !status; i++) {
        char *const unit = split_unit(g->heading[i]);
        for (size_t j = 0; j < i && !status; j++)
            if (strcmp(g->heading[i], g->heading[j]) == 0)
                status = br_fail(err, BR_BAD_INPUT, "%s: the column '%s' is there twice", q->path,
                                 g->heading[i]);
        if (status)
            break;
        if (br_resolution_column_find(g->heading[i]))
            status = take_sizes(g, q, i, unit, numbers, err);
        else if (is_studied(g, q, i))
            status = take_quantity(g, q, i, unit, numbers, err);
    }
    if (!status)
        status = check_list(g, q, "--error", q->errors, q->values, err);
    return status ? status : check_list(g, q, "--value", q->values, NULL, err);
}

enum br_status br_table_load(const char *path, char **text, struct br_error *err)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return br_fail(err, BR_BAD_INPUT, "%s: %s", path, strerror(errno));
    enum br_status status = BR_OK;
    *text = br_allocate(BR_LONGEST_TABLE + 2, 1); /* what is not read takes no memory */
    const size_t length = *text ? fread(*text, 1, BR_LONGEST_TABLE + 1, file) : 0;
    if (!*text)
        status = br_no_memory(err, "the table");
    else if (ferror(file))
        status =
            br_fail(err, errno == EISDIR ? BR_BAD_INPUT : BR_IO, "%s: %s", path, strerror(errno));
    else if (length > BR_LONGEST_TABLE)
        status = br_fail(err, BR_BAD_INPUT, "%s: found more than %d bytes, expected a table", path,
                         BR_LONGEST_TABLE);
    else if (strlen(*text) < length)
        status = br_fail(err, BR_BAD_INPUT, "%s: found a zero byte, expected text", path);
    fclose(file);
    if (!status)
        return BR_OK;
    free(*text);
    *text = NULL;
    return status;
}

enum br_status br_table_read(const char *text, const struct br_table_request *q,
                             struct br_numbers *numbers, struct br_error *err)
{
    static const char byte_order_mark[] = "\xef\xbb\xbf"; /* spreadsheets begin with it */
    struct grid g = {0};
    *numbers = (struct br_numbers){0};
    if (strncmp(text, byte_order_mark, strlen(byte_order_mark)) == 0)
        text += strlen(byte_order_mark);
    enum br_status status = text[strspn(text, " \t\r\n")] == '{'
                                ? read_objects(text, q->path, &g, err)
                                : read_separated(text, q->path, &g, err);
    if (!status && g.rows > BR_MOST_TABLE_ROWS)
        status = br_fail(err, BR_BAD_INPUT, "%s: found %zu rows, expected at most %d", q->path,
                         g.rows, BR_MOST_TABLE_ROWS);
    if (!status)
        status = take_columns(&g, q, numbers, err);
    clear_grid(&g);
    if (status)
        return status;
    if (!numbers->column[BR_AXIS_SPACE] && !numbers->column[BR_AXIS_TIME])
        return br_fail(err, BR_BAD_INPUT,
                       "%s: found no column of a resolution, expected h, n or dofs, or k, dt or "
                       "steps",
                       q->path);
    if (!numbers->quantities)
        return br_fail(err, BR_BAD_INPUT, "%s: found no column of numbers beside the resolution",
                       q->path);
    return br_numbers_check(numbers, q->path, err);
}
