/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Colours: six hues that the colour-blind can tell apart (Okabe and Ito, 2008), each with a dash
 * and a mark of its own. */
#include "plots/layout.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

enum {
    NARROW = 1200,
    WIDE = 1500,
    ONE_ROW = 800,
    TWO_ROWS = 1250,
    LINE = 33,   /* of small text */
    LETTER = 12, /* about as wide is a small one */
    SAMPLE = 85  /* of a key's entry, with the space beside it */
};

/* ---- pens ---- */

static const struct {
    const char *colour, *dash;
    int mark; /* filled; hollow is one less */
} hues[BR_HUES + 1] = {{"#000000", "solid", 7},         {"#0072b2", "solid", 7},
                       {"#d55e00", "(12,4)", 5},        {"#009e73", "(4,3)", 9},
                       {"#cc79a7", "(12,4,3,4)", 13},   {"#e69f00", "(20,5)", 11},
                       {"#56b4e9", "(8,3,2,3,2,3)", 15}};

/* Of pens without a hue. */
static const char *const styles[BR_PENS] = {
    [BR_PEN_OTHERS] = "lines lw 1.5 lc rgb '#b0b0b0' dt solid",
    [BR_PEN_BAND] = "lines lw 12 lc rgb '#dcdcdc'",
    [BR_PEN_DOTS] = "points pt 7 ps 0.45*size lc rgb '#9a9a9a'",
    [BR_PEN_RINGS] = "points pt 6 ps 1.5*size lw 2 lc rgb '#222222'",
    [BR_PEN_SQUARES] = "points pt 4 ps 2.6*size lw 2 lc rgb '#000000'",
    [BR_PEN_PLUSES] = "points pt 1 ps 1.1*size lw 2 lc rgb '#707070'",
    [BR_PEN_STARS] = "points pt 3 ps 1.5*size lw 1.5 lc rgb '#707070'",
};
static const char *const guide_dashes[] = {"(9,5)", "(12,4,2,4)", "(3,3)", "(20,5)"};

/* Verdicts: what matters is dark, what is right is pale; also in grey. */
const char *const br_kind_colours[BR_FIGURE_KINDS] = {"#cce5f5", "#e69f00", "#d55e00", "#cc79a7",
                                                      "#0072b2", "#f0e442", "#000000", "#009e73"};

const char br_empty_style[] = "lc rgb '#aaaaaa' fs pattern 4 border";

/* Marks shrink, so that curves that lie on one another can still be told apart. pi -1: the line
 * leaves room for the marks. */
void br_write_styles(FILE *out)
{
    for (int i = 1; i <= BR_HUES; i++)
        fprintf(out, "set style line %d lw 2.5 lc rgb '%s' dt %s pt %d ps %.2f*size pi -1\n", i,
                hues[i].colour, hues[i].dash, hues[i].mark, 2.8 - 0.22 * i);
}

int br_mark_of(const struct br_series *s)
{
    return hues[s->mark ? s->mark : s->hue].mark;
}

const char *br_pen_of(const struct br_panel *p, const struct br_series *s, char style[BR_STYLE])
{
    size_t before = 0;
    for (size_t j = 0; j < p->count && p->series[j] != s; j++)
        before += p->series[j]->pen == BR_PEN_GUIDE;
    const int mark = br_mark_of(s);
    if (s->pen == BR_PEN_CURVE)
        snprintf(style, BR_STYLE, "linespoints ls %zu pt %d", s->hue, mark);
    else if (s->pen == BR_PEN_LINE)
        snprintf(style, BR_STYLE, "lines ls %zu", s->hue);
    else if (s->pen == BR_PEN_SIGNS)
        snprintf(style, BR_STYLE, "points pt %d ps 1.8*size lc rgb '#444444'", mark);
    else if (s->pen == BR_PEN_GUIDE)
        snprintf(style, BR_STYLE, "lines lw 2.5 lc rgb '#333333' dt %s", guide_dashes[before % 4]);
    else
        snprintf(style, BR_STYLE, "%s", styles[s->pen]);
    return style;
}

struct br_seen br_look_at(const struct br_panel *p, const struct br_series *s)
{
    struct br_seen seen = {false, false};
    for (size_t k = 0; k < s->count; k++) {
        const bool drawn = br_is_drawn(p, &s->point[k]);
        seen.drawn |= drawn;
        seen.flagged |= drawn && s->point[k].flag;
    }
    return seen;
}

/* ---- ranges ---- */

double br_decades(struct br_range r)
{
    return log10(r.high / r.low);
}

/* Widens a range to what is drawn of the series along x or y. */
static void include(const struct br_panel *p, bool along_y, struct br_range *r)
{
    for (size_t j = 0; j < p->count; j++)
        for (size_t k = 0; k < p->series[j]->count; k++) {
            const struct br_figure_point *at = &p->series[j]->point[k];
            if (!br_is_drawn(p, at))
                continue;
            r->low = fmin(r->low, along_y ? at->y : at->x);
            r->high = fmax(r->high, along_y ? at->y : at->x);
        }
}

