/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The numbers of the columns, and the digits that they are printed to. */
#include "orders/reading/roles.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/words.h"

char *br_row_place(const struct br_fields *f, size_t row, char text[32])
{
    snprintf(text, 32, f->line[row] ? "line %zu" : "row %zu",
             f->line[row] ? f->line[row] : row + 1);
    return text;
}

/* The unit behind the number of a field, "10 mm"; NULL: there is none. */
static const char *unit_in(const char *text)
{
    const char *end = text + strlen(text), *unit = end;
    if (end > text && end[-1] == '%')
        return end - 1;
    if (end > text + 2 && strcmp(end - 2, "\xc2\xb0") == 0)
        return end - 2;
    while (unit > text && isalpha((unsigned char)unit[-1]))
        unit--;
    return unit > text && br_is_unit(unit) && (unit[-1] == ' ' || isdigit((unsigned char)unit[-1]))
               ? unit
               : NULL;
}

static bool is_percent(const char *unit)
{
    return unit && *unit == '%';
}

/* Whether a text ends with a "K" of a thousand: that of a number of cells is not a kelvin. */
static bool ends_with_thousand(const struct br_role_column *c, const char *text)
{
    const size_t length = strlen(text);
    return length > 1 && text[length - 1] == 'K' && c->named >= BR_USUAL_NAME;
}

/* The unit that all numbers of a column have in their fields; NULL: there is none. */
static const char *unit_of_all(const struct br_roles *r, size_t column)
{
    const char *all = NULL;
    for (size_t i = 0; i < r->rows; i++) {
        const char *text = br_role_field(r, i, column);
        if (br_field_is_missing(text) || br_is_gap(text))
            continue;
        const char *unit = unit_in(text);
        if (!unit || (all && strcmp(unit, all) != 0) ||
            ends_with_thousand(&r->column[column], text))
            return NULL;
        all = unit;
    }
    return all;
}

/* Whether a blank or an apostrophe of a number stands between thousands, "1 000": three digits are
 * behind it, and one to three before it; behind a decimal mark three. */
static bool parts_thousands(const char *text, const char *at, char mark)
{
    const char *first = at;
    while (first > text && isdigit((unsigned char)first[-1]))
        first--;
    const bool more = first > text && strchr(" '", first[-1]);
    const bool decimals = first > text && first[-1] == mark;
    return at > first && at - first <= 3 && (at - first == 3 || !(more || decimals)) &&
           strchr(" '", *at) && strspn(at + 1, "0123456789") == 3 && *text != '0';
}

/* Whether a field has the unit of all, and of the heading. Without a unit 4 % is 0.04. */
static bool has_its_unit(const struct br_role_column *c, const char *text)
{
    if (!c->unit_of_fields)
        return !c->unit || !is_percent(unit_in(text));
    return !c->unit || strcmp(c->unit, c->unit_of_fields) == 0;
}

/* Reads a field of a column. Behind it may be the unit of all; thousands may be apart: "1 000". */
static bool read_field(const struct br_roles *r, size_t column, const char *text,
                       struct br_field_number *n)
{
    enum { LONGEST = 64 };
    const struct br_role_column *c = &r->column[column];
    char plain[LONGEST], *to = plain;
    if (r->fields->is_words[column] || !has_its_unit(c, text))
        return false;
    const char *bracket = c->rates_in_brackets ? strrchr(text, '(') : NULL;
    if (!bracket && br_field_read(text, r->fields->mark, n))
        return true;
    const char *unit = is_percent(c->unit_of_fields) ? NULL : c->unit_of_fields;
    const size_t length =
        bracket ? (size_t)(bracket - text) : strlen(text) - (unit ? strlen(unit) : 0);
    const char *const end = text + length;
    for (const char *at = text; at < end && length < LONGEST; at++)
        if (!parts_thousands(text, at, r->fields->mark))
            *to++ = *at;
    while (to > plain && to[-1] == ' ')
        to--;
    *to = '\0';
    if (ends_with_thousand(c, plain))
        to[-1] = 'k';
    return to > plain && br_field_read(plain, r->fields->mark, n);
}

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
        const int digits = digits_of(br_role_field(r, i, column), &of_row);
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

/* Whether fields of a column give powers of ten in brackets, "1.2(-3)": then "1.2(3)" has one, and
 * no deviation. */
static bool has_powers(const struct br_roles *r, size_t column)
{
    struct br_field_number n;
    for (size_t i = 0; i < r->rows; i++)
        if (br_role_field(r, i, column) &&
            br_field_read(br_role_field(r, i, column), r->fields->mark, &n) && !isnan(n.of_power) &&
            isnan(n.deviation))
            return true;
    return false;
}

/* The power of "64^2" in a field, a mesh with 64 cells along each side; 1: it has none. */
static int power_of_sides(const char *text)
{
    static const struct {
        const char *sign;
        int power;
    } signs[] = {{"^2", 2}, {"^{2}", 2}, {"\xc2\xb2", 2}, {"^3", 3}, {"^{3}", 3}, {"\xc2\xb3", 3}};
    text += strspn(text, " `$*");
    const size_t digits = strspn(text, "0123456789");
    for (size_t i = 0; digits && i < sizeof signs / sizeof *signs; i++) {
        const char *rest = text + digits;
        if (br_takes(&rest, signs[i].sign) && !rest[strspn(rest, " `$*")])
            return signs[i].power;
    }
    return 1;
}

