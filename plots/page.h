/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What all the scripts share: pens, captions, frames and slopes to compare with. */
#ifndef BR_PLOTS_PAGE_H
#define BR_PLOTS_PAGE_H

#include "plots/data.h"

/* A page's size, pixels, and the size of its letters. */
enum {
    BR_PAGE_HEIGHT = 800,
    BR_PAGE_NARROW = 1200,
    BR_PAGE_WIDE = 1500,
    BR_PAGE_FONT = 24,
    BR_PAGE_SMALL = 21
};

/* An order to compare with. */
struct br_order {
    double value;
    const char *label; /* for gnuplot, enhanced */
};

/* One pair of axes. Places are in gnuplot's "screen" units, 0 to 1 of the page from
 * its lower left. */
struct br_frame {
    enum br_axis axis;
    double left, right, bottom, top;
    struct br_range y;            /* of the errors */
    size_t orders;                /* 0: none are shown */
    const struct br_order *order; /* ascending, borrowed */
    const char *note;             /* after the x axis' label, borrowed; NULL: none */
    bool numbered;                /* along the y axis, which also has its label */
    int page;                     /* the page's width, pixels */
};

/* The pen of curve i of count. Marks shrink and get lighter, so that curves that lie on
 * one another can still be told apart. */
struct br_pen {
    const char *colour, *dash;
    int mark;    /* gnuplot's filled one; mark - 1 is hollow */
    double size; /* of the mark */
};
struct br_pen br_pen_of(size_t i, size_t count);

/* How every script begins: comments, and the variables `stem` and `data`, names of its files. What
 * it draws says a caption, and a title where that is not NULL. */
void br_write_script_head(FILE *out, const char *caption, const char *title, const char *stem);

/* The head of a report's script, with the styles of slopes and grid. */
void br_write_head(FILE *out, const struct br_report *report, const struct br_plot *plot,
                   const char *stem);

/* The beginning and the end of the loop over both formats; the page in pixels. */
void br_write_loop(FILE *out, int width, int height);
void br_write_foot(FILE *out);

/* In the loop: line styles 1 to `pens`, one a curve. */
void br_write_pens(FILE *out, size_t pens);

/* The caption, and a line below it (y: screen) with the fitted orders of one part. */
void br_write_caption(FILE *out, const struct br_report *report, int width);
void br_write_orders(FILE *out, const struct br_report *report, enum br_part part, double y);

/* Says what a hollow mark means, right-aligned at (x, y), screen, where there is one. */
void br_write_hollow(FILE *out, const struct br_report *report, const struct br_columns *columns,
                     double x, double y);

/* Axes, ticks and slopes of a frame. */
void br_write_frame(FILE *out, const struct br_report *report, const struct br_frame *frame);

#endif
