/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Limits and uncertainties of values on finer and finer grids: published examples, exact power
 * laws, and an independent least squares in long double. */
#include "study/fit/limits.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "support.h"

/* |actual - printed| is at most half a unit of the last printed digit. */
#define PRINTED(actual, printed, digits) CLOSE(actual, printed, 0.5000001 * pow(10, -(digits)))
#define IS_NAN(x) assert_true(isnan(x))

enum { MOST = 12 };

static struct br_error err;

/* h of two-dimensional grids of so many cells, equation (2) of Celik et al., from coarse to fine.
 */
static void sizes(const double *cells, size_t count, double *h)
{
    for (size_t i = 0; i < count; i++)
        h[i] = 1 / sqrt(cells[i]);
}

/* ---- the grid convergence index ---- */

/* Celik et al. (2008), Table 1. The columns 2 and 3 belong to 18000, 4500 and 980 cells (r21 = 2.0,
 * r32 = 2.143). Misprinted is e_ext of column 2: 0.9 %. Equation (6) divides by phi_ext and gives
 * 0.8465 %; 0.9 % comes out with phi_1 below (0.8538 %). */
static const struct {
    double cells[3], value[3];
    double r21, r32, p, limit;
    double relative, extrapolated, index; /* % */
} celik[] = {
    {{4500, 8000, 18000}, {5.863, 5.972, 6.063}, 1.5, 1.333, 1.53, 6.1685, 1.5, 1.7, 2.2},
    {{980, 4500, 18000}, {10.605, 10.725, 10.788}, 2.0, 2.143, 0.75, 10.8801, 0.6, 0.8, 1.1},
    {{980, 4500, 18000}, {6.0909, 5.9624, 6.0042}, 2.0, 2.143, 1.51, 6.0269, 0.7, 0.4, 0.5},
};

TEST(test_celik)
{
    for (size_t i = 0; i < sizeof celik / sizeof *celik; i++) {
        double h[3];
        struct br_gci g;
        sizes(celik[i].cells, 3, h);
        br_gci(h, celik[i].value, 3, &g);
        assert_int_equal(g.sequence, i < 2 ? BR_MONOTONE_CONVERGENCE : BR_OSCILLATORY_CONVERGENCE);
        PRINTED(g.fine.ratio, celik[i].r21, 1);
        PRINTED(g.coarse.ratio, celik[i].r32, 3);
        PRINTED(g.order, celik[i].p, 2);
        PRINTED(g.fine.limit, celik[i].limit, 4);
        PRINTED(100 * g.fine.relative, celik[i].relative, 1);
        PRINTED(100 * g.fine.relative_extrapolated, celik[i].extrapolated, 1);
        PRINTED(100 * g.fine.index, celik[i].index, 1);
        if (i != 1)
            continue;
        CLOSE(100 * g.fine.relative_extrapolated, 0.8465, 1e-4);
        PRINTED(100 * (g.fine.limit - celik[1].value[2]) / celik[1].value[2], 0.9, 1);
    }
}

/* "Examining Spatial (Grid) Convergence", NPARC Alliance. Its 0.997980 is r^p GCI_12/GCI_23, the
 * inverse of the ratio here. */
/* The limits of Oberkampf and Roy: values 5 - h^p at h = 1, 1/2, 1/4, formal order 2. */
TEST(test_limited_order)
{
    static const struct {
        double p, safety, order;
    } cases[] = {{2.1, 1.25, 2}, {1.81, 1.25, 2}, {1.5, 3, 1.5}, {3, 3, 2}, {0.2, 3, 0.5}};
    static const double h[] = {1, 0.5, 0.25};
    struct br_gci g;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double value[3];
        for (int j = 0; j < 3; j++)
            value[j] = 5 - pow(h[j], cases[i].p);
        br_gci(h, value, 3, &g);
        CLOSE(br_gci_limited(&g, 2),
              cases[i].safety * (value[2] - value[1]) / value[2] / (pow(2, cases[i].order) - 1),
              1e-12);
        assert_true(br_gci_is_far(&g, 2) == (cases[i].safety > 2));
    }
    br_gci(h, (const double[]){1, 2, 4}, 3, &g);
    IS_NAN(br_gci_limited(&g, 2));
    assert_false(br_gci_is_far(&g, 2));
}

TEST(test_nparc)
{
    static const double h[] = {4, 2, 1}, value[] = {0.96178, 0.96854, 0.97050};
    struct br_gci g;
    br_gci(h, value, 3, &g);
    PRINTED(g.order, 1.786170, 6);
    PRINTED(g.fine.limit, 0.97130, 5);
    PRINTED(100 * g.fine.index, 0.103083, 6);
    PRINTED(100 * g.coarse.index, 0.356249, 6);
    PRINTED(1 / g.asymptotic, 0.997980, 6);
    CLOSE(g.asymptotic, value[2] / value[1], 1e-12);
    CLOSE(g.coarse.limit, g.fine.limit, 1e-14);
    CLOSE(g.fine.uncertainty, g.fine.index * value[2], 1e-15);
}

