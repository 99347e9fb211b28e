/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A picture as data: panels of series between axes, or of coloured cells. A filler fills it from a
 * result (plots/pictures.h), layout.c lays it out, and script.c alone writes it for gnuplot.
 *
 * Series grow as points are added. A filler need not look whether there was memory: the figure
 * remembers, and br_figure_check tells. Texts are in gnuplot's enhanced markup unless they are
 * called plain; plain ones may come from a scene. */
#ifndef BR_PLOTS_FIGURE_H
#define BR_PLOTS_FIGURE_H

#include <stdbool.h>
#include <stdio.h>

#include "solver/status.h"

enum {
    BR_FIGURE_PANELS = 6,
    BR_FIGURE_NOTES = 2,
    BR_FIGURE_KINDS = 8,
    BR_PANEL_MARKS = 3,
    BR_PANEL_GUIDES = 4,
    BR_HUES = 6 /* that can be told apart; each has a dash and a mark of its own */
};

/* How a series is drawn. The first two are in a hue; a panel's seventh series without a hue of its
 * own is grey, one of the "others". */
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
    double x, y; /* not finite: a gap */
    const char
        *flag; /* why it counts less, a word: its mark is hollow; NULL: it counts. Borrowed */
};

struct br_series {
    char title[80]; /* "": not in the key */
    enum br_pen pen;
    size_t hue, mark; /* 1 to BR_HUES; mark 0: that of the hue */
    struct br_figure_point *point;
    size_t count, room; /* no points: it stands in the key alone */
    bool failed;
};

/* Cells of a plane. value: rows * columns, by rows; NaN: an empty cell. */
struct br_cells {
    size_t columns, rows;
    double *x, *y, *value; /* x, y: edges, columns + 1 and rows + 1, ascending; owned */
};

/* A line across a panel at one x, with a name. */
struct br_mark {
    double x;
    char label[64];
    double height; /* of the label, 0 to 1 of the panel */
    bool left;     /* the label stands left of the line */
};

/* An order to compare slopes with; ascending in a panel. */
struct br_guide {
    double order;
    char label[40];
};

/* low 0, high 0: that end is found from the data. */
struct br_range {
    double low, high;
};

struct br_panel {
    char title[96], x_label[96], y_label[64], top_label[32];
    bool log_x, log_y;
    struct br_range x, y;
    struct br_series **series; /* count; owned */
    size_t count, room;
    struct br_series top;  /* ticks of the upper axis: at x stands the number y */
    struct br_cells cells; /* 0 columns: none */
    struct br_mark mark[BR_PANEL_MARKS];
    struct br_guide guide[BR_PANEL_GUIDES];
    size_t marks, guides;
    struct br_range inset_x, inset_y; /* 0 to 1 of the panel before, in which it is drawn; all 0:
                                         it stands beside it */
    bool failed;
};

struct br_figure {
    char stem[512];                  /* of the files, plain */
    char title[1024];                /* plain */
    char about[256];                 /* a comment in the files, plain */
    char note[BR_FIGURE_NOTES][256]; /* lines below the title, plain */
    char hollow[48];                 /* what a hollow mark means */
    bool one_key;                    /* of the first panel, below all */
    bool one_y;                      /* all panels share the range of y */
    struct br_panel panel[BR_FIGURE_PANELS];
    size_t panels;
    /* Of cells: */
    char value_label[96]; /* of the colour bar */
    struct br_range value;
    bool log_value;
    double neutral;                 /* the value that is white between two hues; 0: none */
    char kind[BR_FIGURE_KINDS][64]; /* where values are kinds 0, 1, ...: their names, no bar */
    size_t kinds;
};

/* Fills a text of a figure. */
#define BR_SAY(text, ...) snprintf((text), sizeof(text), __VA_ARGS__)

/* A new panel (there must be room), and a new series of it, to be filled; NULL without memory,
 * which the functions below take. The title is a format. */
struct br_panel *br_panel_add(struct br_figure *figure);
__attribute__((format(printf, 3, 4))) struct br_series *br_series_add(struct br_panel *panel,
                                                                      enum br_pen pen,
                                                                      const char *title, ...);
void br_point_add(struct br_series *series, double x, double y, const char *flag);

/* A new mark (there must be room), and a new guide. The label is a format. */
__attribute__((format(printf, 3, 4))) struct br_mark *br_mark_add(struct br_panel *panel, double x,
                                                                  const char *label, ...);
void br_guide_add(struct br_panel *panel, double order, const char *label);

/* Makes a panel's cells, all NaN, with their edges to be filled. Whether there was memory. */
bool br_cells_make(struct br_panel *panel, size_t columns, size_t rows);

/* The hue of entry i of a sorted list, so that at most BR_HUES of them, spread evenly, have one;
 * 0: it is one of the others. */
size_t br_hue_of(size_t i, size_t count);

/* Whether a point can be drawn: finite, and positive along logarithmic axes. */
bool br_is_drawn(const struct br_panel *panel, const struct br_figure_point *point);

/* The ends of the colours: as given, or of the data, without what has no place among them. */
struct br_range br_value_range(const struct br_figure *figure);

/* Whether a cell has a colour: NaN has none, nor has what is no kind. Values beyond the ends have
 * the colour of the nearer end. */
bool br_is_coloured(const struct br_figure *figure, double value);

/* Fails with BR_NO_MEMORY where something is missing in the figure. */
enum br_status br_figure_check(const struct br_figure *figure, struct br_error *err);
void br_figure_clear(struct br_figure *figure);

/* The data: a block for each panel's cells and each series with points. */
void br_figure_write_data(FILE *out, const struct br_figure *figure);

/* ---- script.c ---- */

/* The script that draws stem.svg, stem.png and, where gnuplot can, stem.pdf from stem.dat. */
void br_figure_write_script(FILE *out, const struct br_figure *figure);

/* A script that draws the panels one below the other with letters, `columns` wide, into the file
 * `output`; its data are in it. */
void br_figure_write_letters(FILE *out, const struct br_figure *figure, int columns,
                             const char *output);

/* How every script begins: comments, and the variable `stem`. pictures: what it draws. */
void br_script_head(FILE *out, const char *title, const char *stem, const char *pictures);

#endif
