/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the classes of random lines draw with (errors.c, held_out.c). */
#ifndef BR_TESTS_LAB_DRAW_H
#define BR_TESTS_LAB_DRAW_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "tests/lab/errors.h"

static inline double uniform(struct br_test_random *r, double a, double b)
{
    return br_test_uniform(r, a, b);
}

static inline double normal(struct br_test_random *r)
{
    return sqrt(-2 * log(1 - uniform(r, 0, 1))) * cos(2 * 3.14159265358979 * uniform(r, 0, 1));
}

static inline size_t whole(struct br_test_random *r, size_t a, size_t b)
{
    return a + br_test_index(r, b - a + 1);
}

static inline double pick(struct br_test_random *r, const double *v, size_t n)
{
    return v[br_test_index(r, n)];
}

#define PICK(r, ...) \
    pick(r, (const double[]){__VA_ARGS__}, sizeof((const double[]){__VA_ARGS__}) / sizeof(double))

static inline void mesh_sequence(struct br_test_random *r, struct br_error_line *s, size_t least,
                                 size_t most, double ratio)
{
    s->rows = whole(r, least, most);
    const double n0 = floor(uniform(r, 4, 20));
    for (size_t i = 0; i < s->rows; i++)
        s->h[i] = 1 / (n0 * pow(ratio, (double)i));
}

static inline double digits(double v, int d)
{
    char t[40];
    snprintf(t, sizeof t, "%.*e", d - 1, v);
    return strtod(t, NULL);
}

static inline double order(struct br_test_random *r)
{
    return PICK(r, 0.5, 1, 1.5, 2, 3, 4);
}

#define EACH_ROW for (size_t i = 0; i < s->rows; i++)

static inline double constant_of(struct br_test_random *r)
{
    return br_test_decades(r, -3, 3);
}

#endif
