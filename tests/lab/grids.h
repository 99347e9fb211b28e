/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Classes of random grids of errors in h and k with known orders, drawn from a seed:
 *     e^2 = a^2 + 2 r a b + b^2,   a = C_h h^p,   b = C_k k^q,
 * with what programs add to it: noise, floors, next terms, missing cells. */
#ifndef BR_TESTS_LAB_GRIDS_H
#define BR_TESTS_LAB_GRIDS_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "tests/lab/errors.h"

enum { BR_GRID_MOST = 36 };

struct br_grid {
    size_t meshes, steps, rows;
    double h[BR_GRID_MOST], k[BR_GRID_MOST], e[BR_GRID_MOST]; /* rows */
    double order[2];                                          /* in h and k; NaN: there is none */
    double other[2]; /* the order may as well be this one; NaN: it may not */
};

/* What a class adds to two powers. */
struct br_grid_law {
    double least_r, most_r; /* correlation of the two errors */
    double noise;           /* of each cell, relative, normal */
    double floor;           /* constant, at most so much of the finest cell; < 0: by squares */
    double balance;         /* decades by which b exceeds a in all cells; 0: they meet within */
    double next;            /* terms h^(p+1) and k^(q+1), at the coarsest at most so much */
    size_t least, most;     /* meshes and steps */
    bool lower;             /* the next terms are larger than the first ones: one to eight times */
    bool logarithm;         /* h^p log(1/h) */
    double ratio;           /* of neighbouring sizes; 0: 2 */
    size_t blown; /* so many cells are off by far, in the corner of large k, or anywhere */
    int digits;   /* as printed; 0: six */
    enum { BR_GRID_FULL, BR_GRID_MISSING, BR_GRID_TIED, BR_GRID_DIAGONALS } cells;
    enum { BR_GRID_FALLS, BR_GRID_STAYS, BR_GRID_GROWS, BR_GRID_SCATTERS } kind;
    enum {
        BR_GRID_ONE_ORDER,
        BR_GRID_KINK,
        BR_GRID_MAXIMUM
    } changes; /* order: at a size, between */
};

static inline double br_grid_normal(struct br_test_random *r)
{
    return sqrt(-2 * log(1 - br_test_uniform(r, 0, 1))) *
           cos(2 * acos(-1) * br_test_uniform(r, 0, 1));
}

/* As a table prints it. */
static inline double br_grid_printed(double value, int digits)
{
    const double unit = pow(10, floor(log10(value)) + 1 - digits);
    return value > 0 ? round(value / unit) * unit : value;
}

/* Whether a class has the cell of mesh i and step j; of cells that go along, those near the
 * diagonal. */
static inline bool br_grid_has(struct br_test_random *r, const struct br_grid_law *law, size_t i,
                               size_t j)
{
    const bool near = i <= j + 1 && j <= i + 1;
    return law->cells == BR_GRID_FULL || (law->cells == BR_GRID_TIED && near) ||
           (law->cells == BR_GRID_DIAGONALS && (j == i || j == i + 1)) ||
           (law->cells == BR_GRID_MISSING && !br_test_once_in(r, 6));
}

/* The constants of both errors: they meet in a cell within the grid, or one exceeds the other in
 * all of them. */
static inline void br_grid_balance(struct br_test_random *r, const struct br_grid *g,
                                   double balance, double ratio, double c[2])
{
    const double p = g->order[0], q = g->order[1];
    const double i = br_test_uniform(r, 0.3, 0.7) * (double)(g->meshes - 1);
    const double j = br_test_uniform(r, 0.3, 0.7) * (double)(g->steps - 1);
    double decades = p * i * log10(ratio) - q * j * log10(ratio); /* of a = b there */
    if (balance > 0)
        decades = balance + q * (double)(g->steps - 1) * log10(ratio);
    if (balance < 0)
        decades = balance - p * (double)(g->meshes - 1) * log10(ratio);
    c[0] = br_test_decades(r, -3, 3);
    c[1] = c[0] * pow(10, balance == 0 ? -decades : decades);
}

/* A power of a size x relative to the coarsest; where the order changes, another one below t. */
static inline double br_grid_power(const struct br_grid *g, int axis, double x, double t)
{
    const double p = g->order[axis], coarse = isnan(g->other[axis]) ? p : g->other[axis];
    return x < t ? pow(t, coarse - p) * pow(x, p) : pow(x, coarse);
}

/* An error of both at sizes x, y relative to the coarsest. */
static inline double br_grid_error(const struct br_grid *g, const double c[2], const double next[2],
                                   double r, double x, double y, double t)
{
    const double a = c[0] * br_grid_power(g, 0, x, t) * (1 + next[0] * x);
    const double b = c[1] * br_grid_power(g, 1, y, t) * (1 + next[1] * y);
    return sqrt(fmax(0, a * a + 2 * r * a * b + b * b));
}

