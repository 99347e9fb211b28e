/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The library's functions: orders of numbers, and verdicts on them. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "orders/library/library.h"

static_assert((int)BEAMRATE_SPACE == BR_AXIS_SPACE && (int)BEAMRATE_TIME == BR_AXIS_TIME, "");
static_assert((int)BEAMRATE_PASS == BR_PASS && (int)BEAMRATE_FAIL == BR_FAIL &&
                  (int)BEAMRATE_INCONCLUSIVE == BR_INCONCLUSIVE,
              "");

static bool is_axis(enum beamrate_axis axis)
{
    return axis == BEAMRATE_SPACE || axis == BEAMRATE_TIME;
}

static const struct beamrate_estimate nothing = {NAN, NAN, NAN};

static struct beamrate_estimate estimate_of(struct br_estimate e)
{
    return (struct beamrate_estimate){e.value, e.low, e.high};
}

static struct beamrate_fit fit_of(const struct br_joint_fit *fit)
{
    if (!fit->converged)
        return (struct beamrate_fit){0,       nothing, nothing, nothing,
                                     nothing, nothing, NAN,     fit->points};
    return (struct beamrate_fit){
        .describes = br_joint_describes(fit),
        .p = estimate_of(fit->order[BR_AXIS_SPACE]),
        .c_h = estimate_of(fit->c[BR_AXIS_SPACE]),
        .q = estimate_of(fit->order[BR_AXIS_TIME]),
        .c_k = estimate_of(fit->c[BR_AXIS_TIME]),
        .r = estimate_of(fit->r),
        .misfit = fit->misfit,
        .points = fit->points,
    };
}

/* ---- orders ---- */

static const char name_of_numbers[] = "numbers"; /* in messages, instead of a file's path */

static enum br_status copy_numbers(const struct beamrate_numbers *from, struct br_numbers *to,
                                   struct br_error *err)
{
    if (!from || !from->number)
        return br_fail(err, BR_BAD_INPUT, "%s: found NULL, expected numbers", name_of_numbers);
    if (!(from->formal >= 0 && isfinite(from->formal)))
        return br_fail(err, BR_BAD_INPUT, "formal: found %g, expected an order above 0, or 0: 2",
                       from->formal);
    if (!from->h && !from->k)
        return br_fail(err, BR_BAD_INPUT, "%s: found neither h nor k, expected at least one",
                       name_of_numbers);
    to->column[BR_AXIS_SPACE] = from->h ? br_resolution_column_find("h") : NULL;
    to->column[BR_AXIS_TIME] = from->k ? br_resolution_column_find("k") : NULL;
    enum br_status status = br_numbers_make_room(to, from->count, 1, err);
    if (!status)
        status =
            br_numbers_add_quantity(to, from->values ? "value" : "error", NULL, from->values, err);
    for (size_t i = 0; i < from->count && !status; i++) {
        struct br_numbers_row *row = &to->row[i];
        row->given[BR_AXIS_SPACE] = row->z[BR_AXIS_SPACE] = from->h ? from->h[i] : NAN;
        row->given[BR_AXIS_TIME] = row->z[BR_AXIS_TIME] = from->k ? from->k[i] : NAN;
        row->line = i + 1;
        *row->number = from->number[i];
    }
    return status ? status : br_numbers_check(to, name_of_numbers, err);
}

static enum br_status find_orders(struct beamrate_orders *o, const struct beamrate_numbers *from,
                                  struct br_error *err)
{
    const enum br_status status = copy_numbers(from, &o->numbers, err);
    return status ? status : br_orders_find(&o->numbers, from->formal, &o->orders, err);
}

enum beamrate_status beamrate_orders_find(struct beamrate_orders **orders,
                                          const struct beamrate_numbers *numbers,
                                          struct beamrate_error *err)
{
    MAKE_HANDLE(orders, BR_HANDLE_ORDERS, beamrate_orders_free,
                find_orders(*orders, numbers, &call.err));
}

