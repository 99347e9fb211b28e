/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/proof.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_BOXES = 20000, MOST_LOOKS = 400000, MOST_BREAKS = 20000, MOST_CELLS = 20000 };

/* ---- intervals and boxes ---- */

typedef struct br_interval iv;

static iv point(double a)
{
    return (iv){a, a};
}

static double width(iv a)
{
    return a.high - a.low;
}

static double middle(iv a)
{
    return a.low + (a.high - a.low) / 2;
}

/* Whether a number is between both ends. */
static bool is_divisible(iv a)
{
    return a.low < middle(a) && middle(a) < a.high;
}

static iv *side(struct br_box *box, enum br_variable v)
{
    return v == BR_X ? &box->x : &box->t;
}

static struct br_box with(struct br_box box, enum br_variable v, iv a)
{
    *side(&box, v) = a;
    return box;
}

static double magnitude(iv a)
{
    return fmax(fabs(a.low), fabs(a.high));
}

/* Both halves of a box; or, where no number is between, both of its faces. */
static void split(struct br_box box, enum br_variable v, struct br_box half[2])
{
    const iv a = *side(&box, v);
    const bool divisible = is_divisible(a);
    half[0] = with(box, v, divisible ? (iv){a.low, middle(a)} : point(a.low));
    half[1] = with(box, v, divisible ? (iv){middle(a), a.high} : point(a.high));
}

/* A side that f does not use is a point. */
static struct br_box used_box(const struct br_function *f, struct br_box box)
{
    return (struct br_box){f->uses_x ? box.x : point(box.x.low),
                           f->uses_t ? box.t : point(box.t.low)};
}

/* "x = 0.3333 m, t = 1 s", the middle of a box, of the variables that f uses. */
static void name_place(const struct br_function *f, struct br_box box, char text[80])
{
    const char *between = f->uses_x && f->uses_t ? ", " : "";
    char x[40] = "", t[40] = "";
    if (f->uses_x)
        snprintf(x, sizeof x, "x = %.10g m", middle(box.x));
    if (f->uses_t)
        snprintf(t, sizeof t, "t = %.10g s", middle(box.t));
    snprintf(text, 80, "%s%s%s", x, between, t);
}

/* ---- finite everywhere ---- */

/* The boxes that are still to be judged, the last one first: halves of halves. */
struct proof {
    const struct br_function *f;
    struct br_box whole;
    struct br_box left[2400]; /* each number halved some 1,100 times, and a few more */
    size_t count;
    iv value;
    bool begun;
    struct br_box where;
};

static bool take_in(struct proof *p, struct br_box box)
{
    iv value;
    if (!br_function_bound(p->f, box, &value))
        return false;
    p->value =
        p->begun ? (iv){fmin(p->value.low, value.low), fmax(p->value.high, value.high)} : value;
    p->begun = true;
    return true;
}

/* Whether evaluation gives no finite number at a corner or in the middle; that is then p->where. */
static bool is_no_number(struct proof *p, struct br_box box)
{
    const double x[] = {middle(box.x), box.x.low, box.x.high},
                 t[] = {middle(box.t), box.t.low, box.t.high};
    double value[3];
    for (int i = 0; i < 3; i++) {
        br_function_evaluate(p->f, 3, x, t[i], value);
        for (int k = 0; k < 3; k++)
            if (!isfinite(value[k])) {
                p->where = (struct br_box){point(x[k]), point(t[i])};
                return true;
            }
    }
    return false;
}

/* The variable whose halves are bounded rather; of equals the one that is less divided. */
static enum br_variable choose_side(const struct proof *p, struct br_box box)
{
    int bounded[2];
    for (int v = 0; v < 2; v++) {
        struct br_box half[2];
        iv unused;
        split(box, (enum br_variable)v, half);
        bounded[v] = width(*side(&box, (enum br_variable)v)) > 0
                         ? br_function_bound(p->f, half[0], &unused) +
                               br_function_bound(p->f, half[1], &unused)
                         : -1;
    }
    if (bounded[BR_X] != bounded[BR_T])
        return bounded[BR_X] > bounded[BR_T] ? BR_X : BR_T;
    if (is_divisible(box.x) != is_divisible(box.t))
        return is_divisible(box.x) ? BR_X : BR_T;
    return width(box.x) / width(p->whole.x) >= width(box.t) / width(p->whole.t) ? BR_X : BR_T;
}

