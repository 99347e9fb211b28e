/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plots/chart.h"

#include <math.h>
#include <stdarg.h>

#include "plots/page.h"
#include "study/scene/quote.h"

void br_chart_lay_out(struct br_chart *chart, size_t panels)
{
    *chart = (struct br_chart){.panels = panels};
    for (size_t i = 0; i < panels; i++) {
        struct br_panel *p = &chart->panel[i];
        p->left = i ? 0.585 : 0.085;
        p->right = i ? 0.985 : panels > 1 ? 0.485 : 0.97;
        p->bottom = 0.27;
        p->top = 0.835;
    }
}

double (*br_chart_curve(struct br_panel *panel, enum br_stroke stroke, size_t count,
                        const char *title, ...))[2]
{
    if (panel->curves == BR_CHART_CURVES)
        return NULL;
    struct br_curve *c = &panel->curve[panel->curves];
    c->point = br_allocate(count + 1, sizeof *c->point);
    if (!c->point)
        return NULL;
    c->count = count;
    c->stroke = stroke;
    va_list arguments;
    va_start(arguments, title);
    vsnprintf(c->title, sizeof c->title, title, arguments);
    va_end(arguments);
    panel->curves++;
    return c->point;
}

struct br_mark *br_chart_mark(struct br_panel *panel, double x, const char *label, ...)
{
    struct br_mark *mark = &panel->mark[panel->marks < BR_CHART_MARKS ? panel->marks++ : 0];
    *mark = (struct br_mark){.x = x, .height = 0.5};
    va_list arguments;
    va_start(arguments, label);
    vsnprintf(mark->label, sizeof mark->label, label, arguments);
    va_end(arguments);
    return mark;
}

void br_chart_clear(struct br_chart *chart)
{
    for (size_t i = 0; i < BR_CHART_PANELS; i++)
        for (size_t j = 0; j < chart->panel[i].curves; j++)
            free(chart->panel[i].curve[j].point);
    *chart = (struct br_chart){0};
}

void br_chart_write_data(FILE *out, const struct br_chart *chart)
{
    fputs("# SPDX-License-Identifier: GPL-3.0-or-later\n# ", out);
    br_write_comment(out, chart->title);
    size_t index = 0;
    for (size_t i = 0; i < chart->panels; i++)
        for (size_t j = 0; j < chart->panel[i].curves; j++) {
            const struct br_panel *p = &chart->panel[i];
            const struct br_curve *c = &p->curve[j];
            fprintf(out, "# index %zu: %s; %s\n# %s | %s\n", index++, p->title, c->title,
                    p->x_label, p->y_label);
            for (size_t k = 0; k < c->count; k++)
                if (isfinite(c->point[k][0]) && isfinite(c->point[k][1]))
                    fprintf(out, "%.12g %.12g\n", c->point[k][0], c->point[k][1]);
                else
                    fprintf(out, "NaN NaN\n");
            fputs("\n\n", out);
        }
}

/* ---- the script ---- */

static void write_pen(FILE *out, const struct br_panel *p, size_t curve)
{
    const struct br_curve *c = &p->curve[curve];
    size_t series = 0, before = 0;
    for (size_t j = 0; j < p->curves; j++) {
        series += p->curve[j].stroke <= BR_STROKE_MARKED;
        before += j < curve && p->curve[j].stroke <= BR_STROKE_MARKED;
    }
    struct br_pen pen = {0}; /* none but a series' has a choice */
    if (c->stroke <= BR_STROKE_MARKED)
        pen = c->pen ? br_pen_of(c->pen - 1, c->pens) : br_pen_of(before, series);
    switch (c->stroke) {
    case BR_STROKE_SERIES:
        fprintf(out, "with lines lw 3 lc rgb '%s' dt %s", pen.colour, pen.dash);
        break;
    case BR_STROKE_MARKED:
        fprintf(out, "with linespoints lw 3 lc rgb '%s' dt %s pt %d ps %.2f*size", pen.colour,
                pen.dash, pen.mark, 0.65 * pen.size);
        break;
    case BR_STROKE_SOLID:
        fprintf(out, "with lines lw %d lc rgb '#0d0887'", p->inset ? 2 : 3);
        break;
    case BR_STROKE_DASHED:
        fprintf(out, "with lines lw 3 lc rgb '#de5f65' dt (10,5)");
        break;
    case BR_STROKE_DOTS:
        fprintf(out, "with points pt 6 lw 2 ps %s*size lc rgb '#222222'", p->inset ? "1.2" : "1.6");
        break;
    }
}

static void write_range(FILE *out, const char *axis, double low, double high)
{
    if (low < high)
        fprintf(out, "set %srange [%.6g:%.6g]\n", axis, low, high);
    else
        fprintf(out, "set %srange [*:*]\n", axis);
}

/* A label of an open line: its text in quotes. */
static void write_label(FILE *out, const char *tag, const char *text)
{
    fprintf(out, "set label %s", tag);
    br_quote(out, &br_for_gnuplot, text);
}

