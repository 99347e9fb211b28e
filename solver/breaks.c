/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where a function breaks, and a mesh on which polynomials approximate it. */
#include <stdlib.h>

#include "solver/box.h"

enum { MOST_EXAMINED = 400000, MOST_BREAKS = 20000, MOST_CELLS = 20000 };

/* ---- breaks ---- */

void br_breaks_free(struct br_breaks *b)
{
    free(b->at);
    *b = (struct br_breaks){0};
}

/* The sign of a switching function in an interval. ZERO: it is zero everywhere there. */
enum sign { NEGATIVE = -1, ZERO, POSITIVE, UNDECIDED };

struct zero_search {
    const struct br_function *switching;
    enum br_variable along;
    struct br_box box;
    struct br_breaks *out;
    size_t examined;
    enum sign before; /* in the last interval that was settled */
    enum br_status status;
    struct br_error *err;
};

static enum sign sign_of(bool bounded, iv a)
{
    return !bounded                    ? UNDECIDED
           : a.low > 0                 ? POSITIVE
           : a.high < 0                ? NEGATIVE
           : a.low == 0 && a.high == 0 ? ZERO
                                       : UNDECIDED;
}

static enum sign sign_on(const struct zero_search *s, iv part)
{
    iv value;
    const bool bounded = br_function_bound(s->switching, with(s->box, s->along, part), &value);
    return sign_of(bounded, value);
}

static void refuse(struct zero_search *s, iv part, const char *what)
{
    char position[80];
    br_name_position(s->switching, with(s->box, s->along, part), position);
    s->status = br_fail(s->err, BR_BAD_INPUT, "%s near %s", what, position);
}

/* The sign after the break is not known. */
static void add_break(struct zero_search *s, iv at)
{
    const iv all = *side(&s->box, s->along);
    s->before = UNDECIDED;
    if (at.high <= all.low || at.low >= all.high)
        return;
    if (s->out->count == 2 * MOST_BREAKS)
        refuse(s, at, "it changes its form too often (20,000 times)");
    else
        s->out->at[s->out->count++] = at;
}

/* The switching function has this sign in the next interval. */
static void settle(struct zero_search *s, iv part, enum sign sign)
{
    if (sign != s->before && s->before != UNDECIDED)
        add_break(s, point(part.low));
    else if (sign == ZERO && s->before == UNDECIDED)
        add_break(s, point(part.low));
    s->before = sign;
}

/* By bisection, the last number from `from` towards `to` (which may be smaller) at which the
 * switching function is known to have the sign that it has at `from`. */
static double last_with(const struct zero_search *s, double from, double to, enum sign sign)
{
    for (double m = from + (to - from) / 2; m != from && m != to; m = from + (to - from) / 2)
        if (sign_on(s, point(m)) == sign)
            from = m;
        else
            to = m;
    return from;
}

/* Finds the one zero, if any, of a switching function that rises (up) or falls everywhere in the
 * interval. */
static void find_zero(struct zero_search *s, iv part, bool up)
{
    const enum sign left = up ? NEGATIVE : POSITIVE, right = up ? POSITIVE : NEGATIVE;
    const enum sign first = sign_on(s, point(part.low)), last = sign_on(s, point(part.high));
    if (first == right || last == left) {
        settle(s, part, first == right ? right : left);
        return;
    }
    iv root = part;
    if (first == left)
        root.low = last_with(s, part.low, part.high, left);
    if (last == right)
        root.high = last_with(s, part.high, root.low, right);
    /* The sign is known at both ends of `root`; between them it is not. */
    const double low = first == left ? nextafter(root.low, INFINITY) : root.low,
                 high = last == right ? nextafter(root.high, -INFINITY) : root.high;
    add_break(s, low <= high ? (iv){low, high} : root);
    if (last == right)
        s->before = right;
}

/* Whether the switching function's values in the interval are within the round-off of its middle.
 */
static bool is_noise(const struct zero_search *s, iv part, iv value)
{
    iv at;
    return br_function_bound(s->switching, with(s->box, s->along, point(middle(part))), &at) &&
           at.low <= 0 && at.high >= 0 && width(at) > 0 && width(value) <= 8 * width(at);
}

