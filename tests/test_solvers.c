/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every solver of the registry against the first one, at random data, with the
 * certificate of every step. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "reference/certificate.h"
#include "support.h"

enum { STEPS = 30, MOST_N = 48, MOST_KERNEL_N = 700 };

static const char *const loads[] = {"0",
                                    "30*t",
                                    "-20*(exp(t) - 1)",
                                    "50*x^2",
                                    "100*sin(3*x)*cos(5*t)",
                                    "10*exp(-x)*(t > 0.3)",
                                    "(x > 0.37 ? 40 : -15)*sin(7*t)"};

static struct br_load random_load(struct br_test_random *r)
{
    return br_test_load(loads[br_test_index(r, sizeof loads / sizeof *loads)]);
}

/* Elastic, viscous or both. */
static void random_material(struct br_test_random *r, double *stiffness, double *viscosity)
{
    const size_t choice = br_test_index(r, 4);
    *stiffness = choice == 0 ? 0 : br_test_log_uniform(r, 0.1, 1000);
    *viscosity = choice == 1 ? 0 : br_test_log_uniform(r, 0.01, 100);
}

static void random_initial(struct br_test_random *r, struct br_scene *s)
{
    if (br_test_index(r, 2)) {
        s->axial.displacement = br_test_function("0.02*x");
        s->axial.velocity = br_test_function("sin(x)");
    }
    if (br_test_index(r, 2)) {
        s->bending.displacement = br_test_function("0.3*x^2");
        s->bending.displacement_slope = br_test_function("0.6*x");
        s->bending.velocity = br_test_function("1 - cos(2*x)");
        s->bending.velocity_slope = br_test_function("2*sin(2*x)");
    }
}

static struct br_scene random_scene(struct br_test_random *r)
{
    struct br_scene s = {
        .length = br_test_log_uniform(r, 0.3, 3),
        .duration = br_test_log_uniform(r, 0.1, 3),
        .density = br_test_index(r, 3) ? br_test_log_uniform(r, 1e-4, 100) : 0,
    };
    const size_t parts = br_test_index(r, 5); /* mostly both */
    s.axial.modelled = parts != 0;
    s.bending.modelled = parts != 1;
    random_material(r, &s.axial.stiffness, &s.axial.viscosity);
    random_material(r, &s.bending.stiffness, &s.bending.viscosity);
    random_initial(r, &s);
    s.axial.load = random_load(r);
    s.bending.load = random_load(r);
    if (s.axial.modelled && br_test_index(r, 4))
        s.contact = (struct br_contact){.modelled = true,
                                        .gap = br_test_index(r, 2) ? 0.01 : 0,
                                        .stiffness = br_test_log_uniform(r, 0.1, 100)};
    if (s.bending.modelled && br_test_index(r, 4)) {
        const bool coulomb = s.contact.modelled && br_test_index(r, 2);
        s.friction = (struct br_friction){.law = coulomb ? BR_COULOMB : BR_TRESCA,
                                          .coefficient = br_test_log_uniform(r, 0.1, 100),
                                          .regularisation = br_test_log_uniform(r, 1e-10, 1)};
    }
    return s;
}

/* The lagged contact magnifies round-off too, where c_H k z_tip > 1, z_tip <= L/(c + ka). */
static void make_stable(struct br_scene *s)
{
    const double k = s->duration / STEPS;
    const double most = (s->axial.viscosity + k * s->axial.stiffness) / (k * s->length);
    s->contact.stiffness = fmin(s->contact.stiffness, 0.9 * most);
}

static double largest(const double *x, size_t count)
{
    double most = 0;
    for (size_t i = 0; i < count; i++)
        most = fmax(most, fabs(x[i]));
    return most;
}

static double difference(const double *x, const double *y, size_t count)
{
    double most = 0;
    for (size_t i = 0; i < count; i++)
        if (!(fabs(x[i] - y[i]) <= most)) /* a NaN stays */
            most = fabs(x[i] - y[i]);
    return most;
}

