/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each law bends the line log e = log C + p log z by a correction that one parameter sets. For each
 * parameter of a table, and each window of rows, log C and p follow by linear regression. With a
 * flat prior of log C and p, and 1/sigma of the scatter, the order then has Student's
 * distribution, and the rows have the evidence
 *     prior Gamma(f/2) (pi S)^(-f/2) (sum w)^(-1/2) Sxx^(-1/2),   f = rows - 2,
 * with S the sum of squares that is left. A law with a curve, a second term of either sign, has one
 * more column in the regression, f = rows - 3, and its share of (sum w) Sxx (Hoeting et al. 1999;
 * Bernardo and Smith, Bayesian Theory, 1994, 5.2). The variance of rounded numbers is known: it is
 * added to S, and to the width of the order. A row outside the window has the density of a number
 * that nothing explains. The order is the mixture of all these distributions. */
#include "orders/line/line_order.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* The middle of a cell of parameters (below) describes the whole cell to about this. */
static const double cell_scatter = 8e-3;

/* ---- rows ---- */

struct rows {
    size_t count;
    size_t *index;         /* in the points */
    double *z, *x, *y;     /* x, y: of the regression, slope p */
    double *ratio;         /* z_against / z */
    double *given;         /* the weight that is given, relative; 1: none is */
    double *log_given;     /* half its logarithm */
    double *rounded;       /* the variance of y by its printed digits; 0: it is not rounded */
    double order;          /* of the regression over all rows */
    double *bent, *weight; /* of a law: y - correction; relative to 1/sigma^2 */
    double *curve;         /* of a law: z^curve, 1 at the coarsest row; 0: it has none */
    double *log_density;   /* the part of the density of y that the weight does not cancel */
    double *change;        /* of a law: how large the correction is, 0 to 1 */
    double *noise;         /* log of the density of all rows behind this one, if they are noise */
    double *error;         /* log e */
    double *log_gamma;     /* by degrees of freedom, of half of them */
    double *other;         /* x of the exponential law */
    double *behind_x, *behind_y; /* means of x, and of y by a law, of all rows behind this one */
    struct br_law_place *place;  /* of a law */
};

/* log of 1 - ratio^p over p, and its derivative: the loss by a reference of finite resolution. */
static double loss(double ratio, double p, double *slope)
{
    const double decay = ratio > 0 ? p * log(ratio) : 0;
    *slope = 0;
    if (ratio == 0)
        return 0;
    *slope = fabs(decay) < 1e-4 ? log(ratio) / 2 : log(ratio) / expm1(-decay) * -1 - 1 / p;
    return fabs(decay) < 1e-8 ? log(-log(ratio))
                              : fmax(decay, 0) + log(-expm1(-fabs(decay)) / fabs(p));
}

/* The regression over all rows; where errors are differences the loss depends on its slope. */
static double regress_all(const struct rows *r, double p)
{
    double x = 0, y = 0, xx = 0, xy = 0, slope;
    const double n = (double)r->count;
    for (size_t i = 0; i < r->count; i++) {
        const double log_z = r->x[i], log_e = r->y[i] - loss(r->ratio[i], p, &slope);
        x += log_z, y += log_e, xx += log_z * log_z, xy += log_z * log_e;
    }
    return (xy - x * y / n) / (xx - x * x / n);
}

static bool usable(const struct br_order_point *p)
{
    return p->error > 0 && isfinite(p->error);
}

/* The standard deviation of an error over the error. */
static double scatter(const struct br_order_point *p)
{
    return p->deviation / p->error;
}

static void take_rows(struct rows *r, const struct br_order_point *point, size_t count)
{
    double finest = NAN, slope, least = INFINITY;
    for (size_t i = 0; i < count; i++)
        if (usable(&point[i])) {
            finest = point[i].z;
            least = scatter(&point[i]) > 0 && isfinite(scatter(&point[i]))
                        ? fmin(least, scatter(&point[i]))
                        : 0;
        }
    const bool weighted = least > 0 && isfinite(least);
    for (size_t i = 0; i < count; i++) {
        const struct br_order_point *p = &point[i];
        if (!usable(p))
            continue;
        r->index[r->count] = i;
        r->z[r->count] = p->z / finest;
        r->x[r->count] = log(p->z / finest);
        r->ratio[r->count] = p->z_against / p->z;
        r->given[r->count] = weighted ? pow(least / scatter(p), 2) : 1;
        r->rounded[r->count] = pow(p->rounding / p->error, 2) / 3;
        r->error[r->count] = log(p->error);
        r->y[r->count++] = log(p->error);
    }
    if (r->count < 2)
        return;
    r->order = 1;
    for (int turn = 0; turn < 30; turn++)
        r->order = regress_all(r, r->order);
    for (size_t i = 0; i < r->count; i++) { /* the loss is linear about that order */
        r->y[i] -= loss(r->ratio[i], r->order, &slope) - slope * r->order;
        r->x[i] += slope;
    }
}

/* ---- the mixture ---- */

/* Student's distribution of the order, from one parameter of one law in one window. */
struct part {
    double weight; /* its logarithm, until all are known */
    double mean, scale, freedom, floor, curve;
    double there, curve_there;    /* of values: the corrections at the finest one */
    double left, left_scale, own; /* logarithm of the error that is left there; its scatter, too */
    double power;                 /* g of the exponential law */
    double misfit;                /* the standard deviation of logarithms */
    enum br_law law;
    size_t first, last, outlier;
};

/* The windows from row first to first_most, and to row last to last_most, that matter, with the
 * logarithm of the largest weight in them, and the misfit of that one; outlier: whether a row
 * inside may not count. */
struct box {
    double best, misfit;
    size_t first, first_most, last, last_most;
    bool outlier;
};

struct mixture {
    struct part *part; /* owned */
    struct box within; /* the windows to try */
    struct box found;  /* out, if only_best: those that matter */
    size_t rows;
    size_t count, room;
    double best;   /* the largest logarithm of a weight */
    double misfit; /* of the part that has it */
    double far;    /* of values: x of the finest one; NaN: they are errors */
    double finest; /* weight of the finest row by its scatter; 1: it is relative, as of all rows */
    double prior;  /* logarithm of that of the scatter */
    double within_cell; /* what a parameter that stands for others leaves of them, in logarithms */
    const double *log_gamma; /* by degrees of freedom, of half of them */
    bool few;                /* of two differences: their order is its prior alone */
    double keeps;            /* logarithm of weights below the best that are kept */
    bool only_best, starved;
};

