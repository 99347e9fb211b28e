/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures: the figure as data, the fillers that make a figure of each report, and gnuplot, which
 * draws it.
 *
 * To add a picture, write a filler, and a row of its registry or a declaration below. */
#ifndef BR_PLOTS_PICTURES_H
#define BR_PLOTS_PICTURES_H

#include <stdbool.h>
#include <stdio.h>
#include <sys/types.h>

#include "base/status.h"

struct br_named_method;
struct br_named_methods;
struct br_norm;
struct br_orders;
struct br_check;
struct br_example;
struct br_floors;
struct br_history_record;
struct br_paper;
struct br_report;
struct br_scene;
struct br_split;
struct br_stability;
struct br_trade;
struct br_trial;

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
    BR_PENS
};

struct br_figure_point {
    double x, y; /* not finite: a gap */
    const char
        *flag; /* a word that says why it counts less: its mark is hollow; NULL: none. Borrowed */
};

/* Series of one pen and title have one style in all panels, and one entry in the key. */
struct br_series {
    char title[80]; /* "": not in the key */
    char end[80];   /* a text beside the last point; of a panel with rows, left of its axis */
    bool stairs;    /* a line that keeps y until the next x, as a Pareto front does */
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

/* Adds a panel; there must be room. */
struct br_panel *br_panel_add(struct br_figure *figure, const char *x_label, const char *y_label);

/* Adds a series, to be filled, to the last panel. The title is a format. */
__attribute__((format(printf, 3, 4))) struct br_series *br_series_add(struct br_figure *figure,
                                                                      enum br_pen pen,
                                                                      const char *title, ...);
void br_point_add(struct br_series *series, double x, double y, const char *flag);

/* Marks, a line that was fitted to them, and its band, to the last panel. Add each point, and then
 * the upper end of the band, from the last point to the first. Numbers may be NaN. */
struct br_fitted_series {
    struct br_series *area, *line, *marks;
};
struct br_fitted_series br_fitted_series_add(struct br_figure *figure, const char *title);
void br_fitted_point_add(const struct br_fitted_series *series, double x, double y,
                         const char *flag, double fit, double low);

/* Sorts the points by x, then by y. */
void br_series_sort(struct br_series *series);

/* Call these two after the panel's series are filled. br_mark_add draws a line across the last
 * panel at one x, with a title in the key; br_slopes_add draws slopes to compare with, ascending,
 * right of all points of a panel with logarithmic axes. */
void br_mark_add(struct br_figure *figure, double x, const char *title);
void br_slopes_add(struct br_figure *figure, size_t count, const double *order);

/* Puts an order into an ascending list of `count`, unless the list has it; returns the new count.
 */
size_t br_slope_put(double *order, size_t count, double new);

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

/* ---- convergence.c: a study's errors ---- */

/* A row of the registry. Its files are <report->name>-<name>.dat, .gp and so on. */
struct br_convergence_picture {
    const char *name;
    const char *title; /* one line for a person */
    const char *short_title;
    bool (*applies)(const struct br_report *report);
    void (*fill)(const struct br_report *report, struct br_figure *figure);
};
extern const struct br_convergence_picture *const br_convergence_pictures[]; /* NULL-terminated */

/* Call picture->applies first. */
struct br_figure br_convergence_draw(const struct br_convergence_picture *picture,
                                     const struct br_report *report);

/* ---- trade.c: what a digit costs ---- */

/* A method's stairs join the trials that none of its own beats; dots are the others. */
struct br_trade_picture {
    const char *name;  /* of the files: <scene>-<name>.gp and so on */
    const char *title; /* one line for a person */
    const char *short_title;
    /* Whether a method has a curve. */
    bool (*shows)(const struct br_trade *trade, const struct br_named_method *named);
    const char *label;                            /* of the axis of work, with its unit */
    double (*work)(const struct br_trial *trial); /* along that axis; NaN: not drawn */
};
extern const struct br_trade_picture *const br_trade_pictures[]; /* NULL-terminated */

/* Whether the picture has anything to show. */
bool br_trade_picture_applies(const struct br_trade_picture *picture, const struct br_trade *trade);

struct br_figure br_trade_draw(const struct br_trade_picture *picture, const struct br_trade *trade,
                               const char *name, const char *caption);

/* ---- check.c: observed orders beside what is expected ---- */

/* A row an order or, of many, a check. No panels if there is no order. */
struct br_figure br_check_draw(const struct br_check *checks, size_t count);

/* ---- split.c: where the error comes from ---- */

/* A panel for each of the first two methods among the runs. The axis is k on the finest mesh, if
 * the runs differ in k, or else h at the smallest k; no panels if no two runs differ in either. */
struct br_figure br_split_draw(const struct br_split *split, size_t count);

/* ---- orders.c: any program's errors ---- */

/* A panel over the size of elements, and one over that of steps. Each quantity has a line, at the
 * finest size of the other kind. */
struct br_figure br_orders_draw(const struct br_orders *orders, const char *caption);

/* ---- extremes.c ---- */

/* Deviation from the exact discrete solution over n, at time step number k; or, for round-off that
 * adds up, over the number of steps. */
struct br_figure br_floors_draw(const struct br_floors *floors, size_t k);
/* Stable and unstable marches over n and k, and over c_H and k. */
struct br_figure br_stability_draw(const struct br_stability *stability);

/* ---- paper.c: Figures 2 to 10 ---- */

/* A row of the registry, in the order of the paper. */
struct br_paper_figure {
    int number;
    size_t example;     /* 1 to 4 */
    const char *title;  /* the paper's caption */
    const char *says;   /* the statement in the paper's text */
    const char *beside; /* what we add to the paper's picture; may be NULL */
    bool bending;       /* it shows the beam's w, not the rod's u; fill is NULL then */
    void (*fill)(const struct br_paper *paper, struct br_figure *figure);
    void (*mark)(const struct br_example *example, struct br_figure *figure); /* may be NULL */
};
extern const struct br_paper_figure br_paper_figures[]; /* ends with number 0 */

struct br_figure br_paper_figure_draw(const struct br_paper_figure *row,
                                      const struct br_paper *paper);

/* ---- run.c: the tip of a run over time ---- */

/* The offset of a number in struct br_history_row. */
#define BR_ROW(member) offsetof(struct br_history_row, member)

/* Adds a line: a number of all rows, times `factor`, over time. */
void br_rows_add(struct br_figure *figure, enum br_pen pen, const char *title,
                 const struct br_history_record *record, size_t place, double factor);

/* Its files are called history. */
struct br_figure br_history_draw(const struct br_scene *scene,
                                 const struct br_history_record *record);

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
