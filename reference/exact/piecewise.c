/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Most elements of the mesh lie inside of one piece: those are a restriction each piece. The others
 * straddle: in each overlap of such an element with a piece, the piece's series and the element's
 * polynomials are written in the polynomials of the overlap. */

#include "reference/exact/restriction.h"

#include <math.h>
#include <string.h>

/* An element that reaches this far out of a piece, in units of L, lies inside: round-off. */
static const long double tolerance = 4e-16L;

struct overlap {
    size_t element, piece;
    size_t terms;   /* of the series there, at least kept */
    double *series; /* terms x terms, [k][l]: the piece's k-th polynomial in the overlap's l-th */
    double *kept;   /* kept x terms: the element's */
};

struct inside {
    struct br_restriction *restriction; /* NULL: no element */
    size_t first;                       /* element */
};

struct br_piecewise {
    const struct br_pieces *pieces; /* borrowed */
    size_t extra;
    struct br_exact_mesh mesh;
    struct inside *inside; /* pieces */
    struct overlap *overlap;
    size_t overlaps, room;
    double *local; /* workspace: an overlap's coefficients */
    struct br_store *store;
};

/* ---- places, in units of L ---- */

static long double piece_end(const struct br_piecewise *w, size_t e)
{
    return (long double)w->pieces->end[e] / w->pieces->length;
}

static long double node(const struct br_piecewise *w, size_t j)
{
    return (long double)j / (long double)w->mesh.elements;
}

static size_t piece_terms(const struct br_piecewise *w, size_t e)
{
    return w->pieces->terms[e] + w->extra;
}

/* ---- creation ---- */

/* The elements first to last - 1 lie inside of piece e. */
static enum br_status restrict_inside(struct br_piecewise *w, size_t e, size_t first, size_t last,
                                      struct br_error *err)
{
    struct inside *in = &w->inside[e];
    in->first = first;
    const long double a = piece_end(w, e), h = piece_end(w, e + 1) - a;
    const bool whole = w->pieces->count == 1;
    const struct br_restriction_shape shape = {
        .length = piece_terms(w, e),
        .elements = last - first,
        .degree = w->mesh.degree,
        .scale = sqrt(w->pieces->length),
        .first = whole ? 0 : (node(w, first) - a) / h,
        .width = whole ? 1 : (node(w, last) - node(w, first)) / h,
    };
    return br_restriction_create(&in->restriction, &shape, w->store, err);
}

/* out (count x s->count) = the orthonormal polynomials of `all` in those of `part` of it. */
static void rewrite(struct br_subinterval *s, const long double part[2], const long double all[2],
                    size_t count, double *out)
{
    const long double width = (part[1] - part[0]) / (all[1] - all[0]);
    br_subinterval_move(s, (part[0] - all[0]) / (all[1] - all[0]), width);
    for (size_t k = 0; k < count; k++)
        for (size_t l = 0; l <= k; l++)
            out[k * s->count + l] = (double)(sqrtl(width) * s->r[k * s->count + l]);
}

static enum br_status fill_overlap(struct br_piecewise *w, struct overlap *o,
                                   const long double part[2], struct br_error *err)
{
    const size_t kept = w->mesh.degree + 1;
    const long double piece[2] = {piece_end(w, o->piece), piece_end(w, o->piece + 1)};
    const long double element[2] = {node(w, o->element), node(w, o->element + 1)};
    struct br_store store = {0};
    struct br_subinterval s;
    br_subinterval_init(&s, o->terms, &store);
    o->series = br_store_take(w->store, o->terms * o->terms, sizeof *o->series);
    o->kept = br_store_take(w->store, kept * o->terms, sizeof *o->kept);
    const bool failed = store.failed || w->store->failed;
    if (!failed) {
        rewrite(&s, part, piece, o->terms, o->series);
        rewrite(&s, part, element, kept, o->kept);
    }
    br_store_clear(&store);
    return failed ? br_no_memory(err, "a projection") : BR_OK;
}

static enum br_status add_overlap(struct br_piecewise *w, size_t j, size_t e,
                                  const long double part[2], struct br_error *err)
{
    if (w->overlaps == w->room) {
        const size_t room = 2 * w->room + 16;
        struct overlap *bigger = br_store_take(w->store, room, sizeof *bigger);
        if (!bigger)
            return br_no_memory(err, "a projection");
        if (w->overlaps)
            memcpy(bigger, w->overlap, w->overlaps * sizeof *bigger);
        w->overlap = bigger;
        w->room = room;
    }
    const size_t kept = w->mesh.degree + 1, terms = piece_terms(w, e);
    struct overlap *o = &w->overlap[w->overlaps++];
    *o = (struct overlap){.element = j, .piece = e, .terms = terms > kept ? terms : kept};
    return fill_overlap(w, o, part, err);
}

