/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The fields of a table, as programs, spreadsheets and people write it: separated by commas, tabs,
 * semicolons, bars, ampersands or blanks. */
#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "study/base/words.h"
#include "study/orders/request.h"

/* The position in a text. */
struct cursor {
    const char *path, *at;
    char separator;  /* ' ': any number of blanks */
    size_t blanks;   /* how many, at least, where the separator is a blank */
    char mark;       /* of decimals, as the first number has it; zero: none has it yet */
    size_t doubtful; /* the line of "1,089", which may be 1089; 0: there is none, or 0,5 is there */
    bool commas;     /* a number can only have a decimal comma */
    size_t line;
    char *field; /* a buffer for the longest one; owned */
};

/* ---- lines ---- */

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

/* Whether a line has the types of columns alone, as Julia, polars and R print them. */
static bool has_types(const char *line, const char *end)
{
    static const char types[] = " Int64 Float64 String i64 i32 u32 f64 str <dbl> <int> <chr> ";
    for (line += strspn(line, " |"); line < end; line += strspn(line, " |\t\r")) {
        char word[12];
        const size_t length = strcspn(line, " |\t\r\n");
        snprintf(word, sizeof word, " %.*s ", length < 9 ? (int)length : 9, line);
        if (!strstr(types, word))
            return false;
        line += length;
    }
    return true;
}

