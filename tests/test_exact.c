/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whole marches against values that were computed in other ways: in closed form, and in quadruple
 * precision (generate_discrete.c); and `plain` in long double, by which round-off is measured, step
 * by step. Orders in time: 'check --all'; steps in double: test_extreme_marches. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "dense_march.h"
#include "solver/linear/linear_solver.h"
#include "solver/scene.h"
#include "support.h"

/* The scheme as printed against the golden values on meshes of at most `most` elements, to a limit
 * that depends on the scene, or (NULL) within the round-off that the solver predicts for itself. */
static void check_golden(const struct br_linear_solver *solver, size_t most,
                         double (*limit)(const char *scene))
{
    struct br_test_golden rows[BR_TEST_MOST_GOLDEN];
    const size_t count = br_test_golden(rows);
    struct br_method method = br_test_method(NULL, "lagged", "exact");
    method.solver = solver;
    assert_true(count >= 6);
    for (size_t i = 0; i < count; i++) {
        if (rows[i].n > (br_test_quick() ? 400 : most))
            continue;
        OWNED(br_scene) scene = br_test_bundled(rows[i].scene);
        OWNED(br_march) *march = br_test_march(&scene, rows[i].n, rows[i].steps, &method);
        const double predicted = br_march_round_off(march);
        const struct br_test_end end = br_test_run(&scene, rows[i].n, rows[i].steps, &method);
        AT_MOST(br_test_deviation(&end, &rows[i].end),
                limit ? limit(rows[i].scene) * br_test_slack() : predicted);
    }
}

static double of_riccati(const char *scene)
{
    (void)scene;
    return 1e-11;
}

/* exp(t) - 1 is a double in long double, too; and so is friction that holds a tip: it creeps. */
static double of_long_double(const char *scene)
{
    return strcmp(scene, "example1") == 0 ? 1e-12 : 1e-14;
}

TEST(test_golden)
{
    check_golden(&br_riccati, SIZE_MAX, of_riccati);
    for (const struct br_linear_solver *const *s = br_linear_solvers + 1; *s; s++)
        check_golden(*s, br_test_long() ? SIZE_MAX : 3200, NULL);
    if (!br_test_quick())
        check_golden(&br_long_plain, 3200, of_long_double);
}

/* By the scheme in long double, on both fields, laws and degrees: what is left is the rounding of
 * loads, tip forces and results. */
static void check_scheme(const char *name, const struct br_time_scheme *scheme, int degree)
{
    enum { N = 40, STEPS = 24 };
    OWNED(br_scene) scene = br_test_bundled(name);
    struct br_method method = br_test_method(NULL, "implicit", "exact");
    method.solver = &br_long_plain;
    method.scheme = scheme;
    method.axial_degree = degree;
    OWNED(br_march) *march = br_test_march(&scene, N, STEPS, &method);
    struct dense_march *dense = dense_follow(march, &scene, &method);
    br_test_advance(march, STEPS);
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && dense; kind++)
        AT_MOST(dense_deviation(dense, kind, 0), 2e-14 * br_test_slack());
    dense_free(dense);
}

TEST(test_long_schemes)
{
    static const char *const scenes[] = {"example2", "example4"};
    for (size_t i = 0; i < 2; i++)
        for (size_t j = 0; br_time_schemes[j]; j++)
            for (int degree = 1; degree <= 2 && !br_time_schemes[j]->adaptive; degree++)
                check_scheme(scenes[i], br_time_schemes[j], degree);
}

/* u(1) and w(1) of Example 2 on other meshes and with other steps. */
TEST(test_other_resolutions)
{
    static const struct {
        size_t n, steps;
        const char *contact;
        double u, w, tolerance; /* NaN: not known; relative */
    } rows[] = {
        {100, 100, "lagged", NAN, -0.07046467, 1e-7},
        {100, 100, "implicit", NAN, -0.07159502, 1e-7},
        {800, 100000, "lagged", NAN, -0.0715938939323, 1e-11},
        {1000000, 100, "lagged", 0.0432626953501273, -0.0704646705265127, 2e-11},
    };
    OWNED(br_scene) scene = br_test_bundled("example2");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (br_test_quick() && rows[i].n * rows[i].steps > 100000)
            continue;
        const struct br_method method = br_test_method("riccati", rows[i].contact, "exact");
        const struct br_test_end end = br_test_run(&scene, rows[i].n, rows[i].steps, &method);
        CLOSE(end.w_tip, rows[i].w, rows[i].tolerance * fabs(rows[i].w));
        if (!isnan(rows[i].u))
            CLOSE(end.u_tip, rows[i].u, rows[i].tolerance * fabs(rows[i].u));
    }
}
