/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/projection.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

/* ---- a part of an interval ---- */

/* Legendre series on [0, 1] as series on an interval of it. */
struct subinterval {
    size_t count;
    long double *coupling; /* count + 1: b in x p_k = b_{k+1} p_{k+1} + p_k / 2 + b_k p_{k-1} */
    long double *r;        /* count x count, see move; 0 for l > k */
};

/* For p_0 ... p_{count - 1}. After a failure, which the store keeps, it is of no use. */
static void subinterval_init(struct subinterval *v, size_t count, struct br_store *store)
{
    v->count = count;
    v->coupling = br_store_take(store, count + 1, sizeof *v->coupling);
    v->r = br_store_take(store, count * count, sizeof *v->r);
    for (size_t k = 0; !store->failed && k <= count; k++) {
        const long double x = (long double)k;
        v->coupling[k] = k ? x / (2 * sqrtl(4 * x * x - 1)) : 0;
    }
}

/* p_k(first + width xi) = sum over l of r[k * count + l] p_l(xi), 0 <= first and first + width <=
 * 1: by the recurrence of p_{k+1} in x = first + width xi, where a product with xi is the same
 * recurrence in l. Small coefficients keep their digits: they only come from each other. */
static void move(struct subinterval *v, long double first, long double width)
{
    const size_t count = v->count;
    const long double *b = v->coupling;
    v->r[0] = 1;
    for (size_t k = 0; k + 1 < count; k++) {
        const long double *here = v->r + k * count, *before = k ? here - count : here;
        long double *next = v->r + (k + 1) * count;
        for (size_t l = 0; l <= k + 1; l++) {
            const long double left = l ? b[l] * here[l - 1] : 0;
            const long double right = l < k ? b[l + 1] * here[l + 1] : 0;
            next[l] =
                ((first - 0.5L + width / 2) * here[l] + width * (left + right) - b[k] * before[l]) /
                b[k + 1];
        }
    }
}

/* ---- what is left out, as a triangle ---- */

/* |A c|^2 for a tall matrix A that comes in blocks, as |R c|^2 with a triangle: A = Q R. */
struct remainder {
    size_t columns, block; /* rows of a block; 0: there is nothing, R stays 0 */
    double
        *a; /* (columns + block) x columns, by columns: R, upper triangle, above the next block */
    double *tau; /* workspace */
};

/* R = 0. */
static void remainder_init(struct remainder *m, size_t columns, size_t block,
                           struct br_store *store)
{
    *m = (struct remainder){.columns = columns, .block = block};
    m->a = br_store_take(store, (columns + block) * columns, sizeof *m->a);
    m->tau = br_store_take(store, columns, sizeof *m->tau);
}

/* An entry of R or of the next block. */
static double *remainder_r(const struct remainder *m, size_t row, size_t column)
{
    return &m->a[column * (m->columns + m->block) + row];
}

static double *remainder_block(const struct remainder *m, size_t row, size_t column)
{
    return remainder_r(m, m->columns + row, column);
}

/* Adds the block to R, and clears it. Fails with BR_NO_MEMORY or BR_SINGULAR. */
static enum br_status remainder_add(const struct remainder *m, struct br_error *err)
{
    const size_t rows = m->columns + m->block;
    if (!m->block)
        return BR_OK;
    const lapack_int info = LAPACKE_dgeqrf(LAPACK_COL_MAJOR, (lapack_int)rows,
                                           (lapack_int)m->columns, m->a, (lapack_int)rows, m->tau);
    for (size_t k = 0; k < m->columns; k++) /* the reflectors below the diagonal are not needed */
        memset(remainder_r(m, k + 1, k), 0, (rows - k - 1) * sizeof(double));
    if (info == LAPACK_WORK_MEMORY_ERROR)
        return br_no_memory(err, "a projection's remainder");
    return info ? br_fail(err, BR_SINGULAR, "a projection's remainder failed (%d)", (int)info)
                : BR_OK;
}

/* ---- one piece ----
 *
 * In two stages: the series on groups of elements, in as many local polynomials as round-off lets
 * matter, and these on the elements, by one table for all groups. Elements that do not fill the
 * last group get it moved back over those before. */

/* Local coefficients are left out of the tables where the root of the sum of their squares is
 * below this part of the series, and out of a sum at this part of what they are added to. */
