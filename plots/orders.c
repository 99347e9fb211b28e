/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Errors, or differences of values, of any program over the size of elements or steps. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/quote.h"
#include "orders/orders.h"
#include "plots/pictures.h"

/* The errors, with the line of their order and its band; those of a joint fit, which is no line,
 * are joined. */
static void add_line(struct br_figure *f, const struct br_orders *o,
                     const struct br_quantity_orders *of, const struct br_orders_line *line)
{
    char name[sizeof((struct br_series *)0)->title];
    const struct br_case *c = &line->observed;
    const bool fitted = c->points && isfinite(c->point[0].fit.value);
    br_quoted(name, sizeof name, &br_for_markup, o->numbers->quantity[of->quantity].name);
    struct br_fitted_series s = {0};
    if (fitted)
        s = br_fitted_series_add(f, name);
    else
        s.marks = br_series_add(f, BR_PEN_CURVE, "%s", name);
    for (const struct br_point *p = c->point; p < c->point + c->points; p++) {
        const double error = p->flag == BR_FLAG_FAILED ? (double)NAN : p->error;
        const char *flag = p->flag ? br_flag_name(p->flag) : NULL;
        if (fitted)
            br_fitted_point_add(&s, p->z, error, flag, p->fit.value, p->fit.low);
        else
            br_point_add(s.marks, p->z, error, flag);
    }
    for (size_t i = c->points; i-- > 0 && fitted;)
        br_point_add(s.area, c->point[i].z, c->point[i].fit.high, NULL);
    br_series_sort(s.marks);
}

/* A size has the unit of the source; one over a count has none. */
static void name_axis(const struct br_numbers *numbers, enum br_axis axis, char label[96])
{
    static const char *const names[] = {"mesh size h", "time step k"};
    const struct br_resolution_column *column = numbers->column[axis];
    const char *unit = numbers->unit[axis];
    char quoted[60]; /* the label has room for 96 bytes */
    if (!column->is_size)
        snprintf(label, 96, "%s %s%s", names[axis], column->is_volume ? "from " : "= 1/",
                 column->name);
    else
        snprintf(label, 96, "%s%s%s", names[axis], unit ? ", " : "",
                 unit ? br_quoted(quoted, sizeof quoted, &br_for_markup, unit) : "");
}

/* The unit is named where all quantities have the same. */
static void name_quantities(const struct br_numbers *numbers, char label[96])
{
    const char *unit = numbers->quantity[0].unit;
    size_t values = 0;
    for (size_t i = 0; i < numbers->quantities; i++) {
        const char *own = numbers->quantity[i].unit;
        values += numbers->quantity[i].is_value;
        unit = unit && own && strcmp(unit, own) == 0 ? unit : NULL;
    }
    char quoted[60]; /* the label has room for 96 bytes */
    snprintf(label, 96, "%s%s%s",
             values == 0                    ? "error"
             : values < numbers->quantities ? "error, or difference of values"
                                            : "difference of values",
             unit ? ", " : "", unit ? br_quoted(quoted, sizeof quoted, &br_for_markup, unit) : "");
}

/* The lines along one axis: for each quantity the one at the finest size of the other axis. */
static void add_panel(struct br_figure *f, const struct br_orders *o, enum br_axis axis)
{
    double slope[3];
    size_t slopes = 0;
    char x[96], y[96];
    name_axis(o->numbers, axis, x);
    name_quantities(o->numbers, y);
    struct br_panel *p = br_panel_add(f, x, y);
    p->log_x = p->log_y = true;
    for (size_t i = 0; i < o->count; i++) {
        const struct br_orders_line *finest = br_orders_finest(&o->of[i], axis);
        if (!finest)
            continue;
        add_line(f, o, &o->of[i], finest);
        if (*finest->at)
            BR_SAY(p->title, "at %s", finest->at);
        const double order = round(o->of[i].answer[axis].order.value);
        if (slopes < 3 && order >= 1)
            slopes = br_slope_put(slope, slopes, order);
    }
    br_slopes_add(f, slopes, slope);
}

/* Adds errors over processor time where runs were timed. */
static void add_costs(struct br_figure *f, const struct br_orders *o)
{
    const struct br_numbers *numbers = o->numbers;
    bool timed = false;
    for (size_t i = 0; i < numbers->rows; i++)
        timed |= numbers->row[i].seconds > 0;
    if (!timed)
        return;
    struct br_panel *p = br_panel_add(f, "processor time (s)", "error");
    p->log_x = p->log_y = true;
    for (size_t i = 0; i < o->count; i++) {
        char quoted[sizeof((struct br_series *)0)->title];
        const struct br_quantity *q = &numbers->quantity[o->of[i].quantity];
        if (q->is_value)
            continue;
        struct br_series *s = br_series_add(
            f, BR_PEN_CURVE, "%s", br_quoted(quoted, sizeof quoted, &br_for_markup, q->name));
        for (size_t row = 0; row < numbers->rows; row++)
            if (br_orders_cheapest(o, o->of[i].quantity,
                                   numbers->row[row].number[o->of[i].quantity]) ==
                &numbers->row[row])
                br_point_add(s, numbers->row[row].seconds,
                             numbers->row[row].number[o->of[i].quantity], NULL);
        br_series_sort(s);
    }
}

struct br_figure br_orders_draw(const struct br_orders *orders, const char *caption)
{
    struct br_figure f = {0};
    BR_SAY(f.stem, "orders");
    BR_SAY(f.title, "%s. Orders of convergence", caption);
    BR_SAY(f.about, "errors, or differences of values, over the size of elements and of steps");
    BR_SAY(f.hollow, "left out of the order");
    for (int axis = 0; axis < BR_AXES; axis++) {
        bool any = false;
        for (size_t i = 0; i < orders->count; i++)
            any |= br_orders_finest(&orders->of[i], (enum br_axis)axis) != NULL;
        if (any)
            add_panel(&f, orders, (enum br_axis)axis);
    }
    add_costs(&f, orders);
    return f;
}
