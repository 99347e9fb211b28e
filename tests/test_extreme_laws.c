/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The laws at the tip where products of what they are given are no doubles, at their corners to the
 * last bit, and where they degenerate: every friction rule against the law in long double. */
#include <fenv.h>
#include <float.h>
#include <math.h>

#include "support.h"

#define EACH(rule) \
    for (const struct br_friction_rule *const *rule = br_friction_rules; *rule; rule++)

static int bad_flags(void)
{
    return fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
}

/* (12) or (29), in numbers that neither overflow nor are lost. */
static double law(const struct br_friction_rule *rule, const struct br_friction_state *s)
{
    const long double mu = rule->needs_regularisation ? s->regularisation : 0;
    const long double v = s->free_velocity, width = mu + (long double)s->bound * s->compliance;
    const double size = fabsl(v) >= width ? s->bound : (double)(fabsl(v) / width * s->bound);
    return copysign(size, s->free_velocity);
}

static void check_rule(const struct br_friction_rule *rule, struct br_friction_state s)
{
    s.iteration = br_iteration_defaults;
    const double expected = law(rule, &s);
    feclearexcept(FE_ALL_EXCEPT);
    const double lambda = rule->force(&s);
    const double tolerance = rule->iterates ? 2 * s.iteration.tolerance : 8 * DBL_EPSILON;
    if (bad_flags() ||
        !(fabs(lambda - expected) <=
          tolerance * (rule->iterates ? s.bound : fabs(expected)) + (1 + s.bound) * DBL_TRUE_MIN))
        fail_msg("%s: lambda is %.17g, expected %.17g; v* = %g, z = %g, bound %g, mu %g; flags %x",
                 rule->name, lambda, expected, s.free_velocity, s.compliance, s.bound,
                 s.regularisation, (unsigned)bad_flags());
}

/* Where h v or h z or 1 / mu is no double. */
static void test_sizes(void **state)
{
    (void)state;
    static const double sizes[] = {0, 1e-310, 1e-300, 1e-200, 1e-15, 1, 1e15, 1e100};
    enum { COUNT = sizeof sizes / sizeof *sizes };
    struct br_test_random random = {11};
    EACH(rule)
    for (int i = 0; i < 20000; i++) {
        const double jitter = br_test_uniform(&random, 1, 2);
        struct br_friction_state s = {
            .free_velocity = (i % 2 ? -jitter : jitter) * sizes[br_test_index(&random, COUNT)],
            .compliance = jitter * sizes[2 + br_test_index(&random, COUNT - 2)],
            .bound = sizes[br_test_index(&random, COUNT)],
            .regularisation = jitter * sizes[1 + br_test_index(&random, COUNT - 1)],
            .last = sizes[br_test_index(&random, COUNT)],
        };
        const double way = s.bound * s.compliance; /* below DBL_MIN it has no digits of its own */
        if (way == 0 || way > DBL_MIN)
            check_rule(*rule, s);
    }
}

/* A bound that is the reaction of a tip that is held, to the last bit, and one to each side. */
static void test_corner(void **state)
{
    (void)state;
    struct br_test_random random = {12};
    for (int i = 0; i < 2000; i++) {
        const double v = br_test_log_uniform(&random, 1e-9, 1e3);
        const double z = br_test_log_uniform(&random, 1e-9, 1e3), reaction = v / z;
        struct br_friction_state s = {.free_velocity = i % 2 ? v : -v, .compliance = z};
        const double sign = copysign(1, s.free_velocity);
        s.bound = reaction;
        assert_true(br_friction_rule_find("exact")->force(&s) == sign * reaction);
        s.bound = nextafter(reaction, INFINITY); /* sticks: not more than what holds it */
        assert_true(br_friction_rule_find("exact")->force(&s) == sign * reaction);
        s.bound = nextafter(reaction, 0); /* slips: all that there is */
        assert_true(br_friction_rule_find("exact")->force(&s) == sign * s.bound);
    }
}

/* mu so small that it is lost beside h z: the law itself, to the last bits. */
static void test_without_mu(void **state)
{
    (void)state;
    struct br_test_random random = {13};
    const struct br_friction_rule *exact = br_friction_rule_find("exact");
    const struct br_friction_rule *regularised = br_friction_rule_find("regularised");
    for (int i = 0; i < 2000; i++) {
        struct br_friction_state s = {
            .free_velocity = br_test_uniform(&random, -2, 2),
            .compliance = br_test_log_uniform(&random, 1e-3, 1),
            .bound = br_test_log_uniform(&random, 1e-3, 1e3),
            .regularisation = i % 2 ? 1e-300 : 1e-310,
        };
        const double lambda = exact->force(&s);
        CLOSE(regularised->force(&s), lambda, 4 * DBL_EPSILON * fabs(lambda));
    }
}

/* What is not a number stays so, and raises no flag of a trap. */
static void test_not_a_number(void **state)
{
    (void)state;
    EACH(rule)
    {
        struct br_friction_state s = {.free_velocity = NAN,
                                      .compliance = 1,
                                      .bound = 1,
                                      .regularisation = 1,
                                      .iteration = br_iteration_defaults};
        feclearexcept(FE_ALL_EXCEPT);
        assert_true(isnan((*rule)->force(&s)));
        s.bound = 0;
        assert_true(isnan((*rule)->force(&s)) || (*rule)->force(&s) == 0);
#ifndef __clang__ /* which compares a NaN with a flag where C asks for none */
        assert_int_equal(bad_flags(), 0);
#endif
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_corner),
        cmocka_unit_test(test_without_mu),
        cmocka_unit_test(test_not_a_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
