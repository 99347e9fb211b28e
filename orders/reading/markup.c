/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables of HTML: each row becomes one of LaTeX, with "&" and "\\", on the line where it begins;
 * what stands outside of tables becomes comments, but no row of Markdown. */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "orders/reading/lines.h"
#include "orders/reading/reading.h"

enum { MOST_SPAN = 100 };

struct page {
    struct br_store *store; /* of all that is pointed to */
    char *out;
    size_t length, room;
    size_t newlines; /* in the row: they come behind it */
    size_t column;   /* of the next cell */
    bool in_table, in_row, in_cell, in_text;
    bool has_data;        /* a cell of the table was no heading */
    size_t cell;          /* where its text begins */
    size_t columns, rows; /* that it spans */
    struct above {
        const char *text;
        size_t rows;                      /* below that it spans */
    } above[BR_MOST_COLUMNS + MOST_SPAN]; /* by column */
};

/* Puts a text, and the zero behind it. */
static void put(struct page *p, const char *text)
{
    do {
        p->out = br_store_grow(p->store, p->out, p->length, &p->room, 1);
        if (!p->out)
            return;
        p->out[p->length++] = *text;
    } while (*text++);
    p->length--;
}

/* ---- text ---- */

/* Puts the sign that an entity stands for, "&nbsp;"; returns what follows. */
static const char *put_entity(struct page *p, const char *at)
{
    static const char *const signs[][2] = {
        {"nbsp", " "},        {"#160", " "},      {"minus", "-"},     {"#8722", "-"},
        {"ndash", "-"},       {"mdash", "-"},     {"lt", "<"},        {"gt", ">"},
        {"times", "\\times"}, {"sdot", "\\cdot"}, {"plusmn", "\\pm"}, {"amp", "+"}};
    char name[12];
    const size_t length = strcspn(at + 1, "; <&\n");
    if (at[1 + length] != ';' || length >= sizeof name) {
        put(p, "+");
        return at + 1;
    }
    snprintf(name, sizeof name, "%.*s", (int)length, at + 1);
    for (size_t i = 0; i < sizeof signs / sizeof *signs; i++)
        if (strcmp(name, signs[i][0]) == 0) {
            put(p, signs[i][1]);
            return at + length + 2;
        }
    put(p, name);
    return at + length + 2;
}

/* ---- cells ---- */

/* Puts the cells of rows above that span this column; returns the next column. */
static void put_above(struct page *p)
{
    struct above *above = &p->above[p->column];
    for (; p->column < BR_MOST_COLUMNS && above->rows; above = &p->above[++p->column]) {
        above->rows--;
        put(p, p->column ? " & " : "");
        put(p, above->text);
    }
}

static void end_cell(struct page *p)
{
    if (!p->in_cell || p->store->failed)
        return;
    p->in_cell = false;
    for (size_t i = 0; i < p->columns && p->column < BR_MOST_COLUMNS; i++, p->column++)
        if (p->rows > 1) {
            const char *const text = p->has_data ? br_store_copy(p->store, p->out + p->cell) : "";
            p->above[p->column] = (struct above){text ? text : "", p->rows - 1};
        }
    if (p->columns > 1)
        put(p, "}");
}

static void end_row(struct page *p)
{
    end_cell(p);
    if (p->in_row) {
        put_above(p);
        put(p, " \\\\");
    }
    p->in_row = false;
    for (; p->newlines && !p->store->failed; p->newlines--)
        put(p, "\n");
}

/* The number of an attribute, "colspan=2"; 1: it has none. */
static size_t span_of(const char *tag, size_t length, const char *attribute)
{
    char text[200];
    snprintf(text, sizeof text, "%.*s", length < sizeof text ? (int)length : 199, tag);
    const char *at = strcasestr(text, attribute);
    at = at ? at + strlen(attribute) + strspn(at + strlen(attribute), " =\"'") : "1";
    const unsigned long span = strtoul(at, NULL, 10);
    return span < 1 ? 1 : span > MOST_SPAN ? MOST_SPAN : span;
}

