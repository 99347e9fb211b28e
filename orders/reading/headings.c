/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The headings of a table: names, units, --column, and refusals that list them. */
#include "orders/reading/roles.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/quote.h"
#include "base/words.h"

enum { LONGEST_ADVICE = 400 };

/* Whether the numbers of a column rise, or fall, from each row of a case to its next one. */
static bool is_monotone(const struct br_roles *r, const struct br_role_column *c)
{
    bool rises = c->number && c->numbers > 1 && !c->words, falls = rises;
    double before = NAN;
    for (size_t i = 0; i < r->rows && (rises || falls); i++) {
        if (isnan(c->number[i]))
            continue;
        rises &= !(before >= c->number[i]);
        falls &= !(before <= c->number[i]);
        before = c->number[i];
    }
    return rises || falls;
}

/* The column that may be a size most likely: of numbers that are monotone and have no other name,
 * or of numbers. */
static const struct br_role_column *likely_size(const struct br_roles *r)
{
    const struct br_role_column *best = NULL;
    int most = -1;
    for (size_t i = 0; i < r->columns; i++) {
        const struct br_role_column *c = &r->column[i];
        const int rank = (c->numbers && !c->words ? 1 : 0) +
                         (c->least > 0 && is_monotone(r, c) ? 2 : 0) +
                         (c->kind == BR_KIND_UNKNOWN ? 1 : 0);
        if (!c->shown || rank <= most)
            continue;
        most = rank;
        best = c;
    }
    return best;
}

static void list_headings(const struct br_roles *r, char names[300])
{
    char name[80];
    *names = '\0';
    for (size_t i = 0; i < r->columns; i++) {
        if (!r->column[i].shown)
            continue;
        br_quoted(name, sizeof name, &br_for_text, r->column[i].shown);
        if (strlen(names) + strlen(name) + 8 < 300)
            br_append(names, 300, "%s%s", names[0] ? ", " : "", name);
        else if (!strstr(names, ", ..."))
            br_append(names, 300, ", ...");
    }
}

/* How to name a column, "--column 'dx=h' says what a column is", and what a word may mean. */
static void advise_column(const struct br_roles *r, const char *word, char text[LONGEST_ADVICE])
{
    enum { MOST = 64 };
    const char *headings[MOST] = {0};
    size_t count = 0;
    char name[80], item[90], quoted[120], suggestion[BR_SUGGESTION] = "";
    const struct br_role_column *size = likely_size(r);
    for (size_t i = 0; i < r->columns && count < MOST; i++)
        if (r->column[i].shown)
            headings[count++] = r->column[i].shown;
    if (word)
        br_suggestion(word, headings, count, suggestion);
    snprintf(item, sizeof item, "%s=h",
             size ? br_quoted(name, sizeof name, &br_for_text, size->shown) : "1");
    snprintf(text, LONGEST_ADVICE,
             "--column %s says what a column is (h, n, dofs, cells, points, interior, level, k, "
             "dt, steps, degree, std or aside)%s",
             br_quoted(quoted, sizeof quoted, &br_for_shell, item), suggestion);
}

enum br_status br_roles_refuse(const struct br_roles *r, const char *why, const char *advice,
                               struct br_error *err)
{
    char names[300], usual[LONGEST_ADVICE];
    const size_t line = r->fields->heading_line ? r->fields->heading_line : 1;
    list_headings(r, names);
    if (!*names)
        return br_fail(err, BR_BAD_INPUT,
                       "%s:%zu: %s: there is no heading; --column 1=h,2=error names columns",
                       r->wishes->path, line, why);
    if (!advice)
        advise_column(r, NULL, usual);
    return br_fail(err, BR_BAD_INPUT, "%s:%zu: %s among %s; %s", r->wishes->path, line, why, names,
                   advice ? advice : usual);
}

/* ---- names ---- */

/* Splits "dt [s]" or "dt (s)" in place, at the last bracket; NULL: there is no unit. */
static char *split_unit(char *heading)
{
    const size_t length = strlen(heading);
    const char last = length ? heading[length - 1] : '\0';
    char *open = last == ']' ? strrchr(heading, '[') : last == ')' ? strrchr(heading, '(') : NULL;
    if (!open || open == heading || strchr("^*/", open[-1]) ||
        (open - heading >= 3 && memcmp(open - 3, "qrt", 3) == 0)) /* a formula */
        return NULL;
    heading[length - 1] = '\0';
    char *end = open;
    while (end > heading && isspace((unsigned char)end[-1]))
        end--;
    *end = '\0';
    return open[1] ? open + 1 : NULL;
}

