/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The fields of a table, as programs, spreadsheets and people write it: separated by commas, tabs,
 * semicolons, bars, ampersands or blanks. */
#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "study/orders/request.h"
#include "study/scene/words.h"

/* The position in a text. */
struct cursor {
    const char *path, *at;
    char separator;     /* ' ': any number of blanks */
    size_t blanks;      /* how many, at least, where the separator is a blank */
    bool decimal_comma; /* 0,5 is a number */
    size_t line;
    char *field; /* a buffer for the longest one; owned */
};

/* ---- lines ---- */

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

/* Lines between rows, and LaTeX's commands. */
static bool is_rule(const char *line, const char *end)
{
    if (*line == '\\')
        return true;
    for (; line < end; line++)
        if (!strchr("-+=|:_* \t\r&", *line))
            return false;
    return true;
}

/* Skips empty lines, rules and comments; false: the text has ended. comment (out): the last comment
 * without its sign, or NULL: there was none. */
static bool next_line(struct cursor *c, const char **comment)
{
    for (;;) {
        const char *end = c->at + strcspn(c->at, "\n");
        const char *first = c->at;
        while (first < end && is_blank(*first))
            first++;
        const bool is_comment = first < end && strchr("#%!", *first);
        if (first < end && !is_comment && !is_rule(first, end))
            return true;
        if (is_comment)
            *comment = first + strspn(first, "#%!");
        if (!*end)
            return false;
        c->at = end + 1;
        c->line++;
    }
}

/* ---- fields ---- */

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

static bool ends_line(const struct cursor *c, const char *at)
{
    return !*at || *at == '\n' || (c->separator == '&' && at[0] == '\\' && at[1] == '\\');
}

/* Blanks beside '=' are in a field: "h = 0.5". */
static bool ends_field(const struct cursor *c, const char *at)
{
    if (c->separator != ' ' || ends_line(c, at))
        return ends_line(c, at) || *at == c->separator;
    const size_t blanks = strspn(at, " \t\r");
    return blanks >= c->blanks && at[-1] != '=' && at[blanks] != '=';
}

static const char *skip_blanks(const struct cursor *c, const char *at)
{
    while (is_blank(*at) && *at != c->separator)
        at++;
    return at;
}

/* Takes a field without the blanks around it; *more (out): whether the line goes on. */
static enum br_status take_field(struct cursor *c, json_t *row, bool *more, struct br_error *err)
{
    const size_t line = c->line;
    c->at = skip_blanks(c, c->at);
    const bool quoted = *c->at == '"' && c->separator != ' ';
    char *to = quoted ? take_quoted(c) : c->field;
    if (!to)
        return br_fail(err, BR_BAD_INPUT, "%s:%zu: a quote is open to the end", c->path, line);
    if (quoted && !ends_field(c, skip_blanks(c, c->at)))
        return br_fail(err, BR_BAD_INPUT, "%s:%zu: found text behind a quote in its field", c->path,
                       line);
    while (!ends_field(c, c->at))
        *to++ = *c->at++;
    while (to > c->field && isspace((unsigned char)to[-1]))
        to--;
    *to = '\0';
    if (c->separator == ' ')
        c->at += strspn(c->at, " \t\r");
    *more = !ends_line(c, c->at);
    c->at += *more && c->separator != ' ';
    char *comma = c->decimal_comma ? strchr(c->field, ',') : NULL;
    if (comma && isdigit((unsigned char)comma[1]))
        *comma = '.';
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

/* Takes the fields of a line into a row. A separator at the end is none. */
static enum br_status take_fields(struct cursor *c, json_t *row, struct br_error *err)
{
    const size_t line = c->line;
    enum br_status status = BR_OK;
    while (is_blank(*c->at) && c->separator != '\t')
        c->at++;
    c->at += c->separator == '|' && *c->at == '|';
    for (bool more = true; more && !status;)
        status =
            json_array_size(row) > BR_MOST_COLUMNS
                ? br_fail(err, BR_BAD_INPUT, "%s:%zu: found more than %d columns, expected fewer",
                          c->path, line, BR_MOST_COLUMNS)
                : take_field(c, row, &more, err);
    c->at += strcspn(c->at, "\n");
    c->line += *c->at == '\n';
    c->at += *c->at != '\0';
    return status;
}

/* ---- the heading ---- */

static const char *field(const json_t *table, size_t row, size_t column)
{
    return json_string_value(json_array_get(json_array_get(table, row), column));
}

static size_t fields(const json_t *table, size_t row)
{
    const size_t size = json_array_size(json_array_get(table, row));
    return size ? size - 1 : 0;
}

bool br_is_missing(const char *text)
{
    static const char *const words[] = {"-",  "--",  "---", "nan", "-nan",
                                        "na", "n/a", "inf", "-inf"};
    if (!text || strspn(text, "*") == strlen(text))
        return true;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strcasecmp(text, words[i]) == 0)
            return true;
    return false;
}

