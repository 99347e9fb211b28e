/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes gnuplot scripts. gnuplot places axes, ticks and texts. This file gives each panel its
 * share of the page, in pixels from the lower left corner, and sets all styles.
 *
 * Colours: six hues that colour-blind people can distinguish (Okabe and Ito, 2008), each with a
 * dash and a mark of its own. */
#include <math.h>
#include <string.h>

#include "base/quote.h"
#include "plots/pictures.h"

enum {
    FONT = 24,
    SMALL = 21,  /* the default of all terminals */
    LINE = 37,   /* height of a line of small text, with the space below it */
    LETTER = 12, /* about the width of a small letter */
    SAMPLE = 95  /* width of the sample in a key's entry, with the space beside it */
};

/* ---- pens ---- */

static const struct {
    const char *colour, *dash;
    int mark; /* the filled one; the hollow one is one less */
} hues[BR_HUES] = {{"#0072b2", "solid", 7},   {"#d55e00", "(12,4)", 5},
                   {"#009e73", "(4,3)", 9},   {"#cc79a7", "(12,4,3,4)", 13},
                   {"#e69f00", "(20,5)", 11}, {"#56b4e9", "(8,3,2,3,2,3)", 15}};

/* Styles of pens without a hue. */
static const char *const styles[BR_PENS] = {
    [BR_PEN_OTHERS] = "lines lw 1.5 lc rgb '#b0b0b0' dt solid",
    [BR_PEN_BAND] = "lines lw 12 lc rgb '#dcdcdc'",
    [BR_PEN_DOTS] = "points pt 7 ps 0.8*size lc rgb '#8a8a8a'",
    [BR_PEN_RINGS] = "points pt 6 ps 1.5*size lw 2 lc rgb '#222222'",
    [BR_PEN_SQUARES] = "points pt 4 ps 2.6*size lw 2 lc rgb '#000000'",
    [BR_PEN_PLUSES] = "points pt 1 ps 1.1*size lw 2 lc rgb '#707070'",
    [BR_PEN_THIN] = "lines lw 2 lc rgb '#333333'",
    [BR_PEN_STARS] = "points pt 3 ps 1.6*size lw 2.5 lc rgb '#000000'",
};
static const char *const guide_dashes[] = {"(9,5)", "(12,4,2,4)", "(3,3)", "(20,5)"};

static int mark_of(const struct br_series *s)
{
    return hues[((s->mark ? s->mark : s->style) - 1) % BR_HUES].mark;
}

/* Writes the pen of a series, as gnuplot reads it after "with". */
static void write_pen(FILE *out, const struct br_series *s)
{
    if (s->pen < BR_PEN_LINE)
        fprintf(out, "linespoints ls %zu pt %d", s->style, mark_of(s));
    else if (s->pen == BR_PEN_LINE)
        fprintf(out, "lines ls %zu", s->style);
    else if (s->pen == BR_PEN_SIGNS)
        fprintf(out, "points pt %d ps 1.8*size lc rgb '#444444'", mark_of(s));
    else if (s->pen == BR_PEN_GUIDE)
        fprintf(out, "lines lw 2.5 lc rgb '#333333' dt %s", guide_dashes[(s->style - 1) % 4]);
    else
        fputs(styles[s->pen], out);
}

/* The number of points that are drawn; flagged: of those with a flag. */
static size_t count_drawn(const struct br_panel *p, const struct br_series *s, bool flagged)
{
    size_t count = 0;
    for (size_t k = 0; k < s->count; k++)
        count += br_is_drawn(p, &s->point[k]) && (s->point[k].flag || !flagged);
    return count;
}

/* ---- the page ---- */

struct page {
    double width, height, top, bottom; /* above and below all panels */
    size_t across, down;
    size_t key_rows;
};

/* The entries of the key: they are counted, and written if `out` is not NULL. */
struct key {
    FILE *out;
    size_t entries, longest; /* longest: letters of the longest title */
};

/* style: for an entry that is no series. */
static void add_entry(struct key *key, const char *title, const char *style,
                      const struct br_series *series)
{
    key->entries++;
    key->longest = strlen(title) > key->longest ? strlen(title) : key->longest;
    if (!key->out)
        return;
    fputs(", \\\n     keyentry with ", key->out);
    if (style)
        fputs(style, key->out);
    else
        write_pen(key->out, series);
    br_print(key->out, &br_for_gnuplot, " title %s", title);
}

