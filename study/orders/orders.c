/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/orders/orders.h"

#include <gsl/gsl_sort.h>
#include <math.h>
#include <string.h>

enum { LEAST_POINTS = 3 }; /* that an order with an interval needs */

static enum br_axis other(enum br_axis axis)
{
    return axis == BR_AXIS_SPACE ? BR_AXIS_TIME : BR_AXIS_SPACE;
}

/* ---- stagnation ---- */

/* From the first pair of points that stagnates on, no order is seen: a pair's rate is below this
 * share of what the pairs before show. */
static const double stagnates = 0.25;

/* What is that much smaller than the coarsest error is taken for round-off. */
static const double round_off_share = 1e-6;

static double rate(const struct br_point *coarse, const struct br_point *fine)
{
    return log(coarse->error / fine->error) / log(coarse->z / fine->z);
}

/* The median of the rates up to point `last`; NaN where that is not even one. */
static double median_rate(const struct br_point *p, size_t last, double *room)
{
    for (size_t i = 1; i <= last; i++)
        room[i - 1] = rate(&p[i - 1], &p[i]);
    gsl_sort(room, 1, last);
    return last ? room[last / 2] : NAN;
}

/* The first point of the fine end where errors do not fall any more; count: there is none. All
 * pairs from there on stagnate. */
static size_t find_plateau(const struct br_point *p, size_t count, double *room)
{
    size_t first = count;
    for (size_t i = count; i-- > LEAST_POINTS;) {
        const double before = median_rate(p, i - 1, room);
        if (!(before > stagnates && rate(&p[i - 1], &p[i]) < stagnates * before))
            break;
        first = i - 1;
    }
    return first;
}

/* Flags what is near the level where a line's errors stay: as far as a study leaves cells out. */
static enum br_status flag_plateau(struct br_case *c, struct br_error *err)
{
    struct br_point *p = c->point;
    double *room = br_allocate(c->points + 1, sizeof *room);
    if (!room)
        return br_no_memory(err, "the orders");
    size_t good = 0;
    while (good < c->points && p[good].flag == BR_FLAG_NONE)
        good++;
    const size_t first = find_plateau(p, good, room);
    double level = 0;
    for (size_t i = first; i < good; i++)
        level = fmax(level, p[i].error);
    const bool deep = level <= round_off_share * p[0].error;
    for (size_t i = 0; i < good && first < good; i++)
        if (!(p[i].error >= br_flag_margin * level))
            p[i].flag = deep ? BR_FLAG_ROUND_OFF : BR_FLAG_STALLED;
    free(room);
    return BR_OK;
}

/* ---- lines ---- */

static double z_of(const struct br_numbers *numbers, size_t row, enum br_axis axis)
{
    return numbers->row[row].z[axis];
}

/* "n = 40", as the source has it. */
static void name_place(const struct br_numbers *numbers, size_t row, enum br_axis axis,
                       char text[64])
{
    snprintf(text, 64, "%s = %.6g", numbers->column[axis]->name, numbers->row[row].given[axis]);
}

/* The rows of the line that row `first` begins: of equal size along the other axis, or, where both
 * go along, all. Returns how many there are. */
static size_t rows_of_line(const struct br_orders *o, enum br_axis axis, size_t first, size_t *row)
{
    const struct br_numbers *numbers = o->numbers;
    size_t count = 0;
    for (size_t i = 0; i < numbers->rows; i++)
        if (o->tied || !numbers->column[other(axis)] ||
            z_of(numbers, i, other(axis)) == z_of(numbers, first, other(axis)))
            row[count++] = i;
    return count;
}

static const char *failure_of(const struct br_numbers_row *row, double number)
{
    return row->failure ? row->failure : isnan(number) ? "has no number" : "";
}

/* An error, or what a value differs from the next finer one by. */
static struct br_point point_of(const struct br_orders *o, size_t quantity,
                                const struct br_orders_line *line, size_t i)
{
    const struct br_numbers *numbers = o->numbers;
    const struct br_numbers_row *row = &numbers->row[line->row[i]];
    struct br_point p = {.z = row->z[line->axis], .error = row->number[quantity]};
    const char *failure = failure_of(row, p.error);
    if (numbers->quantity[quantity].is_value) {
        const struct br_numbers_row *finer = &numbers->row[line->row[i + 1]];
        failure = *failure ? failure : failure_of(finer, finer->number[quantity]);
        p.z_against = finer->z[line->axis];
        p.error = fabs(finer->number[quantity] - p.error);
    }
    name_place(numbers, line->row[i], line->axis, p.label);
    snprintf(p.failure, sizeof p.failure, "%.255s", failure);
    p.flag = *failure       ? BR_FLAG_FAILED
             : p.error > 0  ? BR_FLAG_NONE
             : p.error == 0 ? BR_FLAG_ROUND_OFF
                            : BR_FLAG_FAILED;
    return p;
}

static enum br_status observe(const struct br_orders *o, size_t quantity,
                              struct br_orders_line *line, size_t rows, struct br_error *err)
{
    const struct br_quantity *q = &o->numbers->quantity[quantity];
    struct br_case *c = &line->observed;
    *c = (struct br_case){
        .kind = line->axis == BR_AXIS_SPACE ? BR_VERIFY_SPACE : BR_VERIFY_TIME,
        .expected = {.order = NAN, .tolerance = NAN, .floor = NAN, .ceiling = NAN},
        .measure = q->name,
        .part = "",
        .unit = q->unit ? q->unit : "",
        .points = rows - q->is_value,
    };
    c->point = br_allocate(c->points + 1, sizeof *c->point);
    if (!c->point)
        return br_no_memory(err, "the orders");
    for (size_t i = 0; i < c->points; i++)
        c->point[i] = point_of(o, quantity, line, i);
    if (flag_plateau(c, err))
        return err->status;
    return br_case_observe(c, LEAST_POINTS, err);
}

