/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/inside.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

#include "base/blas.h"

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
    size_t columns, block; /* rows of a block, at most */
    double *a;   /* (columns + block) x columns, by columns: R, upper triangle, above the block */
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

/* An entry of R, or of the next block below it. */
static double *remainder_at(const struct remainder *m, size_t row, size_t column)
{
    return &m->a[column * (m->columns + m->block) + row];
}

/* Adds a block of some rows to R, and clears it. Fails with BR_NO_MEMORY or BR_SINGULAR. */
static enum br_status remainder_add(const struct remainder *m, size_t block, struct br_error *err)
{
    const size_t rows = m->columns + block;
    if (!block)
        return BR_OK;
    br_blas_enter();
    const lapack_int info =
        LAPACKE_dgeqrf(LAPACK_COL_MAJOR, (lapack_int)rows, (lapack_int)m->columns, m->a,
                       (lapack_int)(m->columns + m->block), m->tau);
    br_blas_leave();
    for (size_t k = 0; k < m->columns; k++) /* the reflectors below the diagonal are not needed */
        memset(remainder_at(m, k + 1, k), 0, (rows - k - 1) * sizeof(double));
    if (info == LAPACK_WORK_MEMORY_ERROR)
        return br_no_memory(err, "a projection's remainder");
    return info ? br_fail(err, BR_SINGULAR, "a projection's remainder failed (%d)", (int)info)
                : BR_OK;
}

/* ---- runs of elements ----
 *
 * Most elements of the mesh lie inside of one spectral element. A run of them takes two stages: the
 * spectral element's series on groups of elements, in as many local polynomials as round-off lets
 * matter, and these on the elements, by one table for all groups. What does not fill a group is
 * another run.
 *
 * The others straddle: each overlap of such an element with a spectral element is a run of its own,
 * in which the spectral element's series and the element's polynomials are written in the overlap's
 * polynomials. */

/* Local coefficients are left out of the tables where the root of the sum of their squares is
 * below this part of the series, and out of a sum at this part of what they are added to. */
static const double table_tail = 1e-18, sum_tail = 1e-17;

/* An element that reaches this far out of a spectral element, in units of L, lies inside:
 * round-off. */
static const long double tolerance = 4e-16L;

struct element_run {
    size_t spectral, element; /* the first */
    size_t group, groups;     /* elements in each, and their number */
    size_t terms;             /* local coefficients of a group that are kept */
    double *coarse; /* series x (groups x terms): the spectral element's series on the groups */
    double *fine;   /* terms x (group x (degree + 1)); NULL for groups of one element */
    double *local;  /* groups x terms, workspace */
    double *kept;   /* of an overlap: (degree + 1) x terms, the element's; else NULL */
};

struct br_piecewise {
    const struct br_spectral_elements *spectral; /* borrowed */
    size_t extra, kept;                          /* degree + 1 */
    size_t elements;
    struct element_run *run;
    size_t runs, room;
    double **rest; /* by spectral elements: series x series, R' with |R series|^2 what the elements
                      inside leave out; NULL: there are none */
    double *work;  /* the longest series */
    struct br_store *store;
};

/* What the tables are made with. */
struct making {
    struct br_piecewise *w;
    struct element_run *run;
    long double first, width;         /* of the run's first element, in the spectral element */
    struct subinterval series, local; /* the series on a group, and a group's on an element */
    struct remainder group, all;      /* what elements leave out of either */
    struct br_store store;
};

/* In units of L. */
static long double spectral_end(const struct br_piecewise *w, size_t e)
{
    return (long double)w->spectral->end[e] / w->spectral->length;
}

static long double node(const struct br_piecewise *w, size_t j)
{
    return (long double)j / (long double)w->elements;
}

static size_t spectral_terms(const struct br_piecewise *w, size_t e)
{
    return w->spectral->terms[e] + w->extra;
}

/* The norm of a function on an element whose coefficients have the norm 1 on the spectral element.
 */
static double scale(const struct making *m)
{
    return sqrt(m->w->spectral->length * (double)m->width);
}

/* The series on group g. */
static void move_to(struct making *m, size_t g)
{
    const struct element_run *r = m->run;
    move(&m->series, m->first + m->width * (long double)(g * r->group),
         m->width * (long double)r->group);
}

/* A group's series on its element j. */
static void move_inside(struct making *m, size_t j)
{
    const long double group = (long double)m->run->group;
    move(&m->local, (long double)j / group, 1 / group);
}

