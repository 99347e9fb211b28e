/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plots/pictures.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "base/quote.h"

static struct br_panel *last_panel(struct br_figure *f)
{
    return &f->panel[f->panels - 1];
}

struct br_panel *br_panel_add(struct br_figure *f, const char *x_label, const char *y_label)
{
    f->panels++;
    BR_SAY(last_panel(f)->x_label, "%s", x_label);
    BR_SAY(last_panel(f)->y_label, "%s", y_label);
    return last_panel(f);
}

/* Whether series of the two pens must differ in style. */
static bool are_akin(enum br_pen a, enum br_pen b)
{
    return a == b || (a <= BR_PEN_LINE && b <= BR_PEN_LINE);
}

/* Takes the style of the series with the same title, else a new one; without a title the first. */
static void find_style(const struct br_figure *f, enum br_pen pen, struct br_series *new)
{
    size_t last = 0;
    for (size_t i = 0; i < f->panels; i++)
        for (size_t j = 0; j < f->panel[i].count; j++) {
            const struct br_series *s = f->panel[i].series[j];
            if (are_akin(s->pen, pen) && strcmp(s->title, new->title) == 0) {
                new->style = s->style;
                return;
            }
            last = are_akin(s->pen, pen) && s->style > last ? s->style : last;
        }
    new->in_key = new->title[0];
    new->style = new->in_key ? last + 1 : 1;
}

struct br_series *br_series_add(struct br_figure *f, enum br_pen pen, const char *title, ...)
{
    struct br_panel *p = last_panel(f);
    struct br_series *s = NULL;
    if (br_grow(&p->series, p->count, &p->room, sizeof *p->series))
        s = br_allocate(1, sizeof *s);
    if (!s) {
        f->failed = f->lost.failed = true;
        return &f->lost;
    }
    va_list arguments;
    va_start(arguments, title);
    vsnprintf(s->title, sizeof s->title, title, arguments);
    va_end(arguments);
    find_style(f, pen, s);
    s->pen = pen <= BR_PEN_LINE && s->style > BR_HUES ? BR_PEN_OTHERS : pen;
    return p->series[p->count++] = s;
}

void br_point_add(struct br_series *s, double x, double y, const char *flag)
{
    if (s->failed)
        return;
    s->failed = !br_grow(&s->point, s->count, &s->room, sizeof *s->point);
    if (!s->failed)
        s->point[s->count++] = (struct br_figure_point){x, y, flag};
}

struct br_fitted_series br_fitted_series_add(struct br_figure *f, const char *title)
{
    return (struct br_fitted_series){.area = br_series_add(f, BR_PEN_AREA, "%s", title),
                                     .line = br_series_add(f, BR_PEN_LINE, "%s", title),
                                     .marks = br_series_add(f, BR_PEN_MARKS, "%s", title)};
}

void br_fitted_point_add(const struct br_fitted_series *s, double x, double y, const char *flag,
                         double fit, double low)
{
    br_point_add(s->marks, x, y, flag);
    br_point_add(s->line, x, fit, NULL);
    br_point_add(s->area, x, low, NULL);
}

static int compare(const void *a, const void *b)
{
    const struct br_figure_point *p = a, *q = b;
    if (p->x != q->x)
        return p->x < q->x ? -1 : 1;
    return (p->y > q->y) - (p->y < q->y);
}

void br_series_sort(struct br_series *s)
{
    if (s->count)
        qsort(s->point, s->count, sizeof *s->point, compare);
}

void br_mark_add(struct br_figure *f, double x, const char *title)
{
    const struct br_range y = br_extent(last_panel(f), true);
    struct br_series *s = br_series_add(f, BR_PEN_GUIDE, "%s", title);
    br_point_add(s, x, y.low, NULL);
    br_point_add(s, x, y.high, NULL);
}

size_t br_slope_put(double *slope, size_t count, double order)
{
    size_t at = 0;
    while (at < count && slope[at] < order)
        at++;
    if (at < count && slope[at] == order)
        return count;
    memmove(slope + at + 1, slope + at, (count - at) * sizeof *slope);
    slope[at] = order;
    return count + 1;
}

/* Adds lines that rise from one point. They take at most two fifths of the panel's height, and a
 * fifth of its width. */
void br_slopes_add(struct br_figure *f, size_t count, const double *order)
{
    const struct br_range x = br_extent(last_panel(f), false), y = br_extent(last_panel(f), true);
    if (!(x.low < x.high && y.low < y.high) || !count)
        return;
    const double width =
        fmin(0.2 * log(x.high / x.low), 0.4 * log(y.high / y.low) / order[count - 1]);
    const double left = x.high * pow(x.high / x.low, 0.06);
    for (size_t i = 0; i < count; i++) {
        struct br_series *s = br_series_add(f, BR_PEN_GUIDE, "%s", "");
        BR_SAY(s->end, "%g", order[i]);
        br_point_add(s, left, y.low, NULL);
        br_point_add(s, left * exp(width), y.low * exp(width * order[i]), NULL);
    }
}

bool br_is_drawn(const struct br_panel *panel, const struct br_figure_point *p)
{
    return isfinite(p->x) && isfinite(p->y) && (p->x > 0 || !panel->log_x) &&
           (p->y > 0 || !panel->log_y);
}

struct br_range br_extent(const struct br_panel *p, bool along_y)
{
    struct br_range r = {INFINITY, -INFINITY};
    for (size_t j = 0; j < p->count; j++)
        for (size_t k = 0; k < p->series[j]->count; k++) {
            const struct br_figure_point *at = &p->series[j]->point[k];
            if (!br_is_drawn(p, at) || p->series[j]->pen == BR_PEN_AREA)
                continue;
            r.low = fmin(r.low, along_y ? at->y : at->x);
            r.high = fmax(r.high, along_y ? at->y : at->x);
        }
    return r;
}

enum br_status br_figure_check(const struct br_figure *f, struct br_error *err)
{
    bool failed = f->failed;
    if (f->stem[0] && !br_is_name(f->stem))
        return br_fail(err, BR_BAD_INPUT,
                       "a figure's name is \"%s\", expected the beginning of a file name", f->stem);
    for (size_t i = 0; i < f->panels; i++) {
        failed |= f->panel[i].top.failed;
        for (size_t j = 0; j < f->panel[i].count; j++)
            failed |= f->panel[i].series[j]->failed;
    }
    return failed ? br_no_memory(err, "a figure") : BR_OK;
}

void br_figure_clear(struct br_figure *f)
{
    for (struct br_panel *p = f->panel; p < f->panel + f->panels; p++) {
        for (size_t j = 0; j < p->count; j++) {
            free(p->series[j]->point);
            free(p->series[j]);
        }
        free(p->series);
        free(p->top.point);
    }
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
        fprintf(out, "# A flag says why a point is %s; - for none.\n", f->hollow);
    for (size_t i = 0; i < f->panels; i++) {
        const struct br_panel *p = &f->panel[i];
        for (size_t j = 0; j < p->count; j++) {
            const struct br_series *s = p->series[j];
            if (!s->count)
                continue;
            fprintf(out, "\n# index %zu: %s; %s\n# %s | %s | flag\n", index++, p->title,
                    p->series[j]->title, p->x_label, p->y_label);
            for (const struct br_figure_point *at = s->point; at < s->point + s->count; at++) {
                write_number(out, at->x);
                write_number(out, br_is_drawn(p, at) ? at->y : NAN); /* NAN: a gap */
                fprintf(out, "%s\n", at->flag ? at->flag : "-");
            }
            fputs("\n\n", out);
        }
    }
}
