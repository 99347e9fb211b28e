/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where an error comes from: the parts add up, each goes as its source does, and what is not there
 * is none. */
#include <math.h>
#include <string.h>

#include "solver/linear/linear_solver.h"
#include "solver/scene.h"
#include "study/grid/sweep.h"
#include "study/trade/split.h"
#include "support.h"

static struct br_split split_of(const struct br_scene *scene, size_t n, size_t steps,
                                struct br_method method)
{
    struct br_split split = {
        .scene = scene,
        .method = method,
        .at = {n, steps},
        .norm = {&br_norm_l2, &br_norm_energy, &br_norm_tip},
        .norms = 3,
    };
    MUST(br_split_run(&split, 2, NULL, &err));
    return split;
}

static const struct br_share *share_of(const struct br_split *split, const char *name)
{
    for (size_t i = 0; i < BR_SOURCES; i++)
        if (strcmp(split->share[i].name, name) == 0)
            return &split->share[i];
    fail_msg("there is no part called %s", name);
    return NULL;
}

/* No norm of one function of the chain is above the sum of all others': the whole's and the
 * parts' alike. */
static void check_triangle(const struct br_split *split, size_t m, enum br_part part)
{
    const double whole = split->whole.error[m][part];
    double slack = split->whole.floor[m][part], sum = whole;
    for (size_t i = 0; i < BR_SOURCES; i++) {
        slack += split->share[i].floor[m][part];
        sum += split->share[i].error[m][part];
    }
    AT_MOST(whole, sum - whole + slack);
    for (size_t i = 0; i < BR_SOURCES; i++)
        AT_MOST(split->share[i].error[m][part], sum - split->share[i].error[m][part] + slack);
    CLOSE(split->sum.error[m][part], sum - whole, 1e-14 * sum);
}

/* Signed at the tip: exactly the whole, but for the rounding of the sums. */
static void check_tip(const struct br_split *split, enum br_field_kind kind)
{
    double sum = 0;
    for (size_t i = 0; i < BR_SOURCES; i++)
        sum += split->share[i].tip[kind];
    const double round_off = 1e-15 * (fabs(split->tip[kind]) + fabs(split->solution_tip[kind]));
    CLOSE(sum, split->tip[kind] - split->solution_tip[kind], round_off);
    CLOSE(split->whole.tip[kind], split->tip[kind] - split->solution_tip[kind], round_off);
    CLOSE(split->sum.tip[kind], sum, round_off);
}

static void check_sums(const struct br_split *split)
{
    for (size_t m = 0; m < split->norms; m++)
        for (enum br_part part = 0; part < BR_PARTS; part++)
            check_triangle(split, m, part);
    check_tip(split, BR_AXIAL);
    check_tip(split, BR_BENDING);
}

TEST(test_sums)
{
    static const char *const scenes[] = {"example1", "example2", "reversal"};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        OWNED(br_scene) scene = br_test_bundled(scenes[i]);
        const char *friction = scene.friction.regularisation > 0 ? "regularised" : NULL;
        struct br_split split = split_of(&scene, 20, 50, br_test_method("umfpack", NULL, friction));
        check_sums(&split);
        split = split_of(&scene, 20, 50, br_test_method(NULL, "implicit", NULL));
        check_sums(&split);
    }
}

/* The parts against marches that this test makes itself. */
TEST(test_links)
{
    OWNED(br_scene) scene = br_test_bundled("example2");
    scene.friction.regularisation = 1e-3;
    const struct br_method given = br_test_method("umfpack", "lagged", "regularised");
    const struct br_method riccati = br_test_method("riccati", "lagged", "regularised");
    const struct br_method exact = br_test_method("riccati", "lagged", "exact");
    const struct br_method implicit = br_test_method("riccati", "implicit", "exact");
    const struct br_split split = split_of(&scene, 30, 40, given);
    const struct br_test_end end[] = {
        br_test_run(&scene, 30, 40, &given), br_test_run(&scene, 30, 40, &riccati),
        br_test_run(&scene, 30, 40, &exact), br_test_run(&scene, 30, 40, &implicit)};
    static const char *const names[] = {"round-off", "mu", "lag"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const struct br_share *share = share_of(&split, names[i]);
        assert_null(share->none);
        assert_true(share->tip[BR_AXIAL] == end[i].u_tip - end[i + 1].u_tip);
        assert_true(share->tip[BR_BENDING] == end[i].w_tip - end[i + 1].w_tip);
    }
    const struct br_share *time = share_of(&split, "time"), *space = share_of(&split, "space");
    CLOSE(time->tip[BR_BENDING] + space->tip[BR_BENDING],
          end[3].w_tip - split.solution_tip[BR_BENDING], 1e-15);
    assert_true(split.tip[BR_BENDING] == end[0].w_tip);
}

