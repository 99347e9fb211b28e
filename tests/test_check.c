/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks of real scenes: what is right passes, what is wrong does not, on any number of threads;
 * and what has moved since an earlier check, and how serious that is. */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "orders/expectation/comparison.h"
#include "solver/function.h"
#include "solver/scene.h"
#include "study/scene/method_fields.h"
#include "study/verify/check.h"
#include "support.h"

/* A small scene of its own with the default expectations, and its check. */
struct made_check {
    struct br_scene scene;
    struct br_verify verify;
    struct br_check check;
    struct br_scene_check of;
};

/* A rod that is pulled; to be cleared. It may be changed before it is checked. */
static void made_create(struct made_check *m)
{
    *m = (struct made_check){.scene = br_test_bare()};
    m->scene.bending.modelled = false;
    m->scene.axial.load = br_test_load("sin(x)*(1 + t)");
    MUST(br_verify_default(&m->scene, &m->verify, &err));
    m->verify.study[BR_VERIFY_JOINT].count = 4; /* the fifth cell costs more than all others */
    m->of = (struct br_scene_check){.scene = &m->scene, .verify = &m->verify, .check = &m->check};
    MUST(br_scene_check_begin(&m->of, "made.yaml", &err));
    m->check.name = "made";
}

static void made_clear(struct made_check *m)
{
    br_check_clear(&m->check);
    br_scene_check_clear(&m->of);
    br_verify_clear(&m->verify);
    br_load_clear(&m->scene.axial.load);
}

/* Runs the check, again if need be. */
static void made_run(struct made_check *m, int threads)
{
    br_check_clear(&m->check);
    MUST(br_check_run(&m->of, 1, threads, NULL, &err));
}

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
    double work = 0; /* of one field, without pairs and references */
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++)
        for (size_t i = 0; i < m.verify.study[kind].count; i++)
            work += (double)m.verify.study[kind].n[i] * (double)m.verify.study[kind].steps[i];
    CLOSE(m.check.element_steps, work, 3 * work);
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
    assert_non_null(strstr(c->reason, "; expect it of n: 10, 20, 40, 80, 160, 320"));
    made_clear(&m);
}

/* What would settle a verdict is a line for the part `verify` of the scene. */
TEST(test_sizes)
{
    struct made_check m;
    made_create(&m);
    struct br_verify_study *space = &m.verify.study[BR_VERIFY_SPACE];
    m.scene.axial.modelled = false;
    m.scene.bending.modelled = true;
    m.scene.bending.load = br_test_load("sin(x)*(1 + t)");
    br_verify_expect_default(&m.scene, &m.verify);
    m.verify.study[BR_VERIFY_JOINT].count = 4;
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++)
        m.verify.study[kind].expectation[0].band.tolerance = 1e-9;
    for (size_t i = 0; i < space->count; i++) { /* to where errors are round-off */
        space->n[i] = (size_t)16 << 3 * i;
        space->steps[i] = 1;
    }
    made_run(&m, 1);
    static const char *const sizes[BR_VERIFY_KINDS] = {
        "; expect it of n: 2, 16, 128, 1024, 8192, 65536",
        "; expect it of k: 0.001, 0.0005, 0.00025, 0.000125, 6.25e-05, 3.125e-05 s",
        ("; expect it of n: 10, 20, 40, 80, 160 k: 0.01, 0.0025, 0.000625, 0.00015625, "
         "3.90625e-05 s")};
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++) {
        const struct br_case *c = case_of(&m, (enum br_verify_kind)kind);
        if (c->verdict != BR_INCONCLUSIVE || !strstr(c->reason, sizes[kind]))
            fail_msg("%s: %s", br_verdict_names[c->verdict], c->reason);
    }
    br_load_clear(&m.scene.bending.load);
    made_clear(&m);
}

