/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A picture of curves in panels, as data; written as a gnuplot script and its data file. */
#ifndef BR_PLOTS_CHART_H
#define BR_PLOTS_CHART_H

#include <stdbool.h>
#include <stdio.h>

#include "solver/status.h"

enum { BR_CHART_PANELS = 3, BR_CHART_CURVES = 16, BR_CHART_MARKS = 3 };

/* How a curve is drawn. */
enum br_stroke {
    BR_STROKE_SERIES, /* one of several of a kind: the pens of plots/page.h */
    BR_STROKE_MARKED, /* the same, with marks */
    BR_STROKE_SOLID,  /* dark, thick */
    BR_STROKE_DASHED, /* red, dashed */
    BR_STROKE_DOTS,   /* circles */
};

struct br_curve {
    char title[80]; /* enhanced; "": not in the key */
    enum br_stroke stroke;
    size_t pen, pens; /* of a series: pen 1, 2, ... of so many; 0: by its place in the panel */
    size_t count;
    double (*point)[2]; /* count; owned; NaN: a gap */
};

/* A line across a panel at one x, with a name. */
struct br_mark {
    double x;
    char label[64]; /* enhanced */
    double height;  /* of the label, 0 to 1 of the panel */
    bool left;      /* the label stands left of the line */
};

struct br_panel {
    double left, right, bottom, top;          /* of 1, the page from its lower left */
    char title[96], x_label[64], y_label[64]; /* enhanced */
    double x_low, x_high, y_low, y_high;      /* both equal: by the data */
    bool log_x, log_y;
    bool inset;     /* small, on a white ground, over the one before */
    bool plain;     /* no key below */
    size_t columns; /* of the key; 0: 3 */
    struct br_curve curve[BR_CHART_CURVES];
    size_t curves;
    struct br_mark mark[BR_CHART_MARKS];
    size_t marks;
};

struct br_chart {
    char stem[128];  /* of the files */
    char title[160]; /* plain */
    struct br_panel panel[BR_CHART_PANELS];
    size_t panels;
};

/* Two panels side by side on a chart, with their titles and labels to be filled; or one. */
void br_chart_lay_out(struct br_chart *chart, size_t panels);

/* A new curve of `count` points, to be filled; NULL without memory or room. The title is a format.
 */
__attribute__((format(printf, 4, 5))) double (*br_chart_curve(struct br_panel *panel,
                                                              enum br_stroke stroke, size_t count,
                                                              const char *title, ...))[2];

/* A new mark; the label is a format. */
__attribute__((format(printf, 3, 4))) struct br_mark *br_chart_mark(struct br_panel *panel,
                                                                    double x, const char *label,
                                                                    ...);

/* The data, one block a curve, and the script that draws stem.svg and stem.png from stem.dat. */
void br_chart_write_data(FILE *out, const struct br_chart *chart);
void br_chart_write_script(FILE *out, const struct br_chart *chart);
void br_chart_clear(struct br_chart *chart);

#endif
