/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All that tables and plots show of one study: they compute nothing themselves. */
#ifndef BR_REPORT_H
#define BR_REPORT_H

#include "study/fit.h"
#include "study/triangle.h"

enum { BR_MOST_TRIANGLES = 4 };

struct br_report {
    const char *name;        /* file name stem: "table1", or the scene's name; borrowed */
    const char *caption;     /* one line; borrowed */
    struct br_study *study;  /* borrowed */
    struct br_fits fits[BR_PARTS];
    double *printed;         /* n_count * k_count, m^(3/2), by rows; NaN: none; NULL: no table */
    struct br_triangle triangle[BR_MOST_TRIANGLES];
    size_t triangles;
    double wall_seconds;     /* of the whole study */
};

#endif
