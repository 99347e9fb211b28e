/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "orders/reading/roles.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/quote.h"
#include "base/words.h"

enum { LONGEST_ADVICE = 400 };

static const char *field_at(const struct br_roles *r, size_t row, size_t column)
{
    return r->fields->field[row * r->columns + column];
}

static char *copy_text(struct br_roles *r, const char *text)
{
    char *copy = br_store_take(&r->store, strlen(text) + 1, 1);
    return copy ? strcpy(copy, text) : NULL;
}

char *br_row_place(const struct br_fields *f, size_t row, char text[32])
{
    snprintf(text, 32, f->line[row] ? "line %zu" : "row %zu",
             f->line[row] ? f->line[row] : row + 1);
    return text;
}

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
    if (!c->shown)
        return BR_OK;
    const size_t digits = strspn(c->shown, "0123456789"); /* gnuplot: "1:n" */
    const bool counted = digits && c->shown[digits] == ':' && c->shown[digits + 1];
    const char *text = c->shown + (counted ? digits + 1 : 0);
    char *name = copy_text(r, text);
    if (!name)
        return br_no_memory(err, "the table");
    c->name = name;
    c->unit = split_unit(name);
    if (!c->unit && !(c->unit = br_unit_behind_slash(name)))
        strcpy(name, text);
    weigh_name(c);
    for (size_t j = 0; j < r->columns && c->unit && c->named < BR_USUAL_NAME; j++)
        if (j != i && r->fields->heading[j] &&
            strncmp(r->fields->heading[j], text, (size_t)(c->unit - name)) == 0) {
            strcpy(name, text); /* "L2(u)", "L2(p)": no units */
            c->unit = NULL;
        }
    c->kind = br_kind_of(c->name);
    return BR_OK;
}

/* ---- --column ---- */

/* The column of a heading or a position; BR_NO_ROW: there is none. */
static size_t find_column(const struct br_roles *r, const char *text, size_t length)
{
    for (size_t i = 0; i < r->columns; i++) {
        const char *names[] = {r->column[i].name, r->column[i].shown};
        for (int k = 0; k < 2; k++)
            if (names[k] && strlen(names[k]) == length && memcmp(names[k], text, length) == 0)
                return i;
    }
    const unsigned long position = strtoul(text, NULL, 10);
    return length && strspn(text, "0123456789") >= length && position > 0 && position <= r->columns
               ? position - 1
               : BR_NO_ROW;
}

static enum br_status refuse_column(const struct br_roles *r, const char *option, const char *text,
                                    size_t length, struct br_error *err)
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
    item = in_quotes ? inside : item;
    const size_t size = (size_t)(equals - item) - in_quotes;
    if (!size || rest < 2)
        return br_fail(err, BR_BAD_INPUT,
                       "--column: found '%.*s', expected COLUMN=NAME, as in dx=h or 1=h",
                       (int)length, item);
    const size_t found = find_column(r, item, size);
    if (found == BR_NO_ROW)
        return refuse_column(r, "--column", item, size, err);
    struct br_role_column *c = &r->column[found];
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
        memcpy(position, item, size);
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

/* For a trade: the column of costs is neither an error nor, beside another one, a size. */
static void leave_costs(struct br_roles *r)
{
    const char *cost = r->wishes->cost;
    double factor;
    for (size_t i = 0; i < r->columns && cost; i++) {
        struct br_role_column *c = &r->column[i];
        bool leaves = c->name && strcmp(c->name, cost) == 0 && c->named < BR_USUAL_NAME;
        for (size_t k = 0; k < r->columns && c->name && !c->by_hand; k++)
            for (int s = 0; s < BR_RESOLUTIONS && k != i; s++)
                leaves |= br_cost_of(c->name, c->unit, &factor) == BR_COST_DOFS &&
                          !br_resolution_columns[s].is_volume &&
                          r->column[k].odds[s] >= BR_USUAL_NAME;
        if (leaves) {
            c->by_hand = true;
            c->why = "the cost";
        }
    }
}

static enum br_status take_names(struct br_roles *r, struct br_error *err)
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

/* ---- numbers ---- */

/* The significant digits of a text, and its decimals where it has no exponent (else -1). */
static int digits_of(const char *text, int *decimals)
{
    int digits = 0;
    bool leading = true, point = false;
    *decimals = 0;
    for (; *text && !strchr("eEdDqQx\\^ (", *text); text++) {
        point |= *text == '.' || *text == ',';
        if (!isdigit((unsigned char)*text))
            continue;
        leading = leading && *text == '0';
        digits += !leading;
        *decimals += point;
    }
    if (*text)
        *decimals = -1;
    return digits;
}

