/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What finer meshes would give, and what runs cost. */
#include <math.h>

#include "orders/line/line_order.h"
#include "orders/orders.h"

/* ---- finer meshes ---- */

struct br_orders_forecast br_orders_forecast_of(const struct br_orders *o,
                                                const struct br_quantity_orders *of)
{
    const struct br_orders_line *line = br_orders_is_grid(o) || !of->lines ? NULL : &of->line[0];
    if (!line)
        return (struct br_orders_forecast){.line = NULL};
    const struct br_case *c = &line->observed;
    const bool is_value = br_quantity_of(o, of)->is_value;
    const struct br_point *finest = c->point + c->points - 1 + is_value;
    const enum br_sequence sequence = line->limits.limit.sequence;
    struct br_orders_forecast f = {line, line->limits.gci.fine.index, line->limits.gci.order,
                                   finest->z, finest->z / finest[-1].z};
    if (!is_value) {
        f.number = finest->flag || br_law_is_floor(c->law) ? (double)NAN : finest->error;
        f.order = br_order_determined(&c->order) ? c->order.value : (double)NAN;
    } else if (isnan(finest->value) || /* the index is of coarser ones */
               sequence == BR_SEQUENCE_ANOMALOUS || sequence == BR_SEQUENCE_UNKNOWN)
        f.number = NAN;
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
    static const double most = 100; /* times finer, or as many cells: nobody knows more */
    const struct br_resolution_column *column = o->numbers->column[f->line->axis];
    const double part = pow(wanted / f->number, 1 / f->order);
    const double growth = pow(part, column->is_volume ? -o->numbers->dimension : -1);
    return growth <= most ? br_numbers_given(column, f->z * part, o->numbers->dimension)
                          : (double)NAN;
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
    struct br_point *point = line ? br_allocate(o->numbers->rows, sizeof *point) : NULL;
    if (!line || !point)
        return line ? br_no_memory(err, "the costs") : BR_OK;
    const size_t rows = line->observed.points + o->numbers->quantity[o->of[0].quantity].is_value;
    size_t count = 0;
    for (size_t i = 0; i < rows; i++) {
        const struct br_numbers_row *row = &o->numbers->row[line->observed.point[i].row];
        if (row->seconds >= least_seconds)
            point[count++] = (struct br_point){.z = row->z[axis], .error = 1 / row->seconds};
    }
    struct br_line_order found;
    const enum br_status status = br_line_order_find(point, count, &found, err);
    *growth = found.order;
    free(point);
    return status;
}