/* A range with some room at its ends, but not where the panel says otherwise. */
static struct br_range axis_range(const struct br_figure *f, const struct br_panel *p, bool along_y)
{
    const bool logarithmic = along_y ? p->log_y : p->log_x;
    const struct br_range given = along_y ? p->y : p->x;
    struct br_range r = {INFINITY, -INFINITY};
    for (size_t i = 0; i < f->panels; i++)
        if (&f->panel[i] == p || (along_y && f->one_y))
            include(&f->panel[i], along_y, &r);
    if (!(r.low <= r.high))
        r = logarithmic ? (struct br_range){0.1, 1} : (struct br_range){0, 1};
    if (logarithmic) {
        const double more = fmax(0.06 * br_decades(r), (1 - br_decades(r)) / 2);
        r = (struct br_range){r.low * pow(10, -more), r.high * pow(10, more)};
    } else {
        const double size = r.high > r.low ? r.high - r.low : fmax(fabs(r.high), 1);
        const double more = along_y || !(r.high > r.low) ? 0.06 * size : 0;
        r = (struct br_range){r.low == 0 ? 0 : r.low - more, r.high + more};
    }
    return (struct br_range){given.low != 0 ? given.low : r.low,
                             given.high != 0 ? given.high : r.high};
}

/* Whether a curve comes below y to the right of x; both axes are logarithmic. */
static bool is_crossed(const struct br_panel *p, double x, double y)
{
    for (size_t j = 0; j < p->count; j++)
        for (size_t k = 0; k < p->series[j]->count; k++) {
            const struct br_figure_point *b = &p->series[j]->point[k], *a = k ? b - 1 : b;
            if (!br_is_drawn(p, a) || !br_is_drawn(p, b))
                continue;
            const double along = a->x < x && b->x > x ? log(x / a->x) / log(b->x / a->x) : 1;
            if (b->x > x && fmin(b->y, a->y * pow(b->y / a->y, along)) < y)
                return true;
        }
    return false;
}

/* Slopes start at the lower right, beneath the data or, where these are in the way, beside them. */
static void place_fan(const struct br_panel *p, struct br_axes *a)
{
    const double steepest = p->guide[p->guides - 1].order, gap = 0.05 * br_decades(a->x);
    const double width = fmin(0.42 * br_decades(a->y) / fmax(steepest, 1), 0.28 * br_decades(a->x));
    a->fan_y = a->y.low * pow(10, 0.06 * br_decades(a->y));
    const double top = a->fan_y * pow(10, steepest * width + 0.06 * br_decades(a->y));
    if (is_crossed(p, a->x.high * pow(10, -width - 1.5 * gap), top))
        a->x.high *= pow(10, width + gap);
    a->fan =
        (struct br_range){a->x.high * pow(10, -width - gap / 2), a->x.high * pow(10, -gap / 2)};
}

struct br_axes br_axes_of(const struct br_figure *f, const struct br_panel *p)
{
    struct br_axes a = {.x = axis_range(f, p, false), .y = axis_range(f, p, true)};
    if (p->cells.columns) {
        a.x = (struct br_range){p->cells.x[0], p->cells.x[p->cells.columns]};
        a.y = (struct br_range){p->cells.y[0], p->cells.y[p->cells.rows]};
    } else if (p->guides) {
        place_fan(p, &a);
    }
    return a;
}

/* ---- keys ---- */

bool br_is_inset(const struct br_panel *p)
{
    return p->inset_x.high > p->inset_x.low;
}

static bool has_empty(const struct br_figure *f)
{
    bool empty = false;
    for (size_t i = 0; i < f->panels; i++)
        for (size_t k = 0; k < f->panel[i].cells.rows * f->panel[i].cells.columns; k++)
            empty |= !br_is_coloured(f, f->panel[i].cells.value[k]);
    return empty;
}

__attribute__((format(printf, 3, 4))) static void add_entry(struct br_key *key, const char *title,
                                                            const char *style, ...)
{
    if (key->entries == BR_ENTRIES)
        return;
    va_list arguments;
    va_start(arguments, style);
    vsnprintf(key->entry[key->entries].style, BR_STYLE, style, arguments);
    va_end(arguments);
    key->entry[key->entries++].title = title;
    key->longest = strlen(title) > key->longest ? strlen(title) : key->longest;
}

