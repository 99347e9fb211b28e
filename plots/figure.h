/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A picture as data: panels of series between axes, or of coloured cells, and one key for all of
 * them. A filler fills it from a result (plots/pictures.h), and script.c alone writes it for
 * gnuplot, which lays it out.
 *
 * Fillers add to the last panel, and need not look whether there was memory: the figure remembers,
 * and br_figure_check tells. Texts are in gnuplot's enhanced markup unless they are called plain;
 * plain ones may come from a scene. */
#ifndef BR_PLOTS_FIGURE_H
#define BR_PLOTS_FIGURE_H

#include <stdbool.h>
#include <stdio.h>

#include "solver/status.h"

enum {
    BR_FIGURE_PANELS = 6,
    BR_FIGURE_NOTES = 3,
    BR_FIGURE_KINDS = 8,
    BR_HUES = 6 /* that can be told apart; each has a dash and a mark of its own */
};

/* How a series is drawn. The first two are in a hue; where none is left, they are grey, two of the
 * "others". */
enum br_pen {
    BR_PEN_CURVE, /* a line with marks */
    BR_PEN_LINE,  /* a line, for many points */
    BR_PEN_OTHERS,
    BR_PEN_GUIDE, /* what is predicted or compared with: thin, dark, dashed */
    BR_PEN_BAND,  /* wide and pale, behind the others */
    BR_PEN_DOTS,  /* points: small and grey, */
    BR_PEN_RINGS, /* and so on */
    BR_PEN_SQUARES,
    BR_PEN_PLUSES,
    BR_PEN_STARS,
    BR_PEN_SIGNS, /* a mark in black, for a key whose hues mean something else */
    BR_PENS
};

struct br_figure_point {
    double x, y;      /* not finite: a gap */
    const char *flag; /* a word, why it counts less: its mark is hollow; NULL: none. Borrowed */
};

/* Series of one pen and title look the same in all panels, and have one entry in the key. */
struct br_series {
    char title[80]; /* "": not in the key */
    char end[16];   /* a text beside the last point */
    enum br_pen pen;
    size_t look; /* 1, 2, ...: the hue; of a guide its dash */
    bool in_key; /* the first one of its title */
    size_t mark; /* 1 to BR_HUES: another hue's mark; 0: its own */
    struct br_figure_point *point;
    size_t count, room; /* no points: it stands in the key alone */
    bool failed;
};

/* Cells of a plane. value: rows * columns, by rows; NaN: an empty cell. */
struct br_cells {
    size_t columns, rows;
    double *x, *y, *value; /* x, y: edges, columns + 1 and rows + 1, ascending; owned */
};

struct br_range {
    double low, high;
};

struct br_panel {
    char title[96], x_label[96], y_label[96], top_label[32];
    bool log_x, log_y;
    struct br_series **series; /* count; owned */
    size_t count, room;
    struct br_series top;  /* ticks of the upper axis: at x stands the number y */
    struct br_cells cells; /* 0 columns: none */
};

struct br_figure {
    char stem[512];                  /* of the files, plain */
    char title[1024];                /* plain */
    char about[256];                 /* a comment in the files, plain */
    char note[BR_FIGURE_NOTES][256]; /* lines below the title, plain */
    char hollow[48];                 /* what a hollow mark means */
    bool one_y;                      /* all panels share the range of y */
    struct br_panel panel[BR_FIGURE_PANELS];
    size_t panels;
    bool failed;
    struct br_series lost; /* what a filler gets where there is no memory */
    /* Of cells: factors, by size, with white at 1; or, where they are kinds 0, 1, ..., names. */
    char value_label[96];
    struct br_range value; /* the ends of the colours: below and above 1 */
    char kind[BR_FIGURE_KINDS][64];
    size_t kinds;
};

/* Fills a text of a figure. */
#define BR_SAY(text, ...) snprintf((text), sizeof(text), __VA_ARGS__)

/* A new panel; there must be room. */
struct br_panel *br_panel_add(struct br_figure *figure, const char *x_label, const char *y_label);

/* A new series of the last panel, to be filled. The title is a format. */
__attribute__((format(printf, 3, 4))) struct br_series *br_series_add(struct br_figure *figure,
                                                                      enum br_pen pen,
                                                                      const char *title, ...);
void br_point_add(struct br_series *series, double x, double y, const char *flag);

/* Brings the points into the order of x; of equals the least y first. */
void br_series_sort(struct br_series *series);

/* To the last panel, when its series are there: a line across it at one x, with a title in the key,
 * and right of all points (both axes are logarithmic) slopes to compare with, ascending. */
void br_mark_add(struct br_figure *figure, double x, const char *title);
void br_slopes_add(struct br_figure *figure, size_t count, const double *order);

/* Makes the last panel's cells, all NaN, with their edges to be filled; NULL without memory. */
struct br_cells *br_cells_make(struct br_figure *figure, size_t columns, size_t rows);

/* Whether a point can be drawn: finite, and positive along logarithmic axes. */
bool br_is_drawn(const struct br_panel *panel, const struct br_figure_point *point);

/* The range of the points that are drawn; low > high: there are none. */
struct br_range br_extent(const struct br_panel *panel, bool along_y);

/* What a cell is coloured by: its kind, or its value brought between the ends; -1: it is empty. */
double br_colour_of(const struct br_figure *figure, double value);

/* Fails with BR_NO_MEMORY where something is missing in the figure, and with BR_BAD_INPUT where its
 * stem is not the beginning of a file's name; a figure for the terminal has none. */
enum br_status br_figure_check(const struct br_figure *figure, struct br_error *err);
void br_figure_clear(struct br_figure *figure);

/* The data: a block for each panel's cells and each series with points. */
void br_figure_write_data(FILE *out, const struct br_figure *figure);

/* ---- script.c ---- */

/* The script that draws stem.svg, stem.png and, where gnuplot can, stem.pdf from stem.dat. */
void br_figure_write_script(FILE *out, const struct br_figure *figure);

/* A script that draws the panels one below the other with letters, `columns` wide, on standard
 * output; its data are in it. */
void br_figure_write_letters(FILE *out, const struct br_figure *figure, int columns);

/* How every script begins: comments, and the variables `stem` and `data`. pictures: what it draws.
 */
void br_script_head(FILE *out, const char *title, const char *stem, const char *pictures);

#endif