/* Makes the order of one axis change, to a lower one; returns the size at which it does. */
static inline double br_grid_change(struct br_test_random *r, const struct br_grid_law *law,
                                    struct br_grid *g)
{
    const int axis = (int)br_test_index(r, 2);
    const double sizes = (double)(axis ? g->steps : g->meshes), least = 1;
    if (law->changes == BR_GRID_ONE_ORDER)
        return 0;
    g->other[axis] = g->order[axis] = fmax(1.5, g->order[axis]);
    g->order[axis] -= br_test_uniform(r, 0.4, 1);
    const double from = law->changes == BR_GRID_KINK ? 1 + (double)br_test_index(r, 2)
                                                     : br_test_uniform(r, least, 2.9);
    return pow(2, fmin(from, sizes - 3) + 1 - sizes);
}

/* Multiplies cells of a full grid: those of the largest k at the finest meshes, or any. */
static inline void br_grid_blow(struct br_test_random *r, struct br_grid *g, size_t blown)
{
    const bool corner = br_test_once_in(r, 2);
    for (size_t i = 0; i < blown; i++) {
        const size_t at =
            corner ? (g->meshes - 1 - i % 2) * g->steps + i / 2 : br_test_index(r, g->rows);
        g->e[at] = br_grid_printed(g->e[at] * pow(10, br_test_uniform(r, 0.7, 6)), 6);
    }
}

static inline void br_grid_draw(struct br_test_random *r, const struct br_grid_law *law,
                                struct br_grid *g)
{
    static const double orders[] = {1, 1.5, 2, 3, 4};
    *g = (struct br_grid){
        .meshes = law->least + br_test_index(r, law->most - law->least + 1),
        .steps = law->least + br_test_index(r, law->most - law->least + 1),
        .order = {orders[br_test_index(r, 5)], orders[br_test_index(r, 5)]},
        .other = {NAN, NAN},
    };
    const double ratio = law->ratio > 0 ? law->ratio : 2;
    const double correlation = br_test_uniform(r, law->least_r, law->most_r);
    double next[] = {br_test_uniform(r, -law->next, law->next),
                     br_test_uniform(r, -law->next, law->next)};
    const double h0 = 1 / floor(br_test_uniform(r, 4, 20)), k0 = br_test_decades(r, -3, 0);
    double c[2];
    for (int a = 0; a < 2 && law->lower; a++)
        next[a] = br_test_uniform(r, 1, 8);
    br_grid_balance(r, g, law->balance, ratio, c);
    const double t = br_grid_change(r, law, g);
    const double finest =
        br_grid_error(g, c, next, fmax(0, correlation), pow(ratio, 1 - (double)g->meshes),
                      pow(ratio, 1 - (double)g->steps), t);
    const double level = fabs(law->floor) * br_test_uniform(r, 0.3, 1) * finest;
    const double growth = br_test_uniform(r, 0.5, 3);
    for (size_t i = 0; i < g->meshes; i++)
        for (size_t j = 0; j < g->steps; j++) {
            const double x = pow(ratio, -(double)i), y = pow(ratio, -(double)j);
            const double log_h = law->logarithm ? 1 - log(x) / log(1 / h0) : 1;
            const double of[] = {c[0] * log_h, c[1]};
            double e = br_grid_error(g, of, next, correlation, x, y, t);
            e = law->floor < 0 ? hypot(e, level) : e + level;
            if (law->kind == BR_GRID_STAYS)
                e = c[0];
            if (law->kind == BR_GRID_GROWS)
                e = c[0] * pow(x * y, -growth);
            if (law->kind == BR_GRID_SCATTERS)
                e = c[0] * exp(br_grid_normal(r));
            if (!br_grid_has(r, law, i, j))
                continue;
            g->h[g->rows] = h0 * x;
            g->k[g->rows] = k0 * y;
            g->e[g->rows++] = br_grid_printed(e * exp(law->noise * br_grid_normal(r)),
                                              law->digits ? law->digits : 6);
        }
    br_grid_blow(r, g, law->blown);
    if (law->kind)
        g->order[0] = g->order[1] = NAN;
}

