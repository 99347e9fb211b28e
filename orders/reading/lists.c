/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lists of a program, "h = [0.1, 0.05]", or of its output, "errors: [1e-2 3e-3]": each becomes a
 * column, by way of JSON. Python (with numpy), MATLAB, Julia and R write them. The other lines of a
 * program are passed over; a list that one of them changes is refused. */
#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "orders/reading/reading.h"
#include "orders/reading/roles.h"

enum {
    DEEPEST = 12,
    MOST_LISTS = 64,
    LEAST_VALUES = 3,
    LONGEST_TEXT = 1 << 22, /* bytes */
    LONGEST_BLOCK = 2000    /* of comments */
};

struct lists {
    const char *text;
    struct br_fields *fields;
    char *json; /* what is written */
    size_t length, room;
    struct list {
        const char *name, *end; /* in the text; both NULL: it has no name */
        const char *from;       /* its statement */
        bool nested;            /* it has lists, or is a record */
    } list[MOST_LISTS];
    size_t count;
    bool broken;  /* a bracket is never closed, or there are too many */
    bool skipped; /* a statement with brackets and without a name */
};

static void put_sign(struct lists *s, char sign)
{
    char *const json = br_store_grow(&s->fields->store, s->json, s->length, &s->room, 1);
    if (!json)
        return;
    json[s->length++] = sign;
    s->json = json;
}

/* A text as a string of JSON. */
static void put_text(struct lists *s, const char *text, const char *end)
{
    put_sign(s, '"');
    for (; text < end; text++) {
        if (*text == '"' || (*text == '\\' && !strchr("\"\\/", text[1])))
            put_sign(s, '\\');
        put_sign(s, *text == '\n' || *text == '\t' ? ' ' : *text);
    }
    put_sign(s, '"');
}

/* ---- values ---- */

static bool begins_comment(const char *at)
{
    return *at == '#' || *at == '%' || strncmp(at, "//", 2) == 0;
}

/* Skips the prompt of a program, ">> ". */
static const char *skip_prompt(const char *at)
{
    const size_t length = strspn(at, ">");
    return at + (length > 1 ? length + strspn(at + length, " ") : 0);
}

/* Skips a block of comments, or a text of several lines. */
static const char *skip_block(const char *at)
{
    static const char *const blocks[][2] = {
        {"\"\"\"", "\"\"\""}, {"'''", "'''"}, {"%{\n", "%}"}, {"/*", "*/"}};
    for (size_t i = 0; i < 4; i++) {
        const size_t length = strlen(blocks[i][0]), behind = strlen(blocks[i][1]);
        if (strncmp(at, blocks[i][0], length) != 0)
            continue;
        const size_t rest = strnlen(at + length, LONGEST_BLOCK);
        const char *const end = memmem(at + length, rest, blocks[i][1], behind);
        if (end)
            return end + behind;
    }
    return at;
}

/* Skips blanks, comments and continued lines; *lines (out) may be NULL: the ends of lines. */
static const char *skip_space(const char *at, size_t *lines)
{
    for (;; at++) {
        at = skip_block(at);
        const bool continued = strncmp(at, "...", 3) == 0;
        if (continued || begins_comment(at))
            at += strcspn(at, "\n");
        if (*at == '\n' && lines && !continued)
            ++*lines;
        if (!*at || !strchr(" \t\r\n", *at))
            return at;
    }
}

static const char *skip_quoted(const char *at)
{
    const char quote = *at++;
    while (*at && *at != quote && *at != '\n')
        at += 1 + (*at == '\\' && at[1]);
    return *at == quote ? at + 1 : NULL;
}

/* Whether a list has a sign outside of the brackets in it. */
static bool has_sign(struct lists *s, const char *at, char sign)
{
    int depth = 0;
    bool has = false;
    do {
        const char *const quoted = *at == '"' || *at == '\'' ? skip_quoted(at) : NULL;
        at = quoted ? quoted : skip_space(at, NULL);
        has |= depth == 1 && *at == sign;
        depth += *at && strchr("[({", *at) ? 1 : 0;
        depth -= *at && strchr("])}", *at) ? 1 : 0;
        s->broken |= !*at || depth > DEEPEST;
        at++;
    } while (!s->broken && depth > 0);
    return has;
}

/* Skips what only says that a list is one: "np.array(", "Float64"; *closes (out): a bracket has to
 * close it. */
