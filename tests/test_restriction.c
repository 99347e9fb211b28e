/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The projection of a Legendre series on elements against its definition: integrals over each
 * element by Gauss's rule, in long double. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/exact/inside.h"
#include "tests/support.h"

enum { MOST_LENGTH = 160, MOST_POINTS = 160, MOST_LOCAL = 20 };

/* p_k(x), k < count, orthonormal on [0, 1], by the recurrence of the usual ones. */
static void legendre(size_t count, long double x, long double *p)
{
    const long double y = 2 * x - 1;
    long double before = 0, here = 1;
    for (size_t k = 0; k < count; k++) {
        const long double n = (long double)k;
        p[k] = sqrtl(2 * n + 1) * here;
        const long double next = ((2 * n + 1) * y * here - n * before) / (n + 1);
        before = here;
        here = next;
    }
}

/* Gauss's points and weights on [0, 1]: Newton's method from Tricomi's guess. */
static void gauss(size_t points, long double *x, long double *weight)
{
    const long double n = (long double)points;
    for (size_t i = 0; i < points; i++) {
        long double p[MOST_POINTS + 1], slope = 0;
        x[i] = (1 - cosl(acosl(-1) * ((long double)i + 0.75L) / (n + 0.5L))) / 2;
        for (int step = 0; step < 20; step++) {
            const long double y = 2 * x[i] - 1;
            legendre(points + 1, x[i], p);
            const long double here = p[points] / sqrtl(2 * n + 1),
                              before = p[points - 1] / sqrtl(2 * n - 1);
            slope = n * (y * here - before) / (y * y - 1);
            x[i] -= here / slope / 2;
        }
        const long double y = 2 * x[i] - 1;
        weight[i] = 1 / ((1 - y * y) * slope * slope);
    }
}

/* A series on all of a beam, and the elements that it is projected on. */
struct shape {
    size_t length;
    struct br_exact_mesh mesh;
    double beam; /* m */
};

static struct br_piecewise *project(const struct shape *s, struct br_store *store)
{
    struct br_piecewise *out = NULL;
    struct br_spectral_elements *spectral = br_store_take(store, 1, sizeof *spectral);
    assert_non_null(spectral);
    br_spectral_init(spectral, s->beam, 1, (const double[]){0, s->beam}, &s->length, store);
    MUST(br_piecewise_create(&out, spectral, 0, &s->mesh, store, &err));
    return out;
}

/* How far an application is from the definition. */
struct deviation {
    long double norm;             /* of the series */
    long double values;           /* L2 norm of the error of c */
    long double rest, rest_error; /* roots: what is right, the error */
};

static struct deviation deviation_of(const struct shape *s, const double *series, const double *c,
                                     double rest)
{
    static long double x[MOST_POINTS], weight[MOST_POINTS], p[MOST_POINTS][MOST_LOCAL];
    const size_t kept = s->mesh.degree + 1;
    const size_t points = s->length < 30 || s->mesh.elements < 50 ? s->length + 2 : 40;
    struct deviation d = {0};
    long double all = 0;
    assert_true(points <= MOST_POINTS);
    gauss(points, x, weight);
    for (size_t i = 0; i < points; i++)
        legendre(MOST_LOCAL, x[i], p[i]);
    const long double root_h = sqrtl((long double)s->beam / (long double)s->mesh.elements);
    for (size_t e = 0; e < s->mesh.elements; e++) {
        long double local[MOST_LOCAL] = {0}, value[MOST_POINTS], square = 0, left = 0;
        for (size_t i = 0; i < points; i++) {
            long double global[MOST_LENGTH];
            legendre(s->length, ((long double)e + x[i]) / (long double)s->mesh.elements, global);
            value[i] = 0;
            for (size_t k = 0; k < s->length; k++)
                value[i] += root_h * series[k] * global[k];
            for (size_t l = 0; l < kept; l++)
                local[l] += weight[i] * value[i] * p[i][l];
            square += weight[i] * value[i] * value[i];
        }
        for (size_t i = 0; i < points; i++) {
            long double difference = value[i];
            for (size_t l = 0; l < kept; l++)
                difference -= local[l] * p[i][l];
            left += weight[i] * difference * difference;
        }
        for (size_t l = 0; l < kept; l++) {
            const long double error = c[e * kept + l] - local[l];
            d.values += error * error;
        }
        all += square;
        d.rest += left;
    }
    d.norm = sqrtl(all);
    d.values = sqrtl(d.values);
    d.rest = sqrtl(d.rest);
    d.rest_error = fabsl(sqrtl(rest) - d.rest);
    return d;
}

