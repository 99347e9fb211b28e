/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks of real scenes: what is right passes, what is wrong does not, on any number of threads. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "made_check.h"
#include "study/scene/file.h"
#include "support.h"

static const struct br_case *case_of(const struct made_check *m, enum br_verify_kind kind)
{
    for (size_t i = 0; i < m->check.count; i++)
        if (m->check.cases[i].kind == kind)
            return &m->check.cases[i];
    fail_msg("no such case");
    return NULL;
}

TEST(test_sound)
{
    struct made_check m;
    made_create(&m);
    made_run(&m, 2);
    assert_int_equal(m.check.count, 3);
    for (size_t i = 0; i < m.check.count; i++)
        if (m.check.cases[i].verdict != BR_PASS)
            fail_msg("%s: %s", br_verify_names[m.check.cases[i].kind], m.check.cases[i].reason);
    const struct br_case *space = case_of(&m, BR_VERIFY_SPACE);
    assert_int_equal(space->points, 4);
    CLOSE(space->order.value, 2, 0.01);
    assert_int_equal(space->point[0].at.n, 10);
    assert_int_equal(space->point[0].against.n, 20);
    assert_int_equal(space->point[0].against.steps, space->point[0].at.steps);
    const struct br_case *joint = case_of(&m, BR_VERIFY_JOINT);
    assert_int_equal(joint->points, 4);
    assert_int_equal(joint->point[3].against.n, 0);
    assert_true(m.check.seconds > 0);
    CLOSE(m.check.element_steps, br_check_work(&m.check), 3 * br_check_work(&m.check));
    made_clear(&m);
}

/* Expectations that do not hold are told so. */
TEST(test_wrong_expectation)
{
    struct made_check m;
    made_create(&m);
    m.verify.study[BR_VERIFY_SPACE].expectation[0].order = 3;
    m.verify.study[BR_VERIFY_TIME].expectation[0].ceiling = 1e-12;
    made_run(&m, 1);
    assert_int_equal(case_of(&m, BR_VERIFY_SPACE)->verdict, BR_FAIL);
    assert_int_equal(case_of(&m, BR_VERIFY_TIME)->verdict, BR_FAIL);
    assert_int_equal(case_of(&m, BR_VERIFY_JOINT)->verdict, BR_PASS);
    assert_int_equal(br_check_tally(&m.check, 1, BR_FAIL), 2);
    assert_int_equal(br_check_tally(&m.check, 1, BR_PASS), 1);
    made_clear(&m);
}

/* A march that breaks down is a verdict, not an end of the check. */
TEST(test_failing_march)
{
    struct made_check m;
    made_create(&m);
    br_function_free(&m.scene.axial.load.term[0].space);
    m.scene.axial.load.term[0].space = br_test_function("1/(0.5 - t) + x");
    m.verify.study[BR_VERIFY_JOINT].count = 0;
    m.verify.study[BR_VERIFY_JOINT].expectations = 0;
    made_run(&m, 2);
    assert_int_equal(m.check.count, 2);
    assert_int_equal(br_check_tally(&m.check, 1, BR_FAIL), 2);
    assert_non_null(strstr(m.check.cases[0].reason, "at n = 10 "));
    made_clear(&m);
}

/* Lagged contact that is stable on four meshes and not on the fifth: the fourth has nothing sound
 * to be compared with. */
TEST(test_unstable_reference)
{
    struct made_check m;
    made_create(&m);
    m.scene.duration = 2;
    m.scene.axial.stiffness = 100;
    m.scene.axial.viscosity = 0.001;
    m.scene.contact = (struct br_contact){true, 0, 10400};
    struct br_verify_study *space = &m.verify.study[BR_VERIFY_SPACE];
    for (size_t i = 0; i < space->count; i++)
        space->steps[i] = 1000;
    m.verify.study[BR_VERIFY_JOINT].count = m.verify.study[BR_VERIFY_JOINT].expectations = 0;
    made_run(&m, 1);
    const struct br_case *c = case_of(&m, BR_VERIFY_SPACE);
    assert_int_equal(c->point[2].flag, BR_FLAG_NONE);
    assert_int_equal(c->point[3].flag, BR_FLAG_UNSTABLE);
    assert_int_equal(c->verdict, BR_INCONCLUSIVE);
    made_clear(&m);
}

