/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The writer of gnuplot scripts and their data. Colours: six hues that the colour-blind can tell
 * apart (Okabe and Ito, 2008), each with a dash and a mark of its own; values by cividis, whose
 * lightness rises steadily (Nunez, Anderton and Renslow, 2018), or from blue over white to red.
 *
 * A page is laid out in pixels, from its lower left. */
#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "plots/figure.h"
#include "study/scene/quote.h"

enum {
    NARROW = 1200,
    WIDE = 1500,
    ONE_ROW = 800,
    TWO_ROWS = 1250,
    FONT = 24,
    SMALL = 21,
    TINY = 16,
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
static const char *const kind_colours[BR_FIGURE_KINDS] = {
    "#cce5f5", "#e69f00", "#d55e00", "#cc79a7", "#0072b2", "#f0e442", "#000000", "#009e73"};

static const char empty_style[] = "lc rgb '#aaaaaa' fs pattern 4 border";

/* Marks shrink, so that curves that lie on one another can still be told apart. pi -1: the line
 * leaves room for the marks. */
static void write_styles(FILE *out)
{
    for (int i = 1; i <= BR_HUES; i++)
        fprintf(out, "set style line %d lw 2.5 lc rgb '%s' dt %s pt %d ps %.2f*size pi -1\n", i,
                hues[i].colour, hues[i].dash, hues[i].mark, 2.8 - 0.22 * i);
}

enum { STYLE = 96 };

/* The pen of a series, as it stands after "with". */
static const char *pen_of(const struct br_panel *p, const struct br_series *s, char style[STYLE])
{
    size_t before = 0;
    for (size_t j = 0; j < p->count && p->series[j] != s; j++)
        before += p->series[j]->pen == BR_PEN_GUIDE;
    const int mark = hues[s->mark ? s->mark : s->hue].mark;
    if (s->pen == BR_PEN_CURVE)
        snprintf(style, STYLE, "linespoints ls %zu pt %d", s->hue, mark);
    else if (s->pen == BR_PEN_LINE)
        snprintf(style, STYLE, "lines ls %zu", s->hue);
    else if (s->pen == BR_PEN_SIGNS)
        snprintf(style, STYLE, "points pt %d ps 1.8*size lc rgb '#444444'", mark);
    else if (s->pen == BR_PEN_GUIDE)
        snprintf(style, STYLE, "lines lw 2.5 lc rgb '#333333' dt %s", guide_dashes[before % 4]);
    else
        snprintf(style, STYLE, "%s", styles[s->pen]);
    return style;
}

/* What is to be seen of a series. */
struct seen {
    bool drawn, flagged;
};

static struct seen look_at(const struct br_panel *p, const struct br_series *s)
{
    struct seen seen = {false, false};
    for (size_t k = 0; k < s->count; k++) {
        const bool drawn = br_is_drawn(p, &s->point[k]);
        seen.drawn |= drawn;
        seen.flagged |= drawn && s->point[k].flag;
    }
    return seen;
}

/* ---- data ---- */

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

/* ---- ranges ---- */

static double decades(struct br_range r)
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
        const double more = fmax(0.06 * decades(r), (1 - decades(r)) / 2);
        r = (struct br_range){r.low * pow(10, -more), r.high * pow(10, more)};
    } else {
        const double size = r.high > r.low ? r.high - r.low : fmax(fabs(r.high), 1);
        const double more = along_y || !(r.high > r.low) ? 0.06 * size : 0;
        r = (struct br_range){r.low == 0 ? 0 : r.low - more, r.high + more};
    }
    return (struct br_range){given.low != 0 ? given.low : r.low,
                             given.high != 0 ? given.high : r.high};
}