/* clang-format off */
static const struct br_grid_class {
    const char *name;
    enum br_error_group group;
    struct br_grid_law law;
} br_grid_classes[] = {
    {"errors add", BR_SMOOTH_ERRORS, {.least_r = 1, .most_r = 1, .least = 3, .most = 6}},
    {"errors subtract", BR_SMOOTH_ERRORS, {.least_r = -1, .most_r = -1, .least = 4, .most = 6}},
    {"norms", BR_SMOOTH_ERRORS, {.least_r = -.9, .most_r = .9, .least = 4, .most = 6}},
    {"norms, 3 x 3", BR_SMOOTH_ERRORS, {.least_r = -.9, .most_r = .9, .least = 3, .most = 3}},
    {"1 % noise", BR_NOISY_ERRORS, {.least_r = -.9, .most_r = .9, .noise = .01, .least = 4, .most = 6}},
    {"3 % noise", BR_NOISY_ERRORS, {.least_r = -.9, .most_r = .9, .noise = .03, .least = 4, .most = 6}},
    {"5 % noise", BR_NOISY_ERRORS, {.least_r = -.9, .most_r = .9, .noise = .05, .least = 4, .most = 6}},
    {"10 % noise", BR_NOISY_ERRORS, {.least_r = -.9, .most_r = .9, .noise = .1, .least = 4, .most = 6}},
    {"5 % noise, 3 x 3", BR_NOISY_ERRORS, {.least_r = -.9, .most_r = .9, .noise = .05, .least = 3, .most = 3}},
    {"floor, added", BR_HARD_ERRORS, {.least_r = -.9, .most_r = .9, .floor = 1, .least = 4, .most = 6}},
    {"floor, by squares", BR_HARD_ERRORS, {.least_r = -.9, .most_r = .9, .floor = -1, .least = 4, .most = 6}},
    {"floor, 3 % noise", BR_HARD_ERRORS,
     {.least_r = -.9, .most_r = .9, .floor = 1, .noise = .03, .least = 4, .most = 6}},
    {"time dominates", BR_SMOOTH_ERRORS, {.most_r = .5, .balance = 4, .least = 4, .most = 6}},
    {"time dominates, 1 % noise", BR_NOISY_ERRORS,
     {.most_r = .5, .balance = 4, .noise = .01, .least = 4, .most = 6}},
    {"space dominates, 1 % noise", BR_NOISY_ERRORS,
     {.most_r = .5, .balance = -4, .noise = .01, .least = 4, .most = 6}},
    {"next terms of 5 %", BR_SMOOTH_ERRORS, {.least_r = -.9, .most_r = .9, .next = .05, .least = 4, .most = 6}},
    {"next terms of 30 %", BR_HARD_ERRORS, {.least_r = -.9, .most_r = .9, .next = .3, .least = 4, .most = 6}},
    {"next terms, 2 % noise", BR_HARD_ERRORS,
     {.least_r = -.9, .most_r = .9, .next = .3, .noise = .02, .least = 4, .most = 6}},
    {"missing cells, 1 % noise", BR_NOISY_ERRORS,
     {.least_r = -.9, .most_r = .9, .noise = .01, .least = 4, .most = 6, .cells = BR_GRID_MISSING}},
    {"tied in part", BR_SMOOTH_ERRORS, {.least_r = -.9, .most_r = .9, .least = 4, .most = 6, .cells = BR_GRID_TIED}},
    {"tied in part, 2 % noise", BR_NOISY_ERRORS,
     {.least_r = -.9, .most_r = .9, .noise = .02, .least = 4, .most = 6, .cells = BR_GRID_TIED}},
    {"time dominates, 3 digits", BR_SMOOTH_ERRORS,
     {.most_r = .5, .balance = 4, .digits = 3, .least = 4, .most = 6}},
    {"space dominates, 3 digits", BR_SMOOTH_ERRORS,
     {.most_r = .5, .balance = -4, .digits = 3, .least = 4, .most = 6}},
    {"hidden in part, 3 digits", BR_SMOOTH_ERRORS,
     {.most_r = .5, .balance = 1, .digits = 3, .least = 4, .most = 6}},
    {"logarithm and power", BR_HARD_ERRORS,
     {.least_r = 1, .most_r = 1, .logarithm = true, .least = 4, .most = 5}},
    {"next terms larger", BR_HARD_ERRORS, {.least_r = 1, .most_r = 1, .lower = true, .least = 4, .most = 6}},
    {"blown-up cells", BR_HARD_ERRORS, {.least_r = 1, .most_r = 1, .blown = 3, .least = 4, .most = 5}},
    {"two diagonals", BR_SMOOTH_ERRORS,
     {.least_r = 1, .most_r = 1, .least = 4, .most = 6, .cells = BR_GRID_DIAGONALS}},
    {"order changes at a size", BR_TWO_ORDERS,
     {.least_r = -.5, .most_r = 1, .least = 4, .most = 6, .changes = BR_GRID_KINK}},
    {"order changes between sizes", BR_TWO_ORDERS,
     {.least_r = -.5, .most_r = 1, .least = 4, .most = 6, .changes = BR_GRID_MAXIMUM}},
    {"constant, 2 % noise", BR_NO_ORDER, {.noise = .02, .least = 3, .most = 6, .kind = BR_GRID_STAYS}},
    {"grows, 5 % noise", BR_NO_ORDER, {.noise = .05, .least = 3, .most = 6, .kind = BR_GRID_GROWS}},
    {"scatters", BR_NO_ORDER, {.least = 3, .most = 6, .kind = BR_GRID_SCATTERS}},
    {"logarithm and power, 3 x 3", BR_HARD_ERRORS,
     {.least_r = 1, .most_r = 1, .logarithm = true, .least = 3, .most = 3}},
    {"logarithm and power, ratio 3", BR_HARD_ERRORS,
     {.least_r = 1, .most_r = 1, .logarithm = true, .ratio = 3, .least = 5, .most = 6}},
};
/* clang-format on */
enum { BR_GRID_CLASSES = sizeof br_grid_classes / sizeof *br_grid_classes };