/* Adds the series with a title, one of BR_PEN_OTHERS, and the meaning of a hollow mark. */
static void add_series(const struct br_figure *f, struct key *key)
{
    size_t flagged = 0, others = 0;
    for (size_t i = 0; i < f->panels; i++)
        for (size_t j = 0; j < f->panel[i].count; j++) {
            const struct br_series *s = f->panel[i].series[j];
            flagged += count_drawn(&f->panel[i], s, true);
            others += s->pen == BR_PEN_OTHERS;
            if (s->in_key && s->pen != BR_PEN_OTHERS)
                add_entry(key, s->title, NULL, s);
        }
    if (others)
        add_entry(key, "others", styles[BR_PEN_OTHERS], NULL);
    if (f->hollow[0] && flagged)
        add_entry(key, f->hollow, "points pt 6 ps 1.8*size lc rgb '#444444'", NULL);
}

static struct page lay_out(const struct br_figure *f)
{
    const size_t n = f->panels ? f->panels : 1;
    const bool rows = f->panels && f->panel[0].rows, small = n == 1 && !rows;
    struct page l = {.width = n > 1 ? 1500 : small ? 960 : 1200, .top = 65};
    struct key key = {0};
    l.across = n <= 3 ? n : n == 4 ? 2 : 3;
    l.down = (n + l.across - 1) / l.across;
    l.height = l.down > 1 ? 1250 : small ? 720 : 800;
    if (rows) { /* a line of text for each */
        const struct br_range r = br_extent(&f->panel[0], true);
        l.height = fmax(l.height, 250 + 28 * (r.high - r.low));
    }
    for (size_t i = 0; i < BR_FIGURE_NOTES; i++)
        l.top += f->note[i][0] ? LINE - 4 : 0;
    add_series(f, &key);
    const double columns = (l.width - 60) / (double)(key.longest * LETTER + SAMPLE);
    l.key_rows = (size_t)ceil((double)key.entries / fmax(1, floor(columns)));
    l.bottom = l.key_rows ? LINE * (double)l.key_rows + 15 : 0;
    l.height += fmax(0, l.bottom - 4 * LINE);
    return l;
}

/* ---- the script: around the panels ---- */

/* The size of letters with which a line of text has room, pixels. */
static int letters_of(double size, double room, const char *text)
{
    return (int)fmax(10, fmin(size, 0.96 * room / 0.55 / (double)(strlen(text) + 1)));
}

/* Writes plain lines one below the other, none wider than the page. */
static void write_titles(FILE *out, const struct br_figure *f, const struct page *l)
{
    double y = l->height - 35;
    for (size_t i = 0; i <= BR_FIGURE_NOTES; i++) {
        const char *line = i ? f->note[i - 1] : f->title;
        if (!*line)
            continue;
        br_print(out, &br_for_gnuplot,
                 "set label %s at screen %.4f,%.4f left noenhanced font ',%d'\n", line,
                 30 / l->width, y / l->height, letters_of(i ? SMALL : FONT + 2, l->width, line));
        y -= LINE - 2;
    }
}

/* Writes a comment for a person, and the variables `stem` and `data`. */
static void write_head(FILE *out, const struct br_figure *f)
{
    char name[512];
    br_quoted(name, sizeof name, &br_for_text, f->stem);
    fputs("# SPDX-License-Identifier: GPL-3.0-or-later\n# ", out);
    br_write_comment(out, f->title);
    fprintf(out,
            "# Draws %s.svg, .png and, where gnuplot can, .pdf from %s.dat;\n"
            "# edit it, and draw again, in this folder, with\n"
            "#     gnuplot %s.gp\n\n"
            "set encoding utf8\n",
            name, name, name);
    br_print(out, &br_for_gnuplot, "stem = %s\ndata = stem.'.dat'\n", f->stem);
}

/* Writes the loop over the three terminals, which scale marks and ticks differently. Marks shrink
 * from hue to hue, so that curves on top of one another can be distinguished. pi -1: the line
 * leaves room for the marks. */
