/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The writer of gnuplot scripts. Values are coloured by cividis, whose lightness rises steadily
 * (Nunez, Anderton and Renslow, 2018), or from blue over white to red. */
#include <math.h>
#include <string.h>

#include "plots/layout.h"
#include "study/scene/quote.h"

/* ---- the script: around the panels ---- */

static void write_label(FILE *out, const struct br_figure_page *l, const char *text, double x,
                        double y, const char *how, int font)
{
    fputs("set label ", out);
    br_quote(out, &br_for_gnuplot, text);
    fprintf(out, " at screen %.4f,%.4f %s font ',%d'\n", x / l->width, y / l->height, how, font);
}

/* A plain line, as wide as the page at most. */
static double write_line(FILE *out, const struct br_figure_page *l, const char *text, int size,
                         double y)
{
    const double fits = 0.96 * l->width / BR_LINE_WIDTH / (double)(strlen(text) + 1);
    y -= 0.65 * size;
    write_label(out, l, text, 30, y, "left noenhanced", (int)fmax(10, fmin(size, fits)));
    return y - 0.65 * size;
}

static void write_title(FILE *out, const struct br_figure *f, const struct br_figure_page *l)
{
    char line[sizeof f->title];
    double y = l->height - 18;
    BR_SAY(line, "%s", f->title);
    char *second = line + strlen(line) / 2;
    while (*second && *second != ' ')
        second++;
    const bool two = br_is_long(f, l->width) && *second;
    if (two)
        *second++ = '\0';
    y = write_line(out, l, line, two ? BR_SMALL : BR_FONT + 2, y) - 6;
    if (two)
        y = write_line(out, l, second, BR_SMALL, y) - 6;
    for (size_t i = 0; i < BR_FIGURE_NOTES; i++)
        if (f->note[i][0])
            y = write_line(out, l, f->note[i], BR_SMALL, y) - 6;
}

void br_script_head(FILE *out, const char *title, const char *stem, const char *pictures)
{
    char name[512];
    br_quoted(name, sizeof name, &br_for_text, stem);
    fputs("# SPDX-License-Identifier: GPL-3.0-or-later\n# ", out);
    br_write_comment(out, title);
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
static void write_loop(FILE *out, const struct br_figure_page *l)
{
    fprintf(
        out,
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
        "    set terminal pdfcairo size %.4g,%.4g font 'DejaVu Sans,12' fontscale 0.5 linewidth 1.3\n"
        "    size = 0.86\n"
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

/* Less than two br_decades have one power of ten or two: 2 and 5 times it are named, too. Of many
 * as many as have room; pixels: the length of the axis. */
static void write_ticks(FILE *out, char axis, struct br_range r, bool logarithmic, double pixels,
                        int font)
{
    const double room = axis == 'x' ? 3.6 * font : 1.8 * font;
    fprintf(out, "set %ctics nomirror %s font ',%d'\nset format %c '%s'\n", axis,
            axis == 'x' ? "offset 0,-0.3" : "offset -0.3,0", font, axis,
            logarithmic ? power_format : number_format);
    if (!logarithmic)
        fprintf(out, "set %ctics autofreq\n", axis);
    else if (br_decades(r) >= 2)
        fprintf(out, "set %ctics 1e%g\n", axis, ceil(room * br_decades(r) / pixels));
    else
        write_few_ticks(out, axis, r);
}

/* Numbers along the top; one that has no room beside the one before it is left out. pixel: the
 * axis' br_decades in one. */
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
    fprintf(out, " font ',%d' offset 0,-0.2\n", BR_FONT - 2);
}

/* Names of axes and panels stand at fixed places, since terminals space their own differently. */
static void write_names(FILE *out, const struct br_panel *p, const struct br_figure_box *b,
                        const struct br_figure_page *l)
{
    const bool inset = br_is_inset(p);
    const double center = (b->left + b->right) / 2;
    const int font = inset ? BR_TINY : BR_FONT;
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
                m->height, m->left ? "-1.6" : "1.8", BR_SMALL);
    }
}

static void write_fan(FILE *out, const struct br_panel *p, const struct br_axes *a)
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
        fprintf(out, " at graph 1.015,first fy*fw**%g left font ',%d'\n", p->guide[i].order,
                BR_SMALL);
    }
}

static void write_axes(FILE *out, const struct br_figure *f, const struct br_panel *p,
                       const struct br_figure_box *b, const struct br_figure_page *l)
{
    const struct br_axes a = br_axes_of(f, p);
    const int font = br_is_inset(p) ? BR_TINY - 1 : BR_SMALL;
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
    write_top(out, p, a.x, br_decades(a.x) / (b->right - b->left));
    fputs(br_is_inset(p) || p->cells.columns ? "unset grid\n" : "set grid xtics ytics ls 102\n",
          out);
    write_names(out, p, b, l);
    write_marks(out, p);
    write_fan(out, p, &a);
}