static void check(const struct shape *shape, const double *series)
{
    OWNED(br_store) store = {0};
    const size_t values = shape->mesh.elements * (shape->mesh.degree + 1);
    double *c = calloc(values, sizeof *c), rest = NAN;
    assert_non_null(c);
    for (size_t i = 0; i < values; i++)
        c[i] = NAN;
    br_piecewise_apply(project(shape, &store), series, c, &rest);
    const struct deviation d = deviation_of(shape, series, c, rest);
    const double slack = br_test_slack();
    AT_MOST((double)(d.values / d.norm), 1e-15 * slack);
    /* What is left out is right in its own size, down to the long doubles' own round-off. */
    AT_MOST((double)((d.rest_error - 3e-18L * d.norm * (long double)slack) / (d.rest + 1e-300L)),
            1e-13 * slack);
    free(c);
}

/* Terms of one size, and a smooth function, of which only some count. */
static void check_all(const struct shape *shape)
{
    for (int smooth = 0; smooth < 2; smooth++) {
        double series[MOST_LENGTH];
        struct br_test_random random = {shape->length + 17};
        for (size_t k = 0; k < shape->length; k++)
            series[k] = br_test_uniform(&random, -1, 1) * (smooth ? pow(0.1, (double)k) : 1);
        check(shape, series);
    }
}

/* Also elements that do not fill groups, and series of all lengths. */
TEST(test_definition)
{
    static const size_t elements[] = {1, 7, 100, 3200, 12800};
    static const struct shape rows[] = {
        {20, {3203, 3}, 1}, {19, {997, 1}, 1},  {1, {13, 3}, 1},  {2, {640, 1}, 1},
        {3, {13, 3}, 1},    {5, {640, 1}, 1},   {60, {13, 3}, 1}, {60, {640, 1}, 1},
        {150, {13, 3}, 1},  {150, {640, 1}, 1},
    };
    const size_t count = br_test_quick() ? 3 : sizeof elements / sizeof *elements;
    for (size_t i = 0; i < 4 * count; i++)
        check_all(&(struct shape){21, {elements[i / 4], i % 4}, 2.25});
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        check_all(&rows[i]);
}

/* A polynomial of the elements' degree leaves nothing out, and the zero series nothing at all; of
 * what is not finite, nothing is lost. */
TEST(test_nothing_left)
{
    enum { LENGTH = 25, ELEMENTS = 3200 };
    static double c[ELEMENTS * 4];
    for (size_t degree = 0; degree <= 3; degree++) {
        const struct shape shape = {LENGTH, {ELEMENTS, degree}, 1};
        OWNED(br_store) store = {0};
        struct br_piecewise *r = project(&shape, &store);
        double series[LENGTH] = {0}, rest = NAN;
        br_piecewise_apply(r, series, c, &rest);
        assert_true(rest == 0);
        for (size_t i = 0; i < ELEMENTS * (degree + 1); i++)
            assert_true(c[i] == 0);
        for (size_t k = 0; k <= degree; k++)
            series[k] = 1;
        br_piecewise_apply(r, series, c, &rest);
        assert_true(rest == 0);
        for (size_t k = 0; k < LENGTH; k++) {
            double bad[LENGTH] = {1};
            bad[k] = NAN;
            br_piecewise_apply(r, bad, c, &rest);
            assert_true(isnan(rest) && isnan(c[0]));
        }
    }
}

TEST(test_combiners)
{
    enum { ROWS = 7, COUNT = 9, MOST = 111 };
    struct br_test_random random = {3};
    double factor[ROWS * COUNT], table[COUNT * MOST], sum[ROWS * MOST], expected[ROWS * MOST];
    for (size_t i = 0; i < ROWS * COUNT; i++)
        factor[i] = br_test_uniform(&random, -1, 1);
    for (size_t i = 0; i < COUNT * MOST; i++)
        table[i] = br_test_uniform(&random, -1, 1);
    for (size_t width = 1; width <= MOST; width++) {
        for (size_t j = 0; j < ROWS * width; j++) {
            double value = 0;
            for (size_t k = 0; k < COUNT; k++) {
                const double product = factor[j / width * COUNT + k] * table[k * width + j % width];
                value += product;
            }
            expected[j] = value;
        }
        for (size_t i = br_instruction_set_best(); br_combiners[i]; i++) {
            memset(sum, 0, sizeof sum);
            br_combiners[i]->combine(ROWS, COUNT, factor, width, table, sum);
            assert_memory_equal(sum, expected, ROWS * width * sizeof *sum);
        }
    }
}