struct axes {
    struct br_range x, y;
    struct br_range fan; /* of the guides along x; their foot is at fan_y */
    double fan_y;
};

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
static void place_fan(const struct br_panel *p, struct axes *a)
{
    const double steepest = p->guide[p->guides - 1].order, gap = 0.05 * decades(a->x);
    const double width = fmin(0.42 * decades(a->y) / fmax(steepest, 1), 0.28 * decades(a->x));
    a->fan_y = a->y.low * pow(10, 0.06 * decades(a->y));
    const double top = a->fan_y * pow(10, steepest * width + 0.06 * decades(a->y));
    if (is_crossed(p, a->x.high * pow(10, -width - 1.5 * gap), top))
        a->x.high *= pow(10, width + gap);
    a->fan =
        (struct br_range){a->x.high * pow(10, -width - gap / 2), a->x.high * pow(10, -gap / 2)};
}

static struct axes axes_of(const struct br_figure *f, const struct br_panel *p)
{
    struct axes a = {.x = axis_range(f, p, false), .y = axis_range(f, p, true)};
    if (p->cells.columns) {
        a.x = (struct br_range){p->cells.x[0], p->cells.x[p->cells.columns]};
        a.y = (struct br_range){p->cells.y[0], p->cells.y[p->cells.rows]};
    } else if (p->guides) {
        place_fan(p, &a);
    }
    return a;
}

/* ---- keys ---- */

enum { ENTRIES = 40 };

struct key {
    struct {
        const char *title;
        char style[STYLE];
    } entry[ENTRIES];
    size_t entries, longest, columns, rows;
};

static bool is_inset(const struct br_panel *p)
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

__attribute__((format(printf, 3, 4))) static void add_entry(struct key *key, const char *title,
                                                            const char *style, ...)
{
    if (key->entries == ENTRIES)
        return;
    va_list arguments;
    va_start(arguments, style);
    vsnprintf(key->entry[key->entries].style, STYLE, style, arguments);
    va_end(arguments);
    key->entry[key->entries++].title = title;
    key->longest = strlen(title) > key->longest ? strlen(title) : key->longest;
}

/* Kinds, series with a title, of the others one, and what a hollow mark means. */
static void collect(const struct br_figure *f, const struct br_panel *p, struct key *key)
{
    bool flagged = false, others = false;
    char style[STYLE];
    for (size_t k = 0; k < f->kinds; k++)
        add_entry(key, f->kind[k], "boxes lc rgb '%s' fs solid 1 border lc rgb '#666666'",
                  kind_colours[k]);
    if (p->cells.columns && has_empty(f))
        add_entry(key, "no case", "boxes %s", empty_style);
    for (size_t j = 0; j < p->count; j++) {
        const struct br_series *s = p->series[j];
        flagged |= look_at(p, s).flagged;
        others |= s->pen == BR_PEN_OTHERS;
        if (s->title[0] && s->pen != BR_PEN_OTHERS)
            add_entry(key, s->title, "%s", pen_of(p, s, style));
    }
    if (others)
        add_entry(key, "others", "%s", styles[BR_PEN_OTHERS]);
    if (f->hollow[0] && flagged)
        add_entry(key, f->hollow, "points pt 6 ps 1.8*size lc rgb '#444444'");
}

/* In a space so wide. */
static struct key key_of(const struct br_figure *f, const struct br_panel *p, double width)
{
    struct key key = {.entries = 0};
    if (!p->keyless && !is_inset(p))
        collect(f, p, &key);
    const double fit = floor(width / (double)(key.longest * LETTER + SAMPLE));
    key.columns = (size_t)fmax(1, fmin(fit, (double)key.entries));
    key.rows = (key.entries + key.columns - 1) / key.columns;
    return key;
}

/* ---- layout ---- */

struct layout {
    double width, height;
    size_t across, down;
    double left, head, foot, top, bottom; /* around each panel; above and below all */
    double column;                        /* a panel's width with what is around it */
    double right;                         /* of each panel */
    bool beside;                          /* the key stands right of the only panel */
};

#define LINE_WIDTH 0.55 /* of a letter, over its height */

