/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Projections, refusals, failing allocations, many readers. */
#include <gsl/gsl_integration.h>
#include <gsl/gsl_sf_legendre.h>
#include <math.h>
#include <pthread.h>
#include <string.h>

#include "reference/exact/exact.h"
#include "tests/exact_scenes.h"

/* Coefficients and remainder on one element, by plain quadrature. */
static double project_element(const struct br_exact *exact, const struct br_exact_state *state,
                              struct br_exact_part part, const double ends[2], size_t degree,
                              double *c)
{
    gsl_integration_glfixed_table *gauss = gsl_integration_glfixed_table_alloc(32);
    double rest = 0;
    memset(c, 0, (degree + 1) * sizeof *c);
    for (int sweep = 0; sweep < 2; sweep++)
        for (size_t i = 0; i < 32; i++) {
            double x, weight, h = ends[1] - ends[0];
            gsl_integration_glfixed_point(ends[0], ends[1], i, &x, &weight, gauss);
            double value = value_of(exact, state, part, x);
            for (size_t k = 0; k <= degree; k++) {
                const double p = sqrt((2 * (double)k + 1) / h) *
                                 gsl_sf_legendre_Pl((int)k, 2 * (x - ends[0]) / h - 1);
                if (sweep == 0)
                    c[k] += weight * value * p;
                else
                    value -= c[k] * p;
            }
            rest += sweep == 1 ? weight * value * value : 0;
        }
    gsl_integration_glfixed_table_free(gauss);
    return rest;
}

static void check_projection(const struct br_exact *exact, const struct br_exact_state *state,
                             struct br_exact_part part, size_t elements, size_t degree)
{
    struct br_exact_projection *projection = NULL;
    const struct br_exact_mesh mesh = {elements, degree};
    double c[64], rest, expected_rest = 0;
    assert_true(elements * (degree + 1) <= sizeof c / sizeof *c);
    const double scale = sqrt(square_of(exact, state, part) / (double)elements);
    assert_int_equal(br_exact_projection_create(&projection, exact, &part, &mesh, NULL), BR_OK);
    br_exact_projection_apply(projection, state, c, &rest);
    for (size_t e = 0; e < elements; e++) {
        const double ends[] = {(double)e / (double)elements, (double)(e + 1) / (double)elements};
        double expected[64];
        expected_rest += project_element(exact, state, part, ends, degree, expected);
        for (size_t k = 0; k <= degree; k++)
            assert_near(c[e * (degree + 1) + k], expected[k], 1e-13 * scale);
    }
    assert_near(sqrt(rest), sqrt(expected_rest), 1e-7 * sqrt(expected_rest) + 1e-14 * scale);
    assert_true(rest > 0);
    br_exact_projection_free(projection);
}

TEST(test_projection)
{
    const struct br_scene scene = paper_example(4);
    struct br_exact *exact = solve(&scene, 1e-10);
    struct br_exact_state *state = new_state(exact);
    br_exact_at(exact, 2.3, state);
    const struct br_exact_part parts[] = {
        {BR_EXACT_AXIAL, false, 0},   {BR_EXACT_AXIAL, true, 1},   {BR_EXACT_BENDING, false, 0},
        {BR_EXACT_BENDING, false, 1}, {BR_EXACT_BENDING, true, 2},
    };
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        check_projection(exact, state, parts[i], 1, 0);
        check_projection(exact, state, parts[i], 7, 1);
        check_projection(exact, state, parts[i], 30, 1);
    }
    check_projection(exact, state, parts[2], 3, 3);
    check_projection(exact, state, parts[2], 10, 3);
    br_exact_state_free(state);
    br_exact_free(exact);
}

