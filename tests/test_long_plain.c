/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `plain` in long double, against quadruple precision in another form (stiffness): in every scheme
 * of equal steps, and on fine meshes by golden values. */
#include <math.h>
#include <string.h>

#include "dense_march.h"
#include "solver/linear/linear_solver.h"
#include "solver/scene.h"
#include "support.h"

enum { N = 40, STEPS = 24 };

static struct br_method long_method(const struct br_time_scheme *scheme, const char *contact)
{
    struct br_method method = br_test_method(NULL, contact, "exact");
    method.solver = &br_long_plain;
    method.scheme = scheme;
    return method;
}

TEST(test_golden)
{
    struct br_test_golden rows[BR_TEST_MOST_GOLDEN];
    const size_t count = br_test_golden(rows), most = br_test_quick() ? 0 : 3200;
    size_t checked = 0;
    for (size_t i = 0; i < count; i++) {
        if (rows[i].n > most)
            continue;
        struct br_scene scene = br_test_bundled(rows[i].scene);
        const struct br_method method = long_method(br_time_schemes[0], "lagged");
        const struct br_test_end end = br_test_run(&scene, rows[i].n, rows[i].steps, &method);
        /* exp(t) - 1 is a double here; and friction that holds a tip is one, too: it creeps */
        const bool sticks = strcmp(rows[i].scene, "example1") == 0;
        AT_MOST(br_test_deviation(&end, &rows[i].end), (sticks ? 1e-12 : 1e-14) * br_test_slack());
        br_scene_clear(&scene);
        checked++;
    }
    assert_true(checked == 4 || br_test_quick());
}

/* Both fields, laws and degrees: what is left is the rounding of loads, tip forces and results. */
static void check_scheme(const char *name, const struct br_time_scheme *scheme, int degree)
{
    struct br_scene scene = br_test_bundled(name);
    struct br_method method = long_method(scheme, "implicit");
    method.axial_degree = degree;
    struct br_march *march = br_test_march(&scene, N, STEPS, &method);
    struct dense_march *dense = dense_follow(march, &scene, &method);
    br_test_advance(march, STEPS);
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && dense; kind++)
        AT_MOST(dense_deviation(dense, kind, 0), 2e-14 * br_test_slack());
    dense_free(dense);
    br_march_free(march);
    br_scene_clear(&scene);
}

TEST(test_schemes)
{
    static const char *const scenes[] = {"example2", "example4"};
    for (size_t i = 0; i < 2; i++)
        for (size_t j = 0; br_time_schemes[j]; j++)
            for (int degree = 1; degree <= 2 && !br_time_schemes[j]->adaptive; degree++)
                check_scheme(scenes[i], br_time_schemes[j], degree);
}