/* phi = 2 + 3 h^p gives back p and 2 for any ratios, also where the paper's iteration runs away;
 * and so does 2 +- 3 h^p with alternating signs give back p. */
TEST(test_power_law)
{
    struct br_test_random random = {1};
    for (int i = 0; i < 400; i++) {
        const bool alternates = i % 4 == 0;
        const double p = br_test_uniform(&random, -4, 6);
        const double r21 = br_test_uniform(&random, 1.1, 4), r32 = br_test_uniform(&random, 1.1, 9);
        const double h[] = {r21 * r32, r21, 1};
        double value[3];
        for (int j = 0; j < 3; j++)
            value[j] = 2 + (alternates && j % 2 ? -3 : 3) * pow(h[j], p);
        struct br_gci g;
        br_gci(h, value, 3, &g);
        CLOSE(g.order, p, 1e-9);
        if (alternates) {
            assert_int_equal(g.sequence,
                             p > 0 ? BR_OSCILLATORY_CONVERGENCE : BR_OSCILLATORY_DIVERGENCE);
            continue;
        }
        assert_int_equal(g.sequence, p > 0 ? BR_MONOTONE_CONVERGENCE : BR_MONOTONE_DIVERGENCE);
        if (p > 0) {
            CLOSE(g.fine.limit, 2, 1e-8 / fmin(p, 1));
            CLOSE(g.coarse.limit, 2, 1e-7 / fmin(p, 1));
            CLOSE(g.fine.uncertainty, 1.25 * 3, 1e-7 / fmin(p, 1));
            CLOSE(g.asymptotic, fabs(value[2] / value[1]), 1e-9);
        } else {
            IS_NAN(g.fine.uncertainty);
            IS_NAN(g.fine.limit);
            IS_NAN(g.coarse.index);
            IS_NAN(g.asymptotic);
        }
    }
}

/* One h, the values, what they are. */
struct named {
    size_t count;
    double h[MOST], value[MOST];
    enum br_sequence sequence;
};

TEST(test_triplet_kinds)
{
    static const struct named cases[] = {
        {3, {4, 2, 1}, {1.4, 1.1, 1}, BR_MONOTONE_CONVERGENCE},
        {3, {4, 2, 1}, {-1.4, -1.1, -1}, BR_MONOTONE_CONVERGENCE},
        {3, {4, 2, 1}, {0.8, 1.1, 1}, BR_OSCILLATORY_CONVERGENCE},
        {3, {4, 2, 1}, {1.2, 1.1, 1.0 - 0.1}, BR_MONOTONE_DIVERGENCE},
        {3, {4, 2, 1}, {1.05, 1.1, 1}, BR_OSCILLATORY_DIVERGENCE},
        {3, {4, 2, 1}, {1, 1, 1}, BR_SEQUENCE_CONSTANT},
        {3, {4, 2, 1}, {0, 0, 0}, BR_SEQUENCE_CONSTANT},
        {3, {4, 2, 1}, {1, 1 + 1e-15, 1}, BR_SEQUENCE_CONSTANT},
        {3, {4, 2, 1}, {1.1, 1, 1}, BR_SEQUENCE_UNKNOWN},
        {3, {4, 2, 1}, {1, 1, 1.1}, BR_SEQUENCE_UNKNOWN},
        {3, {4, 2, 1}, {1.2, 1.1, 1}, BR_MONOTONE_DIVERGENCE}, /* e21 = e32: p = 0 */
        /* 1 + h converges, though R = 5; 1 + 1/h diverges, though R = 0.11 */
        {3, {1, 10.0 / 11, 5.0 / 11}, {2, 21.0 / 11, 16.0 / 11}, BR_MONOTONE_CONVERGENCE},
        {3, {10, 1, 10.0 / 11}, {1.1, 2, 2.1}, BR_MONOTONE_DIVERGENCE},
        /* only the three finest count */
        {5, {16, 8, 4, 2, 1}, {1, 9, 1.4, 1.1, 1}, BR_MONOTONE_CONVERGENCE},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct named *c = &cases[i];
        struct br_gci g;
        br_gci(c->h, c->value, c->count, &g);
        if (g.sequence != c->sequence)
            fail_msg("case %zu is %s, expected %s", i, br_sequence_text(g.sequence),
                     br_sequence_text(c->sequence));
        const bool known = strstr(br_sequence_text(g.sequence), "convergence");
        assert_int_equal(isfinite(g.fine.uncertainty), known);
        assert_int_equal(isfinite(g.coarse.index), known);
        assert_int_equal(isfinite(g.asymptotic), known);
        assert_false(known && !(g.order > 0));
        CLOSE(g.fine.difference, fabs(c->value[c->count - 1] - c->value[c->count - 2]), 0);
        CLOSE(g.coarse.difference, fabs(c->value[c->count - 2] - c->value[c->count - 3]), 0);
    }
}

