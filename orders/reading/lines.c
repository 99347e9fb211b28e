/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "orders/reading/lines.h"
#include "orders/reading/roles.h"

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
    *bytes = 3; /* of boxes, U+2500 to 257F; upright: 2502, 2503, 2506, 2507, 250A, 250B, 254E,
                   254F, 2551 */
    const bool upright =
        strchr(at[1] == '\x94' ? "\x82\x83\x86\x87\x8a\x8b" : "\x8e\x8f\x91", at[2]) != NULL;
    return upright ? BR_BOX_BAR : '-';
}

/* Quoted texts stay as they are, to the end of their line: they may be names. */
static void make_plain(char *text)
{
    char *to = text, before = '\n';
    bool quoted = false;
    for (size_t bytes; *text; before = text[bytes - 1], text += bytes) {
        bytes = 0;
        if (*text == '"' || *text == '\n')
            quoted = *text == '"' && !quoted && strchr("\n\t ,;|&", before);
        const char sign = *text == '\r' || (!quoted && (unsigned char)*text >= 0x80)
                              ? plain_sign(text, &bytes)
                              : 0;
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
    const size_t skipped = sign + strspn(line->text + sign, " \t");
    if (line->kind == BR_LINE_COMMENT) {
        line->text += skipped;
        line->indent += skipped;
    }
}

/* ---- lines ---- */

/* Skips a quoted text; returns its last quote; NULL: it is not closed. */
static const char *skip_quoted(const char *at)
{
    for (at++; *at && (*at != '"' || at[1] == '"'); at++)
        at += *at == '"';
    return *at ? at : NULL;
}

/* The end of a line, which quotes at the begin of a token may hold; NULL: one is open to the end.
 */
static const char *line_end(const char *at)
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

/* Skips the name of a log before a line, "DEAL:2d::cells". */
static char *skip_log_name(char *text)
{
    const size_t length =
        strspn(text, ":_0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ");
    for (size_t i = length; i > 2 && isalpha((unsigned char)*text); i--)
        if (strncmp(text + i - 2, "::", 2) == 0)
            return text + i;
    return text;
}

static void add_line(struct br_line *line, char *text, size_t number)
{
    const char *const begin = text;
    text = skip_log_name(text + strspn(text, " \t"));
    text += strspn(text, " \t");
    const size_t indent = (size_t)(text - begin);
    size_t length = strlen(text);
    while (length && text[length - 1] == ' ')
        text[--length] = '\0';
    *line = (struct br_line){text, number, indent, BR_LINE_EMPTY};
    find_kind(line);
}

/* The comment behind a row: behind numbers, and a blank; NULL: there is none. */
static char *comment_in(char *line)
{
    const char *equals = strchr(line, '=');
    const char *first = line + strspn(line, " \t|\x01\"+-.");
    equals = equals ? equals + 1 + strspn(equals + 1, " +-.") : "";
    char *const sign = strchr("#%!", *line) ? NULL : strstr(line, " #");
    return sign && !strchr(sign, '"') &&
                   (isdigit((unsigned char)*first) || isdigit((unsigned char)*equals))
               ? sign + 1
               : NULL;
}

/* Adds a line, or several: rows of LaTeX, a comment behind a row; returns how many. */
static size_t add_rows(struct br_line *line, char *text, size_t number)
{
    size_t count = 0;
    for (char *end; (end = row_end(text)); text = end) {
        *end = '\0';
        end += 2;
        end += *end == '[' ? strcspn(end, "]") + 1 : 0;
        add_line(&line[count++], text, number);
    }
    char *const comment = comment_in(text);
    if (comment)
        add_line(&line[count + 1], comment, number);
    if (comment)
        *comment = '\0';
    add_line(&line[count], text, number);
    return count + 1 + (comment != NULL);
}

/* A table that is a comment as a whole, as one in a program. */
static void uncomment(struct br_line *line, size_t count)
{
    size_t comments = 0;
    for (size_t i = 0; i < count; i++) {
        comments += line[i].kind == BR_LINE_COMMENT;
        if (line[i].kind == BR_LINE_TEXT)
            return;
    }
    for (size_t i = 0; i < count && comments > 2; i++) {
        const size_t sign = strspn(line[i].text, "#%! \t");
        line[i].text += sign;
        line[i].indent += sign;
        find_kind(&line[i]);
    }
}

enum br_status br_lines_cut(char *text, const char *path, struct br_store *store,
                            struct br_line **lines, size_t *count, struct br_error *err)
{
    make_plain(text);
    size_t most = 2;
    for (const char *c = text; *c; c++)
        most += *c == '\n' || *c == '#' || (c[0] == '\\' && c[1] == '\\');
    struct br_line *const line = br_store_take(store, most, sizeof *line);
    *lines = line;
    *count = 0;
    if (!line)
        return br_no_memory(err, "the table");
    size_t number = 1;
    for (char *at = text; *at;) {
        const char *const last = line_end(at);
        const size_t first = number;
        if (!last)
            return br_fail(err, BR_BAD_INPUT, "%s:%zu: a quote is never closed", path, number);
        char *const begin = at, *const end = at + (last - at);
        for (; at < end; at++)
            number += *at == '\n';
        number += *end == '\n';
        at += *end != '\0';
        *end = '\0';
        *count += add_rows(&line[*count], begin, first);
    }
    uncomment(line, *count);
    return BR_OK;
}

/* ---- tokens of a line ---- */

static bool is_blank(char c)
{
    return c == ' ' || c == '\t';
}

/* Whether a token ends here; *bytes (out): of what separates it from the next one. */
static bool ends_token(const char *begin, const char *at, enum br_separator by, size_t *bytes)
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

/* The end of a quoted token; NULL: it is not quoted. */
static const char *quoted_end(const char *at, enum br_separator by)
{
    const char *end = *at == '"' ? skip_quoted(at) : NULL;
    return end && (by < BR_BY_WIDE_BLANKS || !end[1] || is_blank(end[1])) ? end + 1 : NULL;
}

/* Where tokens of a line go. */
struct splitter {
    enum br_separator by;
    char mark, *room;
    struct br_token *token;
    size_t count;
    char *before; /* in a sentence, what stood before the last symbol of a size; NULL */
};

static char *copy(struct splitter *s, const char *begin, const char *end)
{
    char *const text = s->room;
    memcpy(text, begin, (size_t)(end - begin));
    text[end - begin] = '\0';
    s->room += end - begin + 1;
    return text;
}

/* A text in quotes, without these and the blanks around it, in place. */
static char *unquote(char *text)
{
    char *to = text;
    for (const char *at = text + 1; at[1]; at++) {
        at += *at == '"';
        *to++ = *at;
    }
    while (to > text && isspace((unsigned char)to[-1]))
        to--;
    *to = '\0';
    return text + strspn(text, " \t");
}

static void add_token(struct splitter *s, const char *begin, const char *end, const char *name)
{
    struct br_field_number number;
    const char *const close = quoted_end(begin, s->by);
    const bool quoted = close && close <= end;
    char *text = copy(s, begin, end);
    text = quoted && close == end ? unquote(text) : text;
    s->token[s->count++] = (struct br_token){text, name,
                                             quoted && close < end                   ? BR_BROKEN
                                             : !*text                                ? BR_NOTHING
                                             : br_field_is_missing(text)             ? BR_MISSING
                                             : br_field_read(text, s->mark, &number) ? BR_NUMBER
                                                                                     : BR_WORD};
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

/* The end of the sides of a mesh, "[8 8]" or "(8, 8)", that a token begins with; NULL: there are
 * none. */
static const char *sides_end(const char *at)
{
    const size_t size = *at && strchr("[(", *at) ? strspn(at + 1, "0123456789, ") : 0;
    return size && at[size + 1] == (*at == '[' ? ']' : ')') ? at + size + 2 : NULL;
}

/* The end of a norm, "||u||", that a token begins with; NULL: there is none. */
static const char *norm_end(const char *at)
{
    const bool begins = strncmp(at, "||", 2) == 0 && isalpha((unsigned char)at[2]);
    const char *const end = begins ? strchr(at + 2, '|') : NULL;
    return end && end[1] == '|' ? end + 2 : NULL;
}

static void split_signs(struct splitter *s, const char *at)
{
    const enum br_separator by = s->by;
    size_t bytes = 0;
    const bool bars = by == BR_BY_BARS;
    const bool begins = bars || (by == BR_BY_LONE_BARS && is_blank(at[*at != '\0']));
    at += (begins && *at == '|') || (by >= BR_BY_LONE_BARS && *at == BR_BOX_BAR);
    for (bool more = true; more && s->count <= BR_MOST_COLUMNS; at += more ? bytes : 0) {
        while (is_blank(*at) && (by != BR_BY_TABS || *at != '\t'))
            at++;
        const char *const begin = at, *end = bars ? norm_end(at) : NULL;
        end = end ? end : sides_end(at);
        end = end ? end : quoted_end(at, by);
        at = end ? end : at;
        while (*at && !(ends_token(begin, at, by, &bytes) &&
                        !(by == BR_BY_BLANKS && is_in_number(begin, at, bytes))))
            at++;
        for (end = at; end > begin && is_blank(end[-1]); end--)
            ;
        add_token(s, begin, end, NULL);
        more = *at && (by < BR_BY_WIDE_BLANKS || at[bytes]);
    }
}

/* The begin of the last name in a text from `at` to `end`: behind gaps, signs and numbers. */
static const char *begin_of_name(const char *at, const char *end)
{
    const char *begin = at;
    for (const char *word = at, *next; word < end; word = next) {
        const size_t length = strcspn(word, " \t");
        next = word + length + strspn(word + length, " \t");
        const bool no_name = strspn(word, "+-.:;,|\x01"
                                          "0123456789") >= length;
        const bool is_last = length && strchr(",;:|", word[length - 1]);
        const bool is_bar = length == 1 && strchr("|&", *word);
        if (is_bar || (next < end && (no_name || is_last || next > word + length + 1)))
            begin = next;
    }
    while (begin < end && strchr(",; \t\x01", *begin))
        begin++;
    return begin;
}

/* The end of a word without what ends a clause: ":", "." and a bracket that it does not open. */
static const char *end_of_word(const char *word, const char *end)
{
    const bool opens = memchr(word, '(', (size_t)(end - word)) != NULL;
    while (end > word && strchr(opens ? ":." : ":.)", end[-1]))
        end--;
    return end;
}

/* A number that is missing, and ends its clause: "error nan". */
static bool is_missing_at_end(const char *text, const char *behind)
{
    behind += strspn(behind, " \t");
    return isalpha((unsigned char)text[strspn(text, "+-")]) && br_field_is_missing(text) &&
           strchr(",;", *behind);
}

/* The end of a word, which may have a decimal comma, or be a time, "12:30". */
static const char *word_end(const struct splitter *s, const char *word)
{
    word += strcspn(word, s->by == BR_BY_COLONS ? " \t\x01,;=:" : " \t\x01,;=");
    const bool goes_on = *word == ':' || (*word == ',' && s->mark == ',');
    return goes_on && isdigit((unsigned char)word[-1]) && isdigit((unsigned char)word[1])
               ? word_end(s, word + 1)
               : word;
}

/* The value behind the sign of a pair between two places; NULL: there is no sign. */
static const char *signed_value(const struct splitter *s, const char *from, const char *to)
{
    const char *const sign =
        s->by == BR_BY_WORDS ? NULL
                             : memchr(from, s->by == BR_BY_EQUALS ? '=' : ':', (size_t)(to - from));
    return sign ? sign + 1 + strspn(sign + 1, " \t\x01=") : NULL;
}

/* The next value among the words from `at` to its end: a number, one that is missing, or whatever
 * stands behind the sign of a pair; *behind (out): its end. NULL: there is none. */
static const char *next_value(const struct splitter *s, const char *at, const char **behind)
{
    struct br_field_number number;
    for (const char *word = at; *word; word = *behind) {
        char text[64];
        const char *const plain = word + strspn(word, " \t\x01,;:=("), *const value = signed_value(
                                                                           s, word, plain);
        word = value ? value : plain;
        const char *const sides = sides_end(word);
        *behind = sides ? sides : word_end(s, word);
        for (size_t blanks; (blanks = strspn(*behind, " ")) && is_in_number(word, *behind, blanks);)
            *behind = word_end(s, *behind + blanks);
        const long length = end_of_word(word, *behind) - word;
        snprintf(text, sizeof text, "%.*s", length > 0 && length < 64 ? (int)length : 0, word);
        if (value || br_field_read(text, s->mark, &number) || is_missing_at_end(text, *behind))
            return word;
    }
    return NULL;
}

/* Whether a word from `at` to `end` is one of the words. */
static bool is_one_of(const char *words, const char *at, const char *end)
{
    char word[16];
    snprintf(word, sizeof word, " %.*s ", end - at < 12 ? (int)(end - at) : 12, at);
    return strcasestr(words, word);
}

/* Whether a name without its last word says that this one is a size: it is nothing of its own, as
 * "Running" before "dt", or "error for" before "n"; but the "error in" h is an error. */
static bool is_of_a_size(const char *name, const char *last)
{
    const char *const before = memrchr(name, ' ', (size_t)(last - name));
    return !br_kind_of(name) || (before && is_one_of(" for at with ", before + 1, last));
}

static const char verbs[] = " is was are were equals of ";

/* Moves the ends of a name inwards, past blanks, signs, and words that only join a sentence, as in
 * "and the H1 error is"; but a name has one word. */
static void trim_name(const char **at, const char **end)
{
    static const char joins[] = " and the its with for of at on in then so has gives ";
    while (*end > *at && strchr(" \t=:,(", (*end)[-1]))
        --*end;
    for (const char *next;
         (next = memchr(*at, ' ', (size_t)(*end - *at))) && is_one_of(joins, *at, next);)
        *at = next + strspn(next, " ");
    for (const char *last;
         (last = memrchr(*at, ' ', (size_t)(*end - *at))) && is_one_of(verbs, last + 1, *end);)
        for (*end = last; (*end)[-1] == ' ';)
            --*end;
}

/* A name from `at` to `end`. The symbol of a size at its end is the name, whatever a sentence has
 * before it. */
static const char *copy_name(struct splitter *s, const char *at, const char *end)
{
    const size_t longest_symbol = 2;
    trim_name(&at, &end);
    char *const name = copy(s, at, end), *const last = strrchr(name, ' ');
    const bool is_symbol = last && strlen(last + 1) <= longest_symbol &&
                           br_size_name_odds(last + 1) >= BR_USUAL_NAME && is_of_a_size(name, last);
    if (!is_symbol)
        return name;
    *last = '\0';
    s->before = name;
    return last + 1;
}

/* The name of a number behind a verb: "Error" of "Error for n = 10 is", without the word that joins
 * it to the size. */
static const char *name_of_verb(const struct splitter *s, const char *verb)
{
    char *const join = s->before ? strrchr(s->before, ' ') : NULL;
    if (!join || !is_one_of(verbs, verb, verb + strlen(verb)))
        return verb;
    *join = '\0';
    return s->before;
}

/* The word behind a number that ends its clause: "64 cells,". *behind: the end of the number, then
 * of the word. Empty: there is none. */
static const char *name_behind(struct splitter *s, const char **behind)
{
    const char *const word = *behind + strspn(*behind, " \t");
    size_t length = 0;
    while (isalpha((unsigned char)word[length]))
        length++;
    const char *const end = word + length + (word[length] == ')');
    if (word == *behind || !length || (*end && !strchr(",;:", *end)))
        return "";
    *behind = end;
    return copy(s, word, word + length);
}

/* The word behind a number that a preposition joins to an error, "Error after 10 steps is": it is
 * the name of the number, and the error that of the next one. Empty: there is no such word. */
static const char *name_behind_joined(struct splitter *s, const char *name, const char **behind)
{
    const char *const word = *behind + strspn(*behind, " \t");
    const char *end = word;
    while (isalpha((unsigned char)*end))
        end++;
    s->before = copy(s, name, name + strlen(name));
    *behind = end;
    return copy(s, word, end);
}

static bool joins_error(const char *name)
{
    const char *const last = strrchr(name, ' ');
    return last && br_kind_of(name) == BR_KIND_ERROR &&
           is_one_of(" after for at with on using ", last + 1, name + strlen(name));
}

/* The name with the unit that ends the clause of a number, as a heading has it: lines with other
 * units have other names. *at: behind the number, then behind the unit. */
static const char *add_unit(struct splitter *s, const char *name, const char **at)
{
    char unit[16];
    const char *const word = *at + strspn(*at, " \t");
    const size_t length = strcspn(word, " \t,;:");
    snprintf(unit, sizeof unit, "%.*s", length < sizeof unit ? (int)length : 0, word);
    if (word == *at || !br_is_unit(unit) ||
        (is_blank(word[length]) && !is_blank(word[length + 1])) ||
        (word[length] == ':' && s->by == BR_BY_COLONS))
        return name;
    *at = word + length;
    const char *const whole = s->room;
    s->room += sprintf(s->room, "%s [%s]", name, unit) + 1;
    return whole;
}

/* Whether the number before `at` has an exponent behind a blank: "2.3 e-2". */
static bool has_exponent_behind(const char *at)
{
    at += strspn(at, " \t");
    const char *const digits = *at && strchr("eEdD", *at) ? at + 1 + strspn(at + 1, "+-") : "";
    return isdigit((unsigned char)*digits);
}

/* Values in a sentence, each named by the words before it: "N = 16: error 1.2e-2". In front may be
 * a time, or a label: "10: e = 0.1". Whether all of them have a name. */
static bool split_sentence(struct splitter *s, const char *at)
{
    at += *at == '[' && strchr(at, ']') ? strcspn(at, "]") + 1 : 0;
    const char *behind = at;
    for (const char *next; (next = next_value(s, behind, &behind)); at = behind) {
        const char *const begin = begin_of_name(at, next);
        const char *name = copy_name(s, begin + (*begin == '('), next);
        const char *const last = end_of_word(next, behind);
        name = joins_error(name) ? name_behind_joined(s, name, &behind)
               : *name           ? name_of_verb(s, name)
                                 : name_behind(s, &behind);
        if ((!*name && s->count) || s->count > BR_MOST_COLUMNS || has_exponent_behind(behind))
            return false;
        name = add_unit(s, name, &behind);
        add_token(s, next, last, name);
    }
    return true;
}

size_t br_line_stated(const char *line, enum br_separator by, char mark, char *room,
                      struct br_token *token, bool *whole)
{
    struct splitter s = {by <= BR_BY_COLONS ? by : BR_BY_WORDS, mark, room, token, 0, NULL};
    *whole = split_sentence(&s, line);
    return s.count;
}

size_t br_line_split(const char *line, enum br_separator by, char mark, char *room,
                     struct br_token *token)
{
    struct splitter s = {by, mark, room, token, 0, NULL};
    if (by <= BR_BY_COLONS) {
        const bool has_sign = by == BR_BY_WORDS || strchr(line, by == BR_BY_EQUALS ? '=' : ':');
        return has_sign && split_sentence(&s, line) ? s.count : 0;
    }
    split_signs(&s, line);
    return s.count;
}
