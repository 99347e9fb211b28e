/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks of real scenes: what is right passes, what is wrong does not, on any number of threads;
 * and what has moved since an earlier check. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study/comparison.h"
#include "study/scene_file.h"
#include "support.h"

/* A small scene of its own: a rod that is pulled, and its expectations. */
struct made {
    struct br_scene scene;
    struct br_verify verify;
    struct br_check check;
};

static void make(struct made *m)
{
    struct br_error err = {0};
    *m = (struct made){.scene = br_test_bare()};
    m->scene.bending.modelled = false;
    m->scene.axial.load = br_test_load("sin(x)*(1 + t)");
    MUST(br_verify_default(&m->scene, &m->verify, &err));
    m->verify.study[BR_VERIFY_JOINT].count = 4; /* the fifth cell costs more than all others */
    m->check = (struct br_check){.path = "made.yaml", .scene = &m->scene, .verify = &m->verify};
}

static void clear(struct made *m)
{
    br_check_clear(&m->check);
    br_verify_clear(&m->verify);
    br_function_free(&m->scene.axial.load.space);
    br_function_free(&m->scene.axial.load.time);
}

static void check(struct made *m, int threads)
{
    struct br_error err = {0};
    br_check_clear(&m->check);
    MUST(br_check_run(&m->check, 1, threads, NULL, &err));
}

static const struct br_case *case_of(const struct made *m, enum br_verify_kind kind)
{
    for (size_t i = 0; i < m->check.count; i++)
        if (m->check.cases[i].kind == kind)
            return &m->check.cases[i];
    fail_msg("no such case");
    return NULL;
}

static void test_sound(void **state)
{
    (void)state;
    struct made m;
    make(&m);
    check(&m, 2);
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
    clear(&m);
}

/* Expectations that do not hold are told so. */
static void test_wrong_expectation(void **state)
{
    (void)state;
    struct made m;
    make(&m);
    m.verify.study[BR_VERIFY_SPACE].expectation[0].order = 3;
    m.verify.study[BR_VERIFY_TIME].expectation[0].ceiling = 1e-12;
    check(&m, 1);
    assert_int_equal(case_of(&m, BR_VERIFY_SPACE)->verdict, BR_FAIL);
    assert_int_equal(case_of(&m, BR_VERIFY_TIME)->verdict, BR_FAIL);
    assert_int_equal(case_of(&m, BR_VERIFY_JOINT)->verdict, BR_PASS);
    assert_int_equal(br_check_tally(&m.check, 1, BR_FAIL), 2);
    assert_int_equal(br_check_tally(&m.check, 1, BR_PASS), 1);
    clear(&m);
}

/* A march that breaks down is a verdict, not an end of the check. */
static void test_failing_march(void **state)
{
    (void)state;
    struct made m;
    make(&m);
    br_function_free(&m.scene.axial.load.space);
    m.scene.axial.load.space = br_test_function("1/(0.5 - t) + x");
    m.verify.study[BR_VERIFY_JOINT].count = 0;
    m.verify.study[BR_VERIFY_JOINT].expectations = 0;
    check(&m, 2);
    assert_int_equal(m.check.count, 2);
    assert_int_equal(br_check_tally(&m.check, 1, BR_FAIL), 2);
    assert_non_null(strstr(m.check.cases[0].reason, "at n = 10 "));
    clear(&m);
}

/* Lagged contact that is stable on four meshes and not on the fifth: the fourth has nothing sound
 * to be compared with. */
static void test_unstable_reference(void **state)
{
    (void)state;
    struct made m;
    make(&m);
    m.scene.duration = 2;
    m.scene.axial.stiffness = 100;
    m.scene.axial.viscosity = 0.001;
    m.scene.contact = (struct br_contact){true, 0.05, 5062.5};
    struct br_verify_study *space = &m.verify.study[BR_VERIFY_SPACE];
    for (size_t i = 0; i < space->count; i++)
        space->steps[i] = 1000;
    m.verify.study[BR_VERIFY_JOINT].count = m.verify.study[BR_VERIFY_JOINT].expectations = 0;
    check(&m, 1);
    const struct br_case *c = case_of(&m, BR_VERIFY_SPACE);
    assert_int_equal(c->point[2].flag, BR_FLAG_NONE);
    assert_int_equal(c->point[3].flag, BR_FLAG_UNSTABLE);
    assert_int_equal(c->verdict, BR_INCONCLUSIVE);
    clear(&m);
}

/* Without a solution to compare with there is nothing to verify. */
static void test_unverifiable(void **state)
{
    (void)state;
    struct made m;
    struct br_error err = {0};
    make(&m);
    m.verify.study[BR_VERIFY_JOINT].line = 33;
    br_function_free(&m.scene.axial.load.space);
    m.scene.axial.load.space = br_test_function("step(x - 0.3)");
    struct made sound;
    make(&sound);
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
    clear(&sound);
    m.scene.friction = (struct br_friction){BR_TRESCA, 1, 0};
    m.scene.bending.modelled = true;
    m.verify.study[BR_VERIFY_SPACE].method.friction = br_friction_rule_find("regularised");
    m.verify.study[BR_VERIFY_SPACE].line = 22;
    MUST(br_check_run(&m.check, 1, 1, NULL, &err));
    assert_non_null(strstr(m.check.failure.message,
                           "made.yaml:22: verify: space: the scene cannot be verified"));
    clear(&m);
}