/* The derivatives belong together: each is the integral of the next. */
TEST(test_derivatives)
{
    const struct br_scene scene = paper_example(1);
    struct br_exact *exact = solve(&scene, 1e-10);
    struct br_exact_state *state = new_state(exact);
    br_exact_at(exact, 0.6, state);
    const double x = 0.4, h = 1e-3;
    for (unsigned field = 0; field < 2; field++)
        for (unsigned order = 0; order <= field + 1; order++) {
            struct br_exact_part part = {(enum br_exact_field)field, false, order}, next = part;
            next.order++;
            const double difference =
                8 * value_of(exact, state, part, x + h) - 8 * value_of(exact, state, part, x - h) -
                value_of(exact, state, part, x + 2 * h) + value_of(exact, state, part, x - 2 * h);
            const double expected = value_of(exact, state, next, x);
            assert_near(difference / (12 * h), expected, 1e-8 * (1 + fabs(expected)));
        }
    br_exact_state_free(state);
    br_exact_free(exact);
}

static void refuses(const struct br_scene *scene, struct br_exact_options options,
                    enum br_status expected, const char *text)
{
    struct br_exact *exact = NULL;
    struct br_error err = {0};
    assert_int_equal(br_exact_create(&exact, scene, &options, &err), expected);
    assert_null(exact);
    assert_non_null(strstr(err.message, text));
}

static double f_nan(const double *p, double x, double t)
{
    (void)p, (void)x;
    return t > 0.5 ? NAN : t;
}

TEST(test_refusals)
{
    struct formula bad = {f_nan, {0}};
    const struct br_scene good = paper_example(3);
    struct br_scene s = good;
    s.bending.load = formula_load(1, &bad);
    refuses(&s, (struct br_exact_options){0}, BR_NOT_FINITE, "not finite");
    s = (struct br_scene){.length = 1, .duration = 1, .density = 1};
    s.axial = (struct br_axial){.modelled = true, .stiffness = 1, .load = formula_load(1, &bad)};
    refuses(&s, (struct br_exact_options){0}, BR_NOT_FINITE, "not finite");
    refuses(&good, (struct br_exact_options){.tolerance = 1e-14}, BR_BAD_INPUT, "tolerance");
    refuses(&good, (struct br_exact_options){.tolerance = NAN}, BR_BAD_INPUT, "tolerance");
    refuses(&good, (struct br_exact_options){.max_modes = 2}, BR_BAD_INPUT, "modes");
    refuses(&good, (struct br_exact_options){.max_steps = 30}, BR_NOT_FINITE, "more than 30");
    s = good;
    s.density = s.bending.viscosity = 0;
    refuses(&s, (struct br_exact_options){0}, BR_BAD_INPUT, "viscosity");
    s = good;
    s.bending.viscosity = NAN;
    refuses(&s, (struct br_exact_options){0}, BR_BAD_INPUT, "viscosity");
    /* An undamped rod that hits an obstacle: a kink travels for ever. */
    s = (struct br_scene){.length = 1, .duration = 3, .density = 1};
    s.axial = (struct br_axial){.modelled = true, .stiffness = 1};
    s.axial.load =
        (struct br_load){.term[0].space = {.constant = 1}, .term[0].time = {.constant = 1}};
    s.contact = (struct br_contact){true, 0.2, 5};
    refuses(&s, (struct br_exact_options){.max_modes = 60}, BR_NOT_FINITE, "no exact solution");

    struct br_exact *exact = solve(&good, 1e-8);
    struct br_exact_state *state = new_state(exact);
    const double x = 0.5;
    double value;
    const struct br_exact_part axial = {BR_EXACT_AXIAL, false, 0},
                               high = {BR_EXACT_BENDING, false, 4};
    assert_int_equal(br_exact_evaluate(exact, state, &axial, 1, &x, &value, NULL), BR_BAD_INPUT);
    assert_int_equal(br_exact_evaluate(exact, state, &high, 1, &x, &value, NULL), BR_BAD_INPUT);
    br_exact_state_free(state);
    br_exact_free(exact);
}

