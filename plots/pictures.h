/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures: the figure as data, the fillers that make a figure of a report, and gnuplot, which
 * draws it. The fillers of the beam's reports are in plots/beam/pictures.h. */
#ifndef BR_PLOTS_PICTURES_H
#define BR_PLOTS_PICTURES_H

#include <stdbool.h>
#include <stdio.h>
#include <sys/types.h>

#include "base/status.h"

struct br_orders;
struct br_check;
struct br_point;
struct br_work_precision;

/* ---- figure.c ---- */

/* A picture as data: panels of series between axes, and one key for all of
 * them. A filler fills it from a result. Only script.c writes it for gnuplot.
 *
 * Fillers add to the last panel, and need not check for lack of memory: the figure remembers it,
 * and br_figure_check reports it. Texts are in gnuplot's enhanced markup unless they are called
 * plain; plain ones may come from a scene. */

enum {
    BR_FIGURE_PANELS = 6,
    BR_FIGURE_NOTES = 3,
    BR_HUES = 6 /* that people can distinguish; each has a dash and a mark of its own */
};

/* How a series is drawn. The first four have a hue; without a free hue they become BR_PEN_OTHERS.
 */
enum br_pen {
    BR_PEN_CURVE, /* a line with marks */
    BR_PEN_MARKS, /* marks alone */
    BR_PEN_AREA,  /* pale, behind the others: what the points go around */
    BR_PEN_LINE,  /* a line, for many points */
    BR_PEN_OTHERS,
    BR_PEN_GUIDE, /* a prediction, or a line to compare with: thin, dark, dashed */
    BR_PEN_BAND,  /* wide and pale, behind the others */
    BR_PEN_DOTS,  /* points, here small and grey */
    BR_PEN_RINGS,
    BR_PEN_SQUARES,
    BR_PEN_PLUSES,
    BR_PEN_STARS,
    BR_PEN_SIGNS, /* a mark in black, for a key whose hues mean something else */
    BR_PEN_THIN,  /* a thin dark line: a triangle of an order, the bar of an interval */
    BR_PENS
};

struct br_figure_point {
    double x, y; /* not finite: a gap */
    const char
        *flag; /* a word that says why it counts less: its mark is hollow; NULL: none. Borrowed */
};

/* Series of one pen and title have one style in all panels, and one entry in the key. */
struct br_series {
    char title[160]; /* "": not in the key */
    char end[100];   /* a text beside the last point; of a panel with rows, left of its axis */
    bool end_left;   /* it stands left of the point */
    bool stairs;     /* a line that keeps y until the next x, as a Pareto front does */
    enum br_pen pen;
    size_t style; /* 1, 2, ...: the hue; of a guide its dash */
    bool in_key;  /* the first one of its title */
    size_t mark;  /* 1 to BR_HUES: another hue's mark; 0: its own */
    struct br_figure_point *point;
    size_t count, room; /* no points: it is only in the key */
    bool failed;
};

struct br_range {
    double low, high;
};

struct br_panel {
    char title[96], x_label[96], y_label[96], top_label[32];
    bool log_x, log_y;
    bool margins;              /* beside the points of a linear x */
    bool rows;                 /* y is the number of a row, whose label is the end of a series */
    struct br_series **series; /* `count` of them; owned */
    size_t count, room;
    struct br_series top; /* ticks of the upper axis: the number y is printed at x */
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
    struct br_series lost; /* a filler gets this one when there is no memory */
};

/* Fills a text of a figure. */
#define BR_SAY(text, ...) snprintf((text), sizeof(text), __VA_ARGS__)

/* A foreign name, shortened by whole characters, plain; returns text (out). */
enum { BR_SHORT_NAME = 40 };
char *br_short_name(const char *name, char text[BR_SHORT_NAME]);

/* Sets a label: "error (m)" of a name in markup and a plain unit; NULL or "": none. */
void br_label_set(char label[96], const char *name, const char *unit);

/* Adds a panel, with logarithmic axes or with linear ones; there must be room. The label of y is a
 * format. */
__attribute__((format(printf, 4, 5))) struct br_panel *br_panel_add(struct br_figure *figure,
                                                                    bool logarithmic,
                                                                    const char *x_label,
                                                                    const char *y_label, ...);

