/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The library's functions for studies, verdicts and orders of numbers. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "base/each.h"
#include "orders/request.h"
#include "study/foresee/foreseen.h"
#include "study/grid/sweep.h"
#include "study/library/library.h"
#include "study/verify/check.h"

static_assert((int)BEAMRATE_TOTAL == BR_PART_TOTAL && (int)BEAMRATE_OF_AXIAL == BR_PART_AXIAL &&
                  (int)BEAMRATE_OF_BENDING == BR_PART_BENDING,
              "");
static_assert((int)BEAMRATE_SPACE == BR_AXIS_SPACE && (int)BEAMRATE_TIME == BR_AXIS_TIME, "");
static_assert((int)BEAMRATE_PASS == BR_PASS && (int)BEAMRATE_FAIL == BR_FAIL &&
                  (int)BEAMRATE_INCONCLUSIVE == BR_INCONCLUSIVE,
              "");

static enum br_status check_threads(int threads, struct br_error *err)
{
    return threads >= 0 && threads <= BR_MOST_THREADS
               ? BR_OK
               : br_fail(err, BR_BAD_INPUT, "threads: found %d, expected 0 to %d", threads,
                         BR_MOST_THREADS);
}

static bool is_axis(enum beamrate_axis axis)
{
    return axis == BEAMRATE_SPACE || axis == BEAMRATE_TIME;
}

/* ---- studies ---- */

struct beamrate_study {
    enum br_handle kind;
    struct br_study study;
    struct br_fits fits[BR_PARTS];
    size_t *n, *steps; /* owned */
    struct beamrate_reference reference;
};

/* A copy of a list; *to (out) is owned by the caller, even after a failure. */
static enum br_status copy_list(const char *name, const size_t *list, size_t count, size_t **to,
                                struct br_error *err)
{
    *to = NULL;
    if (count && !list)
        return br_fail(err, BR_BAD_INPUT, "%s: found NULL, expected a list", name);
    if (count < 1 || list[0] < 1)
        return br_fail(err, BR_BAD_INPUT, "%s: found %s, expected numbers of at least 1", name,
                       count < 1 ? "an empty list" : "0");
    for (size_t i = 1; i < count; i++)
        if (!(list[i] > list[i - 1]))
            return br_fail(err, BR_BAD_INPUT,
                           "%s: found %zu behind %zu, expected ascending numbers", name, list[i],
                           list[i - 1]);
    *to = br_allocate(count, sizeof **to);
    if (!*to)
        return br_no_memory(err, "the grid");
    memcpy(*to, list, count * sizeof **to);
    return BR_OK;
}

static enum br_status choose_reference(const struct beamrate_study_request *q, struct br_study *s,
                                       struct br_error *err)
{
    s->judge = q->reference ? br_judge_find(q->reference) : br_judge_best(s->scene);
    if (!s->judge || !s->judge->create)
        return br_fail(err, BR_BAD_INPUT, "reference: found '%.200s', expected exact, mms or fine",
                       q->reference);
    const bool given = q->reference_n || q->reference_steps;
    if (s->judge->nests != given)
        return br_fail(err, BR_BAD_INPUT,
                       "reference: found %zu elements and %zu steps, expected %s", q->reference_n,
                       q->reference_steps,
                       given ? "none: they are for a fine run" : "those of the fine run");
    s->reference = (struct br_resolution){q->reference_n, q->reference_steps};
    s->auditor = s->judge->nests ? br_judge_best(s->scene) : NULL;
    return BR_OK;
}

static enum br_status prepare_study(struct beamrate_study *s, const struct br_scene *scene,
                                    const struct beamrate_study_request *q, struct br_error *err)
{
    struct br_study *study = &s->study;
    *study = (struct br_study){.scene = scene,
                               .norm = q->norm ? br_norm_find(q->norm) : br_norms[0],
                               .n_count = q->n_count,
                               .k_count = q->steps_count};
    if (!study->norm)
        return br_fail(err, BR_BAD_INPUT, "norm: found '%.200s', expected l2, energy or tip",
                       q->norm);
    if (check_threads(q->threads, err) || br_library_method(q->method, &study->method, err) ||
        copy_list("n", q->n, q->n_count, &s->n, err) ||
        copy_list("steps", q->steps, q->steps_count, &s->steps, err) ||
        choose_reference(q, study, err))
        return err->status;
    study->reference_method = study->method;
    study->n = s->n;
    study->steps = s->steps;
    return br_fit_together(study, 1, br_memory_available(), err);
}

