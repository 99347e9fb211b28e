/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Derivatives, refusals, failing allocations, many readers. */
#include <math.h>
#include <pthread.h>
#include <string.h>

#include "solver/function.h"
#include "solver/scene.h"
#include "tests/exact_scenes.h"

/* The derivatives belong together: each is the integral of the next. */
TEST(test_derivatives)
{
    OWNED(br_scene) scene = br_test_bundled("example1");
    struct solved solved = solve(&scene, 1e-10);
    br_exact_at(solved.exact, 0.6, solved.state);
    const double x = 0.4, h = 1e-3;
    for (unsigned field = 0; field < 2; field++)
        for (unsigned order = 0; order <= field + 1; order++) {
            struct br_exact_quantity part = {(enum br_field_kind)field, false, order}, next = part;
            next.order++;
            const double difference =
                8 * value_of(&solved, part, x + h) - 8 * value_of(&solved, part, x - h) -
                value_of(&solved, part, x + 2 * h) + value_of(&solved, part, x - 2 * h);
            const double expected = value_of(&solved, next, x);
            assert_near(difference / (12 * h), expected, 1e-8 * (1 + fabs(expected)));
        }
    release(&solved);
}

static void refuses(const struct br_scene *scene, struct br_exact_options options,
                    enum br_status expected, const char *text)
{
    struct br_exact *exact = NULL;
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
    OWNED(br_scene) good = br_test_bundled("example3");
    struct br_scene s = good;
    s.bending.load = (struct br_load){{{formula_function(&bad), {.constant = 1}}}};
    refuses(&s, (struct br_exact_options){0}, BR_NOT_FINITE, "not finite");
    s = (struct br_scene){.length = 1, .duration = 1, .density = 1};
    s.axial = (struct br_scene_field){.modelled = true, .stiffness = 1};
    s.axial.load = (struct br_load){{{formula_function(&bad), {.constant = 1}}}};
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
    s.axial = (struct br_scene_field){.modelled = true, .stiffness = 1};
    s.axial.load =
        (struct br_load){.term[0].space = {.constant = 1}, .term[0].time = {.constant = 1}};
    s.contact = (struct br_contact){true, 0.2, 5};
    refuses(&s, (struct br_exact_options){.max_modes = 60}, BR_NOT_FINITE, "no exact solution");

    struct solved solved = solve(&good, 1e-8);
    struct br_exact_projection *none;
    const struct br_exact_mesh mesh = {4, 3};
    const struct br_exact_quantity axial = {BR_AXIAL, false, 0}, high = {BR_BENDING, false, 3};
    assert_int_equal(br_exact_projection_create(&none, solved.exact, &axial, &mesh, NULL),
                     BR_BAD_INPUT);
    assert_int_equal(br_exact_projection_create(&none, solved.exact, &high, &mesh, NULL),
                     BR_BAD_INPUT);
    release(&solved);
}

/* Shared by those who would get the same one, and by nobody else. */
TEST(test_shared)
{
    struct br_scene scene = br_test_bundled("example2"), same_data = scene;
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
    assert_true(br_exact_report(exact[0], BR_AXIAL).modes >= 18); /* 18 may be cut short */
    br_exact_give_back(exact[0]);
    assert_int_equal(br_exact_borrow(&exact[5], &scene, &modest, NULL), BR_OK);
    assert_true(exact[5] == exact[1]); /* still there for its second user */
    for (size_t i = 1; i < 6; i++)
        br_exact_give_back(exact[i]);
    br_exact_give_back(NULL);
    br_scene_clear(&scene);
}

static enum br_status solve_and_project(const void *scene, struct br_error *why)
{
    const struct br_exact_options options = {.tolerance = 1e-4};
    const struct br_exact_quantity part = {BR_BENDING, false, 0};
    const struct br_exact_mesh mesh = {4, 3};
    struct br_exact *exact = NULL;
    struct br_exact_state *state = NULL;
    struct br_exact_projection *projection = NULL;
    enum br_status status = br_exact_create(&exact, scene, &options, why);
    if (!status)
        status = br_exact_state_create(&state, exact, why);
    if (!status)
        status = br_exact_projection_create(&projection, exact, &part, &mesh, why);
    br_exact_projection_free(projection);
    br_exact_state_free(state);
    br_exact_free(exact);
    return status;
}

TEST(test_allocations)
{
    OWNED(br_scene) scene = br_test_bundled("example2");
    br_test_without_memory(solve_and_project, &scene, 50);
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
    OWNED(br_scene) scene = br_test_bundled("example4");
    struct solved solved = solve(&scene, 1e-8);
    pthread_t thread[4];
    double *sum[4];
    for (size_t i = 0; i < 4; i++)
        assert_int_equal(pthread_create(&thread[i], NULL, read_all, solved.exact), 0);
    for (size_t i = 0; i < 4; i++) {
        void *result;
        pthread_join(thread[i], &result);
        sum[i] = result;
        assert_non_null(sum[i]);
        assert_true(*sum[i] != 0 && *sum[i] == *sum[0]);
    }
    for (size_t i = 0; i < 4; i++)
        free(sum[i]);
    release(&solved);
}
