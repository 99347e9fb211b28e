/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "orders/line/mixture.h"

/* Whether the order of two powers may be that of the coarse rows: where these are more, or the fine
 * ones few. */
static bool coarse_may_count(size_t coarse_rows, size_t fine_rows)
{
    enum { FEW = 3 };
    return fine_rows <= FEW || coarse_rows >= fine_rows;
}

/* One power, and from a row on another one. The order is that of the fine rows or of the coarse
 * ones. */
static void add_kink(struct br_mixture *all, const struct br_rows *r, size_t middle, bool behind)
{
    enum { SIDE = 2 };
    const size_t n = r->count, stride = n > 16 ? n / 12 : 1;
    const double share = behind ? br_priors.kink_coarse : 1 - br_priors.kink_coarse;
    br_rows_plain(r); /* with a correction of those before `middle`, or behind it */
    for (size_t i = 0; i < n; i++)
        r->curve[i] = behind ? fmin(0, r->x[i] - r->x[middle]) : fmax(0, r->x[i] - r->x[middle]);
    for (size_t first = 0; first + SIDE <= middle; first += stride) {
        struct br_sums s = {.start = r->y[n - 1],
                            .order = r->order,
                            .unit = 1,
                            .behind = behind,
                            .noise_x = NAN,
                            .noise_y = NAN};
        if (middle + SIDE >= n || (behind && !coarse_may_count(middle - first, n - 1 - middle)))
            return;
        for (size_t i = first; i < n; i++)
            br_window_row(&s, r, i, 1);
        br_window_add(all, &s,
                      &(struct br_law_part){.law = BR_LAW_KINK,
                                            .first = first,
                                            .last = behind ? middle : n - 1,
                                            .outlier = n,
                                            .curve_there = behind ? all->far - r->x[middle] : 0,
                                            .weight = log(br_priors.kink * share / (double)n) +
                                                      br_window_coarse(first)},
                      br_priors.sure);
    }
}

/* The line through rows that one power describes. */
struct side {
    struct br_sums sums;
    double middle, xx, slope, level; /* level: at the middle */
};

static struct side side_of(const struct br_rows *r, size_t first, size_t last)
{
    struct side a = {
        .sums = {.start = r->y[r->count - 1], .order = r->order, .noise_x = NAN, .noise_y = NAN}};
    for (size_t i = first; i <= last; i++)
        br_window_row(&a.sums, r, i, 1);
    const struct br_sums *s = &a.sums;
    a.middle = s->x / s->w;
    a.level = s->y / s->w;
    a.xx = s->xx - a.middle * s->x;
    a.slope = (s->xy - a.middle * s->y) / a.xx;
    return a;
}

/* Adds the order of one of two lines that meet between their rows, `gap` wide. */
static void add_side(struct br_mixture *all, const struct side *a, const struct side *b, double gap,
                     struct br_law_part p)
{
    const struct br_sums *other = &b->sums;
    struct br_sums s = a->sums;
    s.elsewhere = fmax(0, other->yy - b->level * other->y - b->slope * b->slope * b->xx);
    s.freedom = (double)other->rows - 2;
    s.parted = true;
    p.curve = b->slope - a->slope;
    p.outlier = p.last + 1;
    p.weight += other->log_density - 0.5 * log(other->w * b->xx) - log(gap * fabs(p.curve));
    br_window_add(all, &s, &p, br_priors.sure);
}

/* The same where the two powers meet between this row and the next one, as the largest of errors at
 * two places does. */
static void add_break(struct br_mixture *all, const struct br_rows *r, size_t middle)
{
    enum { SIDE = 2 };
    static const double falls = 0.4; /* a smaller order is a plateau that scatters */
    static const double differs = 0.1, inside = 1e-3; /* of the gap: others meet at a row */
    const size_t n = r->count, stride = n > 16 ? n / 12 : 1;
    br_rows_plain(r);
    for (size_t first = 0; first + SIDE <= middle + 1 && middle + SIDE < n; first += stride) {
        const struct side coarse_side = side_of(r, first, middle),
                          fine_side = side_of(r, middle + 1, n - 1);
        const struct side *c = &coarse_side, *f = &fine_side;
        const double meet = (f->level - f->slope * f->middle - c->level + c->slope * c->middle) /
                            (c->slope - f->slope);
        const double gap = r->x[middle] - r->x[middle + 1], at = (r->x[middle] - meet) / gap;
        if (!(at > inside && at < 1 - inside && f->slope + r->order > falls &&
              fabs(c->slope - f->slope) > differs))
            continue;
        const double prior = br_priors.kink / (double)n;
        struct br_law_part p = {.law = BR_LAW_KINK, .first = first, .last = n - 1};
        p.weight = log(prior * (1 - br_priors.kink_coarse)) + br_window_coarse(first);
        add_side(all, f, c, gap, p);
        p.weight = log(prior * br_priors.kink_coarse) + br_window_coarse(first);
        p.last = middle;
        if (coarse_may_count(middle + 1 - first, n - 1 - middle))
            add_side(all, c, f, gap, p);
    }
}

void br_kinks_add(struct br_mixture *all, const struct br_rows *r)
{
    for (size_t i = 0, stride = r->count > 16 ? r->count / 12 : 1; i < r->count; i += stride) {
        add_kink(all, r, i, false);
        add_kink(all, r, i, true);
        if (!isfinite(all->far))
            add_break(all, r, i);
    }
}
