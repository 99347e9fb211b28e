/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Errors of any program, or values with their limits, over the size of elements or steps. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/quote.h"
#include "base/words.h"
#include "orders/orders.h"
#include "plots/pictures.h"

enum { MARKUP = 90, TITLE = sizeof((struct br_series *)0)->title };

/* A foreign name as markup. */
static const char *name_of(const char *name, char markup[MARKUP])
{
    return br_quoted(markup, MARKUP, &br_for_markup, br_short_name(name, (char[BR_SHORT_NAME]){0}));
}

/* "2.00 [1.99, 2.01]": what is found of the order along an axis. */
static const char *order_of(const struct br_quantity_orders *of, enum br_axis axis, char text[96])
{
    const struct br_orders_line *line = br_orders_finest(of, axis);
    const struct br_estimate *order = &of->answer[axis].order;
    if (order->low > 0 && isfinite(order->value))
        return br_order_text(order, text, 64);
    if (!line || !isfinite(line->observed.factor.low))
        return "not measurable";
    br_order_text(&line->observed.factor, stpcpy(text, "exponential, by "), 64);
    return text;
}

/* Appends "p = 1.91, GCI 0.03 %, limit 24.94 [24.93, 24.95]". g: NULL, of a grid. */
static void say_value(const struct br_gci *g, const struct br_grid_limit *limit, char *text,
                      size_t size)
{
    char number[128];
    if (g && isfinite(g->fine.index))
        br_append(text, size, "p = %.2f, GCI %.2g %%, ", g->order, 100 * g->fine.index);
    if (isfinite(limit->value.low))
        br_append(text, size, "limit %s", br_interval_text(&limit->value, number, sizeof number));
    else
        br_append(text, size, limit->sequence ? "no limit: %s" : "limit %s",
                  br_sequence_text(limit->sequence));
}

/* "l2: 2.00 [1.99, 2.01]", of two axes "l2: h 2.00 [1.99, 2.01], k 1.00 [0.99, 1.01]": one title in
 * all panels, so that the quantity has one hue. Plain. */
static const char *title_of(const struct br_orders *o, const struct br_quantity_orders *of,
                            char title[TITLE])
{
    char text[96];
    const char *between = ": ";
    const bool both = br_orders_finest(of, BR_AXIS_SPACE) && br_orders_finest(of, BR_AXIS_TIME);
    br_short_name(br_quantity_of(o, of)->name, title);
    if (br_quantity_of(o, of)->is_value) {
        say_value(of->lines == 1 ? &of->line->limits.gci : NULL, &of->limit, strcat(title, ": "),
                  TITLE);
        return title;
    }
    for (enum br_axis axis = 0; axis < BR_AXES; axis++)
        if (br_orders_finest(of, axis)) {
            br_append(title, TITLE, "%s%s%s%s", between, both ? br_axis_letters[axis] : "",
                      both ? " " : "", order_of(of, axis, text));
            between = ", ";
        }
    return title;
}

/* Adds the numbers beside a line that are left out by hand. */
static void add_by_hand(struct br_series *marks, const struct br_orders *o,
                        const struct br_quantity_orders *of, const struct br_orders_line *line)
{
    const struct br_numbers_row *on = &o->numbers->row[line->row[0]];
    const bool alone = o->tied || !o->numbers->column[!line->axis];
    for (size_t i = 0; i < o->numbers->rows; i++) {
        const struct br_numbers_row *row = &o->numbers->row[i];
        if (row->out[of->quantity] == BR_FLAG_BY_HAND && isfinite(row->number[of->quantity]) &&
            (alone || row->z[!line->axis] == on->z[!line->axis]))
            br_point_add(marks, row->z[line->axis], row->number[of->quantity],
                         br_flag_name(BR_FLAG_BY_HAND));
    }
}

struct br_series *br_points_draw(struct br_figure *f, const char *title,
                                 const struct br_point *point, size_t count, bool fitted)
{
    struct br_series *area = fitted ? br_series_add(f, BR_PEN_AREA, "%s", title) : NULL;
    struct br_series *line = fitted ? br_series_add(f, BR_PEN_LINE, "%s", title) : NULL;
    struct br_series *marks = br_series_add(f, fitted ? BR_PEN_MARKS : BR_PEN_CURVE, "%s", title);
    for (const struct br_point *p = point; p < point + count; p++)
        br_point_add(marks, p->z, p->flag == BR_FLAG_FAILED ? (double)NAN : p->error,
                     p->flag ? br_flag_name(p->flag) : NULL);
    for (size_t i = 0; i < 2 * count && fitted; i++) { /* the band goes back along its upper end */
        const struct br_point *p = &point[i < count ? i : 2 * count - 1 - i];
        if (i < count)
            br_point_add(line, p->z, p->fit.value, NULL);
        br_point_add(area, p->z, i < count ? p->fit.low : p->fit.high, NULL);
    }
    return marks;
}

