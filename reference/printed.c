/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/printed.h"

#include <math.h>

/* One row of a table: its errors at the columns' k, s. */
#define ROW(n, a, b, c, d, e, f) \
    {n, 0.01, a}, {n, 0.005, b}, {n, 0.002, c}, {n, 0.001, d}, {n, 0.0005, e}, {n, 0.0001, f},

/* clang-format off */
static const struct br_printed_cell table1[] = {
    ROW(100, 5.042e-3, 5.042e-3, 5.042e-3, 5.042e-3, 5.042e-3, 5.042e-3)
    ROW(200, 2.856e-3, 2.856e-3, 2.856e-3, 2.856e-3, 2.856e-3, 2.856e-3)
    ROW(400, 1.699e-3, 1.699e-3, 1.699e-3, 1.699e-3, 1.699e-3, 1.699e-3)
    ROW(800, 1.008e-3, 1.008e-3, 1.008e-3, 1.008e-3, 1.008e-3, 1.008e-3)
    ROW(1600, 5.639e-4, 5.637e-4, 5.637e-4, 5.636e-4, 5.636e-4, 5.636e-4)
    ROW(3200, 2.028e-4, 2.015e-4, 2.008e-4, 2.007e-4, 2.005e-4, 2.003e-4)
};

static const struct br_printed_cell table2[] = {
    ROW(100, 1.522e-2, 1.060e-2, 7.923e-3, 7.056e-3, 6.598e-3, 5.944e-3)
    ROW(200, 1.512e-2, 1.044e-2, 7.627e-3, 6.669e-3, 6.156e-3, 5.417e-3)
    ROW(400, 1.512e-2, 1.043e-2, 7.610e-3, 6.649e-3, 6.133e-3, 5.382e-3)
    ROW(800, 1.514e-2, 1.045e-2, 7.634e-3, 6.674e-3, 6.159e-3, 5.409e-3)
    ROW(1600, 1.516e-2, 1.049e-2, 7.670e-3, 6.718e-3, 6.200e-3, 5.453e-3)
    ROW(3200, 1.498e-2, 1.044e-2, 7.702e-3, 6.755e-3, 6.281e-3, 5.549e-3)
};
/* clang-format on */

const struct br_printed br_printed_table1 = {table1, sizeof table1 / sizeof *table1};
const struct br_printed br_printed_table2 = {table2, sizeof table2 / sizeof *table2};

double br_printed_error(const struct br_printed *printed, size_t n, double k)
{
    for (size_t i = 0; i < printed->count; i++)
        if (printed->cell[i].n == n && fabs(printed->cell[i].k - k) <= 1e-9 * k)
            return printed->cell[i].error;
    return NAN;
}
