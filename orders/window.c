/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A window by hand: the sizes that the request leaves out have no part in orders, limits and
 * verdicts. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/words.h"
#include "orders/request.h"

/* ---- sizes without a part: "8, n=16" ---- */

/* An item of the list. */
struct item {
    char text[64];
    const char *name; /* of the column; NULL: any */
    double number;
};

static bool read_item(const char *from, size_t length, struct item *item)
{
    struct br_field_number found;
    snprintf(item->text, sizeof item->text, "%.*s", (int)(length < 63 ? length : 63), from);
    char number[64], *equals = strchr(item->text, '=');
    snprintf(number, sizeof number, "%s", equals ? equals + 1 : item->text);
    item->name = NULL;
    if (equals) {
        const struct br_resolution_column *column;
        char name[64];
        snprintf(name, sizeof name, "%.*s", (int)(equals - item->text), item->text);
        column = strcmp(name, br_degree_column.name) == 0 ? &br_degree_column
                                                          : br_resolution_column_find(name);
        item->name = column ? column->name : "";
    }
    const bool reads = length < 63 && br_field_read(number, '.', &found);
    item->number = reads ? found.value : (double)NAN;
    return reads && isnan(found.deviation);
}

/* The first row whose size along an axis is the item's, to so much; NULL: there is none. */
static const struct br_numbers_row *row_of_size(const struct br_numbers *n, enum br_axis axis,
                                                const struct item *item, double relative)
{
    const struct br_resolution_column *column = n->column[axis];
    for (size_t i = 0; i < n->rows && column; i++)
        if ((!item->name || strcmp(item->name, column->name) == 0) &&
            fabs(n->row[i].given[axis] - item->number) <= relative * fabs(item->number))
            return &n->row[i];
    return NULL;
}

/* Lists the sizes of both axes: "n = 8", "k = 0.1". */
static enum br_status refuse_size(const struct br_numbers *n, const char *path,
                                  const struct item *item, struct br_error *err)
{
    char expected[BR_EXPECTED - BR_SUGGESTION] = "expected one of: ", name[64];
    size_t count = 0;
    for (enum br_axis axis = 0; axis < BR_AXES; axis++)
        for (size_t i = 0; i < n->rows && n->column[axis]; i++) {
            bool is_new = !isnan(n->row[i].given[axis]);
            for (size_t j = 0; j < i && is_new; j++)
                is_new = n->row[j].z[axis] != n->row[i].z[axis];
            if (!is_new)
                continue;
            br_numbers_name(n, &n->row[i], axis, name);
            br_append(expected, sizeof expected, "%s%s", count++ ? ", " : "", name);
        }
    return br_fail(err, BR_BAD_INPUT, "%s: --without: found %s, which is no size there, %s", path,
                   item->text, expected);
}

static void leave(struct br_numbers_row *row, size_t quantity)
{
    if (row->out[quantity] != BR_FLAG_ABSENT)
        row->out[quantity] = BR_FLAG_BY_HAND;
}

/* Leaves out the rows of a size: all that have its name, since sizes are printed to six digits. */
static void leave_out(struct br_numbers *n, enum br_axis axis, const struct br_numbers_row *size)
{
    char name[64], other[64];
    br_numbers_name(n, size, axis, name);
    for (size_t i = 0; i < n->rows; i++) {
        br_numbers_name(n, &n->row[i], axis, other);
        for (size_t q = 0; q < n->quantities && strcmp(other, name) == 0; q++)
            leave(&n->row[i], q);
    }
}

/* Leaves out one size. Nearly equal ones are one, where no other is equal. */
static enum br_status leave_size_out(struct br_numbers *n, const char *path,
                                     const struct item *item, struct br_error *err)
{
    static const double equal = 1e-12, printed = 1e-5;
    const struct br_numbers_row *found[BR_AXES] = {NULL};
    for (int turn = 0; turn < 2 && !found[0] && !found[1]; turn++)
        for (enum br_axis axis = 0; axis < BR_AXES; axis++)
            found[axis] = row_of_size(n, axis, item, turn ? printed : equal);
    if (!found[0] && !found[1])
        return refuse_size(n, path, item, err);
    if (found[0] && found[1])
        return br_fail(err, BR_BAD_INPUT,
                       "%s: --without: %s is a size of %s and of %s, expected %s=%s or %s=%s", path,
                       item->text, n->column[0]->name, n->column[1]->name, n->column[0]->name,
                       item->text, n->column[1]->name, item->text);
    leave_out(n, found[0] ? BR_AXIS_SPACE : BR_AXIS_TIME, found[0] ? found[0] : found[1]);
    return BR_OK;
}

static enum br_status leave_sizes_out(struct br_numbers *n, const char *path, const char *list,
                                      struct br_error *err)
{
    const char *from;
    size_t length;
    while (list) {
        struct item item;
        list = br_list_next(list, &from, &length);
        if (!read_item(from, length, &item))
            return br_fail(err, BR_BAD_INPUT,
                           "%s: --without: found '%s', expected sizes, like 8 or 8,16 or n=8", path,
                           item.text);
        if (leave_size_out(n, path, &item, err))
            return err->status;
    }
    return BR_OK;
}

/* ---- the finest sizes ---- */

static bool has_part(const struct br_numbers *n, size_t row, size_t q, enum br_axis axis)
{
    const struct br_numbers_row *r = &n->row[row];
    return n->column[axis] && !r->failure && isfinite(r->number[q]) && isfinite(r->z[axis]) &&
           br_has_part(r->out[q]);
}

