/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scalar laws at the tip, each against its own definition. */
#include <math.h>
#include <string.h>

#include "support.h"

/* Backward Euler's contact force solves r = c_H (u + k (v* - r z) - g)_+. */
static void test_contact(void **state)
{
    (void)state;
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
    assert_in_range(closed, 1000, 9000);
}

/* The exact law: stick, or slip at the bound in the direction of v. */
static void check_exact(struct br_friction_state *s)
{
    const double lambda = br_friction_rule_find("exact")->force(s);
    const double v = s->free_velocity - lambda * s->compliance;
    const double round_off = 1e-15 * fabs(s->free_velocity);
    assert_true(fabs(lambda) <= s->bound);
    if (fabs(lambda) < s->bound)
        CLOSE(v, 0, round_off);
    else
        assert_true(lambda * v >= -fabs(lambda) * round_off);
}

/* (29), corrected: lambda = h v / mu within mu, h sign(v) beyond. */
static void check_regularised(struct br_friction_state *s)
{
    const double lambda = br_friction_rule_find("regularised")->force(s);
    const double v = s->free_velocity - lambda * s->compliance;
    const double inner = s->bound * v / s->regularisation;
    const double law = fabs(v) <= s->regularisation ? inner : copysign(s->bound, v);
    const double round_off = 1e-15 * fabs(s->free_velocity);
    assert_true(fabs(lambda) <= s->bound);
    CLOSE(lambda, law, 1e-13 * s->bound + s->bound / s->regularisation * round_off);
}

static void test_friction(void **state)
{
    (void)state;
    struct br_test_random r = {8};
    size_t stuck = 0;
    for (int i = 0; i < 10000; i++) {
        struct br_friction_state s = {
            .free_velocity = br_test_uniform(&r, -1, 1),
            .compliance = br_test_log_uniform(&r, 1e-3, 1),
            .bound = br_test_index(&r, 10) ? br_test_log_uniform(&r, 1e-3, 100) : 0,
            .regularisation = br_test_log_uniform(&r, 1e-10, 1),
        };
        check_exact(&s);
        check_regularised(&s);
        stuck += fabs(s.free_velocity) < s.bound * s.compliance;
    }
    assert_in_range(stuck, 1000, 9000);
}

/* As mu falls the regularised force tends to the exact one, within h mu/(mu + h z). */
static void test_regularisation_vanishes(void **state)
{
    (void)state;
    struct br_test_random r = {9};
    for (int i = 0; i < 1000; i++) {
        struct br_friction_state s = {
            .free_velocity = br_test_uniform(&r, -1, 1),
            .compliance = br_test_log_uniform(&r, 1e-3, 1),
            .bound = br_test_log_uniform(&r, 1e-3, 100),
        };
        const double exact = br_friction_rule_find("exact")->force(&s);
        for (s.regularisation = 1; s.regularisation > 1e-12; s.regularisation /= 10) {
            const double mu = s.regularisation;
            CLOSE(br_friction_rule_find("regularised")->force(&s), exact,
                  s.bound * mu / (mu + s.bound * s.compliance) + 1e-14 * s.bound);
        }
    }
}

static void test_bounds(void **state)
{
    (void)state;
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

/* A NaN must come out as one: clamping must not hide it. */
static void test_nan_stays(void **state)
{
    (void)state;
    const struct br_contact contact = {true, 0, 1};
    assert_true(isnan(br_penetration(&contact, NAN)));
    for (size_t i = 0; br_contact_rules[i]; i++) {
        const struct br_contact_state s = {NAN, NAN, 1, 1};
        assert_true(isnan(br_contact_rules[i]->force(&contact, &s)));
    }
    for (size_t i = 0; br_friction_rules[i]; i++) {
        struct br_friction_state s = {NAN, 1, 1, 1, 0, br_iteration_defaults, 0};
        assert_true(isnan(br_friction_rules[i]->force(&s)));
    }
}

/* Names are unique, every record is complete, and an unknown name is NULL. */
static void test_registries(void **state)
{
    (void)state;
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
    assert_null(br_contact_rule_find("none of these"));
    assert_null(br_friction_rule_find("none of these"));
    assert_null(br_linear_solver_find("none of these"));
}

/* (12) in a whole march: the tip of a stuck beam rests, and lambda is its reaction. */
static void test_stick_reaction(void **state)
{
    (void)state;
    struct br_scene scene = br_test_bare();
    scene.density = 0;
    scene.bending.load = br_test_load("16");
    scene.friction = (struct br_friction){.law = BR_TRESCA, .coefficient = 6.5};
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++) {
        struct br_method method = br_method_default();
        method.solver = *s;
        struct br_march *march = br_test_march(&scene, 8, 10, &method);
        br_test_advance(march, 10);
        CLOSE(br_march_tip(march)->friction_force, 3.0 / 8 * 16, 1e-9); /* propped cantilever */
        CLOSE(br_march_tip_displacement(march, BR_BENDING), 0, 1e-12);
        br_march_free(march);
    }
    br_scene_clear(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_contact),
        cmocka_unit_test(test_friction),
        cmocka_unit_test(test_regularisation_vanishes),
        cmocka_unit_test(test_bounds),
        cmocka_unit_test(test_nan_stays),
        cmocka_unit_test(test_registries),
        cmocka_unit_test(test_stick_reaction),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