/* Without a solution to compare with there is nothing to verify. */
TEST(test_unverifiable)
{
    struct made_check m;
    struct br_error err = {0};
    made_create(&m);
    m.verify.study[BR_VERIFY_JOINT].line = 33;
    m.scene.density = m.scene.axial.viscosity = 0; /* the velocity is not determined */
    struct made_check sound;
    made_create(&sound);
    struct br_check both[] = {m.check, sound.check};
    MUST(br_check_run(both, 2, 1, NULL, &err));
    assert_int_equal(both[0].failure.status, BR_BAD_INPUT);
    assert_non_null(strstr(both[0].failure.message,
                           "made.yaml:33: verify: joint: the scene cannot be verified"));
    assert_null(both[0].cases);
    assert_int_equal(br_check_tally(both, 2, BR_PASS), 3); /* the other one's */
    const struct br_check *first;
    assert_int_equal(br_check_failures(both, 2, &first), 1);
    assert_ptr_equal(first, &both[0]);
    br_check_clear(&both[1]);
    made_clear(&sound);
    m.scene.friction = (struct br_friction){BR_TRESCA, 1, 0};
    m.scene.bending.modelled = true;
    m.verify.study[BR_VERIFY_SPACE].method.friction = br_friction_rule_find("regularised");
    m.verify.study[BR_VERIFY_SPACE].line = 22;
    MUST(br_check_run(&m.check, 1, 1, NULL, &err));
    assert_non_null(strstr(m.check.failure.message,
                           "made.yaml:22: verify: space: the scene cannot be verified"));
    made_clear(&m);
}

/* A rod at rest has errors of 0: that is no order. */
TEST(test_nothing_moves)
{
    struct made_check m;
    made_create(&m);
    br_load_clear(&m.scene.axial.load);
    m.scene.axial.load = (struct br_load){0};
    made_run(&m, 1);
    assert_int_equal(br_check_tally(&m.check, 1, BR_PASS), 0);
    made_clear(&m);
}

/* A path whose cells share one mesh. */
TEST(test_one_mesh)
{
    struct made_check m;
    made_create(&m);
    struct br_verify_study *joint = &m.verify.study[BR_VERIFY_JOINT];
    for (size_t i = 0; i < joint->count; i++)
        joint->n[i] = 640;
    made_run(&m, 2);
    const struct br_case *c = case_of(&m, BR_VERIFY_JOINT);
    if (c->verdict != BR_PASS)
        fail_msg("%s", c->reason);
    CLOSE(c->order.value, 1, 0.1);
    made_clear(&m);
}

static bool same_estimate(const struct br_estimate *a, const struct br_estimate *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

/* The same bits on 1 to 8 threads, and the second time. */
TEST(test_threads)
{
    struct br_scene scene;
    struct br_verify verify;
    struct br_error err = {0};
    char path[1024], *text;
    MUST(br_scene_find("example2", path, sizeof path, &err));
    MUST(br_scene_load(path, &text, &err));
    MUST(br_scene_parse(path, text, &(struct br_scene_asked){.verify = &verify}, &scene, &err));
    free(text);
    struct br_check first = {.path = path, .name = scene.name, .scene = &scene, .verify = &verify};
    MUST(br_check_run(&first, 1, 1, NULL, &err));
    assert_true(first.count > 0);
    assert_int_equal(br_check_tally(&first, 1, BR_PASS), first.count);
    for (int threads = 1; threads <= (br_test_quick() ? 2 : 8); threads *= 2) {
        struct br_check again = {
            .path = path, .name = scene.name, .scene = &scene, .verify = &verify};
        MUST(br_check_run(&again, 1, threads, NULL, &err));
        for (size_t i = 0; i < first.count; i++) {
            assert_true(same_estimate(&first.cases[i].order, &again.cases[i].order));
            assert_int_equal(first.cases[i].verdict, again.cases[i].verdict);
        }
        br_check_clear(&again);
    }
    br_check_clear(&first);
    br_verify_clear(&verify);
    br_scene_clear(&scene);
}