/* The title takes two lines where it is long. */
static bool is_long(const struct br_figure *f, double width)
{
    return LINE_WIDTH * SMALL * (double)strlen(f->title) > 0.96 * width;
}

static double top_of(const struct br_figure *f, double width)
{
    double top = is_long(f, width) ? 90 : 60;
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
        count += !is_inset(&f->panel[i]);
    return count ? count : 1;
}

/* What stands beside and below the panels. */
static void add_keys(const struct br_figure *f, struct layout *l)
{
    const struct br_panel *first = &f->panel[0];
    const double beside = (double)(key_of(f, first, 0).longest * LETTER) + SAMPLE + 20;
    const bool bar = first->cells.columns && !f->kinds;
    l->beside = f->panels == 1 && !first->cells.columns && !first->keyless && beside <= 400;
    const double aside = bar ? 175 : l->beside ? fmax(beside, guide_width(first)) - 20 : 0;
    l->column = (l->width - aside) / (double)l->across;
    size_t rows = 0;
    for (size_t i = 0; i < f->panels; i++) {
        const struct br_panel *p = &f->panel[i];
        const double room = f->one_key ? l->width - 60 : l->column - l->left - 35 - guide_width(p);
        const size_t needed = f->one_key && i > 0 ? 0 : key_of(f, p, room).rows;
        rows = needed > rows ? needed : rows;
        l->head = fmax(l->head, (p->title[0] && !is_inset(p) ? 45 : 12) + (p->top.count ? 75 : 0));
        l->right = l->beside ? 40 : fmax(l->right, 35 + guide_width(p));
    }
    const double key = l->beside ? 0 : LINE * (double)rows + (rows ? 15 : 0);
    l->bottom = f->one_key ? key : 0;
    l->foot = 105 + (f->one_key ? 0 : key);
}

static struct layout lay_out(const struct br_figure *f)
{
    const size_t n = places(f);
    struct layout l = {.width = n > 1 ? WIDE : NARROW, .left = 130};
    l.across = n <= 3 ? n : n == 4 ? 2 : 3;
    l.down = (n + l.across - 1) / l.across;
    l.height = l.down > 1 ? TWO_ROWS : ONE_ROW;
    l.top = top_of(f, l.width);
    add_keys(f, &l);
    return l;
}

/* A rectangle on the page, pixels. */
struct box {
    double left, right, bottom, top;
};

static struct box panel_box(const struct br_figure *f, const struct layout *l, size_t i)
{
    size_t at = 0;
    for (size_t j = 1; j <= i; j++)
        at += !is_inset(&f->panel[j]);
    const double row = (l->height - l->top - l->bottom) / (double)l->down;
    const double top = l->height - l->top - row * (double)(at / l->across);
    const double left = l->column * (double)(at % l->across);
    struct box b = {left + l->left, left + l->column - l->right, top - row + l->foot,
                    top - l->head};
    const struct br_panel *p = &f->panel[i];
    if (!is_inset(p))
        return b;
    const double width = b.right - b.left, height = b.top - b.bottom;
    return (struct box){b.left + p->inset_x.low * width, b.left + p->inset_x.high * width,
                        b.bottom + p->inset_y.low * height, b.bottom + p->inset_y.high * height};
}

/* ---- the script: around the panels ---- */

static void write_label(FILE *out, const struct layout *l, const char *text, double x, double y,
                        const char *how, int font)
{
    fputs("set label ", out);
    br_quote(out, &br_for_gnuplot, text);
    fprintf(out, " at screen %.4f,%.4f %s font ',%d'\n", x / l->width, y / l->height, how, font);
}

/* A plain line, as wide as the page at most. */
static double write_line(FILE *out, const struct layout *l, const char *text, int size, double y)
{
    const double fits = 0.96 * l->width / LINE_WIDTH / (double)(strlen(text) + 1);
    y -= 0.65 * size;
    write_label(out, l, text, 30, y, "left noenhanced", (int)fmax(10, fmin(size, fits)));
    return y - 0.65 * size;
}