/* Relative errors of a value 0 are not known; absolute ones are. */
TEST(test_zero_value)
{
    static const double h[] = {4, 2, 1}, value[] = {5, 1, 0};
    struct br_gci g;
    br_gci(h, value, 3, &g);
    CLOSE(g.order, 2, 1e-13);
    CLOSE(g.fine.limit, -1.0 / 3, 1e-13);
    CLOSE(g.fine.uncertainty, 1.25 / 3, 1e-13);
    CLOSE(g.fine.difference, 1, 0);
    CLOSE(g.fine.relative_extrapolated, 1, 1e-13);
    IS_NAN(g.fine.relative);
    IS_NAN(g.fine.index);
    IS_NAN(g.asymptotic);
    CLOSE(g.coarse.index, 1.25 * 4 / 3, 1e-12);
}

/* ---- least squares, once more: normal equations in long double ---- */

struct oracle_fit {
    long double limit, error, misfit, sigma, p;
};

/* Solves the normal equations of phi_0 + sum alpha_j (h/h_1)^power_j by Gauss elimination. */
static struct oracle_fit oracle_solve(const struct named *c, bool weighted, size_t terms,
                                      const long double *power, size_t unknowns)
{
    const size_t n = c->count, m = terms + 1;
    long double a[3][4] = {{0}}, sum = 0, squares = 0, solution[3];
    for (size_t i = 0; i < n; i++)
        sum += 1 / (long double)c->h[i];
    for (size_t i = 0; i < n; i++) {
        const long double w = weighted ? 1 / (long double)c->h[i] / sum : 1 / (long double)n;
        const long double z = (long double)c->h[i] / c->h[n - 1];
        long double row[4] = {1};
        for (size_t j = 0; j < terms; j++)
            row[1 + j] = powl(z, power[j]);
        row[m] = c->value[i];
        for (size_t j = 0; j < m; j++)
            for (size_t k = 0; k <= m; k++)
                a[j][k] += w * row[j] * row[k];
    }
    for (size_t j = 0; j < m; j++)
        for (size_t k = j + 1; k < m; k++) {
            const long double factor = a[k][j] / a[j][j];
            for (size_t l = j; l <= m; l++)
                a[k][l] -= factor * a[j][l];
        }
    for (size_t j = m; j-- > 0;) {
        solution[j] = a[j][m];
        for (size_t k = j + 1; k < m; k++)
            solution[j] -= a[j][k] * solution[k];
        solution[j] /= a[j][j];
    }
    struct oracle_fit fit = {.limit = solution[0], .p = power[0]};
    for (size_t i = 0; i < n; i++) {
        long double residual = c->value[i] - solution[0];
        for (size_t j = 0; j < terms; j++)
            residual -= solution[1 + j] * powl((long double)c->h[i] / c->h[n - 1], power[j]);
        squares += residual * residual * (weighted ? n / (long double)c->h[i] / sum : 1);
        fit.misfit = residual;
    }
    for (size_t j = 0; j < terms; j++)
        fit.error += solution[1 + j];
    fit.sigma = sqrtl(squares / (long double)(n - unknowns));
    return fit;
}

/* The best p by a dense scan, then by scans ten times as dense; p = NaN at an end. */
static struct oracle_fit oracle_observed(const struct named *c, bool weighted)
{
    long double low = -12, width = 0.029L, best = -12;
    long double least = INFINITY;
    for (int level = 0; level < 9; level++) {
        const long double end = level ? best + 12 * width : 12;
        for (long double p = level ? best - 12 * width : low; p <= end; p += width) {
            if (fabsl(p) < 1e-7L)
                continue;
            const struct oracle_fit fit = oracle_solve(c, weighted, 1, &p, 3);
            if (fit.sigma < least) {
                least = fit.sigma;
                best = p;
            }
        }
        if (level == 0 && fabsl(best) > 11.95L)
            return (struct oracle_fit){.p = NAN, .sigma = NAN};
        width /= 10;
    }
    return oracle_solve(c, weighted, 1, &best, 3);
}

struct oracle {
    struct oracle_fit fit;
    long double order, uncertainty, safety;
};

