/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/number_option.h"

#include <math.h>
#include <stdio.h>

#include "study/scene/number_list.h"

enum br_status br_read_count_option(const char *option, const char *text, int most, int *value,
                                    struct br_error *err)
{
    double number = 0;
    const char *end = text ? br_read_number(text, &number) : "";
    if (!end || *end || !(number >= 0 && number <= most) || number != floor(number))
        return br_fail(err, BR_BAD_INPUT, "--%s: found '%s', expected a whole number from 0 to %d",
                       option, text, most);
    if (text)
        *value = (int)number;
    return BR_OK;
}

enum br_status br_read_number_option(const char *option, const char *text, double low, double high,
                                     double *value, struct br_error *err)
{
    double number;
    if (!text)
        return BR_OK;
    const char *end = br_read_number(text, &number);
    char below[32] = "";
    if (isfinite(high))
        snprintf(below, sizeof below, " and below %g", high);
    if (!end || *end || !(number > low && number < high))
        return br_fail(err, BR_BAD_INPUT, "--%s: found '%s', expected a number above %g%s", option,
                       text, low, below);
    *value = number;
    return BR_OK;
}