static void write_title(FILE *out, const struct br_figure *f, const struct layout *l)
{
    char line[sizeof f->title];
    double y = l->height - 18;
    BR_SAY(line, "%s", f->title);
    char *second = line + strlen(line) / 2;
    while (*second && *second != ' ')
        second++;
    const bool two = is_long(f, l->width) && *second;
    if (two)
        *second++ = '\0';
    y = write_line(out, l, line, two ? SMALL : FONT + 2, y) - 6;
    if (two)
        y = write_line(out, l, second, SMALL, y) - 6;
    for (size_t i = 0; i < BR_FIGURE_NOTES; i++)
        if (f->note[i][0])
            y = write_line(out, l, f->note[i], SMALL, y) - 6;
}

void br_script_head(FILE *out, const char *title, const char *stem, const char *pictures)
{
    char name[512];
    br_quoted(name, sizeof name, &br_for_text, stem);
    fputs("# SPDX-License-Identifier: GPL-3.0-or-later\n", out);
    write_comment_line(out, title);
    fprintf(out,
            "# Draws %s from %s.dat;\n"
            "# edit it, and draw again, in this folder, with\n"
            "#     gnuplot %s.gp\n\n"
            "set encoding utf8\n"
            "stem = ",
            pictures, name, name);
    br_quote(out, &br_for_gnuplot, stem);
    fputs("\ndata = stem.'.dat'\n", out);
}

static void write_palette(FILE *out, const struct br_figure *f)
{
    const struct br_range r = br_value_range(f);
    double white = (f->neutral - r.low) / (r.high - r.low);
    if (f->log_value)
        white = log(f->neutral / r.low) / log(r.high / r.low);
    if (f->neutral != 0 && white > 0 && white < 1)
        fprintf(out,
                "set palette defined (0 '#0072b2', %.6g '#ffffff', %.6g '#d55e00', 1 '#5c1a00')\n",
                white, (1 + white) / 2);
    else
        fputs("set palette defined (0 '#00224e', 1 '#35456c', 2 '#666970', 3 '#948e77', "
              "4 '#c8b866', 5 '#fee838')\n",
              out);
    fprintf(out, "set cbrange [%.12g:%.12g]; set format cb '%s'\n", r.low, r.high,
            f->log_value ? "10^{%L}" : "%g");
    if (f->log_value)
        fputs("set logscale cb\n", out);
}

/* The three terminals. */
static void write_loop(FILE *out, const struct layout *l)
{
    fprintf(out,
            "\n# The default font only scales marks; every text has its own size.\n"
            "do for [format in 'svg png pdf'] {\n"
            "if (format eq 'svg') {\n"
            "    set terminal svg size %g,%g font 'DejaVu Sans,12' background rgb 'white'\n"
            "    size = 0.75\n"
            "}\n"
            "if (format eq 'png') {\n"
            "    set terminal pngcairo size %g,%g font 'DejaVu Sans,12' fontscale 0.75\n"
            "    size = 1\n"
            "}\n"
            "if (format eq 'pdf') {\n"
            "    if (strstrt(GPVAL_TERMINALS, 'pdfcairo') == 0) { break }\n"
            "    set terminal pdfcairo size %.4g,%.4g font 'DejaVu Sans,12' fontscale 0.5\n"
            "    size = 0.66\n"
            "}\n"
            "set pointintervalbox 1.6\n"
            "set output stem.'.'.format\n"
            "unset label\nunset arrow\n",
            l->width, l->height, l->width, l->height, l->width / 108, l->height / 108);
}

/* ---- the script: axes ---- */

static const char number_format[] = "%g", power_format[] = "10^{%L}";