/* The same bits on 1 to 8 threads, and the second time. */
TEST(test_threads)
{
    struct made_check m;
    struct br_estimate first[3];
    made_create(&m);
    for (int threads = 1; threads <= 8; threads *= 2)
        for (size_t time = 0; time < 2; time++) {
            made_run(&m, threads);
            for (size_t i = 0; i < 3; i++) {
                const struct br_case *c = &m.check.cases[i];
                if (threads == 1 && time == 0)
                    first[i] = c->order;
                assert_memory_equal(&first[i], &c->order, sizeof c->order);
                assert_int_equal(c->verdict, BR_PASS);
            }
        }
    made_clear(&m);
}

/* ---- comparisons ---- */

/* A method as a report has it. */
static json_t *as_json(const struct br_settings *settings)
{
    json_t *method = json_object();
    for (const struct br_setting *s = settings->row; s < settings->row + settings->count; s++) {
        json_t *value = !*s->text                      ? json_null()
                        : s->kind == BR_SETTING_NUMBER ? json_real(atof(s->text))
                        : s->kind == BR_SETTING_COUNT  ? json_integer(atoi(s->text))
                                                       : json_string(s->text);
        json_t *in = method;
        if (s->group && !json_is_object(in = json_object_get(method, s->group)))
            json_object_set_new(method, s->group, in = *s->text ? json_object() : json_null());
        if (json_is_object(in))
            json_object_set_new(in, s->key, value);
    }
    return method;
}

/* Replaces the methods of an earlier check. */
static void remember(struct br_old_check *old, enum br_verify_kind kind,
                     const struct br_settings *settings)
{
    json_t *of_first = json_object_get(json_object_get(old->json, "methods"), "0");
    assert_int_equal(json_object_set_new(of_first, br_verify_names[kind], as_json(settings)), 0);
}

/* What the check itself would have left behind, as the earlier check of a scene of that name. */
static struct br_old_check as_old(const struct made_check *m, const char *name)
{
    struct br_old_check old = {.path = "old.json", .count = 1};
    const size_t cases = m->check.count;
    old.check = br_allocate(1, sizeof *old.check);
    old.json = json_pack("{s{s{}}}", "methods", "0");
    struct br_case *copy = br_allocate(cases + 1, sizeof *copy);
    assert_true(old.check && old.json && copy);
    memcpy(copy, m->check.cases, cases * sizeof *copy);
    for (size_t i = 0; i < cases; i++)
        copy[i].point = NULL;
    *old.check = m->check;
    old.check->cases = copy;
    old.check->name = name;
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++)
        remember(&old, (enum br_verify_kind)kind, &m->of.method[kind]);
    return old;
}

/* The most serious difference. */
static void compare(const struct made_check *m, const struct br_old_check *old, bool whole,
                    enum br_severity expected, const char *subject)
{
    OWNED(br_comparison) c;
    MUST(br_compare(&m->check, 1, whole, old, &c, &err));
    const enum br_severity found = c.count ? c.difference[0].severity : BR_SAME;
    if (found != expected || (c.count && !strstr(c.difference[0].subject, subject)))
        fail_msg("found %s of '%s', expected %s of '%s'", br_severity_names[found],
                 c.count ? c.difference[0].subject : "", br_severity_names[expected], subject);
    for (size_t i = 1; i < c.count; i++)
        assert_true(c.difference[i - 1].severity >= c.difference[i].severity);
}

/* What is changed of the earlier check's first case: added to, multiplied or set. The tolerance is
 * 0.2. */
