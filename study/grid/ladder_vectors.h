/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The vectors of the instruction set BR_SET, and how they get the modes of a view; for
 * ladder_loops.c alone. Whole vectors of elements whose ratio is 1, 2 or 4 are loaded as they lie
 * in memory and sorted by shuffles; other ratios, and the elements left over at the end, are
 * collected one by one. */
#ifndef BR_STUDY_GRID_LADDER_VECTORS_H
#define BR_STUDY_GRID_LADDER_VECTORS_H

#include "solver/vectors.h"
#include "study/grid/ladder_kernel.h"

#define LANES WIDTH

enum { MOST = BR_MOST_MODES, MOST_RATIO = 4 };

/* f of each lane; every other one of the values of a and b; those of a from the second on, and b's
 * first. */
#if LANES == 8
#define EACH(f) f(0), f(1), f(2), f(3), f(4), f(5), f(6), f(7)
#define EVEN(a, b) SHUFFLE(a, b, 0, 2, 4, 6, 8, 10, 12, 14)
#define ODD(a, b) SHUFFLE(a, b, 1, 3, 5, 7, 9, 11, 13, 15)
#define SHIFT(a, b) SHUFFLE(a, b, 1, 2, 3, 4, 5, 6, 7, 8)
#elif LANES == 4
#define EACH(f) f(0), f(1), f(2), f(3)
#define EVEN(a, b) SHUFFLE(a, b, 0, 2, 4, 6)
#define ODD(a, b) SHUFFLE(a, b, 1, 3, 5, 7)
#define SHIFT(a, b) SHUFFLE(a, b, 1, 2, 3, 4)
#else
#define EACH(f) f(0), f(1)
#define EVEN(a, b) SHUFFLE(a, b, 0, 2)
#define ODD(a, b) SHUFFLE(a, b, 1, 3)
#define SHIFT(a, b) SHUFFLE(a, b, 1, 2)
#endif

/* `count` vectors that stand `apart`, as one row of values; then vector i has the values i,
 * i + count, ... of it. count: a power of two. */
INLINE void load_sorted(int count, const double *from, int apart, vec *x)
{
    for (int i = 0; i < count; i++)
        x[i] = load(from + i * apart);
    for (int done = 1; done < count; done *= 2) {
        vec next[MOST * MOST_RATIO];
        for (int i = 0; i < count / 2; i++) {
            next[i] = EVEN(x[2 * i], x[2 * i + 1]);
            next[i + count / 2] = ODD(x[2 * i], x[2 * i + 1]);
        }
        for (int i = 0; i < count; i++)
            x[i] = next[i];
    }
}

/* Unknowns a node of elements of so many modes. */
INLINE int unknowns_of(int modes)
{
    return (modes + 1) / 2;
}

/* Which of the values of its two nodes has value i of an element: all, but of three modes not the
 * second one, the bubble of the element before. */
INLINE int place_of(int modes, int i)
{
    return modes == 3 && i > 0 ? i + 1 : i;
}

/* The nodes of all children of a vector of elements: value[j][i] of child j's two nodes. */
INLINE void fetch_nodes(int modes, int ratio, const double *from, vec value[][MOST])
{
    const int unknowns = unknowns_of(modes), count = ratio * unknowns;
    vec node[MOST / 2 * (MOST_RATIO + 1)];
    load_sorted(count, from, LANES, node);
    for (int i = 0; i < unknowns; i++) {
        const vec next = ALL(from[count * LANES + i]);
        node[count + i] = SHIFT(node[i], next);
    }
    for (int j = 0; j < ratio; j++)
        for (int i = 0; i < modes; i++)
            value[j][i] = node[j * unknowns + place_of(modes, i)];
}

/* As load_sorted of vectors side by side, for any count. */
INLINE void load_elements(int count, const double *from, vec *x)
{
    if (count != 3) {
        load_sorted(count, from, LANES, x);
        return;
    }
#define AT(l) from[(l)*3 + i]
    for (int i = 0; i < count; i++)
        x[i] = (vec){EACH(AT)};
#undef AT
}

/* The values of all children of a vector of elements from `first` on, value[j] those of child j. */
INLINE void fetch(const struct br_view *v, enum br_layout layout, int modes, int ratio,
                  size_t first, vec value[][MOST])
{
    vec row[MOST * MOST_RATIO];
    const double *from = v->values + first * (size_t)(modes * ratio);
    switch (layout) {
    case BR_BY_NODE:
        fetch_nodes(modes, ratio, v->values + first * (size_t)(unknowns_of(modes) * ratio), value);
        return;
    case BR_BY_ELEMENT:
        load_elements(ratio * modes, from, row);
        for (int j = 0; j < ratio; j++)
            for (int i = 0; i < modes; i++)
                value[j][i] = row[j * modes + i];
        return;
    case BR_IN_LANES:
        for (int i = 0; i < modes; i++) {
            load_sorted(ratio, from + i * LANES, modes * LANES, row);
            for (int j = 0; j < ratio; j++)
                value[j][i] = row[j];
        }
    }
}

/* Elements that are collected one by one: e, e + stride, ..., `live` of them. */
struct few {
    size_t e, stride, live;
};

/* Their values; zeros in the other lanes. */
INLINE void collect(const struct br_view *v, enum br_layout layout, int modes,
                    const struct few *few, vec *value)
{
    static const double zeros[MOST * LANES];
    const size_t width = (size_t)(layout == BR_BY_NODE ? unknowns_of(modes) : modes);
    const int step = layout == BR_IN_LANES ? LANES : 1;
    const double *from[LANES];
    for (size_t l = 0; l < LANES; l++) {
        const size_t e = few->e + l * few->stride;
        from[l] = layout == BR_IN_LANES ? v->values + e / LANES * LANES * width + e % LANES
                                        : v->values + e * width;
        if (l >= few->live)
            from[l] = zeros;
    }
#define AT(l) from[l][(layout == BR_BY_NODE ? place_of(modes, i) : i) * step]
    for (int i = 0; i < modes; i++)
        value[i] = (vec){EACH(AT)};
#undef AT
}

/* Values -> modes without their scales, in place (solver/modes.h). */
INLINE void combine(enum br_layout layout, int modes, vec *x)
{
    if (layout == BR_BY_NODE && modes == 2) {
        const vec sum = x[0] + x[1], difference = x[1] - x[0];
        x[0] = sum;
        x[1] = difference;
    } else if (layout == BR_BY_NODE && modes == 3) {
        const vec sum = x[0] + x[1] - ALL(1.0 / 3) * x[2], difference = x[1] - x[0];
        x[0] = sum;
        x[1] = difference;
    } else if (layout == BR_BY_NODE) {
        const vec w = x[0] + x[2], d = x[2] - x[0], s = x[1] + x[3], c = x[3] - x[1];
        x[0] = w - ALL(1.0 / 6) * c;
        x[1] = d - ALL(1.0 / 12) * s;
        x[2] = c;
        x[3] = s - ALL(2.0) * d;
    }
}

/* Values -> modes, in place. */
INLINE void make_modes(const double *scale, enum br_layout layout, int modes, vec *x)
{
    combine(layout, modes, x);
    for (int i = 0; i < modes && layout != BR_IN_LANES; i++)
        x[i] *= ALL(scale[i]);
}

#endif