/* Kinds, series with a title, of the others one, and what a hollow mark means. */
static void collect(const struct br_figure *f, const struct br_panel *p, struct br_key *key)
{
    bool flagged = false, others = false;
    char style[BR_STYLE];
    for (size_t k = 0; k < f->kinds; k++)
        add_entry(key, f->kind[k], "boxes lc rgb '%s' fs solid 1 border lc rgb '#666666'",
                  br_kind_colours[k]);
    if (p->cells.columns && has_empty(f))
        add_entry(key, "no case", "boxes %s", br_empty_style);
    for (size_t j = 0; j < p->count; j++) {
        const struct br_series *s = p->series[j];
        flagged |= br_look_at(p, s).flagged;
        others |= s->pen == BR_PEN_OTHERS;
        if (s->title[0] && s->pen != BR_PEN_OTHERS)
            add_entry(key, s->title, "%s", br_pen_of(p, s, style));
    }
    if (others)
        add_entry(key, "others", "%s", styles[BR_PEN_OTHERS]);
    if (f->hollow[0] && flagged)
        add_entry(key, f->hollow, "points pt 6 ps 1.8*size lc rgb '#444444'");
}

struct br_key br_key_of(const struct br_figure *f, const struct br_panel *p, double width)
{
    struct br_key key = {.entries = 0};
    if (!br_is_inset(p))
        collect(f, p, &key);
    const double fit = floor(width / (double)(key.longest * LETTER + SAMPLE));
    key.columns = (size_t)fmax(1, fmin(fit, (double)key.entries));
    key.rows = (key.entries + key.columns - 1) / key.columns;
    return key;
}

/* ---- layout ---- */

bool br_is_long(const struct br_figure *f, double width)
{
    return BR_LINE_WIDTH * BR_SMALL * (double)strlen(f->title) > 0.96 * width;
}

static double top_of(const struct br_figure *f, double width)
{
    double top = br_is_long(f, width) ? 90 : 60;
    for (size_t i = 0; i < BR_FIGURE_NOTES; i++)
        top += f->note[i][0] ? LINE : 0;
    return top;
}

static double guide_width(const struct br_panel *p)
{
    size_t longest = 0;
    for (size_t i = 0; i < p->guides; i++)
        longest = strlen(p->guide[i].label) > longest ? strlen(p->guide[i].label) : longest;
    return longest ? (double)(longest * LETTER) + 12 : 0;
}

static size_t places(const struct br_figure *f)
{
    size_t count = 0;
    for (size_t i = 0; i < f->panels; i++)
        count += !br_is_inset(&f->panel[i]);
    return count ? count : 1;
}

/* What stands beside and below the panels. */
static void add_keys(const struct br_figure *f, struct br_figure_page *l)
{
    const struct br_panel *first = &f->panel[0];
    const double beside = (double)(br_key_of(f, first, 0).longest * LETTER) + SAMPLE + 20;
    const bool bar = first->cells.columns && !f->kinds;
    l->beside = f->panels == 1 && !first->cells.columns && beside <= 400;
    const double aside = bar ? 175 : l->beside ? fmax(beside, guide_width(first)) - 20 : 0;
    l->column = (l->width - aside) / (double)l->across;
    size_t rows = 0;
    for (size_t i = 0; i < f->panels; i++) {
        const struct br_panel *p = &f->panel[i];
        const double room = f->one_key ? l->width - 60 : l->column - l->left - 35 - guide_width(p);
        const size_t needed = f->one_key && i > 0 ? 0 : br_key_of(f, p, room).rows;
        rows = needed > rows ? needed : rows;
        l->head =
            fmax(l->head, (p->title[0] && !br_is_inset(p) ? 45 : 12) + (p->top.count ? 75 : 0));
        l->right = l->beside ? 40 : fmax(l->right, 35 + guide_width(p));
    }
    const double key = l->beside ? 0 : LINE * (double)rows + (rows ? 15 : 0);
    l->bottom = f->one_key ? key : 0;
    l->foot = 105 + (f->one_key ? 0 : key);
}

struct br_figure_page br_lay_out(const struct br_figure *f)
{
    const size_t n = places(f);
    struct br_figure_page l = {.width = n > 1 ? WIDE : NARROW, .left = 130};
    l.across = n <= 3 ? n : n == 4 ? 2 : 3;
    l.down = (n + l.across - 1) / l.across;
    l.height = l.down > 1 ? TWO_ROWS : ONE_ROW;
    l.top = top_of(f, l.width);
    add_keys(f, &l);
    return l;
}

struct br_figure_box br_panel_box(const struct br_figure *f, const struct br_figure_page *l,
                                  size_t i)
{
    size_t at = 0;
    for (size_t j = 1; j <= i; j++)
        at += !br_is_inset(&f->panel[j]);
    const double row = (l->height - l->top - l->bottom) / (double)l->down;
    const double top = l->height - l->top - row * (double)(at / l->across);
    const double left = l->column * (double)(at % l->across);
    struct br_figure_box b = {left + l->left, left + l->column - l->right, top - row + l->foot,
                              top - l->head};
    const struct br_panel *p = &f->panel[i];
    if (!br_is_inset(p))
        return b;
    const double width = b.right - b.left, height = b.top - b.bottom;
    return (struct br_figure_box){b.left + p->inset_x.low * width, b.left + p->inset_x.high * width,
                                  b.bottom + p->inset_y.low * height,
                                  b.bottom + p->inset_y.high * height};
}
