/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lists of a program, "h = [0.1, 0.05]", or of its output, "errors: [1e-2 3e-3]": each becomes a
 * column, by way of JSON. Python (with numpy), MATLAB, Julia and R write them. The other lines of a
 * program are passed over; a list that one of them changes is refused. */
#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "orders/reading/reading.h"
#include "orders/reading/roles.h"

enum { DEEPEST = 8, MOST_LISTS = 64, LEAST_VALUES = 3 };

struct lists {
    const char *text;
    char *json; /* what is written; it has room for all */
    size_t length;
    struct list {
        const char *name, *end; /* in the text; both NULL: it has no name */
        const char *from;       /* its statement */
        size_t value;           /* where it is written */
    } list[MOST_LISTS];
    size_t count;
    bool broken; /* a bracket is never closed, or they are too deep */
};

static void put(struct lists *s, const char *text, const char *end)
{
    memcpy(s->json + s->length, text, (size_t)(end - text));
    s->length += (size_t)(end - text);
    s->json[s->length] = '\0';
}

static void put_sign(struct lists *s, char sign)
{
    put(s, &sign, &sign + 1);
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

/* Skips blanks, comments and continued lines; *lines (out) may be NULL: the ends of lines. */
static const char *skip_space(const char *at, size_t *lines)
{
    for (;; at++) {
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
        if (end)
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

/* The name at the begin of a statement, *end (out), and what follows its sign; NULL: there is none.
 */
static const char *skip_name(const char **name, const char **end)
{
    const char *at = *name;
    while (isalnum((unsigned char)*at) || (unsigned char)*at >= 0x80 ||
           (*at && strchr("_.-^'\" ", *at)))
        at++;
    const char *last = at;
    if ((*at != '=' && *at != ':') || at[1] == '=')
        return NULL;
    while (last > *name && last[-1] == ' ')
        last--;
    if (last > *name + 1 && strchr("'\"", **name) && last[-1] == **name) {
        ++*name;
        last--;
    }
    *end = last;
    return last > *name && last - *name < 80 && !isdigit((unsigned char)**name)
               ? skip_space(at + 1, NULL)
               : NULL;
}

/* Takes a statement that gives a list, and nothing else; returns what follows, or NULL. */
static const char *take_statement(struct lists *s, const char *from)
{
    const char *name = from, *end = NULL;
    const char *value = skip_name(&name, &end);
    const size_t length = s->length;
    if (!value && strchr("[({aAn", *from)) {
        value = from;
        name = end = NULL;
    }
    size_t count = 0;
    put_sign(s, ',');
    if (name) {
        put_text(s, name, end);
        put_sign(s, ':');
    }
    const size_t begin = s->length;
    const char *at = value && (isalpha((unsigned char)*value) || strchr("[({", *value))
                         ? take_value(s, value, true, 0, &count)
                         : NULL;
    at = at ? at + (*at == '\'') : NULL;
    at = at ? at + strspn(at, " \t") : NULL;
    char heading[80];
    snprintf(heading, sizeof heading, "%.*s", (int)(end - name), name ? name : "");
    const enum br_kind kind = br_kind_of(heading);
    const bool is_rate = kind == BR_KIND_RATE || kind == BR_KIND_FACTOR;
    if (!at || !(!*at || strchr("\n;,", *at) || begins_comment(at)) ||
        count < (size_t)(is_rate ? 2 : LEAST_VALUES)) {
        s->length = length;
        return at && count ? at : NULL;
    }
    s->list[s->count++] = (struct list){name, end, from, begin};
    return at;
}

/* The begin of the next statement: behind a line, or ";". */
static const char *next_statement(const char *at)
{
    at += begins_comment(at) ? strcspn(at, "\n") : strcspn(at, ";\n");
    return skip_space(*at ? at + 1 : at, NULL);
}

/* Whether a statement changes what has a name: "e = ", "e[0] = ", "e /= ", "e.append(". */
static bool changes(const char *at, const struct list *list)
{
    const size_t length = (size_t)(list->end - list->name);
    if (strncmp(at, list->name, length) != 0 || isalnum((unsigned char)at[length]) ||
        at[length] == '_')
        return false;
    at += length;
    if (strncmp(at, ".append", 7) == 0 || strncmp(at, ".extend", 7) == 0)
        return true;
    if (*at && strchr("[(", *at))
        at += strcspn(at, "])\n") + 1;
    at += strspn(at, " \t");
    at += strspn(at, "+-*/.^");
    return *at == '=' && at[1] != '=';
}

static size_t line_of(const struct lists *s, const char *at)
{
    size_t line = 1;
    for (const char *c = s->text; c < at; c++)
        line += *c == '\n';
    return line;
}

/* Refuses a list that another line changes, and one that has another number of values. */
static enum br_status check(const struct lists *s, const char *path, struct br_error *err)
{
    for (const char *at = skip_space(s->text, NULL); *at; at = next_statement(at))
        for (size_t i = 0; i < s->count; i++) {
            const struct list *const list = &s->list[i];
            if (list->name && at != list->from && changes(at, list))
                return br_fail(err, BR_BAD_INPUT,
                               "%s:%zu: found a line that changes the list '%.*s' of line %zu: "
                               "keep the lists as they are in the end, and remove the rest",
                               path, line_of(s, at), (int)(list->end - list->name), list->name,
                               line_of(s, list->from));
        }
    return BR_OK;
}

/* Whether a line may be a row of a table. */
static bool may_be_row(const char *at)
{
    at += strspn(at, "+-.");
    return isdigit((unsigned char)*at) || *at == '|';
}

/* Whether lists are a table: several with names, or one of lists. */
static bool is_table(const struct lists *s)
{
    bool named = true;
    for (size_t i = 0; s && i < s->count; i++)
        named &= s->list[i].name != NULL;
    if (!s || s->count != 1)
        return s && s->count > 1 && named;
    const char *const value = s->json + s->list[0].value;
    return *value == '{' || strpbrk(value + 1, "[{");
}

enum br_status br_lists_find(const char *text, const char *path, struct br_store *store,
                             const char **json, struct br_error *err)
{
    *json = NULL;
    struct lists *s = NULL;
    for (const char *at = skip_space(text, NULL), *end; *at; at = end) {
        if (may_be_row(at))
            return BR_OK;
        end = next_statement(at);
        if (!strchr("[({", at[strcspn(at, "[({\n")]))
            continue;
        if (!s) {
            s = br_store_take(store, 1, sizeof *s);
            char *const room = br_store_take(store, 4 * strlen(text) + 64, 1);
            if (!s || !room)
                return br_no_memory(err, "the table");
            *s = (struct lists){.text = text, .json = room};
        }
        const char *const behind = take_statement(s, at);
        if (s->broken || s->count == MOST_LISTS)
            return BR_OK;
        end = !behind          ? end
              : *behind == ',' ? skip_space(behind + 1, NULL)
                               : next_statement(behind);
    }
    if (!is_table(s))
        return BR_OK;
    if (check(s, path, err))
        return err->status;
    if (s->list[0].name) {
        s->json[0] = '{';
        put_sign(s, '}');
    }
    *json = s->json + !s->list[0].name;
    return BR_OK;
}