static void take_smaller(struct oracle_fit *best, struct oracle_fit other)
{
    if (!(best->sigma <= other.sigma))
        *best = other;
}

static struct oracle oracle_of(const struct named *c, double formal)
{
    struct oracle o = {.fit = {.sigma = NAN}, .order = NAN};
    struct oracle_fit positive = {.sigma = NAN, .p = NAN}, negative = positive;
    for (int w = 0; w < 2; w++) {
        const struct oracle_fit f = oracle_observed(c, w);
        if (f.p > 0)
            take_smaller(&positive, f);
        if (f.p <= 0)
            take_smaller(&negative, f);
        if (f.p >= 0.5L && f.p <= formal)
            take_smaller(&o.fit, f);
    }
    o.order = isnan(positive.p) ? negative.p : positive.p;
    if (!isnan(o.fit.sigma))
        o.order = o.fit.p;
    const long double both[2] = {1, formal > 1 ? formal : 2};
    for (int w = 0; w < 2 && !(o.fit.p >= 0.5L && o.fit.p == o.order); w++) {
        take_smaller(&o.fit, oracle_solve(c, w, 1, both, 2));
        if (formal > 1)
            take_smaller(&o.fit, oracle_solve(c, w, 1, both + 1, 2));
        if (isnan(o.order) || o.order < 0.5L)
            take_smaller(&o.fit, oracle_solve(c, w, 2, both, 3));
    }
    double least = INFINITY, most = -INFINITY;
    for (size_t i = 0; i < c->count; i++) {
        least = fmin(least, c->value[i]);
        most = fmax(most, c->value[i]);
    }
    const long double range = ((long double)most - least) / (long double)(c->count - 1);
    const long double rest = o.fit.sigma + fabsl(o.fit.misfit), error = fabsl(o.fit.error);
    o.safety = o.order >= 0.5L && o.order < formal + 0.1L && o.fit.sigma < range ? 1.25L : 3;
    o.uncertainty =
        o.fit.sigma < range ? o.safety * error + rest : 3 * o.fit.sigma / range * (error + rest);
    return o;
}

/* What random sequences have led to. */
struct seen {
    int observed, first, formal, both, both_without_order, weighted, equal, rough, careful;
    int kind[BR_SEQUENCE_ANOMALOUS + 1];
};

static void compare(const struct named *c, double formal, struct seen *seen)
{
    struct br_least_squares r;
    MUST(br_least_squares(c->h, c->value, c->count, formal, &r, &err));
    const struct oracle o = oracle_of(c, formal);
    assert_int_equal(isnan(o.order), isnan(r.order));
    if (!isnan(r.order))
        CLOSE(r.order, (double)o.order, 1e-5);
    const double unit = (double)o.uncertainty;
    CLOSE(r.uncertainty, unit, 1e-5 * unit);
    CLOSE(r.fit.limit, (double)o.fit.limit, 1e-5 * unit);
    CLOSE(r.fit.error, (double)o.fit.error, 1e-5 * unit);
    CLOSE(r.fit.misfit, (double)o.fit.misfit, 1e-5 * unit);
    CLOSE(r.fit.sigma, (double)o.fit.sigma, 1e-5 * unit);
    CLOSE(r.safety, (double)o.safety, 0);
    seen->observed += r.fit.observed;
    seen->first += r.fit.terms == 1 && !r.fit.observed && r.fit.power[0] == 1;
    seen->formal += r.fit.terms == 1 && !r.fit.observed && r.fit.power[0] == formal;
    seen->both += r.fit.terms == 2;
    seen->both_without_order += r.fit.terms == 2 && isnan(r.order);
    seen->weighted += r.fit.weighted;
    seen->equal += !r.fit.weighted;
    seen->rough += !(r.fit.sigma < r.range);
    seen->careful += r.safety == 3;
    seen->kind[r.sequence]++;
}

TEST(test_random_sequences)
{
    struct br_test_random random = {2014};
    struct seen seen = {0};
    const int rounds = br_test_quick() ? 10 : 120;
    for (int i = 0; i < rounds; i++) {
        struct named c = {.count = 4 + br_test_index(&random, 6)};
        const double p = br_test_uniform(&random, -1, 4);
        const double noise = i % 3 ? br_test_log_uniform(&random, 1e-4, 3) : 1e-3;
        double h = br_test_log_uniform(&random, 1e-3, 10);
        for (size_t j = 0; j < c.count; j++) {
            c.h[j] = h;
            const double side = i % 5 == 0 && j % 2 ? -1 : 1; /* some alternate */
            c.value[j] =
                0.7 + side * 5 * pow(h / c.h[0], p) + noise * br_test_uniform(&random, -1, 1);
            h /= br_test_uniform(&random, 1.2, 2.2);
        }
        compare(&c, i % 4 ? 2 : 1 + (double)br_test_index(&random, 4), &seen);
    }
    if (br_test_quick())
        return;
    assert_true(seen.observed > 10 && seen.first > 5 && seen.formal > 5 && seen.both > 5);
    assert_true(seen.both_without_order > 3);
    assert_true(seen.weighted > 10 && seen.equal > 10 && seen.rough > 3 && seen.careful > 10);
    assert_true(seen.kind[BR_MONOTONE_CONVERGENCE] > 10 && seen.kind[BR_MONOTONE_DIVERGENCE] > 3);
}