/* The errors, with the line of their order and its band; those of a joint fit, which is no line,
 * are joined. Returns the errors. */
static const struct br_series *add_line(struct br_figure *f, const struct br_orders *o,
                                        const struct br_quantity_orders *of,
                                        const struct br_orders_line *line)
{
    char title[TITLE], name[TITLE];
    const struct br_case *c = &line->observed;
    const bool fitted = c->points && isfinite(c->point[0].fit.value);
    br_quoted(name, sizeof name, &br_for_markup, title_of(o, of, title));
    struct br_series *marks = br_points_draw(f, name, c->point, c->points, fitted);
    add_by_hand(marks, o, of, line);
    br_series_sort(marks);
    return marks;
}

/* "mesh size h = 1/n"; a size has the unit of the source, too. */
static void name_axis(const struct br_numbers *numbers, enum br_axis axis, char label[96])
{
    const struct br_resolution_column *column = numbers->column[axis];
    const char *unit = column->is_size ? numbers->unit[axis] : NULL;
    char states[MARKUP], name[MARKUP + 16];
    name_of(column->is_degree ? "1/(degree + 1)" : column->states, states);
    snprintf(name, sizeof name, "%s %s", axis == BR_AXIS_SPACE ? "mesh size" : "time step", states);
    br_label_set(label, name, unit);
}

/* The order of a triangle: a half or whole one where that is near. */
static double slope_of(double order)
{
    const double half = round(2 * order) / 2;
    return fabs(order - half) < 0.15 ? half : round(10 * order) / 10;
}

/* The lines of errors along one axis: for each quantity the one at the finest size of the other
 * axis. Of each order one line has its triangle. */
static void add_errors(struct br_figure *f, const struct br_orders *o, enum br_axis axis)
{
    const struct br_series *line[BR_HUES];
    double order[BR_HUES];
    size_t lines = 0;
    struct br_panel *p = NULL;
    const char *common = NULL;
    for (size_t i = 0; i < o->count; i++) {
        const struct br_orders_line *finest = br_orders_finest(&o->of[i], axis);
        const char *unit = o->numbers->quantity[o->of[i].quantity].unit;
        char x[96];
        if (!finest || br_quantity_of(o, &o->of[i])->is_value)
            continue;
        if (!p) {
            name_axis(o->numbers, axis, x);
            p = br_panel_add(f, true, x, "%s", "");
            br_label_set(p->y_label, "error", unit);
            common = unit;
        }
        if (!common || !unit || strcmp(common, unit) != 0)
            BR_SAY(p->y_label, "error"); /* not all have the same unit */
        const struct br_series *marks = add_line(f, o, &o->of[i], finest);
        if (marks->pen == BR_PEN_OTHERS && axis == o->of[i].line[0].axis)
            br_append(f->note[1], sizeof f->note[1], "%s%s",
                      f->note[1][0] ? "; " : "Grey: ", title_of(o, &o->of[i], (char[TITLE]){0}));
        if (*finest->at)
            BR_SAY(p->title, "at %s", finest->at);
        if (lines < BR_HUES) {
            order[lines] = slope_of(o->of[i].answer[axis].order.value);
            line[lines++] = marks;
        }
    }
    for (size_t i = 0; i < lines; i++)
        br_slope_add(f, line[i], order[i]);
}

/* ---- values ---- */

/* The bar of an interval; an end that is far from the values has no cap. */
static void add_bar(struct br_figure *f, double x, double half, const struct br_range *values,
                    double low, double high)
{
    const double far = fmax(values->high - values->low, 0.01 * fabs(values->high));
    const double ends[] = {fmax(low, values->low - far), fmin(high, values->high + far)};
    struct br_series *bar = br_series_add(f, BR_PEN_THIN, "%s", "");
    for (int i = 0; i < 2; i++) {
        const double cap = ends[i] == (i ? high : low) ? half : 0;
        br_point_add(bar, i ? x : x - cap, ends[i], NULL);
        br_point_add(bar, x + cap, ends[i], NULL);
        br_point_add(bar, i ? x - cap : x, ends[i], NULL);
    }
}

/* The curve through the three finest values, which ends at their limit, as the grid convergence
 * index takes it. */
static void add_curve(struct br_figure *f, const struct br_gci *g, double h, double value,
                      double end, const char *title)
{
    enum { PIECES = 60 };
    struct br_series *s = br_series_add(f, BR_PEN_LINE, "%s", title);
    for (int i = 0; i <= PIECES; i++) {
        const double x = end * pow((double)i / PIECES, fmax(1, 1 / g->order));
        br_point_add(s, x, g->fine.limit + (value - g->fine.limit) * pow(x / h, g->order), NULL);
    }
}

