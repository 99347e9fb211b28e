/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "study/orders/orders.h"
#include "tables/report_parts.h"

static const struct br_quantity *quantity_of(const struct br_orders *o,
                                             const struct br_quantity_orders *of)
{
    return &o->numbers->quantity[of->quantity];
}

static const char *const limit_methods[] = {
    [BR_LIMIT_GCI] = "GCI, Celik et al. 2008",
    [BR_LIMIT_LEAST_SQUARES] = "least squares, Eca and Hoekstra 2014",
};

enum { MOST_NAMED = BR_MOST_ANSWERS - 6 }; /* quantities with an answer; the tables have all */

/* What is put before an item of a sentence; the first item follows a colon. */
static const char *separator(bool *first)
{
    const bool was = *first;
    *first = false;
    return was ? " " : "; ";
}

static void say_order(struct br_document *d, const struct br_estimate *order, enum br_axis axis,
                      const char *where, bool *first)
{
    char text[64];
    const bool none = !isfinite(order->value) || order->value <= 0 || order->low <= 0;
    br_put_more(d, "%sorder in %s %s%s%s%s", separator(first), br_axis_letters[axis],
                none ? "not seen" : br_order_text(order, text, sizeof text),
                !none && !br_order_determined(order) ? " (not determined)" : "",
                *where ? " at " : "", where);
}

static void say_orders(struct br_document *d, const struct br_quantity_orders *of, bool *first)
{
    const bool joint = br_joint_describes(&of->joint);
    for (int axis = 0; axis < BR_AXES; axis++) {
        const struct br_orders_line *line = br_orders_finest(of, (enum br_axis)axis);
        const struct br_orders_answer *answer = &of->answer[axis];
        if (answer->open && isnan(answer->order.value))
            br_put_more(d, "%s%s", separator(first), answer->open);
        else if (line || joint)
            say_order(d, &answer->order, (enum br_axis)axis, joint ? "" : line->at, first);
    }
    if (joint)
        br_put_more(d, "%sby the joint fit of %zu rows, misfit %.2g %%", separator(first),
                    of->joint.points, 100 * of->joint.misfit);
    if (joint && isfinite(of->joint.floor))
        br_put_more(d, "%swith a floor of %.1e", separator(first), of->joint.floor);
}

/* Puts the number of rows that are left out, the first reason and where it begins. */
static void say_left_out(struct br_document *d, const struct br_quantity_orders *of)
{
    size_t count = 0, points = 0;
    const struct br_point *first = NULL;
    for (size_t l = 0; l < of->lines; l++)
        for (size_t i = 0; i < of->line[l].observed.points; i++) {
            const struct br_point *p = &of->line[l].observed.point[i];
            if (of->line[l].axis != of->line[0].axis)
                continue;
            points++;
            count += p->flag != BR_FLAG_NONE;
            first = !first && p->flag ? p : first;
        }
    if (!count)
        return;
    br_put_more(d, " %zu of %zu left out, the first at %s (%s", count, points, first->label,
                br_flag_name(first->flag));
    if (isfinite(first->error))
        br_put_more(d, ", %.1e", first->error);
    br_put_more(d, ").");
}

static void say_limit(struct br_document *d, const struct br_grid_limit *limit, bool *first)
{
    if (isfinite(limit->value.low))
        br_put_more(d, "%slimit %.9g, between %.9g and %.9g (%s), %s", separator(first),
                    limit->value.value, limit->value.low, limit->value.high,
                    limit_methods[limit->method], br_sequence_text(limit->sequence));
    else
        br_put_more(d, "%sno limit: %s", separator(first), br_sequence_text(limit->sequence));
}

/* An exponent of about 0, or none, is not said. */
static void say_growth(struct br_document *d, const struct br_estimate *growth, enum br_axis axis)
{
    const struct br_estimate falls = {-growth->value, -growth->high, -growth->low};
    if (fabs(growth->value) >= 0.1)
        br_put_answer(d, "Processor time %s like %s^%s%s.", growth->value > 0 ? "grows" : "falls",
                      br_axis_letters[axis], growth->value > 0 ? "-" : "",
                      br_order_text(growth->value > 0 ? growth : &falls, (char[64]){0}, 64));
}