static void write_loop(FILE *out, const struct page *l)
{
    fprintf(out,
            "\ndo for [format in 'svg png pdf'] {\n"
            "if (format eq 'svg') {\n"
            "    set terminal svg size %g,%g font 'DejaVu Sans,%d' background rgb 'white'\n"
            "    size = 0.43\n"
            "}\n"
            "if (format eq 'png') {\n"
            "    set terminal pngcairo size %g,%g font 'DejaVu Sans,%d' fontscale 0.75\n"
            "    size = 1\n"
            "}\n"
            "if (format eq 'pdf') {\n"
            "    if (strstrt(GPVAL_TERMINALS, 'pdfcairo') == 0) { break }\n"
            "    set terminal pdfcairo size %.4g,%.4g font 'DejaVu Sans,%d' fontscale 0.5 "
            "linewidth 1.3\n"
            "    size = 0.86\n"
            "}\n"
            "set tics scale 1.2*size,0.6*size\nset pointintervalbox 1.6\n"
            "set output stem.'.'.format\n",
            l->width, l->height, SMALL, l->width, l->height, SMALL, l->width / 108, l->height / 108,
            SMALL);
    for (int i = 0; i < BR_HUES; i++)
        fprintf(out, "set style line %d lw 2.5 lc rgb '%s' dt %s pt %d ps %.2f*size pi -1\n", i + 1,
                hues[i].colour, hues[i].dash, hues[i].mark, 2.58 - 0.22 * i);
    fputs("set multiplot\n", out);
}

/* ---- the script: axes ---- */

static double decades(struct br_range r)
{
    return log10(r.high / r.low);
}

/* A little more than the points, except along a linear x without rows; not below 0 if the points
 * begin at 0. */
static struct br_range axis_range(const struct br_figure *f, const struct br_panel *p, bool along_y)
{
    struct br_range r = br_extent(p, along_y);
    for (size_t i = 0; i < f->panels && along_y && f->one_y; i++) {
        const struct br_range other = br_extent(&f->panel[i], true);
        r = (struct br_range){fmin(r.low, other.low), fmax(r.high, other.high)};
    }
    if (!(r.low <= r.high))
        return (struct br_range){0.1, 1};
    if (along_y ? p->log_y : p->log_x) {
        const double more = fmax(0.06 * decades(r), (1 - decades(r)) / 2);
        return (struct br_range){r.low * pow(10, -more), r.high * pow(10, more)};
    }
    if (along_y && p->rows)
        return (struct br_range){r.low - 0.7, r.high + 0.7};
    const double size = r.high > r.low ? r.high - r.low : fmax(fabs(r.high), 1);
    const bool wider = along_y || p->rows || p->margins || !(r.high > r.low);
    const double more = wider ? 0.06 * size : 0;
    return (struct br_range){r.low == 0 && !p->margins ? 0 : r.low - more, r.high + more};
}

/* The digits that tell numbers of a linear axis apart; a format has six at least. */
static int digits_of(struct br_range r)
{
    const double digits = ceil(log10(fmax(fabs(r.low), fabs(r.high)) / (r.high - r.low))) + 2;
    return digits > 6 ? (int)fmin(digits, 17) : 6; /* also of NaN */
}

/* Numbers are as people write them, 0.02, where all are near 1, else powers of ten. Less than two
 * decades contain one or two of these, so 2 and 5 times these get labels, too. Of many decades only
 * as many get labels as have room; pixels: about the length of the axis. */
static void write_axis(FILE *out, char axis, struct br_range r, bool logarithmic, double pixels)
{
    fprintf(out, "set %crange [%.9g:%.9g]\n", axis, r.low, r.high);
    if (!logarithmic) {
        const int digits = digits_of(r);
        fprintf(out,
                digits > 6 ? "set %ctics nomirror autofreq; set format %c '%%.%dh'\n"
                           : "set %ctics nomirror autofreq; set format %c '%%h'\n",
                axis, axis, digits);
        return;
    }
    /* Ticks start at a power of ten: without a start gnuplot 5.4 begins at half a decade for some
     * ranges, and labels it with the power below it. */
    const bool plain = r.low > 2e-4 && r.high < 5e4;
    const double room = axis == 'x' ? 3.6 * SMALL : 1.8 * SMALL;
    const double step = ceil(room * decades(r) / pixels);
    fprintf(out, "set logscale %c; set %ctics nomirror 1e%g,1e%g; set format %c '%s'\n", axis, axis,
            step * floor(log10(r.low) / step), step, axis, plain ? "%g" : "10^{%L}");
    static const char *const more[] = {
        "(sprintf('10^{%d}', p) 10.0**p, sprintf('2×10^{%d}', p) 2*10.0**p, "
        "sprintf('5×10^{%d}', p) 5*10.0**p)",
        "(sprintf('%g', 2*10.0**p) 2*10.0**p, sprintf('%g', 5*10.0**p) 5*10.0**p)"};
    if (decades(r) < 2)
        fprintf(out, "set for [p=%d:%d] %ctics add %s\n", (int)floor(log10(r.low)),
                (int)ceil(log10(r.high)), axis, more[plain]);
}