/* Half a unit of the last digit that a column is printed to: as many decimals everywhere, or as
 * many digits, of which zeros at the end may be lost. */
static void find_rounding(struct br_roles *r, size_t column)
{
    struct br_role_column *c = &r->column[column];
    int most = 1, decimals = -2;
    for (size_t i = 0; i < r->rows; i++) {
        int of_row;
        if (isnan(c->number[i]))
            continue;
        const int digits = digits_of(field_at(r, i, column), &of_row);
        most = digits > most ? digits : most;
        decimals = decimals == -2 || decimals == of_row ? of_row : -1;
    }
    for (size_t i = 0; i < r->rows; i++) {
        const double number = fabs(c->number[i]);
        const double unit =
            decimals > 0 ? pow(10, -decimals) : pow(10, floor(log10(number)) + 1 - most);
        c->rounding[i] = number > 0 ? 0.5 * unit / number : 0;
    }
}

/* Reads the numbers of a column in the rows that are not left aside. */
static void read_numbers(struct br_roles *r, size_t column)
{
    struct br_role_column *c = &r->column[column];
    c->numbers = c->words = c->gaps = 0;
    c->is_whole = true;
    c->least = INFINITY;
    c->most = -INFINITY;
    for (size_t i = 0; i < r->rows; i++) {
        struct br_field_number n = {NAN, NAN};
        const char *text = field_at(r, i, column);
        c->number[i] = c->deviation[i] = NAN;
        if (r->dropped[i] || br_field_is_missing(text))
            continue;
        if (br_is_gap(text)) {
            c->gaps++;
            c->gap = text;
            continue;
        }
        if (r->fields->is_words[column] || !br_field_read(text, r->fields->mark, &n)) {
            c->words++;
            continue;
        }
        c->number[i] = n.value;
        c->deviation[i] = n.deviation;
        c->numbers++;
        c->is_whole &= n.value == floor(n.value);
        c->least = fmin(c->least, n.value);
        c->most = fmax(c->most, n.value);
    }
    c->is_whole &= c->numbers > 0;
    find_rounding(r, column);
}

static enum br_status take_numbers(struct br_roles *r, struct br_error *err)
{
    for (size_t i = 0; i < r->columns; i++) {
        double *room = br_store_take(&r->store, 3 * (r->rows + 1), sizeof *room);
        if (!room)
            return br_no_memory(err, "the table");
        r->column[i].number = room;
        r->column[i].deviation = room + r->rows;
        r->column[i].rounding = room + 2 * r->rows;
        read_numbers(r, i);
    }
    return BR_OK;
}

/* deal.II prints rates in columns without a heading, which begin or end with a gap. */
static void find_rates_without_a_name(struct br_roles *r)
{
    for (size_t i = 0; i < r->columns && r->rows > 2; i++) {
        struct br_role_column *c = &r->column[i];
        const bool gap = isnan(c->number[0]) || isnan(c->number[r->rows - 1]);
        if (r->fields->heading_line && !c->name && gap && c->numbers + 1 >= r->rows - 1 &&
            !c->words)
            c->kind = BR_KIND_RATE;
    }
}

/* Rows without a field are none. MOOSE writes a row of zeros before the first solution. */
static void drop_zeros(struct br_roles *r)
{
    for (size_t i = 0; i < r->rows; i++) {
        bool empty = true;
        for (size_t k = 0; k < r->columns && empty; k++)
            empty = !field_at(r, i, k);
        if (empty)
            r->dropped[i] = "an empty row";
    }
    bool zeros = r->columns > 2 && r->rows > 0;
    for (size_t i = 0; i < r->columns; i++)
        zeros = zeros && r->column[i].number[0] == 0;
    if (!zeros)
        return;
    r->dropped[0] = "a first row of zeros";
    for (size_t i = 0; i < r->columns; i++)
        read_numbers(r, i);
}

enum br_status br_roles_check_words(const struct br_roles *r, size_t column, struct br_error *err)
{
    const struct br_role_column *c = &r->column[column];
    struct br_field_number n;
    for (size_t i = 0; i < r->rows && c->words; i++) {
        const char *text = field_at(r, i, column);
        if (!r->dropped[i] && !br_field_is_missing(text) && !br_is_gap(text) &&
            (r->fields->is_words[column] || !br_field_read(text, r->fields->mark, &n)))
            return br_fail(
                err, BR_BAD_INPUT,
                "%s:%zu: %s: found '%.40s', expected a number, or nan where it is missing",
                r->wishes->path, r->fields->line[i], c->label, text);
    }
    return BR_OK;
}