static struct beamrate_reference describe_reference(const struct br_study *s)
{
    struct beamrate_reference r = {
        .name = s->judge->name,
        .n = s->reference.n,
        .steps = s->reference.steps,
        .size = s->reference_scale,
        .tip = {s->reference_tip[BR_AXIAL], s->reference_tip[BR_BENDING]},
    };
    for (enum br_part part = 0; part < BR_PARTS; part++)
        r.own_error[part] =
            s->judge->nests ? s->reference_error[part]
                            : br_norm_of_constant(s->norm, s->scene, s->judged_by.own_error, part);
    return r;
}

static enum br_status march_and_fit(struct beamrate_study *s, const struct beamrate_scene *scene,
                                    const struct beamrate_study_request *q, struct br_call *call)
{
    struct br_library_watch watch;
    struct br_error *err = &call->err;
    enum br_status status = br_call_take_scene(call, scene);
    if (!status && !q)
        status = br_fail(err, BR_BAD_INPUT, "request: found NULL, expected a struct");
    if (!status)
        status = prepare_study(s, &call->scene, q, err);
    if (status)
        return status;
    br_library_watch_begin(&watch, q->observer);
    status = br_study_run(&s->study, 1, q->threads, &watch.ours, err);
    br_library_watch_end(&watch);
    for (enum br_part part = 0; part < BR_PARTS && !status; part++)
        status = br_fit(&s->study, part, &s->fits[part], err);
    if (!status)
        s->reference = describe_reference(&s->study);
    return status;
}

enum beamrate_status beamrate_study_run(struct beamrate_study **study,
                                        const struct beamrate_scene *scene,
                                        const struct beamrate_study_request *request,
                                        struct beamrate_error *err)
{
    BR_MAKE_HANDLE(study, BR_HANDLE_STUDY, beamrate_study_free,
                   march_and_fit(*study, scene, request, &call));
}

void beamrate_study_free(struct beamrate_study *study)
{
    if (!br_handle_is(study, BR_HANDLE_STUDY))
        return;
    br_study_clear(&study->study);
    free(study->n);
    free(study->steps);
    free(study);
}

static bool is_part_of(const struct beamrate_study *study, enum beamrate_part part)
{
    return br_handle_is(study, BR_HANDLE_STUDY) &&
           (part == BEAMRATE_TOTAL || part == BEAMRATE_OF_AXIAL || part == BEAMRATE_OF_BENDING);
}

enum beamrate_status beamrate_study_cell(const struct beamrate_study *study, size_t i, size_t j,
                                         struct beamrate_cell *cell)
{
    if (cell)
        *cell = (struct beamrate_cell){
            .error = {NAN, NAN, NAN}, .flag = {"", "", ""}, .tip = {NAN, NAN}, .failure = ""};
    if (!cell || !br_handle_is(study, BR_HANDLE_STUDY) || i >= study->study.n_count ||
        j >= study->study.k_count)
        return BEAMRATE_BAD_INPUT;
    const struct br_cell *c = br_study_cell(&study->study, i, j);
    *cell = (struct beamrate_cell){
        .n = c->at.n,
        .steps = c->at.steps,
        .tip = {c->tip[BR_AXIAL], c->tip[BR_BENDING]},
        .seconds = c->seconds,
        .failure = c->failure.status ? c->failure.message : "",
    };
    for (enum br_part part = 0; part < BR_PARTS; part++) {
        cell->error[part] = c->error[part];
        cell->flag[part] = br_flag_name(c->flag[part]);
    }
    return BEAMRATE_OK;
}

enum beamrate_status beamrate_study_fit(const struct beamrate_study *study, enum beamrate_part part,
                                        struct beamrate_fit *fit)
{
    const struct br_joint_fit none = {0};
    const bool good = fit && is_part_of(study, part);
    if (fit)
        *fit = br_library_fit(good ? &study->fits[part].joint : &none);
    return good ? BEAMRATE_OK : BEAMRATE_BAD_INPUT;
}