/* A part that needs no refined march has a floor of twice the difference of two solvers' marches of
 * the run: its own round-off may be as large as that, and so may that of the march beside it. */
TEST(test_floor_of_two_marches)
{
    OWNED(br_scene) scene = br_test_bundled("example2");
    const struct br_split split = split_of(&scene, 50, 100, br_method_default());
    struct br_study study =
        br_test_study(&scene, &br_reference_fine, 1, &split.at.n, 1, &split.at.steps);
    study.norm = split.norm[0];
    study.method = study.reference_method = split.method;
    study.method.solver = br_linear_solver_find("plain");
    study.reference_method.solver = br_linear_solver_find("riccati");
    study.reference = split.at;
    MUST(br_study_run(&study, 1, 1, NULL, &err));
    for (int part = 0; part < BR_PARTS; part++) {
        const double distinct = study.cell[0].error[part];
        assert_true(distinct > 0);
        CLOSE(share_of(&split, "lag")->floor[0][part], 2 * distinct, 1e-9 * distinct);
    }
    br_study_clear(&study);
}

/* The whole is what a study says of the run; what is at the round-off is below the floor, and what
 * is not is above it. */
TEST(test_whole)
{
    OWNED(br_scene) scene = br_test_bundled("example2");
    const struct br_split split = split_of(&scene, 50, 100, br_method_default());
    for (size_t m = 0; m < split.norms; m++) {
        struct br_study study =
            br_test_study(&scene, &br_reference_exact, 1, &split.at.n, 1, &split.at.steps);
        study.norm = split.norm[m];
        study.method = split.method;
        MUST(br_study_run(&study, 1, 1, NULL, &err));
        for (int part = 0; part < BR_PARTS; part++)
            assert_true(split.whole.error[m][part] == study.cell[0].error[part]);
        assert_true(split.scale[m] == study.reference_scale);
        br_study_clear(&study);
    }
    assert_true(br_share_known(share_of(&split, "space"), 0, BR_PART_TOTAL));
    assert_true(br_share_known(share_of(&split, "lag"), 0, BR_PART_TOTAL));
    AT_MOST(share_of(&split, "lag")->floor[0][BR_PART_TOTAL], 1e-13);
    AT_MOST(share_of(&split, "time")->floor[0][BR_PART_TOTAL], 1e-9);
    AT_MOST(share_of(&split, "space")->floor[0][BR_PART_TOTAL], 1e-9);
    struct br_share share = {.error = {{NAN}}, .floor = {{1e-15}}};
    assert_false(br_share_known(&share, 0, BR_PART_TOTAL));
    share.error[0][0] = 1e-15;
    assert_false(br_share_known(&share, 0, BR_PART_TOTAL));
}

static void check_none(const struct br_split *split, const char *name, const char *why)
{
    const struct br_share *share = share_of(split, name);
    assert_non_null(share->none);
    assert_non_null(strstr(share->none, why));
    for (size_t m = 0; m < split->norms; m++)
        for (int part = 0; part < BR_PARTS; part++)
            assert_true(share->error[m][part] == 0);
    assert_true(share->tip[BR_AXIAL] == 0 && share->tip[BR_BENDING] == 0);
}

/* What is not there is none; and one source alone moves its part, and no other. */
TEST(test_none)
{
    struct br_scene scene = br_test_bundled("example2");
    struct br_split split = split_of(&scene, 10, 20, br_test_method(NULL, "implicit", NULL));
    check_none(&split, "round-off", "auto");
    check_none(&split, "iteration", "directly");
    check_none(&split, "mu", "not smoothed");
    check_none(&split, "lag", "implicit");
    const struct br_split lagged = split_of(&scene, 10, 20, br_test_method(NULL, "lagged", NULL));
    assert_null(share_of(&lagged, "lag")->none);
    for (int part = 0; part < BR_PARTS; part++) {
        assert_true(share_of(&lagged, "time")->error[0][part] ==
                    share_of(&split, "time")->error[0][part]);
        assert_true(share_of(&lagged, "space")->error[0][part] ==
                    share_of(&split, "space")->error[0][part]);
    }
    br_scene_clear(&scene);
    scene = br_test_bundled("vibration"); /* no contact, no friction */
    split = split_of(&scene, 10, 50, br_method_default());
    check_none(&split, "lag", "no contact");
    check_none(&split, "mu", "no friction");
    check_none(&split, "iteration", "no friction");
    check_sums(&split);
    br_scene_clear(&scene);
}

enum { SIZES = 3 };

/* Orders of parts, over resolutions each the double of the one before. In Example 2 the lag is of
 * order k and, at the end, the start's transients gone, what the time steps leave beside it. A tip
 * that sticks creeps where friction is smoothed, in proportion to mu. */