/* A value over the size, its limit with the interval at 0, and at the finest size its GCI. */
static void add_value(struct br_figure *f, const struct br_orders *o,
                      const struct br_quantity_orders *of, const struct br_orders_line *line)
{
    const struct br_quantity *q = br_quantity_of(o, of);
    const struct br_gci *g = &line->limits.gci;
    const struct br_estimate *limit = &line->limits.limit.value;
    const size_t rows = line->observed.points + 1;
    const struct br_numbers_row *row = o->numbers->row, *finest = NULL;
    char name[MARKUP], x[96];
    double end = 0;
    name_of(q->name, name);
    name_axis(o->numbers, line->axis, x);
    struct br_panel *p = br_panel_add(f, false, x, "%s", "");
    br_label_set(p->y_label, name, q->unit);
    if (*line->at)
        BR_SAY(p->title, "at %s: ", line->at);
    say_value(g, &line->limits.limit, p->title, sizeof p->title);
    const bool curve = g->sequence == BR_MONOTONE_CONVERGENCE && isfinite(limit->low);
    p->margins = true;
    struct br_series *marks = br_series_add(f, curve ? BR_PEN_MARKS : BR_PEN_CURVE, "%s", name);
    for (size_t i = 0; i < rows; i++) {
        const struct br_numbers_row *at = &row[line->row[i]];
        br_point_add(marks, at->z[line->axis], at->number[of->quantity], NULL);
        finest = isfinite(at->number[of->quantity]) ? at : finest;
        end = fmax(end, at->z[line->axis]);
    }
    const struct br_range values = br_extent(p, true);
    add_by_hand(marks, o, of, line);
    if (!finest)
        return;
    const double h = finest->z[line->axis], value = finest->number[of->quantity];
    if (curve)
        add_curve(f, g, h, value, end, name);
    if (isfinite(g->fine.uncertainty)) {
        br_series_add(f, BR_PEN_THIN, "GCI of the finest value");
        add_bar(f, h, 0.015 * end, &values, value - g->fine.uncertainty,
                value + g->fine.uncertainty);
    }
    if (isfinite(limit->low)) {
        br_point_add(br_series_add(f, BR_PEN_RINGS, "limit, with its 95 %% interval"), 0,
                     limit->value, NULL);
        add_bar(f, 0, 0.015 * end, &values, limit->low, limit->high);
    }
}

/* "Order of l2: 2.00 [1.99, 2.01]; h1: 1.000 [0.999, 1.001]", "drag: p = 1.91, ...". */
static void say_title(const struct br_orders *o, char *title, size_t size)
{
    enum { MOST = 2, LETTERS = 80 }; /* quantities; beyond these the title's letters are small */
    char text[TITLE];
    size_t said = 0, left = 0;
    for (size_t i = 0; i < o->count; i++) {
        const struct br_quantity_orders *of = &o->of[i];
        const char *before = br_quantity_of(o, of)->is_value ? "" : "Order of ";
        if (!of->lines)
            continue;
        title_of(o, of, text);
        if (said == MOST || (said && strlen(title) + strlen(text) > LETTERS)) {
            left++;
            continue;
        }
        br_append(title, size, "%s%s", said++ ? "; " : before, text);
    }
    br_append(title, size, "%s", left ? "; ..." : "");
}

struct br_figure br_orders_draw(const struct br_orders *orders, const char *caption)
{
    struct br_figure f = {0};
    BR_SAY(f.stem, "orders");
    BR_SAY(f.note[0], "%s", caption);
    BR_SAY(f.about, "errors, or values, over the size of elements and of steps");
    BR_SAY(f.hollow, "left out of the order");
    say_title(orders, f.title, sizeof f.title);
    if (orders->numbers->quantity->window) /* of all quantities, but for numbers of sizes */
        br_append(f.note[0], sizeof f.note[0], "; rows by hand: %s",
                  orders->numbers->quantity->window);
    for (enum br_axis axis = 0; axis < BR_AXES; axis++)
        add_errors(&f, orders, axis);
    for (size_t i = 0; i < orders->count; i++)
        for (enum br_axis axis = 0; axis < BR_AXES && f.panels < BR_FIGURE_PANELS; axis++) {
            const struct br_orders_line *line = br_orders_finest(&orders->of[i], axis);
            if (line && br_quantity_of(orders, &orders->of[i])->is_value)
                add_value(&f, orders, &orders->of[i], line);
        }
    if (f.panels == 1 && !f.panel[0].log_x)
        f.panel[0].title[0] = '\0'; /* the figure has it */
    return f;
}
