/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of the exact reference: Legendre series, Radau's tables, modes. */
#include <math.h>
#include <string.h>

#include "reference/exact/inside.h"
#include "solver/laws.h"
#include "tests/exact_scenes.h"
#include "tests/support.h"

enum { S = BR_STAGES };

/* 3 x^2 - 2 x + 1, and its integral x^3 - x^2 + x. */
TEST(test_legendre)
{
    double c[] = {1, 2 / sqrt(3) / 4, 1 / sqrt(5) / 2, 0};
    for (double x = 0; x <= 1; x += 0.125) {
        double p[4], both[4], q[4], value = 0, integral = 0, series = 0;
        double d[] = {c[0], c[1], c[2], 0};
        br_legendre(4, x, p);
        br_legendre_integral(3, x, both, q);
        for (size_t k = 0; k < 3; k++) {
            value += c[k] * p[k];
            integral += c[k] * q[k];
        }
        br_legendre_integrate(3, d);
        for (size_t k = 0; k < 4; k++)
            series += d[k] * p[k];
        for (size_t k = 0; k < 3; k++)
            assert_near(both[k], p[k], 2e-15);
        assert_near(value, 3 * x * x - 2 * x + 1, 1e-15);
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

/* The exact reference has its own table of laws: it says of each what the solver says. */
TEST(test_laws_known)
{
    for (enum br_friction_law law = 0; law < BR_FRICTION_LAWS; law++) {
        const struct br_friction f = {.law = law, .coefficient = 1};
        assert_true(br_law_is_known(&f));
        assert_int_equal(br_law_follows(&f), br_friction_follows_contact(&f));
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

/* ---- a beam on one element, and on four, one of which is narrow ---- */

enum { ELEMENTS = 4 };
static const double spectral_end[] = {0, 0.75, 0.75 + 2.5e-8, 1.9, 2.5};
static const size_t spectral_terms[] = {12, 4, 12, 12};

static struct br_spectral_elements new_elements(bool one, struct br_store *store)
{
    struct br_spectral_elements spectral;
    if (one)
        br_spectral_init(&spectral, 1, 1, (const double[]){0, 1}, (const size_t[]){30}, store);
    else
        br_spectral_init(&spectral, 2.5, ELEMENTS, spectral_end, spectral_terms, store);
    assert_false(store->failed);
    return spectral;
}

/* Frequencies of rods and beams: s_i = 1 / ((i - 1/2) pi), and 1 / beta_i^2; and values at the tip
 * of unit energy: sqrt(2) s_i sin(x / s_i), and 2 s_i for a cantilever. */
TEST(test_modes)
{
    const double beta[] = {1.875104068711961166445, 4.694091132974174576436,
                           7.854757438237612564861};
    for (int one = 0; one < 2; one++) {
        OWNED(br_store) store = {0};
        struct br_modes rod = {.spectral = new_elements(one, &store)},
                        beam = {.spectral = rod.spectral};
        assert_int_equal(br_modes_init(&rod, 1, &store, NULL), BR_OK);
        assert_int_equal(br_modes_init(&beam, 2, &store, NULL), BR_OK);
        for (size_t i = 0; i < 3; i++) {
            assert_near(rod.size[i], 1 / (((double)i + 0.5) * acos(-1)), 1e-15);
            assert_near(fabs(rod.tip[i]), sqrt(2) * rod.size[i], 1e-14);
            assert_near(beam.size[i], 1 / (beta[i] * beta[i]), 1e-15);
            assert_near(fabs(beam.tip[i]), 2 * beam.size[i], 1e-14);
        }
    }
}

/* Of the spectral elements, each with one more for the integral. */
enum { LENGTH = 64 };

/* The integral from 0 in x / L of -1 on the spectral elements before `kink` and 1 on the others. */
static void fill_kink(const struct br_spectral_elements *spectral, size_t kink, double *series)
{
    memset(series, 0, LENGTH * sizeof *series);
    for (size_t e = 0; e < ELEMENTS; e++)
        series[br_spectral_at(spectral, e, 0)] =
            (e < kink ? -1 : 1) * sqrt(br_spectral_width(spectral, e));
    br_spectral_integrate(spectral, 0, series);
}

/* |x - a| - a, in x / L, over meshes whose elements the spectral elements' ends cut: its mean over
 * each element, and its square over all. */
TEST(test_projection_of_elements)
{
    static const size_t elements[] = {1, 3, 10, 97};
    OWNED(br_store) store = {0};
    const struct br_spectral_elements spectral = new_elements(false, &store);
    double series[LENGTH];
    fill_kink(&spectral, 3, series);
    const double a = spectral_end[3] / 2.5, b = 1 - a;
    const double square = 2.5 * (a * a * a / 3 + (b * b * b - 3 * a * b * b + 3 * a * a * b) / 3);
    for (size_t i = 0; i < 4; i++) {
        const struct br_exact_mesh mesh = {elements[i], 2};
        const double n = (double)mesh.elements;
        struct br_piecewise *piecewise = NULL;
        double c[3 * 97], rest = NAN, sum = 0;
        MUST(br_piecewise_create(&piecewise, &spectral, 1, &mesh, &store, &err));
        br_piecewise_apply(piecewise, series, c, &rest);
        for (size_t j = 0; j < mesh.elements; j++) {
            const double left = (double)j / n - a, right = ((double)j + 1) / n - a;
            const double integral = (right * fabs(right) - left * fabs(left)) / 2 - a / n;
            assert_near(c[3 * j], integral * sqrt(2.5 * n), 1e-14);
        }
        for (size_t k = 0; k < 3 * mesh.elements; k++)
            sum += c[k] * c[k];
        assert_near(sum + rest, square, 1e-14);
        assert_true(rest > 1e-9); /* no parabola has a kink */
    }
}

/* ---- a beam of 2.5 m in three spectral elements, and x^2 on it ---- */

enum { TERMS = 4, THREE = 3, MOST = THREE * (TERMS + 1) };
static const double beam = 2.5;

/* Its series, c; cut at a front or not, it is the same. */
static void project_square(struct br_spectral_elements *spectral, size_t fronts,
                           struct br_store *store, double c[MOST])
{
    static const double end[] = {0, 0.4, 1.7, 2.5};
    struct br_interval front[] = {{1.1, 1.1}};
    const struct br_breaks breaks = {.at = front, .count = fronts};
    static const size_t terms[] = {TERMS, TERMS, TERMS};
    struct br_quadrature q;
    br_spectral_init(spectral, beam, THREE, end, terms, store);
    br_quadrature_init(&q, spectral, 0, store);
    assert_false(store->failed);
    OWNED(br_function) f = br_test_function("x^2");
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
TEST(test_elements)
{
    for (size_t fronts = 0; fronts < 2; fronts++) {
        OWNED(br_store) store = {0};
        struct br_spectral_elements spectral;
        double c[MOST];
        project_square(&spectral, fronts, &store, c);
        assert_near(squares(THREE * TERMS, c), pow(beam, 4) / 5, 1e-13);
        assert_near(br_spectral_integral(&spectral, 0, c), beam * beam / 3, 1e-13);
        br_spectral_integrate(&spectral, 0, c);
        assert_near(squares(MOST, c), pow(beam, 4) / 63, 1e-13);
        assert_near(br_spectral_integral(&spectral, 1, c), beam * beam / 12, 1e-13);
    }
}