/* Lines between rows, and LaTeX's commands. */
static bool is_rule(const char *line, const char *end)
{
    if (*line == '\\' || has_types(line, end))
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

/* A comma before decimals becomes a point. Refuses commas beside points: one of them may stand
 * before thousands. */
static enum br_status take_decimals(struct cursor *c, size_t line, struct br_error *err)
{
    char *equals = strrchr(c->field, '='), *number = equals ? equals + 1 : c->field;
    number += strspn(number, " \t");
    char *mark = number + strspn(number, "+-0123456789");
    if (mark == number || (*mark != ',' && *mark != '.') || !isdigit((unsigned char)mark[1]))
        return BR_OK;
    const size_t digits = strspn(mark + 1, "0123456789");
    if (c->mark && c->mark != *mark)
        return br_fail(err, BR_BAD_INPUT,
                       "%s:%zu: found '%.40s' beside numbers with '%c', expected one sign before "
                       "decimals, and none before thousands",
                       c->path, line, number, c->mark);
    c->mark = *mark;
    if (*mark != ',')
        return BR_OK;
    const bool thousands = digits == 3 && !mark[4] && *number != '0' && mark - number <= 3;
    c->doubtful = c->doubtful || !thousands ? c->doubtful : line;
    c->commas |= !thousands;
    *mark = '.';
    return BR_OK;
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
    if (take_decimals(c, line, err))
        return err->status;
    json_t *field = *c->field ? json_string_nocheck(c->field) : json_null();
    return json_array_append_new(row, field) ? br_no_memory(err, "the table") : BR_OK;
}

static const char *field(const json_t *table, size_t row, size_t column)
{
    return json_string_value(json_array_get(json_array_get(table, row), column));
}

static size_t fields(const json_t *table, size_t row)
{
    const size_t size = json_array_size(json_array_get(table, row));
    return size ? size - 1 : 0;
}

/* Adds a line to a table, as a row. A separator at the end is none. Fails where it is one row, or
 * one field, too many. */
static enum br_status take_row(struct cursor *c, json_t *table, struct br_error *err)
{
    const size_t line = c->line, rows = json_array_size(table), columns = fields(table, 0);
    json_t *row = json_pack("[I]", (json_int_t)line);
    if (json_array_append_new(table, row))
        return br_no_memory(err, "the table");
    if (rows > BR_MOST_ROWS)
        return br_fail(err, BR_BAD_INPUT, "%s:%zu: found row %zu, expected at most %d", c->path,
                       line, rows, BR_MOST_ROWS);
    if (rows * columns > BR_MOST_FIELDS)
        return br_fail(err, BR_BAD_INPUT,
                       "%s:%zu: found row %zu of %zu fields, expected at most %d "
                       "fields in all",
                       c->path, line, rows, columns, BR_MOST_FIELDS);
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

static size_t numbers(const json_t *table, size_t row)
{
    double value;
    size_t count = 0;
    for (size_t i = 1; i <= fields(table, row); i++) {
        const char *text = field(table, row, i);
        count += !br_is_missing(text) && br_table_number(text, &value);
    }
    return count;
}

/* Whether a row has more numbers than words. */
static bool has_data(const json_t *table, size_t row)
{
    size_t words = 0;
    for (size_t i = 1; i <= fields(table, row); i++)
        words += !br_is_missing(field(table, row, i));
    return 2 * numbers(table, row) > words;
}

/* Whether all fields of a row are "h = 0.5". */
static bool has_pairs(const json_t *table, size_t row)
{
    double number;
    for (size_t i = 1; i <= fields(table, row); i++) {
        const char *text = field(table, row, i), *equals = text ? strchr(text, '=') : NULL;
        const char *first = equals ? equals + 1 + strspn(equals + 1, " \t") : NULL;
        if (!first || !(br_is_missing(first) || br_table_number(first, &number)))
            return false;
    }
    return fields(table, row) > 0;
}

/* Whether the names of this line stand in groups above those of the next one. */
static bool has_groups(const json_t *table, size_t row)
{
    const size_t above = fields(table, row), below = fields(table, row + 1);
    const char *first = field(table, row, 1);
    return above > 0 && below > above && below % above == 0 && !numbers(table, row) &&
           !numbers(table, row + 1) && !(first && strchr(first, ':'));
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
 * row, as pandas and R print it, and rates, which are '-' in the first row, as deal.II prints them.
 */
static enum br_status name_columns(json_t *table, struct br_error *err)
{
    json_t *heading = json_array_get(table, 0);
    const size_t names = fields(table, 0), columns = fields(table, 1);
    const char *first = field(table, 1, 1), *second = field(table, 2, 1);
    const bool counted = first && (strcmp(first, "0") == 0 ||
                                   (strcmp(first, "1") == 0 && second && strcmp(second, "2") == 0));
    size_t rates = 0;
    bool failed = false;
    for (size_t i = 1; i <= columns; i++)
        rates += field(table, 1, i) && strcmp(field(table, 1, i), "-") == 0;
    if (columns == names + 1 && counted)
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
    if (!has_pairs(table, 0))
        return BR_OK;
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

/* The positions of columns are their names where the first row is one of numbers. */
static enum br_status name_positions(json_t *table, struct br_error *err)
{
    json_t *heading = json_pack("[O]", json_array_get(json_array_get(table, 0), 0));
    bool failed = json_array_insert_new(table, 0, heading) != 0;
    for (size_t i = 1; i <= fields(table, 1) && !failed; i++)
        failed = json_array_append_new(heading, json_sprintf("%zu", i)) != 0;
    return failed ? br_no_memory(err, "the table") : BR_OK;
}

static enum br_status settle_heading(json_t *table, const char *path, struct br_error *err)
{
    json_t *last = json_array_get(table, 0);
    while (fields(table, 0) > 1 && json_is_null(json_array_get(last, fields(table, 0))))
        json_array_remove(last, fields(table, 0));
    if (name_pairs(table, path, err) || (has_data(table, 0) && name_positions(table, err)))
        return err->status;
    if (has_groups(table, 0) && has_data(table, 2) && join_headings(table, err))
        return err->status;
    for (size_t i = 1; i < json_array_size(table); i++)
        trim(table, i);
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

/* Whether a bar stands alone in the line, as in Markdown without bars at its ends. */
static bool has_bars(const char *line)
{
    const char *bar = strstr(line, " | ");
    return bar && bar < line + strcspn(line, "\n");
}

/* What separates the fields of a line. Bars stand in names, too, and LaTeX's lines end with \\. */
static char find_separator(const char *line)
{
    static const char separators[] = "\t|&;,";
    for (int quotes = 1; quotes >= 0; quotes--)
        for (const char *s = separators; *s; s++)
            if (stands_in_line(line, *s, quotes) &&
                (*s != '|' || line[strspn(line, " ")] == '|' || has_bars(line)) &&
                (*s != '&' || stands_in_line(line, '\\', quotes)))
                return *s;
    return ' ';
}

/* The heading of a table whose columns are apart by blanks: "L2 error" is one name where that makes
 * as many names as the first row has fields. */
static enum br_status take_heading(struct cursor *c, json_t *table, struct br_error *err)
{
    struct cursor apart = *c, next;
    const char *comment;
    if (take_row(c, table, err) || c->separator != ' ')
        return err->status;
    json_t *wide = json_array(), *first = json_array();
    apart.blanks = 2;
    next = *c;
    const bool failed =
        take_row(&apart, wide, err) || (next_line(&next, &comment) && take_row(&next, first, err));
    const size_t given = fields(table, 0), columns = fields(first, 0);
    if (!failed && given != columns && fields(wide, 0) == columns)
        json_array_set(table, 0, json_array_get(wide, 0));
    json_decref(wide);
    json_decref(first);
    return err->status;
}

/* Copies a text with lines of boxes as bars and dashes; a bar alone in its line is a blank. */
static char *without_boxes(const char *text)
{
    char *copy = br_allocate(strlen(text) + 1, 1), *to = copy, *bar = NULL;
    size_t bars = 0;
    for (; copy && *text; text++) {
        const bool box = strncmp(text, "\xe2\x94", 2) == 0 || strncmp(text, "\xe2\x95", 2) == 0;
        if (box && text[2]) { /* U+2500 to 257F; upright: 2502, 2503, 2506, 250A, 2551 */
            const char code = text[2];
            const bool upright =
                text[1] == '\x94' ? strchr("\x82\x83\x86\x8a", code) != NULL : code == '\x91';
            bar = upright ? to : bar;
            bars += upright;
            *to++ = upright ? '|' : '-';
            text += 2;
        } else
            *to++ = *text;
        if (*text == '\n' || !text[1]) {
            if (bars == 1)
                *bar = ' ';
            bars = 0;
        }
    }
    return copy;
}

/* Skips titles: lines above the heading, or above rows of pairs, with another number of fields or
 * with a number. */
static enum br_status skip_titles(struct cursor *c, const char **comment, struct br_error *err)
{
    for (bool title = true; title && !err->status;) {
        struct cursor ahead = *c;
        const char *below_title = NULL, *none;
        bool more = true;
        json_t *lines = json_array();
        for (int i = 0; i < 3 && more && !err->status; i++) {
            ahead.separator = find_separator(ahead.at);
            if (!take_row(&ahead, lines, err))
                more = next_line(&ahead, i ? &none : &below_title);
        }
        const size_t above = fields(lines, 0), below = fields(lines, 1);
        title = !has_pairs(lines, 0) &&
                (has_pairs(lines, 1) || (above == 1 && below > 2 && !has_data(lines, 1)) ||
                 (above != below && below_title && !numbers(lines, 0) && has_data(lines, 1)) ||
                 ((above != below || numbers(lines, 0)) && below > 1 && !numbers(lines, 1) &&
                  has_data(lines, 2) && !has_groups(lines, 0)));
        json_decref(lines);
        c->at += title ? strcspn(c->at, "\n") : 0;
        if (title)
            next_line(c, comment);
        c->separator = find_separator(c->at);
    }
    return err->status;
}

enum br_status br_table_split(const char *text, const char *path, bool only_last,
                              const struct br_observer *observer, json_t *table,
                              struct br_error *err)
{
    char *copy = without_boxes(text);
    struct cursor c = {.path = path, .at = copy, .line = 1, .blanks = 1};
    const char *comment = NULL, *none;
    c.field = copy ? br_allocate(strlen(copy) + 1, 1) : NULL;
    err->status = BR_OK;
    enum br_status status = !c.field ? br_no_memory(err, "the table")
                            : !next_line(&c, &comment)
                                ? br_fail(err, BR_BAD_INPUT, "%s:1: the table is empty", path)
                            : skip_titles(&c, &comment, err) ? err->status
                                                             : take_heading(&c, table, err);
    if (!status && comment && has_data(table, 0)) {
        json_t *names = json_array();
        struct cursor above = c;
        above.at = comment;
        if (!take_row(&above, names, err) && fields(names, 0) == fields(table, 0) &&
            !numbers(names, 0) && json_array_insert(table, 0, json_array_get(names, 0)))
            br_no_memory(err, "the table");
        status = err->status;
        json_decref(names);
    }
    while (!status && next_line(&c, &none)) {
        if (only_last)
            json_array_remove(table, 1);
        status = br_observer_stops(observer) ? br_fail(err, BR_INTERRUPTED, "interrupted")
                                             : take_row(&c, table, err);
    }
    if (!status && c.doubtful && !c.commas)
        status = br_fail(err, BR_BAD_INPUT,
                         "%s:%zu: found a comma before three digits only, expected no sign before "
                         "thousands, or a point before decimals",
                         path, c.doubtful);
    free(c.field);
    free(copy);
    return status ? status : settle_heading(table, path, err);
}
