/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's printed tables, as data: reference/printed/table1.csv and table2.csv. */
#ifndef BR_REFERENCE_PRINTED_H
#define BR_REFERENCE_PRINTED_H

#include "solver/status.h"

struct br_printed_cell {
    size_t n;
    double k;     /* s */
    double error; /* as printed, m^(3/2) */
};

struct br_printed {
    struct br_printed_cell *cell; /* owned */
    size_t count;
};

/* Reads a file with the columns n,k,error and a heading. Fails with BR_BAD_INPUT,
 * naming file and line. */
enum br_status br_printed_read(const char *path, struct br_printed *printed, struct br_error *err);
void br_printed_clear(struct br_printed *printed);

/* The printed error of (n, k), or NaN where the paper has none. */
double br_printed_error(const struct br_printed *printed, size_t n, double k);

#endif