static void locate(struct zero_search *s, iv part)
{
    const struct br_box box = with(s->box, s->along, part);
    iv value, slope[2];
    if (s->status)
        return;
    if (++s->examined > MOST_EXAMINED) {
        refuse(s, part, "where it changes its form cannot be determined");
        return;
    }
    const bool bounded = br_function_bound(s->switching, box, &value);
    const enum sign sign = sign_of(bounded, value);
    if (sign != UNDECIDED) {
        settle(s, part, sign);
    } else if (br_function_taylor(s->switching, s->along, box, 1, slope) &&
               (slope[1].low > 0 || slope[1].high < 0)) {
        find_zero(s, part, slope[1].low > 0);
    } else if (!is_divisible(part) || (bounded && is_noise(s, part, value))) {
        add_break(s, part);
    } else {
        locate(s, (iv){part.low, middle(part)});
        locate(s, (iv){middle(part), part.high});
    }
}

static int compare_breaks(const void *a, const void *b)
{
    const iv *p = a, *q = b;
    return p->low < q->low ? -1 : p->low > q->low;
}

/* Sorts the breaks, and unites those that touch. */
static void merge(struct br_breaks *b)
{
    size_t kept = 0;
    if (b->count)
        qsort(b->at, b->count, sizeof *b->at, compare_breaks);
    for (size_t i = 0; i < b->count; i++)
        if (kept && b->at[i].low <= nextafter(b->at[kept - 1].high, INFINITY))
            b->at[kept - 1].high = fmax(b->at[kept - 1].high, b->at[i].high);
        else
            b->at[kept++] = b->at[i];
    b->count = kept;
}

static enum br_status search(const struct br_function *switching, enum br_variable along,
                             struct br_box box, struct br_breaks *out, struct br_error *err)
{
    struct zero_search s = {.switching = switching,
                            .along = along,
                            .box = box,
                            .out = out,
                            .err = err,
                            .before = UNDECIDED};
    const iv *all = side(&box, along);
    if (!out->at)
        out->at = br_allocate(2 * MOST_BREAKS, sizeof *out->at);
    if (!out->at)
        return br_no_memory(err, "the breaks of a function");
    /* A switching function that is zero from the start on has no break there. */
    s.before = sign_on(&s, point(all->low));
    locate(&s, *all);
    merge(out);
    return s.status;
}

/* A switching function of both variables that may be zero in the box, where neither is a point. */
static bool is_moving(const struct br_function *g, struct br_box box)
{
    iv value;
    return g->uses_x && g->uses_t && width(box.x) > 0 && width(box.t) > 0 &&
           sign_of(br_function_bound(g, box, &value), value) == UNDECIDED;
}

enum br_status br_breaks_add(const struct br_function *f, enum br_variable along, struct br_box box,
                             struct br_breaks *out, struct br_error *err)
{
    const struct br_function *g;
    enum br_status status = BR_OK;
    for (size_t i = 0; (g = br_function_switching(f, i)) && !status; i++)
        if (is_moving(g, box))
            out->moving = true;
        else if (along == BR_X ? g->uses_x : g->uses_t)
            status = search(g, along, used_box(g, box), out, err);
    if (!status && out->count > MOST_BREAKS)
        status = br_fail(err, BR_BAD_INPUT, "it changes its form %zu times, expected at most %d",
                         out->count, MOST_BREAKS);
    return status;
}

enum br_status br_front_times(const struct br_function *f, struct br_box box, struct br_breaks *out,
                              struct br_error *err)
{
    const struct br_function *g;
    enum br_status status = BR_OK;
    for (size_t i = 0; (g = br_function_switching(f, i)) && !status; i++) {
        if (!is_moving(g, box))
            continue;
        status = search(g, BR_T, with(box, BR_X, point(box.x.low)), out, err);
        if (!status)
            status = search(g, BR_T, with(box, BR_X, point(box.x.high)), out, err);
    }
    return status;
}

/* ---- a mesh ---- */

void br_mesh_free(struct br_mesh *m)
{
    free(m->at);
    free(m->rough);
    *m = (struct br_mesh){0};
}