static const char *skip_call(const char *at, bool *closes)
{
    static const char calls[] = " array asarray tensor list tuple Array Float64 Float32 Int64 Int ";
    const char *word = at, *end = at;
    while (isalnum((unsigned char)*end) || *end == '_' || *end == '.') {
        word = *end == '.' ? end + 1 : word;
        end++;
    }
    char name[16];
    snprintf(name, sizeof name, " %.*s ", end - word < 12 ? (int)(end - word) : 12, word);
    *closes = false;
    if (end == word || !*end || !strchr("[(", *end))
        return at;
    if (strcmp(name, " c ") == 0)
        return end;
    *closes = *end == '(';
    return strstr(calls, name) ? skip_space(end + *closes, NULL) : NULL;
}

/* Takes a number, or a word that stands for none. */
static const char *take_number(struct lists *s, const char *at, bool commas)
{
    static const char words[] = " True False true false ";
    struct br_field_number number;
    char text[64], word[72];
    const char *end = at + strcspn(at, commas ? ",;])}\n#%" : " \t,;])}\n#%");
    const char *const next = end;
    while (end > at && strchr(" \t\r", end[-1]))
        end--;
    snprintf(text, sizeof text, "%.*s", end - at < 60 ? (int)(end - at) : 0, at);
    snprintf(word, sizeof word, " %s ", text);
    if (end == at || (!br_field_read(text, '.', &number) &&
                      !(isalpha((unsigned char)text[strspn(text, "+-")]) &&
                        (br_field_is_missing(text) || strstr(words, word)))))
        return NULL;
    put_text(s, at, end);
    return next;
}

static const char *take_list(struct lists *s, const char *at, int depth, size_t *count);

/* Takes a number, a text, or a list, also in a call; *count (out): of its values. */
static const char *take_value(struct lists *s, const char *at, bool commas, int depth,
                              size_t *count)
{
    bool closes = false;
    *count = 0;
    if (*at == '"' || *at == '\'') {
        const char *const end = skip_quoted(at);
        for (const char *c = at; end && *at == '"' && c < end; c++)
            put_sign(s, *c);
        if (end && *at == '\'')
            put_text(s, at + 1, end - 1);
        return end;
    }
    at = isalpha((unsigned char)*at) ? skip_call(at, &closes) : at;
    if (!at || !*at || !strchr("[({", *at))
        return at && !closes ? take_number(s, at, commas) : NULL;
    at = depth < DEEPEST ? take_list(s, at, depth + 1, count) : NULL;
    if (!at || !closes)
        return at;
    at += strcspn(at, "()[]\n"); /* ", dtype=float" */
    return *at == ')' ? at + 1 : NULL;
}

/* Takes the pairs of a dictionary behind its bracket. */
static const char *take_pairs(struct lists *s, const char *at, int depth, size_t *count)
{
    size_t inner;
    put_sign(s, '{');
    for (*count = 0; at && *(at = skip_space(at, NULL)) != '}'; ++*count) {
        const char *const quoted = *at == '"' || *at == '\'' ? skip_quoted(at) : NULL;
        const char *const end = quoted ? quoted : at + strcspn(at, " :,}\n");
        if (*count)
            put_sign(s, ',');
        put_text(s, at + (quoted != NULL), end - (quoted != NULL));
        put_sign(s, ':');
        at = skip_space(end, NULL);
        at = *at == ':' ? take_value(s, skip_space(at + 1, NULL), true, depth, &inner) : NULL;
        at = at ? skip_space(at, NULL) : NULL;
        at = at && *at == ',' ? at + 1 : at && *at == '}' ? at : NULL;
    }
    put_sign(s, '}');
    return at ? at + 1 : NULL;
}

/* Takes the values of a row up to ";" or the closing bracket. Without commas and ";" several
 * lines are one list if the last line is shorter, or if each line has one value. */
static const char *take_row(struct lists *s, const char *at, bool commas, int depth, size_t *count)
{
    size_t lines = 0, line = 0, in_line = 0, in_first = 0, inner;
    *count = 0;
    while (*(at = skip_space(at, &lines)) && !strchr(";])}", *at)) {
        in_line = lines == line ? in_line : 0;
        line = lines;
        if (*count)
            put_sign(s, ',');
        at = take_value(s, at, commas, depth, &inner);
        if (!at)
            return NULL;
        ++*count;
        in_line += !inner;
        in_first = *count == in_line ? in_line : in_first;
        at = skip_space(at, &lines);
        if (commas && !strchr(",;])}", *at))
            return NULL;
        at += *at == ',';
    }
    const bool unclear = !commas && in_first > 1 && in_line < *count && in_line == in_first;
    return *at && !unclear ? at : NULL;
}

