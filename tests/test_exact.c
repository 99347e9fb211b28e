/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whole marches against values that were computed in other ways: in closed form, and in quadruple
 * precision (generate_discrete.c). Orders in time: 'check --all'; steps of either contact rule:
 * test_extreme_marches. */
#include <math.h>
#include <stdio.h>

#include "solver/linear/linear_solver.h"
#include "solver/scene.h"
#include "support.h"

/* The scheme as printed, to 1e-11 by the default solver whatever the mesh. */
TEST(test_golden_riccati)
{
    struct br_test_golden rows[BR_TEST_MOST_GOLDEN];
    const size_t count = br_test_golden(rows);
    const struct br_method method = br_test_method("riccati", "lagged", "exact");
    assert_true(count >= 6);
    for (size_t i = 0; i < count; i++) {
        if (br_test_quick() && rows[i].n > 400)
            continue;
        struct br_scene scene = br_test_bundled(rows[i].scene);
        const struct br_test_end end = br_test_run(&scene, rows[i].n, rows[i].steps, &method);
        AT_MOST(br_test_deviation(&end, &rows[i].end), 1e-11 * br_test_slack());
        br_scene_clear(&scene);
    }
}

/* Every other solver within the round-off that it predicts for itself. */
TEST(test_golden_others)
{
    struct br_test_golden rows[BR_TEST_MOST_GOLDEN];
    const size_t count = br_test_golden(rows);
    for (const struct br_linear_solver *const *s = br_linear_solvers + 1; *s; s++)
        for (size_t i = 0; i < count; i++) {
            if (rows[i].n > (br_test_quick() ? 400 : br_test_long() ? SIZE_MAX : 3200))
                continue;
            struct br_scene scene = br_test_bundled(rows[i].scene);
            struct br_method method = br_test_method((*s)->name, "lagged", "exact");
            struct br_march *march = br_test_march(&scene, rows[i].n, rows[i].steps, &method);
            const double predicted = br_march_round_off(march);
            br_march_free(march);
            const struct br_test_end end = br_test_run(&scene, rows[i].n, rows[i].steps, &method);
            AT_MOST(br_test_deviation(&end, &rows[i].end), predicted);
            br_scene_clear(&scene);
        }
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
    struct br_scene scene = br_test_bundled("example2");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (br_test_quick() && rows[i].n * rows[i].steps > 100000)
            continue;
        const struct br_method method = br_test_method("riccati", rows[i].contact, "exact");
        const struct br_test_end end = br_test_run(&scene, rows[i].n, rows[i].steps, &method);
        CLOSE(end.w_tip, rows[i].w, rows[i].tolerance * fabs(rows[i].w));
        if (!isnan(rows[i].u))
            CLOSE(end.u_tip, rows[i].u, rows[i].tolerance * fabs(rows[i].u));
    }
    br_scene_clear(&scene);
}
