/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "study/reading/lines.h"
#include "study/reading/reading.h"

/* ---- signs of a text ---- */

/* The letter that stands for the sign of a text that begins here, and its bytes; zero: there is
 * none, and the bytes stay, or go where there are some. */
static char plain_sign(const char *at, size_t *bytes)
{
    static const char *const blanks[] = {"\u00a0", "\u2002", "\u2003", "\u2007", "\u2009",
                                         "\u200a", "\u202f", "\u3000", "\r\n"};
    for (size_t i = 0; i < sizeof blanks / sizeof *blanks; i++)
        if (strncmp(at, blanks[i], strlen(blanks[i])) == 0) {
            *bytes = strlen(blanks[i]);
            return *at == '\r' ? '\n' : ' ';
        }
    *bytes = strncmp(at, "\ufeff", 3) == 0 || strncmp(at, "\u200b", 3) == 0 ? 3 : 0;
    if (*bytes || strncmp(at, "\xe2\x94", 2) * strncmp(at, "\xe2\x95", 2) != 0 || !at[2])
        return 0;
    *bytes = 3; /* of boxes, U+2500 to 257F; upright: 2502, 2503, 2506, 2507, 250A, 250B, 2551 */
    const bool upright =
        at[1] == '\x94' ? strchr("\x82\x83\x86\x87\x8a\x8b", at[2]) != NULL : at[2] == '\x91';
    return upright ? BR_BOX_BAR : '-';
}

static void make_plain(char *text)
{
    char *to = text;
    for (size_t bytes; *text; text += bytes) {
        bytes = 0;
        const char sign =
            *text == '\r' || (unsigned char)*text >= 0x80 ? plain_sign(text, &bytes) : 0;
        if (!bytes) {
            *to++ = *text == '\r' ? '\n' : *text;
            bytes = 1;
        } else if (sign)
            *to++ = sign;
    }
    *to = '\0';
}

/* ---- kinds of lines ---- */

/* Whether a line has the types of columns alone, as Julia, polars and R print them. */
static bool has_types(const char *line)
{
    static const char types[] = " Int64 Int32 Float64 Float32 String Bool Date DateTime i8 i16 i32 "
                                "i64 u8 u16 u32 u64 f32 f64 str bool date <dbl> <int> <chr> <lgl> "
                                "<fct> <date> <dttm> ";
    static const char between[] = " |?\t\x01";
    for (line += strspn(line, between); *line; line += strspn(line, between)) {
        char word[16];
        const size_t length = strcspn(line, between);
        snprintf(word, sizeof word, " %.*s ", length < 12 ? (int)length : 12, line);
        if (!strstr(types, word))
            return false;
        line += length;
    }
    return true;
}

/* Skips a command that lays out LaTeX, with what it is given; NULL: there is none. */
static char *skip_command(char *line)
{
    static const char commands[] =
        " \\hline \\toprule \\midrule \\bottomrule \\cline \\cmidrule \\begin \\end \\centering "
        "\\label \\addlinespace \\rowcolor \\noalign \\small \\footnotesize \\scriptsize \\tiny ";
    char word[20];
    const size_t letters = *line == '\\' ? strspn(line + 1, "abcdefghijklmnopqrstuvwxyz") : 0;
    snprintf(word, sizeof word, " %.*s ", letters < 16 ? (int)letters + 1 : 17, line);
    if (!letters || !strstr(commands, word))
        return NULL;
    line += letters + 1;
    while (*line && strchr("{[(", *line)) {
        line += strcspn(line, "}])");
        line += *line != '\0';
    }
    return line + strspn(line, " \t");
}

/* Finds the kind of a line without the blanks around it. */
static void find_kind(struct br_line *line)
{
    static const char rules[] = "-+=|:_*~.,; \t&\x01";
    for (char *rest; (rest = skip_command(line->text));)
        line->text = rest;
    const size_t sign = strncmp(line->text, "//", 2) == 0 ? 2 : strspn(line->text, "#%!");
    const char *const excel = line->text + (*line->text == '"');
    const bool is_separator = strncmp(excel, "sep=", 4) == 0 && strlen(excel) <= 6;
    line->kind = is_separator || line->text[strspn(line->text, rules)] == '\0' ||
                         line->text[sign + strspn(line->text + sign, rules)] == '\0' ||
                         has_types(line->text)
                     ? BR_LINE_EMPTY
                 : sign ? BR_LINE_COMMENT
                        : BR_LINE_TEXT;
    if (line->kind == BR_LINE_COMMENT)
        line->text += sign + strspn(line->text + sign, " \t");
}

/* ---- lines ---- */

/* Skips a quoted text; returns its last quote; NULL: it is not closed. */
static char *skip_quoted(char *at)
{
    for (at++; *at && (*at != '"' || at[1] == '"'); at++)
        at += *at == '"';
    return *at ? at : NULL;
}

/* The end of a line, which quotes at the begin of a piece may hold; NULL: one is open to the end.
 */
