/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plots/figure.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "study/scene/quote.h"

/* Room for one more in an array (in/out: *array, *room); false: no memory. */
static bool grow(void *array, size_t count, size_t *room, size_t size)
{
    void **old = array;
    if (count < *room)
        return true;
    const size_t more = 2 * *room + 8;
    void *larger = br_allocate(more, size);
    if (!larger)
        return false;
    if (count)
        memcpy(larger, *old, count * size);
    free(*old);
    *old = larger;
    *room = more;
    return true;
}

struct br_panel *br_panel_add(struct br_figure *figure)
{
    return &figure->panel[figure->panels++];
}

static bool has_hue(enum br_pen pen)
{
    return pen == BR_PEN_CURVE || pen == BR_PEN_LINE;
}

/* The first hue that no series of the panel has; 0: none is left. */
static size_t free_hue(const struct br_panel *panel)
{
    for (size_t hue = 1; hue <= BR_HUES; hue++) {
        bool taken = false;
        for (size_t i = 0; i < panel->count; i++)
            taken |= has_hue(panel->series[i]->pen) && panel->series[i]->hue == hue;
        if (!taken)
            return hue;
    }
    return 0;
}

struct br_series *br_series_add(struct br_panel *panel, enum br_pen pen, const char *title, ...)
{
    struct br_series *s = NULL;
    if (grow(&panel->series, panel->count, &panel->room, sizeof *panel->series))
        s = br_allocate(1, sizeof *s);
    panel->failed |= !s;
    if (!s)
        return NULL;
    s->hue = has_hue(pen) ? free_hue(panel) : 0;
    s->pen = has_hue(pen) && !s->hue ? BR_PEN_OTHERS : pen;
    va_list arguments;
    va_start(arguments, title);
    vsnprintf(s->title, sizeof s->title, title, arguments);
    va_end(arguments);
    return panel->series[panel->count++] = s;
}

void br_point_add(struct br_series *s, double x, double y, const char *flag)
{
    if (!s || s->failed)
        return;
    s->failed = !grow(&s->point, s->count, &s->room, sizeof *s->point);
    if (!s->failed)
        s->point[s->count++] = (struct br_figure_point){x, y, flag};
}

struct br_mark *br_mark_add(struct br_panel *panel, double x, const char *label, ...)
{
    struct br_mark *mark = &panel->mark[panel->marks++];
    *mark = (struct br_mark){.x = x, .height = 0.5};
    va_list arguments;
    va_start(arguments, label);
    vsnprintf(mark->label, sizeof mark->label, label, arguments);
    va_end(arguments);
    return mark;
}

void br_guide_add(struct br_panel *panel, double order, const char *label)
{
    struct br_guide *guide = &panel->guide[panel->guides++];
    guide->order = order;
    BR_SAY(guide->label, "%s", label);
}

bool br_cells_make(struct br_panel *panel, size_t columns, size_t rows)
{
    struct br_cells *c = &panel->cells;
    *c = (struct br_cells){
        .columns = columns,
        .rows = rows,
        .x = br_allocate(columns + 1, sizeof *c->x),
        .y = br_allocate(rows + 1, sizeof *c->y),
        .value = br_allocate(rows * columns + 1, sizeof *c->value),
    };
    const bool made = c->x && c->y && c->value;
    panel->failed |= !made;
    for (size_t i = 0; made && i < rows * columns; i++)
        c->value[i] = NAN;
    return made;
}

size_t br_hue_of(size_t i, size_t count)
{
    if (count <= BR_HUES)
        return i + 1;
    for (size_t hue = 0; hue < BR_HUES; hue++)
        if (i == hue * (count - 1) / (BR_HUES - 1))
            return hue + 1;
    return 0;
}

bool br_is_drawn(const struct br_panel *panel, const struct br_figure_point *p)
{
    return isfinite(p->x) && isfinite(p->y) && (p->x > 0 || !panel->log_x) &&
           (p->y > 0 || !panel->log_y);
}

struct br_range br_value_range(const struct br_figure *f)
{
    struct br_range r = f->value;
    if (r.low < r.high)
        return r;
    r = (struct br_range){INFINITY, -INFINITY};
    for (size_t i = 0; i < f->panels; i++)
        for (size_t j = 0; j < f->panel[i].cells.rows * f->panel[i].cells.columns; j++) {
            const double v = f->panel[i].cells.value[j];
            if (!isfinite(v) || (f->log_value && !(v > 0)))
                continue;
            r.low = fmin(r.low, v);
            r.high = fmax(r.high, v);
        }
    if (!(r.low <= r.high))
        r.low = r.high = 1; /* no cell has a colour */
    if (r.low < r.high)
        return r;
    return f->log_value ? (struct br_range){r.low / 10, r.high * 10}
                        : (struct br_range){r.low - 1, r.high + 1};
}