/* The axes' names are labels at fixed places, as in plots/frame.c. */
static void write_labels(FILE *out, const struct br_panel *p)
{
    const int font = p->inset ? 17 : BR_PAGE_FONT;
    const double middle = (p->left + p->right) / 2;
    write_label(out, "1 ", p->x_label);
    fprintf(out, " at screen %.4f,%.4f center font ',%d'\n", middle,
            p->bottom - (p->inset ? 0.07 : 0.095), font);
    write_label(out, "2 ", p->y_label);
    fprintf(out, " at screen %.4f,%.4f center rotate font ',%d'\n",
            p->left - (p->inset ? 0.048 : 0.068), (p->bottom + p->top) / 2, font);
    write_label(out, "3 ", p->title);
    fprintf(out, " at screen %.4f,%.4f center font ',%d'\n", middle,
            p->top + (p->inset ? 0.025 : 0.04), font);
}

static void write_marks(FILE *out, const struct br_panel *p)
{
    for (size_t i = 0; i < p->marks; i++) {
        const struct br_mark *m = &p->mark[i];
        fprintf(out,
                "set arrow from first %.9g,graph 0 to first %.9g,graph 1 nohead lw 2 dt (4,4) "
                "lc rgb '#444444'\n",
                m->x, m->x);
        write_label(out, "", m->label);
        fprintf(out, " at first %.9g,graph %.3g left rotate offset %s,0 font ',%d'\n", m->x,
                m->height, m->left ? "-1.6" : "1.8", BR_PAGE_SMALL);
    }
}

static void write_key(FILE *out, const struct br_panel *p)
{
    if (p->plain || p->inset) {
        fputs("unset key\n", out);
        return;
    }
    fprintf(
        out,
        "set key at screen %.4f,%.4f center top horizontal Left reverse samplen 2.5 maxcols %zu "
        "spacing 1.15 font ',%d'\n",
        (p->left + p->right) / 2, p->bottom - 0.13, p->columns ? p->columns : 3, BR_PAGE_SMALL);
}

static void write_title(FILE *out, const struct br_chart *chart)
{
    fputs("set label 4 ", out);
    br_quote(out, &br_for_gnuplot, chart->title);
    fprintf(out, " noenhanced at screen 0.02,0.955 left font ',%d'\n", BR_PAGE_FONT + 2);
}

static void write_panel(FILE *out, const struct br_chart *chart, size_t i, size_t first)
{
    const struct br_panel *p = &chart->panel[i];
    fputs("\nunset label\nunset arrow\nunset object\nunset logscale\n", out);
    fputs(p->inset ? "unset grid\n" : "set grid xtics ytics ls 102\n", out);
    if (i == 0)
        write_title(out, chart);
    if (p->inset) /* a white ground, with room for the numbers */
        fprintf(out,
                "set object 1 rectangle from screen %.4f,%.4f to screen %.4f,%.4f "
                "fc rgb 'white' fs solid 1 border lc rgb '#888888' behind\n",
                p->left - 0.068, p->bottom - 0.1, p->right + 0.012, p->top + 0.055);
    fprintf(out,
            "set lmargin at screen %.4f; set rmargin at screen %.4f\n"
            "set bmargin at screen %.4f; set tmargin at screen %.4f\n"
            "set xtics nomirror autofreq font ',%d'; set ytics nomirror autofreq font ',%d'\n"
            "set format x '%s'; set format y '%s'\n",
            p->left, p->right, p->bottom, p->top, p->inset ? 15 : BR_PAGE_SMALL,
            p->inset ? 15 : BR_PAGE_SMALL, p->log_x ? "10^{%L}" : "%g",
            p->log_y ? "10^{%L}" : "%g");
    if (p->log_x || p->log_y)
        fprintf(out, "set logscale %s%s\n", p->log_x ? "x" : "", p->log_y ? "y" : "");
    write_range(out, "x", p->x_low, p->x_high);
    write_range(out, "y", p->y_low, p->y_high);
    write_labels(out, p);
    write_marks(out, p);
    write_key(out, p);
    for (size_t j = 0; j < p->curves; j++) {
        fprintf(out, "%sdata index %zu using 1:2 ", j ? ", \\\n     " : "plot ", first + j);
        write_pen(out, p, j);
        fprintf(out, "%s", p->curve[j].title[0] ? " title " : " notitle");
        if (p->curve[j].title[0])
            br_quote(out, &br_for_gnuplot, p->curve[j].title);
    }
    fputc('\n', out);
}

void br_chart_write_script(FILE *out, const struct br_chart *chart)
{
    br_write_script_head(out, chart->title, NULL, chart->stem);
    fputs("set datafile missing 'NaN'\n"
          "set style line 102 lw 1 lc rgb '#d0d0d0' # grid\n",
          out);
    br_write_loop(out, BR_PAGE_WIDE, BR_PAGE_HEIGHT);
    fputs("set multiplot\n", out);
    size_t first = 0;
    for (size_t i = 0; i < chart->panels; i++) {
        write_panel(out, chart, i, first);
        first += chart->panel[i].curves;
    }
    fputs("unset multiplot\n", out);
    br_write_foot(out);
}
