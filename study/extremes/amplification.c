/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/extremes/amplification.h"

typedef long double real;

/* R(z), row by row: Y_i (1 - z a_ii) = 1 + z sum of a_ij Y_j. */
static double complex stability_function(const struct br_textbook *t, double complex z)
{
    long double complex y[BR_TEXTBOOK_ROWS];
    for (int i = 0; i < t->rows; i++) {
        long double complex sum = 1;
        for (int j = 0; j < i; j++)
            sum += z * t->a[i][j] * y[j];
        y[i] = sum / (1 - z * t->a[i][i]);
    }
    return (double complex)y[t->rows - 1];
}

/* Newton's method, from z = 0, where the root is 1, on to z in small steps. */
static double complex principal_root(const struct br_textbook *t, double complex z)
{
    enum { PIECES = 64, ITERATIONS = 8 };
    long double complex r = 1;
    for (int piece = 1; piece <= PIECES; piece++)
        for (int i = 0; i < ITERATIONS; i++) {
            long double complex value = 1 - t->beta * z * (real)piece / PIECES, slope = 0;
            for (int j = 0; j < t->back; j++) {
                slope = slope * r + value;
                value = value * r - t->past[j];
            }
            r -= value / slope;
        }
    return (double complex)r;
}

double complex br_amplification(const struct br_textbook *t, double complex z)
{
    return t->rows > 0 ? stability_function(t, z) : principal_root(t, z);
}
