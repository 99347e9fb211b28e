/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/orders/orders.h"

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

/* Orders of differences are believed up to this one, of either sign. */
static const double steepest = 60;

/* The order that two errors show. Differences from the next finer value, where `fine` is that of
 * the value that `coarse` is compared with, are C |z^p - z_against^p|. */
static double rate(const struct br_point *coarse, const struct br_point *fine)
{
    const double falls = log(coarse->error / fine->error), ratio = log(coarse->z / fine->z);
    if (!(coarse->error > 0 && fine->error > 0))
        return NAN;
    if (coarse->z_against == 0)
        return falls / ratio;
    const double order = br_order_of_differences(log(fine->z / fine->z_against), ratio, falls, 1);
    return fmax(-steepest, fmin(order, steepest));
}

/* The first point that is hardly smaller than the one before it, as are all finer ones; count:
 * there is none. sorted: room for as many; it holds the rates of the pairs before a point, whose
 * median says what is hardly. */
static size_t find_plateau(const struct br_point *p, size_t count, double *sorted)
{
    size_t first = count;
    for (size_t i = 1; i < count; i++) {
        const double now = rate(&p[i - 1], &p[i]), before = i > 1 ? sorted[(i - 1) / 2] : 0;
        const double share = p[i].error <= deep * p[0].error ? stagnates_deep : stagnates;
        const bool stays = i >= LEAST_POINTS && before > stagnates && now < share * before;
        first = !stays ? count : first < count ? first : i;
        size_t place = i - 1;
        for (; place > 0 && sorted[place - 1] > now; place--)
            sorted[place] = sorted[place - 1];
        sorted[place] = now;
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

static const char *failure_of(const struct br_numbers_row *row, double number)
{
    return row->failure ? row->failure : isnan(number) ? "has no number" : "";
}

/* A row among those of its line: by the size along the other axis, then along the line's. */
struct place {
    double other, along;
    size_t row;
};

static int by_line(const void *a, const void *b)
{
    const struct place *x = a, *y = b;
    const int order = (x->other < y->other) - (x->other > y->other);
    return order ? order : (x->along < y->along) - (x->along > y->along);
}

/* An error, or what a value differs from the next finer one by. */
static struct br_point point_of(const struct br_orders *o, size_t quantity,
                                const struct br_orders_line *line, size_t i)
{
    const struct br_numbers *numbers = o->numbers;
    const struct br_numbers_row *row = &numbers->row[line->row[i]];
    struct br_point p = {.z = row->z[line->axis], .error = row->number[quantity]};
    const char *failure = failure_of(row, p.error);
    size_t named = line->row[i];
    if (numbers->quantity[quantity].is_value) {
        const struct br_numbers_row *finer = &numbers->row[line->row[i + 1]];
        const char *of_finer = failure_of(finer, finer->number[quantity]);
        named = !*failure && *of_finer ? line->row[i + 1] : named;
        failure = *failure ? failure : of_finer;
        p.z_against = finer->z[line->axis];
        p.error = fabs(finer->number[quantity] - p.error);
    }
    name_place(numbers, named, line->axis, p.label);
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

/* Of these rows, from coarse to fine. */
static enum br_status add_line(const struct br_orders *o, struct br_quantity_orders *of,
                               enum br_axis axis, const struct place *place, size_t rows,
                               struct br_error *err)
{
    const struct br_numbers *numbers = o->numbers;
    struct br_orders_line *line = &of->line[of->lines];
    line->row = br_allocate(rows, sizeof *line->row);
    if (!line->row)
        return br_no_memory(err, "the orders");
    of->lines++;
    line->axis = axis;
    for (size_t i = 0; i < rows; i++)
        line->row[i] = place[i].row;
    if (numbers->column[other(axis)] && !o->tied)
        name_place(numbers, line->row[0], other(axis), line->at);
    const enum br_status status = make_points(o, of->quantity, line, rows, err);
    if (status)
        return status;
    for (size_t i = 0; i < line->observed.points; i++)
        of->point[axis][line->row[i]] = (struct br_row_point){line, i};
    return numbers->quantity[of->quantity].is_value ? find_limit(o, of->quantity, rows, line, err)
                                                    : BR_OK;
}

/* The lines along an axis, from the coarsest size of the other one to the finest. */
static enum br_status add_lines(const struct br_orders *o, struct br_quantity_orders *of,
                                enum br_axis axis, struct br_error *err)
{
    const struct br_numbers *numbers = o->numbers;
    const bool alone = o->tied || !numbers->column[other(axis)];
    struct place *place = br_allocate(numbers->rows, sizeof *place);
    of->point[axis] = br_allocate(numbers->rows, sizeof *of->point[axis]);
    enum br_status status = BR_OK;
    if (!place || !of->point[axis])
        status = br_no_memory(err, "the orders");
    for (size_t i = 0; i < numbers->rows && !status; i++)
        place[i] =
            (struct place){alone ? 0 : z_of(numbers, i, other(axis)), z_of(numbers, i, axis), i};
    if (!status)
        qsort(place, numbers->rows, sizeof *place, by_line);
    for (size_t first = 0, end; first < numbers->rows && !status; first = end) {
        for (end = first + 1; end < numbers->rows && place[end].other == place[first].other;)
            end++;
        if (end - first >= LEAST_POINTS)
            status = add_line(o, of, axis, &place[first], end - first, err);
    }
    free(place);
    return status;
}

/* ---- both axes ---- */

static struct br_point *point_on(const struct br_quantity_orders *of, enum br_axis axis, size_t row)
{
    const struct br_row_point *at = of->point[axis] ? &of->point[axis][row] : NULL;
    return at && at->line ? &at->line->observed.point[at->index] : NULL;
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
            seen[count++] = (struct br_observation){
                .x = {z_of(numbers, i, BR_AXIS_SPACE), z_of(numbers, i, BR_AXIS_TIME)},
                .error = error};
    }
    const bool same =
        count > 0 && count == of->joint.points; /* rows are left out, never taken back */
    const enum br_status status = same ? BR_OK : br_joint_fit_solve(seen, count, &of->joint, err);
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
        if (numbers->column[axis] && !(o->tied && axis == BR_AXIS_TIME) && !status)
            status = add_lines(o, of, (enum br_axis)axis, err);
    if (!status)
        status = leave_out(o, of, err);
    for (size_t l = 0; l < of->lines && !status; l++)
        status = br_case_observe(&of->line[l].observed, LEAST_POINTS, err);
    return status;
}

/* Whether both axes are refined from each row to the next. */
static bool are_tied(const struct br_orders *o)
{
    const struct br_numbers *numbers = o->numbers;
    bool tied = is_grid(o);
    for (size_t i = 1; i < numbers->rows; i++)
        for (int axis = 0; axis < BR_AXES; axis++)
            tied &= z_of(numbers, i, (enum br_axis)axis) < z_of(numbers, i - 1, (enum br_axis)axis);
    return tied;
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
        for (int axis = 0; axis < BR_AXES; axis++)
            free(o->of[i].point[axis]);
    }
    free(o->of);
    *o = (struct br_orders){0};
}

const struct br_orders_line *br_orders_finest(const struct br_quantity_orders *of,
                                              enum br_axis axis)
{
    const struct br_orders_line *finest = NULL; /* lines come from coarse to fine */
    for (size_t i = 0; i < of->lines; i++)
        finest = of->line[i].axis == axis ? &of->line[i] : finest;
    return finest;
}

double br_orders_rate(const struct br_orders_line *line, size_t i)
{
    const struct br_point *p = line->observed.point;
    const double order = i ? rate(&p[i - 1], &p[i]) : NAN;
    const bool is_end = i && p[i].z_against > 0 && !(fabs(order) < steepest * (1 - 1e-9));
    return is_end ? NAN : order;
}

/* ---- costs ---- */

/* Below that a run is mostly its start, s. */
static const double least_seconds = 0.02;

enum br_status br_orders_growth(const struct br_orders *o, enum br_axis axis,
                                struct br_estimate *growth, struct br_error *err)
{
    const struct br_orders_line *line = o->count ? br_orders_finest(&o->of[0], axis) : NULL;
    *growth = (struct br_estimate){NAN, NAN, NAN};
    struct br_order_point *point = line ? br_allocate(o->numbers->rows, sizeof *point) : NULL;
    if (!line || !point)
        return line ? br_no_memory(err, "the costs") : BR_OK;
    const size_t rows = line->observed.points + o->numbers->quantity[o->of[0].quantity].is_value;
    size_t count = 0;
    for (size_t i = 0; i < rows; i++) {
        const struct br_numbers_row *row = &o->numbers->row[line->row[i]];
        if (row->seconds >= least_seconds)
            point[count++] = (struct br_order_point){row->z[axis], 0, row->seconds};
    }
    const enum br_status status = br_order_fit(point, count, growth, err);
    *growth = (struct br_estimate){-growth->value, -growth->high, -growth->low};
    free(point);
    return status;
}

const struct br_numbers_row *br_orders_cheapest(const struct br_orders *o, size_t quantity,
                                                double error)
{
    const struct br_numbers_row *best = NULL;
    for (size_t i = 0; i < o->numbers->rows; i++) {
        const struct br_numbers_row *row = &o->numbers->row[i];
        if (row->number[quantity] <= error && (!best || row->seconds < best->seconds))
            best = row;
    }
    return best && isfinite(best->seconds) ? best : NULL;
}