/* ---- the choice of groups ---- */

/* About how many multiplications an application takes for groups of a size. Local coefficients that
 * count: p_k oscillates like cos(k phi), most at the ends, where phi spans 2 sqrt(h). */
static double cost(const struct making *m, size_t elements, size_t group)
{
    const double length = (double)m->series.count, values = (double)(elements * m->w->kept);
    const double h = (double)group * (double)m->width,
                 groups = ceil((double)elements / (double)group);
    const double terms = fmin(length, 8 + 2 * length * sqrt(h));
    return group == 1 ? values * length : groups * terms * length + values * terms;
}

static size_t choose_group(const struct making *m, size_t elements)
{
    size_t best = 1;
    for (size_t group = 2; group <= elements; group *= 2)
        if (cost(m, elements, group) < cost(m, elements, best))
            best = group;
    return best;
}

/* ---- the tables ---- */

/* The number of local coefficients that count in any series of norm 1. */
static size_t count_terms(struct making *m)
{
    const size_t length = m->series.count, groups = m->run->groups;
    const double h = (double)(m->width * (long double)m->run->group);
    double *square = br_store_take(&m->store, length * length, sizeof *square);
    size_t terms = 1;
    for (size_t g = 0; square && g < groups; g++) {
        move_to(m, g);
        for (size_t i = 0; i < length * length; i++)
            square[i] += h * (double)(m->series.r[i] * m->series.r[i]);
    }
    for (size_t k = 0; square && k < length; k++) {
        double tail = 0;
        for (size_t l = length; l-- > terms;)
            if (!((tail += square[k * length + l]) <= table_tail * table_tail))
                terms = l + 1;
    }
    return terms;
}

/* A group's elements: their tables, where there are any, and |R_0 c|^2, what they leave out of its
 * series c. */
static enum br_status fill_group(struct making *m, struct br_error *err)
{
    const struct element_run *r = m->run;
    const size_t terms = m->group.columns, kept = m->w->kept;
    enum br_status status = BR_OK;
    for (size_t j = 0; j < r->group && !status; j++) {
        move_inside(m, j);
        for (size_t k = 0; k < terms; k++)
            for (size_t l = 0; l < terms; l++) {
                const double value = scale(m) * (double)m->local.r[k * terms + l];
                if (l >= kept)
                    *remainder_at(&m->group, terms + l - kept, k) = value;
                else if (r->fine)
                    r->fine[(k * r->group + j) * kept + l] = value;
            }
        status = remainder_add(&m->group, m->group.block, err);
    }
    return status;
}

/* The series on every group: its table, and R_0 times it as what is left out. */
static enum br_status fill_groups(struct making *m, struct br_error *err)
{
    const struct element_run *r = m->run;
    const size_t length = m->series.count, terms = m->group.columns;
    const double factor = r->fine ? 1 : scale(m);
    enum br_status status = fill_group(m, err);
    for (size_t g = 0; g < r->groups && !status; g++) {
        move_to(m, g);
        for (size_t k = 0; k < length; k++) {
            for (size_t l = 0; l < r->terms && l <= k; l++)
                r->coarse[(k * r->groups + g) * r->terms + l] =
                    factor * (double)m->series.r[k * length + l];
            for (size_t i = 0; i < terms; i++) {
                long double sum = 0;
                for (size_t l = i; l < terms && l <= k; l++)
                    sum += *remainder_at(&m->group, i, l) * m->series.r[k * length + l];
                *remainder_at(&m->all, length + i, k) = (double)sum;
            }
        }
        status = remainder_add(&m->all, terms, err);
    }
    return status;
}

static enum br_status keep_run(struct br_piecewise *w, const struct element_run *r,
                               struct br_error *err)
{
    struct element_run *all = br_store_grow(w->store, w->run, w->runs, &w->room, sizeof *all);
    if (w->store->failed)
        return br_no_memory(err, "a projection");
    w->run = all;
    w->run[w->runs++] = *r;
    return BR_OK;
}