/* Power laws: the limit is exact, and U is 1.25 eps as with the grid convergence index. */
TEST(test_exact_laws)
{
    static const double orders[] = {0.5001, 0.8, 1, 1.3, 1.9, 2};
    for (size_t i = 0; i < sizeof orders / sizeof *orders; i++) {
        struct named c = {6, {1, 0.7, 0.4, 0.3, 0.2, 0.15}, {0}, BR_MONOTONE_CONVERGENCE};
        for (size_t j = 0; j < c.count; j++)
            c.value[j] = 1000 - 3 * pow(c.h[j], orders[i]);
        const double error = -3 * pow(0.15, orders[i]);
        struct br_least_squares r;
        struct br_gci g;
        MUST(br_least_squares(c.h, c.value, c.count, 2, &r, &err));
        br_gci(c.h, c.value, c.count, &g);
        CLOSE(r.order, orders[i], 1e-7);
        CLOSE(r.fit.limit, 1000, 1e-6);
        CLOSE(r.fit.error, error, 1e-6);
        CLOSE(r.fit.sigma, 0, 1e-10);
        CLOSE(r.range, (c.value[5] - c.value[0]) / 5, 1e-12);
        CLOSE(r.uncertainty, 1.25 * fabs(error), 1e-6);
        CLOSE(r.uncertainty, g.fine.uncertainty, 1e-6);
        assert_int_equal(r.sequence, BR_MONOTONE_CONVERGENCE);
        assert_true(r.safety == 1.25);
    }
}

/* Values 7 + 2 h^order + b h^2, and which of the paper's fits they get. An order between the formal
 * one and 0.1 more is fitted with the formal one, and reliable. */
TEST(test_fits_of_the_paper)
{
    static const struct {
        double order, b, formal;
        size_t terms;
        bool observed;
        double power, safety;
    } rows[] = {
        {3, 0, 2, 1, false, 2, 3},       {3, 0, 4, 1, true, 3, 1.25},  {1, -1.9, 2, 2, false, 1, 3},
        {2.05, 0, 2, 1, false, 2, 1.25}, {2.15, 0, 2, 1, false, 2, 3},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct named c = {5, {1, 0.5, 0.25, 0.125, 0.0625}, {0}, BR_SEQUENCE_UNKNOWN};
        struct br_least_squares r;
        for (size_t j = 0; j < c.count; j++)
            c.value[j] = 7 + 2 * pow(c.h[j], rows[i].order) + rows[i].b * c.h[j] * c.h[j];
        MUST(br_least_squares(c.h, c.value, c.count, rows[i].formal, &r, &err));
        assert_int_equal(r.fit.terms, rows[i].terms);
        assert_int_equal(r.fit.observed, rows[i].observed);
        CLOSE(r.fit.power[0], rows[i].power, 1e-7);
        CLOSE(r.safety, rows[i].safety, 0);
        if (rows[i].b == 0)
            CLOSE(r.order, rows[i].order, 1e-7);
        if (rows[i].observed || rows[i].b != 0)
            CLOSE(r.fit.limit, 7, 1e-7);
        if (rows[i].b != 0)
            CLOSE(r.uncertainty, 3 * (2.0 / 16 - 1.9 / 256), 1e-12);
    }
}

/* Values that fall with ln h have order 0 and no limit: the fixed fits are used, with care. */
TEST(test_logarithm)
{
    static const double h[] = {1, 0.6, 0.3, 0.2, 0.1};
    double value[5];
    struct br_least_squares r;
    for (int i = 0; i < 5; i++)
        value[i] = 3 + log(h[i]);
    MUST(br_least_squares(h, value, 5, 2, &r, &err));
    CLOSE(r.order, 0, 1e-6);
    assert_true(!r.fit.observed && r.safety == 3 && isfinite(r.uncertainty));
}