static enum br_status add_line(const struct br_orders *o, struct br_quantity_orders *of,
                               enum br_axis axis, size_t first, struct br_error *err)
{
    const struct br_numbers *numbers = o->numbers;
    struct br_orders_line *line = &of->line[of->lines];
    line->row = br_allocate(numbers->rows, sizeof *line->row);
    if (!line->row)
        return br_no_memory(err, "the orders");
    line->axis = axis;
    const size_t rows = rows_of_line(o, axis, first, line->row);
    if (rows < LEAST_POINTS) {
        free(line->row);
        line->row = NULL;
        return BR_OK;
    }
    of->lines++;
    if (numbers->column[other(axis)] && !o->tied)
        name_place(numbers, first, other(axis), line->at);
    return observe(o, of->quantity, line, rows, err);
}

/* Whether no row before has its size along the other axis. */
static bool begins_line(const struct br_orders *o, enum br_axis axis, size_t row)
{
    const struct br_numbers *numbers = o->numbers;
    if (o->tied || !numbers->column[other(axis)])
        return row == 0;
    for (size_t i = 0; i < row; i++)
        if (z_of(numbers, i, other(axis)) == z_of(numbers, row, other(axis)))
            return false;
    return true;
}

/* ---- both axes ---- */

/* Whether a row counts in all lines that it is in. */
static bool counts(const struct br_quantity_orders *of, size_t row)
{
    for (size_t l = 0; l < of->lines; l++)
        for (size_t i = 0; i < of->line[l].observed.points; i++)
            if (of->line[l].row[i] == row && of->line[l].observed.point[i].flag != BR_FLAG_NONE)
                return false;
    return true;
}

static enum br_status fit_both(const struct br_orders *o, struct br_quantity_orders *of,
                               struct br_error *err)
{
    const struct br_numbers *numbers = o->numbers;
    struct br_observation *seen = br_allocate(numbers->rows, sizeof *seen);
    size_t count = 0;
    if (!seen)
        return br_no_memory(err, "the joint fit");
    for (size_t i = 0; i < numbers->rows; i++) {
        const double error = numbers->row[i].number[of->quantity];
        if (error > 0 && counts(of, i))
            seen[count++] = (struct br_observation){.h = z_of(numbers, i, BR_AXIS_SPACE),
                                                    .k = z_of(numbers, i, BR_AXIS_TIME),
                                                    .error = error};
    }
    const enum br_status status = br_joint_fit_solve(seen, count, &of->joint, err);
    free(seen);
    return status;
}

/* ---- all ---- */

static bool is_grid(const struct br_orders *o)
{
    return o->numbers->column[BR_AXIS_SPACE] && o->numbers->column[BR_AXIS_TIME] && !o->tied;
}

static enum br_status find_quantity(const struct br_orders *o, struct br_quantity_orders *of,
                                    struct br_error *err)
{
    const struct br_numbers *numbers = o->numbers;
    of->line = br_allocate(2 * numbers->rows, sizeof *of->line);
    if (!of->line)
        return br_no_memory(err, "the orders");
    enum br_status status = BR_OK;
    for (int axis = 0; axis < BR_AXES; axis++)
        for (size_t i = 0; i < numbers->rows && !status; i++)
            if (numbers->column[axis] && begins_line(o, (enum br_axis)axis, i) &&
                !(o->tied && axis == BR_AXIS_TIME))
                status = add_line(o, of, (enum br_axis)axis, i, err);
    if (!status && is_grid(o) && !numbers->quantity[of->quantity].is_value)
        status = fit_both(o, of, err);
    return status;
}

/* Whether no size of either axis has three rows. */
static bool are_tied(struct br_orders *o)
{
    const struct br_numbers *numbers = o->numbers;
    if (!is_grid(o))
        return false;
    for (size_t i = 0; i < numbers->rows; i++)
        for (int axis = 0; axis < BR_AXES; axis++) {
            size_t equal = 0;
            for (size_t j = 0; j < numbers->rows; j++)
                equal += numbers->row[i].z[axis] == numbers->row[j].z[axis];
            if (equal >= LEAST_POINTS)
                return false;
        }
    return true;
}

enum br_status br_orders_find(const struct br_numbers *numbers, struct br_orders *o,
                              struct br_error *err)
{
    *o = (struct br_orders){.numbers = numbers};
    o->tied = are_tied(o);
    o->of = br_allocate(numbers->quantities, sizeof *o->of);
    if (!o->of)
        return br_no_memory(err, "the orders");
    enum br_status status = BR_OK;
    for (; o->count < numbers->quantities && !status; o->count++) {
        o->of[o->count].quantity = o->count;
        status = find_quantity(o, &o->of[o->count], err);
    }
    return status;
}

void br_orders_clear(struct br_orders *o)
{
    for (size_t i = 0; i < o->count; i++) {
        for (size_t l = 0; l < o->of[i].lines; l++) {
            free(o->of[i].line[l].row);
            free(o->of[i].line[l].observed.point);
        }
        free(o->of[i].line);
    }
    free(o->of);
    *o = (struct br_orders){0};
}

double br_orders_rate(const struct br_orders_line *line, size_t i)
{
    const struct br_point *p = line->observed.point;
    return i ? rate(&p[i - 1], &p[i]) : NAN;
}