enum br_status br_request_of(const struct beamrate_table *table, struct br_orders_request *q,
                             struct br_error *err)
{
    *q = br_orders_request_default();
    if (!table || !table->text)
        return br_fail(err, BR_BAD_INPUT, "table: found NULL, expected a table");
    if (!(table->dimension >= 0 && table->dimension <= BR_MOST_DIMENSIONS &&
          table->dimension == floor(table->dimension) && table->formal >= 0 &&
          isfinite(table->formal)))
        return br_fail(err, BR_BAD_INPUT,
                       "table: found dimension %g and formal order %g, expected a whole number "
                       "up to %d and a number above 0, or 0: not stated",
                       table->dimension, table->formal, BR_MOST_DIMENSIONS);
    q->path = (char *)(table->name ? table->name : "table");
    q->table = (char *)table->text;
    q->errors = (char *)table->errors;
    q->values = (char *)table->values;
    q->columns = (char *)table->columns;
    q->where = (char *)table->where;
    q->finest = (double)table->finest;
    q->without = (char *)table->without;
    if (table->finest > 0 && table->finest < BR_ORDERS_LEAST)
        return br_fail(err, BR_BAD_INPUT, "table: finest: found %zu, expected at least %d, or 0",
                       table->finest, BR_ORDERS_LEAST);
    q->dimension = table->dimension > 0 ? table->dimension : q->dimension;
    q->assumed_dimension = !(table->dimension > 0);
    q->formal = table->formal > 0 ? table->formal : q->formal;
    return BR_OK;
}

static enum br_status read_orders(struct beamrate_orders *o, const struct beamrate_table *table,
                                  struct br_error *err)
{
    struct br_orders_request q;
    if (br_request_of(table, &q, err))
        return err->status;
    return br_orders_read(&q, &o->numbers, err)
               ? err->status
               : br_orders_find(&o->numbers, q.formal, &o->orders, err);
}

enum beamrate_status beamrate_orders_read(struct beamrate_orders **orders,
                                          const struct beamrate_table *table,
                                          struct beamrate_error *err)
{
    MAKE_HANDLE(orders, BR_HANDLE_ORDERS, beamrate_orders_free,
                read_orders(*orders, table, &call.err));
}

void beamrate_orders_free(struct beamrate_orders *orders)
{
    if (!br_handle_is(orders, BR_HANDLE_ORDERS))
        return;
    free(orders->report);
    br_orders_clear(&orders->orders);
    br_numbers_clear(&orders->numbers);
    free(orders);
}

/* The orders of a column, and its finest line along an axis (out); NULL: there are none. */
static const struct br_quantity_orders *find_column(const struct beamrate_orders *orders,
                                                    size_t quantity, enum beamrate_axis axis,
                                                    const struct br_orders_line **line)
{
    const bool good =
        br_handle_is(orders, BR_HANDLE_ORDERS) && is_axis(axis) && quantity < orders->orders.count;
    const struct br_quantity_orders *of = good ? &orders->orders.of[quantity] : NULL;
    *line = of ? br_orders_finest(of, (enum br_axis)axis) : NULL;
    return of;
}

int beamrate_orders_answer(const struct beamrate_orders *orders, size_t quantity,
                           enum beamrate_axis axis, struct beamrate_answer *answer)
{
    const struct br_orders_line *line;
    const struct br_quantity_orders *of = find_column(orders, quantity, axis, &line);
    if (!answer)
        return 0;
    *answer = (struct beamrate_answer){.quantity = "", .order = nothing, .open = ""};
    if (!of)
        return 0;
    const struct br_quantity *q = &orders->numbers.quantity[quantity];
    const struct br_orders_answer *found = &of->answer[axis];
    answer->quantity = q->name;
    answer->values = q->is_value;
    answer->refined = line || of->flag;
    answer->order = estimate_of(found->order);
    const char *unsettled = answer->refined ? orders->numbers.unsettled : NULL;
    answer->open = found->open ? found->open : unsettled ? unsettled : "";
    return 1;
}