/* Refuses words among the numbers of a column that is called a size. */
static enum br_status check_sizes(const struct br_roles *r, struct br_error *err)
{
    for (size_t i = 0; i < r->columns; i++) {
        const struct br_role_column *c = &r->column[i];
        const bool size = c->stated || c->named >= BR_USUAL_NAME;
        if (size && (c->stated || c->numbers > c->words) && br_roles_check_words(r, i, err))
            return err->status;
    }
    return BR_OK;
}

/* ---- cases ---- */

/* Whether a field is this word, or this number. */
static bool is_field(const struct br_roles *r, size_t row, size_t column, const char *word)
{
    struct br_field_number a, b;
    const char *text = field_at(r, row, column);
    return text && (strcmp(text, word) == 0 ||
                    (br_field_read(text, r->fields->mark, &a) &&
                     br_field_read(word, r->fields->mark, &b) && a.value == b.value));
}

/* Keeps the rows of one case: "method=P1". */
static enum br_status take_where(struct br_roles *r, struct br_error *err)
{
    const char *where = r->wishes->where, *equals = where ? strchr(where, '=') : NULL;
    size_t kept = 0, column = BR_NO_ROW;
    char place[32];
    if (!where)
        return BR_OK;
    while (equals && (column = find_column(r, where, (size_t)(equals - where))) == BR_NO_ROW)
        equals = strchr(equals + 1, '=');
    if (!equals && !strchr(where, '='))
        return br_fail(err, BR_BAD_INPUT, "--where: found '%s', expected COLUMN=WORD", where);
    if (!equals)
        return refuse_column(r, "--where", where, strcspn(where, "="), err);
    for (size_t i = 0; i < r->rows; i++)
        if (is_field(r, i, column, equals + 1))
            kept++;
        else if (!r->dropped[i])
            r->dropped[i] = "--where chooses others";
    if (!kept)
        return br_fail(err, BR_BAD_INPUT, "%s: --where: no row has %s = '%s', as %s has '%s'",
                       r->wishes->path, r->column[column].label, equals + 1,
                       r->rows ? br_row_place(r->fields, 0, place) : "none",
                       r->rows && field_at(r, 0, column) ? field_at(r, 0, column) : "");
    for (size_t i = 0; i < r->columns; i++)
        read_numbers(r, i);
    r->column[column].why = "--where chooses by it";
    return BR_OK;
}

static const char *text_of(const struct br_roles *r, size_t row, size_t column)
{
    const char *text = field_at(r, row, column);
    return text ? text : "";
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
        while (k < count && strcmp(text_of(r, first[k], column), text_of(r, i, column)) != 0)
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
 * cases apart. */
static bool a_size_repeats(const struct br_roles *r, size_t but)
{
    for (size_t i = 0; i < r->columns; i++) {
        const struct br_role_column *c = &r->column[i];
        if (i == but || c->words || !(c->least < c->most) ||
            !(c->stated || c->named >= BR_USUAL_NAME))
            continue;
        for (size_t a = 0; a < r->rows; a++)
            for (size_t b = 0; b < a; b++)
                if (c->number[a] == c->number[b])
                    return true;
    }
    return false;
}

static bool is_consecutive(const struct br_roles *r, const struct br_role_column *c)
{
    bool seen[32] = {false};
    if (!c->is_whole || c->words || c->least < 0 || c->most > 31)
        return false;
    for (size_t i = 0; i < r->rows; i++)
        if (!isnan(c->number[i]))
            seen[(int)c->number[i]] = true;
    for (int i = (int)c->least; i <= (int)c->most; i++)
        if (!seen[i])
            return false;
    return c->least < c->most;
}

/* Small whole numbers that are called a degree; an order, p or k only if they count by one. */
static bool is_degree(const struct br_roles *r, const struct br_role_column *c)
{
    const bool word = c->kind == BR_KIND_DEGREE;
    const bool letter = c->name && !c->name[1];
    const bool other =
        (letter && *c->name == 'k') || (c->kind == BR_KIND_RATE && c->numbers == r->rows);
    if (c->stated || c->role != BR_ROLE_ASIDE || c->by_hand)
        return c->by_hand && word;
    return word && !letter ? c->is_whole && !c->words && c->most <= 64
                           : (word || other) && is_consecutive(r, c) && c->most <= 20;
}

/* Whether a column follows from another: rows of one field there have one field here. */
static bool follows(const struct br_roles *r, size_t column, size_t other)
{
    bool again = false;
    for (size_t a = 0; a < r->rows; a++)
        for (size_t b = 0; b < a; b++) {
            if (r->dropped[a] || r->dropped[b] ||
                strcmp(text_of(r, a, other), text_of(r, b, other)) != 0)
                continue;
            again = true;
            if (strcmp(text_of(r, a, column), text_of(r, b, column)) != 0)
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
        !a_size_repeats(r, i))
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
    snprintf(item, sizeof item, "%.100s=%.100s", r->column[i].label, text_of(r, row, i));
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
                      text_of(r, row, i));
    return copy_text(r, text);
}

