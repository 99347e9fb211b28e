/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of the exact reference: Legendre series, Radau's tables, modes. */
#include <math.h>
#include <string.h>

#include "reference/exact/field.h"
#include "reference/exact/legendre.h"
#include "reference/exact/pieces.h"
#include "tests/exact_scenes.h"

enum { S = BR_STAGES };

/* 3 x^2 - 2 x + 1, its integral x^3 - x^2 + x and its derivative 6 x - 2. */
TEST(test_legendre)
{
    double c[] = {1, 2 / sqrt(3) / 4, 1 / sqrt(5) / 2, 0};
    for (double x = 0; x <= 1; x += 0.125) {
        double p[4], dp[4], both[4], q[4], value = 0, rate = 0, integral = 0, series = 0;
        double d[] = {c[0], c[1], c[2], 0};
        br_legendre_derivative(3, x, p, dp);
        br_legendre_integral(3, x, both, q);
        for (size_t k = 0; k < 3; k++) {
            value += c[k] * p[k];
            rate += c[k] * dp[k];
            integral += c[k] * q[k];
        }
        br_legendre_integrate(3, d);
        br_legendre(4, x, p);
        for (size_t k = 0; k < 4; k++)
            series += d[k] * p[k];
        for (size_t k = 0; k < 3; k++)
            assert_near(both[k], p[k], 2e-15);
        assert_near(value, 3 * x * x - 2 * x + 1, 1e-15);
        assert_near(rate, 6 * x - 2, 1e-14);
        assert_near(integral, x * x * x - x * x + x, 1e-15);
        assert_near(series, x * x * x - x * x + x, 1e-15);
    }
}

/* What stands in tables is what the formulas give, bit by bit. */
TEST(test_legendre_tables)
{
    double p[40];
    br_legendre(40, 1, p); /* P_k(1) = 1 */
    for (size_t k = 0; k < 40; k++) {
        const double n = (double)k;
        assert_true(p[k] == sqrt(2 * n + 1));
        assert_true(k == 0 || br_legendre_coupling(k) == 0.5 / sqrt(4 * n * n - 1));
    }
}

/* As many as there may be, against the longer way. */
TEST(test_legendre_integrals)
{
    for (double x = 0; x <= 1; x += 1.0 / 64) {
        double p[BR_MOST_INTEGRALS + 1], both[BR_MOST_INTEGRALS], q[BR_MOST_INTEGRALS];
        br_legendre(BR_MOST_INTEGRALS + 1, x, p);
        br_legendre_integral(BR_MOST_INTEGRALS, x, both, q);
        for (size_t k = 0; k < BR_MOST_INTEGRALS; k++) {
            double c[BR_MOST_INTEGRALS + 1] = {0}, sum = 0;
            c[k] = 1;
            br_legendre_integrate(BR_MOST_INTEGRALS, c);
            for (size_t l = 0; l <= BR_MOST_INTEGRALS; l++)
                sum += c[l] * p[l];
            assert_near(both[k], p[k], 2e-14);
            assert_near(q[k], sum, 2e-15);
        }
    }
}

/* Collocation: X integrates each p_k right at the nodes, and fit() undoes p_k. */
TEST(test_radau_tables)
{
    struct br_radau r;
    assert_int_equal(br_radau_init(&r, NULL), BR_OK);
    double value[S][S], fitted[S];
    for (size_t j = 0; j < S; j++)
        br_legendre(S, r.node[j], value[j]);
    for (size_t k = 0; k < S; k++) {
        double samples[S];
        for (size_t j = 0; j < S; j++) {
            double p[S], exact[S], sum = 0;
            br_legendre_integral(S, r.node[j], p, exact);
            for (size_t l = 0; l < S; l++)
                sum += value[j][l] * r.integral[l][k];
            assert_near(sum, exact[k], 1e-15);
            samples[j] = value[j][k];
        }
        br_radau_fit(&r, samples, fitted);
        for (size_t l = 0; l < S; l++)
            assert_near(fitted[l], l == k, 1e-14);
    }
    assert_near(r.node[S - 1], 1, 0);
}

/* y' = z y, one step from 1: the series solves v = z (1 + X v), by iteration. */
static double step_end(const struct br_radau *r, double z)
{
    double v[S] = {0};
    for (int round = 0; round < 200; round++) {
        double next[S];
        for (size_t k = 0; k < S; k++)
            next[k] = z * ((k == 0) + br_radau_sum(r->integral[k], v));
        memcpy(v, next, sizeof v);
    }
    return 1 + v[0];
}

/* Radau IIA of s stages is the Pade approximant of e^z of degrees s - 1 and s. */
TEST(test_radau_stability)
{
    struct br_radau r;
    assert_int_equal(br_radau_init(&r, NULL), BR_OK);
    for (double z = -3; z <= 6; z += 1.5) {
        double top = 0, bottom = 0, a = 1, b = 1;
        for (int i = 0; i <= S; i++) {
            top += a;
            bottom += b;
            a *= z * (S - 1 - i) / ((2 * S - 1 - i) * (i + 1.0));
            b *= -z * (S - i) / ((2 * S - 1 - i) * (i + 1.0));
        }
        assert_near(step_end(&r, z) / (top / bottom), 1, 1e-12);
    }
}

static void modes_of(size_t count, double length, size_t degree, struct br_modes *modes,
                     struct br_store *store)
{
    *modes = (struct br_modes){0};
    br_pieces_init(&modes->pieces, length, 1, (const double[]){0, length}, &count, store);
    assert_int_equal(br_modes_init(modes, degree, store, NULL), BR_OK);
}

