/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The line of a table that names its columns, and the line of groups above it. */
#include <stdio.h>
#include <string.h>

#include "orders/reading/layout.h"

/* Whether the first column counts the rows or has words, as an index in front of them. */
static bool has_index(const struct layout *l)
{
    struct br_field_number one, two;
    const size_t next = br_layout_next_text(l, l->first, 1);
    if (next > l->last || l->width < 2)
        return false;
    const char *const text = l->row[l->first].token->text;
    if (!br_field_read(text, '.', &one))
        return !br_field_is_missing(text);
    return (one.value == 0 || one.value == 1) &&
           (!br_field_read(l->row[next].token->text, '.', &two) || two.value == one.value + 1);
}

/* Which columns begin with a gap, as those of rates do (l->skipped); returns how many. */
static size_t find_gaps(struct layout *l)
{
    const struct row *r = &l->row[l->first];
    size_t gaps = 0;
    for (size_t i = 0; i < l->width; i++) {
        l->skipped[i] = i >= r->count || r->token[i].content == BR_NOTHING ||
                        (r->token[i].content == BR_MISSING && *r->token[i].text == '-');
        gaps += l->skipped[i];
    }
    return r->count == l->width || l->rows > 1 ? gaps : 0;
}

/* Splits a line in the way of the rows or another one, so that it has `wanted` tokens (l->token). A
 * line with "&" is split there. */
static bool split_names(struct layout *l, size_t line, size_t wanted)
{
    const char *const text = l->line[line].text;
    char *room = br_store_take(&l->fields->store, BR_ROOM(text), 1);
    for (int i = BR_BY_TABS - 1; room && i < BR_SEPARATORS; i++) {
        const enum br_separator by = i < BR_BY_TABS ? l->by : (enum br_separator)i;
        size_t count = br_line_split(text, by, '.', room, l->token);
        while (count > wanted && l->token[count - 1].content == BR_NOTHING)
            count--;
        if (count == wanted || (l->by == BR_BY_AMPERSANDS && strchr(text, '&')))
            return count == wanted;
    }
    return false;
}

/* How many columns a token stands above, as LaTeX has it; the token (out) becomes its text. */
static size_t columns_of(char **text)
{
    size_t columns = 1;
    int from = 0;
    char *const at = strstr(*text, "\\multicolumn{");
    if (!at || sscanf(at, "\\multicolumn{%4zu}{%*[^}]}{%n", &columns, &from) < 1 || !from)
        return 1;
    int depth = 1; /* of braces */
    char *close = at + from;
    for (; *close; close++) {
        depth += (*close == '{') - (*close == '}');
        if (!depth)
            break;
    }
    *close = '\0';
    *text = at + from;
    return columns;
}

/* A name without the stars and quotes of Markdown around it, and without gnuplot's "1:" and
 * what LaTeX has around it, in place; NULL: it is empty. */
static const char *plain_name(char *name, size_t column)
{
    char counted[24];
    snprintf(counted, sizeof counted, "%zu:", column + 1);
    if (strncmp(name, counted, strlen(counted)) == 0 && name[strlen(counted)])
        name += strlen(counted);
    columns_of(&name);
    name += strspn(name, "*`");
    size_t length = strlen(name);
    while (length && strchr("*`", name[length - 1]))
        name[--length] = '\0';
    if (*name == '{' && strchr(name, '}') == name + length - 1) {
        name[length - 1] = '\0';
        return length > 2 ? name + 1 : NULL;
    }
    return length ? name : NULL;
}

