/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "orders/orders.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void br_numbers_name(const struct br_numbers *numbers, const struct br_numbers_row *row,
                     enum br_axis axis, char text[64])
{
    const bool by_list = isnan(row->given[axis]) && numbers->listed[axis];
    const struct br_resolution_column *column = (by_list ? numbers->listed : numbers->column)[axis];
    char number[32];
    snprintf(text, 64, "%s%s = %s", by_list ? "the run of " : "", column->name,
             br_numbers_text(column, (by_list ? row->listed : row->given)[axis], number));
}

void br_numbers_name_cell(const struct br_numbers *numbers, const struct br_numbers_row *row,
                          char text[BR_CELL_NAME])
{
    char size[BR_AXES][64] = {""};
    for (int axis = 0; axis < BR_AXES; axis++)
        if (numbers->column[axis])
            br_numbers_name(numbers, row, (enum br_axis)axis, size[axis]);
    snprintf(text, BR_CELL_NAME, "%s%s%s", size[0], *size[0] && *size[1] ? ", " : "", size[1]);
}

enum br_status br_numbers_make_room(struct br_numbers *numbers, size_t rows, size_t quantities,
                                    struct br_error *err)
{
    if (rows > BR_MOST_ROWS)
        return br_fail(err, BR_BAD_INPUT, "found %zu rows, expected at most %d", rows,
                       BR_MOST_ROWS);
    numbers->quantity = br_allocate(quantities + 1, sizeof *numbers->quantity);
    numbers->row = br_allocate(rows + 1, sizeof *numbers->row);
    for (; numbers->row && numbers->rows < rows; numbers->rows++) {
        struct br_numbers_row *row = &numbers->row[numbers->rows];
        *row =
            (struct br_numbers_row){.given = {NAN, NAN},
                                    .z = {NAN, NAN},
                                    .number = br_allocate(2 * quantities + 2, sizeof *row->number),
                                    .out = br_allocate(quantities + 1, sizeof *row->out),
                                    .seconds = NAN,
                                    .wall = NAN,
                                    .bytes = NAN};
        if (!row->number || !row->out) {
            numbers->rows++;
            return br_no_memory(err, "the numbers");
        }
        row->deviation = row->number + quantities + 1;
        for (size_t i = 0; i <= quantities; i++)
            row->deviation[i] = NAN;
    }
    return numbers->row && numbers->quantity ? BR_OK : br_no_memory(err, "the numbers");
}

enum br_status br_numbers_add_quantity(struct br_numbers *numbers, const char *name,
                                       const char *unit, bool is_value, struct br_error *err)
{
    struct br_quantity *q = &numbers->quantity[numbers->quantities++];
    *q = (struct br_quantity){
        .name = strdup(name), .unit = unit ? strdup(unit) : NULL, .is_value = is_value};
    return q->name && (!unit || q->unit) ? BR_OK : br_no_memory(err, "the numbers");
}

/* ---- printed digits ---- */

/* The least digits that give a number, and how many of them are decimals. */
static int digits_of(double number, int *decimals)
{
    char text[40];
    int digits = 0;
    do
        snprintf(text, sizeof text, "%.*e", digits++, number);
    while (strtod(text, NULL) != number && digits < DBL_DECIMAL_DIG);
    *decimals = digits - 1 - atoi(strchr(text, 'e') + 1);
    return digits;
}

/* A program prints a column to the same decimals (0.0100), or to the same digits (1.00e-02), and
 * zeros at the end may be lost. Of both, the one that has lost fewer zeros is believed. */
static void find_digits(struct br_numbers *numbers, size_t quantity)
{
    struct br_quantity *q = &numbers->quantity[quantity];
    int decimals, sum_of_digits = 0, sum_of_decimals = 0, count = 0;
    for (size_t i = 0; i < numbers->rows; i++) {
        const double number = numbers->row[i].number[quantity];
        if (!isfinite(number) || number == 0)
            continue;
        const int digits = digits_of(number, &decimals);
        decimals = decimals > 0 ? decimals : 0;
        q->digits = digits > q->digits ? digits : q->digits;
        q->decimals = decimals > q->decimals ? decimals : q->decimals;
        sum_of_digits += digits;
        sum_of_decimals += decimals;
        count++;
    }
    q->fixed = count * q->decimals - sum_of_decimals < count * q->digits - sum_of_digits;
}

