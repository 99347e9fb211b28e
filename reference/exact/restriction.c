/* SPDX-License-Identifier: GPL-3.0-or-later */
/* In two stages: the series on groups of elements, in as many local polynomials as round-off lets
 * matter, and these on the elements, by one table for all groups. Elements that do not fill the
 * last group get it moved back over those before. */
#include "reference/exact/restriction.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

#include "reference/exact/combine.h"

void br_subinterval_init(struct br_subinterval *v, size_t count, struct br_store *store)
{
    v->count = count;
    v->coupling = br_store_take(store, count + 1, sizeof *v->coupling);
    v->r = br_store_take(store, count * count, sizeof *v->r);
    for (size_t k = 0; !store->failed && k <= count; k++) {
        const long double x = (long double)k;
        v->coupling[k] = k ? x / (2 * sqrtl(4 * x * x - 1)) : 0;
    }
}

/* The recurrence of p_{k+1} in x = first + width xi, where a product with xi is the same
 * recurrence in l. Small coefficients keep their digits: they only come from each other. */
void br_subinterval_move(struct br_subinterval *v, long double first, long double width)
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

/* Local coefficients are left out of the tables where the root of the sum of their squares is
 * below this part of the series, and out of a sum at this part of what they are added to. */
static const double table_tail = 1e-18, sum_tail = 1e-17;

struct br_restriction {
    struct br_restriction_shape shape;
    br_combine *combine;
    size_t group, groups; /* elements in each, and their number */
    size_t terms;         /* local coefficients of a group that are kept */
    double *coarse;       /* length x (groups x terms): the series on the groups */
    double *fine;         /* terms x (group x (degree + 1)); NULL for groups of one element */
    double *rest;         /* length x length, R' with rest = |R series|^2 */
    double *local;        /* groups x terms, workspace */
    double *left;         /* length, workspace */
    double *square;       /* terms, workspace */
};

/* What the tables are made with. */
struct making {
    struct br_subinterval series, local; /* the series on a group, and a group's on an element */
    struct remainder group, all;         /* what elements leave out of either */
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
static void move_to(const struct br_restriction *r, size_t g, struct br_subinterval *series)
{
    const long double h = r->shape.width / (long double)r->shape.elements;
    br_subinterval_move(series, r->shape.first + h * (long double)first_element(r, g),
                        h * (long double)r->group);
}

/* A group's series, of r->terms, on its element j. */
static void move_inside(const struct br_restriction *r, size_t j, struct br_subinterval *local)
{
    br_subinterval_move(local, (long double)j / (long double)r->group, 1 / (long double)r->group);
}

/* ---- what is left out ---- */

/* |R_0 c|^2 is what the group's elements from `first` on leave out of its series c. */
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
static enum br_status add_group(const struct remainder *group, const struct br_subinterval *series,
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

/* Groups first to last - 1, of which the elements before `skipped` do not count. */
/* Groups first to last - 1, of which the elements before `skipped` do not count. */
static enum br_status add_groups(const struct br_restriction *r, const size_t range[2],
                                 size_t skipped, struct making *with, struct br_error *err)
{
    enum br_status status = reduce_group(r, skipped, with, err);
    for (size_t g = range[0]; g < range[1] && !status; g++) {
        move_to(r, g, &with->series);
        status = add_group(&with->group, &with->series, &with->all, err);
    }
    return status;
}

static enum br_status fill_rest(const struct br_restriction *r, struct making *with,
                                struct br_error *err)
{
    const size_t length = r->shape.length, last = r->groups - 1;
    const size_t skipped = last * r->group - first_element(r, last);
    enum br_status status = add_groups(r, (size_t[]){0, last}, 0, with, err);
    if (!status)
        status = add_groups(r, (size_t[]){last, r->groups}, skipped, with, err);
    for (size_t k = 0; k < length && !status; k++)
        memcpy(&r->rest[k * length], remainder_r(&with->all, 0, k), length * sizeof *r->rest);
    return status;
}

/* ---- the tables ---- */

/* The number of local coefficients that count in any series of norm 1. square: length x length,
 * workspace. */
static size_t count_terms(const struct br_restriction *r, struct br_subinterval *series,
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

static void fill_coarse(struct br_restriction *r, struct br_subinterval *series)
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

static void fill_fine(struct br_restriction *r, struct br_subinterval *local)
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

static enum br_status allocate(struct br_restriction *r, size_t terms, struct making *with,
                               struct br_store *store, struct br_error *err)
{
    const size_t length = r->shape.length, kept = r->shape.degree + 1;
    r->terms = r->group == 1 ? kept : terms;
    r->coarse = br_store_take(store, length * r->groups * r->terms, sizeof *r->coarse);
    r->local = br_store_take(store, r->groups * r->terms, sizeof *r->local);
    r->left = br_store_take(store, length, sizeof *r->left);
    r->square = br_store_take(store, r->terms, sizeof *r->square);
    if (r->group > 1)
        r->fine = br_store_take(store, r->terms * r->group * kept, sizeof *r->fine);
    br_subinterval_init(&with->local, terms, &with->store);
    remainder_init(&with->group, terms, terms > kept ? terms - kept : 0, &with->store);
    remainder_init(&with->all, length, terms, &with->store);
    return store->failed || with->store.failed ? br_no_memory(err, "a projection") : BR_OK;
}

static enum br_status fill(struct br_restriction *r, struct making *with, struct br_store *store,
                           struct br_error *err)
{
    const size_t length = r->shape.length;
    br_subinterval_init(&with->series, length, &with->store);
    r->rest = br_store_take(store, length * length, sizeof *r->rest);
    if (with->store.failed || !r->rest)
        return br_no_memory(err, "a projection");
    const size_t terms = count_terms(r, &with->series, r->rest);
    const enum br_status status = allocate(r, terms, with, store, err);
    if (status)
        return status;
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
    r->combine = br_combiner_best()->combine;
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

static double sum_of_squares(size_t count, const double *x)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += x[i] * x[i];
    return sum;
}

static size_t significant_series(const struct br_restriction *r, const double *series)
{
    for (size_t k = 0; k < r->shape.length; k++)
        r->left[k] = series[k] * series[k];
    return significant(r->shape.length, r->left);
}

static size_t significant_terms(const struct br_restriction *r)
{
    memset(r->square, 0, r->terms * sizeof *r->square);
    for (size_t g = 0; g < r->groups; g++)
        for (size_t l = 0; l < r->terms; l++)
            r->square[l] += r->local[g * r->terms + l] * r->local[g * r->terms + l];
    return significant(r->terms, r->square);
}

void br_restriction_apply(struct br_restriction *r, const double *series, double *c, double *rest)
{
    const size_t length = r->shape.length, kept = r->shape.degree + 1;
    const size_t count = significant_series(r, series);
    r->combine(1, count, series, r->groups * r->terms, r->coarse, r->fine ? r->local : c);
    if (r->fine) {
        const size_t terms = significant_terms(r);
        for (size_t g = 0; g < r->groups; g++)
            r->combine(1, terms, r->local + g * r->terms, r->group * kept, r->fine,
                       c + first_element(r, g) * kept);
    }
    r->combine(1, length, series, length, r->rest, r->left);
    *rest = sum_of_squares(length, r->left);
}