static char *line_end(char *at)
{
    const bool quotes = !strchr("#%!", at[strspn(at, " \t")]) || !*at;
    char before = ',';
    for (; *at && *at != '\n'; at++) {
        if (*at == '"' && quotes && strchr(",;\t|&\x01", before) && !(at = skip_quoted(at)))
            return NULL;
        before = *at == ' ' ? before : *at;
    }
    return at;
}

/* Where a row of LaTeX ends in a line: at "\\"; NULL: it does not. */
static char *row_end(char *line)
{
    return strchr(line, '&') ? strstr(line, "\\\\") : NULL;
}

static void add_line(struct br_line *line, char *text, size_t number)
{
    text += strspn(text, " \t");
    size_t length = strlen(text);
    while (length && text[length - 1] == ' ')
        text[--length] = '\0';
    *line = (struct br_line){text, number, BR_LINE_EMPTY};
    find_kind(line);
}

/* Adds a line, or several: rows of LaTeX; returns how many, of which one is kept for the next. */
static size_t add_rows(struct br_line *line, char *text, size_t number)
{
    size_t count = 0;
    for (char *end; (end = row_end(text)); text = end) {
        *end = '\0';
        end += 2;
        end += *end == '[' ? strcspn(end, "]") + 1 : 0;
        add_line(&line[count++], text, number);
    }
    add_line(&line[count], text, number);
    return count + 1;
}

enum br_status br_lines_cut(char *text, const char *path, struct br_store *store,
                            struct br_line **lines, size_t *count, struct br_error *err)
{
    make_plain(text);
    size_t most = 2;
    for (const char *c = text; *c; c++)
        most += *c == '\n' || (c[0] == '\\' && c[1] == '\\');
    struct br_line *const line = br_store_take(store, most, sizeof *line);
    *lines = line;
    *count = 0;
    if (!line)
        return br_no_memory(err, "the table");
    size_t number = 1;
    for (char *at = text; *at;) {
        char *const end = line_end(at), *const begin = at;
        const size_t first = number;
        if (!end)
            return br_fail(err, BR_BAD_INPUT, "%s:%zu: a quote is open to the end", path, number);
        for (; at < end; at++)
            number += *at == '\n';
        number += *end == '\n';
        at += *end != '\0';
        *end = '\0';
        *count += add_rows(&line[*count], begin, first);
    }
    return BR_OK;
}

/* ---- pieces of a line ---- */

static bool is_blank(char c)
{
    return c == ' ' || c == '\t';
}

/* Whether a piece ends here; *bytes (out): of what separates it from the next one. */
static bool ends_piece(const char *begin, const char *at, enum br_separator by, size_t *bytes)
{
    static const char signs[] = {
        [BR_BY_TABS] = '\t',      [BR_BY_LONE_BARS] = '|',  [BR_BY_BARS] = '|',
        [BR_BY_AMPERSANDS] = '&', [BR_BY_SEMICOLONS] = ';', [BR_BY_COMMAS] = ','};
    *bytes = 1;
    if (by == BR_BY_LONE_BARS && *at == '|')
        return (at == begin || is_blank(at[-1])) && (!at[1] || is_blank(at[1]));
    if (by < BR_BY_WIDE_BLANKS)
        return (*at == signs[by] && (at == begin || at[-1] != '\\')) ||
               ((by == BR_BY_BARS || by == BR_BY_LONE_BARS) && *at == BR_BOX_BAR);
    *bytes = strspn(at, " \t\x01");
    return at > begin && (*bytes >= (by == BR_BY_BLANKS ? 1 : 2) || (*bytes && *at != ' '));
}

/* The end of a quoted piece; NULL: it is not quoted. */
static char *quoted_end(char *at, enum br_separator by)
{
    char *end = *at == '"' ? skip_quoted(at) : NULL;
    return end && (by < BR_BY_WIDE_BLANKS || !end[1] || is_blank(end[1])) ? end + 1 : NULL;
}

/* Whether the blanks at `at` stand in a number: "1.0 x 10^-2", "1.2 +- 0.1", "5 %". */
static bool is_in_number(const char *begin, const char *at, size_t blanks)
{
    static const char *const signs[] = {"x",  "*",   "\u00d7", "\u00b7", "\\times", "\\cdot",
                                        "+-", "+/-", "\u00b1", "\\pm",   "%",       "\\%"};
    const char *const next = at + blanks;
    for (size_t i = 0; i < sizeof signs / sizeof *signs; i++) {
        const size_t size = strlen(signs[i]);
        const bool ahead = strncmp(next, signs[i], size) == 0 && isdigit((unsigned char)at[-1]);
        if (ahead && (strchr(signs[i], '%')
                          ? !next[size] || is_blank(next[size])
                          : is_blank(next[size]) &&
                                isdigit((unsigned char)next[size + strspn(next + size, " ")])))
            return true;
        if (!strchr(signs[i], '%') && at - begin > (long)size + 1 &&
            is_blank(at[-(long)size - 1]) && strncmp(at - size, signs[i], size) == 0 &&
            isdigit((unsigned char)*next) && isdigit((unsigned char)*begin))
            return true;
    }
    return false;
}

