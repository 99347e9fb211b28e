/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What runs of a program cost: how that grows, and the cheapest one to each error. */
#include <math.h>

#include "study/orders/orders.h"

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
    size_t count = 0;
    for (size_t i = 0; i < line->observed.points; i++) {
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
