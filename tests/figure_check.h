/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A figure's data file read back, and held against the figure. */
#ifndef BR_TESTS_FIGURE_CHECK_H
#define BR_TESTS_FIGURE_CHECK_H

#include "plots/figure.h"
#include "support.h"

/* What a writer writes; to be freed. */
char *figure_written(const struct br_figure *figure,
                     void (*write)(FILE *, const struct br_figure *));

/* Every column of the data file is the figure's, to the last bit, block by block, under the names
 * of its axes; and the script draws each block from its own columns, along axes of these names. */
void figure_check(const struct br_figure *figure);

/* The series of that title; fails where there is none. */
const struct br_series *figure_series(const struct br_panel *panel, const char *title);

/* The axis' label begins so, and the point has these values (NAN: a gap). */
void figure_axes(const struct br_panel *panel, const char *x_label, const char *y_label);
void figure_point(const struct br_series *series, size_t i, double x, double y);

#endif