void br_numbers_clear(struct br_numbers *numbers)
{
    for (size_t i = 0; i < numbers->quantities + numbers->costs; i++) {
        free(numbers->quantity[i].name);
        free(numbers->quantity[i].unit);
        free(numbers->quantity[i].window);
    }
    for (size_t i = 0; i < numbers->rows; i++) {
        free(numbers->row[i].number);
        free(numbers->row[i].out);
        free(numbers->row[i].failure);
    }
    for (int axis = 0; axis < BR_AXES; axis++)
        free(numbers->unit[axis]);
    free(numbers->quantity);
    free(numbers->row);
    br_store_clear(&numbers->store);
    *numbers = (struct br_numbers){0};
}

/* From coarse to fine. */
static int by_size(double a, double b)
{
    return (a < b) - (a > b);
}

static int by_resolution(const void *a, const void *b)
{
    const struct br_numbers_row *x = a, *y = b;
    for (int axis = 0; axis < BR_AXES; axis++) {
        const int order = by_size(x->z[axis], y->z[axis]);
        if (order)
            return order;
    }
    const int order = (x->line > y->line) - (x->line < y->line);
    return order ? order : (x->repeat > y->repeat) - (x->repeat < y->repeat);
}

void br_numbers_sort(struct br_numbers *numbers)
{
    qsort(numbers->row, numbers->rows, sizeof *numbers->row, by_resolution);
}

enum { SOURCE = 450 };

/* The source of a row, for messages: "file:3", or the resolution of a run. */
static void name_row(const struct br_numbers *numbers, const struct br_numbers_row *row,
                     const char *path, char text[SOURCE])
{
    char size[BR_CELL_NAME];
    br_numbers_name_cell(numbers, row, size);
    if (row->line)
        snprintf(text, SOURCE, "%.300s:%zu", path, row->line);
    else
        snprintf(text, SOURCE, "%.300s: %s", path, size);
}

static const double largest = 1e150; /* size */

static enum br_status check_row(const struct br_numbers *numbers, const struct br_numbers_row *row,
                                const char *path, struct br_error *err)
{
    char source[SOURCE];
    name_row(numbers, row, path, source);
    for (int axis = 0; axis < BR_AXES; axis++) {
        const struct br_resolution_column *column = numbers->column[axis];
        const double z = row->z[axis];
        const double given = row->failure && isnan(row->given[axis]) ? 1 : row->given[axis];
        if (column && !((given > 0 || ((column->is_power || column->is_degree) && given >= 0)) &&
                        isfinite(given)))
            return isfinite(given)
                       ? br_fail(err, BR_BAD_INPUT, "%s: %s: found %g, expected a number above 0",
                                 source, column->name, given)
                       : br_fail(err, BR_BAD_INPUT,
                                 "%s: %s: found no finite number, expected a number above 0",
                                 source, column->name);
        if (column && !(z >= 1 / largest && z <= largest)) /* so that ratios do not overflow */
            return br_fail(err, BR_BAD_INPUT, "%s: %s: found %g, expected a size from %g to %g",
                           source, column->name, given, 1 / largest, largest);
    }
    for (size_t i = 0; i < numbers->quantities; i++) {
        const struct br_quantity *q = &numbers->quantity[i];
        const double number = row->number[i];
        if (!q->is_value && number < 0)
            return br_fail(err, BR_BAD_INPUT,
                           "%s: %.100s: found %g, expected an error of at least 0; is it a value? "
                           "(--value %.100s)",
                           source, q->name, number, q->name);
        if (fabs(number) > DBL_MAX / 4) /* so that differences do not overflow */
            return br_fail(err, BR_BAD_INPUT, "%s: %.100s: found %g, expected at most %.2g", source,
                           q->name, number, DBL_MAX / 4);
    }
    return BR_OK;
}

