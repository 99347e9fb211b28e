/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's Tables 1 and 2, as they are printed. */
#ifndef BR_REFERENCE_PRINTED_H
#define BR_REFERENCE_PRINTED_H

#include <stddef.h>

struct br_printed_cell {
    size_t n;
    double k;     /* s */
    double error; /* as printed, m^(3/2) */
};

struct br_printed {
    const struct br_printed_cell *cell;
    size_t count;
};

extern const struct br_printed br_printed_table1, br_printed_table2;

/* The printed error of (n, k), or NaN where the paper has none. */
double br_printed_error(const struct br_printed *printed, size_t n, double k);

#endif