static void weigh_name(struct br_role_column *c)
{
    c->named = 0;
    for (int i = 0; i < BR_RESOLUTIONS; i++) {
        c->odds[i] = br_name_odds(c->name, c->unit, &br_resolution_columns[i]);
        c->named = c->by_hand ? 0 : fmax(c->named, c->odds[i]);
    }
}

static enum br_status name_column(struct br_roles *r, size_t i, struct br_error *err)
{
    struct br_role_column *c = &r->column[i];
    c->shown = r->fields->heading ? r->fields->heading[i] : NULL;
    if (!c->shown || !*c->shown) {
        c->shown = NULL;
        return BR_OK;
    }
    const size_t digits = strspn(c->shown, "0123456789"); /* gnuplot: "1:n" */
    const bool counted = digits && c->shown[digits] == ':' && c->shown[digits + 1];
    const char *text = c->shown + (counted ? digits + 1 : 0);
    char *name = br_store_copy(&r->store, text);
    if (!name)
        return br_no_memory(err, "the table");
    c->name = name;
    c->unit = split_unit(name);
    c->unit = c->unit && br_is_logarithm(c->unit) ? NULL : c->unit; /* "error (log10)" */
    if (!c->unit && (strcmp(name, text) != 0 || !(c->unit = br_unit_behind_slash(name))))
        strcpy(name, text);
    weigh_name(c);
    for (size_t j = 0; j < r->columns && c->unit && c->named < BR_USUAL_NAME; j++)
        if (j != i && r->fields->heading[j] &&
            strncmp(r->fields->heading[j], text, (size_t)(c->unit - name)) == 0) {
            strcpy(name, text); /* "L2(u)", "L2(p)": no units */
            c->unit = NULL;
        }
    c->rates_in_brackets = c->unit && br_kind_of(c->unit) == BR_KIND_RATE;
    c->unit = c->rates_in_brackets ? NULL : c->unit;
    c->kind = br_kind_of(c->name);
    return BR_OK;
}

/* ---- --column ---- */

static bool is_called(const struct br_role_column *c, const char *text, size_t length,
                      int (*compare)(const char *, const char *, size_t))
{
    const char *const names[] = {c->name, c->shown};
    bool is = false;
    for (int i = 0; i < 2; i++)
        is |= names[i] && strlen(names[i]) == length && compare(names[i], text, length) == 0;
    return is;
}

size_t br_roles_find_column(const struct br_roles *r, const char *text, size_t length)
{
    size_t found = BR_NO_ROW, count = 0;
    for (size_t i = 0; i < r->columns; i++)
        if (is_called(&r->column[i], text, length, strncmp))
            return i;
    for (size_t i = 0; i < r->columns; i++)
        if (is_called(&r->column[i], text, length, strncasecmp)) {
            found = i;
            count++;
        }
    if (count == 1)
        return found;
    const unsigned long position = strtoul(text, NULL, 10);
    return length && strspn(text, "0123456789") >= length && position > 0 && position <= r->columns
               ? position - 1
               : BR_NO_ROW;
}

enum br_status br_roles_refuse_column(const struct br_roles *r, const char *option,
                                      const char *text, size_t length, struct br_error *err)
{
    char why[120], word[60], advice[LONGEST_ADVICE];
    snprintf(word, sizeof word, "%.*s", length < 59 ? (int)length : 59, text);
    snprintf(why, sizeof why, "%s: found no column '%s'", option, word);
    advise_column(r, word, advice);
    return br_roles_refuse(r, why, advice, err);
}

/* Names a column as an item of --column says: its heading or position, '=', its name or what it
 * states. */
static enum br_status take_item(struct br_roles *r, const char *item, size_t length,
                                struct br_error *err)
{
    const char *equals = item + length, *inside = item, *quoted = br_list_quoted(&inside);
    while (equals > item && *equals != '=')
        equals--;
    const size_t rest = length - (size_t)(equals - item);
    const bool in_quotes = quoted && quoted == equals;
    const char *heading = in_quotes ? inside : item;
    const size_t size = (size_t)(equals - heading) - in_quotes;
    if (!size || rest < 2)
        return br_fail(err, BR_BAD_INPUT,
                       "--column: found '%.*s', expected COLUMN=NAME, as in dx=h or 1=h",
                       (int)length, item);
    const size_t found = br_roles_find_column(r, heading, size);
    if (found == BR_NO_ROW)
        return br_roles_refuse_column(r, "--column", heading, size, err);
    struct br_role_column *c = &r->column[found];
    if (c->by_hand)
        return br_fail(err, BR_BAD_INPUT, "--column: found '%.*s', expected each column once",
                       (int)length, item);
    char *name = br_store_take(&r->store, rest, 1);
    if (!name)
        return br_no_memory(err, "the table");
    memcpy(name, equals + 1, rest - 1);
    c->by_hand = true;
    c->stated = br_resolution_column_find(name);
    c->kind = BR_KIND_UNKNOWN;
    if (c->stated) { /* it keeps its name and its unit, or is called by its position */
        char *position = br_store_take(&r->store, size + 1, 1);
        if (!position)
            return br_no_memory(err, "the table");
        memcpy(position, heading, size);
        c->name = c->name ? c->name : position;
    } else if (strcmp(name, "aside") == 0)
        c->why = "--column says so";
    else if (strcmp(name, "degree") == 0)
        c->kind = BR_KIND_DEGREE;
    else if (strcmp(name, "std") == 0)
        c->kind = BR_KIND_DEVIATION;
    else {
        c->name = name;
        c->unit = NULL;
        c->role = BR_ROLE_ERROR;
    }
    return BR_OK;
}

