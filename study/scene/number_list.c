/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/number_list.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>

enum { MOST = 1024 };

const char *br_read_number(const char *text, double *value)
{
    if (!isdigit((unsigned char)*text) && *text != '.' && *text != '-' && *text != '+')
        return NULL; /* strtod would take "nan", "inf" and leading blanks */
    char *end;
    *value = strtod(text, &end);
    return end != text && isfinite(*value) ? end : NULL;
}

static enum br_status not_in_range(const char *text, const struct br_number_range *r,
                                   struct br_error *err)
{
    char below[32] = "";
    if (r->whole)
        return br_fail(err, BR_BAD_INPUT, "found '%s', expected a whole number from %.0f to %.0f",
                       text, r->low, r->high);
    if (isfinite(r->high))
        snprintf(below, sizeof below, " and below %g", r->high);
    return br_fail(err, BR_BAD_INPUT, "found '%s', expected a number above %g%s", text, r->low,
                   below);
}

enum br_status br_read_in_range(const char *text, const struct br_number_range *r, double *value,
                                struct br_error *err)
{
    double number = NAN;
    const char *end = br_read_number(text, &number);
    const bool inside = r->whole ? number >= r->low && number <= r->high && number == floor(number)
                                 : number > r->low && number < r->high;
    if (!end || *end || !inside)
        return not_in_range(text, r, err);
    *value = number;
    return BR_OK;
}

const char *br_shortest(double number, char *text, size_t size)
{
    snprintf(text, size, "%.15g", number);
    if (strtod(text, NULL) != number)
        snprintf(text, size, "%.17g", number);
    return text;
}

static bool contains(const double *values, size_t count, double value)
{
    for (size_t i = 0; i < count; i++)
        if (values[i] == value)
            return true;
    return false;
}

enum br_status br_read_numbers(const char *option, const char *text, double **values, size_t *count,
                               struct br_error *err)
{
    *count = 0;
    *values = br_allocate(MOST, sizeof **values);
    if (!*values)
        return br_no_memory(err, "a list");
    for (const char *rest = text;; rest++) {
        double value;
        const char *end = br_read_number(rest, &value);
        if (!end || (*end && *end != ',') || !(value > 0))
            return br_fail(err, BR_BAD_INPUT,
                           "%s: found '%s', expected positive numbers separated by commas", option,
                           rest);
        if (contains(*values, *count, value))
            return br_fail(err, BR_BAD_INPUT, "%s: %g is given twice", option, value);
        if (*count == MOST)
            return br_fail(err, BR_BAD_INPUT, "%s: more than %d values", option, MOST);
        (*values)[(*count)++] = value;
        rest = end;
        if (!*rest)
            return BR_OK;
        while (rest[1] == ' ')
            rest++;
    }
}

enum br_status br_read_counts(const char *option, const char *text, size_t **values, size_t *count,
                              struct br_error *err)
{
    double *numbers;
    enum br_status status = br_read_numbers(option, text, &numbers, count, err);
    *values = status ? NULL : br_allocate(*count, sizeof **values);
    if (!status && !*values)
        status = br_no_memory(err, "a list");
    for (size_t i = 0; i < *count && !status; i++) {
        if (numbers[i] != floor(numbers[i]) || !(numbers[i] <= 1e9))
            status =
                br_fail(err, BR_BAD_INPUT, "%s: found %g, expected whole numbers from 1 to 1e9",
                        option, numbers[i]);
        else
            (*values)[i] = (size_t)numbers[i];
    }
    free(numbers);
    return status;
}
