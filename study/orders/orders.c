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

/* Errors have stopped falling where a pair of points shows less than this share of the rate of the
 * pairs before. Beside a limit that is as small as round-off, more of it is enough: there an order
 * that falls is no order of the program any more. */
static const double stagnates = 0.25, stagnates_deep = 0.6;

/* What is that much smaller than the coarsest error is taken for round-off. */
static const double deep = 1e-6;

/* What is less than this many times the level at which errors stay is off by that level. */
static const double beside = 10;

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

/* The first point that is hardly smaller than the one before it, as are all finer ones; count:
 * there is none. */
static size_t find_plateau(const struct br_point *p, size_t count, double *room)
{
    size_t first = count;
    for (size_t i = count; i-- > LEAST_POINTS;) {
        const double before = median_rate(p, i - 1, room);
        const double share = p[i].error <= deep * p[0].error ? stagnates_deep : stagnates;
        if (!(before > stagnates && rate(&p[i - 1], &p[i]) < share * before))
            break;
        first = i;
    }
    return first;
}

/* Flags what is near the level where a line's errors stay. */
static enum br_status flag_plateau(struct br_case *c, struct br_error *err)
{
    struct br_point *p = c->point;
    double *room = br_allocate(c->points + 1, sizeof *room);
    if (!room)
        return br_no_memory(err, "the orders");
    size_t good = 0;
    while (good < c->points && p[good].flag == BR_FLAG_NONE)
        good++;
    double level = 0;
    for (size_t i = find_plateau(p, good, room); i < good; i++)
        level = fmax(level, p[i].error);
    for (size_t i = 0; i < good; i++)
        if (p[i].error < beside * level)
            p[i].flag = level <= deep * p[0].error ? BR_FLAG_ROUND_OFF : BR_FLAG_STALLED;
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

static enum br_status make_points(const struct br_orders *o, size_t quantity,
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
        .drifts = true,
    };
    c->point = br_allocate(c->points + 1, sizeof *c->point);
    if (!c->point)
        return br_no_memory(err, "the orders");
    for (size_t i = 0; i < c->points; i++)
        c->point[i] = point_of(o, quantity, line, i);
    return BR_OK;
}

/* What the values of a line tend to; nothing is known where there are too few. */
static enum br_status find_limit(const struct br_orders *o, size_t quantity, size_t rows,
                                 struct br_orders_line *line, struct br_error *err)
{
    double *h = br_allocate(2 * rows, sizeof *h), *value = h + rows;
    size_t count = 0;
    line->limit.value = (struct br_estimate){NAN, NAN, NAN};
    if (!h)
        return br_no_memory(err, "the limits");
    for (size_t i = 0; i < rows; i++) {
        const struct br_numbers_row *row = &o->numbers->row[line->row[i]];
        if (isnan(row->number[quantity]) || row->failure)
            continue;
        h[count] = row->z[line->axis];
        value[count++] = row->number[quantity];
    }
    enum br_status status = BR_OK;
    if (count >= LEAST_POINTS)
        status = br_limit_of_values(h, value, count, o->formal, &line->limit, err);
    if (count >= LEAST_POINTS && !status)
        status = br_gci(h, value, count, &line->gci, err);
    free(h);
    return status;
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
    const enum br_status status = make_points(o, of->quantity, line, rows, err);
    return status || !numbers->quantity[of->quantity].is_value
               ? status
               : find_limit(o, of->quantity, rows, line, err);
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

/* The point of a row on a line along an axis; NULL: it is on none. */
static struct br_point *point_on(const struct br_quantity_orders *of, enum br_axis axis, size_t row)
{
    for (size_t l = 0; l < of->lines; l++)
        for (size_t i = 0; i < of->line[l].observed.points; i++)
            if (of->line[l].axis == axis && of->line[l].row[i] == row)
                return &of->line[l].observed.point[i];
    return NULL;
}

/* Errors that stay along one axis, but fall along the other one, are that one's, and count. */
static void flag_corners(const struct br_orders *o, struct br_quantity_orders *of)
{
    for (size_t i = 0; i < o->numbers->rows; i++) {
        struct br_point *a = point_on(of, BR_AXIS_SPACE, i), *b = point_on(of, BR_AXIS_TIME, i);
        if (a && b && (a->flag == BR_FLAG_NONE || b->flag == BR_FLAG_NONE))
            a->flag = b->flag = BR_FLAG_NONE;
    }
}

static bool counts(const struct br_quantity_orders *of, size_t row)
{
    const struct br_point *a = point_on(of, BR_AXIS_SPACE, row),
                          *b = point_on(of, BR_AXIS_TIME, row);
    return (!a || a->flag == BR_FLAG_NONE) && (!b || b->flag == BR_FLAG_NONE);
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

/* Leaves out what is at a floor. On a grid errors may stay along one axis for the other one's;
 * where the joint fit describes them all, nothing is left out. */
static enum br_status leave_out(const struct br_orders *o, struct br_quantity_orders *of,
                                struct br_error *err)
{
    const bool joint = is_grid(o) && !o->numbers->quantity[of->quantity].is_value;
    enum br_status status = joint ? fit_both(o, of, err) : BR_OK;
    if (status || (joint && br_joint_describes(&of->joint)))
        return status;
    for (size_t l = 0; l < of->lines && !status; l++)
        status = flag_plateau(&of->line[l].observed, err);
    if (status || !joint)
        return status;
    flag_corners(o, of);
    return fit_both(o, of, err);
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
    if (!status)
        status = leave_out(o, of, err);
    for (size_t l = 0; l < of->lines && !status; l++)
        status = br_case_observe(&of->line[l].observed, LEAST_POINTS, err);
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

enum br_status br_orders_find(const struct br_numbers *numbers, double formal, struct br_orders *o,
                              struct br_error *err)
{
    *o = (struct br_orders){.numbers = numbers, .formal = formal};
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