/* Gives the names of a list the case of their headings, and takes units off: "flow (m/s)" is called
 * "flow". */
static void settle_names(const struct br_roles *r, char *list)
{
    const char *item;
    size_t length;
    for (const char *rest = list; rest;) {
        rest = br_list_next(rest, &item, &length);
        const size_t found = br_roles_find_column(r, item, length);
        const struct br_role_column *c = found == BR_NO_ROW ? NULL : &r->column[found];
        const size_t size = c && c->name ? strlen(c->name) : 0;
        if (!size || size > length || !(is_called(c, item, length, strncasecmp)))
            continue;
        char *const to = list + (item - list);
        memcpy(to, c->name, size);
        memmove(to + size, to + length, strlen(to + length) + 1);
        if (rest)
            rest -= length - size;
    }
}

/* "err_sigma" beside "err" has deviations; alone it is the error of a stress. */
static void find_deviations(struct br_roles *r)
{
    for (size_t i = 0; i < r->columns; i++)
        for (size_t k = 0; k < r->columns && r->column[i].name; k++) {
            const char *of = r->column[k].name;
            if (k != i && of && of[1] && r->column[i].kind == BR_KIND_ERROR &&
                strstr(r->column[i].name, "sigma") && strstr(r->column[i].name, of))
                r->column[i].kind = BR_KIND_DEVIATION;
        }
}

/* For a trade: the column of costs is no error, and unknowns beside another size are a cost. */
static void leave_costs(struct br_roles *r)
{
    const char *cost = r->wishes->cost;
    bool sizes = false;
    double factor;
    for (size_t i = 0; i < r->columns; i++)
        for (int s = 0; s < BR_RESOLUTIONS; s++)
            sizes |= br_resolution_columns[s].axis == BR_AXIS_SPACE &&
                     !br_resolution_columns[s].is_volume && r->column[i].odds[s] >= BR_USUAL_NAME;
    for (struct br_role_column *c = r->column; c < r->column + r->columns && cost; c++)
        if (c->name && !c->by_hand &&
            ((strcmp(c->name, cost) == 0 && c->named < BR_USUAL_NAME) ||
             (sizes && br_cost_of(c->name, c->unit, &factor) == BR_COST_DOFS))) {
            c->by_hand = true;
            c->why = "the cost";
        }
}

enum br_status br_roles_take_headings(struct br_roles *r, struct br_error *err)
{
    const char *item;
    size_t length;
    bool gci = false;
    for (size_t i = 0; i < r->columns; i++)
        if (name_column(r, i, err))
            return err->status;
    for (const char *list = r->wishes->columns; list;) {
        list = br_list_next(list, &item, &length);
        if (take_item(r, item, length, err))
            return err->status;
    }
    settle_names(r, r->wishes->errors);
    settle_names(r, r->wishes->values);
    for (size_t i = 0; i < r->columns; i++) {
        struct br_role_column *c = &r->column[i];
        snprintf(c->position, sizeof c->position, "%zu", i + 1);
        c->label = c->name ? c->name : c->position;
        weigh_name(c);
        if ((br_lists(r->wishes->errors, c->name) || br_lists(r->wishes->values, c->name)) &&
            !c->stated && c->named < BR_USUAL_NAME)
            c->role = BR_ROLE_ERROR;
        c->is_value = br_lists(r->wishes->values, c->name);
        gci |= c->name && strcasestr(c->name, "gci");
    }
    find_deviations(r);
    leave_costs(r);
    for (size_t i = 0; i < r->columns && gci; i++) /* r is the ratio of two sizes, p one order */
        if (r->column[i].name && !r->column[i].name[1] && strchr("rp", *r->column[i].name) &&
            !r->column[i].by_hand)
            r->column[i].kind = BR_KIND_FACTOR;
    return BR_OK;
}