enum beamrate_status beamrate_study_reference(const struct beamrate_study *study,
                                              struct beamrate_reference *reference)
{
    const bool good = reference && br_handle_is(study, BR_HANDLE_STUDY);
    if (reference)
        *reference = good ? study->reference
                          : (struct beamrate_reference){.name = "", .own_error = {NAN, NAN, NAN}};
    return good ? BEAMRATE_OK : BEAMRATE_BAD_INPUT;
}

/* ---- verdicts ---- */

struct beamrate_check {
    enum br_handle kind;
    struct br_check check;
    char *measure; /* of numbers: the name of their column; owned */
};

static enum br_status check_scene(struct br_check *check, const struct beamrate_scene *scene,
                                  int threads, const struct beamrate_observer *observer,
                                  struct br_call *call)
{
    struct br_library_watch watch;
    struct br_error *err = &call->err;
    const struct br_scene *own = &call->scene;
    if (br_call_take_scene(call, scene) || check_threads(threads, err))
        return err->status;
    *check = (struct br_check){
        .path = scene->path, .name = own->name, .scene = own, .verify = &scene->verify};
    br_library_watch_begin(&watch, observer);
    const enum br_status status = br_check_run(check, 1, threads, &watch.ours, err);
    br_library_watch_end(&watch);
    const struct br_error *failure = &check->failure;
    return status || !failure->status ? status
                                      : br_fail(err, failure->status, "%s", failure->message);
}

enum beamrate_status beamrate_check_run(struct beamrate_check **check,
                                        const struct beamrate_scene *scene, int threads,
                                        const struct beamrate_observer *observer,
                                        struct beamrate_error *err)
{
    BR_MAKE_HANDLE(check, BR_HANDLE_CHECK, beamrate_check_free,
                   check_scene(&(*check)->check, scene, threads, observer, &call));
}

