/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Studies of one table, which words, degrees or numbers of a column tell apart. */
#include "orders/reading/roles.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/quote.h"
#include "base/words.h"

/* Whether a field is this word, or this number. */
static bool is_field(const struct br_roles *r, size_t row, size_t column, const char *word)
{
    struct br_field_number a, b;
    const char *text = br_role_field(r, row, column);
    return text && (strcmp(text, word) == 0 ||
                    (br_field_read(text, r->fields->mark, &a) &&
                     br_field_read(word, r->fields->mark, &b) && a.value == b.value));
}

enum br_status br_roles_take_where(struct br_roles *r, struct br_error *err)
{
    const char *where = r->wishes->where, *equals = where ? strchr(where, '=') : NULL;
    size_t kept = 0, column = BR_NO_ROW;
    char place[32];
    if (!where)
        return BR_OK;
    while (equals &&
           (column = br_roles_find_column(r, where, (size_t)(equals - where))) == BR_NO_ROW)
        equals = strchr(equals + 1, '=');
    if (!equals && !strchr(where, '='))
        return br_fail(err, BR_BAD_INPUT, "--where: found '%s', expected COLUMN=WORD", where);
    if (!equals)
        return br_roles_refuse_column(r, "--where", where, strcspn(where, "="), err);
    for (size_t i = 0; i < r->rows; i++)
        if (is_field(r, i, column, equals + 1))
            kept++;
        else if (!r->dropped[i])
            r->dropped[i] = "--where chooses others";
    if (!kept)
        return br_fail(err, BR_BAD_INPUT, "%s: --where: no row has %s = '%s', as %s has '%s'",
                       r->wishes->path, r->column[column].label, equals + 1,
                       r->rows ? br_row_place(r->fields, 0, place) : "none",
                       r->rows && br_role_field(r, 0, column) ? br_role_field(r, 0, column) : "");
    for (size_t i = 0; i < r->columns; i++)
        br_roles_read_column(r, i);
    r->column[column].why = "--where chooses by it";
    return BR_OK;
}

/* The number of different fields of a column, where each is there three times; 0: it tells no cases
 * apart. */
static size_t count_cases(const struct br_roles *r, size_t column)
{
    enum { MOST = 100, LEAST = 3 };
    size_t first[MOST], times[MOST], count = 0;
    for (size_t i = 0; i < r->rows; i++) {
        size_t k = 0;
        if (r->dropped[i])
            continue;
        while (k < count &&
               strcmp(br_role_text(r, first[k], column), br_role_text(r, i, column)) != 0)
            k++;
        if (k == MOST)
            return 0;
        if (k == count) {
            first[count] = i;
            times[count++] = 0;
        }
        times[k]++;
    }
    for (size_t k = 0; k < count; k++)
        if (times[k] < LEAST)
            return 0;
    return count > 1 ? count : 0;
}

/* Whether some column that is called a size has a number twice: a column of numbers may then tell
 * cases apart. whole: also one of whole numbers. */
static bool a_size_repeats(const struct br_roles *r, size_t but, bool whole)
{
    for (size_t i = 0; i < r->columns; i++) {
        const struct br_role_column *c = &r->column[i];
        if (i == but || c->words || !(c->least < c->most) ||
            !(c->stated || c->named >= BR_USUAL_NAME ||
              (whole && c->is_whole && c->kind == BR_KIND_UNKNOWN)))
            continue;
        for (size_t a = 0; a < r->rows; a++)
            for (size_t b = 0; b < a; b++)
                if (c->number[a] == c->number[b])
                    return true;
    }
    return false;
}

/* Whether a word of a column counts for the empty fields below it, too: where sizes begin anew. */
static bool fills_down(const struct br_roles *r, size_t column)
{
    const struct br_role_column *c = &r->column[column];
    size_t empty = 0;
    for (size_t i = 0; i < r->rows; i++)
        empty += !br_role_field(r, i, column);
    return c->words && !c->numbers && empty && br_role_field(r, 0, column) &&
           a_size_repeats(r, column, true);
}

/* The step by which small whole numbers count up; 0: there is none. */
static int step_of(const struct br_roles *r, const struct br_role_column *c)
{
    bool found[32] = {false};
    int step = 0;
    if (!c->is_whole || c->words || c->least < 0 || c->most > 31)
        return 0;
    for (size_t i = 0; i < r->rows; i++)
        if (!isnan(c->number[i]))
            found[(int)c->number[i]] = true;
    for (int i = (int)c->least + 1, before = i - 1; i <= (int)c->most; i++) {
        if (!found[i])
            continue;
        if (step && i - before != step)
            return 0;
        step = i - before;
        before = i;
    }
    return step;
}

/* Small whole numbers that are called a degree; p only if they count by one step, an order or k if
 * that is one. */