static void write_few_ticks(FILE *out, char axis, struct br_range r)
{
    static const int digits[] = {1, 2, 5};
    const char *before = "";
    fprintf(out, "set %ctics (", axis);
    for (int power = (int)floor(log10(r.low)); power <= (int)floor(log10(r.high)); power++)
        for (size_t i = 0; i < sizeof digits / sizeof *digits; i++) {
            const int digit = digits[i];
            const double value = digit * pow(10, power);
            if (value < r.low || value > r.high)
                continue;
            if (digit == 1)
                fprintf(out, "%s'10^{%d}' %.9g", before, power, value);
            else
                fprintf(out, "%s'%d·10^{%d}' %.9g", before, digit, power, value);
            before = ", ";
        }
    fputs(")\n", out);
}

/* Less than two decades have one power of ten or two: 2 and 5 times it are named, too. Of many as
 * many as have room; pixels: the length of the axis. */
static void write_ticks(FILE *out, char axis, struct br_range r, bool logarithmic, double pixels,
                        int font)
{
    const double room = axis == 'x' ? 3.6 * font : 1.8 * font;
    fprintf(out, "set %ctics nomirror %s font ',%d'\nset format %c '%s'\n", axis,
            axis == 'x' ? "offset 0,-0.3" : "offset -0.3,0", font, axis,
            logarithmic ? power_format : number_format);
    if (!logarithmic)
        fprintf(out, "set %ctics autofreq\n", axis);
    else if (decades(r) >= 2)
        fprintf(out, "set %ctics 1e%g\n", axis, ceil(room * decades(r) / pixels));
    else
        write_few_ticks(out, axis, r);
}

/* Numbers along the top; one that has no room beside the one before it is left out. pixel: the
 * axis' decades in one. */
static void write_top(FILE *out, const struct br_panel *p, struct br_range x, double pixel)
{
    double last = INFINITY;
    if (!p->top.count) {
        fputs("unset x2tics; unset x2label\n", out);
        return;
    }
    fprintf(out, "set logscale x2\nset x2range [%.9g:%.9g]\nset x2tics font ',%d' (", x.low, x.high,
            18);
    for (size_t i = 0; i < p->top.count; i++) {
        const struct br_figure_point *at = &p->top.point[i];
        char number[32];
        const int digits = snprintf(number, sizeof number, "%.0f", at->y);
        const bool fits = fabs(log10(last / at->x)) > (digits * 11.5 + 8) * pixel;
        fprintf(out, "%s'%s' %.9g", i ? ", " : "", fits ? number : "", at->x);
        last = fits ? at->x : last;
    }
    fputs(")\nset x2label ", out);
    br_quote(out, &br_for_gnuplot, p->top_label);
    fprintf(out, " font ',%d' offset 0,-0.2\n", FONT - 2);
}

/* Names of axes and panels stand at fixed places, since terminals space their own differently. */
static void write_names(FILE *out, const struct br_panel *p, const struct box *b,
                        const struct layout *l)
{
    const bool inset = is_inset(p);
    const double center = (b->left + b->right) / 2;
    const int font = inset ? TINY : FONT;
    write_label(out, l, p->x_label, center, b->bottom - (inset ? 45 : 75), "center", font);
    write_label(out, l, p->y_label, b->left - (inset ? 62 : 103), (b->bottom + b->top) / 2,
                "center rotate", font);
    if (p->title[0])
        write_label(out, l, p->title, center,
                    b->top + (p->top.count ? 100
                              : inset      ? 16
                                           : 25),
                    "center", font);
}

static void write_marks(FILE *out, const struct br_panel *p)
{
    for (size_t i = 0; i < p->marks; i++) {
        const struct br_mark *m = &p->mark[i];
        fprintf(out,
                "set arrow from first %.9g,graph 0 to first %.9g,graph 1 nohead lw 2 dt (4,4) "
                "lc rgb '#444444'\nset label ",
                m->x, m->x);
        br_quote(out, &br_for_gnuplot, m->label);
        fprintf(out, " at first %.9g,graph %.3g left rotate offset %s,0 font ',%d'\n", m->x,
                m->height, m->left ? "-1.6" : "1.8", SMALL);
    }
}