void beamrate_check_free(struct beamrate_check *check)
{
    if (!br_handle_is(check, BR_HANDLE_CHECK))
        return;
    br_check_clear(&check->check);
    free(check->measure);
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
        *c = (struct beamrate_case){.study = "",
                                    .measure = "",
                                    .part = "",
                                    .verdict = BEAMRATE_FAIL,
                                    .reason = "",
                                    .note = ""};
    if (!c || i >= beamrate_check_count(check))
        return BEAMRATE_BAD_INPUT;
    const struct br_case *from = &check->check.cases[i];
    *c = (struct beamrate_case){
        .study = br_verify_names[from->kind],
        .measure = from->measure,
        .part = from->part,
        .expected = from->expected.order,
        .tolerance = from->expected.tolerance,
        .order = br_library_estimate(from->order),
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

/* ---- orders of any numbers ---- */

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
    BR_MAKE_HANDLE(orders, BR_HANDLE_ORDERS, beamrate_orders_free,
                   find_orders(*orders, numbers, &call.err));
}

static enum br_status read_orders(struct beamrate_orders *o, const struct beamrate_table *table,
                                  struct br_error *err)
{
    struct br_orders_request q = br_orders_request_default();
    if (!table || !table->text)
        return br_fail(err, BR_BAD_INPUT, "table: found NULL, expected a table");
    if (!(table->dimension >= 0 && isfinite(table->dimension) && table->formal >= 0 &&
          isfinite(table->formal)))
        return br_fail(
            err, BR_BAD_INPUT,
            "table: found dimension %g and formal order %g, expected numbers above 0, or "
            "0: not stated",
            table->dimension, table->formal);
    q.path = (char *)(table->name ? table->name
                                  : "table"); /* all borrowed: the request is not cleared */
    q.table = (char *)table->text;
    q.errors = (char *)table->errors;
    q.values = (char *)table->values;
    q.columns = (char *)table->columns;
    q.where = (char *)table->where;
    q.dimension = table->dimension > 0 ? table->dimension : q.dimension;
    q.assumed_dimension = !(table->dimension > 0);
    q.formal = table->formal > 0 ? table->formal : q.formal;
    return br_orders_read(&q, &o->numbers, err)
               ? err->status
               : br_orders_find(&o->numbers, q.formal, &o->orders, err);
}

enum beamrate_status beamrate_orders_read(struct beamrate_orders **orders,
                                          const struct beamrate_table *table,
                                          struct beamrate_error *err)
{
    BR_MAKE_HANDLE(orders, BR_HANDLE_ORDERS, beamrate_orders_free,
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

static const struct beamrate_estimate nothing = {NAN, NAN, NAN};

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
    answer->order = br_library_estimate(found->order);
    answer->open = found->open ? found->open : "";
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
                                           .fit = br_library_estimate(p->fit),
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
    order->order = br_library_estimate(line->observed.order);
    order->constant = line->observed.constant;
    order->points = line->observed.points;
    order->used = line->observed.used;
    if (orders->numbers.quantity->is_value)
        order->limit = br_library_estimate(line->limits.limit.value);
    return 1;
}

enum beamrate_status beamrate_orders_fit(const struct beamrate_orders *orders,
                                         struct beamrate_fit *fit)
{
    const struct br_joint_fit none = {0};
    const bool good = fit && br_handle_is(orders, BR_HANDLE_ORDERS);
    if (fit)
        *fit = br_library_fit(good ? &orders->orders.of[0].joint : &none);
    return good ? BEAMRATE_OK : BEAMRATE_BAD_INPUT;
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
        if (!(e->order > 0 && e->tolerance > 0 && e->tolerance < e->order && isfinite(e->order) &&
              e->down_to >= 0))
            return br_fail(err, BR_BAD_INPUT,
                           "expectation %zu: found order %g +- %g down to %g, expected an order "
                           "above 0, a tolerance above 0 and below it, and an error of at least 0",
                           i, e->order, e->tolerance, e->down_to);
        (*to)[i] = (struct br_order_expectation){.axis = (enum br_axis)e->axis,
                                                 .order = e->order,
                                                 .tolerance = e->tolerance,
                                                 .down_to = e->down_to};
    }
    return BR_OK;
}

static enum br_status check_orders(struct beamrate_check *made,
                                   const struct beamrate_orders *orders, size_t quantity,
                                   const struct beamrate_expectation *from, size_t count,
                                   struct br_error *err)
{
    struct br_check *check = &made->check;
    struct br_order_expectation *e;
    if (br_handle_check(orders, BR_HANDLE_ORDERS, "orders", err))
        return err->status;
    if (quantity >= orders->orders.count)
        return br_fail(err, BR_BAD_INPUT, "quantity: found %zu, expected less than %zu", quantity,
                       orders->orders.count);
    if (copy_expectations(from, count, &e, err))
        return free(e), err->status;
    /* One column: a name that is longer than an expectation's is no other one's. */
    struct br_orders alone = orders->orders;
    struct br_numbers numbers = orders->numbers;
    alone.numbers = &numbers;
    alone.of += quantity;
    alone.count = 1;
    numbers.quantity += quantity;
    made->measure = strdup(numbers.quantity->name); /* outlives the orders */
    check->path = name_of_numbers;
    for (size_t i = 0; i < count; i++)
        snprintf(e[i].quantity, sizeof e->quantity, "%s", numbers.quantity->name);
    enum br_status status = made->measure ? BR_OK : br_no_memory(err, "the verdicts");
    for (size_t i = 0; i < count && !status; i++)
        if (numbers.unsettled)
            status = br_fail(err, BR_BAD_INPUT, "an order of %.200s in %s is expected, and %s",
                             made->measure, br_axis_letters[e[i].axis], numbers.unsettled);
    if (!status)
        status = br_orders_check(&alone, e, count, check, err);
    for (size_t i = 0; i < check->count && !status; i++)
        check->cases[i].measure = made->measure;
    free(e);
    return status;
}

enum beamrate_status beamrate_orders_check(struct beamrate_check **check,
                                           const struct beamrate_orders *orders,
                                           const struct beamrate_expectation *expectation,
                                           size_t count, struct beamrate_error *err)
{
    BR_MAKE_HANDLE(check, BR_HANDLE_CHECK, beamrate_check_free,
                   check_orders(*check, orders, 0, expectation, count, &call.err));
}

enum beamrate_status beamrate_orders_check_quantity(struct beamrate_check **check,
                                                    const struct beamrate_orders *orders,
                                                    size_t quantity,
                                                    const struct beamrate_expectation *expectation,
                                                    size_t count, struct beamrate_error *err)
{
    BR_MAKE_HANDLE(check, BR_HANDLE_CHECK, beamrate_check_free,
                   check_orders(*check, orders, quantity, expectation, count, &call.err));
}