int beamrate_orders_point(const struct beamrate_orders *orders, size_t quantity,
                          enum beamrate_axis axis, size_t i, struct beamrate_order_point *point)
{
    const struct br_orders_line *line;
    find_column(orders, quantity, axis, &line);
    if (!point)
        return 0;
    *point = (struct beamrate_order_point){NAN, NAN, NAN, nothing, ""};
    if (!line || i >= line->observed.points)
        return 0;
    const struct br_point *p = &line->observed.point[i];
    *point = (struct beamrate_order_point){.size = p->z,
                                           .error = p->error,
                                           .rate = br_orders_rate(line, i),
                                           .fit = estimate_of(p->fit),
                                           .left_out = br_flag_name(p->flag)};
    return 1;
}

int beamrate_orders_line(const struct beamrate_orders *orders, enum beamrate_axis axis,
                         struct beamrate_order *order)
{
    const struct br_orders_line *line;
    find_column(orders, 0, axis, &line);
    if (!order)
        return 0;
    *order = (struct beamrate_order){.order = nothing, .constant = NAN, .limit = nothing};
    if (!line)
        return 0;
    order->order = estimate_of(line->observed.order);
    order->constant = line->observed.constant;
    order->points = line->observed.points;
    order->used = line->observed.used;
    if (orders->numbers.quantity->is_value)
        order->limit = estimate_of(line->limits.limit.value);
    return 1;
}

enum beamrate_status beamrate_orders_fit(const struct beamrate_orders *orders,
                                         struct beamrate_fit *fit)
{
    const struct br_joint_fit none = {0};
    const bool good = fit && br_handle_is(orders, BR_HANDLE_ORDERS);
    if (fit)
        *fit = fit_of(good ? &orders->orders.of[0].joint : &none);
    return good ? BEAMRATE_OK : BEAMRATE_BAD_INPUT;
}

/* ---- verdicts ---- */

struct beamrate_check {
    enum br_handle kind;
    struct br_check check;
    struct br_store names; /* of the cases */
};

void beamrate_check_free(struct beamrate_check *check)
{
    if (!br_handle_is(check, BR_HANDLE_CHECK))
        return;
    br_check_clear(&check->check);
    br_store_clear(&check->names);
    free(check);
}

size_t beamrate_check_count(const struct beamrate_check *check)
{
    return br_handle_is(check, BR_HANDLE_CHECK) ? check->check.count : 0;
}

enum beamrate_status beamrate_check_case(const struct beamrate_check *check, size_t i,
                                         struct beamrate_case *c)
{
    if (c)
        *c = (struct beamrate_case){
            .study = "", .measure = "", .verdict = BEAMRATE_FAIL, .reason = "", .note = ""};
    if (!c || i >= beamrate_check_count(check))
        return BEAMRATE_BAD_INPUT;
    const struct br_case *from = &check->check.cases[i];
    *c = (struct beamrate_case){
        .study = br_verify_names[from->kind],
        .measure = from->measure,
        .expected = from->expected.order,
        .tolerance = from->expected.tolerance,
        .order = estimate_of(from->order),
        .constant = from->constant,
        .margin = from->margin,
        .points = from->points,
        .used = from->used,
        .verdict = (enum beamrate_verdict)from->verdict,
        .reason = from->reason,
        .note = from->note,
    };
    return BEAMRATE_OK;
}

static enum br_status copy_expectations(const struct beamrate_expectation *from, size_t count,
                                        struct br_order_expectation **to, struct br_error *err)
{
    *to = NULL;
    if (!from || !count)
        return br_fail(err, BR_BAD_INPUT, "expectations: found none, expected at least one");
    *to = br_allocate(count, sizeof **to);
    if (!*to)
        return br_no_memory(err, "the expectations");
    for (size_t i = 0; i < count; i++) {
        const struct beamrate_expectation *e = &from[i];
        if (!is_axis(e->axis))
            return br_fail(err, BR_BAD_INPUT,
                           "expectation %zu: axis: found %d, expected 0 (space) or 1 (time)", i,
                           (int)e->axis);
        (*to)[i] = (struct br_order_expectation){.axis = (enum br_axis)e->axis,
                                                 .band = {.order = e->order,
                                                          .tolerance = e->tolerance,
                                                          .floor = NAN,
                                                          .ceiling = NAN,
                                                          .down_to = e->down_to}};
        struct br_error inner;
        if (br_expectation_check(&(*to)[i].band, &inner))
            return br_fail(err, inner.status, "expectation %zu: %s", i, inner.message);
    }
    return BR_OK;
}