/* The sizes of a quantity along an axis, from fine to coarse. */
static size_t sizes_of(const struct br_numbers *n, size_t q, enum br_axis axis, double *z)
{
    size_t count = 0, different = 0;
    for (size_t i = 0; i < n->rows; i++)
        if (has_part(n, i, q, axis))
            z[count++] = n->row[i].z[axis];
    qsort(z, count, sizeof *z, br_by_number);
    for (size_t i = 0; i < count; i++)
        if (i == 0 || z[i] > z[different - 1])
            z[different++] = z[i];
    return different;
}

/* Leaves out all but the finest sizes along each axis. "the 3 finest of 6", "of 6 n and of 4 k"; of
 * a quantity with fewer sizes all. */
static void keep_finest(struct br_numbers *n, size_t q, size_t finest, double *z, char *text,
                        size_t size)
{
    double coarsest[BR_AXES] = {INFINITY, INFINITY};
    size_t count[BR_AXES] = {0};
    const bool both = n->column[0] && n->column[1];
    for (enum br_axis axis = 0; axis < BR_AXES; axis++) {
        count[axis] = sizes_of(n, q, axis, z);
        coarsest[axis] = count[axis] > finest ? z[finest - 1] : (double)INFINITY;
    }
    const size_t most = count[0] > count[1] ? count[0] : count[1];
    br_append(text, size, "the %zu finest", finest < most ? finest : most);
    for (enum br_axis axis = 0; axis < BR_AXES; axis++)
        if (n->column[axis])
            br_append(text, size, "%s of %zu%s%s", both && axis ? " and" : "", count[axis],
                      both ? " " : "", both ? n->column[axis]->name : "");
    for (size_t i = 0; i < n->rows; i++)
        if (n->row[i].z[0] > coarsest[0] || n->row[i].z[1] > coarsest[1])
            leave(&n->row[i], q);
}

static enum br_status check_finest(const struct br_numbers *n, const char *path, double finest,
                                   double *z, struct br_error *err)
{
    size_t most = 0;
    for (size_t q = 0; q < n->quantities; q++)
        for (enum br_axis axis = 0; axis < BR_AXES; axis++) {
            const size_t count = sizes_of(n, q, axis, z);
            most = count > most ? count : most;
        }
    return finest <= (double)most
               ? BR_OK
               : br_fail(err, BR_BAD_INPUT,
                         "%s: --finest: found %g, expected at most the %zu sizes "
                         "that have numbers",
                         path, finest, most);
}

/* ---- all ---- */

/* Refuses a window without an order: the sizes that a quantity had are too few now. */
static enum br_status check_left(const struct br_numbers *n, const char *path, size_t q,
                                 const size_t before[BR_AXES], double *z, struct br_error *err)
{
    size_t most_before = 0, most = 0, least = SIZE_MAX;
    for (enum br_axis axis = 0; axis < BR_AXES; axis++) {
        const size_t count = sizes_of(n, q, axis, z);
        most_before = before[axis] > most_before ? before[axis] : most_before;
        most = count > most ? count : most;
        least = before[axis] > 1 && count < least ? count : least;
    }
    if (most_before < BR_ORDERS_LEAST || (most >= BR_ORDERS_LEAST && least > 1))
        return BR_OK;
    return br_fail(err, BR_BAD_INPUT,
                   "%s: rows by hand: of %s %zu size%s would be left, expected at least %d", path,
                   n->quantity[q].name, least, least == 1 ? "" : "s",
                   most >= BR_ORDERS_LEAST ? 2 : BR_ORDERS_LEAST);
}

/* "the 3 finest of 5, without 8". */
static enum br_status open_window(struct br_numbers *n, const struct br_orders_request *r, size_t q,
                                  double *z, struct br_error *err)
{
    const size_t size = 100 + (r->without ? strlen(r->without) : 0);
    char *text = n->quantity[q].window = br_allocate(size, 1);
    if (!text)
        return br_no_memory(err, "the window");
    if (r->finest > 0)
        keep_finest(n, q, (size_t)r->finest, z, text, size);
    if (r->without)
        br_append(text, size, "%s %s", *text ? ", without" : "all but", r->without);
    return BR_OK;
}

enum br_status br_orders_window(const struct br_orders_request *r, struct br_numbers *n,
                                struct br_error *err)
{
    const char *path = br_orders_path(r);
    if (!(r->finest > 0) && !r->without)
        return BR_OK;
    double *z = br_allocate(n->rows, sizeof *z);
    size_t(*before)[BR_AXES] = br_allocate(n->quantities, sizeof *before);
    enum br_status status = z && before ? BR_OK : br_no_memory(err, "the window");
    for (size_t q = 0; q < n->quantities && !status; q++)
        for (enum br_axis axis = 0; axis < BR_AXES; axis++)
            before[q][axis] = sizes_of(n, q, axis, z);
    if (!status && r->without)
        status = leave_sizes_out(n, path, r->without, err);
    if (!status && r->finest > 0)
        status = check_finest(n, path, r->finest, z, err);
    for (size_t q = 0; q < n->quantities && !status; q++) {
        status = open_window(n, r, q, z, err);
        status = status ? status : check_left(n, path, q, before[q], z, err);
    }
    free(before);
    free(z);
    return status;
}