/* Whether a line names all columns but those that are skipped; then takes it. */
static bool take_names(struct layout *l, size_t line)
{
    size_t wanted = 0, used = 0;
    for (size_t i = 0; i < l->width; i++)
        wanted += !l->skipped[i];
    if (!wanted || !split_names(l, line, wanted))
        return false;
    for (size_t i = 0; i < wanted && l->line[line].kind == BR_LINE_COMMENT; i++) {
        const size_t length = strlen(l->token[i].text);
        if (l->token[i].content == BR_NUMBER || (length && l->token[i].text[length - 1] == ':'))
            return false;
    }
    for (size_t i = 0; i < l->width; i++)
        l->fields->heading[i] = l->skipped[i] ? NULL : plain_name(l->token[used++].text, i);
    l->fields->heading_line = l->line[line].number;
    return l->row[line].is_used = true;
}

/* Whether the words of a line above aligned columns name them, "L2 error" as well; then takes it.
 * Rates have no names there, as their columns begin with a gap. */
static bool take_names_above(struct layout *l, size_t line)
{
    struct br_store *store = &l->fields->store;
    const struct br_line *heading = &l->line[line];
    const char **name = l->fields->heading;
    struct br_span *span = br_store_take(store, l->width, sizeof *span);
    char *room = br_store_take(store, BR_ROOM(heading->text), 1);
    bool named = l->by >= BR_BY_WIDE_BLANKS && span && room && strstr(heading->text, "  ") &&
                 !l->row[line].numbers;
    for (size_t i = l->first; named && i <= l->last; i++)
        named = !l->row[i].is_row || br_spans_widen(span, l->width, &l->line[i]);
    const size_t gaps = find_gaps(l);
    named = named && br_names_above(heading, span, l->skipped, l->width, room, name);
    for (size_t i = 0; i < l->width && gaps; i++)
        named &= !name[i] || !br_layout_is_rate(name[i]);
    l->fields->heading_line = named ? heading->number : 0;
    if (!named) {
        memset(l->skipped, 0, sizeof l->skipped);
        memset(name, 0, l->width * sizeof *name);
    }
    return l->row[line].is_used = named;
}

/* Whether the line above the rows names all columns but an index or rates; then takes it. Pandas
 * has the name of an index alone below the others. */
static bool take_short_heading(struct layout *l, size_t above)
{
    const struct row *r = &l->row[above];
    if (find_gaps(l) && take_names(l, above))
        return true;
    memset(l->skipped, 0, sizeof l->skipped);
    const size_t title = br_layout_next_text(l, above, -1);
    const bool is_index = l->by >= BR_BY_WIDE_BLANKS && r->count == 1 && !r->numbers &&
                          title < l->lines && !l->row[title].numbers;
    l->skipped[0] = true;
    bool found = has_index(l) && take_names(l, above);
    if (!found && is_index && take_names(l, title)) {
        l->fields->heading[0] = r->token->text;
        found = l->row[above].is_used = true;
    }
    l->skipped[0] = false;
    return found;
}

/* Of names that repeat, "N error EOC error EOC": how many are in each of the groups; 0: none. */
static size_t period_of(const struct layout *l, size_t groups)
{
    const char *const *name = l->fields->heading;
    for (size_t p = groups > 1 ? l->width / groups : 0; p > 0; p--) {
        bool repeats = true;
        for (size_t i = l->width - p * groups; i + p < l->width && repeats; i++)
            repeats = name[i] && name[i + p] && strcmp(name[i], name[i + p]) == 0;
        if (repeats)
            return p;
    }
    return 0;
}

/* Finds the group of each column (out; NULL: none) in a line above the heading. */
static bool find_groups(const struct layout *l, size_t line, const char **group)
{
    const struct row *r = &l->row[line];
    const size_t period = period_of(l, r->count);
    size_t column = 0;
    if (period && !r->numbers) {
        for (size_t i = 0; i < r->count * period; i++)
            group[l->width - r->count * period + i] = r->token[i / period].text;
        return true;
    }
    for (size_t i = 0; i < r->count && column < l->width; i++) {
        char *text = r->token[i].text;
        const size_t columns = columns_of(&text);
        for (size_t j = 0; j < columns && column < l->width; j++, column++)
            group[column] = *text ? text : column ? group[column - 1] : NULL;
    }
    return column == l->width;
}