#define OF(member) offsetof(struct br_case, member)
static const struct {
    size_t offset;
    char how;
    double by;
    enum br_severity severity;
    const char *subject;
} moved[] = {
    {OF(order.value), '+', 0, BR_SAME, ""},
    {OF(order.value), '+', 0.0001, BR_SAME, ""},
    {OF(order.value), '+', 0.01, BR_NOTE, "order"},
    {OF(order.value), '+', -0.1, BR_WARNING, "order"},
    {OF(order.value), '+', 0.3, BR_SERIOUS, "order"},
    {OF(order.value), '+', NAN, BR_SERIOUS, "order"},
    {OF(constant), '*', 1.0005, BR_SAME, ""},
    {OF(constant), '*', 1.02, BR_NOTE, "constant"},
    {OF(constant), '*', 1.5, BR_WARNING, "constant"},
    {OF(constant), '*', 0.6, BR_WARNING, "constant"},
    {OF(constant), '*', 2.1, BR_SERIOUS, "constant"},
    {OF(constant), '*', NAN, BR_SERIOUS, "constant"},
    {OF(expected.tolerance), '*', 0.5, BR_WARNING, "made space l2 axial: expectation"},
    {OF(expected.tolerance), '*', 2, BR_SAME, ""}, /* it is narrower now */
    {OF(expected.ceiling), '=', 1, BR_WARNING, "made space l2 axial: expectation"}, /* none now */
};

TEST(test_comparison)
{
    struct made_check m;
    made_create(&m);
    made_run(&m, 1);
    OWNED(br_old_check) old = as_old(&m, "made");
    struct br_case *const first = &old.check->cases[0], sound = *first;
    for (size_t i = 0; i < sizeof moved / sizeof *moved; i++) {
        double *value = (double *)((char *)first + moved[i].offset);
        *value = moved[i].how == '+'   ? *value + moved[i].by
                 : moved[i].how == '*' ? *value * moved[i].by
                                       : moved[i].by;
        compare(&m, &old, false, moved[i].severity, moved[i].subject);
        *first = sound;
    }
    first->verdict = BR_FAIL;
    compare(&m, &old, false, BR_NOTE, "verdict");
    first->order.value = first->constant = NAN; /* that it has one now is no harm */
    compare(&m, &old, false, BR_NOTE, "made space l2 axial");
    *first = sound;
    m.check.cases[0].verdict = BR_FAIL;
    compare(&m, &old, false, BR_SERIOUS, "made space l2 axial: verdict");
    m.check.cases[0].verdict = BR_PASS;
    struct br_expectation *now = &m.check.cases[0].expected;
    const struct br_expectation expected = *now;
    first->expected.floor = 1e-9;
    first->expected.ceiling = 1e9;
    now->floor = 1e-10;
    now->ceiling = 1e9;
    compare(&m, &old, false, BR_WARNING, "made space l2 axial: expectation");
    now->floor = 1e-8; /* narrower at both ends */
    now->ceiling = 1e8;
    compare(&m, &old, false, BR_SAME, "");
    *now = expected;
    *first = sound;
    now->tolerance = first->expected.tolerance = 0; /* a least order: a higher one is no harm */
    const double z = m.check.cases[0].point[m.check.cases[0].points - 1].z; /* of one error */
    first->order.value -= 1;
    first->constant = sound.constant * z;
    compare(&m, &old, false, BR_NOTE, "made space l2 axial: order");
    first->order.value += 1.1;
    first->constant = sound.constant * pow(z, -0.1);
    compare(&m, &old, false, BR_WARNING, "made space l2 axial: order");
    *first = sound;
    first->expected.tolerance = 0;
    first->constant = sound.constant / 10; /* the errors have grown, whatever their order */
    compare(&m, &old, false, BR_SERIOUS, "made space l2 axial: constant");
    first->constant = sound.constant * 10;
    compare(&m, &old, false, BR_NOTE, "made space l2 axial: constant");
    *first = sound; /* a band had an upper end */
    compare(&m, &old, false, BR_WARNING, "made space l2 axial: expectation");
    *now = expected;
    old.check->seconds = NAN;
    compare(&m, &old, false, BR_SAME, "");
    old.check->seconds = m.check.seconds / 10;
    compare(&m, &old, false, BR_WARNING, "made: ns per element-step");
    old.check->seconds = m.check.seconds;
    old.check->element_steps *= 2;
    compare(&m, &old, false, BR_WARNING, "made: ");
    old.check->element_steps /= 2;
    m.check.element_steps = old.check->element_steps = 0; /* neither was marched */
    compare(&m, &old, false, BR_SAME, "");
    first->measure = "tip";
    compare(&m, &old, false, BR_SERIOUS, "made space tip axial: gone");
    old.check->name = "other"; /* which is not checked now: that is no loss */
    compare(&m, &old, false, BR_NOTE, "new");
    compare(&m, &old, true, BR_SERIOUS, "gone"); /* or it is, where these are all there are */
    made_clear(&m);
}