/* Grid `index` of a class and a seed. */
static inline struct br_grid br_grid_of(size_t class, uint64_t seed, size_t index)
{
    struct br_grid g;
    struct br_test_random r = br_test_random_of(seed * 1000 + class, index);
    br_grid_draw(&r, &br_grid_classes[class].law, &g);
    return g;
}

/* ---- values ---- */

/* A value L + A h^p (1 + c h) + B k^q (1 + d k) + products, of grids of four to six sizes; of
 * lines, L + A h^p (1 + c h). */
static const struct br_value_class {
    const char *name;
    double next, product, noise; /* relative: at the coarsest, to both errors, to the finest step */
    bool one;                    /* all but one direction is far smaller */
    bool line;                   /* h alone */
    double mixed; /* c and d: at the coarsest at least a fifth of it, at most so much */
} br_value_classes[] = {
    {"limits, two powers", .next = 0},
    {"limits, next terms", .next = 0.3},
    {"limits, products", .product = 1},
    {"limits, all of that", .next = 0.3, .product = 0.5},
    {"limits, one dominates", .next = 0.1, .product = 0.1, .one = true},
    {"limits, noise", .noise = 0.05},
    {"limits, mixed orders", .mixed = 2},
    {"limits, mixed, noise", .mixed = 2, .noise = 0.05},
    {"limits of lines, one power", .line = true},
    {"limits of lines, next term", .line = true, .next = 0.3},
    {"limits of lines, noise", .line = true, .noise = 0.05},
    {"limits of lines, 20 % noise", .line = true, .noise = 0.2},
    {"limits of lines, mixed", .line = true, .mixed = 2},
    {"limits of lines, mixed, noise", .line = true, .mixed = 2, .noise = 0.05},
};
enum { BR_VALUE_CLASSES = sizeof br_value_classes / sizeof *br_value_classes };

static inline struct br_grid br_value_grid_of(size_t class, uint64_t seed, size_t index,
                                              double *limit)
{
    const struct br_value_class *law = &br_value_classes[class];
    struct br_test_random random = br_test_random_of(seed * 1000 + 500 + class, index),
                          *r = &random;
    static const double orders[] = {1, 1.5, 2};
    struct br_grid g = {
        .meshes = 4 + br_test_index(r, 3),
        .steps = law->line ? 1 : 4 + br_test_index(r, 3),
        .order = {orders[br_test_index(r, 3)], orders[br_test_index(r, 3)]},
        .other = {NAN, NAN},
    };
    *limit = br_test_uniform(r, -2, 2);
    const double sign = br_test_once_in(r, 2) ? -1 : 1;
    const double a = br_test_decades(r, -2, -0.5);
    const double both = law->line ? 0 : sign * a;
    const double b = both * br_test_decades(r, law->one ? -4 : -0.7, law->one ? -3 : 0.7);
    const double low = law->mixed > 0 ? law->mixed / 5 : -law->next, high = law->mixed + law->next;
    const double c = br_test_uniform(r, low, high), d = br_test_uniform(r, low, high);
    for (size_t i = 0; i < g.meshes; i++)
        for (size_t j = 0; j < g.steps; j++, g.rows++) {
            const double x = pow(2, -(double)i), y = pow(2, -(double)j);
            const double f = a * pow(x, g.order[0]) * (1 + c * x);
            const double e = b * pow(y, g.order[1]) * (1 + d * y);
            const double step = a * pow(2, -g.order[0] * ((double)g.meshes - 1));
            g.h[g.rows] = x;
            g.k[g.rows] = y;
            g.e[g.rows] = *limit + f + e + law->product * f * e / fmax(fabs(a), fabs(b)) +
                          law->noise * step * br_grid_normal(r);
        }
    return g;
}

#endif