/* Relative to the largest displacement so far, in/out; velocities to that over k, too. */
static void compare(const struct br_march *a, const struct br_march *b, enum br_field_kind kind,
                    double *scale, double tolerance)
{
    const struct br_field *f = br_march_field(a, kind);
    const size_t size = br_field_size(f);
    double w[2][2 * (MOST_KERNEL_N + 1)], v[2][2 * (MOST_KERNEL_N + 1)];
    br_march_get(a, kind, w[0], v[0]);
    br_march_get(b, kind, w[1], v[1]);
    *scale = fmax(*scale, fmax(largest(w[0], size), f->k * largest(v[0], size)));
    AT_MOST(difference(w[0], w[1], size), tolerance * *scale);
    AT_MOST(difference(v[0], v[1], size), tolerance * *scale / f->k);
}

/* One march of each solver, each watched by a witness. */
struct pair {
    uint64_t seed;
    struct br_method method[2];
    struct br_march *march[2];
    struct br_witness *witness[2];
};

static void check_step(struct pair *p, double scale[2])
{
    struct br_error err = {0};
    for (int i = 0; i < 2; i++) {
        MUST(br_march_step(p->march[i], &err));
        const struct br_field *f = br_march_field(p->march[i], BR_AXIAL);
        const struct br_certificate certificate = br_witness_step(p->witness[i]);
        const struct br_certificate limits = br_certificate_limits(
            p->method[i].scheme, f->n, br_test_slack() * br_march_round_off(p->march[i]));
        if (br_certificate_check(&certificate, &limits, &err))
            fail_msg("seed %ju, %s, n = %zu, step %zu: %s", (uintmax_t)p->seed,
                     p->method[i].solver->name, f->n, br_march_steps_done(p->march[i]),
                     err.message);
    }
    const double tolerance = 1e-13 + 40 * br_test_slack() * br_march_round_off(p->march[1]);
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        compare(p->march[0], p->march[1], (enum br_field_kind)kind, &scale[kind], tolerance);
}

static void check_case(const struct br_linear_solver *solver, uint64_t seed)
{
    struct br_test_random r = {seed};
    struct br_error err = {0};
    struct br_scene scene = random_scene(&r);
    const size_t n =
        br_test_index(&r, 3) ? 1 + br_test_index(&r, MOST_N) : 1 + br_test_index(&r, 3);
    struct pair p = {.seed = seed};
    const struct br_contact_rule *contact = br_contact_rules[br_test_index(&r, 2)];
    if (contact == br_contact_rule_find("lagged"))
        make_stable(&scene);
    for (int i = 0; i < 2; i++)
        p.method[i] = br_method_default();
    p.method[1].solver = solver;
    p.method[0].contact = contact;
    p.method[0].friction = br_friction_rules[br_test_index(&r, 2)];
    p.method[1].contact = p.method[0].contact;
    p.method[1].friction = p.method[0].friction;
    for (int i = 0; i < 2; i++) {
        p.march[i] = br_test_march(&scene, n, STEPS, &p.method[i]);
        MUST(br_witness_create(&p.witness[i], p.march[i], &scene, &p.method[i], &err));
    }
    double scale[2] = {0, 0};
    for (int step = 0; step < STEPS; step++)
        check_step(&p, scale);
    for (int i = 0; i < 2; i++) {
        br_witness_free(p.witness[i]);
        br_march_free(p.march[i]);
    }
    br_scene_clear(&scene);
}

static void test_random_data(void **state)
{
    (void)state;
    const uint64_t cases = br_test_quick() ? 20 : 600;
    for (const struct br_linear_solver *const *s = br_linear_solvers + 1; *s; s++)
        for (uint64_t seed = 1; seed <= cases; seed++)
            check_case(*s, seed);
}

/* A march on each of two kernels: as close as the round-off predicted for both allows. */
static void check_kernel(const struct br_kernel *kernel, uint64_t seed)
{
    struct br_test_random r = {seed};
    struct br_scene scene = random_scene(&r);
    make_stable(&scene);
    const size_t n = 1 + br_test_index(&r, MOST_KERNEL_N);
    struct br_march *march[2];
    struct br_method method = br_test_method("riccati", NULL, NULL);
    method.contact = br_contact_rules[br_test_index(&r, 2)];
    method.friction = br_friction_rules[br_test_index(&r, 2)];
    for (int i = 0; i < 2; i++) {
        method.linear.kernel = i ? kernel : br_kernel_find("portable");
        march[i] = br_test_march(&scene, n, STEPS, &method);
    }
    double scale[2] = {0, 0};
    for (size_t step = 1; step <= STEPS; step++) {
        br_test_advance(march[0], step);
        br_test_advance(march[1], step);
        for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
            compare(march[0], march[1], (enum br_field_kind)kind, &scale[kind],
                    2 * br_march_round_off(march[0]));
    }
    br_march_free(march[0]);
    br_march_free(march[1]);
    br_scene_clear(&scene);
}

