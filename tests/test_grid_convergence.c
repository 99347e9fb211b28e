/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Limits and uncertainties of values on finer and finer grids: published examples, exact power
 * laws, random sequences, means. */
#include "orders/limits/limits.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "checks.h"

/* |actual - printed| is at most half a unit of the last printed digit. */
#define PRINTED(actual, printed, digits) CLOSE(actual, printed, 0.5000001 * pow(10, -(digits)))
#define IS_NAN(x) assert_true(isnan(x))

enum { MOST = 12 };

/* h of two-dimensional grids of so many cells, equation (2) of Celik et al., from coarse to fine.
 */
static void sizes(const double *cells, size_t count, double *h)
{
    for (size_t i = 0; i < count; i++)
        h[i] = 1 / sqrt(cells[i]);
}

static void find_gci(const double *h, const double *value, size_t count, struct br_gci *gci)
{
    struct br_point three[3];
    for (size_t i = 0; i < 3; i++)
        three[i] = (struct br_point){.z = h[count - 3 + i], .value = value[count - 3 + i]};
    br_gci(three, gci);
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
        find_gci(h, celik[i].value, 3, &g);
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
/* The limits of Oberkampf and Roy: values 5 - h^p at h = 1, 1/2, 1/4. */
TEST(test_limited_order)
{
    static const struct {
        double p, formal, safety, order;
    } cases[] = {{2.1, 2, 1.25, 2}, {1.81, 2, 1.25, 2}, {1.5, 2, 3, 1.5}, {3, 2, 3, 2},
                 {0.2, 2, 3, 0.5},  {3.7, 4, 1.25, 4},  {3, 4, 3, 3},     {5, 4, 3, 4}};
    static const double h[] = {1, 0.5, 0.25};
    struct br_gci g;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double value[3];
        for (int j = 0; j < 3; j++)
            value[j] = 5 - pow(h[j], cases[i].p);
        find_gci(h, value, 3, &g);
        CLOSE(br_gci_limited(&g, cases[i].formal),
              cases[i].safety * (value[2] - value[1]) / value[2] / (pow(2, cases[i].order) - 1),
              1e-12);
        assert_true(br_gci_is_far(&g, cases[i].formal) == (cases[i].safety > 2));
    }
    /* by hand, of 1 + h^3 at h = 0.4, 0.2, 0.1: 3 (0.007/1.001)/7, 1.25 of it, and 3 of it over 3
     */
    find_gci((const double[]){.4, .2, .1}, (const double[]){1.064, 1.008, 1.001}, 3, &g);
    CLOSE(br_gci_limited(&g, 4), 0.002997002997003, 1e-12);
    CLOSE(br_gci_limited(&g, 3), 0.001248751248751, 1e-12);
    CLOSE(br_gci_limited(&g, 2), 0.006993006993007, 1e-12);
    find_gci(h, (const double[]){1, 2, 4}, 3, &g);
    IS_NAN(br_gci_limited(&g, 2));
    assert_false(br_gci_is_far(&g, 2));
}