/* Refuses orders of a mesh whose dimension is assumed; gives the cases names that outlive the
 * orders. */
static enum br_status finish_check(struct beamrate_check *made, const struct br_numbers *numbers,
                                   struct br_error *err)
{
    for (size_t i = 0; i < made->check.count; i++) {
        struct br_case *c = &made->check.cases[i];
        c->unit = "";
        if (numbers->unsettled)
            return br_fail(err, BR_BAD_INPUT, "an order of %.200s in %s is expected, and %s",
                           c->measure, c->kind == BR_VERIFY_SPACE ? "h" : "k", numbers->unsettled);
        c->measure = br_store_copy(&made->names, c->measure);
        if (!c->measure)
            return br_no_memory(err, "the verdicts");
    }
    return BR_OK;
}

static enum br_status check_orders(struct beamrate_check *made,
                                   const struct beamrate_orders *orders, size_t quantity,
                                   const struct beamrate_expectation *from, size_t count,
                                   struct br_error *err)
{
    struct br_order_expectation *e;
    if (br_handle_check(orders, err))
        return err->status;
    if (quantity >= orders->orders.count)
        return br_fail(err, BR_BAD_INPUT, "quantity: found %zu, expected less than %zu", quantity,
                       orders->orders.count);
    enum br_status status = copy_expectations(from, count, &e, err);
    made->check.path = name_of_numbers;
    for (size_t i = 0; i < count && !status; i++)
        status = br_orders_decide(&orders->orders, &orders->orders.of[quantity], &e[i],
                                  &made->check, err);
    free(e);
    return status ? status : finish_check(made, &orders->numbers, err);
}

static enum br_status check_text(struct beamrate_check *made, const struct beamrate_orders *orders,
                                 const char *text, struct br_error *err)
{
    struct br_order_expectation *e = NULL;
    size_t count = 0;
    if (br_handle_check(orders, err))
        return err->status;
    if (!text)
        return br_fail(err, BR_BAD_INPUT, "expectations: found NULL, expected a text");
    made->check.path = name_of_numbers;
    enum br_status status = br_expectations_read(text, 0, &e, &count, err);
    if (!status)
        status = br_orders_check(&orders->orders, e, count, &made->check, err);
    free(e);
    return status ? status : finish_check(made, &orders->numbers, err);
}

enum beamrate_status beamrate_orders_check(struct beamrate_check **check,
                                           const struct beamrate_orders *orders,
                                           const struct beamrate_expectation *expectation,
                                           size_t count, struct beamrate_error *err)
{
    return beamrate_orders_check_quantity(check, orders, 0, expectation, count, err);
}

enum beamrate_status beamrate_orders_check_quantity(struct beamrate_check **check,
                                                    const struct beamrate_orders *orders,
                                                    size_t quantity,
                                                    const struct beamrate_expectation *expectation,
                                                    size_t count, struct beamrate_error *err)
{
    MAKE_HANDLE(check, BR_HANDLE_CHECK, beamrate_check_free,
                check_orders(*check, orders, quantity, expectation, count, &call.err));
}

enum beamrate_status beamrate_orders_expect(struct beamrate_check **check,
                                            const struct beamrate_orders *orders, const char *text,
                                            struct beamrate_error *err)
{
    MAKE_HANDLE(check, BR_HANDLE_CHECK, beamrate_check_free,
                check_text(*check, orders, text, &call.err));
}