/* Shared by those who would get the same one, and by nobody else. */
TEST(test_shared)
{
    const struct br_scene scene = paper_example(2), same_data = scene;
    const struct br_exact_options modest = {.tolerance = 1e-4, .max_modes = 64},
                                  any = {.tolerance = 1e-4},
                                  fine = {.tolerance = 1e-6, .max_modes = 64},
                                  least = {.tolerance = 1e-4, .max_modes = 18};
    const struct br_exact *exact[6];
    assert_int_equal(br_exact_borrow(&exact[0], &scene, &modest, NULL), BR_OK);
    assert_int_equal(br_exact_borrow(&exact[1], &scene, &any, NULL), BR_OK);
    assert_int_equal(br_exact_borrow(&exact[2], &scene, &fine, NULL), BR_OK);
    assert_int_equal(br_exact_borrow(&exact[3], &same_data, &modest, NULL), BR_OK);
    assert_int_equal(br_exact_borrow(&exact[4], &scene, &least, NULL), BR_OK);
    assert_true(exact[1] == exact[0]);
    assert_true(exact[2] != exact[0] && exact[3] != exact[0] && exact[4] != exact[0]);
    assert_true(br_exact_report(exact[0], BR_EXACT_AXIAL).modes >= 18); /* 18 may be cut short */
    br_exact_give_back(exact[0]);
    assert_int_equal(br_exact_borrow(&exact[5], &scene, &modest, NULL), BR_OK);
    assert_true(exact[5] == exact[1]); /* still there for its second user */
    for (size_t i = 1; i < 6; i++)
        br_exact_give_back(exact[i]);
    br_exact_give_back(NULL);
}

/* Every allocation fails once. */
TEST(test_allocations)
{
    const struct br_scene scene = paper_example(2);
    const struct br_exact_options options = {.tolerance = 1e-4};
    const struct br_exact_part part = {BR_EXACT_BENDING, false, 0};
    const struct br_exact_mesh mesh = {4, 3};
    enum br_status status = BR_NO_MEMORY;
    long failures = 0;
    for (; status; failures++) {
        struct br_exact *exact = NULL;
        struct br_exact_state *state = NULL;
        struct br_exact_projection *projection = NULL;
        const double x = 0.5;
        double value;
        br_allocation_fails_at(failures);
        status = br_exact_create(&exact, &scene, &options, NULL);
        if (!status)
            status = br_exact_state_create(&state, exact, NULL);
        if (!status)
            status = br_exact_projection_create(&projection, exact, &part, &mesh, NULL);
        if (!status)
            status = br_exact_evaluate(exact, state, &part, 1, &x, &value, NULL);
        assert_true(status == BR_OK || status == BR_NO_MEMORY);
        br_exact_projection_free(projection);
        br_exact_state_free(state);
        br_exact_free(exact);
    }
    br_allocation_fails_at(-1);
    assert_true(failures > 50);
}

static void *read_all(void *data)
{
    const struct br_exact *exact = data;
    struct br_exact_state *state = NULL;
    double *sum = br_allocate(1, sizeof *sum);
    if (br_exact_state_create(&state, exact, NULL) || !sum)
        return sum;
    for (int n = 0; n <= 2000; n++) {
        br_exact_at(exact, 3.0 * n / 2000, state);
        *sum += state->tip[0].displacement + state->friction_force;
    }
    br_exact_state_free(state);
    return sum;
}

TEST(test_threads)
{
    const struct br_scene scene = paper_example(4);
    struct br_exact *exact = solve(&scene, 1e-8);
    pthread_t thread[4];
    double *sum[4];
    for (size_t i = 0; i < 4; i++)
        assert_int_equal(pthread_create(&thread[i], NULL, read_all, exact), 0);
    for (size_t i = 0; i < 4; i++) {
        void *result;
        pthread_join(thread[i], &result);
        sum[i] = result;
        assert_non_null(sum[i]);
        assert_true(*sum[i] != 0 && *sum[i] == *sum[0]);
    }
    for (size_t i = 0; i < 4; i++)
        free(sum[i]);
    br_exact_free(exact);
}
