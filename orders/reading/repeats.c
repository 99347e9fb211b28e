/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of one size: repeated runs, adaptive meshes, or several studies. */
#include "orders/reading/roles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/words.h"

struct repeated_run {
    size_t group, row;
    double z[BR_AXES], error; /* -infinity: none, which counts more than others of its size */
};

static int by_run(const void *a, const void *b)
{
    const struct repeated_run *x = a, *y = b;
    if (x->group != y->group)
        return (x->group > y->group) - (x->group < y->group);
    for (int i = 0; i < BR_AXES; i++)
        if (fabs(x->z[i] - y->z[i]) > 1e-9)
            return (x->z[i] < y->z[i]) - (x->z[i] > y->z[i]);
    return (x->error < y->error) - (x->error > y->error); /* the least error last */
}

static bool is_one_size(const struct repeated_run *a, const struct repeated_run *b)
{
    return a->group == b->group && fabs(a->z[0] - b->z[0]) <= 1e-9 &&
           fabs(a->z[1] - b->z[1]) <= 1e-9;
}

/* The scatter of numbers from run[first] to before run[end], relative to their mean. */
static double scatter_of(const struct repeated_run *run, size_t first, size_t end)
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
        "%s%s%s: the same resolution as in %s: if these are several studies, choose one with "
        "--where COLUMN=WORD; if they are repeated runs, give their mean, or each size at least "
        "twice",
        r->wishes->path, lines ? ":" : ": ",
        br_row_place(r->fields, row, place) + (lines ? strlen("line ") : 0),
        br_row_place(r->fields, before, other));
}

/* Runs of one size: of repeated runs the mean counts, of adaptive meshes the last. */
static enum br_status settle_repeats(struct br_roles *r, struct repeated_run *run, size_t count,
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

enum br_status br_roles_take_repeats(struct br_roles *r, struct br_error *err)
{
    struct repeated_run *run = br_store_take(&r->store, r->rows + 1, sizeof *run);
    size_t count = 0, error = BR_NO_ROW;
    if (!run)
        return br_no_memory(err, "the table");
    for (size_t i = 0; i < r->columns && error == BR_NO_ROW; i++)
        if (br_role_is_studied(&r->column[i]))
            error = i;
    for (size_t i = 0; i < r->rows && error != BR_NO_ROW; i++) {
        if (r->dropped[i])
            continue;
        struct repeated_run *of = &run[count++];
        const double number = r->column[error].number[i];
        *of = (struct repeated_run){r->group[i], i, {0, 0}, isnan(number) ? -INFINITY : number};
        for (int axis = 0; axis < BR_AXES; axis++)
            of->z[axis] = !r->log_z[axis] ? 0
                          : isfinite(r->log_z[axis][i])
                              ? r->log_z[axis][i]
                              : 1e6 + (double)i; /* of none, which is refused */
    }
    return settle_repeats(r, run, count, err);
}