TEST(test_nparc)
{
    static const double h[] = {4, 2, 1}, value[] = {0.96178, 0.96854, 0.97050};
    struct br_gci g;
    find_gci(h, value, 3, &g);
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
        find_gci(h, value, 3, &g);
        CLOSE(g.order, p, 1e-9);
        if (alternates) {
            assert_int_equal(g.sequence,
                             p > 0 ? BR_OSCILLATORY_CONVERGENCE : BR_OSCILLATORY_DIVERGENCE);
            continue;
        }
        const bool slow = fabs(p) < 0.05; /* as log n */
        assert_int_equal(g.sequence, slow    ? BR_SEQUENCE_LOGARITHM
                                     : p > 0 ? BR_MONOTONE_CONVERGENCE
                                             : BR_MONOTONE_DIVERGENCE);
        if (p > 0 && !slow) {
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
        {3, {4, 2, 1}, {1.2, 1.1, 1}, BR_SEQUENCE_LOGARITHM}, /* e21 = e32: p = 0 */
        /* 1 + h converges, though R = 5; 1 + 1/h diverges, though R = 0.11 */
        {3, {1, 10.0 / 11, 5.0 / 11}, {2, 21.0 / 11, 16.0 / 11}, BR_MONOTONE_CONVERGENCE},
        {3, {10, 1, 10.0 / 11}, {1.1, 2, 2.1}, BR_MONOTONE_DIVERGENCE},
        /* only the three finest count */
        {5, {16, 8, 4, 2, 1}, {1, 9, 1.4, 1.1, 1}, BR_MONOTONE_CONVERGENCE},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct named *c = &cases[i];
        struct br_gci g;
        find_gci(c->h, c->value, c->count, &g);
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
    find_gci(h, value, 3, &g);
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

/* ---- limits ---- */

static struct br_grid_limit limit_of(const double *h, const double *value, size_t count)
{
    struct br_point line[MOST];
    struct br_grid_limit limit;
    for (size_t i = 0; i < count; i++)
        line[i] = (struct br_point){.z = h[i], .value = value[i]};
    MUST(br_limit_of_values(line, count, &limit, &err));
    return limit;
}

TEST(test_sequence_kinds)
{
    static const struct named cases[] = {
        {4, {8, 4, 2, 1}, {9, 5, 3, 2}, BR_MONOTONE_CONVERGENCE},
        {4, {8, 4, 2, 1}, {1, 2, 4, 8}, BR_MONOTONE_DIVERGENCE},
        {5, {16, 8, 4, 2, 1}, {2, 0.75, 1.0625, 0.984375, 1.00390625}, BR_OSCILLATORY_CONVERGENCE},
        {5, {16, 8, 4, 2, 1}, {1.00390625, 0.984375, 1.0625, 0.75, 2}, BR_OSCILLATORY_DIVERGENCE},
        {6, {32, 16, 8, 4, 2, 1}, {32, 18, 13, 29, 24, 11}, BR_SEQUENCE_UNKNOWN},
        {5, {16, 8, 4, 2, 1}, {1, 2, 3, 4, 5}, BR_SEQUENCE_LOGARITHM},
        {3, {4, 2, 1}, {1, 2, 3}, BR_SEQUENCE_LOGARITHM},
        {4, {8, 4, 2, 1}, {3, 3, 3, 3}, BR_SEQUENCE_CONSTANT},
        {4, {8, 4, 2, 1}, {0, 0, 0, 0}, BR_SEQUENCE_CONSTANT},
        {3, {4, 2, 1}, {1, 1.1, 1.5}, BR_MONOTONE_DIVERGENCE},
        {3, {4, 2, 1}, {3, 3, 3}, BR_SEQUENCE_CONSTANT},
        {3, {4, 2, 1}, {2, 3, 3}, BR_SEQUENCE_UNKNOWN},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct named *c = &cases[i];
        const bool constant = c->sequence == BR_SEQUENCE_CONSTANT;
        const struct br_grid_limit limit = limit_of(c->h, c->value, c->count);
        if (limit.sequence != c->sequence)
            fail_msg("case %zu is %s, expected %s (p = %g)", i, br_sequence_text(limit.sequence),
                     br_sequence_text(c->sequence), limit.order);
        const bool none = c->sequence == BR_SEQUENCE_UNKNOWN ||
                          c->sequence == BR_SEQUENCE_LOGARITHM ||
                          strstr(br_sequence_text(c->sequence), "divergence");
        assert_int_equal(isnan(limit.value.value), none);
        assert_int_equal(isnan(limit.value.low), none || constant);
        assert_int_equal(isnan(limit.value.high), none || constant);
    }
}

/* What is left where values begin to stay lies ahead, in the direction of their last change: the
 * same whether they fall or rise. */
TEST(test_values_that_stay)
{
    static const double h[] = {16, 8, 4, 2, 1}, falling[] = {1.1, 1.05, 1.02, 1.02, 1.02};
    double ahead[2], back[2];
    for (int rises = 0; rises < 2; rises++) {
        double value[5];
        for (size_t i = 0; i < 5; i++)
            value[i] = rises ? -falling[i] : falling[i];
        const struct br_grid_limit limit = limit_of(h, value, 5);
        assert_int_equal(limit.sequence, BR_MONOTONE_CONVERGENCE);
        CLOSE(limit.value.value, value[4], 0);
        ahead[rises] = rises ? limit.value.high - value[4] : value[4] - limit.value.low;
        back[rises] = rises ? value[4] - limit.value.low : limit.value.high - value[4];
    }
    if (!(ahead[0] >= 0.03)) /* the last change */
        fail_msg("%g is left, expected at least 0.03", ahead[0]);
    CLOSE(ahead[1], ahead[0], 1e-12);
    CLOSE(back[0], 0.003, 1e-12); /* two changes may have passed the limit, by a tenth */
    CLOSE(back[1], 0.003, 1e-12);
}

/* A small power converges; the inverse of a logarithm, or of its square, does, too, and no table
 * shows where to. */
TEST(test_small_orders)
{
    enum { ROWS = 7 };
    double h[ROWS], power[ROWS], inverse[ROWS], size[ROWS], square[ROWS];
    for (int i = 0; i < ROWS; i++) {
        h[i] = ldexp(0.125, -i);
        power[i] = 1 + 0.5 * pow(h[i], 0.2);
        inverse[i] = 1 - 0.1 / log(h[i]);
        size[i] = ldexp(0.1, -i);
        square[i] = 1 + 0.1 / pow(log(size[i]), 2);
    }
    const struct br_grid_limit limit = limit_of(h, power, ROWS), none = limit_of(h, inverse, ROWS),
                               no_square = limit_of(size, square, ROWS);
    assert_int_equal(limit.sequence, BR_MONOTONE_CONVERGENCE);
    assert_true(limit.value.low <= 1 && 1 <= limit.value.high);
    assert_int_equal(none.sequence, BR_SEQUENCE_UNKNOWN);
    IS_NAN(none.value.value);
    assert_int_equal(no_square.sequence, BR_SEQUENCE_UNKNOWN);
    IS_NAN(no_square.value.value);
}

/* The limit is in its interval, which is far narrower than Richardson's distance. One bad coarse
 * value changes nothing. */
TEST(test_exact_laws)
{
    static const double orders[] = {0.5, 0.8, 1, 1.3, 2, 3};
    static const double h[] = {1, 0.7, 0.4, 0.3, 0.2, 0.15};
    for (size_t i = 0; i < sizeof orders / sizeof *orders; i++)
        for (int bad = 0; bad < 2; bad++) {
            double value[6];
            for (size_t j = 0; j < 6; j++)
                value[j] = 1000 - 3 * pow(h[j], orders[i]);
            value[0] += bad ? 7 : 0;
            const struct br_grid_limit l = limit_of(h, value, 6);
            const double distance = 3 * pow(0.15, orders[i]);
            assert_int_equal(l.sequence, BR_MONOTONE_CONVERGENCE);
            CLOSE(l.order, orders[i], 0.02);
            CLOSE(l.value.value, 1000, 0.05 * distance);
            assert_true(l.value.low <= 1000 && 1000 <= l.value.high);
            AT_MOST(l.value.high - l.value.low, 0.5 * distance);
        }
}

/* The values of which one answer said "order 2.0000" and "no limit"; and rounded ones, whose
 * interval is not narrower than half a unit of the last digit: of three values, and of many that
 * end within their last digit. */
TEST(test_one_answer)
{
    static const double h[] = {1, .5, .25, .125, .0625},
                        value[] = {.95, 1.225, 1.05625, 1.0140625, 1.003515625};
    const struct br_grid_limit l = limit_of(h, value, 5);
    assert_int_equal(l.sequence, BR_MONOTONE_CONVERGENCE);
    CLOSE(l.order, 2, 0.02);
    CLOSE(l.value.value, 1, 1e-4);
    assert_true(l.value.low <= 1 && 1 <= l.value.high);
    struct br_point rounded[] = {{.z = 1, .value = .0752, .rounding = 5e-5},
                                 {.z = .1, .value = .0791, .rounding = 5e-5},
                                 {.z = .01, .value = .0792, .rounding = 5e-5}};
    struct br_grid_limit r;
    MUST(br_limit_of_values(rounded, 3, &r, &err));
    AT_MOST(r.value.low, .07915);
    AT_MOST(.07925, r.value.high);
    static const double many[] = {-1.8491408, -2.4306829, -2.4712922, -2.474128,
                                  -2.474326,  -2.4743399, -2.4743408, -2.4743409};
    static const double tends_to = -2.4743409008; /* + 0.6252 (4 h)^3.84 */
    struct br_point line[8];
    for (size_t i = 0; i < 8; i++)
        line[i] = (struct br_point){.z = ldexp(1, -(int)i), .value = many[i], .rounding = 5e-8};
    MUST(br_limit_of_values(line, 8, &r, &err));
    assert_true(r.value.low <= tends_to && tends_to <= r.value.high);
    AT_MOST(r.value.high - r.value.low, 1e-6);
}

/* Other units of size and value: the same limit. */
TEST(test_units)
{
    static const double h[] = {1, 0.6, 0.3, 0.2, 0.1}, value[] = {3.1, 2.2, 1.45, 1.3, 1.11};
    static const double scales[] = {1e-150, -1, 1e150};
    const struct br_grid_limit one = limit_of(h, value, 5);
    const double width = one.value.high - one.value.low;
    for (int i = 0; i < 3; i++) {
        double finer[5], scaled[5];
        for (size_t j = 0; j < 5; j++) {
            finer[j] = 1e-9 * h[j];
            scaled[j] = scales[i] * value[j];
        }
        const struct br_grid_limit other = limit_of(finer, scaled, 5);
        CLOSE(other.value.value / scales[i], one.value.value, 0.01 * width);
        CLOSE(fabs((other.value.high - other.value.low) / scales[i]), width, 0.02 * width);
    }
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
        for (size_t j = 0; j < count; j++) {
            h[j] = finest * pow(1.5, (double)(count - 1 - j));
            value[j] = 1 + h[j] * (a + h[j] * (b + h[j] * c));
        }
        const struct br_grid_limit limit = limit_of(h, value, count);
        told += isfinite(limit.value.low);
        right += limit.value.low <= 1 && limit.value.high >= 1;
    }
    print_message("# %zu grids to h = %g: %d told, %d right\n", count, finest, told, right);
    return (double)right / told;
}

/* The interval promises 95 %; also where the first term does not dominate. */
TEST(test_coverage)
{
    for (size_t count = 3; count < 7; count++) {
        AT_MOST(0.93, coverage(count, 0.01));
        AT_MOST(0.88, coverage(count, 0.1)); /* 95 %, less two deviations of so few */
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
        for (size_t count = 3; count < 7; count += br_test_long() ? 1 : 3) {
            size_t scatter = 0, diverges = 0, stated = 0, right = 0;
            for (int trial = 0; trial < TRIALS; trial++) {
                struct br_point line[6];
                OWNED(br_limits) limits;
                for (size_t i = 0; i < count; i++) {
                    double sum = -6; /* of deviation 1 */
                    for (int j = 0; j < 12; j++)
                        sum += br_test_uniform(&random, 0, 1);
                    const double h = ldexp(1, -(int)i);
                    line[i] = (struct br_point){
                        .z = h, .value = 1 + slopes[s] * h + 0.05 * sum, .half = 1.96 * 0.05};
                }
                MUST(br_limits_find(line, count, &limits, &err));
                const struct br_grid_limit *l = &limits.limit;
                scatter += l->sequence == BR_SEQUENCE_SCATTER;
                diverges += l->sequence == BR_MONOTONE_DIVERGENCE ||
                            l->sequence == BR_OSCILLATORY_DIVERGENCE;
                stated += isfinite(l->value.low) ? 1 : 0;
                right += l->value.low <= 1 && 1 <= l->value.high;
                for (size_t i = 0; i < limits.triples; i++)
                    if (fabs(line[i + 2].value - line[i + 1].value) <=
                        hypot(line[i + 1].half, line[i + 2].half))
                        IS_NAN(limits.triple[i].fine.index);
            }
            assert_true(s < 2 ? (double)scatter > 0.96 * TRIALS : (double)scatter < 0.02 * TRIALS);
            if (!((double)diverges < 0.02 * TRIALS && (double)stated > 0.94 * TRIALS))
                fail_msg("%zu values, slope %g: %zu diverge, %zu stated, %zu scatter", count,
                         slopes[s], diverges, stated, scatter);
            if (!((double)right >= 0.91 * (double)stated))
                fail_msg("%zu values, slope %g: %zu of %zu intervals hold the limit", count,
                         slopes[s], right, stated);
        }
}

/* The half width of one mean by hand. Of 15, 7, 3, 1 only the first three hold the coarsest; the
 * others are of order 1, and go to -1. */
TEST(test_scatter_of_the_coarsest)
{
    static const struct br_point line[] = {{.z = 8, .value = 15, .half = 10},
                                           {.z = 4, .value = 7, .half = 0.1},
                                           {.z = 2, .value = 3, .half = 0.1},
                                           {.z = 1, .value = 1, .half = 0.1}};
    OWNED(br_limits) limits;
    MUST(br_limits_find(line, 4, &limits, &err));
    assert_int_equal(limits.triples, 2);
    assert_int_equal(limits.triple[0].sequence, BR_SEQUENCE_UNKNOWN);
    assert_int_equal(limits.triple[1].sequence, BR_MONOTONE_CONVERGENCE);
    CLOSE(limits.triple[1].order, 1, 1e-13);
    CLOSE(limits.triple[1].fine.limit, -1, 1e-12);
}

static enum br_status attempt(const void *data, struct br_error *why)
{
    OWNED(br_limits) limits;
    const enum br_status status = br_limits_find(data, 5, &limits, why);
    return status;
}

TEST(test_without_memory)
{
    static const struct br_point line[] = {{.z = 16, .value = 2},
                                           {.z = 8, .value = 1.25},
                                           {.z = 4, .value = 1.0625},
                                           {.z = 2, .value = 1.015625},
                                           {.z = 1, .value = 1.00390625}};
    br_test_without_memory(attempt, line, 5);
}

/* By hand, of a value 10: over h 9 [8.5, 10.2] is left, which changes by 0.1 to the next k, over
 * k 10.5 [10, 11.5], which changes by 0.3 to the next h. So 10 - 1 + 0.5, and 1.2 + 1 + 0.3 around
 * it. */
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
    CLOSE(found.value.low, 7, 1e-12);
    CLOSE(found.value.high, 12, 1e-12);
    along[1].limit.value.value = NAN;
    assert_true(isnan(br_limit_of_grid(10, along).value.value));
}