static void put_given(struct br_document *d, const struct br_numbers *numbers, size_t row)
{
    for (int axis = 0; axis < BR_AXES; axis++)
        if (numbers->column[axis])
            BR_PUT(d, br_number(numbers->row[row].given[axis]), .key = numbers->column[axis]->name,
                   .unit = numbers->unit[axis], .format = "%.6g");
}

static void put_rows(struct br_document *d, const struct br_orders *o,
                     const struct br_quantity_orders *of)
{
    static const char *const rates[] = {"rate_h", "rate_k"}, *const headings[] = {"rate in h",
                                                                                  "rate in k"};
    const struct br_numbers *numbers = o->numbers;
    const struct br_quantity *q = quantity_of(o, of);
    char key[80], title[160];
    snprintf(key, sizeof key, "rows-%zu", of->quantity + 1);
    snprintf(title, sizeof title, "%s %s, row by row", q->is_value ? "Value" : "Error", q->name);
    br_put_table(d, key, title, BR_LONG);
    for (size_t i = 0; i < numbers->rows; i++) {
        const struct br_numbers_row *row = &numbers->row[i];
        const double number = row->number[of->quantity];
        const char *left_out = row->failure || isnan(number) ? br_flag_name(BR_FLAG_FAILED) : "";
        br_put_row(d);
        BR_PUT(d, br_text(q->name), .key = "quantity");
        put_given(d, numbers, i);
        BR_PUT(d, br_number(number), .key = q->is_value ? "value" : "error", .unit = q->unit,
               .format = q->is_value ? "%.9g" : "%.3e");
        for (int axis = 0; axis < BR_AXES; axis++) {
            const struct br_row_point *at = of->point[axis] ? &of->point[axis][i] : NULL;
            const struct br_orders_line *line = at ? at->line : NULL; /* NULL: the row is on none */
            const enum br_flag flag = line ? line->observed.point[at->index].flag : BR_FLAG_NONE;
            if (numbers->column[axis] && !(o->tied && axis == BR_AXIS_TIME))
                BR_PUT(d, br_number(line ? br_orders_rate(line, at->index) : (double)NAN),
                       .key = rates[axis], .heading = headings[axis], .format = "%.2f");
            if (flag && flag != BR_FLAG_FAILED) /* the next finer one may have failed */
                left_out = br_flag_name(flag);
        }
        BR_PUT(d, br_text(left_out), .key = "left_out", .heading = "left out");
        BR_PUT(d, br_text(row->failure), .key = "failure", .flags = BR_FILES_ONLY);
    }
}

static void put_costs(struct br_document *d, const struct br_numbers *numbers)
{
    br_put_table(d, "costs", "What each run costs", 0);
    for (size_t i = 0; i < numbers->rows; i++) {
        const struct br_numbers_row *row = &numbers->row[i];
        br_put_row(d);
        put_given(d, numbers, i);
        BR_PUT(d, br_number(row->seconds), .key = "cpu_seconds", .heading = "processor time",
               .unit = "s", .format = "%.3g");
        BR_PUT(d, br_number(row->bytes / 1e6), .key = "peak_memory", .heading = "peak memory",
               .unit = "MB", .format = "%.3g");
        BR_PUT(d, br_truth(row->kept), .key = "kept", .flags = BR_FILES_ONLY);
    }
}

/* Puts the cheapest run for each power of ten, from the largest error down to the smallest one. */
static void put_cheapest_of(struct br_document *d, const struct br_orders *o, size_t quantity)
{
    const struct br_numbers *numbers = o->numbers;
    const struct br_numbers_row *run = NULL;
    double most = 0;
    for (size_t i = 0; i < numbers->rows; i++)
        most = fmax(most, numbers->row[i].number[quantity]);
    double error = pow(10, floor(log10(most)));
    for (int digit = 0; digit < 17 && error > 0; digit++) { /* 0: no power of ten is smaller */
        if (!(run = br_orders_cheapest(o, quantity, error)))
            break;
        br_put_row(d);
        BR_PUT(d, br_text(numbers->quantity[quantity].name), .key = "quantity");
        BR_PUT(d, br_number(error), .key = "wanted", .heading = "error at most", .format = "%.0e");
        put_given(d, numbers, (size_t)(run - numbers->row));
        BR_PUT(d, br_number(run->number[quantity]), .key = "error", .format = "%.3e");
        BR_PUT(d, br_number(run->seconds), .key = "cpu_seconds", .heading = "processor time",
               .unit = "s", .format = "%.3g");
        error /= 10;
    }
}