static void write_fan(FILE *out, const struct br_panel *p, const struct axes *a)
{
    if (!p->guides)
        return;
    fprintf(out,
            "# Slopes to compare with, from (fx, fy), at the axes' scale.\n"
            "fx = %.9g; fy = %.9g; fw = %.9g\n"
            "set arrow from fx,fy to fx*fw,fy nohead ls 101\n"
            "set arrow from fx*fw,fy to fx*fw,fy*fw**%g nohead ls 101\n",
            a->fan.low, a->fan_y, a->fan.high / a->fan.low, p->guide[p->guides - 1].order);
    for (size_t i = 0; i < p->guides; i++) {
        fprintf(out, "set arrow from fx,fy to fx*fw,fy*fw**%g nohead ls 101\nset label ",
                p->guide[i].order);
        br_quote(out, &br_for_gnuplot, p->guide[i].label);
        fprintf(out, " at graph 1.015,first fy*fw**%g left font ',%d'\n", p->guide[i].order, SMALL);
    }
}

static void write_axes(FILE *out, const struct br_figure *f, const struct br_panel *p,
                       const struct box *b, const struct layout *l)
{
    const struct axes a = axes_of(f, p);
    const int font = is_inset(p) ? TINY - 1 : SMALL;
    fprintf(out,
            "set lmargin at screen %.4f; set rmargin at screen %.4f\n"
            "set bmargin at screen %.4f; set tmargin at screen %.4f\n",
            b->left / l->width, b->right / l->width, b->bottom / l->height, b->top / l->height);
    if (p->log_x || p->log_y)
        fprintf(out, "set logscale %s%s\n", p->log_x ? "x" : "", p->log_y ? "y" : "");
    fprintf(out, "set xrange [%.9g:%.9g]; set yrange [%.9g:%.9g]\n", a.x.low, a.x.high, a.y.low,
            a.y.high);
    write_ticks(out, 'x', a.x, p->log_x, b->right - b->left, font);
    write_ticks(out, 'y', a.y, p->log_y, b->top - b->bottom, font);
    write_top(out, p, a.x, decades(a.x) / (b->right - b->left));
    fputs(is_inset(p) || p->cells.columns ? "unset grid\n" : "set grid xtics ytics ls 102\n", out);
    write_names(out, p, b, l);
    write_marks(out, p);
    write_fan(out, p, &a);
}

/* ---- the script: what is plotted ---- */

/* Ends a plot command with the key of a panel. */
static void write_entries(FILE *out, const struct key *key)
{
    for (size_t i = 0; i < key->entries; i++) {
        fprintf(out, ", \\\n     keyentry with %s title ", key->entry[i].style);
        br_quote(out, &br_for_gnuplot, key->entry[i].title);
    }
    fputc('\n', out);
}

/* Below the box, or beside it. */
static void write_key_place(FILE *out, const struct key *key, const struct box *b,
                            const struct layout *l)
{
    if (!key->entries)
        fputs("unset key\n", out);
    else if (l->beside)
        fprintf(out, "set key at screen %.4f,%.4f left top Left reverse samplen 3",
                (b->right + 15) / l->width, b->top / l->height);
    else
        fprintf(out,
                "set key at screen %.4f,%.4f center top horizontal Left reverse samplen 2.5 "
                "maxcols %zu",
                (b->left + b->right) / 2 / l->width, (b->bottom - 95) / l->height, key->columns);
    if (key->entries)
        fprintf(out, " spacing 1.15 font ',%d'\n", SMALL);
}

/* One colour, kind or emptiness of all cells; borders hide the seams between cells. */
static void write_clause(FILE *out, size_t index, const char *test, const char *colour,
                         const char *style)
{
    fprintf(out,
            ", \\\n     data index %zu using (%s ? $1 : NaN):2:3:4:5:6%s with boxxyerror %s "
            "notitle",
            index, test, colour, style);
}