static void begin_cell(struct page *p, const char *tag, size_t length)
{
    char group[40];
    end_cell(p);
    put_above(p);
    put(p, p->column ? " & " : "");
    p->has_data |= strncasecmp(tag, "<td", 3) == 0;
    p->columns = span_of(tag, length, "colspan");
    p->rows = span_of(tag, length, "rowspan");
    snprintf(group, sizeof group, "\\multicolumn{%zu}{c}{", p->columns);
    if (p->columns > 1)
        put(p, group);
    p->in_cell = true;
    p->cell = p->length;
}

/* ---- tags ---- */

static bool is_tag(const char *at, const char *name)
{
    const size_t length = strlen(name);
    return strncasecmp(at, name, length) == 0 && at[length] && strchr(" \t\r\n>/", at[length]);
}

static void put_newline(struct page *p)
{
    p->newlines += p->in_row;
    p->in_text = false;
    put(p, p->in_cell ? " " : p->in_row ? "" : "\n");
}

/* The end of a tag, of a comment, or of a script. */
static const char *tag_end(const char *at)
{
    const char *const ends[][2] = {
        {"<!--", "-->"}, {"<script", "</script>"}, {"<style", "</style>"}, {"", ">"}};
    size_t i = 0;
    while (strncasecmp(at, ends[i][0], strlen(ends[i][0])) != 0)
        i++;
    const char *const end = strcasestr(at, ends[i][1]);
    return end ? end + strlen(ends[i][1]) : at + strlen(at);
}

static const char *take_tag(struct page *p, const char *at)
{
    const char *const end = tag_end(at);
    const bool begins_row = p->in_table && is_tag(at, "<tr");
    if (begins_row || is_tag(at, "<table"))
        end_row(p);
    p->column = begins_row ? 0 : p->column;
    p->in_row |= begins_row;
    for (const char *c = at; c < end; c++)
        if (*c == '\n')
            put_newline(p);
    if (is_tag(at, "<table")) {
        p->in_table = true;
        p->in_text = p->has_data = false;
        memset(p->above, 0, sizeof p->above);
    } else if (is_tag(at, "</tr") || is_tag(at, "</table")) {
        end_row(p);
        p->in_table &= !is_tag(at, "</table");
    } else if (p->in_row && (is_tag(at, "<td") || is_tag(at, "<th")))
        begin_cell(p, at, (size_t)(end - at));
    else if (is_tag(at, "</td") || is_tag(at, "</th"))
        end_cell(p);
    else if (p->in_cell)
        put(p, is_tag(at, "<sup") ? "^" : is_tag(at, "<br") ? " " : "");
    return end;
}

/* Takes a character; those that separate fields, or begin quotes and comments, are replaced. */
static void take_character(struct page *p, char c)
{
    const char text[] = {c, '\0'};
    const bool shown = p->in_cell || (!p->in_table && (p->in_text || !strchr(" \t\r", c)));
    if (!shown)
        return;
    if (!p->in_cell && !p->in_text && c != '|') /* of Markdown */
        put(p, "# ");
    p->in_text = !p->in_cell;
    put(p, c == '"' ? "'" : c == '#' ? "no" : text);
}

enum br_status br_markup_flatten(char **text, struct br_store *store, struct br_error *err)
{
    const char *at = *text;
    if (!strcasestr(at, "<tr") || !strcasestr(at, "<td"))
        return BR_OK;
    struct page *p = br_store_take(store, 1, sizeof *p);
    if (!p)
        return br_no_memory(err, "the table");
    *p = (struct page){.store = store, .in_table = !strcasestr(at, "<table")};
    while (*at && !store->failed) {
        const bool is_entity = *at == '&' && p->in_cell;
        if (*at == '<' && (isalpha((unsigned char)at[1]) || strchr("/!", at[1])))
            at = take_tag(p, at);
        else if (is_entity)
            at = put_entity(p, at);
        else if (*at++ == '\n')
            put_newline(p);
        else
            take_character(p, at[-1]);
    }
    end_row(p);
    *text = p->out;
    return store->failed ? br_no_memory(err, "the table") : BR_OK;
}
