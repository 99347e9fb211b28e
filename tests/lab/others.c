/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/lab/others.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>

enum {
    BOOTSTRAPS = 200,
    ROBUST_BOOTSTRAPS = 25,
    WEIGHTS = 3,
    NORMS = 2,
    MOST_FITS = BR_MOST_ERRORS * WEIGHTS * NORMS * ROBUST_BOOTSTRAPS,
};

const char *const br_other_names[BR_OTHERS] = {"finest rows", "least squares", "bootstrap",
                                               "robust fits"};

static const struct br_other_interval none = {NAN, NAN};

/* y = limit + slope x^p; of errors, in logarithms: y = limit + slope log x. */
struct fit {
    size_t rows;
    double x[BR_MOST_ERRORS], y[BR_MOST_ERRORS], weight[BR_MOST_ERRORS];
    bool powers; /* of values; else of logarithms */
    double limit, slope, p, squares;
};

/* The basis function of a row. */
static double basis(const struct fit *f, double p, size_t i)
{
    return f->powers ? exp(p * log(f->x[i])) : log(f->x[i]);
}

/* Limit and slope of a given p, by weighted least squares. Returns the sum of squares. */
static double solve(struct fit *f, double p)
{
    double w = 0, a = 0, b = 0, aa = 0, ab = 0, squares = 0;
    for (size_t i = 0; i < f->rows; i++) {
        w += f->weight[i];
        a += f->weight[i] * basis(f, p, i);
        b += f->weight[i] * f->y[i];
    }
    for (size_t i = 0; i < f->rows; i++) {
        const double u = basis(f, p, i) - a / w;
        aa += f->weight[i] * u * u;
        ab += f->weight[i] * u * (f->y[i] - b / w);
    }
    f->p = p;
    f->slope = aa > 0 ? ab / aa : 0;
    f->limit = b / w - f->slope * a / w;
    for (size_t i = 0; i < f->rows; i++) {
        const double off = f->y[i] - f->limit - f->slope * basis(f, p, i);
        squares += f->weight[i] * off * off;
    }
    return f->squares = squares;
}

/* The best p from 0.05 to 10: the best of a list, then by golden section. */
static void find(struct fit *f)
{
    static const double golden = 0.6180339887498949;
    double best = INFINITY, at = 1;
    for (double p = 0.05; f->powers && p < 10; p *= 1.15)
        if (solve(f, p) < best) {
            best = f->squares;
            at = p;
        }
    double low = at / 1.15, high = at * 1.15;
    for (int i = 0; f->powers && i < 30; i++) {
        const double c = high - golden * (high - low), d = low + golden * (high - low);
        if (solve(f, c) < solve(f, d))
            high = d;
        else
            low = c;
    }
    solve(f, (low + high) / 2);
    if (!f->powers)
        f->p = f->slope;
}

static double residual(const struct fit *f, size_t i)
{
    return f->y[i] - f->limit - f->slope * basis(f, f->p, i);
}

/* The same by least sums of distances: weights of the inverse residuals, again and again. */
static void find_sums(struct fit *f)
{
    double weight[BR_MOST_ERRORS], off[BR_MOST_ERRORS], most = 0;
    find(f);
    for (size_t i = 0; i < f->rows; i++)
        weight[i] = f->weight[i];
    for (int round = 0; round < 5; round++) {
        for (size_t i = 0; i < f->rows; i++)
            most = fmax(most, off[i] = fabs(residual(f, i)));
        for (size_t i = 0; i < f->rows && most > 0; i++)
            f->weight[i] = weight[i] / fmax(off[i], 1e-3 * most);
        find(f);
    }
    for (size_t i = 0; i < f->rows; i++)
        f->weight[i] = weight[i];
}

