/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/orders/orders.h"

#include <math.h>
#include <string.h>

#include "study/fit/line_order.h"

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

/* ---- rates ---- */

static double rate(const struct br_point *coarse, const struct br_point *fine)
{
    return br_order_rate(&(struct br_order_point){coarse->z, coarse->z_against, coarse->error},
                         &(struct br_order_point){fine->z, fine->z_against, fine->error});
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

static double deviation_of(const struct br_numbers_row *row, size_t quantity)
{
    return row->deviation ? row->deviation[quantity] : NAN;
}

/* An error, or the difference of a value from the next finer one that there is. */
static struct br_point point_of(const struct br_orders *o, size_t quantity,
                                const struct br_orders_line *line, size_t i)
{
    const struct br_numbers *numbers = o->numbers;
    const struct br_numbers_row *row = &numbers->row[line->row[i]];
    struct br_point p = {.z = row->z[line->axis],
                         .error = row->number[quantity],
                         .deviation = deviation_of(row, quantity)};
    const char *failure = failure_of(row, p.error);
    size_t named = line->row[i];
    if (numbers->quantity[quantity].is_value) {
        const struct br_numbers_row *finer;
        const char *of_finer;
        size_t next = i;
        do {
            finer = &numbers->row[line->row[++next]];
            of_finer = failure_of(finer, finer->number[quantity]);
        } while (*of_finer && next < line->observed.points);
        named = !*failure && *of_finer ? line->row[next] : named;
        failure = *failure ? failure : of_finer;
        p.z_against = finer->z[line->axis];
        p.error = fabs(finer->number[quantity] - p.error);
        p.deviation = hypot(p.deviation, deviation_of(finer, quantity));
    }
    name_size(numbers, named, line->axis, p.label);
    snprintf(p.failure, sizeof p.failure, "%.255s", failure);
    p.deviation = p.deviation > 0 ? p.deviation : 0; /* NaN: it is no mean */
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
        .may_miss = true,
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
    double *given = line->finest_of = br_allocate(rows, sizeof *given);
    size_t count = 0;
    line->limit.value = (struct br_estimate){NAN, NAN, NAN};
    line->triple = br_allocate(rows, sizeof *line->triple);
    if (!h || !given || !line->triple) {
        free(h);
        return br_no_memory(err, "the limits");
    }
    for (size_t i = 0; i < rows; i++) {
        const struct br_numbers_row *row = &o->numbers->row[line->row[i]];
        if (isnan(row->number[quantity]) || row->failure)
            continue;
        h[count] = row->z[line->axis];
        given[count >= 2 ? count - 2 : 0] = row->given[line->axis];
        value[count++] = row->number[quantity];
    }
    enum br_status status = BR_OK;
    if (count >= LEAST_POINTS)
        status = br_limit_of_values(h, value, count, o->formal, &line->limit, err);
    if (count >= LEAST_POINTS && !status && o->assumed_formal)
        status = br_limit_of_values(h, value, count, 1, &line->first_order, err);
    for (size_t i = 0; i + 2 < count && !status; i++) {
        status = br_gci(h + i, value + i, 3, &line->triple[i], err);
        line->gci = line->triple[i];
        line->triples = i + 1;
    }
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

static bool is_level(enum br_flag flag)
{
    return flag == BR_FLAG_STALLED || flag == BR_FLAG_ROUND_OFF;
}

/* Where neighbours on a grid show a smaller order the error stays. */
static const double hardly_falls = 0.25;

/* Errors below this many times a floor are changed by it. */
static const double floor_margin = 2;

/* Whether the error is at a level of its line, or hardly another one than that of the next coarser
 * size (that of the coarsest size: than that of the next finer one). */
static bool stays(const struct br_row_point *at)
{
    const struct br_point *p = at->line->observed.point;
    const size_t fine = at->index > 0 ? at->index : 1;
    return is_level(p[at->index].flag) || fabs(rate(&p[fine - 1], &p[fine])) < hardly_falls;
}

/* The level of a floor, along both axes and below all other errors; 0: there is none. */
static double floor_of(const struct br_orders *o, const struct br_quantity_orders *of)
{
    double lowest = INFINITY, level = 0;
    for (int turn = 0; turn < 2; turn++)
        for (size_t i = 0; i < o->numbers->rows; i++) {
            const struct br_point *a = point_on(of, BR_AXIS_SPACE, i);
            if (!a || !point_on(of, BR_AXIS_TIME, i) || !(a->error > 0))
                continue;
            if (turn == 0)
                lowest = fmin(lowest, a->error);
            else if (a->error < floor_margin * lowest && stays(&of->point[BR_AXIS_SPACE][i]) &&
                     stays(&of->point[BR_AXIS_TIME][i]))
                level = fmax(level, a->error);
        }
    return level;
}

/* An error that stays along one axis but falls along the other belongs to the other: no flag. One
 * that stays along both is at a floor, also where a line takes that for its order, zero. */
static void flag_corners(const struct br_orders *o, struct br_quantity_orders *of)
{
    const double level = floor_of(o, of);
    for (size_t i = 0; i < o->numbers->rows; i++) {
        struct br_point *a = point_on(of, BR_AXIS_SPACE, i), *b = point_on(of, BR_AXIS_TIME, i);
        if (!a || !b || a->flag == BR_FLAG_FAILED || !(a->error > 0))
            continue;
        if (a->error < floor_margin * level)
            a->flag = b->flag = is_level(a->flag)   ? a->flag
                                : is_level(b->flag) ? b->flag
                                                    : BR_FLAG_STALLED;
        else if (is_level(a->flag) != is_level(b->flag) || a->flag == BR_FLAG_NONE ||
                 b->flag == BR_FLAG_NONE)
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
        same ? BR_OK
             : br_joint_fit_solve(observation, count, true, numbers->observer, &of->joint, err);
    free(observation);
    return status;
}

/* ---- all ---- */

static bool is_grid(const struct br_orders *o)
{
    return o->numbers->column[BR_AXIS_SPACE] && o->numbers->column[BR_AXIS_TIME] && !o->tied;
}

/* Finds the orders of all lines, which leaves out the errors that do not show them. On a grid,
 * errors may stay along one axis since the error of the other axis is larger; where the joint fit
 * describes all errors, none is left out. */
static enum br_status observe_lines(const struct br_orders *o, struct br_quantity_orders *of,
                                    bool leave_out, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t l = 0; l < of->lines && !status; l++) {
        struct br_case *c = &of->line[l].observed;
        status = stopped(o->numbers, err) ? err->status : br_case_observe(c, LEAST_POINTS, err);
        if (!status && !leave_out)
            br_case_take_order(c, c->order, c->constant);
    }
    return status;
}

static enum br_status observe_all(const struct br_orders *o, struct br_quantity_orders *of,
                                  struct br_error *err)
{
    const bool joint = is_grid(o) && !o->numbers->quantity[of->quantity].is_value;
    enum br_status status = joint ? fit_both(o, of, err) : BR_OK;
    const bool described = joint && br_joint_describes(&of->joint);
    if (!status)
        status = observe_lines(o, of, !described, err);
    if (status || !joint || described)
        return status;
    flag_corners(o, of);
    return fit_both(o, of, err);
}

static bool holds(const struct br_estimate *interval, const struct br_estimate *order)
{
    return interval->low <= order->value && order->value <= interval->high;
}

/* The answer of a grid of errors without a joint fit: the order of a line only if the line at the
 * next size shows the same one, else the error of the other axis bends it. */
static struct br_orders_answer answer_of_lines(const struct br_quantity_orders *of,
                                               const struct br_orders_line *finest)
{
    static const char *const bent[BR_AXES] = {
        "the order in h is not the same at the two finest k, and no joint fit describes the "
        "errors: a finer k, or more sizes of both, would show it",
        "the order in k is not the same at the two finest h, and no joint fit describes the "
        "errors: a finer h, or more sizes of both, would show it"};
    const struct br_orders_line *next = finest > of->line ? finest - 1 : NULL;
    const struct br_estimate *a = &finest->observed.order;
    if (next && next->axis == finest->axis && holds(a, &next->observed.order) &&
        holds(&next->observed.order, a))
        return (struct br_orders_answer){*a, NULL};
    return (struct br_orders_answer){{NAN, NAN, NAN}, bent[finest->axis]};
}

static struct br_orders_answer find_answer(const struct br_orders *o,
                                           const struct br_quantity_orders *of, enum br_axis axis)
{
    static const char *const hidden[BR_AXES] = {
        "the order in h is hidden, since the error in k is larger everywhere: a finer k, or a "
        "coarser h, would show it",
        "the order in k is hidden, since the error in h is larger everywhere: a finer h, or a "
        "coarser k, would show it"};
    static const char *const open[BR_AXES] = {
        "the joint fit does not determine the order in h: more sizes of both would",
        "the joint fit does not determine the order in k: more sizes of both would"};
    const struct br_orders_line *finest = br_orders_finest(of, axis);
    const struct br_estimate *joint = &of->joint.order[axis];
    if (br_joint_describes(&of->joint))
        return (struct br_orders_answer){*joint, !br_joint_has(of->joint.kind, (int)axis)
                                                     ? hidden[axis]
                                                 : br_order_determined(joint) ? NULL
                                                                              : open[axis]};
    if (!finest)
        return (struct br_orders_answer){{NAN, NAN, NAN}, NULL};
    return is_grid(o) && !o->numbers->quantity[of->quantity].is_value
               ? answer_of_lines(of, finest)
               : (struct br_orders_answer){finest->observed.order, NULL};
}

/* A value of a grid is L + f(h) + g(k), and small products of both: what is left over h at the
 * finest k and over k at the finest h adds up, each with its interval. By as much as one of the two
 * changes to the next size of the other axis, the products may change it again. */
static void find_limit_of_grid(const struct br_orders *o, struct br_quantity_orders *of)
{
    const struct br_grid_limit none = {.value = {NAN, NAN, NAN}, .order = NAN};
    double finest = NAN, left = 0, half = 0, products = 0;
    size_t row[BR_AXES] = {0};
    of->limit = none;
    for (int axis = 0; axis < BR_AXES; axis++) {
        const struct br_orders_line *line = br_orders_finest(of, (enum br_axis)axis);
        const struct br_orders_line *next = line > of->line ? line - 1 : NULL;
        if (!next || next->axis != line->axis)
            return;
        row[axis] = line->row[line->observed.points];
        const struct br_numbers_row *fine = &o->numbers->row[row[axis]],
                                    *before = &o->numbers->row[next->row[next->observed.points]];
        const struct br_estimate *e = &line->limit.value;
        const bool constant = line->limit.sequence == BR_SEQUENCE_CONSTANT;
        finest = fine->number[of->quantity];
        const double rest = e->value - finest;
        left += rest;
        half += constant ? 0 : fmax(e->high - finest, finest - e->low);
        products =
            fmax(products, fabs(next->limit.value.value - before->number[of->quantity] - rest));
        if (axis == 0 || line->limit.sequence == of->limit.sequence || constant)
            of->limit.sequence = axis == 0 ? line->limit.sequence : of->limit.sequence;
        else
            of->limit.sequence = of->limit.sequence == BR_SEQUENCE_CONSTANT ? line->limit.sequence
                                                                            : BR_SEQUENCE_UNKNOWN;
        of->limit.method = line->limit.method;
    }
    half += products;
    if (row[0] == row[1] && isfinite(left) && half > 0 && isfinite(half))
        of->limit.value = (struct br_estimate){finest + left, finest - half, finest + half};
}

static void take_limit(const struct br_orders *o, struct br_quantity_orders *of)
{
    if (is_grid(o))
        find_limit_of_grid(o, of);
    else if (of->lines)
        of->limit = of->line[of->lines - 1].limit;
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
        status = observe_all(o, of, err);
    for (int axis = 0; axis < BR_AXES; axis++)
        of->answer[axis] = find_answer(o, of, (enum br_axis)axis);
    if (!status && numbers->quantity[of->quantity].is_value)
        take_limit(o, of);
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
    *o = (struct br_orders){
        .numbers = numbers, .formal = formal > 0 ? formal : 2, .assumed_formal = formal == 0};
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
            free(o->of[i].line[l].triple);
            free(o->of[i].line[l].finest_of);
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
    return i ? rate(&p[i - 1], &p[i]) : NAN;
}

/* ---- finer meshes ---- */

static bool has_floor(const struct br_case *c)
{
    return c->law == br_law_text(BR_LAW_FLOOR) || c->law == br_law_text(BR_LAW_FLOOR_SQUARES) ||
           c->law == br_law_text(BR_LAW_OFFSET);
}

struct br_orders_forecast br_orders_foresee(const struct br_orders *o,
                                            const struct br_quantity_orders *of)
{
    const struct br_orders_line *line = is_grid(o) || !of->lines ? NULL : &of->line[0];
    struct br_orders_forecast f = {.line = NULL};
    if (!line)
        return f;
    const struct br_case *c = &line->observed;
    const bool is_value = o->numbers->quantity[of->quantity].is_value;
    const size_t last = c->points - 1 + is_value;
    f = (struct br_orders_forecast){line, line->gci.fine.index, line->gci.order,
                                    z_of(o->numbers, line->row[last], line->axis), NAN};
    if (!is_value) {
        f.number = c->point[last].flag || has_floor(c) ? (double)NAN : c->point[last].error;
        f.order = br_order_determined(&c->order) ? c->order.value : (double)NAN;
    }
    if (isnan(o->numbers->row[line->row[last]].number[of->quantity]))
        f.number = NAN; /* the index is that of a coarser row */
    f.ratio = f.z / z_of(o->numbers, line->row[last - 1], line->axis);
    if (!(f.number > 0 && f.order > 0))
        f.line = NULL;
    return f;
}

double br_orders_next(const struct br_orders *o, const struct br_orders_forecast *f, double *given)
{
    *given =
        br_numbers_given(o->numbers->column[f->line->axis], f->z * f->ratio, o->numbers->dimension);
    return f->number * pow(f->ratio, f->order);
}

double br_orders_needed(const struct br_orders *o, const struct br_orders_forecast *f,
                        double wanted)
{
    return br_numbers_given(o->numbers->column[f->line->axis],
                            f->z * pow(wanted / f->number, 1 / f->order), o->numbers->dimension);
}

double br_orders_in_dimension(const struct br_orders *o, double order, double dimension)
{
    return order * dimension / o->numbers->dimension;
}

bool br_orders_stays(const struct br_orders_line *line)
{
    double least = INFINITY, most = 0;
    for (size_t i = 0; i < line->observed.points; i++) {
        least = fmin(least, line->observed.point[i].error);
        most = fmax(most, line->observed.point[i].error);
    }
    return most > 0 && most < 2 * least; /* 0: no row has a number */
}

/* ---- costs ---- */

/* A shorter run is mostly its start, s. */
static const double least_seconds = 0.02;

bool br_orders_costs_differ(const struct br_orders *o)
{
    double least = INFINITY, most = 0;
    for (size_t i = 0; i < o->numbers->rows; i++) {
        least = fmin(least, o->numbers->row[i].seconds);
        most = fmax(most, o->numbers->row[i].seconds);
    }
    return most >= least_seconds && most > 2 * least;
}

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
    struct br_line_order found;
    const enum br_status status = br_line_order_find(point, count, &found, err);
    *growth = (struct br_estimate){-found.order.value, -found.order.high, -found.order.low};
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