static void write_cell_clauses(FILE *out, const struct br_figure *f, size_t index)
{
    char test[64], style[96];
    write_clause(out, index, "$9 == 0", "", empty_style);
    if (!f->kinds)
        write_clause(out, index, "$9 == 1", ":8", "lc palette lw 0.5 fs solid 1 border");
    for (size_t k = 0; k < f->kinds; k++) {
        BR_SAY(test, "$9 == 1 && $8 == %zu", k);
        BR_SAY(style, "lc rgb '%s' lw 0.5 fs solid 1 border", kind_colours[k]);
        write_clause(out, index, test, "", style);
    }
}

static void write_curve(FILE *out, const struct br_panel *p, const struct br_series *s,
                        size_t index)
{
    char style[STYLE];
    fprintf(out, ", \\\n     data index %zu using 1:2", index);
    if (s->pen == BR_PEN_CURVE && look_at(p, s).flagged) {
        fprintf(out, ":(mark(%d, strcol(3))) with linespoints ls %zu pt variable notitle",
                hues[s->mark ? s->mark : s->hue].mark, s->hue);
        return;
    }
    if (p->cells.columns) /* on a white ground */
        fprintf(out, " with lines lw 7 lc rgb 'white' notitle, \\\n     '' index %zu using 1:2",
                index);
    fprintf(out, " with %s notitle", pen_of(p, s, style));
}

/* Those that stand behind first. */
static void write_curves(FILE *out, const struct br_figure *f, const struct br_panel *p,
                         size_t index)
{
    fputs("plot NaN notitle", out);
    if (p->cells.columns)
        write_cell_clauses(out, f, index++);
    for (int behind = 1; behind >= 0; behind--)
        for (size_t j = 0, at = index; j < p->count; j++) {
            const struct br_series *s = p->series[j];
            const bool is_behind = s->pen == BR_PEN_OTHERS || s->pen == BR_PEN_BAND;
            if (is_behind == behind && look_at(p, s).drawn)
                write_curve(out, p, s, at);
            at += s->count > 0;
        }
}

/* One bar for all panels, right of them. */
static void write_bar(FILE *out, const struct br_figure *f, const struct layout *l)
{
    const struct box last = panel_box(f, l, f->panels - 1), first = panel_box(f, l, 0);
    fprintf(out, "set colorbox user origin screen %.4f,%.4f size screen 0.018,%.4f\n",
            (l->width - 165) / l->width, last.bottom / l->height,
            (first.top - last.bottom) / l->height);
    fprintf(out, "set cbtics font ',%d'\n", SMALL);
    write_label(out, l, f->value_label, l->width - 28, (last.bottom + first.top) / 2,
                "center rotate", FONT);
}

static void write_panel(FILE *out, const struct br_figure *f, size_t i, size_t index,
                        const struct layout *l)
{
    const struct br_panel *p = &f->panel[i];
    const struct box b = panel_box(f, l, i);
    fputs("\nunset label; unset arrow; unset object; unset logscale; unset colorbox\n", out);
    if (i == 0)
        write_title(out, f, l);
    if (is_inset(p)) /* a white ground, with room for the numbers */
        fprintf(out,
                "set object 1 rectangle from screen %.4f,%.4f to screen %.4f,%.4f "
                "fc rgb 'white' fs solid 1 border lc rgb '#888888' behind\n",
                (b.left - 80) / l->width, (b.bottom - 62) / l->height, (b.right + 18) / l->width,
                (b.top + 32) / l->height);
    if (p->cells.columns && !f->kinds && f->log_value)
        fputs("set logscale cb\n", out);
    if (p->cells.columns && !f->kinds && i == 0)
        write_bar(out, f, l);
    write_axes(out, f, p, &b, l);
    const struct key none = {.entries = 0};
    const struct key key = f->one_key ? none : key_of(f, p, b.right - b.left);
    write_key_place(out, &key, &b, l);
    write_curves(out, f, p, index);
    write_entries(out, &key);
}