/* Whether a row has more numbers than words. */
static bool has_data(const json_t *table, size_t row)
{
    size_t numbers = 0, words = 0;
    for (size_t i = 1; i <= fields(table, row); i++) {
        double value;
        const char *text = field(table, row, i);
        const bool missing = br_is_missing(text);
        numbers += !missing && br_table_number(text, &value);
        words += !missing && !br_table_number(text, &value);
    }
    return numbers > words;
}

/* Puts the names of a line of headings above the next line's: rho, and error, EOC. */
static enum br_status join_headings(json_t *table, struct br_error *err)
{
    const size_t above = fields(table, 0), below = fields(table, 1);
    for (size_t i = 1; i <= below; i++) {
        char name[200];
        const char *group = field(table, 0, (i - 1) / (below / above) + 1);
        snprintf(name, sizeof name, "%s %s", group ? group : "", field(table, 1, i));
        if (json_array_set_new(json_array_get(table, 1), i, json_string_nocheck(name)))
            return br_no_memory(err, "the table");
    }
    json_array_remove(table, 0);
    return BR_OK;
}

/* Gives the columns that the heading does not name a heading of null: an index in front of each
 * row, as pandas prints it, and rates, which are '-' in the first row, as deal.II prints them. */
static enum br_status name_columns(json_t *table, struct br_error *err)
{
    json_t *heading = json_array_get(table, 0);
    const size_t names = fields(table, 0), columns = fields(table, 1);
    const char *first = field(table, 1, 1);
    size_t rates = 0;
    bool failed = false;
    for (size_t i = 1; i <= columns; i++)
        rates += field(table, 1, i) && strcmp(field(table, 1, i), "-") == 0;
    if (columns == names + 1 && first && strcmp(first, "0") == 0)
        failed = json_array_insert_new(heading, 1, json_null()) != 0;
    else if (rates && columns == names + rates)
        for (size_t i = 1; i <= columns && !failed; i++)
            if (field(table, 1, i) && strcmp(field(table, 1, i), "-") == 0)
                failed = json_array_insert_new(heading, i, json_null()) != 0;
    return failed ? br_no_memory(err, "the table") : BR_OK;
}

/* Removes an empty field behind the last separator, where the heading has none. */
static void trim(json_t *table, size_t row)
{
    json_t *fields_of = json_array_get(table, row);
    while (fields(table, row) > fields(table, 0) &&
           json_is_null(json_array_get(fields_of, fields(table, row))))
        json_array_remove(fields_of, fields(table, row));
}

/* A row of means, below the others, ends the table. */
static bool is_footer(const json_t *table, size_t row)
{
    static const char *const words[] = {"mean", "average", "avg", "slope", "order", "eoc", "fit"};
    const char *first = field(table, row, 1);
    for (size_t i = 0; row > 2 && first && i < sizeof words / sizeof *words; i++)
        if (strncasecmp(first, words[i], strlen(words[i])) == 0)
            return true;
    return false;
}