static bool is_degree(const struct br_roles *r, const struct br_role_column *c)
{
    const bool word = c->kind == BR_KIND_DEGREE;
    const bool letter = c->name && !c->name[1];
    const bool other =
        (letter && *c->name == 'k') || (c->kind == BR_KIND_RATE && c->numbers == r->rows);
    if (c->stated || c->role != BR_ROLE_ASIDE || c->by_hand)
        return c->by_hand && word;
    const int step = step_of(r, c);
    return word && !letter ? c->is_whole && !c->words && c->most <= 64
                           : (word ? step > 0 : other && step == 1) && c->most <= 20;
}

/* Whether a column follows from another: rows of one field there have one field here. */
static bool follows(const struct br_roles *r, size_t column, size_t other)
{
    bool again = false;
    for (size_t a = 0; a < r->rows; a++)
        for (size_t b = 0; b < a; b++) {
            if (r->dropped[a] || r->dropped[b] ||
                strcmp(br_role_text(r, a, other), br_role_text(r, b, other)) != 0)
                continue;
            again = true;
            if (strcmp(br_role_text(r, a, column), br_role_text(r, b, column)) != 0)
                return false;
        }
    return again;
}

/* Whether a column tells cases apart: by words or degrees, or by other numbers. */
static bool tells_cases(const struct br_roles *r, size_t i, bool by_numbers)
{
    const struct br_role_column *c = &r->column[i];
    const bool degree = is_degree(r, c);
    if (c->stated || c->why || c->role == BR_ROLE_ERROR || !count_cases(r, i))
        return false;
    if (!by_numbers)
        return c->words ? c->numbers == 0 : degree;
    if (c->words || degree || c->kind != BR_KIND_UNKNOWN || c->named >= BR_USUAL_NAME ||
        !a_size_repeats(r, i, false))
        return false;
    for (size_t k = 0; k < r->columns; k++)
        if (k != i &&
            (r->column[k].role == BR_ROLE_CASE || r->column[k].stated ||
             r->column[k].named >= BR_USUAL_NAME) &&
            follows(r, i, k))
            return false;
    return true;
}

/* Several columns of numbers tell studies apart: one is to be chosen. */
static enum br_status ask_where(const struct br_roles *r, size_t i, struct br_error *err)
{
    char item[240], quoted[300];
    size_t row = 0;
    while (r->dropped[row])
        row++;
    snprintf(item, sizeof item, "%.100s=%.100s", r->column[i].label, br_role_text(r, row, i));
    return br_fail(
        err, BR_BAD_INPUT, "%s: sizes repeat, and %s has several studies: --where %s chooses one",
        r->wishes->path, r->column[i].label, br_quoted(quoted, sizeof quoted, &br_for_shell, item));
}

/* "method = P1, degree = 2" */
static const char *name_group(struct br_roles *r, size_t row)
{
    char text[200] = "";
    for (size_t i = 0; i < r->columns; i++)
        if (r->column[i].role == BR_ROLE_CASE)
            br_append(text, sizeof text, "%s%s%s%s", *text ? ", " : "",
                      r->column[i].name ? r->column[i].name : "", r->column[i].name ? " = " : "",
                      br_role_text(r, row, i));
    return br_store_copy(&r->store, text);
}

enum br_status br_roles_find_cases(struct br_roles *r, struct br_error *err)
{
    for (size_t i = 0; i < r->columns; i++) {
        r->column[i].fills = fills_down(r, i);
        if (tells_cases(r, i, false))
            r->column[i].role = BR_ROLE_CASE;
    }
    size_t by_numbers = BR_NO_ROW;
    for (size_t i = 0; i < r->columns; i++)
        if (tells_cases(r, i, true)) {
            if (by_numbers != BR_NO_ROW)
                return ask_where(r, by_numbers, err);
            by_numbers = i;
        }
    if (by_numbers != BR_NO_ROW)
        r->column[by_numbers].role = BR_ROLE_CASE;
    for (size_t i = 0; i < r->columns; i++)
        if (r->column[i].role != BR_ROLE_CASE && is_degree(r, &r->column[i]))
            r->column[i].role = BR_ROLE_DEGREE;
    size_t *first = br_store_take(&r->store, r->rows + 1, sizeof *first);
    r->group_name = br_store_take(&r->store, r->rows + 1, sizeof *r->group_name);
    if (!first || !r->group_name)
        return br_no_memory(err, "the table");
    for (size_t i = 0; i < r->rows; i++) {
        size_t k = 0;
        if (r->dropped[i])
            continue;
        for (bool same = false; k < r->groups && !same; k += !same) {
            same = true;
            for (size_t c = 0; c < r->columns && same; c++)
                same = r->column[c].role != BR_ROLE_CASE ||
                       strcmp(br_role_text(r, first[k], c), br_role_text(r, i, c)) == 0;
        }
        if (k == r->groups) {
            first[k] = i;
            r->group_name[r->groups++] = name_group(r, i);
            if (!r->group_name[k])
                return br_no_memory(err, "the table");
        }
        r->group[i] = k;
    }
    return BR_OK;
}
