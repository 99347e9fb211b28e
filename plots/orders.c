/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Errors, or differences of values, of any program over the size of elements or steps. */
#include <math.h>

#include "plots/pictures.h"
#include "study/orders/orders.h"
#include "study/scene/quote.h"

static void add_line(struct br_figure *f, const struct br_orders *o,
                     const struct br_quantity_orders *of, const struct br_orders_line *line)
{
    char quoted[400];
    struct br_series *s = br_series_add(
        f, BR_PEN_CURVE, "%s",
        br_quoted(quoted, sizeof quoted, &br_for_markup, o->numbers->quantity[of->quantity].name));
    for (size_t i = 0; i < line->observed.points; i++) {
        const struct br_point *p = &line->observed.point[i];
        br_point_add(s, p->z, p->flag == BR_FLAG_FAILED ? (double)NAN : p->error,
                     p->flag ? br_flag_name(p->flag) : NULL);
    }
    br_series_sort(s);
}

/* The lines along one axis: of all quantities the one at the finest size of the other axis. */
static void add_panel(struct br_figure *f, const struct br_orders *o, enum br_axis axis)
{
    static const char *const labels[] = {"mesh size h", "time step k"};
    double slope[3];
    size_t slopes = 0;
    struct br_panel *p = br_panel_add(f, labels[axis], "error, or difference of values");
    p->log_x = p->log_y = true;
    for (size_t i = 0; i < o->count; i++) {
        const struct br_orders_line *finest = NULL;
        for (size_t l = 0; l < o->of[i].lines; l++)
            finest = o->of[i].line[l].axis == axis ? &o->of[i].line[l] : finest;
        if (!finest)
            continue;
        add_line(f, o, &o->of[i], finest);
        if (*finest->at)
            BR_SAY(p->title, "at %s", finest->at);
        const double order = round(finest->observed.order.value);
        bool known = slopes == 3 || !(order >= 1);
        for (size_t s = 0; s < slopes; s++)
            known |= slope[s] == order;
        if (!known)
            slope[slopes++] = order;
    }
    for (size_t i = 1; i < slopes; i++)
        for (size_t j = i; j > 0 && slope[j] < slope[j - 1]; j--) {
            const double larger = slope[j - 1];
            slope[j - 1] = slope[j];
            slope[j] = larger;
        }
    if (slopes)
        br_slopes_add(f, slopes, slope);
}

/* Where runs were timed: errors over processor time. */
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
        char quoted[400];
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

static bool has_line(const struct br_orders *o, enum br_axis axis)
{
    for (size_t i = 0; i < o->count; i++)
        for (size_t l = 0; l < o->of[i].lines; l++)
            if (o->of[i].line[l].axis == axis)
                return true;
    return false;
}

struct br_figure br_orders_draw(const struct br_orders *orders, const char *caption)
{
    struct br_figure f = {0};
    BR_SAY(f.stem, "orders");
    BR_SAY(f.title, "%s", caption);
    BR_SAY(f.about, "errors over the size of elements and of steps");
    BR_SAY(f.hollow, "left out of the order");
    for (int axis = 0; axis < BR_AXES; axis++)
        if (has_line(orders, (enum br_axis)axis))
            add_panel(&f, orders, (enum br_axis)axis);
    add_costs(&f, orders);
    return f;
}