/* A run of the groups that `elements` fill, from r->element on. */
static enum br_status add_run(struct making *m, struct element_run *r, size_t elements,
                              struct br_error *err)
{
    struct br_store *store = m->w->store;
    const size_t length = m->series.count, kept = m->w->kept;
    m->run = r;
    r->group = choose_group(m, elements);
    r->groups = elements / r->group;
    const size_t terms = count_terms(m);
    r->terms = r->group == 1 ? kept : terms;
    r->coarse = br_store_take(store, length * r->groups * r->terms, sizeof *r->coarse);
    r->local = br_store_take(store, r->groups * r->terms, sizeof *r->local);
    if (r->group > 1)
        r->fine = br_store_take(store, r->terms * r->group * kept, sizeof *r->fine);
    subinterval_init(&m->local, terms, &m->store);
    remainder_init(&m->group, terms, terms > kept ? terms - kept : 0, &m->store);
    if (store->failed || m->store.failed)
        return br_no_memory(err, "a projection");
    const enum br_status status = fill_groups(m, err);
    return status ? status : keep_run(m->w, r, err);
}

/* ---- all spectral elements ---- */

/* The elements first to last - 1 lie inside of spectral element e. */
static enum br_status fill_inside(struct br_piecewise *w, size_t e, size_t first, size_t last,
                                  struct br_error *err)
{
    const size_t length = spectral_terms(w, e);
    const long double a = spectral_end(w, e), h = spectral_end(w, e + 1) - a;
    struct making m = {.w = w, .first = (node(w, first) - a) / h};
    m.width = (node(w, last) - node(w, first)) / h / (long double)(last - first);
    subinterval_init(&m.series, length, &m.store);
    remainder_init(&m.all, length, length, &m.store);
    w->rest[e] = br_store_take(w->store, length * length, sizeof **w->rest);
    enum br_status status =
        m.store.failed || !w->rest[e] ? br_no_memory(err, "a projection") : BR_OK;
    while (first < last && !status) {
        struct element_run r = {.spectral = e, .element = first};
        status = add_run(&m, &r, last - first, err);
        first += r.group * r.groups;
        m.first += m.width * (long double)(r.group * r.groups);
    }
    for (size_t k = 0; k < length && !status; k++)
        memcpy(&w->rest[e][k * length], remainder_at(&m.all, 0, k), length * sizeof **w->rest);
    br_store_clear(&m.store);
    return status;
}

/* out (count x s->count) = the orthonormal polynomials of `all` in those of `part` of it, times a
 * factor. */
static void rewrite(struct subinterval *s, const long double part[2], const long double all[2],
                    long double factor, size_t count, double *out)
{
    const long double width = (part[1] - part[0]) / (all[1] - all[0]);
    move(s, (part[0] - all[0]) / (all[1] - all[0]), width);
    for (size_t k = 0; k < count; k++)
        for (size_t l = 0; l <= k; l++)
            out[k * s->count + l] = (double)(factor * sqrtl(width) * s->r[k * s->count + l]);
}

/* The overlap of element j and spectral element e, from part[0] to part[1]. */
static enum br_status add_overlap(struct br_piecewise *w, size_t j, size_t e,
                                  const long double part[2], struct br_error *err)
{
    const size_t length = spectral_terms(w, e), terms = length > w->kept ? length : w->kept;
    const long double spectral[2] = {spectral_end(w, e), spectral_end(w, e + 1)};
    const long double element[2] = {node(w, j), node(w, j + 1)};
    struct br_store store = {0};
    struct subinterval s;
    subinterval_init(&s, terms, &store);
    const struct element_run r = {
        .spectral = e,
        .element = j,
        .group = 1,
        .groups = 1,
        .terms = terms,
        .coarse = br_store_take(w->store, terms * terms, sizeof *r.coarse),
        .local = br_store_take(w->store, terms, sizeof *r.local),
        .kept = br_store_take(w->store, w->kept * terms, sizeof *r.kept),
    };
    enum br_status status = BR_NO_MEMORY;
    if (!store.failed && !w->store->failed) {
        rewrite(&s, part, spectral, sqrtl(w->spectral->length), length, r.coarse);
        rewrite(&s, part, element, 1, w->kept, r.kept);
        status = keep_run(w, &r, err);
    }
    br_store_clear(&store);
    return status ? br_no_memory(err, "a projection") : BR_OK;
}

/* Element j, which begins in spectral element e and ends in another. */
static enum br_status straddle(struct br_piecewise *w, size_t j, size_t e, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (; e < w->spectral->count && spectral_end(w, e) < node(w, j + 1) && !status; e++) {
        const long double part[2] = {fmaxl(node(w, j), spectral_end(w, e)),
                                     fminl(node(w, j + 1), spectral_end(w, e + 1))};
        if (part[1] > part[0])
            status = add_overlap(w, j, e, part, err);
    }
    return status;
}