bool br_is_coloured(const struct br_figure *f, double value)
{
    return f->kinds ? value >= 0 && value < (double)f->kinds : !isnan(value);
}

enum br_status br_figure_check(const struct br_figure *f, struct br_error *err)
{
    bool failed = false;
    for (size_t i = 0; i < f->panels; i++) {
        const struct br_panel *p = &f->panel[i];
        failed |= p->failed || p->top.failed;
        for (size_t j = 0; j < p->count; j++)
            failed |= p->series[j]->failed;
    }
    return failed ? br_no_memory(err, "a figure") : BR_OK;
}

static void clear_panel(struct br_panel *p)
{
    for (size_t j = 0; j < p->count; j++) {
        free(p->series[j]->point);
        free(p->series[j]);
    }
    free(p->series);
    free(p->top.point);
    free(p->cells.x);
    free(p->cells.y);
    free(p->cells.value);
}

void br_figure_clear(struct br_figure *f)
{
    for (size_t i = 0; i < f->panels; i++)
        clear_panel(&f->panel[i]);
    *f = (struct br_figure){0};
}

/* ---- the data file ---- */

static void write_number(FILE *out, double value)
{
    if (isfinite(value))
        fprintf(out, "%.17g ", value);
    else
        fputs(isnan(value) ? "NaN " : value > 0 ? "Inf " : "-Inf ", out);
}

static double middle(double a, double b, bool logarithmic)
{
    return logarithmic ? sqrt(a) * sqrt(b) : (a + b) / 2;
}

static void write_cells(FILE *out, const struct br_figure *f, const struct br_panel *p)
{
    const struct br_cells *c = &p->cells;
    const struct br_range r = br_value_range(f);
    for (size_t i = 0; i < c->rows; i++)
        for (size_t j = 0; j < c->columns; j++) {
            const double v = c->value[i * c->columns + j];
            write_number(out, middle(c->x[j], c->x[j + 1], p->log_x));
            write_number(out, middle(c->y[i], c->y[i + 1], p->log_y));
            write_number(out, c->x[j]);
            write_number(out, c->x[j + 1]);
            write_number(out, c->y[i]);
            write_number(out, c->y[i + 1]);
            write_number(out, v);
            write_number(out, isnan(v) || f->kinds ? v : fmin(fmax(v, r.low), r.high));
            fprintf(out, "%d\n", br_is_coloured(f, v));
        }
}

/* What cannot be drawn is a gap. */
static void write_points(FILE *out, const struct br_panel *p, const struct br_series *s)
{
    for (size_t k = 0; k < s->count; k++) {
        const struct br_figure_point *at = &s->point[k];
        write_number(out, at->x);
        write_number(out, br_is_drawn(p, at) ? at->y : NAN);
        fprintf(out, "%s\n", at->flag ? at->flag : "-");
    }
}

static void write_comment_line(FILE *out, const char *text)
{
    fputs("# ", out);
    br_write_comment(out, text);
}

void br_figure_write_data(FILE *out, const struct br_figure *f)
{
    size_t index = 0;
    fputs("# SPDX-License-Identifier: GPL-3.0-or-later\n", out);
    write_comment_line(out, f->title);
    if (f->about[0])
        write_comment_line(out, f->about);
    if (f->hollow[0])
        fprintf(out, "# A flag tells why a point is %s; - for none.\n", f->hollow);
    for (size_t k = 0; k < f->kinds; k++)
        fprintf(out, "# value %zu: %s\n", k, f->kind[k]);
    for (size_t i = 0; i < f->panels; i++) {
        const struct br_panel *p = &f->panel[i];
        if (p->cells.columns) {
            fprintf(out,
                    "\n# index %zu: %s; cells: x, y, x from, to, y from, to, value, its colour, "
                    "whether it has one\n# %s | %s\n",
                    index++, p->title, p->x_label, p->y_label);
            write_cells(out, f, p);
            fputs("\n\n", out);
        }
        for (size_t j = 0; j < p->count; j++) {
            if (!p->series[j]->count)
                continue;
            fprintf(out, "\n# index %zu: %s; %s\n# %s | %s | flag\n", index++, p->title,
                    p->series[j]->title, p->x_label, p->y_label);
            write_points(out, p, p->series[j]);
            fputs("\n\n", out);
        }
    }
}