static void put_cheapest(struct br_document *d, const struct br_orders *o)
{
    br_put_table(d, "cheapest", "The cheapest run to each digit", 0);
    for (size_t i = 0; i < o->count; i++)
        if (!o->numbers->quantity[o->of[i].quantity].is_value)
            put_cheapest_of(d, o, o->of[i].quantity);
}

/* Puts an order, and for programs the ends of its interval. */
static void put_order(struct br_document *d, const struct br_estimate *order)
{
    BR_PUT_CELLS(d, br_number(order->value));
    br_put_shown(d, "%s", br_order_text(order, (char[64]){0}, 64));
    BR_PUT_CELLS(d, br_number(order->low), br_number(order->high));
}

void br_report_orders(const struct br_orders *o, const struct br_estimate *growth,
                      const char *caption, struct br_document *d)
{
    bool timed = false;
    br_document_begin(d, "orders", "beamrate orders", 1, caption);

    size_t kept = 0;
    for (size_t i = 0; i < o->count && i < MOST_NAMED; i++) {
        const struct br_quantity_orders *of = &o->of[i];
        const struct br_orders_line *line =
            of->lines ? br_orders_finest(of, of->line[0].axis) : NULL;
        bool first = true;
        br_put_answer(d, "%s:", quantity_of(o, of)->name);
        if (!line)
            br_put_more(d, "%sno order: fewer than three sizes", separator(&first));
        if (line && quantity_of(o, of)->is_value)
            say_limit(d, &of->limit, &first);
        say_orders(d, of, &first);
        br_put_more(d, ".");
        say_left_out(d, of);
    }
    if (o->numbers->taken[0])
        br_put_answer(d, "Read: %s.", o->numbers->taken);
    if (o->count > MOST_NAMED)
        br_put_answer(d, "Columns that only the tables have: %zu.", o->count - MOST_NAMED);
    for (int axis = 0; axis < BR_AXES; axis++)
        say_growth(d, &growth[axis], (enum br_axis)axis);
    if (o->tied)
        br_put_answer(d, "Mesh and time step go along: the orders in h are of both together.");
    for (size_t i = 0; i < o->numbers->rows; i++)
        kept += o->numbers->row[i].kept;
    if (kept) /* their numbers are those of the program at that time */
        br_put_answer(d, "%zu of %zu runs were kept from before, and not run again.", kept,
                      o->numbers->rows);

    static const struct br_column orders_columns[] = {
        {.key = "quantity"},
        {.key = "in"},
        {.key = "at"},
        {.key = "order", .heading = "order [95 %]"},
        {.key = "low", .flags = BR_FOR_PROGRAMS},
        {.key = "high", .flags = BR_FOR_PROGRAMS},
        {.key = "points"},
        {.key = "used"},
        {.key = "note", .flags = BR_FILES_ONLY | BR_WRAP},
    };
    BR_TABLE(d, "orders", "Orders along lines", BR_MAIN, orders_columns);
    for (size_t i = 0; i < o->count; i++)
        for (size_t l = 0; l < o->of[i].lines; l++) {
            const struct br_orders_line *line = &o->of[i].line[l];
            const struct br_case *c = &line->observed;
            BR_PUT_ROW(d, br_text(quantity_of(o, &o->of[i])->name),
                       br_text(br_axis_letters[line->axis]), br_text(line->at));
            put_order(d, &c->order);
            BR_PUT_CELLS(d, br_count(c->points), br_count(c->used), br_text(c->note));
        }

    static const struct br_column joint_columns[] = {
        {.key = "quantity"},
        {.key = "order_h", .heading = "order in h [95 %]"},
        {.key = "order_h_low", .flags = BR_FOR_PROGRAMS},
        {.key = "order_h_high", .flags = BR_FOR_PROGRAMS},
        {.key = "order_k", .heading = "order in k [95 %]"},
        {.key = "order_k_low", .flags = BR_FOR_PROGRAMS},
        {.key = "order_k_high", .flags = BR_FOR_PROGRAMS},
        {.key = "c_h", .heading = "C_h", .format = "%.3e"},
        {.key = "c_k", .heading = "C_k", .format = "%.3e"},
        {.key = "rows"},
        {.key = "misfit", .format = "%.2e"},
        {.key = "floor", .format = "%.1e", .flags = BR_FILES_ONLY},
    };
    BR_TABLE(d, "joint", "Joint fit of the signed errors C_h h^p and C_k k^q", 0, joint_columns);
    for (size_t i = 0; i < o->count; i++) {
        const struct br_joint_fit *f = &o->of[i].joint;
        if (!f->converged)
            continue;
        BR_PUT_ROW(d, br_text(quantity_of(o, &o->of[i])->name));
        for (int axis = 0; axis < BR_AXES; axis++)
            put_order(d, &f->order[axis]);
        BR_PUT_CELLS(d, br_number(f->c[BR_AXIS_SPACE].value), br_number(f->c[BR_AXIS_TIME].value),
                     br_count(f->points), br_number(f->misfit), br_number(f->floor));
    }

    /* The limits of values. The grid convergence index is that of the three finest rows, relative
     * as Celik et al. print it. */
    static const struct br_column limits_columns[] = {
        {.key = "quantity"},
        {.key = "in"},
        {.key = "at"},
        {.key = "sequence"},
        {.key = "limit", .format = "%.9g"},
        {.key = "low", .format = "%.9g"},
        {.key = "high", .format = "%.9g"},
        {.key = "method", .flags = BR_FILES_ONLY},
        {.key = "p", .heading = "p of three", .format = "%.4f"},
        {.key = "r21", .format = "%.4g", .flags = BR_FILES_ONLY},
        {.key = "r32", .format = "%.4g", .flags = BR_FILES_ONLY},
        {.key = "phi_ext", .format = "%.9g", .flags = BR_FILES_ONLY},
        {.key = "e_a", .format = "%.3e", .flags = BR_FILES_ONLY},
        {.key = "e_ext", .format = "%.3e", .flags = BR_FILES_ONLY},
        {.key = "gci_fine", .heading = "GCI fine", .format = "%.3e"},
        {.key = "gci_coarse", .heading = "GCI coarse", .format = "%.3e"},
        {.key = "asymptotic", .heading = "asymptotic ratio", .format = "%.4f"},
        {.key = "of_three", .flags = BR_FOR_PROGRAMS},
    };
    BR_TABLE(d, "limits", "Limits of values, and the grid convergence index", 0, limits_columns);
    for (size_t i = 0; i < o->count; i++)
        for (size_t l = 0; l < o->of[i].lines && quantity_of(o, &o->of[i])->is_value; l++) {
            const struct br_orders_line *line = &o->of[i].line[l];
            const struct br_grid_limit *limit = &line->limit;
            const struct br_gci *g = &line->gci;
            BR_PUT_ROW(d, br_text(quantity_of(o, &o->of[i])->name),
                       br_text(br_axis_letters[line->axis]), br_text(line->at),
                       br_text(br_sequence_text(limit->sequence)), br_number(limit->value.value),
                       br_number(limit->value.low), br_number(limit->value.high),
                       br_text(limit_methods[limit->method]), br_number(g->order),
                       br_number(g->fine.ratio), br_number(g->coarse.ratio),
                       br_number(g->fine.limit), br_number(g->fine.relative),
                       br_number(g->fine.relative_extrapolated), br_number(g->fine.index),
                       br_number(g->coarse.index), br_number(g->asymptotic),
                       br_text(br_sequence_text(g->sequence)));
        }
    for (size_t i = 0; i < o->count; i++) /* one line has its limit above */
        if (quantity_of(o, &o->of[i])->is_value && o->of[i].lines > 1) {
            const struct br_grid_limit *limit = &o->of[i].limit;
            BR_PUT_ROW(d, br_text(quantity_of(o, &o->of[i])->name), br_text("h and k"), br_text(""),
                       br_text(br_sequence_text(limit->sequence)), br_number(limit->value.value),
                       br_number(limit->value.low), br_number(limit->value.high),
                       br_text(limit_methods[limit->method]));
        }

    for (size_t i = 0; i < o->numbers->rows; i++)
        timed |= isfinite(o->numbers->row[i].seconds);
    if (timed) {
        put_costs(d, o->numbers);
        put_cheapest(d, o);
    }
    for (size_t i = 0; i < o->count; i++)
        put_rows(d, o, &o->of[i]);
}