/* Another method is told, whatever has changed of it. */
TEST(test_methods)
{
    struct made_check m;
    made_create(&m);
    made_run(&m, 1);
    OWNED(br_old_check) old = as_old(&m, "made");
    struct br_settings *now = &m.of.method[BR_VERIFY_TIME], then;
    for (size_t i = 0; i < now->count; i++) {
        const bool compared = i < BR_METHOD_FIELDS && !br_method_fields[i].unsaid;
        then = *now;
        strcpy(then.row[i].text, "another");
        then.row[i].kind = BR_SETTING_WORD;
        remember(&old, BR_VERIFY_TIME, &then);
        compare(&m, &old, false, compared ? BR_SERIOUS : BR_SAME,
                compared ? "made time: another method than the baseline's" : "");
    }
    json_t *of_first = json_object_get(json_object_get(old.json, "methods"), "0");
    json_object_del(of_first, "time"); /* not made then */
    compare(&m, &old, false, BR_SAME, "");
    struct br_method *method = &m.verify.study[BR_VERIFY_TIME].method;
    method->scheme = br_time_scheme_find("adaptive");
    br_method_settings(&(struct br_meshes){0}, method, now);
    remember(&old, BR_VERIFY_TIME, now);
    compare(&m, &old, false, BR_SAME, "");
    then = *now;
    strcpy(then.row[BR_METHOD_TOLERANCE].text, "2e-06");
    remember(&old, BR_VERIFY_TIME, &then);
    compare(&m, &old, false, BR_SERIOUS, "made time: another method");
    made_clear(&m);
}

/* A report that is older than a key means the default; one that never had what all have is none. */
TEST(test_missing_settings)
{
    struct made_check m;
    made_create(&m);
    made_run(&m, 1);
    OWNED(br_old_check) old = as_old(&m, "made");
    json_t *of_first = json_object_get(json_object_get(old.json, "methods"), "0");
    json_t *time = json_object_get(of_first, "time");
    json_object_del(time, "axial_degree");
    json_object_del(time, "scheme");
    json_object_del(time, "iteration");
    MUST(br_compare_check(&m.check, 1, &old, &err));
    compare(&m, &old, false, BR_SAME, "");
    for (int missing = 0; missing < 2; missing++) {
        json_object_set_new(time, "contact", json_array());
        if (missing)
            json_object_del(time, "contact");
        REFUSED(br_compare_check(&m.check, 1, &old, &err), BR_BAD_INPUT,
                "old.json: methods: found no contact of made time");
    }
    made_clear(&m);
}

/* What a comparison needs of the names. */
TEST(test_names)
{
    struct made_check m;
    made_create(&m);
    m.check.name = "m\xe4"
                   "de";
    made_run(&m, 1);
    OWNED(br_old_check) old = as_old(&m, "made");
    REFUSED(br_compare_check(&m.check, 1, &old, &err), BR_BAD_INPUT, "none of these scenes");
    old.check->name = "m?de"; /* as JSON has it */
    MUST(br_compare_check(&m.check, 1, &old, &err));
    compare(&m, &old, false, BR_SAME, "");
    const struct br_check twice[] = {m.check, m.check};
    REFUSED(br_compare_check(twice, 2, &old, &err), BR_BAD_INPUT, "two scenes are called");
    made_clear(&m);
}
