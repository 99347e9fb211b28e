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
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "orders/line/mixture.h"

void br_rows_plain(const struct br_rows *r)
{
    memcpy(r->bent, r->y, r->count * sizeof *r->bent);
    memcpy(r->weight, r->given, r->count * sizeof *r->weight);
    memcpy(r->log_density, r->log_given, r->count * sizeof *r->log_density);
    memset(r->change, 0, r->count * sizeof *r->change);
    memset(r->curve, 0, r->count * sizeof *r->curve);
}

void br_window_row(struct br_sums *s, const struct br_rows *r, size_t i, double sign)
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

/* Whether the law may have this order. Two powers: the order is of the fine rows or, where these
 * are few, and neither stay nor grow, of the coarse ones. */
static bool is_of_law(const struct br_mixture *all, const struct br_law_part *p, bool behind)
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
        return p->mean > stays || isfinite(all->far);
    case BR_LAW_LOGARITHM:
        return p->mean > (isfinite(all->far) ? 0 : stays);
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
static void find_left(double far, const struct br_sums *s, double variance, double xx, double slope,
                      struct br_law_part *p)
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
    if (power) { /* rows know the loss as a line about the order of all of them */
        double loses;
        const double ratio = exp(far), as_known = br_row_loss(ratio, s->order, &loses);
        p->left -= br_row_loss(ratio, order, &(double){0}) - as_known - loses * (order - s->order);
    }
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

void br_window_add(struct br_mixture *all, const struct br_sums *s, const struct br_law_part *of,
                   double least)
{
    enum { FEW = 4 };                  /* of two differences: as if five had shown their scatter */
    static const double chance = 2e-2; /* some parameter leads through three rows exactly; so a
                                          power that nearly does is no more probable */
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
    const bool exact = left <= pow(br_priors.least_curved, 2) + s->v / s->w;
    const bool by_chance =
        freedom < 2 && !(of->law == BR_LAW_POWER && exact) && of->law != BR_LAW_KINK;
    const double seen =
        fmax(fmax(all->within_cell, by_chance ? chance : 0),
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
    struct br_law_part p = *of;
    p.weight = prior - 0.5 * log(spread) - (all->few ? 0 : freedom / 2 * log(M_PI * squares));
    const double middle = s->x / s->w;
    const double rounded = fmax(0, s->xxv - 2 * middle * s->xv + middle * middle * s->v);
    const double scatter = all->few ? 0 : left / freedom;
    p.curve = curved ? (yq - xy / xx * xq) / (qq * s->unit * s->unit) : p.curve;
    if (curved && p.law != BR_LAW_KINK && !(fabs(p.curve) * s->unit < br_priors.most_curved))
        return;
    if (curved && p.law != BR_LAW_KINK)
        least += (least_scatter(fmin(1, fabs(p.curve) * s->unit)) - br_priors.sure);
    const double variance = scatter + least * least * all->finest;
    p.mean = s->order + xy / xx;
    p.misfit = all->few ? 0 : sqrt(squares / freedom);
    p.freedom = all->few ? FEW : freedom;
    p.scale = hypot(sqrt(variance / xx), br_scale_of_known(p.freedom) * sqrt(rounded) / xx);
    p.weight += all->few ? log_prior_of_order(p.mean) : -log1p(p.misfit / br_priors.usual_scatter);
    if (isfinite(all->far)) {
        find_left(all->far, s, variance, xx, xy / xx, &p);
        p.own = br_priors.shared * sqrt((scatter + least * least * all->finest) / all->finest);
    }
    if (p.mean < 0 && p.law != BR_LAW_POWER)
        p.weight += log(br_priors.grows);
    const double above = s->noise_y - (s->y / s->w + xy / xx * (s->noise_x - middle));
    if (isfinite(p.weight) && is_of_law(all, &p, s->behind) && !(above < br_priors.noise_above))
        br_mixture_add(all, &p);
}

/* The same without one row inside, each in turn. */
static void add_without_one(struct br_mixture *all, const struct br_rows *r,
                            const struct br_sums *s, struct br_law_part p, double least)
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
        struct br_sums without = *s;
        if (s->unit == 0 && r->weight[p.outlier] * off * off < outside * left)
            continue;
        br_window_row(&without, r, p.outlier, -1);
        br_window_add(all, &without, &p, least);
    }
}