static enum br_status find_cases(struct br_roles *r, struct br_error *err)
{
    for (size_t i = 0; i < r->columns; i++)
        if (tells_cases(r, i, false))
            r->column[i].role = BR_ROLE_CASE;
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
                       strcmp(text_of(r, first[k], c), text_of(r, i, c)) == 0;
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

/* ---- no column of a resolution ---- */

/* Whether rates stand without sizes, and nothing else may count: then h halves from row to row. */
static bool may_halve(const struct br_roles *r)
{
    bool rates = false;
    for (size_t i = 0; i < r->columns; i++) {
        const struct br_role_column *c = &r->column[i];
        rates |= c->kind == BR_KIND_RATE && c->numbers;
        if ((c->words && !c->numbers) || c->role == BR_ROLE_DEGREE ||
            (c->is_whole && !c->words && c->least < c->most && c->kind != BR_KIND_RATE &&
             c->kind != BR_KIND_COST))
            return false;
    }
    return rates && r->groups == 1;
}

/* Takes a degree as the axis, if its heading or the user says that it is one. */
static enum br_status take_degree(struct br_roles *r, size_t i, struct br_error *err)
{
    struct br_role_column *c = &r->column[i];
    if (c->kind != BR_KIND_DEGREE)
        return br_fail(err, BR_BAD_INPUT,
                       "%s: %s is a degree, and errors over a degree have no order in h: "
                       "--column '%s=degree' gives the factor of a degree, '%s=n' an order",
                       r->wishes->path, c->name, c->name, c->name);
    double *log_z = br_store_take(&r->store, r->rows + 1, sizeof *log_z);
    if (!log_z)
        return br_no_memory(err, "the table");
    for (size_t row = 0; row < r->rows; row++)
        log_z[row] =
            r->dropped[row] ? (double)NAN : log(br_numbers_z(&br_degree_column, c->number[row], 1));
    c->role = BR_ROLE_SIZE;
    r->size[BR_AXIS_SPACE].states = &br_degree_column;
    r->size[BR_AXIS_SPACE].column = i;
    r->size[BR_AXIS_SPACE].dimension = 1;
    r->log_z[BR_AXIS_SPACE] = log_z;
    return BR_OK;
}

static enum br_status halve_by_row(struct br_roles *r, struct br_error *err)
{
    struct br_candidate c = {.size = {br_resolution_column_find("level"), BR_NO_ROW, 1}};
    for (size_t i = 0; i < r->columns; i++)
        if (r->column[i].role == BR_ROLE_DEGREE)
            return take_degree(r, i, err);
    if (!may_halve(r))
        return br_roles_refuse(r, "found no column of a resolution", NULL, err);
    c.log_z = br_store_take(&r->store, r->rows + 1, sizeof *c.log_z);
    size_t *sorted = br_store_take(&r->store, r->rows + 1, sizeof *sorted);
    if (!c.log_z || !sorted)
        return br_no_memory(err, "the table");
    for (int up = 0; up < 2 && !c.agrees_with_rates;
         up++) { /* the last row is the finest, or the first */
        for (size_t i = 0; i < r->rows; i++)
            c.log_z[i] = r->dropped[i] ? (double)NAN : -log(2) * (double)(up ? r->rows - 1 - i : i);
        br_decide_sort(r, &c, sorted);
        br_evidence_weigh(r, &c, sorted);
    }
    if (!c.agrees_with_rates)
        return br_roles_refuse(r,
                               "found no column of a resolution, and the rates of the table do "
                               "not show that h halves from row to row",
                               NULL, err);
    r->halves = true;
    r->size[BR_AXIS_SPACE] = c.size;
    r->log_z[BR_AXIS_SPACE] = c.log_z;
    return BR_OK;
}

/* ---- errors, values and the rest ---- */

static bool is_asked(const struct br_roles *r, const struct br_role_column *c)
{
    return br_lists(r->wishes->errors, c->name) || br_lists(r->wishes->values, c->name);
}

static const char *why_aside(const struct br_roles *r, size_t i)
{
    static const char *const of_kinds[] = {
        [BR_KIND_RATE] = "a rate",
        [BR_KIND_FACTOR] = "a factor",
        [BR_KIND_COST] = "a cost or an index",
        [BR_KIND_DEVIATION] = "deviations of no column",
        [BR_KIND_DEGREE] = "a degree",
        [BR_KIND_REPEAT] = "the number of a run",
    };
    const struct br_role_column *c = &r->column[i];
    if (c->why)
        return c->why;
    if (!c->numbers)
        return c->words ? "words" : "no numbers";
    if (of_kinds[c->kind] && !c->by_hand)
        return of_kinds[c->kind];
    if (c->words)
        return "words among numbers";
    if (!(c->least < c->most))
        return "one number only";
    if (c->named >= BR_USUAL_NAME)
        return "another size";
    return r->wishes->errors || r->wishes->values ? "not asked for"
           : c->least < 0                         ? "both signs: --value, if it is studied"
           : c->is_whole                          ? "a count"
                         : "no error by its numbers: --error or --value, if "
                           "it is studied";
}

static bool is_studied(const struct br_role_column *c)
{
    return c->role == BR_ROLE_ERROR || c->role == BR_ROLE_VALUE;
}

/* The column whose deviations these are: it has the same words, or is the only one. */
static size_t find_of(const struct br_roles *r, size_t deviations)
{
    size_t found = BR_NO_ROW, count = 0;
    for (size_t i = 0; i < r->columns; i++) {
        const struct br_role_column *c = &r->column[i];
        if (!is_studied(c))
            continue;
        if (c->name && r->column[deviations].name && strstr(r->column[deviations].name, c->name))
            return i;
        if (i < deviations || found == BR_NO_ROW)
            found = i;
        count++;
    }
    return count == 1 ? found : BR_NO_ROW;
}

/* Whether a column is that power of the size which its name says: "h^2" beside h. */
static bool is_power_of_size(const struct br_roles *r, size_t i)
{
    char base[20];
    const struct br_role_column *c = &r->column[i];
    const int power = c->name && !c->by_hand ? br_power_in(c->name, base) : 0;
    for (int axis = 0; power && axis < BR_AXES; axis++) {
        const struct br_resolution_column *size = br_resolution_column_find(axis ? "dt" : "h");
        double low = INFINITY, high = -INFINITY;
        for (size_t row = 0; r->log_z[axis] && row < r->rows; row++) {
            const double off = log(c->number[row]) - power * r->log_z[axis][row];
            low = fmin(low, off); /* that of a gap is none */
            high = fmax(high, off);
        }
        if (br_name_odds(base, NULL, size) >= BR_USUAL_NAME && high - low <= 0.02)
            return true;
    }
    return false;
}

static void take_errors(struct br_roles *r, const struct br_candidate *over, const size_t *sorted)
{
    const bool asked = r->wishes->errors || r->wishes->values;
    for (size_t i = 0; i < r->columns; i++) {
        struct br_role_column *c = &r->column[i];
        if (!is_asked(r, c) && is_power_of_size(r, i))
            c->why = "a power of the size";
        if (c->role == BR_ROLE_SIZE || c->role == BR_ROLE_CASE || c->stated || c->why)
            continue;
        const bool by_hand = c->by_hand && c->kind == BR_KIND_UNKNOWN;
        const bool named_size = c->named >= BR_USUAL_NAME;
        const bool studied =
            asked ? is_asked(r, c) && !named_size
                  : by_hand || (!named_size && c->numbers && c->role != BR_ROLE_DEGREE &&
                                br_evidence_of_errors(r, over, sorted, i) >= 1);
        c->role = !studied      ? c->role == BR_ROLE_DEGREE ? BR_ROLE_DEGREE : BR_ROLE_ASIDE
                  : c->is_value ? BR_ROLE_VALUE
                                : BR_ROLE_ERROR;
    }
    for (size_t i = 0; i < r->columns; i++) {
        struct br_role_column *c = &r->column[i];
        if (c->role == BR_ROLE_ASIDE && c->kind == BR_KIND_DEVIATION && c->numbers && !c->words &&
            (c->of = find_of(r, i)) != BR_NO_ROW)
            c->role = BR_ROLE_DEVIATION;
    }
    for (size_t i = 0; i < r->columns; i++)
        if (r->column[i].role == BR_ROLE_ASIDE || r->column[i].role == BR_ROLE_DEGREE)
            r->column[i].why = why_aside(r, i);
}

/* Names errors of one heading apart: "l2", "l2 (2)". */
static enum br_status number_names(struct br_roles *r, struct br_error *err)
{
    char text[220];
    for (size_t i = r->columns; i-- > 0;) {
        struct br_role_column *c = &r->column[i];
        size_t count = 1;
        for (size_t k = 0; k < i && c->name; k++)
            count += is_studied(&r->column[k]) && r->column[k].name &&
                     strcmp(r->column[k].name, c->name) == 0;
        if (count == 1 || !is_studied(c))
            continue;
        snprintf(text, sizeof text, "%.190s (%zu)", c->name, count);
        if (!(c->label = c->name = copy_text(r, text)))
            return br_no_memory(err, "the table");
    }
    return BR_OK;
}

/* An error that halves exactly beside sizes that do not is a size, more likely. */
static enum br_status check_swap(struct br_roles *r, const struct br_candidate *over,
                                 size_t *sorted, struct br_error *err)
{
    const struct br_role_column *size =
        over->size.column == BR_NO_ROW ? NULL : &r->column[over->size.column];
    struct br_candidate c = {.size = {br_resolution_column_find("h"), 0, 1}};
    size_t *order = br_store_take(&r->store, r->rows + 1, sizeof *order);
    bool swapped = false;
    size_t i = 0;
    c.log_z = br_store_take(&r->store, r->rows + 1, sizeof *c.log_z);
    if (!c.log_z || !order)
        return br_no_memory(err, "the table");
    const bool count = size && size->is_whole && !over->size.states->is_size; /* errors are none */
    for (; size && !count && !size->by_hand && !r->halves && i < r->columns && !swapped; i++) {
        if (r->column[i].role != BR_ROLE_ERROR || r->column[i].by_hand || over->agrees_with_rates ||
            br_evidence_halves(r, over, sorted))
            continue;
        for (size_t row = 0; row < r->rows; row++)
            c.log_z[row] = r->dropped[row] ? (double)NAN : log(r->column[i].number[row]);
        br_decide_sort(r, &c, order);
        swapped = br_evidence_halves(r, &c, order);
    }
    if (!swapped)
        return BR_OK;
    return br_fail(err, BR_BAD_INPUT,
                   "%s: %s halves exactly, and the sizes in %s do not: are the two swapped? "
                   "--column '%s=%s' says that they are not",
                   r->wishes->path, r->column[i - 1].label, size->label, size->label,
                   over->size.states->name);
}

/* Below a title that says rates, columns that stay between them are no errors. */
static enum br_status check_rates_alone(const struct br_roles *r, struct br_error *err)
{
    const double least = 0.2, most = 12, falls = 2;
    bool rates = false;
    for (size_t i = 0; i < r->fields->lefts; i++)
        rates |= strcasestr(r->fields->left[i].text, "rates") ||
                 strcasestr(r->fields->left[i].text, "orders of convergence");
    for (size_t i = 0; i < r->columns && rates; i++) {
        const struct br_role_column *c = &r->column[i];
        rates = !is_studied(c) || (!is_asked(r, c) && !c->by_hand && c->least >= least &&
                                   c->most <= most && c->most < falls * c->least);
    }
    return rates
               ? br_roles_refuse(r,
                                 "found rates and no errors: --error NAME says which column is one",
                                 NULL, err)
               : BR_OK;
}

/* Beside the iterations of a solver, an error that does not fall from mesh to mesh is one of the
 * solver. */
static enum br_status check_residuals(const struct br_roles *r, const size_t *sorted,
                                      struct br_error *err)
{
    const struct br_resolution_column *steps = br_resolution_column_find("steps");
    if (sorted[0] == BR_NO_ROW)
        return BR_OK;
    const char *iterations = NULL, *error = NULL;
    for (size_t i = 0; i < r->columns; i++) {
        const struct br_role_column *c = &r->column[i];
        bool rises = false;
        if (c->role == BR_ROLE_ASIDE && c->name && c->numbers && !c->by_hand &&
            (strcasestr(c->name, "iter") || br_odds(c, steps) >= BR_USUAL_NAME))
            iterations = c->name;
        if (!is_studied(c))
            continue;
        size_t last = 0;
        for (; sorted[last + 1] != BR_NO_ROW; last++)
            rises |= c->number[sorted[last + 1]] >= c->number[sorted[last]];
        if (c->by_hand || c->is_value || r->wishes->errors || !rises ||
            4 * c->number[sorted[last]] < c->number[sorted[0]])
            return BR_OK;
        error = c->label;
    }
    return iterations && error && r->groups == 1
               ? br_fail(err, BR_BAD_INPUT,
                         "%s: %s does not fall from mesh to mesh, beside iterations (%s): is it a "
                         "residual of the solver? --error '%s' says that it is an error",
                         r->wishes->path, error, iterations, error)
               : BR_OK;
}

/* ---- rows of one size ---- */

struct run {
    size_t group, row;
    double z[BR_AXES], error;
};

static int by_run(const void *a, const void *b)
{
    const struct run *x = a, *y = b;
    if (x->group != y->group)
        return (x->group > y->group) - (x->group < y->group);
    for (int i = 0; i < BR_AXES; i++)
        if (fabs(x->z[i] - y->z[i]) > 1e-9)
            return (x->z[i] < y->z[i]) - (x->z[i] > y->z[i]);
    return (x->error < y->error) - (x->error > y->error); /* the least error last */
}

static bool is_one_size(const struct run *a, const struct run *b)
{
    return a->group == b->group && fabs(a->z[0] - b->z[0]) <= 1e-9 &&
           fabs(a->z[1] - b->z[1]) <= 1e-9;
}

/* The scatter of numbers from run[first] to before run[end], relative to their mean. */
static double scatter_of(const struct run *run, size_t first, size_t end)
{
    double sum = 0, squares = 0;
    for (size_t i = first; i < end; i++)
        sum += run[i].error;
    const double mean = sum / (double)(end - first);
    for (size_t i = first; i < end; i++)
        squares += pow(run[i].error / mean - 1, 2);
    return sqrt(squares / (double)(end - first - 1));
}

static enum br_status refuse_repeats(const struct br_roles *r, size_t row, size_t before,
                                     struct br_error *err)
{
    char place[32], other[32];
    const bool lines = r->fields->line[row];
    return br_fail(
        err, BR_BAD_INPUT,
        "%s%s%s: the resolution is that of %s, expected each once: --where chooses "
        "one of several studies, by a column that differs between them; of repeated runs, "
        "give the mean, or each size at least twice",
        r->wishes->path, lines ? ":" : ": ",
        br_row_place(r->fields, row, place) + (lines ? strlen("line ") : 0),
        br_row_place(r->fields, before, other));
}

/* Runs of one size: of repeated runs the mean counts, of adaptive meshes the last. */
static enum br_status settle_repeats(struct br_roles *r, struct run *run, size_t count,
                                     struct br_error *err)
{
    size_t repeats = 0, least = count, at = 0;
    double scatter = 0;
    bool numbered = false;
    qsort(run, count, sizeof *run, by_run);
    for (size_t first = 0, end; first < count; first = end) {
        for (end = first + 1; end < count && is_one_size(&run[first], &run[end]);)
            end++;
        least = end - first < least ? end - first : least;
        if (end - first < 2)
            continue;
        at = repeats ? at : first + 1;
        repeats += end - first - 1;
        scatter = fmax(scatter, scatter_of(run, first, end));
    }
    if (!repeats)
        return BR_OK;
    for (size_t i = 0; i < r->columns; i++)
        numbered |= r->column[i].kind == BR_KIND_REPEAT;
    const struct br_resolution_column *s = r->size[BR_AXIS_SPACE].states;
    if (least >= 2 && (numbered || scatter < 0.3)) {
        r->means = true;
        if (!numbered && least < 3)
            br_append(
                r->assumed, sizeof r->assumed,
                "%srows of one size are assumed to be repeated runs: a column that numbers them "
                "(run, seed) settles it",
                *r->assumed ? "; " : "");
        return BR_OK;
    }
    if (least >= 2 || !s || !s->is_volume || r->size[BR_AXIS_TIME].states || 2 * repeats > count)
        return refuse_repeats(r, run[at].row, run[at - 1].row, err);
    for (size_t i = 0; i + 1 < count; i++)
        if (is_one_size(&run[i], &run[i + 1]))
            r->dropped[run[i].row] = "of rows with as many unknowns the last one counts";
    return BR_OK;
}

static enum br_status take_repeats(struct br_roles *r, struct br_error *err)
{
    struct run *run = br_store_take(&r->store, r->rows + 1, sizeof *run);
    size_t count = 0, error = BR_NO_ROW;
    if (!run)
        return br_no_memory(err, "the table");
    for (size_t i = 0; i < r->columns && error == BR_NO_ROW; i++)
        if (is_studied(&r->column[i]))
            error = i;
    for (size_t i = 0; i < r->rows && error != BR_NO_ROW; i++) {
        if (r->dropped[i])
            continue;
        struct run *of = &run[count++];
        *of = (struct run){r->group[i], i, {0, 0}, r->column[error].number[i]};
        for (int axis = 0; axis < BR_AXES; axis++)
            of->z[axis] = !r->log_z[axis] ? 0
                          : isfinite(r->log_z[axis][i])
                              ? r->log_z[axis][i]
                              : 1e6 + (double)i; /* of none, which is refused */
    }
    return settle_repeats(r, run, count, err);
}

/* ---- all ---- */

/* Whether a column may count unknowns or cells, or there is none of the mesh. */
static bool counts_volume(const struct br_roles *r)
{
    const struct br_resolution_column *chosen = r->size[BR_AXIS_SPACE].states;
    bool counts = !chosen || chosen->is_volume;
    for (size_t i = 0; i < r->columns && !counts; i++)
        for (const struct br_resolution_column *s = br_resolution_columns; s->name; s++)
            counts |= s->is_volume && (r->column[i].stated == s || br_odds(&r->column[i], s) > 1);
    return counts;
}

static enum br_status find_roles(struct br_roles *r, struct br_error *err)
{
    if (take_names(r, err) || take_numbers(r, err))
        return err->status;
    drop_zeros(r);
    find_rates_without_a_name(r);
    if (take_where(r, err) || check_sizes(r, err) || find_cases(r, err) || br_decide_sizes(r, err))
        return err->status;
    if (r->wishes->dimension > 0 && !counts_volume(r))
        return br_roles_refuse(r, "--dimension: found no numbers of unknowns or cells", NULL, err);
    const bool sizes = r->size[BR_AXIS_SPACE].states || r->size[BR_AXIS_TIME].states;
    if (!sizes && halve_by_row(r, err))
        return err->status;
    const enum br_axis axis = r->size[BR_AXIS_SPACE].states ? BR_AXIS_SPACE : BR_AXIS_TIME;
    struct br_candidate over = {.size = r->size[axis], .log_z = r->log_z[axis]};
    size_t *sorted = br_store_take(&r->store, r->rows + 1, sizeof *sorted);
    if (!sorted)
        return br_no_memory(err, "the table");
    br_decide_sort(r, &over, sorted);
    if (!r->halves)
        br_evidence_weigh(r, &over, sorted);
    take_errors(r, &over, sorted);
    return number_names(r, err) || check_swap(r, &over, sorted, err) ||
                   check_residuals(r, sorted, err) || check_rates_alone(r, err) ||
                   take_repeats(r, err)
               ? err->status
               : BR_OK;
}

enum br_status br_roles_find(const struct br_fields *fields, const struct br_table_wishes *wishes,
                             struct br_roles *r, struct br_error *err)
{
    *r = (struct br_roles){
        .fields = fields, .wishes = wishes, .columns = fields->columns, .rows = fields->rows};
    err->status = BR_OK;
    r->column = br_store_take(&r->store, r->columns + 1, sizeof *r->column);
    r->dropped = br_store_take(&r->store, r->rows + 1, sizeof *r->dropped);
    r->group = br_store_take(&r->store, r->rows + 1, sizeof *r->group);
    r->line = br_store_take(&r->store, r->rows + 1, sizeof *r->line);
    r->place = br_store_take(&r->store, r->rows + 1, sizeof *r->place);
    if (!r->column || !r->dropped || !r->group || !r->line || !r->place)
        return br_no_memory(err, "the table");
    return find_roles(r, err);
}

void br_roles_clear(struct br_roles *r)
{
    br_store_clear(&r->store);
    *r = (struct br_roles){0};
}