/* Takes a list, a matrix with ";" behind its rows, or a dictionary. */
static const char *take_list(struct lists *s, const char *at, int depth, size_t *count)
{
    const char close = *at == '[' ? ']' : *at == '(' ? ')' : '}';
    const bool commas = has_sign(s, at, ',');
    if (s->broken)
        return NULL;
    if (*at == '{' && has_sign(s, at, ':'))
        return take_pairs(s, at + 1, depth, count);
    const bool has_rows = has_sign(s, at, ';');
    size_t width = 0;
    const size_t length = s->length;
    if (has_rows && !take_row(s, at + 1, commas, depth, &width))
        return NULL;
    s->length = length;
    put_sign(s, '[');
    *count = 0;
    for (size_t values; *at != close; *count += has_rows ? values > 0 : values) {
        const bool is_row = has_rows && width > 1;
        if (*count)
            put_sign(s, ',');
        if (is_row)
            put_sign(s, '[');
        const size_t before = s->length;
        at = take_row(s, at + 1, commas, depth, &values);
        if (!at || (*at != close && *at != ';') || (has_rows && values && values != width))
            return NULL;
        if (is_row)
            put_sign(s, ']');
        if (!values) /* ";" before the bracket */
            s->length = before - is_row - (*count > 0);
    }
    put_sign(s, ']');
    return at + 1;
}

/* ---- statements ---- */

static size_t line_of(const struct lists *s, const char *at)
{
    size_t line = 1;
    for (const char *c = s->text; c < at; c++)
        line += *c == '\n';
    return line;
}

/* The name at the begin of a statement, *end (out), and what follows its sign; NULL: there is none.
 */
static const char *skip_name(const char **name, const char **end)
{
    const char *at = *name;
    while (isalnum((unsigned char)*at) || (unsigned char)*at >= 0x80 ||
           (*at && strchr("_.-^'\" ", *at)))
        at++;
    const char *last = at;
    const bool arrow = strncmp(at, "<-", 2) == 0; /* of R */
    if ((*at != '=' && *at != ':' && !arrow) || at[1] == '=')
        return NULL;
    while (last > *name && last[-1] == ' ')
        last--;
    if (last > *name + 1 && strchr("'\"", **name) && last[-1] == **name) {
        ++*name;
        last--;
    }
    *end = last;
    return last > *name && last - *name < 80 && !isdigit((unsigned char)**name)
               ? skip_space(at + 1 + arrow, NULL)
               : NULL;
}

static size_t number_length(const char *at)
{
    return strspn(at, "+-.0123456789e") * (isdigit((unsigned char)at[strspn(at, "+-.")]) != 0);
}

/* Takes the lines of numbers that MATLAB shows below a name: a row, a column, or a matrix. Above
 * them may be a factor of all, "1.0e-03 *". */
static const char *take_shown(struct lists *s, const char *at, size_t *count)
{
    char first[20], factor[8] = "";
    int length = 0;
    snprintf(first, sizeof first, "%.19s", at);
    if (sscanf(first, "1.0e%7[-+0-9] *%n", factor, &length) == 1 && length)
        at = skip_space(at + length, NULL);
    const char *const second = at + number_length(at) + strspn(at + number_length(at), " ");
    const bool is_matrix =
        number_length(second) && number_length(skip_space(at + strcspn(at, "\n"), NULL));
    put_sign(s, '[');
    const char *end = at;
    for (*count = 0; number_length(at);) {
        end = at + strcspn(at, "\r\n");
        put_sign(s, *count ? ',' : ' ');
        put_sign(s, is_matrix ? '[' : ' ');
        for (size_t i = 0; at < end && number_length(at); i++, *count += !is_matrix) {
            put_sign(s, i ? ',' : ' ');
            char number[60];
            const size_t size = number_length(at);
            snprintf(number, sizeof number, "%.*s%s%s", size < 40 ? (int)size : 0, at,
                     length ? "e" : "", length ? factor : "");
            put_text(s, number, number + strlen(number));
            at += size + strspn(at + size, " \t");
        }
        put_sign(s, is_matrix ? ']' : ' ');
        *count += is_matrix;
        if (at < end)
            return NULL;
        at = skip_space(at, NULL);
    }
    put_sign(s, ']');
    return end;
}

