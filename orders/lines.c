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

double br_orders_rounding(const struct br_orders *o, size_t quantity,
                          const struct br_numbers_row *row)
{
    enum { ALL = 12 }; /* so many digits are as good as all */
    const struct br_quantity *q = &o->numbers->quantity[quantity];
    const double number = row->number[quantity];
    if (row->repeat > 1 || isnan(number) || q->digits > ALL || number == 0)
        return 0;
    return 0.5 * pow(10, q->fixed ? -q->decimals : floor(log10(fabs(number))) + 1 - q->digits);
}

bool br_orders_counts(const struct br_quantity_orders *of, const struct br_numbers_row *row)
{
    const double number = row->number[of->quantity];
    return !row->failure && !row->out[of->quantity] && number > 0 && isfinite(number);
}

/* An error, or the difference of a value from the next finer one that there is. */
static struct br_point point_of(const struct br_orders *o, size_t quantity,
                                const struct br_orders_line *line, size_t i)
{
    const struct br_numbers *numbers = o->numbers;
    const struct br_numbers_row *row = &numbers->row[line->row[i]];
    struct br_point p = {.z = row->z[line->axis],
                         .z_against = row->against[line->axis],
                         .error = row->number[quantity],
                         .deviation = deviation_of(row, quantity),
                         .rounding = br_orders_rounding(o, quantity, row)};
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
        p.rounding = hypot(p.rounding, br_orders_rounding(o, quantity, finer));
    }
    br_numbers_name(numbers, &numbers->row[named], line->axis, p.label);
    snprintf(p.failure, sizeof p.failure, "%.255s", failure);
    p.deviation = p.deviation > 0 ? p.deviation : 0; /* NaN: it is no mean */
    p.flag = *failure             ? BR_FLAG_FAILED
             : row->out[quantity] ? row->out[quantity]
             : p.error > 0        ? BR_FLAG_NONE
             : p.error == 0       ? BR_FLAG_ROUND_OFF
                                  : BR_FLAG_FAILED;
    return p;
}

static enum br_status begin_case(const struct br_orders *o, size_t quantity, enum br_axis axis,
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

static enum br_status make_points(const struct br_orders *o, size_t quantity,
                                  struct br_orders_line *line, size_t rows, struct br_error *err)
{
    struct br_case *c = &line->observed;
    const size_t points = rows - o->numbers->quantity[quantity].is_value;
    const enum br_status status = begin_case(o, quantity, line->axis, points, c, err);
    for (size_t i = 0; i < points && !status; i++)
        c->point[i] = point_of(o, quantity, line, i);
    return status;
}

enum br_status br_orders_add_differences(const struct br_orders *o, struct br_quantity_orders *of,
                                         enum br_axis axis, struct br_error *err)
{
    const struct br_differences *d = &br_quantity_of(o, of)->differences[axis];
    struct br_orders_line *line = &of->differences[axis];
    line->axis = axis;
    if (!d->point)
        return BR_OK;
    if (begin_case(o, of->quantity, axis, d->points, &line->observed, err))
        return err->status;
    memcpy(line->observed.point, d->point, d->points * sizeof *d->point);
    return br_case_observe(&line->observed, BR_ORDERS_LEAST, err);
}

static int by_size(const void *a, const void *b)
{
    const struct br_point *x = a, *y = b;
    return (x->z < y->z) - (x->z > y->z);
}

enum br_status br_orders_joint_case(const struct br_orders *o, const struct br_quantity_orders *of,
                                    enum br_axis axis, struct br_case *c, struct br_error *err)
{
    const struct br_numbers *n = o->numbers;
    const struct br_orders_answer *answer = &of->answer[axis];
    if (begin_case(o, of->quantity, axis, n->rows, c, err))
        return err->status;
    c->points = 0;
    for (size_t i = 0; i < n->rows; i++) {
        size_t at = 0;
        double finest = INFINITY; /* other size of the point at this size */
        if (!br_orders_counts(of, &n->row[i]) || of->flag[i] != BR_FLAG_NONE)
            continue;
        for (size_t j = 0; j < i; j++) /* that of a row before it, if there is one */
            if (br_orders_counts(of, &n->row[j]) && of->flag[j] == BR_FLAG_NONE &&
                n->row[j].z[axis] == n->row[i].z[axis])
                finest = fmin(finest, n->row[j].z[!axis]);
        while (at < c->points && c->point[at].z != n->row[i].z[axis])
            at++;
        if (n->row[i].z[!axis] > finest)
            continue;
        struct br_point *p = &c->point[at];
        c->points += at == c->points;
        *p = (struct br_point){.z = n->row[i].z[axis],
                               .error = n->row[i].number[of->quantity],
                               .constant = NAN, /* the error has a part of the other axis */
                               .rounding = br_orders_rounding(o, of->quantity, &n->row[i])};
        br_numbers_name(n, &n->row[i], axis, p->label);
    }
    qsort(c->point, c->points, sizeof *c->point, by_size);
    br_case_take_order(c, answer->order, fabs(of->joint.c[axis].value));
    c->of_grid = true;
    c->low99 = of->joint.low99[axis];
    c->high99 = of->joint.high99[axis];
    return BR_OK;
}

/* The half width of the 95 % interval of a mean; 0: it is none. */
static double half_width(const struct br_numbers_row *row, size_t quantity)
{
    return row->repeat > 1
               ? gsl_cdf_tdist_Pinv(0.975, (double)row->repeat - 1) * deviation_of(row, quantity)
               : 0;
}

/* The limits of the values of a line. */
static enum br_status find_limits(const struct br_orders *o, size_t quantity, size_t rows,
                                  struct br_orders_line *line, struct br_error *err)
{
    struct br_line_value *value = br_allocate(rows, sizeof *value);
    double *given = line->finest_of = br_allocate(rows, sizeof *given);
    size_t count = 0;
    for (size_t i = 0; i < rows && value && given; i++) {
        const struct br_numbers_row *row = &o->numbers->row[line->row[i]];
        if (isnan(row->number[quantity]) || row->failure)
            continue;
        given[count >= 2 ? count - 2 : 0] = row->given[line->axis];
        value[count++] = (struct br_line_value){.h = row->z[line->axis],
                                                .value = row->number[quantity],
                                                .half = half_width(row, quantity),
                                                .rounding = br_orders_rounding(o, quantity, row)};
    }
    /* Values over a degree have a limit, but no order: of two there is no grid convergence index.
     */
    const size_t most = o->numbers->column[line->axis]->is_degree ? 2 : count;
    enum br_status status =
        value && given ? br_limits_find(value, most < count ? most : count, &line->limits, err)
                       : br_no_memory(err, "the limits");
    if (!status && most < count)
        status = br_limit_of_values(value, count, &line->limits.limit, err);
    free(value);
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
    if (numbers->column[!axis] && !o->tied)
        br_numbers_name(numbers, &numbers->row[line->row[0]], (enum br_axis) !axis, line->at);
    const enum br_status status = make_points(o, of->quantity, line, rows, err);
    if (status)
        return status;
    for (size_t i = 0; i < line->observed.points; i++)
        of->point[axis][line->row[i]] = (struct br_row_point){line, i};
    return numbers->quantity[of->quantity].is_value ? find_limits(o, of->quantity, rows, line, err)
                                                    : BR_OK;
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
        if (!(numbers->row[i].absent && numbers->row[i].absent[of->quantity]) &&
            numbers->row[i].out[of->quantity] != BR_FLAG_BY_HAND)
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
