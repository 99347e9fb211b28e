/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/orders/orders.h"

#include <math.h>
#include <string.h>

enum { LEAST_POINTS = 3 }; /* for an order with an interval */

static enum br_axis other(enum br_axis axis)
{
    return axis == BR_AXIS_SPACE ? BR_AXIS_TIME : BR_AXIS_SPACE;
}

static enum br_status stopped(const struct br_numbers *numbers, struct br_error *err)
{
    return br_observer_stops(numbers->observer) ? br_fail(err, BR_INTERRUPTED, "interrupted")
                                                : BR_OK;
}

/* ---- stagnation ---- */

/* Errors have stopped falling where the rate of a pair of points is below this share of the rate of
 * the pairs before. Near a limit as small as round-off the share may be larger: there a lower rate
 * is not the order of the program any more. */
static const double stagnates = 0.25, stagnates_deep = 0.6;

/* A level below this share of the coarsest error is taken for round-off. */
static const double deep = 1e-6;

/* Errors below this many times the level at which errors stay are changed by that level. */
static const double level_margin = 10;

/* Orders of differences are believed up to this magnitude. */
static const double steepest = 60;

/* The order that two errors show. Differences from the next finer value are C |z^p - z_against^p|;
 * then z_against of `coarse` is z of `fine`. */
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

/* The first of the points at the fine end that are hardly smaller than the point before, by the
 * median rate of the pairs before; count: there is none. sorted: room for `count` rates. */
static size_t find_plateau(const struct br_point *p, size_t count, double *sorted)
{
    size_t first = count;
    for (size_t i = 1; i < count; i++) {
        const double now = rate(&p[i - 1], &p[i]), before = i > 1 ? sorted[(i - 1) / 2] : 0;
        const double share = p[i].error <= deep * p[0].error ? stagnates_deep : stagnates;
        const bool stays = i >= LEAST_POINTS && before > stagnates && now < share * before;
        first = !stays ? count : first < count ? first : i;
        size_t at = i - 1;
        for (; at > 0 && sorted[at - 1] > now; at--)
            sorted[at] = sorted[at - 1];
        sorted[at] = now;
    }
    return first;
}

/* Flags the points near the level at which the errors of a line stay. */
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
        if (p[i].error < level_margin * level)
            p[i].flag = level <= deep * p[0].error ? BR_FLAG_ROUND_OFF : BR_FLAG_STALLED;
    free(room);
    return BR_OK;
}

/* ---- lines ---- */

static double z_of(const struct br_numbers *numbers, size_t row, enum br_axis axis)
{
    return numbers->row[row].z[axis];
}

/* "n = 40", with the number as given. */
static void name_size(const struct br_numbers *numbers, size_t row, enum br_axis axis,
                      char text[64])
{
    snprintf(text, 64, "%s = %.6g", numbers->column[axis]->name, numbers->row[row].given[axis]);
}

static const char *failure_of(const struct br_numbers_row *row, double number)
{
    return row->failure ? row->failure : isnan(number) ? "has no number" : "";
}

/* A row by its size along the other axis, then by its size along the axis of the line. */
struct line_row {
    double other, along;
    size_t row;
};

static int by_line(const void *a, const void *b)
{
    const struct line_row *x = a, *y = b;
    const int order = (x->other < y->other) - (x->other > y->other);
    return order ? order : (x->along < y->along) - (x->along > y->along);
}

/* An error, or the difference of a value from the next finer one. */
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
    name_size(numbers, named, line->axis, p.label);
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

/* The limit of the values of a line; not known where there are too few. */
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

/* Adds the line of these rows, which are sorted from coarse to fine. */
static enum br_status add_line(const struct br_orders *o, struct br_quantity_orders *of,
                               enum br_axis axis, const struct line_row *sorted, size_t rows,
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
        line->row[i] = sorted[i].row;
    if (numbers->column[other(axis)] && !o->tied)
        name_size(numbers, line->row[0], other(axis), line->at);
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
    struct line_row *sorted = br_allocate(numbers->rows, sizeof *sorted);
    of->point[axis] = br_allocate(numbers->rows, sizeof *of->point[axis]);
    enum br_status status = BR_OK;
    if (!sorted || !of->point[axis])
        status = br_no_memory(err, "the orders");
    for (size_t i = 0; i < numbers->rows && !status; i++)
        sorted[i] =
            (struct line_row){alone ? 0 : z_of(numbers, i, other(axis)), z_of(numbers, i, axis), i};
    if (!status)
        qsort(sorted, numbers->rows, sizeof *sorted, by_line);
    for (size_t first = 0, end; first < numbers->rows && !status; first = end) {
        status = stopped(numbers, err);
        for (end = first + 1; end < numbers->rows && sorted[end].other == sorted[first].other;)
            end++;
        if (!status && end - first >= LEAST_POINTS)
            status = add_line(o, of, axis, &sorted[first], end - first, err);
    }
    free(sorted);
    return status;
}