static const double table_tail = 1e-18, sum_tail = 1e-17;

struct br_restriction {
    struct br_restriction_shape shape;
    size_t group, groups; /* elements in each, and their number */
    size_t terms;         /* local coefficients of a group that are kept */
    double *coarse;       /* length x (groups x terms): the series on the groups */
    double *fine;         /* terms x (group x (degree + 1)); NULL for groups of one element */
    double *rest;         /* length x length, R' with rest = |R series|^2 */
    double *local;        /* groups x terms, workspace */
    double *work;         /* length */
};

/* What the tables are made with. */
struct making {
    struct subinterval series, local; /* the series on a group, and a group's on an element */
    struct remainder group, all;      /* what elements leave out of either */
    struct br_store store;
};

/* The norm of a function on an element whose coefficients have the norm 1 on [0, 1]. */
static double scale(const struct br_restriction *r)
{
    return r->shape.scale * sqrt((double)r->shape.width / (double)r->shape.elements);
}

/* ---- the choice of groups ---- */

/* About how many local coefficients count: p_k oscillates like cos(k phi), most at the ends,
 * where phi spans 2 sqrt(h). */
static double likely_terms(const struct br_restriction_shape *s, size_t group)
{
    const double h = (double)group / (double)s->elements * (double)s->width;
    return fmin((double)s->length, 8 + 2 * (double)s->length * sqrt(h));
}

/* Multiplications of an application. */
static double cost(const struct br_restriction_shape *s, size_t group)
{
    const double values = (double)s->elements * (double)(s->degree + 1);
    const double groups = ceil((double)s->elements / (double)group);
    const double terms = likely_terms(s, group);
    return group == 1 ? values * (double)s->length
                      : groups * terms * (double)s->length + values * terms;
}

static size_t choose_group(const struct br_restriction_shape *s)
{
    size_t best = 1;
    for (size_t group = 2; group <= s->elements; group *= 2)
        if (cost(s, group) < cost(s, best))
            best = group;
    return best;
}

static size_t first_element(const struct br_restriction *r, size_t g)
{
    const size_t first = g * r->group, last = r->shape.elements - r->group;
    return first < last ? first : last;
}

/* The series on group g. */
static void move_to(const struct br_restriction *r, size_t g, struct subinterval *series)
{
    const long double h = r->shape.width / (long double)r->shape.elements;
    move(series, r->shape.first + h * (long double)first_element(r, g), h * (long double)r->group);
}

/* A group's series, of r->terms, on its element j. */
static void move_inside(const struct br_restriction *r, size_t j, struct subinterval *local)
{
    move(local, (long double)j / (long double)r->group, 1 / (long double)r->group);
}

/* ---- what is left out ---- */

/* |R_0 c|^2 is what the group's elements from `first` on leave out of its series c. */
static enum br_status reduce_group(const struct br_restriction *r, size_t first,
                                   struct making *with, struct br_error *err)
{
    const struct remainder *group = &with->group;
    const size_t terms = group->columns, kept = r->shape.degree + 1;
    enum br_status status = BR_OK;
    memset(group->a, 0, (terms + group->block) * terms * sizeof *group->a);
    for (size_t j = first; j < r->group && !status; j++) {
        move_inside(r, j, &with->local);
        for (size_t k = 0; k < terms; k++)
            for (size_t l = kept; l < terms; l++)
                *remainder_block(group, l - kept, k) =
                    scale(r) * (double)with->local.r[k * terms + l];
        status = remainder_add(group, err);
    }
    return status;
}

/* Adds R_0 times the series on a group. */
static enum br_status add_group(const struct remainder *group, const struct subinterval *series,
                                const struct remainder *all, struct br_error *err)
{
    for (size_t k = 0; k < series->count; k++)
        for (size_t i = 0; i < group->columns; i++) {
            long double sum = 0;
            for (size_t l = i; l < group->columns && l <= k; l++)
                sum += *remainder_r(group, i, l) * series->r[k * series->count + l];
            *remainder_block(all, i, k) = (double)sum;
        }
    return remainder_add(all, err);
}