struct mesher {
    const struct br_function *f;
    enum br_variable along;
    struct br_box box;
    const struct br_mesh_aim *aim;
    struct br_mesh *out;
    double total; /* width of the box */
    enum br_status status;
    struct br_error *err;
};

static void add_cell(struct mesher *m, iv cell, bool rough, double range)
{
    struct br_mesh *out = m->out;
    if (out->count == out->capacity) {
        char position[80];
        br_name_position(m->f, with(m->box, m->along, cell), position);
        m->status = br_fail(m->err, BR_BAD_INPUT,
                            "it cannot be resolved: after %zu pieces it still changes near %s",
                            out->count, position);
        return;
    }
    out->at[out->count] = cell.low;
    out->rough[out->count++] = rough;
    out->at[out->count] = cell.high;
    if (rough)
        out->missed += width(cell) * range;
}

/* The inside of a cell: a break at an end of the cell is excluded. */
static iv inside(iv cell)
{
    const iv in = {nextafter(cell.low, INFINITY), nextafter(cell.high, -INFINITY)};
    return in.low <= in.high ? in : cell;
}

/* |f - interpolant| <= |c_(d+1)| 2 (width / 4)^(d+1) at Chebyshev's nodes */
static bool is_polynomial(const struct mesher *m, struct br_box box, iv cell)
{
    enum { MOST_ORDER = 16 };
    const size_t order = m->aim->degree + 1;
    iv c[MOST_ORDER + 1];
    return br_function_taylor(m->f, m->along, box, order, c) &&
           magnitude(c[order]) * 2 * pow(width(cell) / 4, (double)order) <= m->aim->tolerance;
}

static void refine(struct mesher *m, iv cell)
{
    if (m->status)
        return;
    const struct br_box box = with(m->box, m->along, inside(cell));
    iv value;
    const bool bounded = br_function_bound(m->f, box, &value);
    const double range = width(value), tolerance = m->aim->tolerance;
    /* the interpolant's range is at most 3 times that of f (degree 15) */
    const bool flat = bounded && 4 * range <= tolerance;
    if (flat || (bounded && is_polynomial(m, box, cell)))
        add_cell(m, cell, false, range);
    else if (bounded && width(cell) * range <= tolerance * m->total)
        add_cell(m, cell, true, range);
    else if (!is_divisible(cell)) {
        m->out->capacity = m->out->count; /* stop here */
        add_cell(m, cell, true, range);
    } else {
        refine(m, (iv){cell.low, middle(cell)});
        refine(m, (iv){middle(cell), cell.high});
    }
}

/* Refines the intervals between breaks, and wide breaks themselves. */
static void refine_between(struct mesher *m, const struct br_breaks *breaks)
{
    const iv all = *side(&m->box, m->along);
    double from = all.low;
    for (size_t i = 0; i < breaks->count; i++) {
        const iv at = {fmax(breaks->at[i].low, all.low), fmin(breaks->at[i].high, all.high)};
        if (at.low > from)
            refine(m, (iv){from, at.low});
        if (at.high > at.low)
            refine(m, at);
        from = at.high;
    }
    if (from < all.high)
        refine(m, (iv){from, all.high});
}

enum br_status br_resolve(const struct br_function *f, enum br_variable along, struct br_box box,
                          const struct br_mesh_aim *aim, struct br_mesh *out, struct br_error *err)
{
    struct mesher m = {.f = f,
                       .along = along,
                       .box = box,
                       .aim = aim,
                       .out = out,
                       .total = width(*side(&box, along)),
                       .err = err};
    struct br_breaks breaks = {0};
    *out = (struct br_mesh){br_allocate(MOST_CELLS + 1, sizeof *out->at),
                            br_allocate(MOST_CELLS, sizeof *out->rough), 0, MOST_CELLS, 0};
    m.status = out->at && out->rough ? br_breaks_add(f, along, box, &breaks, err)
                                     : br_no_memory(err, "a mesh for a function");
    if (!m.status)
        refine_between(&m, &breaks);
    br_breaks_free(&breaks);
    if (m.status)
        br_mesh_free(out);
    return m.status;
}