/* Writes numbers along the top, without those that would overlap the one before. pixels: about the
 * length of a decade. */
static void write_top(FILE *out, const struct br_panel *p, struct br_range x, double pixels)
{
    double last = INFINITY;
    if (!p->top.count) {
        fputs("unset x2tics; unset x2label; set title offset 0,-0.5\n", out);
        return;
    }
    fprintf(out,
            "set title offset 0,0.3\nset logscale x2; set x2range [%.9g:%.9g]\n"
            "set x2tics font ',18' (",
            x.low, x.high);
    for (size_t i = 0; i < p->top.count; i++) {
        const struct br_figure_point *at = &p->top.point[i];
        char number[32];
        const int digits = snprintf(number, sizeof number, "%.0f", at->y);
        const bool fits = fabs(log10(last / at->x)) * pixels > digits * 11.5 + 8;
        fprintf(out, "%s'%s' %.9g", i ? ", " : "", fits ? number : "", at->x);
        last = fits ? at->x : last;
    }
    fprintf(out, ")\nset x2label '%s' font ',%d'\n", p->top_label, SMALL);
}

/* ---- the script: what is plotted ---- */

static void write_curve(FILE *out, const struct br_series *s, size_t index)
{
    if (s->pen == BR_PEN_CURVE && s->stairs)
        fprintf(out, ", \\\n     data index %zu using 1:2 with steps ls %zu", index, s->style);
    if (s->pen == BR_PEN_CURVE || s->pen == BR_PEN_MARKS)
        fprintf(out,
                ", \\\n     data index %zu using 1:2:(mark(%d, strcol(3))) with %spoints ls %zu "
                "pt variable",
                index, mark_of(s), s->pen == BR_PEN_CURVE && !s->stairs ? "lines" : "", s->style);
    else if (s->pen == BR_PEN_AREA)
        fprintf(
            out,
            ", \\\n     data index %zu using 1:2 with filledcurves closed ls %zu fs transparent "
            "solid 0.25 noborder",
            index, s->style);
    else if (s->stairs && styles[s->pen])
        fprintf(out, ", \\\n     data index %zu using 1:2 with steps%s", index,
                styles[s->pen] + strlen("lines"));
    else {
        fprintf(out, ", \\\n     data index %zu using 1:2 with ", index);
        write_pen(out, s);
    }
}

/* Whether a series is a box in its row: cairo draws the ends of a short and wide line askew. */
static bool is_box(const struct br_panel *p, const struct br_series *s)
{
    return p->rows && s->pen == BR_PEN_BAND;
}

/* Draws the curves that lie behind first. */
static void write_plot(FILE *out, const struct br_panel *p, size_t index)
{
    fputs("plot NaN", out);
    for (int behind = 1; behind >= 0; behind--)
        for (size_t j = 0, at = index; j < p->count; j++) {
            const struct br_series *s = p->series[j];
            const bool is_behind =
                s->pen == BR_PEN_OTHERS || s->pen == BR_PEN_BAND || s->pen == BR_PEN_AREA;
            if (is_behind == behind && count_drawn(p, s, false) && !is_box(p, s))
                write_curve(out, s, at);
            at += s->count > 0;
        }
    fputc('\n', out);
}

/* Writes boxes, and the texts beside last points; those of rows in place of the numbers along y.
 * width: of the panel; row: from one to the next, about; pixels. */
