/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scalar laws at the tip, each against its own definition: also where products of what they are
 * given are no doubles, at their corners to the last bit, and where they degenerate; rules that
 * iterate, which reach the exact law's force in as many iterations as their contraction allows, or
 * say that they do not. */
#include <fenv.h>
#include <float.h>
#include <math.h>
#include <string.h>

#include "solver/linear/linear_solver.h"
#include "solver/method.h"
#include "solver/scene.h"
#include "support.h"

/* The friction rules in turn; those that iterate. */
#define EACH(rule) \
    for (const struct br_friction_rule *const *rule = br_friction_rules; *(rule); (rule)++)
#define EACH_THAT_ITERATES(rule) EACH(rule) if ((*(rule))->iterates)

static int bad_flags(void)
{
    return fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
}

/* ---- contact ---- */

/* Backward Euler's contact force solves r = c_H (u + k (v* - r z) - g)_+. */
TEST(test_contact)
{
    struct br_test_random r = {7};
    const struct br_contact_rule *lagged = br_contact_rule_find("lagged");
    const struct br_contact_rule *implicit = br_contact_rule_find("implicit");
    size_t closed = 0;
    for (int i = 0; i < 10000; i++) {
        const struct br_contact c = {true, br_test_uniform(&r, 0, 0.5),
                                     br_test_log_uniform(&r, 1e-2, 1e8)};
        const struct br_contact_state s = {br_test_uniform(&r, -1, 1), br_test_uniform(&r, -50, 50),
                                           br_test_log_uniform(&r, 1e-4, 1),
                                           br_test_log_uniform(&r, 1e-4, 1e-1)};
        const double before = s.displacement > c.gap ? c.stiffness * (s.displacement - c.gap) : 0;
        CLOSE(lagged->force(&c, &s), before, 1e-14 * before);
        const double force = implicit->force(&c, &s);
        const double u = s.displacement + s.k * (s.free_velocity - force * s.compliance);
        const double after = u > c.gap ? c.stiffness * (u - c.gap) : 0;
        assert_true(force >= 0);
        const double size = fabs(s.displacement) + s.k * fabs(s.free_velocity) + c.gap;
        CLOSE(force, after, 4e-16 * c.stiffness * size + 1e-14 * force);
        closed += force > 0;
    }
    assert_true(closed >= 1000 && closed <= 9000);
}

/* ---- friction that is solved directly ---- */

TEST(test_bounds)
{
    struct br_scene s = br_test_bare();
    s.contact = (struct br_contact){true, 0.25, 10};
    assert_true(br_friction_bound(&s, 2) == 0);
    s.friction = (struct br_friction){.law = BR_TRESCA, .coefficient = 3};
    assert_true(br_friction_bound(&s, 2) == 3 && br_friction_bound(&s, -2) == 3);
    s.friction.law = BR_COULOMB;
    assert_true(br_friction_bound(&s, 2) == 6);
    assert_true(br_friction_bound(&s, 0) == 0);
    assert_true(br_penetration(&s.contact, 0.75) == 0.5);
    assert_true(br_penetration(&s.contact, 0.2) == 0);
}

/* The slope is the bound's derivative, none where the bound is constant; with a slope there is no
 * bound without penetration. A law without a row is refused. */
