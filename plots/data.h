/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A report as curves: error over h at fixed k, or over k at fixed n. */
#ifndef BR_PLOTS_DATA_H
#define BR_PLOTS_DATA_H

#include "plots/plots.h"

enum br_axis { BR_OVER_H, BR_OVER_K };

/* A range of an axis, in its unit; low > high: empty. */
struct br_range {
    double low, high;
};

/* What a curve's block of data holds: after h or k a column and a flag for each part,
 * then the printed errors. */
struct br_columns {
    size_t parts;
    enum br_part part[BR_PARTS];
    bool printed;
};

/* Steps through a list by size, without duplicates: the place of its smallest entry
 * above `after` (0 to begin with), or `count`. */
size_t br_next(const size_t *list, size_t count, size_t after);

/* How many different entries there are, and the place of the largest. */
size_t br_distinct(const size_t *list, size_t count);
size_t br_largest(const size_t *list, size_t count);

/* The study's list along an axis (n over h, steps over k); *count: its length. */
const size_t *br_axis_list(const struct br_report *report, enum br_axis axis, size_t *count);

/* h or k of an entry of that list, m or s. */
double br_axis_value(const struct br_report *report, enum br_axis axis, size_t entry);

/* Comment lines at the top of a data file: the report and what stands in a block. */
void br_write_heading(FILE *out, const struct br_report *report, const struct br_plot *plot);

/* One block, and the two empty lines that end it: the errors along `axis`, at the place
 * `fixed` of the other axis' list. A cell that failed is NaN. */
void br_write_block(FILE *out, const struct br_report *report, enum br_axis axis, size_t fixed,
                    const struct br_columns *columns);

/* The blocks of all curves along an axis. */
void br_write_blocks(FILE *out, const struct br_report *report, enum br_axis axis,
                     const struct br_columns *columns);

/* Widens a range of errors to hold what such a block shows. */
void br_include_block(struct br_range *range, const struct br_report *report, enum br_axis axis,
                      size_t fixed, const struct br_columns *columns);
void br_include_blocks(struct br_range *range, const struct br_report *report, enum br_axis axis,
                       const struct br_columns *columns);

#endif
