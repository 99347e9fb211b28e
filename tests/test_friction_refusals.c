/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Friction rules that iterate and do not converge, or cannot: they say so, and no march goes on. */
#include <math.h>
#include <string.h>

#include "solver/method.h"
#include "support.h"

/* The rules in turn. */
#define EACH(rule)                                                                          \
    for (const struct br_friction_rule *const *rule = br_friction_rules; *(rule); (rule)++) \
        if ((*(rule))->iterates)

static void test_nan_at_once(void **state)
{
    (void)state;
    const struct br_friction_state good = {0.5, 1, 1, 0, 0, {0.5, 1e-10, 10000}, 0};
    EACH(rule)
    for (int i = 0; i < 5; i++) {
        struct br_friction_state s = good;
        double *const number[] = {&s.free_velocity, &s.compliance, &s.bound, &s.last,
                                  &s.iteration.parameter};
        *number[i] = NAN;
        assert_true(isnan((*rule)->force(&s)));
        assert_int_equal(s.iterations, 0);
        if (i < 2) {
            s.bound = 0;
            assert_true(isnan((*rule)->force(&s)));
        }
    }
}

/* What does not converge is NaN, not some force. */
static void test_no_convergence(void **state)
{
    (void)state;
    EACH(rule)
    {
        struct br_friction_state s = {0.5, 1, 1, 0, 0, {0.01, 1e-10, 20}, 0};
        assert_true(isnan((*rule)->force(&s)));
        assert_int_equal(s.iterations, 20);
        s.iteration = (struct br_iteration){0.5, 1e-17, 1000}; /* below round-off */
        assert_true(isnan((*rule)->force(&s)));
        s.iteration = (struct br_iteration){0.5, NAN, 1000};
        assert_true(isnan((*rule)->force(&s)));
        const double wrong[] = {0, -1, (*rule)->parameter_below, 2 * (*rule)->parameter_below};
        for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
            s.iteration = (struct br_iteration){wrong[i], 1e-3, 1000};
            assert_true(isnan((*rule)->force(&s)));
        }
    }
}

static void test_refusals(void **state)
{
    (void)state;
    struct br_error err = {0};
    const struct {
        const char *rule;
        struct br_iteration iteration;
        const char *message;
    } rows[] = {
        {"uzawa",
         {2, 1e-10, 10},
         "the parameter of friction rule 'uzawa' is 2, expected a number above 0 and below 2"},
        {"uzawa", {0, 1e-10, 10}, "is 0, expected a number above 0 and below 2"},
        {"uzawa", {NAN, 1e-10, 10}, "is nan, expected a number above 0 and below 2"},
        {"penalty-duality", {-1, 1e-10, 10}, "is -1, expected a number above 0, where"},
        {"penalty-duality", {INFINITY, 1e-10, 10}, "is inf, expected a number above 0, where"},
        {"penalty-duality", {1, 1, 10}, "is to iterate to 1, at most 10 times, expected a"},
        {"penalty-duality", {1, NAN, 10}, "is to iterate to nan"},
        {"uzawa", {1, 0.1, 0}, "is to iterate to 0.1, at most 0 times, expected"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct br_method m = br_method_default();
        MUST(br_method_check(&m, &err));
        m.iteration = rows[i].iteration;
        MUST(br_method_check(&m, &err)); /* the exact law does not heed it */
        m.friction = br_friction_rule_find(rows[i].rule);
        REFUSED(br_method_check(&m, &err), BR_BAD_INPUT, rows[i].message);
        m.iteration = br_iteration_defaults;
        MUST(br_method_check(&m, &err));
    }
}

/* A march whose iterations do not end says so; one with which they cannot is refused. */
static void test_failing_march(void **state)
{
    (void)state;
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled("example2");
    EACH(rule)
    {
        struct br_method method = br_method_default();
        method.friction = *rule;
        method.iteration.most = 2;
        struct br_march *march = br_test_march(&scene, 10, 10, &method);
        enum br_status status = BR_OK;
        for (int step = 1; step <= 10 && !status; step++)
            status = br_march_step(march, &err);
        REFUSED(status, BR_NOT_FINITE, (*rule)->name);
        assert_non_null(strstr(err.message, "in 2 iterations at t = "));
        br_march_free(march);
        method.iteration.parameter = -1;
        REFUSED(br_march_create(&march, &scene, 10, 10, &method, &err), BR_BAD_INPUT,
                "is -1, expected a number above 0");
    }
    br_scene_clear(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nan_at_once),
        cmocka_unit_test(test_no_convergence),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_failing_march),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