/* Whether the function's size grows by more than 1000 over the last 2^40 numbers before a face, on
 * the side on which there is room. */
static bool grows(const struct proof *p, struct br_box box, enum br_variable v, double at,
                  double step)
{
    struct br_box whole = p->whole;
    const iv all = *side(&whole, v);
    const double away = fmin(fmax(at + ldexp(step, 40), all.low), all.high);
    iv here, there;
    return !br_function_bound(p->f, with(box, v, point(at)), &here) ||
           !br_function_bound(p->f, with(box, v, point(away)), &there) ||
           !(magnitude(here) <= 1000 * magnitude(there) + 1e-300 || away == at);
}

/* Whether a guard such as x == 0 is zero on a face: there a limit may be filled in. */
static bool is_guarded(const struct proof *p, const struct br_box face[2])
{
    const struct br_function *g;
    for (size_t i = 0; (g = br_function_guard(p->f, i)); i++)
        for (int k = 0; k < 2; k++) {
            iv value;
            if (br_function_bound(g, face[k], &value) && value.low == 0 && value.high == 0)
                return true;
        }
    return false;
}

/* Both faces have bounds, but f has none between them, where no number is: a pole if f grows
 * towards it; else a limit that is filled in. */
static enum br_finite judge_gap(const struct proof *p, struct br_box box, enum br_variable v,
                                const struct br_box face[2])
{
    const iv a = *side(&box, v);
    if (grows(p, box, v, a.low, -width(a)) || grows(p, box, v, a.high, width(a)))
        return BR_POLE;
    return is_guarded(p, face) ? BR_FINITE : BR_UNBOUNDED;
}

/* Whether evaluation grows by more than 1000 over the last 2^40 numbers before a point. */
static bool is_steep(const struct proof *p, struct br_box box, enum br_variable v)
{
    const double at = side(&box, v)->low, away = ldexp(nextafter(at, INFINITY) - at, 40);
    double value[3];
    for (int k = 0; k < 3; k++) {
        const struct br_box place = with(box, v, point(at + (k - 1) * away));
        value[k] = br_function_at(p->f, place.x.low, place.t.low);
    }
    return !(fabs(value[1]) <= 1000 * fmin(fabs(value[0]), fabs(value[2])));
}

/* Judges a box that has no bound: leaves its halves to be judged, or returns what it is. */
static enum br_finite divide(struct proof *p, struct br_box box)
{
    p->where = box;
    if (is_no_number(p, box))
        return BR_NOT_NUMBER;
    if (width(box.x) == 0 && width(box.t) == 0)
        return is_steep(p, box, p->f->uses_x ? BR_X : BR_T) ? BR_POLE : BR_UNBOUNDED;
    const enum br_variable v = choose_side(p, box);
    struct br_box half[2];
    split(box, v, half);
    bool both = true;
    for (int k = 2; k-- > 0;)
        if (!take_in(p, half[k])) {
            p->left[p->count++] = half[k];
            both = false;
        }
    return both && !is_divisible(*side(&box, v)) ? judge_gap(p, box, v, half) : BR_FINITE;
}

enum br_finite br_prove_bounded(const struct br_function *f, struct br_box box, size_t budget,
                                iv *value, struct br_box *where)
{
    struct proof p = {.f = f, .whole = used_box(f, box)};
    enum br_finite found = BR_FINITE;
    size_t looked = 0;
    if (!take_in(&p, p.whole))
        p.left[p.count++] = p.whole;
    while (p.count && found == BR_FINITE) {
        found = divide(&p, p.left[--p.count]);
        if (found == BR_FINITE && p.count &&
            (++looked == (budget ? budget : MOST_BOXES) ||
             p.count + 2 > sizeof p.left / sizeof *p.left))
            found = BR_UNBOUNDED;
    }
    *value = p.value;
    *where = p.where;
    return found;
}