static size_t split_signs(char *at, enum br_separator by, struct br_piece *piece)
{
    size_t count = 0, bytes = 0;
    const bool bars = by == BR_BY_BARS || (by == BR_BY_LONE_BARS && is_blank(at[*at != '\0']));
    at += (bars && *at == '|') || (by >= BR_BY_LONE_BARS && *at == BR_BOX_BAR);
    for (bool more = true; more && count <= BR_MOST_COLUMNS; at += more ? bytes : 0) {
        while (is_blank(*at) && (by != BR_BY_TABS || *at != '\t'))
            at++;
        char *const begin = at, *end = quoted_end(at, by);
        at = end ? end : at;
        while (*at && !(ends_piece(begin, at, by, &bytes) &&
                        !(by == BR_BY_BLANKS && is_in_number(begin, at, bytes))))
            at++;
        for (end = at; end > begin && is_blank(end[-1]); end--)
            ;
        piece[count++] = (struct br_piece){begin, NULL, (size_t)(end - begin), 0};
        more = *at && (by < BR_BY_WIDE_BLANKS || at[bytes]);
    }
    return count;
}

/* The begin of the last name in a text from `at` to `end`: behind gaps, signs and numbers. */
static char *begin_of_name(char *at, const char *end)
{
    char *begin = at;
    for (char *word = at; word < end;) {
        const size_t length = strcspn(word, " \t");
        char *const next = word + length + strspn(word + length, " \t");
        const bool no_name = strspn(word, "+-.:;,|\x01"
                                          "0123456789") >= length;
        const bool is_last = length && strchr(",;:|", word[length - 1]);
        if (next < end && (no_name || is_last || next > word + length + 1))
            begin = next;
        word = next;
    }
    while (begin < end && strchr(",; \t\x01", *begin))
        begin++;
    return begin;
}

/* The last word from `at` to `end` that is a number, as a piece with what is before it as its name;
 * length 0: there is none. */
static struct br_piece last_number(char *at, const char *end)
{
    struct br_piece last = {at, at, 0, 0};
    struct br_field_number number;
    char text[64];
    for (char *word = at; word < end;) {
        word += strspn(word, " \t,;:");
        size_t length = strcspn(word, " \t,;:");
        length = word + length <= end ? length : word < end ? (size_t)(end - word) : 0;
        snprintf(text, sizeof text, "%.*s", (int)(length < 63 ? length : 0), word);
        if (length && br_field_read(text, '.', &number))
            last = (struct br_piece){word, at, length, (size_t)(word - at)};
        word += length;
    }
    while (last.name_length && is_blank(last.name[last.name_length - 1]))
        last.name_length--;
    return last;
}

/* Pieces "name = value"; a value is one word. Before the first one may be a label, "step 3:". Other
 * numbers between or behind them are no pairs. */
static size_t split_pairs(char *at, char sign, struct br_piece *piece)
{
    size_t count = 0;
    at += *at == '[' && strchr(at, ']') ? strcspn(at, "]") + 1 : 0; /* a time */
    for (char *equals; (equals = strchr(at, sign)) && count <= BR_MOST_COLUMNS;) {
        char *name = begin_of_name(at, equals), *end = equals;
        const struct br_piece label = last_number(at, name);
        if (label.length && (count > 0 || label.name_length + label.length > 60))
            return 0;
        if (label.length)
            piece[count++] = label;
        while (end > name && is_blank(end[-1]))
            end--;
        char *value = equals + 1 + strspn(equals + 1, " \t");
        at = value;
        while (*at && !is_blank(*at) && *at != BR_BOX_BAR &&
               !(strchr(",;", *at) && !isdigit((unsigned char)at[1])))
            at++;
        size_t length = (size_t)(at - value);
        length -= length && value[length - 1] == ':';
        piece[count++] = (struct br_piece){value, name, length, (size_t)(end - name)};
        if (strspn(name, " +-.0123456789") >= (size_t)(end - name))
            return 0; /* a time, as 12:30 */
    }
    return last_number(at, at + strlen(at)).length ? 0 : count;
}

size_t br_line_split(char *line, enum br_separator by, struct br_piece *piece)
{
    return by == BR_BY_EQUALS   ? split_pairs(line, '=', piece)
           : by == BR_BY_COLONS ? split_pairs(line, ':', piece)
                                : split_signs(line, by, piece);
}

char *br_piece_close(const struct br_piece *piece, enum br_separator by)
{
    char *const text = piece->text, *to = text;
    char *const end = text + piece->length;
    char *const close = quoted_end(text, by);
    if (!close || close > end) {
        *end = '\0';
        return text;
    }
    if (close < end)
        return NULL;
    for (char *at = text + 1; at < close - 1; at++) {
        at += *at == '"';
        *to++ = *at;
    }
    while (to > text && isspace((unsigned char)to[-1]))
        to--;
    *to = '\0';
    return text + strspn(text, " \t");
}