/* Frequencies of rods and beams: s_i = 1 / ((i - 1/2) pi), and 1 / beta_i^2. */
TEST(test_modes)
{
    const double beta[] = {1.875104068711961166445, 4.694091132974174576436,
                           7.854757438237612564861, 10.99554073487546699067};
    struct br_store store = {0};
    struct br_modes rod, beam;
    modes_of(30, 1, 1, &rod, &store);
    modes_of(30, 1, 2, &beam, &store);
    for (size_t i = 0; i < 4; i++) {
        assert_near(rod.size[i], 1 / (((double)i + 0.5) * acos(-1)), 1e-15);
        assert_near(beam.size[i], 1 / (beta[i] * beta[i]), 1e-15);
        /* unit energy: sqrt(2) s_i sin(x / s_i), and 2 s_i for a cantilever */
        assert_near(fabs(rod.tip[i]), sqrt(2) * rod.size[i], 1e-14);
        assert_near(fabs(beam.tip[i]), 2 * beam.size[i], 1e-14);
    }
    br_store_clear(&store);
}

/* Projections of a function that the modes can represent, (2 xi)^2. */
static void check_projections(size_t m)
{
    struct br_store store = {0};
    struct br_modes beam;
    modes_of(m, 2, 2, &beam, &store);
    struct formula square = {f_power, {1, 2}}, slope = {f_power, {2, 1}};
    const struct br_function w = formula_function(&square), dw = formula_function(&slope);
    const double expected[] = {4.0 / 3, 4 / sqrt(12), 4 / sqrt(180)};
    double q[256], c[258];
    assert_true(m <= sizeof q / sizeof *q);
    assert_int_equal(br_modes_project_energy(&beam, &dw, 2, q, NULL), BR_OK);
    br_modes_expand(&beam, 0, q, c);
    for (size_t k = 0; k < m + 2; k++)
        assert_near(c[k], k < 3 ? expected[k] : 0, 1e-12);
    assert_int_equal(br_modes_project(&beam, &w, q, NULL), BR_OK);
    br_modes_expand(&beam, 0, q, c);
    for (size_t k = 0; k < m + 2; k++)
        assert_near(c[k], k < 3 ? expected[k] : 0, 1e-12);
    br_store_clear(&store);
}

TEST(test_projections)
{
    check_projections(10);
    check_projections(150);
}

/* ---- a beam of 2.5 m in three pieces, and x^2 on it ---- */

enum { TERMS = 4, PIECES = 3, MOST = PIECES * (TERMS + 1) };
static const double beam = 2.5;

/* Its series, c; cut at a front or not, it is the same. */
static void project_square(struct br_pieces *pieces, size_t fronts, struct br_store *store,
                           double c[MOST])
{
    static const double end[] = {0, 0.4, 1.7, 2.5};
    struct br_interval front[] = {{1.1, 1.1}};
    const struct br_breaks breaks = {.at = front, .count = fronts};
    static const size_t terms[] = {TERMS, TERMS, TERMS};
    struct formula square = {f_power, {1, 2}};
    struct br_error err;
    struct br_quadrature q;
    br_pieces_init(pieces, beam, PIECES, end, terms, store);
    br_quadrature_init(&q, pieces, 0, store);
    assert_false(store->failed);
    const struct br_function f = formula_function(&square);
    assert_int_equal(br_quadrature_project(&q, &f, 0, &breaks, c, &err), BR_OK);
}

static double squares(size_t count, const double *c)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += c[i] * c[i];
    return sum;
}

/* int x^4 d(x/L) = L^4 / 5; with F = x^3 / (3 L), int F^2 d(x/L) = L^4 / 63. */
TEST(test_pieces)
{
    for (size_t fronts = 0; fronts < 2; fronts++) {
        struct br_store store = {0};
        struct br_pieces pieces;
        double c[MOST];
        project_square(&pieces, fronts, &store, c);
        assert_near(squares(PIECES * TERMS, c), pow(beam, 4) / 5, 1e-13);
        assert_near(br_pieces_integral(&pieces, 0, c), beam * beam / 3, 1e-13);
        br_pieces_integrate(&pieces, 0, c);
        assert_near(squares(MOST, c), pow(beam, 4) / 63, 1e-13);
        assert_near(br_pieces_integral(&pieces, 1, c), beam * beam / 12, 1e-13);
        br_store_clear(&store);
    }
}

/* On elements that do not meet the pieces' ends, parabolas are x^2, and lines leave something out;
 * the squares of both add up to int x^4 dx = L^5 / 5. */
TEST(test_projected_pieces)
{
    for (size_t degree = 1; degree <= 2; degree++)
        for (size_t n = 1; n <= 20; n++) {
            const struct br_exact_mesh mesh = {n, degree};
            struct br_store store = {0};
            struct br_pieces pieces;
            struct br_piecewise *w;
            struct br_error err;
            double c[MOST], modes[20 * 3] = {0}, rest = NAN;
            project_square(&pieces, 0, &store, c);
            assert_int_equal(br_piecewise_create(&w, &pieces, 0, &mesh, &store, &err), BR_OK);
            br_piecewise_apply(w, c, modes, &rest);
            const double all = pow(beam, 5) / 5, h = beam / (double)n;
            assert_near(squares(n * (degree + 1), modes) + rest, all, 1e-12);
            /* of x^2 the second Legendre polynomial has h^2 / 6, its square h / 5 */
            assert_near(rest, degree == 2 ? 0 : (double)n * pow(h, 5) / 180, 1e-12);
            br_store_clear(&store);
        }
}
