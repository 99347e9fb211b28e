/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Proofs that a function is finite. */
#include "solver/proof.h"

#include <stdio.h>

#include "solver/box.h"

enum { MOST_BOXES = 20000 };

void br_name_position(const struct br_function *f, struct br_box box, char text[80])
{
    const char *between = f->uses_x && f->uses_t ? ", " : "";
    char x[40] = "", t[40] = "";
    if (f->uses_x)
        snprintf(x, sizeof x, "x = %.10g m", middle(box.x));
    if (f->uses_t)
        snprintf(t, sizeof t, "t = %.10g s", middle(box.t));
    snprintf(text, 80, "%s%s%s", x, between, t);
}

/* The boxes that are still to be examined, as a stack: halves of halves. */
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

/* Whether evaluation gives no finite number at a corner or in the middle; that point is then
 * p->where. */
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

/* The variable with more bounded halves; if they have equally many, the one that has been divided
 * less. */
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
 * the side inside the whole box. */
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

/* Whether a switching function such as x == 0 is zero on a face: there a limit may be filled in. */
static bool is_guarded(const struct proof *p, const struct br_box face[2])
{
    const struct br_function *g;
    for (size_t i = 0; (g = br_function_switching(p->f, i)); i++)
        for (int k = 0; k < 2; k++) {
            iv value;
            if (br_function_bound(g, face[k], &value) && value.low == 0 && value.high == 0)
                return true;
        }
    return false;
}

/* Both faces have bounds, but f has none between them, although no double lies there: a pole if f
 * grows towards it; else, at a switching function, a limit that is filled in. */
static enum br_finite check_gap(const struct proof *p, struct br_box box, enum br_variable v,
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
        const struct br_box position = with(box, v, point(at + (k - 1) * away));
        value[k] = br_function_at(p->f, position.x.low, position.t.low);
    }
    return !(fabs(value[1]) <= 1000 * fmin(fabs(value[0]), fabs(value[2])));
}

/* Examines a box without a bound: pushes its halves without bounds on the stack, or returns the
 * verdict. */
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
    return both && !is_divisible(*side(&box, v)) ? check_gap(p, box, v, half) : BR_FINITE;
}

enum br_finite br_prove_bounded(const struct br_function *f, struct br_box box, iv *value,
                                struct br_box *where)
{
    struct proof p = {.f = f, .whole = used_box(f, box)};
    enum br_finite found = BR_FINITE;
    size_t examined = 0;
    if (!take_in(&p, p.whole))
        p.left[p.count++] = p.whole;
    while (p.count && found == BR_FINITE) {
        found = divide(&p, p.left[--p.count]);
        if (found == BR_FINITE && p.count &&
            (++examined == MOST_BOXES || p.count + 2 > sizeof p.left / sizeof *p.left))
            found = BR_UNBOUNDED;
    }
    *value = p.value;
    *where = p.where;
    return found;
}

/* A box and the enclosure of f on it. */
struct subbox {
    struct br_box box;
    iv value;
};

/* The subbox with the highest upper bound, or, for sign -1, the lowest lower bound. */
static size_t find_worst(const struct subbox *subbox, size_t count, double sign)
{
    size_t worst = 0;
    for (size_t i = 1; i < count; i++)
        if (sign > 0 ? subbox[i].value.high > subbox[worst].value.high
                     : subbox[i].value.low < subbox[worst].value.low)
            worst = i;
    return worst;
}

/* The enclosure is the whole line where f has no bound. */
static struct subbox subbox_of(const struct br_function *f, struct br_box box)
{
    struct subbox p = {.box = box};
    if (!br_function_bound(f, box, &p.value))
        p.value = (iv){-INFINITY, INFINITY};
    return p;
}

/* Halves subbox i: one half becomes subbox i, the other one subbox `next`. */
static bool halve(const struct br_function *f, struct br_box whole, struct subbox *subbox, size_t i,
                  size_t next)
{
    struct br_box half[2];
    const struct br_box box = subbox[i].box;
    const bool along_x = width(box.x) * width(whole.t) >= width(box.t) * width(whole.x);
    if (!is_divisible(along_x ? box.x : box.t))
        return false;
    split(box, along_x ? BR_X : BR_T, half);
    subbox[i] = subbox_of(f, half[0]);
    subbox[next] = subbox_of(f, half[1]);
    return true;
}

bool br_enclose_values(const struct br_function *f, struct br_box box, iv *value,
                       struct br_box *peak)
{
    enum { MOST = 500 };
    struct subbox subbox[MOST] = {subbox_of(f, used_box(f, box))};
    const struct br_box whole = subbox[0].box;
    iv sampled = {INFINITY, -INFINITY};
    for (size_t count = 1;; count++) {
        const size_t top = find_worst(subbox, count, 1), bottom = find_worst(subbox, count, -1);
        *value = (iv){subbox[bottom].value.low, subbox[top].value.high};
        for (int k = 0; k < 2; k++) {
            const struct br_box *at = &subbox[k ? top : bottom].box;
            const double x = middle(at->x), found = br_function_at(f, x, middle(at->t));
            if (!(fabs(found) <= magnitude(sampled)) || count == 1)
                *peak = (struct br_box){point(x), point(middle(at->t))};
            sampled = (iv){fmin(sampled.low, found), fmax(sampled.high, found)};
        }
        const double above = value->high - sampled.high, below = sampled.low - value->low;
        if (count == MOST || (above + below) * 20 <= width(sampled) ||
            !halve(f, whole, subbox, above >= below ? top : bottom, count))
            break;
    }
    struct br_box where; /* a filled-in limit has a bound in small boxes only */
    return (isfinite(value->low) && isfinite(value->high)) ||
           br_prove_bounded(f, box, value, &where) == BR_FINITE;
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
    char position[80];
    const enum br_finite found = br_prove_bounded(f, box, &value, &where);
    if (found == BR_FINITE)
        return BR_OK;
    br_name_position(f, where, position);
    if (found == BR_POLE)
        return br_fail(err, BR_BAD_INPUT, "it has a pole at %s", position);
    const double at = br_function_at(f, where.x.low, where.t.low);
    if (found == BR_UNBOUNDED)
        return br_fail(err, BR_BAD_INPUT, "it cannot be proved to be finite near %s (found %g)",
                       position, at);
    return br_fail(err, BR_BAD_INPUT, "found %g at %s%s", isnan(at) ? NAN : at, position,
                   isnan(at) && is_lonely(f, where)
                       ? " alone; if it has a limit there, write it as in x == 0 ? 1 : sin(x)/x"
                       : "");
}