TEST(test_models)
{
    for (enum br_friction_law law = 1; law < BR_FRICTION_LAWS; law++) {
        const struct br_friction_model *m = &br_friction_models[law];
        const struct br_friction f = {.law = law, .coefficient = 3};
        assert_true(m->name && m->title && m->words && m->bound);
        assert_true(br_friction_rubs(&f));
        assert_int_equal(br_friction_follows_contact(&f), m->bound(&f, 1) != m->bound(&f, 2));
        if (!m->slope)
            continue;
        CLOSE(m->slope(&f, 0.5), (m->bound(&f, 0.75) - m->bound(&f, 0.25)) / 0.5, 1e-12);
        assert_true(m->bound(&f, 0) == 0);
    }
    struct br_scene s = br_test_bare();
    s.friction.law = 1000000;
    REFUSED(br_scene_check(&s, &err), BR_BAD_INPUT, "has no bound");
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

/* Usual numbers, and where h v or h z or 1 / mu is no double. */
TEST(test_friction)
{
    static const double sizes[] = {0, 1e-310, 1e-300, 1e-200, 1e-15, 1e-2, 1, 1e2, 1e15, 1e100};
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
TEST(test_corner)
{
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

/* ---- friction that iterates ---- */

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

/* What an iteration leaves of an error, at most: |1 - a| of laws.c. */
static double contraction(const struct br_friction_rule *rule, double parameter)
{
    return fabs(1 - parameter) / (strcmp(rule->name, "uzawa") == 0 ? 1 : 1 + parameter);
}

/* The start is within 2 of the bound from the solution (in the dual variable of penalty-duality
 * within 2 (1 + parameter)), its first change is at most 1 + q times that, each later one q times
 * the one before, and an error is at most q/(1 - q) of a change. Half of the tolerance is left to
 * round-off. */
static double most_iterations(const struct br_friction_rule *rule, const struct br_iteration *i)
{
    const double q = contraction(rule, i->parameter);
    const double first = 2 * (1 + i->parameter) * (1 + q) / (1 - q);
    return q == 0 ? 1 : fmax(1, ceil(log(i->tolerance / 2 / first) / log(q)));
}

TEST(test_agreement)
{
    struct br_test_random r = {71};
    size_t rules = 0, stuck = 0, all = 0;
    EACH_THAT_ITERATES(rule)
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
    assert_true(stuck >= all / 5 && stuck <= all - all / 5);
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
TEST(test_printed_forms)
{
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
TEST(test_one_iteration)
{
    struct br_test_random r = {72};
    EACH_THAT_ITERATES(rule)
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
TEST(test_contraction)
{
    EACH_THAT_ITERATES(rule)
    for (double parameter = 0.25; parameter < 2; parameter += 0.25) {
        double tolerance[2] = {1e-3, 1e-11}, count[2];
        for (int i = 0; i < 2; i++) {
            struct br_friction_state s = {.free_velocity = 0.1, .compliance = 1, .bound = 1};
            s.iteration = (struct br_iteration){parameter, tolerance[i], 100000};
            (*rule)->force(&s);
            count[i] = (double)s.iterations;
        }
        const double q = contraction(*rule, parameter);
        const double expected = q == 0 ? 0 : log(tolerance[1] / tolerance[0]) / log(q);
        CLOSE(count[1] - count[0], expected, 1 + 0.01 * expected);
    }
}

/* The tip's velocity and the friction force of both marches, to what the tolerance lets through:
 * an error of lambda changes the velocity by z_tip times that, and each step's may stay. */
static void compare_marches(const char *name, const struct br_friction_rule *rule)
{
    OWNED(br_scene) scene = br_test_bundled(name);
    struct br_method method = br_method_default();
    OWNED(br_march) *march = br_test_march(&scene, 50, 200, &method);
    method.friction = rule;
    OWNED(br_march) *iterated = br_test_march(&scene, 50, 200, &method);
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
    assert_true(count >= 200 && count <= 200 * (size_t)most_iterations(rule, &method.iteration));
    assert_int_equal(br_march_counts(march).iterations, 0);
}

TEST(test_marches)
{
    static const char *const scenes[] = {"example1", "example2", "example3", "example4"};
    EACH_THAT_ITERATES(rule)
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        compare_marches(scenes[i], *rule);
}

/* What does not converge is NaN, not some force. */
TEST(test_no_convergence)
{
    EACH_THAT_ITERATES(rule)
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

TEST(test_refusals)
{
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
        MUST(br_method_check(&m, NULL, &err));
        m.iteration = rows[i].iteration;
        MUST(br_method_check(&m, NULL, &err)); /* the exact law does not heed it */
        m.friction = br_friction_rule_find(rows[i].rule);
        REFUSED(br_method_check(&m, NULL, &err), BR_BAD_INPUT, rows[i].message);
        m.iteration = br_iteration_defaults;
        MUST(br_method_check(&m, NULL, &err));
    }
}

/* A march whose iterations do not end says so; one with which they cannot is refused. */
TEST(test_failing_march)
{
    OWNED(br_scene) scene = br_test_bundled("example2");
    EACH_THAT_ITERATES(rule)
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
}

/* ---- NaN, and the registries ---- */

/* A NaN must come out as one, at once; that of a velocity without a flag of a trap. */
static void check_friction_nan(const struct br_friction_rule *rule)
{
    for (int i = 0; i < 5; i++) {
        struct br_friction_state s = {0.5, 1, 1, 1, 0, {0.5, 1e-10, 10000}, 0};
        double *const number[] = {&s.free_velocity, &s.compliance, &s.bound, &s.last,
                                  &s.iteration.parameter};
        if (i > 0 && !rule->iterates)
            continue;
        *number[i] = NAN;
        feclearexcept(FE_ALL_EXCEPT);
        assert_true(isnan(rule->force(&s)));
        assert_int_equal(s.iterations, 0);
        if (i < 2) {
            s.bound = 0;
            const double lambda = rule->force(&s);
            assert_true(isnan(lambda) || (lambda == 0 && !rule->iterates));
        }
#ifndef __clang__ /* which compares a NaN with a flag where C asks for none */
        assert_true(i > 0 || bad_flags() == 0);
#endif
    }
}

TEST(test_nan_stays)
{
    const struct br_contact contact = {true, 0, 1};
    assert_true(isnan(br_penetration(&contact, NAN)));
    for (size_t i = 0; br_contact_rules[i]; i++) {
        const struct br_contact_state s = {NAN, NAN, 1, 1};
        assert_true(isnan(br_contact_rules[i]->force(&contact, &s)));
    }
    EACH(rule)
    check_friction_nan(*rule);
}

/* Names are unique, every record is complete, and an unknown name is NULL. */
TEST(test_registries)
{
    for (size_t i = 0; br_contact_rules[i]; i++) {
        assert_ptr_equal(br_contact_rule_find(br_contact_rules[i]->name), br_contact_rules[i]);
        assert_true(br_contact_rules[i]->title && br_contact_rules[i]->citation);
    }
    for (size_t i = 0; br_friction_rules[i]; i++) {
        assert_ptr_equal(br_friction_rule_find(br_friction_rules[i]->name), br_friction_rules[i]);
        assert_true(br_friction_rules[i]->title && br_friction_rules[i]->citation);
    }
    for (size_t i = 0; br_linear_solvers[i]; i++) {
        assert_ptr_equal(br_linear_solver_find(br_linear_solvers[i]->name), br_linear_solvers[i]);
        assert_true(br_linear_solvers[i]->title && br_linear_solvers[i]->citation);
    }
    for (const struct br_kernel *const *k = br_kernels; *k; k++)
        assert_ptr_equal(br_kernel_find((*k)->name), *k);
    assert_null(br_kernel_find("none of these"));
    assert_null(br_contact_rule_find("none of these"));
    assert_null(br_friction_rule_find("none of these"));
    assert_null(br_linear_solver_find("none of these"));
}