/* Sizes with a relative difference below this one are one size, written in two ways. */
static const double nearly = 1e-9;

static int by_z(const void *a, const void *b)
{
    return by_size(**(double *const *)a, **(double *const *)b);
}

/* Sets nearly equal sizes along an axis to the coarsest of them; returns the number of different
 * sizes; 0: memory lacks. */
static size_t unite_sizes(struct br_numbers *numbers, int axis)
{
    double **z = br_allocate(numbers->rows, sizeof *z);
    size_t count = 0;
    for (size_t i = 0; z && i < numbers->rows; i++)
        z[i] = &numbers->row[i].z[axis];
    if (z)
        qsort(z, numbers->rows, sizeof *z, by_z);
    for (size_t i = 0; z && i < numbers->rows; i++) {
        const bool same = i > 0 && *z[i] > (1 - nearly) * *z[i - 1];
        *z[i] = same ? *z[i - 1] : *z[i];
        count += !same;
    }
    free(z);
    return count;
}

enum br_status br_numbers_check(struct br_numbers *numbers, const char *path, struct br_error *err)
{
    enum br_status status = BR_OK;
    size_t most = 0;
    for (size_t i = 0; i < numbers->rows && !status; i++)
        status = check_row(numbers, &numbers->row[i], path, err);
    if (status)
        return status;
    for (int axis = 0; axis < BR_AXES; axis++) {
        const size_t count = numbers->column[axis] ? unite_sizes(numbers, axis) : 0;
        if (numbers->column[axis] && numbers->rows && !count)
            return br_no_memory(err, "the numbers");
        if (count > BR_MOST_SIZES)
            return br_fail(err, BR_BAD_INPUT, "%s: found %zu sizes of %s, expected at most %d",
                           path, count, br_axis_letters[axis], BR_MOST_SIZES);
        most = count > most ? count : most;
    }
    for (size_t i = 0; i < numbers->quantities; i++)
        find_digits(numbers, i);
    br_numbers_sort(numbers);
    for (size_t i = 1; i < numbers->rows; i++) {
        const struct br_numbers_row *a = &numbers->row[i - 1], *b = &numbers->row[i];
        bool equal = true;
        for (int axis = 0; axis < BR_AXES; axis++)
            equal &= !numbers->column[axis] || a->z[axis] == b->z[axis];
        if (!equal || a->failure || b->failure)
            continue;
        char source[SOURCE];
        name_row(numbers, b, path, source);
        return b->line ? br_fail(err, BR_BAD_INPUT,
                                 "%s: the same resolution as on line %zu, expected each once; give "
                                 "the mean of repeated runs",
                                 source, a->line)
                       : br_fail(err, BR_BAD_INPUT, "%s: found twice, expected once", source);
    }
    if (most < 3)
        return br_fail(err, BR_BAD_INPUT, "%s: found %zu resolution%s, expected at least 3", path,
                       most, most == 1 ? "" : "s");
    return BR_OK;
}

enum br_status br_numbers_check_runs(const struct br_numbers *numbers, struct br_error *err)
{
    size_t failed = 0;
    const struct br_numbers_row *first = NULL;
    for (size_t i = 0; i < numbers->rows; i++)
        if (numbers->row[i].failure) {
            first = first ? first : &numbers->row[i];
            failed++;
        }
    char size[BR_CELL_NAME];
    if (!failed)
        return BR_OK;
    br_numbers_name_cell(numbers, first, size);
    return br_fail(err, BR_NOT_FINITE, "%zu of %zu runs failed; the first, %s: %s", failed,
                   numbers->rows, size, first->failure);
}

/* ---- words ---- */

const char *const br_axis_letters[] = {"h", "k"};

const char *br_flag_name(enum br_flag flag)
{
    static const char *const names[BR_CELL_FLAGS] = {
        "",           "reference",      "round-off", "failed",  "unstable",
        "stagnation", "not asymptotic", "outlier",   "by hand", ""};
    return names[flag];
}