/* The first panel's key, below all: a plot of its own as wide as the page, since gnuplot fits a key
 * to the plot. */
static void write_one_key(FILE *out, const struct br_figure *f, const struct layout *l)
{
    const struct box b = {30, l->width - 30, l->bottom + 95, l->bottom + 95};
    fprintf(
        out,
        "\nunset label; unset arrow; unset object; unset logscale; unset tics; unset border; unset x2label\n"
        "set lmargin at screen 0.02; set rmargin at screen 0.98\n"
        "set bmargin at screen 0; set tmargin at screen %.4f\nset xrange [0:1]; set yrange "
        "[0:1]\n",
        l->bottom / l->height);
    const struct key key = key_of(f, &f->panel[0], b.right - b.left);
    write_key_place(out, &key, &b, l);
    fputs("plot NaN notitle", out);
    write_entries(out, &key);
    fputs("\nset border\n", out);
}

void br_figure_write_script(FILE *out, const struct br_figure *f)
{
    const struct layout l = lay_out(f);
    size_t index = 0;
    char name[512], pictures[1600];
    br_quoted(name, sizeof name, &br_for_text, f->stem);
    BR_SAY(pictures, "%s.svg, .png and, where gnuplot can, .pdf", name);
    br_script_head(out, f->title, f->stem, pictures);
    if (f->hollow[0])
        fprintf(out, "# A point with a flag (%s) has a hollow mark.\n", f->hollow);
    fputs("mark(filled, flag) = flag eq '-' ? filled : filled - 1\n"
          "set datafile missing 'NaN'\n"
          "set style line 101 lw 2 lc rgb '#555555' # slopes\n"
          "set style line 102 lw 1 lc rgb '#d0d0d0' # grid\n"
          "set border front lw 1\nset tics scale 1.2,0.6\n",
          out);
    if (f->panel[0].cells.columns && !f->kinds)
        write_palette(out, f);
    write_loop(out, &l);
    write_styles(out);
    fputs("set multiplot\n", out);
    for (size_t i = 0; i < f->panels; i++) {
        write_panel(out, f, i, index, &l);
        index += f->panel[i].cells.columns > 0;
        for (size_t j = 0; j < f->panel[i].count; j++)
            index += f->panel[i].series[j]->count > 0;
    }
    if (f->one_key)
        write_one_key(out, f, &l);
    fputs("unset multiplot\nunset output\n}\n", out);
}

/* ---- letters ---- */

static void write_letter_panel(FILE *out, const struct br_panel *p)
{
    for (size_t j = 0; j < p->count; j++) {
        fprintf(out, "$d%zu << EOD\n", j);
        for (size_t k = 0; k < p->series[j]->count; k++)
            if (br_is_drawn(p, &p->series[j]->point[k]))
                fprintf(out, "%.9g %.9g\n", p->series[j]->point[k].x, p->series[j]->point[k].y);
        fputs("EOD\n", out);
    }
    fprintf(out, "%s\nset xlabel '%s'\nset title '%s'\nplot ",
            p->count > 1 ? "set key below" : "unset key", p->x_label, p->y_label);
    for (size_t j = 0; j < p->count; j++)
        fprintf(out, "%s$d%zu using 1:2 with lines title '%s'", j ? ", " : "", j,
                p->series[j]->title);
    fputc('\n', out);
}

void br_figure_write_letters(FILE *out, const struct br_figure *f, int columns, const char *output)
{
    enum { LINES = 17 };
    fprintf(out, "set terminal dumb noenhanced size %d,%d\nset output '%s'\n", columns, LINES,
            output);
    for (size_t i = 0; i < f->panels; i++)
        write_letter_panel(out, &f->panel[i]);
    fputs("unset output\n", out);
}
