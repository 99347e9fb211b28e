/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Meshes for a function along one variable. Its box is halved until a polynomial represents the
 * function in each part; or, where it is not smooth, until little of its integral is left there.
 *
 * A function of x and t that is no product has switching functions that move. Its box is halved
 * along the variable that helps more, until in each part a polynomial along `one` represents the
 * function, or a switching function crosses the part all along. Cells end where smooth functions
 * need it, not at a switching function: that moves, and quadratures are cut at it. */
#include "reference/exact/inside.h"

#include <gsl/gsl_sort.h>
#include <math.h>
#include <string.h>

#include "solver/box.h"

/* ---- lists ---- */

void br_list_add(struct br_list *list, double value, struct br_store *store)
{
    double *at = br_store_grow(store, list->at, list->count, &list->room, sizeof *at);
    if (!at)
        return;
    list->at = at;
    list->at[list->count++] = value;
}

void br_list_sort(struct br_list *list)
{
    size_t kept = 0;
    if (list->count)
        gsl_sort(list->at, 1, list->count);
    for (size_t i = 0; i < list->count; i++)
        if (!kept || list->at[i] > list->at[kept - 1])
            list->at[kept++] = list->at[i];
    list->count = kept;
}

/* ---- boxes ---- */

static struct br_interval along(struct br_box box, enum br_variable v)
{
    return *side(&box, v);
}

static void halve(struct br_box box, enum br_variable v, struct br_box half[2])
{
    const struct br_interval i = along(box, v);
    half[0] = half[1] = box;
    side(&half[0], v)->high = side(&half[1], v)->low = i.low + width(i) / 2;
}

static double measure(struct br_box box)
{
    const double x = width(box.x), t = width(box.t);
    return (x > 0 ? x : 1) * (t > 0 ? t : 1);
}

double br_function_mesh_error(const struct br_function *f, enum br_variable v, struct br_box box,
                              size_t degree)
{
    struct br_interval coefficient[17];
    if (!br_function_taylor(f, v, box, degree + 1, coefficient))
        return INFINITY;
    const double error =
        2 * magnitude(coefficient[degree + 1]) * pow(width(along(box, v)) / 4, (double)degree + 1);
    return isnan(error) ? INFINITY : error;
}

/* ---- the mean ---- */

/* Repeated halves: the one whose share is known least is halved next, along the variable by which
 * more is known then. */
struct share {
    struct br_box box;
    double low, high; /* of the integral of |f| over it */
};

static struct share share_of(const struct br_function *f, struct br_box box)
{
    struct br_interval v;
    if (!br_function_bound(f, box, &v))
        return (struct share){box, 0, INFINITY};
    const double least = v.low > 0 ? v.low : v.high < 0 ? -v.high : 0;
    return (struct share){box, measure(box) * least, measure(box) * magnitude(v)};
}

static double unknown(const struct share of[2])
{
    return of[0].high - of[0].low + (of[1].high - of[1].low);
}

static void share_halves(const struct br_function *f, struct br_box box, enum br_variable v,
                         struct share of[2])
{
    struct br_box half[2];
    halve(box, v, half);
    for (size_t k = 0; k < 2; k++)
        of[k] = share_of(f, half[k]);
}

double br_function_mesh_mean(const struct br_function *f, struct br_box whole)
{
    enum { MOST = 400 };
    struct share share[MOST] = {share_of(f, whole)};
    for (size_t count = 1;; count++) {
        double low = 0, high = 0;
        size_t worst = 0;
        for (size_t i = 0; i < count; i++) {
            low += share[i].low;
            high += share[i].high;
            if (share[i].high - share[i].low > share[worst].high - share[worst].low)
                worst = i;
        }
        if (count == MOST || low >= high / 2)
            return (low > 0 ? low : high) / measure(whole);
        const struct br_box box = share[worst].box;
        const double x = width(box.x), t = width(box.t);
        const bool along_x = x > 0 && !(t / width(whole.t) > x / width(whole.x));
        struct share of[2], other[2];
        share_halves(f, box, along_x ? BR_X : BR_T, of);
        if (x > 0 && t > 0) {
            share_halves(f, box, along_x ? BR_T : BR_X, other);
            if (unknown(other) < unknown(of))
                memcpy(of, other, sizeof of);
        }
        share[worst] = of[0];
        share[count] = of[1];
    }
}

/* ---- the mesh ---- */

enum { MOST_BOXES = 40000, MOST_HALVINGS = 10 };

/* Of the polynomials by br_variable: on an element, and over a Radau step. */
static const size_t degrees[] = {[BR_X] = BR_MESH_DEGREE, [BR_T] = 8};

/* The share of a function's integral that a cell may hide, and the share of the box below which
 * cells are not examined. */
static const double little = 1e-13, least = 1e-15;

struct cover {
    const struct br_function_mesh *function_mesh;
    enum br_variable one, other; /* the mesh is along the one */
    struct br_box whole;
    struct br_list *ends;
    struct br_store *store;
    struct br_error *err;
    size_t boxes;
    double missed;
};

/* The share of the whole that the box takes along a variable. */
static double share_along(const struct cover *c, struct br_box box, enum br_variable v)
{
    return width(along(box, v)) / width(along(c->whole, v));
}

static double error_in(const struct cover *c, struct br_box box)
{
    return br_function_mesh_error(c->function_mesh->f, c->one, box, degrees[c->one]);
}