/* Element j, which begins in piece e and ends in another. */
static enum br_status straddle(struct br_piecewise *w, size_t j, size_t e, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (; e < w->pieces->count && piece_end(w, e) < node(w, j + 1) && !status; e++) {
        const long double part[2] = {fmaxl(node(w, j), piece_end(w, e)),
                                     fminl(node(w, j + 1), piece_end(w, e + 1))};
        if (part[1] > part[0])
            status = add_overlap(w, j, e, part, err);
    }
    return status;
}

static enum br_status fill(struct br_piecewise *w, struct br_error *err)
{
    const size_t n = w->mesh.elements;
    enum br_status status = BR_OK;
    for (size_t j = 0, e = 0; j < n && !status;) {
        while (e + 1 < w->pieces->count && piece_end(w, e + 1) <= node(w, j) + tolerance)
            e++;
        const long double inside = (piece_end(w, e + 1) + tolerance) * (long double)n;
        const size_t last = inside < (long double)n ? (size_t)inside : n;
        if (last > j) {
            status = restrict_inside(w, e, j, last, err);
            j = last;
        } else
            status = straddle(w, j++, e, err);
    }
    return status;
}

enum br_status br_piecewise_create(struct br_piecewise **out, const struct br_pieces *pieces,
                                   size_t extra, const struct br_exact_mesh *mesh,
                                   struct br_store *store, struct br_error *err)
{
    struct br_piecewise *w = *out = br_store_take(store, 1, sizeof *w);
    if (!w)
        return br_no_memory(err, "a projection");
    *w = (struct br_piecewise){.pieces = pieces, .extra = extra, .mesh = *mesh, .store = store};
    w->inside = br_store_take(store, pieces->count, sizeof *w->inside);
    const enum br_status status = w->inside ? fill(w, err) : br_no_memory(err, "a projection");
    size_t most = 1;
    for (size_t i = 0; i < w->overlaps; i++)
        most = w->overlap[i].terms > most ? w->overlap[i].terms : most;
    w->local = br_store_take(store, most, sizeof *w->local);
    return status || w->local ? status : br_no_memory(err, "a projection");
}

/* ---- the application ---- */

/* The series in the overlap's own polynomials, into w->local. */
static void localise(const struct br_piecewise *w, const struct overlap *o, const double *series)
{
    const double *here = series + br_pieces_at(w->pieces, o->piece, w->extra);
    const size_t terms = piece_terms(w, o->piece);
    const double scale = sqrt(w->pieces->length);
    for (size_t l = 0; l < o->terms; l++) {
        w->local[l] = 0;
        for (size_t k = l; k < terms; k++)
            w->local[l] += here[k] * o->series[k * o->terms + l];
        w->local[l] *= scale;
    }
}

static void add_values(const struct br_piecewise *w, const struct overlap *o, double *c)
{
    for (size_t k = 0; k <= w->mesh.degree; k++)
        for (size_t l = 0; l <= k; l++)
            c[k] += o->kept[k * o->terms + l] * w->local[l];
}

/* The square of what the element's values c leave out of the overlap. */
static double left_out(const struct br_piecewise *w, const struct overlap *o, const double *c)
{
    double sum = 0;
    for (size_t l = 0; l < o->terms; l++) {
        for (size_t k = l; k <= w->mesh.degree; k++)
            w->local[l] -= c[k] * o->kept[k * o->terms + l];
        sum += w->local[l] * w->local[l];
    }
    return sum;
}

static double apply_overlaps(const struct br_piecewise *w, const double *series, double *c)
{
    const size_t kept = w->mesh.degree + 1;
    double rest = 0;
    for (size_t i = 0; i < w->overlaps; i++)
        for (size_t k = 0; k < kept; k++)
            c[w->overlap[i].element * kept + k] = 0;
    for (size_t i = 0; i < w->overlaps; i++) {
        localise(w, &w->overlap[i], series);
        add_values(w, &w->overlap[i], &c[w->overlap[i].element * kept]);
    }
    for (size_t i = 0; i < w->overlaps; i++) {
        localise(w, &w->overlap[i], series);
        rest += left_out(w, &w->overlap[i], &c[w->overlap[i].element * kept]);
    }
    return rest;
}

void br_piecewise_apply(struct br_piecewise *w, const double *series, double *c, double *rest)
{
    const size_t kept = w->mesh.degree + 1;
    *rest = apply_overlaps(w, series, c);
    for (size_t e = 0; e < w->pieces->count; e++) {
        double part;
        if (!w->inside[e].restriction)
            continue;
        br_restriction_apply(w->inside[e].restriction,
                             series + br_pieces_at(w->pieces, e, w->extra),
                             &c[w->inside[e].first * kept], &part);
        *rest += part;
    }
}