/* The rows of a line from first on, weighted by a power of their sizes. */
static struct fit fit_of(const struct br_error_line *line, size_t first, double power)
{
    struct fit f = {.rows = line->rows - first, .powers = line->values};
    for (size_t i = 0; i < f.rows; i++) {
        f.x[i] = line->h[first + i] / line->h[line->rows - 1];
        f.y[i] = line->values ? line->e[first + i] : log(line->e[first + i]);
        f.weight[i] = pow(f.x[i], power);
    }
    return f;
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* From 2.5 to 97.5 % of n numbers. */
static struct br_other_interval middle(double *number, size_t n)
{
    qsort(number, n, sizeof *number, by_size);
    return n < 10 ? none
                  : (struct br_other_interval){number[(size_t)(0.025 * (double)(n - 1))],
                                               number[(size_t)ceil(0.975 * (double)(n - 1))]};
}

/* The order or the limit of fits to the fitted line with its own residuals drawn again. */
static size_t bootstrap(struct fit f, bool sums, size_t times, double *found)
{
    struct br_test_random random = br_test_random_of(20261128, f.rows);
    const size_t unknowns = f.powers ? 3 : 2;
    if (f.rows <= unknowns)
        return 0;
    const double more = sqrt((double)f.rows / (double)(f.rows - unknowns));
    sums ? find_sums(&f) : find(&f);
    for (size_t k = 0; k < times; k++) {
        struct fit g = f;
        for (size_t i = 0; i < f.rows; i++) {
            const size_t from = br_test_index(&random, f.rows);
            g.y[i] += more * residual(&f, from) - residual(&f, i);
        }
        sums ? find_sums(&g) : find(&g);
        found[k] = f.powers ? g.limit : g.p;
    }
    return times;
}

static struct br_other_interval bootstrapped(const struct br_error_line *line)
{
    double found[BOOTSTRAPS];
    const struct fit f = fit_of(line, 0, 0);
    return middle(found, bootstrap(f, false, BOOTSTRAPS, found));
}

static struct br_other_interval robust(const struct br_error_line *line)
{
    static const double power[WEIGHTS] = {0, -1, -2};
    double found[MOST_FITS];
    size_t n = 0;
    for (size_t first = 0; first + 4 <= line->rows; first++)
        for (size_t w = 0; w < WEIGHTS; w++)
            for (size_t norm = 0; norm < NORMS; norm++)
                n += bootstrap(fit_of(line, first, power[w]), norm > 0, ROBUST_BOOTSTRAPS,
                               found + n);
    return middle(found, n);
}

/* ---- the three finest rows ---- */

static double rate(const struct br_error_line *line, size_t i)
{
    return log(line->e[i - 1] / line->e[i]) / log(line->h[i - 1] / line->h[i]);
}

static struct br_other_interval last_rates(const struct br_error_line *line)
{
    const size_t last = line->rows - 1;
    const double p = rate(line, last), change = fabs(p - rate(line, last - 1));
    return (struct br_other_interval){p - change, p + change};
}

/* The order of three values whose changes fall, by bisection; NaN: they do not. */
static double order_of(const double h[3], const double v[3])
{
    const double coarse = v[0] - v[1], fine = v[1] - v[2];
    double low = 1e-6, high = 40;
    if (!(coarse * fine > 0))
        return NAN;
    for (int i = 0; i < 100; i++) {
        const double p = (low + high) / 2;
        const double model = (pow(h[0] / h[1], p) - 1) / (1 - pow(h[2] / h[1], p));
        *(model < coarse / fine ? &low : &high) = p;
    }
    return low > 1e-5 && low < 39 ? low : NAN;
}

static struct br_other_interval grid_index(const struct br_error_line *line)
{
    const double *h = line->h + line->rows - 3, *v = line->e + line->rows - 3;
    const double p = order_of(h, v), error = fabs(v[1] - v[2]) / (pow(h[1] / h[2], p) - 1);
    return (struct br_other_interval){v[2] - 1.25 * error, v[2] + 1.25 * error};
}

/* ---- least squares ---- */

static struct br_other_interval regression(const struct br_error_line *line)
{
    struct fit f = fit_of(line, 0, 0);
    double mean = 0, spread = 0;
    find(&f);
    for (size_t i = 0; i < f.rows; i++)
        mean += log(f.x[i]) / (double)f.rows;
    for (size_t i = 0; i < f.rows; i++)
        spread += (log(f.x[i]) - mean) * (log(f.x[i]) - mean);
    const double n = (double)f.rows - 2;
    const double half = gsl_cdf_tdist_Pinv(0.975, n) * sqrt(f.squares / n / spread);
    return (struct br_other_interval){f.p - half, f.p + half};
}

/* The deviation of a fit: its sum of squares over rows less unknowns, weights of mean 1. */
static double deviation(const struct fit *f, size_t unknowns)
{
    double weights = 0;
    for (size_t i = 0; i < f->rows; i++)
        weights += f->weight[i];
    return sqrt(f->squares * (double)f->rows / weights / (double)(f->rows - unknowns));
}

/* Takes g for f where it deviates less. */
static void take_better(struct fit *f, double *least, struct fit g, size_t unknowns)
{
    const double d = deviation(&g, unknowns);
    if (!(d < *least))
        return;
    *least = d;
    *f = g;
}

/* Of the fits with the order free, or with 1 and with 2 where that order is not between 0.5 and 2,
 * with equal weights and with 1/h, the one that deviates least (Eca and Hoekstra 2014; without
 * their fit of h and h^2 together). */
static struct fit best_of(const struct br_error_line *line, double *least)
{
    struct fit best = {.p = NAN};
    *least = INFINITY;
    for (int power = 0; power >= -1; power--) {
        struct fit g = fit_of(line, 0, power);
        find(&g);
        take_better(&best, least, g, 3);
    }
    if (best.p >= 0.5 && best.p <= 2.05)
        return best;
    *least = INFINITY;
    for (int power = 0; power >= -1; power--)
        for (int p = 1; p <= 2; p++) {
            struct fit g = fit_of(line, 0, power);
            solve(&g, p);
            take_better(&best, least, g, 2);
        }
    return best;
}

static struct br_other_interval least_squares(const struct br_error_line *line)
{
    const size_t last = line->rows - 1;
    double sigma, low = INFINITY, high = -INFINITY;
    if (line->rows < 4)
        return grid_index(line);
    const struct fit f = best_of(line, &sigma);
    for (size_t i = 0; i <= last; i++) {
        low = fmin(low, f.y[i]);
        high = fmax(high, f.y[i]);
    }
    const double range = (high - low) / (double)last, off = fabs(residual(&f, last));
    const double error = fabs(f.y[last] - f.limit);
    const double half =
        sigma < range ? 1.25 * error + sigma + off : 3 * sigma / range * (error + sigma + off);
    return (struct br_other_interval){f.y[last] - half, f.y[last] + half};
}

struct br_other_interval br_other_order(enum br_other other, const struct br_error_line *line)
{
    return other == BR_OTHER_TRIPLE      ? last_rates(line)
           : other == BR_OTHER_SQUARES   ? regression(line)
           : other == BR_OTHER_BOOTSTRAP ? bootstrapped(line)
                                         : robust(line);
}

struct br_other_interval br_other_limit(enum br_other other, const struct br_error_line *line)
{
    return other == BR_OTHER_TRIPLE      ? grid_index(line)
           : other == BR_OTHER_SQUARES   ? least_squares(line)
           : other == BR_OTHER_BOOTSTRAP ? bootstrapped(line)
                                         : robust(line);
}