/* A box and what is proved of it. */
struct piece {
    struct br_box box;
    iv value;
};

/* The piece that reaches highest, or, for sign -1, lowest. */
static size_t find_worst(const struct piece *piece, size_t count, double sign)
{
    size_t worst = 0;
    for (size_t i = 1; i < count; i++)
        if (sign > 0 ? piece[i].value.high > piece[worst].value.high
                     : piece[i].value.low < piece[worst].value.low)
            worst = i;
    return worst;
}

/* Without bound: everything. */
static struct piece piece_of(const struct br_function *f, struct br_box box)
{
    struct piece p = {.box = box};
    if (!br_function_bound(f, box, &p.value))
        p.value = (iv){-INFINITY, INFINITY};
    return p;
}

/* Halves piece i: one half takes its place, the other one the next. */
static bool halve(const struct br_function *f, struct br_box whole, struct piece *piece, size_t i,
                  size_t next)
{
    struct br_box half[2];
    const struct br_box box = piece[i].box;
    const bool along_x = width(box.x) * width(whole.t) >= width(box.t) * width(whole.x);
    if (!is_divisible(along_x ? box.x : box.t))
        return false;
    split(box, along_x ? BR_X : BR_T, half);
    piece[i] = piece_of(f, half[0]);
    piece[next] = piece_of(f, half[1]);
    return true;
}

bool br_enclose_values(const struct br_function *f, struct br_box box, size_t budget, iv *value,
                       struct br_box *peak)
{
    enum { MOST = 500 };
    struct piece piece[MOST] = {piece_of(f, used_box(f, box))};
    const size_t most = budget && budget < MOST ? budget : MOST;
    const struct br_box whole = piece[0].box;
    iv seen = {INFINITY, -INFINITY};
    for (size_t count = 1;; count++) {
        const size_t top = find_worst(piece, count, 1), bottom = find_worst(piece, count, -1);
        *value = (iv){piece[bottom].value.low, piece[top].value.high};
        for (int k = 0; k < 2; k++) {
            const struct br_box *at = &piece[k ? top : bottom].box;
            const double x = middle(at->x), found = br_function_at(f, x, middle(at->t));
            if (!(fabs(found) <= magnitude(seen)) || count == 1)
                *peak = (struct br_box){point(x), point(middle(at->t))};
            seen = (iv){fmin(seen.low, found), fmax(seen.high, found)};
        }
        const double above = value->high - seen.high, below = seen.low - value->low;
        if (count == most || (above + below) * 20 <= width(seen) ||
            !halve(f, whole, piece, above >= below ? top : bottom, count))
            break;
    }
    struct br_box where; /* a limit that is filled in has a bound near it only */
    return (isfinite(value->low) && isfinite(value->high)) ||
           br_prove_bounded(f, box, 0, value, &where) == BR_FINITE;
}

/* Whether evaluation gives numbers at the neighbours of a point, in each variable. */
static bool is_lonely(const struct br_function *f, struct br_box at)
{
    const double x[] = {nextafter(at.x.low, -INFINITY), nextafter(at.x.low, INFINITY)};
    double value[4];
    br_function_evaluate(f, 2, x, nextafter(at.t.low, -INFINITY), value);
    br_function_evaluate(f, 2, x, nextafter(at.t.low, INFINITY), value + 2);
    return isfinite(value[0]) && isfinite(value[1]) && isfinite(value[2]) && isfinite(value[3]);
}