TEST(test_sequence_kinds)
{
    static const struct named cases[] = {
        {4, {8, 4, 2, 1}, {9, 5, 3, 2}, BR_MONOTONE_CONVERGENCE},
        {4, {8, 4, 2, 1}, {1, 2, 4, 8}, BR_MONOTONE_DIVERGENCE},
        {5, {16, 8, 4, 2, 1}, {2, 0.75, 1.0625, 0.984375, 1.00390625}, BR_OSCILLATORY_CONVERGENCE},
        {5, {16, 8, 4, 2, 1}, {1.00390625, 0.984375, 1.0625, 0.75, 2}, BR_OSCILLATORY_DIVERGENCE},
        /* a third of the rows turn, and one row less */
        {6, {32, 16, 8, 4, 2, 1}, {32, 18, 13, 29, 24, 11}, BR_OSCILLATORY_CONVERGENCE},
        {6, {32, 16, 8, 4, 2, 1}, {3, 25, 27, 12, 12, 20}, BR_SEQUENCE_ANOMALOUS},
        {4, {8, 4, 2, 1}, {1, 0, 0, 0}, BR_SEQUENCE_ANOMALOUS},
        {4, {8, 4, 2, 1}, {1, 0x1p-14, 0x1p-28, 0x1p-42}, BR_SEQUENCE_ANOMALOUS}, /* order 14 */
        {4, {8, 4, 2, 1}, {3, 3, 3, 3}, BR_SEQUENCE_CONSTANT},
        {4, {8, 4, 2, 1}, {0, 0, 0, 0}, BR_SEQUENCE_CONSTANT},
        {3, {4, 2, 1}, {1, 1.1, 1.5}, BR_MONOTONE_DIVERGENCE},
        {3, {4, 2, 1}, {3, 3, 3}, BR_SEQUENCE_CONSTANT},
        {3, {4, 2, 1}, {2, 3, 3}, BR_SEQUENCE_UNKNOWN},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct named *c = &cases[i];
        const bool constant = c->sequence == BR_SEQUENCE_CONSTANT;
        struct br_grid_limit limit;
        MUST(br_limit_of_values(c->h, c->value, NULL, c->count, 2, &limit, &err));
        if (limit.sequence != c->sequence)
            fail_msg("case %zu is %s, expected %s (p = %g)", i, br_sequence_text(limit.sequence),
                     br_sequence_text(c->sequence), limit.order);
        const bool none = c->sequence == BR_SEQUENCE_UNKNOWN ||
                          strstr(br_sequence_text(c->sequence), "divergence");
        assert_int_equal(isnan(limit.value.value), none);
        assert_int_equal(isnan(limit.value.low), none || constant);
        assert_int_equal(isnan(limit.value.high), none || constant);
        struct br_least_squares r;
        if (c->count < 4)
            continue;
        MUST(br_least_squares(c->h, c->value, c->count, 2, &r, &err));
        assert_int_equal(isnan(r.uncertainty), constant);
        assert_int_equal(r.fit.terms == 0, constant);
    }
}

/* Results scale with the values and do not see the unit of h. */
TEST(test_units)
{
    const struct named c = {5, {1, 0.6, 0.3, 0.2, 0.1}, {3.1, 2.2, 1.45, 1.3, 1.11}, 0};
    static const double scales[] = {1e-150, -1, 1e150};
    struct br_least_squares one, other;
    MUST(br_least_squares(c.h, c.value, c.count, 2, &one, &err));
    for (int i = 0; i < 3; i++) {
        struct named d = c;
        for (size_t j = 0; j < c.count; j++) {
            d.h[j] *= 1e-9;
            d.value[j] *= scales[i];
        }
        MUST(br_least_squares(d.h, d.value, d.count, 2, &other, &err));
        CLOSE(other.order, one.order, 1e-6);
        CLOSE(other.uncertainty / fabs(scales[i]), one.uncertainty, 1e-7);
        CLOSE(other.fit.limit / scales[i], one.fit.limit, 1e-7);
        CLOSE(other.fit.sigma / fabs(scales[i]), one.fit.sigma, 1e-9);
        CLOSE(other.range / fabs(scales[i]), one.range, 1e-12);
    }
}

/* ---- either ---- */