/* The power that all fields of a column have, if its name is one of a side, and none of cells. */
static int power_of_all(const struct br_roles *r, size_t column)
{
    const struct br_role_column *c = &r->column[column];
    const double side = br_odds(c, br_resolution_column_find("n")); /* more: "nx", "samples" */
    int all = side >= 2 && side <= BR_USUAL_NAME &&
                      br_odds(c, br_resolution_column_find("cells")) < BR_USUAL_NAME
                  ? 0
                  : 1;
    for (size_t i = 0; i < r->rows && all != 1; i++) {
        const int power = power_of_sides(br_role_text(r, i, column));
        all = all && power != all ? 1 : power;
    }
    return all > 1 ? all : 1;
}

/* Whether all fields have the cells along each side: "8x8x8", "[8 8]"; but "8 x 10^3" has none. */
static bool are_sides(const struct br_roles *r, size_t column)
{
    const struct br_role_column *c = &r->column[column];
    bool are = c->is_whole;
    for (size_t i = 0; i < r->rows && are; i++) {
        const char *text = br_role_text(r, i, column) + strspn(br_role_text(r, i, column), " `$*");
        const bool bracket = *text && strchr("[(", *text);
        char *end;
        const double first = strtod(text + bracket, &end);
        end += strspn(end, " ");
        are = isnan(c->number[i]) || (first == c->number[i] &&
                                      (bracket || *end == 'x' || strncmp(end, "\xc3\x97", 2) == 0 ||
                                       strncmp(end, "\\times", 6) == 0));
    }
    return are;
}

/* Errors that are all negative, and fall, are taken without their sign. */
static void drop_signs(const struct br_roles *r, struct br_role_column *c)
{
    static const double falls = 2;
    const bool is_error = c->kind == BR_KIND_ERROR
                              ? br_says_error(c->name) && strcmp(c->name, "E") != 0 /* energy */
                              : c->role == BR_ROLE_ERROR;
    c->without_sign = is_error && !c->is_value && c->most <= 0 && c->least < falls * c->most;
    for (size_t i = 0; i < r->rows && c->without_sign; i++)
        c->number[i] = fabs(c->number[i]);
    if (c->without_sign) {
        const double most = -c->least;
        c->least = fabs(c->most);
        c->most = most;
    }
}

/* Reads the numbers of a column in the rows that are not left aside. */
void br_roles_read_column(struct br_roles *r, size_t column)
{
    struct br_role_column *c = &r->column[column];
    c->numbers = c->words = c->gaps = 0;
    const bool powers = has_powers(r, column);
    const int sides = power_of_all(r, column);
    c->unit_of_fields = unit_of_all(r, column);
    if (!c->unit && c->name && !is_percent(c->unit_of_fields)) /* 5 % is 0.05 */
        c->unit = c->unit_of_fields;
    c->is_whole = true;
    c->least = INFINITY;
    c->most = -INFINITY;
    for (size_t i = 0; i < r->rows; i++) {
        struct br_field_number n = {NAN, NAN, NAN};
        const char *text = br_role_field(r, i, column);
        c->number[i] = c->deviation[i] = NAN;
        if (r->dropped[i] || br_field_is_missing(text))
            continue;
        if (br_is_gap(text)) {
            c->gaps++;
            c->gap = text;
            continue;
        }
        if (!read_field(r, column, text, &n)) {
            c->words++;
            continue;
        }
        if (is_percent(c->unit) && is_percent(c->unit_of_fields))
            n = (struct br_field_number){100 * n.value, 100 * n.deviation, NAN};
        if (sides > 1)
            n = (struct br_field_number){round(pow(n.value, 1.0 / sides)), NAN, NAN};
        if (powers && !isnan(n.of_power))
            n = (struct br_field_number){n.of_power, NAN, NAN};
        c->number[i] = n.value;
        c->deviation[i] = n.deviation;
        c->numbers++;
        c->is_whole &= n.value == floor(n.value);
        c->least = fmin(c->least, n.value);
        c->most = fmax(c->most, n.value);
    }
    c->is_whole &= c->numbers > 0;
    c->of_sides = sides > 1 || are_sides(r, column);
    drop_signs(r, c);
    find_rounding(r, column);
}

enum br_status br_roles_take_numbers(struct br_roles *r, struct br_error *err)
{
    for (size_t i = 0; i < r->columns; i++) {
        double *room = br_store_take(&r->store, 3 * (r->rows + 1), sizeof *room);
        if (!room)
            return br_no_memory(err, "the table");
        r->column[i].number = room;
        r->column[i].deviation = room + r->rows;
        r->column[i].rounding = room + 2 * r->rows;
        br_roles_read_column(r, i);
    }
    return BR_OK;
}

enum br_status br_roles_check_words(const struct br_roles *r, size_t column, struct br_error *err)
{
    const struct br_role_column *c = &r->column[column];
    struct br_field_number n;
    for (size_t i = 0; i < r->rows && c->words; i++) {
        const char *text = br_role_field(r, i, column);
        if (!r->dropped[i] && !br_field_is_missing(text) && !br_is_gap(text) &&
            !read_field(r, column, text, &n))
            return br_fail(
                err, BR_BAD_INPUT,
                "%s:%zu: %s: found '%.40s', expected a number, or nan where it is missing",
                r->wishes->path, r->fields->line[i], c->label, text);
    }
    return BR_OK;
}