/* Adds a series, to be filled, to the last panel. The title is a format. */
__attribute__((format(printf, 3, 4))) struct br_series *br_series_add(struct br_figure *figure,
                                                                      enum br_pen pen,
                                                                      const char *title, ...);
void br_point_add(struct br_series *series, double x, double y, const char *flag);

/* Sorts the points by x, then by y; stairs: a Pareto front, of the points whose y falls. */
void br_series_sort(struct br_series *series);
void br_series_stairs(struct br_series *series);

/* Call these after the panel's series are filled. br_mark_add draws a line across the last panel at
 * one x, with a title in the key. br_slope_add draws a triangle of an order beside a series of a
 * panel with logarithmic axes, where no other series is near; false: there is no such place, or the
 * panel has a triangle of that order. */
void br_mark_add(struct br_figure *figure, double x, const char *title);
bool br_slope_add(struct br_figure *figure, const struct br_series *series, double order);

/* Whether a point can be drawn: finite, and positive along logarithmic axes. */
bool br_is_drawn(const struct br_panel *panel, const struct br_figure_point *point);

/* The range of the points that are drawn, without areas, which may be wide; low > high: there are
 * none. */
struct br_range br_extent(const struct br_panel *panel, bool along_y);

/* Fails with BR_NO_MEMORY if a part of the figure is missing, and with BR_BAD_INPUT if its stem
 * cannot begin a file's name; a figure for the terminal has no stem. */
enum br_status br_figure_check(const struct br_figure *figure, struct br_error *err);
void br_figure_clear(struct br_figure *figure);

/* Writes the data: a block for each series with points. */
void br_figure_write_data(FILE *out, const struct br_figure *figure);

/* ---- script.c ---- */

/* Writes the script that draws stem.svg, stem.png and, if gnuplot can, stem.pdf from stem.dat. */
void br_figure_write_script(FILE *out, const struct br_figure *figure);

/* ==== the fillers ====
 *
 * Each makes a figure of a result, and computes only the points' positions. Clear the figure;
 * br_figure_check reports lack of memory. */

/* ---- orders.c: any program's errors ---- */

/* A panel over the size of elements, and one over that of steps. Each quantity has a line, at the
 * finest size of the other kind. */
struct br_figure br_orders_draw(const struct br_orders *orders, const char *caption);

/* Adds errors over sizes to the last panel: marks, the line that was fitted to them and its band;
 * or joined marks where none was fitted. Returns the marks. */
struct br_series *br_points_draw(struct br_figure *figure, const char *title,
                                 const struct br_point *point, size_t count, bool fitted);

/* ---- work.c: errors over costs of several programs ---- */

/* A panel for each of the works, which are quantities: each program's own stairs, and the front. */
struct br_figure br_work_draw(const struct br_work_precision *works, size_t count,
                              const char *caption);

/* ---- check.c: observed orders beside what is expected ---- */

/* A row an order or, of many, a check. No panels if there is no order. */
struct br_figure br_check_draw(const struct br_check *checks, size_t count);

/* ---- render.c ---- */

/* Running gnuplot. All fail with BR_IO if gnuplot fails (the message is its line about
 * the error), or takes longer than a minute (or BEAMRATE_GNUPLOT_SECONDS); with BR_INTERRUPTED when
 * the work must stop (br_must_stop). A gnuplot that has not ended is killed. */

/* A gnuplot that works on a script; several may run side by side. */
enum { BR_SCRIPT_NAME = 512 };
struct br_gnuplot {
    char folder[4096], script[BR_SCRIPT_NAME];
    pid_t child;
    FILE *said;     /* its messages */
    double started; /* s, by the monotonic clock */
};

/* Starts gnuplot on a script in its folder. *missing (out): gnuplot is not installed, and the call
 * fails. After a success, call br_gnuplot_end. */
enum br_status br_gnuplot_start(struct br_gnuplot *g, const char *folder, const char *script,
                                bool *missing, struct br_error *err);

/* Waits for the end. Fails, too, if a picture is incomplete (a full disk), which gnuplot itself
 * does not check. After any failure it removes all pictures of the figure. */
enum br_status br_gnuplot_end(struct br_gnuplot *g, struct br_error *err);

#endif
