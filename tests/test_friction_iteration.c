/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Friction rules that iterate: they reach the exact law's force, in as many iterations as their
 * contraction allows. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "support.h"

/* The rules in turn. */
#define EACH(rule)                                                                          \
    for (const struct br_friction_rule *const *rule = br_friction_rules; *(rule); (rule)++) \
        if ((*(rule))->iterates)

static double exact(struct br_friction_state s)
{
    return br_friction_rule_find("exact")->force(&s);
}

/* A number of any size, in one of three ranges; now and then 0. */
static double any_size(struct br_test_random *r)
{
    switch (br_test_index(r, 8)) {
    case 0:
        return 0;
    case 1:
        return br_test_log_uniform(r, 1e-320, 1e-290);
    case 2:
        return br_test_log_uniform(r, 1e290, 1e308);
    case 3:
        return br_test_log_uniform(r, 1e-100, 1e100);
    default:
        return br_test_log_uniform(r, 1e-4, 1e4);
    }
}

static struct br_friction_state any_state(struct br_test_random *r)
{
    const double sign = br_test_index(r, 2) ? 1 : -1;
    struct br_friction_state s = {
        .free_velocity = sign * any_size(r),
        .compliance = any_size(r) + DBL_TRUE_MIN,
        .bound = any_size(r),
        .iteration = {.tolerance = br_test_log_uniform(r, 1e-12, 1e-2), .most = 100000},
    };
    if (br_test_index(r, 2)) /* near the change of stick and slip */
        s.free_velocity = sign * s.bound * s.compliance * br_test_uniform(r, 0, 1.5);
    s.last = s.bound * br_test_uniform(r, -2, 2); /* the bound has changed since */
    return s;
}

/* A parameter well within the range of a rule. */
static double any_parameter(const struct br_friction_rule *rule, struct br_test_random *r)
{
    return br_test_log_uniform(r, 0.05, isfinite(rule->parameter_below) ? 1.95 : 20);
}

/* The start is within 2 of the bound from the solution (in the dual variable of penalty-duality
 * within 2 (1 + parameter)), its first change is at most 1 + q times that, each later one q times
 * the one before, and an error is at most q/(1 - q) of a change. Half of the tolerance is left to
 * round-off. */
static double most_iterations(const struct br_friction_rule *rule, const struct br_iteration *i)
{
    const double q = rule->contraction(i->parameter);
    const double first = 2 * (1 + i->parameter) * (1 + q) / (1 - q);
    return q == 0 ? 1 : fmax(1, ceil(log(i->tolerance / 2 / first) / log(q)));
}

static void test_agreement(void **state)
{
    (void)state;
    struct br_test_random r = {71};
    size_t rules = 0, stuck = 0, all = 0;
    EACH(rule)
    {
        rules++;
        for (int i = 0; i < 20000; i++) {
            struct br_friction_state s = any_state(&r);
            s.iteration.parameter = any_parameter(*rule, &r);
            const double expected = exact(s), lambda = (*rule)->force(&s);
            CLOSE(lambda, expected, s.iteration.tolerance * s.bound + DBL_TRUE_MIN);
            assert_true(fabs(lambda) <= s.bound);
            const double most = most_iterations(*rule, &s.iteration);
            if (!((double)s.iterations <= most))
                fail_msg("%s: %zu iterations with parameter %g to %g, expected %g at most",
                         (*rule)->name, s.iterations, s.iteration.parameter, s.iteration.tolerance,
                         most);
            assert_true(s.iterations >= 1 || s.bound == 0);
            stuck += fabs(expected) < s.bound;
            all++;
        }
    }
    assert_true(rules >= 2);
    assert_in_range(stuck, all / 5, all - all / 5);
}

static double into(double lambda, double bound)
{
    return fmax(-bound, fmin(lambda, bound));
}

/* lambda <- P(lambda + rho v), as it is printed. */
static double printed_uzawa(const struct br_friction_state *s)
{
    const double rho = s->iteration.parameter / s->compliance;
    double lambda = into(s->last, s->bound);
    for (size_t i = 0; i < s->iterations; i++)
        lambda = into(lambda + rho * (s->free_velocity - lambda * s->compliance), s->bound);
    return lambda;
}

/* Bermudez and Moreno's, with the Yosida regularisation of G = b Sign - omega I from its resolvent,
 * and lambda in b Sign at the resolvent's velocity. */
static double printed_penalty_duality(const struct br_friction_state *s)
{
    const double z = s->compliance, omega = s->iteration.parameter / z, zeta = 1 / (2 * omega);
    const double last = into(s->last, s->bound);
    double q = last - omega * (s->free_velocity - last * z), resolvent = 0;
    for (size_t i = 0; i < s->iterations; i++) {
        const double v = (s->free_velocity - z * q) / (1 + omega * z);
        const double r = v + zeta * q, slack = fabs(r) - zeta * s->bound;
        resolvent = slack > 0 ? copysign(slack / (1 - zeta * omega), r) : 0;
        q = (r - resolvent) / zeta;
    }
    return q + omega * resolvent;
}

