/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A heat map: one value, or one kind, a cell of a plane, with lines across it; as data, written as
 * a gnuplot script and its data file. */
#ifndef BR_PLOTS_HEAT_H
#define BR_PLOTS_HEAT_H

#include <stdbool.h>
#include <stdio.h>

#include "solver/status.h"

enum { BR_HEAT_LINES = 4, BR_HEAT_KINDS = 8, BR_HEAT_PANELS = 6 };

/* A line over the cells, such as a predicted boundary. */
struct br_heat_line {
    char title[80]; /* enhanced */
    size_t count;
    double (*point)[2]; /* count; owned; NaN: a gap */
};

struct br_heat_panel {
    char title[96], x_label[64], y_label[64]; /* enhanced */
    size_t columns, rows;
    double *x, *y;     /* edges of the cells, columns + 1 and rows + 1, ascending; owned */
    bool log_x, log_y; /* edges are positive */
    double *value;     /* rows * columns, by rows; owned; NaN: an empty cell */
    struct br_heat_line line[BR_HEAT_LINES];
    size_t lines;
};

struct br_heat {
    char stem[128];       /* of the files */
    char title[160];      /* plain */
    char value_label[96]; /* of the colour bar, enhanced, with its unit */
    double low, high;     /* of the colours; both equal: by the data */
    bool log_value;
    char kind[BR_HEAT_KINDS]
             [48]; /* where values are kinds 0, 1, ...: their names instead of a bar */
    size_t kinds;
    struct br_heat_panel panel[BR_HEAT_PANELS];
    size_t panels;
};

/* Room for a panel's cells, all NaN, and its edges; fails with BR_NO_MEMORY. */
enum br_status br_heat_panel_init(struct br_heat_panel *panel, size_t columns, size_t rows,
                                  struct br_error *err);

/* A new line of `count` points, to be filled; NULL without memory or room. The title is a format.
 */
__attribute__((format(printf, 3, 4))) double (*br_heat_line(struct br_heat_panel *panel,
                                                            size_t count, const char *title,
                                                            ...))[2];

/* The ends of the colours: as given, or of the data, without what has no place among them. */
void br_heat_range(const struct br_heat *heat, double *low, double *high);

/* Whether a cell has a colour: NaN has none, nor has what is no kind. Values beyond the ends, the
 * infinite ones among them, have the colour of the nearer end. */
bool br_heat_told(const struct br_heat *heat, double value);

/* The data, and the script that draws stem.svg and stem.png from stem.dat. */
void br_heat_write_data(FILE *out, const struct br_heat *heat);
void br_heat_write_script(FILE *out, const struct br_heat *heat);
void br_heat_clear(struct br_heat *heat);

#endif
