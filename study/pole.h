/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Poles of a function between the places where it was looked at. */
#ifndef BR_POLE_H
#define BR_POLE_H

#include "solver/scene.h"

/* Along which a function is looked at: x of [0, end] at a time, or t of [0, end] at a place. */
struct br_line {
    const struct br_function *function;
    bool along_x;
    double other; /* the time, s, or the place, m */
    double end;   /* m or s */
};

/* The function at a place of the line. */
double br_line_value(const struct br_line *line, double at);

/* Looks at the line's `parts` + 1 equidistant places, of which there are 3 or more, some more near
 * both ends, and at what is between them: wherever the sign changes, or the size is the largest of
 * three, it halves towards that until neighbouring numbers are reached. A pole is where the size
 * still grows then, by 2.8 over each 8 halvings: of order 3/16 or above, like 1/(t - c), its root
 * and its square. Steep and finite functions have ceased to grow by then. Returns whether it found
 * a pole or a value that is not finite; *at and *value: where (as near as it came), and how large.
 */
bool br_find_pole(const struct br_line *line, size_t parts, double *at, double *value);

#endif