/* Parts of less weight than e^-8.5 of the best are not kept. */
static const double kept = 8.5;

static void widen(struct box *box, const struct part *p, size_t rows)
{
    if (p->weight > box->best) {
        box->best = p->weight;
        box->misfit = p->misfit;
    }
    box->first = p->first < box->first ? p->first : box->first;
    box->first_most = p->first > box->first_most ? p->first : box->first_most;
    box->last = p->last < box->last ? p->last : box->last;
    box->last_most = p->last > box->last_most ? p->last : box->last_most;
    box->outlier = box->outlier || p->outlier < rows;
}

static void join(struct box *box, const struct box *other)
{
    box->first = other->first < box->first ? other->first : box->first;
    box->first_most = other->first_most > box->first_most ? other->first_most : box->first_most;
    box->last = other->last < box->last ? other->last : box->last;
    box->last_most = other->last_most > box->last_most ? other->last_most : box->last_most;
    box->outlier = box->outlier || other->outlier;
}

static void add_part(struct mixture *all, const struct part *p)
{
    if (!(p->weight > all->best - all->keeps))
        return;
    if (all->only_best)
        widen(&all->found, p, all->rows);
    if (p->weight > all->best) {
        all->best = p->weight;
        all->misfit = p->misfit;
    }
    if (all->only_best)
        return;
    if (all->count == all->room) {
        const size_t room = 2 * all->room + 1024;
        struct part *more = realloc(all->part, room * sizeof *more);
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
    const struct part *x = a, *y = b;
    return (x->weight < y->weight) - (x->weight > y->weight);
}

static int by_mean(const void *a, const void *b)
{
    const struct part *x = a, *y = b;
    return (x->mean > y->mean) - (x->mean < y->mean);
}

/* Of parts with less than a share of the whole, one stands for as many as make that share. */
static void thin(struct mixture *all)
{
    static const double share = 1e-3;
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

/* From logarithms to weights of sum 1; the least, together 0.2 %, are left out. */
static void normalise(struct mixture *all)
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

/* Student's distribution of whole freedom (Abramowitz and Stegun 1964, 26.7.3 and 26.7.4). */
static double student_below(double t, double freedom)
{
    const double square = freedom / (freedom + t * t), sine = t / sqrt(freedom + t * t);
    const bool odd = (int)freedom % 2 == 1;
    double term = odd ? sqrt(square) : 1, sum = 0;
    for (double k = odd ? 3 : 2; k <= freedom; k += 2) {
        sum += term;
        term *= square * (k - 1) / k;
    }
    return 0.5 + (odd ? (atan(t / sqrt(freedom)) + sine * sum) / M_PI : sine * sum / 2);
}

static double probability_below(const struct mixture *all, double order)
{
    double sum = 0;
    for (size_t i = 0; i < all->count; i++) {
        const struct part *p = &all->part[i];
        sum += p->weight * student_below((order - p->mean) / p->scale, p->freedom);
    }
    return sum;
}

/* Where the shares of the mixture that are asked for end. */
struct quantile {
    double share, low, high, below, above; /* below, above: what is below low, and below high */
};

/* Each probability that is computed narrows the search for all. By false position, each third step
 * a bisection. */
static void find_quantiles(const struct mixture *all, struct quantile *q, size_t count)
{
    static const double enough = 1e-5;
    double low = INFINITY, high = -INFINITY, least = INFINITY;
    for (size_t i = 0; i < all->count; i++) {
        const struct part *p = &all->part[i];
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
            const double below = probability_below(all, at);
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

/* ---- windows ---- */

struct sums {
    double w, x, y, xx, xy, yy, log_density; /* y: less start + order x, else digits cancel */
    double q, xq, yq, qq, unit;              /* q: the curve; unit: it at the first row */
    double v, xv, xxv; /* v: the variance by rounding, with the square of the weight */
    double start, order;
    double elsewhere, freedom; /* of a part of the rows with its own line: squares, and freedom */
    bool parted;               /* whether there is such a part */
    bool behind;               /* the curve is of the fine rows */
    double noise_x, noise_y; /* means of the rows that are left out as noise; NaN: there are none */
    size_t rows;
};

/* Adds a row to a window, or (sign < 0) takes it out again. */
static void add_row(struct sums *s, const struct rows *r, size_t i, double sign)
{
    const double w = sign * r->weight[i], x = r->x[i], y = r->bent[i] - s->start - s->order * x;
    const double q = r->curve[i];
    s->w += w, s->x += w * x, s->y += w * y;
    s->xx += w * x * x, s->xy += w * x * y, s->yy += w * y * y;
    if (s->unit > 0)
        s->q += w * q, s->xq += w * x * q, s->yq += w * y * q, s->qq += w * q * q;
    if (r->rounded[i] > 0) {
        const double v = w * r->weight[i] * r->rounded[i];
        s->v += v, s->xv += x * v, s->xxv += x * x * v;
    }
    s->log_density += sign * r->log_density[i];
    s->rows = sign > 0 ? s->rows + 1 : s->rows - 1;
}

/* What a known variance adds to the scale of Student's distribution, so that it widens the 95 %
 * interval as the normal distribution would: the ratio of their quantiles, to 3 %. */
static double of_known(double freedom)
{
    return freedom < 2 ? 0.154 : 1 - 1.1 / freedom;
}

/* Whether the law may have this order. Two powers: the order is of the fine rows or, where these
 * are few, and neither stay nor grow, of the coarse ones. */
static bool is_of_law(const struct mixture *all, const struct part *p, bool behind)
{
    enum { MOST_COARSE = 2, FALLS = 3 }; /* so many rows fall before others that stay: a floor */
    const double other = p->mean + p->curve, stays = br_priors.least_order;
    const bool floors = behind && p->last - p->first >= FALLS;
    const bool grows = p->mean < -stays;
    if (p->mean < stays && p->first >= MOST_COARSE) /* errors fell before, and stay: a floor */
        return false;
    switch (p->law) {
    case BR_LAW_POWER:
        return true;
    case BR_LAW_CANCEL: /* values may grow as log n: differences of the order zero */
    case BR_LAW_LOCKING:
    case BR_LAW_SQUARES:
    case BR_LAW_LOGARITHM:
        return p->mean > stays || isfinite(all->far);
    case BR_LAW_KINK:
        return (p->mean > stays || (grows && !behind)) && other > (floors ? -stays : stays);
    case BR_LAW_NEXT:
    case BR_LAW_LOWER:
        return p->mean > stays || grows || isfinite(all->far);
    default:
        return p->mean > stays;
    }
}

/* Of two differences alone: orders above 4 are rare, and few sequences diverge. */
static double log_prior_of_order(double order)
{
    return order > 0 ? -log1p(pow(order / 4, 6)) : log(0.15);
}

/* Sets what is left at the finest value: the error C z^p of a law of differences C (z^p - r^p z^p).
 * variance: of the logarithms; known: whether rounding has a part in it; xx, slope: as below. */
static void find_left(double far, const struct sums *s, double variance, double xx, double slope,
                      struct part *p)
{
    static const double least = 0.1; /* orders below it do not converge */
    const double order = fmax(p->mean + (s->behind ? p->curve : 0), least), middle = s->x / s->w;
    const bool power = p->law != BR_LAW_EXPONENTIAL;
    const double a = 1 / s->w, b = (far - middle - (power ? 1 / order : 0)) / xx;
    const double known = a * a * s->v + 2 * a * b * (s->xv - middle * s->v) +
                         b * b * (s->xxv - 2 * middle * s->xv + middle * middle * s->v);
    p->left = s->start + s->order * far + s->y / s->w + slope * (far - middle) +
              p->curve * (p->curve_there - s->q / s->w) - (power ? log(order) : 0) + p->there;
    p->left_scale = br_priors.shared * sqrt(variance * (a + b * b * xx) + fmax(0, known));
}

/* Not above the logarithm, and at most 0.06 below it; x is a normal number above 0. */
static double log_below(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return M_LN2 * ((double)bits * 0x1p-52 - 1023);
}

/* The smallest standard deviation of a logarithm, where a correction is so large: more terms
 * follow. */
static double least_scatter(double change)
{
    return br_priors.sure + change * (br_priors.truncation + br_priors.next_term * change);
}

/* Adds the distribution of the order of these sums. of: its law and window, and the logarithm of
 * their prior; least: the smallest standard deviation of a logarithm. */
static void add_window(struct mixture *all, const struct sums *s, const struct part *of,
                       double least)
{
    enum { FEW = 4 }; /* of two differences: as if five had shown their scatter */
    double xx = s->xx - s->x * s->x / s->w, xy = s->xy - s->x * s->y / s->w;
    double yy = s->yy - s->y * s->y / s->w, qq = 1;
    const bool curved = s->unit > 0;
    double xq = 0, yq = 0;
    if (curved) { /* what is left of x and y beside the curve */
        xq = s->xq - s->x * s->q / s->w;
        yq = s->yq - s->y * s->q / s->w;
        qq = s->qq - s->q * s->q / s->w;
        xx -= xq * xq / qq, xy -= xq * yq / qq, yy -= yq * yq / qq;
    }
    const double left = fmax(0, yy - xy * xy / xx) + s->elsewhere;
    const double freedom = (double)s->rows - 2 - curved + s->freedom;
    if (!(freedom >= (all->few ? 0 : 1) && xx > 0 && qq > 0))
        return;
    const double seen =
        fmax(all->within_cell,
             curved && of->law != BR_LAW_KINK ? br_priors.least_curved : br_priors.least_scatter);
    if (s->parted && !(left <= (pow(br_priors.least_curved, 2) + s->v / s->w) * freedom))
        return; /* exact errors alone show two lines */
    const double squares = left + (seen * seen + s->v / s->w) * freedom;
    qq /= curved ? s->unit * s->unit : 1;
    const double spread = s->w * xx * qq;
    const double prior =
        of->weight + all->prior + s->log_density + (all->few ? 0 : all->log_gamma[(size_t)freedom]);
    const double most =
        prior - 0.5 * log_below(spread) - (all->few ? 0 : freedom / 2 * log_below(M_PI * squares));
    if (!(most > all->best - all->keeps)) /* all that follows lowers it */
        return;
    struct part p = *of;
    p.weight = prior - 0.5 * log(spread) - (all->few ? 0 : freedom / 2 * log(M_PI * squares));
    const double middle = s->x / s->w;
    const double rounded = fmax(0, s->xxv - 2 * middle * s->xv + middle * middle * s->v);
    const double scatter = all->few ? 0 : left / freedom;
    p.curve = curved ? (yq - xy / xx * xq) / (qq * s->unit * s->unit) : p.curve;
    if (curved && p.law != BR_LAW_KINK)
        least += (least_scatter(fmin(1, fabs(p.curve) * s->unit)) - br_priors.sure);
    const double variance = scatter + least * least * all->finest;
    p.mean = s->order + xy / xx;
    p.misfit = all->few ? 0 : sqrt(squares / freedom);
    p.freedom = all->few ? FEW : freedom;
    p.scale = hypot(sqrt(variance / xx), of_known(p.freedom) * sqrt(rounded) / xx);
    p.weight += all->few ? log_prior_of_order(p.mean) : -log1p(p.misfit / br_priors.usual_scatter);
    if (isfinite(all->far)) {
        find_left(all->far, s, variance, xx, xy / xx, &p);
        p.own = br_priors.shared * sqrt((scatter + least * least * all->finest) / all->finest);
    }
    if (p.mean < 0 && p.law != BR_LAW_POWER)
        p.weight += log(br_priors.grows);
    const double above = s->noise_y - (s->y / s->w + xy / xx * (s->noise_x - middle));
    if (isfinite(p.weight) && is_of_law(all, &p, s->behind) && !(above < br_priors.noise_above))
        add_part(all, &p);
}

/* The same without one row inside, each in turn. */
static void add_without_one(struct mixture *all, const struct rows *r, const struct sums *s,
                            struct part p, double least)
{
    static const double outside = 0.25; /* one that makes less of the misfit is none */
    enum { LEAST = 5, MOST = 16 };
    const size_t inside = p.last - p.first - 1;
    if (s->rows < LEAST || r->count > MOST || (p.law != BR_LAW_POWER && p.law != BR_LAW_NEXT))
        return;
    const double middle = s->x / s->w, xx = s->xx - middle * s->x, xy = s->xy - middle * s->y,
                 left = s->yy - s->y * s->y / s->w - xy * xy / xx;
    p.weight += log(br_priors.unexplained * br_priors.leaves_inside / (double)inside);
    for (p.outlier = p.first + 1; p.outlier < p.last; p.outlier++) {
        const double x = r->x[p.outlier];
        const double off =
            r->bent[p.outlier] - s->start - s->order * x - s->y / s->w - xy / xx * (x - middle);
        struct sums without = *s;
        if (s->unit == 0 && r->weight[p.outlier] * off * off < outside * left)
            continue;
        add_row(&without, r, p.outlier, -1);
        add_window(all, &without, &p, least);
    }
}

/* The logarithm of the density of so many rows at the coarse end that do not count. */
static double coarse(size_t rows)
{
    return (double)rows * log(br_priors.unexplained * br_priors.leaves_coarse);
}

/* The means of two rows or more behind each one. */
static void find_means(const struct rows *r)
{
    double x = 0, y = 0, rows = 0;
    for (size_t i = r->count; i-- > 0; rows++) {
        r->behind_x[i] = rows > 1 ? x / rows : (double)NAN;
        r->behind_y[i] = rows > 1 ? y / rows : (double)NAN;
        x += r->x[i];
        y += r->bent[i];
    }
}

/* All windows of a law whose correction is set. Of many rows, not every window is tried. */
static void add_windows(struct mixture *all, const struct rows *r, struct part p)
{
    const size_t n = r->count, stride = n > 16 ? n / 12 : 1, least = all->few ? 2 : 3;
    const struct box *within = &all->within;
    const double prior = p.weight;
    const bool bends = p.law != BR_LAW_POWER && p.law != BR_LAW_NEXT;
    if (within->last + 2 < n)
        find_means(r);
    for (p.first = within->first; p.first <= within->first_most; p.first += stride) {
        struct sums s = {.start = r->y[n - 1], .order = r->order, .unit = r->curve[p.first]};
        const double left_out = prior + coarse(p.first);
        double change = 0;
        for (p.last = p.first; p.last <= within->last_most && isfinite(r->bent[p.last]); p.last++) {
            const size_t lost = n - 1 - p.last;
            add_row(&s, r, p.last, 1);
            change = fmax(change, r->change[p.last]);
            if (s.rows < least || p.last < within->last || (lost > 4 && lost % stride))
                continue;
            p.weight = left_out + r->noise[p.last] + (lost > 1 && bends ? log(br_priors.both) : 0);
            p.outlier = n;
            s.noise_x = lost > 1 ? r->behind_x[p.last] : (double)NAN;
            s.noise_y =
                lost > 1 ? r->behind_y[p.last] - s.start - s.order * s.noise_x : (double)NAN;
            add_window(all, &s, &p, least_scatter(change));
            if (within->outlier)
                add_without_one(all, r, &s, p, least_scatter(change));
        }
    }
}

/* One power whose constant drifts: not errors, but what they change by from row to row is scattered
 * independently. The sums are those of the changes; the line goes through the last row. */
static void add_drifts(struct mixture *all, const struct rows *r)
{
    enum { LEAST = 4 };
    const size_t n = r->count, stride = n > 16 ? n / 12 : 1;
    for (size_t i = 0; i < n; i++)
        if (r->log_given[i] < 0 || r->log_given[i] > 0)
            return;
    for (size_t first = 0; first + LEAST <= n; first += stride) {
        double xx = 0, xy = 0, yy = 0, v = 0, xxv = 0;
        for (size_t i = first; i + 1 < n; i++) {
            const double x = r->x[i] - r->x[i + 1], y = r->y[i] - r->y[i + 1] - r->order * x;
            const double rounded = r->rounded[i] + r->rounded[i + 1], end = r->x[i + 1];
            xx += x * x, xy += x * y, yy += y * y, v += rounded, xxv += x * x * rounded;
            const size_t rows = i + 2 - first;
            const double mean = v / (double)(rows - 1);
            const struct sums s = {.w = 1,
                                   .x = end,
                                   .xx = xx + end * end,
                                   .xy = xy,
                                   .yy = yy,
                                   .v = mean,
                                   .xv = end * mean,
                                   .xxv = xxv + end * end * mean,
                                   .rows = rows,
                                   .start = r->y[i + 1] - r->order * end,
                                   .order = r->order,
                                   .noise_x = NAN,
                                   .noise_y = NAN};
            if (rows >= LEAST)
                add_window(all, &s,
                           &(struct part){.law = BR_LAW_POWER,
                                          .first = first,
                                          .last = i + 1,
                                          .outlier = n,
                                          .weight = log(br_priors.power * br_priors.drifts) +
                                                    coarse(first) + r->noise[i + 1]},
                           br_priors.sure);
        }
    }
}

/* ---- noise at the fine end ---- */

/* The density of rows from `from` on as noise about a level z^-growth, with this scatter. */
static double density_of_noise(const struct rows *r, size_t from, double growth, double scatter)
{
    double mean = 0, squares = 0;
    const double n = (double)(r->count - from);
    for (size_t i = from; i < r->count; i++)
        mean += (r->y[i] + growth * r->x[i]) / n;
    for (size_t i = from; i < r->count; i++)
        squares += pow((r->y[i] + growth * r->x[i] - mean) / scatter, 2);
    return exp(-squares / 2) * pow(scatter * sqrt(2 * M_PI), 1 - n) / sqrt(n);
}

/* Rows at the fine end are left out as noise of a known kind alone: a floor stays, round-off
 * scatters about a level, or a growing one. What falls on is no noise. One row may be anything. */
static void take_noise(const struct rows *r)
{
    static const double growth[] = {0, 0.5, 1, 2}, scatter[] = {0.03, 0.1, 0.3, 0.6, 1, 2};
    enum { GROWTHS = sizeof growth / sizeof *growth, SCATTERS = sizeof scatter / sizeof *scatter };
    for (size_t last = 0; last < r->count; last++) {
        double sum = 0;
        for (size_t i = 0; i < GROWTHS * SCATTERS && last + 1 < r->count; i++)
            sum += density_of_noise(r, last + 1, growth[i / SCATTERS], scatter[i % SCATTERS]) /
                   (GROWTHS * SCATTERS);
        r->noise[last] =
            last + 1 == r->count
                ? 0
                : log(br_priors.unexplained * (last + 2 == r->count ? br_priors.leaves_finest * sum
                                                                    : br_priors.leaves_fine * sum));
    }
}

/* ---- laws ---- */

/* The next term of a difference, relative to that of the error itself. */
static double next_of_difference(const struct rows *r, size_t i, double s)
{
    if (r->ratio[i] == 0)
        return 1;
    const double p = r->order, log_ratio = log(r->ratio[i]);
    if (fabs(p * log_ratio) < 1e-8)
        return 1;
    return expm1((p + s) * log_ratio) / expm1(p * log_ratio);
}

/* Sets what all members of a family have in common. */
static void set_family(const struct rows *r, const struct br_family *f)
{
    for (size_t i = 0; i < r->count; i++) {
        const double log_z = log(r->z[i]);
        r->place[i] =
            (struct br_law_place){log_z, exp(f->s * log_z) * next_of_difference(r, i, f->s),
                                  exp(r->y[r->count - 1] - r->y[i])};
        r->curve[i] = f->curve > 0
                          ? pow(r->z[i] / r->z[0], f->curve) * next_of_difference(r, i, f->curve)
                          : 0;
    }
}

/* Sets the correction of row i by a law with this parameter. */
static void bend(const struct rows *r, size_t i, const struct br_family *f, double parameter)
{
    const struct br_law_bend b = br_law_bend(f, parameter, &r->place[i]);
    r->bent[i] = r->y[i] - b.correction;
    r->weight[i] = b.weight * r->given[i];
    r->log_density[i] = b.density ? 0.5 * log(r->weight[i]) : r->log_given[i];
    r->change[i] = b.change;
}

/* Adds a law with one parameter. */
static void add_law(struct mixture *all, const struct rows *r, const struct br_family *f,
                    double parameter, double log_prior)
{
    for (size_t i = 0; i < r->count; i++)
        bend(r, i, f, parameter);
    const double crosses = br_law_log_prior(f, parameter, r->z[0]);
    const struct br_law_place finest = {all->far, exp(f->s * all->far), 1};
    const double there = isfinite(all->far) ? br_law_bend(f, parameter, &finest).correction : 0;
    const bool small = f->law == BR_LAW_CANCEL && crosses == 0;
    const bool has_floor = f->law == BR_LAW_FLOOR || f->law == BR_LAW_FLOOR_SQUARES;
    add_windows(
        all, r,
        (struct part){.there = isfinite(there) ? there : 0,
                      .curve_there = f->curve > 0 ? exp(f->curve * (all->far - log(r->z[0]))) : 0,
                      .law = small ? BR_LAW_NEXT : f->law,
                      .weight = log_prior + crosses,
                      .floor = has_floor ? parameter * exp(r->y[r->count - 1]) : 0});
}

/* The rows of an exact power, with a second correction of those before `middle`, or behind it. */
static void bend_at(const struct rows *r, size_t middle, bool behind)
{
    for (size_t i = 0; i < r->count; i++) {
        const double from = r->x[i] - r->x[middle];
        r->bent[i] = r->y[i];
        r->weight[i] = r->given[i];
        r->log_density[i] = r->log_given[i];
        r->curve[i] = behind ? fmin(0, from) : fmax(0, from);
    }
}

/* Whether the order of two powers may be that of the coarse rows: where these are more, or the fine
 * ones few. */
static bool coarse_may_count(size_t coarse_rows, size_t fine_rows)
{
    enum { FEW = 3 };
    return fine_rows <= FEW || coarse_rows >= fine_rows;
}

/* One power, and from a row on another one. The order is that of the fine rows or of the coarse
 * ones. */
static void add_kink(struct mixture *all, const struct rows *r, size_t middle, bool behind)
{
    enum { SIDE = 2 };
    const size_t n = r->count, stride = n > 16 ? n / 12 : 1;
    const double share = behind ? br_priors.kink_coarse : 1 - br_priors.kink_coarse;
    bend_at(r, middle, behind);
    for (size_t first = 0; first + SIDE <= middle; first += stride) {
        struct sums s = {.start = r->y[n - 1],
                         .order = r->order,
                         .unit = 1,
                         .behind = behind,
                         .noise_x = NAN,
                         .noise_y = NAN};
        if (middle + SIDE >= n || (behind && !coarse_may_count(middle - first, n - 1 - middle)))
            return;
        for (size_t i = first; i < n; i++)
            add_row(&s, r, i, 1);
        add_window(
            all, &s,
            &(struct part){.law = BR_LAW_KINK,
                           .first = first,
                           .last = behind ? middle : n - 1,
                           .outlier = n,
                           .curve_there = behind ? all->far - r->x[middle] : 0,
                           .weight = log(br_priors.kink * share / (double)n) + coarse(first)},
            br_priors.sure);
    }
}

/* The line through rows that one power describes. */
struct side {
    struct sums sums;
    double middle, xx, slope, level; /* level: at the middle */
};

static struct side side_of(const struct rows *r, size_t first, size_t last)
{
    struct side a = {
        .sums = {.start = r->y[r->count - 1], .order = r->order, .noise_x = NAN, .noise_y = NAN}};
    for (size_t i = first; i <= last; i++)
        add_row(&a.sums, r, i, 1);
    const struct sums *s = &a.sums;
    a.middle = s->x / s->w;
    a.level = s->y / s->w;
    a.xx = s->xx - a.middle * s->x;
    a.slope = (s->xy - a.middle * s->y) / a.xx;
    return a;
}

/* Adds the order of one of two lines that meet between their rows, `gap` wide. */
static void add_side(struct mixture *all, const struct side *a, const struct side *b, double gap,
                     struct part p)
{
    const struct sums *other = &b->sums;
    struct sums s = a->sums;
    s.elsewhere = fmax(0, other->yy - b->level * other->y - b->slope * b->slope * b->xx);
    s.freedom = (double)other->rows - 2;
    s.parted = true;
    p.curve = b->slope - a->slope;
    p.outlier = p.last + 1;
    p.weight += other->log_density - 0.5 * log(other->w * b->xx) - log(gap * fabs(p.curve));
    add_window(all, &s, &p, br_priors.sure);
}

/* The same where the two powers meet between this row and the next one, as the largest of errors at
 * two places does. */
static void add_break(struct mixture *all, const struct rows *r, size_t middle)
{
    enum { SIDE = 2 };
    static const double falls = 0.4; /* a smaller order is a plateau that scatters */
    static const double differs = 0.1, inside = 1e-3; /* of the gap: others meet at a row */
    const size_t n = r->count, stride = n > 16 ? n / 12 : 1;
    bend_at(r, middle, false);
    for (size_t i = 0; i < n; i++)
        r->curve[i] = 0;
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
        struct part p = {.law = BR_LAW_KINK, .first = first, .last = n - 1};
        p.weight = log(prior * (1 - br_priors.kink_coarse)) + coarse(first);
        add_side(all, f, c, gap, p);
        p.weight = log(prior * br_priors.kink_coarse) + coarse(first);
        p.last = middle;
        if (coarse_may_count(middle + 1 - first, n - 1 - middle))
            add_side(all, c, f, gap, p);
    }
}

/* log e = log C - b n^g with n = 1/z: a line over another x, whose slope is the order at the middle
 * row. */
static void add_exponentials(struct mixture *all, const struct rows *r)
{
    static const double powers[] = {1, 0.5, 1. / 3};
    static const double range =
        2.4; /* of n; within less, a power with a next term looks the same */
    const size_t n = r->count, middle = n / 2, least = isfinite(all->far) ? 5 : 4;
    const bool shows = n >= least && r->z[0] >= range;
    for (size_t k = 0; k < sizeof powers / sizeof *powers && shows; k++) {
        struct rows e = *r;
        e.x = r->other;
        for (size_t i = 0; i < n; i++) {
            e.x[i] = -pow(r->z[middle] / r->z[i], powers[k]) / powers[k];
            e.bent[i] = r->y[i];
            e.weight[i] = r->given[i];
            e.log_density[i] = r->log_given[i];
            e.change[i] = 0;
            e.curve[i] = 0;
        }
        e.order = (e.y[0] - e.y[n - 1]) / (e.x[0] - e.x[n - 1]);
        const double far = all->far;
        all->far = -pow(r->z[middle] / exp(far), powers[k]) / powers[k];
        add_windows(all, &e,
                    (struct part){.law = BR_LAW_EXPONENTIAL,
                                  .weight = log(br_priors.exponential),
                                  .power = powers[k]});
        all->far = far;
    }
}

/* Parameters are first tried in cells, within which a law changes by about the same amount. Cells
 * that may matter are split, as finely as their misfit asks for: where it is much more than what
 * the middle of a part leaves of the part, that is enough. */
enum { MOST_CELLS = 80, LEVELS = 7, SPLIT = 3 };
static const double cell = 0.32, widest = 0.64; /* of the logarithm of the parameter */
static const double matters = 10;               /* logarithm of the weight below the best one's */

struct cell {
    double from, width; /* of the logarithm of the parameter */
    double slope;       /* how much the correction changes with it, from row to row */
    struct box box;     /* the windows that matter in it */
};

/* The search in the laws of all families. rough: of what may matter. */
struct search {
    struct mixture *all, rough;
    const struct rows *r;
    struct cell cell[BR_FAMILIES][MOST_CELLS];
    size_t count[BR_FAMILIES];
    double top[LEVELS]; /* the largest weight of all, by the size of parts */
};

static bool is_floor(const struct br_family *f)
{
    return f->law == BR_LAW_FLOOR || f->law == BR_LAW_FLOOR_SQUARES || f->law == BR_LAW_OFFSET;
}

static double slope_at(const struct rows *r, const struct br_family *f, double parameter)
{
    double least = INFINITY, most = 0;
    for (size_t i = 0; i < r->count; i++) {
        const struct br_law_bend b = br_law_bend(f, parameter, &r->place[i]);
        least = fmin(least, b.slope);
        most = isnan(b.correction) ? 1 : fmax(most, b.slope);
    }
    return fmin(1, most - least);
}

static void make_cells(const struct rows *r, const struct br_family *f, struct cell *c,
                       size_t *count)
{
    const double end = log(f->high);
    *count = 0;
    for (double from = log(f->low); from < end && *count < MOST_CELLS;
         from += c[*count - 1].width) {
        const double slope = slope_at(r, f, exp(from));
        const double width = fmin(fmax(cell, fmin(widest, 0.8 * cell / slope)), end - from);
        c[(*count)++] = (struct cell){.from = from, .width = width, .slope = slope};
    }
}

/* Adds the middle of a cell. */
static void add_member(struct mixture *all, const struct rows *r, const struct br_family *f,
                       const struct cell *c)
{
    const bool stays = is_floor(f);
    const double parameter = exp(c->from + c->width / 2), share = c->width / log(f->high / f->low);
    if (all->few && (stays || parameter < br_priors.few_next)) /* two differences show none */
        return;
    add_law(all, r, f, parameter,
            log(f->prior * share * (stays && isfinite(all->far) ? br_priors.values_stay : 1)));
}

/* Which windows matter in a part of a cell, where its middle leaves so much of it. */
static void try_part(struct search *s, const struct br_family *f, struct cell *c, int level)
{
    static const struct box no_window = {.best = -INFINITY, .first = SIZE_MAX, .last = SIZE_MAX};
    s->rough.found = no_window;
    s->rough.best = s->top[level];
    s->rough.within_cell = cell_scatter / pow(SPLIT, level);
    add_member(&s->rough, s->r, f, c);
    s->top[level] = s->rough.best;
    c->box = s->rough.found;
}

/* Of a few cells of each family all windows are tried, of the others those that may matter. */
static void try_cells(struct search *s)
{
    enum { FEW = 8 };
    static const double may_matter = 20;
    struct box found = {.best = -INFINITY, .first = SIZE_MAX, .last = SIZE_MAX};
    for (size_t f = 0; f < BR_FAMILIES; f++) {
        set_family(s->r, &br_families[f]);
        make_cells(s->r, &br_families[f], s->cell[f], &s->count[f]);
        for (size_t i = 0; i < s->count[f]; i += FEW) {
            s->rough.keeps = may_matter;
            try_part(s, &br_families[f], &s->cell[f][i], 0);
            join(&found, &s->rough.found);
        }
    }
    s->rough.within = found;
    s->rough.keeps = matters + 2;
    for (size_t f = 0; f < BR_FAMILIES; f++) {
        set_family(s->r, &br_families[f]);
        for (size_t i = 0; i < s->count[f]; i++)
            try_part(s, &br_families[f], &s->cell[f][i], 0);
    }
}

/* Adds what matters of a cell, or of a part of it. */
static void descend(struct search *s, const struct br_family *f, const struct cell *c, int level)
{
    static const double enough = 12; /* so many times what the middle of a part leaves of it */
    const double scatter = cell_scatter / pow(SPLIT, level);
    if (!(c->box.best > s->top[level] - matters))
        return;
    if (level + 1 == LEVELS || s->all->few || c->box.misfit > enough * scatter) {
        s->all->within = c->box;
        s->all->within_cell = fmin(scatter, cell_scatter * c->slope * c->width / cell);
        add_member(s->all, s->r, f, c);
        return;
    }
    const double parts = fmax(1, ceil(c->slope * c->width / cell * pow(SPLIT, level + 1)));
    for (double j = 0; j < parts; j++) {
        struct cell part = *c;
        part.width = c->width / parts;
        part.from += j * part.width;
        s->rough.within = c->box;
        try_part(s, f, &part, level + 1);
        descend(s, f, &part, level + 1);
    }
}

static struct box all_windows(const struct mixture *all, const struct rows *r)
{
    return (struct box){
        .first_most = r->count - (all->few ? 2 : 3), .last_most = r->count - 1, .outlier = true};
}

static void add_laws(struct mixture *all, const struct rows *r, double log_prior)
{
    static const struct br_family power = {.law = BR_LAW_POWER};
    struct search s = {.all = all,
                       .r = r,
                       .rough = {.best = -INFINITY,
                                 .only_best = true,
                                 .rows = r->count,
                                 .far = all->far,
                                 .few = all->few,
                                 .finest = all->finest,
                                 .log_gamma = all->log_gamma}};
    all->prior = log_prior;
    all->keeps = kept;
    all->within = s.rough.within = all_windows(all, r);
    all->within_cell = 0;
    set_family(r, &power);
    add_law(all, r, &power, 0, log(br_priors.power * (all->few ? br_priors.few_power : 1)));
    for (int level = 0; level < LEVELS; level++) {
        s.rough.best = -INFINITY;
        s.rough.within_cell = cell_scatter / pow(SPLIT, level);
        add_law(&s.rough, r, &power, 0, log(br_priors.power));
        s.top[level] = s.rough.best;
    }
    try_cells(&s);
    for (size_t i = 0, stride = r->count > 16 ? r->count / 12 : 1; i < r->count; i += stride) {
        add_kink(all, r, i, false);
        add_kink(all, r, i, true);
        if (!isfinite(all->far))
            add_break(all, r, i);
    }
    add_exponentials(all, r);
    add_drifts(all, r);
    for (size_t f = 0; f < BR_FAMILIES; f++) {
        set_family(r, &br_families[f]);
        for (size_t i = 0; i < s.count[f]; i++)
            descend(&s, &br_families[f], &s.cell[f][i], 0);
    }
}

/* ---- the order ---- */

/* The interval of 95 % of all parts, with the median; low99, high99: that of 99 %, or NULL. */
static struct br_estimate estimate(const struct mixture *all, double *low99, double *high99)
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

/* Keeps the parts of this g of the exponential law, 0: of all others; their weights are then 1. */
static void keep(struct mixture *all, double g)
{
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < all->count; i++)
        if (all->part[i].power == g) {
            sum += all->part[i].weight;
            all->part[count++] = all->part[i];
        }
    all->count = count;
    for (size_t i = 0; i < count; i++)
        all->part[i].weight /= sum;
}

/* b of exp(-b n^g), g of the most probable part. */
static void find_rate(struct mixture *all, const struct rows *r, double finest,
                      struct br_line_order *found)
{
    const double g = found->power = all->part[0].power;
    const double unit = g * pow(r->z[r->count / 2] * finest, -g);
    const struct br_estimate slope = estimate(all, NULL, NULL);
    found->rate = (struct br_estimate){slope.value / unit, slope.low / unit, slope.high / unit};
}

/* The distribution of what is left at the finest value, in the unit of the values: of a part with a
 * wide logarithm several nodes of equal probability. Parts that do not converge have none. */
static enum br_status take_left(const struct mixture *all, const struct rows *r,
                                struct mixture *left, struct br_error *err)
{
    enum { NODES = 8 };
    static const double node[NODES] = {-1.9, -1.0, -0.53, -0.17, 0.17, 0.53, 1.0, 1.9};
    static const double wide = 0.1, most = 7, between = 0.4;
    const size_t n = r->count;
    *left = (struct mixture){.part = br_allocate(NODES * all->count + 1, sizeof *left->part)};
    if (!left->part)
        return br_no_memory(err, "the limit");
    for (size_t i = 0; i < all->count; i++) {
        const struct part *p = &all->part[i];
        const double ratio = exp(all->far * p->mean); /* of the error to that before it */
        const size_t nodes = p->left_scale < wide ? 1 : NODES;
        double lost = 0;
        if (p->power == 0 && !(p->mean > 0.1))
            continue;
        for (size_t j = p->last + 1; j < n; j++)
            lost = fmax(lost, exp(r->error[j]));
        for (size_t j = 0; j < nodes; j++) {
            const double by = nodes > 1 ? fmin(most, node[j] * p->left_scale) : 0;
            const double e = exp(p->left + by);
            const double own = p->own * e * (1 - ratio) / ratio;
            struct part *q = &left->part[left->count++];
            *q = *p;
            q->mean = e;
            q->scale = hypot(hypot(e * p->left_scale * (nodes > 1 ? between : 1), own), lost);
            q->weight = p->weight / (double)nodes;
        }
    }
    keep(left, all->count ? all->part[0].power : 0);
    return BR_OK;
}

/* Values whose differences fall by a smaller order may grow as log log n. */
static const double least_convergence = 0.3, surely_falls = 0.1;

static void describe(struct mixture *all, const struct rows *r, double finest,
                     struct br_line_order *found)
{
    for (size_t i = 0; i < all->count; i++)
        found->law[all->part[i].law] += all->part[i].weight;
    thin(all);
    const bool exponential = found->law[BR_LAW_EXPONENTIAL] > 0.5;
    size_t first = 0;
    while (exponential && all->part[first].power == 0)
        first++;
    keep(all, exponential ? all->part[first].power : 0);
    const struct part *likely = &all->part[0];
    if (exponential)
        find_rate(all, r, finest, found);
    else if (!all->few)
        found->order = estimate(all, &found->low99, &found->high99);
    found->converges = exponential ? 1 : 1 - probability_below(all, all->few ? 0.2 : surely_falls);
    found->diverges = exponential ? 0 : probability_below(all, 0);
    for (size_t i = 0; i < all->count; i++) { /* differences that stay make a logarithm */
        const enum br_law law = all->part[i].law;
        if (isfinite(all->far) && (law == BR_LAW_FLOOR || law == BR_LAW_FLOOR_SQUARES))
            found->converges -= all->part[i].weight;
    }
    if (found->order.value < least_convergence) {
        found->converges = 0;
        if (isfinite(all->far)) {
            found->order.low = fmin(found->order.low, 0);
            found->low99 = fmin(found->low99, 0);
        }
    }
    found->first = r->index[likely->first];
    found->last = r->index[likely->last];
    if (likely->outlier < r->count)
        found->outlier = r->index[likely->outlier];
    found->floor = likely->floor;
}

enum br_status br_line_order_find(const struct br_order_point *point, size_t count,
                                  struct br_line_order *found, struct br_error *err)
{
    enum { ARRAYS = 18 };
    *found = (struct br_line_order){.order = {NAN, NAN, NAN},
                                    .rate = {NAN, NAN, NAN},
                                    .power = NAN,
                                    .left = {NAN, NAN, NAN},
                                    .low99 = NAN,
                                    .high99 = NAN,
                                    .last = count ? count - 1 : 0,
                                    .outlier = count};
    double *room = br_allocate(ARRAYS * count + 1, sizeof *room);
    size_t *index = br_allocate(count + 1, sizeof *index);
    struct br_law_place *place = br_allocate(count + 1, sizeof *place);
    struct mixture all = {.best = -INFINITY};
    enum br_status status = room && index && place ? BR_OK : br_no_memory(err, "the order");
    if (!status) {
        struct rows r = {.index = index, .z = room, .place = place};
        double **const array[] = {&r.x,           &r.y,        &r.ratio,    &r.bent,     &r.weight,
                                  &r.log_density, &r.change,   &r.given,    &r.curve,    &r.rounded,
                                  &r.noise,       &r.other,    &r.behind_x, &r.behind_y, &r.error,
                                  &r.log_gamma,   &r.log_given};
        for (size_t i = 0; i + 1 < ARRAYS; i++)
            *array[i] = room + (i + 1) * count;
        take_rows(&r, point, count);
        const struct br_order_point *finest = r.count ? &point[index[r.count - 1]] : NULL;
        all.far =
            finest && finest->z_against > 0 ? log(finest->z_against / finest->z) : (double)NAN;
        all.few = r.count == 2 && isfinite(all.far);
        if ((r.count >= 3 || all.few) && isfinite(r.order)) {
            take_noise(&r);
            for (size_t i = 1; i < r.count; i++)
                r.log_gamma[i] = lgamma_r((double)i / 2, &(int){0}); /* lgamma writes a global */
            all.log_gamma = r.log_gamma;
            const double absolute = isfinite(all.far) && !all.few ? br_priors.absolute : 0;
            all.finest = 1;
            for (size_t i = 0; i < r.count; i++)
                r.log_given[i] = 0.5 * log(r.given[i]);
            add_laws(&all, &r, log(1 - absolute));
            for (size_t i = 0; i < r.count; i++)
                r.given[i] *= exp(2 * (r.error[i] - r.error[0]));
            for (size_t i = 0; i < r.count; i++)
                r.log_given[i] = 0.5 * log(r.given[i]);
            all.finest = r.given[r.count - 1];
            if (absolute > 0)
                add_laws(&all, &r, log(absolute));
        }
        if (all.count)
            normalise(&all);
        if (all.starved)
            status = br_no_memory(err, "the order");
        else if (all.count)
            describe(&all, &r, finest->z, found);
        struct mixture left = {.part = NULL};
        if (!status && all.count && isfinite(all.far))
            status = take_left(&all, &r, &left, err);
        if (!status && left.count)
            found->left = estimate(&left, NULL, NULL);
        free(left.part);
    }
    free(all.part);
    free(place);
    free(index);
    free(room);
    return status;
}

struct br_estimate br_exponential_factor(const struct br_line_order *found)
{
    const struct br_estimate *b = &found->rate;
    return found->power == 1 ? (struct br_estimate){exp(b->value), exp(b->low), exp(b->high)}
                             : (struct br_estimate){NAN, NAN, NAN};
}

/* ---- which rows count ---- */

/* A level below this share of the coarsest error that counts is taken for round-off. */
static const double deep = 1e-6;

enum br_flag br_line_order_flag(const struct br_line_order *found,
                                const struct br_order_point *point, size_t i)
{
    const bool floors = found->law[BR_LAW_FLOOR] + found->law[BR_LAW_FLOOR_SQUARES] > 0.5;
    const struct br_order_point *last = &point[found->last];
    if (i < found->first)
        return BR_FLAG_COARSE;
    if (i == found->outlier)
        return BR_FLAG_OUTLIER;
    if (i <= found->last && !(floors && point[i].error < 2 * found->floor))
        return BR_FLAG_NONE;
    if (i > found->last &&
        point[i].error < 1.05 * last->error * pow(point[i].z / last->z, found->order.value))
        return BR_FLAG_OUTLIER;
    return point[i].error <= deep * point[found->first].error ? BR_FLAG_ROUND_OFF : BR_FLAG_STALLED;
}

double br_order_rate(const struct br_order_point *coarse, const struct br_order_point *fine)
{
    static const double steepest = 60;
    const double falls = log(coarse->error / fine->error), ratio = log(coarse->z / fine->z);
    double low = -steepest, high = steepest, slope;
    if (!usable(coarse) || !usable(fine))
        return NAN;
    if (coarse->z_against == 0 && fine->z_against == 0)
        return falls / ratio;
    while (high - low > 1e-14 * steepest) {
        const double p = (low + high) / 2;
        const double lost = loss(coarse->z_against / coarse->z, p, &slope) -
                            loss(fine->z_against / fine->z, p, &slope);
        *(p * ratio + lost < falls ? &low : &high) = p;
    }
    return low > -steepest && high < steepest ? (low + high) / 2 : NAN;
}

/* ---- the line of an order ---- */

/* The logarithm of a point's share of an error of order p. Its constant factor is not that of the
 * error itself, and |z^p - z_against^p| also has a share of an order of zero or less. */
static double log_share(const struct br_order_point *point, double p)
{
    double slope;
    return p * log(point->z) + loss(point->z_against / point->z, p, &slope);
}

static double line_at(const struct br_order_point *point, size_t count, size_t i, double p)
{
    double sum = 0, counts = 0;
    for (size_t j = 0; j < count; j++)
        if (usable(&point[j])) {
            sum += log(point[j].error) - log_share(&point[j], p);
            counts++;
        }
    return exp(log_share(&point[i], p) + sum / counts);
}

struct br_estimate br_line_fit(const struct br_order_point *point, size_t count, size_t i,
                               const struct br_estimate *order)
{
    const double fit = line_at(point, count, i, order->value),
                 a = line_at(point, count, i, order->low),
                 b = line_at(point, count, i, order->high);
    if (!(isfinite(a) && isfinite(b)))
        return (struct br_estimate){fit, NAN, NAN};
    return (struct br_estimate){fit, fmin(fit, fmin(a, b)), fmax(fit, fmax(a, b))};
}
