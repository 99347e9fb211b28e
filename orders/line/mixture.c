/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "orders/line/mixture.h"

#include <math.h>
#include <stdlib.h>

void br_windows_join(struct br_windows *box, const struct br_windows *other)
{
    if (other->best > box->best) {
        box->best = other->best;
        box->misfit = other->misfit;
    }
    box->first = other->first < box->first ? other->first : box->first;
    box->first_most = other->first_most > box->first_most ? other->first_most : box->first_most;
    box->last = other->last < box->last ? other->last : box->last;
    box->last_most = other->last_most > box->last_most ? other->last_most : box->last_most;
    box->outlier = box->outlier || other->outlier;
}

void br_mixture_add(struct br_mixture *all, const struct br_law_part *p)
{
    if (!(p->weight > all->best - all->keeps))
        return;
    if (all->only_best)
        br_windows_join(&all->found,
                        &(struct br_windows){p->weight, p->misfit, p->first, p->first, p->last,
                                             p->last, p->outlier < all->rows});
    all->best = fmax(all->best, p->weight);
    if (all->only_best)
        return;
    if (all->count == all->room) {
        const size_t room = 2 * all->room + 1024;
        struct br_law_part *more = realloc(all->part, room * sizeof *more);
        if (!more) {
            all->starved = true;
            return;
        }
        all->part = more;
        all->room = room;
    }
    all->part[all->count++] = *p;
}

static int by_weight(const void *a, const void *b)
{
    const struct br_law_part *x = a, *y = b;
    return (x->weight < y->weight) - (x->weight > y->weight);
}

static int by_mean(const void *a, const void *b)
{
    const struct br_law_part *x = a, *y = b;
    return (x->mean > y->mean) - (x->mean < y->mean);
}

void br_mixture_thin(struct br_mixture *all)
{
    static const double share = 5e-4;
    size_t large = 0, count;
    while (large < all->count && all->part[large].weight >= share)
        large++;
    qsort(all->part + large, all->count - large, sizeof *all->part, by_mean);
    double sum = 0.5 * share;
    count = large;
    for (size_t i = large; i < all->count; i++) {
        sum += all->part[i].weight;
        if (sum >= share) {
            sum -= share;
            all->part[count] = all->part[i];
            all->part[count++].weight = share;
        }
    }
    all->count = count;
}

void br_mixture_normalise(struct br_mixture *all)
{
    double sum = 0, used = 0;
    qsort(all->part, all->count, sizeof *all->part, by_weight);
    for (size_t i = 0; i < all->count; i++)
        sum += all->part[i].weight = exp(all->part[i].weight - all->best);
    size_t count = 0;
    while (count < all->count && used < 0.998 * sum)
        used += all->part[count++].weight;
    all->count = count;
    for (size_t i = 0; i < count; i++)
        all->part[i].weight /= used;
}

double br_mixture_below(const struct br_mixture *all, double order)
{
    double sum = 0;
    for (size_t i = 0; i < all->count; i++) {
        const struct br_law_part *p = &all->part[i];
        sum += p->weight * br_student_below((order - p->mean) / p->scale, p->freedom);
    }
    return sum;
}

/* Where the shares of the mixture that are asked for end. */
struct quantile {
    double share, low, high, below, above; /* below, above: what is below low, and below high */
};

/* Each probability that is computed narrows the search for all. By false position, each third step
 * a bisection. */
static void find_quantiles(const struct br_mixture *all, struct quantile *q, size_t count)
{
    static const double enough = 5e-5;
    double low = INFINITY, high = -INFINITY, least = INFINITY;
    for (size_t i = 0; i < all->count; i++) {
        const struct br_law_part *p = &all->part[i];
        const double width = p->scale * (p->freedom < 2 ? 640 : 35); /* 0.1 % are outside */
        low = fmin(low, p->mean - width);
        high = fmax(high, p->mean + width);
        least = fmin(least, p->scale);
    }
    for (size_t i = 0; i < count; i++)
        q[i] = (struct quantile){q[i].share, low, high, 0, 1};
    for (size_t i = 0; i < count; i++)
        for (int step = 0; step < 80 && q[i].high - q[i].low > 1e-3 * least; step++) {
            const double part = (q[i].share - q[i].below) / (q[i].above - q[i].below);
            const double at = q[i].low + (step % 3 == 2 ? 0.5 : part) * (q[i].high - q[i].low);
            const double below = br_mixture_below(all, at);
            for (size_t j = i; j < count; j++)
                if (below < q[j].share && at > q[j].low)
                    q[j].low = at, q[j].below = below;
                else if (below >= q[j].share && at < q[j].high)
                    q[j].high = at, q[j].above = below;
            if (fabs(below - q[i].share) < enough)
                q[i].low = q[i].high = at;
        }
    for (size_t i = 0; i < count; i++)
        q[i].low = 0.5 * (q[i].low + q[i].high);
}

struct br_estimate br_mixture_estimate(const struct br_mixture *all, double *low99, double *high99)
{
    struct quantile q[] = {
        {.share = 0.5}, {.share = 0.025}, {.share = 0.975}, {.share = 0.005}, {.share = 0.995}};
    find_quantiles(all, q, low99 ? 5 : 3);
    if (low99) {
        *low99 = q[3].low;
        *high99 = q[4].low;
    }
    return (struct br_estimate){q[0].low, q[1].low, q[2].low};
}