/* Leaves a statement with a list that is no column. */
static void leave(struct lists *s, const char *from)
{
    struct br_fields *f = s->fields;
    const size_t length = strcspn(from, "\n");
    char text[80];
    snprintf(text, sizeof text, "%.*s", length < 70 ? (int)length : 70, from);
    s->broken |= f->lefts == MOST_LISTS;
    br_fields_leave(f, line_of(s, from), br_store_copy(&f->store, text), "no list of numbers");
}

/* Takes a statement that gives a list, and nothing else; returns what follows, or NULL. */
static const char *take_statement(struct lists *s, const char *from)
{
    const char *name = from, *end = from;
    const char *value = skip_name(&name, &end);
    const size_t length = s->length;
    const bool named = value;
    value = named ? value : from;
    size_t count = 0;
    char heading[80] = "";
    put_sign(s, ',');
    if (named) {
        snprintf(heading, sizeof heading, "%.*s", (int)(end - name), name);
        put_text(s, name, end);
        put_sign(s, ':');
    }
    const size_t begin = s->length;
    const bool is_shown = named && end[strspn(end, " ")] == '=' &&
                          memchr(end, '\n', (size_t)(value - end)) && number_length(value);
    const char *at = is_shown ? take_shown(s, value, &count)
                     : isalpha((unsigned char)*value) || strchr("[({", *value)
                         ? take_value(s, value, true, 0, &count)
                         : NULL;
    at = at ? at + (*at == '\'') : NULL;
    at = at ? at + strspn(at, " \t\r") : NULL;
    const enum br_kind kind = br_kind_of(heading);
    const bool is_rate = kind == BR_KIND_RATE || kind == BR_KIND_FACTOR;
    const bool ends = at && (is_shown || !*at || strchr("\n;,", *at) || begins_comment(at));
    bool nested = *value == '{';
    for (size_t i = begin + 1; i < s->length && !nested; i++)
        nested = strchr("[{", s->json[i]) != NULL;
    if (ends && count >= (size_t)(nested ? 1 : is_rate ? 2 : LEAST_VALUES)) {
        s->list[s->count++] = (struct list){named ? name : NULL, end, from, nested};
        return at;
    }
    s->length = length;
    const size_t before = strcspn(from, "([\n"); /* "h, e = [..." */
    if (named ? memchr(from, '[', strcspn(from, "\n")) != NULL
              : from[before] == '[' && memchr(from, '=', before))
        leave(s, from);
    s->skipped |= !named;
    return ends && count ? at : NULL;
}

/* The begin of the next statement: behind a line, or ";". */
static const char *next_statement(const char *at)
{
    at += begins_comment(at) ? strcspn(at, "\n") : strcspn(at, ";\n");
    return skip_prompt(skip_space(*at ? at + 1 : at, NULL));
}

/* The next place from `at` to `end` where the name of a list stands as a word; NULL: there is none.
 */
static const char *find_name(const char *at, const char *end, const struct list *list)
{
    const size_t length = (size_t)(list->end - list->name);
    for (bool inside = false; at + length <= end; at++) {
        const bool is = !inside && strncmp(at, list->name, length) == 0 &&
                        !isalnum((unsigned char)at[length]) && at[length] != '_';
        if (is)
            return at;
        inside = isalnum((unsigned char)*at) || *at == '_' || *at == '.';
    }
    return NULL;
}

/* The end of a statement without a comment behind it. */
static const char *end_of_statement(const char *at)
{
    while (!strchr(";\n#", *at) && !(*at == '%' && at[1] != '='))
        at++;
    return at;
}

/* The sign of an assignment in a statement, "=" or "<-", outside of brackets and texts; *target
 * (out): what is behind "if x:" in front. NULL: there is none. */
static const char *assignment(const char *at, const char *end, const char **target)
{
    int depth = 0;
    for (*target = at; at < end; at++) {
        const char *const quoted = *at == '"' || *at == '\'' ? skip_quoted(at) : NULL;
        at = quoted && quoted < end ? quoted : at;
        depth += strchr("[({", *at) ? 1 : strchr("])}", *at) ? -1 : 0;
        if (depth)
            continue;
        if (strncmp(at, "<-", 2) == 0 || (*at == '=' && at[1] != '='))
            return at;
        *target = *at == ':' ? at + 1 : *target;
        at += (*at == '=' || strchr("<>!~", *at)) && at[1] == '='; /* a comparison */
    }
    return NULL;
}

/* Whether a statement changes what has a name: "e = ", "h, e[0] = ", "e /= ", "e.append(", "del e",
 * "sort!(h, e)", "f(e, out=e)". */
