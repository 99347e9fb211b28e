/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "orders/reading/columns.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const struct br_resolution_column br_resolution_columns[BR_RESOLUTIONS + 1] = {
    {"h", "h", BR_AXIS_SPACE, .is_size = true},
    {"n", "h = 1/n", BR_AXIS_SPACE, .is_size = false},
    {"points", "h = 1/(points - 1)", BR_AXIS_SPACE, .more = -1},
    {"interior", "h = 1/(interior + 1)", BR_AXIS_SPACE, .more = 1},
    {"dofs", "h = dofs^(-1/d)", BR_AXIS_SPACE, .is_volume = true},
    {"cells", "h = cells^(-1/d)", BR_AXIS_SPACE, .is_volume = true},
    {"level", "h = 2^-level", BR_AXIS_SPACE, .is_power = true},
    {"k", "k", BR_AXIS_TIME, .is_size = true},
    {"dt", "k", BR_AXIS_TIME, .is_size = true},
    {"steps", "k = 1/steps", BR_AXIS_TIME, .is_size = false},
    {0},
};

const struct br_resolution_column br_degree_column = {"degree", "degrees", BR_AXIS_SPACE, .more = 1,
                                                      .is_degree = true};

const struct br_resolution_column *br_resolution_column_find(const char *name)
{
    for (const struct br_resolution_column *c = br_resolution_columns; c->name; c++)
        if (strcmp(c->name, name) == 0)
            return c;
    return NULL;
}

double br_numbers_z(const struct br_resolution_column *column, double given, double dimension)
{
    if (column->is_size)
        return given;
    if (column->is_power)
        return exp2(-given);
    return column->is_volume ? pow(given, -1 / dimension) : 1 / (given + column->more);
}

double br_numbers_given(const struct br_resolution_column *column, double z, double dimension)
{
    const double given = column->is_size     ? z
                         : column->is_power  ? -log2(z)
                         : column->is_volume ? pow(z, -dimension)
                                             : 1 / z - column->more;
    const double whole = round(given);
    if (column->is_size)
        return given;
    if (given >= 1e15) { /* round-off has the last digits of a double */
        char digits[32];
        snprintf(digits, sizeof digits, "%.14e", given);
        return strtod(digits, NULL);
    }
    return fabs(given - whole) <= fmin(1e-9 * given, 0.1) ? whole : ceil(given);
}