TEST(test_limit)
{
    static const double h[] = {1, 0.5, 0.25, 0.125}, value[] = {2.1, 1.4, 1.12, 1.03};
    struct br_grid_limit limit;
    struct br_gci g;
    struct br_least_squares fit;
    MUST(br_limit_of_values(h, value, NULL, 3, 2, &limit, &err));
    br_gci(h, value, 3, &g);
    assert_int_equal(limit.method, BR_LIMIT_GCI);
    assert_int_equal(limit.sequence, BR_MONOTONE_CONVERGENCE);
    CLOSE(limit.order, log(2.5) / log(2), 1e-13);
    CLOSE(limit.value.value, 1.12 - 0.28 / 1.5, 1e-13);
    CLOSE(limit.value.low, 1.12 * (1 - g.fine.index), 1e-13);
    CLOSE(limit.value.high, 1.12 * (1 + g.fine.index), 1e-13);
    MUST(br_limit_of_values(h, value, NULL, 4, 2, &limit, &err));
    MUST(br_least_squares(h, value, 4, 2, &fit, &err));
    assert_int_equal(limit.method, BR_LIMIT_LEAST_SQUARES);
    CLOSE(limit.order, fit.order, 0);
    CLOSE(limit.value.value, fit.fit.limit, 0);
    struct br_estimate order;
    MUST(br_order_of_values(h, value, 4, &order, &err));
    const double least = 0.09 / (pow(2, order.low) - 1);
    assert_true(least > fit.uncertainty);
    CLOSE(limit.value.low, 1.03 - least, 1e-15);
    CLOSE(limit.value.high, 1.03 + least, 1e-15);
    assert_true(limit.value.low < limit.value.value && limit.value.value < limit.value.high);
}

/* How often the interval holds the limit 1 of 1 + a h + b h^2 + c h^3, if there is an interval. */
static double coverage(size_t count, double finest)
{
    struct br_test_random random = {count};
    int told = 0, right = 0;
    for (int i = 0; i < (br_test_long() ? 100 : 40); i++) {
        const double a = br_test_uniform(&random, -1, 1), b = br_test_uniform(&random, -1, 1);
        const double c = br_test_uniform(&random, -1, 1);
        double h[MOST], value[MOST];
        struct br_grid_limit limit;
        for (size_t j = 0; j < count; j++) {
            h[j] = finest * pow(1.5, (double)(count - 1 - j));
            value[j] = 1 + h[j] * (a + h[j] * (b + h[j] * c));
        }
        MUST(br_limit_of_values(h, value, NULL, count, 2, &limit, &err));
        told += isfinite(limit.value.low);
        right += limit.value.low <= 1 && limit.value.high >= 1;
    }
    print_message("# %zu grids to h = %g: %d told, %d right\n", count, finest, told, right);
    return (double)right / told;
}

/* The interval promises 95 %; of three grids that holds only where the first term dominates. */
TEST(test_coverage)
{
    for (size_t count = 3; count < 7; count++) {
        AT_MOST(0.93, coverage(count, 0.01));
        AT_MOST(count > 3 ? 0.93 : 0.5, coverage(count, 0.1)); /* of three, Richardson's alone */
    }
}

/* ---- bad input ---- */

/* Means of values that do not change, and of values that fall to 1: no word of divergence, and the
 * limit is within its interval. Each value is known to +- half. */
TEST(test_scatter)
{
    enum { TRIALS = 100 };
    static const double slopes[] = {0, 0.02, 2};
    struct br_test_random random = {20261231};
    for (size_t s = 0; s < 3; s++)
        for (size_t count = 3; count < 7; count++) {
            size_t scatter = 0, diverges = 0, stated = 0, right = 0;
            for (int trial = 0; trial < TRIALS; trial++) {
                double h[6], value[6], half[6];
                struct br_limits limits;
                for (size_t i = 0; i < count; i++) {
                    double sum = -6; /* of deviation 1 */
                    for (int j = 0; j < 12; j++)
                        sum += br_test_uniform(&random, 0, 1);
                    h[i] = ldexp(1, -(int)i);
                    half[i] = 1.96 * 0.05;
                    value[i] = 1 + slopes[s] * h[i] + 0.05 * sum;
                }
                MUST(br_limits_find(h, value, half, count, 1, &limits, &err));
                const struct br_grid_limit *l = &limits.limit;
                scatter += l->sequence == BR_SEQUENCE_SCATTER;
                diverges += l->sequence == BR_MONOTONE_DIVERGENCE ||
                            l->sequence == BR_OSCILLATORY_DIVERGENCE;
                stated += isfinite(l->value.low) ? 1 : 0;
                right += l->value.low <= 1 && 1 <= l->value.high;
                for (size_t i = 0; i < limits.triples; i++)
                    if (fabs(value[i + 2] - value[i + 1]) <= hypot(half[i + 1], half[i + 2]))
                        IS_NAN(limits.triple[i].fine.index);
                br_limits_clear(&limits);
            }
            const double few = 0.02 * TRIALS, most = 0.96 * TRIALS;
            assert_true(s < 2 ? (double)scatter > most : (double)scatter < few);
            assert_true((double)diverges < few && (double)stated > most);
            if (!((double)right >= 0.91 * (double)stated))
                fail_msg("%zu values, slope %g: %zu of %zu intervals hold the limit", count,
                         slopes[s], right, stated);
        }
}