/* The last group's first elements may be of the one before, too, and count once. */
static enum br_status fill_rest(const struct br_restriction *r, struct making *with,
                                struct br_error *err)
{
    const size_t length = r->shape.length, last = r->groups - 1;
    enum br_status status = BR_OK;
    for (size_t g = 0; g <= last && !status; g++) {
        if (g == 0 || g == last)
            status = reduce_group(r, g * r->group - first_element(r, g), with, err);
        move_to(r, g, &with->series);
        if (!status)
            status = add_group(&with->group, &with->series, &with->all, err);
    }
    for (size_t k = 0; k < length && !status; k++)
        memcpy(&r->rest[k * length], remainder_r(&with->all, 0, k), length * sizeof *r->rest);
    return status;
}

/* ---- the tables ---- */

/* The number of local coefficients that count in any series of norm 1. square: length x length,
 * workspace. */
static size_t count_terms(const struct br_restriction *r, struct subinterval *series,
                          double *square)
{
    const size_t length = r->shape.length;
    const double h = (double)r->group / (double)r->shape.elements * (double)r->shape.width;
    memset(square, 0, length * length * sizeof *square);
    for (size_t g = 0; g < r->groups; g++) {
        move_to(r, g, series);
        for (size_t i = 0; i < length * length; i++)
            square[i] += h * (double)(series->r[i] * series->r[i]);
    }
    size_t terms = 1;
    for (size_t k = 0; k < length; k++) {
        double tail = 0;
        for (size_t l = length; l-- > terms;)
            if (!((tail += square[k * length + l]) <= table_tail * table_tail))
                terms = l + 1;
    }
    return terms;
}

static void fill_coarse(struct br_restriction *r, struct subinterval *series)
{
    const size_t length = r->shape.length;
    const double factor = r->fine ? 1 : scale(r);
    for (size_t g = 0; g < r->groups; g++) {
        move_to(r, g, series);
        for (size_t k = 0; k < length; k++)
            for (size_t l = 0; l < r->terms && l <= k; l++)
                r->coarse[(k * r->groups + g) * r->terms + l] =
                    factor * (double)series->r[k * length + l];
    }
}

static void fill_fine(struct br_restriction *r, struct subinterval *local)
{
    const size_t kept = r->shape.degree + 1;
    for (size_t j = 0; j < r->group; j++) {
        move_inside(r, j, local);
        for (size_t k = 0; k < r->terms; k++)
            for (size_t l = 0; l < kept && l <= k; l++)
                r->fine[(k * r->group + j) * kept + l] =
                    scale(r) * (double)local->r[k * r->terms + l];
    }
}

static enum br_status fill(struct br_restriction *r, struct making *with, struct br_store *store,
                           struct br_error *err)
{
    const size_t length = r->shape.length, kept = r->shape.degree + 1;
    subinterval_init(&with->series, length, &with->store);
    r->rest = br_store_take(store, length * length, sizeof *r->rest);
    if (with->store.failed || !r->rest)
        return br_no_memory(err, "a projection");
    const size_t terms = count_terms(r, &with->series, r->rest);
    r->terms = r->group == 1 ? kept : terms;
    r->coarse = br_store_take(store, length * r->groups * r->terms, sizeof *r->coarse);
    r->local = br_store_take(store, r->groups * r->terms, sizeof *r->local);
    r->work = br_store_take(store, length, sizeof *r->work);
    if (r->group > 1)
        r->fine = br_store_take(store, r->terms * r->group * kept, sizeof *r->fine);
    subinterval_init(&with->local, terms, &with->store);
    remainder_init(&with->group, terms, terms > kept ? terms - kept : 0, &with->store);
    remainder_init(&with->all, length, terms, &with->store);
    if (store->failed || with->store.failed)
        return br_no_memory(err, "a projection");
    fill_coarse(r, &with->series);
    if (r->fine)
        fill_fine(r, &with->local);
    return fill_rest(r, with, err);
}

enum br_status br_restriction_create(struct br_restriction **out,
                                     const struct br_restriction_shape *shape,
                                     struct br_store *store, struct br_error *err)
{
    struct br_restriction *r = *out = br_store_take(store, 1, sizeof *r);
    if (!r)
        return br_no_memory(err, "a projection");
    r->shape = *shape;
    r->group = choose_group(shape);
    r->groups = (shape->elements + r->group - 1) / r->group;
    struct making with = {0};
    const enum br_status status = fill(r, &with, store, err);
    br_store_clear(&with.store);
    return status;
}