static enum br_status check_rows(json_t *table, const char *path, struct br_error *err)
{
    for (size_t i = 1; i < json_array_size(table); i++) {
        trim(table, i);
        if (i + 1 == json_array_size(table) && is_footer(table, i))
            json_array_remove(table, i);
        else if (fields(table, i) == fields(table, 0))
            continue;
        else
            return br_fail(
                err, BR_BAD_INPUT, "%s:%lld: found %s than %zu fields, as the heading has", path,
                json_integer_value(json_array_get(json_array_get(table, i), 0)),
                fields(table, i) > fields(table, 0) ? "more" : "fewer", fields(table, 0));
    }
    return BR_OK;
}

/* Rows of "h = 0.5  error = 2" get their names as a heading. */
static enum br_status name_pairs(json_t *table, const char *path, struct br_error *err)
{
    const size_t columns = fields(table, 0);
    double number;
    for (size_t i = 1; i <= columns; i++) {
        const char *text = field(table, 0, i), *equals = text ? strchr(text, '=') : NULL;
        const char *first = equals ? equals + 1 + strspn(equals + 1, " \t") : NULL;
        if (!first || !(br_is_missing(first) || br_table_number(first, &number)))
            return BR_OK;
    }
    if (json_array_insert_new(table, 0, json_deep_copy(json_array_get(table, 0))))
        return br_no_memory(err, "the table");
    for (size_t row = json_array_size(table); row-- > 0;)
        for (size_t i = 1; i <= columns; i++) {
            const char *text = field(table, row, i), *name = field(table, 0, i);
            const size_t length = strcspn(name, " =");
            const char *equals = text ? strchr(text, '=') : NULL;
            if (!equals || strncmp(text, name, length) != 0 || !strchr(" =", text[length]))
                return br_fail(err, BR_BAD_INPUT, "%s:%lld: found '%.40s', expected '%.*s = ...'",
                               path,
                               json_integer_value(json_array_get(json_array_get(table, row), 0)),
                               text ? text : "", (int)length, name);
            const char *value = equals + 1 + strspn(equals + 1, " \t");
            json_t *new = row ? json_string_nocheck(value) : json_stringn_nocheck(name, length);
            if (json_array_set_new(json_array_get(table, row), i, new))
                return br_no_memory(err, "the table");
        }
    return BR_OK;
}

static enum br_status settle_heading(json_t *table, const char *path, struct br_error *err)
{
    json_t *last = json_array_get(table, 0);
    while (fields(table, 0) > 1 && json_is_null(json_array_get(last, fields(table, 0))))
        json_array_remove(last, fields(table, 0));
    if (fields(table, 0) == 1 && fields(table, 1) > 2 && !has_data(table, 1)) {
        json_array_remove(table, 0); /* a title */
        return settle_heading(table, path, err);
    }
    if (name_pairs(table, path, err))
        return err->status;
    if (has_data(table, 0))
        return br_fail(err, BR_BAD_INPUT,
                       "%s:%lld: found numbers, expected a heading that names the columns: n,error",
                       path, json_integer_value(json_array_get(json_array_get(table, 0), 0)));
    const size_t above = fields(table, 0), below = fields(table, 1);
    const bool two = json_array_size(table) > 2 && above && below > above && below % above == 0 &&
                     !has_data(table, 1) && has_data(table, 2);
    if (two && join_headings(table, err))
        return err->status;
    return name_columns(table, err) || check_rows(table, path, err) ? err->status : BR_OK;
}

/* ---- the text ---- */

/* Whether a letter stands in the first line: outside of quotes, which may hold lines, or anywhere.
 */
static bool stands_in_line(const char *line, char letter, bool quotes)
{
    bool quoted = false;
    for (const char *at = line; *at && (*at != '\n' || quoted); at++) {
        quoted ^= quotes && *at == '"';
        if (*at == letter && !quoted)
            return true;
    }
    return false;
}