/* ---- the script: what is plotted ---- */

/* Ends a plot command with the key of a panel. */
static void write_entries(FILE *out, const struct br_key *key)
{
    for (size_t i = 0; i < key->entries; i++) {
        fprintf(out, ", \\\n     keyentry with %s title ", key->entry[i].style);
        br_quote(out, &br_for_gnuplot, key->entry[i].title);
    }
    fputc('\n', out);
}

/* Below the box, or beside it. */
static void write_key_place(FILE *out, const struct br_key *key, const struct br_figure_box *b,
                            const struct br_figure_page *l)
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
        fprintf(out, " spacing 1.15 font ',%d'\n", BR_SMALL);
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
    write_clause(out, index, "$9 == 0", "", br_empty_style);
    if (!f->kinds)
        write_clause(out, index, "$9 == 1", ":8", "lc palette lw 0.5 fs solid 1 border");
    for (size_t k = 0; k < f->kinds; k++) {
        BR_SAY(test, "$9 == 1 && $8 == %zu", k);
        BR_SAY(style, "lc rgb '%s' lw 0.5 fs solid 1 border", br_kind_colours[k]);
        write_clause(out, index, test, "", style);
    }
}

static void write_curve(FILE *out, const struct br_panel *p, const struct br_series *s,
                        size_t index)
{
    char style[BR_STYLE];
    fprintf(out, ", \\\n     data index %zu using 1:2", index);
    if (s->pen == BR_PEN_CURVE && br_look_at(p, s).flagged) {
        fprintf(out, ":(mark(%d, strcol(3))) with linespoints ls %zu pt variable notitle",
                br_mark_of(s), s->hue);
        return;
    }
    if (p->cells.columns) /* on a white ground */
        fprintf(out, " with lines lw 7 lc rgb 'white' notitle, \\\n     '' index %zu using 1:2",
                index);
    fprintf(out, " with %s notitle", br_pen_of(p, s, style));
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
            if (is_behind == behind && br_look_at(p, s).drawn)
                write_curve(out, p, s, at);
            at += s->count > 0;
        }
}

/* One bar for all panels, right of them. */
static void write_bar(FILE *out, const struct br_figure *f, const struct br_figure_page *l)
{
    const struct br_figure_box last = br_panel_box(f, l, f->panels - 1),
                               first = br_panel_box(f, l, 0);
    fprintf(out, "set colorbox user origin screen %.4f,%.4f size screen 0.018,%.4f\n",
            (l->width - 165) / l->width, last.bottom / l->height,
            (first.top - last.bottom) / l->height);
    fprintf(out, "set cbtics font ',%d'\n", BR_SMALL);
    write_label(out, l, f->value_label, l->width - 28, (last.bottom + first.top) / 2,
                "center rotate", BR_FONT);
}

static void write_panel(FILE *out, const struct br_figure *f, size_t i, size_t index,
                        const struct br_figure_page *l)
{
    const struct br_panel *p = &f->panel[i];
    const struct br_figure_box b = br_panel_box(f, l, i);
    fputs("\nunset label; unset arrow; unset object; unset logscale; unset colorbox\n", out);
    if (i == 0)
        write_title(out, f, l);
    if (br_is_inset(p)) /* a white ground, with room for the numbers */
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
    const struct br_key none = {.entries = 0};
    const struct br_key key = f->one_key ? none : br_key_of(f, p, b.right - b.left);
    write_key_place(out, &key, &b, l);
    write_curves(out, f, p, index);
    write_entries(out, &key);
}

/* The first panel's key, below all: a plot of its own as wide as the page, since gnuplot fits a key
 * to the plot. */
static void write_one_key(FILE *out, const struct br_figure *f, const struct br_figure_page *l)
{
    const struct br_figure_box b = {30, l->width - 30, l->bottom + 95, l->bottom + 95};
    fprintf(
        out,
        "\nunset label; unset arrow; unset object; unset logscale; unset tics; unset border; unset x2label\n"
        "set lmargin at screen 0.02; set rmargin at screen 0.98\n"
        "set bmargin at screen 0; set tmargin at screen %.4f\nset xrange [0:1]; set yrange "
        "[0:1]\n",
        l->bottom / l->height);
    const struct br_key key = br_key_of(f, &f->panel[0], b.right - b.left);
    write_key_place(out, &key, &b, l);
    fputs("plot NaN notitle", out);
    write_entries(out, &key);
    fputs("\nset border\n", out);
}

void br_figure_write_script(FILE *out, const struct br_figure *f)
{
    const struct br_figure_page l = br_lay_out(f);
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
    br_write_styles(out);
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