/* The half width of one mean by hand. Of 15, 7, 3, 1 only the first three hold the coarsest; the
 * others are of order 1, and go to -1. */
TEST(test_scatter_of_the_coarsest)
{
    static const double h[] = {8, 4, 2, 1}, value[] = {15, 7, 3, 1}, half[] = {10, 0.1, 0.1, 0.1};
    struct br_limits limits;
    MUST(br_limits_find(h, value, half, 4, 1, &limits, &err));
    assert_int_equal(limits.triples, 2);
    assert_int_equal(limits.triple[0].sequence, BR_SEQUENCE_UNKNOWN);
    assert_int_equal(limits.triple[1].sequence, BR_MONOTONE_CONVERGENCE);
    CLOSE(limits.triple[1].order, 1, 1e-13);
    CLOSE(limits.triple[1].fine.limit, -1, 1e-12);
    br_limits_clear(&limits);
}

/* Of 6, 2, 1 on ratios of 2, 2^p is the quotient 4 of the differences, and U = 1.25/(4 - 1) = 5/12.
 * Where the coarsest is 5 or 7, U is 1.25/2 or 1.25/4: changes by 10/48 and -5/48. Where the finest
 * is 0.5 or 1.5, U is 1.25 1.5^2/(4 - 1.5) = 9/8 or 1.25 0.5^2/(4 - 0.5) = 5/56: changes by 17/24
 * and -55/168. Their mean square adds to U, and the half width of the finest does, too. */
TEST(test_half_widths_by_hand)
{
    static const double h[] = {4, 2, 1}, value[] = {6, 2, 1}, half[][3] = {{1, 0, 0}, {0, 0, 0.5}};
    const double off[] = {5.0 / 12 + sqrt(62.5) / 48,
                          5.0 / 12 + hypot(17.0 / 24, 55.0 / 168) / sqrt(2) + 0.5};
    for (int i = 0; i < 2; i++) {
        struct br_grid_limit limit;
        MUST(br_limit_of_values(h, value, half[i], 3, 2, &limit, &err));
        CLOSE(limit.value.value, 2.0 / 3, 1e-12);
        CLOSE(limit.value.low, 1 - off[i], 1e-12);
        CLOSE(limit.value.high, 1 + off[i], 1e-12);
    }
}

TEST(test_bad_input)
{
    static const double h[] = {4, 2, 1, 0.5}, v[] = {3, 2, 1.5, 1.3};
    static const struct {
        double formal;
        const char *message;
    } bad[] = {
        {0.9, "the formal order is 0.9, expected 1 to 10"},
        {10.1, "expected 1 to 10"},
        {NAN, "the formal order is nan, expected"},
        {-2, "expected 1 to 10"},
        {INFINITY, "expected 1 to 10"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        for (size_t count = 3; count <= 4; count++) {
            struct br_limits limits;
            REFUSED(br_limits_find(h, v, NULL, count, bad[i].formal, &limits, &err), BR_BAD_INPUT,
                    bad[i].message);
            br_limits_clear(&limits);
        }
}

static enum br_status attempt(const void *data, struct br_error *why)
{
    const struct named *c = data;
    struct br_grid_limit limit;
    return br_limit_of_values(c->h, c->value, NULL, c->count, 2, &limit, why);
}

/* An oscillating sequence needs the order of its differences too. */
TEST(test_without_memory)
{
    const struct named c = {5, {16, 8, 4, 2, 1}, {2, 0.75, 1.0625, 0.984375, 1.00390625}, 0};
    br_test_without_memory(attempt, &c, 3);
}

/* By hand, of a value 10: over h 9 [8.5, 10.2] is left, which changes by 0.1 to the next k, over
 * k 10.5 [10, 11.5], which changes by 0.3 to the next h. So 10 - 1 + 0.5, and 1.5 + 1.5 + 0.3
 * around 10. */
TEST(test_limit_of_a_grid_by_hand)
{
    struct br_limit_along along[BR_AXES] = {
        {.limit = {.value = {9, 8.5, 10.2}, .sequence = BR_MONOTONE_CONVERGENCE},
         .next = {.value = {9.3, NAN, NAN}},
         .next_value = 10.2},
        {.limit = {.value = {10.5, 10, 11.5}, .sequence = BR_MONOTONE_CONVERGENCE},
         .next = {.value = {10.9, NAN, NAN}},
         .next_value = 10.1}};
    const struct br_grid_limit found = br_limit_of_grid(10, along);
    CLOSE(found.value.value, 9.5, 1e-12);
    CLOSE(found.value.low, 6.7, 1e-12);
    CLOSE(found.value.high, 13.3, 1e-12);
    along[1].limit.value.value = NAN;
    assert_true(isnan(br_limit_of_grid(10, along).value.value));
}
