/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The numbers of the columns, and the digits that they are printed to. */
#include "orders/reading/roles.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

char *br_row_place(const struct br_fields *f, size_t row, char text[32])
{
    snprintf(text, 32, f->line[row] ? "line %zu" : "row %zu",
             f->line[row] ? f->line[row] : row + 1);
    return text;
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

/* Reads the numbers of a column in the rows that are not left aside. */
void br_roles_read_column(struct br_roles *r, size_t column)
{
    struct br_role_column *c = &r->column[column];
    c->numbers = c->words = c->gaps = 0;
    c->is_whole = true;
    c->least = INFINITY;
    c->most = -INFINITY;
    for (size_t i = 0; i < r->rows; i++) {
        struct br_field_number n = {NAN, NAN};
        const char *text = br_role_field(r, i, column);
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
            (r->fields->is_words[column] || !br_field_read(text, r->fields->mark, &n)))
            return br_fail(
                err, BR_BAD_INPUT,
                "%s:%zu: %s: found '%.40s', expected a number, or nan where it is missing",
                r->wishes->path, r->fields->line[i], c->label, text);
    }
    return BR_OK;
}