enum br_status br_must_be_finite(const struct br_function *f, struct br_box box,
                                 struct br_error *err)
{
    iv value;
    struct br_box where;
    char place[80];
    const enum br_finite found = br_prove_bounded(f, box, 0, &value, &where);
    if (found == BR_FINITE)
        return BR_OK;
    name_place(f, where, place);
    if (found == BR_POLE)
        return br_fail(err, BR_BAD_INPUT, "it has a pole at %s", place);
    const double at = br_function_at(f, where.x.low, where.t.low);
    if (found == BR_UNBOUNDED)
        return br_fail(err, BR_BAD_INPUT, "it cannot be proved to be finite near %s (found %g)",
                       place, at);
    return br_fail(err, BR_BAD_INPUT, "found %g at %s%s", isnan(at) ? NAN : at, place,
                   isnan(at) && is_lonely(f, where)
                       ? " alone; if it has a limit there, write it as in x == 0 ? 1 : sin(x)/x"
                       : "");
}

/* ---- breaks ---- */

void br_breaks_free(struct br_breaks *b)
{
    free(b->at);
    *b = (struct br_breaks){0};
}

/* The sign of a guard where it has one. Zero: everywhere. */
enum sign { NEGATIVE = -1, ZERO, POSITIVE, UNDECIDED };

struct zero_search {
    const struct br_function *guard;
    enum br_variable along;
    struct br_box box;
    struct br_breaks *out;
    size_t looked;
    enum sign before; /* on what was settled last */
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
    const bool bounded = br_function_bound(s->guard, with(s->box, s->along, part), &value);
    return sign_of(bounded, value);
}

/* Also where the doubling of the list fails. */
static bool make_room(struct br_breaks *b)
{
    if (b->count < b->capacity)
        return true;
    const size_t capacity = b->capacity ? 2 * b->capacity : 16;
    iv *at = br_allocate(capacity, sizeof *at);
    if (!at)
        return false;
    if (b->count)
        memcpy(at, b->at, b->count * sizeof *at);
    free(b->at);
    b->at = at;
    b->capacity = capacity;
    return true;
}

static void refuse(struct zero_search *s, iv part, const char *what)
{
    char place[80];
    name_place(s->guard, with(s->box, s->along, part), place);
    s->status = br_fail(s->err, BR_BAD_INPUT, "%s near %s", what, place);
}

/* The state behind it is not known. */
static void add_break(struct zero_search *s, iv at)
{
    const iv all = *side(&s->box, s->along);
    s->before = UNDECIDED;
    if (at.high <= all.low || at.low >= all.high)
        return;
    if (!make_room(s->out))
        s->status = br_no_memory(s->err, "the breaks of a function");
    else if (s->out->count == 2 * MOST_BREAKS)
        refuse(s, at, "it changes its form too often (20,000 times)");
    else
        s->out->at[s->out->count++] = at;
}

/* The guard has this sign in the part that follows. */
static void settle(struct zero_search *s, iv part, enum sign sign)
{
    if (sign != s->before && s->before != UNDECIDED)
        add_break(s, point(part.low));
    else if (sign == ZERO && s->before == UNDECIDED)
        add_break(s, point(part.low));
    s->before = sign;
}

/* The last number of the part that is known to have the sign of its first one; or, backward, the
 * first one that has the sign of its last. */
static double last_with(const struct zero_search *s, double from, double to, enum sign sign)
{
    for (double m = from + (to - from) / 2; m != from && m != to; m = from + (to - from) / 2)
        if (sign_on(s, point(m)) == sign)
            from = m;
        else
            to = m;
    return from;
}

/* The one zero, if any, of a guard that rises or falls (up) everywhere in the part. */
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
    /* Both ends have a sign; what is between has none. */
    const double low = first == left ? nextafter(root.low, INFINITY) : root.low,
                 high = last == right ? nextafter(root.high, -INFINITY) : root.high;
    add_break(s, low <= high ? (iv){low, high} : root);
    if (last == right)
        s->before = right;
}

/* Whether the guard is no larger in the part than the round-off in its middle. */
static bool is_noise(const struct zero_search *s, iv part, iv value)
{
    iv at;
    return br_function_bound(s->guard, with(s->box, s->along, point(middle(part))), &at) &&
           at.low <= 0 && at.high >= 0 && width(at) > 0 && width(value) <= 8 * width(at);
}