/* Sums of any length. */
TEST(test_sums)
{
    struct br_test_random random = {7};
    double a[40] = {0}, b[40] = {0};
    for (size_t count = 0; count <= 40; count++) {
        long double products = 0, squares = 0, weighted = 0;
        for (size_t i = 0; i < count; i++) {
            a[i] = br_test_uniform(&random, -1, 1);
            b[i] = br_test_uniform(&random, -1, 1);
            products += (long double)a[i] * b[i];
            squares += (long double)b[i] * b[i];
            weighted += (long double)a[i] * b[i] * a[i] * b[i];
        }
        CLOSE(br_sum_products(count, a, b), (double)products, 1e-14);
        CLOSE(br_norm(count, NULL, b), (double)sqrtl(squares), 1e-14);
        CLOSE(br_norm(count, a, b), (double)sqrtl(weighted), 1e-14);
    }
}

/* ---- the stages' equations ---- */

enum { S = BR_STAGES, MODES = 3 * BR_STAGE_LANES };

/* y = X x, where (a + b X + X^2) x = r, by the elimination of Gauss and Jordan with the largest
 * pivots. */
static void solve_stages(const struct br_radau *radau, double a, double b, const double r[S],
                         long double y[S])
{
    long double m[S][S + 1];
    for (size_t k = 0; k < S; k++) {
        for (size_t l = 0; l < S; l++) {
            m[k][l] = (k == l ? (long double)a : 0) + (long double)b * radau->integral[k][l];
            for (size_t i = 0; i < S; i++)
                m[k][l] += (long double)radau->integral[k][i] * radau->integral[i][l];
        }
        m[k][S] = r[k];
    }
    for (size_t k = 0; k < S; k++) {
        size_t largest = k;
        for (size_t l = k; l < S; l++)
            largest = fabsl(m[l][k]) > fabsl(m[largest][k]) ? l : largest;
        for (size_t i = 0; i <= S; i++) {
            const long double swap = m[k][i];
            m[k][i] = m[largest][i];
            m[largest][i] = swap;
        }
        for (size_t l = 0; l < S; l++)
            for (size_t i = S + 1; i-- > k && l != k;)
                m[l][i] -= m[l][k] / m[k][k] * m[k][i];
    }
    for (size_t k = 0; k < S; k++) {
        y[k] = 0;
        for (size_t l = 0; l < S; l++)
            y[k] += radau->integral[k][l] * m[l][S] / m[l][l];
    }
}

static void check_stages(const struct br_radau *radau, const struct br_stage_system *system,
                         size_t first, const double *r, const double *y)
{
    for (size_t i = 0; i < MODES; i++) {
        double column[S];
        long double expected[S], size = 0;
        for (size_t k = 0; k < S; k++)
            column[k] = k < first ? 0 : r[k * MODES + i];
        solve_stages(radau, system->a[i], system->b, column, expected);
        for (size_t k = 0; k < S; k++)
            size = fmaxl(size, fabsl(expected[k]));
        for (size_t k = first; k < S; k++)
            AT_MOST((double)(fabsl(y[k * MODES + i] - expected[k]) / size), 1e-14);
    }
}

/* From free waves to those that resist all motion, damped or not; modes of all frequencies at once:
 * each instruction set gives the same bits. */
TEST(test_stages)
{
    struct br_test_random random = {5};
    struct br_radau radau;
    double a[MODES], pivot[2 * S * MODES], r[S * MODES], y[S * MODES], portable[S * MODES];
    struct br_stage_system system = {.width = MODES, .a = a, .pivot = pivot};
    MUST(br_radau_init(&radau, &err));
    for (size_t round = 0; round < 100; round++) {
        const size_t first = round % S;
        system.b = round % 3 ? br_test_log_uniform(&random, 1e-8, 1e8) : 0;
        for (size_t i = 0; i < MODES; i++)
            a[i] = br_test_log_uniform(&random, 1e-12, 1e12);
        for (size_t i = 0; i < S * MODES; i++)
            r[i] = br_test_uniform(&random, -1, 1);
        br_stage_factor(&system, &radau);
        memcpy(portable, r, sizeof r);
        br_combiner_portable.solve(&system, first, portable);
        check_stages(&radau, &system, first, r, portable);
        for (size_t i = br_instruction_set_best(); br_combiners[i]; i++) {
            memcpy(y, r, sizeof r);
            br_combiners[i]->solve(&system, first, y);
            assert_memory_equal(y, portable, sizeof y);
        }
    }
}