/* The iterates are those of the literature, whatever form they take in the code. */
static void test_printed_forms(void **state)
{
    (void)state;
    static const struct {
        const char *rule;
        double (*printed)(const struct br_friction_state *s);
    } rows[] = {{"uzawa", printed_uzawa}, {"penalty-duality", printed_penalty_duality}};
    struct br_test_random r = {73};
    for (size_t i = 0; i < 2 * 5000; i++) {
        const struct br_friction_rule *rule = br_friction_rule_find(rows[i % 2].rule);
        struct br_friction_state s = {
            .compliance = br_test_log_uniform(&r, 1e-4, 1e4),
            .bound = br_test_log_uniform(&r, 1e-3, 1e3),
            .iteration = {any_parameter(rule, &r), 1e-2, 1000},
        };
        s.free_velocity = s.bound * s.compliance * br_test_uniform(&r, -1.2, 1.2);
        s.last = s.bound * br_test_uniform(&r, -1.2, 1.2);
        const double lambda = rule->force(&s);
        CLOSE(lambda, rows[i % 2].printed(&s), 1e-12 * s.bound);
    }
}

/* Parameter 1 is the solution at once, and so is a start at the solution. */
static void test_one_iteration(void **state)
{
    (void)state;
    struct br_test_random r = {72};
    EACH(rule)
    for (int i = 0; i < 1000; i++) {
        struct br_friction_state s = any_state(&r);
        s.bound = 1;
        s.compliance = br_test_log_uniform(&r, 1e-4, 1e4);
        s.free_velocity = s.compliance * br_test_uniform(&r, -1, 1);
        s.iteration.parameter = 1;
        (*rule)->force(&s);
        assert_int_equal(s.iterations, 1);
        s.iteration.parameter = any_parameter(*rule, &r);
        s.last = exact(s);
        (*rule)->force(&s);
        assert_int_equal(s.iterations, 2);
        s.last = -s.last; /* which is none */
        s.iteration.parameter = 0.5;
        (*rule)->force(&s);
        assert_true(s.iterations > 3 || fabs(s.last) < 1e-2);
    }
}

/* The contraction is met where all is stick: it is not merely a bound. */
static void test_contraction(void **state)
{
    (void)state;
    EACH(rule)
    for (double parameter = 0.25; parameter < 2; parameter += 0.25) {
        double tolerance[2] = {1e-3, 1e-11}, count[2];
        for (int i = 0; i < 2; i++) {
            struct br_friction_state s = {.free_velocity = 0.1, .compliance = 1, .bound = 1};
            s.iteration = (struct br_iteration){parameter, tolerance[i], 100000};
            (*rule)->force(&s);
            count[i] = (double)s.iterations;
        }
        const double q = (*rule)->contraction(parameter);
        const double expected = q == 0 ? 0 : log(tolerance[1] / tolerance[0]) / log(q);
        CLOSE(count[1] - count[0], expected, 1 + 0.01 * expected);
    }
}

/* The tip's velocity and the friction force of both marches, to what the tolerance lets through:
 * an error of lambda changes the velocity by z_tip times that, and each step's may stay. */
static void compare_marches(const char *name, const struct br_friction_rule *rule)
{
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled(name);
    struct br_method method = br_method_default();
    struct br_march *march = br_test_march(&scene, 50, 200, &method);
    method.friction = rule;
    struct br_march *iterated = br_test_march(&scene, 50, 200, &method);
    const double z = br_march_compliance(march, BR_BENDING);
    const double tolerance = method.iteration.tolerance;
    for (int step = 1; step <= 200; step++) {
        MUST(br_march_step(march, &err));
        MUST(br_march_step(iterated, &err));
        const struct br_tip *a = br_march_tip(march), *b = br_march_tip(iterated);
        const double most = step * tolerance * a->friction_bound;
        CLOSE(b->friction_force, a->friction_force, most + 1e-12);
        CLOSE(b->velocity[BR_BENDING], a->velocity[BR_BENDING], z * most + 1e-13);
    }
    const size_t count = br_march_counts(iterated).iterations;
    assert_in_range(count, 200, 200 * (size_t)most_iterations(rule, &method.iteration));
    assert_int_equal(br_march_counts(march).iterations, 0);
    br_march_free(march);
    br_march_free(iterated);
    br_scene_clear(&scene);
}

static void test_marches(void **state)
{
    (void)state;
    static const char *const scenes[] = {"example1", "example2", "example3", "example4"};
    EACH(rule)
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        compare_marches(scenes[i], *rule);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_agreement),     cmocka_unit_test(test_printed_forms),
        cmocka_unit_test(test_one_iteration), cmocka_unit_test(test_contraction),
        cmocka_unit_test(test_marches),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