/* Whether the names need those of the line above: two are the same, or all are units. */
static bool lack_groups(const struct layout *l)
{
    const char *const *name = l->fields->heading;
    bool units = true, same = false;
    for (size_t i = 0; i < l->width; i++) {
        units &= name[i] && strchr("[(", *name[i]);
        for (size_t j = 0; j < i && l->width < 100; j++)
            same |= name[i] && name[j] && strcmp(name[i], name[j]) == 0;
    }
    return units || same;
}

/* Puts a line of groups before the names below it: rho, and error, EOC. */
static enum br_status join_groups(struct layout *l, size_t line)
{
    const char **name = l->fields->heading;
    if (!lack_groups(l))
        return BR_OK;
    const char **group = br_store_take(&l->fields->store, l->width, sizeof *group);
    if (!group)
        return br_no_memory(l->err, "the table");
    if (!find_groups(l, line, group))
        return BR_OK;
    for (size_t i = 0; i < l->width; i++) {
        const char *own = name[i] ? name[i] : "", *above = group[i] ? group[i] : "";
        char *joined = br_store_take(&l->fields->store, strlen(own) + strlen(above) + 2, 1);
        if (!joined)
            return br_no_memory(l->err, "the table");
        sprintf(joined, "%s%s%s", above, *own && *above ? " " : "", own);
        name[i] = *joined ? joined : NULL;
    }
    l->row[line].is_used = true;
    return BR_OK;
}

/* Whether the first row is a heading of words and numbers: "p,1,2,3". */
static bool has_names_in_row(const struct layout *l)
{
    bool words = false;
    const struct row *r = &l->row[l->first];
    for (size_t i = 0; i < l->width && l->rows > 2 && r->count == l->width; i++)
        words |= r->token[i].content >= BR_WORD && l->has_number[i] + 1 >= l->rows;
    return words;
}

/* Whether a line without the rows' number of names may be a title, and is no heading that lacks
 * some. */
static bool is_title(const struct layout *l, size_t line)
{
    const char *const text = l->line[line].text;
    return l->row[line].count < 2 || strchr(":.[({=", text[strlen(text) - 1]) ||
           (l->by >= BR_BY_WIDE_BLANKS && l->line[line].number + 1 < l->line[l->first].number);
}

enum br_status br_layout_find_heading(struct layout *l)
{
    const size_t above = br_layout_next_text(l, l->first, -1), first = l->first;
    for (size_t i = 0; i < l->width && l->by <= BR_BY_COLONS; i++) {
        l->fields->heading[i] = l->row[first].token[i].name;
        l->fields->heading_line = l->line[first].number;
    }
    if (l->by <= BR_BY_COLONS)
        return BR_OK;
    if (above < l->lines && (take_names_above(l, above) || take_names(l, above))) {
        const size_t group = br_layout_next_text(l, above, -1);
        return group < l->lines ? join_groups(l, group) : BR_OK;
    }
    for (size_t i = l->first; i-- > 0;)
        if (l->line[i].kind == BR_LINE_COMMENT && take_names(l, i))
            return BR_OK;
    if (has_names_in_row(l)) {
        l->row[first].is_row = false;
        l->first = br_layout_next_text(l, first, 1);
        take_names(l, first);
        return BR_OK;
    }
    if (above < l->lines && take_short_heading(l, above))
        return BR_OK;
    if (above == l->lines || is_title(l, above))
        return BR_OK;
    if (l->row[above].numbers)
        return br_layout_refuse_row(l, above, "first row");
    const size_t count = l->row[above].count;
    const size_t row =
        l->width > count && br_layout_is_short(l, first) ? br_layout_next_text(l, first, 1) : first;
    return br_fail(l->err, BR_BAD_INPUT, "%s:%zu: found %s than the %zu fields of the heading",
                   l->path, l->line[row].number, l->width > count ? "more" : "fewer", count);
}