/* ---- the application ---- */

/* How many of `count` squares count in their sum; all of them if one is not a number. */
static size_t significant(size_t count, const double *square)
{
    double sum = 0, tail = 0;
    for (size_t i = 0; i < count; i++)
        sum += square[i];
    while (count > 1 && tail + square[count - 1] <= sum_tail * sum_tail * sum)
        tail += square[--count];
    return count;
}

static size_t significant_terms(const struct br_restriction *r)
{
    memset(r->work, 0, r->terms * sizeof *r->work);
    for (size_t g = 0; g < r->groups; g++)
        for (size_t l = 0; l < r->terms; l++)
            r->work[l] += r->local[g * r->terms + l] * r->local[g * r->terms + l];
    return significant(r->terms, r->work);
}

void br_restriction_apply(struct br_restriction *r, const double *series, double *c, double *rest)
{
    const size_t length = r->shape.length, kept = r->shape.degree + 1;
    for (size_t k = 0; k < length; k++)
        r->work[k] = series[k] * series[k];
    br_combine(1, significant(length, r->work), series, r->groups * r->terms, r->coarse,
               r->fine ? r->local : c);
    if (r->fine) {
        const size_t terms = significant_terms(r);
        for (size_t g = 0; g < r->groups; g++)
            br_combine(1, terms, r->local + g * r->terms, r->group * kept, r->fine,
                       c + first_element(r, g) * kept);
    }
    br_combine(1, length, series, length, r->rest, r->work);
    *rest = 0;
    for (size_t k = 0; k < length; k++)
        *rest += r->work[k] * r->work[k];
}

/* ---- all pieces ----
 *
 * Most elements of the mesh lie inside of one piece: those are a restriction each piece. The others
 * straddle: in each overlap of such an element with a piece, the piece's series and the element's
 * polynomials are written in the polynomials of the overlap. */

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

/* In units of L. */
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
static void rewrite(struct subinterval *s, const long double part[2], const long double all[2],
                    size_t count, double *out)
{
    const long double width = (part[1] - part[0]) / (all[1] - all[0]);
    move(s, (part[0] - all[0]) / (all[1] - all[0]), width);
    for (size_t k = 0; k < count; k++)
        for (size_t l = 0; l <= k; l++)
            out[k * s->count + l] = (double)(sqrtl(width) * s->r[k * s->count + l]);
}

/* The overlap of element j and piece e, from part[0] to part[1]. */
static enum br_status add_overlap(struct br_piecewise *w, size_t j, size_t e,
                                  const long double part[2], struct br_error *err)
{
    const size_t kept = w->mesh.degree + 1, all = piece_terms(w, e);
    const size_t terms = all > kept ? all : kept;
    const long double piece[2] = {piece_end(w, e), piece_end(w, e + 1)};
    const long double element[2] = {node(w, j), node(w, j + 1)};
    struct br_store store = {0};
    struct subinterval s;
    subinterval_init(&s, terms, &store);
    struct overlap o = {.element = j, .piece = e, .terms = terms};
    o.series = br_store_take(w->store, terms * terms, sizeof *o.series);
    o.kept = br_store_take(w->store, kept * terms, sizeof *o.kept);
    struct overlap *all_of = br_store_grow(w->store, w->overlap, w->overlaps, &w->room, sizeof o);
    const bool failed = store.failed || w->store->failed;
    if (!failed) {
        w->overlap = all_of;
        rewrite(&s, part, piece, terms, o.series);
        rewrite(&s, part, element, kept, o.kept);
        w->overlap[w->overlaps++] = o;
    }
    br_store_clear(&store);
    return failed ? br_no_memory(err, "a projection") : BR_OK;
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

static enum br_status fill_pieces(struct br_piecewise *w, struct br_error *err)
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
    size_t most = mesh->degree + 1;
    for (size_t e = 0; e < pieces->count; e++)
        most = piece_terms(w, e) > most ? piece_terms(w, e) : most;
    w->inside = br_store_take(store, pieces->count, sizeof *w->inside);
    w->local = br_store_take(store, most, sizeof *w->local);
    return store->failed ? br_no_memory(err, "a projection") : fill_pieces(w, err);
}

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
