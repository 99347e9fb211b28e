/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plots/pictures.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "base/quote.h"

char *br_short_name(const char *name, char text[BR_SHORT_NAME])
{
    const bool whole = strlen(name) < BR_SHORT_NAME;
    int most = BR_SHORT_NAME - 4;
    while (!whole && most > 0 && ((unsigned char)name[most] & 0xc0) == 0x80)
        most--;
    snprintf(text, BR_SHORT_NAME, "%.*s%s", whole ? BR_SHORT_NAME : most, name, whole ? "" : "...");
    return text;
}

void br_label_set(char label[96], const char *name, const char *unit)
{
    char text[BR_SHORT_NAME], markup[80];
    if (unit && *unit)
        snprintf(label, 96, "%.60s (%.32s)", name,
                 br_quoted(markup, sizeof markup, &br_for_markup, br_short_name(unit, text)));
    else
        snprintf(label, 96, "%s", name);
}

static struct br_panel *last_panel(struct br_figure *f)
{
    return &f->panel[f->panels - 1];
}

struct br_panel *br_panel_add(struct br_figure *f, bool logarithmic, const char *x_label,
                              const char *y_label, ...)
{
    struct br_panel *p = &f->panel[f->panels++];
    va_list arguments;
    BR_SAY(p->x_label, "%s", x_label);
    va_start(arguments, y_label);
    vsnprintf(p->y_label, sizeof p->y_label, y_label, arguments);
    va_end(arguments);
    p->log_x = p->log_y = logarithmic;
    return p;
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

void br_series_stairs(struct br_series *s)
{
    size_t kept = 0;
    br_series_sort(s);
    for (size_t i = 0; i < s->count; i++)
        if (!kept || s->point[i].y < s->point[kept - 1].y)
            s->point[kept++] = s->point[i];
    s->count = kept;
    s->stairs = true;
}

void br_mark_add(struct br_figure *f, double x, const char *title)
{
    const struct br_range y = br_extent(last_panel(f), true);
    struct br_series *s = br_series_add(f, BR_PEN_GUIDE, "%s", title);
    br_point_add(s, x, y.low, NULL);
    br_point_add(s, x, y.high, NULL);
}

/* ---- triangles of orders, in shares of the panel: 0 to 1 along its logarithmic axes ---- */

struct box {
    double left, right, low, high;
};

/* log y of a series at x, both in shares of the panel; NaN: it is not there. */
static double height_at(const struct br_panel *p, const struct br_series *s, double x)
{
    const struct br_range across = br_extent(p, false), up = br_extent(p, true);
    const double at = across.low * pow(across.high / across.low, x);
    for (size_t i = 1; i < s->count; i++) {
        const struct br_figure_point *a = &s->point[i - 1], *b = &s->point[i];
        if (!br_is_drawn(p, a) || !br_is_drawn(p, b) || (a->x < at) == (b->x < at))
            continue;
        const double y = a->y * pow(b->y / a->y, log(at / a->x) / log(b->x / a->x));
        return log(y / up.low) / log(up.high / up.low);
    }
    return NAN;
}

/* Whether a series comes near a triangle in the box; the triangle is below its own series, or
 * above. own: at its sides; else also beside them, where the triangle has its number. */
static bool is_near(const struct br_panel *p, const struct br_series *s, const struct box *b,
                    bool below, bool own)
{
    enum { LOOKS = 60 };
    const double more = 0.03, number = 0.09;
    const double from = b->left - (own ? 0 : below ? more : number);
    const double to = b->right + (own ? 0 : below ? number : more);
    for (int i = 0; i <= LOOKS; i++) {
        const double x = from + (to - from) * i / LOOKS, y = height_at(p, s, x);
        const double share = fmin(fmax((x - b->left) / (b->right - b->left), 0), 1);
        const double side = b->low + (b->high - b->low) * share;
        const bool over = y >= (below ? side : b->high) + more;
        const bool under = y <= (below ? b->low : side) - more;
        if (!isnan(y) && !over && !under)
            return true;
    }
    return false;
}

/* Whether a series, or its triangle, is in the way. */
static bool is_taken(const struct br_panel *p, const struct br_series *own, const struct box *b,
                     bool below)
{
    for (size_t i = 0; i < p->count; i++) {
        const struct br_series *s = p->series[i];
        if (s->pen != BR_PEN_AREA && is_near(p, s, b, below, strcmp(s->title, own->title) == 0))
            return true;
    }
    return b->left < 0.01 || b->right > 0.99;
}

/* Draws the legs on the side of the box that is away from the series. */
static void add_triangle(struct br_figure *f, const struct box *b, bool below, double order)
{
    const struct br_panel *p = last_panel(f);
    const struct br_range x = br_extent(p, false), y = br_extent(p, true);
    const double leg = below ? b->right : b->left, base = below ? b->low : b->high;
    const double corners[][2] = {{leg, (b->low + b->high) / 2},
                                 {leg, base},
                                 {below ? b->left : b->right, base},
                                 {leg, below ? b->high : b->low},
                                 {leg, (b->low + b->high) / 2}};
    struct br_series *s = br_series_add(f, BR_PEN_THIN, "%s", "");
    BR_SAY(s->end, "%g", order);
    s->end_left = !below;
    for (size_t i = 0; i < sizeof corners / sizeof *corners; i++)
        br_point_add(s, x.low * pow(x.high / x.low, corners[i][0]),
                     y.low * pow(y.high / y.low, corners[i][1]), NULL);
}

bool br_slope_add(struct br_figure *f, const struct br_series *along, double order)
{
    static const double places[] = {0.62, 0.38, 0.74, 0.26, 0.5, 0.86, 0.14};
    const struct br_panel *p = last_panel(f);
    const struct br_range x = br_extent(p, false), y = br_extent(p, true);
    char end[sizeof along->end];
    BR_SAY(end, "%g", order);
    for (size_t i = 0; i < p->count; i++)
        if (p->series[i]->pen == BR_PEN_THIN && strcmp(p->series[i]->end, end) == 0)
            return false;
    if (!(x.low < x.high && y.low < y.high && order > 0))
        return false;
    const double steep = order * log(x.high / x.low) / log(y.high / y.low); /* high over wide */
    const double width = fmin(0.13, 0.2 / steep), high = width * steep, away = 0.045;
    for (size_t i = 0; i < 2 * sizeof places / sizeof *places && high > 0.025; i++) {
        const bool below = i % 2 == 0;
        const double middle = places[i / 2];
        const double low = height_at(p, along, middle) - high / 2 + (below ? -away : away);
        const struct box b = {middle - width / 2, middle + width / 2, low, low + high};
        if (!isfinite(low) || is_taken(p, along, &b, below))
            continue;
        add_triangle(f, &b, below, order);
        return true;
    }
    return false;
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