static void locate(struct zero_search *s, iv part)
{
    const struct br_box box = with(s->box, s->along, part);
    iv value, slope[2];
    if (s->status)
        return;
    if (++s->looked > MOST_LOOKS) {
        refuse(s, part, "where it changes its form cannot be told");
        return;
    }
    const bool bounded = br_function_bound(s->guard, box, &value);
    const enum sign sign = sign_of(bounded, value);
    if (sign != UNDECIDED) {
        settle(s, part, sign);
    } else if (br_function_taylor(s->guard, s->along, box, 1, slope) &&
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

/* Sorts, and makes one of those that touch. */
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

static enum br_status search(const struct br_function *guard, enum br_variable along,
                             struct br_box box, struct br_breaks *out, struct br_error *err)
{
    struct zero_search s = {
        .guard = guard, .along = along, .box = box, .out = out, .err = err, .before = UNDECIDED};
    iv *all = side(&box, along);
    s.before = sign_on(&s, point(all->low)); /* so that zero from the start on is no break */
    locate(&s, *all);
    merge(out);
    return s.status;
}

/* A guard of both variables that may be zero in the box, where neither is a point. */
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
    for (size_t i = 0; (g = br_function_guard(f, i)) && !status; i++)
        if (is_moving(g, box))
            out->moving = true;
        else if (along == BR_X ? g->uses_x : g->uses_t)
            status = search(g, along, used_box(g, box), out, err);
    if (!status && out->count > MOST_BREAKS)
        status = br_fail(err, BR_BAD_INPUT, "it changes its form %zu times, expected at most %d",
                         out->count, MOST_BREAKS);
    return status;
}

/* Whether a guard's derivative by x is not zero wherever it may be zero itself. */
static bool has_single_front(const struct br_function *g, struct br_box box, int depth)
{
    iv value, slope[2];
    if (sign_of(br_function_bound(g, box, &value), value) != UNDECIDED)
        return true;
    if (br_function_taylor(g, BR_X, box, 1, slope) && (slope[1].low > 0 || slope[1].high < 0))
        return true;
    struct br_box half[2];
    split(box, depth % 2 ? BR_X : BR_T, half);
    return depth > 0 && has_single_front(g, half[0], depth - 1) &&
           has_single_front(g, half[1], depth - 1);
}

enum br_status br_front_times(const struct br_function *f, struct br_box box, struct br_breaks *out,
                              bool *complete, struct br_error *err)
{
    enum { DEPTH = 12 };
    const struct br_function *g;
    enum br_status status = BR_OK;
    *complete = true;
    for (size_t i = 0; (g = br_function_guard(f, i)) && !status; i++) {
        if (!is_moving(g, box))
            continue;
        *complete = *complete && has_single_front(g, box, DEPTH);
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
        char place[80];
        name_place(m->f, with(m->box, m->along, cell), place);
        m->status = br_fail(m->err, BR_BAD_INPUT,
                            "it cannot be resolved: after %zu pieces it still changes near %s",
                            out->count, place);
        return;
    }
    out->at[out->count] = cell.low;
    out->rough[out->count++] = rough;
    out->at[out->count] = cell.high;
    if (rough)
        out->missed += width(cell) * range;
}

/* Its inside: what breaks at an end of the cell does so outside. */
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
    /* Chebyshev's interpolants are not wider than 3 times that (degree 15) */
    const bool flat = bounded && 4 * range <= tolerance;
    if (flat || (bounded && is_polynomial(m, box, cell)))
        add_cell(m, cell, false, range);
    else if (bounded && width(cell) * range <= tolerance * m->total)
        add_cell(m, cell, true, range);
    else if (!is_divisible(cell)) {
        m->out->capacity = m->out->count; /* no further */
        add_cell(m, cell, true, range);
    } else {
        refine(m, (iv){cell.low, middle(cell)});
        refine(m, (iv){middle(cell), cell.high});
    }
}

/* From break to break. */
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
