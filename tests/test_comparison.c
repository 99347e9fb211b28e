/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What has moved since an earlier check, and how serious that is. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "made_check.h"
#include "study/verify/comparison.h"
#include "support.h"

/* What the check itself would have left behind. */
static struct br_old_check as_old(const struct made_check *m)
{
    struct br_old_check old = {.count = m->check.count, .scenes = 1};
    old.cases = br_allocate(old.count + 1, sizeof *old.cases);
    old.costs = br_allocate(1, sizeof *old.costs);
    assert_non_null(old.cases);
    assert_non_null(old.costs);
    old.costs[0] = (struct br_old_cost){
        .scene = "made",
        .seconds = m->check.seconds,
        .element_steps = m->check.element_steps,
    };
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++)
        br_old_method_of(&m->verify.study[kind].method, &old.costs[0].method[kind]);
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
static void compare(const struct made_check *m, const struct br_old_check *old,
                    enum br_severity expected, const char *subject)
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

TEST(test_comparison)
{
    struct made_check m;
    made_create(&m);
    m.scene.name = (char[]){"made"};
    made_run(&m, 1);
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
    struct br_expectation *now = &m.check.cases[0].expected;
    const struct br_expectation expected = *now;
    old.cases[0].floor = 1e-9;
    old.cases[0].ceiling = 1e9;
    *now = expected;
    now->floor = 1e-10;
    now->ceiling = 1e9;
    compare(&m, &old, BR_WARNING, "made space l2 axial: expectation");
    now->floor = 1e-8; /* narrower at both ends */
    now->ceiling = 1e8;
    compare(&m, &old, BR_SAME, "");
    *now = expected;
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
    made_clear(&m);
}

/* Another method is told, whatever has changed of it. */
TEST(test_methods)
{
    struct made_check m;
    made_create(&m);
    m.scene.name = (char[]){"made"};
    made_run(&m, 1);
    struct br_old_check old = as_old(&m);
    struct br_old_method *method = &old.costs[0].method[BR_VERIFY_TIME];
    const struct br_old_method same = *method;
    for (size_t i = 0; i < BR_METHOD_FIELDS; i++) {
        strcpy(method->value[i], "another");
        compare(&m, &old, br_method_fields[i].unsaid ? BR_SAME : BR_NOTE,
                br_method_fields[i].unsaid ? "" : "made time: method");
        *method = same;
    }
    *method = (struct br_old_method){0}; /* not made then */
    compare(&m, &old, BR_SAME, "");
    *method = same;
    struct br_verify_study *time = &m.verify.study[BR_VERIFY_TIME];
    time->method.scheme = br_time_scheme_find("adaptive");
    br_old_method_of(&time->method, method);
    compare(&m, &old, BR_SAME, "");
    strcpy(method->value[BR_METHOD_TOLERANCE], "2e-06");
    compare(&m, &old, BR_NOTE, "made time: method");
    br_old_check_clear(&old);
    made_clear(&m);
}

/* What a comparison needs of the names. */
TEST(test_names)
{
    struct made_check m;
    struct br_error err = {0};
    made_create(&m);
    m.scene.name = (char[]){"m\xe4"
                            "de"};
    m.check.name = m.scene.name;
    made_run(&m, 1);
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
    made_clear(&m);
}

TEST(test_worse_verdict)
{
    struct made_check m;
    made_create(&m);
    m.scene.name = (char[]){"made"};
    m.verify.study[BR_VERIFY_SPACE].expectation[0].ceiling = 1e-12;
    made_run(&m, 1);
    struct br_old_check old = as_old(&m);
    old.cases[0].verdict = BR_PASS;
    compare(&m, &old, BR_SERIOUS, "made space l2 axial: verdict");
    br_old_check_clear(&old);
    made_clear(&m);
}