/* A rod at rest has errors of 0: that is no order. */
static void test_nothing_moves(void **state)
{
    (void)state;
    struct made m;
    make(&m);
    br_function_free(&m.scene.axial.load.space);
    br_function_free(&m.scene.axial.load.time);
    m.scene.axial.load = (struct br_load){0};
    check(&m, 1);
    assert_int_equal(br_check_tally(&m.check, 1, BR_PASS), 0);
    clear(&m);
}

/* A path whose cells share one mesh. */
static void test_one_mesh(void **state)
{
    (void)state;
    struct made m;
    make(&m);
    struct br_verify_study *joint = &m.verify.study[BR_VERIFY_JOINT];
    for (size_t i = 0; i < joint->count; i++)
        joint->n[i] = 640;
    check(&m, 2);
    const struct br_case *c = case_of(&m, BR_VERIFY_JOINT);
    if (c->verdict != BR_PASS)
        fail_msg("%s", c->reason);
    CLOSE(c->order.value, 1, 0.1);
    clear(&m);
}

static bool same_estimate(const struct br_estimate *a, const struct br_estimate *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

/* The same bits on 1 to 8 threads, and the second time. */
static void test_threads(void **state)
{
    (void)state;
    struct br_scene scene;
    struct br_verify verify;
    struct br_error err = {0};
    char path[1024];
    MUST(br_scene_find("example2", path, sizeof path, &err));
    MUST(br_scene_read_verify(path, &scene, &verify, &err));
    struct br_check first = {.path = path, .scene = &scene, .verify = &verify};
    MUST(br_check_run(&first, 1, 1, NULL, &err));
    assert_true(first.count > 0);
    assert_int_equal(br_check_tally(&first, 1, BR_PASS), first.count);
    for (int threads = 1; threads <= (br_test_quick() ? 2 : 8); threads *= 2) {
        struct br_check again = {.path = path, .scene = &scene, .verify = &verify};
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

static void test_override(void **state)
{
    (void)state;
    struct made m;
    make(&m);
    br_check_override(&m.verify, &(struct br_check_method){.contact = br_contact_rules[1]});
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++) {
        assert_ptr_equal(m.verify.study[kind].method.contact, br_contact_rules[1]);
        assert_ptr_equal(m.verify.study[kind].method.solver, br_linear_solvers[0]);
    }
    clear(&m);
}

/* ---- against an earlier check ---- */

/* What the check itself would have left behind. */
static struct br_old_check as_old(const struct made *m)
{
    struct br_old_check old = {.count = m->check.count, .scenes = 1};
    old.cases = br_allocate(old.count + 1, sizeof *old.cases);
    old.costs = br_allocate(1, sizeof *old.costs);
    assert_non_null(old.cases);
    assert_non_null(old.costs);
    old.costs[0] = (struct br_old_cost){"made", m->check.seconds, m->check.element_steps};
    for (size_t i = 0; i < old.count; i++) {
        const struct br_case *c = &m->check.cases[i];
        struct br_old_case *o = &old.cases[i];
        *o = (struct br_old_case){
            .scene = "made",
            .order = c->order.value,
            .constant = c->constant,
            .expected = c->expected.order,
            .tolerance = c->expected.tolerance,
            .floor = c->expected.floor,
            .ceiling = c->expected.ceiling,
            .verdict = c->verdict,
        };
        snprintf(o->study, sizeof o->study, "%s", br_verify_names[c->kind]);
        snprintf(o->norm, sizeof o->norm, "%s", c->expected.norm->name);
        snprintf(o->part, sizeof o->part, "%s", br_part_names[c->expected.part]);
    }
    return old;
}

/* The most serious difference, after a change to the old check. */
static void compare(const struct made *m, const struct br_old_check *old, enum br_severity expected,
                    const char *subject)
{
    struct br_comparison c;
    struct br_error err = {0};
    MUST(br_compare(&m->check, 1, false, old, &c, &err));
    const enum br_severity found = c.count ? c.difference[0].severity : BR_SAME;
    if (found != expected || (c.count && !strstr(c.difference[0].subject, subject)))
        fail_msg("found %s of '%s', expected %s of '%s'", br_severity_names[found],
                 c.count ? c.difference[0].subject : "", br_severity_names[expected], subject);
    for (size_t i = 1; i < c.count; i++)
        assert_true(c.difference[i - 1].severity >= c.difference[i].severity);
    br_comparison_clear(&c);
}

static void test_comparison(void **state)
{
    (void)state;
    struct made m;
    make(&m);
    m.scene.name = (char[]){"made"};
    check(&m, 1);
    struct br_old_check old = as_old(&m);
    compare(&m, &old, BR_SAME, "");
    const struct br_old_case sound = old.cases[0];
    const struct {
        double order, constant;
        enum br_severity severity;
        const char *subject;
    } rows[] = {
        {0.0001, 1, BR_SAME, ""},         {0.01, 1, BR_NOTE, "order"},
        {-0.1, 1, BR_WARNING, "order"},   {0.3, 1, BR_SERIOUS, "order"},
        {NAN, 1, BR_SERIOUS, "order"},    {0, 1.0005, BR_SAME, ""},
        {0, 1.02, BR_NOTE, "constant"},   {0, 1.5, BR_WARNING, "constant"},
        {0, 0.6, BR_WARNING, "constant"}, {0, 2.1, BR_SERIOUS, "constant"},
        {0, NAN, BR_SERIOUS, "constant"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) { /* the tolerance is 0.2 */
        old.cases[0] = sound;
        old.cases[0].order += rows[i].order;
        old.cases[0].constant *= rows[i].constant;
        compare(&m, &old, rows[i].severity, rows[i].subject);
    }
    old.cases[0] = sound;
    old.cases[0].verdict = BR_FAIL;
    compare(&m, &old, BR_NOTE, "verdict");
    old.cases[0] = sound;
    old.cases[0].verdict = BR_FAIL; /* and had no order: that it has one now is no harm */
    old.cases[0].order = old.cases[0].constant = NAN;
    compare(&m, &old, BR_NOTE, "made space l2 axial");
    old.cases[0] = sound;
    old.cases[0].tolerance *= 0.5;
    compare(&m, &old, BR_WARNING, "made space l2 axial: expectation");
    old.cases[0].tolerance *= 4; /* it is narrower now */
    compare(&m, &old, BR_SAME, "");
    old.cases[0] = sound;
    old.cases[0].ceiling = 1; /* there is none now */
    compare(&m, &old, BR_WARNING, "made space l2 axial: expectation");
    old.cases[0] = sound;
    old.costs[0].seconds = NAN;
    compare(&m, &old, BR_SAME, "");
    old.costs[0].seconds = m.check.seconds;
    strcpy(old.cases[0].norm, "tip");
    compare(&m, &old, BR_SERIOUS, "made space tip axial: gone");
    strcpy(old.cases[0].scene, "other"); /* which is not checked now: that is no loss */
    compare(&m, &old, BR_NOTE, "new");
    struct br_comparison all; /* or it is, where these are all there are */
    struct br_error err = {0};
    MUST(br_compare(&m.check, 1, true, &old, &all, &err));
    assert_int_equal(all.difference[0].severity, BR_SERIOUS);
    assert_string_equal(all.difference[0].subject, "other space tip axial: gone");
    br_comparison_clear(&all);
    old.cases[0] = sound;
    old.costs[0].element_steps *= 2;
    compare(&m, &old, BR_WARNING, "made: ");
    old.costs[0].element_steps /= 2;
    old.costs[0].seconds /= 10;
    compare(&m, &old, BR_WARNING, "made: ns per element-step");
    br_old_check_clear(&old);
    clear(&m);
}

/* What a comparison needs of the names. */
static void test_names(void **state)
{
    (void)state;
    struct made m;
    struct br_error err = {0};
    make(&m);
    m.scene.name = (char[]){"m\xe4"
                            "de"};
    check(&m, 1);
    struct br_old_check old = as_old(&m);
    REFUSED(br_compare_check(&m.check, 1, &old, &err), BR_BAD_INPUT, "none of these scenes");
    strcpy(old.costs[0].scene, "m?de"); /* as JSON has it */
    for (size_t i = 0; i < old.count; i++)
        strcpy(old.cases[i].scene, "m?de");
    MUST(br_compare_check(&m.check, 1, &old, &err));
    compare(&m, &old, BR_SAME, "");
    const struct br_check twice[] = {m.check, m.check};
    REFUSED(br_compare_check(twice, 2, &old, &err), BR_BAD_INPUT, "two scenes are called");
    br_old_check_clear(&old);
    clear(&m);
}

static void test_worse_verdict(void **state)
{
    (void)state;
    struct made m;
    make(&m);
    m.scene.name = (char[]){"made"};
    m.verify.study[BR_VERIFY_SPACE].expectation[0].ceiling = 1e-12;
    check(&m, 1);
    struct br_old_check old = as_old(&m);
    old.cases[0].verdict = BR_PASS;
    compare(&m, &old, BR_SERIOUS, "made space l2 axial: verdict");
    br_old_check_clear(&old);
    clear(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sound),         cmocka_unit_test(test_wrong_expectation),
        cmocka_unit_test(test_failing_march), cmocka_unit_test(test_unverifiable),
        cmocka_unit_test(test_nothing_moves), cmocka_unit_test(test_one_mesh),
        cmocka_unit_test(test_threads),       cmocka_unit_test(test_override),
        cmocka_unit_test(test_names),         cmocka_unit_test(test_unstable_reference),
        cmocka_unit_test(test_comparison),    cmocka_unit_test(test_worse_verdict),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