/* ---- both axes ---- */

static struct br_point *point_on(const struct br_quantity_orders *of, enum br_axis axis, size_t row)
{
    const struct br_row_point *at = of->point[axis] ? &of->point[axis][row] : NULL;
    return at && at->line ? &at->line->observed.point[at->index] : NULL;
}

/* An error that stays along one axis but falls along the other belongs to the other: no flag. */
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
    struct br_observation *observation = br_allocate(numbers->rows, sizeof *observation);
    size_t count = 0;
    if (!observation)
        return br_no_memory(err, "the joint fit");
    for (size_t i = 0; i < numbers->rows; i++) {
        const double error = numbers->row[i].number[of->quantity];
        if (error > 0 && counts(of, i))
            observation[count++] = (struct br_observation){
                .x = {z_of(numbers, i, BR_AXIS_SPACE), z_of(numbers, i, BR_AXIS_TIME)},
                .error = error};
    }
    /* Rows are only left out, so the same number means the same rows. */
    const bool same = count > 0 && count == of->joint.points;
    const enum br_status status =
        same ? BR_OK : br_joint_fit_solve(observation, count, numbers->observer, &of->joint, err);
    free(observation);
    return status;
}

/* ---- all ---- */

static bool is_grid(const struct br_orders *o)
{
    return o->numbers->column[BR_AXIS_SPACE] && o->numbers->column[BR_AXIS_TIME] && !o->tied;
}

/* Leaves out errors at a floor. On a grid, errors may stay along one axis since the error of the
 * other axis is larger; where the joint fit describes all errors, none is left out. */
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

static bool holds(const struct br_estimate *interval, const struct br_estimate *order)
{
    return interval->low <= order->value && order->value <= interval->high;
}

/* The answer of a grid of errors whose joint fit is refused. */
static struct br_orders_answer answer_of_lines(const struct br_quantity_orders *of,
                                               const struct br_orders_line *finest)
{
    static const char *const disturbed[BR_AXES] = {
        "the order in h is not the same at the two finest k, and no joint fit describes the "
        "errors: a finer k, or more sizes of both, would show it",
        "the order in k is not the same at the two finest h, and no joint fit describes the "
        "errors: a finer h, or more sizes of both, would show it"};
    const struct br_orders_line *next = finest > of->line ? finest - 1 : NULL;
    const struct br_estimate *a = &finest->observed.order;
    if (next && next->axis == finest->axis && holds(a, &next->observed.order) &&
        holds(&next->observed.order, a))
        return (struct br_orders_answer){*a, ""};
    return (struct br_orders_answer){{NAN, NAN, NAN}, disturbed[finest->axis]};
}

static struct br_orders_answer find_answer(const struct br_orders *o,
                                           const struct br_quantity_orders *of, enum br_axis axis)
{
    static const char *const hidden[BR_AXES] = {
        "the error in h is below that in k everywhere: a finer k, or a coarser h, would show it",
        "the error in k is below that in h everywhere: a finer h, or a coarser k, would show it"};
    const struct br_orders_line *finest = br_orders_finest(of, axis);
    if (br_joint_describes(&of->joint))
        return (struct br_orders_answer){of->joint.order[axis],
                                         br_joint_has(of->joint.kind, axis) ? "" : hidden[axis]};
    if (!finest)
        return (struct br_orders_answer){{NAN, NAN, NAN}, ""};
    return is_grid(o) && !o->numbers->quantity[of->quantity].is_value
               ? answer_of_lines(of, finest)
               : (struct br_orders_answer){finest->observed.order, ""};
}

static enum br_status find_quantity(const struct br_orders *o, struct br_quantity_orders *of,
                                    struct br_error *err)
{
    const struct br_numbers *numbers = o->numbers;
    of->line = br_allocate(2 * numbers->rows, sizeof *of->line);
    if (!of->line)
        return br_no_memory(err, "the orders");
    enum br_status status = stopped(numbers, err);
    for (int axis = 0; axis < BR_AXES; axis++)
        if (numbers->column[axis] && !(o->tied && axis == BR_AXIS_TIME) && !status)
            status = add_lines(o, of, (enum br_axis)axis, err);
    if (!status)
        status = leave_out(o, of, err);
    for (size_t l = 0; l < of->lines && !status; l++)
        status = stopped(numbers, err) ? err->status
                                       : br_case_observe(&of->line[l].observed, LEAST_POINTS, err);
    for (int axis = 0; axis < BR_AXES; axis++)
        of->answer[axis] = find_answer(o, of, (enum br_axis)axis);
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

/* A shorter run is mostly its start, s. */
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