static void write_ends(FILE *out, const struct br_panel *p, double width, double row)
{
    const double half = fmin(0.3, 12 / row); /* of a box */
    const char *longest = "";
    for (size_t j = 0; j < p->count; j++)
        if (strlen(p->series[j]->end) > strlen(longest))
            longest = p->series[j]->end;
    const int letters = letters_of(SMALL, 0.6 * width, longest);
    if (p->rows)
        fprintf(out, "unset ytics; set lmargin at screen %.4f\n",
                (40 + LETTER * (double)letters / SMALL * (double)strlen(longest)) / width);
    for (size_t j = 0; j < p->count; j++) {
        const struct br_series *s = p->series[j];
        if (!s->count)
            continue;
        const struct br_figure_point *last = s->point + s->count - 1;
        if (is_box(p, s) && count_drawn(p, s, false) == s->count)
            fprintf(out,
                    "set object rectangle from %.9g,%.9g to %.9g,%.9g behind "
                    "fc rgb '#d4d4d4' fs solid noborder\n",
                    s->point->x, last->y - half, last->x, last->y + half);
        if (!s->end[0])
            continue;
        br_print(out, &br_for_gnuplot, "set label %s", s->end);
        if (p->rows)
            fprintf(out, " at graph 0, first %.9g right offset -0.6,0 font ',%d'\n", last->y,
                    letters);
        else
            fprintf(out, " at %.9g,%.9g %s offset %s0.5,0\n", last->x, last->y,
                    s->end_left ? "right" : "left", s->end_left ? "-" : "");
    }
}

static void write_panel(FILE *out, const struct br_figure *f, size_t i, size_t index,
                        const struct page *l)
{
    const struct br_panel *p = &f->panel[i];
    const struct br_range x = axis_range(f, p, false), y = axis_range(f, p, true);
    const double width = l->width / (double)l->across;
    const double height = (l->height - l->top - l->bottom) / (double)l->down;
    fprintf(out, "\nset origin %.4f,%.4f; set size %.4f,%.4f\nunset label; unset logscale xyx2\n",
            (double)(i % l->across) * width / l->width,
            (l->bottom + (double)(l->down - 1 - i / l->across) * height) / l->height,
            width / l->width, height / l->height);
    if (i == 0)
        write_titles(out, f, l);
    br_print(out, &br_for_gnuplot,
             "set title %s font ',%d'\nset xlabel %s font ',%d'\nset ylabel %s font ',%d'\n",
             p->title, letters_of(FONT, width - 60, p->title), p->x_label,
             letters_of(FONT, width - 60, p->x_label), p->y_label,
             letters_of(FONT, height, p->y_label));
    write_axis(out, 'x', x, p->log_x, 0.75 * width);
    write_axis(out, 'y', y, p->log_y, 0.7 * height);
    write_top(out, p, x, 0.75 * width / decades(x));
    fputs("set grid xtics ytics ls 102\n", out);
    write_ends(out, p, width, 0.75 * height / (y.high - y.low));
    write_plot(out, p, index);
    fputs(p->rows ? "set lmargin; unset object\n" : "", out);
}

/* Writes the key below all panels, as a plot of its own: gnuplot fits a key to its plot. */
static void write_key(FILE *out, const struct br_figure *f, const struct page *l)
{
    if (l->bottom <= 0)
        return;
    fprintf(out,
            "\nset origin 0,0; set size 1,%.4f\n"
            "unset label; unset logscale xyx2; unset tics; unset border; unset colorbox\n"
            "unset title; unset xlabel; unset ylabel; unset x2label\n"
            "set lmargin 0; set rmargin 0; set tmargin 0; set bmargin 0\n"
            "set xrange [0:1]; set yrange [0:1]\n"
            "set key center center vertical Left reverse samplen 2.5 maxrows %zu font ',19'\n"
            "plot NaN notitle",
            l->bottom / l->height, l->key_rows);
    add_series(f, &(struct key){.out = out});
    fputs("\nset border; unset key; set lmargin; set rmargin; set tmargin; set bmargin\n", out);
}

void br_figure_write_script(FILE *out, const struct br_figure *f)
{
    const struct page l = lay_out(f);
    size_t index = 0;
    write_head(out, f);
    if (f->hollow[0])
        fprintf(out, "# A point with a flag (%s) has a hollow mark.\n", f->hollow);
    fputs("mark(filled, flag) = flag eq '-' ? filled : filled - 1\n"
          "set style line 102 lw 1 lc rgb '#d0d0d0' # grid\n"
          "set border front lw 1\nunset key\n",
          out);
    write_loop(out, &l);
    for (size_t i = 0; i < f->panels; i++) {
        write_panel(out, f, i, index, &l);
        for (size_t j = 0; j < f->panel[i].count; j++)
            index += f->panel[i].series[j]->count > 0;
    }
    write_key(out, f, &l);
    fputs("unset multiplot\nunset output\n}\n", out);
}

/* ---- letters ---- */
