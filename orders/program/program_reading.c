/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <regex.h>
#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "base/quote.h"
#include "base/words.h"
#include "orders/request.h"

enum {
    SHOWN = 80,          /* bytes of foreign text in a message */
    LONGEST = 64,        /* bytes of a number, with the zero at the end */
    MOST_LETTERS = 1000, /* of a regular expression, also with its repetitions written out */
    LONGEST_LINE = 8192  /* bytes of a line in which an expression is searched for */
};

/* A reading of one output. */
struct search {
    const struct br_reading *reading;
    const struct br_orders_request *request; /* its limit of time, and its observer */
    char *output;                            /* owned */
    size_t length;
    regex_t regex;
    double began, compiled; /* when the search began, and when its expression was compiled, s */
    char text[LONGEST];     /* out: the number as it is written there */
    struct br_error *err;
};

__attribute__((format(printf, 2, 3))) static enum br_status refuse(const struct search *s,
                                                                   const char *format, ...)
{
    char name[SHOWN], why[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(why, sizeof why, format, arguments);
    va_end(arguments);
    return br_fail(s->err, BR_BAD_INPUT, "%s: %s",
                   br_quoted(name, sizeof name, &br_for_text, s->reading->name), why);
}

static const char *shown(char buffer[SHOWN], const char *text)
{
    return br_quoted(buffer, SHOWN, &br_for_text, text);
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

/* Takes a text without the blanks around it; a text that has no room is not a number. */
static enum br_status take_text(struct search *s, const char *from, size_t length)
{
    char buffer[SHOWN];
    for (; length && is_blank(*from); length--)
        from++;
    while (length && is_blank(from[length - 1]))
        length--;
    if (length < sizeof s->text) {
        memcpy(s->text, from, length);
        s->text[length] = '\0';
        return BR_OK;
    }
    snprintf(s->text, sizeof s->text, "%.*s", (int)sizeof s->text - 1, from);
    return refuse(s, "found '%s...' of %zu bytes, expected a number", shown(buffer, s->text),
                  length);
}

/* Where a reading looks. */
static const char *place_of(const struct br_reading *r)
{
    return r->file ? r->file : r->complaints ? "standard error" : "the output";
}

/* ---- regular expressions ---- */

/* The prefix that may have been meant by the word before the colon, for a message. */
static const char *prefix(const struct br_reading *r, char text[BR_SUGGESTION])
{
    static const char *const known[] = {"json:", "csv:", "last:", "stderr:", "file:"};
    char word[16];
    const size_t length = strcspn(r->what, ":");
    snprintf(word, sizeof word, "%.*s", (int)(length < 14 ? length + 1 : 15), r->what);
    return br_suggestion(r->what[length] ? word : "", known, sizeof known / sizeof *known, text);
}

static bool continues(const char *s)
{
    return isalnum((unsigned char)*s) || *s == '.' || *s == '_' ||
           (*s == ',' && isdigit((unsigned char)s[1]));
}

/* Whether the group has only a piece of a number, as ([0-9.]+) has of 1.5e-7, 1.5D-7 and 1,5: a
 * number that begins with it ends behind it, or one that begins before it reaches into it. Text
 * that the expression itself matches behind its group is no piece of the number. */
static bool is_cut(const char *line, const regmatch_t match[2])
{
    const char *from = line + match[1].rm_so, *to = line + match[1].rm_eo;
    char *end;
    strtod(from, &end);
    if (end > to || (match[1].rm_eo == match[0].rm_eo && to > from && continues(to)))
        return true;
    for (const char *c = from - 1; c >= line && from - c < LONGEST; c--) {
        const bool sign = (*c == '-' || *c == '+') && (c == line || !isalnum((unsigned char)c[-1]));
        if (!isdigit((unsigned char)*c) && *c != '.' && !sign)
            continue;
        strtod(c, &end);
        if (end > from)
            return true;
    }
    return false;
}

/* The matches of the expression. */
struct matches {
    size_t count;
    char lines[64]; /* their numbers */
};

static enum br_status take_group(struct search *s, const char *line, const regmatch_t match[2],
                                 size_t number)
{
    char buffer[SHOWN];
    if (match[1].rm_so < 0)
        return take_text(s, "", 0);
    if (is_cut(line, match))
        return refuse(s, "its group has only a part of the number on line %zu: '%s'", number,
                      shown(buffer, line + match[0].rm_so));
    return take_text(s, line + match[1].rm_so, (size_t)(match[1].rm_eo - match[1].rm_so));
}

static enum br_status compile(struct search *s)
{
    s->compiled = br_seconds();
    return regcomp(&s->regex, s->reading->what, REG_EXTENDED) == 0
               ? BR_OK
               : br_no_memory(s->err, "a regular expression");
}

/* Between two calls of the C library. A compiled expression keeps up to 10 kB of each letter that
 * it has read, so one that has worked for long is made anew. */
static enum br_status pause_search(struct search *s)
{
    char buffer[SHOWN];
    const double now = br_seconds();
    if (br_observer_check(s->request->observer, s->err))
        return s->err->status;
    if (now - s->began > s->request->seconds)
        return refuse(s, "the search for '%s' did not end within %g s",
                      shown(buffer, s->reading->what), s->request->seconds);
    if (now - s->compiled < 0.1)
        return BR_OK;
    regfree(&s->regex);
    s->regex = (regex_t){0}; /* so that it can be freed again */
    return compile(s);
}

/* Finds the first match from `at` on, match[0].rm_so -1 if there is none. A call of the C library
 * cannot be stopped, and may read the rest of the line from each beginning of a match: so it tries
 * few of them. */
static enum br_status next_match(struct search *s, const char *line, size_t length, size_t at,
                                 regmatch_t match[2])
{
    const size_t tries = LONGEST_LINE / (length + 1);
    enum br_status status;
    match[0].rm_so = -1;
    for (; match[0].rm_so == -1 && at <= length; at += tries + 1) {
        const size_t range = at + tries < length ? tries : length - at;
        if ((status = pause_search(s)))
            return status;
        match[0].rm_so =
            re_search(&s->regex, line, (int)length, (int)at, (int)range, NULL); /* -2: failed */
    }
    if (match[0].rm_so == -1)
        return BR_OK;
    match[0].rm_eo = (regoff_t)length;
    if (match[0].rm_so >= 0 && (status = pause_search(s)))
        return status;
    return match[0].rm_so >= 0 && regexec(&s->regex, line, 2, match, REG_STARTEND) == 0
               ? BR_OK
               : br_no_memory(s->err, "a regular expression");
}

/* Takes the first match of the output; counts those of the line. */
static enum br_status search_line(struct search *s, const char *line, size_t number,
                                  struct matches *m)
{
    const size_t length = strlen(line);
    regmatch_t match[2];
    if (length > LONGEST_LINE)
        return refuse(s,
                      "line %zu of the output has %zu bytes, expected at most %d for a regular "
                      "expression (json: and csv: have no such limit)",
                      number, length, LONGEST_LINE);
    for (size_t at = 0; at <= length;) {
        enum br_status status = next_match(s, line, length, at, match);
        if (status || match[0].rm_so < 0)
            return status;
        const bool empty = match[0].rm_eo == match[0].rm_so;
        if (empty && at > 0) { /* (.*) also matches the empty text behind the whole line */
            at = (size_t)match[0].rm_eo + 1;
            continue;
        }
        const size_t used = strlen(m->lines);
        if (used < sizeof m->lines - 24)
            snprintf(m->lines + used, sizeof m->lines - used, "%s%zu", used ? ", " : "", number);
        if ((m->count++ == 0 || s->reading->last) && (status = take_group(s, line, match, number)))
            return status;
        at = (size_t)match[0].rm_eo + empty;
    }
    return BR_OK;
}

static enum br_status search_regex(struct search *s)
{
    char buffer[SHOWN], suggestion[BR_SUGGESTION], *rest = s->output;
    struct matches m = {0};
    enum br_status status = compile(s);
    for (size_t number = 1; rest && !status; number++) {
        const char *line = strsep(&rest, "\n");
        if (rest || *line) /* else it is empty, behind the last line end */
            status = search_line(s, line, number, &m);
    }
    regfree(&s->regex);
    if (status || m.count == 1 || (m.count && s->reading->last))
        return status;
    if (m.count == 0)
        return refuse(s, "'%s' matches nothing in %s%s%s", shown(buffer, s->reading->what),
                      place_of(s->reading),
                      s->reading->file || s->reading->complaints
                          ? ""
                          : " (stderr:REGEX reads standard error)",
                      prefix(s->reading, suggestion));
    return refuse(s, "'%s' matches %zu times, expected once; lines %s (last:REGEX takes the last)",
                  shown(buffer, s->reading->what), m.count, m.lines);
}

/* The end of the bracket expression that begins here: its ']', or the end of the text. */
static const char *skip_brackets(const char *at)
{
    at += at[1] == '^' ? 2 : 1;
    for (at += *at == ']'; *at && *at != ']'; at++)
        if (*at == '[' && at[1] && strchr(":.=", at[1])) { /* [:alpha:], [.a.], [=a=] */
            const char closing[] = {at[1], ']', '\0'};
            const char *end = strstr(at + 2, closing);
            at = end ? end + 1 : at + strlen(at) - 1;
        }
    return at;
}

/* How often + or {m,n} repeats what is before it; "m,": a further copy is for the rest. */
static size_t repetitions(const char *at)
{
    char *end = NULL;
    const size_t least = *at == '+' ? 2 : strtoul(at + 1, &end, 10);
    if (!end || *end != ',')
        return least;
    return isdigit((unsigned char)end[1]) ? strtoul(end + 1, NULL, 10) : least + 1;
}

/* Refuses what the C library might crash on, or compile or match for ever. */
static enum br_status check_expression(const struct search *s)
{
    const char *const text = s->reading->what, *at = text;
    char buffer[SHOWN];
    size_t size = 0, last = 0, open = 0, groups = 0; /* letters; last: those that are repeated */
    if (strlen(text) > MOST_LETTERS)
        return refuse(s, "'%s' has %zu letters, expected at most %d", shown(buffer, text),
                      strlen(text), MOST_LETTERS);
    for (; *at && size <= MOST_LETTERS; at += *at != '\0') {
        if (*at == '\\' && at[1] >= '1' && at[1] <= '9')
            return refuse(s, "'%s', letter %td: found \\%c, expected no back-reference",
                          shown(buffer, text), at - text + 1, at[1]);
        if (*at == '+' || *at == '{') {
            const size_t most = MOST_LETTERS + 1, times = repetitions(at);
            const size_t more = last * (times > most ? most : times > 0 ? times : 1) - last;
            size += more;
            last += more;
            at += *at == '{' && size <= MOST_LETTERS ? strcspn(at, "}") : 0;
        } else if (*at == '(') {
            groups++;
            open = size;
        } else if (*at == ')')
            last = size - open;
        else if (!strchr("*?|^$", *at)) {
            at = *at == '[' ? skip_brackets(at) : at + (*at == '\\' && at[1]);
            last = 1;
            size++;
        }
    }
    if (size > MOST_LETTERS)
        return refuse(s, "'%s', letter %td: repeats to more than %d letters, expected fewer",
                      shown(buffer, text), at - text, MOST_LETTERS);
    return groups > 1 ? refuse(s, "'%s' has %zu groups, expected one around the number",
                               shown(buffer, text), groups)
                      : BR_OK;
}

/* ---- JSON ---- */

/* One step of RFC 6901: reads a token, which ends at a slash, and moves the pointer behind it. */
static const json_t *step_into(const json_t *value, const char **pointer, char *token)
{
    char *to = token;
    for (; **pointer && **pointer != '/'; (*pointer)++) {
        const bool escaped = **pointer == '~';
        *pointer += escaped;
        *to++ = escaped ? (char)(**pointer == '1' ? '/' : '~') : **pointer;
    }
    *to = '\0';
    if (!json_is_array(value))
        return json_object_get(value, token);
    const size_t digits = strspn(token, "0123456789");
    const bool index =
        digits > 0 && digits < 10 && !token[digits] && (*token != '0' || digits == 1);
    return index ? json_array_get(value, strtoul(token, NULL, 10)) : NULL;
}

static enum br_status search_json(struct search *s)
{
    static const char *const types[] = {"an object", "an array", "a text", "a number",
                                        "a number",  "true",     "false",  "null"};
    json_error_t why;
    char buffer[SHOWN], *token = br_allocate(strlen(s->reading->what) + 1, 1);
    if (!token)
        return br_no_memory(s->err, "a JSON pointer");
    json_t *root =
        json_loadb(s->output, s->length,
                   JSON_DECODE_ANY | JSON_DECODE_INT_AS_REAL | JSON_REJECT_DUPLICATES, &why);
    const json_t *value = root;
    for (const char *pointer = s->reading->what; *pointer == '/' && value;) {
        pointer++;
        value = step_into(value, &pointer, token);
    }
    free(token);
    enum br_status status = BR_OK;
    if (!root)
        status = refuse(s, "the output is no JSON, line %d: %s", why.line, shown(buffer, why.text));
    else if (!value)
        status = refuse(s, "the output has no '%s'", shown(buffer, s->reading->what));
    else if (!json_is_number(value))
        status = refuse(s, "'%s' is %s, expected a number", shown(buffer, s->reading->what),
                        types[json_typeof(value)]);
    else
        snprintf(s->text, sizeof s->text, "%.17g", json_number_value(value));
    json_decref(root);
    return status;
}

/* ---- CSV ---- */

/* Takes the middle out of long tables: a log may have more rows than a study. */
static void shorten(char *text)
{
    enum { HEAD = 20, TAIL = 20, LINES = 1000 };
    size_t lines = 0;
    for (const char *at = text; (at = strchr(at, '\n')); at++)
        lines++;
    char *head = text, *tail = text;
    for (size_t i = 0; lines > LINES && i < lines - TAIL; i++) {
        tail = strchr(tail, '\n') + 1;
        head = i < HEAD ? tail : head;
    }
    memmove(head, tail, strlen(tail) + 1);
}

/* The first line below the last row that says that the run failed; NULL: there is none. */
static const char *failure_below(const struct br_fields *f)
{
    for (size_t i = 0; i < f->lefts; i++)
        if (f->left[i].line > f->line[f->rows - 1] && br_says_failure(f->left[i].text))
            return f->left[i].text;
    return NULL;
}

/* The number is in the last row. */
static enum br_status search_csv(struct search *s)
{
    char buffer[SHOWN], number[40];
    struct br_fields f = {0};
    struct br_error why = {0};
    struct br_field_number found;
    size_t columns = 0;
    const char *field = NULL, *below;
    shorten(s->output);
    enum br_status status = br_fields_read(s->output, "the output", s->request->observer, &f, &why);
    for (size_t i = 0; i < f.columns && f.heading && !status; i++)
        if (f.heading[i] && strcmp(f.heading[i], s->reading->what) == 0) {
            columns++;
            field = f.rows ? f.field[(f.rows - 1) * f.columns + i] : NULL;
        }
    if (status)
        status = status == BR_BAD_INPUT ? refuse(s, "%s", why.message)
                                        : br_fail(s->err, status, "%s", why.message);
    else if (!columns && strstr(s->output, s->reading->what)) /* one row with a gap is no table */
        status = refuse(s, "found nothing below '%s', expected a number",
                        shown(buffer, s->reading->what));
    else if (columns != 1)
        status = refuse(s, "found %zu columns '%s' in the heading, expected one", columns,
                        shown(buffer, s->reading->what));
    else if (!f.rows)
        status = refuse(s, "the table has no row below its heading");
    else if ((below = failure_below(&f)))
        status = refuse(s,
                        "found '%s' below the last row, expected no failure (last:REGEX reads the "
                        "number all the same)",
                        shown(buffer, below));
    else {
        const bool reads = field && br_field_read(field, f.mark, &found);
        const char *text = reads   ? br_shortest(found.value, number, sizeof number)
                           : field ? field
                                   : "";
        status = take_text(s, text, strlen(text));
    }
    br_fields_clear(&f);
    return status;
}

/* ---- all ---- */

static bool is_pointer(const char *text)
{
    bool valid = *text == '\0' || *text == '/';
    for (; *text && valid; text++)
        valid = *text != '~' || text[1] == '0' || text[1] == '1';
    return valid;
}

enum br_status br_reading_check(const struct br_reading *reading, struct br_error *err)
{
    const struct search s = {.reading = reading, .err = err};
    char buffer[SHOWN], why[SHOWN], suggestion[BR_SUGGESTION];
    regex_t regex;
    if (!*reading->name)
        return br_fail(err, BR_BAD_INPUT, "a reading has no name");
    if (reading->kind == BR_READING_JSON && !is_pointer(reading->what))
        return refuse(&s, "'%s' is no JSON pointer, expected /NAME/..., with ~1 for / and ~0 for ~",
                      shown(buffer, reading->what));
    if (reading->kind == BR_READING_CSV && !*reading->what)
        return refuse(&s, "found no column, expected its heading");
    if (reading->kind != BR_READING_REGEX)
        return BR_OK;
    if (check_expression(&s))
        return err->status;
    const int failure = regcomp(&regex, reading->what, REG_EXTENDED);
    if (failure == REG_ESPACE)
        return br_no_memory(err, "a regular expression");
    if (failure) {
        regerror(failure, &regex, why, sizeof why);
        return refuse(&s, "'%s' is no extended regular expression: %s",
                      shown(buffer, reading->what), why);
    }
    const size_t groups = regex.re_nsub;
    regfree(&regex);
    return groups == 1 ? BR_OK
                       : refuse(&s, "'%s' has %zu groups, expected one around the number%s",
                                shown(buffer, reading->what), groups, prefix(reading, suggestion));
}

/* Reads one finite number in C's notation, or with Fortran's exponents D and Q, without other text.
 */
static enum br_status convert(const struct search *s, double *number)
{
    char buffer[SHOWN], text[LONGEST], *end;
    strcpy(text, s->text);
    char *exponent = strchr(text, 'x') || strchr(text, 'X') ? NULL : strpbrk(text, "dDqQ");
    if (exponent && exponent > text && strchr("0123456789.", exponent[-1]))
        *exponent = 'e';
    errno = 0;
    *number = strtod(text, &end);
    const bool whole = *text && !is_blank(*text) && !*end;
    if (whole && isfinite(*number) && !(errno == ERANGE && *number == 0))
        return BR_OK;
    return refuse(s, "found '%s', expected a finite number", shown(buffer, s->text));
}

enum br_status br_reading_take(const struct br_orders_request *request, size_t index,
                               const char *output, size_t length, double *number,
                               struct br_error *err)
{
    const struct br_reading *reading = &request->reading[index];
    static enum br_status (*const search[])(struct search *) = {
        [BR_READING_REGEX] = search_regex,
        [BR_READING_JSON] = search_json,
        [BR_READING_CSV] = search_csv,
    };
    struct search s = {.reading = reading,
                       .request = request,
                       .length = length,
                       .began = br_seconds(),
                       .err = err};
    s.output = br_allocate(length + 1, 1);
    if (!s.output)
        return br_no_memory(err, "a program's output");
    memcpy(s.output, output, length);
    enum br_status status = BR_OK;
    if (reading->file && !length)
        status = refuse(&s, "%s is empty, or the run did not write it", reading->file);
    else if (reading->kind != BR_READING_JSON && memchr(output, '\0', length))
        status = refuse(&s, "the output has a zero byte, expected text");
    if (!status)
        status = search[reading->kind](&s);
    if (!status)
        status = convert(&s, number);
    free(s.output);
    return status;
}