static void test_kernels(void **state)
{
    (void)state;
    const uint64_t cases = br_test_quick() ? 10 : 300;
    for (const struct br_kernel *const *k = br_kernels; *k; k++)
        for (uint64_t seed = 1; (*k)->available() && seed <= cases; seed++)
            check_kernel(*k, seed);
}

/* Every scaling and refinement that the options offer gives the same march. */
static void test_options(void **state)
{
    (void)state;
    static const char *const scalings[] = {"none", "sum", "max"};
    struct br_scene scene = br_test_bundled("example2");
    const struct br_method reference = br_method_default();
    const struct br_test_end expected = br_test_run(&scene, 20, 50, &reference);
    for (size_t i = 0; i < 3; i++)
        for (int refinement = 0; refinement < 3; refinement++) {
            struct br_method method = br_test_method("umfpack", NULL, NULL);
            method.linear =
                (struct br_linear_options){.scaling = scalings[i], .refinement = refinement};
            const struct br_test_end end = br_test_run(&scene, 20, 50, &method);
            AT_MOST(br_test_deviation(&end, &expected), 1e-9);
        }
    br_scene_clear(&scene);
}

static void test_refusals(void **state)
{
    (void)state;
    struct br_error err = {0};
    struct br_march *march;
    struct br_scene scene = br_test_bare();
    struct br_method method = br_test_method("umfpack", NULL, NULL);
    method.linear.scaling = "rows";
    REFUSED(br_march_create(&march, &scene, 4, 4, &method, &err), BR_BAD_INPUT,
            "scaling is 'rows', expected none, sum or max");
    assert_null(march);
    method = br_method_default();
    REFUSED(br_march_create(&march, &scene, 0, 4, &method, &err), BR_BAD_INPUT, "n is 0");
    REFUSED(br_march_create(&march, &scene, 4, 0, &method, &err), BR_BAD_INPUT, "no time steps");
    scene.friction.law = BR_TRESCA;
    method.friction = br_friction_rule_find("regularised");
    REFUSED(br_march_create(&march, &scene, 4, 4, &method, &err), BR_BAD_INPUT, "mu > 0");
    assert_null(march);
    scene.bending.stiffness = scene.bending.viscosity = 0;
    scene.friction.law = BR_FRICTIONLESS;
    REFUSED(br_march_create(&march, &scene, 4, 4, &method, &err), BR_BAD_INPUT,
            "stiffness plus viscosity is 0");
}

/* A load that is no number, and a march that blows up, are told at once. */
static void test_not_finite(void **state)
{
    (void)state;
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++) {
        struct br_error err = {0};
        struct br_method method = br_method_default();
        method.solver = *s;
        struct br_scene scene = br_test_bare();
        scene.bending.load = (struct br_load){.term[0].space = {.constant = 1},
                                              .term[0].time = br_test_function("sqrt(0.55 - t)")};
        struct br_march *march = br_test_march(&scene, 3, 10, &method);
        br_test_advance(march, 5);
        REFUSED(br_march_step(march, &err), BR_NOT_FINITE, "t = 0.59999999999999998 s");
        br_march_free(march);
        br_scene_clear(&scene);

        scene = br_test_bare(); /* unstable: the lagged contact, without viscosity */
        scene.duration = 1000;
        scene.axial.viscosity = 0;
        scene.axial.load = br_test_load("1");
        scene.contact = (struct br_contact){.modelled = true, .gap = 0.1, .stiffness = 1000};
        march = br_test_march(&scene, 4, 800, &method);
        enum br_status status = BR_OK;
        while (!status && br_march_steps_done(march) < 800)
            status = br_march_step(march, &err);
        REFUSED(status, BR_NOT_FINITE, "the march blew up at t = ");
        REFUSED(status, BR_NOT_FINITE, "of 800, k = 1.25 s): the axial ");
        br_march_free(march);
        br_scene_clear(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_data), cmocka_unit_test(test_kernels),
        cmocka_unit_test(test_options),     cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_not_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