/* The larger error of both halves. */
static double error_of_halves(const struct cover *c, struct br_box box, enum br_variable v)
{
    struct br_box half[2];
    halve(box, v, half);
    return fmax(error_in(c, half[0]), error_in(c, half[1]));
}

static enum br_status too_fine(const struct cover *c, struct br_box box)
{
    const struct br_interval here = along(box, c->one);
    if (width(c->whole.x) > 0 && width(c->whole.t) > 0)
        return br_fail(c->err, BR_NOT_FINITE,
                       "a load of x and t has too fine details near x = %g m, t = %g s", box.x.low,
                       box.t.low);
    return br_fail(c->err, BR_NOT_FINITE, "the data have details that are too fine near %s = %g %s",
                   c->one == BR_X ? "x" : "t", here.low + width(here) / 2,
                   c->one == BR_X ? "m" : "s");
}

/* A switching function crosses the box, which is not halved any more: by how much the function may
 * exceed its sampled values there. */
static double excess(const struct cover *c, struct br_box box, struct br_interval value)
{
    double low = INFINITY, high = -INFINITY;
    for (int j = 0; j <= 2; j++) {
        double x[3], at[3];
        for (int i = 0; i <= 2; i++)
            x[i] = box.x.low + width(box.x) * i / 2;
        br_function_evaluate(c->function_mesh->f, 3, x, box.t.low + width(box.t) * j / 2, at);
        for (int i = 0; i <= 2; i++) {
            low = fmin(low, at[i]);
            high = fmax(high, at[i]);
        }
    }
    return fmax(low - value.low, 0) + fmax(value.high - high, 0);
}

static enum br_status cover(struct cover *c, struct br_box box);

/* Covers both halves along v. cells: the halves are cells, whose ends are added, but not the
 * whole's own. */
static enum br_status cover_halves(struct cover *c, struct br_box box, enum br_variable v,
                                   bool cells)
{
    const struct br_interval whole = along(c->whole, c->one);
    struct br_box half[2];
    enum br_status status = BR_OK;
    halve(box, v, half);
    for (size_t k = 0; k < 2 && !status; k++) {
        const struct br_interval here = along(half[k], c->one);
        if (cells && here.low > whole.low)
            br_list_add(c->ends, here.low, c->store);
        if (cells && here.high < whole.high)
            br_list_add(c->ends, here.high, c->store);
        status = cover(c, half[k]);
    }
    return status;
}

/* Halves a box in which no polynomial represents the function, unless little of the integral is in
 * it, it is narrow, or a moving switching function crosses it all along. The error is infinite
 * where the function is not smooth. */
static enum br_status divide(struct cover *c, struct br_box box, double error, bool bounded,
                             struct br_interval value)
{
    const struct br_function_mesh *s = c->function_mesh;
    const struct br_interval here = along(box, c->one);
    const double middle = here.low + width(here) / 2, fine = pow(0.5, MOST_HALVINGS);
    const bool narrow = !(width(here) > least * width(along(s->box, c->one)) && here.low < middle &&
                          middle < here.high);
    const bool moving = isinf(error) && width(along(c->whole, c->other)) > 0;
    const enum br_variable longer =
        share_along(c, box, BR_X) >= share_along(c, box, BR_T) ? BR_X : BR_T;
    double hidden = measure(box) * width(value);
    if (!narrow && !(bounded && hidden <= little * s->mean * measure(s->box))) {
        if (moving && share_along(c, box, longer) > fine)
            return cover_halves(c, box, longer, false);
        const bool help = !moving && share_along(c, box, c->other) > fine &&
                          error_of_halves(c, box, c->other) < error_of_halves(c, box, c->one);
        if (!moving)
            return cover_halves(c, box, help ? c->other : c->one, !help);
        hidden = bounded ? measure(box) * excess(c, box, value) : 0;
    }
    c->missed += hidden;
    return bounded ? BR_OK : br_must_be_finite(s->f, box, c->err);
}

static enum br_status cover(struct cover *c, struct br_box box)
{
    struct br_interval value = {0, 0};
    const bool bounded = br_function_bound(c->function_mesh->f, box, &value);
    const double error = error_in(c, box);
    if (++c->boxes > MOST_BOXES)
        return too_fine(c, box);
    return bounded && error <= BR_MESH_TOLERANCE * fmax(magnitude(value), c->function_mesh->mean)
               ? BR_OK
               : divide(c, box, error, bounded, value);
}

enum br_status br_function_mesh_add(struct br_function_mesh *function_mesh, struct br_box part,
                                    struct br_list ends[2], struct br_store *store,
                                    struct br_error *err)
{
    enum br_status status = BR_OK;
    double missed = 0;
    for (enum br_variable v = BR_X; v <= BR_T && !status; v++) {
        struct cover c = {.function_mesh = function_mesh,
                          .one = v,
                          .other = v == BR_X ? BR_T : BR_X,
                          .whole = part,
                          .ends = &ends[v],
                          .store = store,
                          .err = err};
        if (width(along(part, v)) > 0)
            status = cover(&c, part);
        missed = fmax(missed, c.missed);
    }
    if (missed > 0)
        function_mesh->missed += missed / (function_mesh->mean * measure(function_mesh->box));
    return store->failed ? br_no_memory(err, "a mesh") : status;
}