/* What separates the fields of a line. Bars stand in names, too, and LaTeX's lines end with \\. */
static char find_separator(const char *line)
{
    static const char separators[] = "\t|&;,";
    for (int quotes = 1; quotes >= 0; quotes--)
        for (const char *s = separators; *s; s++)
            if (stands_in_line(line, *s, quotes) && (*s != '|' || line[strspn(line, " ")] == '|') &&
                (*s != '&' || stands_in_line(line, '\\', quotes)))
                return *s;
    return ' ';
}

/* Whether numbers have a comma before their decimals, and none a point. */
static bool has_decimal_commas(const char *text, char separator)
{
    bool found = false;
    for (const char *at = text; separator != ',' && at[0] && at[1] && at[2]; at++) {
        const bool between = isdigit((unsigned char)at[0]) && isdigit((unsigned char)at[2]);
        if (between && at[1] == '.')
            return false;
        found |= between && at[1] == ',';
    }
    return found;
}

/* The heading of a table whose columns are apart by blanks: "L2 error" is one name where that makes
 * as many names as the first row has fields. */
static enum br_status take_heading(struct cursor *c, json_t *table, struct br_error *err)
{
    json_t *row;
    struct cursor apart = *c, next = *c;
    const char *comment;
    if (add_row(table, c->line, c->path, &row, err) || take_fields(c, row, err) ||
        c->separator != ' ')
        return err->status;
    json_t *wide = json_array(), *first = json_array();
    apart.blanks = 2;
    next.at = c->at;
    const bool failed = !wide || !first || json_array_append_new(wide, json_integer(0)) ||
                        json_array_append_new(first, json_integer(0)) ||
                        take_fields(&apart, wide, err) ||
                        (next_line(&next, &comment) && take_fields(&next, first, err));
    const size_t given = json_array_size(row), columns = json_array_size(first);
    if (!failed && given != columns && json_array_size(wide) == columns)
        for (size_t i = 0; i + 1 < given || i + 1 < columns; i++)
            i + 1 < columns ? json_array_set(row, i + 1, json_array_get(wide, i + 1))
                            : json_array_remove(row, columns);
    json_decref(wide);
    json_decref(first);
    return failed && !err->status ? br_no_memory(err, "the table") : err->status;
}

enum br_status br_table_split(const char *text, const char *path, bool only_last,
                              const struct br_observer *observer, json_t *table,
                              struct br_error *err)
{
    struct cursor c = {.path = path, .at = text, .line = 1, .blanks = 1};
    const char *comment = NULL, *none;
    if (!next_line(&c, &comment))
        return br_fail(err, BR_BAD_INPUT, "%s:1: the table is empty", path);
    c.separator = find_separator(c.at);
    c.decimal_comma = has_decimal_commas(text, c.separator);
    c.field = br_allocate(strlen(text) + 1, 1);
    err->status = BR_OK;
    enum br_status status = c.field ? take_heading(&c, table, err) : br_no_memory(err, "the table");
    if (!status && comment && has_data(table, 0)) {
        struct cursor above = c;
        json_t *heading =
            json_pack("[I]", json_integer_value(json_array_get(json_array_get(table, 0), 0)));
        above.at = comment;
        if (!heading || take_fields(&above, heading, err))
            status = heading ? err->status : br_no_memory(err, "the table");
        if (!status && json_array_size(heading) == fields(table, 0) + 1)
            status = json_array_insert(table, 0, heading) ? br_no_memory(err, "the table") : BR_OK;
        json_decref(heading);
    }
    while (!status && next_line(&c, &none)) {
        json_t *row;
        if (only_last)
            json_array_remove(table, 1);
        status = br_observer_stops(observer) ? br_fail(err, BR_INTERRUPTED, "interrupted")
                                             : add_row(table, c.line, c.path, &row, err);
        if (!status)
            status = take_fields(&c, row, err);
    }
    free(c.field);
    return status ? status : settle_heading(table, path, err);
}
