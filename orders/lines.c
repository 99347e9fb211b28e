/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The lines of numbers along which one size alone changes. */
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <string.h>

#include "orders/orders.h"

double br_orders_rate(const struct br_orders_line *line, size_t i)
{
    const struct br_point *p = line->observed.point;
    return i ? br_point_rate(&p[i - 1], &p[i]) : NAN;
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

/* Half a unit of the last digit of a number; 0 where it was not printed. */
static double rounding_of(const struct br_quantity *q, const struct br_numbers_row *row,
                          double number)
{
    enum { ALL = 12 }; /* so many digits are as good as all */
    if (row->repeat > 1 || isnan(number) || q->digits > ALL || number == 0)
        return 0;
    return 0.5 * pow(10, q->fixed ? -q->decimals : floor(log10(fabs(number))) + 1 - q->digits);
}

static enum br_flag flag_of(const struct br_point *p, enum br_flag out)
{
    return out             ? out
           : *p->failure   ? BR_FLAG_FAILED
           : p->error > 0  ? BR_FLAG_NONE
           : p->error == 0 ? BR_FLAG_ROUND_OFF
                           : BR_FLAG_FAILED;
}

struct br_point br_orders_point(const struct br_orders *o, size_t quantity, size_t row)
{
    const struct br_quantity *q = &o->numbers->quantity[quantity];
    const struct br_numbers_row *r = &o->numbers->row[row];
    const double number = r->number[quantity], deviation = r->deviation[quantity];
    struct br_point p = {.row = row,
                         .x = {r->z[BR_AXIS_SPACE], r->z[BR_AXIS_TIME]},
                         .ref = {r->against[BR_AXIS_SPACE], r->against[BR_AXIS_TIME]},
                         .error = number,
                         .value = r->failure ? (double)NAN : number,
                         .deviation = deviation,
                         .rounding = rounding_of(q, r, number),
                         .constant = NAN};
    if (q->is_value && r->repeat > 1)
        p.half = gsl_cdf_tdist_Pinv(0.975, (double)r->repeat - 1) * deviation;
    snprintf(p.failure, sizeof p.failure, "%.255s",
             r->failure      ? r->failure
             : isnan(number) ? "has no number"
                             : "");
    p.flag = flag_of(&p, r->out[quantity]);
    return p;
}

/* Makes the error of a value its difference from the next finer one that there is, at point[i] of
 * a line; the finest has none. */
static void take_difference(struct br_point *point, size_t points, size_t i, enum br_flag out)
{
    struct br_point *p = &point[i], *finer = p;
    while (finer < point + points && (finer == p || *finer->failure))
        finer++;
    if (!*p->failure && *finer->failure) {
        strcpy(p->label, finer->label);
        strcpy(p->failure, finer->failure);
    }
    p->z_against = finer->z;
    p->error = i < points ? fabs(finer->value - p->value) : (double)NAN;
    p->deviation = hypot(p->deviation, finer->deviation);
    p->rounding = hypot(p->rounding, finer->rounding);
    p->flag = flag_of(p, out);
}

enum br_status br_orders_begin_case(const struct br_orders *o, size_t quantity, enum br_axis axis,
                                    size_t points, struct br_case *c, struct br_error *err)
{
    const struct br_quantity *q = &o->numbers->quantity[quantity];
    *c = (struct br_case){
        .kind = axis == BR_AXIS_SPACE ? BR_VERIFY_SPACE : BR_VERIFY_TIME,
        .expected = {.order = NAN, .tolerance = NAN, .floor = NAN, .ceiling = NAN},
        .measure = q->name,
        .part = "",
        .unit = q->unit ? q->unit : "",
        .points = points,
        .order = {NAN, NAN, NAN},
        .may_miss = !o->numbers->all_needed,
        .window = q->window,
        .of_degree = o->numbers->column[axis]->is_degree,
    };
    c->point = br_allocate(points + 1, sizeof *c->point);
    return c->point ? BR_OK : br_no_memory(err, "the orders");
}

/* The limits of the values of a line. */
static enum br_status find_limits(const struct br_orders *o, struct br_orders_line *line,
                                  struct br_error *err)
{
    const size_t rows = line->observed.points + 1;
    struct br_point *value = br_allocate(rows, sizeof *value);
    size_t count = 0;
    if (!value)
        return br_no_memory(err, "the limits");
    for (size_t i = 0; i < rows; i++)
        if (!isnan(line->observed.point[i].value))
            value[count++] = line->observed.point[i];
    /* Values over a degree have a limit, but no order: of two there is no grid convergence index.
     */
    const size_t most = o->numbers->column[line->axis]->is_degree ? 2 : count;
    enum br_status status = br_limits_find(value, most < count ? most : count, &line->limits, err);
    if (!status && most < count)
        status = br_limit_of_values(value, count, &line->limits.limit, err);
    free(value);
    return status;
}

/* Of a value, point[points] is the finest, which has no difference. */
static enum br_status make_points(const struct br_orders *o, size_t quantity,
                                  const struct line_row *sorted, size_t rows,
                                  struct br_orders_line *line, struct br_error *err)
{
    struct br_case *c = &line->observed;
    const bool is_value = o->numbers->quantity[quantity].is_value;
    if (br_orders_begin_case(o, quantity, line->axis, rows - is_value, c, err))
        return err->status;
    for (size_t i = 0; i < rows; i++) {
        c->point[i] = br_orders_point(o, quantity, sorted[i].row);
        c->point[i].z = c->point[i].x[line->axis];
        c->point[i].z_against = c->point[i].ref[line->axis];
        br_numbers_name(o->numbers, &o->numbers->row[sorted[i].row], line->axis, c->point[i].label);
    }
    const enum br_status status = is_value ? find_limits(o, line, err) : BR_OK;
    for (size_t i = 0; i < rows && !status; i++) {
        struct br_point *p = &c->point[i];
        if (is_value)
            take_difference(c->point, c->points, i, o->numbers->row[p->row].out[quantity]);
        p->deviation = p->deviation > 0 ? p->deviation : 0; /* NaN: it is no mean */
    }
    return status;
}

enum br_status br_orders_joint_case(const struct br_orders *o, const struct br_quantity_orders *of,
                                    enum br_axis axis, struct br_case *c, struct br_error *err)
{
    const struct br_numbers *n = o->numbers;
    if (br_orders_begin_case(o, of->quantity, axis, n->rows, c, err))
        return err->status;
    c->points = 0;
    for (size_t i = 0; i < n->rows; i++) {
        struct br_point p = br_orders_point(o, of->quantity, i);
        size_t at = 0;
        p.z = p.x[axis];
        while (at < c->points && c->point[at].z != p.z)
            at++;
        if (of->flag[i] || (at < c->points && p.x[!axis] > c->point[at].x[!axis]))
            continue;
        p.z_against = p.deviation = 0;
        br_numbers_name(n, &n->row[i], axis, p.label);
        c->points += at == c->points;
        c->point[at] = p;
    }
    qsort(c->point, c->points, sizeof *c->point, br_by_size);
    br_case_take_order(c, of->answer[axis].order, fabs(of->joint.c[axis].value));
    c->of_grid = true;
    c->low99 = of->joint.low99[axis];
    c->high99 = of->joint.high99[axis];
    return BR_OK;
}

/* Adds the line of these rows, which are sorted from coarse to fine. */
static enum br_status add_line(const struct br_orders *o, struct br_quantity_orders *of,
                               enum br_axis axis, const struct line_row *sorted, size_t rows,
                               struct br_error *err)
{
    const struct br_numbers *numbers = o->numbers;
    struct br_orders_line *line = &of->line[of->lines];
    of->lines++;
    line->axis = axis;
    if (numbers->column[!axis] && !o->tied)
        br_numbers_name(numbers, &numbers->row[sorted->row], (enum br_axis) !axis, line->at);
    const enum br_status status = make_points(o, of->quantity, sorted, rows, line, err);
    for (size_t i = 0; i < line->observed.points && !status; i++)
        of->point[axis][sorted[i].row] = (struct br_row_point){line, i};
    return status;
}

enum br_status br_orders_add_lines(const struct br_orders *o, struct br_quantity_orders *of,
                                   enum br_axis axis, struct br_error *err)
{
    const struct br_numbers *numbers = o->numbers;
    const bool alone = o->tied || !numbers->column[!axis];
    struct line_row *sorted = br_allocate(numbers->rows, sizeof *sorted);
    of->point[axis] = br_allocate(numbers->rows, sizeof *of->point[axis]);
    enum br_status status = BR_OK;
    if (!sorted || !of->point[axis])
        status = br_no_memory(err, "the orders");
    size_t rows = 0;
    for (size_t i = 0; i < numbers->rows && !status; i++)
        if (br_has_part(numbers->row[i].out[of->quantity]))
            sorted[rows++] =
                (struct line_row){alone ? 0 : numbers->row[i].z[!axis], numbers->row[i].z[axis], i};
    if (!status)
        qsort(sorted, rows, sizeof *sorted, by_line);
    for (size_t first = 0, end; first < rows && !status; first = end) {
        status = br_observer_check(numbers->observer, err);
        for (end = first + 1; end < rows && sorted[end].other == sorted[first].other;)
            end++;
        if (!status && end - first >= BR_ORDERS_LEAST)
            status = add_line(o, of, axis, &sorted[first], end - first, err);
    }
    free(sorted);
    return status;
}