static enum br_status fill_elements(struct br_piecewise *w, struct br_error *err)
{
    const size_t n = w->elements;
    enum br_status status = BR_OK;
    for (size_t j = 0, e = 0; j < n && !status;) {
        while (e + 1 < w->spectral->count && spectral_end(w, e + 1) <= node(w, j) + tolerance)
            e++;
        const long double inside = (spectral_end(w, e + 1) + tolerance) * (long double)n;
        const size_t last = inside < (long double)n ? (size_t)inside : n;
        if (last > j) {
            status = fill_inside(w, e, j, last, err);
            j = last;
        } else
            status = straddle(w, j++, e, err);
    }
    return status;
}

enum br_status br_piecewise_create(struct br_piecewise **out,
                                   const struct br_spectral_elements *spectral, size_t extra,
                                   const struct br_exact_mesh *mesh, struct br_store *store,
                                   struct br_error *err)
{
    struct br_piecewise *w = *out = br_store_take(store, 1, sizeof *w);
    if (!w)
        return br_no_memory(err, "a projection");
    *w = (struct br_piecewise){.spectral = spectral,
                               .extra = extra,
                               .kept = mesh->degree + 1,
                               .elements = mesh->elements,
                               .store = store};
    w->rest = br_store_take(store, spectral->count, sizeof *w->rest);
    w->work =
        br_store_take(store, br_spectral_at(spectral, spectral->count, extra), sizeof *w->work);
    return store->failed ? br_no_memory(err, "a projection") : fill_elements(w, err);
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

/* The same of rows of coefficients, each `count` long, by the sums of their squares. */
static size_t significant_terms(const struct br_piecewise *w, size_t rows, size_t count,
                                const double *x)
{
    memset(w->work, 0, count * sizeof *w->work);
    for (size_t i = 0; i < rows; i++)
        for (size_t l = 0; l < count; l++)
            w->work[l] += x[i * count + l] * x[i * count + l];
    return significant(count, w->work);
}

/* c: out, of the run's first element on; of an overlap, what it adds. */
static void apply_run(const struct br_piecewise *w, const struct element_run *r,
                      const double *series, double *c)
{
    const size_t length = spectral_terms(w, r->spectral), kept = w->kept;
    br_combine(1, significant_terms(w, 1, length, series), series, r->groups * r->terms, r->coarse,
               r->fine || r->kept ? r->local : c);
    const size_t terms = r->fine ? significant_terms(w, r->groups, r->terms, r->local) : 0;
    for (size_t g = 0; g < r->groups && r->fine; g++)
        br_combine(1, terms, r->local + g * r->terms, r->group * kept, r->fine,
                   c + g * r->group * kept);
    for (size_t k = 0; k < kept && r->kept; k++)
        for (size_t l = 0; l <= k; l++)
            c[k] += r->kept[k * r->terms + l] * r->local[l];
}

/* The square of what an element's values c leave out of the overlap. */
static double left_out(const struct br_piecewise *w, const struct element_run *r, const double *c)
{
    double sum = 0;
    for (size_t l = 0; l < r->terms; l++) {
        for (size_t k = l; k < w->kept; k++)
            r->local[l] -= c[k] * r->kept[k * r->terms + l];
        sum += r->local[l] * r->local[l];
    }
    return sum;
}

void br_piecewise_apply(struct br_piecewise *w, const double *series, double *c, double *rest)
{
    const struct element_run *end = w->run + w->runs;
    for (const struct element_run *r = w->run; r < end; r++)
        if (r->kept)
            memset(&c[r->element * w->kept], 0, w->kept * sizeof *c);
    for (const struct element_run *r = w->run; r < end; r++)
        apply_run(w, r, series + br_spectral_at(w->spectral, r->spectral, w->extra),
                  &c[r->element * w->kept]);
    *rest = 0;
    for (const struct element_run *r = w->run; r < end; r++)
        if (r->kept)
            *rest += left_out(w, r, &c[r->element * w->kept]);
    for (size_t e = 0; e < w->spectral->count; e++) {
        const size_t length = w->rest[e] ? spectral_terms(w, e) : 0;
        br_combine(1, length, series + br_spectral_at(w->spectral, e, w->extra), length, w->rest[e],
                   w->work);
        for (size_t k = 0; k < length; k++)
            *rest += w->work[k] * w->work[k];
    }
}