static bool changes(const char *at, const struct list *list)
{
    static const char *const ways[] = {".append", ".extend", ".insert", ".sort", ".reverse",
                                       ".pop",    ".remove", ".clear",  ".fill", ".resize"};
    const char *target, *const end = end_of_statement(at),
                               *const sign = assignment(at, end, &target);
    const char *const bang = memmem(at, (size_t)(end - at), "!(", 2);
    const char *const out = memmem(at, (size_t)(end - at), "out=", 4);
    const char *const name = find_name(at, end, list);
    bool by_method = false;
    for (size_t i = 0; i < sizeof ways / sizeof *ways && name == at; i++)
        by_method |= strncmp(at + (list->end - list->name), ways[i], strlen(ways[i])) == 0;
    return name && (by_method || strncmp(at, "del ", 4) == 0 ||
                    (sign && (name == at || find_name(target, sign, list))) ||
                    (bang && find_name(bang, end, list)) || (out && find_name(out + 4, end, list)));
}

/* Whether a statement gives another list with the name of one. */
static bool gives(const struct lists *s, const char *at, const struct list *list)
{
    for (const struct list *l = s->list; l < s->list + s->count; l++)
        if (l->from == at && l->name && l->end - l->name == list->end - list->name &&
            strncmp(l->name, list->name, (size_t)(l->end - l->name)) == 0)
            return true;
    return false;
}

/* Refuses a list that another line changes, or gives again. */
static enum br_status check(const struct lists *s, const char *path, struct br_error *err)
{
    for (const char *at = skip_space(s->text, NULL); *at; at = next_statement(at))
        for (size_t i = 0; i < s->count; i++) {
            const struct list *const list = &s->list[i];
            if (list->name && at > list->from && (changes(at, list) || gives(s, at, list)))
                return br_fail(err, BR_BAD_INPUT,
                               "%s:%zu: found a line that changes the list '%.*s' of line %zu: "
                               "keep the lists as they are in the end, and remove the rest",
                               path, line_of(s, at), (int)(list->end - list->name), list->name,
                               line_of(s, list->from));
        }
    return BR_OK;
}

/* Whether a line begins with a number, or a bar: it may be a row of a table. */
static bool may_be_row(const char *at)
{
    char word[60];
    struct br_field_number number;
    const size_t length = strcspn(at, " \t,;|&\n");
    snprintf(word, sizeof word, "%.*s", length < sizeof word ? (int)length : 0, at);
    return *at == '|' || br_field_read(word, '.', &number);
}

/* Whether lists are a table: several with names, or records, or one of lists. */
static bool is_table(const struct lists *s)
{
    size_t named = 0, nested = 0;
    for (size_t i = 0; i < s->count; i++) {
        named += s->list[i].name != NULL;
        nested += s->list[i].nested;
    }
    return s->count > 1 ? named == s->count || (!named && nested == s->count && !s->skipped)
                        : nested && (named || !s->skipped);
}

/* Takes all statements; whether they are a table. */
static bool take_all(struct lists *s)
{
    for (const char *at = skip_prompt(skip_space(s->text, NULL)), *end; *at;) {
        end = may_be_row(at) ? NULL : at;
        const char *const behind = end ? take_statement(s, at) : NULL;
        if (!end || s->broken || s->count == MOST_LISTS)
            return false;
        at = !behind          ? next_statement(at)
             : *behind == ',' ? skip_space(behind + 1, NULL)
                              : next_statement(behind);
    }
    return is_table(s);
}

enum br_status br_lists_find(const char *text, const char *path, struct br_fields *fields,
                             const char **json, struct br_error *err)
{
    struct lists *s = br_store_take(&fields->store, 1, sizeof *s);
    *json = NULL;
    if (!s)
        return br_no_memory(err, "the table");
    *s = (struct lists){.text = text, .fields = fields};
    if (strnlen(text, LONGEST_TEXT) == LONGEST_TEXT || !take_all(s)) {
        fields->lefts = 0;
        return fields->store.failed ? br_no_memory(err, "the table") : BR_OK;
    }
    const bool named = s->list[0].name;
    put_sign(s, named ? '}' : s->count > 1 ? ']' : ' ');
    put_sign(s, '\0');
    if (fields->store.failed)
        return br_no_memory(err, "the table");
    s->json[0] = named ? '{' : s->count > 1 ? '[' : ' ';
    *json = s->json;
    return check(s, path, err);
}
