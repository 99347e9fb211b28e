/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/pole.h"

#include <math.h>

enum { MOST_HALVINGS = 64, SOON = 12, LATE = 8, NEAR_ENDS = 8 };

static const double grown_soon = 4, grown_late = 2.8; /* over so many halvings */

double br_line_value(const struct br_line *l, double at)
{
    const double x = l->along_x ? at : l->other, t = l->along_x ? l->other : at;
    double value;
    br_function_evaluate(l->function, 1, &x, t, &value);
    return value;
}

struct point {
    double at, value;
};

static struct point point_of(const struct br_line *l, double at)
{
    return (struct point){at, br_line_value(l, at)};
}

static struct point middle(const struct br_line *l, const struct point *a, const struct point *b)
{
    return point_of(l, a->at + (b->at - a->at) / 2);
}

static bool is_between(const struct point *a, const struct point *m, const struct point *b)
{
    return a->at < m->at && m->at < b->at;
}

static bool opposite(double a, double b)
{
    return (a > 0 && b < 0) || (a < 0 && b > 0);
}

/* Sizes at the ends of the interval, after each halving. */
struct growth {
    double size[MOST_HALVINGS + 1];
    int halvings;
};

/* Whether it is worth going on. */
static bool add(struct growth *g, double size)
{
    g->size[++g->halvings] = size;
    return g->halvings < MOST_HALVINGS && (g->halvings != SOON || size >= grown_soon * g->size[0]);
}

static bool still_grows(const struct growth *g)
{
    const double *last = &g->size[g->halvings];
    return g->halvings > SOON + 2 * LATE && last[0] > grown_late * last[-LATE] &&
           last[-LATE] > grown_late * last[-2 * LATE];
}

/* Towards a change of sign, where the lesser of both sizes grows at a pole, but not at a zero or a
 * jump. */
static bool pole_at_change(const struct br_line *l, struct point a, struct point b,
                           struct point *pole)
{
    struct growth g = {.size = {fmin(fabs(a.value), fabs(b.value))}};
    bool going = true;
    while (going) {
        const struct point m = middle(l, &a, &b);
        *pole = m;
        if (!isfinite(m.value))
            return true;
        if (!is_between(&a, &m, &b))
            break;
        if (opposite(a.value, m.value))
            b = m;
        else
            a = m;
        going = add(&g, fmin(fabs(a.value), fabs(b.value)));
    }
    *pole = fabs(a.value) > fabs(b.value) ? a : b;
    return still_grows(&g);
}

/* Towards the largest of three; beside it the larger of both sizes grows at a pole. */
static bool pole_at_peak(const struct br_line *l, struct point a, struct point m, struct point b,
                         struct point *pole)
{
    struct growth g = {.size = {fmax(fabs(a.value), fabs(b.value))}};
    bool going = true;
    while (going) {
        const struct point left = middle(l, &a, &m), right = middle(l, &m, &b);
        *pole = isfinite(left.value) ? right : left;
        if (!isfinite(left.value) || !isfinite(right.value))
            return true;
        if (!is_between(&a, &left, &m) || !is_between(&m, &right, &b))
            break;
        if (fabs(left.value) > fmax(fabs(m.value), fabs(right.value))) {
            b = m;
            m = left;
        } else if (fabs(right.value) > fabs(m.value)) {
            a = m;
            m = right;
        } else {
            a = left;
            b = right;
        }
        going = add(&g, fmax(fabs(a.value), fabs(b.value)));
    }
    *pole = m;
    return still_grows(&g);
}

/* The place is not finite, or a pole is between it and those before it. */
static bool is_at(const struct br_line *l, const struct point p[3], size_t count,
                  struct point *pole)
{
    *pole = p[2];
    if (!isfinite(p[2].value))
        return true;
    if (count > 1 && opposite(p[1].value, p[2].value) && pole_at_change(l, p[1], p[2], pole))
        return true;
    const bool peak =
        count > 2 && fabs(p[1].value) > fabs(p[0].value) && fabs(p[1].value) >= fabs(p[2].value);
    return peak && pole_at_peak(l, p[0], p[1], p[2], pole);
}

/* Place i of [0, end]: equidistant ones, and in the first and in the last of their intervals
 * halves, quarters ... towards the end, since the size of a function cannot be the largest of three
 * there. */
static double place(const struct br_line *l, size_t parts, size_t i)
{
    const double h = l->end / (double)parts;
    if (i <= NEAR_ENDS)
        return i ? ldexp(h, (int)i - NEAR_ENDS - 1) : 0;
    if (i < NEAR_ENDS + parts)
        return l->end * (double)(i - NEAR_ENDS) / (double)parts;
    const int j = (int)(i - NEAR_ENDS - parts);
    return j < NEAR_ENDS ? l->end - ldexp(h, -j - 1) : l->end;
}

bool br_find_pole(const struct br_line *l, size_t parts, double *at, double *value)
{
    struct point last[3] = {{0}}, pole;
    for (size_t i = 0; i <= parts + 2 * NEAR_ENDS; i++) {
        last[0] = last[1];
        last[1] = last[2];
        last[2] = point_of(l, place(l, parts, i));
        if (is_at(l, last, i + 1, &pole)) {
            *at = pole.at;
            *value = pole.value;
            return true;
        }
    }
    return false;
}