double br_window_coarse(size_t rows)
{
    return (double)rows * log(br_priors.unexplained * br_priors.leaves_coarse);
}

/* The means of two rows or more behind each one. */
static void find_means(const struct br_rows *r)
{
    double x = 0, y = 0, rows = 0;
    for (size_t i = r->count; i-- > 0; rows++) {
        r->behind_x[i] = rows > 1 ? x / rows : (double)NAN;
        r->behind_y[i] = rows > 1 ? y / rows : (double)NAN;
        x += r->x[i];
        y += r->bent[i];
    }
}

void br_window_all(struct br_mixture *all, const struct br_rows *r, struct br_law_part p)
{
    const size_t n = r->count, stride = n > 16 ? n / 12 : 1, least = all->few ? 2 : 3;
    const struct br_windows *within = &all->within;
    const double prior = p.weight;
    const bool bends = p.law != BR_LAW_POWER && p.law != BR_LAW_NEXT && p.law != BR_LAW_EXPONENTIAL;
    if (within->last + 2 < n)
        find_means(r);
    for (p.first = within->first; p.first <= within->first_most; p.first += stride) {
        struct br_sums s = {.start = r->y[n - 1], .order = r->order, .unit = r->curve[p.first]};
        const double left_out = prior + br_window_coarse(p.first);
        double change = 0;
        for (p.last = p.first; p.last <= within->last_most && isfinite(r->bent[p.last]); p.last++) {
            const size_t lost = n - 1 - p.last;
            br_window_row(&s, r, p.last, 1);
            change = fmax(change, r->change[p.last]);
            if (s.rows < least || p.last < within->last || (lost > 4 && lost % stride))
                continue;
            p.weight = left_out + r->noise[p.last] + (lost > 1 && bends ? log(br_priors.both) : 0);
            p.outlier = n;
            s.noise_x = lost > 1 ? r->behind_x[p.last] : (double)NAN;
            s.noise_y =
                lost > 1 ? r->behind_y[p.last] - s.start - s.order * s.noise_x : (double)NAN;
            br_window_add(all, &s, &p, least_scatter(change));
            if (within->outlier)
                add_without_one(all, r, &s, p, least_scatter(change));
        }
    }
}

/* The sums are those of the changes; the line goes through the last row. */
void br_window_drifts(struct br_mixture *all, const struct br_rows *r)
{
    enum { LEAST = 5 };
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
            struct br_sums s = {
                .w = 1, .rows = rows, .order = r->order, .noise_x = NAN, .noise_y = NAN};
            s.start = r->y[i + 1] - r->order * end;
            s.x = end, s.xx = xx + end * end, s.xy = xy, s.yy = yy;
            s.v = mean, s.xv = end * mean, s.xxv = xxv + end * end * mean;
            if (rows >= LEAST)
                br_window_add(
                    all, &s,
                    &(struct br_law_part){.law = BR_LAW_POWER,
                                          .first = first,
                                          .last = i + 1,
                                          .outlier = n,
                                          .weight = log(br_priors.power * br_priors.drifts) +
                                                    br_window_coarse(first) + r->noise[i + 1]},
                    br_priors.sure);
        }
    }
}

/* ---- noise at the fine end ---- */

/* The density of rows from `from` on as noise about a level z^-growth, with this scatter. */
static double density_of_noise(const struct br_rows *r, size_t from, double growth, double scatter)
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
void br_window_take_noise(const struct br_rows *r)
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
