/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where everything of a figure stands on its page, and how it looks; for script.c. In pixels, from
 * the page's lower left. */
#ifndef BR_PLOTS_LAYOUT_H
#define BR_PLOTS_LAYOUT_H

#include "plots/figure.h"

enum { BR_FONT = 24, BR_SMALL = 21, BR_TINY = 16, BR_STYLE = 96, BR_ENTRIES = 40 };
#define BR_LINE_WIDTH 0.55 /* of a letter, over its height */

/* Colours of kinds, and how an empty cell is drawn. */
extern const char *const br_kind_colours[BR_FIGURE_KINDS];
extern const char br_empty_style[];

/* The hues as gnuplot's line styles, for marks of the script's `size`. */
void br_write_styles(FILE *out);

/* The pen of a series, as it stands after "with", into `style`, which is returned. */
const char *br_pen_of(const struct br_panel *panel, const struct br_series *series,
                      char style[BR_STYLE]);

/* The mark of its points, filled. */
int br_mark_of(const struct br_series *series);

/* What is to be seen of a series. */
struct br_seen {
    bool drawn, flagged;
};
struct br_seen br_look_at(const struct br_panel *panel, const struct br_series *series);

double br_decades(struct br_range range);

/* The ranges of a panel's axes, and where its guides stand. */
struct br_axes {
    struct br_range x, y;
    struct br_range fan; /* of the guides along x; their foot is at fan_y */
    double fan_y;
};
struct br_axes br_axes_of(const struct br_figure *figure, const struct br_panel *panel);

bool br_is_inset(const struct br_panel *panel);

/* The entries of a panel's key, its longest title, and how it is arranged in a space so wide. */
struct br_key {
    struct {
        const char *title;
        char style[BR_STYLE];
    } entry[BR_ENTRIES];
    size_t entries, longest, columns, rows;
};
struct br_key br_key_of(const struct br_figure *figure, const struct br_panel *panel, double width);

struct br_figure_page {
    double width, height;
    size_t across, down;
    double left, head, foot, top, bottom; /* around each panel; above and below all */
    double column;                        /* a panel's width with what is around it */
    double right;                         /* of each panel */
    bool beside;                          /* the key stands right of the only panel */
};
struct br_figure_page br_lay_out(const struct br_figure *figure);

/* Whether the title takes two lines. */
bool br_is_long(const struct br_figure *figure, double width);

/* A rectangle on the page, pixels. */
struct br_figure_box {
    double left, right, bottom, top;
};
struct br_figure_box br_panel_box(const struct br_figure *figure,
                                  const struct br_figure_page *layout, size_t panel);

#endif
