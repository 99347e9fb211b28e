/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/orders/numbers.h"

#include <math.h>
#include <string.h>

const char *const br_axis_letters[] = {"h", "k"};

const struct br_resolution_column br_resolution_columns[] = {
    {"h", BR_AXIS_SPACE, .is_size = true},
    {"n", BR_AXIS_SPACE, .is_size = false},
    {"dofs", BR_AXIS_SPACE, .is_volume = true},
    {"k", BR_AXIS_TIME, .is_size = true},
    {"dt", BR_AXIS_TIME, .is_size = true},
    {"steps", BR_AXIS_TIME, .is_size = false},
    {0},
};

const struct br_resolution_column *br_resolution_column_find(const char *name)
{
    for (const struct br_resolution_column *c = br_resolution_columns; c->name; c++)
        if (strcmp(c->name, name) == 0)
            return c;
    return NULL;
}

double br_numbers_z(const struct br_resolution_column *column, double given, double dimension)
{
    return column->is_size ? given : column->is_volume ? pow(given, -1 / dimension) : 1 / given;
}

bool br_lists(const char *list, const char *name)
{
    const size_t length = strlen(name);
    for (const char *at = list; at && *at; at += strcspn(at, ","), at += *at == ',') {
        at += strspn(at, " ");
        if (strncmp(at, name, length) == 0 && strchr(", ", at[length]))
            return true;
    }
    return false;
}

void br_numbers_clear(struct br_numbers *numbers)
{
    for (size_t i = 0; i < numbers->quantities; i++) {
        free(numbers->quantity[i].name);
        free(numbers->quantity[i].unit);
    }
    for (size_t i = 0; i < numbers->rows; i++) {
        free(numbers->row[i].number);
        free(numbers->row[i].failure);
    }
    for (int axis = 0; axis < BR_AXES; axis++)
        free(numbers->unit[axis]);
    free(numbers->quantity);
    free(numbers->row);
    *numbers = (struct br_numbers){0};
}

/* From coarse to fine; a column that is not there is equal in all rows. */
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
    return (x->line > y->line) - (x->line < y->line);
}

static enum br_status check_row(const struct br_numbers *numbers, const struct br_numbers_row *row,
                                const char *path, struct br_error *err)
{
    for (int axis = 0; axis < BR_AXES; axis++)
        if (numbers->column[axis] && !(row->given[axis] > 0 && isfinite(row->given[axis])))
            return br_fail(err, BR_BAD_INPUT, "%s:%zu: %s: found %g, expected a number above 0",
                           path, row->line, numbers->column[axis]->name, row->given[axis]);
    return BR_OK;
}

/* How many different sizes there are along an axis. */
static size_t sizes(const struct br_numbers *numbers, int axis)
{
    size_t count = 0;
    for (size_t i = 0; i < numbers->rows; i++) {
        bool seen = false;
        for (size_t j = 0; j < i; j++)
            seen |= numbers->row[i].z[axis] == numbers->row[j].z[axis];
        count += !seen;
    }
    return count;
}

enum br_status br_numbers_check(struct br_numbers *numbers, const char *path, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < numbers->rows && !status; i++)
        status = check_row(numbers, &numbers->row[i], path, err);
    if (status)
        return status;
    qsort(numbers->row, numbers->rows, sizeof *numbers->row, by_resolution);
    for (size_t i = 1; i < numbers->rows; i++) {
        const struct br_numbers_row *a = &numbers->row[i - 1], *b = &numbers->row[i];
        bool equal = true;
        for (int axis = 0; axis < BR_AXES; axis++)
            equal &= !numbers->column[axis] || a->z[axis] == b->z[axis];
        if (equal)
            return br_fail(err, BR_BAD_INPUT,
                           "%s:%zu: the resolution is that of line %zu, expected each once", path,
                           b->line, a->line);
    }
    size_t most = 0;
    for (int axis = 0; axis < BR_AXES; axis++) {
        const size_t count = numbers->column[axis] ? sizes(numbers, axis) : 0;
        most = count > most ? count : most;
    }
    if (most < 3)
        return br_fail(err, BR_BAD_INPUT, "%s: found %zu resolutions, expected at least 3", path,
                       most);
    return BR_OK;
}