static const struct {
    const char *scene, *scheme, *contact, *friction;
    size_t n, steps;
    enum { IN_SPACE, IN_TIME, IN_MU } over;
    const char *name;
    enum br_part part;
    double order, tolerance;
} orders[] = {
    {"example2", "euler", "lagged", "exact", 8, 50, IN_SPACE, "space", BR_PART_AXIAL, 2, 0.02},
    {"example2", "euler", "lagged", "exact", 8, 50, IN_SPACE, "space", BR_PART_BENDING, 4, 0.1},
    {"vibration", "euler", "implicit", "exact", 8, 1000, IN_TIME, "time", BR_PARTS, 1, 0.06},
    {"vibration", "bdf2", "implicit", "exact", 8, 1000, IN_TIME, "time", BR_PARTS, 2, 0.06},
    {"example2", "euler", "lagged", "exact", 16, 100, IN_TIME, "lag", BR_PART_TOTAL, 1, 0.05},
    {"example1", "euler", NULL, "regularised", 20, 50, IN_MU, "mu", BR_PART_BENDING, 1, 0.02},
};

static void check_order(size_t row, double coarse, double fine)
{
    const double found = log2(coarse / fine);
    if (!(fabs(found - orders[row].order) <= orders[row].tolerance))
        fail_msg("%s of %s: order %g, expected %g +- %g", orders[row].name, orders[row].scene,
                 found, orders[row].order, orders[row].tolerance);
}

TEST(test_orders)
{
    for (size_t i = 0; i < sizeof orders / sizeof *orders; i++) {
        OWNED(br_scene) scene = br_test_bundled(orders[i].scene);
        struct br_method method = br_test_method(NULL, orders[i].contact, orders[i].friction);
        struct br_split split[SIZES];
        method.scheme = br_time_scheme_find(orders[i].scheme);
        for (size_t j = 0; j < SIZES; j++) {
            if (orders[i].over == IN_MU)
                scene.friction.regularisation = 1e-4 / (1 << j);
            split[j] =
                split_of(&scene, orders[i].n * (orders[i].over == IN_SPACE ? 1u << j : 1),
                         orders[i].steps * (orders[i].over == IN_TIME ? 1u << j : 1), method);
            check_sums(&split[j]);
            const struct br_share *fine = share_of(&split[j], orders[i].name);
            assert_true(orders[i].over != IN_MU || br_share_known(fine, 0, BR_PART_BENDING));
            for (int part = 0; part < BR_PARTS && j > 0; part++)
                if (orders[i].part == BR_PARTS || (int)orders[i].part == part)
                    check_order(i, share_of(&split[j - 1], orders[i].name)->error[0][part],
                                fine->error[0][part]);
            for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && j > 0; kind++)
                if (strcmp(orders[i].name, "lag") == 0)
                    check_order(i, fabs(share_of(&split[j - 1], "time")->tip[kind]),
                                fabs(share_of(&split[j], "time")->tip[kind]));
        }
    }
}

/* A tip that sticks creeps by what an iteration leaves: the less, the smaller its tolerance. */
TEST(test_iteration)
{
    OWNED(br_scene) scene = br_test_bundled("example1");
    for (const struct br_friction_rule *const *r = br_friction_rules; *r; r++) {
        double last = INFINITY;
        for (double tolerance = 1e-6; (*r)->iterates && tolerance > 1e-9; tolerance /= 100) {
            struct br_method method = br_test_method(NULL, NULL, (*r)->name);
            method.iteration.tolerance = tolerance;
            const struct br_split split = split_of(&scene, 20, 50, method);
            const struct br_share *share = share_of(&split, "iteration");
            assert_null(share->none);
            AT_MOST(share->error[0][BR_PART_BENDING], last / 5);
            assert_true(br_share_known(share, 0, BR_PART_BENDING));
            check_sums(&split);
            last = share->error[0][BR_PART_BENDING];
        }
    }
}

TEST(test_refused)
{
    struct br_scene scene = br_test_bundled("example1");
    struct br_split split = {
        .scene = &scene,
        .method = br_test_method(NULL, "lagged", NULL),
        .at = {0, 50},
        .norm = {&br_norm_l2},
        .norms = 1,
    };
    REFUSED(br_split_run(&split, 1, NULL, &err), BR_BAD_INPUT, "at least one element");
    split.at = (struct br_resolution){10, 50};
    br_scene_clear(&scene);
    scene = br_test_bare(); /* no exact solution resolves so short a blow */
    scene.density = 0;
    scene.axial.load = br_test_load("exp(-((t - 0.51)/1e-13)^2)/1e-13");
    REFUSED(br_split_run(&split, 1, NULL, &err), BR_NOT_FINITE, "no exact solution");
    br_scene_clear(&scene);
}
